//! The function block of the controller.

use phea_dynamics::controller::{AntiWindup, Converter, Section};
use phea_machine::Deployed;

use super::FunctionBlock;
use super::statements::{Statements, literal};
use crate::export::{DeployedSignal, ExportedController};

/// Largest finite number of the type LREAL.
const LARGEST: &str = "1.7976931348623157E+308";
/// Beyond this magnitude every number is whole.
const WHOLE: &str = "4503599627370496.0";

/// Name of the input for a signal. Dialects reserve `Reference`.
pub(super) fn input(signal: DeployedSignal) -> &'static str {
    match signal {
        DeployedSignal::Reference => "SetPoint",
        DeployedSignal::Measurement => "Measured",
        DeployedSignal::Velocity => "Velocity",
        DeployedSignal::Pressure => "PressureSignal",
    }
}

/// A series of sections by the name of its states.
#[derive(Clone, Copy)]
struct Series<'a> {
    name: &'static str,
    sections: &'a [Section],
}

fn series(deployed: &Deployed) -> [Series<'_>; 3] {
    let controller = &deployed.controller;
    [
        Series { name: "Prefilter", sections: controller.prefilter_sections() },
        Series { name: "Feedback", sections: controller.feedback_sections() },
        Series { name: "Inner", sections: controller.inner_sections() },
    ]
}

/// Names of both states of a section.
fn states(series: &str, index: usize) -> [String; 2] {
    ["A", "B"].map(|state| format!("{series}{}{state}", index + 1))
}

/// The function block.
pub(super) fn block(exported: &ExportedController) -> FunctionBlock {
    let ExportedController { name, deployed, .. } = exported;
    let mut body = Statements::default();
    body.assign("Invalid", format_args!("NOT ({})", finite(&exported.signals())));
    body.when("Reset", |body| {
        for Series { name, sections } in series(deployed) {
            for state in (0..sections.len()).flat_map(|index| states(name, index)) {
                body.assign(state, "0.0");
            }
        }
        body.assign("LastCommand", "0.0");
    });
    let usable = format!("Hold AND (NOT Invalid) AND {}", between("HeldCommand"));
    body.when(usable, |body| hold(body, deployed));
    body.choose(
        "Enable AND (NOT Invalid)",
        |body| step(body, deployed),
        |body| {
            body.assign("Unlimited", "LastCommand");
            body.assign("Limited", "FALSE");
        },
    );
    body.assign("Command", "LastCommand");
    FunctionBlock { name: name.clone(), declaration: declaration(exported), statements: body.into_text() }
}

fn declaration(exported: &ExportedController) -> String {
    let ExportedController { name, deployed, .. } = exported;
    let mut text = Statements::default();
    text.line(format_args!("FUNCTION_BLOCK {name}"));
    let variable = |text: &mut Statements, name: &str, kind: &str, words: &str| {
        text.within(|text| text.line(format_args!("{name} : {kind}; (* {words} *)")));
    };
    text.line("VAR_INPUT");
    variable(&mut text, "Enable", "BOOL", "one sample, once in every sample time");
    variable(&mut text, "Reset", "BOOL", "while TRUE, state at rest before each sample");
    variable(
        &mut text,
        "Hold",
        "BOOL",
        "while TRUE, state at which the signals give HeldCommand, before each sample",
    );
    variable(&mut text, "HeldCommand", "LREAL", "command for Hold");
    for signal in exported.signals() {
        variable(&mut text, input(signal), "LREAL", &signal.meaning(exported.contract.motion));
    }
    text.line("END_VAR");
    text.line("VAR_OUTPUT");
    variable(&mut text, "Command", "LREAL", "command; the last one without Enable");
    variable(&mut text, "Unlimited", "LREAL", "command before its limit");
    variable(&mut text, "Limited", "BOOL", "TRUE while the limit acts");
    variable(
        &mut text,
        "Invalid",
        "BOOL",
        "TRUE if a signal is not a finite number: the state is unchanged, the command repeated",
    );
    text.line("END_VAR");
    text.line("VAR");
    text.within(|text| {
        let zero = |text: &mut Statements, name: &str| text.line(format_args!("{name} : LREAL := 0.0;"));
        let clamping = deployed.controller.anti_windup() == AntiWindup::Clamping;
        for Series { name, sections } in series(deployed) {
            for state in (0..sections.len()).flat_map(|index| states(name, index)) {
                zero(text, &state);
                if clamping && name == "Feedback" {
                    zero(text, &before(&state));
                }
            }
        }
        let others = ["LastCommand", "SignalValue", "ErrorValue", "SectionOutput", "AddedValue", "Continued"];
        let products = ["PartOne", "PartTwo", "Quotient", "Magnitude", "Nearest"];
        others.iter().chain(&products).for_each(|name| zero(text, name));
    });
    text.line("END_VAR");
    text.into_text()
}

