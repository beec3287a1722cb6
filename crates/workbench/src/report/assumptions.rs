//! The assumptions of the models of a rig, each only if the project has the part that it concerns.

use phea_dynamics::portable;
use phea_hydraulics::stiffness::StiffnessModel;

use crate::answer::significant;
use crate::project::{
    DeclaredActuator, DeclaredLine, LineMotion, Load, Project, SETTLING_BAND_PERCENT, Speed, SupplyModel,
};

/// The assumptions of the models.
pub(super) fn assumptions(project: &Project) -> Vec<String> {
    let Some(actuator) = &project.actuator else {
        return vec![
            "The plant is what the project states: a transfer function in its whole box, or measured responses."
                .to_string(),
        ];
    };
    let mut sentences: Vec<&str> = vec![supply(actuator)];
    sentences.extend(lines(actuator));
    let sizing = project.sizing.as_ref().map(|sizing| first_order(sizing.speed));
    sentences.extend(friction(actuator));
    let moves = match actuator.load {
        Load::Prescribed => "The load moves as prescribed",
        _ => "The load is the declared one",
    };
    let sensor = actuator.motion().words().force_sensor;
    let load = format!("{moves}; the {sensor}'s stiffness includes what it is mounted on.");
    sentences.push(&load);
    sentences.extend(sizing.as_deref());
    if actuator.fluid.entrained_air.is_none_or(|fraction| fraction == 0.0) {
        sentences.push("The oil carries no free air.");
    }
    sentences.extend(velocity(project));
    sentences.extend(pressures(project));
    sentences.into_iter().map(str::to_string).collect()
}

/// The response that the sizing assumes; its deviation from the final value is e^(-t/T).
fn first_order(speed: Speed) -> String {
    let (given, band_percent) = match speed {
        Speed::TimeConstant(_) => ("its time constant is stated", SETTLING_BAND_PERCENT),
        Speed::Settling(settling) => {
            ("its time constant follows from the stated settling time", settling.band_percent)
        }
    };
    let constants = portable::ln(100.0 / band_percent);
    format!(
        "The sizing takes a response of first order: {given}, and it settles to {band_percent} % in {} time constants.",
        significant(constants, 3)
    )
}

fn supply(actuator: &DeclaredActuator) -> &'static str {
    match actuator.supply.model {
        SupplyModel::Constant { flow: Some(_) } => {
            actuator.motion().either(
                "Pressures are gauge; tank and supply stay at the declared pressures, whatever the valve takes: `supply.flow` limits the sizing, the speeds of the piston and an operating region, and with `supply.model = \"constant\"` no simulation and no linear plant.",
                "Pressures are gauge; tank and supply stay at the declared pressures, whatever the valve takes: `supply.flow` limits the sizing, the speeds of the shaft and an operating region, and with `supply.model = \"constant\"` no simulation and no linear plant.",
            )
        }
        SupplyModel::Constant { flow: None } => {
            "Pressures are gauge; tank and supply stay at the declared pressures, whatever the valve takes."
        }
        SupplyModel::PumpLimited(_) => {
            "Pressures are gauge; the tank stays at the declared pressure; the supply pressure falls with the demand in the simulation and in the plant of the loop, and is constant in the other linear models."
        }
    }
}

/// Assumptions of the models on the lines of the rig.
fn lines(actuator: &DeclaredActuator) -> Vec<&'static str> {
    let sides = || [&actuator.line.a, &actuator.line.b].into_iter();
    let any = |has: &dyn Fn(&DeclaredLine) -> bool| sides().any(has);
    let creeps = |line: &DeclaredLine| match line.motion {
        LineMotion::Creeping { .. } => true,
        LineMotion::Segments(segments) => segments.relaxation_time.is_some(),
        _ => false,
    };
    let stiffens = |line: &DeclaredLine| {
        line.hose().is_some() && line.dynamic_stiffening.as_ref().is_some_and(|ratio| ratio.nominal != 1.0)
    };
    let mut sentences = Vec::new();
    if any(&|line| line.hose().is_some()) {
        sentences.push(match actuator.line.compliance {
            StiffnessModel::Uniform => "Volumetric expansion and wall modulus of a hose are taken at the supply pressure (`uniform`); between the stated point and another pressure the expansion follows the slope of the catalogue, and a supply beyond the point causes a warning.",
            StiffnessModel::ByVolume => "Volumetric expansion of a hose is taken at the mean of supply and tank pressure (`by_volume`), and its compliance is the slope of the catalogue; a supply beyond the stated point causes a warning.",
        });
    }
    if any(&|line| stiffens(line) && creeps(line)) {
        sentences.push("The wall of a hose creeps: it has its dynamic modulus for fast motions, its static one at rest, and passes from one to the other with the declared relaxation time.");
    }
    if any(&|line| stiffens(line) && !creeps(line)) {
        sentences.push("The wall of a hose has its dynamic modulus at every frequency; at rest it is softer by the stiffening ratio.");
    }
    if any(&|line| line.length().is_some() && !line.motion.has_waves()) {
        sentences.push("A line has one pressure over its length: no waves travel in it.");
    }
    if sides().any(|line| line.length().is_some()) {
        sentences.push(match actuator.line.compliance {
            StiffnessModel::Uniform => {
                "The effective bulk modulus of a line applies to its chamber too (`uniform`)."
            }
            StiffnessModel::ByVolume => "Chamber and line each have the modulus of their own (`by_volume`).",
        });
    }
    sentences
}

fn friction(actuator: &DeclaredActuator) -> Option<&'static str> {
    let law = &actuator.friction()?.law;
    law.curve().is_some().then_some(
        "Friction enters the linear models by its viscous part alone; the simulation has all of it.",
    )
}

/// Source of the chamber pressures, if they are fed back.
fn pressures(project: &Project) -> Option<&'static str> {
    let controller = project.controller.as_ref()?;
    let fed = controller.pressure_feedback.filter(|fed| fed.gain != 0.0)?;
    Some(match (controller.sample_time, fed.noise > 0.0) {
        (Some(_), true) => {
            "The pressures that are fed back are those of the chambers, without delay or error of their sensors, with white noise at the samples."
        }
        (None, _) | (_, false) => {
            "The pressures that are fed back are those of the chambers, without delay, error or noise of their sensors."
        }
    })
}

/// Source of the velocity of the load, if it is fed forward.
fn velocity(project: &Project) -> Option<&'static str> {
    let fed = project.controller.as_ref()?.load_velocity_feed_forward?;
    let sensor = project.actuator.as_ref()?.velocity_sensor.as_ref();
    (fed.gain != Some(0.0)).then_some(match sensor {
        None => "The load velocity that is fed forward is known exactly and at once.",
        Some(_) => "The load velocity that is fed forward is what its sensor shows, whose filter and delay are known exactly.",
    })
}
