//! Effects that the project declares and a verdict on the linear loop does not include.
//!
//! A simulation includes the whole machine. What the linear plant cannot represent is stated before
//! the verdict; where a specification depends on it, the verdict is not proven.

mod beyond_reach;
mod fed;
mod friction_directions;
mod leakage_humps;
mod misfit;
mod moved_roots;
mod null_sides;
pub(crate) mod overlap;

use phea_hydraulics::cross_port::Restrictor;
use phea_hydraulics::operating_point::{Condition, OperatingPoint};
use phea_hydraulics::series::MOST_SEGMENTS;

use beyond_reach::beyond_reach;
use fed::{fed_in_loop, feed_forward, impedance, measured_without_pressures, pressures_in_loop};
use friction_directions::friction_directions;
use leakage_humps::leakage_humps;
use misfit::misfits;
use moved_roots::moved_roots;
use overlap::overlap;

pub use misfit::misfits_in_runs;

use crate::family::{ShutGas, shut_gas};
use crate::project::{CrossPortKind, DeclaredSeries, Load, Project, Pump, SupplyModel};
use crate::quantity::{DisplayUnit, PRESSURE, display, significant};
use crate::rig::{ChargedRange, accumulator_place, charged_range, cross_port_at_point, waves_right_to};
use crate::setup::Setup;

/// A declared effect that the linear loop does not include.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Caveat {
    /// What it is, and where it is included.
    pub sentence: String,
    /// Whether a specification that the linear loop satisfies may be violated because of it.
    pub unproven: bool,
}

/// Declared effects that no linear loop includes.
pub fn caveats(setup: &Setup<'_>) -> Vec<Caveat> {
    let of_rig =
        supply(setup).into_iter().chain(accumulator(setup)).chain(cross_port(setup)).chain(neck(setup));
    let of_rig = of_rig.chain(adjustment(setup)).chain(gas_valve(setup));
    let of_rig = apart_from_lines(setup).chain(of_rig).chain(progression(setup)).chain(segments(setup));
    let of_valve = leakage_humps(setup)
        .into_iter()
        .chain(overlap(setup))
        .map(|sentence| Caveat { sentence, unproven: false });
    of_valve
        .chain(misfits(setup))
        .chain(beyond_reach(setup))
        .chain(friction_directions(setup))
        .chain(of_rig)
        .chain(moved_roots(setup))
        .chain(blocked_piston(setup))
        .collect()
}

/// A region of positions alone under the force of a piston that is blocked at null.
fn blocked_piston(setup: &Setup<'_>) -> Option<Caveat> {
    let region = setup.project.family.as_ref()?.operating_region.as_ref()?;
    let rig = setup.rig().ok()?;
    let blocked = matches!(rig.condition, Condition::Command(command) if command == 0.0);
    if region.load_force.is_some() || region.velocity.is_some() || !blocked {
        return None;
    }
    let (force, parts) = (rig.point.hydraulic_force, rig.actuator.components());
    let is_visible = force.abs() > LEAST_FORCE * parts.cylinder.greatest_areas()[0] * parts.supply.pressure;
    is_visible.then(|| Caveat {
        sentence: format!(
            "family.operating_region has positions alone: its plants are those of a piston blocked at null, which pushes with {}, and not \
             of zero force, for which operating_point.load_force = 0 is stated",
            setup.project.units.force.short(force, 4)
        ),
        unproven: false,
    })
}

/// Part of the largest force from which on it changes a plant.
const LEAST_FORCE: f64 = 1e-3;

/// Declared effects that no linear model includes, in sentences.
pub fn of_models(setup: &Setup<'_>) -> Vec<String> {
    let project = setup.project;
    let others = apart_from_lines(setup).map(|caveat| caveat.sentence);
    lumped(project)
        .into_iter()
        .chain(others)
        .chain(constant_supply(project))
        .chain(fed_between_chambers(project))
        .chain(of_gas(project))
        .chain(fed_in_loop(setup))
        .chain(pressures_in_loop(project))
        .chain(beside_spring(project))
        .chain(standing(project))
        .chain(null_sides::null_sides(setup))
        .chain(leakage_humps(setup))
        .chain(overlap(setup))
        .chain(misfits(setup).into_iter().map(|caveat| caveat.sentence))
        .collect()
}

