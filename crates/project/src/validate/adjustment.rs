//! Motion of the setting of adjusted accumulators.

use super::Check;
use crate::{DeclaredActuator, DeclaredAdjustment, InputSignal, InputUnit, Scenario, Uncertain};
use phea_quantity::{self as quantity, TIME};

/// Checks the input schedule of the setting in a scenario.
pub(super) fn input_schedule(
    scenario: &Scenario,
    actuator: &DeclaredActuator,
    path: &str,
    check: &mut Check<'_, '_>,
) {
    let (signals, unit) = (&scenario.setting_change, InputUnit::SETTING_CHANGE);
    super::input_signal::signals(signals, unit, [path, "setting_change"], scenario.duration, check);
    if signals.is_empty() {
        return;
    }
    let place = format!("{path}.setting_change");
    let adjusted: Vec<DeclaredAdjustment> = actuator.adjustments().into_iter().flatten().collect();
    if adjusted.is_empty() {
        let message = "no accumulator at a chamber is adjusted: there is no setting to change";
        let help = "state [line.accumulator.adjustment], or leave out `setting_change`";
        return check.error_with_help(&place, message, help);
    }
    for rest in adjusted.iter().map(|one| one.setting.unwrap_or(0.0)) {
        leaves_its_way(signals, rest, &place, check);
    }
    let is_unclear = check.reader.unclear.iter().any(|table| table.ends_with(".adjustment"));
    let moves_gas = !is_unclear && adjusted.iter().any(|one| one.valve().is_none());
    let jumps = |signal: &InputSignal| match signal {
        InputSignal::Step { at, .. } => *at > 0.0,
        InputSignal::Steps { times, .. } => times.iter().any(|time| *time > 0.0),
        _ => false,
    };
    for (index, _) in signals.iter().enumerate().filter(|(_, signal)| moves_gas && jumps(signal)) {
        let message = "a step would add or take gas in no time";
        let help = "let the setting move in a time: `kind = \"ramp\"` with a `duration`";
        check.error_with_help(&format!("{place}[{index}]"), message, help);
    }
}

/// Warns about a setting that leaves the range from 0 to 1. Signals with only steps and ramps have
/// their extremes at a beginning or an end; for others a simulation reports it.
fn leaves_its_way(signals: &[InputSignal], rest: f64, place: &str, check: &mut Check<'_, '_>) {
    let schedules: Option<Vec<PartSchedule>> = signals.iter().map(PartSchedule::of).collect();
    let Some(schedules) = schedules else { return };
    let sum =
        |time: f64| rest + schedules.iter().map(|input_schedule| input_schedule.value(time)).sum::<f64>();
    let times = schedules.iter().flat_map(|input_schedule| &input_schedule.corners).map(|[time, _]| *time);
    let beyond = |time: &f64| !(-ROUNDING..=1.0 + ROUNDING).contains(&sum(*time));
    let Some(time) = times.filter(beyond).reduce(f64::min) else { return };
    let words = |value: f64| quantity::significant(value, 4);
    let message = format!(
        "the setting comes to {} at {}, and it stays from 0 to 1: it is `adjustment.setting`, {}, and the `change` of every signal",
        words(sum(time)),
        quantity::display(time, &TIME, 4),
        words(rest)
    );
    let index = schedules
        .iter()
        .position(|input_schedule| input_schedule.corners.iter().any(|[start, _]| *start == time))
        .unwrap_or(0);
    let help = "no simulation runs this scenario: one of them must be smaller";
    check.warning_with_help(&format!("{place}[{index}]"), message, help);
}

/// Rounding allowance of a setting.
const ROUNDING: f64 = 1e-9;

/// Signal of steps, or a ramp; zero before it begins.
struct PartSchedule {
    is_ramp: bool,
    /// Corners: times in s and values.
    corners: Vec<[f64; 2]>,
}

impl PartSchedule {
    fn of(signal: &InputSignal) -> Option<PartSchedule> {
        let (is_ramp, corners) = match signal {
            InputSignal::Step { at, value, .. } => (false, vec![[*at, *value]]),
            InputSignal::Steps { times, values } => {
                (false, times.iter().zip(values).map(|(time, value)| [*time, *value]).collect())
            }
            InputSignal::Ramp { value, start, duration } => {
                let start = start.unwrap_or(0.0);
                (true, vec![[start, 0.0], [start + duration, *value]])
            }
            _ => return None,
        };
        Some(PartSchedule { is_ramp, corners })
    }

    fn value(&self, time: f64) -> f64 {
        match self.corners.as_slice() {
            [[start, _], [end, last]] if self.is_ramp && (*start..*end).contains(&time) => {
                last * (time - start) / (end - start)
            }
            corners => {
                corners.iter().rev().find(|[start, _]| *start <= time).map_or(0.0, |[_, value]| *value)
            }
        }
    }
}

/// End of the path of a setting.
const SETTING: &str = "accumulator.adjustment.setting";

/// Checks that the setting of a valve opens in every plant of a family.
pub(super) fn uncertain(
    uncertain: &Uncertain,
    actuator: Option<&DeclaredActuator>,
    check: &mut Check<'_, '_>,
) {
    if !uncertain.name.ends_with(SETTING) {
        return;
    }
    let path = format!("uncertainty.{}", uncertain.name);
    let sides = actuator.map_or([None; 2], DeclaredActuator::adjustments);
    if uncertain.minimum == 0.0 && sides.into_iter().flatten().any(|one| one.valve().is_some()) {
        let message = "a `valve` that is shut takes its gas out of the plant: it is not the limit of plants with the gas in them";
        let help = "let the range begin above 0, and judge the shut valve as an alternative of its own with `setting = 0`";
        check.error_with_help(&format!("{path}.minimum"), message, help);
    }
}
