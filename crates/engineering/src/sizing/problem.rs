use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::line::{Hose, Line, StiffeningMember};
use phea_hydraulics::linear::{
    LinearParameters, RequiredStiffness, proportional_gain, required_stiffness, rigid_limit_gain,
};
use phea_hydraulics::stiffness::{StiffnessModel, StrokeStiffness, chamber_compliance};

use super::SizingStep;
use super::other_means::OtherMeansProblem;
use crate::quantity::{DisplayUnit, significant};
use crate::rig::LargestFlow;

/// The input of the procedure, with every value resolved. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SizingProblem {
    /// What else is sized for the stiffness of the hose; `None` where nobody asks.
    pub other_means: Option<OtherMeansProblem>,
    /// The cylinder.
    pub cylinder: Cylinder,
    /// What leaks from chamber to chamber, which K_c of the linear model includes, m3/(s Pa).
    pub internal_leakage: f64,
    /// Parameters of the linear model, K_c with what leaks from chamber to chamber, K_S with the
    /// load in series; the hydraulic stiffness is to be found; its value is not used.
    pub linear: LinearParameters,
    /// K_S without the load, N/m.
    pub sensor_alone: f64,
    /// The load in series with it.
    pub load: SizedLoad,
    /// K_qU of a spool at null that retracts the piston and of one that extends it, m3/(s V);
    /// `None` where they are equal or K_qU is stated.
    pub null_flow_gains: Option<[f64; 2]>,
    /// K_qU at null over that beyond the lap, of a valve whose edges overlap; `None` of any other,
    /// and where K_qU is stated.
    pub dead_band: Option<f64>,
    /// Bulk modulus of the fluid beta_0, Pa.
    pub fluid_modulus: f64,
    /// Density of the fluid, kg/m3.
    pub density: f64,
    /// The largest K_c of the project's uncertainty, where it states one.
    pub flow_pressure_coefficient_maximum: Option<f64>,
    /// Desired closed-loop time constant tau_d, s.
    pub time_constant: f64,
    /// Where tau_d comes from, in words.
    pub time_constant_origin: String,
    /// The largest flows of the lines, and what limits them.
    pub flow: LargestFlow,
    /// Recommended oil velocities, lowest and highest, m/s.
    pub oil_velocity: [f64; 2],
    /// The least proportional gain that is practical, V/N.
    pub minimum_gain: f64,
    /// The gain at which the search starts, V/N.
    pub maximum_gain: f64,
    /// Hoses are cut to multiples of this, m.
    pub length_increment: Option<f64>,
    /// Available length of hose, for both lines together, m.
    pub stock_length: Option<f64>,
    /// Acceptable length of each line, m.
    pub hose_length: [f64; 2],
    /// Supply pressure, Pa.
    pub supply_pressure: f64,
    /// The stiffness model the project declares.
    pub model: StiffnessModel,
    /// What differs between the lines as they are declared, in words, and what is made of it;
    /// `None` where they are hoses alike.
    pub unlike: Option<String>,
    /// The hoses to choose from.
    pub hoses: Vec<HoseOption>,
    /// Bores on the market other than those of the hoses, with their names, m.
    pub market_bores: Vec<(String, f64)>,
}

/// The load in the first-order model that a hose is sized with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SizedLoad {
    /// Its motion is prescribed, whatever the force: the thesis.
    Prescribed,
    /// It yields under the force with this stiffness at the rod, N/m.
    Yielding {
        /// N/m
        stiffness: f64,
    },
    /// It can move, but no stiffness holds it: the model holds it still.
    HeldStill,
}

impl SizedLoad {
    /// N/m, where it yields with one.
    pub fn stiffness(self) -> Option<f64> {
        match self {
            SizedLoad::Yielding { stiffness } => Some(stiffness),
            SizedLoad::Prescribed | SizedLoad::HeldStill => None,
        }
    }
}

/// A hose of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct HoseOption {
    /// Name in the catalogue.
    pub name: String,
    /// Bore, expansion and stiffening of that of line A and that of line B.
    pub hoses: [Hose; 2],
    /// Working pressure, Pa, where known: of two the lower.
    pub working_pressure: Option<f64>,
    /// Pressure at which the expansion is stated, Pa, where it is: of two the lower.
    pub expansion_stated_at: Option<f64>,
    /// Minimum bend radius, m, where known: of two the greater.
    pub minimum_bend_radius: Option<f64>,
}

impl HoseOption {
    /// Whether both lines have the same hose.
    pub fn is_alike(&self) -> bool {
        self.hoses[0] == self.hoses[1]
    }

    /// m, of the narrower, whose oil is the faster.
    pub fn bore(&self) -> f64 {
        self.hoses[0].bore.min(self.hoses[1].bore)
    }

    /// Lengths of both lines in m for a metre of line A, so that each has the same compliance.
    ///
    /// ```text
    /// L_B/L_A = kappa_A/kappa_B
    /// ```
    pub fn proportion(&self, model: StiffnessModel, fluid_modulus: f64) -> [f64; 2] {
        if self.is_alike() {
            return [1.0; 2];
        }
        let [metre_a, metre_b] = self.hoses.map(|hose| {
            let line = Line::Hose { hose, length: 1.0 };
            match model {
                StiffnessModel::Uniform => {
                    line.compliance_of_unexpanded(fluid_modulus, StiffeningMember::Nominal)
                }
                StiffnessModel::ByVolume => line.compliance(fluid_modulus, StiffeningMember::Nominal),
            }
        });
        [1.0, metre_a / metre_b]
    }

