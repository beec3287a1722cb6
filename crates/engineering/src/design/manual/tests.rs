use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;

use super::*;

fn general(gain: f64, zeros: &[[f64; 2]], poles: &[[f64; 2]]) -> Compensator {
    let roots = |pairs: &[[f64; 2]]| pairs.iter().map(|[re, im]| Complex64::new(*re, *im)).collect();
    let function = TransferFunction::from_factors(gain, roots(zeros), roots(poles)).unwrap();
    Compensator::new(vec![Element::General(function)])
}

/// Parts of a law, checked to return G at every frequency, from far below the roots to far above
/// them.
fn words_of(law: &Compensator, name: Option<NamedStructure>) -> Vec<ManualPart> {
    let words = ManualLaw::new(law, name).unwrap();
    let (given, again) = (law.transfer_function().unwrap(), words.compensator().transfer_function().unwrap());
    for exponent in -40..60 {
        let frequency = portable::pow(10.0, 0.1 * f64::from(exponent));
        let [one, other] = [&given, &again].map(|function| function.at_frequency(frequency));
        assert!(
            (one - other).norm_sqr().sqrt() <= 1e-12 * one.norm_sqr().sqrt(),
            "{frequency}: {one} {other}"
        );
    }
    let elements = words.declared();
    assert!(elements.iter().all(|element| element.enabled));
    words.parts
}

#[test]
fn a_pi_has_the_times_of_a_manual() {
    // 0.002 (s + 8)/s = 0.002 (1 + 8/s)
    let parts = words_of(&general(0.002, &[[-8.0, 0.0]], &[[0.0, 0.0]]), None);
    assert_eq!(parts, [ManualPart::ProportionalIntegral { gain: 0.002, integral_time_s: 0.125 }]);
}

#[test]
fn a_pid_is_told_from_a_pi_with_lead_by_its_name_or_its_complex_zeros() {
    // (s^2 + 30 s + 200)/(s (0.01 s + 1)): zeros at 10 and 20, K_p = 30 - 2, K_d = 1 - 0.28
    let law = general(100.0, &[[-10.0, 0.0], [-20.0, 0.0]], &[[0.0, 0.0], [-100.0, 0.0]]);
    let [ManualPart::ProportionalIntegralDerivative { gain, integral_time_s, derivative_time_s, .. }] =
        words_of(&law, Some(NamedStructure::Pid))[..]
    else {
        panic!()
    };
    assert!((gain - 28.0).abs() < 1e-12 && (integral_time_s - 0.14).abs() < 1e-15);
    assert!((derivative_time_s - 0.72 / 28.0).abs() < 1e-15);
    let [ManualPart::ProportionalIntegral { .. }, ManualPart::Lead { .. }] = words_of(&law, None)[..] else {
        panic!()
    };
    let complex = general(100.0, &[[-10.0, 5.0], [-10.0, -5.0]], &[[0.0, 0.0], [-100.0, 0.0]]);
    let [ManualPart::ProportionalIntegralDerivative { .. }] = words_of(&complex, None)[..] else { panic!() };
}

/// Derivative gain K_d = k (1/z_1 - T_f) (1/z_2 - T_f): a filter between the zeros has a T_d below
/// zero, and one that is slower than both a T_i below zero. Either is a PI with a lag.
#[test]
fn a_pid_with_a_slow_filter_is_a_pi_with_a_lag() {
    for pole in [5.0, 15.0] {
        let law = general(100.0, &[[-10.0, 0.0], [-20.0, 0.0]], &[[0.0, 0.0], [-pole, 0.0]]);
        let parts = words_of(&law, Some(NamedStructure::Pid));
        let [ManualPart::ProportionalIntegral { .. }, ManualPart::Lag { .. }] = parts[..] else {
            panic!("{pole}: {parts:?}")
        };
    }
}

#[test]
fn every_named_part_reads_back() {
    let zero = Element::RealZero { frequency: 12.0 };
    let notch = |frequency: f64, pole_damping_ratio: f64| Element::Notch {
        natural_frequency: frequency,
        zero_damping_ratio: 0.05,
        pole_damping_ratio,
    };
    let law = Compensator::new(vec![
        Element::Gain(-0.003),
        Element::Integrator,
        zero,
        notch(390.0, 1.7),
        notch(150.0, 0.6),
        Element::LeadLag { zero_frequency: 80.0, pole_frequency: 900.0 },
        Element::RealPole { frequency: 700.0 },
        Element::ComplexPoles { natural_frequency: 1500.0, damping_ratio: 0.7 },
    ]);
    let parts = words_of(&law, None);
    assert_eq!(parts.len(), 6);
    let notch = |part: &ManualPart| match part {
        ManualPart::Notch { frequency_rad_per_s, .. } => *frequency_rad_per_s,
        _ => f64::NAN,
    };
    assert_eq!([notch(&parts[1]), notch(&parts[2])], [150.0, 390.0]);
}

#[test]
fn a_notch_is_found_in_a_ratio_of_factors() {
    let law = general(
        1e-3,
        &[[-8.0, 0.0], [-20.0, 300.0], [-20.0, -300.0]],
        &[[0.0, 0.0], [-200.0, 250.0], [-200.0, -250.0]],
    );
    let parts = words_of(&law, None);
    let [ManualPart::ProportionalIntegral { .. }, ManualPart::Notch { pole_damping_ratio, .. }] = parts[..]
    else {
        panic!("{parts:?}")
    };
    assert!((pole_damping_ratio - 200.0 / 102_500_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn laws_without_such_words_say_why() {
    let gap = |law: Compensator| ManualLaw::new(&law, None).unwrap_err();
    assert_eq!(gap(general(1.0, &[[8.0, 0.0]], &[[0.0, 0.0]])), ManualGap::NotMinimumPhase);
    assert_eq!(gap(general(1.0, &[], &[[0.0, 0.0], [0.0, 0.0]])), ManualGap::Origin);
    assert_eq!(gap(general(1.0, &[[-1.0, 0.0]], &[])), ManualGap::Zeros);
    let far = general(1.0, &[[-1.0, 9.0], [-1.0, -9.0]], &[[-70.0, 70.0], [-70.0, -70.0]]);
    assert_eq!(gap(far), ManualGap::Zeros);
}
