//! Sizing, operating point, uncertainty, scenarios and campaign.

use std::collections::BTreeSet;

use super::input_signal::signals;
use super::linear_loop::conjugates;
use super::measured::measured;
use super::{Check, adjustment, linear_parameter};
use crate::{
    Campaign, DELAY_PATH, DeclaredActuator, DeclaredPlant, DeclaredSizing, Distribution, Formula, InputUnit,
    LINEAR_PARAMETERS, LinearParameter, Load, Project, Scenario, Start, Uncertain,
};
use phea_dynamics::uncertain_plant::Spacing;
use phea_quantity::significant;
use phea_quantity::spelling::nearest;
use phea_quantity::{self as quantity, RATIO};

/// Largest number of rows of all scenarios together: four gigabytes of tables.
const MAXIMUM_ROWS: f64 = 1e7;
/// Output step below which the step is the cause of too many rows, otherwise the duration, s.
const ORDINARY_STEP: f64 = 1e-3;

/// Checks tables that only a project with an actuator may have.
pub(super) fn with_actuator(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    if let Some(wanted) = &project.sizing {
        sizing(wanted, check);
    }
    operating_point(project, actuator, check);
    rows(&project.scenarios, check);
    let mut names = BTreeSet::new();
    for (index, scenario) in project.scenarios.iter().enumerate() {
        let path = format!("scenario[{index}]");
        one_scenario(scenario, actuator, &path, check);
        if !names.insert(&scenario.name) {
            check.error(&format!("{path}.name"), format!("a second scenario called \"{}\"", scenario.name));
        }
    }
    if let Some(varied) = &project.campaign {
        campaign(project, varied, check);
    }
}

fn sizing(sizing: &DeclaredSizing, check: &mut Check<'_, '_>) {
    check.ascending("sizing.oil_velocity", sizing.oil_velocity);
    check.ascending("sizing.hose_length", sizing.hose_length);
    if let (Some(minimum), Some(maximum)) = (sizing.minimum_gain, sizing.maximum_gain) {
        check.in_order(["sizing.minimum_gain", "sizing.maximum_gain"], [minimum, maximum]);
    }
    if let Some(means) = &sizing.other_means {
        check.ascending("sizing.other_means.force_range", means.force_range);
    }
}

fn operating_point(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let point = &project.operating_point;
    let known = project.resolved_operating_point();
    let moved = known.load_force.is_some() || known.velocity.is_some();
    if known.command.is_some() && moved {
        let message =
            "a `command` determines its pressures, thesis (4.18): remove `load_force` and `velocity`";
        check.error_with_help(
            "operating_point.command",
            message,
            "leave out the `command`: it follows from the others",
        );
    }
    if known.load_pressure.is_some() && known.load_force.is_some() {
        let message = "both `load_pressure` and `load_force`: state only one of the two";
        check.error("operating_point.load_pressure", message);
    }
    if point.position.is_some_and(|position| actuator.is_beyond(position)) {
        check.error("operating_point.position", "`position` is beyond the stroke");
    }
    let available = actuator.supply.pressure - actuator.supply.tank_pressure;
    if point.load_pressure.is_some_and(|pressure| pressure.abs() >= available && available > 0.0) {
        let message = "`load_pressure` must be below supply less tank pressure";
        check.error("operating_point.load_pressure", message);
    }
    let full = actuator.valve.nominal_voltage;
    if point.command.is_some_and(|command| command.abs() > full && full > 0.0) {
        check.error("operating_point.command", "`command` is beyond the valve's `nominal_voltage`");
    }
}

/// Rejects the scenario that exceeds the limit of rows.
fn rows(scenarios: &[Scenario], check: &mut Check<'_, '_>) {
    let mut before = 0.0;
    for (index, scenario) in scenarios.iter().enumerate() {
        let rows = scenario.duration / scenario.output_step;
        if before <= MAXIMUM_ROWS && before + rows > MAXIMUM_ROWS {
            let name = if scenario.output_step < ORDINARY_STEP { "output_step" } else { "duration" };
            let message = format!(
                "`duration` over `output_step` asks for {} rows; all scenarios together may have {MAXIMUM_ROWS}",
                significant(rows, 3)
            );
            check.error(&format!("scenario[{index}].{name}"), message);
        }
        before += rows;
    }
}

