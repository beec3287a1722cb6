//! Columns of a scenario's table; the guide states their signs and units.

use phea_hydraulics::signal::{Signal, SignalPart};

use super::ControlledMachine;
use super::record::Sample;
use phea_quantity::ZERO_CELSIUS;

/// Parts of a rig with signals in addition to those of every rig.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SignalParts {
    /// True with an external force, or a torque with a linkage.
    pub external_force: bool,
    /// True with a series element.
    pub series: bool,
    /// True with a hydrostatic transmission.
    pub transmission: bool,
    /// True with a linkage.
    pub linkage: bool,
    /// True with a virtual impedance.
    pub impedance: bool,
    /// True with accumulators that are adjusted.
    pub adjustment: bool,
    /// True, for chambers A and B, with gas beyond a neck or a valve.
    pub gas_pressure: [bool; 2],
    /// True, for chambers A and B, with gas that exchanges heat.
    pub heated_gas: [bool; 2],
    /// Wall temperature of that gas, degC, if the project states its working temperature.
    pub gas_wall_celsius: [Option<f64>; 2],
}

impl SignalParts {
    /// Parts of a machine with its controller.
    pub(super) fn of(bench: &ControlledMachine) -> SignalParts {
        let machine = &bench.machine;
        let heated_gas = machine.has_heated_gas();
        let wall = |side: usize| bench.gas_wall_celsius[side].filter(|_| heated_gas[side]);
        SignalParts {
            external_force: machine.has_external_force(),
            series: machine.has_series_element(),
            transmission: machine.has_transmission(),
            linkage: machine.has_linkage(),
            impedance: !bench.control.impedance_states().is_empty(),
            adjustment: machine.has_adjustment(),
            gas_pressure: machine.has_gas_pressure(),
            heated_gas,
            gas_wall_celsius: [wall(0), wall(1)],
        }
    }

    /// True if a rig with these parts has a signal.
    pub fn have(&self, signal: Signal) -> bool {
        match signal.part() {
            SignalPart::Rig => true,
            SignalPart::SeriesElement => self.series,
            SignalPart::Transmission => self.transmission,
            SignalPart::Linkage => self.linkage,
            SignalPart::VirtualImpedance => self.impedance,
            SignalPart::Adjustment => self.adjustment,
            SignalPart::GasPressure(side) => self.gas_pressure[side],
            SignalPart::HeatedGas(side) => self.heated_gas[side],
            SignalPart::GasTemperature(side) => self.gas_wall_celsius[side].is_some(),
            SignalPart::ExternalForce => self.external_force && !self.linkage,
            SignalPart::ExternalTorque => self.external_force && self.linkage,
        }
    }

    /// Signals of a rig with these parts, in the order of the columns.
    pub(super) fn signals(&self) -> Vec<Signal> {
        Signal::ALL.iter().copied().filter(|signal| self.have(*signal)).collect()
    }

    /// Value of a signal that the rig has; NaN if the run lacks it, as an open loop lacks the
    /// reference.
    pub(super) fn value(&self, signal: Signal, sample: &Sample) -> f64 {
        let of_gas = |side: usize| {
            let ratio = sample.machine.gas_temperature_ratios[side];
            self.gas_wall_celsius[side].map_or(f64::NAN, |wall| gas_temperature(ratio, wall))
        };
        match signal {
            Signal::Time => sample.time_s,
            Signal::Reference => sample.reference_n.unwrap_or(f64::NAN),
            Signal::FilteredReference => sample.filtered_reference_n.unwrap_or(f64::NAN),
            Signal::Control => sample.control_v,
            Signal::Command => sample.control.command_v,
            Signal::UnlimitedControl => sample.control.unlimited_v,
            Signal::Integral => sample.control.integral_v,
            Signal::Measurement => sample.control.measurement_n,
            Signal::VirtualForce => sample.control.virtual_force_n,
            Signal::ExternalForce | Signal::ExternalTorque => sample.external_force_n.unwrap_or(f64::NAN),
            Signal::GasTemperatureA => of_gas(0),
            Signal::GasTemperatureB => of_gas(1),
            of_machine => sample.machine.get(of_machine).unwrap_or(f64::NAN),
        }
    }
}

/// Temperature of gas, degC, at this ratio of its absolute temperature to that of its wall, which
/// is in degC: T = theta T_w.
fn gas_temperature(ratio: f64, wall: f64) -> f64 {
    // exact if the gas has the temperature of its wall
    wall + (ratio - 1.0) * (wall + ZERO_CELSIUS)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rig without such parts has the columns of every rig, and one with a part at B those of B.
    #[test]
    fn a_part_that_is_missing_has_no_column() {
        let plain = SignalParts::default().signals();
        let gas_at_b = SignalParts {
            gas_pressure: [false, true],
            heated_gas: [false, true],
            gas_wall_celsius: [None, Some(40.0)],
            ..SignalParts::default()
        };
        let added: Vec<&str> = gas_at_b
            .signals()
            .iter()
            .filter(|signal| !plain.contains(signal))
            .map(|one| one.name())
            .collect();
        assert_eq!(added, ["gas_pressure_b_pa", "gas_temperature_b_ratio", "gas_temperature_b_degC"]);
    }

    /// Ten percent above an absolute 300 K is 330 K; gas as warm as its wall has its temperature.
    #[test]
    fn the_temperature_of_gas_is_absolute() {
        assert!((gas_temperature(1.1, 300.0 - ZERO_CELSIUS) - (330.0 - ZERO_CELSIUS)).abs() < 1e-12);
        assert_eq!(gas_temperature(1.0, 37.3), 37.3);
    }
}
