//! Discs that contain all responses simultaneously, from discs that contain one response each.
//!
//! ```text
//! r_all^2 = F(2, m; 0.05/n) sigma^2           n rows, each outside with 0.05/n: all inside with at least 95 %
//! F(2, m; p) = (m/2) (p^(-2/m) - 1)           r^2 = F(2, m; 0.05) sigma^2 states m
//! ```
//!
//! A verdict depends on every row: of a hundred discs of 95 %, five do not contain their response.

use phea_dynamics::portable;

/// Probability that a disc does not contain its response.
const OUTSIDE: f64 = 0.05;
/// Largest m/2 that is distinguished from a normal distribution.
const HALF_MAXIMUM: f64 = 1e6;
/// Number of bisections in the search for m.
const HALVINGS: usize = 80;

/// Radii widened to contain all responses simultaneously with 95 %; the standard deviations
/// determine the number of blocks of each, and without them the error is assumed to be normal.
pub(super) fn of_all_rows(radii: &[f64], deviations: Option<&Vec<f64>>) -> Vec<f64> {
    let outside = OUTSIDE / radii.len().max(1) as f64;
    let widened = |(row, radius): (usize, &f64)| {
        let deviation = deviations.and_then(|all| all.get(row)).copied();
        let ratio = deviation.map_or(f64::NAN, |deviation| radius / deviation);
        let half = half_of(ratio * ratio);
        radius * (quantile(half, outside) / quantile(half, OUTSIDE)).sqrt()
    };
    radii.iter().enumerate().map(widened).collect()
}

/// Standard deviation of each row's error: from the columns, or of a normal distribution with these
/// radii.
///
/// ```text
/// r^2 = F(2, infinity; 0.05) sigma^2 = -ln(0.05) sigma^2
/// ```
pub(super) fn deviations(radii: &[f64], stated: Option<&Vec<f64>>) -> Vec<f64> {
    let normal = (-portable::ln(OUTSIDE)).sqrt();
    stated.cloned().unwrap_or_else(|| radii.iter().map(|radius| radius / normal).collect())
}

/// Quantile F(2, 2 half; p).
fn quantile(half: f64, outside: f64) -> f64 {
    half * (portable::pow(outside, -1.0 / half) - 1.0)
}

/// Half the number of degrees of freedom at which the quantile of 95 % has this value; that of the
/// normal distribution if the value is less.
fn half_of(value: f64) -> f64 {
    if value.is_nan() || value <= quantile(HALF_MAXIMUM, OUTSIDE) || value.is_infinite() {
        return HALF_MAXIMUM;
    }
    // the quantile decreases with the degrees of freedom
    let [mut low, mut high] = [0.5, HALF_MAXIMUM];
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if quantile(middle, OUTSIDE) > value {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
