//! Contours of constant |T| = |L/(1+L)| on a Nichols chart.

use phea_dynamics::portable::{cos, log10, sin};

/// Number of points of one half of a contour.
const POINTS: i32 = 90;

/// Contour |L/(1+L)| = M as (phase of L in degrees within [-360, 0], magnitude of L in dB); empty
/// for an invalid M.
///
/// ```text
/// (M^2 - 1) g^2 + 2 M^2 cos(phi) g + M^2 = 0,      L = g e^(j phi)           from |L|^2 = M^2 |1 + L|^2
///   M > 1: a closed curve around -180 degrees        M = 1: cos(phi) = -1/(2 g)
///   M < 1: one gain for every phase
/// ```
///
/// # Example
/// ```
/// use phea_figure::nichols::magnitude_contour;
/// // |T| = 1/2 (-6.02 dB) takes a gain of 1 where L is positive: 1/(1 + 1).
/// let contour = magnitude_contour(-20.0 * 2f64.log10());
/// let (phase_deg, magnitude_db) = *contour.last().unwrap();
/// assert!(phase_deg == 0.0 && magnitude_db.abs() < 1e-9);
/// ```
pub fn magnitude_contour(contour_db: f64) -> Vec<(f64, f64)> {
    let magnitude = phea_dynamics::portable::pow(10.0, contour_db / 20.0);
    let square = magnitude * magnitude;
    if !(square.is_finite() && square > 0.0) {
        return Vec::new();
    }
    let decibel = |gain: f64| 20.0 * log10(gain);
    if contour_db == 0.0 {
        // denser towards -90 and -270 degrees, where the gain is unbounded
        let last = POINTS - 1;
        let phases = (-last..=last).map(|i| {
            let left = 1.0 - f64::from(i.abs()) / f64::from(POINTS);
            -180.0 + 90.0 * f64::from(i.signum()) * (1.0 - left * left * left)
        });
        return phases.map(|phase| (phase, decibel(-0.5 / cos(phase.to_radians())))).collect();
    }
    if magnitude < 1.0 {
        let phases = (0..=4 * POINTS).map(|i| 90.0 * f64::from(i) / f64::from(POINTS) - 360.0);
        return phases
            .map(|phase| {
                let part = square * cos(phase.to_radians());
                // the one positive root, without cancellation if cos(phi) is negative
                let root = (part * part + square * (1.0 - square)).sqrt();
                let gain = if part > 0.0 { (part + root) / (1.0 - square) } else { square / (root - part) };
                (phase, decibel(gain))
            })
            .collect();
    }
    // once around: the phase oscillates about -180 degrees as the gain goes from the greater root
    // to the lesser and back
    let widest = phea_dynamics::portable::acos((1.0 - 1.0 / square).sqrt());
    (0..=4 * POINTS)
        .map(|i| {
            let turn = (90.0 * f64::from(i) / f64::from(POINTS)).to_radians();
            let off = widest * sin(turn);
            let part = square * cos(off);
            let root = (part * part - square * (square - 1.0)).max(0.0).sqrt();
            let gain = if cos(turn) > 0.0 { (part + root) / (square - 1.0) } else { square / (part + root) };
            (off.to_degrees() - 180.0, decibel(gain))
        })
        .collect()
}
