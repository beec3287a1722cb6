use phea_hydraulics::cylinder::{Cylinder, chamber_volumes};
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::{Hose, Line, StiffeningMember};
use phea_hydraulics::operating_point::Condition;

use super::Derived;
use super::accumulator::accumulators;
use super::chamber_valves::chamber_valves;
use super::dynamics::dynamics;
use super::impedance::impedance;
use super::linkage::linkage;
use super::list::List;
use super::parts::costs;
use super::series::series;
use super::valve::valve;
use crate::linearize::{stiffness_models, stroke_stiffness};
use crate::project::Project;
use crate::quantity::{DAMPING, FORCE, LENGTH, MASS, MotionKind, STIFFNESS, VELOCITY};
use crate::rig::{FlowLimit, ParameterOrigin, Rig, RigError, largest_flow};
use crate::setup::Setup;

/// Equations of the flow gain and of the flow-pressure coefficient, for a cylinder and for a motor.
const FLOW_GAIN: &str = "K_{qU} = A_u (A_A K_{qA}/C_A + A_B K_{qB}/C_B)/K_H";
const FLOW_GAIN_OF_A_MOTOR: &str = "K_{qU} = D^2 (K_{qA}/C_A + K_{qB}/C_B)/K_θ";
const SLOPES: &str = "A_u^2/K_c = A_A^2/K_{cA} + A_B^2/K_{cB}";
const SLOPES_OF_A_MOTOR: &str = "1/K_c = 1/K_{cA} + 1/K_{cB}";

/// Every derived quantity of a rig, in the order in which they follow from each other.
///
/// # Errors
/// Errors of [`Setup::rig`].
pub fn derive(setup: &Setup<'_>) -> Result<Vec<Derived>, RigError> {
    let (project, rig) = (setup.project, setup.rig()?);
    let mut list = List::new(project.motion());
    moving(rig, &mut list);
    lines(rig, &mut list);
    stiffness(rig, &mut list);
    accumulators(project, rig, &mut list);
    series(project, rig, &mut list);
    costs(project, rig, &mut list);
    linkage(project, rig, &mut list);
    valve(project, rig, &mut list);
    equilibrium(rig, &mut list);
    chamber_valves(setup, rig, &mut list);
    linear_parameters(rig, &mut list);
    dynamics(rig, &mut list);
    impedance(rig, &mut list);
    friction(rig, &mut list);
    flow(project, rig, &mut list);
    sizing(project, rig, &mut list);
    Ok(list.into_entries())
}

/// The moving part: cylinder or motor.
fn moving(rig: &Rig, list: &mut List) {
    let cylinder = &rig.actuator.components().cylinder;
    match list.motion {
        MotionKind::Linear => self::cylinder(rig, cylinder, list),
        MotionKind::Rotary => motor(rig, cylinder, list),
    }
}

fn motor(rig: &Rig, motor: &Cylinder, list: &mut List) {
    list.group("Motor");
    list.add("motor.displacement", "D", motor.area_a, "m3/rad", "declared");
    if let Some(stroke) = motor.stroke.length() {
        list.add("motor.swept_volume", "V", motor.area_a * stroke, "m3", "V = D Δθ, of each chamber");
    }
    let supply = &rig.actuator.components().supply;
    let stall = motor.area_a * (supply.pressure - supply.tank_pressure);
    list.add("motor.stall_torque", "T_max", stall, "N.m", "T_{max} = D (p_S - p_T)");
}

fn cylinder(rig: &Rig, cylinder: &Cylinder, list: &mut List) {
    list.group("Cylinder");
    list.add("cylinder.area_a", "A_A", cylinder.area_a, "m2", "A_A = π/4 (D_p^2 - D_{rA}^2)");
    list.add("cylinder.area_b", "A_B", cylinder.area_b, "m2", "A_B = π/4 (D_p^2 - D_{rB}^2)");
    for (index, [area_a, area_b]) in cylinder.areas_of_stages().enumerate().skip(1) {
        let name = |side: &str| format!("cylinder.stage_{}.area_{side}", index + 1);
        list.add(name("a"), "A_A", area_a, "m2", "declared, of this stage");
        list.add(name("b"), "A_B", area_b, "m2", "declared, of this stage");
    }
    if let Some(stroke) = cylinder.stroke.length() {
        let swept =
            chamber_volumes(&Cylinder { dead_volume_a: 0.0, dead_volume_b: 0.0, ..*cylinder }, stroke)[0];
        let emptied =
            chamber_volumes(&Cylinder { dead_volume_a: 0.0, dead_volume_b: 0.0, ..*cylinder }, 0.0)[1];
        let equations = match cylinder.stroke.telescope() {
            Some(_) => ["V_A = integral of A_A over the stroke", "V_B = integral of A_B over the stroke"],
            None => ["V_A = A_A L", "V_B = A_B L"],
        };
        list.add("cylinder.swept_volume_a", "V_A", swept, "m3", equations[0]);
        list.add("cylinder.swept_volume_b", "V_B", emptied, "m3", equations[1]);
    }
    let [pull, stall] = cylinder.stall_forces(&rig.actuator.components().supply);
    list.add("cylinder.stall_force", "F_max", stall, "N", "F_{max} = A_A p_S - A_B p_T");
    list.add("cylinder.stall_force_retracting", "F_min", pull, "N", "F_{min} = A_A p_T - A_B p_S");
}

