//! Specifications of robust design from those of a project.

mod kind;
mod limit;
mod name;
mod rounding;

use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::LinearError;
use phea_dynamics::order::sorted_distinct;
use phea_qft::specification::{
    ClosedLoop, LimitError, MarginError, Requirement, RequirementCheck, RequirementOutcome, Specification,
    TimeDomainError,
};

pub use self::kind::{closed_loop_key, kind_key};
use self::limit::TrackingSide;
pub use self::name::{NamedSpecification, SpecificationName};
pub(crate) use self::rounding::of_rounding;
use crate::project::{self, FormulaError, Project};
use crate::quantity::significant;

/// Reason why a declared specification cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("[[specification]] {number}, `{key}`: {reason}")]
pub struct SpecificationError {
    /// Number in the file, from 1.
    pub number: usize,
    /// Key: `limit`, `upper` or `lower`.
    pub key: &'static str,
    /// Fault of the specification.
    pub reason: SpecificationProblem,
}

/// Fault of a limit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpecificationProblem {
    /// The limit is missing.
    #[error("this kind of specification needs it")]
    Missing,
    /// The text is not a ratio of polynomials.
    #[error("{message}", message = .0.message)]
    Formula(FormulaError),
    /// The polynomials do not form a transfer function.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// The table is invalid.
    #[error(transparent)]
    Table(#[from] LimitError),
    /// No limit guarantees the margins.
    #[error(transparent)]
    Margin(#[from] MarginError),
    /// The requirement in time has no limit, or the limit no response to check.
    #[error(transparent)]
    TimeDomain(#[from] TimeDomainError),
    /// The lower limit is above the upper one, so that no loop meets both.
    #[error(
        "the limits cross from {} to {} rad/s: at {} rad/s the lower one is {}, above the upper one, {}",
        significant(span_rad_per_s[0], 4), significant(span_rad_per_s[1], 4),
        significant(*frequency_rad_per_s, 4), significant(*lower, 3), significant(*upper, 3)
    )]
    Crossed {
        /// Frequency at which the lower limit is the most above the upper one, rad/s.
        frequency_rad_per_s: f64,
        /// Lower limit at this frequency.
        lower: f64,
        /// Upper limit at this frequency.
        upper: f64,
        /// Ends of the range around it in which they cross, rad/s, or ends of the band.
        span_rad_per_s: [f64; 2],
    },
    /// Margins are stated, which belong to another kind of specification.
    #[error("this kind of specification does not take margins")]
    TakesNoMargins,
    /// A requirement in time is stated, which belongs to another kind of specification.
    #[error("this kind of specification takes no requirement in time")]
    TakesNoRequirementInTime,
}

/// A limit of tracking that was stated in time, and its step response.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedRequirement {
    /// Number of the specification in the file, from 1.
    pub number: usize,
    /// Key: `upper` or `lower`.
    pub key: &'static str,
    /// Required and reached values.
    pub check: RequirementCheck,
    /// True if the limit follows from the requirement in time; otherwise it is stated, and only
    /// compared with it.
    pub follows: bool,
}

impl CheckedRequirement {
    /// True if the limit meets the requirement in time.
    pub fn is_met(&self) -> bool {
        self.check.outcome() == RequirementOutcome::Met
    }
}

/// Limits of a project on closed loops, in file order.
///
/// # Errors
/// [`SpecificationError`] for a limit that is absent or not a function of frequency.
///
/// # Example
/// ```
/// use phea_project::source::Memory;
/// let text = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s\"\n\
///             [[specification]]\nkind = \"sensitivity\"\nlimit = \"s/(s + 15)\"\nfrequencies = [1, 15]\n";
/// let source = Memory::default().with("servo.toml", text);
/// let project = phea_project::read(&source, "servo.toml", &[], &[])?.project;
/// let specifications = phea_engineering::specification::specifications(&project)?;
/// assert_eq!(specifications[0].band_rad_per_s, [1.0, 15.0]); // the span of the frequencies
/// let (_, limit) = specifications[0].requirement.limits();
/// assert!((limit.magnitude(15.0).unwrap() - 0.5_f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn specifications(project: &Project) -> Result<Vec<Specification>, SpecificationError> {
    closed_loops(project).map(|(number, kind, declared)| specification(declared, kind, number)).collect()
}

/// The specifications that limit a closed loop, with their numbers in the file, from 1.
pub(crate) fn closed_loops(
    project: &Project,
) -> impl Iterator<Item = (usize, ClosedLoop, &project::DeclaredSpecification)> {
    let all = project.specifications.iter().enumerate();
    all.filter_map(|(index, declared)| Some((index + 1, declared.closed_loop()?, declared)))
}

