//! What is read off a run: one window for each step of the reference and for the motion of the load.

use phea_dynamics::time_response::{Settling, StepBaseline, step_metrics};

use crate::project::SignalKind;

/// Share of a window, at its end, over which the steady-state error is averaged.
const STEADY_SHARE: f64 = 0.1;

/// Part of a run that is looked at by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// What begins it.
    pub cause: Cause,
    /// s.
    pub start_s: f64,
    /// s, where the next one begins or the scenario ends.
    pub end_s: f64,
}

/// What begins a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The reference changes.
    ReferenceStep {
        /// N.
        from_n: f64,
        /// N.
        to_n: f64,
    },
    /// A part of the reference begins to move.
    ReferenceMotion {
        /// What kind of part.
        kind: SignalKind,
    },
    /// The open-loop command changes.
    CommandStep {
        /// V.
        from_v: f64,
        /// V.
        to_v: f64,
    },
    /// A part of the open-loop command begins to move.
    CommandMotion {
        /// What kind of part.
        kind: SignalKind,
    },
    /// The load begins to move.
    LoadMotion,
    /// A force on the load from outside begins or changes.
    ExternalForce,
}

impl Cause {
    /// Its word in answers.
    pub(crate) fn word(&self) -> &'static str {
        match self {
            Cause::ReferenceStep { .. } => "reference_step",
            Cause::ReferenceMotion { .. } => "reference_motion",
            Cause::CommandStep { .. } => "command_step",
            Cause::CommandMotion { .. } => "command_motion",
            Cause::LoadMotion => "load_motion",
            Cause::ExternalForce => "external_force",
        }
    }

    /// What a figure says of the moment.
    pub(crate) fn label(&self) -> &'static str {
        match self {
            Cause::ReferenceStep { .. } | Cause::CommandStep { .. } => "step",
            Cause::ReferenceMotion { kind } | Cause::CommandMotion { kind } => kind.name(),
            Cause::LoadMotion => "load moves",
            Cause::ExternalForce => "force from outside",
        }
    }
}

/// A number, or why there is none.
pub type Measured = Result<f64, &'static str>;

/// Numbers read off a window. A peak between two looks is that of the parabola through its three nearest, so that it does not depend
/// on where they fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metrics {
    /// How far the force exceeds the new reference, percent of the step.
    pub overshoot_percent: Measured,
    /// From 10 % to 90 % of the step, each where the force first reaches it, s.
    pub rise_time_s: Measured,
    /// From the start of the window until the force stays within the band around the reference, s.
    pub settling_time_s: Measured,
    /// The band of the settling time: percent of the step, or of the reference that a load motion disturbs.
    pub settling_band_percent: f64,
    /// Largest difference of force and reference while the load moves, or is pushed from outside, and after, N.
    pub disturbance_peak_n: Measured,
    /// Largest difference of force and reference while the reference moves, N.
    pub tracking_error_peak_n: Measured,
    /// Largest magnitude of the force where no force is asked for, N.
    pub force_peak_n: Measured,
    /// Reference less force, mean over the last tenth of the window, N.
    pub steady_state_error_n: Measured,
    /// Largest magnitude of the command, V.
    pub control_peak_v: Measured,
    /// Root mean square of the command, V.
    pub control_rms_v: Measured,
}

const UNREACHED: &str = "the run ended before";
const NO_STEP: &str = "the reference does not step";
const NO_MOTION: &str = "the load does not begin to move";
const NOT_REACHED: &str = "the force does not come to 90 % of the step";
const BEGUN_BEYOND: &str = "the force is beyond 10 % of the step when it comes";
pub(crate) const NOT_SETTLED: &str = "outside the band at the end of the window";
const MOVES: &str = "the reference moves";
const OPEN_LOOP: &str = "open loop: no force is asked for";
const ASKED_FOR: &str = "the reference says which force there should be";
const STANDS_STILL: &str = "the reference stands still";
const NO_REFERENCE: &str = "the reference is zero: a band around it has no width";

/// The metrics of a window of what was seen; `band` in percent.
pub(crate) fn metrics_seen(all: &Seen<'_>, window: Window, band: f64) -> Metrics {
    let seen = all.within(window);
    let whole = all.ends_s() > window.end_s * (1.0 - 4.0 * f64::EPSILON);
    match window.cause {
        _ if seen.times_s.len() < 3 => Metrics::none(UNREACHED, band),
        Cause::ReferenceStep { from_n, to_n } => seen.step(window.start_s, [from_n, to_n], band, whole),
        _ if seen.reference_n.is_empty() => seen.open_loop(band),
        Cause::ReferenceMotion { .. } | Cause::CommandStep { .. } | Cause::CommandMotion { .. } => {
            Metrics { disturbance_peak_n: Err(NO_MOTION), ..seen.common(band, whole) }
        }
        Cause::LoadMotion | Cause::ExternalForce => seen.motion(window.start_s, band, whole),
    }
}

