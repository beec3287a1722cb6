//! Evaluation of a run from step to step, so that the metrics of its windows are those of the
//! solution, independent of the rows.

use std::cell::RefCell;

use phea_dynamics::simulation::{Profile, ProfilePiece, Quartic, Stretch};
use phea_machine::ControllerSamples;

use super::divergence::{Divergence, DivergenceWatch, OtherInputs};
use super::sum::SignalSum;
use super::tally::{CommandStretch, Passed, Tally};
use super::{Metrics, Window};

/// Number of parts of a step over each of which an input that is not a polynomial is replaced by
/// one of degree four: a sine over a quarter of its period, the longest possible step, to 3e-7 of
/// its amplitude.
const PARTS: u32 = 4;
/// Distance of ends that differ only by rounding, in steps; and in units of the last place of the
/// time, which matter for a step that ends at a located event.
const SAME: f64 = 1e-9;
pub(super) const LAST_PLACES: f64 = 16.0;

/// Distance of ends that differ only by rounding, for a step that ends here, s.
fn rounding_s(start_s: f64, end_s: f64) -> f64 {
    SAME * (end_s - start_s) + LAST_PLACES * f64::EPSILON * end_s.abs()
}

/// Source of the command.
pub(super) enum CommandSource<'a> {
    /// Command that a continuous controller demands, with its limit, V, or the stated command of an
    /// open loop.
    Continuously(SignalSum<'a>, f64),
    /// The last command of a sampled controller.
    Sampled(&'a RefCell<ControllerSamples>),
}

/// Accumulates the metrics of the windows of a run.
pub struct Follower<'a> {
    force: SignalSum<'a>,
    commanded: CommandSource<'a>,
    /// `None` in an open loop.
    reference: Option<&'a Profile>,
    tallies: Vec<Tally>,
    /// Index of the first window that has not ended.
    first: usize,
    /// Storage for all inputs.
    inputs: Vec<f64>,
    /// `None` in an open loop.
    divergence: Option<DivergenceWatch>,
}

