//! Machines on which a verdict is tested: the declared one, the worst plants of the audit made into
//! rigs, and the rig with waves in its lumped lines.

use std::sync::Arc;

use phea_dynamics::uncertain_plant::PlantMember;
use phea_hydraulics::series::MOST_SEGMENTS;
use phea_qft::family::Family;
use phea_qft::verification::PlantPoint;

use super::reason::{MissedParameter, NoRig, NotDriven, TrialMachine, WorstOf};
use crate::audit::ProjectAudit;
use crate::plant_names::NamedPlant;
use crate::project::{
    Component, DeclaredActuator, DeclaredLine, DeclaredSeries, LINEAR_PARAMETERS, LineMotion, Linear,
    Project, ValveCoefficients,
};
use crate::rig::{Rig, quarter_wave, with_controller_of};
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// A machine and its plant in the linear loop.
#[derive(Clone, Debug)]
pub(super) struct TrialRig {
    pub(super) machine: TrialMachine,
    /// Plant of the audit from which it was made.
    pub(super) named: Option<NamedPlant>,
    /// Quarter-wave frequency of a rig with waves, rad/s, at which its lines begin to oscillate.
    pub(super) quarter_wave_rad_per_s: Option<f64>,
    pub(super) project: Project,
    /// `None` if no plant is known.
    pub(super) plant: Option<PlantMember>,
    /// True if its machine is that of the rig as declared: they differ at most by the side of null
    /// at which the valve is linearised.
    pub(super) is_declared: bool,
}

/// Permitted relative deviation of a parameter of the linear model from that of a plant.
const CLOSE: f64 = 1e-3;
/// Number of passes over all parameters of a plant, which affect each other slightly.
const PASSES: usize = 8;
/// Relative change of a number by which its effect on a parameter is measured.
const NUDGE: f64 = 1e-3;

/// Machines, and the reasons for plants without one.
pub(super) fn rigs(
    setup: &Setup<'_>,
    rig: &Rig,
    problem: &RobustProblem,
    view: &ProjectAudit,
) -> (Vec<TrialRig>, Vec<NotDriven>) {
    let project = setup.project;
    let seen = rig.in_loop();
    let plant = match seen.in_motion {
        None => PlantMember::Rational(seen.plant.coefficients()),
        Some(moving) => PlantMember::Responding(Arc::new(moving)),
    };
    let of = |machine: TrialMachine, project: Project, quarter_wave_rad_per_s| TrialRig {
        machine,
        named: None,
        quarter_wave_rad_per_s,
        project,
        plant: Some(plant.clone()),
        is_declared: false,
    };
    let mut rigs = vec![of(TrialMachine::Declared, project.clone(), None)];
    let waves = with_waves(project);
    rigs.extend(waves.map(|project| of(TrialMachine::WithWaves, project, quarter_wave(rig))));
    let mut missing = Vec::new();
    let mut known: Vec<&PlantPoint> = Vec::new();
    for (of, plant) in worst_plants(view) {
        let Some(numbers) = view.names.numbers(plant) else { continue };
        if known.contains(&plant) {
            continue;
        }
        known.push(plant);
        let (names, values): (Vec<&str>, Vec<f64>) = numbers.map(|(name, _, value)| (name, value)).unzip();
        // the one plant of a family without parameters is the rig as declared
        if names.is_empty() {
            continue;
        }
        match rig_with(setup, rig, &names, &values) {
            Ok(project) => rigs.push(TrialRig {
                machine: TrialMachine::WorstPlant(of),
                named: Some(view.names.named(plant)),
                quarter_wave_rad_per_s: None,
                is_declared: is_same_machine(project.clone(), setup.project.clone()),
                project,
                plant: match &problem.family {
                    Family::Uncertain(family) => family.plant().member(&values),
                    Family::Measured(_) => None,
                },
            }),
            Err(reason) => {
                missing.push(NotDriven::Plant { of, plant: view.names.named(plant), reason });
            }
        }
    }
    (rigs, missing)
}

