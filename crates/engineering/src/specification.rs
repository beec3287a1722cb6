//! From the specifications of a project to those of robust design.

mod kind;
mod limit;
mod name;
mod rounding;

use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::LinearError;
use phea_dynamics::order::sorted_distinct;
use phea_qft::specification::{
    ClosedLoop, LimitError, MarginError, Requirement, Specification, TimeDomainError, WishCheck, WishOutcome,
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
    /// Its number in the file, from 1.
    pub number: usize,
    /// `limit`, `upper` or `lower`.
    pub key: &'static str,
    /// What is wrong with it.
    pub reason: SpecificationProblem,
}

/// What is wrong with a limit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpecificationProblem {
    /// It is not there.
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
    /// The wish in time has no limit, or the limit no response to check.
    #[error(transparent)]
    TimeDomain(#[from] TimeDomainError),
    /// The lower limit is above the upper one, so that no loop meets both.
    #[error(
        "the limits cross from {} to {} rad/s: at {} rad/s the lower one is {}, above the upper one, {}",
        significant(span_rad_per_s[0], 4), significant(span_rad_per_s[1], 4),
        significant(*frequency_rad_per_s, 4), significant(*lower, 3), significant(*upper, 3)
    )]
    Crossed {
        /// rad/s, where the lower one is the most above the other.
        frequency_rad_per_s: f64,
        /// There.
        lower: f64,
        /// There.
        upper: f64,
        /// The frequencies around it at which they cross, rad/s, or the ends of the band.
        span_rad_per_s: [f64; 2],
    },
    /// Margins, which belong to another kind of specification.
    #[error("this kind of specification does not take margins")]
    TakesNoMargins,
    /// A requirement in time, which belongs to another kind of specification.
    #[error("this kind of specification does not take a wish in time")]
    TakesNoWish,
}

/// A limit of tracking that was stated in time, and its own step response.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedWish {
    /// Number of the specification in the file, from 1.
    pub number: usize,
    /// `upper` or `lower`.
    pub key: &'static str,
    /// Wished and reached.
    pub check: WishCheck,
    /// Whether the limit follows from the wish; otherwise it is stated, and only compared with it.
    pub follows: bool,
}

impl CheckedWish {
    /// Whether the limit meets the wish.
    pub fn is_met(&self) -> bool {
        self.check.outcome() == WishOutcome::Met
    }
}

/// The limits of a project on closed loops, in file order.
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

/// Every limit of tracking that was stated in time, compared with its wish; in file order.
///
/// # Errors
/// [`SpecificationError`] for a wish without a limit, or a limit whose step response has no end.
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
/// let wishes = phea_engineering::specification::wishes(&project)?;
/// assert_eq!((wishes[0].number, wishes[0].key), (1, "upper"));
/// assert!((wishes[0].check.reached.overshoot_percent - 2.19).abs() < 0.005); // thesis: 1 %
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn wishes(project: &Project) -> Result<Vec<CheckedWish>, SpecificationError> {
    let mut checked = Vec::new();
    for (index, declared) in project.specifications.iter().enumerate() {
        let number = index + 1;
        for (key, side, limit) in
            [("upper", TrackingSide::Upper, &declared.upper), ("lower", TrackingSide::Lower, &declared.lower)]
        {
            if let Some(project::DeclaredLimit::Response(wish)) = limit {
                let (_, check) = limit::of_wish(wish, side).map_err(|reason| SpecificationError {
                    number,
                    key,
                    reason,
                })?;
                checked.push(CheckedWish { number, key, check, follows: wish.function.is_none() });
            }
        }
    }
    Ok(checked)
}

/// The limit that a declared specification makes, with its number for messages.
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
            found("lower", &declared.lower, limit::Takes::Wish(TrackingSide::Lower))?,
            found("upper", &declared.upper, limit::Takes::Wish(TrackingSide::Upper))?,
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

/// The first specification whose lower limit is above its upper one: no loop meets it.
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

/// How far the limits may cross, as a share: rounding.
const ROUNDING: f64 = 1e-6;
/// Frequencies of the band at which the limits are compared, in addition to those of the design.
const COMPARED: usize = 200;

/// The frequency at which the lower limit is the most above the upper one, if any.
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

/// The ends of the frequencies around this one at which limits cross, by halving between two of the
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

/// Halvings that find where limits begin to cross.
const HALVINGS: usize = 40;

/// Ends of the band over which limits are compared, rad/s.
const LEAST_FREQUENCY: f64 = 1e-4;
const MOST_FREQUENCY: f64 = 1e5;
