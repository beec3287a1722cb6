//! Margins of a loop that is known by its response.

use num_complex::Complex64;
use phea_dynamics::frequency::{GainMargin, Margins, ModulusMargin, PhaseMargin, logarithmic_grid};
use phea_dynamics::minimum::golden_section;
use phea_dynamics::portable::{argument, magnitude};
use phea_qft::closed_loop::Member;

use crate::robust::RobustProblem;

/// Number of frequencies of an even grid, before it is refined.
const GRID_POINTS: usize = 300;
/// Turn of L from one frequency to the next, rad, unless |L| is small.
const TURN_RAD: f64 = 0.3;
const SMALL_GAIN: f64 = 1e-3;
/// Number of golden sections by which the place of the least |1 + L| is narrowed.
const REFINEMENTS: usize = 50;
/// Ratio of two frequencies below which no more are inserted between them.
const CLOSEST: f64 = 1.0 + 1e-6;
/// Largest number of frequencies.
const POINTS_MAXIMUM: usize = 5000;

/// A frequency, rad/s, and L there.
pub(in crate::audit) type KnownPoint = (f64, Complex64);

/// Margins between the first and the last frequency at which the response is known; `None` for
/// fewer than two. Between the frequencies of a measurement the response is interpolated.
pub(super) fn margins(problem: &RobustProblem, member: &Member) -> Option<Margins> {
    let at = |frequency: f64| {
        let response = problem.response(member, frequency)?;
        let value = response.plant * response.sensor * response.controller;
        value.is_finite().then_some((frequency, value))
    };
    let points = points(problem, member, &at);
    let nearest = nearest(&points, &at)?;
    let pairs = || points.iter().zip(points.iter().skip(1));
    let of_gain = |(from, to): (&KnownPoint, &KnownPoint)| {
        let angle = |point: &KnownPoint| argument(-point.1);
        let passes = (angle(from) < 0.0) != (angle(to) < 0.0)
            && (angle(from) - angle(to)).abs() < std::f64::consts::PI;
        let (frequency_rad_per_s, value) = crossing(*from, *to, &at, &|point| angle(point) < 0.0)?;
        passes.then(|| GainMargin { frequency_rad_per_s, factor: 1.0 / magnitude(value) })
    };
    Some(Margins {
        gain_margins: pairs().filter_map(of_gain).collect(),
        phase_margins: phase_margins(&points, &at),
        modulus_margin: ModulusMargin { frequency_rad_per_s: nearest.0, distance: nearest.1 },
    })
}

/// Margins at which |L| passes 1 between neighbouring points.
pub(in crate::audit) fn phase_margins(
    points: &[KnownPoint],
    at: &dyn Fn(f64) -> Option<KnownPoint>,
) -> Vec<PhaseMargin> {
    let above = |point: &KnownPoint| magnitude(point.1) >= 1.0;
    let of_phase = |(from, to): (&KnownPoint, &KnownPoint)| {
        let (frequency_rad_per_s, value) = crossing(*from, *to, at, &above)?;
        let signed = argument(-value);
        let lag = if signed < 0.0 { signed + 2.0 * std::f64::consts::PI } else { signed };
        let delay_s = lag / frequency_rad_per_s;
        Some(PhaseMargin { frequency_rad_per_s, phase_deg: signed.to_degrees(), delay_s })
    };
    points.iter().zip(points.iter().skip(1)).filter_map(of_phase).collect()
}

/// Frequency of the least |1 + L|, and its value: the least of the points, refined between its
/// neighbours.
fn nearest(points: &[KnownPoint], at: &dyn Fn(f64) -> Option<KnownPoint>) -> Option<(f64, f64)> {
    let distance = |point: &KnownPoint| magnitude(1.0 + point.1);
    let least = (0..points.len()).min_by(|one, other| {
        let [one, other] = [one, other].map(|index| points.get(*index).map_or(f64::INFINITY, distance));
        one.total_cmp(&other)
    })?;
    let own = *points.get(least)?;
    let ends =
        [least.saturating_sub(1), least + 1].map(|index| points.get(index).map_or(own.0, |point| point.0));
    let of = |frequency: f64| at(frequency).as_ref().map_or(f64::INFINITY, distance);
    let refined = at(golden_section(ends, REFINEMENTS, of)).filter(|point| distance(point) < distance(&own));
    let found = refined.unwrap_or(own);
    Some((found.0, distance(&found)))
}

/// L at the frequencies of a measurement, or at as many as needed for L to turn little.
fn points(
    problem: &RobustProblem,
    member: &Member,
    at: &dyn Fn(f64) -> Option<KnownPoint>,
) -> Vec<KnownPoint> {
    let highest = problem.compensation.highest_frequency_rad_per_s();
    let frequencies = match member {
        Member::Measured { plant, .. } => plant.frequencies_rad_per_s.clone(),
        Member::Responding { plant, .. } => {
            let [from, to] = plant.range_rad_per_s();
            logarithmic_grid(1e-3 * from, to.min(highest), GRID_POINTS).unwrap_or_default()
        }
        _ => vec![],
    };
    let known = frequencies.into_iter().take_while(|&one| one <= highest);
    match member {
        Member::Responding { .. } => filled(known, at),
        _ => known.filter_map(at).collect(),
    }
}

/// Points at these frequencies, rising, and as many between them as needed for L to turn little.
pub(in crate::audit) fn filled(
    frequencies: impl Iterator<Item = f64>,
    at: &dyn Fn(f64) -> Option<KnownPoint>,
) -> Vec<KnownPoint> {
    let mut found: Vec<KnownPoint> = Vec::new();
    for end in frequencies.filter_map(at) {
        let mut ahead = vec![end];
        while let Some(&next) = ahead.last() {
            let middle = found.last().filter(|&&last| turns(last, next));
            let middle = middle.filter(|_| found.len() < POINTS_MAXIMUM);
            match middle.and_then(|last| at((last.0 * next.0).sqrt())) {
                Some(point) => ahead.push(point),
                None => found.extend(ahead.pop()),
            }
        }
    }
    found
}

/// True if L turns much from one point to the next.
fn turns(from: KnownPoint, to: KnownPoint) -> bool {
    let large = magnitude(from.1).max(magnitude(to.1)) > SMALL_GAIN;
    large && to.0 > CLOSEST * from.0 && argument(to.1 / from.1).abs() > TURN_RAD
}

/// Point between two others at which a condition changes; `None` if it does not.
fn crossing(
    from: KnownPoint,
    to: KnownPoint,
    at: &dyn Fn(f64) -> Option<KnownPoint>,
    holds: &dyn Fn(&KnownPoint) -> bool,
) -> Option<KnownPoint> {
    let first = holds(&from);
    if first == holds(&to) {
        return None;
    }
    let (mut low, mut high) = (from, to);
    for _ in 0..50 {
        let Some(middle) = at(0.5 * (low.0 + high.0)) else { break };
        if holds(&middle) == first { low = middle } else { high = middle }
    }
    Some(high)
}
