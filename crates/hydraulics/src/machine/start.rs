use nalgebra::{Matrix3, Vector3};
use phea_dynamics::scalar::Dual;
use phea_dynamics::simulation::Plant;

use super::{LoadModel, LoadMotion, Machine, MachineError, MachineState, PowerUnit};
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::friction::MovingFriction;
use crate::operating_point::OperatingPoint;

/// Values that a run starts from; what is not stated is zero, the supply's pressure as its power unit holds it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Piston position x in m.
    pub position: f64,
    /// Piston velocity in m/s.
    pub velocity: f64,
    /// Chamber pressure p_A in Pa.
    pub pressure_a: f64,
    /// Chamber pressure p_B in Pa.
    pub pressure_b: f64,
    /// Force on the load in N.
    pub force: f64,
    /// Spool position in V.
    pub spool: f64,
}

/// Where a run begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Beginning {
    /// The machine's states.
    pub state: Vec<f64>,
    /// The command in V that holds the spool there.
    pub command: f64,
    /// Position in m and velocity in m/s of the load's ground: where a prescribed motion starts.
    pub inputs: [f64; 2],
}

/// Steps of Newton's method towards the pressures of a rest, and halvings of each.
const REST_STEPS: usize = 60;
/// What may remain of a rest, in scales per second.
const REST_TOLERANCE: f64 = 1e-4;

