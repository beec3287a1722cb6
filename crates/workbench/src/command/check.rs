//! `check`: the consequences of a project, and its errors, found before anything is run.

use phea_qft::family::Family;

use super::CommandError;
use super::alternatives::read_alternatives;
use super::impossible::{Impossible, ImpossibleAnswer};
use super::unprinted::Unprinted;
use crate::answer::{Answer, Body};
use crate::caveat::{self, Caveat, caveats};
use crate::derived::{self, DerivedAnswer, derive};
use crate::document::Document;
use crate::family::{family, visited_box};
use crate::project::{LateError, Loaded, Severity, WrittenUnits, refused};
use crate::rig::RigError;
use crate::robust::robust_problem;
use crate::setup::Setup;
use crate::simulate::{foreseen, foreseen_late, unreadable};
use crate::source::Source;
use crate::specification::{self, requirements_in_time};

/// Answer of `check`.
#[derive(Answer)]
pub(super) struct CheckAnswer {
    #[answer(flatten)]
    derived: DerivedAnswer,
    /// Requirements that no loop can satisfy.
    impossible: Vec<ImpossibleAnswer>,
}

/// Every derived quantity, the box of the family and the requirements in time.
///
/// # Errors
/// [`CommandError`] for an invalid rig, family or scenario.
pub(super) fn check(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let derived = match derive(&setup) {
        Ok(derived) => derived,
        // A plant given as a transfer function has nothing to derive, but is valid.
        Err(RigError::NoActuator) => vec![],
        Err(error) => return Err(error.into()),
    };
    // every error of measured plants, and not only the first missing file
    let underived = derived.is_empty().then(|| without_derived(source, &setup)).transpose()?;
    let of_alternatives = read_alternatives(source, loaded, catalogues)?;
    let is_specified = !loaded.project.specifications.is_empty();
    let problem = if is_specified { robust_problem(source, &setup).ok() } else { None };
    let impossible = Impossible::all(source, loaded, &setup, problem.as_ref())?;
    let of_scenarios = scenarios(source, loaded, &setup)?;
    let requirements_in_time = requirements_in_time(&loaded.project)?;
    let visited = visited_box(&setup)?;
    let of_loops = impossible.iter().map(Impossible::sentence);
    let further_warnings = first_warnings(&setup, &impossible).into_iter().chain(of_loops);
    let further_warnings: Vec<String> = further_warnings.chain(of_alternatives).chain(of_scenarios).collect();
    let mut document = Document::default();
    document.warnings(further_warnings.clone());
    if !derived.is_empty() {
        document.append(derived::document(&derived, &WrittenUnits::of(loaded)));
        document.gap();
    }
    if let Some(ranges) = visited.as_ref().filter(|_| !derived.is_empty()) {
        document.append(derived::visited(&loaded.project, ranges));
        document.gap();
    }
    document.append(specification::document(&requirements_in_time));
    let valid = match impossible.is_empty() {
        true => "The project is valid.",
        false => "The project is valid, and requires what no loop can satisfy: see the warnings.",
    };
    document.line(match underived {
        Some(words) => format!("{valid} {words}"),
        None => valid.to_string(),
    });
    let files = derived::files(&derived);
    let body = CheckAnswer {
        derived: derived::body(loaded, &derived, visited.as_deref(), &requirements_in_time, further_warnings),
        impossible: impossible.iter().map(Impossible::answer).collect(),
    };
    Ok(Unprinted { document, body: body.into_object(), files, affirmative: true })
}

/// Requests of the scenarios that the rig cannot satisfy, each with its line.
///
/// # Errors
/// [`CommandError`] for a file that the project names and that is missing or malformed.
fn scenarios(source: &dyn Source, loaded: &Loaded, setup: &Setup<'_>) -> Result<Vec<String>, CommandError> {
    if let Some(missing) = unreadable(source, &loaded.project).first() {
        let mut refusal = refused(source, loaded, missing);
        refusal.diagnostics.retain(|found| found.severity == Severity::Error);
        return Err(CommandError::Refused(refusal));
    }
    let line = |at: &LateError| {
        let found = refused(source, loaded, at).diagnostics;
        found.iter().find(|found| found.message == at.message).map_or(0, |found| found.line)
    };
    let units = &setup.project.units;
    let late = foreseen(source, setup)?.into_iter().map(|one| foreseen_late(one, units));
    Ok(late.map(|at| format!("{} (line {})", at.message, line(&at))).collect())
}

/// Effects that no verdict on the linear loop includes, and parameters of the rig outside its own
/// family.
fn first_warnings(setup: &Setup<'_>, impossible: &[Impossible]) -> Vec<String> {
    let outside = setup.outside().map(|(_, parameters)| caveat::outside(&parameters));
    // a required step beyond the rig is among the impossible requirements, with its line
    let is_new = |caveat: &Caveat| !impossible.iter().any(|one| one.is_step_of(caveat));
    let of_loop: Vec<Caveat> = caveats(setup).into_iter().filter(is_new).collect();
    outside.into_iter().chain(caveat::sentences(&of_loop, &setup.project.units)).collect()
}

/// A project without an actuator has only its family, which must be valid.
fn without_derived(source: &dyn Source, setup: &Setup<'_>) -> Result<&'static str, CommandError> {
    Ok(match family(setup, source)? {
        Family::Measured(_) => "Its plants were measured, and nothing is derived from them.",
        Family::Uncertain(_) => "Its plant is a transfer function, from which nothing is derived.",
    })
}
