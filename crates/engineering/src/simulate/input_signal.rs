//! Signals of a scenario as functions of time, and the events in them that begin a window.

use phea_dynamics::simulation::{Harmonic, Profile, ProfileError, schroeder_phases};

use super::SimulateError;
use super::motion_file;
use crate::project::{InputSignal, Multisine, Project};
use crate::source::Source;
use crate::table::Measurand;

/// Beginning of an event in a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SignalOnset {
    /// Step of the signal.
    Step {
        /// Time of the step, s.
        time_s: f64,
        /// Value before the step.
        from: f64,
        /// Value after the step.
        to: f64,
    },
    /// Beginning of the motion of a part.
    Motion {
        /// Time of the beginning, s.
        time_s: f64,
        /// Kind of part, as written.
        kind: &'static str,
    },
}

/// Sum of the parts. Single steps form one staircase: each value holds until the next step.
pub(super) fn profile(
    source: &dyn Source,
    project: &Project,
    scenario: &str,
    signals: &[InputSignal],
    values: &'static Measurand,
) -> Result<Profile, SimulateError> {
    let named = |error: ProfileError| SimulateError::Profile { name: scenario.to_string(), error };
    let (single, others): (Vec<&InputSignal>, Vec<&InputSignal>) =
        signals.iter().partition(|signal| matches!(signal, InputSignal::Step { .. }));
    let steps: Vec<(f64, f64)> = single.into_iter().flat_map(InputSignal::steps).collect();
    let mut parts = vec![Profile::steps(0.0, &steps).map_err(named)?];
    for signal in others {
        parts.push(shape(source, project, signal, values)?.map_err(named)?);
    }
    Ok(Profile::sum(&parts))
}

fn shape(
    source: &dyn Source,
    project: &Project,
    signal: &InputSignal,
    values: &'static Measurand,
) -> Result<Result<Profile, ProfileError>, SimulateError> {
    let start_s = signal.begins_s();
    let ended = |profile: Profile| match signal.duration_s() {
        Some(duration_s) => profile.held_from(start_s + duration_s),
        None => profile,
    };
    Ok(match signal {
        InputSignal::Step { .. } | InputSignal::Steps { .. } => Profile::steps(0.0, &signal.steps()),
        InputSignal::Ramp { value, duration, .. } => Profile::ramp(start_s, *duration, *value),
        InputSignal::Sine { amplitude, frequency, .. } => {
            Profile::sine(start_s, *amplitude, *frequency).map(ended)
        }
        InputSignal::Chirp { duration, amplitude, frequency, final_frequency, .. } => {
            Profile::chirp(start_s, *duration, *amplitude, [*frequency, *final_frequency])
        }
        InputSignal::Multisine(sines) => Profile::multisine(start_s, &harmonics(sines)).map(ended),
        InputSignal::File { file, .. } => {
            motion_file::signal(source, project, file, start_s, values).map_err(SimulateError::Motion)?
        }
    })
}

/// Harmonics with Schroeder's phases if none are stated.
fn harmonics(sines: &Multisine) -> Vec<Harmonic> {
    let amplitudes = sines.amplitudes.of(sines.frequencies.len());
    let phases = if sines.phases.is_empty() { schroeder_phases(&amplitudes) } else { sines.phases.clone() };
    let each = sines.frequencies.iter().zip(amplitudes).zip(phases);
    each.map(|((&frequency_rad_per_s, amplitude), phase_rad)| Harmonic {
        amplitude,
        frequency_rad_per_s,
        phase_rad,
    })
    .collect()
}

/// Events in the sum of these signals before the end. A step that changes nothing is not an event.
pub(super) fn beginnings(signals: &[InputSignal], profile: &Profile, end_s: f64) -> Vec<SignalOnset> {
    let steps = signals.iter().flat_map(InputSignal::steps).map(|(time_s, _)| time_s);
    let step = |time_s: f64| {
        let (from, to) = (profile.value_before(time_s), profile.value(time_s));
        (from != to).then_some(SignalOnset::Step { time_s, from, to })
    };
    let moving = signals.iter().filter(|signal| signal.steps().is_empty());
    let motion =
        |signal: &InputSignal| SignalOnset::Motion { time_s: signal.begins_s(), kind: signal.kind() };
    let all = steps.filter_map(step).chain(moving.map(motion));
    all.filter(|beginning| beginning.time_s() < end_s).collect()
}

impl SignalOnset {
    /// Time of the event, s.
    pub(super) fn time_s(&self) -> f64 {
        match *self {
            SignalOnset::Step { time_s, .. } | SignalOnset::Motion { time_s, .. } => time_s,
        }
    }
}
