//! Table `[[identify.recording]]`.

use super::Check;
use crate::{
    Accuracy, IdentifiedUse, Identify, Project, RecordedColumn, RecordedLoop, RecordedTest, ResponseSignal,
    StaticTest, TestSignal,
};
use phea_quantity::{self as quantity, Dimension, RATIO};

/// Rejects files that occur twice, unsuitable units, and signals that a test does not have.
pub(super) fn identify(identify: &Identify, check: &mut Check<'_, '_>) {
    for (index, recorded) in identify.recordings.iter().enumerate() {
        let path = format!("identify.recording[{index}]");
        let earlier = identify.recordings.iter().take(index);
        if !recorded.file.is_empty() && earlier.into_iter().any(|earlier| earlier.file == recorded.file) {
            check.error(&format!("{path}.file"), format!("`{}` is there twice", recorded.file));
        }
        separator(recorded.separator.as_deref(), &path, check);
        columns(recorded, &path, check);
    }
    for (index, recorded) in identify.responses.iter().enumerate() {
        let path = format!("identify.response[{index}]");
        separator(recorded.separator.as_deref(), &path, check);
        for (signal, column) in ResponseSignal::ALL.into_iter().zip(&recorded.columns) {
            let path = format!("{path}.{}", signal.name());
            if let Some(column) = column {
                reversed(column, signal != ResponseSignal::Time, &path, check);
                accuracy(column, None, &path, check);
            }
            if let Some(unit) = column.as_ref().and_then(|column| column.unit.as_deref()) {
                unit_of(unit, signal.dimension(), &path, check);
            }
        }
    }
}

/// Checks that a test under the declared controller has one whose command follows only from the
/// force.
pub(super) fn controllers_of_tests(project: &Project, identify: &Identify, check: &mut Check<'_, '_>) {
    for (index, recorded) in identify.responses.iter().enumerate() {
        let path = format!("identify.response[{index}].controller");
        if recorded.recorded_controller.is_none() || check.refused("controller") {
            continue;
        }
        if recorded.recorded_loop == Some(RecordedLoop::Open) {
            check.error(&path, "no controller acts in an open loop: `loop` contradicts it");
        }
        let declared = project.controller.as_ref().filter(|controller| controller.has_law());
        let Some(declared) = declared else {
            let is_attempted = |key: &&str| check.declared(&format!("controller.{key}"));
            if ["numerator", "denominator", "gain", "elements"].iter().any(is_attempted) {
                continue;
            }
            let help = "state the transfer function of the test, with its `sample_time`, in [controller]";
            check.error_with_help(&path, "[controller] declares no transfer function", help);
            continue;
        };
        let others = [
            ("pressure_feedback", "the pressures of the chambers", declared.pressure_feedback.is_some()),
            (
                "load_velocity_feed_forward",
                "the velocity of the load",
                declared.load_velocity_feed_forward.is_some(),
            ),
            ("impedance", "the position of the load", declared.impedance.is_some()),
        ];
        for (key, signal, _) in others.into_iter().filter(|(_, _, is_stated)| *is_stated) {
            let message = format!(
                "with controller.{key} the command also follows {signal}, which the record does not have"
            );
            check.error_with_help(&path, message, "record the reference of the loop");
        }
    }
}

fn separator(stated: Option<&str>, path: &str, check: &mut Check<'_, '_>) {
    let is_sign = |text: &str| text.len() == 1 && text.is_ascii() && !text.contains(['"', '\n', '\r', '.']);
    if let Some(sign) = stated.filter(|sign| !is_sign(sign)) {
        let message = format!("`{sign}` cannot separate values: a separator is one sign of ASCII");
        check.error(&format!("{path}.separator"), message);
    }
}

/// Checks that values taken from recordings have recordings, and a valve to replace.
pub(super) fn in_use(project: &Project, identify: &Identify, check: &mut Check<'_, '_>) {
    let path = "identify.use";
    if identify.takes == IdentifiedUse::Nothing || check.refused("identify.recording") {
        return;
    }
    if identify.recordings.is_empty() {
        let help = "declare each file in a table [[identify.recording]]";
        check.error_with_help(path, "`use` takes numbers from recordings, and none is declared", help);
    }
    if project.actuator.is_none() && !check.has_table("valve") {
        let message = "`use` takes the place of numbers of [valve], which this project does not have";
        check.error(path, message);
    }
}

fn columns(recorded: &RecordedTest, path: &str, check: &mut Check<'_, '_>) {
    for signal in TestSignal::ALL {
        let Some(column) = recorded.column(signal) else { continue };
        let path = format!("{path}.{}", signal.name());
        let is_foreign = match recorded.test {
            Some(StaticTest::Metering) => signal == TestSignal::LeakFlow,
            Some(StaticTest::Leakage) => signal == TestSignal::Flow,
            Some(StaticTest::PressureGain) => matches!(signal, TestSignal::LeakFlow | TestSignal::Flow),
            None => false,
        };
        if let Some(test) = recorded.test.filter(|_| is_foreign) {
            check
                .error(&path, format!("a {} test has no `{}`", test.name().replace('_', " "), signal.name()));
        }
        let may_reverse = matches!(signal, TestSignal::Command | TestSignal::LeakFlow | TestSignal::Flow);
        reversed(column, may_reverse, &path, check);
        accuracy(column, (signal != TestSignal::Time).then_some(signal.dimension()), &path, check);
        let Some(unit) = &column.unit else { continue };
        let is_fraction = signal == TestSignal::Command && unit == "%";
        let dimension = if is_fraction { &RATIO } else { signal.dimension() };
        unit_of(unit, dimension, &path, check);
    }
}

/// Rejects reversed times, pressures and temperatures, which have one sign.
fn reversed(column: &RecordedColumn, may_reverse: bool, path: &str, check: &mut Check<'_, '_>) {
    if column.reversed && !may_reverse {
        let message = "only a command, a flow or a force can be reversed";
        let help = "where the columns of two ports are exchanged, name each by its `column`";
        check.error_with_help(&format!("{path}.reversed"), message, help);
    }
}

/// Checks that an accuracy can be read, and belongs to a signal whose errors are considered.
fn accuracy(column: &RecordedColumn, of: Option<&'static Dimension>, path: &str, check: &mut Check<'_, '_>) {
    let Some(text) = &column.accuracy else { return };
    let path = format!("{path}.accuracy");
    let Some(dimension) = of else {
        let help = "it widens the intervals of a valve's coefficients, for command, pressures, flows and temperature";
        check.error_with_help(&path, "no accuracy of this signal is counted", help);
        return;
    };
    let size = column.stated_accuracy(dimension).map(|stated| match stated {
        Accuracy::OfReading(size) | Accuracy::OfRange(size) => size,
    });
    if !size.is_some_and(|size| size.is_finite() && size >= 0.0) {
        let message = format!("`{text}` is not an accuracy of {}", dimension.name);
        let unit = dimension.units.first().copied().unwrap_or("%");
        check.error_with_help(
            &path,
            message,
            format!("such as \"0.5 %\", of its reading, or \"0.3 {unit}\""),
        );
    }
}

fn unit_of(unit: &str, dimension: &'static Dimension, path: &str, check: &mut Check<'_, '_>) {
    if let Err(error) = quantity::parse(&format!("1 {unit}"), dimension) {
        let message = format!("`{unit}` is not a unit of {}: {error}", dimension.name);
        let units: &[&str] = if dimension.units.is_empty() { &["%"] } else { dimension.units };
        check.error_with_help(&format!("{path}.unit"), message, format!("such as {}", units.join(", ")));
    }
}
