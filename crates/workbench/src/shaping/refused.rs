//! Words for a change that cannot be made, as a finding in its text.

use phea_engineering::shaping::{Change, ChangeProblem, RefusedChange, ShapingError, solved_kinds};

use super::words::{element_words, pass_words};
use crate::project::{Findings, Place, RawFinding, Refusal};
use crate::spelling::nearest;

const EXAMPLE: &str = "for instance: lead through -6 dB, -130 deg at 20 rad/s";

/// The error of shaping; for a change that cannot be made, the refusal of its text.
pub(crate) fn with_text(error: ShapingError) -> ShapingError {
    match error {
        ShapingError::Change(refused) => ShapingError::Refused(refusal(&refused)),
        error => error,
    }
}

/// The refusal of a change, which shows its text.
fn refusal(refused: &RefusedChange) -> Refusal {
    let RefusedChange { requested, part, reason } = refused;
    let mut findings = Findings::default();
    let text = findings.add_text(&requested.option_with_text(), requested.text.as_str(), 0);
    let place = Place { text, start: part.start, end: part.end };
    let found = RawFinding::error(place, message(reason));
    findings.push(found.maybe_expected(expected(reason)).maybe_help(help(requested.change, reason)));
    findings.report()
}

fn message(reason: &ChangeProblem) -> String {
    match reason {
        ChangeProblem::Edit(error) => error.to_string(),
        ChangeProblem::Pass(error) => pass_words(error),
        ChangeProblem::Disabled => "this element is disabled".to_string(),
        ChangeProblem::NotMeasured => "the nominal plant was not measured there".to_string(),
        ChangeProblem::NotAnElement => "this is not an element".to_string(),
        ChangeProblem::NoEqualsSign => "there is no `=` in it".to_string(),
        ChangeProblem::NotANumberOfAnElement(number) | ChangeProblem::NoElement { number, .. } => {
            format!("there is no element `{number}`")
        }
        ChangeProblem::NoPoint => "it does not say `through` which point".to_string(),
        ChangeProblem::NoFrequency => "it does not say `at` which frequency".to_string(),
        ChangeProblem::NotSolved(kind) => format!("`{kind}` cannot be solved for"),
        ChangeProblem::WithoutNumber(kind) => format!("`{kind}` has no number that could be solved for"),
        ChangeProblem::NotUnderstood(text) => format!("`{text}` is not understood"),
        ChangeProblem::NotGiven { key, pattern } => {
            format!("`{key}` cannot be given for {}", element_words(*pattern))
        }
        ChangeProblem::NotACoordinate(text) => format!("`{text}` is not a coordinate of the chart"),
        ChangeProblem::CoordinateGivenTwice => "this coordinate is given twice".to_string(),
        ChangeProblem::NotANumber(text) => format!("`{text}` is not a number"),
        ChangeProblem::Frequency(error) => error.fault.to_string(),
    }
}

fn expected(reason: &ChangeProblem) -> Option<String> {
    match reason {
        ChangeProblem::NotSolved(_) | ChangeProblem::WithoutNumber(_) => {
            Some(format!("one of {}", solved_kinds().join(", ")))
        }
        ChangeProblem::Frequency(error) => error.expected.as_ref().map(ToString::to_string),
        _ => None,
    }
}

fn help(change: Change, reason: &ChangeProblem) -> Option<String> {
    match reason {
        ChangeProblem::Edit(_) | ChangeProblem::Pass(_) => None,
        ChangeProblem::Disabled => Some("enable it before it is solved for".to_string()),
        ChangeProblem::NotMeasured => Some("choose another frequency".to_string()),
        ChangeProblem::NotAnElement => Some(
            "an element is an inline table: { kind = \"lead\", zero_frequency = 5, pole_frequency = 50 }"
                .to_string(),
        ),
        ChangeProblem::NoEqualsSign => Some(match change {
            Change::Move => "for instance 3=1".to_string(),
            _ => "for instance 2={ kind = \"integrator\" }".to_string(),
        }),
        ChangeProblem::NotANumberOfAnElement(_) => Some("elements are counted from 1".to_string()),
        ChangeProblem::NoElement { count: 0, .. } => Some("there are no elements yet".to_string()),
        ChangeProblem::NoElement { count: 1, .. } => Some("there is one element".to_string()),
        ChangeProblem::NoElement { count, .. } => Some(format!("there are elements 1 to {count}")),
        ChangeProblem::NotSolved(kind) | ChangeProblem::WithoutNumber(kind) => {
            nearest(kind, solved_kinds()).map(|name| format!("did you mean `{name}`?"))
        }
        ChangeProblem::NotGiven { .. } => {
            Some("a notch takes `frequency` or `damping_ratio`, a roll_off `damping_ratio`".to_string())
        }
        ChangeProblem::NotACoordinate(_) => {
            Some("write a magnitude in dB, a phase in deg, or both".to_string())
        }
        ChangeProblem::NoPoint
        | ChangeProblem::NoFrequency
        | ChangeProblem::NotUnderstood(_)
        | ChangeProblem::CoordinateGivenTwice
        | ChangeProblem::NotANumber(_) => Some(EXAMPLE.to_string()),
        ChangeProblem::Frequency(error) => error.help.as_ref().map(ToString::to_string),
    }
}
