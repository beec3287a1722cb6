use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_hydraulics::operating_point::Condition;

use super::list::List;
use crate::quantity::{FORCE, LENGTH, VELOCITY};

/// The equilibrium at the operating point.
pub(super) fn operating_point(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    let (point, motion) = (&rig.point, list.motion);
    let taken = motion
        .either(["q_A(U, p_A) = A_A v", "q_B(U, p_B) = -A_B v"], ["q_A(U, p_A) = D ω", "q_B(U, p_B) = -D ω"]);
    let [command, pressure_a, pressure_b] = match rig.condition {
        Condition::Command(_) => motion.either(
            ["the null of the valve", "q_A(U, p_A) = 0, blocked piston", "q_B(U, p_B) = 0, blocked piston"],
            ["the null of the valve", "q_A(U, p_A) = 0, blocked shaft", "q_B(U, p_B) = 0, blocked shaft"],
        ),
        Condition::Load(_) => [
            "the command that holds the load",
            "q_A(U, p_A) = 0, holding the load",
            "q_B(U, p_B) = 0, holding the load",
        ],
        Condition::Motion(..) => ["declared", taken[0], taken[1]],
        Condition::Moving(..) => ["the command that keeps the velocity", taken[0], taken[1]],
        Condition::Matched(..) => ["declared", "p_A = (p_S + p_T + p_L)/2", "p_B = (p_S + p_T - p_L)/2"],
    };
    list.group("Operating point");
    let [place, speed] = [&LENGTH, &VELOCITY].map(|dimension| list.si(dimension));
    let position = match rig.actuator.components().cylinder.stroke.length() {
        Some(_) => "declared, or mid stroke",
        None => "declared, or zero",
    };
    list.add("operating_point.position", motion.symbols().position, point.position, place, position);
    list.add(
        "operating_point.velocity",
        motion.either("v", "ω"),
        point.velocity,
        speed,
        "declared, or standstill",
    );
    list.add("operating_point.command", "U_C", point.command, "V", command);
    list.add("operating_point.pressure_a", "p_A", point.pressure_a, "Pa", pressure_a);
    list.add("operating_point.pressure_b", "p_B", point.pressure_b, "Pa", pressure_b);
    list.add("operating_point.load_pressure", "p_L", point.load_pressure(), "Pa", "p_L = p_A - p_B");
    let (name, symbol, equation) = motion.either(
        ("operating_point.hydraulic_force", "F_H", "F_H = A_A p_A - A_B p_B"),
        ("operating_point.hydraulic_torque", "T_H", "T_H = D (p_A - p_B)"),
    );
    list.add(name, symbol, point.hydraulic_force, list.si(&FORCE), equation);
}
