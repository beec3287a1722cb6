//! Actuator: conditions of geometry and physics.

use super::{Check, adjustment, cross_port, line_motion};
use crate::{
    Component, DeclaredAccumulator, DeclaredActuator, DeclaredCylinder, DeclaredFriction, DeclaredLine,
    DeclaredLines, DeclaredPipe, DeclaredSupply, FrictionLaw, NullLeakage, Project, Pump, SupplyModel, Valve,
};
use phea_dynamics::portable;
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE as ATMOSPHERE;
use phea_hydraulics::servovalve::LeakageModel;
use phea_hydraulics::stroke::FURTHER_STAGES;
use phea_quantity::{self as quantity, DAMPING, LENGTH, PRESSURE, display};

pub(super) fn actuator(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    supply(actuator, check);
    valve(&actuator.valve, &actuator.supply, check);
    if actuator.motor.is_none() {
        cylinder(&actuator.cylinder, check);
    }
    if let Some(law) = actuator.friction() {
        friction(law, actuator.moving_part(), check);
    }
    lines(actuator, &actuator.line, check);
    cross_port::cross_port(actuator, check);
    cross_port::gas_valves_within_lines(actuator, check);
}

fn supply(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let supply = &actuator.supply;
    if supply.pressure > 0.0 && supply.tank_pressure >= supply.pressure {
        let at =
            if check.declared("supply.tank_pressure") { "supply.tank_pressure" } else { "supply.pressure" };
        check.error(at, "`tank_pressure` must be below `pressure`");
    }
    if let SupplyModel::PumpLimited(Pump { accumulator: Some(gas), .. }) = &supply.model
        && is_reached(gas, supply, ("supply.accumulator", "the pump never lets oil into it"), check)
    {
        pressure_ratio(gas, supply, "supply.accumulator.maximum_pressure_ratio", check);
    }
}

/// True if the supply's pressure is above the precharge of this gas; otherwise reports an error
/// with its consequence.
fn is_reached(
    gas: &DeclaredAccumulator,
    supply: &DeclaredSupply,
    (path, consequence): (&str, &str),
    check: &mut Check<'_, '_>,
) -> bool {
    let working = gas.working_precharge(ATMOSPHERE);
    let beyond = supply.pressure > 0.0 && working >= supply.pressure;
    if !beyond {
        return true;
    }
    let [precharge, pressure] =
        [working, supply.pressure].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
    let at = if gas.temperatures.is_some() { " at `working_temperature`" } else { "" };
    let message =
        format!("`precharge_pressure` is {precharge}{at} and the supply has {pressure}: {consequence}");
    let help = "the gas is in use only above its precharge: state one below the lowest pressure at which it is to work";
    check.error_with_help(&format!("{path}.precharge_pressure"), message, help);
    false
}

/// Checks the gas at a chamber: its precharge must be below the supply pressure.
fn accumulator(gas: &DeclaredAccumulator, supply: &DeclaredSupply, path: &str, check: &mut Check<'_, '_>) {
    if gas.thermal_time_constant.is_some() && check.declared(&format!("{path}.polytropic_exponent")) {
        let message = "`polytropic_exponent` and `thermal_time_constant` both describe the heat between gas and wall: state one of them";
        check.error(&format!("{path}.polytropic_exponent"), message);
    }
    if !is_reached(gas, supply, (path, "no chamber ever lets oil into this accumulator"), check) {
        return;
    }
    adjustment::adjustment(gas, supply, path, check);
    if check.refused(&format!("{path}.precharge_pressure")) {
        return;
    }
    // compressed most at its least precharge
    let [first, last] = gas.ends();
    let most = if last.precharge_pressure < first.precharge_pressure { last } else { first };
    pressure_ratio(&most, supply, &format!("{path}.maximum_pressure_ratio"), check);
}