/// A progressive spring is that of the operating point.
fn progression(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let declared = setup.project.actuator.as_ref()?.series.as_ref()?.spring()?;
    if declared.progression == 0.0 {
        return None;
    }
    let stiffness = |value: f64| DisplayUnit::MEGANEWTON_PER_METRE.text(value, 3);
    let here = setup.rig().ok()?.plant.series?.stiffness();
    let stiffest = declared.stiffness * (1.0 + 3.0 * declared.progression);
    Some(Caveat {
        sentence: format!(
            "series.progression is counted for small motions, with the {} that the spring has at the operating point: it has {} at rest and \
             {} at the end of its travel, and only a simulation shows a large step through both",
            stiffness(here),
            stiffness(declared.stiffness),
            stiffness(stiffest)
        ),
        unproven: false,
    })
}

/// The waves of a transmission beyond its segments.
fn segments(setup: &Setup<'_>) -> Option<Caveat> {
    let declared = setup.project.actuator.as_ref()?.series.as_ref()?.transmission()?;
    let right_to = waves_right_to(setup.rig().ok()?)?;
    Some(Caveat {
        sentence: format!(
            "the line of the transmission is counted in segments, here {}, whose waves are right to 3 % up to {} rad/s: a margin beyond that may \
             be that of its segments{}{}",
            declared.segments,
            significant(right_to, 3),
            if (declared.segments as usize) < MOST_SEGMENTS { "; `--on-machine` tries more" } else { "" },
            if declared.segments > PROVEN_SEGMENTS {
                "; `--prove` encloses two segments, and no more"
            } else {
                ""
            }
        ),
        unproven: false,
    })
}

/// Segments up to which the polynomials of the plant can be enclosed.
const PROVEN_SEGMENTS: u32 = 2;

/// A linear model has fixed settings.
fn standing(project: &Project) -> Option<String> {
    let adjusted: Vec<_> = project.actuator.as_ref()?.adjustments().into_iter().flatten().collect();
    let moves_gas = adjusted.iter().any(|one| one.valve().is_none());
    let brings = if moves_gas { ", and one that moves brings energy in" } else { "" };
    (!adjusted.is_empty()).then(|| {
        format!(
            "line.accumulator.adjustment is counted at its setting of rest: stiffness and passivity are those of a fixed setting{brings}"
        )
    })
}

/// Effects of a series element that the models with one load pressure do not include.
fn beside_spring(project: &Project) -> Option<String> {
    let series = match project.actuator.as_ref()?.series.as_ref()? {
        DeclaredSeries::Spring(spring) => spring,
        DeclaredSeries::Transmission(_) => {
            return Some(
                "inertia and resistance of the transmission are counted in the plant and its impedance alone: the other models have \
                 its oil as a spring in series with the force sensor"
                    .to_string(),
            );
        }
    };
    let keys = [("series.damping", series.damping), ("series.mass", series.mass)];
    let beside: Vec<&str> = keys.iter().filter(|(_, value)| *value > 0.0).map(|(key, _)| *key).collect();
    let verb = if beside.len() > 1 { "are" } else { "is" };
    (!beside.is_empty()).then(|| {
        format!(
            "{} {verb} counted in the plant and its impedance alone: the other models have the series spring without it, in series with the \
             force sensor",
            beside.join(" and ")
        )
    })
}

/// What no linear model counts.
fn apart_from_lines(setup: &Setup<'_>) -> impl Iterator<Item = Caveat> {
    let project = setup.project;
    let fed = [feed_forward(project), measured_without_pressures(project), impedance(setup)];
    [load(project), stages(project)].into_iter().chain(fed).flatten()
}

