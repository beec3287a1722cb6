use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::line::{Hose, Line, StiffeningMember};
use phea_hydraulics::linear::{
    LinearParameters, RequiredStiffness, proportional_gain, required_stiffness, rigid_limit_gain,
};
use phea_hydraulics::port_valves::ValveAtPoint;
use phea_hydraulics::stiffness::{StiffnessModel, StrokeStiffness, chamber_compliance};

use super::other_means::OtherMeansProblem;
use super::{SizedSystem, SizingStep};
use crate::rig::LargestFlow;

/// Input of the procedure, with every value resolved, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SizingProblem {
    /// Other means that are sized for the stiffness of the hose; `None` if not requested.
    pub other_means: Option<OtherMeansProblem>,
    /// The cylinder.
    pub cylinder: Cylinder,
    /// Leakage coefficient from chamber to chamber, which is included in K_c of the linear model,
    /// m3/(s Pa).
    pub internal_leakage: f64,
    /// Parameters of the linear model, K_c with the leakage from chamber to chamber, K_S with the
    /// load in series; the hydraulic stiffness is to be found; its value is not used.
    pub linear: LinearParameters,
    /// Stiffness K_S without the load, N/m.
    pub sensor_without_load: f64,
    /// The load in series with it.
    pub load: SizedLoad,
    /// K_qU of a spool at null that retracts the piston and of one that extends it, m3/(s V);
    /// `None` if they are equal or K_qU is stated.
    pub null_flow_gains: Option<[f64; 2]>,
    /// Ratio of K_qU at null to that beyond the lap, for a valve whose edges overlap; `None` for
    /// any other valve, and if K_qU is stated.
    pub dead_band: Option<f64>,
    /// Bulk modulus of the fluid beta_0, Pa.
    pub fluid_modulus: f64,
    /// Density of the fluid, kg/m3.
    pub density: f64,
    /// Largest K_c of the project's uncertainty, if it states one.
    pub flow_pressure_coefficient_maximum: Option<f64>,
    /// Desired closed-loop time constant tau_d, s.
    pub time_constant: f64,
    /// Origin of tau_d.
    pub time_constant_origin: TimeConstantOrigin,
    /// Requirement in time that needs the shortest time constant, if it is shorter than the desired
    /// one; `None` if none is.
    pub sooner: Option<SoonerRequirement>,
    /// Largest flows of the lines, and their limitation.
    pub flow: LargestFlow,
    /// Recommended oil velocities, lowest and highest, m/s.
    pub oil_velocity: [f64; 2],
    /// Least practical proportional gain, V/N.
    pub minimum_gain: f64,
    /// Gain at which the search starts, V/N.
    pub maximum_gain: f64,
    /// Increment of hose lengths when cut, m.
    pub length_increment: Option<f64>,
    /// Available length of hose, for both lines together, m.
    pub stock_length: Option<f64>,
    /// Acceptable length of each line, m.
    pub hose_length: [f64; 2],
    /// Supply pressure, Pa.
    pub supply_pressure: f64,
    /// The stiffness model the project declares.
    pub model: StiffnessModel,
    /// Difference between the declared lines; `None` if they are identical hoses.
    pub unlike: Option<UnlikeLines>,
    /// Relief and check valves that act within the pressure of the supply, each with its chamber;
    /// the procedure does not include them.
    pub port_valves: Vec<(char, ValveAtPoint)>,
    /// The hoses to choose from.
    pub hoses: Vec<HoseOption>,
    /// Bores on the market other than those of the hoses, with their names, m.
    pub market_bores: Vec<(String, f64)>,
}

/// Load in the first-order model with which a hose is sized.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SizedLoad {
    /// The motion of the load is prescribed, whatever the force: the thesis.
    Prescribed,
    /// The load yields under the force with this stiffness at the rod.
    Yielding {
        /// Stiffness, N/m.
        stiffness: f64,
    },
    /// The load can move but has no stiffness: the model assumes it at rest.
    HeldStill,
}

impl SizedLoad {
    /// Stiffness, N/m, if the load yields with one.
    pub fn stiffness(self) -> Option<f64> {
        match self {
            SizedLoad::Yielding { stiffness } => Some(stiffness),
            SizedLoad::Prescribed | SizedLoad::HeldStill => None,
        }
    }
}

/// Origin of the desired time constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeConstantOrigin {
    /// Stated time constant.
    Stated,
    /// Time constant of a first-order response with this settling time.
    Settling {
        /// Settling time, s.
        settling_time: f64,
        /// Settling band, percent of the step.
        band_percent: f64,
        /// Time constants until the response enters the band.
        constants: f64,
    },
}

