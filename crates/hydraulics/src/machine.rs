//! Nonlinear model: the whole actuator in motion, as a [`Plant`] that a controller commands.
//!
//! ```text
//! spool          dU/dt, dr/dt, ...                              thesis (4.1) with saturation: SpoolImperfection
//! chambers       C_A(x, p_A) dp_A/dt = q_A - q_i - A_A v        thesis (4.25)
//!                C_B(x, p_B) dp_B/dt = q_B + q_i + A_B v        thesis (4.26), corrected
//!                C of the oil and its enclosure, and of the gas of an Accumulator at that chamber
//! leakage        q_i = G_i (p_A - p_B)                          laminar, across the piston
//!                q_e = G_e (p - p_T)                            laminar, from each chamber to the tank
//! heat           dtheta/dt = (gamma - 1) P q/(P_0 V_0) - (theta - 1)/tau         of the gas at a chamber: RelaxingGas
//! adjustment     C dp/dt = q - (dV_oil/du) du/dt,   q = (s + u) K root(p - p_g)          of the gas at a chamber: Adjustment
//! neck           I dq_n/dt = p - p_g - R q_n - Z q_n |q_n|,   C_g dp_g/dt = q_n     of the gas at a chamber: Neck
//! cross port     q_cp = restrictor(p_A - p_B - p_cp),   C_cp dp_cp/dt = q_cp      part of q_i: CrossPort
//! piston         M dv/dt = A_A p_A - A_B p_B + F_stops - F_fr - F_e      thesis (4.29)
//! sensor         d(x - x_L)/dt = v - v_L,   F_e = K_S (x - x_L)          thesis (4.45)
//! series         spring or oil between sensor and load, or absent         SeriesElement
//! bristles       dz/dt                                          thesis (4.30), corrected: LuGre
//! load           prescribed, or d(x_L - x_0)/dt, dv_L/dt         Load; behind a Linkage theta for x
//! supply         constant, or dp_S/dt                           PowerUnit
//! lines          lumped, or states and waves of their own       DynamicLine
//! ```
//!
//! q_A and q_B are the flows of the four edges into the chambers, through the lines if these have
//! dynamics of their own. Nothing is clamped: a chamber below vapour pressure, a piston beyond its
//! stroke or in its stop, and a load at its wall are indicators whose change of sign an integrator
//! reports.

mod adjusted;
mod balance;
mod chambers;
mod end;
mod equations;
mod gas;
mod kinks;
mod ledger;
mod load;
mod options;
mod scales;
mod series;
mod signals;
mod start;
mod state;

pub use crate::accumulator::Accumulator;
pub use crate::power_unit::{PowerUnit, PumpLimited};
pub use chambers::{AeratedChambers, Chambers};
pub use ledger::{Account, ENERGY_ACCOUNTS, Ledger, OIL_ACCOUNTS};
pub use load::Motion;
pub use options::{MachineError, MachineOptions};
pub use signals::{INDICATORS, MachineSignals};
pub use start::{InitialCondition, StartValues};
pub use state::MachineState;

use phea_dynamics::scalar::{Parameters, Scalar};
use phea_dynamics::simulation::{Lane, Plant, Sliding};

use crate::accumulator::ChamberGas;
use crate::actuator::Actuator;
use crate::cross_port::CrossPort;
use crate::cylinder::Cylinder;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::friction::MovingFriction;
use crate::line::{DynamicLine, Segments};
use crate::linkage::Linkage;
use crate::load::Load;
use crate::outward_flow::OutwardFlow;
use crate::series::MovingSeries;
use crate::servovalve::{Servovalve, Supply};
use equations::constant;
use signals::ground_of;
use state::Layout;

