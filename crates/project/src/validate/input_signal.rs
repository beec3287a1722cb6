//! Functions of time of a scenario.

use super::Check;
use crate::{Amplitudes, InputSignal, InputUnit, Multisine};

/// Largest number of sines of a multisine.
const MOST_SINES: usize = 1000;

/// Checks every part of the signal under this key of a scenario with this duration in s.
pub(super) fn signals(
    signals: &[InputSignal],
    unit: InputUnit,
    [scenario, name]: [&str; 2],
    duration: f64,
    check: &mut Check<'_, '_>,
) {
    let path = format!("{scenario}.{name}");
    let mut times: Vec<f64> = Vec::new();
    for (index, signal) in signals.iter().enumerate() {
        let path = format!("{path}[{index}]");
        one_signal(signal, unit, &path, check);
        match signal {
            InputSignal::Step { at, .. } => {
                let stated = format!("{path}.at");
                times.extend(Some(at).filter(|_| check.declared(&stated) && !check.refused(&stated)));
            }
            _ if duration > 0.0 && signal.begins_s() > duration => {
                check.warning(&path, format!("this {} begins after the end", signal.kind()));
            }
            _ => {}
        }
    }
    check.increasing(&path, &times);
    if duration > 0.0 && times.last().is_some_and(|last| *last > duration) {
        check.warning(&path, format!("the last {name} step is after the end"));
    }
}

fn one_signal(signal: &InputSignal, unit: InputUnit, path: &str, check: &mut Check<'_, '_>) {
    match signal {
        InputSignal::Steps { times, values } => {
            check.increasing(&format!("{path}.times"), times);
            let both = !times.is_empty() && !values.is_empty();
            if both && times.len() != values.len() {
                let (times, values) = (times.len(), values.len());
                let message =
                    format!("{times} `times` need the same number of `{}`, not {values}", unit.values);
                check.error(&format!("{path}.{}", unit.values), message);
            }
        }
        InputSignal::Multisine(sines) if !sines.frequencies.is_empty() => multisine(sines, path, check),
        _ => {}
    }
}

fn multisine(sines: &Multisine, path: &str, check: &mut Check<'_, '_>) {
    check.increasing(&format!("{path}.frequencies"), &sines.frequencies);
    let count = sines.frequencies.len();
    if count > MOST_SINES {
        let message = format!("{count} sines at once; {MOST_SINES} are held");
        check.error(&format!("{path}.frequencies"), message);
    }
    let amplitudes = if let Amplitudes::Each(each) = &sines.amplitudes { each.as_slice() } else { &[] };
    for (name, values) in [("amplitudes", amplitudes), ("phases", sines.phases.as_slice())] {
        if !values.is_empty() && values.len() != count {
            let message =
                format!("{count} `frequencies` need the same number of `{name}`, not {}", values.len());
            check.error(&format!("{path}.{name}"), message);
        }
    }
}