/// Worst plant of each specification, and of each requirement in time that is part of the verdict,
/// with the criterion.
fn worst_plants(view: &ProjectAudit) -> impl Iterator<Item = (WorstOf, &PlantPoint)> {
    let of_limits = view.audit.specifications.iter().enumerate();
    let of_limits = of_limits.filter_map(|(index, finding)| {
        Some((WorstOf::Specification(view.named(index)?), &finding.worst.as_ref()?.plant))
    });
    let in_time = view.in_time.iter().filter(|finding| finding.requirement.follows);
    let in_time = in_time.filter_map(|finding| {
        let of = match finding.requirement.limits {
            Some(index) => WorstOf::InTime(view.named(index)?),
            None => WorstOf::RequiredStep,
        };
        Some((of, &finding.nearest()?.plant))
    });
    of_limits.chain(in_time)
}

/// True if two projects have equal machines, except for uncertainty and the side of null.
fn is_same_machine(one: Project, other: Project) -> bool {
    let [one, other] = [one, other].map(|mut project| {
        project.operating_point.spool_side = None;
        project.without_uncertainty()
    });
    one == other
}

/// The rig with its lumped lines as transmission lines, and a transmission in the largest number of
/// segments; `None` if no line is lumped and long, and no transmission has fewer segments.
pub fn with_waves(project: &Project) -> Option<Project> {
    let mut other = project.clone();
    let actuator = other.actuator.as_mut()?;
    let line = &mut actuator.line;
    let mut moved = false;
    if let Some(DeclaredSeries::Transmission(transmission)) = &mut actuator.series {
        moved = (transmission.segments as usize) < MOST_SEGMENTS;
        transmission.segments = MOST_SEGMENTS as u32;
    }
    for side in [&mut line.a, &mut line.b] {
        if side.length().is_some() && side.motion.is_lumped() {
            side.motion = LineMotion::TransmissionLine { end_share: None };
            moved = true;
        }
    }
    moved.then_some(other)
}

/// A machine whose sensors are without noise; `None` if they are already, and in a continuous loop,
/// which has no noise.
pub(super) fn without_noise(trial_rig: &TrialRig) -> Option<TrialRig> {
    let mut quiet = trial_rig.clone();
    let controller = quiet.project.controller.as_mut()?;
    controller.sample_time?;
    let actuator = quiet.project.actuator.as_mut()?;
    let noises = [
        Some(&mut actuator.force_sensor.noise),
        actuator.velocity_sensor.as_mut().map(|sensor| &mut sensor.noise),
        controller.pressure_feedback.as_mut().map(|feedback| &mut feedback.noise),
    ];
    let mut is_noisy = false;
    for noise in noises.into_iter().flatten() {
        is_noisy |= std::mem::take(noise) > 0.0;
    }
    is_noisy.then_some(quiet)
}

/// The declared rig with waves: without uncertainty, and without stated parameters that replace
/// derived ones, which a machine does not have. `None` if it has no additional waves.
pub(crate) fn waves_only(setup: &Setup<'_>) -> Option<Project> {
    let rig = setup.rig().ok()?;
    let alone = with_controller_of(with_waves(setup.project)?, rig);
    let operating_point = setup.project.resolved_operating_point();
    Some(Project { linear: Linear::default(), operating_point, ..alone.without_uncertainty() })
}

/// A project whose rig has these parameters: numbers of the project and of its operating point
/// directly, those of the linear model through the numbers that determine them.
pub(super) fn rig_with(
    setup: &Setup<'_>,
    declared: &Rig,
    names: &[&str],
    values: &[f64],
) -> Result<Project, NoRig> {
    let project = setup.project;
    let is_linear = |name: &str| LINEAR_PARAMETERS.iter().any(|parameter| parameter.key.name == name);
    let mut rig = with_controller_of(project.clone(), declared);
    let stated = names.iter().copied().zip(values.iter().copied()).filter(|(name, _)| !is_linear(name));
    for (name, value) in stated {
        if name == "operating_point.velocity" && value != 0.0 {
            return Err(NoRig::InMotion);
        }
        rig = rig.with_number(name, value).ok_or_else(|| NoRig::UnknownNumber(name.to_string()))?;
    }
    rig = rig.without_uncertainty();
    let wanted: Vec<(&str, f64)> =
        names.iter().copied().zip(values.iter().copied()).filter(|(name, _)| is_linear(name)).collect();
    if wanted.is_empty() {
        return Ok(rig);
    }
    let mut found = assembled(&rig)?;
    let mut missed = Vec::new();
    for _ in 0..PASSES {
        missed.clear();
        for (name, value) in &wanted {
            let now = derived(&found, name)?;
            if (now - value).abs() > CLOSE * value.abs() {
                missed.push(MissedParameter { name: (*name).to_string(), found: now, wanted: *value });
                rig = towards(&rig, name, now, *value)?;
                found = assembled(&rig)?;
            }
        }
        if missed.is_empty() {
            return Ok(rig);
        }
    }
    Err(NoRig::Missed(missed))
}