fn one_scenario(scenario: &Scenario, actuator: &DeclaredActuator, path: &str, check: &mut Check<'_, '_>) {
    if scenario.output_step > scenario.duration && scenario.duration > 0.0 {
        check.error(&format!("{path}.output_step"), "`output_step` is longer than `duration`");
    }
    if let Some(start) = scenario.start.as_ref().filter(|start| start.file.is_some()) {
        let stated = Start { file: None, ..start.clone() } != Start::default();
        if stated {
            let message = "a start from a `file` has every state already";
            check.error_with_help(&format!("{path}.start.file"), message, "state nothing else");
        }
    }
    let position = scenario.start.as_ref().and_then(|start| start.position);
    if position.is_some_and(|position| actuator.is_beyond(position)) {
        check.error(&format!("{path}.start.position"), "`position` is beyond the stroke");
    }
    signals(&scenario.reference, InputUnit::REFERENCE, [path, "reference"], scenario.duration, check);
    signals(&scenario.command, InputUnit::COMMAND, [path, "command"], scenario.duration, check);
    if scenario.is_open_loop() && !scenario.reference.is_empty() {
        let message = "a scenario with a `command` runs open loop: nothing follows its `reference`";
        check.error_with_help(&format!("{path}.command"), message, "give one of the two");
    }
    let (external, unit) = (&scenario.external_force, InputUnit::EXTERNAL_FORCE);
    signals(external, unit, [path, "external_force"], scenario.duration, check);
    if !external.is_empty() && actuator.load == Load::Prescribed && !check.is_unclear("load") {
        let message = "an `external_force` moves no load whose motion is prescribed";
        let help = "give [load] a model that moves: \"spring_mass_damper\" or \"wall\"";
        check.error_with_help(&format!("{path}.external_force"), message, help);
    }
    adjustment::input_schedule(scenario, actuator, path, check);
    measured(&scenario.measured, path, check);
    let begins = scenario.load_motion.as_ref().map_or(0.0, |motion| motion.start);
    if scenario.duration > 0.0 && begins > scenario.duration {
        check.warning(&format!("{path}.load_motion.start"), "the load begins to move after the end");
    }
}

fn campaign(project: &Project, campaign: &Campaign, check: &mut Check<'_, '_>) {
    if let Some(name) = &campaign.scenario
        && !project.scenarios.iter().any(|scenario| scenario.name == *name)
    {
        let names = || project.scenarios.iter().map(|scenario| scenario.name.as_str());
        let help = match nearest(name, names()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("there are: {}", names().collect::<Vec<_>>().join(", ")),
        };
        let message = format!("there is no scenario called \"{name}\"");
        check.error_with_help("campaign.scenario", message, help);
    }
    let varied: Vec<&str> = campaign.parameters.iter().map(|varied| varied.path.as_str()).collect();
    for varied_path in &varied {
        both_sides("campaign.parameters", "varied", varied_path, &varied, check);
    }
    for varied in &campaign.parameters {
        let path = format!("campaign.parameters.{}", varied.path);
        if ["spread", "minimum", "maximum"].iter().any(|part| check.refused(&format!("{path}.{part}"))) {
            continue;
        }
        match (varied.spread, varied.minimum, varied.maximum) {
            (Some(spread), None, None) if spread > 1.0 => {
                let percent = significant(100.0 * spread, 3);
                let message = format!(
                    "`spread` is {percent} % of the declared value to either side: draws change sign"
                );
                check.warning(&format!("{path}.spread"), message);
            }
            (Some(_), None, None) => {}
            (None, Some(low), Some(high)) if low < high => {
                let distribution = varied.distribution.unwrap_or(campaign.distribution);
                if distribution == Distribution::LogUniform && low <= 0.0 {
                    check.error(&path, "a log-uniform distribution needs a `minimum` above zero");
                }
            }
            (None, Some(low), Some(high)) if low > high => {
                let ends = ["minimum", "maximum"].map(|end| format!("{path}.{end}"));
                check.in_order([&ends[0], &ends[1]], [low, high]);
            }
            (None, Some(_), Some(_)) => check.error(&path, "`minimum` must be below `maximum`"),
            _ => check.error(&path, format!("`{}` takes `spread`, or `minimum` and `maximum`", varied.path)),
        }
        if varied.path.starts_with("operating_point.") {
            let message = format!(
                "`{}` is of the linear model, and the nonlinear simulation finds its own",
                varied.path
            );
            check.error_with_help(&path, message, "vary `start.position` and its like");
        }
        of_one_sensor(&varied.path, &path, check);
        if project.directions.iter().any(|direction| direction.name == varied.path) {
            let message = format!("a campaign draws the direction `{}` by itself", varied.path);
            check.error_with_help(&path, message, "leave it out");
        }
        if linear_parameter(&varied.path).is_some() {
            let message = format!("`{}` does not exist in the nonlinear simulation", varied.path);
            check.error_with_help(&path, message, "vary the physical numbers it depends on");
        }
    }
}

