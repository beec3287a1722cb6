//! Plants between those of a sampled family, needed if modes beyond half the sampling rate move.
//!
//! ```text
//! z = e^(pT):   while Im p moves by 2 pi/T, the sampled mode passes through the whole band, up and down
//! ```
//!
//! Between two plants that a search over the box compares, such a mode may pass every frequency.
//! Therefore the coordinates that move it are sampled in steps over which its phase changes by no
//! more than the width due to its damping. If this requires more plants than can be examined, no
//! claim is made about the plants in between.

use num_complex::Complex64;
use phea_dynamics::linear::Polynomial;
use phea_dynamics::portable;

use crate::family::UncertainFamily;

/// Factor of decay per sample below which a mode is too weak to fold.
const ALIVE: f64 = 0.01;
/// Angles by which a mode may turn from one plant to the next, rad: first for a mode without
/// damping, then the largest.
const TURNS: [f64; 2] = [0.04, 0.7];
/// Number of points of a line on which the roots are followed.
const POINTS: usize = 48;
/// Largest number of plants that may be added.
pub(super) const PLANTS_MAXIMUM: usize = 4000;

/// Half a pass of a mode through the band, as a fraction of a coordinate: two plants farther apart
/// belong to different passes.
const PASS: f64 = std::f64::consts::FRAC_PI_2;
/// Difference of fractions of an unmoved coordinate above which two plants count as distinct.
const APART: f64 = 0.3;

/// Additional plants to be examined, and true if there are enough for the modes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Folded {
    pub(super) plants: Vec<Vec<f64>>,
    pub(super) complete: bool,
    /// Least distance of two fractions of each coordinate at which searches from both may find
    /// different results.
    pub(super) apart: Vec<f64>,
}

/// Movement of a mode beyond half of the sampling rate along one coordinate.
#[derive(Clone, Copy, Debug, Default)]
struct Movement {
    /// Number of even steps that are short enough.
    steps: usize,
    /// Total change of phase, rad.
    turn: f64,
}

impl Folded {
    /// Result for a family without modes that fold.
    pub(super) fn none(dimension: usize) -> Folded {
        Folded { plants: Vec::new(), complete: true, apart: vec![APART; dimension] }
    }
}

/// Plants of a family on the grid of those coordinates that move a mode beyond pi/T, for each of
/// these fractions of the others.
pub(super) fn plants(family: &UncertainFamily, sample_time_s: f64, bases: &[Vec<f64>]) -> Folded {
    let dimension = family.coordinates().len();
    let movement = |coordinate: usize| {
        let along = bases.iter().map(|base| movement(family, sample_time_s, base, coordinate));
        along.max_by_key(|movement| movement.steps).unwrap_or_default()
    };
    let movements: Vec<Movement> = (0..dimension).map(movement).collect();
    let steps = |index: &usize| movements.get(*index).map_or(0, |movement| movement.steps);
    let moving: Vec<usize> = (0..dimension).filter(|index| steps(index) > 1).collect();
    if moving.is_empty() {
        return Folded::none(dimension);
    }
    let count = |index: &usize| steps(index) + 1;
    let grid = moving.iter().map(count).fold(1_usize, usize::saturating_mul);
    let mut fractions = Vec::new();
    if grid <= PLANTS_MAXIMUM {
        for base in bases.iter().take((PLANTS_MAXIMUM / grid).max(1)) {
            let start = vec![base.clone()];
            fractions
                .extend(moving.iter().fold(start, |plants, &index| along(&plants, index, count(&index))));
        }
    } else {
        let each = PLANTS_MAXIMUM / (moving.len() * bases.len().max(1));
        for base in bases {
            for &index in &moving {
                fractions.extend(along(std::slice::from_ref(base), index, count(&index).min(each)));
            }
        }
    }
    let mut plants: Vec<Vec<f64>> = fractions.iter().map(|fractions| family.values(fractions)).collect();
    plants.sort_by(|one, other| one.partial_cmp(other).unwrap_or(std::cmp::Ordering::Equal));
    plants.dedup();
    let apart = movements.iter().map(|one| if one.steps > 1 { (PASS / one.turn).min(APART) } else { APART });
    Folded { plants, complete: grid <= PLANTS_MAXIMUM, apart: apart.collect() }
}

/// Copies of each of these plants at this number of fractions of one coordinate.
fn along(plants: &[Vec<f64>], coordinate: usize, count: usize) -> Vec<Vec<f64>> {
    let last = count.saturating_sub(1).max(1) as f64;
    let mut all = Vec::with_capacity(plants.len() * count);
    for plant in plants {
        for step in 0..count {
            let mut fractions = plant.clone();
            if let Some(fraction) = fractions.get_mut(coordinate) {
                *fraction = step as f64 / last;
            }
            all.push(fractions);
        }
    }
    all
}

/// Movement along one coordinate, for the mode that needs the most steps.
fn movement(family: &UncertainFamily, sample_time_s: f64, base: &[f64], coordinate: usize) -> Movement {
    let modes = |point: usize| {
        let mut fractions = base.to_vec();
        if let Some(fraction) = fractions.get_mut(coordinate) {
            *fraction = point as f64 / POINTS as f64;
        }
        modes(family, sample_time_s, &fractions)
    };
    let (mut total, mut turn) = (0.0, 0.0);
    let mut largest: f64 = 0.0;
    let mut before = modes(0);
    for point in 1..=POINTS {
        let here = modes(point);
        let turns = before.iter().filter_map(|from| {
            let distance = |mode: &Complex64| portable::magnitude(mode - from);
            let to = here.iter().min_by(|one, other| distance(one).total_cmp(&distance(other)))?;
            let beyond = from.im.abs().max(to.im.abs()) > std::f64::consts::PI;
            let radius = portable::exp(from.re.max(to.re).min(0.0));
            let allowed = (1.0 - radius).clamp(TURNS[0], TURNS[1]);
            let turned = (from.im - to.im).abs();
            (beyond && radius > ALIVE).then_some((turned / allowed, turned))
        });
        let (steps, turned) =
            turns.fold((0.0, 0.0), |most: (f64, f64), next| if next.0 > most.0 { next } else { most });
        total += steps;
        turn += turned;
        largest = largest.max(steps);
        before = here;
    }
    // the steps are even: they must also be short enough where the phase of the mode changes
    // fastest
    let even = (largest * POINTS as f64).max(total).ceil();
    Movement { steps: if total > 1.0 { even.min(1e9) as usize } else { 0 }, turn }
}

/// The upper poles of the pairs, multiplied by T.
fn modes(family: &UncertainFamily, sample_time_s: f64, fractions: &[f64]) -> Vec<Complex64> {
    let Some(plant) = family.plant().coefficients(&family.values(fractions)) else { return Vec::new() };
    let roots = Polynomial::new(plant.command.denominator).roots().unwrap_or_default();
    let upper = roots.into_iter().filter(|root| root.im > 0.0).map(|root| root * sample_time_s);
    upper.filter(|mode| mode.is_finite()).collect()
}
