//! Facts that are impossible or hard for a controller, in sentences.

use std::f64::consts::TAU;
use std::fmt::{Display, Formatter, Result};

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_engineering::design::{ExplainedFact, ExplainedLimit, Explanation, limit_key};
use phea_qft::design::{Constraint, ConstraintPlace, Finding};
use phea_qft::verification::SpecificationMargin;

use crate::limit_kind::limit_words;
use crate::specification::stated;

/// The sentence of an explanation.
pub fn explanation_sentence(explanation: &Explanation) -> String {
    match &explanation.fact {
        ExplainedFact::FeedbackNotRequired => NO_FEEDBACK_REQUIRED.to_string(),
        ExplainedFact::Finding(finding) => {
            let name_of = |index: usize| {
                let named = explanation.limits.iter().find(|(known, _)| *known == index);
                named.map_or(String::new(), |(_, limit)| limit_name(limit))
            };
            FindingWords { finding, name_of: &name_of }.to_string()
        }
    }
}

const NO_FEEDBACK_REQUIRED: &str = "nothing requires feedback: the plants of the family differ by less than the limits on tracking allow, so that a prefilter alone could keep them; add a `sensitivity` or a `load_motion`, which say how much of a disturbance may remain";

fn limit_name(limit: &ExplainedLimit) -> String {
    match limit {
        ExplainedLimit::Specification(named) => stated(Some(*named)),
        ExplainedLimit::Design(kind) if kind.has_key() => format!("the limit `design.{}`", limit_key(*kind)),
        ExplainedLimit::Design(kind) => format!("the limit on the {}", limit_words(*kind)),
    }
}

/// A number rounded to four significant digits, for a reader.
fn rounded(value: f64) -> f64 {
    portable::rounded(value, 4)
}

/// The names of specifications by their indices.
type Names<'a> = &'a dyn Fn(usize) -> String;

/// A finding as a sentence.
struct FindingWords<'a> {
    finding: &'a Finding,
    /// The name of a specification by its index.
    name_of: Names<'a>,
}

impl Display for FindingWords<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let FindingWords { finding, name_of } = *self;
        match finding {
            Finding::CrossedLimits { specification, frequency_rad_per_s, lower, upper, relaxation_db } => {
                write!(
                    f,
                    "tracking cannot be met: at {} rad/s the lower limit {} of {} lies above its upper one {}; {} dB on both sides would \
                 bring them together",
                    rounded(*frequency_rad_per_s),
                    rounded(*lower),
                    name_of(*specification),
                    rounded(*upper),
                    rounded(*relaxation_db)
                )
            }
            Finding::SumBelowOne {
                frequency_rad_per_s, sensitivity, complementary, relaxation_db, ..
            } => write!(
                f,
                "no loop meets {} and {} together: at {} rad/s they leave |S| <= {} and |T| <= {}, but S + T = 1; {}",
                name_of(sensitivity.specification),
                name_of(complementary.specification),
                rounded(*frequency_rad_per_s),
                rounded(sensitivity.limit),
                rounded(complementary.limit),
                relaxed(*relaxation_db)
            ),
            Finding::Contradiction { frequency_rad_per_s, phase_rad, gain, conflicts, relaxation_db } => {
                contradiction(
                    f,
                    *frequency_rad_per_s,
                    [*phase_rad, *gain],
                    (conflicts, name_of),
                    *relaxation_db,
                )
            }
            Finding::RightHalfPlane { constraint, relaxation_db } => {
                constrained(f, constraint, name_of).and_then(|()| write!(f, "; {}", relaxed(*relaxation_db)))
            }
            Finding::ForcedPeak { constraint, peak_db } if constraint.specifications.is_empty() => write!(
                f,
                "whatever the controller, {} with the plant's other poles, zeros and dead time in the right half plane raises |S| or |T| to {} dB",
                place(constraint.place),
                rounded(*peak_db)
            ),
            Finding::ForcedPeak { constraint, peak_db } => {
                constrained(f, constraint, name_of)?;
                write!(
                    f,
                    ", unless |S| or |T| rises to {} dB where no specification limits them",
                    rounded(*peak_db)
                )
            }
            Finding::PoleOnTheAxis { .. }
            | Finding::ZeroOnTheAxis { .. }
            | Finding::GainSign { .. }
            | Finding::DelayMargin { .. }
            | Finding::UnstableController { .. }
            | Finding::OutOfReach { .. }
            | Finding::StaticGain { .. } => of_the_plants(finding, name_of, f),
        }
    }
}

