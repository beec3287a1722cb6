//! Plants within a sampled loop, each sampled once however often it is looked at.

use std::cell::RefCell;
use std::collections::BTreeMap;

use phea_dynamics::linear::LinearError;
use phea_dynamics::uncertain_plant::UncertainPlant;

use crate::closed_loop::{Compensation, Member};

/// Plants that are kept, of less than a kilobyte each.
const PLANTS_MAXIMUM: usize = 100_000;

/// Plants of one family within one loop that were sampled before, by the bits of their parameter values: sampling costs more than a
/// thousand responses. A continuous loop takes its plants as they are and keeps none.
#[derive(Clone, Debug, Default)]
pub struct SampledPlants(RefCell<BTreeMap<Vec<u64>, Result<Member, LinearError>>>);

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

    /// How many are kept, for the tests of this package.
    #[doc(hidden)]
    pub fn count(&self) -> usize {
        self.0.borrow().len()
    }
}
