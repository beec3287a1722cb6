//! Implausible numbers of a file for a rig of this size: nearly always in another unit than the
//! heading states.

use crate::project::{DeclaredActuator, Findings, Project, RawFinding};
use crate::quantity::{Dimension, FORCE, LENGTH, PRESSURE, TORQUE, UnitScale, VOLTAGE, display};
use crate::table::{Column, MeasuredTable};

/// Ratio of a value in a file to the capability of the rig from which its unit is doubted.
const BEYOND: f64 = 10.0;
/// Range of plausible values, relative to the capability of the rig.
const USUAL: [f64; 2] = [1e-3, 1.5];

/// Part that bounds a quantity of a rig, as a clause before the bound.
#[derive(Clone, Copy, Debug, thiserror::Error)]
enum Holder {
    #[error("the motor holds")]
    Motor,
    #[error("the cylinder holds")]
    Cylinder,
    #[error("the stroke is")]
    Stroke,
    #[error("the nominal command is")]
    Command,
    #[error("the supply has")]
    Supply,
}

/// A column with implausible values for a rig of this size.
#[derive(Debug, thiserror::Error)]
#[error("`{heading}` reaches {}{reached} {unit}, and {holder} {held}", if *is_small { "only " } else { "" })]
struct ImplausibleColumn {
    heading: String,
    is_small: bool,
    reached: String,
    unit: String,
    holder: Holder,
    held: String,
}

/// Remedy for such a column.
#[derive(Debug, thiserror::Error)]
enum ColumnCure {
    #[error("is it the right column, in the unit that its heading says?")]
    CheckColumn,
    #[error("these numbers would be plausible in {0}: correct the heading")]
    OtherUnit(String),
    #[error(
        "these numbers would be plausible in {0}: correct the heading; forces that are so small are stated in the project, as steps, ramps or sines"
    )]
    OtherUnitOfSmall(String),
}

/// Bound of a quantity on this rig, SI, and the part that sets it.
fn held(actuator: &DeclaredActuator, dimension: &Dimension) -> Option<(f64, Holder)> {
    let is = |one: &Dimension| std::ptr::eq(dimension, one);
    let pressure = actuator.supply.pressure;
    match &actuator.motor {
        Some(motor) if is(&TORQUE) => Some((motor.displacement * pressure, Holder::Motor)),
        None if is(&FORCE) => {
            let [a, b] = actuator.cylinder.effective_areas_m2();
            Some((a.max(b) * pressure, Holder::Cylinder))
        }
        None if is(&LENGTH) => Some((actuator.stroke()?, Holder::Stroke)),
        _ if is(&VOLTAGE) => Some((actuator.valve.nominal_voltage, Holder::Command)),
        _ if is(&PRESSURE) => Some((pressure, Holder::Supply)),
        _ => None,
    }
}

/// True if values that drive a rig are usually of the magnitude of its capability: motions may be
/// far smaller, and pressures near that of the tank.
fn is_of_full_scale(dimension: &Dimension) -> bool {
    [&FORCE, &TORQUE].iter().any(|one| std::ptr::eq(dimension, *one))
}

/// Rejects a measured column that exceeds ten times the capability of the rig. It may be as small
/// as noise.
pub(super) fn check(
    project: &Project,
    table: &MeasuredTable,
    of_column: (&Column, &'static Dimension),
    values: &[f64],
    findings: &mut Findings,
) {
    doubt(project, (table, false), of_column, values, findings);
}

/// Rejects a column that drives a scenario by this criterion; forces below a thousandth of the
/// capability of the rig are rejected too if another unit would make them plausible.
pub(super) fn check_driving(
    project: &Project,
    table: &MeasuredTable,
    of_column: (&Column, &'static Dimension),
    values: &[f64],
    findings: &mut Findings,
) {
    doubt(project, (table, true), of_column, values, findings);
}

fn doubt(
    project: &Project,
    (table, drives): (&MeasuredTable, bool),
    (column, dimension): (&Column, &'static Dimension),
    values: &[f64],
    findings: &mut Findings,
) {
    let held = project.actuator.as_ref().and_then(|actuator| held(actuator, dimension));
    let Some((held, holder)) = held.filter(|(held, _)| *held > 0.0) else { return };
    let most =
        values.iter().filter(|value| !value.is_nan()).fold(0.0, |most: f64, value| most.max(value.abs()));
    let is_small = drives && is_of_full_scale(dimension) && most > 0.0 && most < USUAL[0] * held;
    if most <= BEYOND * held && !is_small {
        return;
    }
    let in_si = |unit: &str| UnitScale::new(unit, dimension).ok()?.read("1");
    let stated = in_si(&column.unit).unwrap_or(1.0);
    let would_do = |unit: &&&str| {
        let other = in_si(unit).map_or(f64::NAN, |other| most / stated * other / held);
        (USUAL[0]..=USUAL[1]).contains(&other)
    };
    let units: Vec<&str> =
        ["N", "kN", "MN", "N.m", "kN.m", "m", "mm", "V", "mV", "Pa", "kPa", "bar", "MPa", "psi"]
            .iter()
            .filter(would_do)
            .copied()
            .collect();
    let heading = table.heading(column).to_string();
    let reached = display(most / stated, &crate::quantity::RATIO, 4);
    if is_small && units.is_empty() {
        return;
    }
    let held = display(held, dimension, 4);
    let unit = column.unit.to_string();
    let problem = ImplausibleColumn { heading, is_small, reached, unit, holder, held };
    let place = table.headings.get(column.index).map(|heading| heading.place).unwrap_or_default();
    let found = RawFinding::error(place, problem.to_string());
    let units = units.join(" or ");
    let remedy = match (units.is_empty(), is_small) {
        (true, _) => ColumnCure::CheckColumn,
        (false, false) => ColumnCure::OtherUnit(units),
        (false, true) => ColumnCure::OtherUnitOfSmall(units),
    };
    findings.push(found.help(remedy.to_string()));
}
