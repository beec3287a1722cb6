//! Peak of the leakage, and commands at half of its height.

use phea_dynamics::order::sort_by_number;

use crate::estimate::Estimate;

/// Curve of the leakage: its base, its peak, and the noise of a row.
pub(super) struct Flank {
    pub(super) base: f64,
    pub(super) peak: f64,
    pub(super) noise: f64,
}

impl Flank {
    /// Height at this fraction of the distance from the base to the peak.
    pub(super) fn height(&self, fraction: f64) -> f64 {
        self.base + fraction * (self.peak - self.base)
    }

    /// Commands at which a branch, from below through its peak and below again, crosses half of its
    /// height.
    pub(super) fn half_height(&self, points: &[(f64, f64)]) -> Option<[Estimate; 2]> {
        let mut sorted = points.to_vec();
        sort_by_number(&mut sorted, |point| point.0);
        let ends = crossings(&sorted, self.height(0.5))?;
        let quarters = [0.25, 0.75].map(|fraction| crossings(&sorted, self.height(fraction)));
        let deviation = |side: usize| {
            let at = |fraction: usize| quarters.get(fraction)?.as_ref()?.get(side).copied();
            let run = at(0).zip(at(1)).map_or(f64::INFINITY, |(low, high)| (high - low).abs());
            self.noise * run / (0.5 * (self.peak - self.base))
        };
        let [low, high] = ends;
        Some([Estimate::of(low, deviation(0)), Estimate::of(high, deviation(1))])
    }
}

/// Commands at which a branch, in order of its commands, first rises above a height and last falls
/// below it.
fn crossings(sorted: &[(f64, f64)], height: f64) -> Option<[f64; 2]> {
    let is_above = |(_, leak): &(f64, f64)| *leak > height;
    let [first, last] = [sorted.iter().position(is_above)?, sorted.iter().rposition(is_above)?];
    let crossing = |outside: usize, inside: usize| {
        let ((x, low), (to, high)) = (sorted.get(outside)?, sorted.get(inside)?);
        Some(x + (height - low) / (high - low) * (to - x))
    };
    let ends = [crossing(first.checked_sub(1)?, first)?, crossing(last + 1, last)?];
    (ends[1] > ends[0]).then_some(ends)
}

/// Highest mean of a twenty-fourth of these rows, which are neighbours in the command.
pub(super) fn peak(points: &[(f64, f64)], noise: f64) -> Option<Estimate> {
    let mut sorted = points.to_vec();
    sort_by_number(&mut sorted, |point| point.0);
    let width = (sorted.len() / 24).max(1);
    let means =
        sorted.windows(width).map(|rows| rows.iter().map(|(_, leak)| leak).sum::<f64>() / width as f64);
    means.reduce(f64::max).map(|peak| Estimate::of(peak, noise / (width as f64).sqrt()))
}
