use super::history::WaveHistory;
use super::passage::Passage;
use super::quartic::Quartic;

/// Accepted step, as passed to its observer.
pub struct Stretch<'a> {
    pub(super) passage: &'a Passage<'a>,
    /// States that the observer requires, in its order.
    pub states: &'a [Quartic],
}

impl Stretch<'_> {
    /// Start time, s.
    pub fn start_s(&self) -> f64 {
        self.passage.time_s
    }

    /// End time, s.
    pub fn end_s(&self) -> f64 {
        self.passage.end_s()
    }

    /// True if no input moves within it.
    pub fn is_still(&self) -> bool {
        self.passage.still
    }

    /// Wave of this number, including the part sent until the end of the step.
    pub fn wave(&self, number: usize) -> Option<&WaveHistory> {
        self.passage.histories.get(number)
    }

    /// All inputs at a fraction of the step, from 0 to 1.
    pub fn inputs_at(&self, part: f64, inputs: &mut [f64]) {
        self.passage.inputs_within(part, inputs);
    }
}
