//! 95 % intervals by linearisation, of coefficients that may vanish too.

use phea_dynamics::least_squares::{Linearised, Settings, Uncertainty, uncertainty};
use phea_dynamics::portable;
use phea_hydraulics::servovalve::StaticCoefficients;

use super::variables::{COUNT, Kind, Variables};

/// Half width of a 95 % interval of a normal distribution, in standard deviations.
const NORMAL_95: f64 = 1.96;

/// Half width, over the change that matters, beyond which an interval carries no information: a
/// factor of a million.
const NOTHING_SAID: f64 = 14.0;

/// How well the recordings determine the coefficients: in changes that matter, see
/// [`Variables::scales`].
pub(super) fn told(
    at: &Linearised,
    groups: &[usize],
    variables: &Variables,
    coefficients: &StaticCoefficients,
) -> Uncertainty {
    let scales = variables.scales(coefficients);
    let slopes = variables.slopes(coefficients);
    let mut factors = scales;
    for (factor, slope) in factors.iter_mut().zip(slopes) {
        *factor /= slope;
    }
    let mut at = at.clone();
    for row in at.jacobian.chunks_exact_mut(COUNT) {
        for (slope, factor) in row.iter_mut().zip(factors) {
            *slope *= factor;
        }
    }
    uncertainty(&at, groups, COUNT, Settings::default().robust_beyond)
}

/// The interval of each coefficient, from its standard deviation over the change that matters.
///
/// For a positive coefficient both ends are positive. For one that may vanish the negative part of
/// the interval is cut off: where its lower end is zero, the interval is an upper bound.
pub(super) fn intervals(
    variables: &Variables,
    coefficients: &StaticCoefficients,
    deviations: &[f64],
) -> [Option<[f64; 2]>; COUNT] {
    let scales = variables.scales(coefficients);
    let mut found = [None; COUNT];
    let all = found.iter_mut().zip(coefficients.to_array()).zip(scales).zip(deviations);
    for (index, (((found, number), scale), deviation)) in all.enumerate() {
        let half = NORMAL_95 * deviation;
        let ends = [-half, half].map(|by| match Kind::of(index) {
            Kind::Positive => number * portable::exp(by),
            Kind::MayVanish => (number + by * scale).max(0.0),
            Kind::EitherSign => number + by * scale,
        });
        *found = (half < NOTHING_SAID).then_some(ends);
    }
    found
}