fn of_the_plants(finding: &Finding, name_of: Names<'_>, f: &mut Formatter<'_>) -> Result {
    match finding {
        Finding::PoleOnTheAxis { frequency_rad_per_s, complementary, .. } => write!(
            f,
            "the plant has a pole at {} rad/s on the axis, where T = 1: {} allows only {}",
            rounded(*frequency_rad_per_s),
            name_of(complementary.specification),
            rounded(complementary.limit)
        ),
        Finding::ZeroOnTheAxis { frequency_rad_per_s, limit, .. } => write!(
            f,
            "the plant passes nothing at {} rad/s, where S = 1 and F T = 0: the limit {} of {} cannot be kept",
            rounded(*frequency_rad_per_s),
            rounded(limit.limit),
            name_of(limit.specification)
        ),
        Finding::GainSign { pole_rad_per_s: 0.0, .. } => write!(
            f,
            "the static gain changes its sign over the family: with integral action no controller stabilises plants of both signs"
        ),
        Finding::GainSign { pole_rad_per_s, .. } => write!(
            f,
            "the plants share the unstable pole {} rad/s, but not the sign of their gain there: no controller stabilises both signs",
            rounded(*pole_rad_per_s)
        ),
        Finding::DelayMargin { pole_rad_per_s, demanded_s, greatest_s, .. } => write!(
            f,
            "a plant with an unstable pole at {} rad/s tolerates less than {} s of delay with any controller: {} s are required",
            rounded(*pole_rad_per_s),
            rounded(*greatest_s),
            rounded(*demanded_s)
        ),
        Finding::UnstableController { between_zeros_rad_per_s: [low, high], .. } => write!(
            f,
            "an odd number of unstable poles lies between the plant's zeros at {} and {} rad/s: only a controller that is unstable itself \
             stabilises it",
            rounded(*low),
            rounded(*high)
        ),
        Finding::OutOfReach { specification, frequency_rad_per_s, reach_rad_per_s: [from, to], plant } => {
            write!(
                f,
                "the design frequency {} rad/s of {} lies outside of {}, {} to {} rad/s: nothing is known there",
                rounded(*frequency_rad_per_s),
                name_of(*specification),
                if plant.is_some() { "what was measured" } else { "the frequencies of a sampled loop" },
                rounded(*from),
                rounded(*to)
            )
        }
        Finding::StaticGain { specification, lower, upper } => write!(
            f,
            "at zero frequency {} requires {} to {} of the reference, which excludes 1: the output will not follow it",
            name_of(*specification),
            rounded(*lower),
            rounded(*upper)
        ),
        _ => Ok(()),
    }
}

fn names(specifications: &[usize], name_of: Names<'_>) -> String {
    let all: Vec<String> = specifications.iter().map(|index| name_of(*index)).collect();
    match all.as_slice() {
        [] => "no specification".to_string(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn relaxed(relaxation_db: f64) -> String {
    if relaxation_db.is_finite() {
        format!("less than {} dB more on every limit would not suffice", rounded(relaxation_db))
    } else {
        "no relaxation of the limits would suffice".to_string()
    }
}

fn contradiction(
    f: &mut Formatter<'_>,
    frequency: f64,
    [phase_rad, gain]: [f64; 2],
    (conflicts, name_of): (&[SpecificationMargin], Names<'_>),
    [low, high]: [f64; 2],
) -> Result {
    let specifications: Vec<usize> = conflicts.iter().map(|margin| margin.specification).collect();
    write!(f, "at {} rad/s the bounds leave no loop", rounded(frequency))?;
    if !high.is_finite() {
        return write!(f, ", however far the limits are relaxed");
    }
    write!(
        f,
        ": {} collide, least at {} degrees and a nominal gain of {}; ",
        names(&specifications, name_of),
        rounded(phase_rad / TAU * 360.0),
        rounded(gain)
    )?;
    write!(f, "every limit would need {} to {} dB more", rounded(low), rounded(high))
}

fn constrained(f: &mut Formatter<'_>, constraint: &Constraint, name_of: Names<'_>) -> Result {
    let Constraint { dead_time_s, sensitivity, complementary, crossover_rad_per_s, .. } = constraint;
    let by = names(&constraint.specifications, name_of);
    let leave = if constraint.specifications.len() == 1 { "leaves" } else { "leave" };
    let delay = if *dead_time_s > 0.0 {
        format!(", dead time of {} s included", rounded(*dead_time_s))
    } else {
        String::new()
    };
    let (sensitivity, complementary) = (rounded(*sensitivity), rounded(*complementary));
    match constraint.place {
        ConstraintPlace::UnstablePole(pole) => {
            write!(f, "the unstable pole at {} rad/s demands |T| = 1 there, and {by}", root(pole))?;
            if let Some(crossover) = crossover_rad_per_s {
                write!(f, ", with |T| below 1 above {} rad/s,", rounded(*crossover))?;
            }
            write!(f, " {leave} at most {complementary}{delay}")
        }
        ConstraintPlace::RightHalfPlaneZero(zero) => {
            write!(
                f,
                "the zero at {} rad/s in the right half plane demands |S| = 1 there, and {by}",
                root(zero)
            )?;
            if let Some(crossover) = crossover_rad_per_s {
                write!(f, ", with |S| below 1 up to {} rad/s,", rounded(*crossover))?;
            }
            write!(f, " {leave} at most {sensitivity}")
        }
        ConstraintPlace::Point(s) => write!(
            f,
            "S + T = 1 holds at s = {} rad/s too, and there {by} {leave} at most |S| = {sensitivity} and |T| = {complementary}{delay}",
            rounded(s)
        ),
    }
}

fn place(place: ConstraintPlace) -> String {
    match place {
        ConstraintPlace::UnstablePole(pole) => format!("the unstable pole at {} rad/s", root(pole)),
        ConstraintPlace::RightHalfPlaneZero(zero) => format!("the zero at {} rad/s", root(zero)),
        ConstraintPlace::Point(s) => format!("S + T = 1 at s = {} rad/s", rounded(s)),
    }
}

fn root(root: Complex64) -> String {
    if root.im == 0.0 {
        format!("{}", rounded(root.re))
    } else {
        format!("{} +- {}i", rounded(root.re), rounded(root.im.abs()))
    }
}
