use std::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex64;
use phea_dynamics::portable;

use super::supply::Coupled;
use super::{Chamber, Chambers, LinearLoad, Plant, YieldingSupply};
use crate::line::DynamicLine;

/// The plant with lines that have dynamics of their own: what no quotient of polynomials is, but a response at every frequency.
///
/// ```text
/// q_valve = K_q U_sp - K_c p_port                                              valve
/// p_port = a p + b q,   q_valve = c p + d q                                    line: TransferMatrix
/// q = C s p + A s X + G (p - p_other)                                          chamber behind it
/// so each chamber of Plant has   K_q/(d + K_c b)   for K_q   and   C s + (c + K_c a)/(d + K_c b)   for C s + K_c
/// ```
///
/// At every frequency it is the machine with these lines, for small motions. Where a stated number makes a chamber of the plant
/// stiffer than its parts are, chamber and line are stiffened alike.
///
/// # Example
/// Slow motion sees no waves.
/// ```
/// # use phea_hydraulics::reference_rig::{components, hose_line, nominal_plant};
/// # use phea_hydraulics::stiffness::StiffnessModel;
/// use num_complex::Complex64;
/// use phea_hydraulics::line::{DynamicLine, END_SHARE, LineModel, Member};
/// use phea_hydraulics::plant::{BehindLines, LinearLoad, Plant, PlantInMotion};
/// let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
/// let model = LineModel::TransmissionLine { end_share: END_SHARE };
/// let line = DynamicLine::new(&hose_line(), &fluid, 35e5, Member::Nominal, &model)?;
/// let plant = Plant::of_load_pressure(&nominal_plant(), 0.0, LinearLoad::Prescribed);
/// let chamber = 0.25 * 1.58e-3 / 1.45e9; // what the oil of half a stroke yields, in m3/Pa
/// let behind = BehindLines { lines: [line; 2], chambers: [chamber; 2], lumped: [chamber + line.elastic_compliance(); 2] };
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
    plant: Plant,
    sides: [Side; 2],
}

/// What the chambers of a plant consist of. Units: m3/Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BehindLines {
    /// The lines.
    pub lines: [DynamicLine; 2],
    /// Compliance of each chamber without its line.
    pub chambers: [f64; 2],
    /// Compliance of both together where the line is lumped, as it follows from the parts.
    pub lumped: [f64; 2],
}

/// A chamber behind its line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    area: f64,
    /// Of the chamber with the end of the line there.
    compliance: f64,
    flow_gain: f64,
    flow_pressure: f64,
    line: DynamicLine,
}

/// A chamber with its line at one frequency.
struct AtChamber {
    /// Flow from the valve per volt, and flow per pascal, both at the chamber.
    flow_gain: Complex64,
    admittance: Complex64,
    /// d + K_c b, by which the valve's flow is less at the chamber than at a port held still, and b.
    passed: Complex64,
    impedance: Complex64,
}

/// F_e (sensed - fed) = command U_C + ground X_0, `fed` being what the velocity of a load that yields feeds back.
struct Paths {
    command: Complex64,
    ground: Complex64,
    sensed: Complex64,
    fed: Complex64,
}

impl PlantInMotion {
    /// The same with the velocity of the load fed forward, K_x in V s/m.
    #[must_use]
    pub fn fed_forward(self, load_velocity_feed_forward: Option<f64>) -> PlantInMotion {
        PlantInMotion { plant: Plant { load_velocity_feed_forward, ..self.plant }, ..self }
    }

    /// The plant with these chambers and lines in place of its lumped ones.
    pub fn new(plant: &Plant, behind: &BehindLines) -> PlantInMotion {
        let side = |side: usize| {
            let Chamber { area, compliance, flow_gain, flow_pressure } = plant.chambers.side(side);
            let stiffer = behind.lumped[side] / compliance;
            let line = behind.lines[side].stiffened(stiffer);
            let compliance = behind.chambers[side] / stiffer + line.chamber_compliance();
            Side { area, compliance, flow_gain, flow_pressure, line }
        };
        PlantInMotion { plant: *plant, sides: [side(0), side(1)] }
    }

    /// F_e/U_C in N/V and F_e/X_0 in N/m at s in rad/s, by the equations of [`Plant::coefficients`].
    pub fn response(&self, s: Complex64) -> [Complex64; 2] {
        let Paths { command, ground, sensed, fed } = self.paths(s);
        [command, ground].map(|path| path / (sensed - fed))
    }

    fn paths(&self, s: Complex64) -> Paths {
        let zero = Complex64::ZERO;
        let Chambers { own, driven, displaced } = self.chambers(s);
        let sensor = self.plant.sensor_stiffness;
        let moved = s * ((self.plant.moving_mass * s + self.plant.viscous_friction) * own + displaced);
        let frequency = self.plant.valve_natural_frequency;
        let square = frequency * frequency;
        let spool = square / (s * s + 2.0 * self.plant.valve_damping_ratio * frequency * s + square);
        let fed = sensor * self.plant.load_velocity_feed_forward.unwrap_or(0.0) * s * spool * driven;
        match self.plant.load {
            LinearLoad::Prescribed => {
                let sensed = moved + sensor * own;
                Paths { command: sensor * spool * driven, ground: fed - sensor * moved, sensed, fed: zero }
            }
            LinearLoad::Yielding { mass, damping, stiffness } => {
                let tied = damping * s + stiffness;
                let load = mass * s * s + tied;
                let sensed = moved * (load + sensor) + sensor * load * own;
                let ground = tied * (fed - sensor * moved);
                Paths { command: sensor * load * spool * driven, ground, sensed, fed }
            }
        }
    }

