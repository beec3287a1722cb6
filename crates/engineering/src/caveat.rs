//! Effects that the project declares but a verdict on the linear loop does not include.
//!
//! A simulation includes the whole machine. Anything that the linear plant cannot represent is
//! stated before the verdict; if a specification depends on it, the verdict is not proven.

mod beyond_reach;
mod effect;
mod fed;
mod friction_directions;
mod leakage_humps;
mod misfit;
mod moved_roots;
mod null_sides;
mod outside_family;
pub(crate) mod overlap;

use phea_hydraulics::cross_port::Restrictor;
use phea_hydraulics::operating_point::Condition;
use phea_hydraulics::port_valves::{PortValveKind, ValveAtPoint, ValveOpening};

use beyond_reach::beyond_reach;
use fed::{fed_in_loop, feed_forward, impedance, measured_without_pressures, pressures_in_loop};
use friction_directions::friction_directions;
use leakage_humps::leakage_humps;
use misfit::misfits;
use moved_roots::moved_roots;
use overlap::overlap;

pub use effect::{CountedSettings, FeedForwardObstacle, UncountedEffect};
pub use misfit::{MISFIT_BOUND, MisfitConsequence, UnexplainedKind, UnexplainedPart, unexplained_parts};
pub use outside_family::{LoopWithRig, OutsideFamily};

use crate::family::shut_gas;
use crate::project::{CrossPortKind, DeclaredSeries, Load, Project, Pump, SupplyModel};
use crate::rig::{ChargedRange, Rig, accumulator_place, charged_range, cross_port_at_point, waves_right_to};
use crate::setup::Setup;

/// A declared effect that the linear loop does not include.
#[derive(Clone, Debug, PartialEq)]
pub struct Caveat {
    /// The effect, with its numbers.
    pub effect: UncountedEffect,
    /// True if the effect may violate a specification that the linear loop satisfies.
    pub unproven: bool,
}

impl Caveat {
    /// Caveat for an effect that does not change the verdict.
    fn noted(effect: UncountedEffect) -> Caveat {
        Caveat { effect, unproven: false }
    }
}

/// Declared effects that no linear loop includes.
pub fn caveats(setup: &Setup<'_>) -> Vec<Caveat> {
    let of_rig =
        supply(setup).into_iter().chain(accumulator(setup)).chain(cross_port(setup)).chain(neck(setup));
    let of_rig = of_rig.chain(adjustment(setup)).chain(gas_valve(setup)).chain(port_valves(setup));
    let of_rig = apart_from_lines(setup).chain(of_rig).chain(progression(setup)).chain(segments(setup));
    let of_valve = leakage_humps(setup).into_iter().chain(overlap(setup)).map(Caveat::noted);
    of_valve
        .chain(misfits(setup))
        .chain(beyond_reach(setup))
        .chain(friction_directions(setup))
        .chain(of_rig)
        .chain(moved_roots(setup))
        .chain(blocked_piston(setup))
        .collect()
}

/// Caveat for a region of positions under only the force of a piston that is blocked at null.
fn blocked_piston(setup: &Setup<'_>) -> Option<Caveat> {
    let region = setup.project.family.as_ref()?.operating_region.as_ref()?;
    let rig = setup.rig().ok()?;
    let blocked = matches!(rig.condition, Condition::Command(command) if command == 0.0);
    if region.load_force.is_some() || region.velocity.is_some() || !blocked {
        return None;
    }
    let (force, parts) = (rig.point.hydraulic_force, rig.actuator.components());
    let is_visible = force.abs() > LEAST_FORCE * parts.cylinder.greatest_areas()[0] * parts.supply.pressure;
    is_visible.then(|| Caveat::noted(UncountedEffect::BlockedPiston { force }))
}

/// Fraction of the largest force above which the force changes a plant.
const LEAST_FORCE: f64 = 1e-3;

/// Declared effects that no linear model includes.
pub fn of_models(setup: &Setup<'_>) -> Vec<UncountedEffect> {
    let project = setup.project;
    let others = apart_from_lines(setup).map(|caveat| caveat.effect);
    lumped(project)
        .into_iter()
        .chain(others)
        .chain(constant_supply(project))
        .chain(fed_between_chambers(project))
        .chain(of_gas(project))
        .chain(fed_in_loop(setup))
        .chain(pressures_in_loop(project))
        .chain(beside_spring(project))
        .chain(fixed_setting(project))
        .chain(null_sides::null_sides(setup))
        .chain(leakage_humps(setup))
        .chain(overlap(setup))
        .chain(misfits(setup).into_iter().map(|caveat| caveat.effect))
        .collect()
}

