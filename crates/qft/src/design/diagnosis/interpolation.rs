//! Identity S + T = 1 in the right half plane, where the limits on the axis bound both functions.
//!
//! S and T of a stable loop are analytic and bounded there, so that at any point of it the
//! logarithm of their magnitude is at most the mean of its boundary values, weighted by harmonic
//! measure and reduced by the contribution of their zeros (Poisson and Jensen):
//!
//! ```text
//! |S(s0)| <= exp(m(ln|S|)) prod |s0 - p|/|s0 + conj p|                      p the unstable poles, where S = 0
//! |T(s0)| <= exp(m(ln|T|)) prod |s0 - z|/|s0 + conj z| e^(-Re(s0) T_d)      z the zeros, T_d the dead time
//! m(f) = (1/pi) integral of f(w) Re s0/|s0 - j w|^2 dw                      over the whole axis
//! ```
//!
//! It contains Bode's integral of the sensitivity, and its extension by Freudenberg and Looze
//! (1985).

use num_complex::Complex64;
use phea_dynamics::portable;

use super::candidate::PlantWithinLoop;
use super::ceiling::{Ceiling, Ceilings};
use super::finding::{Constraint, ConstraintPlace, Finding};
use super::plane::{Plane, fraction};

/// Least deficit that is not left to the search, 0.1 dB, since the discretisation error of the
/// cells can be as large.
const TOLERANCE: f64 = 0.0115;
/// Error of the cells elsewhere.
const ROUNDING: f64 = 1e-6;
/// Least peak that is reported, dB.
const PEAK_DB: f64 = 6.0;
/// Fraction of the axis that counts as zero.
const NOTHING: f64 = 1e-9;
/// Fraction of the axis below which a specification whose limit is the lowest there is not named.
const NAMED: f64 = 0.01;
/// Number of real points examined per decade.
const POINTS_PER_DECADE: f64 = 12.0;
const POINTS_MAXIMUM: f64 = 200.0;
const RELAXATION_MAXIMUM_DB: f64 = 400.0;

/// A point of the half plane.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spot {
    kind: LimitKind,
    at: Complex64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LimitKind {
    Pole,
    Zero,
    Point,
}

/// Limits at a point, without the fraction of the axis without a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Left {
    sensitivity: f64,
    complementary: f64,
    free: f64,
}

/// A point where the limits allow too little.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Deficit {
    spot: Spot,
    candidate: usize,
    left: Left,
    /// Logarithm of the deficit of |S| + |T|, over the free fraction if there is one.
    lack: f64,
}

impl Left {
    fn sum(&self) -> f64 {
        self.sensitivity + self.complementary
    }
}

/// Mean logarithms of the limits in each cell; infinite without a limit.
type LimitCurve = Vec<[f64; 2]>;

fn curve(ceilings: impl Iterator<Item = Ceiling>) -> LimitCurve {
    let nodes: Vec<[f64; 2]> = ceilings
        .map(|ceiling| [portable::ln(ceiling.sensitivity.limit), portable::ln(ceiling.complementary.limit)])
        .collect();
    let mean = |pair: &[[f64; 2]]| match pair {
        [one, other] => [(one[0] + other[0]) / 2.0, (one[1] + other[1]) / 2.0],
        _ => [f64::INFINITY; 2],
    };
    nodes.chunks(2).map(mean).collect()
}

fn left(
    curve: &LimitCurve,
    fractions: &[f64],
    candidate: &PlantWithinLoop,
    plane: Plane,
    at: Complex64,
) -> Left {
    let (mut sensitivity, mut complementary, mut free) = (0.0, 0.0, 0.0);
    for ([s, t], &fraction) in curve.iter().zip(fractions) {
        if fraction <= 0.0 {
            continue;
        }
        if *s < f64::INFINITY && *t < f64::INFINITY {
            sensitivity += fraction * s;
            complementary += fraction * t;
        } else {
            free += fraction;
        }
    }
    Left {
        sensitivity: portable::exp(sensitivity) * candidate.sensitivity_factor(at),
        complementary: portable::exp(complementary) * candidate.complementary_factor(plane, at),
        free,
    }
}

