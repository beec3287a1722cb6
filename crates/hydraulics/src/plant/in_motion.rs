mod responding;

use num_complex::Complex64;
use phea_dynamics::analytic::Analytic;
use phea_dynamics::controller::{RateFilter, VirtualImpedance};

use super::chambers::{Chamber, ChamberPair, ChamberPolynomials, Reading};
use super::supply::{Coupled, Over};
use super::{
    LinearLoad, LinearPlant, LinearSeries, Paths, PressureFeedback, SeriesOutput, VelocitySensor,
    YieldingSupply,
};
use crate::accumulator::GasBranch;
use crate::cross_port::DynamicFeedback;
use crate::line::{DynamicLine, Segments, TransferMatrix};

/// Plant with lines that have dynamics of their own: not a quotient of polynomials, but with a
/// response at every frequency.
///
/// ```text
/// q_valve = K_q U_sp - K_c p_port                                              valve
/// p_port = a p + b q,   q_valve = c p + d q                                    line: TransferMatrix
/// q = C s p + A s X + G (p - p_other) + G_e p                                  chamber behind the line, with leakage to the tank
/// so each chamber of LinearPlant has   K_q/(d + K_c b)   for K_q   and   C s + G_e + (c + K_c a)/(d + K_c b)   for C s + K_c + G_e
/// ```
///
/// At every frequency the response is that of the machine with these lines, for small motions. If a
/// stated number makes a chamber of the plant stiffer than its parts, chamber and line are
/// stiffened by one factor.
///
/// # Example
/// Slow motion is not affected by waves:
/// ```
/// # use phea_hydraulics::reference_rig::{components, hose_line, nominal_plant};
/// # use phea_hydraulics::stiffness::StiffnessModel;
/// use num_complex::Complex64;
/// use phea_hydraulics::line::{DynamicLine, END_SHARE, LineModel, StiffeningMember};
/// use phea_hydraulics::plant::{LineChambers, LinearLoad, LinearPlant, PlantInMotion};
/// let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
/// let model = LineModel::TransmissionLine { end_share: END_SHARE };
/// let line = DynamicLine::new(&hose_line(), &fluid, 35e5, StiffeningMember::Nominal, &model)?;
/// let plant = LinearPlant::of_load_pressure(&nominal_plant(), 0.0, LinearLoad::Prescribed);
/// let chamber = 0.25 * 1.58e-3 / 1.45e9; // what the oil of half a stroke yields, in m3/Pa
/// let lumped = [chamber + line.elastic_compliance(); 2];
/// let behind = LineChambers { lines: [line; 2], chambers: [chamber; 2], lumped, leaking: [0.0; 2] };
/// let moving = PlantInMotion::new(&plant, &behind);
/// let lumped = plant.coefficients().command;
/// let ratio = |frequency| {
///     let [command, _] = moving.response(Complex64::new(0.0, frequency));
///     (command / lumped.at_frequency(frequency)).norm_sqr().sqrt()
/// };
/// assert!((ratio(10.0) - 1.0).abs() < 1e-3 && (ratio(1000.0) - 1.0).abs() > 0.5);
/// # Ok::<(), phea_hydraulics::line::LineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantInMotion {
    plant: LinearPlant,
    sides: [ChamberSide; 2],
    /// True if both lines are equal.
    alike: bool,
    /// Delay of the load's velocity that is fed forward, from its sensor and the loop, s.
    lateness: f64,
    /// Delay of the pressures that are fed back, from the loop, s.
    feedback_delay_s: f64,
}

/// Chambers of a plant, behind its lines. Units: m3/Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineChambers {
    /// The lines.
    pub lines: [DynamicLine; 2],
    /// Compliance of each chamber without its line.
    pub chambers: [f64; 2],
    /// Compliance of each chamber with its line if the line is lumped, from the components.
    pub lumped: [f64; 2],
    /// Fraction of each flow-pressure coefficient of the plant that is leakage from the chamber to
    /// the tank, from 0 to 1: the leakage is behind the line, the valve before it.
    pub leaking: [f64; 2],
}

/// Chamber with its line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ChamberSide {
    area: f64,
    /// Compliance of the chamber with the end of the line there.
    compliance: f64,
    flow_gain: f64,
    /// Flow-pressure coefficient K_c of the valve.
    flow_pressure: f64,
    /// Leakage conductance G_e to the tank, behind the line.
    leakage: f64,
    line: DynamicLine,
    /// Gas behind a neck, or with heat.
    gas: Option<GasBranch>,
}

