//! Certificate: claims about a loop with their proof; everything that a checker needs, and nothing
//! else.

use phea_dynamics::expression::Expression;

use crate::specification::ClosedLoop;

/// A claim about every plant of a box at every frequency of a band, with its proof.
///
/// Each number represents the decimal number that it prints as: the shortest one that reads back as
/// that number.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The plant, as recorded operations on its parameters.
    pub plant: CertifiedPlant,
    /// Feedback G.
    pub feedback: ControlLaw,
    /// Prefilter F.
    pub prefilter: ControlLaw,
    /// Sensor H.
    pub sensor: Quotient,
    /// Sampling of the loop; `None` if it is continuous.
    pub sampling: Option<Sampling>,
    /// Claims of the certificate.
    pub claims: Vec<Claim>,
}

impl Certificate {
    /// Number of leaves of all trees.
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
    /// Dependence of the parameters on the variables for each box, in the order of `parameters`.
    pub boxes: Vec<Vec<ParameterSegment>>,
    /// Coefficients of P, of Pd if there is one, and the dead time of the plant if it has one.
    pub coefficients: Expression,
    /// Numbers of coefficients, highest power first: numerator and denominator of P, then those of
    /// Pd.
    pub lengths: Vec<usize>,
    /// True if the dead time of the plant follows the coefficients.
    pub has_dead_time: bool,
    /// Additional dead time of the loop, s.
    pub delay_s: f64,
    /// Number of terms of the series that approximates dead time.
    pub dead_time_terms: usize,
    /// Degree of the polynomials, with a remainder, that replace nonpolynomial coefficients; 0 if
    /// all are polynomials.
    pub model_degree: usize,
}

/// A parameter in a box: `low + (high - low) t` of the variable with this index, or
/// `low (high/low)^t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSegment {
    /// Value if the variable is 0.
    pub low: f64,
    /// Value if the variable is 1.
    pub high: f64,
    /// Index of the variable that moves the parameter; `None` if it is always `low`.
    pub variable: Option<usize>,
    /// True if the parameter varies logarithmically.
    pub by_factors: bool,
}

impl ParameterSegment {
    /// A constant value.
    pub fn fixed(value: f64) -> ParameterSegment {
        ParameterSegment { low: value, high: value, variable: None, by_factors: false }
    }
}

impl CertifiedPlant {
    /// True if every parameter of a box varies linearly.
    pub(super) fn is_straight(&self) -> bool {
        self.boxes.iter().flatten().all(|one| !one.by_factors)
    }

    /// True if there is dead time in the loop.
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

    /// True if it is the number one.
    pub(crate) fn is_one(&self) -> bool {
        *self == Quotient::constant(1.0)
    }
}

/// A controller or prefilter.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlLaw {
    /// Law in s.
    Continuous(Quotient),
    /// Law in z.
    Sampled(Sections),
}

/// A product of quotients of polynomials in z - 1, of degree two at most, highest power first.
#[derive(Clone, Debug, PartialEq)]
pub struct Sections {
    /// Factor of the product.
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
        /// Proof for each box.
        Vec<StableBox>,
    ),
    /// The loop with this plant has a pole on the stability boundary or beyond it.
    Unstable {
        /// The plant.
        member: CertificateMember,
        /// Number of unstable poles of a sampled loop.
        count: Option<PoleCount>,
    },
    /// A closed loop is within `ratio` times its limit.
    Limited {
        /// The closed loop and its limit.
        limited: LimitedLoop,
        /// The greatest ratio.
        ratio: f64,
        /// Panels for each box, covering the band without a gap.
        boxes: Vec<Vec<FrequencyPanel>>,
    },
    /// A closed loop is at least `ratio` times its limit somewhere.
    Reached {
        /// The closed loop and its limit.
        limited: LimitedLoop,
        /// The ratio.
        ratio: f64,
        /// Frequency at which it is reached, rad/s.
        frequency_rad_per_s: f64,
        /// Plant for which it is reached.
        member: CertificateMember,
    },
}

