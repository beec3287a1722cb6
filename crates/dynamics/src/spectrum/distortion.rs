use num_complex::Complex64;

use super::Blocks;

/// Ratio of a line's power to the strongest below which the input does not excite the line.
const UNEXCITED: f64 = 1e-6;
/// Multiples of the highest excited line that are searched for harmonics.
const HARMONICS: usize = 3;
/// Ratio to the power of the excited lines below which a power is rounding.
const ROUNDING: f64 = 1e-20;
/// Standard deviations of noise that a level must exceed.
const SIGNIFICANT: f64 = 4.0;

/// Size of an output at lines of the period that its input does not excite, over its size at those
/// that it does: 0 if it is no more than noise. A linear system has none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distortion {
    /// Distortion at even multiples of the period's frequency.
    pub even: f64,
    /// Distortion at odd multiples.
    pub odd: f64,
}

impl Blocks {
    /// Harmonics and products of the lines of a periodic input, up to three times the highest of
    /// them. A part that repeats with the period is not noise: it is also present at the excited
    /// lines, where no averaging reveals it (Pintelon and Schoukens 2012, chapter 4).
    ///
    /// ```text
    /// d^2 = sum over silent lines of (n |Y|^2 - s^2) / sum over excited lines of n |Y|^2
    /// ```
    ///
    /// with the mean Y of n periods and the variance s^2 from one to the other. Zero for segments.
    ///
    /// # Example
    /// A cosine, and an output with a tenth of its square, half of which is a constant.
    /// ```
    /// use phea_dynamics::spectrum::periods;
    /// let angles = (0..64).map(|n| f64::from(n) * 2.0 * std::f64::consts::PI / 16.0);
    /// let input: Vec<f64> = angles.map(phea_dynamics::portable::cos).collect();
    /// let output: Vec<f64> = input.iter().map(|u| u + 0.1 * u * u).collect();
    /// let found = periods([&input, &output], 0.1, 16, 0).ok_or("too short")?.distortion();
    /// assert!((found.even - 0.05).abs() < 1e-12 && found.odd == 0.0);
    /// # Ok::<(), &str>(())
    /// ```
    pub fn distortion(&self) -> Distortion {
        let points = self.points();
        let is_excited = |line: usize| {
            let point = line.checked_sub(1).and_then(|index| points.get(index));
            point.is_some_and(|point| point.excitation >= UNEXCITED)
        };
        let highest = (1..=points.len()).rev().find(|line| is_excited(*line)).unwrap_or(0);
        let last = (HARMONICS * highest).min(points.len());
        let excited: f64 =
            (1..=highest).filter(|line| is_excited(*line)).map(|line| self.power(line)[0]).sum();
        let size = |odd: usize| {
            let silent: Vec<[f64; 2]> = (1..=last)
                .filter(|line| line % 2 == odd && !is_excited(*line))
                .map(|line| self.power(line))
                .collect();
            let [power, noise] =
                [0, 1].map(|which: usize| silent.iter().map(|pair| pair[which]).sum::<f64>());
            let squares: f64 = silent.iter().map(|[_, noise]| noise * noise).sum();
            let scatter = (squares * (1.0 + 1.0 / (self.count() as f64 - 1.0))).sqrt();
            let is_more = power > noise + SIGNIFICANT * scatter && power > ROUNDING * excited;
            if is_more && self.is_repeated { ((power - noise) / excited).sqrt() } else { 0.0 }
        };
        Distortion { even: size(0), odd: size(1) }
    }

    /// Power of the mean output at a line, n |Y|^2, and the variance s^2 from block to block.
    fn power(&self, line: usize) -> [f64; 2] {
        let outputs = || self.lines.iter().filter_map(|[_, output]| output.get(line));
        let count = self.count() as f64;
        let sum: Complex64 = outputs().sum();
        let power = sum.norm_sqr() / count;
        let all: f64 = outputs().map(|output| output.norm_sqr()).sum();
        [power, (all - power).max(0.0) / (count - 1.0)]
    }
}
