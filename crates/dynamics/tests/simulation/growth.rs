//! Modes that grow are seen to grow, however small they are and however loose the tolerance.

use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{Method, Status, simulate};

use crate::laws::{Law, Lawful, course, settings};

/// Two equal masses between three equal springs, each damped by the negative of a damper; positions x_1, x_2 and velocities over
/// omega.
///
/// ```text
/// x_1'' = omega^2 (x_2 - 2 x_1) + 2 alpha x_1',    x_2'' = omega^2 (x_1 - 2 x_2) + 2 alpha x_2'
/// modes x_1 + x_2 and x_1 - x_2:    lambda = alpha +- i sqrt(omega^2 - alpha^2),  alpha +- i sqrt(3 omega^2 - alpha^2)
/// ```
#[derive(Clone)]
struct TwoMasses {
    omega: f64,
    alpha: f64,
}

impl Law for TwoMasses {
    const STATES: usize = 4;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        let (omega, growth) = (T::from(self.omega), T::from(2.0 * self.alpha));
        let two = T::from(2.0);
        rates[0] = omega * y[2];
        rates[1] = omega * y[3];
        rates[2] = omega * (y[1] - two * y[0]) + growth * y[2];
        rates[3] = omega * (y[0] - two * y[1]) + growth * y[3];
    }
}

impl TwoMasses {
    /// Logarithms of both modes' amplitudes, each of which grows by alpha a second.
    fn amplitudes(&self, y: &[f64]) -> [f64; 2] {
        [(1.0, 1.0), (-1.0, 3.0)].map(|(sign, square)| {
            let (position, velocity) = (y[0] + sign * y[1], self.omega * (y[2] + sign * y[3]));
            let turning = (square * self.omega * self.omega - self.alpha * self.alpha).sqrt();
            portable::ln(portable::hypot(position, (velocity - self.alpha * position) / turning))
        })
    }
}

/// From a part of 1e-9 of critical damping to a tenth, below the tolerance and above it.
#[test]
fn two_masses_grow_at_their_rate() {
    for (place, zeta) in [1e-9, 1e-7, 1e-5, 1e-3, 1e-2, 1e-1].into_iter().enumerate() {
        for tolerance in [1e-3, 1e-5, 1e-7] {
            for start in [1e-9, 1e-3] {
                let omega = 300.0 * (1.0 + place as f64);
                let law = TwoMasses { omega, alpha: zeta * omega };
                let duration_s = (30.0 / omega).max(2.0 / law.alpha.max(1.0)).min(300.0 / omega);
                let begin = [start, -0.3 * start, 0.2 * start, 0.1 * start];
                let system = Lawful(law.clone(), 1.0);
                let settings = settings(tolerance, Method::Rosenbrock);
                let course = course(duration_s, duration_s, vec![]);
                let run = simulate(&system, &begin, &course, None, &settings, &mut |_| true).unwrap();
                assert_eq!(run.outcome.status, Status::Completed);
                let (before, after) = (law.amplitudes(&begin), law.amplitudes(&run.outcome.end));
                for (before, after) in before.into_iter().zip(after) {
                    let rate = (after - before) / duration_s;
                    assert!(
                        (rate / law.alpha - 1.0).abs() < 0.05,
                        "{zeta:e} of critical at {tolerance:e}: {rate} instead of {} 1/s",
                        law.alpha
                    );
                }
            }
        }
    }
}