fn before(state: &str) -> String {
    format!("Before{state}")
}

fn between(signal: &str) -> String {
    format!("({signal} >= -{LARGEST}) AND ({signal} <= {LARGEST})")
}

/// True for finite signals: no comparison with a value that is no number holds.
fn finite(signals: &[DeployedSignal]) -> String {
    signals.iter().map(|signal| between(input(*signal))).collect::<Vec<_>>().join(" AND ")
}

/// One operation of two values.
fn operation(body: &mut Statements, target: &str, left: &str, operator: char, right: &str) {
    body.assign(target, format_args!("{left} {operator} {right}"));
}

/// The difference of two products in `PartOne`.
fn difference_of_products(body: &mut Statements, [b, input]: [&str; 2], [a, output]: [&str; 2]) {
    operation(body, "PartOne", b, '*', input);
    operation(body, "PartTwo", a, '*', output);
    operation(body, "PartOne", "PartOne", '-', "PartTwo");
}

/// Next state of a section, once its output is known.
fn advance(
    body: &mut Statements,
    section: &Section,
    [first, second]: &[String; 2],
    [input, output]: [&str; 2],
) {
    let ([_, b1, b2], [a1, a2]) = (section.numerator.map(constant), section.denominator.map(constant));
    difference_of_products(body, [&b1, input], [&a1, output]);
    operation(body, first, "PartOne", '+', second);
    difference_of_products(body, [&b2, input], [&a2, output]);
    body.assign(second, "PartOne");
}

/// A constant in an expression.
fn constant(value: f64) -> String {
    match value.is_sign_negative() {
        true => format!("({})", literal(value)),
        false => literal(value),
    }
}

/// Output of a section in `SectionOutput`.
fn output(body: &mut Statements, section: &Section, [first, _]: &[String; 2], input: &str) {
    operation(body, "PartOne", &constant(section.numerator[0]), '*', input);
    operation(body, "SectionOutput", "PartOne", '+', first);
}

/// `SignalValue` after sections in series.
fn filtered(body: &mut Statements, series: Series<'_>, count: usize) {
    for (index, section) in series.sections.iter().take(count).enumerate() {
        let states = states(series.name, index);
        output(body, section, &states, "SignalValue");
        advance(body, section, &states, ["SignalValue", "SectionOutput"]);
        body.assign("SignalValue", "SectionOutput");
    }
}

/// `SignalValue` after sections in which nothing changes; one that integrates gives the wanted
/// output.
fn settled(body: &mut Statements, series: Series<'_>, wanted: &str) {
    for (index, section) in series.sections.iter().enumerate() {
        let [first, second] = states(series.name, index);
        match section.steady_gain() {
            Some(gain) => operation(body, "SectionOutput", &constant(gain), '*', "SignalValue"),
            None => body.assign("SectionOutput", wanted),
        }
        let ([_, b1, b2], [a1, a2]) = (section.numerator.map(constant), section.denominator.map(constant));
        difference_of_products(body, [&b2, "SignalValue"], [&a2, "SectionOutput"]);
        body.assign(&second, "PartOne");
        difference_of_products(body, [&b1, "SignalValue"], [&a1, "SectionOutput"]);
        operation(body, &first, "PartOne", '+', &second);
        body.assign("SignalValue", "SectionOutput");
    }
}

/// `SectionOutput` as the nearest multiple of a step, halves away from zero.
fn level(body: &mut Statements, value: &str, step: f64) {
    operation(body, "Quotient", value, '/', &constant(step));
    body.assign("Magnitude", "Quotient");
    body.when("Quotient < 0.0", |body| body.assign("Magnitude", "-Quotient"));
    body.assign("Nearest", "Magnitude");
    body.when(format_args!("Magnitude < {WHOLE}"), |body| {
        operation(body, "Nearest", "Magnitude", '+', WHOLE);
        operation(body, "Nearest", "Nearest", '-', WHOLE);
        operation(body, "PartOne", "Magnitude", '-', "Nearest");
        body.when("PartOne >= 0.5", |body| operation(body, "Nearest", "Nearest", '+', "1.0"));
        body.when("PartOne < -0.5", |body| operation(body, "Nearest", "Nearest", '-', "1.0"));
    });
    body.when("Quotient < 0.0", |body| body.assign("Nearest", "-Nearest"));
    operation(body, "SectionOutput", "Nearest", '*', &constant(step));
}

