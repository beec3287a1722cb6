//! Transducers, meters and their converters.

use phea_dynamics::controller::Converter;
use phea_dynamics::random::normal;

use crate::project::{Bench, FlowMeter};

/// Fraction of its range that a transducer with a live zero (4 to 20 mA) shows below zero.
const LIVE_ZERO: f64 = 0.025;

/// Instruments of a test, all with converters of equal numbers of bits.
pub(crate) struct Instruments {
    command: Option<Converter>,
    pressure: Option<Converter>,
    pressure_noise: f64,
    command_noise: f64,
    bits: u32,
}

impl Instruments {
    pub(crate) fn new(settings: &Bench, nominal_voltage: f64) -> Instruments {
        let bits = settings.converter_bits;
        Instruments {
            command: Converter::new(bits, [-nominal_voltage, nominal_voltage]).ok(),
            pressure: Converter::new(bits, [-LIVE_ZERO * settings.pressure_range, settings.pressure_range])
                .ok(),
            pressure_noise: settings.pressure_noise,
            command_noise: settings.command_noise,
            bits,
        }
    }

    /// Command at the output of the computer, V.
    pub(super) fn command(&self, wanted: f64) -> f64 {
        self.command.as_ref().map_or(wanted, |converter| converter.rounded(wanted))
    }

    /// Recorded value of a command, V.
    pub(super) fn recorded_command(&self, command: f64, noise: &mut u64) -> f64 {
        if self.command_noise == 0.0 {
            return command;
        }
        let shown = command + self.command_noise * normal(noise);
        self.command.as_ref().map_or(shown, |converter| converter.rounded(shown))
    }

    /// Reading of a pressure, Pa.
    pub(crate) fn pressure(&mut self, value: f64, noise: &mut u64) -> f64 {
        let shown = value + self.pressure_noise * normal(noise);
        self.pressure.as_ref().map_or(shown, |converter| converter.rounded(shown))
    }

    /// Reading of a flow, m3/s: a turbine is at rest below its smallest flow, which is proportional
    /// to the kinematic viscosity, and does not indicate the direction unless it is signed.
    pub(super) fn flow(&self, meter: &FlowMeter, value: f64, viscosity_ratio: f64, noise: &mut u64) -> f64 {
        let disturbed = value + meter.noise * normal(noise);
        let turning = if value.abs() < meter.minimum * viscosity_ratio { 0.0 } else { disturbed };
        let shown = if meter.signed { turning } else { turning.abs() };
        let lowest = if meter.signed { -meter.range } else { 0.0 };
        match Converter::new(self.bits, [lowest, meter.range]) {
            Ok(converter) => converter.rounded(shown),
            Err(_) => shown,
        }
    }
}
