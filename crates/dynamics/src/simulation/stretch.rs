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

    /// Whether no input moves within it.
    pub fn is_still(&self) -> bool {
        self.passage.still
    }

    /// The wave of this number that arrives at a time in s, from its start until as long after its
    /// end as the wave travels; NaN where there is none.
    pub fn arriving(&self, wave: usize, time_s: f64) -> f64 {
        let waves = self.passage.histories.get(wave);
        waves.map_or(f64::NAN, |wave| wave.arriving(time_s, time_s)[0])
    }

    /// All inputs at a part of it, from 0 to 1.
    pub fn inputs_at(&self, part: f64, inputs: &mut [f64]) {
        self.passage.inputs_within(part, inputs);
    }
}
