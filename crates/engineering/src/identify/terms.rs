//! Terms of a valve, if the recordings show them, in addition to edges that open in proportion.

use phea_dynamics::watch::Watch;
use phea_hydraulics::servovalve::{LeakageModel, TestedValve, ValveTerms};

use super::evidence::{DECISIVE, criteria};
use super::fit::{self, Fit};
use crate::identify_error::IdentifyError;

/// A term that a valve may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValveTerm {
    /// Lap of both pairs of edges.
    Lap,
    /// Openings that saturate.
    Saturation,
    /// Leakage with a separate shape for each edge.
    LeakageByEdge,
}

impl ValveTerm {
    /// All terms.
    pub const ALL: [ValveTerm; 3] = [ValveTerm::Lap, ValveTerm::Saturation, ValveTerm::LeakageByEdge];

    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            ValveTerm::Lap => "lap",
            ValveTerm::Saturation => "saturation",
            ValveTerm::LeakageByEdge => "leakage_by_edge",
        }
    }

    fn is_in(self, terms: ValveTerms) -> bool {
        match self {
            ValveTerm::Lap => terms.lap,
            ValveTerm::Saturation => terms.saturation,
            ValveTerm::LeakageByEdge => terms.leakage_by_edge,
        }
    }

    /// The valve with this term in addition; `None` if the term has no meaning.
    fn added_to(self, tested: TestedValve) -> Option<TestedValve> {
        let mut terms = tested.terms;
        match self {
            ValveTerm::Lap => terms.lap = true,
            ValveTerm::Saturation => terms.saturation = true,
            ValveTerm::LeakageByEdge => terms.leakage_by_edge = true,
        }
        // one curve for the whole valve has one shape
        let has_meaning = self != ValveTerm::LeakageByEdge || tested.leakage_model == LeakageModel::EachEdge;
        has_meaning.then_some(TestedValve { terms, ..tested })
    }
}

/// Improvement of the fit with a term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TermEvidence {
    /// Kind of the term.
    pub term: ValveTerm,
    /// Decrease of the information criterion; negative if the term does not earn its numbers.
    pub gain: f64,
    /// True if the valve is identified with the term.
    pub taken: bool,
}

/// Fit with every term that the recordings support, added one at a time, the one that explains most
/// first; and the contribution of each term.
///
/// A term is added if it reduces the information criterion by at least [`DECISIVE`]. The gain of a
/// term that is not added is that in addition to those that are.
pub(super) fn with_terms<'a>(
    mut found: Fit<'a>,
    watch: Watch<'_>,
) -> Result<(Fit<'a>, Vec<TermEvidence>), IdentifyError> {
    let mut taken: Vec<TermEvidence> = Vec::new();
    loop {
        let tested = found.together.tested;
        let mut left: Vec<TermEvidence> = Vec::new();
        let mut best: Option<(f64, Fit<'a>)> = None;
        for term in ValveTerm::ALL.into_iter().filter(|term| !term.is_in(tested.terms)) {
            let Some(tested) = term.added_to(tested) else { continue };
            // far from the end point of a wrong model, a few steps do not show the contribution of
            // a term
            let mut with = fit::a_few_steps_with(&found, tested, watch)?;
            let mut gain = gained(&found, &with);
            if gain > 0.0 || found.has_misfit() {
                let mut whole = fit::with_another_model(&found, tested, watch)?;
                let nearly = gained(&found, &whole);
                if nearly > 0.0 && nearly < DECISIVE {
                    whole = whole.searched_to_the_end(watch)?;
                }
                let of_whole = gained(&found, &whole);
                // the search may end elsewhere, and at a worse point
                if of_whole > gain {
                    (with, gain) = (whole, of_whole);
                }
            }
            left.push(TermEvidence { term, gain, taken: false });
            if gain >= DECISIVE && best.as_ref().is_none_or(|(most, _)| gain > *most) {
                best = Some((gain, with));
            }
        }
        let Some((gain, better)) = best else {
            taken.extend(left);
            return Ok((found, taken));
        };
        let added = left.into_iter().find(|one| one.term.is_in(better.together.tested.terms));
        taken.extend(added.map(|one| TermEvidence { gain, taken: true, ..one }));
        found = better.searched_to_the_end(watch)?;
    }
}

/// Decrease of the criterion from the first to the second fit.
fn gained(without: &Fit<'_>, with: &Fit<'_>) -> f64 {
    let [before, after] = criteria([without, with]);
    before - after
}
