//! Plants within a loop, with their stored results.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use phea_dynamics::expression::EvaluationMemo;
use phea_dynamics::linear::LinearError;
use phea_dynamics::pieces::{WorkPiece, Workers};
use phea_dynamics::uncertain_plant::UncertainPlant;
use phea_dynamics::watch::{Stopped, Watch};

use super::closed_loop::{Compensation, Member, TrialPlant};

/// Number of plants that are stored, of less than a kilobyte each.
const PLANTS_MAXIMUM: usize = 100_000;

/// Plants within their loop, or the reason why they have none, by the bits of their parameter
/// values.
type SampledPlants = BTreeMap<Vec<u64>, Result<Member, LinearError>>;

/// Plants of one family within one loop. Plants already sampled are stored by the bits of their
/// parameter values: sampling costs more than a thousand responses. A clone shares its plants,
/// including later additions.
#[derive(Clone, Debug)]
pub(crate) struct PlantCache {
    sampled: Rc<RefCell<PlantStore>>,
    /// Plants that a search evaluated, likewise.
    evaluated: Rc<RefCell<BTreeMap<Vec<u64>, Option<TrialPlant>>>>,
    /// The last plant that was built: the next one has nearly equal poles.
    last: RefCell<Option<TrialPlant>>,
    memo: RefCell<EvaluationMemo>,
    workers: Workers,
}

/// Plants that were sampled: those shared between tasks, and those added since.
#[derive(Debug, Default)]
struct PlantStore {
    shared: Arc<SampledPlants>,
    new: SampledPlants,
}

impl PlantStore {
    fn len(&self) -> usize {
        self.shared.len() + self.new.len()
    }

    /// All plants, readable by several threads.
    fn fraction(&mut self) -> Arc<SampledPlants> {
        if !self.new.is_empty() {
            Arc::make_mut(&mut self.shared).append(&mut self.new);
        }
        Arc::clone(&self.shared)
    }
}

impl Default for PlantCache {
    fn default() -> Self {
        PlantCache::of(Workers::CALLER)
    }
}

impl PlantCache {
    /// An empty store, with the workers that evaluate more plants.
    pub(crate) fn of(workers: Workers) -> PlantCache {
        PlantCache {
            sampled: Rc::default(),
            evaluated: Rc::default(),
            last: RefCell::default(),
            memo: RefCell::default(),
            workers,
        }
    }

    /// The worker threads.
    pub(crate) fn workers(&self) -> Workers {
        self.workers
    }

    /// Results of tasks, in their order. Each task has the known plants and separate trial plants,
    /// so that its result does not depend on the others.
    pub(crate) fn each<T: Send, R: Send>(
        &self,
        tasks: Vec<T>,
        (stage, watch): (&'static str, Watch<'_>),
        task: impl Fn(&PlantCache, T, Watch<'_>) -> Result<R, Stopped> + Sync,
    ) -> Result<Vec<R>, Stopped> {
        let shared = self.sampled.borrow_mut().fraction();
        let mut places: Vec<(SampledPlants, Option<R>)> = Vec::new();
        places.resize_with(tasks.len(), || (SampledPlants::new(), None));
        let pieces = places.iter_mut().zip(tasks).map(|((new, place), one)| {
            let (task, shared) = (&task, Arc::clone(&shared));
            let piece: WorkPiece<'_> = Box::new(move |watch: Watch<'_>| {
                let own = PlantCache::of(Workers::CALLER);
                own.sampled.borrow_mut().shared = shared;
                *place = Some(task(&own, one, watch)?);
                new.append(&mut own.sampled.borrow_mut().new);
                Ok(())
            });
            piece
        });
        self.workers.work(pieces.collect(), stage, watch)?;
        drop(shared);
        let mut results = Vec::with_capacity(places.len());
        for (mut new, result) in places {
            self.sampled.borrow_mut().new.append(&mut new);
            results.extend(result);
        }
        Ok(results)
    }

    /// Number of sampled plants.
    pub(crate) fn sampled(&self) -> usize {
        self.sampled.borrow().len()
    }

    /// Number of plants evaluated by searches, and number of those whose factors were all needed.
    pub(crate) fn evaluated(&self) -> [usize; 2] {
        let is_whole = |one: &&TrialPlant| match one {
            TrialPlant::Whole(_) => true,
            TrialPlant::Held(held) => held.is_whole(),
        };
        let evaluated = self.evaluated.borrow();
        [evaluated.len(), evaluated.values().flatten().filter(is_whole).count()]
    }

    /// The plant with these parameter values within the loop.
    pub(crate) fn member(
        &self,
        compensation: &Compensation,
        plant: &UncertainPlant,
        values: &[f64],
    ) -> Result<Member, LinearError> {
        let build = || {
            let found = plant.member_by(&mut self.memo.borrow_mut(), values);
            compensation.around(found.ok_or(LinearError::NoPlant)?)
        };
        if compensation.sample_time_s().is_none() {
            return build();
        }
        let key: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        let mut sampled = self.sampled.borrow_mut();
        if let Some(known) = sampled.shared.get(&key) {
            return known.clone();
        }
        if sampled.len() >= PLANTS_MAXIMUM && !sampled.new.contains_key(&key) {
            return build();
        }
        sampled.new.entry(key).or_insert_with(build).clone()
    }

    /// A trial plant for a search, which evaluates it at a few frequencies; `None` if it cannot be
    /// sampled.
    pub(crate) fn trial(
        &self,
        compensation: &Compensation,
        plant: &UncertainPlant,
        values: &[f64],
    ) -> Option<TrialPlant> {
        let build = || {
            let member = plant.member_by(&mut self.memo.borrow_mut(), values)?;
            let found = compensation.trial(member, self.last.borrow().as_ref());
            *self.last.borrow_mut() = found.clone();
            found
        };
        if compensation.sample_time_s().is_none() {
            return build();
        }
        let key: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        let mut evaluated = self.evaluated.borrow_mut();
        if evaluated.len() >= PLANTS_MAXIMUM && !evaluated.contains_key(&key) {
            return build();
        }
        evaluated.entry(key).or_insert_with(build).clone()
    }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::controller::{Controller, Timing};
    use phea_dynamics::linear::TransferFunction;
    use phea_dynamics::uncertain_plant::{
        PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
    };

    use super::{Compensation, Member, PlantCache};

    fn found(plants: &PlantCache, timing: Timing, gain: f64) -> Member {
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
        let plants = PlantCache::default();
        let first = format!("{:?}", found(&plants, sampled, 1.0));
        assert_eq!(first, format!("{:?}", found(&plants, late, 1.0)));
        assert_ne!(first, format!("{:?}", found(&PlantCache::default(), late, 1.0)));
        assert_ne!(first, format!("{:?}", found(&plants, sampled, 1.5)));
        assert_eq!(plants.sampled.borrow().len(), 2);
    }

    #[test]
    fn plants_of_a_continuous_loop_are_not_kept() {
        let plants = PlantCache::default();
        found(&plants, Timing::default(), 1.0);
        assert_eq!(plants.sampled.borrow().len(), 0);
    }
}
