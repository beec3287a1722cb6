//! Requirements that no loop can satisfy, with their lines, in words and in JSON.

use phea_engineering::impossible::{Impossibility, ImpossibleStep, impossibilities};

use crate::answer::Answer;
use crate::caveat::{Caveat, UncountedEffect};
use crate::impossible::late_of;
use crate::project::{LateError, Loaded, refused};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::source::Source;
use crate::specification::SpecificationError;

/// Requirement that no loop can satisfy, in JSON.
#[derive(Answer)]
pub(super) struct ImpossibleAnswer {
    /// Key of the project file.
    key: String,
    /// Line of the key in the file, from 1.
    line: usize,
    /// Sentence with the plant and the frequency that forbid it.
    sentence: String,
    /// Change that would satisfy it.
    remedy: String,
}

/// A requirement that no loop can satisfy.
pub(super) struct Impossible {
    fact: Impossibility,
    at: LateError,
    line: usize,
}

impl Impossible {
    /// The requirements of a project that no loop can satisfy, given its robust problem, if any.
    ///
    /// # Errors
    /// [`SpecificationError`] for a limit that is absent or not a function of frequency.
    pub(super) fn all(
        source: &dyn Source,
        loaded: &Loaded,
        setup: &Setup<'_>,
        problem: Option<&RobustProblem>,
    ) -> Result<Vec<Impossible>, SpecificationError> {
        let found = impossibilities(setup, problem)?;
        let of = |fact: Impossibility| {
            let at = late_of(&fact, problem, &setup.project.units)?;
            let line = refused(source, loaded, &at).diagnostics.first().map_or(0, |found| found.line);
            Some(Impossible { fact, at, line })
        };
        Ok(found.into_iter().filter_map(of).collect())
    }

    /// The sentence with its line and cure.
    pub(super) fn sentence(&self) -> String {
        format!("{} (line {}): {}", self.at.message, self.line, self.at.help)
    }

    /// True if this is the required step beyond the rig that a caveat names.
    pub(super) fn is_step_of(&self, caveat: &Caveat) -> bool {
        match (&self.fact, &caveat.effect) {
            (Impossibility::Step(ImpossibleStep::BeyondReach(own)), UncountedEffect::BeyondReach(other)) => {
                own == other
            }
            _ => false,
        }
    }

    /// The key, what is impossible, and what would satisfy it.
    pub(super) fn answer(&self) -> ImpossibleAnswer {
        ImpossibleAnswer {
            key: self.at.path.clone(),
            line: self.line,
            sentence: self.at.message.clone(),
            remedy: self.at.help.clone(),
        }
    }
}
