//! `alternatives`: one project with several sets of values, judged side by side.

use phea_dynamics::watch::Progress;
use phea_engineering::alternatives::{
    AlternativesError, AlternativesOptions, AlternativesPlan, FrontRequest, IMPEDANCE_AT, JudgedLoad,
    Judging, PreparedAlternative, PreparedLoad, prepared_load,
};
use phea_engineering::linearize::SweepRequest;

use super::simulate::frequencies;
use super::unprinted::Unprinted;
use super::{CommandError, Watch};
use crate::alternatives::{self, PrintedAlternatives, PrintedTask, joined, outside_words};
use crate::answer::Body;
use crate::project::{AS_DECLARED, Loaded};
use crate::source::Source;

/// Request on the alternatives of a project, as written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AlternativesRequest {
    /// True if files are requested.
    pub files: bool,
    /// Columns of a front, separated by commas.
    pub front: Option<String>,
    /// Parameter that is swept for the front, such as `line.length=0.5 m..3 m`.
    pub sweep: Option<String>,
    /// Number of values of the sweep.
    pub points: Option<usize>,
    /// Frequencies at which the impedance at the load is stated, such as `1, 10 Hz`.
    pub frequencies: Option<String>,
}

impl AlternativesRequest {
    pub(super) fn read(&self) -> Result<AlternativesOptions, CommandError> {
        let front = self.front.as_ref().zip(self.sweep.as_ref()).map(|(columns, range)| FrontRequest {
            columns: columns.split(',').map(|column| column.trim().to_string()).collect(),
            sweep: SweepRequest { range: range.clone(), points: self.points },
        });
        let at = self.frequencies.as_deref().map_or(Ok(IMPEDANCE_AT.to_vec()), frequencies)?;
        Ok(AlternativesOptions { front, impedance_at: at })
    }
}

pub(super) fn alternatives_answer(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    request: &AlternativesRequest,
    watch: Watch<'_>,
) -> Result<Unprinted, CommandError> {
    let found = judged(source, loaded, catalogues, &request.read()?, watch)?;
    Ok(unprinted(&found, request.files))
}

/// Output of the command.
pub(super) fn unprinted(found: &PrintedAlternatives, files: bool) -> Unprinted {
    Unprinted {
        document: alternatives::output(found),
        body: alternatives::body(found).into_object(),
        files: if files { alternatives::files(found) } else { vec![] },
        affirmative: found.is_complete(),
    }
}

/// Judges the project as declared, and each of its alternatives, one after the other; then all of
/// them under each load case, and at each value of the front. If `watch` returns `false`, the
/// current one and all later ones are not reached.
///
/// # Errors
/// [`AlternativesError`].
pub(super) fn judged(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    options: &AlternativesOptions,
    watch: Watch<'_>,
) -> Result<PrintedAlternatives, AlternativesError> {
    let plan = AlternativesPlan::new(loaded, options)?;
    let loads = prepared_loads(source, loaded, catalogues, &plan)?;
    let judging = Judging::new(source, catalogues, &plan)?;
    let motion = loaded.project.motion();
    let (tasks, mut continues) = (plan.tasks(), true);
    let count = tasks.len() as f64;
    let results = tasks.into_iter().enumerate().map(|(place, task)| {
        let mut watched = |progress: Progress| {
            watch(Progress { fraction: (place as f64 + progress.fraction) / count, ..progress })
        };
        let prepared = loads.iter().find(|prepared| prepared.load == task.load()).filter(|_| continues);
        let judged = prepared.and_then(|prepared| judging.judged(prepared, task, &mut watched));
        continues = judged.is_some();
        judged.map(|judged| PrintedTask::of(judged, motion))
    });
    Ok(joined(&plan, motion, results))
}

/// The alternatives under every load of a plan.
pub(super) fn prepared_loads(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    plan: &AlternativesPlan,
) -> Result<Vec<PreparedLoad>, AlternativesError> {
    plan.loads().map(|load| prepared_load(source, loaded, catalogues, load)).collect()
}

/// Reads every alternative and assembles its rig, so that an invalid one is found before anything
/// is designed; reports those whose rig is not in its family.
pub(super) fn read_alternatives(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
) -> Result<Vec<String>, CommandError> {
    if loaded.project.alternatives.is_empty() {
        return Ok(vec![]);
    }
    let declared = prepared_load(source, loaded, catalogues, JudgedLoad::Declared)?;
    let mut warnings = rigs(&declared.all, "")?;
    for (index, case) in loaded.project.load_cases.iter().enumerate() {
        let there = prepared_load(source, loaded, catalogues, JudgedLoad::Case(index))?;
        let further = rigs(&there.all, &format!(", {}", case.name))?;
        warnings
            .extend(further.into_iter().filter(|sentence| !warnings.contains(sentence)).collect::<Vec<_>>());
    }
    Ok(warnings)
}

/// Assembles the rig of each alternative; returns the sentences on those that their families do not
/// contain.
fn rigs(all: &[PreparedAlternative], case: &str) -> Result<Vec<String>, CommandError> {
    let own = |one: &&PreparedAlternative| !case.is_empty() || one.name != AS_DECLARED;
    for one in all.iter().filter(own).filter(|one| one.loaded.project.actuator.is_some()) {
        if let Err(error) = &one.rig {
            let name = format!("{}{case}", one.name);
            return Err(AlternativesError::Alternative { name, reason: error.clone().into() }.into());
        }
    }
    Ok(all
        .iter()
        .filter_map(|one| Some(outside_words(&one.name, &one.outside(all)?, !one.moved.is_empty())))
        .collect())
}
