//! Templates: the responses of a family at one frequency.
//!
//! The members come first. A family over a box is then refined: lines along the edges of the box
//! until neighbouring plants are close, the regions enclosed by the edges of its two-dimensional
//! faces, growth of these regions over all coordinates, and witnesses (members and evenly spread
//! probes) that must be inside it.

mod build;
mod cell;
mod explore;
mod growth;
mod plants;
mod region;
mod witness;

use num_complex::Complex64;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch, unwatched};

use crate::closed_loop::Compensation;
use crate::family::Family;

pub(crate) use build::around_disc;
pub use build::template;
use build::template_watched;

/// Resolution of a template, and limits of its refinement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TemplateOptions {
    /// Largest distance of neighbouring plants, degrees; above 0 and below 90.
    pub phase_deg: f64,
    /// Largest distance of neighbouring plants, dB; above 0.
    pub magnitude_db: f64,
    /// Number of plants, in addition to the members, after which refinement is abandoned.
    pub evaluations_maximum: usize,
    /// Number of plants, spread evenly over the box, that must be inside the outline in addition to
    /// the members.
    pub probes: usize,
    /// Number of rounds of growth after which refinement is abandoned; each extends the contour of
    /// the previous round.
    pub rounds_maximum: usize,
}

impl Default for TemplateOptions {
    /// Defaults: 2 degrees, 0.5 dB, 50000 plants, 128 probes, 16 rounds.
    fn default() -> TemplateOptions {
        TemplateOptions {
            phase_deg: 2.0,
            magnitude_db: 0.5,
            evaluations_maximum: 50_000,
            probes: 128,
            rounds_maximum: 16,
        }
    }
}

/// Reason why there is no template.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TemplateError {
    /// A tolerance that is not a positive number, or a phase tolerance of 90 degrees and more.
    #[error("templates cannot be refined to {phase_deg} degrees and {magnitude_db} dB")]
    Tolerance {
        /// The requested tolerance, degrees.
        phase_deg: f64,
        /// The requested tolerance, dB.
        magnitude_db: f64,
    },
    /// A plant that does not fit the loop.
    #[error("the plant with parameters {values:?} cannot be sampled: {reason}")]
    Plant {
        /// Parameters of the plant.
        values: Vec<f64>,
        /// Reason for the failure.
        reason: LinearError,
    },
    /// A measurement that does not cover the frequency.
    #[error("a measured response does not reach {frequency_rad_per_s} rad/s")]
    OutOfReach {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
    /// The watch stopped the refinement.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// A response that is zero or not finite, of the nominal plant or in a family that consists
    /// only of members.
    #[error("member {member} has the response {response} at {frequency_rad_per_s} rad/s")]
    NotFinite {
        /// Index of the member in its family.
        member: usize,
        /// Response P H of the member.
        response: Complex64,
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
}

/// A template and the number of plants evaluated for it.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltTemplate {
    /// The template.
    pub template: Template,
    /// Number of plants evaluated, including members.
    pub evaluations: usize,
}

/// Templates of a family at many frequencies: an iterator, so that the caller decides when the next
/// one is built.
///
/// # Example
/// Template of an integrator with a gain between 1 and 2, which is a segment of the negative
/// imaginary axis:
/// ```
/// # use phea_dynamics::controller::Controller;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_qft::closed_loop::Compensation;
/// # use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
/// use phea_qft::template::{TemplateOptions, Templates};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 2.0 };
/// # let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// # let coordinate = Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
/// # let members = vertices(&plant, &[coordinate.clone()])?;
/// # let family = Family::Uncertain(UncertainFamily::new(plant, vec![coordinate], members, Extent::Box)?);
/// # let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let mut templates = Templates::new(&family, &compensation, &[0.5, 1.0], TemplateOptions::default());
/// let built = templates.next().ok_or("one for each frequency")??;
/// assert_eq!(built.template.frequency_rad_per_s, 0.5);
/// // from -2j to -4j and back
/// let outline = &built.template.outlines[0];
/// assert!(outline.iter().all(|response| response.re.abs() < 1e-12 && (-4.0..=-2.0).contains(&response.im)));
/// assert_eq!(templates.count(), 1);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Templates<'a> {
    family: &'a Family,
    compensation: &'a Compensation,
    frequencies_rad_per_s: std::slice::Iter<'a, f64>,
    options: TemplateOptions,
}

impl<'a> Templates<'a> {
    /// Templates at these frequencies, rad/s, none of them built yet.
    pub fn new(
        family: &'a Family,
        compensation: &'a Compensation,
        frequencies_rad_per_s: &'a [f64],
        options: TemplateOptions,
    ) -> Templates<'a> {
        Templates { family, compensation, frequencies_rad_per_s: frequencies_rad_per_s.iter(), options }
    }
}

impl Templates<'_> {
    /// The next template, under this watch; `None` after the last one.
    pub fn next_watched(&mut self, watch: Watch<'_>) -> Option<Result<BuiltTemplate, TemplateError>> {
        let &frequency_rad_per_s = self.frequencies_rad_per_s.next()?;
        Some(template_watched((self.family, self.compensation), frequency_rad_per_s, &self.options, watch))
    }
}

impl Iterator for Templates<'_> {
    type Item = Result<BuiltTemplate, TemplateError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_watched(&mut unwatched)
    }
}

