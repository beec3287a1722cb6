//! Table `[[specification]]`.

use super::Check;
use crate::{
    DeclaredLimit, DeclaredSpecification, Formula, MarginRequirement, Project, RequiredStep,
    ResponseRequirement, Variable,
};
use phea_dynamics::closed_loop::ClosedLoop;

pub(super) fn specifications(project: &Project, check: &mut Check<'_, '_>) {
    for (index, specification) in project.specifications.iter().enumerate() {
        let path = format!("specification[{index}]");
        match specification.closed_loop() {
            Some(kind) => one_specification(specification, kind, &path, check),
            None => required_step(&specification.step, &path, check),
        }
        let second_path = project.plant.as_ref().is_none_or(|plant| plant.disturbance.is_some());
        if specification.closed_loop() == Some(ClosedLoop::LoadMotion) && !second_path {
            check.error(&format!("specification[{index}].kind"), "\"load_motion\" needs [plant.disturbance]");
        }
    }
}

const STEP_KEYS: &[&str] = &[
    "overshoot_percent",
    "settling_time",
    "settling_band_percent",
    "rise_time",
    "amplitude",
    "initial_force",
];

fn required_step(step: &RequiredStep, path: &str, check: &mut Check<'_, '_>) {
    let because = "belongs to the limit of a closed loop, not to a step";
    refuse(&["limit", "upper", "lower", "frequencies", "band"], because, path, check);
    let required = [step.overshoot_percent, step.settling_time, step.rise_time];
    if required.iter().all(Option::is_none) {
        let message = "nothing is required of the step";
        let help = "state `overshoot_percent`, `settling_time` or `rise_time`";
        check.error_with_help(path, message, help);
    }
    if step.settling_time.is_none() {
        refuse(&["settling_band_percent"], "needs `settling_time`", path, check);
    }
    if step.amplitude == Some(0.0) {
        check.error(&format!("{path}.amplitude"), "a step of no size requires nothing");
    }
}

fn one_specification(
    specification: &DeclaredSpecification,
    kind: ClosedLoop,
    path: &str,
    check: &mut Check<'_, '_>,
) {
    refuse(STEP_KEYS, "belongs to `kind = \"step\"`, or into `upper` or `lower`", path, check);
    let limits =
        [("limit", &specification.limit), ("upper", &specification.upper), ("lower", &specification.lower)];
    let tracking = kind == ClosedLoop::Tracking;
    for (name, limit) in limits {
        let belongs = tracking != (name == "limit");
        let at = format!("{path}.{name}");
        if belongs && limit.is_none() {
            let kind = if tracking { "a tracking specification" } else { "a specification of this kind" };
            check.missing(path, name, format!("missing `{name}`: {kind} needs it"));
        }
        if !belongs && (limit.is_some() || check.declared(&at)) {
            let right = if tracking { "`upper` and `lower`" } else { "`limit`" };
            check.error(&at, format!("`{name}` does not belong here: this kind takes {right}"));
        }
        if let Some(limit) = limit.as_ref().filter(|_| belongs) {
            one_limit(limit, kind, name, &at, check);
        }
    }
    if let (Some(DeclaredLimit::Constant(lower)), Some(DeclaredLimit::Constant(upper))) =
        (&specification.lower, &specification.upper)
    {
        let paths = ["lower", "upper"].map(|key| format!("{path}.{key}"));
        check.in_order([&paths[0], &paths[1]], [*lower, *upper]);
    }
    frequencies(specification, path, check);
}

fn frequencies(specification: &DeclaredSpecification, path: &str, check: &mut Check<'_, '_>) {
    let at = format!("{path}.frequencies");
    if specification.frequencies.is_empty() {
        match check.declared(&at) {
            true => check.error(&at, "`frequencies` is empty"),
            false => check.missing(path, "frequencies", "missing `frequencies`: where bounds are drawn"),
        }
    }
    check.increasing(&at, &specification.frequencies);
    check.strictly_ascending(&format!("{path}.band"), specification.band);
}