/// Rejects tables that need an actuator.
pub(super) fn without_actuator(project: &Project, check: &mut Check<'_, '_>) {
    let foreign = [
        ("sizing", project.sizing.is_some()),
        ("campaign", project.campaign.is_some()),
        ("scenario", !project.scenarios.is_empty()),
        ("operating_point", check.declared("operating_point")),
        ("linear", check.declared("linear")),
    ];
    let system = match (&project.plant, &project.family) {
        (Some(_), _) => "has a [plant]",
        (None, Some(family)) if !family.measured.is_empty() => "has measured plants",
        _ => return,
    };
    for (name, present) in foreign {
        if present {
            check.error(name, format!("[{name}] needs an actuator, but this project {system}"));
        }
    }
}

/// Checks tables that only a project with a plant may have.
pub(super) fn with_plant(project: &Project, plant: &DeclaredPlant, check: &mut Check<'_, '_>) {
    let formulas = plant.formulas();
    let used: Vec<&str> =
        formulas.iter().flat_map(|(_, formula)| formula.parameters()).map(|(name, _)| name).collect();
    let all_read = !formulas.iter().any(|(path, _)| check.refused(path));
    for uncertain in project.uncertainty.iter().filter(|_| all_read) {
        if !used.contains(&uncertain.name.as_str()) {
            let message = format!("`{}` does not occur in [plant]", uncertain.name);
            check.warning(&format!("uncertainty.{}", uncertain.name), message);
        }
    }
    // a missing formula is reported as such
    for (path, formula) in formulas {
        if check.declared(path) {
            nominal_formula(project, formula, path, check);
        }
    }
    let second = plant.disturbance.as_ref();
    for (table, rational) in [("plant", Some(&plant.transfer)), ("plant.disturbance", second)] {
        let Some(factors) = rational.and_then(|rational| rational.factors.as_ref()) else { continue };
        conjugates(&factors.zeros, &format!("{table}.zeros"), check);
        conjugates(&factors.poles, &format!("{table}.poles"), check);
    }
}

/// Checks that the formula has a value at the nominal plant.
fn nominal_formula(project: &Project, formula: &Formula, path: &str, check: &mut Check<'_, '_>) {
    let first = project.family.as_ref().and_then(|family| family.cases.first());
    let value = |name: &str| {
        let nominal = project.uncertainty.iter().find(|u| u.name == name).map(|u| u.nominal);
        let case = || first.and_then(|case| case.parameters.iter().find(|(known, _)| known == name));
        nominal.or_else(|| case().map(|(_, value)| *value))
    };
    let Ok(ratio) = formula.ratio::<f64>(&value) else { return };
    if ratio.denominator.len() > 1 {
        return check
            .error(path, format!("`{}` must be a polynomial: here `s` is divided by", super::last(path)));
    }
    let delay = path == DELAY_PATH;
    if ratio.numerator.iter().any(|c| !c.is_finite()) {
        check.error(path, "this has no value at the nominal parameters");
    } else if delay && ratio.numerator.iter().any(|c| *c < 0.0) {
        check.error(path, "this is negative at the nominal parameters");
    } else if !delay && ratio.numerator.iter().all(|c| *c == 0.0) {
        check.error(path, "this is zero at the nominal parameters");
    }
}

