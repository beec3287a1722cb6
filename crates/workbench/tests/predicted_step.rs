//! The predicted step of a loop with rational plant is shown until it no longer leaves its band.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::ln;
use phea_dynamics::time_response::Settling;
use phea_engineering::linear_loop::linear_loop;

const SAMPLE_TIME_S: f64 = 1e-3;

/// Loop of P = k/(s + b) with G = (s + 1)/s.
fn loop_settles(k: f64, b: f64, sample_time_s: Option<f64>, band_percent: f64) -> (Settling, f64) {
    let real = |root: f64| Complex64::new(root, 0.0);
    let plant = TransferFunction::from_factors(k, vec![], vec![real(-b)]).unwrap();
    let integral = Element::ProportionalIntegral { proportional_gain: 1.0, integral_gain: 1.0 };
    let mut controller = Controller { feedback: Compensator::new(vec![integral]), ..Controller::default() };
    controller.timing.sample_time_s = sample_time_s;
    let unity = TransferFunction::gain_only(1.0);
    let step = linear_loop(&plant, &controller, &unity, band_percent).unwrap().step.unwrap();
    (step.metrics.settling, step.metrics.rise_time_10_90_s.unwrap())
}

/// Closed loop T = k (s + 1)/(s^2 + (b + k) s + k) has the slow pole p2 close to its zero; its step
/// is 1 - c1 exp(-p1 t) - c2 exp(-p2 t) with c2 = k (1 - p2)/((p1 - p2) p2).
#[test]
fn a_small_tail_out_of_the_band_is_predicted() {
    let (k, b) = (40.0_f64, 2.6_f64);
    let sum = b + k;
    let p1 = (sum + (sum * sum - 4.0 * k).sqrt()) / 2.0;
    let p2 = k / p1;
    assert!((1.0 - p2) / p2 < 0.05, "the tail is no small one: {p2}");
    let tail = k * (1.0 - p2) / ((p1 - p2) * p2);
    let settles_s = ln(tail / 0.02) / p2;
    for sample_time_s in [None, Some(SAMPLE_TIME_S)] {
        let (settling, rise_s) = loop_settles(k, b, sample_time_s, 2.0);
        let found = settling.time_s().expect("settles");
        assert!((found - settles_s).abs() < 3e-3, "{found} {settles_s} {sample_time_s:?}");
        // The resolution is that of a loop without slow poles; the tail hardly changes meanwhile.
        let expected = ln((0.9 - tail) / (0.1 - tail)) / p1;
        assert!((rise_s / expected - 1.0).abs() < 0.05, "{rise_s} {expected}");
    }
}

/// The slow pole and the zero of a sampled loop are, in z, within 1 in a thousand whatever their
/// rates: the decay rate decides.
#[test]
fn a_sampled_loop_is_predicted_for_the_same_duration() {
    for (k, b) in [(10.0, 1.5), (100.0, 10.0), (200.0, 30.0)] {
        let [continuous, sampled] = [None, Some(SAMPLE_TIME_S)]
            .map(|sample_time_s| loop_settles(k, b, sample_time_s, 2.0).0.time_s().expect("settles"));
        assert!((sampled - continuous).abs() < 5e-3, "{sampled} {continuous}");
    }
}