fn lines(rig: &Rig, list: &mut List) {
    let components = rig.actuator.components();
    let moduli =
        [rig.point.pressure_a, rig.point.pressure_b].map(|pressure| components.fluid.modulus_at(pressure));
    let sides = [("a", components.line_a, moduli[0]), ("b", components.line_b, moduli[1])];
    let same = components.line_a == components.line_b && moduli[0] == moduli[1];
    list.group("Lines");
    list.add(
        "fluid.bulk_modulus_at_pressure",
        "β_0",
        moduli[0],
        "Pa",
        "β_0(p) = -V dp/dV, entrained air included",
    );
    for (side, line, modulus) in sides.into_iter().take(if same { 1 } else { 2 }) {
        let name = |quantity: &str| {
            if same { format!("line.{quantity}") } else { format!("line.{side}.{quantity}") }
        };
        list.add(name("volume"), "V_ho", line.volume(), "m3", "V_{ho} = π/4 D_{ho}^2 L_{ho}");
        if let Line::Hose { hose, .. } = line {
            hose_wall(hose, &name, list);
        }
        let effective = line.effective_modulus(modulus, StiffeningMember::Nominal);
        list.add(name("effective_modulus"), "β_e", effective, "Pa", "1/β_e = 1/β_0 + 1/β_{ho}");
        if let Line::Hose { .. } = line {
            let softest = line.effective_modulus(modulus, StiffeningMember::Minimum);
            list.add(
                name("effective_modulus_minimum"),
                "β_e",
                softest,
                "Pa",
                "β_e at the least stiffening r_β",
            );
            let stiffest = line.effective_modulus(modulus, StiffeningMember::Maximum);
            list.add(
                name("effective_modulus_maximum"),
                "β_e",
                stiffest,
                "Pa",
                "β_e at the greatest stiffening r_β",
            );
        }
        let compliance = line.compliance(modulus, StiffeningMember::Nominal);
        let equation = match line {
            Line::Hose { .. } => "C_{ho} = ε L_{ho}/r_β + (A_{ho} + E(p)) L_{ho}/β_0",
            Line::Pipe { .. } | Line::Volume { .. } => "C_{ho} = V_{ho}/β_e",
        };
        list.add(name("compliance"), "C_ho", compliance, "m3/Pa", equation);
        // a wave runs in the oil that fills the bore
        let filled = line.filled().effective_modulus(modulus, StiffeningMember::Nominal);
        let wave_speed = (filled / components.fluid.density).sqrt();
        list.add(name("wave_speed"), "c", wave_speed, "m/s", "c = sqrt(β_e(p)/ρ)");
        if let Line::Hose { length, .. } | Line::Pipe { length, .. } = line {
            list.add(name("wave_travel_time"), "T", length / wave_speed, "s", "T = L_{ho}/c");
        }
    }
}

fn hose_wall(hose: Hose, name: &impl Fn(&str) -> String, list: &mut List) {
    list.add(
        name("volumetric_expansion"),
        "E",
        hose.volumetric_expansion,
        "m3/m",
        "E(p_S) = E_1 + ε (p_S - p_1)",
    );
    list.add(
        name("operating_expansion"),
        "E(p)",
        hose.operating_expansion,
        "m3/m",
        "E(p) = E_1 + ε (p - p_1), p = (p_S + p_T)/2",
    );
    list.add(name("static_modulus"), "β_hoSS", hose.static_modulus(), "Pa", "β_{hoSS} = (A_{ho} + E)/ε");
    list.add(
        name("dynamic_modulus"),
        "β_ho",
        hose.wall_modulus(StiffeningMember::Nominal),
        "Pa",
        "β_{ho} = r_β β_{hoSS}",
    );
}

