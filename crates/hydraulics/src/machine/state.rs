use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::Sliding;

use super::gas::GasStates;
use super::series::SeriesStates;
use super::{Machine, Motion};
use crate::series::MovingSeries;
use crate::servovalve::SpoolState;
use crate::signal::Signal;

/// States of a machine, or their rates, by name. States that a machine lacks are zero and are not
/// in its vector.
///
/// The order of the vector is that of the fields: spool voltage and rate, p_A, p_B, deflection,
/// velocity, and then, if present, those of bristles, load, capacity between the chambers, supply,
/// spool friction, magnetic lag, series spring. The states of gas ([`Machine::state_names`] names
/// them too), of the oil of a transmission and those of lines follow; they are read only by the
/// parts that use them, so that machines without them store no zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineState<T = f64> {
    /// Position of the spool in V and its drive; its two memories are last in the vector.
    pub spool: SpoolState<T>,
    /// Chamber pressure p_A, Pa.
    pub pressure_a: T,
    /// Chamber pressure p_B, Pa.
    pub pressure_b: T,
    /// Deflection x - x_L of the force sensor, m; of a series spring instead, if it has neither
    /// damper nor mass.
    pub deflection: T,
    /// Piston velocity v, m/s.
    pub velocity: T,
    /// Deflection z of the bristles, m.
    pub bristle: T,
    /// Motion of a load that is not prescribed: its position from its ground, x_L - x_0, in m, and
    /// its velocity v_L in m/s; behind a linkage its angle in rad and angular velocity in rad/s.
    /// Errors are scaled by the deformation of its spring or wall, not by its distance from the end
    /// of the cylinder.
    pub load: Motion<T>,
    /// Pressure difference p_cp over the capacity of a valve between the chambers, Pa.
    pub cross_port_pressure: T,
    /// Supply pressure p_S of a limited pump, Pa.
    pub supply_pressure: T,
    /// Series spring with damper or mass: deflection of its spring in m, and velocity of the mass
    /// between sensor and spring in m/s.
    pub series: Motion<T>,
}

/// States of a machine beyond the first six.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Layout {
    bristle: bool,
    load: bool,
    supply: bool,
    spool_friction: bool,
    magnetic_lag: bool,
    /// Capacity between the chambers.
    capacity: bool,
    series: SeriesStates,
    /// Necks of accumulators at the chambers.
    necks: [bool; 2],
    /// Valves between chambers and gas.
    valves: [bool; 2],
    /// Accumulators at the chambers whose gas is added and removed.
    moved: [bool; 2],
    /// True if the setting of accumulators is an input.
    setting: bool,
    /// Accumulators at the chambers whose gas exchanges heat.
    heat: [bool; 2],
    /// True if an external force is an input.
    external_force: bool,
    /// States of the gas, which follow those of [`MachineState`].
    gas: usize,
    /// States of the oil of a transmission, which follow those of the gas.
    columns: usize,
    /// States of both lines, which follow all others, A first.
    lines: [usize; 2],
    /// Waves that arrive from both lines, the last inputs, A first.
    waves: [usize; 2],
    /// States of [`MachineState`].
    own: usize,
}

/// Number of the first inputs, position and velocity of the ground.
const GROUND_INPUTS: usize = 2;
/// Number of inputs for the change of the setting of accumulators, and its rate in 1/s.
const SETTING_INPUTS: usize = 2;

impl<T: Scalar> MachineState<T> {
    /// State of zeros.
    pub(super) fn zero() -> MachineState<T> {
        let zero = T::from(0.0);
        let spool = SpoolState { spool: zero, spool_rate: zero, spool_friction: zero, magnetic_lag: zero };
        MachineState {
            spool,
            pressure_a: zero,
            pressure_b: zero,
            deflection: zero,
            velocity: zero,
            bristle: zero,
            load: Motion { position: zero, velocity: zero },
            supply_pressure: zero,
            cross_port_pressure: zero,
            series: Motion { position: zero, velocity: zero },
        }
    }
}

