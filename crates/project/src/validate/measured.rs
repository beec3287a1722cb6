//! Table `[[scenario.measured]]`.

use super::Check;
use crate::MeasuredFile;
use phea_quantity::{self as quantity, Dimension, TIME};

/// Rejects invalid units, and signals that occur twice.
pub(super) fn measured(files: &[MeasuredFile], path: &str, check: &mut Check<'_, '_>) {
    for (number, declared) in files.iter().enumerate() {
        let path = format!("{path}.measured[{number}]");
        if declared.signals.is_empty() {
            check.missing(&path, "signals", "a measurement needs `signals`: which column is which");
        }
        match (&declared.time_column, &declared.time_unit) {
            (None, Some(_)) => {
                let message = "`time_unit` belongs to `time_column`, which is not stated";
                check.error(&format!("{path}.time_unit"), message);
            }
            (_, Some(written)) => unit(written, &TIME, &format!("{path}.time_unit"), check),
            (_, None) => {}
        }
        for (index, signal) in declared.signals.iter().enumerate() {
            let path = format!("{path}.signals[{index}]");
            if let Some(written) = &signal.unit {
                unit(written, signal.signal.dimension(), &format!("{path}.unit"), check);
            }
            if declared.signals.iter().take(index).any(|earlier| earlier.signal == signal.signal) {
                let message = format!("`{}` is there twice", signal.signal.name());
                check.error(&format!("{path}.signal"), message);
            }
        }
    }
}

fn unit(written: &str, dimension: &'static Dimension, path: &str, check: &mut Check<'_, '_>) {
    if let Err(error) = quantity::parse(&format!("1 {written}"), dimension) {
        let message = format!("`{written}` is not a unit of {}: {error}", dimension.name);
        check.error_with_help(path, message, format!("such as {}", dimension.units.join(", ")));
    }
}
