//! What is claimed about a loop, with its proof: everything that a checker needs, and nothing else.

use phea_dynamics::expression::Expression;

use crate::specification::ClosedLoop;

/// A claim about every plant of a box at every frequency of a band, with its proof.
///
/// A number stands for the decimal number that it prints as: the shortest that reads back as it.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The plant, as recorded operations on its parameters.
    pub plant: CertifiedPlant,
    /// G.
    pub feedback: ControlLaw,
    /// F.
    pub prefilter: ControlLaw,
    /// H.
    pub sensor: Quotient,
    /// How the loop samples, where it does.
    pub sampling: Option<Sampling>,
    /// What is claimed.
    pub claims: Vec<Claim>,
}

impl Certificate {
    /// Leaves of all trees.
    pub fn leaves(&self) -> usize {
        let of_claim = |claim: &Claim| -> usize {
            match claim {
                Claim::Stable(boxes) => boxes
                    .iter()
                    .flat_map(|one| one.panels.iter().chain(&one.delays))
                    .map(FrequencyPanel::leaves)
                    .sum(),
                Claim::Limited { boxes, .. } => boxes.iter().flatten().map(FrequencyPanel::leaves).sum(),
                Claim::Unstable { .. } | Claim::Reached { .. } => 0,
            }
        };
        self.claims.iter().map(of_claim).sum()
    }
}

/// The plant of a family: a union of boxes.
#[derive(Clone, Debug, PartialEq)]
pub struct CertifiedPlant {
    /// Names of its parameters.
    pub parameters: Vec<String>,
    /// Number of variables t in [0, 1] that span each box.
    pub variables: usize,
    /// For each box how its parameters depend on the variables, in the order of `parameters`.
    pub boxes: Vec<Vec<ParameterSegment>>,
    /// Coefficients of P, of Pd if there is one, and the dead time of the plant if it has one.
    pub coefficients: Expression,
    /// Numbers of coefficients, highest power first: numerator and denominator of P, and the same
    /// for Pd.
    pub lengths: Vec<usize>,
    /// Whether the dead time of the plant follows the coefficients.
    pub has_dead_time: bool,
    /// Additional dead time of the loop, s.
    pub delay_s: f64,
    /// Terms of the series that stands for dead time.
    pub dead_time_terms: usize,
    /// The degree of the polynomials, with a remainder, that replace coefficients which are not
    /// polynomials; 0 where all are polynomials.
    pub model_degree: usize,
}

/// A parameter in a box: `low + (high - low) t` of the variable with this index, or
/// `low (high/low)^t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSegment {
    /// Its value where the variable is 0.
    pub low: f64,
    /// Its value where the variable is 1.
    pub high: f64,
    /// Which variable moves it; `None` where it is `low` always.
    pub variable: Option<usize>,
    /// Whether it varies logarithmically.
    pub by_factors: bool,
}

impl ParameterSegment {
    /// A value that nothing moves.
    pub fn fixed(value: f64) -> ParameterSegment {
        ParameterSegment { low: value, high: value, variable: None, by_factors: false }
    }
}

impl CertifiedPlant {
    /// Whether every parameter of a box moves along a straight line.
    pub(super) fn is_straight(&self) -> bool {
        self.boxes.iter().flatten().all(|one| !one.by_factors)
    }

    /// Whether there is dead time in the loop.
    pub fn is_late(&self) -> bool {
        self.has_dead_time || self.delay_s != 0.0
    }
}

/// A quotient of polynomials in s, highest power first.
#[derive(Clone, Debug, PartialEq)]
pub struct Quotient {
    /// Numerator.
    pub numerator: Vec<f64>,
    /// Denominator.
    pub denominator: Vec<f64>,
}

impl Quotient {
    /// A number.
    pub fn constant(value: f64) -> Quotient {
        Quotient { numerator: vec![value], denominator: vec![1.0] }
    }

    /// Whether it is the number one.
    pub(crate) fn is_one(&self) -> bool {
        *self == Quotient::constant(1.0)
    }
}

/// A controller or prefilter.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlLaw {
    /// In s.
    Continuous(Quotient),
    /// In z.
    Sampled(Sections),
}

/// A product of quotients of polynomials in z - 1, of degree two at most, highest power first.
#[derive(Clone, Debug, PartialEq)]
pub struct Sections {
    /// What multiplies them.
    pub gain: f64,
    /// Numerators.
    pub numerator: Vec<Vec<f64>>,
    /// Denominators.
    pub denominator: Vec<Vec<f64>>,
}

/// One claim.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// All poles of the loop with every plant, and of the prefilter, have negative real parts.
    Stable(
        /// Of each box.
        Vec<StableBox>,
    ),
    /// With this plant the loop has a pole on the boundary of stability or beyond it.
    Unstable {
        /// The plant.
        member: CertificateMember,
        /// Of a sampled loop.
        count: Option<PoleCount>,
    },
    /// A closed loop is within `ratio` times its limit.
    Limited {
        /// What is limited.
        limited: LimitedLoop,
        /// The greatest ratio.
        ratio: f64,
        /// For each box, over the band without a gap.
        boxes: Vec<Vec<FrequencyPanel>>,
    },
    /// A closed loop is at least `ratio` times its limit somewhere.
    Reached {
        /// What is limited.
        limited: LimitedLoop,
        /// The ratio.
        ratio: f64,
        /// Where, rad/s.
        frequency_rad_per_s: f64,
        /// With which plant.
        member: CertificateMember,
    },
}