impl Layout {
    pub(super) fn of<S: Copy>(machine: &Machine<S>) -> Layout {
        let gas = [0, 1].map(|side| machine.gas[side].as_ref());
        let mut layout = Layout {
            bristle: machine.friction.has_bristles(),
            load: machine.load.moves(),
            supply: machine.power_unit.yields(),
            spool_friction: machine.valve.spool.threshold.is_some(),
            magnetic_lag: machine.valve.spool.hysteresis_width.is_some(),
            necks: gas.map(|gas| gas.is_some_and(|gas| gas.neck().is_some())),
            valves: gas.map(|gas| gas.is_some_and(|gas| gas.valve().is_some())),
            moved: gas.map(|gas| gas.is_some_and(|gas| gas.adjusted().is_some())),
            setting: machine.moving_setting,
            heat: gas.map(|gas| gas.is_some_and(|gas| gas.relaxing().is_some())),
            capacity: machine.cross_port.is_some_and(|port| port.capacity.is_some()),
            series: SeriesStates::of(machine.series.as_ref()),
            columns: match &machine.series {
                Some(MovingSeries::Oil(column)) => 2 * column.segments,
                Some(MovingSeries::Spring(_)) | None => 0,
            },
            external_force: machine.external_force,
            lines: machine.lines.map(|line| line.states()),
            waves: machine.lines.map(|line| line.delays().len()),
            gas: 0,
            own: 0,
        };
        let (mut own, mut gas) = (0, 0);
        layout.visit(&mut MachineState::<f64>::zero(), |_| own += 1);
        layout.visit_gas(&mut GasStates::<f64>::zero(), |_| gas += 1);
        (layout.own, layout.gas) = (own, gas);
        layout
    }

    /// States of a series element.
    #[inline(always)]
    pub(super) fn series(&self) -> SeriesStates {
        self.series
    }