/// The worst impossibility at a pole, at a zero and elsewhere; if there is none, the highest
/// unavoidable peak.
pub(super) fn findings(ceilings: &Ceilings, candidates: &[PlantWithinLoop]) -> Vec<Finding> {
    let plane = ceilings.boundary.plane;
    let fractions = |at: Complex64| -> Vec<f64> {
        ceilings.boundary.cells.iter().map(|cell| fraction(at, *cell)).collect()
    };
    let points: Vec<(Spot, Vec<f64>)> = real_points(ceilings)
        .into_iter()
        .map(|at| (Spot { kind: LimitKind::Point, at }, fractions(at)))
        .collect();
    let mut deficits: Vec<Deficit> = Vec::new();
    let mut peaks: Vec<Deficit> = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        let curve = curve(ceilings.of(index, 1.0));
        let mut look = |spot: Spot, fractions: &[f64]| {
            let left = left(&curve, fractions, candidate, plane, spot.at);
            let lack = -portable::ln(left.sum());
            if left.free <= NOTHING {
                deficits.push(Deficit { spot, candidate: index, left, lack });
            } else {
                peaks.push(Deficit { spot, candidate: index, left, lack: lack / left.free });
            }
        };
        points.iter().for_each(|(spot, fractions)| look(*spot, fractions));
        for (kind, roots) in [(LimitKind::Pole, &candidate.poles), (LimitKind::Zero, &candidate.zeros)] {
            for &at in roots.iter().filter(|root| root.im >= 0.0) {
                look(Spot { kind, at }, &fractions(at));
            }
        }
    }
    let mut found = impossible(ceilings, candidates, &deficits);
    if found.is_empty() {
        found.extend(forced(ceilings, candidates, &peaks));
    }
    found
}

fn worst<'a>(deficits: impl Iterator<Item = &'a Deficit>) -> Option<&'a Deficit> {
    deficits.max_by(|a, b| a.lack.total_cmp(&b.lack))
}

fn impossible(ceilings: &Ceilings, candidates: &[PlantWithinLoop], deficits: &[Deficit]) -> Vec<Finding> {
    let busy = [0.0, ceilings.boundary.highest];
    let tolerance = |deficit: &Deficit| ROUNDING + TOLERANCE * fraction(deficit.spot.at, busy);
    let of_kind = |kind: LimitKind| {
        let lacking = deficits.iter().filter(|deficit| deficit.lack > tolerance(deficit));
        worst(lacking.filter(|deficit| deficit.spot.kind == kind))
    };
    let roots: Vec<&Deficit> = [LimitKind::Pole, LimitKind::Zero].into_iter().filter_map(of_kind).collect();
    let known = roots.iter().map(|deficit| deficit.lack).fold(0.0, f64::max);
    // a point is redundant next to a pole or a zero with the same finding
    let point = of_kind(LimitKind::Point).filter(|point| roots.is_empty() || point.lack > known + 0.1);
    roots
        .into_iter()
        .chain(point)
        .filter_map(|deficit| {
            let constraint = constraint(ceilings, candidates, deficit)?;
            Some(Finding::RightHalfPlane {
                relaxation_db: relaxation_db(ceilings, candidates.get(deficit.candidate)?, deficit),
                constraint,
            })
        })
        .collect()
}

fn forced(ceilings: &Ceilings, candidates: &[PlantWithinLoop], peaks: &[Deficit]) -> Option<Finding> {
    const NEPER_DB: f64 = 20.0 / std::f64::consts::LN_10;
    let highest = worst(peaks.iter().filter(|peak| peak.lack.is_finite()))?;
    let peak_db = highest.lack * NEPER_DB;
    if peak_db <= PEAK_DB {
        return None;
    }
    Some(Finding::ForcedPeak { constraint: constraint(ceilings, candidates, highest)?, peak_db })
}

/// The least relaxation under which |S| + |T| reaches 1 at the spot, by bisection.
fn relaxation_db(ceilings: &Ceilings, candidate: &PlantWithinLoop, deficit: &Deficit) -> f64 {
    let Deficit { spot, candidate: index, .. } = *deficit;
    let fractions: Vec<f64> = ceilings.boundary.cells.iter().map(|cell| fraction(spot.at, *cell)).collect();
    let enough = |relaxation_db: f64| {
        let factor = portable::pow(10.0, relaxation_db / 20.0);
        let curve = curve(ceilings.of(index, factor));
        left(&curve, &fractions, candidate, ceilings.boundary.plane, spot.at).sum() >= 1.0
    };
    least_relaxation_db(RELAXATION_MAXIMUM_DB, enough)
}