/// Every limit of tracking that was stated in time, compared with its requirement; in file order.
///
/// # Errors
/// [`SpecificationError`] for a requirement in time without a limit, or a limit whose step response
/// has no end.
///
/// # Example
/// The thesis' upper limit (6.28), given directly, and its intended response:
/// ```
/// use phea_project::source::Memory;
/// let text = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s\"\n\
///             [[specification]]\nkind = \"tracking\"\nfrequencies = [1]\nlower = 1e-3\n[specification.upper]\n\
///             numerator = \"2116*(s + 75)/75\"\ndenominator = \"s^2 + 73.6*s + 2116\"\n\
///             overshoot_percent = 1\nsettling_time = \"0.1 s\"\nsettling_band_percent = 1\n";
/// let source = Memory::default().with("servo.toml", text);
/// let project = phea_project::read(&source, "servo.toml", &[], &[])?.project;
/// let requirements_in_time = phea_engineering::specification::requirements_in_time(&project)?;
/// assert_eq!((requirements_in_time[0].number, requirements_in_time[0].key), (1, "upper"));
/// assert!((requirements_in_time[0].check.reached.overshoot_percent - 2.19).abs() < 0.005); // thesis: 1 %
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn requirements_in_time(project: &Project) -> Result<Vec<CheckedRequirement>, SpecificationError> {
    let mut checked = Vec::new();
    for (index, declared) in project.specifications.iter().enumerate() {
        let number = index + 1;
        for (key, side, limit) in
            [("upper", TrackingSide::Upper, &declared.upper), ("lower", TrackingSide::Lower, &declared.lower)]
        {
            if let Some(project::DeclaredLimit::Response(response)) = limit {
                let (_, check) = limit::of_requirement(response, side)
                    .map_err(|reason| SpecificationError { number, key, reason })?;
                checked.push(CheckedRequirement { number, key, check, follows: response.function.is_none() });
            }
        }
    }
    Ok(checked)
}

/// Limit that a declared specification makes, with its number for messages.
pub(crate) fn specification(
    declared: &project::DeclaredSpecification,
    kind: ClosedLoop,
    number: usize,
) -> Result<Specification, SpecificationError> {
    let found = |key: &'static str, limit: &Option<project::DeclaredLimit>, takes: limit::Takes| {
        let found = limit.as_ref().ok_or(SpecificationProblem::Missing);
        let found = found.and_then(|limit| limit::over_frequency(limit, takes));
        found.map_err(|reason| SpecificationError { number, key, reason })
    };
    let requirement = match kind {
        ClosedLoop::Tracking => Requirement::tracking(
            found("lower", &declared.lower, limit::Takes::RequirementInTime(TrackingSide::Lower))?,
            found("upper", &declared.upper, limit::Takes::RequirementInTime(TrackingSide::Upper))?,
        ),
        closed_loop => Requirement::at_most(
            closed_loop,
            found("limit", &declared.limit, limit::Takes::MarginsOf(closed_loop))?,
        ),
    };
    Ok(Specification {
        requirement,
        frequencies_rad_per_s: declared.frequencies.clone(),
        band_rad_per_s: declared.band_rad_per_s(),
    })
}

/// First specification whose lower limit is above its upper one: no loop meets it.
///
/// # Errors
/// [`SpecificationError`] for a limit that is absent or not a function of frequency.
pub fn crossed_limits(project: &Project) -> Result<Option<SpecificationError>, SpecificationError> {
    let crossed = |((number, ..), one): ((usize, ClosedLoop, _), &Specification)| {
        let reason = crossed(&one.requirement, &one.frequencies_rad_per_s, one.band_rad_per_s)?;
        Some(SpecificationError { number, key: "lower", reason })
    };
    Ok(closed_loops(project).zip(&specifications(project)?).find_map(crossed))
}

/// Relative crossing of the limits that counts as rounding.
const ROUNDING: f64 = 1e-6;
/// Number of frequencies of the band at which the limits are compared, in addition to those of the
/// design.
const COMPARED: usize = 200;

/// Frequency at which the lower limit is the most above the upper one, if they cross, rad/s.
fn crossed(
    requirement: &Requirement,
    frequencies: &[f64],
    [low, high]: [f64; 2],
) -> Option<SpecificationProblem> {
    let (Some(lower), upper) = requirement.limits() else { return None };
    let span = [low, high].map(|end| end.clamp(LEAST_FREQUENCY, MOST_FREQUENCY));
    let grid = logarithmic_grid(span[0], span[1], COMPARED).unwrap_or_default();
    let both = |frequency: f64| Some((frequency, lower.magnitude(frequency)?, upper.magnitude(frequency)?));
    let all: Vec<f64> = sorted_distinct(frequencies.iter().copied().chain(grid).collect());
    let crosses =
        |frequency: f64| both(frequency).is_some_and(|(_, lower, upper)| lower > upper * (1.0 + ROUNDING));
    let above = all.iter().filter(|frequency| crosses(**frequency)).filter_map(|frequency| both(*frequency));
    let worst = above.max_by(|one, other| (one.1 / one.2).total_cmp(&(other.1 / other.2)));
    worst.map(|(frequency_rad_per_s, lower, upper)| SpecificationProblem::Crossed {
        frequency_rad_per_s,
        lower,
        upper,
        span_rad_per_s: crossing_span(&all, frequency_rad_per_s, &crosses),
    })
}

/// Ends of the range around this frequency in which limits cross, by bisection between two of the
/// compared ones.
fn crossing_span(all: &[f64], inside: f64, crosses: &dyn Fn(f64) -> bool) -> [f64; 2] {
    let end = |mut others: Box<dyn Iterator<Item = f64> + '_>| {
        let mut crossing = inside;
        for other in &mut others {
            if crosses(other) {
                crossing = other;
                continue;
            }
            let mut outside = other;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (crossing + outside);
                if crosses(middle) { crossing = middle } else { outside = middle }
            }
            break;
        }
        crossing
    };
    let below = all.iter().copied().filter(|frequency| *frequency < inside).rev();
    let above = all.iter().copied().filter(|frequency| *frequency > inside);
    [end(Box::new(below)), end(Box::new(above))]
}

/// Number of bisections to find where limits begin to cross.
const HALVINGS: usize = 40;

/// Ends of the band over which limits are compared, rad/s.
const LEAST_FREQUENCY: f64 = 1e-4;
const MOST_FREQUENCY: f64 = 1e5;
