use std::f64::consts::PI;

use num_complex::Complex64;

use super::estimate::fisher;
use super::{SpectralPoint, Transform, disc_radius};
use crate::portable::cos;

/// Probability that a line of the input that is noise counts as excited, because its mean over the
/// periods is larger than their differences.
const NOISE: f64 = 1e-5;
/// Number of lines to each side whose differences determine the size of noise.
const AROUND: usize = 5;

/// Transforms of an input and of an output, block by block.
#[derive(Clone, Debug)]
pub struct Blocks {
    /// Spacing of the lines, rad/s.
    spacing: f64,
    /// Transforms of input and output for each block, at all lines up to half of the sampling
    /// frequency.
    pub(super) lines: Vec<[Vec<Complex64>; 2]>,
    /// Equivalent number of independent blocks.
    independent: f64,
    /// True if all blocks are the response to one repeated input.
    pub(super) is_repeated: bool,
}

/// Last whole periods of two signals that are sampled in steps of `time_step` seconds, after the
/// first `settling` samples. `None` if fewer than two remain.
///
/// Whole periods have no leakage: the lines are exact, and the difference between periods is noise.
///
/// # Example
/// Three periods of a cosine of four samples, and an output of twice its size a sample later: a lag
/// of a quarter of a turn, -2j.
/// ```
/// use phea_dynamics::spectrum::periods;
/// let input = [1.0, 0.0, -1.0, 0.0].repeat(3);
/// let output = [0.0, 2.0, 0.0, -2.0].repeat(3);
/// let blocks = periods([&input, &output], 0.1, 4, 0).ok_or("too short")?;
/// let [point] = blocks.points()[..] else { panic!("a line between the mean and half of the sampling frequency") };
/// assert!((point.frequency - 2.0 * std::f64::consts::PI / 0.4).abs() < 1e-12);
/// assert!(point.response.re.abs() < 1e-12 && (point.response.im + 2.0).abs() < 1e-12);
/// # Ok::<(), &str>(())
/// ```
pub fn periods(signals: [&[f64]; 2], time_step: f64, period: usize, settling: usize) -> Option<Blocks> {
    let count = signals[0].len().min(signals[1].len());
    let repeats = count.checked_sub(settling)?.checked_div(period)?;
    if repeats < 2 || period < 4 {
        return None;
    }
    let first = count - repeats * period;
    let transform = Transform::new(period);
    let of = |signal: &[f64], start: usize| -> Vec<Complex64> {
        let block = signal.get(start..start + period).unwrap_or_default();
        let mean = block.iter().sum::<f64>() / period as f64;
        let centred: Vec<f64> = block.iter().map(|value| value - mean).collect();
        let scale = 2.0 / period as f64;
        transform.of_real(&centred).into_iter().take(period.div_ceil(2)).map(|line| line * scale).collect()
    };
    let lines = (0..repeats).map(|repeat| signals.map(|signal| of(signal, first + repeat * period)));
    let spacing = 2.0 * PI / (period as f64 * time_step);
    Some(Blocks { spacing, lines: lines.collect(), independent: repeats as f64, is_repeated: true })
}

/// Segments of two signals, each overlapping half of the one before, with a Hann window. `None` if
/// fewer than two fit.
///
/// ```text
/// w_n = (1 - cos(2 pi n/N))/2          n_d = K/(1 + 2 rho (1 - 1/K)),   rho = (sum w_n w_(n+N/2) / sum w_n^2)^2
/// ```
///
/// K segments that overlap count as n_d independent ones: Welch (1967).
///
/// # Example
/// For any input, an output of three times its size has the response 3 at every frequency, without
/// noise.
/// ```
/// use phea_dynamics::random::{normal, stream};
/// use phea_dynamics::spectrum::segments;
/// let mut state = stream(1, 0);
/// let input: Vec<f64> = (0..256).map(|_| normal(&mut state)).collect();
/// let output: Vec<f64> = input.iter().map(|value| 3.0 * value).collect();
/// let blocks = segments([&input, &output], 0.01, 64).ok_or("too short")?;
/// assert_eq!(blocks.count(), 7);
/// for point in blocks.points() {
///     assert!((point.response.re - 3.0).abs() < 1e-12 && point.response.im.abs() < 1e-12);
///     assert!((point.coherence - 1.0).abs() < 1e-12);
/// }
/// # Ok::<(), &str>(())
/// ```
pub fn segments(signals: [&[f64]; 2], time_step: f64, length: usize) -> Option<Blocks> {
    let count = signals[0].len().min(signals[1].len());
    let step = length / 2;
    if length < 8 || count < length + step {
        return None;
    }
    let segments = (count - length) / step + 1;
    let window: Vec<f64> =
        (0..length).map(|n| 0.5 - 0.5 * cos(2.0 * PI * n as f64 / length as f64)).collect();
    let transform = Transform::new(length);
    let means = signals.map(|signal| signal.iter().take(count).sum::<f64>() / count as f64);
    let of = |signal: &[f64], mean: f64, start: usize| -> Vec<Complex64> {
        let samples = signal.iter().skip(start).zip(&window);
        let seen: Vec<f64> = samples.map(|(value, window)| (value - mean) * window).collect();
        let scale = 4.0 / length as f64;
        transform.of_real(&seen).into_iter().take(length.div_ceil(2)).map(|line| line * scale).collect()
    };
    let both = |start: usize| [of(signals[0], means[0], start), of(signals[1], means[1], start)];
    let squares: f64 = window.iter().map(|w| w * w).sum();
    let shared: f64 = window.iter().zip(window.iter().skip(step)).map(|(one, other)| one * other).sum();
    let (all, rho) = (segments as f64, (shared / squares) * (shared / squares));
    Some(Blocks {
        spacing: 2.0 * PI / (length as f64 * time_step),
        lines: (0..segments).map(|segment| both(segment * step)).collect(),
        independent: all / (1.0 + 2.0 * rho * (1.0 - 1.0 / all)),
        is_repeated: false,
    })
}