/// A requirement in time that a first-order response with the desired time constant misses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoonerRequirement {
    /// Number of its specification in the file, from 1.
    pub specification: usize,
    /// Band of the settling time, percent of the step.
    pub band_percent: f64,
    /// Settling time of the response, s.
    pub settles: f64,
    /// Required settling time, s.
    pub required: f64,
}

/// Difference between the lines as declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnlikeLines {
    /// The hoses differ: each is sized for an equal compliance.
    HosesDiffer,
    /// Line B is not a hose: hoses are sized for both lines.
    LineBIsNoHose,
    /// Line A is not a hose: hoses are sized for both lines.
    LineAIsNoHose,
}

/// Name of a hose, or of a dash size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HoseName {
    /// Name of the hose of both lines; `None` for a hose of the project without a name.
    Both(Option<String>),
    /// Names of the hose of line A and of that of line B, which differ.
    Each([Option<String>; 2]),
}

impl HoseName {
    /// Name of a product or a dash size.
    pub fn named(name: &str) -> HoseName {
        HoseName::Both(Some(name.to_string()))
    }
}

/// A hose of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct HoseOption {
    /// Name in the catalogue.
    pub name: HoseName,
    /// Bore, expansion and stiffening of the hose of line A and of that of line B.
    pub hoses: [Hose; 2],
    /// Working pressure, Pa, if known: the lower of two.
    pub working_pressure: Option<f64>,
    /// Pressure at which the expansion is stated, Pa, if it is: the lower of two.
    pub expansion_stated_at: Option<f64>,
    /// Minimum bend radius, m, if known: the greater of two.
    pub minimum_bend_radius: Option<f64>,
}

impl HoseOption {
    /// True if both lines have identical hoses.
    pub fn is_alike(&self) -> bool {
        self.hoses[0] == self.hoses[1]
    }

    /// Bore of the narrower hose, in which the oil is faster, m.
    pub fn bore(&self) -> f64 {
        self.hoses[0].bore.min(self.hoses[1].bore)
    }

    /// Lengths of both lines, m, per metre of line A, for which both have equal compliance.
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

    /// Both lines at these lengths, m.
    pub fn lines(&self, lengths: [f64; 2]) -> [Line; 2] {
        let [hose_a, hose_b] = self.hoses;
        [Line::Hose { hose: hose_a, length: lengths[0] }, Line::Hose { hose: hose_b, length: lengths[1] }]
    }
}

impl SizingProblem {
    /// Largest flow of a line, q_max, m3/s.
    pub fn maximum_flow(&self) -> f64 {
        self.flow.line()
    }

    /// Hydraulic stiffness that gives the desired time constant under gain K_p, thesis (6.16), N/m;
    /// infinite at and below the gain at which not even a rigid transmission is stiff enough.
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

    /// Gain at which equation 6.16 has its pole, V/N.
    pub(crate) fn pole_gain(&self) -> f64 {
        rigid_limit_gain(&self.linear, self.time_constant)
    }

    /// The linear model with this hydraulic stiffness.
    pub(super) fn with_stiffness(&self, hydraulic_stiffness: f64) -> LinearParameters {
        LinearParameters { hydraulic_stiffness, ..self.linear }
    }

    /// Stiffness over the stroke with hoses of these lengths on side A and on side B, m.
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

    /// Length of line A if the stock is divided in this proportion, or the longest acceptable one,
    /// whichever is shorter, m.
    pub(crate) fn available_length(&self, proportion: [f64; 2]) -> f64 {
        let [own, other] = proportion;
        let longest = self.hose_length[1] / own.max(other);
        self.stock_length.map_or(longest, |stock| longest.min(stock / (own + other)))
    }

    /// Steps a and b.
    pub(super) fn decisions(&self) -> Vec<SizingStep> {
        let system = SizedSystem {
            useful_area: self.linear.useful_area,
            stroke: 2.0 * self.cylinder.stroke.middle(),
            fluid_modulus: self.fluid_modulus,
            sensor_without_load: self.sensor_without_load,
            load: self.load,
            sensor_stiffness: self.linear.sensor_stiffness,
            flow_gain: self.linear.flow_gain,
            flow_pressure_coefficient: self.linear.flow_pressure_coefficient,
            internal_leakage: self.internal_leakage,
            unlike: self.unlike,
        };
        let time_constant = SizingStep::TimeConstant {
            time_constant: self.time_constant,
            origin: self.time_constant_origin,
            sooner: self.sooner,
        };
        vec![SizingStep::SystemData(system), time_constant]
    }

    /// Step f: gain at which the search begins, and its limitation.
    pub(super) fn search_decision(&self) -> SizingStep {
        SizingStep::Search {
            maximum_gain: self.maximum_gain,
            available_length: self.available_length([1.0; 2]),
            minimum_gain: self.minimum_gain,
            pole_gain: self.pole_gain(),
        }
    }
}