/// A telescopic piston is that of each operating point.
fn stages(project: &Project) -> Option<Caveat> {
    let declared = project.actuator.as_ref()?;
    if declared.motor.is_some() || declared.cylinder.stages.is_empty() {
        return None;
    }
    let region = project.family.as_ref().and_then(|family| family.operating_region.as_ref());
    let in_region = region.is_some_and(|region| region.velocity.is_some());
    let moves =
        in_region || project.resolved_operating_point().velocity.is_some_and(|velocity| velocity != 0.0);
    let sentence = match moves {
        false => {
            "cylinder.stage is counted with the areas at each operating point: only a simulation shows a motion from one stage to the next"
        }
        true => {
            "cylinder.stage is counted with the areas at each operating point, and not with their change at a steady velocity through a \
                 transition: only a simulation shows it"
        }
    };
    Some(Caveat { sentence: sentence.to_string(), unproven: moves })
}

/// A wall without a stated mass of the load.
fn load(project: &Project) -> Option<Caveat> {
    let load = &project.actuator.as_ref()?.load;
    matches!(load, Load::Wall { mass: None, .. }).then(|| Caveat {
        sentence: "load.model = \"wall\" is not included without load.mass: this is the loop with a load that does not move"
            .to_string(),
        unproven: true,
    })
}

/// Effects of the lines that the models of a linearisation do not include.
fn lumped(project: &Project) -> Option<String> {
    let (place, model) = moving(project)?;
    Some(format!(
        "{place} = \"{model}\" is not counted in these models, which have lumped lines: verify, design and simulate count it"
    ))
}

/// The key that sets lines in motion, and its word.
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

/// The effect of a limited supply is included for small motions, but not for a large step; where
/// more flow is taken than the pump delivers, there is no equilibrium about which to linearise.
fn supply(setup: &Setup<'_>) -> Option<Caveat> {
    let project = setup.project;
    let supply = &project.actuator.as_ref()?.supply;
    let SupplyModel::PumpLimited(Pump { flow: gives, .. }) = supply.model else { return None };
    if is_measured(project) {
        return None;
    }
    let found = setup.rig().ok()?.supply?;
    let flow = |value: f64| project.units.flow.text(value, 3);
    let (taken, gives_words) = (flow(found.taken), flow(gives));
    let pressure = project.units.pressure.text(found.supply.pressure, 4);
    let rests = found.taken < gives;
    let sentence = match rests {
        true => format!(
            "supply.model = \"pump_limited\" is included for small motions, at {pressure} where the valve takes {taken} of the \
             pump's {gives_words}: only a simulation shows what a large step takes beyond that"
        ),
        false => format!(
            "supply.model = \"pump_limited\" has no equilibrium at the operating point, where the valve takes {taken} and the pump gives \
             {gives_words}: the plant is that at {pressure}, where the relief valve shuts"
        ),
    };
    Some(Caveat { sentence, unproven: !rests })
}

/// The gas of accumulators is counted at the pressures of each operating point; where a force
/// empties one of them, the actuator becomes as stiff as without it.
fn accumulator(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let declared = setup.project.actuator.as_ref()?;
    let ChargedRange { least, greatest } = charged_range(setup.rig().ok()?)?;
    let [of_a, of_b] = accumulator_place(declared);
    let unit = setup.project.units.force;
    let newton = |point: OperatingPoint| unit.text(point.hydraulic_force, 3);
    let shut = shut_gas(setup).ok().flatten();
    let (place, beyond) = match (least, greatest) {
        (None, None) => (if shut.as_ref()?.side == 'A' { of_a } else { of_b }, None),
        (Some(least), None) => (of_a, Some(format!("below {}", newton(least)))),
        (None, Some(greatest)) => (of_b, Some(format!("above {}", newton(greatest)))),
        (Some(least), Some(greatest)) => {
            (of_a, Some(format!("below {} and above {}", newton(least), newton(greatest))))
        }
    };
    let declared = beyond.map(|beyond| {
        format!(
            ": at forces {beyond} a chamber of the declared rig falls below the precharge, its gas is shut off, and only a simulation \
             shows a motion that goes there"
        )
    });
    let of_family = shut.map(|ShutGas { count, examined, side, at }| {
        format!(
            "; at {count} of {examined} plants of the family it is shut off, and they are as stiff as without it, the first at chamber {side} \
             with {at}"
        )
    });
    let sentence = format!(
        "{place} is counted for small motions, with its gas at the pressures of the operating point{}{}",
        declared.unwrap_or_default(),
        of_family.unwrap_or_default()
    );
    Some(Caveat { sentence, unproven: false })
}

