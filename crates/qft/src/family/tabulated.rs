//! The response of a plant without polynomials as a table, dense where the response bends.

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;

use super::MeasuredPlant;

/// Number of points per decade before refinement.
const POINTS_PER_DECADE: f64 = 25.0;
/// Relative deviation of a response from the interpolated value halfway between two points allowed
/// in tables that replace a plant.
pub const FINE: f64 = 2e-3;
/// Allowed relative deviation in tables that only show the frequencies at which a response bends.
pub(crate) const COARSE: f64 = 3e-2;
/// Least distance of two points, relative to their frequency.
const CLOSEST: f64 = 1e-6;

/// Frequency, rad/s, and both paths there.
pub(crate) type TabulatedPoint = (f64, [Complex64; 2]);

/// The response between two frequencies, rad/s, at points so dense that the value that
/// [`MeasuredPlant::response`] interpolates halfway between any two of them has at most this
/// relative error ([`FINE`] is 0.2 %), for searches that evaluate it thousands of times.
///
/// # Example
/// Plant exp(-s/10)/(s + 1), given by its response: the table equals that response to 0.2 %, also
/// between its points.
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::analytic::Disc;
/// use phea_dynamics::portable::{exp_complex, magnitude};
/// use phea_dynamics::uncertain_plant::responding::RespondingPlant;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
/// use phea_qft::family::{FINE, tabulated};
/// #[derive(Debug)]
/// struct LateLag;
/// impl RespondingPlant for LateLag {
///     fn response(&self, w: f64) -> [Complex64; 2] {
///         [exp_complex(Complex64::new(0.0, -0.1 * w)) / Complex64::new(1.0, w); 2]
///     }
///     fn unstable_poles(&self) -> Option<usize> {
///         Some(0)
///     }
/// #     fn enclosure(&self, _: [f64; 2]) -> Disc {
/// #         Disc::WHOLE
/// #     }
/// #     fn slow(&self) -> PlantCoefficients<f64> {
/// #         let command = RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, 1.0] };
/// #         PlantCoefficients { command, disturbance: None, dead_time_s: 0.1, rate: None }
/// #     }
/// #     fn roll_off(&self, _: f64) -> Option<f64> {
/// #         None
/// #     }
/// #     fn range_rad_per_s(&self) -> [f64; 2] {
/// #         [0.01, 100.0]
/// #     }
/// #     fn echo_s(&self) -> f64 {
/// #         0.1
/// #     }
/// }
/// let table = tabulated(&LateLag, [0.01, 100.0], FINE);
/// let (told, _) = table.response(3.21).ok_or("within the table")?;
/// let [truth, _] = LateLag.response(3.21);
/// assert!(magnitude(told / truth - 1.0) < 2e-3);
/// # Ok::<(), &str>(())
/// ```
pub fn tabulated(plant: &dyn RespondingPlant, range: [f64; 2], tolerance: f64) -> MeasuredPlant {
    let points = points(|frequency| Some(plant.response(frequency)), range, tolerance);
    let unstable_poles = plant.unstable_poles();
    table(points, unstable_poles)
}

/// The table of these points, with the number of unstable poles of the plant, if it is known.
pub(crate) fn table(found: Vec<TabulatedPoint>, unstable_poles: Option<usize>) -> MeasuredPlant {
    MeasuredPlant {
        name: String::new(),
        frequencies_rad_per_s: found.iter().map(|point| point.0).collect(),
        command: found.iter().map(|point| point.1[0]).collect(),
        disturbance: Some(found.iter().map(|point| point.1[1]).collect()),
        radii: Vec::new(),
        integrators: None,
        is_resolved: unstable_poles.is_some(),
        unstable_poles: unstable_poles.unwrap_or(0),
    }
}

/// Both paths between two frequencies, rad/s, as dense as a table of this tolerance requires;
/// points without a response are omitted.
pub(crate) fn points(
    response: impl Fn(f64) -> Option<[Complex64; 2]>,
    [from, to]: [f64; 2],
    tolerance: f64,
) -> Vec<TabulatedPoint> {
    let at = |frequency: f64| Some((frequency, response(frequency)?));
    let decades = portable::ln(to / from) / std::f64::consts::LN_10;
    let grid = logarithmic_grid(from, to, (POINTS_PER_DECADE * decades).ceil() as usize).unwrap_or_default();
    let mut left: Vec<TabulatedPoint> = grid.iter().rev().filter_map(|frequency| at(*frequency)).collect();
    let mut found: Vec<TabulatedPoint> = Vec::with_capacity(2 * left.len());
    found.extend(left.pop());
    while let (Some(&next), Some(&previous)) = (left.last(), found.last()) {
        let close = next.0 - previous.0 <= CLOSEST * next.0;
        let is_bent = |middle: &TabulatedPoint| {
            !close && (0..2).any(|path| apart(previous.1[path], middle.1[path], next.1[path]) > tolerance)
        };
        match at((previous.0 * next.0).sqrt()).filter(is_bent) {
            Some(middle) => left.push(middle),
            None => {
                found.push(next);
                left.pop();
            }
        }
    }
    found
}

/// Relative deviation of the value halfway between two points from their geometric mean.
fn apart(from: Complex64, middle: Complex64, to: Complex64) -> f64 {
    let turn = to / from;
    let half = Complex64::new(portable::ln(portable::magnitude(turn)), portable::argument(turn)) / 2.0;
    let mean = from * portable::exp_complex(half);
    portable::magnitude(middle / mean - 1.0)
}