/// Caveat for a progressive spring, which is linearised at the operating point.
fn progression(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let declared = setup.project.actuator.as_ref()?.series.as_ref()?.spring()?;
    let progression = declared.progression?;
    let counted = setup.rig().ok()?.plant.series?.stiffness();
    let stiffest = declared.stiffness * (1.0 + 3.0 * progression);
    Some(Caveat::noted(UncountedEffect::ProgressiveSpring { counted, at_rest: declared.stiffness, stiffest }))
}

/// Caveat for the waves of a transmission beyond the resolution of its segments.
fn segments(setup: &Setup<'_>) -> Option<Caveat> {
    let declared = setup.project.actuator.as_ref()?.series.as_ref()?.transmission()?;
    let right_to = waves_right_to(setup.rig().ok()?)?;
    Some(Caveat::noted(UncountedEffect::TransmissionSegments { segments: declared.segments, right_to }))
}

/// Effect of an adjusted setting, since a linear model has fixed settings.
fn fixed_setting(project: &Project) -> Option<UncountedEffect> {
    let adjusted: Vec<_> = project.actuator.as_ref()?.adjustments().into_iter().flatten().collect();
    let moves_gas = adjusted.iter().any(|one| one.valve().is_none());
    (!adjusted.is_empty()).then_some(UncountedEffect::FixedSetting { moves_gas })
}

/// Effects of a series element that the models with one load pressure do not include.
fn beside_spring(project: &Project) -> Option<UncountedEffect> {
    match project.actuator.as_ref()?.series.as_ref()? {
        DeclaredSeries::Spring(spring) => {
            let (damping, mass) = (spring.damping.is_some(), spring.mass.is_some());
            (damping || mass).then_some(UncountedEffect::SeriesParts { damping, mass })
        }
        DeclaredSeries::Transmission(_) => Some(UncountedEffect::TransmissionAsSpring),
    }
}

/// Effects that no linear model includes, except those of the lines.
fn apart_from_lines(setup: &Setup<'_>) -> impl Iterator<Item = Caveat> {
    let project = setup.project;
    let fed = [feed_forward(project), measured_without_pressures(project), impedance(setup)];
    [load(project), stages(project)].into_iter().chain(fed).flatten()
}

/// Caveat for a telescopic piston, whose areas are those of each operating point.
fn stages(project: &Project) -> Option<Caveat> {
    let declared = project.actuator.as_ref()?;
    if declared.motor.is_some() || declared.cylinder.stages.is_empty() {
        return None;
    }
    let region = project.family.as_ref().and_then(|family| family.operating_region.as_ref());
    let in_region = region.is_some_and(|region| region.velocity.is_some());
    let moves =
        in_region || project.resolved_operating_point().velocity.is_some_and(|velocity| velocity != 0.0);
    Some(Caveat { effect: UncountedEffect::TelescopicStages { moves }, unproven: moves })
}

/// Caveat for a wall without a stated mass of the load.
fn load(project: &Project) -> Option<Caveat> {
    let load = &project.actuator.as_ref()?.load;
    matches!(load, Load::Wall { mass: None, .. })
        .then_some(Caveat { effect: UncountedEffect::WallWithoutMass, unproven: true })
}

/// Effects of the lines that the models of a linearisation do not include.
fn lumped(project: &Project) -> Option<UncountedEffect> {
    let (key, model) = moving(project)?;
    Some(UncountedEffect::LinesInMotion { key, model })
}

/// Key that declares waves in the lines, and its word.
fn moving(project: &Project) -> Option<(&'static str, &'static str)> {
    let line = &project.actuator.as_ref()?.line;
    let [a, b] = [&line.a, &line.b].map(|line| &line.motion);
    let (place, motion) = match (a, b) {
        (a, b) if a.is_lumped() && b.is_lumped() => return None,
        (a, b) if a.model() == b.model() => ("line.model", a),
        (a, b) if a.is_lumped() => ("line.b.model", b),
        (a, _) => ("line.a.model", a),
    };
    Some((place, motion.model()))
}

