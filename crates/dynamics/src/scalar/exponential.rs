//! Exponential without a branch, so that it vectorises over lanes.

/// Natural exponential, to within one unit of the last place; 0 below -708, infinite above 709.
///
/// ```text
/// e^x = 2^k e^r,     k = round(x/ln 2),   r = x - k ln 2 in two parts,   |r| <= ln(2)/2,   e^r by its series
/// ```
///
/// Only additions, multiplications and shifts of the bits: an identical result on every machine and
/// in every lane.
#[inline(always)]
pub(super) fn exponential(x: f64) -> f64 {
    /// Number whose addition to a number below 2^51 leaves the nearest integer in the last bits.
    const ROUNDING: f64 = 6_755_399_441_055_744.0;
    /// ln 2 with 21 zeros at its end, and the remainder.
    const LN2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
    let shifted = x * std::f64::consts::LOG2_E + ROUNDING;
    let k = shifted - ROUNDING;
    let r = (x - k * LN2[0]) - k * LN2[1];
    let scale = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1023 << 52));
    let value = scale * series(r);
    let value = if x < -708.0 { 0.0 } else { value };
    if x > 709.0 { f64::INFINITY } else { value }
}

/// Series 1 + r + r^2/2! + ... + r^13/13!, in pairs and pairs of pairs (Estrin), the small terms
/// first.
#[inline(always)]
fn series(r: f64) -> f64 {
    let r2 = r * r;
    let r4 = r2 * r2;
    let c2 = 0.5 + r * (1.0 / 6.0);
    let c4 = 1.0 / 24.0 + r * (1.0 / 120.0);
    let c6 = 1.0 / 720.0 + r * (1.0 / 5_040.0);
    let c8 = 1.0 / 40_320.0 + r * (1.0 / 362_880.0);
    let c10 = 1.0 / 3_628_800.0 + r * (1.0 / 39_916_800.0);
    let c12 = 1.0 / 479_001_600.0 + r * (1.0 / 6_227_020_800.0);
    let high = (c8 + r2 * c10) + r4 * c12;
    let low = (c2 + r2 * c4) + r4 * (c6 + r2 * high);
    1.0 + (r + r2 * low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::portable;

    #[test]
    fn agrees_with_an_independent_exponential_to_the_last_places() {
        for index in -7_080..=7_090 {
            let x = 0.1 * f64::from(index) + 0.037;
            let expected = portable::exp(x);
            let allowed = if (-708.0..=709.0).contains(&x) { 4e-16 * expected } else { continue };
            assert!((exponential(x) - expected).abs() <= allowed, "{x}");
        }
        assert_eq!((exponential(0.0), exponential(-1e300), exponential(1e300)), (1.0, 0.0, f64::INFINITY));
        assert_eq!((exponential(f64::NEG_INFINITY), exponential(f64::INFINITY)), (0.0, f64::INFINITY));
        assert!(exponential(f64::NAN).is_nan());
    }
}