/// Chamber with its line at s, with all terms multiplied by the transmission of the line: `passed`
/// is d + K_c b, the factor by which the valve's flow is smaller at the chamber than at a port of
/// constant pressure.
struct AtChamber<A> {
    /// Flow per pascal at the chamber, times `passed`.
    admittance: A,
    passed: A,
    /// Entry b.
    impedance: A,
}

impl PlantInMotion {
    /// Plant with the velocity of the load fed forward, K_x in V s/m.
    #[must_use]
    pub fn fed_forward(self, load_velocity_feed_forward: Option<f64>) -> PlantInMotion {
        PlantInMotion { plant: LinearPlant { load_velocity_feed_forward, ..self.plant }, ..self }
    }

    /// Plant with the velocity that is fed forward behind this filter.
    #[must_use]
    pub fn filtered(self, filter: RateFilter) -> PlantInMotion {
        let velocity_sensor = VelocitySensor { filter, ..self.plant.velocity_sensor };
        PlantInMotion { plant: LinearPlant { velocity_sensor, ..self.plant }, ..self }
    }

    /// Plant with another load.
    #[must_use]
    pub fn of_load(self, load: LinearLoad) -> PlantInMotion {
        PlantInMotion { plant: LinearPlant { load, ..self.plant }, ..self }
    }

    /// Plant with a virtual impedance added to its force.
    #[must_use]
    pub fn with_virtual_impedance(self, virtual_impedance: Option<VirtualImpedance>) -> PlantInMotion {
        PlantInMotion { plant: LinearPlant { virtual_impedance, ..self.plant }, ..self }
    }

    /// Plant with the feed-forward delayed by a time in s: K_x e^(-s tau) for K_x.
    #[must_use]
    pub fn late(self, lateness: f64) -> PlantInMotion {
        PlantInMotion { lateness, ..self }
    }

    /// Plant with the chambers' pressures fed back, delayed by a time in s: H e^(-s tau) for H.
    #[must_use]
    pub fn fed_back(
        self,
        pressure_feedback: Option<PressureFeedback>,
        feedback_delay_s: f64,
    ) -> PlantInMotion {
        let plant = LinearPlant { pressure_feedback, ..self.plant };
        PlantInMotion { plant, feedback_delay_s, ..self }
    }

    /// Plant with the paths to a pressure signal p_A - phi p_B that a loop around it samples.
    #[must_use]
    pub fn showing(self, pressure_signal: Option<f64>) -> PlantInMotion {
        PlantInMotion { plant: LinearPlant { pressure_signal, ..self.plant }, ..self }
    }

    /// Plant with its lumped lines unchanged: for a load velocity that is fed forward late, or
    /// pressures that are fed back late, for which there is no quotient of polynomials.
    pub fn lumped(plant: &LinearPlant) -> PlantInMotion {
        let compliances = [0, 1].map(|side| plant.chambers.side(side).compliance);
        let none = DynamicLine::Segments(Segments::lumped(0.0));
        PlantInMotion::new(
            plant,
            &LineChambers { lines: [none; 2], chambers: compliances, lumped: compliances, leaking: [0.0; 2] },
        )
    }

    /// Plant with these chambers and lines in place of its lumped ones.
    pub fn new(plant: &LinearPlant, behind: &LineChambers) -> PlantInMotion {
        let side = |side: usize| {
            let Chamber { area, compliance, flow_gain, flow_pressure } = plant.chambers.side(side);
            let stiffer = behind.lumped[side] / compliance;
            let line = behind.lines[side].stiffened(stiffer);
            let compliance = behind.chambers[side] / stiffer + line.chamber_compliance();
            let gas = plant.gas[side];
            let leakage = behind.leaking[side] * flow_pressure;
            let flow_pressure = flow_pressure - leakage;
            ChamberSide { area, compliance, flow_gain, flow_pressure, leakage, line, gas }
        };
        let sides = [side(0), side(1)];
        let alike = sides[0].line == sides[1].line;
        PlantInMotion { plant: *plant, sides, alike, lateness: 0.0, feedback_delay_s: 0.0 }
    }

    /// Paths F_e/U_C in N/V and F_e/X_0 in N/m at s in rad/s, or over a set of values of s, by the
    /// equations of [`LinearPlant::coefficients`].
    pub fn response<A: Analytic>(&self, s: A) -> [A; 2] {
        let Paths { command, ground, sensed, fed, .. } = self.paths(s);
        let divisor = fed.map_or(sensed, |fed| sensed - fed);
        [command / divisor, ground / divisor]
    }

