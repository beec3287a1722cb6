//! The chapter on the specifications of the loop, in words and formulae, with the response of the
//! tracking limits in time and the margins that the limits guarantee.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;
use phea_qft::specification::{
    GuaranteedMargins, Limit, LimitOrder, Requirement, Specification, guaranteed_margins, tracking_spread,
};

use super::chapter::Chapter;
use crate::answer::significant;
use crate::audit::{closed_loop_symbol, meaning};
use crate::document::{Cell, Document, StatusMark, Table};
use crate::error::CommandError;
use crate::project::Project;
use crate::quantity::{DisplayUnit, RATIO, display};
use crate::robust::RobustProblem;
use crate::simulate::{RequiredSteps, TimeRequirement, required_words};
use crate::specification::{
    SpecificationError, name_words, requirement_sentence, requirements_in_time, stated,
};
use crate::verdict_words::{frequency_number, frequency_words};

pub(super) fn chapter(project: &Project, problem: &RobustProblem) -> Result<Chapter, CommandError> {
    let specifications = &problem.specifications;
    let row = |(index, one)| row(problem.number_of(index), name_words(problem.named(index)), one);
    let heads = ["", "specification", "demand", "where it must hold", "design frequencies (rad/s)"];
    let requirements_in_time = requirements_in_time(project)?;
    let margins = margins(problem)?;
    let mut out = Document::default();
    out.explanation("The requirements on the closed loop of every plant. L is the open loop; F, G and P are prefilter, controller and plant.");
    let mut rows = Table::new(heads).with(specifications.iter().enumerate().map(row));
    let steps = problem.in_time.iter().filter(|one| one.limits.is_none());
    steps.for_each(|one| rows.row(step_row(one, project.units.force)));
    out.table(rows);
    for (index, specification) in specifications.iter().enumerate() {
        spread(&mut out, &stated(problem.named(index)), specification);
    }
    if !requirements_in_time.is_empty() {
        out.heading("Tracking limits in time");
        out.marked(
            requirements_in_time
                .iter()
                .map(|requirement| (Some(requirement.is_met().into()), requirement_sentence(requirement))),
        );
    }
    if !margins.is_empty() {
        out.heading("Margins that the limits guarantee");
        out.sentences(margins);
    }
    Ok(Chapter::of("specifications", "Specifications", out))
}

fn row(number: Option<usize>, name: &str, specification: &Specification) -> [Cell; 5] {
    let requirement = &specification.requirement;
    let band = match specification.band_rad_per_s {
        [0.0, f64::INFINITY] => "every frequency".to_string(),
        [from, to] => format!("{} to {} rad/s", frequency_number(from), frequency_number(to)),
    };
    let frequencies: Vec<String> =
        specification.frequencies_rad_per_s.iter().map(|frequency| frequency_number(*frequency)).collect();
    [
        number.map_or_else(Cell::empty, Cell::count),
        format!("{name}: {}", meaning(requirement)).into(),
        Cell::Equation(demand(requirement)),
        band.into(),
        frequencies.join(", ").into(),
    ]
}

/// A required step, which limits no closed loop and has no design frequencies.
fn step_row(required: &TimeRequirement, unit: DisplayUnit) -> [Cell; 5] {
    let RequiredSteps { amplitude_n, initial_force_n } = required.steps;
    let from = initial_force_n.map_or(String::new(), |force_n| format!(" from {}", unit.text(force_n, 3)));
    let by = amplitude_n.map_or(String::new(), |size_n| format!(" by {}", unit.text(size_n, 3)));
    let on_rig = match required.steps.are_stated() {
        true => format!("; on the nonlinear rig the step{from}{by}"),
        false => String::new(),
    };
    [
        Cell::count(required.number),
        "step: the response to a step of the reference".into(),
        required_words(&required.step_limits).into(),
        format!("every plant{on_rig}").into(),
        Cell::Missing,
    ]
}

/// The title of a figure: `Specification 2, tracking`, or only the name of a specification that is
/// not in the file.
pub(super) fn titled(number: Option<usize>, name: &str) -> String {
    number.map_or_else(|| name.to_string(), |number| format!("Specification {number}, {name}"))
}

pub(super) fn demand(requirement: &Requirement) -> String {
    let (lower, upper) = requirement.limits();
    let above = lower.map_or(String::new(), |lower| format!("{} ≤ ", limit_text(lower)));
    format!("{above}{} ≤ {}", closed_loop_symbol(requirement), limit_text(upper))
}

fn limit_text(limit: &Limit) -> String {
    match limit {
        Limit::Constant(value) => number(*value),
        Limit::Rational(function) => format!("|{}|", function_text(function)),
        Limit::Table(table) => {
            let ends = [table.points().first(), table.points().last()];
            let [from, to] = ends.map(|point| point.map_or(String::new(), |point| number(point.0)));
            format!("table of {} points from {from} to {to} rad/s", table.points().len())
        }
    }
}

