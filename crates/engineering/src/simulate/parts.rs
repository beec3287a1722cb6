//! The parts of a rig that some signals are of: a table has a column only for a part that is there.

use phea_hydraulics::machine::{
    ADJUSTMENT_SIGNALS, GAS_PRESSURE_SIGNALS, HEAT_SIGNALS, LINKAGE_SIGNALS, SERIES_SIGNALS,
    TRANSMISSION_SIGNALS,
};

use super::ControlledMachine;
use super::columns::{EXTERNAL_FORCE, EXTERNAL_TORQUE, GAS_TEMPERATURES, VIRTUAL_FORCE};

/// Which parts a rig has in addition to those that every rig has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SignalParts {
    /// A force from outside, or a torque behind a linkage.
    pub external_force: bool,
    /// A series element.
    pub series: bool,
    /// It is a transmission.
    pub transmission: bool,
    /// A linkage.
    pub linkage: bool,
    /// A virtual impedance.
    pub impedance: bool,
    /// Accumulators that are adjusted.
    pub adjustment: bool,
    /// Gas behind a neck or a valve at chambers A and B.
    pub gas_pressure: [bool; 2],
    /// Gas at chambers A and B that exchanges heat.
    pub heated_gas: [bool; 2],
    /// degC, of the wall of that gas, where the project states its working temperature.
    pub gas_wall_celsius: [Option<f64>; 2],
}

impl SignalParts {
    /// Of a machine with its controller.
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

    /// Whether a rig with these parts has the signal of this name.
    pub fn have(&self, name: &str) -> bool {
        let side = |names: &[&str; 2]| names.iter().position(|of| *of == name);
        if SERIES_SIGNALS.contains(&name) {
            return self.series;
        }
        if TRANSMISSION_SIGNALS.contains(&name) {
            return self.transmission;
        }
        if LINKAGE_SIGNALS.contains(&name) {
            return self.linkage;
        }
        if ADJUSTMENT_SIGNALS.contains(&name) {
            return self.adjustment;
        }
        if let Some(side) = side(&GAS_PRESSURE_SIGNALS) {
            return self.gas_pressure[side];
        }
        if let Some(side) = side(&HEAT_SIGNALS) {
            return self.heated_gas[side];
        }
        if let Some(side) = side(&GAS_TEMPERATURES) {
            return self.gas_wall_celsius[side].is_some();
        }
        match name {
            VIRTUAL_FORCE => self.impedance,
            EXTERNAL_FORCE => self.external_force && !self.linkage,
            EXTERNAL_TORQUE => self.external_force && self.linkage,
            _ => true,
        }
    }
}