/// The loss at the ends of a neck has no slope where nothing flows.
fn neck(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let line = &setup.project.actuator.as_ref()?.line;
    let gas = [&line.a, &line.b].into_iter().filter_map(|side| side.accumulator.as_ref());
    let loses = gas.filter_map(|gas| gas.neck).any(|neck| neck.loss_coefficient > 0.0);
    loses.then(|| Caveat {
        sentence: "line.accumulator.neck_loss_coefficient is not counted for small motions, which the laminar resistance of the neck \
                   alone damps: only a simulation shows what its ends lose of a large flow"
            .to_string(),
        unproven: false,
    })
}

/// A verdict is for fixed settings.
fn adjustment(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let adjusted = setup.project.actuator.as_ref()?.adjustments();
    let first = adjusted.into_iter().flatten().next()?;
    let mut ranges = setup.project.uncertainty.iter();
    let range = ranges.find(|uncertain| uncertain.name.ends_with(SETTING_PATH));
    let at = |value: f64| significant(value, 3);
    let counted = match (range, adjusted) {
        (Some(range), _) => {
            format!("at every fixed setting from {} to {}", at(range.minimum), at(range.maximum))
        }
        (None, [Some(a), Some(b)]) if a.setting != b.setting => {
            format!("at its settings of rest, {} at A and {} at B", at(a.setting), at(b.setting))
        }
        (None, _) => format!("at its setting of rest, {}", at(first.setting)),
    };
    let moves_gas = adjusted.into_iter().flatten().any(|one| one.valve().is_none());
    let brings = if moves_gas { "brings energy in and " } else { "" };
    Some(Caveat {
        sentence: format!(
            "line.accumulator.adjustment is counted {counted}: one that moves {brings}makes the loop vary with time, which only a simulation \
             shows (`setting_change`)"
        ),
        unproven: false,
    })
}

/// End of the path of a setting.
const SETTING_PATH: &str = "accumulator.adjustment.setting";
const TRANSITION_PATH: &str = "accumulator.adjustment.transition_pressure";

/// A valve between chamber and gas has no drop at rest, and there the slope of its transition.
fn gas_valve(setup: &Setup<'_>) -> Option<Caveat> {
    if is_measured(setup.project) {
        return None;
    }
    let components = *setup.rig().ok()?.actuator.components();
    let valves = [0, 1].map(|side| components.gas_valve(side).filter(|valve| !valve.shut));
    let valve = valves.into_iter().flatten().next()?;
    let covers = |name: &String| name.ends_with(SETTING_PATH) || name.ends_with(TRANSITION_PATH);
    let is_open = setup.project.uncertainty.iter().any(|uncertain| covers(&uncertain.name));
    let cure = match is_open {
        true => "the ranges of setting and transition_pressure say up to which oscillation",
        false => {
            "state a range of line.accumulator.adjustment.setting or transition_pressure in [uncertainty], or judge by a simulation"
        }
    };
    let sentence = format!(
        "the valve of line.accumulator.adjustment has no drop at rest, and is counted with the slope of its transition_pressure of {}: an \
         oscillation beyond that finds it narrower: {cure}",
        display(valve.transition_pressure, &PRESSURE, 3)
    );
    Some(Caveat { sentence, unproven: !is_open })
}

