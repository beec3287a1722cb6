//! The running metrics of a window.

use phea_dynamics::simulation::Quartic;

use super::follower::LAST_PLACES;
use super::metrics::{Measured, Unmeasured, stays_settled};
use super::{Cause, Metrics, Window};

/// Fraction of a window, at its end, over which the steady-state error is averaged.
const STEADY_FRACTION: f64 = 0.1;
/// Fractions of the step between which the rise time is taken.
const RISE: [f64; 2] = [0.1, 0.9];
/// Change of an extreme that justifies no refinement, as a fraction of the largest deviation.
const WORTH: f64 = 1e-7;

/// An interval of time with all signals over it.
pub(super) struct Passed {
    pub(super) times_s: [f64; 2],
    pub(super) force: Quartic,
    /// `None` in an open loop.
    pub(super) reference: Option<Quartic>,
    pub(super) command: CommandStretch,
}

/// A command over an interval of time, V.
pub(super) enum CommandStretch {
    /// Command of the controller, limited.
    Wanted {
        wanted: Quartic,
        limit: f64,
    },
    Held(f64),
}

/// The running metrics of a window.
///
/// ```text
/// deviation    for a step of the reference: force minus its new value, in the direction of the step
///              for all else: reference minus force; in an open loop the force
/// ```
pub(super) struct Tally {
    pub(super) window: Window,
    band_percent: f64,
    /// Half the width of the band around the reference, N.
    width: f64,
    followed_until_s: f64,
    /// Deviation: initial, lowest and highest, N.
    first: f64,
    extremes: [f64; 2],
    /// Largest difference of force and reference, N.
    tracking_error: f64,
    /// Constant reference so far, N; true if it moved, and true if it did so in the last part.
    reference: Option<f64>,
    moves: bool,
    moves_late: bool,
    open_loop: bool,
    /// Times at which the force first reached each fraction of the step, s.
    reached_s: [Option<f64>; 2],
    /// Time at which the deviation last was outside the band, s; absent if it never was.
    outside_s: Option<f64>,
    ends_outside: bool,
    /// Integral of reference minus force over the last part, N s.
    late_error: f64,
    /// Peak of the command, V, and integral of its square, V^2 s.
    command_peak: f64,
    command_square: f64,
}

impl Tally {
    /// An empty record, with the reference at the end of the window, N; `None` in an open loop.
    pub(super) fn new(window: Window, band_percent: f64, last_reference: Option<f64>) -> Tally {
        let height = match window.cause {
            Cause::ReferenceStep { from_n, to_n } => to_n - from_n,
            _ => last_reference.unwrap_or(0.0),
        };
        Tally {
            window,
            band_percent,
            width: 0.01 * band_percent * height.abs(),
            followed_until_s: window.start_s,
            first: 0.0,
            extremes: [f64::INFINITY, f64::NEG_INFINITY],
            tracking_error: 0.0,
            reference: None,
            moves: false,
            moves_late: false,
            open_loop: last_reference.is_none(),
            reached_s: [None; 2],
            outside_s: None,
            ends_outside: false,
            late_error: 0.0,
            command_peak: 0.0,
            command_square: 0.0,
        }
    }

    fn deviation(&self, force: &Quartic, reference: Option<&Quartic>) -> Quartic {
        match (self.window.cause, reference) {
            (_, None) => *force,
            (Cause::ReferenceStep { from_n, to_n }, _) => {
                let towards = (to_n - from_n).signum();
                Quartic::constant(-towards * to_n).plus(towards, force)
            }
            (_, Some(reference)) => reference.plus(-1.0, force),
        }
    }

    /// Records an interval of time, between two fractions of it.
    pub(super) fn pass(&mut self, passed: &Passed, span: [f64; 2]) {
        let [start_s, end_s] = passed.times_s;
        let time_at = |part: f64| start_s + part * (end_s - start_s);
        let deviation = self.deviation(&passed.force, passed.reference.as_ref());
        if self.followed_until_s <= self.window.start_s {
            self.first = deviation.at(span[0]);
        }
        self.followed_until_s = if span[1] == 1.0 { end_s } else { self.window.end_s };
        let bounds = deviation.bounds();
        if bounds[0] < self.extremes[0] || bounds[1] > self.extremes[1] {
            let [low, high] = deviation.extremes(span);
            self.extremes = [self.extremes[0].min(low), self.extremes[1].max(high)];
        }
        if let Some(reference) = &passed.reference {
            self.rise(&deviation, bounds[1], span, time_at);
            self.settle(&deviation, bounds, span, time_at);
            self.track(reference, &passed.force, [start_s, end_s], span);
        }
        self.command(&passed.command, span, time_at(span[1]) - time_at(span[0]));
    }

