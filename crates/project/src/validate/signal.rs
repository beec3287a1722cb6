//! Functions of time that a scenario asks for.

use super::Check;
use crate::{Signal, SignalKind, SignalUnit};

/// Most sines of a multisine.
const MOST_SINES: usize = 1000;

/// Every part of the signal under this key of a scenario that lasts so many seconds.
pub(super) fn signals(
    signals: &[Signal],
    unit: SignalUnit,
    [scenario, name]: [&str; 2],
    duration: f64,
    check: &mut Check<'_, '_>,
) {
    let path = format!("{scenario}.{name}");
    let single = signals.iter().filter(|signal| signal.kind == SignalKind::Step);
    let times: Vec<f64> = single.filter_map(|step| step.at).collect();
    check.increasing(&path, &times);
    if duration > 0.0 && times.last().is_some_and(|last| *last > duration) {
        check.warning(&path, format!("the last {name} step is after the end"));
    }
    for (index, signal) in signals.iter().enumerate() {
        let path = format!("{path}[{index}]");
        one_signal(signal, unit, &path, check);
        let single = signal.kind == SignalKind::Step;
        if !single && duration > 0.0 && signal.begins_s() > duration {
            check.warning(&path, format!("this {} begins after the end", signal.kind.name()));
        }
    }
}

fn one_signal(signal: &Signal, unit: SignalUnit, path: &str, check: &mut Check<'_, '_>) {
    if check.refused(&format!("{path}.kind")) {
        return;
    }
    let [needed, allowed] = signal.keys(unit);
    let kind = signal.kind.name();
    for (name, present) in signal.present(unit) {
        if needed.contains(&name) && !present {
            check.missing(path, name, format!("a {kind} needs `{name}`"));
        }
        if present && !needed.contains(&name) && !allowed.contains(&name) {
            check.error(&format!("{path}.{name}"), format!("`{name}` has no meaning for a {kind}"));
        }
    }
    check.increasing(&format!("{path}.times"), &signal.times);
    let both = !signal.times.is_empty() && !signal.values.is_empty();
    if both && signal.times.len() != signal.values.len() {
        let (times, values) = (signal.times.len(), signal.values.len());
        let message = format!("{times} `times` need as many `{}`, not {values}", unit.values);
        check.error(&format!("{path}.{}", unit.values), message);
    }
    if signal.kind == SignalKind::Multisine && !signal.frequencies.is_empty() {
        multisine(signal, path, check);
    }
}

fn multisine(signal: &Signal, path: &str, check: &mut Check<'_, '_>) {
    let stated = [signal.amplitude.is_some(), !signal.amplitudes.is_empty()];
    check.one_of(path, ["amplitude", "amplitudes"], stated);
    check.increasing(&format!("{path}.frequencies"), &signal.frequencies);
    let count = signal.frequencies.len();
    if count > MOST_SINES {
        let message = format!("{count} sines at once; {MOST_SINES} are held");
        check.error(&format!("{path}.frequencies"), message);
    }
    for (name, values) in [("amplitudes", &signal.amplitudes), ("phases", &signal.phases)] {
        if !values.is_empty() && values.len() != count {
            let message = format!("{count} `frequencies` need as many `{name}`, not {}", values.len());
            check.error(&format!("{path}.{name}"), message);
        }
    }
}
