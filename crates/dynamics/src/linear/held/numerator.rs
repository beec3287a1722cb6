//! Leading coefficient and zeros of the numerator, from its values.

use num_complex::Complex64;

use super::super::double_double::{ComplexDoubleDouble, DoubleDouble};
use super::super::refinement::{converge, symmetrise};
use super::super::{LinearError, Polynomial, roots};
use super::Held;
use crate::portable::{cos, magnitude, sin};

/// Relative size of leading coefficients below which they are rounding in twice the working
/// precision.
const NEGLIGIBLE: f64 = 1e-26;
/// Magnitudes of zeros that are refined. Zeros nearer to the origin, or farther, act on the unit
/// circle as if they were there, and stay at their first guess.
const REFINED: std::ops::RangeInclusive<f64> = 1e-9..=1e9;
/// Largest relative deviation of the numerator from the response on the unit circle.
const AGREEMENT: f64 = 1e-8;
/// Relative distance from a zero within which the response is not compared more closely.
const BESIDE_ZERO: f64 = 1e-3;
/// Angle below which the factors are rounded too coarsely to be compared.
const LEAST_ANGLE: f64 = 1e-3;

/// Numerator N at a point of the unit circle.
struct NumeratorSample {
    z: Complex64,
    numerator: Complex64,
}

impl Held {
    /// Leading coefficient and zeros of N, where `poles` are those of the sampled plant; `None` if
    /// no factors agree with the response.
    ///
    /// # Errors
    /// Errors of [`roots::guessed`].
    pub(in super::super) fn factors(
        &self,
        poles: &[Complex64],
    ) -> Result<Option<(f64, Vec<Complex64>)>, LinearError> {
        let Some((coefficients, mut samples)) = self.interpolated() else { return Ok(None) };
        let largest = coefficients.iter().map(|c| c.value().abs()).fold(0.0, f64::max);
        let first = coefficients.iter().position(|c| c.value().abs() > NEGLIGIBLE * largest);
        let Some(kept) = first.and_then(|first| coefficients.get(first..)) else { return Ok(None) };
        let rounded = Polynomial::new(kept.iter().map(|c| c.value()).collect());
        let gain = rounded.leading_coefficient();
        let mut zeros = apart(roots::guessed(&rounded)?);
        let step = |z: Complex64| self.newton_step(poles, z);
        converge(&mut zeros, 60, |z| if REFINED.contains(&magnitude(z)) { step(z) } else { None });
        let zeros = symmetrise(&zeros);
        let gain = matched(gain, &zeros, &samples);
        samples.extend(self.beside_slow_poles(poles));
        let agree = samples.iter().all(|sample| agrees(gain, &zeros, sample));
        Ok(agree.then_some((gain, zeros)))
    }

    /// True if a gain and zeros agree with the response along the unit circle.
    pub(in super::super) fn agrees_with(&self, gain: f64, zeros: &[Complex64], poles: &[Complex64]) -> bool {
        let samples = self.interpolated().map(|(_, samples)| samples).unwrap_or_default();
        let mut samples = samples.into_iter().chain(self.beside_slow_poles(poles)).peekable();
        samples.peek().is_some() && samples.all(|sample| agrees(gain, zeros, &sample))
    }

    /// Coefficients of N, highest power first, from its values at the roots of z^M = -1; and these
    /// values.
    fn interpolated(&self) -> Option<(Vec<DoubleDouble>, Vec<NumeratorSample>)> {
        let count = self.degree() + 1;
        let points = roots_of_unity(2 * count);
        let mut sums = vec![DoubleDouble::ZERO; count];
        let mut samples = Vec::with_capacity(count / 2 + 1);
        for k in 0..count.div_ceil(2) {
            let z = *points.get(2 * k + 1)?;
            let numerator = self.numerator(z)?;
            samples.push(NumeratorSample { z: z.value(), numerator: numerator.value() });
            // a point of the upper half counts for its conjugate too
            let weight = if 2 * k + 1 == count { 1.0 } else { 2.0 };
            for (power, sum) in sums.iter_mut().enumerate() {
                let turned = *points.get((2 * k + 1) * power % (2 * count))?;
                let real = numerator.re * turned.re + numerator.im * turned.im;
                *sum = *sum + real * weight.into();
            }
        }
        let coefficients = sums.iter().rev().map(|sum| sum.divided_by(count as f64)).collect();
        Some((coefficients, samples))
    }