fn converted(body: &mut Statements, value: &str, converter: Converter) {
    level(body, value, converter.step());
    limited(body, "SectionOutput", converter.range());
}

fn limited(body: &mut Statements, variable: &str, [minimum, maximum]: [f64; 2]) {
    let (minimum, maximum) = (constant(minimum), constant(maximum));
    body.when(format_args!("{variable} < {minimum}"), |body| body.assign(variable, &minimum));
    body.when(format_args!("{variable} > {maximum}"), |body| body.assign(variable, &maximum));
}

/// `ErrorValue` from the filtered set point in `SignalValue`.
fn error(body: &mut Statements, deployed: &Deployed) {
    let measured = match deployed.measurement_converter {
        Some(converter) => {
            converted(body, "Measured", converter);
            "SectionOutput"
        }
        None => "Measured",
    };
    operation(body, "ErrorValue", "SignalValue", '-', measured);
}

/// `AddedValue` by the feedforward of the velocity; zero without one.
fn added(body: &mut Statements, deployed: &Deployed) {
    if deployed.feed_forward == 0.0 {
        body.assign("AddedValue", "0.0");
        return;
    }
    let velocity = match deployed.velocity_resolution > 0.0 {
        true => {
            level(body, "Velocity", deployed.velocity_resolution);
            "SectionOutput"
        }
        false => "Velocity",
    };
    operation(body, "AddedValue", &constant(deployed.feed_forward), '*', velocity);
}

/// State that holds a command.
fn hold(body: &mut Statements, deployed: &Deployed) {
    let [prefilter, feedback, inner] = series(deployed);
    body.assign("SignalValue", "SetPoint");
    settled(body, prefilter, "0.0");
    error(body, deployed);
    body.assign("Continued", "HeldCommand");
    if deployed.controller.reads_inner() {
        body.assign("SignalValue", "PressureSignal");
        settled(body, inner, "0.0");
        operation(body, "Continued", "Continued", '+', "SignalValue");
    }
    if deployed.feed_forward != 0.0 {
        added(body, deployed);
        operation(body, "Continued", "Continued", '-', "AddedValue");
    }
    body.assign("SignalValue", "ErrorValue");
    settled(body, feedback, "Continued");
    body.assign("LastCommand", "HeldCommand");
}

/// One sample.
fn step(body: &mut Statements, deployed: &Deployed) {
    let [prefilter, feedback, inner] = series(deployed);
    body.comment("prefilter");
    body.assign("SignalValue", "SetPoint");
    filtered(body, prefilter, prefilter.sections.len());
    error(body, deployed);
    added(body, deployed);
    if deployed.controller.reads_inner() {
        body.comment("pressure feedback");
        body.assign("SignalValue", "PressureSignal");
        filtered(body, inner, inner.sections.len());
        operation(body, "AddedValue", "AddedValue", '-', "SignalValue");
    }
    body.comment("feedback");
    last_sections(body, deployed, feedback);
}

/// The feedback compensator with the limit of the command.
fn last_sections(body: &mut Statements, deployed: &Deployed, feedback: Series<'_>) {
    let controller = &deployed.controller;
    let all: Vec<String> =
        (0..feedback.sections.len()).flat_map(|index| states(feedback.name, index)).collect();
    let clamping = controller.anti_windup() == AntiWindup::Clamping;
    if clamping {
        all.iter().for_each(|state| body.assign(before(state), state));
    }
    body.assign("SignalValue", "ErrorValue");
    let last = feedback.sections.len().saturating_sub(1);
    filtered(body, feedback, last);
    let Some(section) = feedback.sections.get(last) else { return };
    let own = states(feedback.name, last);
    output(body, section, &own, "SignalValue");
    operation(body, "Unlimited", "SectionOutput", '+', "AddedValue");
    body.assign("LastCommand", "Unlimited");
    let limit = controller.command_limit();
    if limit.is_finite() {
        limited(body, "LastCommand", [-limit, limit]);
    }
    body.assign("Limited", "LastCommand <> Unlimited");
    body.assign("Continued", "SectionOutput");
    if controller.anti_windup() == AntiWindup::BackCalculation {
        body.when("Limited", |body| operation(body, "Continued", "LastCommand", '-', "AddedValue"));
    }
    advance(body, section, &own, ["SignalValue", "Continued"]);
    if clamping {
        operation(body, "PartOne", "Unlimited", '*', "ErrorValue");
        body.when("Limited AND (PartOne > 0.0)", |body| {
            all.iter().for_each(|state| body.assign(state, before(state)));
        });
    }
    if let Some(converter) = deployed.command_converter {
        converted(body, "LastCommand", converter);
        body.assign("LastCommand", "SectionOutput");
    }
}
