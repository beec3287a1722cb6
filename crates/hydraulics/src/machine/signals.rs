use phea_dynamics::scalar::{Parameters, Scalar};

use super::equations::constant;
use super::{Machine, MachineState, Motion};
use crate::series::MovingSeries;
use crate::signal::Signal;

/// Signals of a machine at one time; those of parts that it lacks are zero.
///
/// Pairs refer to sides A and B. With a series element, `force` is the one measured by its
/// [`ForceFrom`](crate::series::ForceFrom), and `load_force` is the force on the load. Behind a
/// linkage `load` is the motion of the rod's end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MachineSignals<T = f64> {
    /// Force of the rod on the load, N.
    pub force: T,
    /// Position U of the spool, V.
    pub spool: T,
    /// Opening of the edges, y = U - U_0 - z, less null bias and magnetic lag, V
    /// ([`crate::servovalve::SpoolImperfection`]).
    pub opening: T,
    /// Pressures of the chambers and of the lines' ends at the cylinder, Pa.
    pub pressures: [T; 2],
    /// Pressures of the lines' ends at the valve, Pa.
    pub port_pressures: [T; 2],
    /// Supply pressure at the valve, Pa.
    pub supply_pressure: T,
    /// Motion of the piston: m, m/s.
    pub piston: Motion<T>,
    /// Deflection of the force sensor, m.
    pub deflection: T,
    /// Force of the chambers on the piston, N.
    pub hydraulic_force: T,
    /// Friction of the piston, N.
    pub friction: T,
    /// Force of the end stops on the piston, N.
    pub end_stops: T,
    /// Flows from the valve into the lines, m3/s.
    pub flows: [T; 2],
    /// Flow from the supply into the valve, m3/s.
    pub supply_flow: T,
    /// Motion of the load: m, m/s.
    pub load: Motion<T>,
    /// Compression of the series spring, or of the oil of a transmission, m.
    pub series_deflection: T,
    /// Force on the load, N.
    pub load_force: T,
    /// Motion of the joint of a linkage: rad, rad/s.
    pub joint: Motion<T>,
    /// Torque of the rod on that joint, N m.
    pub joint_torque: T,
    /// Pressures of the gas behind necks, Pa.
    pub gas_pressures: [T; 2],
    /// Absolute temperatures of gas that exchanges heat over those of its walls.
    pub gas_temperature_ratios: [T; 2],
    /// Settings of the accumulators.
    pub settings: [T; 2],
    /// Power of the adjustment, W, [`MovedGas::power`](crate::accumulator::MovedGas::power).
    pub adjustment_power: T,
    /// Pressures of a transmission's oil at the pistons on rod and load, Pa.
    pub transmission_pressures: [T; 2],
}

impl<T: Copy> MachineSignals<T> {
    /// Value of a signal; `None` for those of the controller and of the external inputs on the
    /// load.
    pub fn get(&self, signal: Signal) -> Option<T> {
        Some(match signal {
            Signal::Force => self.force,
            Signal::Spool => self.spool,
            Signal::Opening => self.opening,
            Signal::PressureA => self.pressures[0],
            Signal::PressureB => self.pressures[1],
            Signal::PortPressureA => self.port_pressures[0],
            Signal::PortPressureB => self.port_pressures[1],
            Signal::SupplyPressure => self.supply_pressure,
            Signal::Position => self.piston.position,
            Signal::Velocity => self.piston.velocity,
            Signal::Deflection => self.deflection,
            Signal::HydraulicForce => self.hydraulic_force,
            Signal::Friction => self.friction,
            Signal::EndStops => self.end_stops,
            Signal::FlowA => self.flows[0],
            Signal::FlowB => self.flows[1],
            Signal::SupplyFlow => self.supply_flow,
            Signal::LoadPosition => self.load.position,
            Signal::LoadVelocity => self.load.velocity,
            Signal::SeriesDeflection => self.series_deflection,
            Signal::LoadForce => self.load_force,
            Signal::JointAngle => self.joint.position,
            Signal::JointVelocity => self.joint.velocity,
            Signal::JointTorque => self.joint_torque,
            Signal::GasPressureA => self.gas_pressures[0],
            Signal::GasPressureB => self.gas_pressures[1],
            Signal::GasTemperatureRatioA => self.gas_temperature_ratios[0],
            Signal::GasTemperatureRatioB => self.gas_temperature_ratios[1],
            Signal::SettingA => self.settings[0],
            Signal::SettingB => self.settings[1],
            Signal::AdjustmentPower => self.adjustment_power,
            Signal::TransmissionPressureRod => self.transmission_pressures[0],
            Signal::TransmissionPressureLoad => self.transmission_pressures[1],
            Signal::Time
            | Signal::Reference
            | Signal::Control
            | Signal::FilteredReference
            | Signal::GasTemperatureA
            | Signal::GasTemperatureB
            | Signal::Command
            | Signal::UnlimitedControl
            | Signal::Integral
            | Signal::Measurement
            | Signal::VirtualForce
            | Signal::ExternalForce
            | Signal::ExternalTorque => return None,
        })
    }
}