    /// N at the angles of the slow poles, between z = 1 and the points above.
    fn beside_slow_poles(&self, poles: &[Complex64]) -> Vec<NumeratorSample> {
        // one of a pair counts for both
        let upper = poles.iter().filter(|pole| pole.im >= 0.0);
        let angles = upper.map(|pole| magnitude(pole - 1.0));
        let within = angles.filter(|angle| (LEAST_ANGLE..1.0).contains(angle));
        let sample = |angle: f64| {
            let z = Complex64::new(cos(angle), sin(angle));
            Some(NumeratorSample { z, numerator: self.numerator(z.into())?.value() })
        };
        within.filter_map(sample).collect()
    }

    /// Newton step N/N' from the response; `None` at a pole that cancels.
    fn newton_step(&self, poles: &[Complex64], z: Complex64) -> Option<Complex64> {
        if poles.iter().any(|pole| magnitude(pole - z) <= 1e-6 * magnitude(z)) {
            return None;
        }
        let local = self.at(z.into())?;
        let (value, slope) = (local.value.value(), local.slope.value());
        if value == Complex64::new(0.0, 0.0) {
            return Some(value);
        }
        let poles: Complex64 = poles.iter().map(|pole| (z - pole).inv()).sum();
        let step = (slope / value + poles).inv();
        step.is_finite().then_some(step)
    }
}

/// Gain with which the zeros reproduce the samples; the leading coefficient unless a relatively
/// small coefficient's zero is known more accurately than that coefficient.
fn matched(leading: f64, zeros: &[Complex64], samples: &[NumeratorSample]) -> f64 {
    let shape = |z: Complex64| zeros.iter().map(|zero| z - zero).product::<Complex64>();
    let shapes = samples.iter().map(|sample| (shape(sample.z), sample.numerator));
    let (product, square) = shapes.fold((0.0, 0.0), |(product, square), (shape, numerator)| {
        (product + (shape.conj() * numerator).re, square + shape.norm_sqr())
    });
    let gain = product / square;
    if gain.is_nan() || (gain - leading).abs() <= 1e-12 * leading.abs() { leading } else { gain }
}

fn agrees(gain: f64, zeros: &[Complex64], sample: &NumeratorSample) -> bool {
    let factors = zeros.iter().map(|zero| sample.z - zero);
    let found = factors.clone().fold(Complex64::new(gain, 0.0), |product, factor| product * factor);
    let size = factors.fold(gain.abs(), |product, factor| product * magnitude(factor).max(BESIDE_ZERO));
    magnitude(found - sample.numerator) <= AGREEMENT * size
}

/// Separates equal guesses slightly: together they would stay equal.
fn apart(mut roots: Vec<Complex64>) -> Vec<Complex64> {
    for index in 1..roots.len() {
        let (earlier, rest) = roots.split_at_mut(index);
        let Some(root) = rest.first_mut() else { continue };
        while *root != Complex64::new(0.0, 0.0) && earlier.contains(root) {
            *root *= Complex64::new(1.0 + 1e-4, if root.im < 0.0 { -1e-4 } else { 1e-4 });
        }
    }
    roots
}

/// exp(2 pi j k/count) for k = 0, 1, ..., where `count` is even, in twice the working precision.
fn roots_of_unity(count: usize) -> Vec<ComplexDoubleDouble> {
    let one = ComplexDoubleDouble::from(1.0);
    let half = count / 2;
    let angle = std::f64::consts::PI / half as f64;
    let mut unit = ComplexDoubleDouble::from(Complex64::new(cos(angle), sin(angle)));
    for _ in 0..2 {
        // Newton's method on w^half = -1, where w/(half w^half) is nearly -w/half
        let power = (0..half).fold(one, |power, _| power * unit);
        let correction = unit * (power + one);
        let step = |part: DoubleDouble| part.divided_by(half as f64);
        unit = unit + ComplexDoubleDouble { re: step(correction.re), im: step(correction.im) };
    }
    let next = |power: &ComplexDoubleDouble| Some(*power * unit);
    std::iter::successors(Some(one), next).take(count).collect()
}
