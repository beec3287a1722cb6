//! Test of the rule by which the random rigs judge ringing: forces that pass and forces that fail.

#[allow(dead_code)]
#[path = "random_rigs/roughness.rs"]
mod roughness;

use roughness::{Roughness, is_rough, roughest};

const STEP_S: f64 = 0.25e-3;
const PEAK_N: f64 = 1000.0;

/// Slow variation of the force, and from `from_s` on a ringing at 1500 rad/s.
fn force(amplitude: f64, phase: f64, from_s: f64) -> Vec<f64> {
    let value = |time_s: f64| {
        let ringing = if time_s < from_s { 0.0 } else { amplitude * (1500.0 * time_s + phase).sin() };
        PEAK_N * (1.0 - (-time_s / 0.3).exp()) + ringing
    };
    (0..4001).map(|row| value(f64::from(row) * STEP_S)).collect()
}

/// Force with ringing only between two times.
fn burst(amplitude: f64, from_s: f64, until_s: f64) -> Vec<f64> {
    let (ringing, calm) = (force(amplitude, 0.0, from_s), force(0.0, 0.0, 0.0));
    let row = |time_s: f64| (time_s / STEP_S) as usize;
    let mut force = calm;
    force[row(from_s)..row(until_s)].copy_from_slice(&ringing[row(from_s)..row(until_s)]);
    force
}

fn compared(ours: &[f64], references: [&[f64]; 2]) -> Roughness {
    Roughness::compared(ours, &references, 1500, PEAK_N, STEP_S).expect("rows are left")
}

#[test]
fn the_roughness_of_a_sine_is_its_root_mean_square() {
    // ORIGIN: analytic, A/sqrt 2 times 1 - sin(x)/x with x = 1500 rad/s x 5.125 ms, the half-width
    // of 41 rows
    let half = 1500.0 * 20.5 * STEP_S;
    let expected = 10.0 / 2.0_f64.sqrt() * (1.0 - half.sin() / half).abs();
    let found = roughest(&force(10.0, 0.0, 0.0)[400..], STEP_S);
    assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    assert!(is_rough(found, PEAK_N) && !is_rough(roughest(&force(0.0, 0.0, 0.0)[400..], STEP_S), PEAK_N));
}

#[test]
fn a_calmed_ringing_is_refused_and_another_phase_is_not() {
    let reference = force(10.0, 0.0, 0.5);
    let kicked = force(10.0, 2.0, 0.52);
    let references = [reference.as_slice(), kicked.as_slice()];
    for phase in [0.0, 1.0, 3.0] {
        let found = compared(&force(10.0, phase, 0.51), references);
        assert!(found.windows >= 3 && found.fault().is_none(), "{found:?}");
    }
    for amplitude in [0.0, 1.0, 5.0, 6.5] {
        let found = compared(&force(amplitude, 0.0, 0.5), references);
        assert!(found.fault().is_some_and(|fault| fault.contains("calmed")), "{amplitude}: {found:?}");
    }
    assert!(compared(&force(14.0, 0.0, 0.5), references).fault().is_some());
}

/// The ringing may end within a tenth of a second, and begin a little later than CVODE's.
#[test]
fn a_burst_is_searched_in_neighbouring_windows() {
    let (reference, kicked) = (burst(10.0, 0.61, 0.69), burst(10.0, 0.62, 0.7));
    let references = [reference.as_slice(), kicked.as_slice()];
    let late = compared(&burst(10.0, 0.7, 0.78), references);
    assert!(late.windows >= 1 && late.fault().is_none(), "{late:?}");
    let calmed = compared(&burst(0.0, 0.61, 0.69), references);
    assert!(calmed.fault().is_some_and(|fault| fault.contains("calmed")), "{calmed:?}");
    let elsewhere = compared(&burst(10.0, 0.81, 0.89), references);
    assert!(elsewhere.fault().is_some(), "{elsewhere:?}");
}

/// Ringing whose strength differs between CVODE's own runs is not judged by its strength, but there
/// must be ringing.
#[test]
fn ringing_that_depends_on_rounding_is_detected() {
    let (reference, kicked) = (force(10.0, 0.0, 0.5), force(28.0, 0.0, 0.5));
    let references = [reference.as_slice(), kicked.as_slice()];
    let weak = compared(&force(4.0, 0.0, 0.5), references);
    assert!(weak.windows >= 3 && weak.fault().is_none(), "{weak:?}");
    let calmed = compared(&force(0.1, 0.0, 0.5), references);
    assert!(calmed.fault().is_some_and(|fault| fault.contains("calmed")), "{calmed:?}");
}

/// Ringing before trajectories separate is judged row by row, and ringing below a thousandth of the
/// peak does not count.
#[test]
fn small_and_early_deviations_are_not_judged() {
    let small = force(0.5, 0.0, 0.0);
    let found = compared(&force(0.0, 0.0, 0.0), [&small, &small]);
    assert_eq!((found.windows, found.fault()), (0, None));
    let whole = force(10.0, 0.0, 0.0);
    assert_eq!(Roughness::compared(&whole, &[&whole, &whole], whole.len(), PEAK_N, STEP_S), None);
}
