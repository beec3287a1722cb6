use std::f64::consts::PI;

use num_complex::Complex64;

use super::estimate::fisher;
use super::{SpectralPoint, Transform};

/// Order of the polynomials over a band.
const ORDER: usize = 2;
/// Number of unknowns in a band: the coefficients of the response and those of the transient.
const UNKNOWNS: usize = 2 * (ORDER + 1);
/// Fewest lines in a band: one more than twice the unknowns.
const FEWEST: usize = 2 * UNKNOWNS + 1;
/// Ratio of a band's width to its lowest line, if that exceeds the fewest lines.
const WIDTH: f64 = 0.06;
/// Ratio of the mean square that halving a band explains to the rest above which it is halved.
const LACK_OF_FIT: f64 = 1.3;
/// Probability that noise resembles a reference that moves the input.
const BY_CHANCE: f64 = 1e-4;
/// Fraction of the reference's power in a band that no transient could explain, below which the two
/// cannot be separated.
const SMOOTH: f64 = 1e-3;
/// Fraction of a column or of a signal below which its square is rounding.
const ROUNDING: f64 = 1e-18;

/// Response from an input to an output in bands of a record that need not repeat, by local
/// polynomials (Pintelon and Schoukens 2012, chapter 7).
///
/// ```text
/// [Y; U]_(k+r) = (g_0 + g_1 r + g_2 r^2) R_(k+r) + t_0 + t_1 r + t_2 r^2 + noise,     G(k) = g_0y/g_0u
/// ```
///
/// U, Y and R are the transforms, without a window, of the input, the output and the `reference`, k
/// the middle of a band and r the lines around it. The effect of the time before and after the
/// record, the leakage, is the smooth transient t, so that it biases no line; the residual of the
/// 13 or more lines shows the noise. In an open loop the reference is the input. In a closed loop
/// it is the external excitation: noise that returns through the controller is not part of it,
/// whereas Y/U would tend to -1/C.
///
/// The disc is the set of all G consistent with the estimates at 95 % confidence (Fieller 1954):
///
/// ```text
/// abs(g_0y - G g_0u)^2 <= F(2, 2 q) (s_yy - 2 Re(G* s_yu) + |G|^2 s_uu)/p
/// ```
///
/// with the noise covariance s of q degrees of freedom and p = sum |R|^2 of the part that only g_0
/// explains. The excitation is |g_0u|^2 p per line, the power by which the reference moves the
/// input; it is zero if noise could move the input as much in one of 10,000 cases. The coherence
/// takes the noise of the neighbouring bands: with its own noise, a band would be selected because
/// it is small by chance, and its disc would be too small. Bands are 6 % wide from 217 lines on and
/// are halved where the halves leave significantly less unexplained. Signals are sampled in steps
/// of `time_step` seconds.
///
/// # Example
/// An output of three times the input, for any history before and after the record.
/// ```
/// use phea_dynamics::random::{normal, stream};
/// use phea_dynamics::spectrum::local_polynomials;
/// let mut state = stream(1, 0);
/// let input: Vec<f64> = (0..256).map(|_| normal(&mut state)).collect();
/// let output: Vec<f64> = input.iter().map(|value| 3.0 * value).collect();
/// let points = local_polynomials(&input, [&input, &output], 0.01);
/// assert_eq!(points.len(), 9);
/// for point in points {
///     assert!((point.response.re - 3.0).abs() < 1e-12 && point.response.im.abs() < 1e-12);
///     assert!((point.coherence - 1.0).abs() < 1e-12 && point.radius < 1e-12);
/// }
/// ```
pub fn local_polynomials(reference: &[f64], signals: [&[f64]; 2], time_step: f64) -> Vec<SpectralPoint> {
    let [input, output] = signals;
    let count = reference.len().min(input.len()).min(output.len());
    let transform = Transform::new(count);
    let lines = |signal: &[f64]| -> Vec<Complex64> {
        let signal = signal.get(..count).unwrap_or_default();
        let mean = signal.iter().sum::<f64>() / count.max(1) as f64;
        let centred: Vec<f64> = signal.iter().map(|value| value - mean).collect();
        transform.of_real(&centred).into_iter().take(count.div_ceil(2)).collect()
    };
    let spectra = [lines(reference), lines(output), lines(input)];
    let spacing = 2.0 * PI / (count as f64 * time_step);
    let bands = bands(&spectra);
    let point = |(index, band): (usize, &LineBand)| {
        let neighbours = [index.checked_sub(1), Some(index + 1)].map(|next| bands.get(next?));
        band.point(spacing, neighbours)
    };
    let mut points: Vec<SpectralPoint> = bands.iter().enumerate().map(point).collect();
    let strongest = points.iter().map(|point| point.excitation).fold(0.0, f64::max);
    for point in &mut points {
        point.excitation = if strongest > 0.0 { point.excitation / strongest } else { 0.0 };
    }
    points
}