/// Proof that every plant of a box is stable: one is, and on the way to every other plant none of
/// its poles crosses the boundary of stability.
#[derive(Clone, Debug, PartialEq)]
pub struct StableBox {
    /// Variables of a plant that is stable without dead time.
    pub member: Vec<f64>,
    /// From zero to infinity without a gap: no pole on the boundary, for every plant of the box.
    pub panels: Vec<FrequencyPanel>,
    /// The same for this plant alone, while its dead time grows from zero to its value; empty
    /// without dead time and for a sampled loop.
    pub delays: Vec<FrequencyPanel>,
    /// For a sampled loop, which needs no path from a loop without dead time.
    pub count: Option<PoleCount>,
}

/// The number of poles of a sampled loop outside the unit circle with one plant, from the number of
/// turns of its characteristic function.
#[derive(Clone, Debug, PartialEq)]
pub struct PoleCount {
    /// The characteristic function f along the unit circle, up to pi/T.
    pub characteristic: Vec<FrequencyPanel>,
    /// The denominator of plant and sensor without its zeros at s = 0, up to pi/T.
    pub denominator: Vec<FrequencyPanel>,
    /// The same from there to infinity.
    pub beyond: Vec<FrequencyPanel>,
}

/// How a loop samples: the plant behind a zero-order hold, its response being the sum of its images
/// at w + 2 pi k/T.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// T, s.
    pub sample_time_s: f64,
    /// The part of the dead time that follows the output, s: that of the sensor, which is not part
    /// of P.
    pub sensor_delay_s: f64,
    /// Number of images on either side that are enclosed one by one.
    pub images: usize,
    /// For each box a bound on the other images: for the plant with its sensor and, where the
    /// sensor is not 1, for the plant alone.
    pub bounds: Vec<Vec<RollOffBound>>,
}

/// |P(jw)| <= `ratio`/w^m from a frequency below those of all images that are not taken one by one.
#[derive(Clone, Debug, PartialEq)]
pub struct RollOffBound {
    /// m, at least 1: the degree of the denominator less that of the numerator.
    pub order: usize,
    /// In the units of P and rad/s.
    pub ratio: f64,
    /// From there to infinity.
    pub panels: Vec<FrequencyPanel>,
}

/// A plant of a family.
#[derive(Clone, Debug, PartialEq)]
pub struct CertificateMember {
    /// Index of the box.
    pub of_box: usize,
    /// Its variables, each within 0 to 1.
    pub variables: Vec<f64>,
}

/// A closed loop with its limit.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitedLoop {
    /// The closed loop.
    pub closed_loop: ClosedLoop,
    /// Which side is limited.
    pub side: CertificateSide,
    /// The limit.
    pub limit: LimitOf,
    /// From and to, rad/s.
    pub band_rad_per_s: [f64; 2],
}

/// What limits a magnitude.
#[derive(Clone, Debug, PartialEq)]
pub enum LimitOf {
    /// The magnitude of this.
    Quotient(Quotient),
    /// Points of frequency, rad/s, and magnitude: straight between them in a double logarithmic
    /// diagram, and without a limit beyond them.
    Table(Vec<(f64, f64)>),
}

/// Whether a limit bounds a magnitude from above or from below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CertificateSide {
    /// The ratio is that of the magnitude to its limit.
    Upper,
    /// The ratio is that of the limit to the magnitude.
    Lower,
}

/// A panel of frequencies and the tree of boxes that covers it with the box of the plants.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyPanel {
    /// rad/s
    pub from: f64,
    /// rad/s; may be infinite.
    pub to: f64,
    /// How dead time is taken.
    pub late: Late,
    /// In order: an axis across which the box is halved, 0 being that of the frequency, then the
    /// lower half, then the upper one; or [`LEAF`] with the direction that shows the claim there,
    /// two numbers of 16 bits, the greater byte first.
    pub tree: Vec<u8>,
}

/// How dead time E = e^(-j w tau) is treated over a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Late {
    /// There is none.
    Not,
    /// It is expanded about this angle, rad: about halfway between the least and the greatest
    /// product of frequency and dead time.
    Turns(f64),
    /// As any number of magnitude one: the part that it multiplies is smaller than the rest.
    Less,
    /// The same where the part that it multiplies is larger than the rest.
    More,
}

/// Precedes the direction of a leaf.
pub const LEAF: u8 = 255;

impl FrequencyPanel {
    /// Number of leaves: n leaves come with n - 1 halvings of one byte each.
    pub fn leaves(&self) -> usize {
        (self.tree.len() + 1) / 6
    }
}
