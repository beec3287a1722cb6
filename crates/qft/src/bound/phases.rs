//! Phases at which a bound is drawn: dense where it turns, sparse where it is straight.

use phea_dynamics::portable;

use super::function::BoundFunction;
use super::interval::GainIntervals;

/// Phases over [-2 pi, 0]: equally spaced, with more in between where a bound is not straight.
///
/// Halfway between two phases the bound is compared with the straight line in dB between its values
/// at both. Where it differs by more than the tolerance, or where an interval begins, ends or
/// splits, both halves are treated likewise, down to the finest spacing: a closed bound closes like
/// a square root, so that a gap of 1e-5 rad at its tip leaves 0.04 dB, whereas a grid of 5 degrees
/// is off by decibels. In addition, one phase is placed in every arc of phases that a plant forbids
/// and that would otherwise fall between two phases, so that no island is missed, however small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseGrid {
    /// Largest distance between two phases, rad. At most 100,000 equally spaced phases are used; if
    /// the spacing is not positive, only the two ends of the range are used.
    pub spacing_rad: f64,
    /// Largest deviation from a straight line between neighbours, dB; infinite for a plain grid.
    pub tolerance_db: f64,
    /// Distance between neighbours below which there is no refinement, rad.
    pub finest_rad: f64,
}

impl Default for PhaseGrid {
    /// Defaults: 2 degrees, 0.05 dB, 1e-5 rad.
    fn default() -> PhaseGrid {
        PhaseGrid { spacing_rad: 2.0_f64.to_radians(), tolerance_db: 0.05, finest_rad: 1e-5 }
    }
}

impl PhaseGrid {
    /// Equally spaced phases only, except for those that prevent a small island from being missed.
    ///
    /// # Example
    /// ```
    /// use phea_qft::bound::PhaseGrid;
    /// assert_eq!(PhaseGrid::uniform(5.0_f64.to_radians()).tolerance_db, f64::INFINITY);
    /// ```
    pub fn uniform(spacing_rad: f64) -> PhaseGrid {
        PhaseGrid { spacing_rad, tolerance_db: f64::INFINITY, finest_rad: spacing_rad }
    }
}

/// The gains forbidden by each of several functions at one phase, followed by their union.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PhaseSample {
    pub(super) phase_rad: f64,
    pub(super) forbidden: Vec<GainIntervals>,
}

/// Largest number of equally spaced phases.
const PHASES_MAXIMUM: f64 = 1e5;

/// The functions at the phases of the grid, in increasing order.
pub(super) fn sampled(grid: &PhaseGrid, functions: &[&BoundFunction]) -> Vec<PhaseSample> {
    let sample = |phase_rad: f64| {
        let mut forbidden: Vec<GainIntervals> =
            functions.iter().map(|function| function.forbidden(phase_rad)).collect();
        let union = forbidden.iter().flat_map(GainIntervals::intervals).copied().collect();
        forbidden.push(GainIntervals::union_of(union));
        PhaseSample { phase_rad, forbidden }
    };
    let mut samples = Vec::new();
    for phase_rad in phases(grid, functions) {
        let next = sample(phase_rad);
        if let Some(last) = samples.pop() {
            refine(grid, &sample, last, &next, &mut samples);
        }
        samples.push(next);
    }
    samples
}

/// Adds the sample at the lower phase and all that are needed between it and the sample at the
/// upper phase.
fn refine(
    grid: &PhaseGrid,
    sample: &impl Fn(f64) -> PhaseSample,
    left: PhaseSample,
    right: &PhaseSample,
    samples: &mut Vec<PhaseSample>,
) {
    let width = right.phase_rad - left.phase_rad;
    let half_way = left.phase_rad + width / 2.0;
    let between = left.phase_rad < half_way && half_way < right.phase_rad;
    if grid.tolerance_db == f64::INFINITY || width <= grid.finest_rad || !between {
        samples.push(left);
        return;
    }
    let middle = sample(half_way);
    let straight = left.forbidden.iter().zip(&middle.forbidden).zip(&right.forbidden);
    if straight.into_iter().all(|((left, middle), right)| is_straight(left, middle, right, grid.tolerance_db))
    {
        samples.push(left);
        return;
    }
    refine(grid, sample, left, &middle, samples);
    refine(grid, sample, middle, right, samples);
}

/// True if three unions have equally many intervals and each middle end is on the straight line
/// between its neighbours.
fn is_straight(
    left: &GainIntervals,
    middle: &GainIntervals,
    right: &GainIntervals,
    tolerance_db: f64,
) -> bool {
    let [left, middle, right] = [left, middle, right].map(GainIntervals::intervals);
    let ends = left.iter().flatten().zip(middle.iter().flatten()).zip(right.iter().flatten());
    left.len() == middle.len()
        && middle.len() == right.len()
        && ends.into_iter().all(|((left, middle), right)| {
            let ratio = (middle / left) * (middle / right);
            (left == middle && middle == right) || (10.0 * portable::log10(ratio)).abs() <= tolerance_db
        })
}

/// The equally spaced phases, and one within each narrow arc that has none.
fn phases(grid: &PhaseGrid, functions: &[&BoundFunction]) -> Vec<f64> {
    let turn = std::f64::consts::TAU;
    let count = if grid.spacing_rad > 0.0 {
        (turn / grid.spacing_rad).ceil().clamp(1.0, PHASES_MAXIMUM)
    } else {
        1.0
    };
    let spacing = turn / count;
    let mut phases: Vec<f64> = (0..=count as u32).rev().map(|step| -spacing * f64::from(step)).collect();
    let mut arcs: Vec<[f64; 2]> =
        functions.iter().flat_map(|function| function.narrow_arcs(spacing)).collect();
    arcs.retain(|[from, to]| (from / spacing).ceil() * spacing > *to);
    arcs.sort_unstable_by(|a, b| a[1].total_cmp(&b[1]));
    let mut last = f64::NEG_INFINITY;
    for [from, to] in arcs {
        if last < from {
            last = to;
            phases.push(to);
        }
    }
    phases.sort_unstable_by(f64::total_cmp);
    phases
}
