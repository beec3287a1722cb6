//! Response of a held and sampled plant at single points from its modes: exact like that from its
//! states, without zeros, for a fraction of the work.
//!
//! ```text
//! P(s) = D + sum r_i/(s - p_i),      r_i = N(p_i)/prod over k of (p_i - p_k)
//! P(z)   = D + sum r_i G_0/(z - e^(p_i T))                     without a fraction of a sample of dead time
//! z P(z) = D + sum r_i (z G_0 + G_1)/(z - e^(p_i T))           with a fraction f, in s
//! G_0 = h F(p_i h),   G_1 = e^(p_i h) f F(p_i f),   F(x) = (e^x - 1)/x,   h = T - f
//! ```
//!
//! Modes of opposite sign cancel if poles are close together, and far above the poles; all
//! operations are in twice the working precision, and results that lose too many digits even then
//! are rejected.

use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

use super::GROWTH_MAXIMUM;
use crate::linear::TransferFunction;
use crate::linear::discretization::{exponential_of, split_dead_time};
use crate::linear::double_double::{ComplexDoubleDouble, DoubleDouble};
use crate::portable::{cos, magnitude, sin};

/// Number of terms of the series of F: the remainder at 1/16 is 1e-33.
const TERMS: usize = 16;
/// Relative distance below which poles are not separated.
const APART: f64 = 1e-4;
/// Ratio of a response to the sum of the magnitudes of its modes below which it is too inaccurate.
const CANCELLED: f64 = 1e-14;

/// A continuous plant before its hold: N(s) (s - z_1).../((s - p_1)...) e^(-s T_d).
#[derive(Clone, Copy, Debug)]
pub struct HeldFactors<'a> {
    /// Coefficients of N, highest power first.
    pub numerator: &'a [f64],
    /// Additional factor.
    pub gain: f64,
    /// Further zeros, in conjugate pairs.
    pub zeros: &'a [Complex64],
    /// All poles, in conjugate pairs.
    pub poles: &'a [Complex64],
    /// T_d, s.
    pub dead_time_s: f64,
}

/// Held and sampled plant with single poles, ready to be evaluated at points of the unit circle.
#[derive(Clone, Debug)]
pub struct HeldModes {
    sections: Vec<ModeSection>,
    feedthrough: f64,
    poles: Vec<Complex64>,
    sample_time_s: f64,
    /// True if the dead time includes a fraction of a sample, which adds a pole at z = 0.
    has_fraction: bool,
    whole_s: f64,
}

/// P(z) at a frequency, and the product of z - p over its poles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldPoint {
    /// P(z), dead time included.
    pub response: Complex64,
    /// Product over the poles, including the pole from a fraction of a sample of dead time.
    pub denominator: Complex64,
}

/// Real mode or pair of modes.
///
/// ```text
/// (b_1 z + b_0)/(z + a_0),     (b_2 z^2 + b_1 z + b_0)/(z^2 + a_1 z + a_0)
/// ```
#[derive(Clone, Copy, Debug)]
struct ModeSection {
    numerator: [DoubleDouble; 3],
    denominator: [DoubleDouble; 2],
    is_pair: bool,
}

