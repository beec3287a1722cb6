//! Discs narrowed by means of neighbouring rows: a response is smooth over frequency, and the noise
//! of its rows is not.
//!
//! ```text
//! ln(P_j/P_i) ~ a + b x + c x^2,    x = ln(w_j/w_i),    j = i - k d to i + k d,    weights 1/sigma_j^2,    k = 3, 5, 8, 12
//! r_i = J_i (sum h_j^2 sigma_j^2)^(1/2) + 2 |a - a'|       |P - P_i e^a| <= |P_i e^a| (e^r_i - 1)
//! ```
//!
//! h_j are the weights of the fit, J_i is the factor for simultaneous validity in all rows, and a'
//! is that of the next window. The window grows as long as its rows scatter about the parabola as
//! their own discs predict, and as long as its result agrees with the smaller ones; the last but
//! one of these windows is used, whose bias is well below that for which the last one was tested.
//! Next to a resonance with few rows no window passes, and the row retains its own disc.
//!
//! Correlated noise of neighbours, as in segments with a window, hides in the parabola and leaves
//! too little scatter: then only every second or third row is used, or none.

use nalgebra::Matrix3;
use num_complex::Complex64;
use phea_dynamics::portable;

/// Numbers of neighbours to either side.
const WINDOWS: [usize; 4] = [3, 5, 8, 12];
/// Distances of neighbours, rows.
const STRIDES: [usize; 3] = [1, 2, 3];
/// Standard deviations by which a window may disagree with smaller ones, and its scatter with the
/// discs.
const AGREES: f64 = 2.0;
/// Bound of the bias of a window, as a multiple of the step to the next one.
const BIAS: f64 = 2.0;
/// Least scatter that independent rows leave, relative to the prediction of their discs.
const LEAST_SCATTER: f64 = 0.75;
/// Fraction of the rows that must have been compared for this.
const COMPARED: f64 = 0.5;
/// Largest standard deviation, relative to the response, for which its logarithm is used.
const LARGEST_NOISE: f64 = 0.2;
/// Largest turn of the response from a row to the next in a window, rad.
const LARGEST_TURN: f64 = 1.0;
/// Coefficients of a parabola.
const ORDER: usize = 3;

/// A measured response with discs. Rows in the order of increasing frequency.
pub(super) struct Discs<'a> {
    pub(super) frequencies: &'a [f64],
    pub(super) response: &'a [Complex64],
    /// Standard deviation of each row's complex error.
    pub(super) deviations: &'a [f64],
    /// Radii for simultaneous validity in all rows.
    pub(super) radii: &'a [f64],
}

/// One window about a row: the logarithm of the response there, its standard deviation, and the
/// scatter about the parabola, relative to that of the discs, with its degrees of freedom.
#[derive(Clone, Copy)]
struct ParabolaFit {
    value: Complex64,
    deviation: f64,
    scatter: f64,
    freedom: f64,
}

/// Response and radii by the smoothness of the response; `None` if the scatter of the rows is not
/// that of independent errors.
pub(super) fn smoothed(discs: &Discs<'_>) -> Option<(Vec<Complex64>, Vec<f64>)> {
    let is_known = |value: &f64| value.is_finite() && *value > 0.0;
    if !discs.deviations.iter().all(is_known) || !discs.radii.iter().all(is_known) {
        return None;
    }
    STRIDES.into_iter().find_map(|stride| discs.with_stride(stride))
}

