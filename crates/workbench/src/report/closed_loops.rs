//! Figures of the audit: closed-loop magnitudes of the family against their limits.

use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::LinearError;
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;
use phea_engineering::audit::ProjectAudit;
use phea_engineering::robust::RobustProblem;
use phea_engineering::specification::kind_key;
use phea_qft::closed_loop::Member;
use phea_qft::specification::{Limit, Requirement, Specification};
use phea_qft::verification::{SpecificationFinding, SpecificationMargin, Verdict};

use super::specifications::titled;
use crate::answer::significant;
use crate::audit::closed_loop_symbol;
use crate::figure::{FamilyEnvelope, FamilyMagnitude, Figure, MagnitudeCurve, MagnitudeMark, Words};
use crate::specification::name_words;
use crate::verdict_words::frequency_words;

/// Number of members that are drawn, in addition to the worst.
pub(super) const DRAWN_MEMBERS: usize = 40;

/// Factor by which the figures extend beyond design frequencies and violations.
const MARGIN_OF_FREQUENCY: f64 = 10.0;

/// The frequencies that a figure of this finding covers, rad/s.
fn span(specification: &Specification, finding: &SpecificationFinding) -> [f64; 2] {
    let mut ends = specification.frequencies_rad_per_s.clone();
    ends.extend(finding.worst.iter().map(|worst| worst.frequency_rad_per_s));
    ends.extend(finding.violations.iter().flat_map(|band| band.band_rad_per_s));
    ends.retain(|frequency| *frequency > 0.0 && frequency.is_finite());
    let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let high = ends.iter().copied().fold(0.0, f64::max);
    if ends.is_empty() { [0.01, 1000.0] } else { [low / MARGIN_OF_FREQUENCY, high * MARGIN_OF_FREQUENCY] }
}

/// The family of plants within one loop, and the findings of its audit.
pub(super) struct LoopFamily<'a> {
    /// Name of the loop; empty if there is only one.
    name: &'static str,
    problem: &'a RobustProblem,
    view: &'a ProjectAudit,
    members: Vec<Member>,
}

impl<'a> LoopFamily<'a> {
    pub(super) fn new(
        name: &'static str,
        problem: &'a RobustProblem,
        view: &'a ProjectAudit,
    ) -> Result<LoopFamily<'a>, LinearError> {
        Ok(LoopFamily { name, problem, view, members: problem.members()? })
    }

    /// The finding of the audit, if the specification has a margin: the magnitudes of an unstable
    /// loop do not describe a response.
    fn finding(&self, index: usize) -> Option<&SpecificationFinding> {
        self.view.audit.specifications.get(index).filter(|finding| finding.worst.is_some())
    }

    /// The curve of each plant, with the worst one of the audit as the last.
    fn curves(&self, index: usize, requirement: &Requirement, frequencies: &[f64]) -> Vec<MagnitudeCurve> {
        let worst = self.finding(index).and_then(|found| self.problem.member(&found.worst.as_ref()?.plant));
        let members = self.members.iter().chain(&worst);
        members.map(|member| curve(self.problem, requirement, member, frequencies)).collect()
    }

    fn mark(
        &self,
        index: usize,
        requirement: &Requirement,
        spread: Option<&MagnitudeCurve>,
    ) -> Option<MagnitudeMark> {
        let found = self.finding(index)?;
        let mark = match spread {
            Some(allowed) => spread_mark(allowed, found).filter(|_| !self.problem.has_prefilter)?,
            None => mark(self.problem, requirement, found, found.worst.as_ref()?)?,
        };
        let text = if self.name.is_empty() { mark.text } else { format!("{}: {}", self.name, mark.text) };
        Some(MagnitudeMark { text, ..mark })
    }
}

