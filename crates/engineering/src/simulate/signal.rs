//! Signals of a scenario as functions of time, and what in them begins a window.

use phea_dynamics::simulation::{Harmonic, Profile, ProfileError, schroeder_phases};

use super::SimulateError;
use super::motion_file::{self, Column};
use crate::project::{Project, Signal, SignalKind};
use crate::source::Source;

/// What begins in a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Beginning {
    /// It steps.
    Step {
        /// s.
        time_s: f64,
        /// Before.
        from: f64,
        /// From then on.
        to: f64,
    },
    /// A part of it begins to move.
    Motion {
        /// s.
        time_s: f64,
        /// What kind of part.
        kind: SignalKind,
    },
}

/// The sum of the parts. Single steps are one staircase: each holds until the next.
pub(super) fn profile(
    source: &dyn Source,
    project: &Project,
    scenario: &str,
    signals: &[Signal],
    column: Column,
) -> Result<Profile, SimulateError> {
    let named = |error: ProfileError| SimulateError::Profile { name: scenario.to_string(), error };
    let (single, others): (Vec<&Signal>, Vec<&Signal>) =
        signals.iter().partition(|signal| signal.kind == SignalKind::Step);
    let steps: Vec<(f64, f64)> = single.into_iter().flat_map(Signal::steps).collect();
    let mut parts = vec![Profile::steps(0.0, &steps).map_err(named)?];
    for signal in others {
        parts.push(
            match signal.kind {
                SignalKind::File => {
                    motion_file::signal(source, project, signal, column).map_err(SimulateError::Motion)?
                }
                _ => shape(signal),
            }
            .map_err(named)?,
        );
    }
    Ok(Profile::sum(&parts))
}

/// A validated signal has every number its kind needs; a missing one is refused as not finite.
fn shape(signal: &Signal) -> Result<Profile, ProfileError> {
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let (start_s, duration_s) = (signal.begins_s(), number(signal.duration));
    let (amplitude, frequency) = (number(signal.amplitude), number(signal.frequency));
    let ended = |profile: Profile| match signal.duration {
        Some(duration_s) => profile.held_from(start_s + duration_s),
        None => profile,
    };
    match signal.kind {
        SignalKind::Step | SignalKind::Steps => Profile::steps(0.0, &signal.steps()),
        SignalKind::Ramp => Profile::ramp(start_s, duration_s, number(signal.value)),
        SignalKind::Sine => Profile::sine(start_s, amplitude, frequency).map(ended),
        SignalKind::Chirp => {
            Profile::chirp(start_s, duration_s, amplitude, [frequency, number(signal.final_frequency)])
        }
        SignalKind::Multisine => Profile::multisine(start_s, &harmonics(signal)).map(ended),
        // a file has been read elsewhere
        SignalKind::File => Ok(Profile::constant(0.0)),
    }
}

/// Equal amplitudes and Schroeder's phases where none are stated.
fn harmonics(signal: &Signal) -> Vec<Harmonic> {
    let count = signal.frequencies.len();
    let amplitudes = match signal.amplitude {
        Some(amplitude) => vec![amplitude; count],
        None => signal.amplitudes.clone(),
    };
    let phases = if signal.phases.is_empty() { schroeder_phases(&amplitudes) } else { signal.phases.clone() };
    let each = signal.frequencies.iter().zip(amplitudes).zip(phases);
    each.map(|((&frequency_rad_per_s, amplitude), phase_rad)| Harmonic {
        amplitude,
        frequency_rad_per_s,
        phase_rad,
    })
    .collect()
}

/// What begins in the sum of these before the end. A step that changes nothing begins nothing.
pub(super) fn beginnings(signals: &[Signal], profile: &Profile, end_s: f64) -> Vec<Beginning> {
    let steps = signals.iter().flat_map(Signal::steps).map(|(time_s, _)| time_s);
    let step = |time_s: f64| {
        let (from, to) = (profile.value_before(time_s), profile.value(time_s));
        (from != to).then_some(Beginning::Step { time_s, from, to })
    };
    let moving = signals.iter().filter(|signal| signal.steps().is_empty());
    let motion = |signal: &Signal| Beginning::Motion { time_s: signal.begins_s(), kind: signal.kind };
    let all = steps.filter_map(step).chain(moving.map(motion));
    all.filter(|beginning| beginning.time_s() < end_s).collect()
}

impl Beginning {
    /// When, s.
    pub(super) fn time_s(&self) -> f64 {
        match *self {
            Beginning::Step { time_s, .. } | Beginning::Motion { time_s, .. } => time_s,
        }
    }
}