impl Metrics {
    /// Each that is measured with its name, in the order of an answer.
    pub(crate) fn named(&self) -> [(&'static str, Measured); 9] {
        [
            ("overshoot_percent", self.overshoot_percent),
            ("rise_time_s", self.rise_time_s),
            ("settling_time_s", self.settling_time_s),
            ("disturbance_peak_n", self.disturbance_peak_n),
            ("tracking_error_peak_n", self.tracking_error_peak_n),
            ("force_peak_n", self.force_peak_n),
            ("steady_state_error_n", self.steady_state_error_n),
            ("control_peak_v", self.control_peak_v),
            ("control_rms_v", self.control_rms_v),
        ]
    }

    fn none(reason: &'static str, settling_band_percent: f64) -> Metrics {
        Metrics {
            overshoot_percent: Err(reason),
            rise_time_s: Err(reason),
            settling_time_s: Err(reason),
            settling_band_percent,
            disturbance_peak_n: Err(reason),
            tracking_error_peak_n: Err(reason),
            force_peak_n: Err(reason),
            steady_state_error_n: Err(reason),
            control_peak_v: Err(reason),
            control_rms_v: Err(reason),
        }
    }
}

/// Looks at a run, or those in a window: as many values of each as there are times.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<'a> {
    /// Rising.
    pub(crate) times_s: &'a [f64],
    pub(crate) force_n: &'a [f64],
    /// None where nothing is asked for.
    pub(crate) reference_n: &'a [f64],
    pub(crate) control_v: &'a [f64],
}

impl<'a> Seen<'a> {
    /// Until when it was seen, s: the last look stands for all until the next one would have come.
    fn ends_s(&self) -> f64 {
        match self.times_s {
            [.., before, last] => last + (last - before),
            _ => 0.0,
        }
    }

    /// Those in a window; its last instant belongs to it where the run ends there.
    fn within(&self, window: Window) -> Self {
        let start = self.times_s.partition_point(|time| *time < window.start_s);
        let last = self.times_s.last() == Some(&window.end_s);
        let end =
            self.times_s.partition_point(|time| *time < window.end_s || (last && *time == window.end_s));
        let part = |values: &'a [f64]| values.get(start..end).unwrap_or_default();
        Seen {
            times_s: part(self.times_s),
            force_n: part(self.force_n),
            reference_n: part(self.reference_n),
            control_v: part(self.control_v),
        }
    }

    fn step(&self, start_s: f64, [from_n, to_n]: [f64; 2], band: f64, whole: bool) -> Metrics {
        if self.reference_moves() {
            return Metrics { disturbance_peak_n: Err(NO_MOTION), ..self.common(band, whole) };
        }
        let beyond: Vec<f64> = self.force_n.iter().map(|force| (force - to_n) / (to_n - from_n)).collect();
        let baseline = StepBaseline { step_time_s: start_s, initial_value: from_n, final_value: to_n };
        let step = step_metrics(self.times_s, self.force_n, baseline, band).map_err(|_| NO_STEP);
        let settling = match step.map(|step| step.settling) {
            _ if !whole => Err(UNREACHED),
            Ok(Settling::Settled { time_s }) => Ok(time_s),
            Ok(Settling::NotSettled { .. }) => Err(NOT_SETTLED),
            Err(reason) => Err(reason),
        };
        let late = if whole { NOT_REACHED } else { UNREACHED };
        let begun_beyond = beyond.first().is_some_and(|part| *part > -0.9);
        let rise = step.and_then(|step| step.rise_time_10_90_s.ok_or(late));
        Metrics {
            overshoot_percent: Ok(100.0 * peak(&beyond).max(0.0)),
            rise_time_s: if begun_beyond { Err(BEGUN_BEYOND) } else { rise },
            settling_time_s: settling,
            disturbance_peak_n: Err(NO_MOTION),
            ..self.common(band, whole)
        }
    }

    fn motion(&self, start_s: f64, band: f64, whole: bool) -> Metrics {
        let settling = match whole {
            true if self.reference_moves() => Err(MOVES),
            true => self.settled(start_s, band),
            false => Err(UNREACHED),
        };
        Metrics {
            overshoot_percent: Err(NO_STEP),
            rise_time_s: Err(NO_STEP),
            settling_time_s: settling,
            disturbance_peak_n: Ok(self.largest_error()),
            ..self.common(band, whole)
        }
    }

    /// Whether the reference is not the same throughout.
    fn reference_moves(&self) -> bool {
        self.reference_n.windows(2).any(|pair| pair[0] != pair[1])
    }

