//! The module for Python.

use std::fmt::Write;

use phea_dynamics::controller::Converter;

use super::{anti_windup, number, numbers, row, series};
use crate::export::{ExportedController, VectorOperation};

/// Classes and functions behind the numbers.
const RUNTIME: &str = include_str!("runtime.py");

/// Numbers of a controller, then the classes and functions that use them.
pub(super) fn module(exported: &ExportedController) -> String {
    let deployed = &exported.deployed;
    let limit = deployed.controller.command_limit();
    let limit = if limit.is_finite() { number(limit) } else { "float(\"inf\")".to_string() };
    let signals: Vec<&str> = exported.signals().iter().map(|signal| signal.name()).collect();
    let mut text = format!(
        "from __future__ import annotations

import math
from typing import Any

SIGNALS = {signals:?}
SAMPLE_TIME_S = {}
COMMAND_LIMIT = {limit}
ANTI_WINDUP = {:?}
FEED_FORWARD = {}
VELOCITY_RESOLUTION = {}
# Step, least and greatest value.
MEASUREMENT_CONVERTER = {}
COMMAND_CONVERTER = {}
# Sections in series: b0, b1, b2, 1, a1, a2 in powers of 1/z, and the steady gain, or none.
",
        number(deployed.controller.sample_time_s()),
        anti_windup(exported),
        number(deployed.feed_forward),
        number(deployed.velocity_resolution),
        converter(deployed.measurement_converter),
        converter(deployed.command_converter),
    );
    for (series, sections) in series(exported) {
        let _ = writeln!(text, "{}: list[tuple[Any, ...]] = [", series.to_uppercase());
        for section in sections {
            let gain = section.steady_gain().map_or("None".to_string(), number);
            let _ = writeln!(text, "    ({}, {gain}),", numbers(row(section)));
        }
        text.push_str("]\n");
    }
    text.push_str(&vectors(exported));
    text.push_str(&family(exported));
    text + RUNTIME
}

fn converter(converter: Option<Converter>) -> String {
    converter.map_or("None".to_string(), |one| {
        let [minimum, maximum] = one.range();
        format!("({})", numbers([one.step(), minimum, maximum]))
    })
}

fn value(value: f64) -> String {
    match value.is_finite() {
        true => number(value),
        false => format!("float(\"{value}\")"),
    }
}

/// Test vectors: operation, signals, held command; command, before its limit, limited, invalid.
fn vectors(exported: &ExportedController) -> String {
    let mut text = "# Operation, signals, held command; command, the same before its limit, limited, invalid.\nVECTORS: list[tuple[Any, ...]] = [\n".to_string();
    for vector in &exported.vectors {
        let operation = match vector.operation {
            VectorOperation::Step => "step",
            VectorOperation::ResetAndStep => "reset",
            VectorOperation::HoldAndStep => "hold",
        };
        let signals = exported.signals();
        let read: Vec<String> = signals.iter().map(|signal| value(signal.value(&vector.signals))).collect();
        let executed = &vector.executed;
        let truth = |truth: bool| if truth { "True" } else { "False" };
        let _ = writeln!(
            text,
            "    (\"{operation}\", ({}), {}, {}, {}, {}, {}),",
            read.join(", "),
            value(vector.held_v),
            value(executed.command_v),
            value(executed.output.wanted),
            truth(executed.output.limited),
            truth(!executed.is_valid),
        );
    }
    text + "]\n"
}

/// Plants from command to measured quantity: values of the parameters, zeros, poles, gain, dead
/// time.
fn family(exported: &ExportedController) -> String {
    let mut text = format!(
        "# Plants of the family from command to measured quantity, without delay and sensor of the loop; the
# first is the nominal one: values of the parameters, zeros, poles, gain, dead time in s.
PARAMETERS: list[str] = {:?}
PLANTS: list[tuple[Any, ...]] = [\n",
        exported.parameters
    );
    let roots = |pairs: &[[f64; 2]]| {
        let one = |&[re, im]: &[f64; 2]| format!("complex({}, {})", number(re), number(im));
        pairs.iter().map(one).collect::<Vec<_>>().join(", ")
    };
    for plant in &exported.plants {
        let factors = &plant.factors;
        let _ = writeln!(
            text,
            "    ([{}], [{}], [{}], {}, {}),",
            numbers(plant.values.iter().copied()),
            roots(&factors.zeros),
            roots(&factors.poles),
            number(factors.gain),
            number(factors.dead_time_s),
        );
    }
    text + "]\n"
}