/// Caveat for a limited supply. Its effect is included for small motions, but not for a large step;
/// if more flow is taken than the pump delivers, there is no equilibrium about which to linearise.
fn supply(setup: &Setup<'_>) -> Option<Caveat> {
    let project = setup.project;
    let supply = &project.actuator.as_ref()?.supply;
    let SupplyModel::PumpLimited(Pump { flow: delivered, .. }) = supply.model else { return None };
    if is_measured(project) {
        return None;
    }
    let found = setup.rig().ok()?.supply?;
    let (pressure, taken) = (found.supply.pressure, found.taken);
    let effect = UncountedEffect::LimitedPump { pressure, taken, delivered };
    Some(Caveat { effect, unproven: taken >= delivered })
}

/// Caveat for the gas of accumulators, which is counted at the pressures of each operating point;
/// if a force empties one of them, the actuator becomes as stiff as without it.
fn accumulator(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let declared = setup.project.actuator.as_ref()?;
    let ChargedRange { least, greatest } = charged_range(setup.rig().ok()?)?;
    let [of_a, of_b] = accumulator_place(declared);
    let of_family = shut_gas(setup).ok().flatten();
    let shut_beyond = [least, greatest].map(|point| point.map(|point| point.hydraulic_force));
    let key = match shut_beyond {
        [None, None] => {
            if of_family.as_ref()?.side == 'A' {
                of_a
            } else {
                of_b
            }
        }
        [None, Some(_)] => of_b,
        [Some(_), _] => of_a,
    };
    Some(Caveat::noted(UncountedEffect::Gas { key, shut_beyond, of_family }))
}

/// Caveat for the loss at the ends of a neck, which has zero slope at zero flow.
fn neck(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let line = &setup.project.actuator.as_ref()?.line;
    let gas = [&line.a, &line.b].into_iter().filter_map(|side| side.accumulator.as_ref());
    let loses = gas.filter_map(|gas| gas.neck).any(|neck| neck.loss_coefficient > 0.0);
    loses.then_some(Caveat::noted(UncountedEffect::NeckLoss))
}

/// Caveat for an adjustment, since a verdict is for fixed settings.
fn adjustment(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let adjusted = setup.project.actuator.as_ref()?.adjustments();
    let first = adjusted.into_iter().flatten().next()?;
    let mut ranges = setup.project.uncertainty.iter();
    let range = ranges.find(|uncertain| uncertain.name.ends_with(SETTING_PATH));
    let settings = match (range, adjusted) {
        (Some(range), _) => CountedSettings::Range([range.minimum, range.maximum]),
        (None, [Some(a), Some(b)]) if a.setting != b.setting => {
            CountedSettings::OfSides([a, b].map(|one| one.setting.unwrap_or(0.0)))
        }
        (None, _) => CountedSettings::OfRest(first.setting.unwrap_or(0.0)),
    };
    let moves_gas = adjusted.into_iter().flatten().any(|one| one.valve().is_none());
    Some(Caveat::noted(UncountedEffect::Adjustment { settings, moves_gas }))
}

/// End of the path of a setting.
const SETTING_PATH: &str = "accumulator.adjustment.setting";
const TRANSITION_PATH: &str = "accumulator.adjustment.transition_pressure";

/// Caveat for a valve between chamber and gas, which has no drop at rest, and there the slope of
/// its transition.
fn gas_valve(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let components = *setup.rig().ok()?.actuator.components();
    let valves = [0, 1].map(|side| components.gas_in_use(side)?.valve());
    let valve = valves.into_iter().flatten().next()?;
    let covers = |name: &String| name.ends_with(SETTING_PATH) || name.ends_with(TRANSITION_PATH);
    let has_range = setup.project.uncertainty.iter().any(|uncertain| covers(&uncertain.name));
    let effect = UncountedEffect::GasValve { transition_pressure: valve.transition_pressure, has_range };
    Some(Caveat { effect, unproven: !has_range })
}