/// Necks and heat of accumulators, which the models of a linearisation do not include.
fn of_gas(project: &Project) -> Option<String> {
    let line = &project.actuator.as_ref()?.line;
    let gas = [&line.a, &line.b].into_iter().filter_map(|side| side.accumulator.as_ref());
    let (necks, heat) = gas.fold((false, false), |(necks, heat), gas| {
        (necks || gas.neck.is_some(), heat || gas.thermal_time_constant.is_some())
    });
    let valve = project.actuator.as_ref()?.adjustments().into_iter().flatten().any(|of| of.valve().is_some());
    let (what, verb, without) = match (necks, heat) {
        (false, false) if valve => {
            ("the valve of line.accumulator.adjustment", "is", "have its gas at the chamber")
        }
        (false, false) => return None,
        (true, false) => ("the neck of line.accumulator", "is", "have its gas at the chamber"),
        (false, true) => ("line.accumulator.thermal_time_constant", "is", "have the isothermal gas of rest"),
        (true, true) => (
            "the neck of line.accumulator and its thermal_time_constant",
            "are",
            "have the isothermal gas of rest at the chamber",
        ),
    };
    Some(format!(
        "{what} {verb} counted in the plant and the impedance at the load: the other models and the asymptotes of the impedance {without}"
    ))
}

/// Drops of an orifice in transition pressures below which its slope is that of the transition.
const IN_TRANSITION: f64 = 10.0;

/// An orifice between the chambers has the slope of its transition where it has no drop: the larger
/// an oscillation, the less it damps.
fn cross_port(setup: &Setup<'_>) -> Option<Caveat> {
    let project = setup.project;
    if is_measured(project) {
        return None;
    }
    let found = cross_port_at_point(setup.rig().ok()?)?;
    let Restrictor::Orifice { transition_pressure, .. } = found.valve.restrictor else { return None };
    let drop = if found.valve.capacity.is_some() { 0.0 } else { found.drop };
    if drop.abs() >= IN_TRANSITION * transition_pressure {
        return None;
    }
    let path = "cross_port.transition_pressure";
    let is_open = project.uncertainty.iter().any(|uncertain| uncertain.name == path);
    let conductance = significant(found.conductance, 3);
    let transition = display(transition_pressure, &PRESSURE, 3);
    let at = match found.valve.capacity {
        Some(_) => "no drop at rest".to_string(),
        None => format!("a drop of {} at rest", display(drop, &PRESSURE, 3)),
    };
    let cure = match is_open {
        true => format!("the range of {path} says up to which oscillation"),
        false => format!(
            "state a range of {path} in [uncertainty], up to 0.81 times the amplitude of the drop, or judge by a simulation"
        ),
    };
    let sentence = format!(
        "cross_port is counted for small motions: its orifice has {at}, and there the slope of its transition_pressure of {transition}, \
         {conductance} m3/(s.Pa); an oscillation beyond that is damped less: {cure}"
    );
    Some(Caveat { sentence, unproven: !is_open })
}

/// Dynamic pressure feedback, which the models of a linearisation do not include.
fn fed_between_chambers(project: &Project) -> Option<String> {
    let port = project.actuator.as_ref()?.cross_port.as_ref()?;
    matches!(port.kind, CrossPortKind::DynamicPressureFeedback { .. }).then(|| {
        "cross_port.kind = \"dynamic_pressure_feedback\" is counted in the plant and the impedance at the load: the other models and the \
         asymptotes of the impedance are without it"
            .to_string()
    })
}

/// Effects of the supply that the models of a linearisation do not include.
fn constant_supply(project: &Project) -> Option<String> {
    let supply = &project.actuator.as_ref()?.supply;
    matches!(supply.model, SupplyModel::PumpLimited(_)).then(|| {
        "supply.model = \"pump_limited\" is counted in the plant alone: the other models have the pressure at which it settles, held \
         constant"
            .to_string()
    })
}

/// Whether the plants of the family are responses that were measured.
fn is_measured(project: &Project) -> bool {
    project.family.as_ref().is_some_and(|family| !family.measured.is_empty())
}