    /// Records the reference, the deviation of the force from it, and its mean at the end.
    fn track(&mut self, reference: &Quartic, force: &Quartic, [start_s, end_s]: [f64; 2], span: [f64; 2]) {
        let [from_s, until_s] = span.map(|part| start_s + part * (end_s - start_s));
        let late_s = self.window.end_s - STEADY_FRACTION * (self.window.end_s - self.window.start_s);
        let Quartic([value, changes @ ..]) = reference;
        let changes = changes.iter().any(|change| *change != 0.0);
        let moves = changes || self.reference.is_some_and(|before| before != *value);
        self.reference = Some(reference.at(1.0));
        self.moves |= moves;
        self.moves_late |= moves && until_s > late_s;
        let error = reference.plus(-1.0, force);
        let [low, high] = error.bounds();
        if low.abs().max(high.abs()) > self.tracking_error {
            let [low, high] = error.extremes(span);
            self.tracking_error = self.tracking_error.max(low.abs()).max(high.abs());
        }
        if until_s > late_s {
            let from = span[0].max((late_s - start_s) / (end_s - start_s));
            self.late_error += error.mean([from, span[1]]) * (until_s - from_s.max(late_s));
        }
    }

    fn rise(&mut self, deviation: &Quartic, highest: f64, span: [f64; 2], time_at: impl Fn(f64) -> f64) {
        let Cause::ReferenceStep { from_n, to_n } = self.window.cause else { return };
        for (fraction, reached_s) in RISE.iter().zip(&mut self.reached_s) {
            let level = (fraction - 1.0) * (to_n - from_n).abs();
            if reached_s.is_none() && highest >= level {
                *reached_s = deviation.first_above(level, span).map(&time_at);
            }
        }
    }

    fn settle(
        &mut self,
        deviation: &Quartic,
        bounds: [f64; 2],
        span: [f64; 2],
        time_at: impl Fn(f64) -> f64,
    ) {
        let width = self.width;
        self.ends_outside = deviation.at(span[1]).abs() > width;
        if self.ends_outside || (-width <= bounds[0] && bounds[1] <= width) {
            // if it ends outside, the next interval decides
            if self.ends_outside {
                self.outside_s = Some(time_at(span[1]));
            }
            return;
        }
        let below = Quartic::constant(0.0).plus(-1.0, deviation);
        let last = [deviation, &below].into_iter().filter_map(|side| side.last_above(width, span));
        if let Some(part) = last.reduce(f64::max) {
            self.outside_s = Some(time_at(part));
        }
    }

    fn command(&mut self, command: &CommandStretch, span: [f64; 2], length_s: f64) {
        match command {
            CommandStretch::Held(value) => {
                self.command_peak = self.command_peak.max(value.abs());
                self.command_square += value * value * length_s;
            }
            CommandStretch::Wanted { wanted, limit } => {
                let [low, high] = wanted.bounds();
                if self.command_peak < *limit && low.abs().max(high.abs()) > self.command_peak {
                    let [low, high] = wanted.extremes(span);
                    self.command_peak = low.abs().max(high.abs()).min(*limit).max(self.command_peak);
                }
                self.command_square += wanted.mean_square_within(*limit, span) * length_s;
            }
        }
    }

    /// True if a step whose force is known only by a cubic may contain an extreme that counts, or
    /// leave the band.
    pub(super) fn needs_accurate_solution(&self, force: &Quartic, reference: Option<f64>) -> bool {
        let reference = reference.map(Quartic::constant);
        let [low, high] = self.deviation(force, reference.as_ref()).bounds();
        // the error of the cubic is less than its deviation from a straight line
        let [low, high] = [low - (high - low), high + (high - low)];
        let [lowest, highest] = self.extremes;
        let worth = WORTH * lowest.abs().max(highest.abs()).max(self.width);
        let one_sided = matches!(self.window.cause, Cause::ReferenceStep { .. });
        let falls = !one_sided && low < lowest - worth;
        let inside = -self.width <= low && high <= self.width;
        let outside = low > self.width || high < -self.width;
        high > highest + worth || falls || !(inside || outside)
    }