/// Least equivalent number of independent blocks of a point of [`local_polynomials`].
pub const LOCAL_BLOCKS: f64 = (FEWEST - UNKNOWNS + 1) as f64;

/// Band with the estimates in its middle; first that of the output, then that of the input.
struct LineBand {
    /// Middle of the band, in lines.
    middle: f64,
    lines: f64,
    /// Sum |R|^2 of the part that only the response in the middle explains.
    power: f64,
    /// Gains from the reference.
    gains: [Complex64; 2],
    /// Residual squares.
    rest: [f64; 2],
    /// Products of the residuals, output times the conjugate of the input.
    cross: Complex64,
    /// Squares of the signals.
    squares: [f64; 2],
}

/// All bands from the first line on.
fn bands(spectra: &[Vec<Complex64>; 3]) -> Vec<LineBand> {
    let end = spectra[0].len();
    let (mut first, mut bands) = (1, Vec::new());
    while first + FEWEST <= end {
        let width = FEWEST.max((WIDTH * first as f64) as usize);
        // lines too few for another band belong to the last one
        let width = if first + width + FEWEST > end { end - first } else { width };
        halved(spectra, first, width, &mut bands);
        first += width;
    }
    bands
}

/// Single band, or its halves if they leave significantly less unexplained.
fn halved(spectra: &[Vec<Complex64>; 3], first: usize, count: usize, bands: &mut Vec<LineBand>) {
    let whole = LineBand::of(spectra, first, count);
    let half = count / 2;
    if half < FEWEST {
        bands.extend(whole);
        return;
    }
    let halves = [LineBand::of(spectra, first, half), LineBand::of(spectra, first + half, count - half)];
    let is_one = match (&whole, &halves) {
        (Some(whole), [Some(lower), Some(upper)]) => !whole.is_worse_than(lower, upper),
        (Some(_), _) => true,
        _ => false,
    };
    if is_one {
        bands.extend(whole);
    } else {
        halved(spectra, first, half, bands);
        halved(spectra, first + half, count - half, bands);
    }
}

impl LineBand {
    /// Least squares in these lines. Once an orthonormal basis of all other columns is removed from
    /// reference and signals, one unknown remains (Frisch and Waugh 1933). `None` if nothing
    /// remains of the reference.
    fn of([reference, output, input]: &[Vec<Complex64>; 3], first: usize, count: usize) -> Option<LineBand> {
        let within = |lines: &[Complex64]| lines.get(first..first + count).map(<[Complex64]>::to_vec);
        let (mut reference, mut output, mut input) = (within(reference)?, within(output)?, within(input)?);
        let middle = (count as f64 - 1.0) / 2.0;
        let places: Vec<f64> = (0..count).map(|line| (line as f64 - middle) / middle).collect();
        let mut basis: Vec<Vec<Complex64>> = Vec::with_capacity(UNKNOWNS);
        let mut transient = vec![Complex64::ONE; count];
        let mut column = reference.clone();
        for order in 0..=ORDER {
            if order > 0 {
                transient.iter_mut().zip(&places).for_each(|(value, place)| *value *= place);
                column.iter_mut().zip(&places).for_each(|(value, place)| *value *= place);
                add(&mut basis, column.clone());
            }
            add(&mut basis, transient.clone());
        }
        let whole = square(&reference);
        let squares = [square(&output), square(&input)];
        for signal in [&mut reference, &mut output, &mut input] {
            take_out(&basis, signal);
        }
        let power = square(&reference);
        if power <= SMOOTH * whole || power == 0.0 {
            return None;
        }
        let gains = [&output, &input].map(|signal| product(&reference, signal) / power);
        for (signal, gain) in [&mut output, &mut input].into_iter().zip(gains) {
            signal.iter_mut().zip(&reference).for_each(|(value, column)| *value -= gain * column);
        }
        Some(LineBand {
            middle: first as f64 + middle,
            lines: count as f64,
            power,
            gains,
            rest: [square(&output), square(&input)],
            cross: product(&input, &output),
            squares,
        })
    }

