//! Error inside a step: for cases in which the error at the end does not show it, and at kinks of a
//! rate.

use super::{Drive, set_lane};
use crate::simulation::kernel::Kernel;
use crate::simulation::method::RESIDUAL_AT;
use crate::simulation::slot::Slot;
use crate::simulation::{Lane, Observer};

/// Halvings by which a kink within a step is located: to one ten-thousandth.
const HALVINGS: usize = 14;

impl<S: Lane, O: Observer> Drive<'_, S, O> {
    /// Error of the step combined with that inside it, in lanes whose end error may not be
    /// sufficient: a step over a kink is checked at the kink, where the part that a polynomial
    /// cannot follow is largest, and late in the step, where a kink near its beginning or its end
    /// shows. One of the three checks detects it: together they are at least half of the error that
    /// a kink causes anywhere in the step.
    pub(super) fn sample_between(&mut self, system: &dyn Kernel<S>, error: S) -> S {
        let mut late = [false; MOST_LANES];
        for (lane, late) in late.iter_mut().enumerate().take(S::COUNT) {
            let passes = self.passes(lane, error);
            let kink = if passes { self.kink(system, lane) } else { None };
            let Some(Slot { passage, .. }) = &mut self.slots[lane] else { continue };
            passage.kink = kink;
            *late = passes && (kink.is_some() || self.method.doubts(lane, passage));
        }
        let with_late = self.evaluate_at(system, error, |lane, _| late[lane].then_some(RESIDUAL_AT));
        self.evaluate_at(system, with_late, |_, kink| kink)
    }

    /// True if the error at the end lets the step of a lane pass, for the method that has more
    /// information about it.
    fn passes(&self, lane: usize, error: S) -> bool {
        let by_method = self.slots[lane].as_ref().is_some_and(|slot| !slot.propagated);
        by_method && self.method.linearized().is_some() && error.lane(lane) <= 1.0
    }

    /// Error combined with that at a fraction of the step, in lanes that have one; `part` receives
    /// the lane and its kink.
    fn evaluate_at(
        &mut self,
        system: &dyn Kernel<S>,
        error: S,
        part: impl Fn(usize, Option<f64>) -> Option<f64>,
    ) -> S {
        let (mut sampled, mut parts, mut any) = (S::from(0.0), S::from(RESIDUAL_AT), false);
        for lane in 0..S::COUNT {
            let Some(Slot { passage, inputs, .. }) = &mut self.slots[lane] else { continue };
            let Some(part) = part(lane, passage.kink) else { continue };
            passage.inputs_within(part, inputs);
            passage.work.evaluations += 1;
            set_lane(&mut self.between.inputs, lane, inputs);
            parts.set_lane(lane, part);
            sampled.set_lane(lane, 1.0);
            any = true;
        }
        if !any {
            return error;
        }
        let (inputs, tolerance) = (&self.between.inputs, self.settings.tolerance);
        let between = self.method.error_between(system, &self.state, self.step, (parts, inputs), tolerance);
        S::select(S::from(0.0).less_than(sampled), (error.squared() + between.squared()).sqrt(), error)
    }

    /// Fraction of the step of a lane just after its first kink; `None` if the marks have equal
    /// signs at both ends.
    fn kink(&mut self, system: &dyn Kernel<S>, lane: usize) -> Option<f64> {
        let is_other = |(before, after): (&S, &S)| (before.lane(lane) > 0.0) != (after.lane(lane) > 0.0);
        if !self.marks.iter().zip(&self.between.marks).any(is_other) {
            return None;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            self.sample(lane, middle);
            system.mark(&self.between.state, &self.between.inputs, &mut self.between.marked);
            let passed = self.marks.iter().zip(&self.between.marked).any(is_other);
            (low, high) = if passed { (low, middle) } else { (middle, high) };
        }
        Some(high)
    }
}

/// Largest number of lanes.
const MOST_LANES: usize = crate::scalar::LANES;
