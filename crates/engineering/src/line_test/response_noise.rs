//! Noise of a response at each of its frequencies.

use phea_dynamics::spectrum::SpectralPoint;

/// Number of rounds of the fit, each of which increases the likelihood.
const ROUNDS: usize = 400;

/// Standard deviation of the response at each point: the scatter of few blocks, smoothed by the
/// origin of the noise.
///
/// ```text
/// sigma_k^2 e_k = a + b |G_k|^2         e the power of the input, a noise of the output, b of the input
/// ```
///
/// White noise of either signal is equally strong at all frequencies, so two numbers suffice for
/// all, which many more blocks determine than there are at one frequency. They are the most likely
/// ones, for scatter that is a sum of squares:
///
/// ```text
/// minimise sum ln m_k + s_k/m_k,  m = a + b g:     a sqrt(sum s/m^2 / sum 1/m) -> a,   b sqrt(sum g s/m^2 / sum g/m) -> b
/// ```
///
/// which never increases the sum (Fevotte and Idier 2011). Pintelon and Schoukens (2012), section
/// 2.
pub(super) fn smoothed_deviations(points: &[SpectralPoint]) -> Vec<f64> {
    let squared = |point: &SpectralPoint| point.response.norm_sqr();
    let largest = points.iter().map(squared).fold(f64::MIN_POSITIVE, f64::max);
    let rows: Vec<[f64; 2]> = points
        .iter()
        .map(|point| [point.deviation * point.deviation * point.excitation, squared(point) / largest])
        .collect();
    let mean = rows.iter().map(|[scatter, _]| scatter).sum::<f64>() / rows.len().max(1) as f64;
    let (mut output, mut input) = (mean, mean);
    for _ in 0..ROUNDS {
        let [mut more, mut less] = [[0.0; 2]; 2];
        for [scatter, gain] in &rows {
            let expected = (output + input * gain).max(f64::MIN_POSITIVE);
            for ((more, less), fraction) in more.iter_mut().zip(&mut less).zip([1.0, *gain]) {
                *more += fraction * scatter / expected / expected;
                *less += fraction / expected;
            }
        }
        let [a, b] = [0, 1].map(|index: usize| {
            more.get(index).zip(less.get(index)).map_or(1.0, |(more, less)| (more / less).sqrt())
        });
        (output, input) = (output * a, input * b);
    }
    let of = |(point, [_, gain]): (&SpectralPoint, &[f64; 2])| {
        ((output + input * gain) / point.excitation).max(0.0).sqrt()
    };
    points.iter().zip(&rows).map(of).collect()
}
