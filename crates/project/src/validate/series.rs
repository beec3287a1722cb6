//! Spring between force sensor and load: consistency of its keys, and its capacity for the force of
//! the cylinder.

use super::Check;
use super::rig;
use phea_hydraulics::line::Stiffening;

use crate::{DeclaredActuator, DeclaredSeries, DeclaredSpring, DeclaredTransmission, Project, Uncertain};
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE as ATMOSPHERE;
use phea_quantity::{self as quantity, AREA, FORCE, LENGTH, PRESSURE, STIFFNESS};

pub(super) fn series(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    match &actuator.series {
        None => {}
        Some(DeclaredSeries::Spring(declared)) => spring(project, actuator, declared, check),
        Some(DeclaredSeries::Transmission(declared)) => transmission(actuator, declared, check),
    }
}

/// Checks the line between two pistons, and the capacity of its oil for the force of the cylinder.
fn transmission(actuator: &DeclaredActuator, declared: &DeclaredTransmission, check: &mut Check<'_, '_>) {
    if check.declared("series.line") {
        rig::line(&declared.line, "series.line", check);
    }
    if let Some(Stiffening { nominal, minimum, maximum }) = declared.line.dynamic_stiffening
        && (minimum, maximum) != (nominal, nominal)
    {
        let message = "only `nominal` counts here: the line of a transmission has one stiffness";
        let help = "state the range as [uncertainty] \"series.line.dynamic_stiffening.nominal\"";
        check.warning_with_help("series.line.dynamic_stiffening", message, help);
    }
    let rests = ["series.piston_area", "series.filling_pressure", "supply.pressure"];
    if rests.iter().any(|path| check.refused(path) || !check.declared(path)) || declared.piston_area <= 0.0 {
        return;
    }
    let ([push, pull], area) = (stall_forces(actuator), declared.piston_area);
    let pressure = |value: f64| quantity::display(value, &PRESSURE, 4);
    let force = |value: f64| quantity::display(value, &FORCE, 4);
    let holds = area * (declared.filling_pressure + ATMOSPHERE);
    if holds < pull {
        let message = format!(
            "filled with {} the oil tears off at a pull of {}, and the cylinder pulls with up to {} (stall force)",
            pressure(declared.filling_pressure),
            force(holds),
            force(pull)
        );
        let wider = quantity::display(round_up(pull / (declared.filling_pressure + ATMOSPHERE)), &AREA, 4);
        let fuller = round_up(pull / area - ATMOSPHERE);
        let fill = if fuller < MOST_FILLING {
            format!("fill it with {} or more, or ", pressure(fuller))
        } else {
            String::new()
        };
        let help = format!("for loads that are pulled, {fill}take a `piston_area` of at least {wider}");
        check.warning_with_help("series.filling_pressure", message, help);
    }
    let most = declared.filling_pressure + push / area;
    let of_hose = declared.line.hose().and_then(|hose| hose.working_pressure);
    let of_pipe = declared.line.pipe().and_then(|pipe| pipe.working_pressure);
    let (part, limit) = (if of_hose.is_some() { "hose" } else { "pipe" }, of_hose.or(of_pipe));
    if let Some(working) = limit.filter(|working| *working < most) {
        let message = format!(
            "at the stall force of {} the oil of the transmission has {}, and the {part}'s `working_pressure` is {}",
            force(push),
            pressure(most),
            pressure(working)
        );
        let key = match part {
            "hose" if declared.line.hose_name().is_some() => "hose",
            "hose" => "working_pressure",
            _ if check.declared("series.line.pipe.working_pressure") => "pipe.working_pressure",
            _ => "pipe.model",
        };
        check.warning(&format!("series.line.{key}"), message);
    }
}

/// Largest filling pressure that is proposed, Pa.
const MOST_FILLING: f64 = 500e5;

/// Greatest push and greatest pull that the supply gives the piston, N.
fn stall_forces(actuator: &DeclaredActuator) -> [f64; 2] {
    let [area_a, area_b] = actuator.cylinder.effective_areas_m2();
    let [supply, tank] = [actuator.supply.pressure, actuator.supply.tank_pressure];
    [area_a * supply - area_b * tank, area_b * supply - area_a * tank]
}

/// Greatest force that the supply gives the piston, in either direction, N.
fn stall_force(actuator: &DeclaredActuator) -> f64 {
    let [push, pull] = stall_forces(actuator);
    push.max(pull)
}

