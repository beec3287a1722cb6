//! The designed controller in the terms of a controller's manual, in JSON.

use std::f64::consts::TAU;

use phea_engineering::design::{ManualLaw, ManualPart};

use crate::answer::{Answer, words};
use crate::design::manual::{depth_db, width_hz};

/// Controller in the terms of a controller's manual.
#[derive(Answer)]
pub(super) struct ManualAnswer {
    /// Formulas of the parts.
    form: &'static str,
    /// Parts in series, the one with the gain first.
    parts: Vec<ManualPartAnswer>,
}

/// Part of a controller with its settings.
#[derive(Answer)]
struct ManualPartAnswer {
    /// Kind of the part.
    kind: ManualPart,
    #[answer(flatten)]
    settings: ManualSettingsAnswer,
}

words! {
    /// Part of a controller, as manuals name it.
    ManualPart {
        Proportional { .. } => "p",
        Integral { .. } => "i",
        ProportionalIntegral { .. } => "pi",
        ProportionalIntegralDerivative { .. } => "pid",
        LowPass { .. } => "low_pass",
        SecondOrderLowPass { .. } => "second_order_low_pass",
        Lead { .. } => "lead",
        Lag { .. } => "lag",
        Notch { .. } => "notch",
    }
}

/// Settings of a part.
#[derive(Answer)]
enum ManualSettingsAnswer {
    Proportional {
        /// Gain K_p, command per controlled quantity.
        proportional_gain: f64,
    },
    Integral {
        /// Gain K_i of K_i/s, command per controlled quantity and second.
        integral_gain: f64,
    },
    ProportionalIntegral {
        /// Gain K_p, command per controlled quantity.
        proportional_gain: f64,
        /// Integral time T_i.
        integral_time_s: f64,
    },
    ProportionalIntegralDerivative {
        /// Gain K_p, command per controlled quantity.
        proportional_gain: f64,
        /// Integral time T_i.
        integral_time_s: f64,
        /// Derivative time T_d.
        derivative_time_s: f64,
        /// Time constant T_f of the low pass, or of the filter of the derivative.
        filter_time_s: f64,
    },
    LowPass {
        /// Time constant T_f.
        filter_time_s: f64,
    },
    SecondOrderLowPass {
        /// Natural frequency, of a notch that of its zeros.
        frequency_rad_per_s: f64,
        /// Damping ratio.
        damping_ratio: f64,
    },
    Corners {
        /// Corner frequency of the zero.
        zero_rad_per_s: f64,
        /// Corner frequency of the pole.
        pole_rad_per_s: f64,
    },
    Notch {
        /// Natural frequency of the zeros of a notch.
        frequency_hz: f64,
        /// Ratio of the damping ratio of the zeros to that of the poles, the magnitude at the
        /// frequency of the notch; negative.
        depth_db: f64,
        /// Natural frequency of the poles times twice their damping ratio.
        width_hz: f64,
        /// Natural frequency of the zeros of a notch.
        frequency_rad_per_s: f64,
        /// Natural frequency of the poles.
        pole_frequency_rad_per_s: f64,
        /// Damping ratio of the zeros.
        zero_damping_ratio: f64,
        /// Damping ratio of the poles.
        pole_damping_ratio: f64,
    },
}

/// The parts of a law.
pub(super) fn answer(words: &ManualLaw) -> ManualAnswer {
    let part = |part: &ManualPart| ManualPartAnswer { kind: *part, settings: settings(part) };
    ManualAnswer {
        form: "parts in series; PI: K_p (1 + 1/(T_i s)); PID: K_p (1 + 1/(T_i s) + T_d s/(T_f s + 1))",
        parts: words.parts.iter().map(part).collect(),
    }
}

fn settings(part: &ManualPart) -> ManualSettingsAnswer {
    match *part {
        ManualPart::Proportional { gain } => ManualSettingsAnswer::Proportional { proportional_gain: gain },
        ManualPart::Integral { gain } => ManualSettingsAnswer::Integral { integral_gain: gain },
        ManualPart::ProportionalIntegral { gain, integral_time_s } => {
            ManualSettingsAnswer::ProportionalIntegral { proportional_gain: gain, integral_time_s }
        }
        ManualPart::ProportionalIntegralDerivative {
            gain,
            integral_time_s,
            derivative_time_s,
            filter_time_s,
        } => ManualSettingsAnswer::ProportionalIntegralDerivative {
            proportional_gain: gain,
            integral_time_s,
            derivative_time_s,
            filter_time_s,
        },
        ManualPart::LowPass { time_s } => ManualSettingsAnswer::LowPass { filter_time_s: time_s },
        ManualPart::SecondOrderLowPass { frequency_rad_per_s, damping_ratio } => {
            ManualSettingsAnswer::SecondOrderLowPass { frequency_rad_per_s, damping_ratio }
        }
        ManualPart::Lead { zero_rad_per_s, pole_rad_per_s }
        | ManualPart::Lag { zero_rad_per_s, pole_rad_per_s } => {
            ManualSettingsAnswer::Corners { zero_rad_per_s, pole_rad_per_s }
        }
        ManualPart::Notch {
            frequency_rad_per_s,
            pole_frequency_rad_per_s,
            zero_damping_ratio,
            pole_damping_ratio,
        } => ManualSettingsAnswer::Notch {
            frequency_hz: frequency_rad_per_s / TAU,
            depth_db: depth_db(part),
            width_hz: width_hz(part),
            frequency_rad_per_s,
            pole_frequency_rad_per_s,
            zero_damping_ratio,
            pole_damping_ratio,
        },
    }
}
