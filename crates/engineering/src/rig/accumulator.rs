//! Accumulators at the chambers: whether their gas is in use at the operating point, and within
//! which forces.

use phea_hydraulics::accumulator::{Accumulator, ChamberGas};
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use phea_hydraulics::operating_point::{Condition, OperatingPoint, operating_point};

use super::Rig;
use crate::project::{DeclaredActuator, DeclaredLine, LateError};
use crate::quantity::DisplayUnit;

/// An accumulator whose precharge is above the pressure of its chamber at the operating point: the
/// bladder fills the shell, and the gas takes no part.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}: {}: {}", self.at().path, self.at().message, self.at().help)]
pub struct EmptyAccumulator {
    /// The table of the project.
    pub place: &'static str,
    /// A or B.
    pub side: char,
    /// Pa gauge, at the temperature in operation.
    pub precharge_pressure: f64,
    /// Pa gauge, as it is stated for another temperature.
    pub stated: Option<f64>,
    /// Pressure of the chamber, Pa gauge.
    pub pressure: f64,
}

impl EmptyAccumulator {
    /// The error at the place of its key.
    pub fn at(&self) -> LateError {
        let EmptyAccumulator { place, side, precharge_pressure, stated, pressure } = self;
        let bar = |value: f64| DisplayUnit::BAR.text(value, 4);
        let [precharge, pressure] = [*precharge_pressure, *pressure].map(bar);
        let problem = match stated {
            None => EmptyGas::AsStated { precharge, pressure, side: *side },
            Some(stated) => EmptyGas::Heated { precharge, pressure, side: *side, stated: bar(*stated) },
        };
        LateError {
            path: format!("{place}.precharge_pressure"),
            message: problem.to_string(),
            help: EmptyGas::Cure.to_string(),
        }
    }
}

/// Fault of a precharge, and its remedy.
#[derive(Debug, thiserror::Error)]
enum EmptyGas {
    #[error(
        "{precharge} is above the pressure of chamber {side} at the operating point, {pressure}, so that the gas is shut off and changes nothing"
    )]
    AsStated { precharge: String, pressure: String, side: char },
    #[error(
        "{precharge} at `working_temperature`, from {stated} at `precharge_temperature`, is above the pressure of chamber {side} at the operating point, {pressure}, so that the gas is shut off and changes nothing"
    )]
    Heated { precharge: String, pressure: String, side: char, stated: String },
    #[error("lower the precharge, or move the [operating_point]")]
    Cure,
}

/// The last operating points at standstill at which the gas is in use; `None` where it is up to the
/// nominal voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargedRange {
    /// With less force the gas at chamber A is shut off.
    pub least: Option<OperatingPoint>,
    /// With more force the gas at chamber B is shut off.
    pub greatest: Option<OperatingPoint>,
}

/// The tables that declare accumulators at chambers A and B: `line.accumulator` where both are the
/// same.
pub(crate) fn accumulator_place(declared: &DeclaredActuator) -> [&'static str; 2] {
    let line = &declared.line;
    match line.a.accumulator == line.b.accumulator {
        true => ["line.accumulator"; 2],
        false => ["line.a.accumulator", "line.b.accumulator"],
    }
}

/// Refuses an accumulator whose gas is shut off at the operating point.
pub(super) fn charged(
    declared: &DeclaredActuator,
    gas: &[Option<ChamberGas>; 2],
    point: &OperatingPoint,
) -> Result<(), EmptyAccumulator> {
    let sides = gas.iter().zip(accumulator_place(declared));
    let line = &declared.line;
    let chambers = [('A', point.pressure_a, &line.a), ('B', point.pressure_b, &line.b)];
    for ((gas, place), (side, pressure, line)) in sides.zip(chambers) {
        let Some(Accumulator { precharge_pressure, .. }) = gas.map(|gas| gas.at_rest()) else { continue };
        if let Some(precharge_pressure) = highest_precharge(line).filter(|highest| pressure < *highest) {
            let place = if place == "line.accumulator" {
                "line.accumulator.adjustment"
            } else if side == 'A' {
                "line.a.accumulator.adjustment"
            } else {
                "line.b.accumulator.adjustment"
            };
            return Err(EmptyAccumulator { place, side, precharge_pressure, stated: None, pressure });
        }
        if pressure < precharge_pressure {
            let other = line.accumulator.as_ref().filter(|gas| gas.temperatures.is_some());
            let stated = other.map(|gas| gas.precharge_pressure);
            return Err(EmptyAccumulator { place, side, precharge_pressure, stated, pressure });
        }
    }
    Ok(())
}

/// The precharge in Pa at setting 1 of an accumulator whose precharge its setting raises.
fn highest_precharge(line: &DeclaredLine) -> Option<f64> {
    let [first, last] = line.accumulator.as_ref()?.ends();
    let rises = last.precharge_pressure > first.precharge_pressure;
    rises.then(|| last.working_precharge(ATMOSPHERIC_PRESSURE_ABSOLUTE))
}

/// Bisections of the command: the width of its interval then is rounding.
const ROUNDS: usize = 60;

/// Where the gas at one of the chambers is shut off as the rig holds more and more force at
/// standstill; `None` without accumulators, and where the operating point does not stand still.
///
/// ```text
/// P_A(U) = 1.01 P_0 of accumulator A,   P_B(U) = 1.01 P_0 of accumulator B             at q_A = q_B = 0, absolute
/// ```
pub fn charged_range(rig: &Rig) -> Option<ChargedRange> {
    let components = rig.actuator.components();
    let [gas_a, gas_b] = [0, 1].map(|side| components.gas_in_use(side).map(ChamberGas::at_rest));
    if gas_a.or(gas_b).is_none() || rig.point.velocity != 0.0 {
        return None;
    }
    let nominal = components.valve.nominal_voltage;
    let at = |command| operating_point(&rig.actuator, rig.point.position, Condition::Command(command)).ok();
    let last = |gas: Option<Accumulator>, end: f64, pressure: fn(&OperatingPoint) -> f64| {
        let least = gas?.least_pressure();
        let is_shut = |command| at(command).is_some_and(|point| pressure(&point) < least);
        if !is_shut(end) {
            return None;
        }
        let (mut charged, mut shut) = (rig.point.command, end);
        for _ in 0..ROUNDS {
            let middle = 0.5 * (charged + shut);
            if is_shut(middle) { shut = middle } else { charged = middle }
        }
        at(charged)
    };
    Some(ChargedRange {
        least: last(gas_a, -nominal, |point| point.pressure_a),
        greatest: last(gas_b, nominal, |point| point.pressure_b),
    })
}