/// Actuator with its load and its power unit, in motion. Parameters are numbers, or lanes of them.
///
/// Its inputs are the position in m and the velocity in m/s of the load's ground ([`Load`]; in
/// rad and rad/s behind a linkage), the external force in N (N m) if there is one
/// ([`MachineOptions::external_force`]), the change of the setting of its accumulators and its rate
/// in 1/s if it moves ([`MachineOptions::moving_setting`]), and then the waves that arrive from
/// line A and line B; its states are named by [`MachineState`].
///
/// # Example
/// A machine at rest stays at rest.
/// ```
/// # use phea_hydraulics::reference_rig::{components, hose_line};
/// use phea_dynamics::simulation::Plant;
/// use phea_hydraulics::actuator::Actuator;
/// use phea_hydraulics::machine::{Machine, MachineOptions};
/// use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
/// use phea_hydraulics::stiffness::StiffnessModel;
/// let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume))?;
/// let machine = Machine::new(&actuator, &MachineOptions::default())?;
/// let point = operating_point(&actuator, 0.2, Condition::Load(SteadyLoad::Force(3e3)))?;
/// let rest = machine.rest(&point)?;
/// let mut rates = vec![f64::NAN; machine.states()];
/// machine.rates(&rest.state, rest.command, &rest.inputs, &mut rates);
/// let largest = rates.iter().zip(machine.scales()).map(|(rate, scale)| (rate / scale).abs()).fold(0.0, f64::max);
/// assert!(largest < 1e-6 && (machine.measurement(&rest.state, &rest.inputs) - 3e3_f64).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine<S = f64> {
    valve: Servovalve<S>,
    supply: Supply<S>,
    power_unit: PowerUnit<S>,
    cylinder: Cylinder<S>,
    chambers: Chambers<S>,
    /// Gas at chambers A and B, adjusted only by a valve or if its setting moves.
    gas: [Option<ChamberGas<S>>; 2],
    gas_pressure_limits: [Option<S>; 2],
    moving_setting: bool,
    cross_port: Option<CrossPort<S>>,
    outward: Option<OutwardFlow<S>>,
    lines: [DynamicLine<S>; 2],
    friction: MovingFriction<S>,
    sensor_stiffness: S,
    series: Option<MovingSeries<S>>,
    linkage: Option<Linkage<S>>,
    load: Load<S>,
    velocity_gain: S,
    /// Factor phi of the pressure signal p_A - phi p_B.
    pressure_ratio: S,
    external_force: bool,
    vapour_pressure: S,
    layout: Layout,
}

impl Machine {
    /// Machine of an actuator with these options.
    ///
    /// # Errors
    /// All impossible options; a load in front of a wall without a mass; a line that its
    /// model does not fit; a static friction curve
    /// without the velocity that smooths its jump;
    /// end stops so soft, or dead volumes so small, that the supply pressure would press the piston
    /// through the last fluid of a chamber; an external force on a load that does not yield.
    pub fn new(actuator: &Actuator, options: &MachineOptions) -> Result<Machine, MachineError> {
        let problems = options.problems();
        if !problems.is_empty() {
            return Err(MachineError::Impossible { problems });
        }
        let components = actuator.components();
        if matches!(components.load, Load::Wall { mass: None, .. }) {
            return Err(MachineError::LoadWithoutMass);
        }
        if options.external_force && !components.load.moves() {
            return Err(MachineError::UnyieldingLoad);
        }
        let lines = components.lines_in_motion(options.member)?;
        let friction = MovingFriction::new(&components.friction).ok_or(MachineError::StaticFriction)?;
        let none = DynamicLine::Segments(Segments::lumped(0.0));
        let mut machine = Machine {
            valve: components.valve,
            supply: components.supply,
            power_unit: components.power_unit,
            cylinder: components.cylinder,
            chambers: match lines {
                None => Chambers::new(actuator, options.member),
                Some(lines) => {
                    let added = lines.map(|line| line.chamber_compliance());
                    Chambers::with_line_compliance(actuator, options.member, added)
                }
            },
            gas: components.gas.map(|gas| Some(gas?.of_machine(options.moving_setting))),
            gas_pressure_limits: components.gas.map(|gas| gas?.pressure_limit()),
            moving_setting: options.moving_setting,
            cross_port: components.cross_port,
            outward: components.outward.if_present(),
            lines: lines.unwrap_or([none; 2]),
            friction,
            sensor_stiffness: components.force_sensor.stiffness,
            series: components.series.map(|series| series.in_motion(&components.fluid, options.member)),
            linkage: components.linkage,
            load: components.load,
            velocity_gain: components.velocity_gain.unwrap_or(1.0),
            pressure_ratio: options.pressure_ratio,
            external_force: options.external_force,
            vapour_pressure: components.fluid.vapour_pressure_absolute - ATMOSPHERIC_PRESSURE_ABSOLUTE,
            layout: Layout::default(),
        };
        machine.layout = Layout::of(&machine);
        machine.check_ends()?;
        Ok(machine)
    }

