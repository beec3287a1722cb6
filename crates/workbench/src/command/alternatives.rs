//! `alternatives`: one project with several sets of values, judged side by side.

use super::simulate::frequencies;
use super::unprinted::Unprinted;
use super::{CommandError, Watch};
use crate::alternatives::{
    self, AlternativesError, AlternativesOptions, FrontRequest, IMPEDANCE_AT, PreparedAlternative, judge,
    outside_words, prepared, prepared_cases,
};
use crate::answer::Body;
use crate::linearize::SweepRequest;
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
    fn read(&self) -> Result<AlternativesOptions, CommandError> {
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
    let found = judge(source, loaded, catalogues, &request.read()?, watch)?;
    Ok(Unprinted {
        document: alternatives::output(&found),
        body: alternatives::body(&found).into_object(),
        files: if request.files { alternatives::files(&found) } else { vec![] },
        affirmative: found.is_complete(),
    })
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
    let mut warnings = rigs(&prepared(source, loaded, catalogues)?.0, "")?;
    for case in prepared_cases(source, loaded, catalogues)? {
        let further = rigs(&case.all, &format!(", {}", case.name))?;
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