/// Necks and heat of accumulators, which the models of a linearisation do not include.
fn of_gas(project: &Project) -> Option<UncountedEffect> {
    let line = &project.actuator.as_ref()?.line;
    let gas = [&line.a, &line.b].into_iter().filter_map(|side| side.accumulator.as_ref());
    let (necks, heat) = gas.fold((false, false), |(necks, heat), gas| {
        (necks || gas.neck.is_some(), heat || gas.thermal_time_constant.is_some())
    });
    let valve = project.actuator.as_ref()?.adjustments().into_iter().flatten().any(|of| of.valve().is_some());
    (necks || heat || valve).then_some(UncountedEffect::GasOutsideModels { necks, heat })
}

/// Pressure drop of an orifice, in transition pressures, below which its slope is that of the
/// transition.
const IN_TRANSITION: f64 = 10.0;

/// Caveat for an orifice between the chambers, which has the slope of its transition if it has no
/// drop: the larger an oscillation, the less it damps.
fn cross_port(setup: &Setup<'_>) -> Option<Caveat> {
    let project = setup.project;
    if is_measured(project) {
        return None;
    }
    let found = cross_port_at_point(setup.rig().ok()?)?;
    let Restrictor::Orifice { transition_pressure, .. } = found.valve.restrictor else { return None };
    let drop = found.valve.capacity.is_none().then_some(found.drop);
    if drop.unwrap_or(0.0).abs() >= IN_TRANSITION * transition_pressure {
        return None;
    }
    let has_range = project.uncertainty.iter().any(|uncertain| uncertain.name == CROSS_PORT_TRANSITION);
    let conductance = found.conductance;
    let effect = UncountedEffect::CrossPortOrifice { drop, transition_pressure, conductance, has_range };
    Some(Caveat { effect, unproven: !has_range })
}

/// Caveats for relief and check valves that small motions about the operating point do not
/// represent, unless the plants were measured.
fn port_valves(setup: &Setup<'_>) -> Vec<Caveat> {
    let Some(rig) = setup.rig().ok().filter(|_| !is_measured(setup.project)) else { return Vec::new() };
    let caveat = |(side, valve): (char, ValveAtPoint)| {
        let unproven = valve.opening == ValveOpening::InTransition;
        Caveat { effect: UncountedEffect::PortValve { side, valve }, unproven }
    };
    acting_port_valves(rig).into_iter().map(caveat).collect()
}

/// Relief and check valves that are open or within their transition at the operating point, and
/// shut relief valves that open within the pressure of the supply, each with its chamber.
pub(crate) fn acting_port_valves(rig: &Rig) -> Vec<(char, ValveAtPoint)> {
    let components = rig.actuator.components();
    let pressures = [rig.point.pressure_a, rig.point.pressure_b];
    let sides = components.outward.port_valves.iter().zip(pressures).zip(['A', 'B']);
    let at_point = sides.flat_map(|((valves, pressure), side)| {
        let of = valves.map_or(Vec::new(), |one| one.at_point(pressure, components.supply.tank_pressure));
        of.into_iter().map(move |valve| (side, valve))
    });
    let is_concerned = |valve: &ValveAtPoint| match (valve.opening, valve.kind) {
        (ValveOpening::Shut, PortValveKind::Check) => false,
        (ValveOpening::Shut, PortValveKind::Relief) => valve.opens_at < components.supply.pressure,
        (ValveOpening::InTransition | ValveOpening::Open, _) => true,
    };
    at_point.filter(|(_, valve)| is_concerned(valve)).collect()
}

/// Path of the transition pressure of an orifice between the chambers.
const CROSS_PORT_TRANSITION: &str = "cross_port.transition_pressure";

/// Dynamic pressure feedback, which the models of a linearisation do not include.
fn fed_between_chambers(project: &Project) -> Option<UncountedEffect> {
    let port = project.actuator.as_ref()?.cross_port.as_ref()?;
    matches!(port.kind, CrossPortKind::DynamicPressureFeedback { .. })
        .then_some(UncountedEffect::DynamicPressureFeedback)
}

/// Effects of the supply that the models of a linearisation do not include.
fn constant_supply(project: &Project) -> Option<UncountedEffect> {
    let supply = &project.actuator.as_ref()?.supply;
    matches!(supply.model, SupplyModel::PumpLimited(_)).then_some(UncountedEffect::ConstantSupply)
}

/// True if the plants of the family are measured responses.
fn is_measured(project: &Project) -> bool {
    project.family.as_ref().is_some_and(|family| !family.measured.is_empty())
}
