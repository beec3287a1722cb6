use phea_dynamics::scalar::{Parameters, Scalar};

use super::equations::constant;
use super::{Machine, Motion};
use crate::series::MovingSeries;

/// Names of the signals of a machine, with units, in the order of [`Machine::outputs`].
pub const SIGNALS: [&str; 33] = [
    "force_n",
    "spool_v",
    "pressure_a_pa",
    "pressure_b_pa",
    "supply_pressure_pa",
    "position_m",
    "velocity_m_per_s",
    "deflection_m",
    "friction_n",
    "end_stops_n",
    "flow_a_m3_per_s",
    "flow_b_m3_per_s",
    "supply_flow_m3_per_s",
    "load_position_m",
    "load_velocity_m_per_s",
    "port_pressure_a_pa",
    "port_pressure_b_pa",
    "hydraulic_force_n",
    "opening_v",
    "series_deflection_m",
    "load_force_n",
    "joint_angle_rad",
    "joint_velocity_rad_per_s",
    "joint_torque_n_m",
    "gas_pressure_a_pa",
    "gas_pressure_b_pa",
    "gas_temperature_a_ratio",
    "gas_temperature_b_ratio",
    "setting_a_ratio",
    "setting_b_ratio",
    "adjustment_power_w",
    "transmission_pressure_rod_pa",
    "transmission_pressure_load_pa",
];

/// Those of [`SIGNALS`] that only a machine with a series element has: without one the force on the
/// load is `force_n`, and nothing deflects but the sensor.
pub const SERIES_SIGNALS: [&str; 2] = ["series_deflection_m", "load_force_n"];

/// Those of [`SIGNALS`] that only a machine with a transmission has: the pressures of its oil at
/// either piston.
pub const TRANSMISSION_SIGNALS: [&str; 2] = ["transmission_pressure_rod_pa", "transmission_pressure_load_pa"];

/// Those of [`SIGNALS`] that only a machine with a linkage has: its load turns.
pub const LINKAGE_SIGNALS: [&str; 3] = ["joint_angle_rad", "joint_velocity_rad_per_s", "joint_torque_n_m"];

/// Those of [`SIGNALS`] that only a machine with a neck at chamber A or B has: without one the gas
/// has the pressure of its chamber.
pub const GAS_PRESSURE_SIGNALS: [&str; 2] = ["gas_pressure_a_pa", "gas_pressure_b_pa"];

/// Those of [`SIGNALS`] that only a machine with gas that exchanges heat at chamber A or B has.
pub const HEAT_SIGNALS: [&str; 2] = ["gas_temperature_a_ratio", "gas_temperature_b_ratio"];

/// Those of [`SIGNALS`] that only a machine has whose accumulators are adjusted: their settings,
/// and the power of the adjustment, [`MovedGas::power`](crate::accumulator::MovedGas::power).
pub const ADJUSTMENT_SIGNALS: [&str; 3] = ["setting_a_ratio", "setting_b_ratio", "adjustment_power_w"];

/// Names of the state events of a machine, in the order of its indicators. Each indicator is
/// positive in ordinary operation and negative while the event lasts.
///
/// `cavitation`: the chamber's pressure, or that behind the neck of its accumulator where it is
/// lower, less vapour pressure in Pa. `end_stop`: the way left to that end in m. `empty`: the
/// chamber's compliance in m3/Pa without accumulators, which vanishes with its volume.
/// `load_contact`: the way left to the wall in m. `supply_lost`: supply less tank pressure in Pa.
/// `accumulator_empty`: the chamber's pressure, or that behind the neck where there is one, less
/// the precharge of its accumulator in Pa. `accumulator_overpressure`: what is left to the pressure
/// limit of that gas in Pa, which moves with a precharge that is adjusted. `series_end`: the way
/// left to the nearer end of a series spring's travel in m. `cavitation_transmission`: the lowest
/// pressure in the oil of a transmission, less vapour pressure in Pa.
pub const INDICATORS: [&str; 14] = [
    "cavitation_a",
    "cavitation_b",
    "end_stop_a",
    "end_stop_b",
    "empty_a",
    "empty_b",
    "load_contact",
    "supply_lost",
    "accumulator_empty_a",
    "accumulator_empty_b",
    "accumulator_overpressure_a",
    "accumulator_overpressure_b",
    "series_end",
    "cavitation_transmission",
];