/// Checks the ends of the ranges of a precharge: the supply must reach the highest, and must not
/// compress the lowest beyond the maker's limit.
pub(super) fn precharge_ranges(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let range_of = |name: &str| project.uncertainty.iter().find(|one| one.name == name);
    let most = range_of("supply.pressure").map_or(actuator.supply.pressure, |range| range.maximum);
    let supply = DeclaredSupply { pressure: most, ..actuator.supply.clone() };
    supply_falls_short(project, actuator, check);
    let sides = [("line.a", &actuator.line.a), ("line.b", &actuator.line.b)];
    let mut seen = vec![];
    for (side, line) in sides {
        let Some(gas) = &line.accumulator else { continue };
        let names = [side, "line"].map(|table| format!("{table}.accumulator.precharge_pressure"));
        let Some(range) =
            names.iter().find_map(|name| range_of(name)).filter(|range| !seen.contains(&&range.name))
        else {
            continue;
        };
        seen.push(&range.name);
        let at = |precharge_pressure: f64| DeclaredAccumulator { precharge_pressure, ..*gas };
        let place = format!("uncertainty.{}", range.name);
        pressure_ratio(&at(range.minimum), &supply, &format!("{place}.minimum"), check);
        let working = at(range.maximum).working_precharge(ATMOSPHERE);
        if supply.pressure > 0.0 && working >= supply.pressure {
            let [precharge, pressure] =
                [working, supply.pressure].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
            let message = format!(
                "the precharge goes up to {precharge} and the supply has {pressure}: no chamber ever lets oil into this accumulator there"
            );
            let help = "let the range end below the lowest pressure at which the gas is to work";
            check.error_with_help(&format!("{place}.maximum"), message, help);
        }
    }
}

/// Rejects a range of the supply pressure that extends below the precharge of the supply's own
/// accumulator.
fn supply_falls_short(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let range = project.uncertainty.iter().find(|one| one.name == "supply.pressure");
    let SupplyModel::PumpLimited(Pump { accumulator: Some(gas), .. }) = &actuator.supply.model else {
        return;
    };
    let working = gas.working_precharge(ATMOSPHERE);
    let stated = actuator.supply.pressure;
    // without a stated pressure above the precharge the pressure itself is rejected
    let Some(range) = range.filter(|range| range.minimum <= working && working < stated) else { return };
    let [pressure, precharge] =
        [range.minimum, working].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
    let message = format!(
        "the supply goes down to {pressure} and its accumulator has a precharge of {precharge}: the pump never lets oil into it there"
    );
    let help = "let the range end above the precharge, or state a lower `precharge_pressure`";
    check.error_with_help("uncertainty.supply.pressure.minimum", message, help);
}

/// Checks the maker's limit of the compression of the gas, at the highest supply pressure; `path`
/// is the place of the error.
fn pressure_ratio(gas: &DeclaredAccumulator, supply: &DeclaredSupply, path: &str, check: &mut Check<'_, '_>) {
    let Some(limit) = gas.maximum_pressure_ratio else { return };
    let precharge = gas.working_precharge(ATMOSPHERE) + ATMOSPHERE;
    let stated = (gas.precharge_pressure + ATMOSPHERE) / precharge;
    let pressure = supply.pressure + ATMOSPHERE;
    let is_beyond = pressure > limit * precharge;
    if !is_beyond {
        return;
    }
    let ratio = quantity::significant(pressure / precharge, 3);
    let supplied = quantity::display(supply.pressure, &PRESSURE, 4);
    let needed = quantity::display(stated * pressure / limit - ATMOSPHERE, &PRESSURE, 4);
    let at = if gas.temperatures.is_some() { " at `working_temperature`" } else { "" };
    let message = format!(
        "at the supply pressure of {supplied} the gas has {ratio} times the absolute pressure of its precharge{at}, and \
         `maximum_pressure_ratio` permits {limit}"
    );
    let help = format!("raise `precharge_pressure` to {needed} or more, or lower the supply pressure");
    check.error_with_help(path, message, help);
}

fn imperfections(valve: &Valve, check: &mut Check<'_, '_>) {
    if let (Some(width), Some(threshold)) = (valve.hysteresis, valve.threshold)
        && width <= threshold
    {
        check.error("valve.hysteresis", "`hysteresis` includes `threshold`, so it must be above it");
    }
    if valve.null_bias.abs() >= valve.nominal_voltage && valve.nominal_voltage > 0.0 {
        check.error("valve.null_bias", "`null_bias` must be within the `nominal_voltage`");
    }
}

