use phea_dynamics::simulation::Plant;

use super::balance::HeldValue;
use super::series::HeldJoint;
use super::{Machine, MachineError, MachineState};
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::friction::MovingFriction;
use crate::load::Load;
use crate::operating_point::OperatingPoint;
use crate::stroke::ActuatorStroke;

/// Initial values of a run; values that are not stated are zero, and the supply pressure is that of
/// its power unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StartValues {
    /// Piston position x, m.
    pub position: f64,
    /// Piston velocity, m/s.
    pub velocity: f64,
    /// Chamber pressure p_A, Pa.
    pub pressure_a: f64,
    /// Chamber pressure p_B, Pa.
    pub pressure_b: f64,
    /// Force on the load, N.
    pub force: f64,
    /// Spool position, V.
    pub spool: f64,
}

/// Initial condition of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialCondition {
    /// States of the machine.
    pub state: Vec<f64>,
    /// Command that holds the spool at its position, V.
    pub command: f64,
    /// Initial position in m and velocity in m/s of the load's ground, in rad and rad/s behind a
    /// linkage: where a prescribed motion starts.
    pub inputs: [f64; 2],
    /// External force on the load before the start, which is zero, N; `None` for a machine without
    /// that input.
    pub external_force: Option<f64>,
    /// Change of the setting of the accumulators before the start, at rest; `None` for a machine
    /// without that input.
    pub setting_change: Option<f64>,
    /// Waves that arrive from the lines before the start, Pa, as the last inputs of the machine.
    pub waves: Vec<f64>,
}

impl InitialCondition {
    /// All inputs of the machine: the ground, the external force, the setting of the accumulators,
    /// and the waves.
    pub fn all_inputs(&self) -> Vec<f64> {
        let setting: Vec<f64> = self.setting_change.into_iter().flat_map(|change| [change, 0.0]).collect();
        [&self.inputs, self.external_force.as_slice(), setting.as_slice(), self.waves.as_slice()].concat()
    }
}

/// State with its load held, and the states of the oil of a transmission.
struct HeldState {
    state: MachineState,
    columns: Vec<f64>,
}

/// Largest residual of an equilibrium, in scales per second.
const REST_TOLERANCE: f64 = 1e-4;
/// Force that counts as rounding, N: a load without spring or wall holds it.
const ROUNDED_FORCE: f64 = 1e-6;

