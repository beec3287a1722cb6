//! The inputs of a scenario, in sentences.

use crate::project::{Amplitudes, InputSignal, Multisine, Scenario};
use crate::quantity::{DisplayUnit, TIME, Units, display};

/// Digits of a number in a sentence.
const DIGITS: usize = 4;
/// Number of frequencies that are listed; if there are more, only the first and the last.
const LISTED: usize = 4;

/// The initial state and the inputs of a scenario, if these are more than steps of the reference;
/// `turns` is true if the load is driven through a linkage, otherwise it moves with the rod.
pub(super) fn sentences(scenario: &Scenario, units: Units, turns: bool) -> Vec<String> {
    let mut sentences = Vec::new();
    if let Some(file) = scenario.start.as_ref().and_then(|start| start.file.as_ref()) {
        sentences.push(format!("It goes on from the state in {file}."));
    }
    if scenario.reference.iter().any(|signal| signal.steps().is_empty()) {
        sentences.push(format!("The reference is {}.", parts(&scenario.reference, units.force)));
    }
    if scenario.is_open_loop() {
        let command = parts(&scenario.command, DisplayUnit::VOLT);
        sentences.push(format!("It runs open loop: no controller acts, and the command is {command}."));
    }
    if !scenario.external_force.is_empty() {
        let external = &scenario.external_force;
        sentences.push(match turns {
            false => {
                let force = units.motion.words().force;
                format!("An external {force} acts on the load: {}.", parts(external, units.force))
            }
            true => format!(
                "An external torque acts on the joint: {}.",
                parts(external, DisplayUnit::NEWTON_METRE)
            ),
        });
    }
    if !scenario.setting_change.is_empty() {
        let change = parts(&scenario.setting_change, DisplayUnit::ONE);
        sentences.push(format!("The setting of the accumulators moves from where it rests: {change}."));
    }
    sentences
}

/// The parts of an input, joined.
fn parts(signals: &[InputSignal], unit: DisplayUnit) -> String {
    let steps: Vec<String> = signals
        .iter()
        .flat_map(InputSignal::steps)
        .map(|(at, to)| format!("{} from {}", unit.short(to, DIGITS), display(at, &TIME, DIGITS)))
        .collect();
    let mut all = Vec::new();
    if !steps.is_empty() {
        all.push(format!("steps ({})", steps.join(", ")));
    }
    let others = signals.iter().filter(|signal| signal.steps().is_empty());
    all.extend(others.map(|signal| part(signal, unit)));
    all.join(", plus ")
}

fn part(signal: &InputSignal, unit: DisplayUnit) -> String {
    let number = |value: &f64| unit.short(*value, DIGITS);
    let time = |value: f64| display(value, &TIME, DIGITS);
    let what = match signal {
        InputSignal::Step { .. } | InputSignal::Steps { .. } => String::new(),
        InputSignal::Ramp { value, .. } => format!("a ramp by {}", number(value)),
        InputSignal::Sine { amplitude, frequency, .. } => {
            format!("a sine of {} at {}", number(amplitude), hertz(frequency))
        }
        InputSignal::Chirp { amplitude, frequency, final_frequency, .. } => {
            let band = [frequency, final_frequency].map(hertz).join(" to ");
            format!("a chirp of {} from {band}", number(amplitude))
        }
        InputSignal::Multisine(sines) => multisine(sines, unit),
        InputSignal::File { file, .. } => format!("the file {file}"),
    };
    let start = time(signal.begins_s());
    match signal.duration_s() {
        Some(duration) => format!("{what} from {start} for {}", time(duration)),
        None => format!("{what} from {start}"),
    }
}

fn hertz(value: &f64) -> String {
    DisplayUnit::HERTZ.text(*value, DIGITS)
}

fn multisine(sines: &Multisine, unit: DisplayUnit) -> String {
    let frequencies = match sines.frequencies.as_slice() {
        [first, .., last] if sines.frequencies.len() > LISTED => [first, last].map(hertz).join(" to "),
        few => few.iter().map(hertz).collect::<Vec<_>>().join(", "),
    };
    let amplitudes = match &sines.amplitudes {
        Amplitudes::Equal(amplitude) => format!(" of {} each", unit.short(*amplitude, DIGITS)),
        Amplitudes::Each(_) => String::new(),
    };
    let phases = if sines.phases.is_empty() { "Schroeder's phases" } else { "stated phases" };
    format!("a multisine of {} sines{amplitudes} at {frequencies} with {phases}", sines.frequencies.len())
}