    /// Metrics of the window.
    pub(super) fn metrics(&self) -> Metrics {
        let Window { start_s, end_s, cause } = self.window;
        if self.followed_until_s <= start_s {
            return Metrics::none(Unmeasured::AfterEnd, self.band_percent);
        }
        let [lowest, highest] = self.extremes;
        let largest = highest.max(-lowest);
        let followed_s = self.followed_until_s - start_s;
        let commanded = |reason| Metrics {
            control_peak_v: Ok(self.command_peak),
            control_rms_v: Ok((self.command_square / followed_s).sqrt()),
            ..Metrics::none(reason, self.band_percent)
        };
        if self.open_loop {
            return Metrics { force_peak_n: Ok(largest), ..commanded(Unmeasured::OpenLoop) };
        }
        let whole = self.followed_until_s >= end_s * (1.0 - 2.0 * LAST_PLACES * f64::EPSILON);
        let at_end = |measured: Measured| if whole { measured } else { Err(Unmeasured::AfterEnd) };
        let steady = self.late_error / (STEADY_FRACTION * (end_s - start_s));
        let common = Metrics {
            force_peak_n: Err(Unmeasured::ReferenceGiven),
            tracking_error_peak_n: if self.moves {
                Ok(self.tracking_error)
            } else {
                Err(Unmeasured::ReferenceConstant)
            },
            steady_state_error_n: at_end(if self.moves_late {
                Err(Unmeasured::ReferenceMoves)
            } else {
                Ok(steady)
            }),
            disturbance_peak_n: Err(Unmeasured::NoMotion),
            ..commanded(if self.moves { Unmeasured::ReferenceMoves } else { Unmeasured::AfterEnd })
        };
        let settling_time_s = at_end(self.settling_time());
        match cause {
            Cause::ReferenceStep { .. } if self.moves => common,
            Cause::ReferenceStep { from_n, to_n } => Metrics {
                overshoot_percent: Ok(100.0 * (highest / (to_n - from_n).abs()).max(0.0)),
                rise_time_s: self.rise_time((to_n - from_n).abs(), whole),
                settling_time_s,
                ..common
            },
            Cause::ReferenceMotion { .. } | Cause::CommandStep { .. } | Cause::CommandMotion { .. } => common,
            Cause::LoadMotion | Cause::ExternalForce { .. } | Cause::SettingChange => Metrics {
                overshoot_percent: Err(Unmeasured::NoStep),
                rise_time_s: Err(Unmeasured::NoStep),
                settling_time_s,
                disturbance_peak_n: Ok(largest),
                ..common
            },
        }
    }

    fn rise_time(&self, height: f64, whole: bool) -> Measured {
        if self.first > (RISE[0] - 1.0) * height {
            return Err(Unmeasured::BegunBeyond);
        }
        match self.reached_s {
            [Some(from_s), Some(until_s)] => Ok(until_s - from_s),
            _ => Err(if whole { Unmeasured::NotReached } else { Unmeasured::AfterEnd }),
        }
    }

    fn settling_time(&self) -> Measured {
        match (self.window.cause, self.outside_s) {
            _ if self.moves => Err(Unmeasured::ReferenceMoves),
            (Cause::LoadMotion | Cause::ExternalForce { .. } | Cause::SettingChange, _)
                if self.width == 0.0 =>
            {
                Err(Unmeasured::ZeroReference)
            }
            _ if self.ends_outside => Err(Unmeasured::NotSettled),
            (_, outside_s) => {
                let settled_s = outside_s.map_or(0.0, |outside_s| outside_s - self.window.start_s);
                let window_s = self.window.end_s - self.window.start_s;
                if stays_settled(settled_s, window_s) { Ok(settled_s) } else { Err(Unmeasured::NotSettled) }
            }
        }
    }
}