impl Blocks {
    /// Equivalent number of independent blocks.
    pub fn independent(&self) -> f64 {
        self.independent
    }

    /// Number of blocks.
    pub fn count(&self) -> usize {
        self.lines.len()
    }

    /// Response at each line except that of the mean.
    ///
    /// ```text
    /// one input in all blocks:   G = sum Y / sum U        otherwise:  G = sum U* Y / sum |U|^2   (H1)
    /// sigma^2 = sum |Y - G U|^2/(n - 1) / sum |U|^2       sigma^2 = m/(m - 1) K/n_d sum |U|^2 |Y - G U|^2/(sum |U|^2)^2
    /// m = n_d/K (sum |U|^2)^2/sum |U|^4
    /// gamma^2 = |sum U* Y|^2/(sum |U|^2 sum |Y|^2)
    /// ```
    ///
    /// The first counts noise of the input as well (Pintelon and Schoukens 2012, section 2.4). In
    /// the second a segment is weighted by its excitation (White 1980), m times in all: a sweep
    /// passes a frequency in only one or two segments, which also contain its leakage. With equal
    /// excitation the formula reduces to that of Bendat and Piersol (2010), section 9.2: (1 -
    /// gamma^2) S_yy/((n - 1) S_uu).
    pub fn points(&self) -> Vec<SpectralPoint> {
        let lines = self.lines.first().map_or(0, |[input, _]| input.len());
        let (mut points, scatter): (Vec<SpectralPoint>, Vec<f64>) =
            (1..lines).map(|line| self.point(line)).unzip();
        if self.is_repeated {
            self.without_noise(&mut points, &scatter);
        }
        let strongest = points.iter().map(|point| point.excitation).fold(0.0, f64::max);
        for point in &mut points {
            point.excitation /= strongest;
        }
        points
    }

    /// Removes the excitation from lines of the input whose mean over the periods is no larger than
    /// noise, estimated from the differences between periods there and at the lines around.
    fn without_noise(&self, points: &mut [SpectralPoint], scatter: &[f64]) {
        for (index, point) in points.iter_mut().enumerate() {
            let around = index.saturating_sub(AROUND)..(index + AROUND + 1).min(scatter.len());
            let count = around.len() as f64;
            let noise = scatter.get(around).unwrap_or_default().iter().sum::<f64>() / count;
            let most = fisher(count * (self.independent - 1.0), NOISE) * noise;
            point.excitation = if point.excitation < most { 0.0 } else { point.excitation };
        }
    }

    /// Point of a line, with the power of the input as excitation, and the variance of the input
    /// there.
    fn point(&self, line: usize) -> (SpectralPoint, f64) {
        let pairs = || {
            let at = |values: &[Complex64]| values.get(line).copied().unwrap_or_default();
            self.lines.iter().map(move |[input, output]| (at(input), at(output)))
        };
        let input_power: f64 = pairs().map(|(input, _)| input.norm_sqr()).sum();
        let output_power: f64 = pairs().map(|(_, output)| output.norm_sqr()).sum();
        let cross: Complex64 = pairs().map(|(input, output)| input.conj() * output).sum();
        let sums = pairs().fold([Complex64::ZERO; 2], |[inputs, outputs], (input, output)| {
            [inputs + input, outputs + output]
        });
        let response = if self.is_repeated { sums[1] / sums[0] } else { cross / input_power };
        let rests =
            || pairs().map(|(input, output)| [input, output - response * input].map(|line| line.norm_sqr()));
        let rest: f64 = rests().map(|[_, rest]| rest).sum();
        let power = if self.is_repeated { sums[0].norm_sqr() / self.independent } else { input_power };
        let scatter = (input_power - power).max(0.0) / (self.independent - 1.0);
        let coherence = cross.norm_sqr() / (input_power * output_power);
        let (variance, independent) = if self.is_repeated {
            (rest / (self.independent - 1.0) / power, self.independent)
        } else {
            // a block is weighted by the excitation of the input in it, and so is its noise or
            // leakage
            let alike = self.independent / self.lines.len() as f64;
            let squares: f64 = rests().map(|[power, _]| power * power).sum();
            let independent = alike * input_power * input_power / squares;
            let weighed: f64 = rests().map(|[power, rest]| power * rest).sum();
            let few = independent / (independent - 1.0);
            (weighed / (input_power * input_power) / alike * few, independent)
        };
        let deviation = if variance >= 0.0 { variance.sqrt() } else { f64::INFINITY };
        let point = SpectralPoint {
            frequency: line as f64 * self.spacing,
            response,
            coherence: if coherence.is_finite() { coherence.min(1.0) } else { 0.0 },
            deviation,
            radius: disc_radius(deviation, independent),
            freedom: independent - 1.0,
            excitation: power,
        };
        (point, scatter)
    }
}
