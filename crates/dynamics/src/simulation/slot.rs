//! Machine in its lane, and the data for its observer.

use super::interface::{Observer, Sampler};
use super::method::Extension;
use super::passage::{Passage, later};
use super::{Lane, Quartic, Stretch};

/// Machine in its lane.
pub(super) struct Slot<'a, O> {
    pub(super) passage: Passage<'a>,
    pub(super) sampler: Option<Box<dyn Sampler + 'a>>,
    pub(super) observer: O,
    /// Steps since its modes were last evaluated.
    pub(super) unwatched: u64,
    /// True if its last step used precomputed matrices.
    pub(super) propagated: bool,
    /// State or input at one time, for sampler and observer.
    pub(super) states: Vec<f64>,
    pub(super) inputs: Vec<f64>,
}

/// Number of steps, or time in s, after which the modes of a machine with precomputed matrices are
/// evaluated.
const UNWATCHED: (u64, f64) = (64, 0.06);

impl<O: Observer> Slot<'_, O> {
    /// True if its modes must be evaluated, although it uses precomputed matrices.
    pub(super) fn is_due(&self) -> bool {
        let (steps, time_s) = UNWATCHED;
        self.unwatched >= steps || self.unwatched as f64 * self.passage.step_s >= time_s
    }

    /// Passes the step to the observer, from the required states over it.
    #[inline]
    pub(super) fn follow(&mut self, wanted: &[Extension<f64>], quartics: &mut Vec<Quartic>) {
        quartics.clear();
        quartics.extend(wanted.iter().map(Quartic::of));
        self.observer.follow(&Stretch { passage: &self.passage, states: quartics });
    }

    /// True if the observer requires the step more accurately.
    pub(super) fn needs_accurate_solution(
        &self,
        wanted: &[Extension<f64>],
        quartics: &mut Vec<Quartic>,
    ) -> bool {
        quartics.clear();
        quartics.extend(wanted.iter().map(Quartic::of));
        self.observer.needs_accurate_solution(&Stretch { passage: &self.passage, states: quartics })
    }

    /// Passes every row before the end of the step to the observer, from the required states over
    /// the step.
    #[inline]
    pub(super) fn observe(&mut self, wanted: &[Extension<f64>]) {
        let Slot { passage, observer, states, inputs, .. } = self;
        let (start_s, step_s, before_s) = (passage.time_s, passage.step_s, passage.end_s());
        let states = states.get_mut(..wanted.len()).unwrap_or_default();
        let seen = if observer.wants_inputs() { inputs.len() } else { 0 };
        loop {
            let time_s = passage.next_row_s();
            // at a break the row has the values after it
            if later(time_s) >= before_s {
                return;
            }
            passage.row += 1;
            if !observer.wants_row(passage.row - 1) {
                continue;
            }
            let part = ((time_s - start_s) / step_s).max(0.0);
            for (place, extension) in states.iter_mut().zip(wanted) {
                *place = extension.at(part);
            }
            if seen > 0 {
                passage.inputs_at(time_s, inputs);
            }
            observer.observe(time_s, states, &inputs[..seen]);
        }
    }

    /// Passes the last row to the observer, at the end of the simulation.
    pub(super) fn observe_end<S: Lane>(&mut self, state: &[S], lane: usize) {
        let Slot { passage, observer, states, inputs, .. } = self;
        let duration_s = passage.schedule.duration_s;
        if passage.next_row_s() > later(duration_s) || !observer.wants_row(passage.row) {
            return;
        }
        let mut count = 0;
        for (place, &index) in states.iter_mut().zip(observer.wanted()) {
            *place = state.get(index).map_or(f64::NAN, |state| state.lane(lane));
            count += 1;
        }
        let seen = if observer.wants_inputs() { inputs.len() } else { 0 };
        if seen > 0 {
            passage.inputs_at(duration_s, inputs);
        }
        observer.observe(duration_s, &states[..count], &inputs[..seen]);
    }
}
