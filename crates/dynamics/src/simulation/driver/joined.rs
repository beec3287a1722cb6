//! Lanes that advance from sample to sample by precomputed matrices.

use super::Drive;
use crate::simulation::kernel::{Kernel, StepTrial};
use crate::simulation::passage::Passage;
use crate::simulation::slot::Slot;
use crate::simulation::{Attention, Lane, Observer, UnfollowedCause, UnfollowedKinks};

/// Largest error of a step with precomputed matrices, in units of the tolerance: such errors have
/// one sign for many samples and accumulate.
const PROPAGATED: f64 = 0.1;

impl<S: Lane, O: Observer> Drive<'_, S, O> {
    /// Propagates the error of the lanes whose bits are set over the step that the method took.
    pub(super) fn carry(&mut self, system: &dyn Kernel<S>, taken: u32) {
        if taken == 0 || self.marks.is_empty() {
            return;
        }
        self.carried.begin();
        if !self.method.carry(system, self.step, &mut self.carried.next) {
            return;
        }
        for lane in (0..S::COUNT).filter(|lane| taken & (1 << lane) != 0) {
            let Some(Slot { passage, sampler: None, .. }) = &self.slots[lane] else { continue };
            if passage.histories.is_empty() {
                self.carried.take(lane, passage.time_s, &self.method.scales);
            }
        }
    }

    /// Counts the step of a lane if it passed a kink.
    pub(super) fn count_kinks(&mut self, lane: usize) {
        let is_other = |(before, after): (&S, &S)| (before.lane(lane) > 0.0) != (after.lane(lane) > 0.0);
        let passed = self.marks.iter().zip(&self.between.marks).any(is_other);
        if let Some(Slot { passage, .. }) = self.slots[lane].as_mut().filter(|_| passed) {
            passage.passed_kinks += 1;
        }
    }

    /// Kinks of a run along which [`Drive::carry`] propagated nothing; a single kink is excluded,
    /// since no other amplifies its error.
    pub(super) fn unfollowed(&self, passage: &Passage<'_>, sampled: bool) -> Option<UnfollowedKinks> {
        let explicit = self.method.linearized().is_none();
        let causes = [
            (sampled, UnfollowedCause::Samples),
            (!passage.histories.is_empty(), UnfollowedCause::Delays),
            (explicit, UnfollowedCause::Method),
        ];
        let (_, cause) = causes.into_iter().find(|(holds, _)| *holds)?;
        (passage.passed_kinks > 1).then_some(UnfollowedKinks { steps: passage.passed_kinks, cause })
    }

    /// Selects the lanes that have matrices for the step to their next break.
    pub(super) fn choose_propagated(&mut self) {
        for lane in 0..S::COUNT {
            let Some(slot) = &mut self.slots[lane] else { continue };
            let whole = slot.sampler.as_ref().and_then(|_| slot.passage.whole_step());
            slot.propagated = whole.is_some_and(|step_s| self.propagator.knows(lane, step_s));
        }
    }

    /// Evaluates the modes of lanes with precomputed matrices now and then. Their growth is exact
    /// as long as friction feeds a growing mode as it did when the matrices were found; otherwise
    /// they are found anew. Returns true if everything has been linearised for this purpose.
    pub(super) fn watch_propagated(&mut self, system: &dyn Kernel<S>, fresh: bool) -> bool {
        let due = |slot: &Slot<'_, O>| slot.propagated && slot.is_due();
        if !self.slots.iter().flatten().any(due) {
            return false;
        }
        if fresh {
            self.linearize(system);
        }
        for lane in 0..S::COUNT {
            let Some(linearized) = self.method.linearized() else { continue };
            let Some(slot) = self.slots[lane].as_mut().filter(|slot| due(slot)) else { continue };
            let (watch, step_s) = (&mut self.watches[lane], slot.passage.step_s);
            let steps = std::mem::take(&mut slot.unwatched);
            watch.bound(slot.passage.time_s, step_s, steps, linearized, lane);
            if watch.has_left(self.propagator.friction[lane], step_s, linearized, lane) {
                self.propagator.learn(lane, step_s, linearized, &self.method.scales);
                self.propagator.friction[lane] = watch.friction(linearized, lane);
                slot.propagated = self.propagator.knows(lane, step_s);
            }
        }
        true
    }

    /// Takes a step with precomputed matrices in every lane that has them; returns true if all
    /// lanes have.
    pub(super) fn propagate(&mut self, system: &dyn Kernel<S>) -> bool {
        if !self.slots.iter().flatten().any(|slot| slot.propagated) {
            return false;
        }
        let (inputs, tolerance) = (&self.inputs.stages[0], self.settings.tolerance);
        let (state, scales) = (&self.state[..], &self.method.scales[..]);
        let trial = StepTrial { state, step: self.step, scales, tolerance };
        let error = system.propagate(&mut self.propagator, trial, inputs);
        self.between.extensions.fill(None);
        self.between.propagated = true;
        self.between.end.copy_from_slice(&self.propagator.end);
        for lane in 0..S::COUNT {
            let Some(slot) = &mut self.slots[lane] else { continue };
            slot.propagated &= error.lane(lane) <= PROPAGATED;
            if slot.propagated {
                slot.passage.go_whole();
                self.step.set_lane(lane, slot.passage.step_s);
            }
        }
        let mut all = true;
        for lane in 0..S::COUNT {
            if self.needs_accurate_solution(lane) {
                self.slots[lane].iter_mut().for_each(|slot| slot.propagated = false);
                self.begin_step(lane);
            }
            let Some(slot) = &mut self.slots[lane] else { continue };
            all &= slot.propagated;
            if slot.propagated {
                slot.passage.work.steps += 1;
                slot.passage.work.evaluations += 2;
            }
        }
        self.indicate_ends(system);
        for lane in 0..S::COUNT {
            if self.slots[lane].as_ref().is_some_and(|slot| slot.propagated) {
                self.take(system, lane);
            }
        }
        all
    }

    /// True if the observer of a lane requires the step with precomputed matrices more accurately.
    fn needs_accurate_solution(&mut self, lane: usize) -> bool {
        let asks = |slot: &Slot<'_, O>| slot.propagated && slot.passage.attention == Attention::Steps;
        if !self.slots[lane].as_ref().is_some_and(asks) {
            return false;
        }
        self.want(lane);
        let Some(slot) = &self.slots[lane] else { return false };
        slot.needs_accurate_solution(&self.between.wanted, &mut self.between.quartics)
    }

    /// Finds the matrices of lanes that a step of the method brought from sample to sample.
    pub(super) fn learn(&mut self, error: S) {
        let Some(linearized) = self.method.linearized() else { return };
        for lane in 0..S::COUNT {
            let Some(slot) = &self.slots[lane] else { continue };
            let step_s = slot.passage.step_s;
            let whole = slot.passage.whole_step() == Some(step_s);
            let taken = slot.sampler.is_some() && !slot.propagated && error.lane(lane) <= 1.0;
            if whole && taken && self.propagator.may_learn(lane) {
                self.propagator.learn(lane, step_s, linearized, &self.method.scales);
                self.propagator.friction[lane] = self.watches[lane].friction(linearized, lane);
            }
        }
    }
}
