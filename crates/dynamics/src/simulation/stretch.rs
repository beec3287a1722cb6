use super::history::WaveHistory;
use super::passage::Passage;
use super::quartic::Quartic;

/// One step that was taken, as its observer is shown it.
pub struct Stretch<'a> {
    pub(super) passage: &'a Passage<'a>,
    /// The states that the observer wants, in its order.
    pub states: &'a [Quartic],
}

impl Stretch<'_> {
    /// Where it begins, in s.
    pub fn start_s(&self) -> f64 {
        self.passage.time_s
    }

    /// Where it ends, in s.
    pub fn end_s(&self) -> f64 {
        self.passage.end_s()
    }

    /// True if no input moves within it.
    pub fn is_still(&self) -> bool {
        self.passage.still
    }

    /// The wave of this number, with what is sent until its end.
    pub fn wave(&self, number: usize) -> Option<&WaveHistory> {
        self.passage.histories.get(number)
    }

    /// All inputs at a part of it, from 0 to 1.
    pub fn inputs_at(&self, part: f64, inputs: &mut [f64]) {
        self.passage.inputs_within(part, inputs);
    }
}
