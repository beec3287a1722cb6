//! Rates with a kink, as friction has at standstill.

use std::f64::consts::PI;

use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;

use super::laws::{Law, Lawful, last, run, schedule};

/// x' = 1,  y' = |x - p|
#[derive(Clone)]
struct Bent(f64);

impl Law for Bent {
    const STATES: usize = 2;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = T::from(1.0);
        rates[1] = (y[0] - T::from(self.0)).abs();
    }
}

/// Result y(1) = (p^2 + (1 - p)^2)/2 at a thousand p. Rejected and shortened steps do not end where
/// their error estimate is blind; the remaining errors are first attempts that happen to begin so.
#[test]
fn a_kink_is_located_to_the_tolerance_anywhere() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut refused = 0;
        let mut errors: Vec<f64> = (0..1000)
            .map(|index| {
                let place = 0.2 + 7e-4 * f64::from(index);
                let law = Lawful(Bent(place), 1.0);
                let result = run(&law, &[0.0; 2], &schedule(1.0, 1.0, vec![]), tolerance);
                refused += result.outcome.work.rejected;
                let exact = 0.5 * (place * place + (1.0 - place) * (1.0 - place));
                (last(&result, 1) - exact).abs() / tolerance
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        assert!(errors[900] < 3.0, "{tolerance:e}: {:?}", &errors[900..]);
        assert!(refused > 1000, "the kink is met by attempts: {refused}");
    }
}

/// Motion with its kink listed.
#[derive(Clone)]
struct Marked(f64);

impl Law for Marked {
    const STATES: usize = 2;
    const KINKS: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], w: &[T], rates: &mut [T]) {
        Bent(self.0).rates(y, w, rates);
    }

    fn mark<T: Scalar>(&self, y: &[T], _: &[T], marks: &mut [T]) {
        marks[0] = y[0] - T::from(self.0);
    }
}

/// No step with a listed kink errs by more than a few tolerances, for any position of the kink,
/// including first attempts.
#[test]
fn every_step_ends_at_a_known_kink() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        for index in 0..1000 {
            let place = 1e-3 + 9.98e-4 * f64::from(index);
            let law = Lawful(Marked(place), 1.0);
            let result = run(&law, &[0.0; 2], &schedule(1.0, 1.0, vec![]), tolerance);
            let exact = 0.5 * (place * place + (1.0 - place) * (1.0 - place));
            let error = (last(&result, 1) - exact).abs() / tolerance;
            assert!(error < 4.0, "{tolerance:e} at {place}: {error}");
        }
    }
}

/// A ball that falls on a spring, x'' = -1 + k (-x)+, from a height h: it returns after a fall,
/// part of an oscillation on the spring, and a rise.
#[derive(Clone)]
struct Ball(f64);

impl Law for Ball {
    const STATES: usize = 2;
    const KINKS: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = y[1];
        rates[1] = T::from(self.0) * (-y[0]).maximum(T::from(0.0)) - T::from(1.0);
    }

    fn mark<T: Scalar>(&self, y: &[T], _: &[T], marks: &mut [T]) {
        marks[0] = y[0];
    }
}

#[test]
fn a_ball_comes_back_to_its_height() {
    for stiffness in [1e2, 1e4, 1e6] {
        for index in 0..60 {
            let height = 0.3 + 0.01 * f64::from(index);
            let (speed, frequency) = ((2.0 * height).sqrt(), stiffness.sqrt());
            // ORIGIN: analytic, the penetration (1 - cos wt)/k + v/w sin wt vanishes again where
            // tan(wt/2) = -v w
            let touch = 2.0 * (PI - portable::atan2(speed * frequency, 1.0)) / frequency;
            let period = 2.0 * speed + touch;
            let law = Lawful(Ball(stiffness), 1.0);
            let result = run(&law, &[height, 0.0], &schedule(period, period, vec![]), 1e-7);
            let error = [last(&result, 0) - height, last(&result, 1)].map(f64::abs);
            assert!(error[0] < 2e-6 && error[1] < 2e-5, "{stiffness} from {height}: {error:?}");
        }
    }
}

/// Bristles under a velocity cos t: z' = v - |v| z, by the distance since the last reversal. States
/// sin t, cos t and z.
#[derive(Clone)]
struct Bristles;

impl Law for Bristles {
    const STATES: usize = 3;
    const KINKS: usize = 1;

    fn rates<T: Scalar>(&self, y: &[T], _: &[T], rates: &mut [T]) {
        rates[0] = y[1];
        rates[1] = -y[0];
        rates[2] = y[1] - y[1].abs() * y[2];
    }

    fn mark<T: Scalar>(&self, y: &[T], _: &[T], marks: &mut [T]) {
        marks[0] = y[1];
    }
}

#[test]
fn bristles_follow_their_closed_form_through_reversals() {
    for tolerance in [1e-5, 1e-7, 1e-9] {
        for index in 1..=100 {
            let until = 0.4 * f64::from(index);
            let result =
                run(&Lawful(Bristles, 1.0), &[0.0, 1.0, 0.0], &schedule(until, until, vec![]), tolerance);
            // ORIGIN: analytic, z = s + (z_0 - s) exp(-way), s the sign of the velocity
            let (mut bristle, mut time, mut sign) = (0.0, 0.0_f64, 1.0);
            let mut reversal = 0.5 * PI;
            while time < until {
                let end = reversal.min(until);
                let way = (portable::sin(end) - portable::sin(time)).abs();
                bristle = sign + (bristle - sign) * portable::exp(-way);
                (time, sign, reversal) = (end, -sign, reversal + PI);
            }
            let error = (last(&result, 2) - bristle).abs() / tolerance;
            assert!(error < 30.0, "{tolerance:e} until {until}: {error}");
        }
    }
}