    /// D, N_u and N_v at s.
    fn chambers(&self, s: Complex64) -> Chambers<Complex64> {
        let at = self.sides.map(|side| side.at_chamber(s));
        let [area_a, area_b] = self.sides.map(|side| side.area);
        let leakage = self.plant.internal_leakage;
        if let Some(supply) = &self.plant.supply {
            return self.behind(supply, &at, s).chambers([area_a, area_b]);
        }
        let [one, other] = at;
        let (a, b) = (one.admittance, other.admittance);
        let difference = area_a - area_b;
        Chambers {
            own: a * b + leakage * (a + b),
            driven: area_a * one.flow_gain * b
                + area_b * other.flow_gain * a
                + leakage * difference * (one.flow_gain - other.flow_gain),
            displaced: area_a * area_a * b + area_b * area_b * a + leakage * difference * difference,
        }
    }

    /// With a supply that yields. Its edges end at the valve's ports, whose pressures are, with a d - b c = 1,
    ///
    /// ```text
    /// p_port = (p + b K_q U + b s_i p_S)/(d + K_c b)
    /// ```
    fn behind(&self, supply: &YieldingSupply, at: &[AtChamber; 2], s: Complex64) -> Coupled<Complex64> {
        let leakage = self.plant.internal_leakage;
        let [of_a, of_b] = supply.edges;
        let [one, other] = at;
        let returned = |edge: f64, at: &AtChamber| edge * at.impedance;
        let own = s * supply.compliance + supply.conductance + of_a + of_b
            - of_a * returned(of_a, one) / one.passed
            - of_b * returned(of_b, other) / other.passed;
        let taken =
            supply.flow_gain - returned(of_a, one) * one.flow_gain + returned(of_b, other) * other.flow_gain;
        Coupled {
            own: [one.admittance + leakage, other.admittance + leakage, own],
            across: leakage.into(),
            edges: [of_a / one.passed, of_b / other.passed],
            gains: [one.flow_gain, other.flow_gain, taken],
        }
    }

    /// Poles in the right half plane of a plant that is passive but for what is fed forward, from its return difference at increasing
    /// frequencies in rad/s, that reach from where it is real to where it is 1; `None` where two of these lie too far apart to tell.
    ///
    /// ```text
    /// poles = -1/pi the turn of 1 - K_x s X_L/U_C around zero, from zero to infinite frequency                    Nyquist
    /// ```
    pub fn unstable_poles(&self, frequencies_rad_per_s: &[f64]) -> Option<usize> {
        if self.plant.load == LinearLoad::Prescribed || self.plant.load_velocity_feed_forward.is_none() {
            return Some(0);
        }
        let difference = |frequency: &f64| {
            let Paths { sensed, fed, .. } = self.paths(Complex64::new(0.0, *frequency));
            1.0 - fed / sensed
        };
        let values: Vec<Complex64> = frequencies_rad_per_s.iter().map(difference).collect();
        let (first, last) = (values.first()?, values.last()?);
        let start = portable::argument(*first);
        let mut turn = start - (start / PI).round() * PI - portable::argument(*last);
        for pair in values.windows(2) {
            let step = portable::argument(pair[1] / pair[0]);
            turn += step;
            if step.is_nan() || step.abs() >= FRAC_PI_2 {
                return None;
            }
        }
        Some((-turn / PI).round().max(0.0) as usize)
    }

    /// Whether nothing in it but what is fed forward gives energy, so that none of its poles lies in the right half plane: its lines are passive, and so are
    /// valve, leakage, friction and load where none of their coefficients is negative.
    pub fn is_passive(&self) -> bool {
        let load = match self.plant.load {
            LinearLoad::Prescribed => [0.0; 3],
            LinearLoad::Yielding { mass, damping, stiffness } => [mass, damping, stiffness],
        };
        let own = [
            self.plant.moving_mass,
            self.plant.viscous_friction,
            self.plant.internal_leakage,
            self.plant.valve_damping_ratio,
        ];
        let of_sides = self.sides.iter().flat_map(|side| [side.compliance, side.flow_pressure]);
        let of_supply = self.plant.supply.iter().flat_map(|supply| {
            let to_tank = [0, 1].map(|side| self.sides[side].flow_pressure - supply.edges[side]);
            [supply.edges, to_tank, [supply.compliance, supply.conductance]].concat()
        });
        own.into_iter().chain(load).chain(of_sides).chain(of_supply).all(|value| value >= 0.0)
    }

    /// Where the slower line is a quarter of a wave long, pi/(2 T) in rad/s; `None` where no wave travels.
    pub fn quarter_wave_rad_per_s(&self) -> Option<f64> {
        let delays = self.sides.iter().flat_map(|side| side.line.delays());
        let longest = delays.fold(0.0, f64::max);
        (longest > 0.0).then(|| std::f64::consts::FRAC_PI_2 / longest)
    }
}

impl Side {
    fn at_chamber(&self, s: Complex64) -> AtChamber {
        let line = self.line.transfer_matrix(s);
        let passed = line.flow + self.flow_pressure * line.impedance;
        AtChamber {
            flow_gain: self.flow_gain / passed,
            admittance: s * self.compliance + (line.admittance + self.flow_pressure * line.pressure) / passed,
            passed,
            impedance: line.impedance,
        }
    }
}
