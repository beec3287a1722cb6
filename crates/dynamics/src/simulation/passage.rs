//! Progress of one machine through time: its state, the limit of its next step, and the coming
//! breaks.

use std::collections::VecDeque;

use super::growth::GrowingMode;
use super::history::WaveHistory;
use super::{Attention, Event, Input, InputSchedule, ProfilePiece, Sampler, Status, StepCounts};
use crate::order::sorted_distinct;
use crate::portable;

/// Smallest and largest ratio of a step to the previous one.
const GROWTH: [f64; 2] = [0.1, 6.0];
/// Distance of a kink from both ends of a failed step, as a fraction of it, above which the
/// repeated step ends at the kink.
const KINK_WITHIN: f64 = 0.02;
/// Safety factor of the step that the error would allow.
const SAFETY: f64 = 0.9;
/// Number of restarts for the waves of a break; by then they have faded. Remaining jumps are
/// smeared over a step.
const ECHOES: u8 = 12;

/// Input between two breaks.
#[derive(Clone, Debug)]
enum InputSegment {
    Still(f64),
    Command,
    Value(ProfilePiece),
    Rate(ProfilePiece),
}

/// Progress of one machine through time.
pub(super) struct Passage<'a> {
    pub(super) schedule: &'a InputSchedule,
    /// Inputs up to the next break.
    segments: Vec<InputSegment>,
    /// True if no input moves before the next break.
    pub(super) still: bool,
    pub(super) time_s: f64,
    /// Length of the next step, unless a break comes before.
    proposed_s: f64,
    /// Longest step.
    longest_s: f64,
    /// Growing mode that requires the shortest step, if there is one.
    pub(super) growing: Option<GrowingMode>,
    /// True if the attempted step is shortened for it.
    held_back: bool,
    /// End of the attempted step, if it is at a break or a kink.
    target_s: Option<f64>,
    /// Fraction of the attempted step just after the first kink of the rates in it.
    pub(super) kink: Option<f64>,
    /// Steps within which some kink was passed.
    pub(super) passed_kinks: u64,
    /// Time of a kink at which a step must end.
    kink_s: Option<f64>,
    /// Time of the next break, sample or arrival.
    goal_s: f64,
    pub(super) step_s: f64,
    /// Times of restarts, rising, each with the number of delays that it has passed.
    breaks: VecDeque<(f64, u8)>,
    pub(super) histories: Vec<WaveHistory>,
    sample: u64,
    pending: VecDeque<(f64, f64)>,
    command: f64,
    pub(super) row: u64,
    /// Level of detail for its observer.
    pub(super) attention: Attention,
    /// True if the last step was rejected.
    pub(super) rejected: bool,
    /// Error of the last step.
    before: f64,
    pub(super) work: StepCounts,
    pub(super) events: Vec<Event>,
    pub(super) status: Option<Status>,
}

impl<'a> Passage<'a> {
    /// Start at time zero, with a held command.
    pub(super) fn new(schedule: &'a InputSchedule, command: f64) -> Passage<'a> {
        let mut times: Vec<f64> = Vec::new();
        let mut longest_s = schedule.duration_s;
        for input in &schedule.inputs {
            if let Input::Value(profile) | Input::Rate(profile) = input {
                times.extend(profile.breaks().into_iter().filter(|&time| time > 0.0));
                longest_s = longest_s.min(profile.longest_step().unwrap_or(longest_s));
            }
        }
        times.push(schedule.duration_s);
        times.retain(|&time| time <= schedule.duration_s);
        let times = sorted_distinct(times);
        Passage {
            schedule,
            segments: schedule.inputs.iter().map(|input| segment(input, 0.0)).collect(),
            still: false,
            time_s: 0.0,
            proposed_s: longest_s,
            longest_s,
            growing: None,
            held_back: false,
            target_s: None,
            kink: None,
            kink_s: None,
            goal_s: schedule.duration_s,
            step_s: 0.0,
            breaks: times.into_iter().map(|time| (time, 0)).collect(),
            histories: Vec::new(),
            sample: 0,
            pending: VecDeque::new(),
            command,
            row: 0,
            attention: Attention::Rows,
            rejected: false,
            before: 1.0,
            passed_kinks: 0,
            work: StepCounts::default(),
            events: Vec::new(),
            status: None,
        }
    }

    /// Adds waves in delays, each with its value before time zero.
    pub(super) fn with_waves(mut self, delays_s: &[f64], initial: &[f64]) -> Passage<'a> {
        self.histories =
            delays_s.iter().zip(initial).map(|(&d, &value)| WaveHistory::new(d, value)).collect();
        for &delay in delays_s {
            self.longest_s = self.longest_s.min(delay);
            self.meet_again(0.0, 0);
        }
        self.proposed_s = self.proposed_s.min(self.longest_s);
        self
    }