    /// Complex degrees of freedom of the noise.
    fn freedom(&self) -> f64 {
        self.lines - UNKNOWNS as f64
    }

    /// True if two halves leave significantly less of either signal unexplained.
    fn is_worse_than(&self, lower: &LineBand, upper: &LineBand) -> bool {
        let freedom = lower.freedom() + upper.freedom();
        let rests = self.rest.iter().zip(&lower.rest).zip(&upper.rest).zip(&self.squares);
        rests.into_iter().any(|(((whole, lower), upper), square)| {
            let apart = lower + upper;
            let explained = (whole - apart) / UNKNOWNS as f64;
            *whole > ROUNDING * square && explained > LACK_OF_FIT * apart / freedom
        })
    }

    /// Power per line of the noise around a response.
    fn noise(&self, response: Complex64) -> f64 {
        let [output, input] = self.rest;
        let rest = output - 2.0 * (response.conj() * self.cross).re + response.norm_sqr() * input;
        rest.max(0.0) / self.freedom()
    }

    /// Point whose excitation is the power per line by which the reference moves the input.
    fn point(&self, spacing: f64, neighbours: [Option<&LineBand>; 2]) -> SpectralPoint {
        let freedom = self.freedom();
        let [output, input] = self.gains;
        let response = output / input;
        let [of_output, of_input] = self.rest.map(|rest| rest / freedom);
        let cross = self.cross / freedom;
        let moved = input.norm_sqr();
        let noise = self.noise(response);
        let scale = fisher(freedom, 0.05) / self.power;
        let left = moved - scale * of_input;
        let determinant = (of_output * of_input - cross.norm_sqr()).max(0.0);
        let squared = scale * (moved * noise - scale * determinant) / (left * left);
        let middle = (output * input.conj() - scale * cross) / left;
        let is_moved = moved * self.power > fisher(freedom, BY_CHANCE) * of_input;
        let excitation = if is_moved { moved * self.power / self.lines } else { 0.0 };
        let signal = response.norm_sqr() * moved * self.power / self.lines;
        let around: Vec<f64> = neighbours.into_iter().flatten().map(|band| band.noise(response)).collect();
        let usual = if around.is_empty() { noise } else { around.iter().sum::<f64>() / around.len() as f64 };
        let coherence = signal / (signal + usual);
        let apart = (middle - response).norm_sqr().sqrt();
        SpectralPoint {
            frequency: self.middle * spacing,
            response,
            coherence: if coherence.is_finite() { coherence } else { 0.0 },
            deviation: (noise / (self.power * moved)).sqrt(),
            radius: if left > 0.0 { squared.max(0.0).sqrt() + apart } else { f64::INFINITY },
            freedom,
            excitation,
        }
    }
}

/// Sum |x|^2.
fn square(lines: &[Complex64]) -> f64 {
    lines.iter().map(|line| line.norm_sqr()).sum()
}

/// Sum x* y.
fn product(one: &[Complex64], other: &[Complex64]) -> Complex64 {
    one.iter().zip(other).map(|(one, other)| one.conj() * other).sum()
}

/// Removes the columns of an orthonormal basis from a signal; twice, against rounding.
fn take_out(basis: &[Vec<Complex64>], signal: &mut [Complex64]) {
    for column in basis.iter().chain(basis) {
        let along = product(column, signal);
        signal.iter_mut().zip(column).for_each(|(value, column)| *value -= along * column);
    }
}

/// Adds the independent part of a column to an orthonormal basis.
fn add(basis: &mut Vec<Vec<Complex64>>, mut column: Vec<Complex64>) {
    let whole = square(&column);
    take_out(basis, &mut column);
    let new = square(&column);
    if new > ROUNDING * whole {
        let size = new.sqrt();
        basis.push(column.into_iter().map(|value| value / size).collect());
    }
}
