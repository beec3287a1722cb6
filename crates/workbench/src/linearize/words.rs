//! Stiffness over the stroke, and reasons for missing parts of a linearisation, in words.

use super::{HidingMass, Linearization, NoBandwidth, NoClosedImpedance};
use phea_hydraulics::stiffness::StrokeStiffness;

use crate::quantity::{DisplayUnit, MotionKind, TORSIONAL_STIFFNESS, fitting, significant};

/// Relative difference up to which the two stiffness models count as agreeing.
const AGREEMENT: f64 = 0.005;

/// The least and the greatest stiffness with their places, or the single value if it is constant.
///
/// The stiffness of a motor is shown in the unit that fits it, because motors are of very different
/// sizes.
pub(crate) fn stiffness_words(motion: MotionKind, stiffness: &StrokeStiffness) -> [String; 2] {
    let unit = match motion {
        MotionKind::Linear => DisplayUnit::MEGANEWTON_PER_METRE,
        MotionKind::Rotary => fitting(stiffness.minimum, &TORSIONAL_STIFFNESS),
    };
    let [least, greatest] = [stiffness.minimum, stiffness.maximum];
    match motion.is_rotary() && least == greatest {
        true => [unit.text(least, 3), "at every angle".to_string()],
        false => {
            let range = format!("{} to {}", unit.number(least, 3), unit.text(greatest, 3));
            [range, "over the stroke".to_string()]
        }
    }
}

/// A sentence on the two stiffness models.
pub(crate) fn stiffness_sentence(linearization: &Linearization) -> String {
    let Linearization { motion, stiffness_models: difference, .. } = linearization;
    let symbol = motion.symbols().stiffness;
    let range = |stiffness: &StrokeStiffness| stiffness_words(*motion, stiffness)[0].clone();
    let [_, place] = stiffness_words(*motion, &difference.by_volume);
    let percent = |fraction: f64| significant(100.0 * fraction, 2);
    let ratios = [difference.minimum_ratio, difference.maximum_ratio];
    let gas = match difference.gas_compliance_fraction {
        0.0 => String::new(),
        fraction => format!(" The gas of accumulators provides {} % of the compliance.", percent(fraction)),
    };
    if ratios.iter().all(|ratio| (ratio - 1.0).abs() < AGREEMENT) {
        return format!(
            "{symbol} is {} {place}, by either stiffness model (uniform, by_volume): the lines are hardly softer \
             than the oil, and {} % of the oil is in the chambers.{gas}",
            range(&difference.by_volume),
            percent(difference.chamber_volume_fraction)
        );
    }
    format!(
        "With one modulus for line and chamber (uniform) {symbol} is {} {place}; if the oil in the chambers \
         keeps its own (by_volume) it is {}, and its least value {} times as high: {} % of the oil is in the chambers, \
         and the lines account for {} % of the compliance.{gas}",
        range(&difference.uniform),
        range(&difference.by_volume),
        significant(difference.minimum_ratio, 3),
        percent(difference.chamber_volume_fraction),
        percent(difference.line_compliance_fraction),
    )
}

/// Mass that hides the compliance.
pub(crate) fn hiding_mass_words(mass: HidingMass, motion: MotionKind) -> &'static str {
    match mass {
        HidingMass::Piston => motion.either("the piston's mass", "the shaft's inertia"),
        HidingMass::Oil => "the oil of the transmission",
    }
}

/// Reason why there is no impedance of the closed loop.
pub(crate) fn no_closed_impedance_words(reason: NoClosedImpedance) -> &'static str {
    match reason {
        NoClosedImpedance::NoController => "the project gives no controller",
        NoClosedImpedance::NotRational => {
            "the controller is sampled or the loop has dead time, so that its impedance is not a rational function"
        }
    }
}

/// Reason why a loop has no bandwidth.
pub(super) fn no_bandwidth_words(reason: NoBandwidth, motion: MotionKind) -> &'static str {
    match reason {
        NoBandwidth::NoController => "the project gives no controller",
        NoBandwidth::NotClosed => "the loop cannot be closed",
        NoBandwidth::Unstable => "the closed loop is unstable",
        NoBandwidth::BeyondRange => motion.either(
            "the force follows up to every frequency that was looked at",
            "the torque follows up to every frequency that was looked at",
        ),
    }
}
