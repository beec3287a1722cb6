use num_complex::Complex64;

use super::SpectralPoint;
use super::estimate::{OUTSIDE, fisher};

/// Relative difference up to which two frequencies count as equal: the rounding of a time step.
const SAME: f64 = 1e-6;
/// Ratio of distance to frequency up to which a response is interpolated between two points.
const GAP: f64 = 0.1;

/// Two independent estimates of a response at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponsePair {
    /// Frequency, rad/s.
    pub frequency: f64,
    /// Estimates of the response.
    pub responses: [Complex64; 2],
    /// Sum of the variances, sigma_1^2 + sigma_2^2.
    variance: f64,
    /// Complex degrees of freedom of the less certain of the two variances.
    freedom: f64,
    /// Bound on the error of the interpolation.
    interpolation: f64,
}

impl ResponsePair {
    /// Distance between the estimates, in the unit of the responses.
    pub fn distance(&self) -> f64 {
        (self.responses[1] - self.responses[0]).norm_sqr().sqrt()
    }

    /// Distance that two estimates of one response exceed with at most this probability.
    ///
    /// ```text
    /// d^2 = F(2, 2 q) (sigma_1^2 + sigma_2^2),    q = min(q_1, q_2),    F(2, 2 q) = q (p^(-1/q) - 1)
    /// ```
    ///
    /// With lambda_i the part of sigma_i^2 in the true variance of the difference, and variances
    /// with q_1 and q_2 complex degrees of freedom, the probability of a distance above `c
    /// (sigma_1^2 + sigma_2^2)` is the product of (1 + c lambda_i/q_i)^(-q_i). Its logarithm is
    /// convex in lambda, so that it is largest where one of them is 1: the probability is p where
    /// the noise of the estimate with the smaller q dominates, and less otherwise. The bound of the
    /// interpolation error is added.
    pub fn distance_by_chance(&self, probability: f64) -> f64 {
        (fisher(self.freedom, probability) * self.variance).sqrt() + self.interpolation
    }
}

/// Response at a frequency, from the points of an estimate.
struct EstimateAt {
    response: Complex64,
    variance: f64,
    freedom: f64,
    interpolation: f64,
}

/// Frequencies at which two estimates can be compared, the lowest first.
///
/// The frequencies are those of the estimate with fewer points; both have their points in the order
/// of frequency. If the other has no point at a frequency, it is interpolated between two points
/// that are at most a tenth of the frequency apart, f_1 < f < f_2:
///
/// ```text
/// G(f) = G_1 + (G_2 - G_1) (f - f_1)/(f_2 - f_1),    error <= max |G[f_i, f_j, f_k]| (f - f_1) (f_2 - f)
/// ```
///
/// with the second divided differences over these two and the point below or above.
///
/// # Example
/// An estimate has no distance from itself, and noise explains it.
/// ```
/// use phea_dynamics::random::{normal, stream};
/// use phea_dynamics::spectrum::{local_polynomials, pairs};
/// let mut state = stream(1, 0);
/// let input: Vec<f64> = (0..256).map(|_| normal(&mut state)).collect();
/// let output: Vec<f64> = input.iter().map(|value| 3.0 * value + normal(&mut state)).collect();
/// let points = local_polynomials(&input, [&input, &output], 0.01);
/// let pairs = pairs(&points, &points);
/// assert_eq!(pairs.len(), points.len());
/// assert!(pairs.iter().all(|pair| pair.distance() < pair.distance_by_chance(0.05)));
/// ```
pub fn pairs(one: &[SpectralPoint], other: &[SpectralPoint]) -> Vec<ResponsePair> {
    let is_swapped = other.len() < one.len();
    let (fewer, more) = if is_swapped { (other, one) } else { (one, other) };
    let pair = |point: &SpectralPoint| {
        let known = [known(point), at(more, point.frequency)?];
        let responses = [known[0].response, known[1].response];
        Some(ResponsePair {
            frequency: point.frequency,
            responses: if is_swapped { [responses[1], responses[0]] } else { responses },
            variance: known[0].variance + known[1].variance,
            freedom: known[0].freedom.min(known[1].freedom),
            interpolation: known[1].interpolation,
        })
    };
    fewer.iter().filter_map(pair).collect()
}

/// Estimate at one of its points. Its variance is that of the disc, which includes a noisy input.
fn known(point: &SpectralPoint) -> EstimateAt {
    EstimateAt {
        response: point.response,
        variance: point.radius * point.radius / fisher(point.freedom, OUTSIDE),
        freedom: point.freedom,
        interpolation: 0.0,
    }
}

/// Response at a frequency; `None` if no points are close enough.
fn at(points: &[SpectralPoint], frequency: f64) -> Option<EstimateAt> {
    let index = points.partition_point(|point| point.frequency < frequency * (1.0 - SAME));
    let above = points.get(index)?;
    if above.frequency <= frequency * (1.0 + SAME) {
        return Some(known(above));
    }
    let below = points.get(index.checked_sub(1)?)?;
    if above.frequency - below.frequency > GAP * frequency {
        return None;
    }
    let curvature = |third: Option<usize>| {
        let third = points.get(third?)?;
        Some(second_difference([below, above, third]).norm_sqr().sqrt())
    };
    let curvatures = [curvature(index.checked_sub(2)), curvature(Some(index + 1))];
    let curvature = curvatures.into_iter().flatten().reduce(f64::max)?;
    let place = (frequency - below.frequency) / (above.frequency - below.frequency);
    let [lower, upper] = [known(below), known(above)];
    Some(EstimateAt {
        response: lower.response + (upper.response - lower.response) * place,
        variance: lower.variance * (1.0 - place) * (1.0 - place) + upper.variance * place * place,
        freedom: lower.freedom.min(upper.freedom),
        interpolation: curvature * (frequency - below.frequency) * (above.frequency - frequency),
    })
}

/// Second divided difference G[f_1, f_2, f_3], half of the second derivative.
fn second_difference([one, two, three]: [&SpectralPoint; 3]) -> Complex64 {
    let slope = |from: &SpectralPoint, to: &SpectralPoint| {
        (to.response - from.response) / (to.frequency - from.frequency)
    };
    (slope(two, three) - slope(one, two)) / (three.frequency - one.frequency)
}