    /// True if its inputs include an external force.
    pub fn has_external_force(&self) -> bool {
        self.external_force
    }

    /// True if accumulators at its chambers are adjusted in operation: by a valve, or by gas that
    /// is added and removed.
    pub fn has_adjustment(&self) -> bool {
        self.layout.is_adjusted()
    }

    /// Indices of the pressures of gas behind shut valves, after their setting has moved by
    /// `change`: they are constant at any value.
    pub fn shut_gas(&self, change: f64) -> Vec<usize> {
        let settings: [f64; 2] = self.settings([change, 0.0]);
        let has_valve = self.gas.map(|gas| gas.is_some_and(|gas| gas.valve().is_some()));
        let shut = [0, 1].map(|side| has_valve[side] && settings[side] == 0.0);
        self.layout.gas_places(shut)
    }

    /// Lines to chambers A and B.
    pub fn lines(&self) -> &[DynamicLine; 2] {
        &self.lines
    }

    /// True if its inputs include the setting of its accumulators.
    pub fn has_moving_setting(&self) -> bool {
        self.moving_setting
    }

    /// True if a spring or a transmission connects force sensor and load.
    pub fn has_series_element(&self) -> bool {
        self.series.is_some()
    }

    /// True if a transmission connects force sensor and load.
    pub fn has_transmission(&self) -> bool {
        matches!(self.series, Some(MovingSeries::Oil(_)))
    }

    /// True if the load turns behind a linkage.
    pub fn has_linkage(&self) -> bool {
        self.linkage.is_some()
    }

    /// True if the gas at chambers A and B has a pressure of its own, behind a neck or a valve.
    pub fn has_gas_pressure(&self) -> [bool; 2] {
        self.layout.behind()
    }

    /// True if the gas at chambers A and B exchanges heat.
    pub fn has_heated_gas(&self) -> [bool; 2] {
        self.layout.heated()
    }

    /// True if end stops hold the piston at the ends of its stroke.
    pub fn has_end_stops(&self) -> bool {
        self.cylinder.end_stops.is_some()
    }

    /// Rejects end stops into which the supply pressure presses the piston further than its
    /// chambers allow.
    fn check_ends(&self) -> Result<(), MachineError> {
        let Some(contact) = self.cylinder.end_stops else {
            return Ok(());
        };
        let pressure = self.supply.pressure.max(0.0);
        let Some(stroke) = self.cylinder.stroke.length() else { return Ok(()) };
        let ([_, area_b], [area_a, _]) = (self.cylinder.areas_at(0.0), self.cylinder.areas_at(stroke));
        let state = MachineState { pressure_a: pressure, pressure_b: pressure, ..MachineState::zero() };
        // at the A end chamber B presses, and vice versa
        for (end, away, pressing) in [(0.0, -1.0, area_b), (stroke, 1.0, area_a)] {
            let penetration = pressure * pressing / contact.stiffness;
            let [compliance_a, compliance_b] = self.oil_compliance(&state, end + away * penetration);
            let compliance = compliance_a.min(compliance_b);
            if compliance <= 0.0 {
                return Err(MachineError::ChamberVanishes { penetration, compliance });
            }
        }
        Ok(())
    }
}

phea_dynamics::parameters! {
    Machine {
        valve, supply, power_unit, cylinder, chambers, gas, gas_pressure_limits, moving_setting: kept,
        cross_port, outward, lines, friction, sensor_stiffness, series, linkage, load, velocity_gain,
        pressure_ratio, external_force: kept, vapour_pressure, layout: kept,
    }
}