fn stiffness(rig: &Rig, list: &mut List) {
    let components = rig.actuator.components();
    let declared = stroke_stiffness(rig, StiffeningMember::Nominal);
    list.group("Stiffness");
    let motion = list.motion;
    let (symbol, unit) = (motion.symbols().stiffness, list.si(&STIFFNESS));
    let [least, greatest] = motion.either(
        ["K_H = min over x of A_A^2/C_A + A_B^2/C_B", "K_H = max over x of A_A^2/C_A + A_B^2/C_B"],
        ["K_θ = min over θ of D^2 (1/C_A + 1/C_B)", "K_θ = max over θ of D^2 (1/C_A + 1/C_B)"],
    );
    list.add("stiffness.minimum", symbol, declared.minimum, unit, least);
    if components.cylinder.stroke.length().is_some() {
        let (name, flat) = motion.either(
            ("stiffness.minimum_position", "dK_H/dx = 0"),
            ("stiffness.minimum_angle", "dK_θ/dθ = 0"),
        );
        let place = motion.symbols().position;
        list.add(name, place, declared.minimum_position, list.si(&LENGTH), flat);
    }
    list.add("stiffness.maximum", symbol, declared.maximum, unit, greatest);
    let models = stiffness_models(rig);
    let uniform = motion.either("C_A = (V_{ho} + V_{A0} + A_A x)/β_e", "C_A = (V_{ho} + V_{A0} + D θ)/β_e");
    list.add("stiffness.uniform.minimum", symbol, models.uniform.minimum, unit, uniform);
    list.add("stiffness.uniform.maximum", symbol, models.uniform.maximum, unit, uniform);
    let by_volume = motion.either("C_A = C_{ho} + (V_{A0} + A_A x)/β_0", "C_A = C_{ho} + (V_{A0} + D θ)/β_0");
    list.add("stiffness.by_volume.minimum", symbol, models.by_volume.minimum, unit, by_volume);
    list.add("stiffness.by_volume.maximum", symbol, models.by_volume.maximum, unit, by_volume);
    if let Line::Hose { .. } = components.line_a {
        let soft = stroke_stiffness(rig, StiffeningMember::Minimum).minimum;
        let equation =
            motion.either("least K_H at the least stiffening r_β", "least K_θ at the least stiffening r_β");
        list.add("stiffness.minimum_softest_wall", symbol, soft, unit, equation);
        let stiff = stroke_stiffness(rig, StiffeningMember::Maximum).maximum;
        let equation = motion.either(
            "greatest K_H at the greatest stiffening r_β",
            "greatest K_θ at the greatest stiffening r_β",
        );
        list.add("stiffness.maximum_stiffest_wall", symbol, stiff, unit, equation);
    }
}