fn spring(
    project: &Project,
    actuator: &DeclaredActuator,
    series: &DeclaredSpring,
    check: &mut Check<'_, '_>,
) {
    if series.travel.is_none() {
        for (key, needs) in [
            ("progression", series.progression > Some(0.0)),
            ("stop_stiffness", series.stop_stiffness.is_some()),
        ] {
            let path = format!("series.{key}");
            if needs && !check.refused("series.travel") {
                let message =
                    format!("`{key}` says what happens over the `travel` of the spring, which is not stated");
                check.error_with_help(&path, message, "state `travel`, to either side");
            }
        }
    }
    if series.coil.is_some() && series.progression > Some(0.0) {
        let message = "a coil of constant pitch is linear: it has no `progression`";
        check.error_with_help("series.coil", message, "take out one of the two");
    }
    damped_stops(series, check);
    bottoms_out(actuator, series, ("series.travel", series.stiffness), check);
    let is_soft = |one: &&Uncertain| one.name == "series.stiffness" && one.minimum < series.stiffness;
    if let Some(softest) = project.uncertainty.iter().find(is_soft) {
        bottoms_out(actuator, series, ("uncertainty.series.stiffness", softest.minimum), check);
    }
    vanishing(project, check);
}

/// Requires a damper or a mass with stops: otherwise only the force determines the velocity of the
/// spring.
fn damped_stops(series: &DeclaredSpring, check: &mut Check<'_, '_>) {
    if series.stop_damping == 0.0 {
        return;
    }
    if series.stop_stiffness.is_none() {
        let message = "`stop_damping` damps stops that are not there";
        return check.error_with_help("series.stop_damping", message, "state `stop_stiffness`");
    }
    if series.damping.is_none() && series.mass.is_none() {
        let message = "`stop_damping` needs `damping` or `mass`: a massless spring without a damper jumps from any speed to any other";
        let help = "state the `damping` of the spring, or the `mass` between sensor and spring";
        check.error_with_help("series.stop_damping", message, help);
    }
}

/// Checks that the stall force of the cylinder is within the travel.
fn bottoms_out(
    actuator: &DeclaredActuator,
    series: &DeclaredSpring,
    (place, stiffness): (&str, f64),
    check: &mut Check<'_, '_>,
) {
    let Some(travel) = series.travel else { return };
    let stall = stall_force(actuator);
    let holds = stiffness * travel * (1.0 + series.progression.unwrap_or(0.0));
    if ["series.stiffness", "series.travel", "supply.pressure"].iter().any(|path| check.refused(path))
        || !(stall > holds && holds > 0.0)
    {
        return;
    }
    let force = |value: f64| quantity::display(value, &FORCE, 4);
    let message = format!(
        "the spring reaches the end of its `travel` of {} at {}, and the cylinder pushes with up to {} (stall force): it would bottom out, \
         and the rig become rigid",
        quantity::display(travel, &LENGTH, 4),
        force(holds),
        force(stall)
    );
    let factor = 1.0 + series.progression.unwrap_or(0.0);
    let help = format!(
        "give it a `travel` of at least {}, or a `stiffness` of at least {}, or lower the supply pressure",
        quantity::display(round_up(stall / (stiffness * factor)), &LENGTH, 4),
        quantity::display(round_up(stall / (travel * factor)), &STIFFNESS, 4)
    );
    check.error_with_help(place, message, help);
}

/// Next higher number with three digits, so that the proposal of a message is sufficient.
fn round_up(value: f64) -> f64 {
    let mut unit = 1.0;
    while value / unit >= 1000.0 {
        unit *= 10.0;
    }
    while value / unit < 100.0 {
        unit /= 10.0;
    }
    (value / unit).ceil() * unit
}

/// Rejects a damper or a mass that may vanish, which would change the order of the plant within one
/// family.
fn vanishing(project: &Project, check: &mut Check<'_, '_>) {
    for key in ["series.damping", "series.mass"] {
        let in_range = project.uncertainty.iter().any(|one| one.name == key && one.minimum <= 0.0);
        let cases = project.family.iter().flat_map(|family| &family.cases);
        let in_case =
            cases.flat_map(|case| &case.parameters).any(|(name, value)| name == key && *value <= 0.0);
        for (place, vanishes) in
            [(format!("uncertainty.{key}"), in_range), ("family.cases".to_string(), in_case)]
        {
            if vanishes {
                let message = format!("`{key}` may vanish here, and a plant without it has another order");
                let help = "let it begin above zero, or leave it at zero and certain";
                check.error_with_help(&place, message, help);
            }
        }
    }
}