/// Names of the state events of a machine, in the order of its indicators. Each indicator is
/// positive in ordinary operation and negative during the event.
///
/// `cavitation`: the chamber's pressure, or that behind the neck of its accumulator if that is
/// lower, less vapour pressure in Pa. `end_stop`: the remaining distance to that end in m. `empty`:
/// the chamber's compliance in m3/Pa without accumulators, which vanishes with its volume.
/// `load_contact`: the remaining distance to the wall in m. `supply_lost`: supply less tank
/// pressure in Pa. `accumulator_empty`: the chamber's pressure, or that behind the neck if there is
/// one, less the precharge of its accumulator in Pa. `accumulator_overpressure`: the remaining
/// margin to the pressure limit of that gas in Pa, which moves with an adjusted precharge.
/// `series_end`: the remaining distance to the nearer end of a series spring's travel in m.
/// `cavitation_transmission`: the lowest pressure in the oil of a transmission, less vapour
/// pressure in Pa. `relief_valve`, `check_valve`: the remaining margin to the cracking pressure of
/// the valve between that chamber and the tank in Pa.
pub const INDICATORS: [&str; 18] = [
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
    "relief_valve_a",
    "relief_valve_b",
    "check_valve_a",
    "check_valve_b",
];

impl<S: Scalar> Machine<S> {
    /// Signals at a state and inputs. `force` differs from `hydraulic_force` by the piston's
    /// friction, end stops and acceleration:
    ///
    /// ```text
    /// F_H = A_A p_A - A_B p_B = F_e + F_fr - F_stops + M dv/dt      all positive towards the B end except F_fr      thesis (4.29)
    /// ```
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::actuator::Actuator;
    /// # use phea_hydraulics::reference_rig::{components, hose_line};
    /// # use phea_hydraulics::stiffness::StiffnessModel;
    /// use phea_hydraulics::machine::{Machine, MachineOptions};
    /// use phea_hydraulics::signal::Signal;
    /// let actuator = Actuator::new(components(hose_line(), StiffnessModel::Uniform))?;
    /// let machine = Machine::new(&actuator, &MachineOptions::default())?;
    /// let signals = machine.signals(&[0.0, 0.0, 35e5, 35e5, 1e-4, 0.0], &[0.25, 0.0]);
    /// assert_eq!((signals.force, signals.piston.position), (2e3, 0.2501));
    /// assert_eq!(signals.get(Signal::PressureA), Some(35e5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn signals<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> MachineSignals<T> {
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
        let [gas_pressures, gas_temperature_ratios] = self.told_of_gas(vector, self.layout.setting(inputs));
        MachineSignals {
            force: self.measured_force(&state),
            spool: state.spool.spool,
            opening: self.valve.spool.convert(&mut constant::<S, T>).opening(&state.spool),
            pressures: [state.pressure_a, state.pressure_b],
            port_pressures: ports,
            supply_pressure: self.supply_of(&state).pressure,
            piston: Motion { position, velocity: state.velocity },
            deflection: joint.sensor_deflection,
            hydraulic_force: forces.hydraulic,
            friction: forces.friction.force,
            end_stops: forces.end_stops,
            flows: flows.from_valve,
            supply_flow: self.supply_flow(&state, &flows.edges),
            load: end.motion,
            series_deflection: joint.spring.position,
            load_force: joint.on_load,
            joint: turning,
            joint_torque: torque,
            gas_pressures,
            gas_temperature_ratios,
            settings,
            adjustment_power: power,
            transmission_pressures: self.oil_pressures([joint.sensed, joint.on_load]),
        }
    }

    /// Pressures of the oil of a transmission that carries these forces in N, Pa; zero without a
    /// transmission.
    fn oil_pressures<T: Scalar + From<S>>(&self, forces: [T; 2]) -> [T; 2] {
        match &self.series {
            Some(MovingSeries::Oil(column)) => {
                let column = column.convert(&mut constant::<S, T>);
                forces.map(|force| column.pressure(force))
            }
            Some(MovingSeries::Spring(_)) | None => [T::from(0.0); 2],
        }
    }

    /// Indicators [`INDICATORS`] at a state and inputs.
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
        let [[relief_a, check_a], [relief_b, check_b]] = self.valve_margins(&state);
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
            relief_a,
            relief_b,
            check_a,
            check_b,
        ]
    }

    /// Margins to the cracking pressures of the relief and the check valve of each chamber, Pa; 1
    /// for a valve that is absent.
    fn valve_margins<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> [[T; 2]; 2] {
        let (one, tank) = (T::from(1.0), constant::<S, T>(self.supply.tank_pressure));
        let valves = self.outward.map_or([None; 2], |outward| outward.port_valves);
        let margins = |side: usize, pressure: T| {
            let valves = valves[side].map(|valves| valves.convert(&mut constant::<S, T>));
            let excesses = valves.map_or([None; 2], |valves| valves.excesses(pressure - tank));
            excesses.map(|excess| excess.map_or(one, |excess| -excess))
        };
        [margins(0, state.pressure_a), margins(1, state.pressure_b)]
    }
}

/// Inputs of the machine by name; missing inputs are NaN.
#[inline(always)]
pub(super) fn ground_of<T: Scalar>(inputs: &[T]) -> Motion<T> {
    let mut entries = inputs.iter().copied();
    let mut next = || entries.next().unwrap_or(T::from(f64::NAN));
    Motion { position: next(), velocity: next() }
}
