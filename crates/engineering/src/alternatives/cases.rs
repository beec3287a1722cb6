//! The project and its alternatives under each of its load cases.

use phea_dynamics::watch::{Progress, Watch};

use super::prepared::prepared;
use super::{AlternativesError, JudgedAlternative, Judging, PreparedAlternative};
use crate::catalogue::Catalogue;
use crate::parts::PartsCounted;
use crate::project::{Loaded, read_load_case};
use crate::source::Source;

/// The project and its alternatives under a load case.
#[derive(Clone, Debug)]
pub struct JudgedCase {
    /// Name of the load case.
    pub name: String,
    /// Settings of the load case.
    pub settings: Vec<String>,
    /// The declared project first, then its alternatives in file order.
    pub judged: Vec<JudgedAlternative>,
    /// Names of the alternatives that were not finished when `watch` cancelled.
    pub not_reached: Vec<String>,
}

/// The project under a load case with its alternatives, ready to be judged.
#[derive(Clone, Debug)]
pub struct PreparedCase {
    /// Name of the load case.
    pub name: String,
    /// Settings of the load case.
    pub settings: Vec<String>,
    /// The declared project first, then its alternatives in file order.
    pub all: Vec<PreparedAlternative>,
    /// Attributes of parts that are counted.
    pub counted: PartsCounted,
}

/// The load cases of a project in file order.
///
/// # Errors
/// The errors of [`prepared()`], with the name of the load case.
pub fn prepared_cases(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
) -> Result<Vec<PreparedCase>, AlternativesError> {
    let each = loaded.project.load_cases.iter().enumerate().map(|(index, case)| {
        let there = read_load_case(source, loaded, catalogues, index).map_err(AlternativesError::Refused)?;
        let named = |error: AlternativesError| match error {
            AlternativesError::Alternative { name, reason } => {
                AlternativesError::Alternative { name: format!("{name}, {}", case.name), reason }
            }
            other => other,
        };
        let (all, counted) = prepared(source, &there, catalogues).map_err(named)?;
        let settings = case.settings().collect();
        Ok(PreparedCase { name: case.name.clone(), settings, all, counted })
    });
    each.collect()
}

/// Judges one after the other; once `watch` cancels, no further one is reached.
pub(super) fn judged(
    judging: &Judging<'_>,
    all: &[PreparedAlternative],
    continues: bool,
    watch: Watch<'_>,
) -> (Vec<JudgedAlternative>, Vec<String>) {
    let (mut found, mut not_reached) = (Vec::new(), Vec::new());
    let count = all.len() as f64;
    for (index, one) in all.iter().enumerate() {
        let mut watched = |progress: Progress| {
            watch(Progress { fraction: (index as f64 + progress.fraction) / count, ..progress })
        };
        let reached = continues && not_reached.is_empty();
        let judged = if reached { judging.judged(one.clone(), &mut watched) } else { None };
        match judged {
            Some(judged) => found.push(judged),
            None => not_reached.push(one.name.clone()),
        }
    }
    (found, not_reached)
}

/// Every load case that is reached before `watch` cancels.
pub(super) fn judged_cases(
    (source, catalogue, impedance_at): (&dyn Source, &Catalogue, &[f64]),
    cases: Vec<PreparedCase>,
    continues: bool,
    watch: Watch<'_>,
) -> Vec<JudgedCase> {
    let count = cases.len() as f64;
    let mut continues = continues;
    let judged = cases.into_iter().enumerate().map(|(index, case)| {
        let judging = Judging { source, catalogue, all: &case.all, impedance_at, counted: case.counted };
        let mut watched = |progress: Progress| {
            watch(Progress { fraction: (index as f64 + progress.fraction) / count, ..progress })
        };
        let (judged, not_reached) = judged(&judging, &case.all, continues, &mut watched);
        continues = continues && not_reached.is_empty();
        JudgedCase { name: case.name, settings: case.settings, judged, not_reached }
    });
    judged.collect()
}
