//! Figures of the audit: closed-loop magnitudes of the family against their limits.

use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;
use phea_qft::closed_loop::Member;
use phea_qft::specification::{Limit, Requirement, Specification};
use phea_qft::verification::{SpecificationFinding, Verdict, WorstCase};

use crate::answer::significant;
use crate::audit::{closed_loop_symbol, frequency_words, kind_key};
use crate::figure::{FamilyEnvelope, FamilyMagnitude, Figure, MagnitudeCurve, MagnitudeMark, Words};
use crate::robust::RobustProblem;

/// Number of members that are drawn, in addition to the worst.
pub(super) const DRAWN_MEMBERS: usize = 40;

/// How far beyond design frequencies and violations the figures reach.
const MARGIN_OF_FREQUENCY: f64 = 10.0;

/// The frequencies that a figure of this finding covers, rad/s.
pub(super) fn span(specification: &Specification, finding: &SpecificationFinding) -> [f64; 2] {
    let mut ends = specification.frequencies_rad_per_s.clone();
    ends.extend(finding.worst.iter().map(|worst| worst.frequency_rad_per_s));
    ends.extend(finding.violations.iter().flat_map(|band| band.band_rad_per_s));
    ends.retain(|frequency| *frequency > 0.0 && frequency.is_finite());
    let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let high = ends.iter().copied().fold(0.0, f64::max);
    if ends.is_empty() { [0.01, 1000.0] } else { [low / MARGIN_OF_FREQUENCY, high * MARGIN_OF_FREQUENCY] }
}

/// One figure for each specification that has a margin; the magnitudes of an unstable loop do not
/// describe a response.
pub(super) fn figures(
    problem: &RobustProblem,
    findings: &[SpecificationFinding],
    tolerance_db: f64,
) -> Result<Vec<Figure>, LinearError> {
    let members = problem.members()?;
    let numbered = problem.specifications.iter().zip(findings).enumerate();
    numbered
        .filter(|(_, (_, finding))| finding.worst.is_some())
        .map(|(index, (specification, finding))| {
            figure(problem, &members, index + 1, (specification, finding), tolerance_db)
        })
        .collect()
}

fn figure(
    problem: &RobustProblem,
    members: &[Member],
    number: usize,
    (specification, finding): (&Specification, &SpecificationFinding),
    tolerance_db: f64,
) -> Result<Figure, LinearError> {
    let requirement = &specification.requirement;
    let [from, to] = span(specification, finding);
    let mut frequencies = problem.drawn_frequencies(from, to);
    frequencies.extend(finding.envelope.iter().map(|point| point.0).filter(|w| (from..=to).contains(w)));
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup();
    let worst = finding.worst.as_ref().and_then(|worst| problem.member(&worst.plant));
    let mut curves: Vec<MagnitudeCurve> = members
        .iter()
        .chain(&worst)
        .map(|member| curve(problem, requirement, member, &frequencies))
        .collect();
    let greatest = extreme(&curves, f64::max);
    let least = requirement.limits().0.map(|_| extreme(&curves, f64::min));
    // the last is the worst plant
    let (last, step) = (curves.len().saturating_sub(1), curves.len() / DRAWN_MEMBERS + 1);
    let mut index = 0;
    curves.retain(|_| {
        index += 1;
        (index - 1) % step == 0 || index - 1 == last
    });
    let (lower, upper) = requirement.limits();
    let band = specification.band_rad_per_s;
    if let (Some(lower), false) = (lower, problem.has_prefilter) {
        let limits = [lower, upper].map(|limit| limit_curve(limit, band, &frequencies));
        let family = [least.unwrap_or_default(), greatest];
        return Ok(spread_figure(number, specification, finding, limits, family, tolerance_db));
    }
    let limit = |limit: &Limit| limit_curve(limit, band, &frequencies);
    let caption = format!(
        "{} of {} plants of the family (thin), the greatest{} of all members (thick), and the limit.",
        closed_loop_symbol(requirement),
        curves.len(),
        if lower.is_some() { " and the least" } else { "" }
    );
    let name = format!("audit_{number}_{}", kind_key(requirement));
    let chart = FamilyMagnitude {
        quantity: closed_loop_symbol(requirement).to_string(),
        upper_limit: Some(limit(upper)),
        lower_limit: lower.map(limit),
        envelopes: vec![FamilyEnvelope { name: String::new(), greatest, least }],
        members: curves,
        design_frequencies_rad_per_s: specification.frequencies_rad_per_s.clone(),
        tolerance_db,
        marks: finding.worst.iter().filter_map(|worst| mark(problem, requirement, finding, worst)).collect(),
        ..FamilyMagnitude::default()
    };
    let title = format!("Specification {number}, {}", problem.name_of(number - 1));
    Ok(chart.draw(&Words::new(name, title, caption)))
}