    /// Sets a first step from the rate of the state, per second and relative to its scale.
    pub(super) fn begin(&mut self, rate: f64, tolerance: f64) {
        let guess = 0.1 * portable::pow(tolerance, 0.2) / rate;
        if guess.is_finite() {
            self.proposed_s = guess.min(self.longest_s);
        }
    }

    /// Chooses the length of the next attempt.
    pub(super) fn choose(&mut self, sample_time_s: Option<f64>) {
        let mut target = self.breaks.front().map_or(self.schedule.duration_s, |&(time, _)| time);
        if let Some(sample_time_s) = sample_time_s {
            target = target.min(self.sample as f64 * sample_time_s);
        }
        if let Some(&(arrival, _)) = self.pending.front() {
            target = target.min(arrival);
        }
        self.goal_s = target;
        target = self.kink_s.map_or(target, |kink_s| target.min(kink_s));
        let left = target - self.time_s;
        let longest_s = self.growing.map_or(self.longest_s, |growing| growing.step_s.min(self.longest_s));
        let wanted = self.proposed_s.min(longest_s);
        self.held_back = wanted < self.proposed_s.min(self.longest_s);
        let nearly = wanted >= 0.99 * left && left <= longest_s;
        (self.step_s, self.target_s) = if wanted >= left || nearly {
            (left, Some(target))
        } else if wanted > 0.5 * left {
            (0.5 * left, None)
        } else {
            (wanted, None)
        };
    }

    /// Records the mode that bounds the step; returns true if the attempted step is too long for
    /// it.
    pub(super) fn limit(&mut self, growing: Option<GrowingMode>) -> bool {
        self.growing = growing;
        growing.is_some_and(|growing| growing.step_s < self.step_s * (1.0 - 1e-9))
    }

    /// Status of a run that has used all its steps.
    pub(super) fn out_of_steps(&self) -> Status {
        let time_s = self.time_s;
        match self.growing.filter(|growing| self.held_back && growing.growth_per_s > 0.0) {
            None => Status::TooManySteps { time_s },
            Some(GrowingMode { frequency_rad_per_s, growth_per_s, .. }) => {
                Status::UnresolvedOscillation { time_s, frequency_rad_per_s, growth_per_s }
            }
        }
    }

    /// Time of the next row.
    pub(super) fn next_row_s(&self) -> f64 {
        self.row as f64 * self.schedule.output_step_s
    }

    /// True if a state inside the attempted step is observed or sent.
    pub(super) fn looked_into(&self) -> bool {
        let past = self.next_row_s() <= later(self.time_s);
        let next_row_s = (self.row + u64::from(past)) as f64 * self.schedule.output_step_s;
        self.attention != Attention::Rows || !self.histories.is_empty() || next_row_s < self.end_s()
    }

    /// Length of the step to the next break, if no input moves and no row is recorded on the way.
    pub(super) fn whole_step(&self) -> Option<f64> {
        let step_s = self.goal_s - self.time_s;
        let past = self.next_row_s() <= later(self.time_s);
        let next_row_s = (self.row + u64::from(past)) as f64 * self.schedule.output_step_s;
        let seen = next_row_s < self.time_s + step_s * (1.0 - 1e-9);
        (self.still && !seen && self.attention != Attention::Everything).then_some(step_s)
    }

    /// Extends the attempted step to the next break.
    pub(super) fn go_whole(&mut self) {
        (self.step_s, self.target_s) = (self.goal_s - self.time_s, Some(self.goal_s));
    }