pub(super) fn uncertainty(project: &Project, check: &mut Check<'_, '_>) {
    let names: Vec<&str> = project.uncertainty.iter().map(|other| other.name.as_str()).collect();
    let numbers = project.system_numbers();
    for uncertain in &project.uncertainty {
        let path = format!("uncertainty.{}", uncertain.name);
        if project.directions.iter().any(|direction| direction.name == uncertain.name) {
            let message = format!("`{}` is a direction: its range is its `deviations`", uncertain.name);
            check.error(&path, message);
        }
        check.bounds(&path, [uncertain.minimum, uncertain.nominal, uncertain.maximum]);
        if uncertain.spacing == Spacing::Logarithmic && uncertain.minimum <= 0.0 {
            check.error(&format!("{path}.minimum"), "logarithmic spacing needs a `minimum` above zero");
        }
        if uncertain.points == 1 && uncertain.minimum < uncertain.maximum {
            check.error(
                &format!("{path}.points"),
                "one point cannot span a range: give `points` of 2 or more",
            );
        }
        if uncertain.name == "s" {
            check.error(&path, "`s` is the variable of transfer functions: give the parameter another name");
        }
        if uncertain.name == "z" && is_sampled(project) {
            let message = "`z` is the variable of sampled transfer functions, and this loop samples: give the parameter another name";
            check.error(&path, message);
        }
        of_one_sensor(&uncertain.name, &path, check);
        adjustment::uncertain(uncertain, project.actuator.as_ref(), check);
        depends(uncertain, project, check);
        both_sides("uncertainty", "uncertain", &uncertain.name, &names, check);
        stated_elsewhere(uncertain, project.number_among(&uncertain.name, &numbers), check);
    }
}

fn is_sampled(project: &Project) -> bool {
    let controller = project.controller.as_ref().and_then(|controller| controller.sample_time);
    controller.or(project.prefilter.as_ref().and_then(|prefilter| prefilter.sample_time)).is_some()
}

/// Rejects uncertain filter, delay and noise of the velocity sensor: they are those of one device,
/// of which no family has several.
pub(super) fn of_one_sensor(name: &str, path: &str, check: &mut Check<'_, '_>) {
    if name.starts_with("velocity_sensor.") && name != "velocity_sensor.gain_error" {
        let message =
            format!("`{name}` cannot vary: one velocity sensor is the same for all plants and runs");
        check.error_with_help(path, message, "its `gain_error` can vary");
    }
}

/// Rejects a number for both lines together with that for one line, which would be set twice.
fn both_sides(table: &str, how: &str, name: &str, all: &[&str], check: &mut Check<'_, '_>) {
    let Some(key) = name.strip_prefix("line.") else { return };
    for side in ["line.a", "line.b"] {
        let one = format!("{side}.{key}");
        if all.contains(&one.as_str()) {
            let message = format!("`{one}` is part of `{name}`: both cannot be {how}");
            check.error_with_help(&format!("{table}.{one}"), message, "list one of the two, or both sides");
        }
    }
}

/// Checks that the nominal value of a path equals the number that the project states there.
fn stated_elsewhere(uncertain: &Uncertain, stated: Option<f64>, check: &mut Check<'_, '_>) {
    let Some(stated) = stated else { return };
    if (stated - uncertain.nominal).abs() > 1e-9 * stated.abs() {
        let dimension = check.reader.named.get(&uncertain.name).map_or(&RATIO, |key| key.dimension);
        let [stated, nominal] =
            [stated, uncertain.nominal].map(|value| quantity::display(value, dimension, 6));
        let message = format!(
            "the project states {stated} for `{}`, not {nominal}: only the family has the latter as its nominal plant",
            uncertain.name
        );
        check.warning(&format!("uncertainty.{}.nominal", uncertain.name), message);
    }
}

/// Rejects a linear parameter together with a path from which it is derived, which would include
/// one uncertainty twice.
fn depends(uncertain: &Uncertain, project: &Project, check: &mut Check<'_, '_>) {
    let Some(parameter) = linear_parameter(&uncertain.name) else {
        return hidden(&uncertain.name, project, check);
    };
    for other in project.uncertain_numbers() {
        if parameter.follows_from(&other.name) {
            let message =
                format!("`{}` depends on `{}`: both cannot be uncertain", uncertain.name, other.name);
            let of_region = other
                .name
                .strip_prefix("operating_point.")
                .filter(|_| !project.uncertainty.iter().any(|declared| declared.name == other.name));
            let path = match of_region {
                Some(name) => format!("family.operating_region.{name}"),
                None => format!("uncertainty.{}", other.name),
            };
            check.error_with_help(&path, message, "list one of the two");
        }
    }
}

/// Warns about an uncertain path without effect, because `[linear]` states every linear parameter
/// that depends on it.
fn hidden(name: &str, project: &Project, check: &mut Check<'_, '_>) {
    let depends = |parameter: &&LinearParameter| parameter.follows_from(name);
    let mut reached = LINEAR_PARAMETERS.iter().filter(depends).peekable();
    if reached.peek().is_some() && reached.all(|parameter| project.linear.get(parameter.key.name).is_some()) {
        let message = format!("`{name}` does not reach the linear model: [linear] sets what it changes");
        check.warning(&format!("uncertainty.{name}"), message);
    }
}