    /// Both lines at these lengths in m.
    pub fn lines(&self, lengths: [f64; 2]) -> [Line; 2] {
        let [hose_a, hose_b] = self.hoses;
        [Line::Hose { hose: hose_a, length: lengths[0] }, Line::Hose { hose: hose_b, length: lengths[1] }]
    }
}

impl SizingProblem {
    /// q_max, the largest flow of a line, m3/s.
    pub fn maximum_flow(&self) -> f64 {
        self.flow.line()
    }

    /// Hydraulic stiffness that gives the desired time constant under gain K_p, thesis (6.16), N/m;
    /// infinite at and below the gain where not even a rigid transmission is stiff enough.
    pub(crate) fn stiffness_for_gain(&self, gain: f64) -> f64 {
        match required_stiffness(&self.linear, self.time_constant, gain) {
            RequiredStiffness::Stiffness(stiffness) => stiffness,
            RequiredStiffness::TooSlow { .. } => f64::INFINITY,
        }
    }

    /// Gain that gives the desired time constant at hydraulic stiffness K_H, thesis (6.27), V/N.
    pub fn gain_for_stiffness(&self, stiffness: f64) -> f64 {
        proportional_gain(&self.with_stiffness(stiffness), self.time_constant)
    }

    /// The gain at which equation 6.16 has its pole, V/N.
    pub(crate) fn pole_gain(&self) -> f64 {
        rigid_limit_gain(&self.linear, self.time_constant)
    }

    /// The linear model with this hydraulic stiffness.
    pub(super) fn with_stiffness(&self, hydraulic_stiffness: f64) -> LinearParameters {
        LinearParameters { hydraulic_stiffness, ..self.linear }
    }

    /// Stiffness over the stroke with hoses of these lengths in m on side A and on side B.
    pub fn stroke_stiffness(
        &self,
        option: &HoseOption,
        lengths: [f64; 2],
        model: StiffnessModel,
    ) -> StrokeStiffness {
        let [line_a, line_b] = option.lines(lengths);
        let (moduli, lines) = ([self.fluid_modulus; 2], [&line_a, &line_b]);
        chamber_compliance(model, moduli, &self.cylinder, lines, StiffeningMember::Nominal).over_stroke()
    }

    /// Length of line A when the stock is shared in this proportion, or the longest acceptable one,
    /// whichever is shorter, m.
    pub(crate) fn available_length(&self, proportion: [f64; 2]) -> f64 {
        let [own, other] = proportion;
        let longest = self.hose_length[1] / own.max(other);
        self.stock_length.map_or(longest, |stock| longest.min(stock / (own + other)))
    }

    /// K_S, and what the load in series with it makes of it.
    fn sensor_words(&self) -> String {
        let unit = DisplayUnit::MEGANEWTON_PER_METRE;
        let sensor = format!("K_S = {}", unit.text(self.sensor_alone, 4));
        match self.load {
            SizedLoad::Prescribed => sensor,
            SizedLoad::Yielding { stiffness } => format!(
                "{sensor} in series with the load's {}: {}",
                unit.text(stiffness, 4),
                unit.text(self.linear.sensor_stiffness, 4)
            ),
            SizedLoad::HeldStill => format!("{sensor}, the load held still, as no stiffness holds it"),
        }
    }

    /// What the words of the procedure say about the lines.
    fn lines_words(&self) -> String {
        match &self.unlike {
            None => "both lines alike".to_string(),
            Some(words) => words.clone(),
        }
    }

    pub(super) fn decisions(&self) -> Vec<SizingStep> {
        let number = |value| significant(value, 4);
        vec![
            SizingStep {
                step: "a",
                text: format!(
                    "System data: A_u = {} cm2, stroke {} mm, β_0 = {} GPa, {}, K_qU = {} m3/(s.V), K_c0 = {} m3/(s.Pa){}; {}.",
                    DisplayUnit::SQUARE_CENTIMETRE.number(self.linear.useful_area, 4),
                    DisplayUnit::MILLIMETRE.number(2.0 * self.cylinder.stroke.middle(), 4),
                    DisplayUnit::GIGAPASCAL.number(self.fluid_modulus, 4),
                    self.sensor_words(),
                    number(self.linear.flow_gain),
                    number(self.linear.flow_pressure_coefficient),
                    match self.internal_leakage {
                        0.0 => String::new(),
                        leakage => format!(" with {} m3/(s.Pa) from chamber to chamber", number(leakage)),
                    },
                    self.lines_words()
                ),
            },
            SizingStep {
                step: "b",
                text: format!(
                    "Time constant τ_d = {} ms: {}.",
                    DisplayUnit::MILLISECOND.number(self.time_constant, 4),
                    self.time_constant_origin
                ),
            },
        ]
    }

    /// Step f: where the search over the gain begins, and what limits it.
    pub(super) fn search_decision(&self) -> SizingStep {
        let text = format!(
            "K_p starts at {} V/N and is halved while the hose is longer than {} m, but not below {} V/N; at {} V/N even a rigid transmission would be too slow (K_H infinite).",
            significant(self.maximum_gain, 3),
            significant(self.available_length([1.0; 2]), 4),
            significant(self.minimum_gain, 3),
            significant(self.pole_gain(), 3)
        );
        SizingStep { step: "f", text }
    }
}