/// A specification in these loops, with every member in the first of them; true if it is shown by
/// the spread of the family, which a prefilter does not change. `None` if no loop has a margin to
/// it.
pub(super) fn magnitudes(
    loops: &[LoopFamily<'_>],
    index: usize,
    specification: &Specification,
) -> Option<(FamilyMagnitude, bool)> {
    let seen: Vec<&LoopFamily<'_>> = loops.iter().filter(|one| one.finding(index).is_some()).collect();
    let first = seen.first()?;
    let requirement = &specification.requirement;
    let frequencies = frequencies(&seen, index, specification);
    let (lower, upper) = requirement.limits();
    let by_spread = lower.is_some() && seen.iter().any(|one| !one.problem.has_prefilter);
    let limit = |limit| limit_curve(limit, specification.band_rad_per_s, &frequencies);
    let (upper_limit, lower_limit) = match lower {
        Some(lower) if by_spread => (quotient([limit(lower), limit(upper)]), None),
        lower => (limit(upper), lower.map(limit)),
    };
    let spread = by_spread.then_some(&upper_limit);
    let marks = seen.iter().filter_map(|one| one.mark(index, requirement, spread)).collect();
    let curves = seen.iter().map(|one| one.curves(index, requirement, &frequencies));
    let curves: Vec<Vec<MagnitudeCurve>> = curves.collect();
    let envelopes = seen.iter().zip(&curves).map(|(one, curves)| {
        let name = one.name.to_string();
        let [least, greatest] = [extreme(curves, f64::min), extreme(curves, f64::max)];
        match lower {
            Some(_) if by_spread => {
                FamilyEnvelope { name, greatest: quotient([least, greatest]), least: None }
            }
            lower => FamilyEnvelope { name, greatest, least: lower.map(|_| least) },
        }
    });
    let quantity = if by_spread { "max|T|/min|T|" } else { closed_loop_symbol(requirement) };
    let chart = FamilyMagnitude {
        quantity: quantity.to_string(),
        marks,
        envelopes: envelopes.collect(),
        upper_limit: Some(upper_limit),
        lower_limit,
        members: curves.into_iter().next().unwrap_or_default(),
        design_frequencies_rad_per_s: specification.frequencies_rad_per_s.clone(),
        tolerance_db: first.view.audit.tolerance_db,
    };
    Some((chart, by_spread))
}

/// The frequencies of the figures of the single loops, and those that their audits examined, rad/s.
fn frequencies(seen: &[&LoopFamily<'_>], index: usize, specification: &Specification) -> Vec<f64> {
    let spans = seen.iter().filter_map(|one| Some(span(specification, one.finding(index)?)));
    let [from, to] =
        spans.fold([f64::INFINITY, 0.0_f64], |all, one| [all[0].min(one[0]), all[1].max(one[1])]);
    let mut frequencies = Vec::new();
    for one in seen {
        frequencies.extend(one.problem.drawn_frequencies(from, to));
        let audited = one.finding(index).into_iter().flat_map(|found| &found.envelope);
        frequencies.extend(audited.map(|point| point.0).filter(|w| (from..=to).contains(w)));
    }
    sorted_distinct(frequencies)
}

/// A figure for each specification that has a margin.
pub(super) fn figures(problem: &RobustProblem, view: &ProjectAudit) -> Result<Vec<Figure>, LinearError> {
    let family = [LoopFamily::new("", problem, view)?];
    let specifications = problem.specifications.iter().enumerate();
    Ok(specifications.filter_map(|(index, one)| figure(&family, index, one)).collect())
}

fn figure(family: &[LoopFamily<'_>; 1], index: usize, specification: &Specification) -> Option<Figure> {
    let (mut chart, by_spread) = magnitudes(family, index, specification)?;
    let requirement = &specification.requirement;
    let problem = family[0].problem;
    let (title, caption) = if by_spread {
        chart.members.clear();
        let caption = "The greatest over the least |T| of the members, which no prefilter changes, and the upper over the lower limit.";
        ("tracking by its spread", caption.to_string())
    } else {
        thin_out(&mut chart.members);
        let caption = format!(
            "{} of {} plants of the family (thin), the greatest{} of all members (thick), and the limit.",
            closed_loop_symbol(requirement),
            chart.members.len(),
            if chart.lower_limit.is_some() { " and the least" } else { "" }
        );
        (name_words(problem.named(index)), caption)
    };
    let name = format!("audit_{}_{}", index + 1, kind_key(requirement));
    Some(chart.draw(&Words::new(name, titled(problem.number_of(index), title), caption)))
}

/// Thins out the curves; retains the last, which is that of the worst plant.
fn thin_out(curves: &mut Vec<MagnitudeCurve>) {
    let (last, step) = (curves.len().saturating_sub(1), curves.len() / DRAWN_MEMBERS + 1);
    let mut index = 0;
    curves.retain(|_| {
        index += 1;
        (index - 1) % step == 0 || index - 1 == last
    });
}

/// The second curve divided by the first.
fn quotient([low, high]: [MagnitudeCurve; 2]) -> MagnitudeCurve {
    MagnitudeCurve {
        magnitudes: high.magnitudes.iter().zip(&low.magnitudes).map(|(high, low)| high / low).collect(),
        frequencies_rad_per_s: high.frequencies_rad_per_s,
    }
}

/// A mark at the frequency at which the spread is worst relative to the allowed one.
fn spread_mark(allowed: &MagnitudeCurve, finding: &SpecificationFinding) -> Option<MagnitudeMark> {
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

fn curve(
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

fn limit_curve(limit: &Limit, band: [f64; 2], frequencies: &[f64]) -> MagnitudeCurve {
    let within = frequencies.iter().filter(|frequency| (band[0]..=band[1]).contains(*frequency));
    let (frequencies_rad_per_s, magnitudes) =
        within.filter_map(|&frequency| Some((frequency, limit.magnitude(frequency)?))).unzip();
    MagnitudeCurve { frequencies_rad_per_s, magnitudes }
}

/// The extreme of all curves at the frequencies of the first; measured ones with a smaller range
/// are left out there.
fn extreme(curves: &[MagnitudeCurve], choose: fn(f64, f64) -> f64) -> MagnitudeCurve {
    let mut extreme = curves.first().cloned().unwrap_or_default();
    let count = extreme.magnitudes.len();
    for curve in curves.iter().filter(|curve| curve.magnitudes.len() == count) {
        for (value, other) in extreme.magnitudes.iter_mut().zip(&curve.magnitudes) {
            *value = choose(*value, *other);
        }
    }
    extreme
}

/// A mark at the frequency of the worst finding, with the distance to the limit.
fn mark(
    problem: &RobustProblem,
    requirement: &Requirement,
    finding: &SpecificationFinding,
    worst: &SpecificationMargin,
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
fn distance_words(worst: &SpecificationMargin, word: &str) -> String {
    const DISTINGUISHED_DB: f64 = 2e-3;
    let (size, place) = (worst.margin_db.abs(), frequency_words(worst.frequency_rad_per_s));
    if size < DISTINGUISHED_DB {
        return format!("at the limit {place}");
    }
    format!("{} dB {word} {place}", significant(size, 3))
}
