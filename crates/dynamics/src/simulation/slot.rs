//! A machine in its lane, and the data for its observer.

use super::course::{Observer, Sampler};
use super::method::Extension;
use super::passage::{Passage, later};
use super::{Lane, Quartic, Stretch};

/// A machine in its lane.
pub(super) struct Slot<'a, O> {
    pub(super) passage: Passage<'a>,
    pub(super) sampler: Option<Box<dyn Sampler + 'a>>,
    pub(super) observer: O,
    /// Steps since its modes were asked for.
    pub(super) unwatched: u64,
    /// True if its last step was taken with known matrices.
    pub(super) propagated: bool,
    /// A state or input at one time, for sampler and observer.
    pub(super) states: Vec<f64>,
    pub(super) inputs: Vec<f64>,
}

/// What goes by known matrices is asked for its modes after this many steps, or this time in s.
const UNWATCHED: (u64, f64) = (64, 0.06);

impl<O: Observer> Slot<'_, O> {
    /// True if its modes are to be asked for, though it goes by known matrices.
    pub(super) fn is_due(&self) -> bool {
        let (steps, time_s) = UNWATCHED;
        self.unwatched >= steps || self.unwatched as f64 * self.passage.step_s >= time_s
    }

    /// Shows the observer the step, from the states it wants over it.
    #[inline]
    pub(super) fn follow(&mut self, wanted: &[Extension<f64>], quartics: &mut Vec<Quartic>) {
        quartics.clear();
        quartics.extend(wanted.iter().map(Quartic::of));
        self.observer.follow(&Stretch { passage: &self.passage, states: quartics });
    }

    /// True if the observer wants to know the step more exactly.
    pub(super) fn looks_closer(&self, wanted: &[Extension<f64>], quartics: &mut Vec<Quartic>) -> bool {
        quartics.clear();
        quartics.extend(wanted.iter().map(Quartic::of));
        self.observer.looks_closer(&Stretch { passage: &self.passage, states: quartics })
    }

    /// Shows the observer every row before the end of the step, from the states it wants over the
    /// step.
    #[inline]
    pub(super) fn observe(&mut self, wanted: &[Extension<f64>]) {
        let Slot { passage, observer, states, inputs, .. } = self;
        let (start_s, step_s, before_s) = (passage.time_s, passage.step_s, passage.end_s());
        let states = states.get_mut(..wanted.len()).unwrap_or_default();
        let seen = if observer.wants_inputs() { inputs.len() } else { 0 };
        loop {
            let time_s = passage.next_row_s();
            // at a break the row shows the values after it
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

    /// Shows the observer the last row, at the end of the course.
    pub(super) fn observe_end<S: Lane>(&mut self, state: &[S], lane: usize) {
        let Slot { passage, observer, states, inputs, .. } = self;
        let duration_s = passage.course.duration_s;
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
