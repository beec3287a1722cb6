//! Errors that grow although no mode grows.

use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{
    GrowthCause, Input, InputSchedule, Profile, SimulationSettings, Status, System, simulate,
};

/// An oscillator whose stiffness is an input: x'' + 2 zeta x' + w x = 0.
#[derive(Clone)]
struct Meissner {
    damping: f64,
    kinks: usize,
}

impl System<f64> for Meissner {
    fn states(&self) -> usize {
        2
    }
    fn inputs(&self) -> usize {
        1
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0, 1.0]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], u: &[T], rates: &mut [T]) {
        rates[0] = y[1];
        rates[1] = -u[0] * y[0] - y[1].times(2.0 * self.damping);
    }
    fn kinks(&self) -> usize {
        self.kinks
    }
    fn mark<T: Scalar + From<f64>>(&self, y: &[T], _u: &[T], marks: &mut [T]) {
        marks.iter_mut().for_each(|mark| *mark = y[0]);
    }
}

const HALF_S: f64 = std::f64::consts::FRAC_PI_2;
const PERIODS: usize = 30;

/// The stiffness alternates between 1 and 1 + and - `depth`, so that the motion is parametrically
/// excited.
fn growth(depth: f64, kinks: usize) -> Option<(f64, GrowthCause)> {
    let system = Meissner { damping: 0.05, kinks };
    let steps = (0..2 * PERIODS).map(|half| {
        let sign = if half % 2 == 0 { 1.0 } else { -1.0 };
        (HALF_S * half as f64, 1.0 + sign * depth)
    });
    let steps: Vec<(f64, f64)> = steps.skip(1).collect();
    let stiffness = Profile::steps(1.0 + depth, &steps).unwrap();
    let duration_s = HALF_S * 2.0 * PERIODS as f64;
    let schedule = InputSchedule { duration_s, output_step_s: 1.0, inputs: vec![Input::Value(stiffness)] };
    let settings = SimulationSettings { tolerance: 1e-8, ..SimulationSettings::default() };
    let run = simulate(&system, &[1.0, 0.0], &schedule, None, &settings, &mut |_| true).unwrap();
    assert_eq!(run.outcome.status, Status::Completed);
    run.outcome.amplification.map(|grown| (grown.logarithm, grown.cause))
}

/// Both pieces are damped, but their product grows by the spectral radius of
///
/// ```text
/// M = E(w_2) E(w_1),   tr M = e^(-2 z T) (2 c_1 c_2 - (O_1/O_2 + O_2/O_1) s_1 s_2),   det M = e^(-4 z T)
/// O_i = sqrt(w_i - z^2),  c_i, s_i = cos, sin O_i T        T half a period; Meissner (1918)
/// ```
#[test]
fn an_error_grows_from_piece_to_piece_as_the_product_of_both() {
    let half = |w: f64| {
        let rate = (w - 0.05_f64 * 0.05).sqrt();
        (rate, portable::cos(rate * HALF_S), portable::sin(rate * HALF_S))
    };
    let ((o1, c1, s1), (o2, c2, s2)) = (half(1.5), half(0.5));
    let trace = portable::exp(-0.1 * HALF_S) * (2.0 * c1 * c2 - (o1 / o2 + o2 / o1) * s1 * s2);
    let determinant = portable::exp(-0.2 * HALF_S);
    let radius = 0.5 * (trace.abs() + (trace * trace - 4.0 * determinant).sqrt());
    let expected = PERIODS as f64 * portable::ln(radius);
    assert!(expected > 10.0);
    let (logarithm, cause) = growth(0.5, 1).unwrap();
    // the initial error is not the one that grows most
    assert!((logarithm - expected).abs() < 1.5, "{logarithm} {expected}");
    assert_eq!(cause, GrowthCause::Motion);
}

/// An oscillator with damping only does not grow, and one without kinks is not followed.
#[test]
fn a_damped_motion_amplifies_nothing() {
    assert!(growth(0.01, 1).is_none_or(|(logarithm, _)| logarithm < 1.0));
    assert_eq!(growth(0.5, 0), None);
}