fn one_limit(limit: &DeclaredLimit, kind: ClosedLoop, name: &str, path: &str, check: &mut Check<'_, '_>) {
    match limit {
        DeclaredLimit::Constant(_) => {}
        DeclaredLimit::Text(formula) => continuous(&[formula], path, check),
        DeclaredLimit::Rational(rational) => {
            continuous(&[&rational.numerator, &rational.denominator], path, check);
            refuse(&["values"], "needs `frequencies`", path, check);
        }
        DeclaredLimit::Table(table) if table.frequencies.is_empty() => nothing(path, check),
        DeclaredLimit::Table(table) => {
            if table.frequencies.len() != table.values.len() {
                let (points, values) = (table.frequencies.len(), table.values.len());
                check.error(path, format!("{points} frequencies but {values} values"));
            }
            check.increasing(&format!("{path}.frequencies"), &table.frequencies);
            let because = "does not belong to a limit given by a table";
            refuse(&[FUNCTION_KEYS, MARGIN_KEYS, RESPONSE_KEYS].concat(), because, path, check);
        }
        DeclaredLimit::Margins(requirement) => {
            let because = "does not belong to a limit given by margins";
            refuse(&[&["values"], FUNCTION_KEYS, RESPONSE_KEYS].concat(), because, path, check);
            margins(requirement, kind, path, check);
        }
        DeclaredLimit::Response(requirement) if kind == ClosedLoop::Tracking => {
            response(requirement, name, path, check)
        }
        DeclaredLimit::Response(_) => {
            check.error(path, "a requirement in time makes `upper` and `lower` of \"tracking\"")
        }
    }
}

/// Reports a limit without any of its forms, perhaps because a part of it was rejected.
fn nothing(path: &str, check: &mut Check<'_, '_>) {
    let found = ["values", "denominator"].iter().find(|name| check.declared(&format!("{path}.{name}")));
    let message = match found {
        Some(&"values") => "`values` need `frequencies`",
        Some(_) => "`denominator` needs `numerator`",
        None => "nothing is limited here",
    };
    let forms =
        "`numerator` and `denominator`, `frequencies` and `values`, margins, or a requirement in time";
    check.error_with_help(path, message, format!("a limit takes a number, a text, {forms}"));
}

const FUNCTION_KEYS: &[&str] = &["numerator", "denominator"];
const MARGIN_KEYS: &[&str] =
    &["gain_margin", "gain_reduction", "phase_margin", "modulus_margin", "delay_margin"];
const RESPONSE_KEYS: &[&str] =
    &["overshoot_percent", "settling_time", "settling_band_percent", "zero", "pole", "rule"];

/// Rejects keys that are present but should not be.
fn refuse(names: &[&str], because: &str, path: &str, check: &mut Check<'_, '_>) {
    for name in names {
        let at = format!("{path}.{name}");
        if check.declared(&at) {
            check.error(&at, format!("`{name}` {because}"));
        }
    }
}

fn continuous(formulas: &[&Formula], path: &str, check: &mut Check<'_, '_>) {
    if formulas.iter().any(|formula| formula.variable() == Some(Variable::Z)) {
        check.error(path, "a limit is written in `s`, not in `z`");
    }
}

fn margins(requirement: &MarginRequirement, kind: ClosedLoop, path: &str, check: &mut Check<'_, '_>) {
    let stability = kind == ClosedLoop::RobustStability;
    if !stability && kind != ClosedLoop::Sensitivity {
        return check.error(path, "margins are limits of \"robust_stability\" and \"sensitivity\" alone");
    }
    let Some(_) = requirement.delay_margin else { return };
    let at = format!("{path}.delay_margin");
    if !stability {
        check.error(&at, "`delay_margin` is a limit of \"robust_stability\" alone");
    }
    if *requirement
        != (MarginRequirement { delay_margin: requirement.delay_margin, ..MarginRequirement::default() })
    {
        let message = "`delay_margin` falls with frequency and cannot be joined with other margins";
        check.error_with_help(&at, message, "write a [[specification]] of its own for it");
    }
}

fn response(requirement: &ResponseRequirement, name: &str, path: &str, check: &mut Check<'_, '_>) {
    let upper = name == "upper";
    refuse(&["values"], "needs `frequencies`", path, check);
    let needed = [
        ("overshoot_percent", requirement.overshoot_percent.is_none() && upper),
        ("settling_time", requirement.settling_time.is_none()),
        ("settling_band_percent", requirement.settling_band_percent.is_none()),
    ];
    for (name, absent) in needed {
        if absent {
            check.missing(path, name, format!("a requirement in time needs `{name}`"));
        }
    }
    let foreign: &[&str] = if upper { &["pole"] } else { &["zero", "overshoot_percent"] };
    let other = if upper { "lower" } else { "upper" };
    refuse(foreign, &format!("belongs to `{other}`"), path, check);
    if let Some(function) = &requirement.function {
        continuous(&[&function.numerator, &function.denominator], path, check);
        let because = "has no meaning together with `numerator`, which is checked as it is";
        refuse(&["zero", "pole"], because, path, check);
        if requirement.rule.is_some() {
            refuse(&["rule"], because, path, check);
        }
    }
}