impl Machine {
    /// The machine at stated values. Its load's ground lies where the stated force is held: at a spring's relaxed end, at a wall
    /// that the load touches with this force, or at a wall its gap away where the force is zero.
    ///
    /// # Errors
    /// A position outside the stroke, a pressure below vacuum, a value that is not finite, a pull on a wall.
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::{actuator::Actuator, stiffness::StiffnessModel};
    /// # use phea_hydraulics::reference_rig::{components, hose_line};
    /// # use phea_hydraulics::machine::{Machine, MachineOptions, Start};
    /// let actuator = Actuator::new(components(hose_line(), StiffnessModel::Uniform))?;
    /// let machine = Machine::new(&actuator, &MachineOptions::default())?;
    /// let start = Start { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..Start::default() };
    /// let beginning = machine.start(&start)?;
    /// assert_eq!(beginning.state, [0.0, 0.0, 35e5, 35e5, 0.0, 0.0]);
    /// assert_eq!(beginning.inputs, [0.25, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn start(&self, start: &Start) -> Result<Beginning, MachineError> {
        check(start, self.cylinder.stroke)?;
        let deflection = start.force / self.sensor_stiffness;
        let load = LoadMotion { position: start.position - deflection, velocity: start.velocity };
        let mut state = MachineState::zero();
        state.spool.spool = start.spool;
        state.pressure_a = start.pressure_a;
        state.pressure_b = start.pressure_b;
        state.deflection = deflection;
        state.velocity = start.velocity;
        state.bristle = self.settled_bristle(start.velocity);
        state.load = load;
        state.supply_pressure = self.supply.pressure;
        let relative = self.load.held_at(start.force);
        let relative =
            relative.ok_or(MachineError::ImpossibleStart { quantity: "force", value: start.force })?;
        Ok(self.begin(&state, load.position - relative))
    }

    /// The machine at rest, or in steady motion with its load, at an operating point of its actuator.
    ///
    /// The spool's position is kept; what the operating point leaves out (leakage across the piston, a pump that yields) moves the
    /// pressures to where all flows balance, and the force is what they hold.
    ///
    /// # Errors
    /// As [`Machine::start`]; no balance near the operating point, as at one that is not steady itself.
    pub fn rest(&self, point: &OperatingPoint) -> Result<Beginning, MachineError> {
        let start = Start {
            position: point.position,
            velocity: point.velocity,
            pressure_a: point.pressure_a,
            pressure_b: point.pressure_b,
            force: 0.0,
            spool: point.command + self.spool.null_bias,
        };
        check(&start, self.cylinder.stroke)?;
        let mut state = MachineState::zero();
        state.spool.spool = start.spool;
        state.velocity = start.velocity;
        state.bristle = self.settled_bristle(start.velocity);
        let pressures = [point.pressure_a, point.pressure_b, self.supply.pressure];
        [state.pressure_a, state.pressure_b, state.supply_pressure] = self.balance(&state, pressures);
        let forces = self.forces(&state, start.position);
        let force = forces.hydraulic + forces.end_stops - forces.friction.force;
        let [pressure_a, pressure_b] = [state.pressure_a, state.pressure_b];
        let beginning = self.start(&Start { pressure_a, pressure_b, force, ..start })?;
        let mut full = self.layout.read(&beginning.state);
        full.supply_pressure = state.supply_pressure;
        let [ground, _] = beginning.inputs;
        let beginning = self.begin(&full, ground);
        let residual = self.residual(&beginning);
        if residual <= REST_TOLERANCE { Ok(beginning) } else { Err(MachineError::NoRest { residual }) }
    }

    fn begin(&self, state: &MachineState, ground: f64) -> Beginning {
        let mut vector = vec![0.0; self.layout.count()];
        self.layout.write(state, &mut vector);
        Beginning { state: vector, command: state.spool.spool, inputs: [ground, state.velocity] }
    }

    /// Deflection of the bristles in steady motion: z = sign(v) g(v)/sigma_0.
    fn settled_bristle(&self, velocity: f64) -> f64 {
        match self.friction {
            MovingFriction::LuGre { lugre, .. } => {
                let curve = lugre.curve;
                (curve.steady_force(velocity) - curve.viscous * velocity) / lugre.bristle_stiffness
            }
            _ => 0.0,
        }
    }

    /// p_A, p_B and p_S at which nothing flows that the piston does not take, by damped Newton steps from these.
    fn balance(&self, state: &MachineState, pressures: [f64; 3]) -> [f64; 3] {
        let mut best = Vector3::from(pressures);
        let mut least = self.surplus(state, best);
        for _ in 0..REST_STEPS {
            let Some(step) = least.1.lu().solve(&least.0) else { break };
            let mut share = 1.0;
            let found = (0..REST_STEPS).find_map(|_| {
                let next = best - step * share;
                let surplus = self.surplus(state, next);
                share *= 0.5;
                (surplus.0.norm() < least.0.norm()).then_some((next, surplus))
            });
            match found {
                Some((next, surplus)) => (best, least) = (next, surplus),
                None => break,
            }
        }
        best.into()
    }

    /// Flows into both chambers and the supply that nothing takes, in m3/s, and their derivatives by the three pressures. A
    /// constant supply is its pressure's difference from what it states.
    fn surplus(&self, state: &MachineState, pressures: Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let variable = |index: usize| Dual::<3>::variable(pressures[index], index);
        let mut dual = MachineState::<Dual<3>>::zero();
        dual.spool.spool = Dual::constant(state.spool.spool);
        (dual.pressure_a, dual.pressure_b, dual.supply_pressure) = (variable(0), variable(1), variable(2));
        let flows = self.flows(&dual);
        let surplus_a = flows.into_a - Dual::constant(self.cylinder.area_a * state.velocity);
        let surplus_b = flows.into_b + Dual::constant(self.cylinder.area_b * state.velocity);
        let stated = Dual::constant(self.supply.pressure);
        let surplus_s = match &self.power_unit {
            PowerUnit::Constant => dual.supply_pressure - stated,
            PowerUnit::PumpLimited(_) => {
                let unit = self.power_unit.convert(&mut Dual::<3>::constant);
                let taken = self.supply_flow(&dual, &flows.edges);
                match unit {
                    PowerUnit::PumpLimited(unit) => {
                        unit.pump_flow - unit.relief_flow(dual.supply_pressure, stated) - taken
                    }
                    PowerUnit::Constant => dual.supply_pressure - stated,
                }
            }
        };
        let rows = [surplus_a, surplus_b, surplus_s];
        let values = Vector3::from(rows.map(|row| row.value()));
        (values, Matrix3::from_fn(|row, column| rows[row].gradient()[column]))
    }

    /// The greatest rate over the scale of its state, in 1/s, leaving aside those that a steady motion has.
    fn residual(&self, beginning: &Beginning) -> f64 {
        let mut rates = vec![0.0; self.layout.count()];
        self.rates(&beginning.state, beginning.command, &beginning.inputs, &mut rates);
        let mut rates = self.layout.read(&rates);
        let [_, velocity] = beginning.inputs;
        rates.load.position -= velocity;
        let mut values = vec![0.0; self.layout.count()];
        self.layout.write(&rates, &mut values);
        values.iter().zip(self.scales()).fold(0.0, |largest, (rate, scale)| {
            let relative = (rate / scale).abs();
            if relative.is_nan() { f64::INFINITY } else { relative.max(largest) }
        })
    }
}

impl LoadModel {
    /// x_L - x_0 in m at which the load is held with this force in N; `None` where none does.
    fn held_at(&self, force: f64) -> Option<f64> {
        match *self {
            LoadModel::Prescribed => Some(0.0),
            LoadModel::SpringMassDamper { stiffness, .. } if stiffness > 0.0 => Some(force / stiffness),
            LoadModel::SpringMassDamper { .. } => (force == 0.0).then_some(0.0),
            LoadModel::Wall { .. } if force == 0.0 => Some(0.0),
            LoadModel::Wall { gap, contact, .. } => (force > 0.0).then_some(gap + force / contact.stiffness),
        }
    }
}

fn check(start: &Start, stroke: f64) -> Result<(), MachineError> {
    let Start { position, velocity, pressure_a, pressure_b, force, spool } = *start;
    if !(0.0..=stroke).contains(&position) {
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