    /// Paths v_L/U_C in m/(s V) and v_L/X_0 in 1/s to the velocity of the load, at s in rad/s.
    pub fn load_velocity(&self, s: Complex64) -> [Complex64; 2] {
        let Some(load) = self.plant.load.terms() else { return [Complex64::ZERO, s] };
        let [_, tied] = load.at(s);
        let Paths { driven, held, sensed, fed, .. } = self.paths(s);
        let divisor = fed.map_or(sensed, |fed| sensed - fed);
        [driven, tied * held].map(|path| s * path / divisor)
    }

    /// Ratio of measured to true velocity of the load.
    fn velocity_gain(&self) -> f64 {
        self.plant.velocity_sensor.gain.unwrap_or(1.0)
    }

    /// Gain from the true velocity of the load to the command, V s/m.
    fn fed_gain(&self) -> Option<f64> {
        self.plant.load_velocity_feed_forward.map(|gain| gain * self.velocity_gain())
    }

    fn paths<A: Analytic>(&self, s: A) -> Paths<A> {
        let tied = self.plant.load.terms().map(|load| {
            let [_, tied] = load.at(s);
            tied
        });
        self.paths_of_force(s).beside(self.plant.virtual_impedance.as_ref(), s, tied)
    }

    fn paths_of_force<A: Analytic>(&self, s: A) -> Paths<A> {
        let spool = self.spool(s);
        let chambers = self.with_feedback(s, spool);
        let moved = self.resisted(s, &chambers);
        self.against_load(s, spool, chambers, moved)
    }

    /// Paths p/U_C in Pa/V and p/X_0 in Pa/m of the signal p_A - phi p_B, like the polynomials of
    /// [`LinearPlant::coefficients`]. Nothing is fed forward or back in the plant.
    fn signal(&self, s: Complex64, ratio: f64) -> [Complex64; 2] {
        let spool = self.spool(s);
        let areas = self.sides.map(|side| side.area);
        let (across, at) = (self.across(s), self.at_chambers(s));
        let force = || self.read(s, &at, across, &Reading::of_force(areas));
        let read = self.read(s, &at, across, &Reading::of_signal(ratio, areas));
        let series = self.plant.series.map(|series| LinearSeries { output: SeriesOutput::Sensor, ..series });
        let own = PlantInMotion { plant: LinearPlant { series, ..self.plant }, ..*self };
        let displaced = self.turned(s, &at).scaled(areas[1] - ratio * areas[0]);
        let within = ChamberPolynomials { own: read.driven, driven: Complex64::ZERO, displaced };
        let moved = self.resisted(s, &within);
        let by_command = own.against_load(s, spool, within, moved).sensed;
        let Paths { ground, .. } = own.against_load(s, spool, force(), s * read.displaced);
        let whole = own.against_load(s, spool, force(), self.resisted(s, &force())).sensed;
        [spool * by_command / whole, ground / whole]
    }

    fn spool<A: Analytic>(&self, s: A) -> A {
        let frequency = self.plant.valve_natural_frequency;
        let square = frequency * frequency;
        let turned = s.scaled(2.0 * self.plant.valve_damping_ratio * frequency);
        A::from(square) / (s * s + turned + A::from(square))
    }

    /// Denominator Q for these chambers.
    fn resisted<A: Analytic>(&self, s: A, chambers: &ChamberPolynomials<A>) -> A {
        let rubbed = s.scaled(self.plant.moving_mass) + A::from(self.plant.viscous_friction);
        let moved = s * (rubbed * chambers.own + chambers.displaced);
        let stiffness = self.plant.area_stiffness;
        stiffness.map_or(moved, |stiffness| moved + chambers.own.scaled(stiffness))
    }

    /// Valve and chambers with this Q, connected to the load.
    fn against_load<A: Analytic>(
        &self,
        s: A,
        spool: A,
        chambers: ChamberPolynomials<A>,
        moved: A,
    ) -> Paths<A> {
        let ChamberPolynomials { own, driven, .. } = chambers;
        let sensor = self.plant.sensor_stiffness;
        let driven = (spool * driven).scaled(sensor);
        let fed = match self.fed_gain() {
            Some(gain) => {
                let late = match self.lateness > 0.0 {
                    true => s.scaled(-self.lateness).exponential() * s.scaled(gain),
                    false => s.scaled(gain),
                };
                match self.plant.velocity_sensor.filter {
                    RateFilter::None => late * driven,
                    filter => filter.response(s) * late * driven,
                }
            }
            None => A::from(0.0),
        };
        if let Some(series) = &self.plant.series {
            return series.responding(&self.plant, s, chambers, [moved, driven, fed]);
        }
        let held = moved + own.scaled(sensor);
        match self.plant.load.terms() {
            None => {
                let (ground, fed) = (fed - moved.scaled(sensor), Some(A::from(0.0)));
                Paths { command: driven, ground, sensed: held, fed, driven, held }
            }
            Some(terms) => {
                let [load, tied] = terms.at(s);
                let sensed = moved * (load + A::from(terms.moved_by(sensor))) + (load * own).scaled(sensor);
                let ground = tied * (fed - moved.scaled(sensor));
                let command = load * driven;
                let [fed, driven] = [fed, driven].map(|path| terms.moved_at(path));
                Paths { command, ground, sensed, fed: Some(fed), driven, held }
            }
        }
    }