impl<'a> Follower<'a> {
    /// Follower of a loop with this number of inputs, in windows in the order of their starts; with
    /// the band of settling times, percent.
    pub(super) fn new(
        force: SignalSum<'a>,
        commanded: CommandSource<'a>,
        inputs: usize,
        reference: Option<&'a Profile>,
        (windows, band): (&[Window], f64),
    ) -> Follower<'a> {
        let tally = |window: &Window| {
            Tally::new(*window, band, reference.map(|reference| last_value(reference, window)))
        };
        let tallies = windows.iter().map(tally).collect();
        let inputs = vec![0.0; inputs];
        Follower { force, commanded, reference, tallies, first: 0, inputs, divergence: None }
    }

    /// The follower with a monitor for divergence, if the loop is closed.
    pub(super) fn watching(self, watch: DivergenceWatch) -> Follower<'a> {
        Follower { divergence: self.reference.map(|_| watch), ..self }
    }

    /// Divergence of the run under these inputs, if there is any.
    pub(crate) fn divergence(&self, inputs: &OtherInputs<'_>) -> Option<Divergence> {
        self.divergence.as_ref()?.found(inputs)
    }

    /// Metrics of each window, up to the last step.
    pub fn metrics(&self) -> Vec<Metrics> {
        self.tallies.iter().map(Tally::metrics).collect()
    }

    /// Force at one time, from the requested states, N.
    pub fn force_n(&self, states: &[f64]) -> f64 {
        self.force.at(states)
    }

    /// Evaluates a step.
    pub fn follow(&mut self, stretch: &Stretch<'_>) {
        let (start_s, end_s) = (stretch.start_s(), stretch.end_s());
        self.watch(stretch);
        let rounding_s = rounding_s(start_s, end_s);
        while self.tallies.get(self.first).is_some_and(|one| one.window.end_s <= start_s + rounding_s) {
            self.first += 1;
        }
        if self.tallies.get(self.first).is_none_or(|one| one.window.start_s >= end_s - rounding_s) {
            return;
        }
        let force = self.force.over(stretch.states);
        let piece = self.reference.map(|reference| reference.piece(0.5 * (start_s + end_s)));
        let still = piece.as_ref().map(ProfilePiece::constant);
        let moved = match &self.commanded {
            CommandSource::Continuously(sum, _) => sum.has_inputs() && !stretch.is_still(),
            CommandSource::Sampled(_) => false,
        };
        if !moved && still != Some(None) {
            let passed = Passed {
                times_s: [start_s, end_s],
                force,
                reference: still.flatten().map(Quartic::constant),
                command: self.command(stretch, [0.0, 1.0]),
            };
            self.pass(&passed);
            return;
        }
        for part in 0..PARTS {
            let within = [part, part + 1].map(|part| f64::from(part) / f64::from(PARTS));
            let times_s = within.map(|part| start_s + part * (end_s - start_s));
            let reference = |piece: &ProfilePiece| match piece.constant() {
                Some(value) => Quartic::constant(value),
                None => through(times_s, |time_s| piece.at(time_s).value),
            };
            let passed = Passed {
                times_s,
                force: through(within, |part| force.at(part)),
                reference: piece.as_ref().map(reference),
                command: self.command(stretch, within),
            };
            self.pass(&passed);
        }
    }

    /// Passes the end of a step to the monitor for divergence.
    fn watch(&mut self, stretch: &Stretch<'_>) {
        let (Some(watch), Some(reference)) = (&mut self.divergence, self.reference) else { return };
        let end_s = stretch.end_s();
        let force = self.force.over(stretch.states).at(1.0);
        let requested = reference.piece(0.5 * (stretch.start_s() + end_s)).at(end_s).value;
        let command = match &self.commanded {
            CommandSource::Sampled(log) => log.borrow().last.map_or(0.0, |sample| sample.command_v),
            CommandSource::Continuously(sum, _) => {
                let driven = if sum.has_inputs() { sum.driven(stretch, 1.0, &mut self.inputs) } else { 0.0 };
                sum.over(stretch.states).at(1.0) + driven
            }
        };
        watch.take(end_s, [force, requested, command]);
    }

    /// Command over a part of a step.
    fn command(&mut self, stretch: &Stretch<'_>, within: [f64; 2]) -> CommandStretch {
        match &self.commanded {
            CommandSource::Sampled(log) => {
                CommandStretch::Held(log.borrow().last.map_or(0.0, |sample| sample.command_v))
            }
            CommandSource::Continuously(sum, limit) => {
                let wanted = sum.over(stretch.states);
                let inputs = &mut self.inputs;
                let wanted = match (sum.has_inputs(), stretch.is_still()) {
                    (false, _) if within == [0.0, 1.0] => wanted,
                    (false, _) => through(within, |part| wanted.at(part)),
                    (true, true) if within == [0.0, 1.0] => {
                        wanted.plus(1.0, &Quartic::constant(sum.driven(stretch, 0.5, inputs)))
                    }
                    (true, _) => through(within, |part| wanted.at(part) + sum.driven(stretch, part, inputs)),
                };
                CommandStretch::Wanted { wanted, limit: *limit }
            }
        }
    }

    fn pass(&mut self, passed: &Passed) {
        let [start_s, end_s] = passed.times_s;
        let length_s = end_s - start_s;
        for tally in self.tallies.iter_mut().skip(self.first) {
            let span = [tally.window.start_s, tally.window.end_s].map(|time_s| (time_s - start_s) / length_s);
            let same = rounding_s(start_s, end_s) / length_s;
            let from = if span[0] > same { span[0] } else { 0.0 };
            let until = if span[1] < 1.0 - same { span[1] } else { 1.0 };
            if from >= 1.0 - same {
                return;
            }
            if until > same {
                tally.pass(passed, [from, until]);
            }
        }
    }

    /// True if a step from sample to sample may contain an extreme that counts, or leave a band:
    /// then the force is needed more accurately than by a cubic.
    pub fn needs_accurate_solution(&self, stretch: &Stretch<'_>) -> bool {
        let (start_s, end_s) = (stretch.start_s(), stretch.end_s());
        let open = |tally: &&Tally| tally.window.start_s < end_s && tally.window.end_s > start_s;
        let mut open = self.tallies.iter().skip(self.first).filter(open).peekable();
        if open.peek().is_none() {
            return false;
        }
        let force = self.force.over(stretch.states);
        if force.is_plainly_monotone() {
            return false;
        }
        let at_end = |reference: &Profile| reference.piece(0.5 * (start_s + end_s)).at(end_s).value;
        let reference = self.reference.map(at_end);
        open.any(|tally| tally.needs_accurate_solution(&force, reference))
    }
}