    /// Inputs at a fraction of the attempted step.
    pub(super) fn inputs_within(&self, part: f64, inputs: &mut [f64]) {
        let time_s = if part == 1.0 { self.end_s() } else { self.time_s + part * self.step_s };
        self.inputs_at(time_s, inputs);
    }

    /// Inputs at a time up to the next break, waves included: at a break, those within the
    /// attempted step.
    #[inline]
    pub(super) fn inputs_at(&self, time_s: f64, inputs: &mut [f64]) {
        for (place, segment) in inputs.iter_mut().zip(&self.segments) {
            *place = match segment {
                InputSegment::Still(value) => *value,
                InputSegment::Command => self.command,
                InputSegment::Value(piece) => piece.at(time_s).value,
                InputSegment::Rate(piece) => piece.at(time_s).rate,
            };
        }
        if let Some(waves) = inputs.get_mut(self.segments.len()..) {
            let middle_s = self.middle_s();
            for (place, history) in waves.iter_mut().zip(&self.histories) {
                *place = history.arriving(time_s, middle_s)[0];
            }
        }
    }

    /// Slopes of all inputs at the beginning of the step.
    pub(super) fn slopes(&self, slopes: &mut [f64]) {
        let known = self.segments.iter().map(|segment| match segment {
            InputSegment::Still(_) | InputSegment::Command => 0.0,
            InputSegment::Value(piece) => piece.at(self.time_s).rate,
            InputSegment::Rate(piece) => piece.at(self.time_s).acceleration,
        });
        let (time_s, middle_s) = (self.time_s, self.middle_s());
        let waves = self.histories.iter().map(|history| history.arriving(time_s, middle_s)[1]);
        for (place, value) in slopes.iter_mut().zip(known.chain(waves)) {
            *place = value;
        }
    }

    /// End of the attempted step.
    pub(super) fn end_s(&self) -> f64 {
        self.target_s.unwrap_or(self.time_s + self.step_s)
    }

    fn middle_s(&self) -> f64 {
        self.time_s + 0.5 * self.step_s
    }

    /// Accepts the step or shortens it, by its error in units of the tolerance; returns true if it
    /// was accepted.
    pub(super) fn judge(&mut self, error: f64) -> bool {
        let taken = error <= 1.0;
        let factor = if error.is_finite() {
            // proportional-integral control of the step (Gustafsson 1991): error^(-3/16)
            // before^(1/16)
            let (eighth, before) =
                (error.max(1e-8).sqrt().sqrt().sqrt(), self.before.sqrt().sqrt().sqrt().sqrt());
            let damped = if taken { before } else { 1.0 };
            (SAFETY * damped / (eighth * eighth.sqrt())).clamp(GROWTH[0], GROWTH[1])
        } else {
            GROWTH[0]
        };
        if taken {
            let factor = if self.rejected { factor.min(1.0) } else { factor };
            // a step cut short by a break does not limit the longer one proposed
            let grown = self.step_s * factor;
            let cut = self.target_s.is_some() && factor >= 1.0;
            self.proposed_s = if cut { grown.max(self.proposed_s) } else { grown };
            self.before = error.max(1e-3);
            self.work.steps += 1;
        } else if let Some(part) = self.kink.filter(|part| self.may_end_at(*part, error)) {
            // the step after the kink may have the length of this attempt
            self.kink_s = Some(self.time_s + part * self.step_s);
            self.work.rejected += 1;
        } else {
            self.proposed_s = self.step_s * factor.min(0.9);
            self.work.rejected += 1;
            if self.time_s + self.proposed_s * 0.01 <= self.time_s || self.proposed_s < 1e-14 {
                let time_s = self.time_s;
                self.status = Some(if error.is_finite() {
                    Status::StepTooSmall { time_s }
                } else {
                    Status::NotFinite { time_s }
                });
            }
        }
        self.rejected = !taken;
        taken
    }

    /// True if a step that failed by this error must end at a kink at this fraction of it: once for
    /// each accepted step, so that a step which fails for another reason becomes shorter.
    fn may_end_at(&self, part: f64, error: f64) -> bool {
        let within = (KINK_WITHIN..1.0 - KINK_WITHIN).contains(&part);
        within && error.is_finite() && self.kink_s.is_none()
    }

