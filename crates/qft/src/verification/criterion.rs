//! One side of one requirement: a closed-loop magnitude and its upper or lower limit.

use crate::specification::{ClosedLoop, Limit, Specification};

/// Side of the limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MarginSide {
    /// Upper limit: magnitude <= limit.
    Below,
    /// Lower limit: magnitude >= limit.
    Above,
}

/// Criterion `magnitude <= limit` or `magnitude >= limit` of a closed loop over a band.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Criterion {
    pub(super) closed_loop: ClosedLoop,
    pub(super) side: MarginSide,
    pub(super) limit: Limit,
    /// The corresponding upper limit, for tracking.
    pub(super) upper: Option<Limit>,
    /// The band where it applies: that of the specification, as far as a table and the sampling
    /// extend, rad/s.
    pub(super) band: [f64; 2],
}

impl Criterion {
    /// True if it applies at this frequency.
    pub(super) fn demands(&self, frequency: f64) -> bool {
        self.band[0] <= frequency && frequency <= self.band[1]
    }
}

/// The criteria of a specification: two for tracking, one for all others.
pub(super) fn criteria(specification: &Specification, highest_frequency: f64) -> Vec<Criterion> {
    let requirement = &specification.requirement;
    let (lower, upper) = requirement.limits();
    let one = |side, limit: &Limit| Criterion {
        closed_loop: requirement.closed_loop(),
        side,
        limit: limit.clone(),
        upper: lower.is_some().then(|| upper.clone()),
        band: reach(limit, specification.band_rad_per_s, highest_frequency),
    };
    std::iter::once(one(MarginSide::Below, upper))
        .chain(lower.map(|lower| one(MarginSide::Above, lower)))
        .collect()
}

/// The part of a band in which the limit exists and the loop has a response; there is no limit if
/// an end is NaN.
fn reach(limit: &Limit, band: [f64; 2], highest_frequency: f64) -> [f64; 2] {
    if band.iter().any(|end| end.is_nan()) {
        return band;
    }
    let [from, to] = [band[0], band[1].min(highest_frequency)];
    match limit {
        Limit::Table(table) => {
            let ends = (table.points().first(), table.points().last());
            let (first, last) = ends.0.zip(ends.1).map_or((to, from), |(first, last)| (first.0, last.0));
            [from.max(first), to.min(last)]
        }
        Limit::Constant(_) | Limit::Rational(_) => [from, to],
    }
}