fn valve(valve: &Valve, supply: &DeclaredSupply, check: &mut Check<'_, '_>) {
    imperfections(valve, check);
    if valve.leakage_shapes.is_some() && valve.leakage_model == LeakageModel::OneCurve {
        check.error(
            "valve.leakage_shapes",
            "`leakage_model = \"one_curve\"` has one shape for the leakage of the whole valve: state `leakage_shape`, or the shapes of the edges \
             with `leakage_model = \"each_edge\"`",
        );
    }
    let laps = valve.lap.iter().flat_map(|lap| [("positive", lap.positive), ("negative", lap.negative)]);
    for (side, _) in laps.filter(|(_, lap)| lap.abs() >= 1.0) {
        check.error(&format!("valve.lap.{side}"), "a lap is less than the full travel of the spool, 100 %");
    }
    if valve.flow.edges().is_some_and(|edges| edges.to_array().iter().all(|edge| *edge == 0.0)) {
        check.error("valve.flow_coefficients", "all flow coefficients are zero: the valve never opens");
    }
    let Some(NullLeakage { flow, maximum, pressure }) = valve.leakage.rating() else { return };
    if *flow < valve.tare_flow * (pressure / valve.tare_drop(supply)).sqrt() {
        check.error(
            "valve.null_leakage",
            "`null_leakage` includes `tare_flow`, so it cannot be below it, each at its own pressure",
        );
    }
    if maximum.is_some_and(|maximum| maximum < *flow) {
        check.error("valve.null_leakage_maximum", "`null_leakage_maximum` is below `null_leakage`");
    }
}

fn cylinder(cylinder: &DeclaredCylinder, check: &mut Check<'_, '_>) {
    piston(cylinder, check);
    // rods are already subtracted from an area
    let by_area = cylinder.piston_area.is_some() || cylinder.piston_areas.is_some();
    let written =
        ["rod_diameter", "rod_diameters"].iter().any(|name| check.declared(&format!("cylinder.{name}")));
    let by_model = cylinder.rod_diameter.is_some() || cylinder.rod_diameters.is_some();
    if !by_area && !written && !by_model && !check.refused("cylinder.model") {
        check.missing("cylinder", "rod_diameter", "missing `rod_diameter` or `rod_diameters` in [cylinder]");
    }
    let too_thick = |piston: f64| cylinder.rod_diameters_m().iter().any(|rod| *rod >= piston);
    if cylinder.piston_diameter.is_some_and(too_thick) {
        let at =
            if cylinder.rod_diameters.is_some() { "cylinder.rod_diameters" } else { "cylinder.rod_diameter" };
        check.error(at, "the rod is as thick as the piston or thicker: no area is left for the oil");
    }
    stages(cylinder, check);
}

/// Checks that the stages of a telescopic piston follow each other within the stroke.
fn stages(cylinder: &DeclaredCylinder, check: &mut Check<'_, '_>) {
    if cylinder.stages.is_empty() && check.declared("cylinder.stage_transition") {
        check.warning(
            "cylinder.stage_transition",
            "`stage_transition` has no effect without [[cylinder.stage]]",
        );
    }
    if cylinder.stages.len() > FURTHER_STAGES {
        let message = format!(
            "{} stages follow the first, and a telescopic piston has at most {FURTHER_STAGES} of them",
            cylinder.stages.len()
        );
        check.error(&format!("cylinder.stage[{FURTHER_STAGES}]"), message);
    }
    for test in ["bench.friction", "bench.line"] {
        if !cylinder.stages.is_empty() && check.declared(test) {
            let message = "tests with the piston are made with one pair of areas, and those of a telescopic piston change";
            check.error_with_help(
                test,
                message,
                format!("remove [{test}], or [[cylinder.stage]] to test one stage"),
            );
        }
    }
    let half = 0.5 * cylinder.stage_transition;
    let in_words = |value: f64| display(value, &LENGTH, 4);
    let mut before = 0.0;
    for (index, stage) in cylinder.stages.iter().enumerate() {
        let at = format!("cylinder.stage[{index}].from");
        if stage.from - half < before {
            let least = in_words(before + half);
            let message = format!(
                "this stage begins within the transition before it, which ends at {}: `from` must be at least {least}",
                in_words(before)
            );
            check.error_with_help(&at, message, "let it begin later, or reduce `stage_transition`");
        } else if stage.from + half > cylinder.stroke {
            let most = in_words(cylinder.stroke - half);
            let message = format!(
                "the transition to this stage ends beyond the stroke of {}: `from` must be at most {most}",
                in_words(cylinder.stroke)
            );
            check.error_with_help(&at, message, "let it begin earlier, or state the stroke of all stages");
        }
        before = stage.from + half;
    }
}

