//! Averages over neighbouring rows, from which a search over all rows begins.

use phea_hydraulics::servovalve::{Supply, TestInput, WarmOil};

use super::recording::{RecordedSignal, Recording};
use phea_dynamics::order::median;

/// Approximate number of averages of a recording near null, and away from it, where leakage is
/// still curved: its curvature within an average counts with the fourth power of their length.
const NEAR: usize = 1500;
const OTHERS: usize = 2500;

/// Fraction of the greatest command within which a row is near null.
const NEAR_NULL: f64 = 0.1;

/// Ratio of the distance from the median to the median distance beyond which a value is an outlier.
const OUTLYING: f64 = 6.0;

/// A recording with one row for each block of neighbouring rows whose command moves in one
/// direction.
///
/// Averages of white noise determine the coefficients as well as all rows do; they only change the
/// curvature of a signal within a block, and its outliers.
pub(super) fn averaged(recording: &Recording) -> Recording {
    let blocks = blocks(recording);
    let mean = |values: &[f64], block: &std::ops::Range<usize>| {
        let own = values.get(block.clone()).unwrap_or_default();
        own.iter().sum::<f64>() / own.len().max(1) as f64
    };
    let signals = recording.signals.iter().map(|signal| RecordedSignal {
        kind: signal.kind,
        values: blocks.iter().map(|block| inner_mean(signal.values.get(block.clone())?)).collect(),
    });
    let memory = recording.inputs.first().map_or(0.0, |input| input.memory);
    let input = |block: &std::ops::Range<usize>| {
        let own = recording.inputs.get(block.clone()).unwrap_or_default();
        let mean = |of: fn(&TestInput) -> f64| own.iter().map(of).sum::<f64>() / own.len().max(1) as f64;
        TestInput {
            command: mean(|input| input.command),
            followed_command: mean(|input| input.followed_command),
            // a block begins where the command turns
            turn: own.first().and_then(|input| input.turn),
            supply: Supply {
                pressure: mean(|input| input.supply.pressure),
                tank_pressure: mean(|input| input.supply.tank_pressure),
            },
            load_pressure: mean(|input| input.load_pressure),
            oil: WarmOil {
                density_ratio: mean(|input| input.oil.density_ratio),
                viscosity_ratio: mean(|input| input.oil.viscosity_ratio),
            },
            memory,
            lag: mean(|input| input.lag),
        }
    };
    let these = |values: &Vec<f64>| blocks.iter().map(|block| mean(values, block)).collect();
    Recording {
        file: recording.file.clone(),
        circuit: recording.circuit,
        command_roughness: recording.command_roughness,
        times: these(&recording.times),
        inputs: blocks.iter().map(input).collect(),
        oil_temperature: recording.oil_temperature.as_ref().map(these),
        accuracies: recording.accuracies.clone(),
        signals: signals.collect(),
    }
}

/// Neighbouring rows that are averaged: fewer near null.
fn blocks(recording: &Recording) -> Vec<std::ops::Range<usize>> {
    let commands: Vec<f64> = recording.inputs.iter().map(|input| input.followed_command).collect();
    let bound = NEAR_NULL * commands.iter().fold(0.0, |most: f64, command| most.max(command.abs()));
    let is_near = |row: usize| commands.get(row).is_some_and(|command| command.abs() < bound);
    let near = (0..commands.len()).filter(|row| is_near(*row)).count();
    let lengths = [commands.len() / OTHERS, near / NEAR].map(|length| length.max(1));
    let turns: Vec<usize> = recording.branches().into_iter().map(|branch| branch.rows.start).collect();
    let mut blocks = Vec::new();
    let mut from = 0;
    for row in 0..commands.len() {
        let length = lengths[usize::from(is_near(from))];
        let turns = turns.binary_search(&row).is_ok();
        if row > from && (turns || row - from >= length || is_near(row) != is_near(from)) {
            blocks.push(from..row);
            from = row;
        }
    }
    blocks.push(from..commands.len());
    blocks
}

/// Mean of the values that are no outliers; absent if none was read.
fn inner_mean(values: &[Option<f64>]) -> Option<f64> {
    let read: Vec<f64> = values.iter().flatten().copied().collect();
    let middle = median(read.clone());
    let usual = median(read.iter().map(|value| (value - middle).abs()).collect());
    let inner = read.iter().filter(|value| (**value - middle).abs() <= OUTLYING * usual);
    let (sum, count) = inner.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then_some(sum / count)
}
