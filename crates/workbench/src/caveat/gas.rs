//! Effects of accumulators at the chambers.

use super::CountedSettings;
use crate::family::{NumberAt, ShutGas};
use crate::quantity::{PRESSURE, Units, display, significant};

pub(super) const NECK_LOSS: &str = "line.accumulator.neck_loss_coefficient is not counted for small motions, which the laminar resistance of the neck \
     alone damps: only a simulation shows what its ends lose of a large flow";

pub(super) fn fixed_setting(moves_gas: bool) -> String {
    let brings = if moves_gas { ", and one that moves brings energy in" } else { "" };
    format!(
        "line.accumulator.adjustment is counted at its setting of rest: stiffness and passivity are those of a fixed setting{brings}"
    )
}

/// Gas at the pressures of the operating point, and the forces beyond which it is shut off.
pub(super) fn gas(
    key: &str,
    shut_beyond: [Option<f64>; 2],
    of_family: Option<&ShutGas>,
    units: &Units,
) -> String {
    let newton = |force: f64| units.force.text(force, 3);
    let beyond = match shut_beyond {
        [None, None] => None,
        [Some(least), None] => Some(format!("below {}", newton(least))),
        [None, Some(greatest)] => Some(format!("above {}", newton(greatest))),
        [Some(least), Some(greatest)] => {
            Some(format!("below {} and above {}", newton(least), newton(greatest)))
        }
    };
    let forces = units.motion.words().forces;
    let declared = beyond.map(|beyond| {
        format!(
            ": at {forces} {beyond} a chamber of the declared rig falls below the precharge, its gas is shut off, and only a simulation \
             shows a motion that goes there"
        )
    });
    let number = |one: &NumberAt| match one.dimension {
        Some(dimension) => format!("{} = {}", one.name, display(one.value, dimension, 4)),
        None => format!("{} = {}", one.name, one.value),
    };
    let of_family = of_family.map(|ShutGas { count, examined, side, at }| {
        let at = at.iter().map(number).collect::<Vec<_>>().join(", ");
        format!(
            "; at {count} of {examined} plants of the family it is shut off, and they are as stiff as without it, the first at chamber {side} \
             with {at}"
        )
    });
    format!(
        "{key} is counted for small motions, with its gas at the pressures of the operating point{}{}",
        declared.unwrap_or_default(),
        of_family.unwrap_or_default()
    )
}

pub(super) fn outside_models(necks: bool, heat: bool) -> String {
    let (what, verb, without) = match (necks, heat) {
        (false, false) => ("the valve of line.accumulator.adjustment", "is", "have its gas at the chamber"),
        (true, false) => ("the neck of line.accumulator", "is", "have its gas at the chamber"),
        (false, true) => ("line.accumulator.thermal_time_constant", "is", "have the isothermal gas of rest"),
        (true, true) => (
            "the neck of line.accumulator and its thermal_time_constant",
            "are",
            "have the isothermal gas of rest at the chamber",
        ),
    };
    format!(
        "{what} {verb} counted in the plant and the impedance at the load: the other models and the asymptotes of the impedance {without}"
    )
}

pub(super) fn adjustment(settings: CountedSettings, moves_gas: bool) -> String {
    let at = |value: f64| significant(value, 3);
    let counted = match settings {
        CountedSettings::Range([least, most]) => {
            format!("at every fixed setting from {} to {}", at(least), at(most))
        }
        CountedSettings::OfSides([a, b]) => {
            format!("at its settings of rest, {} at A and {} at B", at(a), at(b))
        }
        CountedSettings::OfRest(setting) => format!("at its setting of rest, {}", at(setting)),
    };
    let brings = if moves_gas { "brings energy in and " } else { "" };
    format!(
        "line.accumulator.adjustment is counted {counted}: one that moves {brings}makes the loop vary with time, which only a simulation \
         shows (`setting_change`)"
    )
}

pub(super) fn valve(transition_pressure: f64, has_range: bool) -> String {
    let remedy = match has_range {
        true => "the ranges of setting and transition_pressure say up to which oscillation",
        false => {
            "state a range of line.accumulator.adjustment.setting or transition_pressure in [uncertainty], or judge by a simulation"
        }
    };
    format!(
        "the valve of line.accumulator.adjustment has no drop at rest, and is counted with the slope of its transition_pressure of {}: an \
         oscillation beyond that finds it narrower: {remedy}",
        display(transition_pressure, &PRESSURE, 3)
    )
}