/// Digits of the numbers of a formula.
const DIGITS: usize = 5;

/// `1.3`, `7·10^{-11}`.
fn number(value: f64) -> String {
    let text = display(value, &RATIO, DIGITS);
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{mantissa}·10^{{{exponent}}}"),
        None => text,
    }
}

/// `28.213 (s + 75)/(s^2 + 73.6 s + 2116)`.
pub(super) fn function_text(function: &TransferFunction) -> String {
    let variable = if function.domain() == TimeDomain::Continuous { 's' } else { 'z' };
    let (zeros, poles) = (factors(function.zeros(), variable), factors(function.poles(), variable));
    let above = match (number(function.gain()), zeros.join(" ")) {
        (gain, zeros) if zeros.is_empty() => gain,
        (gain, zeros) if gain == "1" => zeros,
        (gain, zeros) => format!("{gain} {zeros}"),
    };
    match poles.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join(" ")),
    }
}

/// Real factors of a polynomial with these roots, which come with their conjugates.
fn factors(roots: &[Complex64], variable: char) -> Vec<String> {
    let term = |value: f64| {
        let sign = if value < 0.0 { '-' } else { '+' };
        (sign, number(value.abs()))
    };
    let factor = |root: &Complex64| {
        if root.im == 0.0 && root.re == 0.0 {
            return variable.to_string();
        }
        if root.im == 0.0 {
            let (sign, corner) = term(-root.re);
            return format!("({variable} {sign} {corner})");
        }
        let ((sign, middle), square) = (term(-2.0 * root.re), number(root.norm_sqr()));
        if root.re == 0.0 {
            format!("({variable}^2 + {square})")
        } else {
            format!("({variable}^2 {sign} {middle} {variable} + {square})")
        }
    };
    roots.iter().filter(|root| root.im >= 0.0).map(factor).collect()
}

/// Distance between the limits of tracking; empty for other kinds.
fn spread(out: &mut Document, name: &str, specification: &Specification) {
    let (Some(lower), upper) = specification.requirement.limits() else { return };
    let decibels = |value: f64| if value.abs() < 5e-4 { "0".to_string() } else { significant(value, 3) };
    match tracking_spread(lower, upper, specification.band_rad_per_s) {
        Ok(spread) => match spread.order {
            LimitOrder::Satisfied { least_db, frequency_rad_per_s } => out.explanation(format!(
                "The limits of {name} are apart by at least {} dB, {}, and by {} dB at the end of the band.",
                decibels(least_db),
                frequency_words(frequency_rad_per_s),
                decibels(spread.at_end_db)
            )),
            LimitOrder::Crossed { from_rad_per_s, excess_db, frequency_rad_per_s } => {
                let sentence = format!(
                    "No loop satisfies {name}: from {} rad/s on its lower limit is above its upper one, by {} dB {}",
                    frequency_number(from_rad_per_s),
                    decibels(excess_db),
                    frequency_words(frequency_rad_per_s)
                );
                out.verdict(StatusMark::Bad, sentence, vec![]);
            }
        },
        Err(reason) => out.explanation(format!("The limits of {name} are not compared: {reason}.")),
    }
}

/// A sentence for each constant limit on |L/(1+L)| or |1/(1+L)| that holds at every frequency.
fn margins(problem: &RobustProblem) -> Result<Vec<String>, SpecificationError> {
    let mut sentences = Vec::new();
    for (index, specification) in problem.specifications.iter().enumerate() {
        if specification.band_rad_per_s != [0.0, f64::INFINITY] {
            continue;
        }
        let found = guaranteed_margins(&specification.requirement);
        let number = problem.number_of(index).unwrap_or(index + 1);
        let refused = |reason| SpecificationError { number, key: "limit", reason };
        if let Some(margins) = found.map_err(|error| refused(error.into()))? {
            sentences.push(margin_sentence(&stated(problem.named(index)), &margins));
        }
    }
    Ok(sentences)
}

fn margin_sentence(name: &str, margins: &GuaranteedMargins) -> String {
    let factor = |value: f64| {
        format!("{} ({} dB)", significant(value, 3), significant(20.0 * portable::log10(value), 3))
    };
    let growth = match margins.gain_increase {
        f64::INFINITY => "without bound".to_string(),
        value => format!("by a factor of {}", factor(value)),
    };
    let fall = match margins.gain_reduction {
        0.0 => "to nothing".to_string(),
        value => format!("to a share of {}", factor(value)),
    };
    let phase = match margins.phase_rad {
        f64::INFINITY => "|L| is nowhere 1".to_string(),
        angle => format!("the phase margin is at least {}°", significant(angle.to_degrees(), 3)),
    };
    format!(
        "A stable loop that satisfies {name} stays stable while its gain grows {growth} or falls {fall}; {phase}, and L stays at least {} away from -1.",
        significant(margins.modulus, 3)
    )
}
