//! Controller and plant family as scripts: text for Python, and for MATLAB and Octave.

mod matlab;
mod python;

use phea_dynamics::controller::{AntiWindup, Section};

use super::ExportedController;
use crate::answer::OutputFile;

/// The module for Python.
pub fn python(exported: &ExportedController) -> Vec<OutputFile> {
    let head = exported.head().join("\n").replace('\\', "/").replace("\"\"\"", "'''");
    let text = format!("\"\"\"{head}\n\"\"\"\n\n{}", python::module(exported));
    vec![OutputFile::new(format!("{}.py", exported.name), text)]
}

/// The script for MATLAB and Octave.
pub fn matlab(exported: &ExportedController) -> Vec<OutputFile> {
    let head: String =
        exported.head().iter().map(|line| format!("{}\n", format!("% {line}").trim_end())).collect();
    let text = format!("{head}\n{}", matlab::script(exported));
    vec![OutputFile::new(format!("{}.m", exported.name), text)]
}

/// Series of sections by name.
fn series(exported: &ExportedController) -> [(&'static str, &[Section]); 3] {
    let controller = &exported.deployed.controller;
    [
        ("prefilter", controller.prefilter_sections()),
        ("feedback", controller.feedback_sections()),
        ("inner", controller.inner_sections()),
    ]
}

/// Coefficients b0, b1, b2, 1, a1, a2 of a section.
fn row(section: &Section) -> [f64; 6] {
    let ([b0, b1, b2], [a1, a2]) = (section.numerator, section.denominator);
    [b0, b1, b2, 1.0, a1, a2]
}

/// Name of the anti-windup.
fn anti_windup(exported: &ExportedController) -> &'static str {
    match exported.deployed.controller.anti_windup() {
        AntiWindup::None => "none",
        AntiWindup::BackCalculation => "back_calculation",
        AntiWindup::Clamping => "clamping",
    }
}

/// A number with 17 significant digits, which every reader of numbers takes for the same bits.
fn number(value: f64) -> String {
    format!("{value:.16e}")
}

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(number).collect::<Vec<_>>().join(", ")
}
