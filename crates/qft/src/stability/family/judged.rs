//! The loop around one plant of a family, and the search between plants; both independent of
//! results for other plants.

use phea_dynamics::linear::LinearError;

use crate::closed_loop::{Compensation, Member};
use crate::coordinate_climb::climb_by;
use crate::family::Family;
use crate::plant_cache::PlantCache;
use crate::stability::badness::Badness;
use crate::stability::characteristic::FeedbackPath;
use crate::stability::responding::PoleCounting;
use crate::stability::{Irresolution, MemberStability, characteristic, of_member, responding};
use crate::verdict::PlantPoint;

/// A family within its loop.
pub(super) struct JudgedFamily<'a> {
    pub(super) family: &'a Family,
    pub(super) compensation: &'a Compensation,
    pub(super) path: Result<FeedbackPath, Irresolution>,
    /// The first plant, whose poles are counted with 1 + L enclosed.
    first: Option<PlantPoint>,
}

/// A climb over the box for one measure after the other, each from the end of the previous one.
pub(super) struct StabilitySearch<'s> {
    pub(super) searched: &'s [Badness],
    pub(super) first_step: f64,
    /// Fractions of the box at which it begins.
    pub(super) fractions: Vec<f64>,
}

impl<'a> JudgedFamily<'a> {
    pub(super) fn new(
        family: &'a Family,
        compensation: &'a Compensation,
        first: Option<&PlantPoint>,
    ) -> JudgedFamily<'a> {
        let path = FeedbackPath::new(compensation);
        JudgedFamily { family, compensation, path, first: first.cloned() }
    }

    pub(super) fn judged(&self, cache: &PlantCache, plant: &PlantPoint) -> MemberStability {
        match (&self.path, self.member(cache, plant)) {
            (Ok(_), Ok(member @ Member::Responding { .. })) if self.first.as_ref() != Some(plant) => {
                responding::stability(&member, self.compensation, PoleCounting::OnPoints)
            }
            (Ok(path), Ok(member)) => of_member(&member, self.compensation, path),
            (Err(reason), _) => MemberStability::not_resolved(reason.clone()),
            (_, Err(error)) => MemberStability::not_resolved(Irresolution::Linear(error)),
        }
    }

    pub(super) fn member(&self, cache: &PlantCache, plant: &PlantPoint) -> Result<Member, LinearError> {
        match (self.family, plant) {
            (Family::Uncertain(family), PlantPoint::Parameters(values)) => {
                cache.member(self.compensation, family.plant(), values)
            }
            (Family::Measured(family), PlantPoint::Measured(index)) => {
                let plant = family.plants().get(*index).ok_or(LinearError::ZeroPolynomial)?;
                Ok(self.compensation.measured(plant))
            }
            _ => Err(LinearError::ZeroPolynomial),
        }
    }

    fn badness_at(&self, cache: &PlantCache, badness: Badness, values: Vec<f64>) -> f64 {
        let Ok(path) = &self.path else { return f64::NAN };
        let Family::Uncertain(family) = self.family else { return f64::NAN };
        let Ok(member) = cache.member(self.compensation, family.plant(), &values) else {
            return f64::NAN;
        };
        match characteristic(&member, path) {
            Some(Ok(characteristic)) => badness.of(&characteristic).unwrap_or(f64::NAN),
            Some(Err(_)) => f64::NAN,
            None => responding::first_sample(&member, self.compensation)
                .and_then(|open_loop| badness.of_response(&open_loop))
                .unwrap_or(f64::NAN),
        }
    }
}

impl StabilitySearch<'_> {
    /// The plant where it ends, true if the last measure was its delay, and its stability; `None`
    /// without a box.
    pub(super) fn searched(
        self,
        around: &JudgedFamily<'_>,
        cache: &PlantCache,
    ) -> Option<(Vec<f64>, bool, MemberStability)> {
        let Family::Uncertain(family) = around.family else { return None };
        let mut fractions = self.fractions;
        for &badness in self.searched {
            let mut objective =
                |fractions: &[f64]| around.badness_at(cache, badness, family.values(fractions));
            (fractions, _) = climb_by(self.first_step, &fractions, &mut objective);
        }
        let values = family.values(&fractions);
        let is_of_delay = self.searched.last() == Some(&Badness::DelaySensitivity);
        let found = around.judged(cache, &PlantPoint::Parameters(values.clone()));
        Some((values, is_of_delay, found))
    }
}