    /// Polynomials D, N_u and N_v at s with the pressures fed back behind a spool S, see
    /// [`PressureFeedback`]: D + S H N_p, N_u and N_v + S H m.
    fn with_feedback<A: Analytic>(&self, s: A, spool: A) -> ChamberPolynomials<A> {
        let (across, at) = (self.across(s), self.at_chambers(s));
        let areas = self.sides.map(|side| side.area);
        let chambers = self.read(s, &at, across, &Reading::of_force(areas));
        let Some(feedback) = &self.plant.pressure_feedback else { return chambers };
        let turned = self.turned(s, &at).scaled(areas[1] - feedback.ratio * areas[0]);
        let signal = self.read(s, &at, across, &Reading::of_signal(feedback.ratio, areas)).driven;
        let back = spool * feedback.filter.response(s);
        let back = match self.feedback_delay_s > 0.0 {
            true => back * s.scaled(-self.feedback_delay_s).exponential(),
            false => back,
        };
        ChamberPolynomials {
            own: chambers.own + back * signal,
            driven: chambers.driven,
            displaced: chambers.displaced + back * turned,
        }
    }

    /// Polynomials D, N_u and N_v of a reading with the flow from chamber to chamber.
    fn read<A: Analytic>(
        &self,
        s: A,
        at: &[AtChamber<A>; 2],
        across: A,
        reading: &Reading<f64>,
    ) -> ChamberPolynomials<A> {
        let combined = |apart: &A, joined: &A| *apart + across * *joined;
        match &self.plant.supply {
            None => self.chambers(at, reading).combined(combined),
            Some(supply) => self
                .behind(supply, at, s)
                .chambers(self.sides.map(|side| side.area), reading)
                .combined(|apart, joined| Over(combined(&apart.0, &joined.0)))
                .unwrapped(),
        }
    }

    /// Determinant m over A_B - phi A_A, see [`PressureFeedback`].
    fn turned<A: Analytic>(&self, s: A, at: &[AtChamber<A>; 2]) -> A {
        let areas = self.sides.map(|side| side.area);
        match &self.plant.supply {
            None => {
                let [gain_a, gain_b] = self.sides.map(|side| side.flow_gain);
                at[1].passed.scaled(areas[1] * gain_a) - at[0].passed.scaled(areas[0] * gain_b)
            }
            Some(supply) => self.behind(supply, at, s).turned(areas).0,
        }
    }

    fn at_chambers<A: Analytic>(&self, s: A) -> [AtChamber<A>; 2] {
        let [one, other] = &self.sides;
        let line = one.line.transfer_matrix(s);
        let across = if self.alike { line } else { other.line.transfer_matrix(s) };
        [one.at_chamber(line, s), other.at_chamber(across, s)]
    }

    /// Polynomials D, N_u and N_v of a reading at s on a constant supply, multiplied by the
    /// transmission of both lines, so that no divisor vanishes at a resonance.
    fn chambers<A: Analytic>(&self, at: &[AtChamber<A>; 2], reading: &Reading<f64>) -> ChamberPair<A> {
        let [one, other] = at;
        let [gain_a, gain_b] = self.sides.map(|side| side.flow_gain);
        let Reading { weights: [read_a, read_b], displaced: [displaced_a, displaced_b], .. } = *reading;
        let (a, b) = (one.admittance, other.admittance);
        let crossed = other.passed.scaled(gain_a) - one.passed.scaled(gain_b);
        ChamberPair {
            apart: ChamberPolynomials {
                own: a * b,
                driven: b.scaled(read_a * gain_a) + a.scaled(read_b * gain_b),
                displaced: (b * one.passed).scaled(displaced_a) + (a * other.passed).scaled(displaced_b),
            },
            joined: ChamberPolynomials {
                own: a * other.passed + b * one.passed,
                driven: crossed.scaled(reading.difference),
                displaced: (one.passed * other.passed).scaled(reading.displaced_difference),
            },
        }
    }

