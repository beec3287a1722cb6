//! A structure that is shaped from a known controller, without an audit.

use phea_dynamics::watch::Watch;

use super::{Attempt, AttemptEnding, Leave, LoopDesignError, best_of};
use crate::loop_shaping::SearchProblem;
use crate::plant_cache::PlantCache;

impl Attempt {
    /// Descends from the best of the starting points, and again with the violations of the sampled
    /// plants between their frequencies. Returns true if a controller was found that stabilises
    /// these plants.
    pub(in crate::design) fn reshape(
        &mut self,
        cache: &PlantCache,
        watch: Watch<'_>,
    ) -> Result<bool, LoopDesignError> {
        match self.until_samples_agree(cache, watch) {
            Ok(()) | Err(Leave::Ended(AttemptEnding::Missed { .. })) => Ok(true),
            Err(Leave::Ended(_)) => Ok(false),
            Err(Leave::Failed(error)) => Err(error),
        }
    }

    fn until_samples_agree(&mut self, cache: &PlantCache, watch: Watch<'_>) -> Result<(), Leave> {
        let given = best_of(&mut self.shaping, std::mem::take(&mut self.given));
        match given.first().cloned() {
            Some(first) if self.shaping.judge(&first).stable => {
                self.x = first;
                self.fits_prefilter(watch)?;
                self.descend(false, watch)?;
            }
            _ => self.search(given, (self.options.seed, self.effort), watch)?,
        }
        loop {
            self.draw_in(watch)?;
            if !self.learns_between_samples(cache, watch)? {
                return Ok(());
            }
            self.shape_again(watch)?;
        }
    }
}