    /// Number of states.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        let [a, b] = self.lines;
        self.before_lines() + a + b
    }

    /// Number of states before those of the lines.
    #[inline(always)]
    fn before_lines(&self) -> usize {
        self.own + self.gas + self.columns
    }

    /// States of the oil of a transmission: velocity and deflection of each segment.
    #[inline(always)]
    pub(super) fn columns<'a, T>(&self, vector: &'a [T]) -> &'a [T] {
        let first = self.own + self.gas;
        vector.get(first..first + self.columns).unwrap_or_default()
    }

    /// States of the oil of a transmission, mutable.
    #[inline(always)]
    pub(super) fn columns_mut<'a, T>(&self, vector: &'a mut [T]) -> &'a mut [T] {
        let first = self.own + self.gas;
        vector.get_mut(first..first + self.columns).unwrap_or_default()
    }

    /// Friction acts on the velocity, the sixth of the states of all machines, and on the bristle
    /// deflection after it.
    pub(super) fn sliding(&self) -> Sliding {
        Sliding { velocity: 5, memory: self.bristle.then_some(6) }
    }

    /// Number of inputs.
    #[inline(always)]
    pub(super) fn inputs(&self) -> usize {
        let [a, b] = self.waves;
        self.before_waves() + a + b
    }

    /// Number of inputs before the waves.
    #[inline(always)]
    fn before_waves(&self) -> usize {
        let setting = if self.setting { SETTING_INPUTS } else { 0 };
        GROUND_INPUTS + usize::from(self.external_force) + setting
    }

    /// External force in N, an input; `None` if the machine does not have this input.
    #[inline(always)]
    pub(super) fn external_force<T: Scalar>(&self, inputs: &[T]) -> Option<T> {
        let missing = T::from(f64::NAN);
        self.external_force.then(|| inputs.get(GROUND_INPUTS).copied().unwrap_or(missing))
    }

    /// Change of the setting of accumulators from rest and its rate in 1/s, inputs; zero if none is
    /// adjusted.
    #[inline(always)]
    pub(super) fn setting<T: Scalar>(&self, inputs: &[T]) -> [T; 2] {
        if !self.setting {
            return [T::from(0.0); 2];
        }
        let first = GROUND_INPUTS + usize::from(self.external_force);
        [0, 1].map(|place| inputs.get(first + place).copied().unwrap_or(T::from(f64::NAN)))
    }

    /// True if accumulators at the chambers are adjusted.
    #[inline(always)]
    pub(super) fn is_adjusted(&self) -> bool {
        self.valves != [false; 2] || self.moved != [false; 2]
    }

    /// True if the gas at each chamber has a pressure of its own.
    #[inline(always)]
    pub(super) fn behind(&self) -> [bool; 2] {
        [self.necks[0] || self.valves[0], self.necks[1] || self.valves[1]]
    }

    /// True if the gas at each chamber exchanges heat.
    pub(super) fn heated(&self) -> [bool; 2] {
        self.heat
    }

    /// True if gas at a chamber has states of its own, or is adjusted.
    #[inline(always)]
    pub(super) fn has_gas(&self) -> bool {
        self.gas != 0 || self.moved != [false; 2]
    }

    /// True if the gas at each chamber has states of its own, or is adjusted.
    #[inline(always)]
    pub(super) fn gas_at(&self) -> [bool; 2] {
        let [behind_a, behind_b] = self.behind();
        [behind_a || self.heat[0] || self.moved[0], behind_b || self.heat[1] || self.moved[1]]
    }

    /// True if lines have states of their own.
    #[inline(always)]
    pub(super) fn has_lines(&self) -> bool {
        self.lines != [0, 0]
    }

    /// Indices of the states that are memories, and stay constant whenever all others do: bristles
    /// and the friction and lag of the spool.
    pub(super) fn memories(&self) -> Vec<usize> {
        let mut state = MachineState::<f64>::zero();
        (state.bristle, state.spool.spool_friction, state.spool.magnetic_lag) = (1.0, 1.0, 1.0);
        let mut vector = vec![0.0; self.count()];
        self.write(state, &mut vector);
        vector.iter().enumerate().filter(|(_, value)| **value != 0.0).map(|(index, _)| index).collect()
    }

    /// Indices of the pressures of the gas at these chambers.
    pub(super) fn gas_places(&self, sides: [bool; 2]) -> Vec<usize> {
        let pressures = sides.map(|is_meant| if is_meant { 1.0 } else { 0.0 });
        let mut vector = vec![0.0; self.count()];
        self.write_gas(GasStates { pressures, ..GasStates::zero() }, &mut vector);
        vector.iter().enumerate().filter(|(_, value)| **value != 0.0).map(|(index, _)| index).collect()
    }

    /// States of both lines.
    #[inline(always)]
    pub(super) fn lines<'a, T>(&self, vector: &'a [T]) -> [&'a [T]; 2] {
        two_parts(vector, self.before_lines(), self.lines)
    }

    /// States of both lines, mutable.
    #[inline(always)]
    pub(super) fn lines_mut<'a, T>(&self, vector: &'a mut [T]) -> [&'a mut [T]; 2] {
        let [count_a, count_b] = self.lines;
        let lines = vector.get_mut(self.before_lines()..).unwrap_or_default();
        match lines.split_at_mut_checked(count_a) {
            Some((line_a, rest)) => [line_a, rest.get_mut(..count_b).unwrap_or_default()],
            None => [&mut [], &mut []],
        }
    }

    /// Waves that arrive from both lines.
    #[inline(always)]
    pub(super) fn arriving<'a, T>(&self, inputs: &'a [T]) -> [&'a [T]; 2] {
        two_parts(inputs, self.before_waves(), self.waves)
    }

    /// Indices of the waves sent into both lines.
    pub(super) fn outgoing<'a, T>(&self, waves: &'a mut [T]) -> [&'a mut [T]; 2] {
        match waves.split_at_mut_checked(self.waves[0]) {
            Some(parts) => [parts.0, parts.1],
            None => [&mut [], &mut []],
        }
    }

    /// States by name; states that the vector lacks are NaN.
    #[inline(always)]
    pub(super) fn read<T: Scalar>(&self, vector: &[T]) -> MachineState<T> {
        let mut state = MachineState::zero();
        let mut entries = vector.iter();
        self.visit(&mut state, |slot| *slot = entries.next().copied().unwrap_or(T::from(f64::NAN)));
        state
    }

    /// Writes the states in the order of the vector.
    #[inline(always)]
    pub(super) fn write<T: Scalar>(&self, mut state: MachineState<T>, vector: &mut [T]) {
        let mut entries = vector.iter_mut();
        self.visit(&mut state, |slot| {
            if let Some(entry) = entries.next() {
                *entry = *slot;
            }
        });
    }

    /// Visits the positions of all states in the order of the vector.
    #[inline(always)]
    fn visit<T>(&self, state: &mut MachineState<T>, mut visit: impl FnMut(&mut T)) {
        visit(&mut state.spool.spool);
        visit(&mut state.spool.spool_rate);
        visit(&mut state.pressure_a);
        visit(&mut state.pressure_b);
        visit(&mut state.deflection);
        visit(&mut state.velocity);
        if self.bristle {
            visit(&mut state.bristle);
        }
        if self.load {
            visit(&mut state.load.position);
            visit(&mut state.load.velocity);
        }
        if self.capacity {
            visit(&mut state.cross_port_pressure);
        }
        if self.supply {
            visit(&mut state.supply_pressure);
        }
        if self.spool_friction {
            visit(&mut state.spool.spool_friction);
        }
        if self.magnetic_lag {
            visit(&mut state.spool.magnetic_lag);
        }
        if matches!(self.series, SeriesStates::Damped | SeriesStates::Mass) {
            visit(&mut state.series.position);
        }
        if self.series == SeriesStates::Mass {
            visit(&mut state.series.velocity);
        }
    }

    /// States of the gas by name; states that the vector lacks are NaN, those that the machine
    /// lacks are zero.
    pub(super) fn read_gas<T: Scalar>(&self, vector: &[T]) -> GasStates<T> {
        let mut gas = GasStates::zero();
        let mut entries = vector.iter().skip(self.own);
        self.visit_gas(&mut gas, |slot| *slot = entries.next().copied().unwrap_or(T::from(f64::NAN)));
        gas
    }

    /// Writes the states of the gas, or their rates, at their positions in the vector.
    pub(super) fn write_gas<T: Copy>(&self, mut gas: GasStates<T>, vector: &mut [T]) {
        let mut entries = vector.iter_mut().skip(self.own);
        self.visit_gas(&mut gas, |slot| {
            if let Some(entry) = entries.next() {
                *entry = *slot;
            }
        });
    }

    /// Visits the states of the gas in the order of the vector.
    #[inline(always)]
    fn visit_gas<T>(&self, gas: &mut GasStates<T>, mut visit: impl FnMut(&mut T)) {
        for side in 0..2 {
            if self.necks[side] {
                visit(&mut gas.neck_flows[side]);
            }
            if self.behind()[side] {
                visit(&mut gas.pressures[side]);
            }
        }
        for side in 0..2 {
            if self.heat[side] {
                visit(&mut gas.warmings[side]);
            }
        }
    }
}