    /// Admittance from chamber to chamber.
    fn across<A: Analytic>(&self, s: A) -> A {
        let leakage = A::from(self.plant.internal_leakage);
        match self.plant.dynamic_feedback {
            None => leakage,
            Some(DynamicFeedback { conductance, capacity }) => {
                let taken = s.scaled(capacity);
                leakage + taken.scaled(conductance) / (taken + A::from(conductance))
            }
        }
    }

    /// Chambers with a supply that yields. Its edges end at the valve's ports, whose pressures are,
    /// with a d
    /// - b c = 1,
    ///
    /// ```text
    /// p_port = (p + b K_q U + b s_i p_S)/(d + K_c b)
    /// ```
    fn behind<A: Analytic>(&self, supply: &YieldingSupply, at: &[AtChamber<A>; 2], s: A) -> Coupled<Over<A>> {
        let [of_a, of_b] = supply.edges;
        let [gain_a, gain_b] = self.sides.map(|side| side.flow_gain);
        let [one, other] = at;
        let returned = |edge: f64, at: &AtChamber<A>| at.impedance.scaled(edge) / at.passed;
        let tied = s.scaled(supply.compliance) + A::from(supply.conductance + of_a + of_b);
        let own = tied - returned(of_a, one).scaled(of_a) - returned(of_b, other).scaled(of_b);
        let taken = A::from(supply.flow_gain) - returned(of_a, one).scaled(gain_a)
            + returned(of_b, other).scaled(gain_b);
        let admittance = |at: &AtChamber<A>| Over(at.admittance / at.passed);
        let passing = |value: f64, at: &AtChamber<A>| Over(A::from(value) / at.passed);
        Coupled {
            own: [admittance(one), admittance(other), Over(own)],
            passed: None,
            edges: [passing(of_a, one), passing(of_b, other)],
            gains: [passing(gain_a, one), passing(gain_b, other), Over(taken)],
        }
    }

    /// True if only its feed-forward and feedback can supply energy, so that without these none of
    /// its poles is in the right half plane: its lines are passive, and so are valve, leakage,
    /// friction and load if none of their coefficients is negative.
    pub fn is_passive(&self) -> bool {
        let load = self.plant.load.terms().map_or([0.0; 3], |load| load.own());
        let series = self.plant.series.iter().flat_map(LinearSeries::numbers);
        let own = [
            self.plant.moving_mass,
            self.plant.viscous_friction,
            self.plant.internal_leakage,
            self.plant.valve_damping_ratio,
        ];
        let of_sides = self.sides.iter().flat_map(|side| [side.compliance, side.flow_pressure, side.leakage]);
        let of_supply = self.plant.supply.iter().flat_map(|supply| {
            let to_tank = [0, 1].map(|side| self.sides[side].flow_pressure - supply.edges[side]);
            [supply.edges, to_tank, [supply.compliance, supply.conductance]].concat()
        });
        let feedback = self.plant.dynamic_feedback.iter().flat_map(|one| [one.conductance, one.capacity]);
        let of_gas = self.sides.iter().filter_map(|side| side.gas).flat_map(|gas| gas.numbers());
        let own = own.into_iter().chain(self.plant.area_stiffness);
        let beyond = own.chain(load).chain(series).chain(of_gas);
        beyond.chain(of_sides).chain(of_supply).chain(feedback).all(|value| value >= 0.0)
    }

    /// Quarter-wave frequency pi/(2 T) of the slower line, rad/s; `None` without waves.
    pub fn quarter_wave_rad_per_s(&self) -> Option<f64> {
        let delays = self.sides.iter().flat_map(|side| side.line.delays());
        let longest = delays.fold(0.0, f64::max);
        (longest > 0.0).then(|| std::f64::consts::FRAC_PI_2 / longest)
    }
}

impl<A> ChamberPolynomials<Over<A>> {
    fn unwrapped(self) -> ChamberPolynomials<A> {
        ChamberPolynomials { own: self.own.0, driven: self.driven.0, displaced: self.displaced.0 }
    }
}

impl ChamberSide {
    fn at_chamber<A: Analytic>(&self, line: TransferMatrix<A>, s: A) -> AtChamber<A> {
        let passed = line.flow + line.impedance.scaled(self.flow_pressure);
        let taken = line.admittance + line.pressure.scaled(self.flow_pressure);
        let own = s.scaled(self.compliance);
        let own = if self.leakage == 0.0 { own } else { own + A::from(self.leakage) };
        let own = self.gas.map_or(own, |gas| own + gas.admittance_at(s));
        let admittance = own * passed + taken;
        AtChamber { admittance, passed, impedance: line.impedance }
    }
}