    fn largest_error(&self) -> f64 {
        let errors = self.errors();
        peak(&errors).max(peak(&errors.iter().map(|error| -error).collect::<Vec<_>>()))
    }

    /// From the start until the last error beyond the band, between two looks on a straight line.
    fn settled(&self, start_s: f64, band: f64) -> Measured {
        let width = 0.01 * band * self.reference_n.last().copied().unwrap_or(0.0).abs();
        if width == 0.0 {
            return Err(NO_REFERENCE);
        }
        let errors = self.errors();
        let Some(outside) = errors.iter().rposition(|error| error.abs() > width) else { return Ok(0.0) };
        let (Some(&inner), Some(&inner_s)) = (errors.get(outside + 1), self.times_s.get(outside + 1)) else {
            return Err(NOT_SETTLED);
        };
        let (outer, outer_s) = (errors[outside].abs(), self.times_s[outside]);
        let share = (outer - width) / (outer - inner.abs());
        Ok(outer_s + share.clamp(0.0, 1.0) * (inner_s - outer_s) - start_s)
    }

    fn common(&self, band: f64, whole: bool) -> Metrics {
        let moves = self.reference_moves();
        Metrics {
            force_peak_n: Err(ASKED_FOR),
            tracking_error_peak_n: if moves { Ok(self.largest_error()) } else { Err(STANDS_STILL) },
            steady_state_error_n: if whole { self.steady_error() } else { Err(UNREACHED) },
            ..self.commanded(if moves { MOVES } else { UNREACHED }, band)
        }
    }

    /// What the command alone tells.
    fn commanded(&self, reason: &'static str, band: f64) -> Metrics {
        Metrics {
            control_peak_v: Ok(self.control_v.iter().map(|command| command.abs()).fold(0.0, f64::max)),
            control_rms_v: Ok(root_mean_square(self.times_s, self.control_v)),
            ..Metrics::none(reason, band)
        }
    }

    fn open_loop(&self, band: f64) -> Metrics {
        let magnitudes: Vec<f64> = self.force_n.iter().map(|force| force.abs()).collect();
        Metrics { force_peak_n: Ok(peak(&magnitudes)), ..self.commanded(OPEN_LOOP, band) }
    }

    fn errors(&self) -> Vec<f64> {
        self.reference_n.iter().zip(self.force_n).map(|(reference, force)| reference - force).collect()
    }

    /// Where the reference stands still in the end.
    fn steady_error(&self) -> Measured {
        let errors = self.errors();
        let last = ((errors.len() as f64 * STEADY_SHARE) as usize).max(1);
        let before = self.reference_n.len().saturating_sub(last);
        if self.reference_n.get(before..).is_some_and(|end| end.windows(2).any(|pair| pair[0] != pair[1])) {
            return Err(MOVES);
        }
        Ok(errors.iter().rev().take(last).sum::<f64>() / last as f64)
    }
}

/// The largest value; between rows, that of the parabola through the three nearest.
fn peak(values: &[f64]) -> f64 {
    let largest = |best: (usize, f64), (row, value): (usize, &f64)| {
        if *value > best.1 { (row, *value) } else { best }
    };
    let (row, top) = values.iter().enumerate().fold((0, f64::NEG_INFINITY), largest);
    let neighbours = row.checked_sub(1).and_then(|before| values.get(before)).zip(values.get(row + 1));
    let Some((before, after)) = neighbours else { return top };
    let curvature = 2.0 * top - before - after;
    if curvature > 0.0 { top + (after - before) * (after - before) / (8.0 * curvature) } else { top }
}