/// The least sufficient relaxation, to 1e-4 dB; infinite if the greatest is not sufficient.
pub(super) fn least_relaxation_db(greatest_db: f64, enough: impl Fn(f64) -> bool) -> f64 {
    if !enough(greatest_db) {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (0.0, greatest_db);
    while high - low > 1e-4 {
        let middle = (low + high) / 2.0;
        if enough(middle) { high = middle } else { low = middle }
    }
    high
}

fn constraint(ceilings: &Ceilings, candidates: &[PlantWithinLoop], deficit: &Deficit) -> Option<Constraint> {
    let Deficit { spot, candidate: index, left, .. } = *deficit;
    let candidate = candidates.get(index)?;
    let boundary = ceilings.boundary;
    let place = match spot.kind {
        LimitKind::Pole => {
            let all = candidate.poles.iter().zip(&candidate.unstable_poles);
            ConstraintPlace::UnstablePole(
                all.into_iter().find(|(image, _)| **image == spot.at).map(|pair| *pair.1)?,
            )
        }
        LimitKind::Zero => ConstraintPlace::RightHalfPlaneZero(boundary.plane.root(spot.at)),
        LimitKind::Point => ConstraintPlace::Point(boundary.plane.root(spot.at).re),
    };
    let mut fractions: Vec<(usize, f64)> = Vec::new();
    let mut crossover = None;
    let firsts = ceilings.of(index, 1.0).step_by(2);
    for (cell, ceiling) in boundary.cells.iter().zip(firsts) {
        let fraction = fraction(spot.at, *cell);
        let [sensitivity, complementary] = [spot.kind != LimitKind::Pole, spot.kind != LimitKind::Zero];
        let named = [(sensitivity, ceiling.sensitivity), (complementary, ceiling.complementary)];
        for specification in
            named.into_iter().filter_map(|(counts, one)| one.specification.filter(|_| counts))
        {
            match fractions.iter_mut().find(|(known, _)| *known == specification) {
                Some((_, sum)) => *sum += fraction,
                None => fractions.push((specification, fraction)),
            }
        }
        let crossed = match spot.kind {
            LimitKind::Pole => ceiling.complementary.limit >= 1.0,
            LimitKind::Zero => ceiling.sensitivity.limit < 1.0,
            LimitKind::Point => false,
        };
        if crossed {
            crossover = Some(boundary.plane.frequency(cell[1]));
        }
    }
    let mut specifications: Vec<usize> = fractions
        .into_iter()
        .filter(|(_, fraction)| *fraction >= NAMED)
        .map(|(specification, _)| specification)
        .collect();
    specifications.sort_unstable();
    Some(Constraint {
        place,
        plant: candidate.point.clone(),
        dead_time_s: candidate.delay_s(boundary.plane),
        sensitivity: left.sensitivity,
        complementary: left.complementary,
        crossover_rad_per_s: crossover.filter(|frequency| frequency.is_finite()),
        specifications,
    })
}

/// Real points over the range of the frequencies of interest; in a sampled loop up to the image of
/// z = infinity.
fn real_points(ceilings: &Ceilings) -> Vec<Complex64> {
    let cells = &ceilings.boundary.cells;
    let ends = cells.first().zip(cells.last()).map_or([1.0, 1.0], |(first, last)| [first[1], last[0]]);
    let greatest = ceilings.boundary.plane.image_of_delay().unwrap_or(f64::INFINITY);
    let [low, high] = [ends[0], ends[1].min(greatest)];
    let decades = portable::log10(high / low).max(0.0);
    let count = (decades * POINTS_PER_DECADE).ceil().clamp(1.0, POINTS_MAXIMUM);
    let step = decades * std::f64::consts::LN_10 / count;
    let inner = (0..count as u32).map(|index| low * portable::exp(step * f64::from(index)));
    let points = inner.chain([high]).map(|s| Complex64::new(s, 0.0));
    // the ends of the plane are not the image of any point
    points.filter(|at| ceilings.boundary.plane.root(*at).re.is_finite()).collect()
}
