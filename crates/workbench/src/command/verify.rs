//! `verify`: the audit of the given controller, with a proof and a test on the machine if these are
//! requested.

use phea_dynamics::watch::{Watch, within};
use phea_engineering::audit::{AuditedProblem, ProjectAudit, audit_problem, problem_to_audit, prove_audit};
use phea_engineering::design::below_design;
use phea_engineering::rig::RigError;
use phea_engineering::robust::RobustProblem;
use phea_engineering::setup::Setup;
use phea_engineering::trial::{Agreement, DrivenCorners, simulated_trial};
use phea_qft::verification::Verdict;

use super::CommandError;
use super::impossible::{Impossible, ImpossibleAnswer};
use super::unprinted::Unprinted;
use crate::answer::{Answer, Body};
use crate::audit::{self, AuditAnswer, CERTIFICATE_FILE, certificate_of};
use crate::document::Document;
use crate::project::Loaded;
use crate::report;
use crate::source::Source;
use crate::trial::{self, TrialAnswer};

/// Answer of `verify`.
#[derive(Answer)]
pub(super) struct VerifyAnswer {
    #[answer(flatten)]
    audit: AuditAnswer,
    /// Requirements that no loop can satisfy.
    impossible: Vec<ImpossibleAnswer>,
    /// Verdict tested on the nonlinear machine, if requested.
    #[answer(optional)]
    machine: Option<TrialAnswer>,
}

/// Fraction of an audit's progress for the specifications; the rest is for the limits of a design.
const SPECIFICATIONS: f64 = 0.9;

/// The audit of the given controller, with the limits of a design that it exceeds.
pub(super) fn audited(
    source: &dyn Source,
    setup: &Setup<'_>,
    watch: Watch<'_>,
) -> Result<(RobustProblem, ProjectAudit), CommandError> {
    let problem = problem_to_audit(source, setup)?;
    let mut view = audit_problem(&problem, &mut within(&mut *watch, [0.0, SPECIFICATIONS]))?;
    let limits = &mut within(watch, [SPECIFICATIONS, 1.0]);
    view.below_design = Some(below_design(setup, &problem, &view, limits)?);
    Ok((problem, view))
}

/// The audit of a given controller, with a proof and a test on the machine if requested.
pub(super) fn verify_answer(
    source: &dyn Source,
    loaded: &Loaded,
    proof: bool,
    on_machine: bool,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let parts = 1.0 + f64::from(u8::from(proof)) + f64::from(u8::from(on_machine));
    let proven = (1.0 + f64::from(u8::from(proof))) / parts;
    let (problem, mut view) = audited(source, &setup, &mut within(&mut *watch, [0.0, 1.0 / parts]))?;
    if proof {
        let watch = &mut within(&mut *watch, [1.0 / parts, proven]);
        prove_audit(&problem, &mut view, watch)?;
    }
    let mut files = audit::files(&view);
    files.extend(certificate_of(loaded, &view, CERTIFICATE_FILE));
    let is_met = view.verdict() == Verdict::Met;
    let impossible = Impossible::all(source, loaded, &setup, Some(&problem))?;
    let mut document = Document::default();
    document.warnings(impossible.iter().map(Impossible::sentence));
    let mut body = VerifyAnswer {
        audit: audit::body(&view),
        impossible: impossible.iter().map(Impossible::answer).collect(),
        machine: None,
    };
    if !on_machine {
        document.append(audit::output(&view, None));
        let body = body.into_object();
        document.later(move || report::of_audit(&problem, &view, None));
        return Ok(Unprinted { document, body, files, affirmative: is_met });
    }
    let watch = &mut within(watch, [proven, 1.0]);
    let corners = DrivenCorners::WhereElseSatisfies;
    let audited = AuditedProblem { problem: &problem, view: &view };
    let Some(trial) = simulated_trial(source, &setup, audited, corners, watch)? else {
        return Err(RigError::NoActuator.into());
    };
    document.append(audit::output(&view, Some(&trial)));
    body.machine = Some(trial::body(&trial));
    let affirmative =
        is_met && trial.agreement() != Agreement::Contradicts && trial.satisfies() != Some(false);
    document.later(move || report::of_audit(&problem, &view, Some(&trial)));
    Ok(Unprinted { document, body: body.into_object(), files, affirmative })
}