/// Reference at the end of a window, before the event there.
fn last_value(reference: &Profile, window: &Window) -> f64 {
    let before_s = window.end_s - 1e-6 * (window.end_s - window.start_s);
    reference.piece(before_s).at(window.end_s).value
}

/// A function of time or of a part of a step as a polynomial over a span.
fn through([from, until]: [f64; 2], mut value: impl FnMut(f64) -> f64) -> Quartic {
    Quartic::through([0.0, 0.25, 0.5, 0.75, 1.0].map(|part| value(from + part * (until - from))))
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable;
    use phea_dynamics::scalar::Scalar;
    use phea_dynamics::simulation::{
        Attention, Input, InputSchedule, Observer, SimulationSettings, System, Task, drive_one,
    };

    use super::super::Cause;
    use super::*;

    /// Test oscillator y'' = w^2 (u - y) - 2 d w y'; its states represent force and command.
    #[derive(Clone)]
    struct Swing {
        frequency: f64,
        damping: f64,
    }

    impl System<f64> for Swing {
        fn states(&self) -> usize {
            2
        }
        fn inputs(&self) -> usize {
            1
        }
        fn scales(&self) -> Vec<f64> {
            vec![1e3, 1e3 * self.frequency]
        }
        fn rates<T: Scalar + From<f64>>(&self, y: &[T], u: &[T], rates: &mut [T]) {
            rates[0] = y[1];
            rates[1] =
                ((u[0] - y[0]).times(self.frequency) - y[1].times(2.0 * self.damping)).times(self.frequency);
        }
    }

    struct Following<'a>(Follower<'a>);

    impl Observer for Following<'_> {
        fn wanted(&self) -> &[usize] {
            &[0, 1]
        }
        fn observe(&mut self, _: f64, _: &[f64], _: &[f64]) {}
        fn attention(&self) -> Attention {
            Attention::Everything
        }
        fn follow(&mut self, stretch: &Stretch<'_>) {
            self.0.follow(stretch);
        }
    }

    /// A run of three seconds and the metrics of its window.
    fn measured(
        swing: &Swing,
        start: [f64; 2],
        [driving, reference]: [&Profile; 2],
        window: Window,
        limit: f64,
        output_step_s: f64,
    ) -> Metrics {
        let schedule =
            InputSchedule { duration_s: 3.0, output_step_s, inputs: vec![Input::Value(driving.clone())] };
        let commanded = CommandSource::Continuously(SignalSum::single(1), limit);
        let follower = Follower::new(SignalSum::single(0), commanded, 1, Some(reference), (&[window], 1.0));
        let observer = Following(follower);
        let task = Task { start: start.to_vec(), schedule: &schedule, sampler: None, observer };
        let settings = SimulationSettings { tolerance: 1e-11, ..SimulationSettings::default() };
        let (_, seen) = drive_one(swing, task, &settings, &mut |_| true).unwrap();
        seen.0.metrics().remove(0)
    }

    fn step() -> (Swing, Profile, Window) {
        let reference = Profile::steps(0.0, &[(1.0, 2e3)]).unwrap();
        let cause = Cause::ReferenceStep { from_n: 0.0, to_n: 2e3 };
        (Swing { frequency: 40.0, damping: 0.3 }, reference, Window { cause, start_s: 1.0, end_s: 3.0 })
    }

    /// An integration step that ends at the step of the reference, a thousand millionth of a second
    /// long, while the window begins one rounding earlier: the reference of the window is only the
    /// one after the step.
    #[test]
    fn a_window_that_begins_a_rounding_early_has_its_step() {
        let (swing, reference, window) = step();
        let driving = Profile::steps(0.0, &[(1.0 - 1e-9, 1e-9), (1.0, 2e3)]).unwrap();
        let window = Window { start_s: window.start_s.next_down(), ..window };
        let found = measured(&swing, [0.0, 0.0], [&driving, &reference], window, f64::INFINITY, 0.1);
        let expected = 100.0 * portable::exp(-std::f64::consts::PI * 0.3 / (1.0 - 0.09_f64).sqrt());
        assert!((found.overshoot_percent.unwrap() - expected).abs() < 1e-3, "{found:?}");
        assert!(found.settling_time_s.is_ok(), "{found:?}");
    }

    /// Closed forms of a step of 2 kN of a mode of 40 rad/s damped by 0.3, however rare the rows.
    #[test]
    fn a_step_is_measured_as_its_closed_form() {
        let (swing, reference, window) = step();
        let Swing { frequency, damping } = swing;
        let sine = (1.0 - damping * damping).sqrt();
        let angle = portable::atan2(sine, damping);
        // response to the step, after it
        let response = |time_s: f64| {
            let phase = frequency * sine * time_s + angle;
            1.0 - portable::exp(-damping * frequency * time_s) * portable::sin(phase) / sine
        };
        let found = |output_step_s| {
            measured(&swing, [0.0; 2], [&reference, &reference], window, f64::INFINITY, output_step_s)
        };
        let seen = found(1e-3);
        let near = |found: f64, expected: f64| (found - expected).abs() < 1e-6 * expected.abs();
        let overshoot = 100.0 * portable::exp(-std::f64::consts::PI * damping / sine);
        assert!(near(seen.overshoot_percent.unwrap(), overshoot), "{seen:?}");
        let fastest = 2e3 * frequency * portable::exp(-damping * angle / sine);
        assert!(near(seen.control_peak_v.unwrap(), fastest), "{seen:?} {fastest}");
        let rms = 2e3 * (frequency / (4.0 * damping) / 2.0).sqrt();
        assert!(near(seen.control_rms_v.unwrap(), rms), "{seen:?} {rms}");
        let crossing = |mut low: f64, mut high: f64, level: f64| {
            let above = response(low) >= level;
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if (response(middle) >= level) == above { low = middle } else { high = middle }
            }
            low
        };
        let first_peak = std::f64::consts::PI / (frequency * sine);
        let rise = crossing(0.0, first_peak, 0.9) - crossing(0.0, first_peak, 0.1);
        assert!(near(seen.rise_time_s.unwrap(), rise), "{seen:?} {rise}");
        // the peaks are exp(-n pi d/s): the last one outside a hundredth is the fourth, below the
        // reference
        let last = crossing(4.0 * first_peak, 5.0 * first_peak, 0.99);
        assert!(response(4.0 * first_peak) < 0.99 && response(5.0 * first_peak) < 1.01);
        assert!(near(seen.settling_time_s.unwrap(), last), "{seen:?} {last}");
        assert!(seen.steady_state_error_n.unwrap().abs() < 1e-6);
        // a force that enters the band in the last tenth of a window was not observed for long
        // enough
        let settled = |fraction: f64| {
            let window = Window { end_s: 1.0 + last / fraction, ..window };
            let driving = [&reference, &reference];
            measured(&swing, [0.0; 2], driving, window, f64::INFINITY, 1e-3).settling_time_s
        };
        assert!(near(settled(0.85).unwrap(), last) && settled(0.95).is_err(), "{:?}", settled(0.85));
        assert_eq!(seen, found(1e-6 * 999.0));
        assert_eq!(seen, found(2.9));
    }

    /// The command's limit clips its peak, and reduces its mean square while it is reached.
    #[test]
    fn a_limit_cuts_the_command() {
        let (swing, reference, window) = step();
        let Swing { frequency, damping } = swing;
        let sine = (1.0 - damping * damping).sqrt();
        let limit = 2e4;
        let seen = measured(&swing, [0.0; 2], [&reference, &reference], window, limit, 0.1);
        assert_eq!(seen.control_peak_v, Ok(limit));
        let command = |time_s: f64| {
            let wave =
                portable::exp(-damping * frequency * time_s) * portable::sin(frequency * sine * time_s);
            2e3 * frequency / sine * wave
        };
        let squares =
            (0..2_000_000).map(|place| command(1e-6 * (f64::from(place) + 0.5)).clamp(-limit, limit));
        let rms = (squares.map(|value| value * value).sum::<f64>() / 2e6).sqrt();
        assert!((seen.control_rms_v.unwrap() - rms).abs() < 1e-6 * rms, "{seen:?} {rms}");
    }

    #[test]
    fn a_disturbance_is_measured_against_the_reference_and_a_run_that_ends_early_says_so() {
        // critically damped: 1000 + 80 t exp(-5 t)
        let swing = Swing { frequency: 5.0, damping: 1.0 };
        let reference = Profile::constant(1e3);
        let window = Window { cause: Cause::LoadMotion, start_s: 0.0, end_s: 3.0 };
        let found =
            |window| measured(&swing, [1e3, 80.0], [&reference, &reference], window, f64::INFINITY, 0.5);
        let seen = found(window);
        // ORIGIN: analytic, 80 t exp(-5 t) is largest at t = 0.2: 16/e
        assert!((seen.disturbance_peak_n.unwrap() - 16.0 * portable::exp(-1.0)).abs() < 1e-6);
        // the band of a hundredth of 1 kN is never left
        assert_eq!(seen.settling_time_s, Ok(0.0));
        let late = found(Window { end_s: 9.0, ..window });
        assert!(late.settling_time_s.is_err() && late.disturbance_peak_n == seen.disturbance_peak_n);
        let never = found(Window { start_s: 5.0, end_s: 6.0, ..window });
        assert!(never.disturbance_peak_n.is_err() && never.control_rms_v.is_err());
    }

    /// A reference that does not move as a polynomial: largest difference from a constant force.
    #[test]
    fn a_moving_reference_is_followed_within_each_step() {
        let swing = Swing { frequency: 5.0, damping: 1.0 };
        let (nothing, reference) = (Profile::constant(0.0), Profile::sine(0.1, 300.0, 7.0).unwrap());
        let window = Window { cause: Cause::LoadMotion, start_s: 0.0, end_s: 3.0 };
        // the steps are those of the input schedule
        let driven = measured(&swing, [0.0; 2], [&reference, &nothing], window, f64::INFINITY, 1.0);
        assert!(driven.disturbance_peak_n.unwrap() > 1.0);
        let schedule = InputSchedule {
            duration_s: 3.0,
            output_step_s: 1.0,
            inputs: vec![Input::Value(Profile::sine(0.1, 1e-9, 7.0).unwrap())],
        };
        let commanded = CommandSource::Continuously(SignalSum::single(1), f64::INFINITY);
        let follower = Follower::new(SignalSum::single(0), commanded, 1, Some(&reference), (&[window], 1.0));
        let observer = Following(follower);
        let task = Task { start: vec![0.0; 2], schedule: &schedule, sampler: None, observer };
        let (_, seen) = drive_one(&swing, task, &SimulationSettings::default(), &mut |_| true).unwrap();
        let peak = seen.0.metrics().remove(0).disturbance_peak_n.unwrap();
        assert!((peak - 300.0).abs() < 1e-6 * 300.0, "{peak}");
    }
}