impl<S: Lane> Machine<S> {
    /// Inserts another machine into one lane.
    ///
    /// # Errors
    /// Machine with other components than these; nothing is changed in this case.
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::{actuator::Actuator, stiffness::StiffnessModel};
    /// # use phea_hydraulics::reference_rig::{components, hose_line, leaking, pipe_line};
    /// # use phea_hydraulics::machine::{Machine, MachineError, MachineOptions};
    /// use phea_dynamics::scalar::{Lanes, Parameters};
    /// let of = |line| Actuator::new(components(line, StiffnessModel::ByVolume));
    /// let [hose, pipe] = [of(hose_line())?, of(pipe_line())?].map(|a| Machine::new(&a, &MachineOptions::default()));
    /// let (hose, pipe) = (hose?, pipe?);
    /// let hoses: Machine<Lanes> = hose.convert(&mut |value: f64| Lanes::from(value));
    /// let mut lanes = hoses;
    /// lanes.put(1, &pipe)?;
    /// assert_ne!(lanes, hoses);
    /// lanes.put(1, &hose)?;
    /// assert_eq!(lanes, hoses);
    /// let leaking = leaking(components(hose_line(), StiffnessModel::ByVolume), 1e-13);
    /// let other = Machine::new(&Actuator::new(leaking)?, &MachineOptions::default())?;
    /// assert_eq!(lanes.put(0, &other), Err(MachineError::DifferentStructure { index: 0 }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn put(&mut self, lane: usize, machine: &Machine) -> Result<(), MachineError> {
        let mut values = Vec::new();
        let structure = machine.replaced(&mut |value| {
            values.push(value);
            0.0
        });
        if structure != self.replaced(&mut |_| 0.0) {
            return Err(MachineError::DifferentStructure { index: lane });
        }
        let mut values = values.into_iter();
        *self = self.replaced(&mut |mut kept| {
            kept.set_lane(lane, values.next().unwrap_or(f64::NAN));
            kept
        });
        Ok(())
    }

    /// Conversion as in [`Parameters::convert`], compiled once for all functions.
    fn replaced<T: Copy>(&self, of: &mut dyn FnMut(S) -> T) -> Machine<T> {
        self.convert(&mut |value| of(value))
    }
}

impl<S: Scalar> Plant<S> for Machine<S> {
    #[inline(always)]
    fn states(&self) -> usize {
        self.layout.count()
    }

    #[inline(always)]
    fn inputs(&self) -> usize {
        self.layout.inputs()
    }

    fn scales(&self) -> Vec<S> {
        self.typical_vector()
    }

    fn command_scale(&self) -> S {
        self.typical_command()
    }

    fn measurement_scale(&self) -> S {
        self.typical_force()
    }

    #[inline(always)]
    fn rates<T: Scalar + From<S>>(&self, state: &[T], command: T, inputs: &[T], rates: &mut [T]) {
        self.write_rates(state, command, inputs, rates);
    }

    #[inline(always)]
    fn measurement<T: Scalar + From<S>>(&self, state: &[T], _inputs: &[T]) -> T {
        self.measured_force(&self.layout.read(state))
    }

    fn disturbance<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T {
        let velocity =
            self.end_of(&self.load_of(&self.layout.read(state), &ground_of(inputs))).motion.velocity;
        constant::<S, T>(self.velocity_gain) * velocity
    }

    fn disturbance_scale(&self) -> S {
        self.typical_state().velocity
    }

    #[inline(always)]
    fn inner_measurement<T: Scalar + From<S>>(&self, state: &[T], _inputs: &[T]) -> T {
        let state = self.layout.read(state);
        state.pressure_a - constant::<S, T>(self.pressure_ratio) * state.pressure_b
    }

    fn inner_measurement_scale(&self) -> S {
        self.typical_state().pressure_a
    }

    #[inline(always)]
    fn position<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T {
        self.end_of(&self.load_of(&self.layout.read(state), &ground_of(inputs))).motion.position
    }

    fn position_scale(&self) -> S {
        let own = self.typical_state().load.position;
        self.linkage.map_or(own, |linkage| own * linkage.typical_arm())
    }

    fn delays(&self) -> Vec<S> {
        self.lines.iter().flat_map(|line| line.delays()).collect()
    }

    fn outgoing<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        self.write_outgoing(state, inputs, waves);
    }

    fn sliding(&self) -> Option<Sliding> {
        Some(self.layout.sliding())
    }

    fn indicators(&self) -> usize {
        INDICATORS.len()
    }

    fn indicate<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], indicators: &mut [T]) {
        for (slot, value) in indicators.iter_mut().zip(self.indicated(state, inputs)) {
            *slot = value;
        }
    }

    fn kinks(&self) -> usize {
        self.kink_count()
    }

    fn mark<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], marks: &mut [T]) {
        let mut places = marks.iter_mut();
        self.write_kinks(state, inputs, &mut |value| {
            if let Some(place) = places.next() {
                *place = value;
            }
        });
    }
}
