//! A prefilter of one pole in place of a longer one whose further poles have almost no effect.

use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;
use phea_dynamics::watch::Watch;

use super::{Attempt, AttemptEnding, Leave, LoopDesignError, PrefilterChoice};
use crate::plant_cache::PlantCache;

/// Least order of a prefilter: with one pole a step of the reference reaches the controller without
/// a jump.
const LEAST_ORDER: usize = 1;
/// Factor by which poles are faster than the slowest one if they have almost no effect.
const FAST: f64 = 10.0;

impl Attempt {
    /// Replaces the prefilter by one with a single pole if its further poles have almost no effect,
    /// every specification is met without them, and the result ([`Attempt::reached_db`]) worsens by
    /// no more than those poles must earn. Returns the original attempt if the watch stops this.
    ///
    /// # Errors
    /// Errors of [`Attempt::run`].
    pub(in crate::design) fn with_shorter_prefilter(
        self,
        ending: AttemptEnding,
        cache: &PlantCache,
        watch: Watch<'_>,
    ) -> Result<(Attempt, AttemptEnding), LoopDesignError> {
        let earned_db = self.options.controller.earned_per_pole_db();
        let (Some(earned_db), AttemptEnding::Met(_)) = (earned_db, &ending) else {
            return Ok((self, ending));
        };
        if !self.prefilter_is_fitted() || !self.has_needless_poles() {
            return Ok((self, ending));
        }
        let mut shorter = self.clone();
        shorter.options.prefilter = PrefilterChoice::Grow { maximum_order: LEAST_ORDER };
        let found = match shorter.refitted(cache, watch) {
            Ok(found) | Err(Leave::Ended(found)) => found,
            Err(Leave::Failed(LoopDesignError::Stopped(_))) => return Ok((self, ending)),
            Err(Leave::Failed(error)) => return Err(error),
        };
        shorter.options.prefilter = self.options.prefilter.clone();
        let most_db = self.reached_db().map(|own| own + earned_db);
        let is_worth_it = most_db.zip(shorter.reached_db()).is_some_and(|(most_db, own)| own <= most_db);
        match found {
            AttemptEnding::Met(_) if is_worth_it => Ok((shorter, found)),
            _ => Ok((self, ending)),
        }
    }

    /// True if the prefilter has more than one pole, and all but one are fast.
    fn has_needless_poles(&self) -> bool {
        let Ok(prefilter) = self.shaping.controller(&self.x).prefilter.transfer_function() else {
            return false;
        };
        let mut sizes: Vec<f64> = prefilter.poles().iter().map(|pole| portable::magnitude(*pole)).collect();
        sort_by_number(&mut sizes, |size| *size);
        matches!(sizes[..], [slowest, next, ..] if next >= FAST * slowest)
    }

    /// A prefilter fitted to the present controller, followed by descents with both until search
    /// and audit agree.
    fn refitted(&mut self, cache: &PlantCache, watch: Watch<'_>) -> Result<AttemptEnding, Leave> {
        self.x.truncate(self.structure.dimension());
        self.shape_with(None)?;
        if self.fits_prefilter(watch)? {
            self.descend(false, watch)?;
        }
        self.audited_until_agreed(cache, watch)
    }
}