fn equilibrium(rig: &Rig, list: &mut List) {
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

fn linear_parameters(rig: &Rig, list: &mut List) {
    list.group("Linear model");
    let slopes = match rig.actuator.components().outward.external_leakage {
        None => list.motion.either(SLOPES, SLOPES_OF_A_MOTOR),
        Some(_) => "1/K_c = 1/(K_{cA} + G_e) + 1/(K_{cB} + G_e), with the leakage G_e through the case",
    };
    let (motion, symbols) = (list.motion, list.motion.symbols());
    let flow_gain = motion.either(FLOW_GAIN, FLOW_GAIN_OF_A_MOTOR);
    let stiffness = motion.either(
        "K_H = A_A^2/C_A + A_B^2/C_B at the operating point",
        "K_θ = D^2 (1/C_A + 1/C_B) at the operating point",
    );
    for parameter in &rig.parameters {
        let (symbol, unit, equation) = match parameter.name {
            "viscous_friction" => ("f_v", list.si(&DAMPING), "f_v = slope of the viscous part"),
            "flow_gain" => ("K_qU", "m3/(s.V)", flow_gain),
            "flow_pressure_coefficient" => ("K_c", "m3/(s.Pa)", slopes),
            "hydraulic_stiffness" => (symbols.stiffness, list.si(&STIFFNESS), stiffness),
            "valve_natural_frequency" => ("ω_nv", "rad/s", "declared for the valve"),
            "valve_damping_ratio" => ("ξ_v", "1", "declared for the valve"),
            "moving_mass" => (
                symbols.mass,
                list.si(&MASS),
                motion.either("declared for the cylinder", "declared for the motor"),
            ),
            "piston_area" if motion.is_rotary() => ("D", "m3/rad", "declared for the motor"),
            "piston_area" => ("A_u", "m2", "A_u = (A_A + A_B)/2"),
            _ => (
                "K_S",
                list.si(&STIFFNESS),
                motion.either("declared for the force sensor", "declared for the torque sensor"),
            ),
        };
        list.add(format!("linear.{}", parameter.name), symbol, parameter.derived, unit, equation);
        match parameter.origin {
            ParameterOrigin::Linear => list.stated(parameter.value, "[linear]", parameter.bounds),
            ParameterOrigin::Uncertainty => list.stated(parameter.value, "[uncertainty]", parameter.bounds),
            ParameterOrigin::Derived => {}
        }
    }
}

fn friction(rig: &Rig, list: &mut List) {
    let Friction::LuGre(lugre) = &rig.actuator.components().friction else { return };
    list.group("Friction");
    let levels = lugre.curve.both_levels();
    let least =
        levels.map(|levels| levels.passive_viscous(lugre.bristle_damping)).into_iter().fold(0.0, f64::max);
    let equation = list
        .motion
        .either("σ_2 >= σ_1 (F_S - F_C)/F_C for passivity", "σ_2 >= σ_1 (T_S - T_C)/T_C for passivity");
    list.add("friction.passive_viscous_minimum", "σ_2", least, list.si(&DAMPING), equation);
}

/// The speed at which the flow of the pump drives the piston, for each direction if they differ.
fn piston_speed(flow: f64, [area_a, area_b]: [f64; 2], list: &mut List) {
    let unit = list.si(&VELOCITY);
    let differs = area_a.total_cmp(&area_b).is_ne();
    let equation = match (list.motion.is_rotary(), differs) {
        (true, _) => "ω_{max} = q_{pump}/D",
        (false, false) => "v_{max} = q_{pump}/A, in both directions",
        (false, true) => "v_{max} = q_{pump}/A_A, extending",
    };
    let (name, symbol) =
        list.motion.either(("supply.piston_speed", "v_max"), ("supply.shaft_speed", "ω_max"));
    list.add(name, symbol, flow / area_a, unit, equation);
    if differs {
        let equation = "v_{max} = q_{pump}/A_B, retracting";
        list.add("supply.piston_speed_retracting", "v_max", flow / area_b, unit, equation);
    }
}

fn flow(project: &Project, rig: &Rig, list: &mut List) {
    let Some(declared) = &project.actuator else { return };
    let components = rig.actuator.components();
    list.group("Flow");
    if let Some(flow) = declared.supply.flow() {
        piston_speed(flow, components.cylinder.greatest_areas(), list);
    }
    let largest = largest_flow(components, &declared.supply);
    let equation = match largest.limit {
        FlowLimit::Pump => "v_{oil} = 4 q/(π D_{ho}^2), unloaded, q_{pump} into the valve",
        FlowLimit::Valve => "v_{oil} = 4 q/(π D_{ho}^2), unloaded, the valve fully open",
    };
    let (a, b) = (components.line_a, components.line_b);
    let [flow_a, flow_b] = largest.lines;
    let lines = match a == b {
        true => vec![("line", a, largest.line())],
        false => vec![("line.a", a, flow_a), ("line.b", b, flow_b)],
    };
    for (name, line, flow) in lines {
        let bore = match line {
            Line::Hose { hose, .. } => hose.bore,
            Line::Pipe { pipe, .. } => pipe.bore,
            Line::Volume { .. } => continue,
        };
        let velocity = 4.0 * flow / (std::f64::consts::PI * bore * bore);
        list.add(format!("{name}.oil_velocity"), "v_oil", velocity, "m/s", equation);
    }
}

/// The values of the valve that `[sizing]` states, next to the derived ones.
fn sizing(project: &Project, rig: &Rig, list: &mut List) {
    let Some(sizing) = &project.sizing else { return };
    list.group("Sizing");
    if let Some(flow_gain) = sizing.flow_gain {
        list.add("sizing.flow_gain", "K_qU", rig.derived.flow_gain, "m3/(s.V)", FLOW_GAIN);
        list.stated(flow_gain, "[sizing]", None);
    }
    if let Some(coefficient) = sizing.flow_pressure_coefficient {
        let derived = rig.derived.flow_pressure_coefficient;
        list.add("sizing.flow_pressure_coefficient", "K_c", derived, "m3/(s.Pa)", SLOPES);
        list.stated(coefficient, "[sizing]", None);
    }
}
