//! Hydraulic stiffness as a function of the force at standstill: gas is the stiffer, the more it is
//! compressed.

use phea_hydraulics::accumulator::ChamberGas;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::operating_point::{Condition, OperatingPoint, SteadyLoad, operating_point};
use phea_hydraulics::stiffness::hydraulic_stiffness;

use crate::rig::{ChargedRange, Rig, charged_range};

/// Number of forces at which the stiffness is computed.
const FORCES: u32 = 120;

/// Stiffness at the forces at which the gas is in use; all vectors have one value for each force.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessOverForce {
    /// Force F_H, N, rising.
    pub forces: Vec<f64>,
    /// Stiffness K_H at the setting at rest, N/m.
    pub at_rest: Vec<f64>,
    /// Other settings of the adjusted accumulators, with K_H; NaN if the gas is shut off at that
    /// setting.
    pub at_settings: Vec<(f64, Vec<f64>)>,
}

/// Stiffness for slow motions as a function of the hydraulic force at standstill, at the position
/// of the operating point; `None` if no gas is in use at standstill.
///
/// ```text
/// F_H = A_A p_A - A_B p_B,   q_A = q_B = 0,   K_H = A_A^2/C_A(p_A) + A_B^2/C_B(p_B)
/// ```
///
/// The forces end where the gas at a chamber is shut off, or at the nominal voltage. The supply
/// pressure is that of the operating point.
pub fn stiffness_over_force(rig: &Rig) -> Option<StiffnessOverForce> {
    let ChargedRange { least, greatest } = charged_range(rig)?;
    let components = rig.actuator.components();
    let position = rig.point.position;
    let under = |condition| operating_point(&rig.actuator, position, condition).ok();
    let nominal = components.valve.nominal_voltage;
    let [least, greatest] = [(least, -nominal), (greatest, nominal)]
        .map(|(end, command)| end.or_else(|| under(Condition::Command(command))));
    let (least, greatest) = least.zip(greatest)?;
    let (from, to) = (least.hydraulic_force, greatest.hydraulic_force);
    let between = (1..FORCES)
        .map(|step| from + (to - from) * f64::from(step) / f64::from(FORCES))
        .filter_map(|force| under(Condition::Load(SteadyLoad::Force(force))));
    let points: Vec<OperatingPoint> =
        std::iter::once(least).chain(between).chain(std::iter::once(greatest)).collect();
    let along = |components: &Components| -> Vec<f64> {
        points.iter().map(|point| stiffness(components, point)).collect()
    };
    let sealed = components.gas.map(|gas| Some(ChamberGas::Sealed(gas?.sealed())));
    let at_rest = along(&Components { gas: sealed, ..*components });
    let settings = || components.gas.iter().flatten().filter_map(ChamberGas::setting);
    let rests = |setting: f64| settings().all(|at_rest| at_rest == setting);
    let others = [0.0, 0.5, 1.0].into_iter().filter(|setting| !rests(*setting));
    let others = others.map(|setting| (setting, along(&components.at_setting(setting))));
    Some(StiffnessOverForce {
        forces: points.iter().map(|point| point.hydraulic_force).collect(),
        // for slow motions the opening of a valve makes no difference
        at_settings: others.filter(|(_, values)| *values != at_rest).collect(),
        at_rest,
    })
}

/// Stiffness K_H at an operating point; NaN if the gas is shut off.
fn stiffness(components: &Components, point: &OperatingPoint) -> f64 {
    let pressures = [point.pressure_a, point.pressure_b];
    let is_shut_off = components
        .gas
        .iter()
        .zip(pressures)
        // the ends of the forces are at this pressure
        .any(|(gas, pressure)| gas.is_some_and(|gas| pressure < gas.at_rest().least_pressure() - 1.0));
    match is_shut_off {
        true => f64::NAN,
        false => hydraulic_stiffness(
            &components.chamber_compliance(pressures, StiffeningMember::Nominal),
            point.position,
        ),
    }
}
