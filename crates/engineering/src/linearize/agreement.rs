//! Frequencies at which a reduced model agrees with the plant.

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;

use crate::rig::Rig;

/// Difference within which a reduction agrees with the plant, dB.
pub const WITHIN_DB: f64 = 1.0;
/// Phase difference within which a reduction agrees with the plant, degrees.
pub const WITHIN_DEG: f64 = 5.0;

/// Bands in which a reduction agrees with the plant to 1 dB and 5 degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct AgreementBand {
    /// Name of the model.
    pub model: &'static str,
    /// Equation of the model.
    pub equation: &'static str,
    /// Bands in which the model agrees, rad/s, by rising frequency, as resolved by the grid.
    pub bands_rad_per_s: Vec<[f64; 2]>,
}

/// Name and equation of each reduction, the fullest first.
const REDUCTIONS: [[&str; 2]; 4] = [
    ["two-pressure, derived parameters", "4.25 to 4.29"],
    ["fifth order", "6.7"],
    ["decomposed, corrected", "6.12"],
    [FIRST_ORDER, "6.13"],
];
/// Name of the first-order model, the only reduction with the stiffness of the load.
pub const FIRST_ORDER: &str = "first order";
/// Name of the plant without waves in its lines.
pub const LUMPED: &str = "lumped lines";

/// Bands in which the reductions, in this order, agree with the plant on a grid of frequencies,
/// rad/s; if lines have waves, the plant with lumped lines comes first.
pub(super) fn agreement(
    rig: &Rig,
    grid: &[f64],
    lumped: &TransferFunction,
    reductions: [&TransferFunction; REDUCTIONS.len()],
) -> Vec<AgreementBand> {
    let one = |[model, equation]: [&'static str; 2], function: &TransferFunction| AgreementBand {
        model,
        equation,
        bands_rad_per_s: bands(grid, |frequency| rig.response(frequency), function),
    };
    let lines = rig.in_motion.map(|_| one([LUMPED, "plant"], lumped));
    let of_reductions = REDUCTIONS.into_iter().zip(reductions).map(|(name, function)| one(name, function));
    lines.into_iter().chain(of_reductions).collect()
}

/// Bands of a grid in which two responses differ by no more than that; a single frequency is not a
/// band.
fn bands(grid: &[f64], plant: impl Fn(f64) -> Complex64, model: &TransferFunction) -> Vec<[f64; 2]> {
    let mut bands: Vec<[f64; 2]> = Vec::new();
    let mut inside = false;
    for &frequency in grid {
        let ratio = model.at_frequency(frequency) / plant(frequency);
        let magnitude_db = 20.0 * portable::ln(portable::magnitude(ratio)) / std::f64::consts::LN_10;
        let phase_deg = portable::argument(ratio).to_degrees();
        let agrees = magnitude_db.abs() <= WITHIN_DB && phase_deg.abs() <= WITHIN_DEG;
        match (agrees, inside, bands.last_mut()) {
            (true, true, Some(band)) => band[1] = frequency,
            (true, ..) => bands.push([frequency; 2]),
            (false, ..) => {}
        }
        inside = agrees;
    }
    bands.retain(|[from, to]| from < to);
    bands
}
