//! The delay margin of a family in a sampled loop. The delay that a plant tolerates is found by
//! resampling it; the plants for which this is done are selected by estimates.

use phea_dynamics::order::sort_by_number;
use phea_dynamics::watch::{Stopped, Watch, part, report_progress};

use super::judged::JudgedFamily;
use super::{STAGE, STARTS, StabilityAudit};
use crate::closed_loop::Compensation;
use crate::coordinate_climb::climb;
use crate::family::{Extent, Family, UncertainFamily};
use crate::plant_cache::PlantCache;
use crate::stability::characteristic::FeedbackPath;
use crate::stability::{CriticalDelay, DelayMargin, StabilityStatus, of_member, resampled};
use crate::verdict::PlantPoint;

/// Fraction of the margin by which the loop is delayed for another ranking of plants: the estimate
/// of the remainder is then nearly exact, and the plants that tolerate least are still stable.
const NEARLY: f64 = 0.9;
/// Number of plants that are ranked again.
const RANKED: usize = 8 * STARTS;
/// Number of passes of ranking and searching.
const ROUNDS: usize = 4;
/// Relative gain below which a pass has found no other plant.
const GAIN: f64 = 1e-6;

impl StabilityAudit<'_> {
    /// Replaces the delay margin by the least that the worst plants tolerate when they are
    /// resampled with every delay.
    ///
    /// Without a delay the estimates may rank the plants wrongly, by a few percent: a delay between
    /// two samples also changes |L|. Therefore the plants are ranked again in the loop delayed by
    /// most of the margin so far, and searches start from the worst of them there, until they find
    /// no plant that tolerates less.
    pub(super) fn resample(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        let mut estimated = std::mem::take(&mut self.estimated);
        if let Some(PlantPoint::Parameters(values)) = self.record.delay.as_ref().map(|margin| &margin.plant) {
            estimated.push(values.clone());
        }
        let mut least = self.least(estimated);
        for round in 0..ROUNDS {
            let fraction = [round, round + 1].map(|done| done as f64 / ROUNDS as f64);
            let watch = &mut part(&mut *watch, STAGE, fraction);
            let Some(known) = &least else { break };
            let less = |found: &DelayMargin| found.delay_s < (1.0 - GAIN) * known.delay_s;
            let Some(found) = self.least(self.worst_near(known, watch)?).filter(less) else { break };
            least = Some(found);
        }
        self.record.delay = least.or(self.record.delay.take());
        self.resampled = true;
        Ok(())
    }

    /// The least delay margin of these plants, resampled with every delay.
    fn least(&self, plants: Vec<Vec<f64>>) -> Option<DelayMargin> {
        let JudgedFamily { family, compensation, path, .. } = &self.around;
        let (Family::Uncertain(family), Ok(path)) = (family, path) else { return None };
        let mut least: Option<DelayMargin> = None;
        for values in plants {
            let Some(plant) = family.plant().coefficients(&values) else { continue };
            let Some(found) = resampled::critical_delay(&plant, compensation, path) else { continue };
            if least.as_ref().is_none_or(|least| found.delay_s < least.delay_s) {
                let CriticalDelay { delay_s, frequency_rad_per_s } = found;
                let plant = PlantPoint::Parameters(values);
                least = Some(DelayMargin { delay_s, frequency_rad_per_s, plant });
            }
        }
        least
    }

    /// The plants that tolerate least in the loop delayed by most of this margin; over a box, those
    /// at which searches from them end.
    fn worst_near(&self, margin: &DelayMargin, watch: Watch<'_>) -> Result<Vec<Vec<f64>>, Stopped> {
        let JudgedFamily { family, compensation, path, .. } = &self.around;
        let (Family::Uncertain(family), Ok(path)) = (family, path) else { return Ok(vec![]) };
        let delayed = compensation.with_delay(compensation.delay_s() + NEARLY * margin.delay_s);
        let worst = |fractions: &[f64]| sensitivity(family, &delayed, path, &family.values(fractions));
        let starts = self.starts_near(family, margin, &worst);
        if family.extent() != Extent::Box {
            return Ok(starts.iter().map(|fractions| family.values(fractions)).collect());
        }
        let end = |_: &PlantCache, fractions: Vec<f64>, watch: Watch<'_>| {
            report_progress(watch, STAGE, 0, 1)?;
            Ok(family.values(&climb(&fractions, &mut |fractions| worst(fractions)).0))
        };
        self.cache.each(starts, (STAGE, watch), end)
    }

    /// The plant of a margin, and those that tolerate least by another measure, distinct from each
    /// other.
    fn starts_near(
        &self,
        family: &UncertainFamily,
        margin: &DelayMargin,
        worst: &dyn Fn(&[f64]) -> f64,
    ) -> Vec<Vec<f64>> {
        let values = |plant: &PlantPoint| match plant {
            PlantPoint::Parameters(values) => Some(family.fractions(values)),
            PlantPoint::Measured(_) | PlantPoint::Additional(_) => None,
        };
        let sensitivities = self.badness.iter().map(|[_, _, sensitivity]| *sensitivity);
        let mut order: Vec<(f64, &PlantPoint)> = sensitivities.zip(&self.plants).collect();
        order.retain(|(value, _)| value.is_finite());
        sort_by_number(&mut order, |one| -one.0);
        let nearest = order.iter().take(RANKED).filter_map(|(_, plant)| values(plant));
        let mut ranked: Vec<(f64, Vec<f64>)> =
            nearest.map(|fractions| (worst(&fractions), fractions)).collect();
        ranked.retain(|(value, _)| !value.is_nan());
        sort_by_number(&mut ranked, |one| -one.0);
        let mut chosen: Vec<Vec<f64>> = values(&margin.plant).into_iter().collect();
        for (_, fractions) in ranked {
            if chosen.len() < STARTS && chosen.iter().all(|earlier| self.apart(earlier, &fractions)) {
                chosen.push(fractions);
            }
        }
        chosen
    }
}

/// Minus the delay that a plant still tolerates in a loop, by the estimate; infinite if the loop is
/// unstable.
fn sensitivity(
    family: &UncertainFamily,
    compensation: &Compensation,
    path: &FeedbackPath,
    values: &[f64],
) -> f64 {
    let plant = family.plant().coefficients(values);
    let Some(member) = plant.and_then(|plant| compensation.member(plant).ok()) else { return f64::NAN };
    let found = of_member(&member, compensation, path);
    match found.status {
        StabilityStatus::Unstable(_) => f64::INFINITY,
        StabilityStatus::Stable => found.critical_delay.map_or(f64::NAN, |critical| -critical.delay_s),
        StabilityStatus::NotResolved(_) => f64::NAN,
    }
}