impl HeldModes {
    /// Modes of a held and sampled plant; `None` if its poles are not separate, grow beyond the
    /// range of numbers within a sample, or are fewer than its zeros.
    ///
    /// # Example
    /// 2/(s + 1), held for 0.5 s: 2 (1 - e^-0.5)/(z - e^-0.5).
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::linear::{HeldFactors, HeldModes};
    /// let poles = [Complex64::new(-1.0, 0.0)];
    /// let lag = HeldFactors { numerator: &[2.0], gain: 1.0, zeros: &[], poles: &poles, dead_time_s: 0.0 };
    /// let point = HeldModes::new(lag, 0.5).and_then(|modes| modes.at(1.0)).ok_or("one mode")?;
    /// let (z, image) = (Complex64::new(0.5_f64.cos(), 0.5_f64.sin()), (-0.5_f64).exp());
    /// assert!((point.denominator - (z - image)).norm_sqr() < 1e-30);
    /// assert!((point.response - 2.0 * (1.0 - image) / (z - image)).norm_sqr() < 1e-28);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(plant: HeldFactors<'_>, sample_time_s: f64) -> Option<HeldModes> {
        let HeldFactors { numerator, gain, zeros, poles, dead_time_s } = plant;
        let numerator = &numerator[numerator.iter().take_while(|one| **one == 0.0).count()..];
        let degree = numerator.len().checked_sub(1)? + zeros.len();
        let growth: f64 = poles.iter().map(|pole| (pole.re * sample_time_s).max(0.0)).sum();
        let is_usable = growth <= GROWTH_MAXIMUM && sample_time_s > 0.0 && degree <= poles.len();
        if !is_usable || !are_apart(poles) {
            return None;
        }
        let (whole, fraction_s) = split_dead_time(dead_time_s, sample_time_s);
        let plant = HeldFactors { numerator, ..plant };
        let sections = Arch::new().dispatch(AllModes { plant, sample_time_s, fraction_s });
        let finite = |section: &ModeSection| section.numerator.iter().all(|part| part.value().is_finite());
        Some(HeldModes {
            feedthrough: if degree == poles.len() { gain * numerator.first()? } else { 0.0 },
            poles: poles.iter().map(|pole| exponential_of(pole * sample_time_s)).collect(),
            sample_time_s,
            has_fraction: fraction_s != 0.0,
            whole_s: whole * sample_time_s,
            sections,
        })
        .filter(|found| found.sections.iter().all(finite))
    }

    /// Modes of a factored plant.
    pub fn of(plant: &TransferFunction, sample_time_s: f64) -> Option<HeldModes> {
        let plant = HeldFactors {
            numerator: &[1.0],
            gain: plant.gain(),
            zeros: plant.zeros(),
            poles: plant.poles(),
            dead_time_s: plant.dead_time_s(),
        };
        HeldModes::new(plant, sample_time_s)
    }

    /// Response at a frequency; `None` at a pole, and if the modes cancel too far.
    pub fn at(&self, frequency_rad_per_s: f64) -> Option<HeldPoint> {
        let angle = frequency_rad_per_s * self.sample_time_s;
        let z = Complex64::new(cos(angle), sin(angle));
        let value = Arch::new().dispatch(ModeSum { modes: self, z })?;
        let poles: Complex64 = self.poles.iter().map(|pole| z - pole).product();
        let (value, denominator) = if self.has_fraction { (value / z, poles * z) } else { (value, poles) };
        let turn = -frequency_rad_per_s * self.whole_s;
        let response = if turn == 0.0 { value } else { value * Complex64::new(cos(turn), sin(turn)) };
        response.is_finite().then_some(HeldPoint { response, denominator })
    }
}

/// True if no two poles are so close that their modes nearly cancel.
fn are_apart(poles: &[Complex64]) -> bool {
    poles.iter().enumerate().all(|(index, one)| {
        let apart = |other: &Complex64| {
            let (distance, size) = ((one - other).norm_sqr(), one.norm_sqr().max(other.norm_sqr()));
            distance > APART * APART * size
        };
        poles.iter().take(index).all(apart)
    })
}

/// All modes of a plant, with the vector instructions of the processor.
struct AllModes<'a> {
    plant: HeldFactors<'a>,
    sample_time_s: f64,
    fraction_s: f64,
}

impl WithSimd for AllModes<'_> {
    type Output = Vec<ModeSection>;

    #[inline(always)]
    fn with_simd<D: Simd>(self, _: D) -> Vec<ModeSection> {
        let AllModes { plant, sample_time_s, fraction_s } = self;
        let mut series = [DoubleDouble::from(1.0); TERMS];
        for term in 1..TERMS {
            series[term] = series[term - 1].divided_by((term + 1) as f64);
        }
        let rest_s = sample_time_s - fraction_s;
        let mut sections = Vec::with_capacity(plant.poles.len());
        for (index, &pole) in plant.poles.iter().enumerate().filter(|(_, pole)| pole.im >= 0.0) {
            let residue = residue(&plant, index, pole);
            let (late, constant) = exponential(&series, pole, rest_s);
            let present = residue * constant.times_real(rest_s);
            let [image, leading, last] = if fraction_s == 0.0 {
                [late, ComplexDoubleDouble::default(), present]
            } else {
                let (early, constant) = exponential(&series, pole, fraction_s);
                [late * early, present, residue * late * constant.times_real(fraction_s)]
            };
            sections.push(ModeSection::of(image, [leading, last], pole.im > 0.0));
        }
        sections
    }
}