impl Machine {
    /// Machine at stated values. The load's ground is where the stated force is held: at a spring's
    /// relaxed end, at a wall that the load touches with this force, or at a wall at the distance
    /// of its gap if the force is zero.
    ///
    /// # Errors
    /// Position outside the stroke, a pressure below vacuum, a value that is not finite, a pull on
    /// a wall.
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::{actuator::Actuator, stiffness::StiffnessModel};
    /// # use phea_hydraulics::reference_rig::{components, hose_line};
    /// # use phea_hydraulics::machine::{Machine, MachineOptions, StartValues};
    /// let actuator = Actuator::new(components(hose_line(), StiffnessModel::Uniform))?;
    /// let machine = Machine::new(&actuator, &MachineOptions::default())?;
    /// let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
    /// let beginning = machine.start(&start)?;
    /// assert_eq!(beginning.state, [0.0, 0.0, 35e5, 35e5, 0.0, 0.0]);
    /// assert_eq!(beginning.inputs, [0.25, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn start(&self, start: &StartValues) -> Result<InitialCondition, MachineError> {
        check(start, self.cylinder.stroke)?;
        let mut state = MachineState::zero();
        state.spool.spool = start.spool;
        (state.pressure_a, state.pressure_b) = (start.pressure_a, start.pressure_b);
        state.cross_port_pressure = start.pressure_a - start.pressure_b;
        state.supply_pressure = self.supply.pressure;
        state.velocity = start.velocity;
        state.bristle = self.settled_bristle(start.velocity);
        let (held, ground) = self.held(&state, start.position, start.force)?;
        Ok(self.begin(&held, start.position, ground))
    }

    /// Machine at rest, or in steady motion with its load, at an operating point of its actuator:
    /// its command is held.
    ///
    /// Effects that the operating point omits (leakage across the piston, a limited pump,
    /// resistance of lines) shift the pressures until all flows balance, and the force is the one
    /// that these pressures hold.
    ///
    /// # Errors
    /// Errors of [`Machine::start`]; no balance near the operating point.
    pub fn rest(&self, point: &OperatingPoint) -> Result<InitialCondition, MachineError> {
        self.settled(point, HeldValue::Spool)
    }

    /// Machine as in [`Machine::rest`], but with the force of the pressures held, and the command
    /// adjusted to hold it.
    ///
    /// # Errors
    /// Errors of [`Machine::rest`].
    pub fn rest_under_load(&self, point: &OperatingPoint) -> Result<InitialCondition, MachineError> {
        self.settled(point, HeldValue::Force(point.hydraulic_force))
    }

    /// Indices of the states that stay at any value while all others are at rest: memories of
    /// friction and magnetisation. At zero they carry no force.
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::{actuator::Actuator, stiffness::StiffnessModel};
    /// # use phea_hydraulics::reference_rig::{components, hose_line};
    /// # use phea_hydraulics::machine::{Machine, MachineOptions};
    /// let actuator = Actuator::new(components(hose_line(), StiffnessModel::Uniform))?;
    /// let machine = Machine::new(&actuator, &MachineOptions::default())?;
    /// assert!(machine.memories().is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn memories(&self) -> Vec<usize> {
        self.layout.memories()
    }

    fn settled(
        &self,
        point: &OperatingPoint,
        held_value: HeldValue,
    ) -> Result<InitialCondition, MachineError> {
        let start = StartValues {
            position: point.position,
            velocity: point.velocity,
            pressure_a: point.pressure_a,
            pressure_b: point.pressure_b,
            force: 0.0,
            spool: point.command + self.valve.spool.null_bias,
        };
        check(&start, self.cylinder.stroke)?;
        let mut state = MachineState::zero();
        state.spool.spool = start.spool;
        (state.pressure_a, state.pressure_b) = (start.pressure_a, start.pressure_b);
        state.cross_port_pressure = start.pressure_a - start.pressure_b;
        state.supply_pressure = self.supply.pressure;
        state.velocity = start.velocity;
        state.bristle = self.settled_bristle(start.velocity);
        let balanced = self.balanced(&state, start.position, held_value);
        let forces = self.forces(&balanced, start.position);
        let force = forces.hydraulic + forces.end_stops - forces.friction.force;
        let (held, ground) = self.held(&balanced, start.position, force)?;
        let beginning = self.begin(&held, start.position, ground);
        let residual = self.residual(&beginning);
        if residual <= REST_TOLERANCE { Ok(beginning) } else { Err(MachineError::NoRest { residual }) }
    }

    /// State with its load held by this force in N at this piston position in m, and the position
    /// of its ground.
    fn held(
        &self,
        state: &MachineState,
        position: f64,
        force: f64,
    ) -> Result<(HeldState, f64), MachineError> {
        let HeldJoint { deflection, series, columns, ahead, on_load } =
            self.held_joint(force, state.velocity);
        let held = self.held_load(position - ahead, on_load, state.velocity);
        let (load, ground) = held.ok_or(MachineError::ImpossibleStart { quantity: "force", value: force })?;
        Ok((HeldState { state: MachineState { deflection, load, series, ..*state }, columns }, ground))
    }

    fn begin(
        &self,
        HeldState { state, columns }: &HeldState,
        position: f64,
        ground: f64,
    ) -> InitialCondition {
        let mut vector = vec![0.0; self.layout.count()];
        self.layout.write(*state, &mut vector);
        let pressures = [state.pressure_a, state.pressure_b];
        self.layout.write_gas(self.resting_gas(pressures), &mut vector);
        self.layout.columns_mut(&mut vector).copy_from_slice(columns);
        let flows = self.steady_flows(state, self.areas_at(position));
        let mut waves = Vec::new();
        let places = self.layout.lines_mut(&mut vector).into_iter().zip(&self.lines);
        for ((place, line), (pressure, flow)) in places.zip(pressures.into_iter().zip(flows)) {
            let (line_state, arriving) = line.steady_state(pressure, flow);
            place.copy_from_slice(&line_state);
            waves.extend(arriving);
        }
        InitialCondition {
            state: vector,
            command: state.spool.spool,
            inputs: [ground, state.load.velocity],
            external_force: self.external_force.then_some(0.0),
            setting_change: self.moving_setting.then_some(0.0),
            waves,
        }
    }

    /// Deflection of the bristles in steady motion.
    ///
    /// ```text
    /// z = sign(v) g(v)/sigma_0
    /// ```
    fn settled_bristle(&self, velocity: f64) -> f64 {
        match self.friction {
            MovingFriction::LuGre { lugre, .. } => {
                let curve = lugre.curve;
                (curve.steady_force(velocity) - curve.levels(velocity).viscous * velocity)
                    / lugre.bristle_stiffness
            }
            _ => 0.0,
        }
    }

    /// Greatest rate over the scale of its state, 1/s: zero in a steady motion.
    fn residual(&self, beginning: &InitialCondition) -> f64 {
        let mut rates = vec![0.0; self.layout.count()];
        self.rates(&beginning.state, beginning.command, &beginning.all_inputs(), &mut rates);
        rates.iter().zip(self.scales()).fold(0.0, |largest, (rate, scale)| {
            let relative = (rate / scale).abs();
            if relative.is_nan() { f64::INFINITY } else { relative.max(largest) }
        })
    }
}

impl Load {
    /// Distance x_L - x_0 at which the load is held with this force in N, m; `None` if there is
    /// none.
    pub(super) fn held_at(&self, force: f64) -> Option<f64> {
        match *self {
            Load::Prescribed => Some(0.0),
            Load::SpringMassDamper { stiffness, .. } if stiffness > 0.0 => Some(force / stiffness),
            Load::SpringMassDamper { .. } => (force.abs() <= ROUNDED_FORCE).then_some(0.0),
            Load::Wall { .. } if force.abs() <= ROUNDED_FORCE => Some(0.0),
            Load::Wall { gap, stiffness, .. } => (force > 0.0).then_some(gap + force / stiffness),
        }
    }
}

fn check(start: &StartValues, stroke: ActuatorStroke) -> Result<(), MachineError> {
    let StartValues { position, velocity, pressure_a, pressure_b, force, spool } = *start;
    if !stroke.contains(position) {
        let stroke = stroke.length().unwrap_or(f64::INFINITY);
        return Err(MachineError::StartOutsideStroke { position, stroke });
    }
    let vacuum = -ATMOSPHERIC_PRESSURE_ABSOLUTE;
    let values = [
        ("velocity", velocity, true),
        ("pressure_a", pressure_a, pressure_a > vacuum),
        ("pressure_b", pressure_b, pressure_b > vacuum),
        ("force", force, true),
        ("spool", spool, true),
    ];
    match values.into_iter().find(|(_, value, possible)| !(value.is_finite() && *possible)) {
        Some((quantity, value, _)) => Err(MachineError::ImpossibleStart { quantity, value }),
        None => Ok(()),
    }
}