/// Proof that every plant of a box is stable: one plant is stable, and on the way to every other
/// plant no pole crosses the stability boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct StableBox {
    /// Variables of a plant that is stable without dead time.
    pub member: Vec<f64>,
    /// Panels from zero to infinity without a gap: no pole on the stability boundary, for every
    /// plant of the box.
    pub panels: Vec<FrequencyPanel>,
    /// Panels for this plant while its dead time grows from zero to its value; empty without dead
    /// time and for a sampled loop.
    pub delays: Vec<FrequencyPanel>,
    /// Number of unstable poles of a sampled loop, which needs no path from a loop without dead
    /// time.
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
    /// The denominator from pi/T to infinity.
    pub beyond: Vec<FrequencyPanel>,
}

/// Sampling of a loop: the plant after a zero-order hold, whose response is the sum of its images
/// at w + 2 pi k/T.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// Sample time T, s.
    pub sample_time_s: f64,
    /// The part of the dead time that follows the output, s: that of the sensor, which does not
    /// belong to P.
    pub sensor_delay_s: f64,
    /// Number of images on either side that are enclosed individually.
    pub images: usize,
    /// Bounds on the other images for each box: for the plant with its sensor and, if the sensor is
    /// not 1, for the plant without it.
    pub bounds: Vec<Vec<RollOffBound>>,
}

/// Bound |P(jw)| <= `ratio`/w^m from a frequency below those of all images not enclosed
/// individually.
#[derive(Clone, Debug, PartialEq)]
pub struct RollOffBound {
    /// Order m, at least 1: the degree of the denominator less that of the numerator.
    pub order: usize,
    /// Ratio in the units of P and rad/s.
    pub ratio: f64,
    /// Panels from that frequency to infinity.
    pub panels: Vec<FrequencyPanel>,
}

/// A plant of a family.
#[derive(Clone, Debug, PartialEq)]
pub struct CertificateMember {
    /// Index of the box.
    pub of_box: usize,
    /// Variables of the plant, each within 0 to 1.
    pub variables: Vec<f64>,
}

/// A closed loop with its limit.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitedLoop {
    /// The closed loop.
    pub closed_loop: ClosedLoop,
    /// Limited side.
    pub side: CertificateSide,
    /// The limit.
    pub limit: LimitOf,
    /// Ends of the band, rad/s.
    pub band_rad_per_s: [f64; 2],
}

/// Limit of a magnitude.
#[derive(Clone, Debug, PartialEq)]
pub enum LimitOf {
    /// Magnitude of this quotient.
    Quotient(Quotient),
    /// Points of frequency, rad/s, and magnitude: interpolated linearly in a double logarithmic
    /// diagram, and without a limit beyond them.
    Table(Vec<(f64, f64)>),
}

/// Side of a limit: from above or from below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CertificateSide {
    /// The ratio is that of the magnitude to its limit.
    Upper,
    /// The ratio is that of the limit to the magnitude.
    Lower,
}

/// A panel of frequencies and the tree of boxes that covers it and the box of the plants.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyPanel {
    /// Lower end, rad/s.
    pub from: f64,
    /// Upper end, rad/s; may be infinite.
    pub to: f64,
    /// Treatment of dead time.
    pub late: Late,
    /// Nodes in preorder: an axis across which the box is halved, 0 for the frequency, then the
    /// lower half, then the upper one; or [`LEAF`] with the direction that proves the claim there,
    /// two big-endian numbers of 16 bits.
    pub tree: Vec<u8>,
}

/// Treatment of dead time E = e^(-j w tau) over a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Late {
    /// Absent.
    Not,
    /// Expanded about this angle, rad: about halfway between the least and the greatest product of
    /// frequency and dead time.
    Turns(f64),
    /// Replaced by any number of magnitude one: the part that it multiplies is smaller than the
    /// rest.
    Less,
    /// Replaced by any number of magnitude one: the part that it multiplies is larger than the
    /// rest.
    More,
}

/// Precedes the direction of a leaf.
pub const LEAF: u8 = 255;

impl FrequencyPanel {
    /// Number of leaves; n leaves have n - 1 halvings of one byte each.
    pub fn leaves(&self) -> usize {
        (self.tree.len() + 1) / 6
    }
}