/// Residue r.
#[inline(always)]
fn residue(plant: &HeldFactors<'_>, index: usize, pole: Complex64) -> ComplexDoubleDouble {
    let point = ComplexDoubleDouble::from(pole);
    let mut value = ComplexDoubleDouble::default();
    for &coefficient in plant.numerator {
        value = value * point + coefficient.into();
    }
    value = value.times_real(plant.gain);
    for &zero in plant.zeros {
        value = value * ComplexDoubleDouble::difference_of(pole, zero);
    }
    let mut others = ComplexDoubleDouble::from(1.0);
    for (other, &root) in plant.poles.iter().enumerate() {
        if other != index {
            others = others * ComplexDoubleDouble::difference_of(pole, root);
        }
    }
    value.divided_by(others)
}

/// Exponential e^x and F(x) for x = p h, by the series of F at x/2^n and doubling.
///
/// ```text
/// e^x = 1 + x F(x),     F(2x) = F(x) (e^x + 1)/2
/// ```
#[inline(always)]
fn exponential(
    series: &[DoubleDouble; TERMS],
    pole: Complex64,
    time_s: f64,
) -> (ComplexDoubleDouble, ComplexDoubleDouble) {
    let size = magnitude(pole) * time_s;
    let (_, exponent) = libm::frexp(size * 16.0);
    let halvings = if size == 0.0 { 0 } else { exponent.clamp(0, 1100) };
    let step = libm::ldexp(time_s, -halvings);
    let x = ComplexDoubleDouble {
        re: DoubleDouble::product_of(pole.re, step),
        im: DoubleDouble::product_of(pole.im, step),
    };
    let mut quotient = ComplexDoubleDouble::default();
    for &coefficient in series.iter().rev() {
        quotient = quotient * x + coefficient.into();
    }
    let one = ComplexDoubleDouble::from(1.0);
    let mut value = one + x * quotient;
    for _ in 0..halvings {
        quotient = quotient * (value + one).scaled(0.5);
        value = value * value;
    }
    (value, quotient)
}

impl ModeSection {
    /// Section (c_1 z + c_0)/(z - image), with its conjugate for a pair.
    #[inline(always)]
    fn of(
        image: ComplexDoubleDouble,
        [leading, last]: [ComplexDoubleDouble; 2],
        is_pair: bool,
    ) -> ModeSection {
        if !is_pair {
            return ModeSection {
                numerator: [DoubleDouble::ZERO, leading.re, last.re],
                denominator: [DoubleDouble::ZERO, -image.re],
                is_pair,
            };
        }
        // twice the real part of c conj(image)
        let turned = |c: ComplexDoubleDouble| (c.re * image.re + c.im * image.im).scaled(2.0);
        ModeSection {
            numerator: [leading.re.scaled(2.0), last.re.scaled(2.0) - turned(leading), -turned(last)],
            denominator: [-image.re.scaled(2.0), image.re * image.re + image.im * image.im],
            is_pair,
        }
    }

    #[inline(always)]
    fn at(&self, z: ComplexDoubleDouble) -> ComplexDoubleDouble {
        let ModeSection { numerator: [second, first, constant], denominator: [linear, last], is_pair } =
            *self;
        let (numerator, denominator) = if is_pair {
            (
                (z.times_wide(second) + first.into()) * z + constant.into(),
                (z + linear.into()) * z + last.into(),
            )
        } else {
            (z.times_wide(first) + constant.into(), z + last.into())
        };
        numerator.divided_by(denominator)
    }
}

/// Sum z^f P(z), with the vector instructions of the processor.
struct ModeSum<'a> {
    modes: &'a HeldModes,
    z: Complex64,
}

impl WithSimd for ModeSum<'_> {
    type Output = Option<Complex64>;

    #[inline(always)]
    fn with_simd<D: Simd>(self, _: D) -> Option<Complex64> {
        let z = ComplexDoubleDouble::from(self.z);
        let mut sum = ComplexDoubleDouble::from(self.modes.feedthrough);
        let mut size = self.modes.feedthrough.abs();
        for section in &self.modes.sections {
            let part = section.at(z);
            size += part.re.high.abs() + part.im.high.abs();
            sum = sum + part;
        }
        let value = sum.value();
        (value.re.abs() + value.im.abs() > CANCELLED * size).then_some(value)
    }
}