    /// Advances to the end of the accepted step and processes the events there: breaks, arriving
    /// commands.
    pub(super) fn arrive(&mut self) {
        self.time_s = self.end_s();
        self.kink_s = self.kink_s.filter(|&kink_s| kink_s > later(self.time_s));
        let mut broken = false;
        let (now_s, mut begins_s) = (later(self.time_s), self.time_s);
        while self.breaks.front().is_some_and(|&(time, _)| time <= now_s) {
            if let Some((time, generation)) = self.breaks.pop_front() {
                self.meet_again(time, generation);
                (broken, begins_s) = (true, begins_s.max(time));
            }
        }
        while self.pending.front().is_some_and(|&(arrival, _)| arrival <= self.time_s) {
            if let Some((_, command)) = self.pending.pop_front() {
                self.hold(command);
            }
        }
        if broken {
            let inputs = self.schedule.inputs.iter();
            self.segments.clear();
            self.segments.extend(inputs.map(|input| segment(input, begins_s)));
            self.begin_anew();
        }
        if now_s >= self.schedule.duration_s {
            self.status = Some(Status::Completed);
        }
    }

    /// True if the sampler must act now.
    pub(super) fn samples_now(&self, sample_time_s: f64) -> bool {
        later(self.time_s) >= self.sample as f64 * sample_time_s
    }

    /// Runs the sampler.
    pub(super) fn act(&mut self, sampler: &mut dyn Sampler, state: &[f64], inputs: &[f64]) {
        let command = sampler.command(self.time_s, state, inputs);
        if !command.is_finite() {
            self.status = Some(Status::NotFinite { time_s: self.time_s });
        }
        self.sample += 1;
        let arrival = self.time_s + sampler.delay_s();
        if arrival > self.time_s {
            self.pending.push_back((arrival, command));
        } else {
            self.hold(command);
        }
    }

    /// Applies a command from now on.
    fn hold(&mut self, command: f64) {
        self.command = command;
        self.begin_anew();
    }

    /// Restarts the method, since the inputs have changed.
    fn begin_anew(&mut self) {
        self.before = 1.0;
        self.still = false;
    }

    /// True if no input moves before the next break, and none moved before the previous one.
    pub(super) fn is_constant(&mut self) -> bool {
        let was = self.still;
        let at_rest =
            |segment: &InputSegment| matches!(segment, InputSegment::Still(_) | InputSegment::Command);
        self.still = self.histories.is_empty() && self.segments.iter().all(at_rest);
        was && self.still
    }

    /// Schedules the arrival of waves that leave at a break as breaks.
    fn meet_again(&mut self, time_s: f64, generation: u8) {
        if generation >= ECHOES {
            return;
        }
        for history in &self.histories {
            let arrival = time_s + history.delay_s();
            if arrival < self.schedule.duration_s {
                // waves that travel equal delays in another order arrive together, except for
                // rounding
                let rounding = 4.0 * f64::EPSILON * arrival;
                let place = self.breaks.partition_point(|&(time, _)| time < arrival - rounding);
                match self.breaks.get_mut(place) {
                    Some((time, other)) if *time <= arrival + rounding => {
                        *other = (*other).min(generation + 1)
                    }
                    _ => self.breaks.insert(place, (arrival, generation + 1)),
                }
            }
        }
    }
}

/// Latest time in s that equals this one within rounding: 17 times 0.7 ms and 11.9 ms are one time.
pub(super) fn later(time_s: f64) -> f64 {
    time_s * (1.0 + 4.0 * f64::EPSILON)
}

fn segment(input: &Input, time_s: f64) -> InputSegment {
    match input {
        Input::Command => InputSegment::Command,
        Input::Value(profile) => {
            let piece = profile.piece(time_s);
            piece.constant().map_or(InputSegment::Value(piece), InputSegment::Still)
        }
        Input::Rate(profile) => {
            let piece = profile.piece(time_s);
            piece.constant().map_or(InputSegment::Rate(piece), |_| InputSegment::Still(0.0))
        }
    }
}
