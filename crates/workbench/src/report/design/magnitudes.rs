//! The closed loops of the family with both controllers against each limit (thesis, Figure 6.15).

use phea_dynamics::linear::LinearError;
use phea_qft::closed_loop::Member;
use phea_qft::specification::{Requirement, Specification};

use super::super::closed_loops::{curve, extreme, limit_curve, mark, quotient, span, spread_mark};
use crate::audit::{closed_loop_symbol, kind_key};
use crate::design::{AuditedController, ProjectDesign};
use crate::figure::{FamilyEnvelope, FamilyMagnitude, Figure, MagnitudeCurve, MagnitudeMark, Words};

/// One loop that is drawn: its name, the side, and its plants.
struct Drawn<'a> {
    name: &'static str,
    side: &'a AuditedController,
    members: Vec<Member>,
}

/// One figure for each specification that the designed loop has a margin to.
pub(super) fn figures(view: &ProjectDesign) -> Result<Vec<Figure>, LinearError> {
    let sides = [("designed", Some(&view.designed)), ("given", view.published.as_ref())];
    let mut drawn = Vec::new();
    for (name, side) in sides {
        let Some(side) = side else { continue };
        drawn.push(Drawn { name, side, members: side.problem.members()? });
    }
    let specifications = view.designed.problem.specifications.iter().enumerate();
    Ok(specifications.filter_map(|(index, one)| figure(&drawn, index, one)).collect())
}

fn figure(drawn: &[Drawn<'_>], index: usize, specification: &Specification) -> Option<Figure> {
    // the magnitudes of an unstable loop do not describe a response
    let judged = |one: &&Drawn<'_>| finding(one.side, index).is_some_and(|finding| finding.worst.is_some());
    let seen: Vec<&Drawn<'_>> = drawn.iter().filter(judged).collect();
    let (first, others) = seen.split_first()?;
    let requirement = &specification.requirement;
    let title = first.side.view.name_of(index);
    let frequencies = frequencies(&seen, index, specification);
    let by_spread =
        requirement.limits().0.is_some() && seen.iter().any(|one| !one.side.problem.has_prefilter);
    let (lower, upper) = requirement.limits();
    let limit = |limit| limit_curve(limit, specification.band_rad_per_s, &frequencies);
    let (upper, lower) = match lower {
        Some(lower) if by_spread => (quotient([limit(lower), limit(upper)]), None),
        lower => (limit(upper), lower.map(limit)),
    };
    let envelope = |one: &Drawn<'_>| envelope(one, index, requirement, &frequencies, by_spread);
    let marks = seen.iter().filter_map(|one| {
        let found = finding(one.side, index)?;
        let mark = match by_spread {
            true => spread_mark(&upper, found).filter(|_| !one.side.problem.has_prefilter)?,
            false => mark(&one.side.problem, requirement, found, found.worst.as_ref()?)?,
        };
        Some(MagnitudeMark { text: format!("{}: {}", one.name, mark.text), ..mark })
    });
    let quantity = if by_spread { "max|T|/min|T|" } else { closed_loop_symbol(requirement) };
    let chart = FamilyMagnitude {
        quantity: quantity.to_string(),
        marks: marks.collect(),
        upper_limit: Some(upper),
        lower_limit: lower,
        envelopes: seen.iter().map(|one| envelope(one)).collect(),
        design_frequencies_rad_per_s: specification.frequencies_rad_per_s.clone(),
        tolerance_db: first.side.view.audit.tolerance_db,
        ..FamilyMagnitude::default()
    };
    Some(chart.draw(&words((index, title), requirement, quantity, others.is_empty(), by_spread)))
}

fn words(
    (index, name): (usize, &str),
    requirement: &Requirement,
    quantity: &str,
    alone: bool,
    by_spread: bool,
) -> Words {
    let number = index + 1;
    let whose = if alone { "the designed loop" } else { "both loops" };
    let extremes = match requirement.limits().0 {
        Some(_) if !by_spread => "The greatest and the least",
        _ => "The greatest",
    };
    let caption = format!("{extremes} {quantity} of the family in {whose}, compared with what is allowed.");
    let title = format!("Specification {number}, {name}, of {whose}");
    Words::new(format!("design_{number}_{}", kind_key(requirement)), title, caption)
}

fn finding(side: &AuditedController, index: usize) -> Option<&phea_qft::verification::SpecificationFinding> {
    side.view.audit.specifications.get(index)
}

/// The frequencies of the figures of the single loops, and those that their audits examined, rad/s.
fn frequencies(seen: &[&Drawn<'_>], index: usize, specification: &Specification) -> Vec<f64> {
    let spans = seen.iter().filter_map(|one| Some(span(specification, finding(one.side, index)?)));
    let [from, to] =
        spans.fold([f64::INFINITY, 0.0_f64], |all, one| [all[0].min(one[0]), all[1].max(one[1])]);
    let mut frequencies = Vec::new();
    for one in seen {
        frequencies.extend(one.side.problem.drawn_frequencies(from, to));
        let audited = finding(one.side, index).into_iter().flat_map(|found| &found.envelope);
        frequencies.extend(audited.map(|point| point.0).filter(|w| (from..=to).contains(w)));
    }
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup();
    frequencies
}

/// The extremes of all members and of the plant that its audit found worst.
fn envelope(
    one: &Drawn<'_>,
    index: usize,
    requirement: &Requirement,
    frequencies: &[f64],
    by_spread: bool,
) -> FamilyEnvelope {
    let problem = &one.side.problem;
    let worst = finding(one.side, index).and_then(|found| problem.member(&found.worst.as_ref()?.plant));
    let members = one.members.iter().chain(&worst);
    let curves: Vec<MagnitudeCurve> =
        members.map(|member| curve(problem, requirement, member, frequencies)).collect();
    let [least, greatest] = [extreme(&curves, f64::min), extreme(&curves, f64::max)];
    let name = one.name.to_string();
    match requirement.limits().0 {
        Some(_) if by_spread => FamilyEnvelope { name, greatest: quotient([least, greatest]), least: None },
        lower => FamilyEnvelope { name, greatest, least: lower.map(|_| least) },
    }
}
