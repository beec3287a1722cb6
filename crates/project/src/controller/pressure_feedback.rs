//! Table `[controller.pressure_feedback]`.

use phea_quantity::{ANGULAR_FREQUENCY, PRESSURE, RATIO, VOLTAGE_PER_PRESSURE};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Description of its gain.
pub(crate) const GAIN: &str = "Command per pressure; positive adds damping.";

/// Feedback of the chamber pressures that the controller subtracts from its command.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredPressureFeedback {
    /// Signal formed from both pressures.
    pub signal: PressureSignal,
    /// Ratio A_B/A_A of a load pressure; if absent, that of the actuator.
    pub area_ratio: Option<f64>,
    /// Gain, V/Pa; required unless a design finds it.
    pub gain: f64,
    /// Corner of the high pass, rad/s; if absent, the pressure at rest is fed back too.
    pub high_pass: Option<f64>,
    /// Corner of the low pass, rad/s; none if absent.
    pub low_pass: Option<f64>,
    /// Root mean square of the white noise of the signal at a sampled controller, Pa.
    pub noise: f64,
}

/// Signal formed from the pressures of both chambers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PressureSignal {
    /// Load pressure p_A - p_B A_B/A_A: the force of the pressures over the area A_A.
    #[default]
    LoadPressure,
    /// Pressure difference p_A - p_B.
    PressureDifference,
}

impl DeclaredPressureFeedback {
    pub(super) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let words = &[
            ("load_pressure", PressureSignal::LoadPressure),
            ("pressure_difference", PressureSignal::PressureDifference),
        ];
        let k = plain("signal", "Load pressure p_A - p_B A_B/A_A, or difference p_A - p_B.");
        v.choice(k, words, &mut self.signal, false);
        let doc = "A_B/A_A that the controller has for a load pressure; absent: of the actuator.";
        v.optional(key("area_ratio", &RATIO, doc).positive(), &mut self.area_ratio);
        let k = key("gain", &VOLTAGE_PER_PRESSURE, GAIN).or(0.0);
        v.quantity(k, &mut self.gain);
        let doc = "Corner of the high pass; absent: the pressure at rest is fed back too.";
        v.optional(key("high_pass", &ANGULAR_FREQUENCY, doc).positive(), &mut self.high_pass);
        let doc = "Corner of the low pass; absent: none.";
        v.optional(key("low_pass", &ANGULAR_FREQUENCY, doc).positive(), &mut self.low_pass);
        let doc = "Root mean square of the noise of the signal, for a sampled controller.";
        v.quantity(key("noise", &PRESSURE, doc).not_negative().or(0.0), &mut self.noise);
    }
}
