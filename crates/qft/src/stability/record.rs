//! The worst results found for a family.

use super::{
    ClosestApproach, DelayMargin, Instability, Irresolution, MemberStability, SearchedInfinity,
    StabilityStatus,
};
use crate::verdict::PlantPoint;

/// The worst results so far.
#[derive(Clone, Debug, Default)]
pub(super) struct StabilityRecord {
    pub(super) unstable: Option<(f64, Instability, PlantPoint)>,
    pub(super) unresolved: Option<(Irresolution, PlantPoint)>,
    pub(super) real_part: Option<(f64, PlantPoint)>,
    pub(super) closest: Option<ClosestApproach>,
    pub(super) delay: Option<DelayMargin>,
    pub(super) infinity: Option<SearchedInfinity>,
}

impl StabilityRecord {
    /// Records the reason why the verdict is open, unless there is already one.
    pub(super) fn doubt(&mut self, reason: Irresolution, plant: PlantPoint) {
        if self.unresolved.is_none() {
            self.unresolved = Some((reason, plant));
        }
    }

    /// True if a plant is nearer to instability than all previous ones.
    pub(super) fn is_worse(&self, found: &MemberStability) -> bool {
        let real_part = found.largest_real_part.zip(self.real_part.as_ref());
        let distance = found.closest_approach.zip(self.closest.as_ref());
        real_part.is_some_and(|(own, (largest, _))| own > *largest)
            || distance.is_some_and(|(own, nearest)| own.distance < nearest.distance)
    }

    /// The values of the plants nearest to instability.
    pub(super) fn worst(&self) -> Vec<Vec<f64>> {
        let points = [
            self.unstable.as_ref().map(|(_, _, plant)| plant),
            self.real_part.as_ref().map(|(_, plant)| plant),
            self.closest.as_ref().map(|closest| &closest.plant),
            self.delay.as_ref().map(|delay| &delay.plant),
        ];
        let values = points.into_iter().flatten().filter_map(|point| match point {
            PlantPoint::Parameters(values) => Some(values.clone()),
            PlantPoint::Measured(_) | PlantPoint::Additional(_) => None,
        });
        values.collect()
    }

    pub(super) fn take(&mut self, plant: PlantPoint, found: &MemberStability) {
        let real_part = found.largest_real_part.filter(|real_part| real_part.is_finite());
        if let Some(real_part) = real_part
            && self.real_part.as_ref().is_none_or(|(largest, _)| real_part > *largest)
        {
            self.real_part = Some((real_part, plant.clone()));
        }
        match &found.status {
            StabilityStatus::Unstable(instability) => {
                let size = real_part.unwrap_or(0.0);
                if self.unstable.as_ref().is_none_or(|(largest, ..)| size > *largest) {
                    self.unstable = Some((size, *instability, plant.clone()));
                }
            }
            StabilityStatus::NotResolved(reason) if self.unresolved.is_none() => {
                self.unresolved = Some((reason.clone(), plant.clone()));
            }
            _ => {}
        }
        if let Some(closest) = found.closest_approach
            && self.closest.as_ref().is_none_or(|nearest| closest.distance < nearest.distance)
        {
            self.closest = Some(ClosestApproach {
                distance: closest.distance,
                frequency_rad_per_s: closest.frequency_rad_per_s,
                plant: plant.clone(),
            });
        }
        if let Some(critical) = found.critical_delay
            && self.delay.as_ref().is_none_or(|least| critical.delay_s < least.delay_s)
        {
            self.delay = Some(DelayMargin {
                delay_s: critical.delay_s,
                frequency_rad_per_s: critical.frequency_rad_per_s,
                plant,
            });
        }
    }
}
