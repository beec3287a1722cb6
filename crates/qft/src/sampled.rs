//! Plants within a sampled loop, each sampled once however often it is used.

use std::cell::RefCell;
use std::collections::BTreeMap;

use phea_dynamics::linear::LinearError;
use phea_dynamics::uncertain_plant::UncertainPlant;

use super::closed_loop::{Compensation, Member};

/// Plants that are kept, of less than a kilobyte each.
const PLANTS_MAXIMUM: usize = 100_000;

/// Plants of one family within one loop that were already sampled, by the bits of their parameter
/// values: sampling costs more than a thousand responses. A continuous loop takes its plants as
/// they are and keeps none.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampledPlants(RefCell<BTreeMap<Vec<u64>, Result<Member, LinearError>>>);

impl SampledPlants {
    /// The plant with these parameter values within the loop.
    pub(crate) fn member(
        &self,
        compensation: &Compensation,
        plant: &UncertainPlant,
        values: &[f64],
    ) -> Result<Member, LinearError> {
        let build = || compensation.member_of(plant, values);
        if compensation.sample_time_s().is_none() {
            return build();
        }
        let key: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        let mut kept = self.0.borrow_mut();
        if kept.len() >= PLANTS_MAXIMUM && !kept.contains_key(&key) {
            return build();
        }
        kept.entry(key).or_insert_with(build).clone()
    }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::controller::{Controller, Timing};
    use phea_dynamics::linear::TransferFunction;
    use phea_dynamics::uncertain_plant::{
        PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
    };

    use super::{Compensation, Member, SampledPlants};

    fn found(plants: &SampledPlants, timing: Timing, gain: f64) -> Member {
        let parameter = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 0.5, maximum: 2.0 };
        let lag = UncertainPlant::record(vec![parameter], |p| PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![p[0]],
                denominator: vec![1.0.into(), 1.0.into()],
            },
            disturbance: None,
            dead_time_s: 0.0.into(),
            rate: None,
        });
        let controller = Controller { timing, ..Controller::default() };
        let around = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
        plants.member(&around, &lag.unwrap(), &[gain]).unwrap()
    }

    /// Each plant is sampled once: the stored plant is returned even for a loop with more delay.
    #[test]
    fn a_plant_is_sampled_once() {
        let sampled = Timing { sample_time_s: Some(0.1), ..Timing::default() };
        let late = Timing { delay_s: 0.5, ..sampled };
        let plants = SampledPlants::default();
        let first = format!("{:?}", found(&plants, sampled, 1.0));
        assert_eq!(first, format!("{:?}", found(&plants, late, 1.0)));
        assert_ne!(first, format!("{:?}", found(&SampledPlants::default(), late, 1.0)));
        assert_ne!(first, format!("{:?}", found(&plants, sampled, 1.5)));
        assert_eq!(plants.0.borrow().len(), 2);
    }

    #[test]
    fn plants_of_a_continuous_loop_are_not_kept() {
        let plants = SampledPlants::default();
        found(&plants, Timing::default(), 1.0);
        assert!(plants.0.borrow().is_empty());
    }
}