/// Checks the piston: a single area suffices only for a rod through both chambers.
fn piston(cylinder: &DeclaredCylinder, check: &mut Check<'_, '_>) {
    let [rod_a, rod_b] = cylinder.rod_diameters_m();
    if cylinder.piston_area.is_some() && (rod_a - rod_b).abs() > 0.0 {
        let message = "with unequal rods `piston_area` is not the same in both chambers: give `piston_diameter`, or `piston_areas`";
        check.error("cylinder.piston_area", message);
    }
}

fn friction(friction: &DeclaredFriction, part: &str, check: &mut Check<'_, '_>) {
    let table = format!("{part}.friction");
    let (FrictionLaw::Stribeck { curve, .. } | FrictionLaw::LuGre { curve, .. }) = &friction.law else {
        if friction.retracting.is_some() {
            let message = "viscous friction alone is the same both ways: choose `model = \"stribeck\"` or `\"lugre\"`, or remove `retracting`";
            check.error(&format!("{table}.retracting"), message);
        }
        return;
    };
    if !check.declared(&format!("{table}.static")) || !check.declared(&format!("{table}.coulomb")) {
        return;
    }
    let extending = [curve.coulomb, curve.static_friction, friction.viscous];
    levels(friction, (&table, &table), extending, check);
    if let Some(back) = friction.retracting {
        let [coulomb, breakaway, viscous] = extending;
        let retracting = [
            back.coulomb.unwrap_or(coulomb),
            back.static_friction.unwrap_or(breakaway),
            back.viscous.unwrap_or(viscous),
        ];
        levels(friction, (&format!("{table}.retracting"), &table), retracting, check);
    }
}

/// Checks the levels of one direction, with keys in the first table if they are there, otherwise in
/// the second.
fn levels(
    friction: &DeclaredFriction,
    (own, other): (&str, &str),
    [coulomb, breakaway, viscous]: [f64; 3],
    check: &mut Check<'_, '_>,
) {
    let at = |key: &str, check: &Check<'_, '_>| {
        let path = format!("{own}.{key}");
        if check.declared(&path) { path } else { format!("{other}.{key}") }
    };
    if breakaway < coulomb {
        let [lower, upper] = ["coulomb", "static"].map(|key| at(key, check));
        return check.in_order([&lower, &upper], [coulomb, breakaway]);
    }
    let FrictionLaw::LuGre { bristle_damping, .. } = friction.law else { return };
    let least = bristle_damping * (breakaway - coulomb) / coulomb;
    if viscous < least {
        let unit = check.motion().dimension(&DAMPING).si;
        let least = rounded_up(least);
        let message = format!(
            "this LuGre friction can give out energy: it is passive for `viscous` of at least {least} {unit} \
             (bristle_damping (static - coulomb)/coulomb; Barabanov and Ortega, 2000)"
        );
        check.warning(&at("viscous", check), message);
    }
}

/// Next higher number with three significant digits.
fn rounded_up(value: f64) -> String {
    let place = portable::pow(10.0, portable::log10(value).floor() - 2.0);
    quantity::significant((value / place).ceil() * place, 3)
}

fn lines(actuator: &DeclaredActuator, lines: &DeclaredLines, check: &mut Check<'_, '_>) {
    line_motion::nobody_inherits(check);
    for (name, side) in [("a", &lines.a), ("b", &lines.b)] {
        let own = format!("line.{name}");
        let path = if check.declared(&own) { own } else { "line".to_string() };
        line(side, &path, check);
        line_motion::motion(side, &path, check);
        expansion(side, actuator.supply.pressure, &path, check);
        if let Some(gas) = &side.accumulator {
            let own = format!("line.{name}.accumulator");
            let path = if check.declared(&own) { own } else { "line.accumulator".to_string() };
            accumulator(gas, &actuator.supply, &path, check);
        }
        let working = side.hose().and_then(|hose| hose.working_pressure);
        if working.is_some_and(|working| working < actuator.supply.pressure) {
            let message = "the hose's `working_pressure` is below the supply pressure";
            let key = if side.hose_name().is_some() { "hose" } else { "working_pressure" };
            check.warning(&format!("{path}.{key}"), message);
        }
        let working = side.pipe().and_then(|pipe| pipe.working_pressure);
        if working.is_some_and(|working| working < actuator.supply.pressure) {
            let key =
                if check.declared(&format!("{path}.pipe.model")) { "model" } else { "working_pressure" };
            let message = "the pipe's `working_pressure` is below the supply pressure";
            check.warning(&format!("{path}.pipe.{key}"), message);
        }
    }
}

