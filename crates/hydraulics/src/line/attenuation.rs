//! Attenuation of a wave along a laminar line: four first-order lags, by dissipation number.

/// Number of lags.
pub(super) const TERMS: usize = 4;

/// Corners b_k of the lags in units of 1/T.
pub(super) const CORNERS: [f64; TERMS] = [1.0, 6.0, 20.0, 100.0];

/// Greatest dissipation number of the fit.
pub(super) const GREATEST_DISSIPATION: f64 = 0.1;

/// Root of the dissipation number, and the weights a_k of the lags there.
// ORIGIN: recomputed by comparisons/recompute_lines.py
const WEIGHTS: [(f64, [f64; TERMS]); 16] = [
    (0.000000000, [0.000000, 0.000000, 0.000000, 0.000000]),
    (0.003162278, [0.003541, 0.002892, 0.004783, 0.033536]),
    (0.010000000, [0.011330, 0.008887, 0.015878, 0.101164]),
    (0.022360680, [0.025853, 0.018886, 0.038271, 0.207234]),
    (0.031622777, [0.037088, 0.025721, 0.056736, 0.273870]),
    (0.044721360, [0.053459, 0.034511, 0.084838, 0.350741]),
    (0.054772256, [0.066377, 0.040616, 0.107651, 0.396953]),
    (0.070710678, [0.087446, 0.049266, 0.145398, 0.449607]),
    (0.089442719, [0.113034, 0.057977, 0.191177, 0.482767]),
    (0.109544512, [0.141357, 0.065787, 0.240643, 0.488848]),
    (0.134164079, [0.177361, 0.070387, 0.307319, 0.444933]),
    (0.158113883, [0.214014, 0.065794, 0.386559, 0.333632]),
    (0.187082869, [0.258648, 0.065881, 0.456490, 0.218981]),
    (0.223606798, [0.315873, 0.070640, 0.510709, 0.102778]),
    (0.264575131, [0.382019, 0.075669, 0.538195, 0.000000]),
    (0.316227766, [0.452102, 0.138736, 0.409162, 0.000000]),
];

/// Weights a_k of the attenuation of a wave at a dissipation number nu T/R^2 from 0 to 0.1; `None`
/// beyond.
///
/// ```text
/// exp(sT - Gamma(s)) ~ A(s) = 1 - sum a_k + sum a_k b_k/(b_k + s T),     Gamma = s T sqrt(N(s R^2/nu))
/// ```
///
/// Fitted by least squares from w T = 0.3 to 40 with non-negative weights, so that |A(jw)| <= A(0)
/// = 1 at every frequency: no wave grows. Between the rows of the table the weights are linear in
/// the root of the dissipation number, as they are in theory when it is small.
pub(super) fn attenuation_weights(dissipation: f64) -> Option<[f64; TERMS]> {
    if !(0.0..=GREATEST_DISSIPATION).contains(&dissipation) {
        return None;
    }
    let root = dissipation.sqrt();
    let above = WEIGHTS.partition_point(|(node, _)| *node <= root).clamp(1, WEIGHTS.len() - 1);
    let ((lower, from), (upper, to)) = (WEIGHTS[above - 1], WEIGHTS[above]);
    let part = ((root - lower) / (upper - lower)).min(1.0);
    let mut weights = from;
    for (weight, to) in weights.iter_mut().zip(to) {
        *weight += part * (to - *weight);
    }
    Some(weights)
}
