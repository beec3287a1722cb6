use phea_engineering::rig::{ChargedRange, Rig, charged_range};
use phea_engineering::setup::Setup;
use phea_hydraulics::accumulator::{Accumulator, GasBranch};
use phea_hydraulics::actuator::Components;
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::operating_point::OperatingPoint;
use phea_hydraulics::stiffness::hydraulic_stiffness;

use super::list::List;
use crate::project::DeclaredAccumulator;
use crate::quantity::{FORCE, STIFFNESS};

/// The precharge at operating temperature, and the stated one.
fn precharge(declared: &DeclaredAccumulator, gas: &Accumulator, name: String, list: &mut List) {
    let Some(temperatures) = declared.temperatures else { return };
    let equation = "P_0 = P_{stated} T/T_{stated}, absolute";
    list.add(name, "p_0", gas.precharge_pressure, "Pa", equation);
    let [stated, working] = temperatures.absolute();
    if stated != working {
        list.stated(declared.precharge_pressure, "precharge_pressure, at precharge_temperature", None);
    }
}

/// Effects of a neck and of heat on the gas.
fn of_branch(branch: &GasBranch, name: &impl Fn(&str) -> String, list: &mut List) {
    if let Some(later) = branch.relaxation {
        let equation = "C_{acc}/γ, too fast for heat, with the oil of a neck";
        list.add(name("fast_compliance"), "C_fast", branch.compliance, "m3/Pa", equation);
        list.add(name("isothermal_below"), "ω_T", 1.0 / later.time, "rad/s", "ω_T = 1/(γ τ), γ = 1.4");
    }
    if let Some(conductance) = branch.valve {
        let equation = "ω_v = g/(C_{acc} + C_v), g = s K/sqrt(dp_t): slower oil reaches the gas";
        list.add(name("valve_corner"), "ω_v", conductance / branch.compliance, "rad/s", equation);
    }
    if let Some((resonance, damping_ratio)) = branch.resonance().zip(branch.damping_ratio()) {
        // the resonance is far too fast for heat
        let [resonates, damps] = match branch.relaxation {
            Some(_) => ["ω_n = 1/sqrt(I C_{fast}), Helmholtz", "ξ_n = R/2 sqrt(C_{fast}/I), laminar"],
            None => {
                ["ω_n = 1/sqrt(I (C_{acc} + C_n)), Helmholtz", "ξ_n = R/2 sqrt((C_{acc} + C_n)/I), laminar"]
            }
        };
        list.add(name("neck_resonance"), "ω_n", resonance, "rad/s", resonates);
        let equation = damps;
        list.add(name("neck_damping_ratio"), "ξ_n", damping_ratio, "1", equation);
    }
}

/// The stiffness at other settings of adjustable accumulators; at 0 the valves are shut, or the
/// added gas is absent.
fn at_settings(
    components: &Components,
    stiffness: &impl Fn(&Components, &OperatingPoint) -> f64,
    point: &OperatingPoint,
    list: &mut List,
) {
    if components.gas.iter().flatten().all(|gas| gas.setting().is_none()) {
        return;
    }
    for (name, setting) in
        [("stiffness.at_setting_0", 0.0), ("stiffness.at_setting_half", 0.5), ("stiffness.at_setting_1", 1.0)]
    {
        let there = components.at_setting(setting);
        let equation = list.motion.either(
            "K_H = A_A^2/C_A + A_B^2/C_B, slow, at this setting",
            "K_θ = D^2 (1/C_A + 1/C_B), slow, at this setting",
        );
        list.add(
            name,
            list.motion.symbols().stiffness,
            stiffness(&there, point),
            list.si(&STIFFNESS),
            equation,
        );
    }
}

/// Equations of the stiffness with the gas, without it, and at another operating point: of a
/// cylinder, and of a motor.
const WITH_GAS: [&str; 3] = [
    "K_H = A_A^2/C_A + A_B^2/C_B, C_A and C_B with C_acc",
    "K_H = A_A^2/C_A + A_B^2/C_B, C_A and C_B without C_acc",
    "K_H = A_A^2/C_A + A_B^2/C_B there",
];
const WITH_GAS_OF_A_MOTOR: [&str; 3] = [
    "K_θ = D^2 (1/C_A + 1/C_B), C_A and C_B with C_acc",
    "K_θ = D^2 (1/C_A + 1/C_B), C_A and C_B without C_acc",
    "K_θ = D^2 (1/C_A + 1/C_B) there",
];

/// The gas at the chambers, and the stiffness of the actuator without it.
pub(super) fn accumulators(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let project = setup.project;
    let components = rig.actuator.components();
    let pressures = [rig.point.pressure_a, rig.point.pressure_b];
    let [gas_a, gas_b] = components.gas;
    if gas_a.or(gas_b).is_none() {
        return;
    }
    list.group("Accumulators");
    let lines = project.actuator.as_ref().map(|actuator| [&actuator.line.a, &actuator.line.b]);
    let declared = lines.map_or([None; 2], |lines| lines.map(|line| line.accumulator.as_ref()));
    for (side, gas, place) in [("a", gas_a, 0), ("b", gas_b, 1)] {
        let Some(chamber_gas) = gas else { continue };
        let gas = chamber_gas.at_rest();
        let pressure = pressures[place];
        let compliance = "C_{acc} = (V_0/(n P)) (P_0/P)^(1/n)";
        let name = |what: &str| format!("line.{side}.accumulator.{what}");
        if let Some(declared) = declared[place] {
            precharge(declared, &gas, name("working_precharge"), list);
        }
        list.add(name("compliance"), "C_acc", gas.compliance(pressure), "m3/Pa", compliance);
        if let Some(branch) = components.gas_branches(pressures)[place] {
            of_branch(&branch, &name, list);
        }
        if let Some(setting) = chamber_gas.setting() {
            let equation = "s of the adjustment, at rest";
            list.add(name("setting"), "s", setting, "1", equation);
        }
        let volume = gas.gas_volume - gas.oil(pressure);
        list.add(name("gas_volume_at_point"), "V", volume, "m3", "V = V_0 (P_0/P)^(1/n)");
    }
    let bare = Components { gas: [None; 2], ..*components };
    let at = |components: &Components, point: &OperatingPoint| {
        let pressures = [point.pressure_a, point.pressure_b];
        let chambers = components.chamber_compliance(pressures, StiffeningMember::Nominal);
        hydraulic_stiffness(&chambers, point.position)
    };
    let symbols = list.motion.symbols();
    let [with, without, there] = list.motion.either(WITH_GAS, WITH_GAS_OF_A_MOTOR);
    let unit = list.si(&STIFFNESS);
    list.add("stiffness.with_accumulators", symbols.stiffness, at(components, &rig.point), unit, with);
    list.add("stiffness.without_accumulators", symbols.stiffness, at(&bare, &rig.point), unit, without);
    at_settings(components, &at, &rig.point, list);
    let Some(ChargedRange { least, greatest }) = charged_range(rig) else { return };
    let ends = [
        ("line.a.accumulator.least_force", "stiffness.at_least_force", "P_A = 1.01 P_0 at standstill", least),
        (
            "line.b.accumulator.greatest_force",
            "stiffness.at_greatest_force",
            "P_B = 1.01 P_0 at standstill",
            greatest,
        ),
    ];
    for (force, stiffness, equation, point) in ends {
        let Some(point) = point else { continue };
        list.add(force, symbols.hydraulic, point.hydraulic_force, list.si(&FORCE), equation);
        list.add(stiffness, symbols.stiffness, at(components, &point), unit, there);
    }
}
