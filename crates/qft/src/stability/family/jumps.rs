//! Plants next to a jump within a box, such as that of a valve's gain where its spool passes null.
//! They are members; a search from the worse side would not cross the jump.

use super::StabilityAudit;
use crate::family::UncertainFamily;
use crate::stability::badness::Badness;
use crate::verdict::PlantPoint;

/// Difference of fractions below which two plants are adjacent.
const NEXT: f64 = 1e-5;
/// Relative difference of a quantity between adjacent plants that counts as a jump.
const JUMP: f64 = 1e-4;
/// First step of a search that starts next to a jump, as a fraction of the box: a longer one would
/// cross it.
pub(super) const STEP: f64 = 0.01;

impl StabilityAudit<'_> {
    /// The worst plant with a worse one adjacent to it across a jump, and the worst of all plants
    /// next to a jump, as fractions of the box; empty if there is no jump.
    pub(super) fn sides(&self, family: &UncertainFamily, badness: Badness) -> Vec<Vec<f64>> {
        let fractions = |plant: &PlantPoint| match plant {
            PlantPoint::Parameters(values) => Some(family.fractions(values)),
            PlantPoint::Measured(_) | PlantPoint::Additional(_) => None,
        };
        // the members come first
        let plants = self.badness.iter().zip(&self.plants).take(family.members().len());
        let mut known: Vec<(f64, Vec<f64>)> =
            plants.filter_map(|(found, plant)| Some((badness.among(found), fractions(plant)?))).collect();
        known.retain(|(value, _)| value.is_finite());
        let (mut worse, mut worst): (Option<usize>, Option<usize>) = (None, None);
        let value = |place: Option<usize>| place.map_or(f64::NEG_INFINITY, |place| known[place].0);
        for (one, (here, from)) in known.iter().enumerate() {
            for (other, (there, to)) in known.iter().enumerate() {
                let jumps = here - there > JUMP * here.abs();
                if jumps && from.iter().zip(to).all(|(a, b)| (a - b).abs() <= NEXT) {
                    worse = if *there > value(worse) { Some(other) } else { worse };
                    worst = if *here > value(worst) { Some(one) } else { worst };
                }
            }
        }
        [worse, worst].into_iter().flatten().map(|place| known[place].1.clone()).collect()
    }
}
