use num_complex::Complex64;

use super::Transform;

/// Largest fraction of a signal's power that may differ from period to period.
const MOST_NOISE: f64 = 0.05;

/// Ratio to the best shift up to which a shift counts as a period.
const ALMOST_BEST: f64 = 1.5;

/// Fraction of the power below which differences are rounding.
const ROUNDING: f64 = 1e-9;

/// Period of a signal in samples: the shortest shift, up to half of the record, that repeats it as
/// well as any; `None` if none does.
///
/// ```text
/// d(P) = sum over n of (u_(n+P) - u_n)^2 / sum over n of (u_(n+P)^2 + u_n^2)
/// ```
///
/// is the fraction of the power that a shift does not explain: 0 for the period of a signal without
/// noise, 1 for uncorrelated parts.
///
/// # Example
/// ```
/// use phea_dynamics::spectrum::period;
/// let signal: Vec<f64> = (0..100).map(|n| [0.0, 2.0, 1.0, -4.0, 2.0, 0.5, -1.5][n % 7]).collect();
/// assert_eq!(period(&signal), Some(7));
/// assert_eq!(period(&(0..100).map(|n| f64::from(n * n)).collect::<Vec<f64>>()), None);
/// ```
pub fn period(signal: &[f64]) -> Option<usize> {
    let unexplained = unexplained(signal);
    // neighbouring samples of a slow signal are alike: a period follows after they have differed
    let first = unexplained.iter().position(|fraction| *fraction > 0.5)?;
    let later = || unexplained.iter().copied().enumerate().skip(first);
    let least = later().map(|(_, fraction)| fraction).fold(f64::INFINITY, f64::min);
    if least > MOST_NOISE {
        return None;
    }
    let enough = ALMOST_BEST * least + ROUNDING;
    let begins = later().find(|(_, fraction)| *fraction <= enough)?.0;
    // the best of the shifts next to each other
    let near =
        later().skip_while(|(shift, _)| *shift < begins).take_while(|(_, fraction)| *fraction <= enough);
    near.min_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(shift, _)| shift)
}

/// Unexplained fraction d for each shift up to half of the record.
fn unexplained(signal: &[f64]) -> Vec<f64> {
    let count = signal.len();
    let mean = signal.iter().sum::<f64>() / count.max(1) as f64;
    let centred: Vec<f64> = signal.iter().map(|value| value - mean).collect();
    // products at all shifts at once, from the transform of the power spectrum
    let transform = Transform::new((2 * count).next_power_of_two());
    let power: Vec<Complex64> =
        transform.of_real(&centred).iter().map(|line| Complex64::new(line.norm_sqr(), 0.0)).collect();
    let products = transform.of(&power);
    let scale = transform.length() as f64;
    let mut sums = Vec::with_capacity(count + 1);
    sums.push(0.0);
    let mut sum = 0.0;
    for value in &centred {
        sum += value * value;
        sums.push(sum);
    }
    let of = |(shift, product): (usize, &Complex64)| {
        let [head, tail] = [sums.get(count - shift), sums.get(shift)].map(|sum| sum.copied().unwrap_or(0.0));
        let both = head + (sum - tail);
        if both > 0.0 { (1.0 - 2.0 * product.re / scale / both).max(0.0) } else { 1.0 }
    };
    products.iter().enumerate().take(count / 2 + 1).map(of).collect()
}