impl Discs<'_> {
    fn with_stride(&self, stride: usize) -> Option<(Vec<Complex64>, Vec<f64>)> {
        let count = self.response.len();
        let (mut found, mut radii) = (self.response.to_vec(), self.radii.to_vec());
        let (mut scatter, mut freedom, mut compared) = (0.0, 0.0, 0.0);
        for row in 0..count {
            if let Some(first) = self.fit(row, WINDOWS[0], stride) {
                scatter += first.scatter * first.freedom;
                freedom += first.freedom;
                compared += 1.0;
            }
            let Some((fit, beyond)) = self.narrowed(row, stride) else { continue };
            let factor = self.radii[row] / self.deviations[row];
            let value = self.response[row] * portable::exp_complex(fit.value);
            let own = factor * fit.deviation + beyond;
            found[row] = value;
            radii[row] = portable::magnitude(value) * (portable::exp(own) - 1.0);
        }
        let shows = compared >= COMPARED * count as f64 && scatter >= LEAST_SCATTER * freedom;
        shows.then_some((found, radii))
    }

    /// The last but one of the windows that agree with all smaller ones, and the distance of the
    /// last one from it; `None` if a row has only its own disc.
    fn narrowed(&self, row: usize, stride: usize) -> Option<(ParabolaFit, f64)> {
        let relative = self.deviations[row] / portable::magnitude(self.response[row]);
        let own = ParabolaFit {
            value: Complex64::new(0.0, 0.0),
            deviation: relative,
            scatter: 1.0,
            freedom: f64::INFINITY,
        };
        let mut fits = vec![own];
        for half in WINDOWS {
            let Some(next) = self.fit(row, half, stride) else { break };
            let scatters = next.scatter > 1.0 + AGREES * (2.0 / next.freedom).sqrt();
            let disagrees = fits.iter().any(|fit| {
                let variance = fit.deviation * fit.deviation - next.deviation * next.deviation;
                portable::magnitude(fit.value - next.value) > AGREES * variance.max(0.0).sqrt()
            });
            if scatters || disagrees {
                break;
            }
            fits.push(next);
        }
        match fits[..] {
            [.., fit, last] if fits.len() > 2 => {
                Some((fit, BIAS * portable::magnitude(fit.value - last.value)))
            }
            _ => None,
        }
    }

    /// Parabola of the rows up to this number of strides to either side; `None` if a row has too
    /// much noise or the response turns too far between two of them.
    fn fit(&self, row: usize, half: usize, stride: usize) -> Option<ParabolaFit> {
        let rows = self.window(row, half, stride)?;
        if rows.len() <= ORDER + 1 {
            return None;
        }
        let reach = rows.iter().map(|one| one.place.abs()).fold(0.0, f64::max);
        let powers = |one: &WindowRow| {
            let x = one.place / reach;
            [1.0, x, x * x]
        };
        let mut normal = [[0.0; ORDER]; ORDER];
        for one in &rows {
            let powers = powers(one);
            for (line, own) in normal.iter_mut().zip(powers) {
                for (entry, other) in line.iter_mut().zip(powers) {
                    *entry += own * other / (one.deviation * one.deviation);
                }
            }
        }
        let inverse: [[f64; ORDER]; ORDER] = Matrix3::from(normal).cholesky()?.inverse().into();
        let mut coefficients = [Complex64::new(0.0, 0.0); ORDER];
        for one in &rows {
            let powers = powers(one);
            for (coefficient, line) in coefficients.iter_mut().zip(inverse) {
                let weight: f64 = line.iter().zip(powers).map(|(entry, power)| entry * power).sum();
                *coefficient += one.value * (weight / (one.deviation * one.deviation));
            }
        }
        let off = |one: &WindowRow| {
            let powers = powers(one);
            let line: Complex64 =
                coefficients.iter().zip(powers).map(|(coefficient, power)| coefficient * power).sum();
            (one.value - line).norm_sqr() / (one.deviation * one.deviation)
        };
        let left = (rows.len() - ORDER) as f64;
        Some(ParabolaFit {
            value: coefficients[0],
            deviation: inverse[0][0].sqrt(),
            scatter: rows.iter().map(off).sum::<f64>() / left,
            freedom: 2.0 * left,
        })
    }

    /// Rows of a window, with the phase followed from its middle outwards.
    fn window(&self, row: usize, half: usize, stride: usize) -> Option<Vec<WindowRow>> {
        let middle = self.response[row];
        let mut rows = vec![self.row(row, row, 0.0)?];
        for up in [true, false] {
            let (mut before, mut turned) = (middle, 0.0);
            for step in 1..=half {
                let offset = step * stride;
                let next = if up { row.checked_add(offset) } else { row.checked_sub(offset) };
                let Some((next, &value)) = next.and_then(|next| Some((next, self.response.get(next)?)))
                else {
                    break;
                };
                let turn = portable::argument(value / before);
                if turn.abs() > LARGEST_TURN {
                    return None;
                }
                (before, turned) = (value, turned + turn);
                rows.push(self.row(row, next, turned)?);
            }
        }
        Some(rows)
    }

    fn row(&self, middle: usize, row: usize, turned: f64) -> Option<WindowRow> {
        let [own, of_middle] = [row, middle].map(|one| portable::magnitude(self.response[one]));
        let deviation = self.deviations[row] / own;
        (deviation < LARGEST_NOISE).then(|| WindowRow {
            place: portable::ln(self.frequencies[row] / self.frequencies[middle]),
            value: Complex64::new(portable::ln(own / of_middle), turned),
            deviation,
        })
    }
}

/// One row of a window.
struct WindowRow {
    /// Logarithm of the frequency, ln(w_j/w_i).
    place: f64,
    /// Logarithm of the response, ln(P_j/P_i).
    value: Complex64,
    deviation: f64,
}