/// Two consecutive slices of these lengths after the first entries; empty if the vector is too
/// short.
#[inline(always)]
fn two_parts<T>(vector: &[T], behind: usize, [first, second]: [usize; 2]) -> [&[T]; 2] {
    let rest = vector.get(behind..).unwrap_or_default();
    match rest.split_at_checked(first) {
        Some((one, rest)) => [one, rest.get(..second).unwrap_or_default()],
        None => [&[], &[]],
    }
}

impl Machine {
    /// Names of all states with their units, in the order of the vector; those of a line are
    /// counted.
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::{actuator::Actuator, stiffness::StiffnessModel};
    /// # use phea_hydraulics::reference_rig::{components, hose_line};
    /// # use phea_hydraulics::machine::{Machine, MachineOptions};
    /// let actuator = Actuator::new(components(hose_line(), StiffnessModel::Uniform))?;
    /// let machine = Machine::new(&actuator, &MachineOptions::default())?;
    /// assert_eq!(machine.state_names()[..2], ["spool_v", "spool_rate_v_per_s"]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn state_names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        let mut own = NAMES;
        if self.layout.series == SeriesStates::Spring {
            own.deflection = own.series.position;
        }
        if self.linkage.is_some() {
            own.load = Motion { position: "joint_displacement_rad", velocity: Signal::JointVelocity.name() };
        }
        self.layout.visit(&mut own, |name| names.push((*name).to_string()));
        self.layout.visit_gas(&mut GAS_NAMES.clone(), |name| names.push((*name).to_string()));
        let plug = |number: usize| {
            [format!("transmission_velocity_{number}_m_per_s"), format!("transmission_deflection_{number}_m")]
        };
        names.extend((1..=self.layout.columns / 2).flat_map(plug));
        for (line, count) in ["line_a", "line_b"].into_iter().zip(self.layout.lines) {
            names.extend((1..=count).map(|number| format!("{line}_{number}")));
        }
        names
    }
}

/// Names of the states with their units.
const NAMES: MachineState<&str> = MachineState {
    spool: SpoolState {
        spool: Signal::Spool.name(),
        spool_rate: "spool_rate_v_per_s",
        spool_friction: "spool_friction_v",
        magnetic_lag: "magnetic_lag_v",
    },
    pressure_a: Signal::PressureA.name(),
    pressure_b: Signal::PressureB.name(),
    deflection: Signal::Deflection.name(),
    velocity: Signal::Velocity.name(),
    bristle: "bristle_m",
    load: Motion { position: "load_displacement_m", velocity: Signal::LoadVelocity.name() },
    supply_pressure: Signal::SupplyPressure.name(),
    cross_port_pressure: "cross_port_pressure_pa",
    series: Motion { position: Signal::SeriesDeflection.name(), velocity: "series_velocity_m_per_s" },
};

const GAS_NAMES: GasStates<&str> = GasStates {
    neck_flows: ["neck_flow_a_m3_per_s", "neck_flow_b_m3_per_s"],
    pressures: [Signal::GasPressureA.name(), Signal::GasPressureB.name()],
    warmings: ["gas_warming_a", "gas_warming_b"],
};