/// By the trapezoid rule.
fn root_mean_square(times_s: &[f64], values: &[f64]) -> f64 {
    let spans = times_s.windows(2).zip(values.windows(2));
    let squares = spans.map(|(time, value)| match (time, value) {
        ([start, end], [one, other]) => 0.5 * (end - start) * (one * one + other * other),
        _ => 0.0,
    });
    let whole = times_s.last().zip(times_s.first()).map_or(0.0, |(last, first)| last - first);
    if whole > 0.0 { (squares.sum::<f64>() / whole).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable;

    use super::*;
    use crate::simulate::Record;

    fn metrics(record: &Record, window: Window, band: f64) -> Metrics {
        let whole = Seen {
            times_s: &record.times_s,
            force_n: &record.signal("force_n"),
            reference_n: &record.reference_n,
            control_v: &record.control_v,
        };
        metrics_seen(&whole, window, band)
    }

    /// A sine of amplitude 3 whose peak lies anywhere between two of 40 looks a period.
    #[test]
    fn a_peak_does_not_depend_on_where_the_looks_fall() {
        for shift in 0..20 {
            let phase = |row: i32| 0.157 * (f64::from(row) + 0.05 * f64::from(shift));
            let values: Vec<f64> = (0..20).map(|row| 3.0 * portable::sin(phase(row))).collect();
            assert!((peak(&values) - 3.0).abs() < 3e-4, "{}", peak(&values));
        }
        assert_eq!((peak(&[1.0, 2.0, 3.0]), peak(&[5.0])), (3.0, 5.0));
    }

    fn record(force: impl Fn(f64) -> f64, reference: impl Fn(f64) -> f64) -> Record {
        let times_s: Vec<f64> = (0..=4000).map(|row| 1e-3 * f64::from(row)).collect();
        let mut signals = vec![[0.0; phea_hydraulics::machine::SIGNALS.len()]; times_s.len()];
        for (row, time) in signals.iter_mut().zip(&times_s) {
            row[0] = force(*time);
        }
        let reference_n: Vec<f64> = times_s.iter().map(|time| reference(*time)).collect();
        let control_v = times_s.iter().map(|time| 2.0 * portable::sin(10.0 * time)).collect();
        Record {
            filtered_reference_n: reference_n.clone(),
            reference_n,
            control_v,
            signals,
            of_loop: Vec::new(),
            times_s,
            ..Record::default()
        }
    }

    #[test]
    fn a_first_order_step_settles_after_the_logarithm_of_the_band() {
        let force =
            |time: f64| if time < 1.0 { 0.0 } else { -500.0 * (1.0 - portable::exp(-(time - 1.0) / 0.1)) };
        let record = record(force, |time| if time < 1.0 { 0.0 } else { -500.0 });
        let cause = Cause::ReferenceStep { from_n: 0.0, to_n: -500.0 };
        let found = metrics(&record, Window { cause, start_s: 1.0, end_s: 4.0 }, 1.0);
        assert_eq!((found.overshoot_percent, found.disturbance_peak_n), (Ok(0.0), Err(NO_MOTION)));
        // ORIGIN: analytic, 0.1 ln 100
        assert!((found.settling_time_s.unwrap() - 0.1 * portable::ln(100.0)).abs() < 1e-5);
        // ORIGIN: analytic, 0.1 (ln 10 - ln (10/9)) = 0.1 ln 9
        assert!((found.rise_time_s.unwrap() - 0.1 * portable::ln(9.0)).abs() < 1e-5);
        assert!(found.steady_state_error_n.unwrap().abs() < 1e-9);
        assert!((found.control_peak_v.unwrap() - 2.0).abs() < 1e-4);
        let short = metrics(&record, Window { cause, start_s: 1.0, end_s: 1.2 }, 1.0);
        assert_eq!((short.rise_time_s, short.settling_time_s), (Err(NOT_REACHED), Err(NOT_SETTLED)));
        // where half of the step is there already, nobody sees it rise
        let half = Cause::ReferenceStep { from_n: 500.0, to_n: -500.0 };
        let begun = metrics(&record, Window { cause: half, start_s: 1.0, end_s: 4.0 }, 1.0);
        assert_eq!(begun.rise_time_s, Err(BEGUN_BEYOND));
        // three seconds are 4.77 periods of the command: its mean square is 2 up to a twentieth
        assert!((found.control_rms_v.unwrap() - 2.0_f64.sqrt()).abs() < 0.05);
    }

    #[test]
    fn a_disturbance_is_measured_against_the_reference_and_a_run_that_ends_early_says_so() {
        let bump = |time: f64| {
            if time < 2.0 { 0.0 } else { 80.0 * (time - 2.0) * portable::exp(-(time - 2.0) / 0.2) }
        };
        let record = record(|time| 1000.0 + bump(time), |_| 1000.0);
        let window = Window { cause: Cause::LoadMotion, start_s: 2.0, end_s: 4.0 };
        let found = metrics(&record, window, 0.1);
        // ORIGIN: analytic, 80 t exp(-t/0.2) is largest at t = 0.2: 16/e
        assert!((found.disturbance_peak_n.unwrap() - 16.0 * portable::exp(-1.0)).abs() < 1e-6);
        let settling = found.settling_time_s.unwrap();
        assert!((bump(2.0 + settling) - 1.0).abs() < 1e-3 && settling > 0.2);
        let late = metrics(&record, Window { end_s: 9.0, ..window }, 0.1);
        assert_eq!((late.settling_time_s, late.disturbance_peak_n.is_ok()), (Err(UNREACHED), true));
        let never = metrics(&record, Window { start_s: 5.0, end_s: 6.0, ..window }, 0.1);
        assert_eq!(never, Metrics::none(UNREACHED, 0.1));
    }
}