impl<S: Scalar> Machine<S> {
    /// The [`SIGNALS`] at a state and inputs. `spool_v` is the spool's position U, `opening_v` the
    /// opening of the edges, y = U - U_0 - z, less null bias and magnetic lag
    /// ([`crate::servovalve::SpoolImperfection`]); flows are those of the valve's ports A and B
    /// into the lines. `port_pressure` is that of a line's end at the valve, `pressure` that of its
    /// end at the chamber, which is the chamber's. `force_n` is what the rod pushes on the load
    /// with, `hydraulic_force_n` what the chambers push the piston with; between them lie its
    /// friction, end stops and acceleration. With a series element `force_n` is the force that its
    /// [`ForceFrom`](crate::series::ForceFrom) measures, F_e that through the sensor,
    /// `load_force_n` that on the load, and `series_deflection_m` how far the spring, or the oil of
    /// a transmission, is compressed. Behind a linkage `load_position_m` is that of the rod's end,
    /// and `joint_torque_n_m` what the rod turns the joint with. `gas_pressure` is that of the gas
    /// behind a neck, gauge, and `gas_temperature_ratio` the absolute temperature of gas that
    /// exchanges heat over that of its wall, theta. Signals of parts that the machine lacks are
    /// zero:
    ///
    /// ```text
    /// F_H = A_A p_A - A_B p_B = F_e + F_fr - F_stops + M dv/dt      all positive towards the B end but F_fr      thesis (4.29)
    /// ```
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::actuator::Actuator;
    /// # use phea_hydraulics::reference_rig::{components, hose_line};
    /// # use phea_hydraulics::stiffness::StiffnessModel;
    /// use phea_hydraulics::machine::{Machine, MachineOptions, SIGNALS};
    /// let actuator = Actuator::new(components(hose_line(), StiffnessModel::Uniform))?;
    /// let machine = Machine::new(&actuator, &MachineOptions::default())?;
    /// let outputs = machine.outputs(&[0.0, 0.0, 35e5, 35e5, 1e-4, 0.0], &[0.25, 0.0]);
    /// assert_eq!((SIGNALS[0], outputs[0]), ("force_n", 2e3));
    /// assert_eq!((SIGNALS[5], outputs[5]), ("position_m", 0.2501));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn outputs<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> [T; SIGNALS.len()] {
        let vector = state;
        let state = self.layout.read(vector);
        let load = self.load_of(&state, &ground_of(inputs));
        let end = self.end_of(&load);
        let joint = self.joint(&state, vector, &end.motion);
        let position = joint.position;
        let ports = self.ports(&state, vector);
        let flows = self.flows(&state, ports);
        let forces = self.forces(&state, position);
        let still = Motion { position: T::from(0.0), velocity: T::from(0.0) };
        let zero = T::from(0.0);
        let (settings, power) = if self.layout.is_adjusted() {
            let setting = self.layout.setting(inputs);
            let pressures = [state.pressure_a, state.pressure_b];
            let pressures = self.gas_pressures(pressures, &self.layout.read_gas(vector), setting);
            (self.settings(setting), self.adjustment_power(pressures, setting))
        } else {
            ([zero; 2], zero)
        };
        let (turning, torque) =
            if self.linkage.is_some() { (load, end.on_load(joint.on_load)) } else { (still, zero) };
        let [gas_pressures, ratios] = self.told_of_gas(vector, self.layout.setting(inputs));
        let oil_pressures = self.oil_pressures([joint.sensed, joint.on_load]);
        [
            self.measured_force(&state),
            state.spool.spool,
            state.pressure_a,
            state.pressure_b,
            self.supply_of(&state).pressure,
            position,
            state.velocity,
            joint.sensor_deflection,
            forces.friction.force,
            forces.end_stops,
            flows.from_valve[0],
            flows.from_valve[1],
            self.supply_flow(&state, &flows.edges),
            end.motion.position,
            end.motion.velocity,
            ports[0],
            ports[1],
            forces.hydraulic,
            self.spool.convert(&mut constant::<S, T>).opening(&state.spool),
            joint.spring.position,
            joint.on_load,
            turning.position,
            turning.velocity,
            torque,
            gas_pressures[0],
            gas_pressures[1],
            ratios[0],
            ratios[1],
            settings[0],
            settings[1],
            power,
            oil_pressures[0],
            oil_pressures[1],
        ]
    }

    /// Pressures of the oil of a transmission in Pa where it carries these forces in N; zero
    /// without one.
    fn oil_pressures<T: Scalar + From<S>>(&self, forces: [T; 2]) -> [T; 2] {
        match &self.series {
            Some(MovingSeries::Oil(column)) => {
                let column = column.convert(&mut constant::<S, T>);
                forces.map(|force| column.pressure(force))
            }
            Some(MovingSeries::Spring(_)) | None => [T::from(0.0); 2],
        }
    }

    /// The [`INDICATORS`] at a state and inputs.
    pub(super) fn indicated<T: Scalar + From<S>>(&self, vector: &[T], inputs: &[T]) -> [T; INDICATORS.len()] {
        let state = self.layout.read(vector);
        let gas = self.layout.read_gas(vector);
        let ground = ground_of(inputs);
        let load = self.load_of(&state, &ground);
        let joint = self.joint(&state, vector, &self.end_of(&load).motion);
        let position = joint.position;
        let vapour: T = constant(self.vapour_pressure);
        let [to_end_a, to_end_b] = match self.cylinder.stroke.length() {
            None => [T::from(1.0); 2],
            Some(stroke) => [position, constant::<S, T>(stroke) - position],
        };
        let [compliance_a, compliance_b] = self.oil_compliance(&state, position);
        let supply = self.supply_of(&state);
        let setting = self.layout.setting(inputs);
        let [precharge_a, precharge_b] = self.precharges(&gas, setting);
        let charged = |precharge: Option<T>, pressure: T| {
            precharge.map_or(T::from(1.0), |precharge| pressure - precharge)
        };
        let below = |limit: Option<T>, pressure: T| limit.map_or(T::from(1.0), |limit| limit - pressure);
        let [behind_a, behind_b] = self.gas_pressures([state.pressure_a, state.pressure_b], &gas, setting);
        let [limit_a, limit_b] = self.gas_limits(setting);
        [
            state.pressure_a.minimum(behind_a) - vapour,
            state.pressure_b.minimum(behind_b) - vapour,
            to_end_a,
            to_end_b,
            compliance_a,
            compliance_b,
            self.load.convert(&mut constant::<S, T>).clearance(&load, &ground),
            supply.pressure - supply.tank_pressure,
            charged(precharge_a, behind_a),
            charged(precharge_b, behind_b),
            below(limit_a, behind_a),
            below(limit_b, behind_b),
            match &self.series {
                Some(MovingSeries::Spring(spring)) => {
                    spring.convert(&mut constant::<S, T>).clearance(joint.spring.position)
                }
                Some(MovingSeries::Oil(_)) | None => T::from(1.0),
            },
            match &self.series {
                Some(MovingSeries::Oil(column)) => {
                    self.least_oil_pressure(column, joint.sensed, self.layout.columns(vector)) - vapour
                }
                Some(MovingSeries::Spring(_)) | None => T::from(1.0),
            },
        ]
    }
}

/// The machine's inputs by name; missing inputs are NaN.
#[inline(always)]
pub(super) fn ground_of<T: Scalar>(inputs: &[T]) -> Motion<T> {
    let mut entries = inputs.iter().copied();
    let mut next = || entries.next().unwrap_or(T::from(f64::NAN));
    Motion { position: next(), velocity: next() }
}
