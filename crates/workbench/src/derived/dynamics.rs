use num_complex::Complex64;
use phea_engineering::linearize::{HidingMass, hidden_above};
use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_hydraulics::linear::{MechanicalDamping, decompose, transfer_functions};

use super::list::List;
use crate::quantity::STIFFNESS;

/// Dynamics of the rig against its load; a quantity that belongs to the actuator itself is named so
/// if the load can move.
pub(super) fn dynamics(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    let linear = &rig.against_load();
    let factors = decompose(linear, MechanicalDamping::Corrected);
    let springs = match (rig.load_stiffness().is_some(), rig.plant.series.is_some()) {
        // only a cylinder has a spring or transmission
        (true, true) => "1/K_{eq} = 1/K_H + 1/K_S + 1/k_t + 1/k_L",
        (false, true) => "1/K_{eq} = 1/K_H + 1/K_S + 1/k_t",
        (true, false) => {
            list.motion.either("1/K_{eq} = 1/K_H + 1/K_S + 1/k_L", "1/K_{eq} = 1/K_θ + 1/K_S + 1/k_L")
        }
        (false, false) => list.motion.either("K_{eq} = K_H K_S/(K_H + K_S)", "K_{eq} = K_θ K_S/(K_θ + K_S)"),
    };
    list.group(match (rig.load_moves(), rig.load_stiffness().is_some()) {
        (true, true) => "Dynamics against the load, with the values in use",
        (true, false) => {
            "Dynamics with the load held still, as no stiffness holds it, with the values in use"
        }
        (false, _) => "Dynamics, with the values in use",
    });
    list.add(
        "dynamics.equivalent_stiffness",
        "K_eq",
        linear.equivalent_stiffness(),
        list.si(&STIFFNESS),
        springs,
    );
    let equation = match factors.hydraulic_rate == 0.0 {
        true => list.motion.either(
            "s_1 = -(K_c + G) K_{eq}/A_u^2, nothing leaks: an infinite time constant",
            "s_1 = -(K_c + G) K_{eq}/D^2, nothing leaks: an infinite time constant",
        ),
        false => list.motion.either("s_1 = -(K_c + G) K_{eq}/A_u^2", "s_1 = -(K_c + G) K_{eq}/D^2"),
    };
    list.add("dynamics.hydraulic_pole", "s_1", -factors.hydraulic_rate, "rad/s", equation);
    let equation =
        list.motion.either("dF_e/dt per volt = K_{qU} K_{eq}/A_u", "dT_e/dt per volt = K_{qU} K_{eq}/D");
    let symbol = list.motion.either("K_qU K_eq/A_u", "K_qU K_eq/D");
    let (name, unit) = list
        .motion
        .either(("dynamics.force_rate_gain", "N/(s.V)"), ("dynamics.torque_rate_gain", "N.m/(s.V)"));
    list.add(name, symbol, factors.hydraulic_gain, unit, equation);
    if rig.load_moves() {
        list.group("Dynamics with the load held still, with the values in use");
    }
    held_still(rig, list);
    if rig.load_moves() {
        list.group("Modes of the plant, with its load and the values in use");
    }
    modes(rig, list);
}

/// The piston held by its force sensor, and the frequency above which a mass hides the compliance.
fn held_still(rig: &Rig, list: &mut List) {
    let factors = decompose(&rig.leaking(), MechanicalDamping::Corrected);
    let frequency = factors.mechanical_square.sqrt();
    let equation = match rig.plant.series {
        None => list.motion.either("ω_m = sqrt((K_H + K_S)/M)", "ω_m = sqrt((K_θ + K_S)/J)"),
        Some(_) => "ω_m = sqrt((K_H + K_S k_t/(K_S + k_t))/M)",
    };
    list.add("dynamics.mechanical_frequency", "ω_m", frequency, "rad/s", equation);
    let damping_ratio = factors.mechanical_damping / (2.0 * frequency);
    let equation = match rig.plant.series {
        None => list.motion.either(
            "2 ξ_m ω_m = f_v/M + (K_c + G) K_H^2/(A_u^2 (K_H + K_S))",
            "2 ξ_m ω_m = f_v/J + (K_c + G) K_θ^2/(D^2 (K_θ + K_S))",
        ),
        Some(_) => "2 ξ_m ω_m = f_v/M + (K_c + G) K_H^2/(A_u^2 (K_H + K_S k_t/(K_S + k_t)))",
    };
    list.add("dynamics.mechanical_damping_ratio", "ξ_m", damping_ratio, "1", equation);
    let (mass, hidden) = hidden_above(rig);
    let equation = match mass {
        HidingMass::Piston => list.motion.either("ω = sqrt(K_H/M)", "ω = sqrt(K_θ/J)"),
        HidingMass::Oil => "ω = sqrt(K_{eq}/m)",
    };
    list.add("dynamics.compliance_hidden_above", "ω", hidden, "rad/s", equation);
}

/// The oscillating modes of the plant, the slowest first, and the one that rings longest: with all
/// parts except waves in the lines.
fn modes(rig: &Rig, list: &mut List) {
    let Ok(plant) = transfer_functions(&rig.plant.coefficients()) else { return };
    let oscillating = plant.command.poles().iter().filter(|pole| pole.im > 0.0);
    let of = |pole: &Complex64| [pole.norm_sqr().sqrt(), -pole.re / pole.norm_sqr().sqrt()];
    let mut modes: Vec<[f64; 2]> = oscillating.map(of).collect();
    modes.sort_by(|[one, _], [other, _]| one.total_cmp(other));
    let equation = "s = -ξ ω ± j ω sqrt(1 - ξ^2), poles of the plant, all lumped parts in it";
    for (index, [frequency, ratio]) in modes.iter().enumerate() {
        let name = format!("dynamics.mode_{}", index + 1);
        list.add(format!("{name}.frequency"), "ω", *frequency, "rad/s", equation);
        list.add(format!("{name}.damping_ratio"), "ξ", *ratio, "1", equation);
    }
    let least = modes.into_iter().reduce(|least, one| if one[1] < least[1] { one } else { least });
    let Some([frequency, ratio]) = least else { return };
    let equation =
        "s = -ξ_d ω_d ± j ω_d sqrt(1 - ξ_d^2), least damped poles of the plant, all lumped parts in it";
    list.add("dynamics.least_damped_frequency", "ω_d", frequency, "rad/s", equation);
    list.add("dynamics.least_damped_ratio", "ξ_d", ratio, "1", equation);
}
