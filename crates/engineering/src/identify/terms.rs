//! Terms of a valve in addition to edges that open in proportion, as far as the recordings show.

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
    /// Leakage with a shape of its own at each edge.
    LeakageByEdge,
}

impl ValveTerm {
    /// All of them.
    pub const ALL: [ValveTerm; 3] = [ValveTerm::Lap, ValveTerm::Saturation, ValveTerm::LeakageByEdge];

    /// Its name in JSON.
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

    /// The valve with this term too; `None` where it has no meaning.
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
    /// Which.
    pub term: ValveTerm,
    /// By how much it lowers the information criterion; negative where it does not earn its
    /// numbers.
    pub gain: f64,
    /// True where the valve is identified with it.
    pub taken: bool,
}

/// The fit with every term that the recordings support, added one at a time, the one that explains
/// most first; and what each term explains.
///
/// A term is taken where it lowers the information criterion by [`DECISIVE`] and more. The
/// gain of a term that is not taken is that in addition to those that are.
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
            // far from where a wrong model ended, a few steps do not show what a term is worth
            let mut with = fit::a_few_steps_with(&found, tested, watch)?;
            let mut gain = gained(&found, &with);
            if gain > 0.0 || found.has_misfit() {
                let mut whole = fit::with_another_model(&found, tested, watch)?;
                let nearly = gained(&found, &whole);
                if nearly > 0.0 && nearly < DECISIVE {
                    whole = whole.searched_to_the_end(watch)?;
                }
                let of_whole = gained(&found, &whole);
                // it may end elsewhere, and worse
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

/// By how much the criterion of the second fit is lower.
fn gained(without: &Fit<'_>, with: &Fit<'_>) -> f64 {
    let [before, after] = criteria([without, with]);
    before - after
}