/// Checks the expansion of a hose, which is known up to the pressure of its measurement.
fn expansion(line: &DeclaredLine, supply: f64, path: &str, check: &mut Check<'_, '_>) {
    let Some(stated) = line.expansion_stated_at().filter(|stated| supply > stated * (1.0 + 1e-9)) else {
        return;
    };
    let [stated, supply] = [stated, supply].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
    let message = format!(
        "the expansion of the hose is stated at {stated}, and the supply has {supply}: in between it is carried on along its slope"
    );
    let key = if line.hose_name().is_some() { "hose" } else { "volumetric_expansion_pressure" };
    check.warning(&format!("{path}.{key}"), message);
}

pub(super) fn line(line: &DeclaredLine, path: &str, check: &mut Check<'_, '_>) {
    let written = |names: &[&str]| names.iter().any(|name| check.declared(&format!("{path}.{name}")));
    let ways = [written(&Component::HOSE), written(&["pipe"]), written(&Component::VOLUME)];
    match ways {
        [false, false, false] => {
            let or_volume =
                if path.starts_with("line") { "`hose`, `pipe` or `volume`" } else { "`hose` or `pipe`" };
            let message = format!("missing {or_volume} in [{path}]");
            return check.missing(path, "pipe", message);
        }
        [true, false, false] | [false, true, false] | [false, false, true] => {}
        [_, is_pipe, _] => {
            let at = if is_pipe { "pipe" } else { "volume" };
            let ways =
                if path.starts_with("line") { "a hose, a pipe or a volume" } else { "a hose or a pipe" };
            return check.error(&format!("{path}.{at}"), format!("a line is {ways}: only one of them"));
        }
    }
    // a key that one side does not use may belong to the other
    let [length, stiffening] =
        ["length", "dynamic_stiffening"].map(|key| path == "line" && check.declared(&format!("line.{key}")));
    if length && matches!(line.component, Component::Volume(_)) {
        check.warning("line.length", "`length` has no effect together with `volume`");
    }
    let sized = ["time_constant", "settling_time"].iter().any(|key| check.declared(&format!("sizing.{key}")));
    // [sizing] uses it for the hoses that it examines
    if stiffening && line.hose().is_none() && !sized {
        check.warning("line.dynamic_stiffening", "`dynamic_stiffening` has no effect without a hose");
    }
    let of_hose = line.hose().map(|hose| ("", hose.working_pressure, hose.burst_pressure));
    let of_pipe = line.pipe().map(|pipe| (".pipe", pipe.working_pressure, pipe.burst_pressure));
    if let Some((part, Some(working), Some(burst))) = of_hose.or(of_pipe)
        && burst < working
    {
        let [low, high] = ["working_pressure", "burst_pressure"].map(|key| format!("{path}{part}.{key}"));
        check.in_order([&low, &high], [working, burst]);
    }
    line.pipe().into_iter().for_each(|pipe| outer_diameter(pipe, path, check));
    check.interval(&format!("{path}.dynamic_stiffening"), line.dynamic_stiffening);
}

/// Tolerance of the outer diameter relative to bore and walls: data sheets round.
const OUTER_ROUNDED: f64 = 0.02;

/// Checks that the outer diameter of a pipe is its bore plus both walls.
fn outer_diameter(pipe: &DeclaredPipe, path: &str, check: &mut Check<'_, '_>) {
    let (Some(outer), Some(wall)) = (pipe.outer_diameter, &pipe.wall) else { return };
    let made = pipe.bore + 2.0 * wall.thickness;
    if (made - outer).abs() > OUTER_ROUNDED * outer {
        let [outer, made] = [outer, made].map(|size| quantity::display(size, &LENGTH, 4));
        let message = format!("`outer_diameter` is {outer}, and bore and walls make {made}");
        check.warning(&format!("{path}.pipe.outer_diameter"), message);
    }
}
