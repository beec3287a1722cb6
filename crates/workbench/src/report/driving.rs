//! What drives a scenario, in sentences.

use crate::project::{Scenario, Signal, SignalKind};
use crate::quantity::{Dimension, DisplayUnit, FORCE, TIME, VOLTAGE, display};

/// Digits of a number in a sentence.
const DIGITS: usize = 4;
/// Frequencies that are told one by one; of more, the first and the last.
const TOLD: usize = 4;

/// Where a scenario goes on from and what drives it, where that is more than steps of the reference.
pub(super) fn sentences(scenario: &Scenario) -> Vec<String> {
    let mut told = Vec::new();
    if let Some(file) = scenario.start.as_ref().and_then(|start| start.file.as_ref()) {
        told.push(format!("It goes on from the state in {file}."));
    }
    if scenario.reference.iter().any(|signal| signal.steps().is_empty()) {
        told.push(format!("The reference is {}.", parts(&scenario.reference, &FORCE)));
    }
    if scenario.is_open_loop() {
        let command = parts(&scenario.command, &VOLTAGE);
        told.push(format!("It runs open loop: no controller acts, and the command is {command}."));
    }
    if !scenario.external_force.is_empty() {
        told.push(format!(
            "From outside the load is pushed with {}.",
            parts(&scenario.external_force, &FORCE)
        ));
    }
    told
}

/// All parts, joined.
fn parts(signals: &[Signal], dimension: &'static Dimension) -> String {
    let steps: Vec<String> = signals
        .iter()
        .flat_map(Signal::steps)
        .map(|(at, to)| format!("{} from {}", display(to, dimension, DIGITS), display(at, &TIME, DIGITS)))
        .collect();
    let mut all = Vec::new();
    if !steps.is_empty() {
        all.push(format!("steps ({})", steps.join(", ")));
    }
    let others = signals.iter().filter(|signal| signal.steps().is_empty());
    all.extend(others.map(|signal| part(signal, dimension)));
    all.join(", plus ")
}

fn part(signal: &Signal, dimension: &'static Dimension) -> String {
    let number = |value: Option<f64>| display(value.unwrap_or(f64::NAN), dimension, DIGITS);
    let time = |value: f64| display(value, &TIME, DIGITS);
    let hertz = |value: Option<f64>| DisplayUnit::HERTZ.text(value.unwrap_or(f64::NAN), DIGITS);
    let what = match signal.kind {
        SignalKind::Step | SignalKind::Steps => String::new(),
        SignalKind::Ramp => format!("a ramp by {}", number(signal.value)),
        SignalKind::Sine => format!("a sine of {} at {}", number(signal.amplitude), hertz(signal.frequency)),
        SignalKind::Chirp => format!(
            "a chirp of {} from {} to {}",
            number(signal.amplitude),
            hertz(signal.frequency),
            hertz(signal.final_frequency)
        ),
        SignalKind::Multisine => multisine(signal, dimension),
        SignalKind::File => format!("the file {}", signal.file.as_deref().unwrap_or_default()),
    };
    let start = time(signal.begins_s());
    match signal.duration {
        Some(duration) => format!("{what} from {start} for {}", time(duration)),
        None => format!("{what} from {start}"),
    }
}

fn multisine(signal: &Signal, dimension: &'static Dimension) -> String {
    let hertz = |value: &f64| DisplayUnit::HERTZ.text(*value, DIGITS);
    let frequencies = match signal.frequencies.as_slice() {
        [first, .., last] if signal.frequencies.len() > TOLD => {
            format!("{} to {}", hertz(first), hertz(last))
        }
        few => few.iter().map(hertz).collect::<Vec<_>>().join(", "),
    };
    let amplitudes = match signal.amplitude {
        Some(amplitude) => format!(" of {} each", display(amplitude, dimension, DIGITS)),
        None => String::new(),
    };
    let phases = if signal.phases.is_empty() { "Schroeder's phases" } else { "stated phases" };
    format!("a multisine of {} sines{amplitudes} at {frequencies} with {phases}", signal.frequencies.len())
}