/// Tracking without a prefilter: the spread of the family against the allowed one.
fn spread_figure(
    number: usize,
    specification: &Specification,
    finding: &SpecificationFinding,
    limits: [MagnitudeCurve; 2],
    family: [MagnitudeCurve; 2],
    tolerance_db: f64,
) -> Figure {
    let allowed = quotient(limits);
    let mark = spread_mark(&allowed, finding);
    let chart = FamilyMagnitude {
        quantity: "max|T|/min|T|".to_string(),
        upper_limit: Some(allowed),
        envelopes: vec![FamilyEnvelope { greatest: quotient(family), ..FamilyEnvelope::default() }],
        design_frequencies_rad_per_s: specification.frequencies_rad_per_s.clone(),
        tolerance_db,
        marks: mark.into_iter().collect(),
        ..FamilyMagnitude::default()
    };
    let words = Words::new(
        format!("audit_{number}_tracking"),
        format!("Specification {number}, tracking by its spread"),
        "The greatest over the least |T| of the members, which no prefilter changes, and the upper over the lower limit.",
    );
    chart.draw(&words)
}

/// The second over the first.
pub(super) fn quotient([low, high]: [MagnitudeCurve; 2]) -> MagnitudeCurve {
    MagnitudeCurve {
        magnitudes: high.magnitudes.iter().zip(&low.magnitudes).map(|(high, low)| high / low).collect(),
        frequencies_rad_per_s: high.frequencies_rad_per_s,
    }
}

/// Where the spread is worst compared with the allowed one.
pub(super) fn spread_mark(allowed: &MagnitudeCurve, finding: &SpecificationFinding) -> Option<MagnitudeMark> {
    let worst = finding.worst.as_ref()?;
    let place = worst.frequency_rad_per_s;
    let index = allowed.frequencies_rad_per_s.partition_point(|&frequency| frequency < place);
    let is_violation = finding.verdict == Verdict::Violated;
    let word = if is_violation { "over" } else { "to spare" };
    Some(MagnitudeMark {
        frequency_rad_per_s: place,
        magnitude: allowed.magnitudes.get(index)?
            * portable::exp(-worst.margin_db / 20.0 * std::f64::consts::LN_10),
        text: distance_words(worst, word),
        is_violation,
    })
}

pub(super) fn curve(
    problem: &RobustProblem,
    requirement: &Requirement,
    member: &Member,
    frequencies: &[f64],
) -> MagnitudeCurve {
    let mut curve = MagnitudeCurve::default();
    for &frequency in frequencies {
        let Some(response) = problem.response(member, frequency) else { continue };
        curve.frequencies_rad_per_s.push(frequency);
        curve.magnitudes.push(portable::magnitude(requirement.closed_loop().response(&response)));
    }
    curve
}

pub(super) fn limit_curve(limit: &Limit, band: [f64; 2], frequencies: &[f64]) -> MagnitudeCurve {
    let within = frequencies.iter().filter(|frequency| (band[0]..=band[1]).contains(*frequency));
    let (frequencies_rad_per_s, magnitudes) =
        within.filter_map(|&frequency| Some((frequency, limit.magnitude(frequency)?))).unzip();
    MagnitudeCurve { frequencies_rad_per_s, magnitudes }
}

/// The extreme of all curves at the frequencies of the first; measured ones with a smaller range
/// are left out there.
pub(super) fn extreme(curves: &[MagnitudeCurve], choose: fn(f64, f64) -> f64) -> MagnitudeCurve {
    let mut extreme = curves.first().cloned().unwrap_or_default();
    let count = extreme.magnitudes.len();
    for curve in curves.iter().filter(|curve| curve.magnitudes.len() == count) {
        for (value, other) in extreme.magnitudes.iter_mut().zip(&curve.magnitudes) {
            *value = choose(*value, *other);
        }
    }
    extreme
}

/// Where a finding is worst, and by how much.
pub(super) fn mark(
    problem: &RobustProblem,
    requirement: &Requirement,
    finding: &SpecificationFinding,
    worst: &WorstCase,
) -> Option<MagnitudeMark> {
    let frequency = worst.frequency_rad_per_s;
    if !(frequency > 0.0 && frequency.is_finite()) {
        return None;
    }
    let member = problem.member(&worst.plant)?;
    let response = problem.response(&member, frequency)?;
    let magnitude = portable::magnitude(requirement.closed_loop().response(&response));
    let is_violation = finding.verdict == Verdict::Violated;
    let word = if is_violation {
        match requirement.limits() {
            (Some(_), upper) => {
                let below = upper.magnitude(frequency).is_some_and(|limit| decibels(magnitude / limit) < 0.0);
                if below { "short" } else { "over" }
            }
            (None, _) => "over",
        }
    } else {
        "to spare"
    };
    let text = distance_words(worst, word);
    Some(MagnitudeMark { frequency_rad_per_s: frequency, magnitude, text, is_violation })
}

/// `19.2 dB over at 1304 rad/s`; a value that cannot be distinguished from the limit is at the
/// limit.
fn distance_words(worst: &WorstCase, word: &str) -> String {
    const DISTINGUISHED_DB: f64 = 2e-3;
    let (size, place) = (worst.margin_db.abs(), frequency_words(worst.frequency_rad_per_s));
    if size < DISTINGUISHED_DB {
        return format!("at the limit {place}");
    }
    format!("{} dB {word} {place}", significant(size, 3))
}
