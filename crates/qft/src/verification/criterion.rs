//! One side of one requirement: a closed-loop magnitude and what it must stay below, or above.

use crate::specification::{Limit, Requirement, Specification};

/// A closed-loop magnitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// |L/(1+L)|
    Complementary,
    /// |1/(1+L)|
    Sensitivity,
    /// |P/(1+L)|
    PlantInput,
    /// |G/(1+L)|
    Effort,
    /// |Pd/(1+L)|
    LoadMotion,
    /// |F P G/(1+L)|
    Tracking,
}

/// On which side of its limit the quantity must stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// quantity <= limit
    Below,
    /// quantity >= limit
    Above,
}

/// `quantity <= limit` or `quantity >= limit` over a band.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Criterion {
    pub(super) quantity: Quantity,
    pub(super) side: Side,
    pub(super) limit: Limit,
    /// The upper limit beside it, for tracking.
    pub(super) upper: Option<Limit>,
    /// Where it is demanded: the band of the specification, as far as a table and the sampling reach, rad/s.
    pub(super) band: [f64; 2],
}

impl Criterion {
    /// Whether anything is demanded at this frequency.
    pub(super) fn demands(&self, frequency: f64) -> bool {
        self.band[0] <= frequency && frequency <= self.band[1]
    }
}

/// The criteria of a specification: two for tracking, one for all others.
pub(super) fn criteria(specification: &Specification, highest_frequency: f64) -> Vec<Criterion> {
    let one = |quantity, side, limit: &Limit| {
        let band = reach(limit, specification.band_rad_per_s, highest_frequency);
        let upper = match &specification.requirement {
            Requirement::Tracking { upper, .. } => Some(upper.clone()),
            _ => None,
        };
        Criterion { quantity, side, limit: limit.clone(), upper, band }
    };
    match &specification.requirement {
        Requirement::RobustStability(limit) => vec![one(Quantity::Complementary, Side::Below, limit)],
        Requirement::Sensitivity(limit) => vec![one(Quantity::Sensitivity, Side::Below, limit)],
        Requirement::PlantInputDisturbance(limit) => vec![one(Quantity::PlantInput, Side::Below, limit)],
        Requirement::ControlEffort(limit) => vec![one(Quantity::Effort, Side::Below, limit)],
        Requirement::LoadMotion(limit) => vec![one(Quantity::LoadMotion, Side::Below, limit)],
        Requirement::Tracking { lower, upper } => {
            vec![one(Quantity::Tracking, Side::Below, upper), one(Quantity::Tracking, Side::Above, lower)]
        }
    }
}

/// The part of a band in which the limit exists and the loop has a response; an end that is no number demands nothing.
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