fn assembled(project: &Project) -> Result<Rig, NoRig> {
    Ok(Setup::rig_of(project)?)
}

/// Parameter of the linear model as derived from the rig.
fn derived(rig: &Rig, name: &str) -> Result<f64, NoRig> {
    let found = rig.parameters.iter().find(|parameter| parameter.name == name);
    found.map(|parameter| parameter.derived).ok_or_else(|| NoRig::UnknownParameter(name.to_string()))
}

/// The rig after one secant step, in the logarithm, of the numbers that determine this parameter.
fn towards(project: &Project, name: &str, now: f64, wanted: f64) -> Result<Project, NoRig> {
    use phea_dynamics::portable::{ln, pow};
    let nudged = assembled(&scaled(project, name, 1.0 + NUDGE)?)?;
    let slope = ln(derived(&nudged, name)? / now) / ln(1.0 + NUDGE);
    if slope.is_nan() || slope.abs() < 1e-6 {
        return Err(NoRig::Fixed(name.to_string()));
    }
    scaled(project, name, pow(wanted / now, 1.0 / slope))
}

/// The rig with the numbers that determine a parameter of the linear model multiplied by a factor.
fn scaled(project: &Project, name: &str, factor: f64) -> Result<Project, NoRig> {
    let mut rig = project.clone();
    let Some(actuator) = rig.actuator.as_mut() else { return Err(NoRig::NoActuator) };
    let numbers = behind(actuator, name);
    if numbers.is_empty() {
        return Err(NoRig::Coupled(name.to_string()));
    }
    for number in numbers {
        *number *= factor;
    }
    Ok(rig)
}

/// Numbers that determine a parameter of the linear model and affect others as little as possible.
fn behind<'a>(actuator: &'a mut DeclaredActuator, name: &str) -> Vec<&'a mut f64> {
    match name {
        "viscous_friction" => {
            actuator.friction_mut().map(|friction| friction.law.viscous_mut()).into_iter().collect()
        }
        "flow_gain" => match &mut actuator.valve.flow {
            ValveCoefficients::Edges { edges, .. } => edges.each_mut().into(),
            ValveCoefficients::Rated(rated) => vec![&mut rated.flow],
        },
        "flow_pressure_coefficient" => match &mut actuator.valve.leakage {
            ValveCoefficients::Edges { edges, .. } => edges.each_mut().into(),
            ValveCoefficients::Rated(_) => Vec::new(),
        },
        "hydraulic_stiffness" => {
            let line = &mut actuator.line;
            let walls: Vec<&mut f64> = [&mut line.a, &mut line.b].into_iter().flat_map(walls).collect();
            if walls.is_empty() { vec![&mut actuator.fluid.bulk_modulus] } else { walls }
        }
        "valve_natural_frequency" => vec![&mut actuator.valve.natural_frequency],
        "valve_damping_ratio" => vec![&mut actuator.valve.damping_ratio],
        "moving_mass" => vec![actuator.moving_mass_mut()],
        "sensor_stiffness" => vec![&mut actuator.force_sensor.stiffness],
        _ => Vec::new(),
    }
}

/// The stated modulus of a line, or the stiffening of its wall.
fn walls(line: &mut DeclaredLine) -> Vec<&mut f64> {
    let stiffening = line.dynamic_stiffening.iter_mut();
    let of_wall = stiffening.flat_map(|one| [&mut one.nominal, &mut one.minimum, &mut one.maximum]);
    let outright = match &mut line.component {
        Component::Volume(given) => Some(&mut given.effective_bulk_modulus),
        Component::Hose { .. } | Component::Pipe { .. } => None,
    };
    outright.into_iter().chain(of_wall).collect()
}