/// The response of the family at one frequency: points that represent plants, and the region that
/// they fill.
///
/// # Example
/// The region must be known to be filled. The template of P = k e^(-sT) with k between 1 and 2 is a
/// curved strip; a controller places the plant in its middle at L = -1, although every plant on the
/// outline satisfies |T| <= 4:
/// ```
/// # use num_complex::Complex64;
/// # use phea_dynamics::controller::Controller;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_qft::closed_loop::Compensation;
/// # use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
/// use phea_qft::template::{TemplateOptions, template};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let range = |name: &str, minimum: f64, maximum: f64| {
/// #     UncertainParameter { name: name.into(), nominal: minimum, minimum, maximum }
/// # };
/// # let plant = UncertainPlant::record(vec![range("k", 1.0, 2.0), range("T", 0.1, 1.0)], |p| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: p[1],
/// #     rate: None,
/// # })?;
/// # let along = |index| Coordinate { parameters: vec![index], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
/// # let coordinates = vec![along(0), along(1)];
/// # let members = vertices(&plant, &coordinates)?;
/// # let middle = plant.response(&[2_f64.sqrt(), 0.55], 5.0).ok_or("a response")?;
/// # let family = Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box)?);
/// # let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let strip = template(&family, &compensation, 5.0, &TemplateOptions::default())?.template;
/// let controller = -1.0 / middle; // middle = P(j 5) at k = 1.414, T = 0.55
/// for &plant in strip.outlines.iter().flatten() {
///     let open_loop = controller * plant;
///     assert!((open_loop / (1.0 + open_loop)).norm_sqr() < 4.0 * 4.0);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Nominal response P0 H0, the nominal plant with its sensor.
    pub nominal: Complex64,
    /// Plants: the members in order, the nominal one first, then those found on the outlines by
    /// refinement.
    pub points: Vec<TemplatePoint>,
    /// Closed polygons of responses P H (the last point joins the first) around the region known to
    /// be filled: without holes, adjacent, with corners no farther apart than the tolerance. There
    /// are several if the region is disconnected or has a hole, a line traversed in both directions
    /// if it has no area, and none for a family that consists only of its members.
    pub outlines: Vec<Vec<Complex64>>,
    /// Resolution of the region.
    pub resolution: Resolution,
}

impl Template {
    /// Area of the region known to be filled, degrees times dB.
    ///
    /// # Example
    /// Square between 0 and -90 degrees, and between 0 and 20 dB:
    /// ```
    /// # use num_complex::Complex64;
    /// # use phea_qft::template::{Resolution, Template};
    /// let corners = [(1.0, 0.0), (10.0, 0.0), (0.0, -10.0), (0.0, -1.0)];
    /// let outline = corners.map(|(re, im)| Complex64::new(re, im)).to_vec();
    /// let nominal = Complex64::new(1.0, 0.0);
    /// let resolution = Resolution::Members;
    /// let square = Template { frequency_rad_per_s: 1.0, nominal, points: vec![], outlines: vec![outline], resolution };
    /// assert!((square.area_deg_db() - 90.0 * 20.0).abs() < 1e-9);
    /// ```
    pub fn area_deg_db(&self) -> f64 {
        self.outlines.iter().map(|outline| area(outline)).sum()
    }
}

/// Area within a closed polygon of responses, degrees times dB; its corners are less than half a
/// turn apart.
///
/// ```text
/// area = abs(sum of (phi_{k+1} - phi_k) (m_k + m_{k+1})/2)
/// ```
fn area(outline: &[Complex64]) -> f64 {
    let decibel = |response: &Complex64| 20.0 * portable::log10(portable::magnitude(*response));
    let next = outline.iter().cycle().skip(1);
    let part = |(one, other): (&Complex64, &Complex64)| {
        let turn = portable::argument(other / one).to_degrees();
        turn * 0.5 * (decibel(one) + decibel(other))
    };
    outline.iter().zip(next).map(part).sum::<f64>().abs()
}

/// One plant of a template.
#[derive(Clone, Debug, PartialEq)]
pub struct TemplatePoint {
    /// Index of the member in its family; `None` for a plant added by refinement.
    pub member: Option<usize>,
    /// Parameters of the plant; empty for a measured plant.
    pub values: Vec<f64>,
    /// Response P H, including delay and hold.
    pub response: Complex64,
    /// Load-motion path Pd; zero if there is no such path.
    pub load_motion: Complex64,
    /// Sensor H.
    pub sensor: Complex64,
}

/// Distance between neighbouring plants of a template.
#[derive(Clone, Debug, PartialEq)]
pub enum Resolution {
    /// Neighbours are closer than the tolerance everywhere along the outlines, and no witness is
    /// farther outside.
    Resolved {
        /// Largest distance of two neighbours, degrees.
        phase_deg: f64,
        /// Largest distance of two neighbours, dB.
        magnitude_db: f64,
    },
    /// A gap did not close (an undamped resonance inside the family never does), or the plants or
    /// rounds allowed are used up. The outlines contain the region found until then.
    NotResolved {
        /// Largest distance of two neighbours, degrees; 180 if a response is infinite or zero.
        phase_deg: f64,
        /// Largest distance of two neighbours, dB; infinite if a response is infinite or zero.
        magnitude_db: f64,
        /// Parameters of the plant next to the widest gap.
        near: Vec<f64>,
    },
    /// The family consists only of its members.
    Members,
}
