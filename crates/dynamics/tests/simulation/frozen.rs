//! Growth of slow modes, and of modes that a delay closes, is reported however fast the others are.

use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{Amplification, Method, System};

use super::laws::{Law, Lawful, schedule, settings, simulate};

/// A damped oscillation of 1 krad/s, and a slow mode, real or oscillating.
///
/// ```text
/// x' = 1000 y,  y' = -1000 x - 200 y;      z' = a z - b v,  v' = b z + a v
/// ```
#[derive(Clone)]
struct SlowAndFast {
    growth: f64,
    turning: f64,
}

impl Law for SlowAndFast {
    const STATES: usize = 4;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        let [growth, turning] = [self.growth, self.turning].map(T::from);
        rates[0] = y[1].times(1e3);
        rates[1] = y[0].times(-1e3) - y[1].times(200.0);
        rates[2] = growth * y[2] - turning * y[3];
        rates[3] = turning * y[2] + growth * y[3];
    }
}

fn grown<E: System<f64>>(system: &E, start: &[f64], duration_s: f64) -> Option<Amplification> {
    let settings = settings(1e-6, Method::Rosenbrock);
    let schedule = schedule(duration_s, duration_s, vec![]);
    simulate(system, start, &schedule, None, &settings, &mut |_| true).unwrap().outcome.amplification
}

#[test]
fn a_slow_mode_that_grows_is_reported() {
    for (growth, turning) in [(2.0, 0.0), (0.7, 0.0), (1.0, 30.0)] {
        let law = SlowAndFast { growth, turning };
        let found = grown(&Lawful(law, 1.0), &[1e-3, 0.0, 1e-9, 1e-9], 8.0).unwrap();
        let expected = growth * 8.0;
        assert!((found.logarithm / expected - 1.0).abs() < 0.1, "{found:?} {expected}");
        assert!(found.from_s < 0.5 && found.frequency_rad_per_s < 40.0, "{found:?}");
    }
    let stable = SlowAndFast { growth: -0.5, turning: 3.0 };
    assert_eq!(grown(&Lawful(stable, 1.0), &[1e-3, 0.0, 0.1, 0.1], 8.0), None);
}

/// A leaking level, measured late and fed back.
///
/// ```text
/// x' = -2 x + k x(t - d),       s + 2 = k e^(-s d)
/// ```
#[derive(Clone)]
struct SeenLate {
    gain: f64,
    delay_s: f64,
}

impl System<f64> for SeenLate {
    fn states(&self) -> usize {
        1
    }
    fn inputs(&self) -> usize {
        1
    }
    fn scales(&self) -> Vec<f64> {
        vec![1.0]
    }
    fn rates<T: Scalar + From<f64>>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        rates[0] = w[0].times(self.gain) - y[0].times(2.0);
    }
    fn delays(&self) -> Vec<f64> {
        vec![self.delay_s]
    }
    fn outgoing<T: Scalar + From<f64>>(&self, y: &[T], _: &[T], waves: &mut [T]) {
        waves[0] = y[0];
    }
}

impl SeenLate {
    /// Real root, by Newton's method.
    fn growth(&self) -> f64 {
        let mut root = 0.0_f64;
        for _ in 0..50 {
            let late = self.gain * portable::exp(-root * self.delay_s);
            root -= (root + 2.0 - late) / (1.0 + self.delay_s * late);
        }
        root
    }
}

#[test]
fn a_loop_that_a_delay_closes_is_reported() {
    for (gain, delay_s) in [(3.0, 0.02), (4.0, 0.1), (8.0, 0.05)] {
        let late = SeenLate { gain, delay_s };
        let duration_s = 12.0 / late.growth();
        let found = grown(&late, &[1e-9], duration_s).unwrap();
        assert!((found.logarithm / 12.0 - 1.0).abs() < 0.1, "{found:?} {}", late.growth());
    }
    assert_eq!(grown(&SeenLate { gain: 1.5, delay_s: 0.1 }, &[1e-3], 10.0), None);
}
