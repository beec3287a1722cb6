//! Limits at zero and infinite frequency, and peaks that no grid contains.

use phea_dynamics::controller::Timing;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Family, Spacing};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::verification::{SpecificationFinding, TrackingJudgement, Verdict};

use super::plants::{along, audited, compensation, on_grid, parameter, rational, specification};

const EVERYWHERE: [f64; 2] = [0.0, f64::INFINITY];

/// Family k numerator/denominator e^(-s T) with k from 1 to 2.
fn gain_times(numerator: &[f64], denominator: &[f64], dead_time_s: f64) -> Family {
    let plant = UncertainPlant::record(vec![parameter("k", 1.0, 1.0, 2.0)], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: numerator.iter().map(|&value| p[0] * value.into()).collect(),
            denominator: denominator.iter().map(|&value| value.into()).collect(),
        },
        disturbance: None,
        dead_time_s: dead_time_s.into(),
        rate: None,
    });
    on_grid(plant.unwrap(), vec![along(0, Spacing::Linear, 2)])
}

fn unity(gain: f64) -> Compensation {
    compensation(TransferFunction::gain_only(gain), TransferFunction::gain_only(1.0), Timing::default())
}

fn judged(
    family: &Family,
    around: &Compensation,
    requirement: Requirement,
    band: [f64; 2],
) -> SpecificationFinding {
    let specifications = [specification(requirement, &[], band)];
    audited(family, around, &specifications, TrackingJudgement::Magnitude).0.remove(0)
}

fn decibels(ratio: f64) -> f64 {
    20.0 * ratio.log10()
}

#[track_caller]
fn check(finding: &SpecificationFinding, margin_db: f64, frequency: f64) {
    let worst = finding.worst.as_ref().unwrap();
    assert!((worst.margin_db - margin_db).abs() < 1e-6 || worst.margin_db == margin_db, "{worst:?}");
    let found = worst.frequency_rad_per_s;
    assert!(found == frequency || (found / frequency - 1.0).abs() < 1e-5, "{worst:?}");
}

#[test]
fn an_integrator_tracks_at_zero_frequency_and_vanishes_at_infinity() {
    let integrator = gain_times(&[1.0], &[1.0, 0.0], 0.0);
    let constant = Limit::Constant;
    // |T| = k/|jw + k|: 1 at zero
    let stability = judged(
        &integrator,
        &unity(1.0),
        Requirement::at_most(ClosedLoop::RobustStability, constant(1.5)),
        EVERYWHERE,
    );
    check(&stability, decibels(1.5), 0.0);
    assert_eq!(stability.interior, None);
    // |S| = w/|jw + k|: 1 at infinity
    let sensitivity = judged(
        &integrator,
        &unity(1.0),
        Requirement::at_most(ClosedLoop::Sensitivity, constant(0.9)),
        EVERYWHERE,
    );
    check(&sensitivity, decibels(0.9), f64::INFINITY);
    assert_eq!(sensitivity.verdict, Verdict::Violated);
    let [from, to] = sensitivity.violations[0].band_rad_per_s;
    // w = 0.9/sqrt(1 - 0.81), and slightly above for the tolerance of 0.001 dB
    assert!((from / (0.9 / 0.19f64.sqrt()) - 1.0).abs() < 1e-3 && to == f64::INFINITY, "{from}");
    // |S| against s/(s + 3): 3/k at zero, 1 at infinity, both margins known
    let sloped =
        Requirement::at_most(ClosedLoop::Sensitivity, Limit::Rational(rational(&[1.0, 0.0], &[1.0, 3.0])));
    check(&judged(&integrator, &unity(1.0), sloped, EVERYWHERE), decibels(1.0 / 3.0), 0.0);
    // |P/(1+L)| -> 1/G
    let disturbance = Requirement::at_most(ClosedLoop::PlantInputDisturbance, constant(0.25));
    check(&judged(&integrator, &unity(5.0), disturbance, EVERYWHERE), decibels(1.25), 0.0);
    // |G/(1+L)| -> G
    let effort = judged(
        &integrator,
        &unity(5.0),
        Requirement::at_most(ClosedLoop::ControlEffort, constant(4.0)),
        EVERYWHERE,
    );
    check(&effort, decibels(0.8), f64::INFINITY);
}

#[test]
fn a_lower_limit_above_a_vanishing_magnitude_is_violated_without_bound() {
    let integrator = gain_times(&[1.0], &[1.0, 0.0], 0.0);
    let constant = Limit::Constant;
    let tracking = Requirement::tracking(constant(0.5), constant(1.1));
    check(&judged(&integrator, &unity(1.0), tracking, EVERYWHERE), f64::NEG_INFINITY, f64::INFINITY);
    // a lower limit that falls equally fast leaves a margin: k/w against 0.25/w
    let lower = Limit::Rational(rational(&[0.25], &[1.0, 0.25]));
    let tracking = Requirement::tracking(lower, constant(1.1));
    let finding = judged(&integrator, &unity(1.0), tracking, EVERYWHERE);
    check(&finding, 0.0, 0.0); // T = lower = 1 at zero frequency, and rounding is no violation
    assert_eq!(finding.verdict, Verdict::Met);
}

#[test]
fn dead_time_turns_a_loop_that_does_not_vanish_through_its_worst_phase() {
    // L = k/4 e^(-s T): |1 + L| repeatedly falls to 1 - k/4
    let family = gain_times(&[1.0], &[1.0], 0.1);
    let finding = judged(
        &family,
        &unity(0.25),
        Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(1.5)),
        EVERYWHERE,
    );
    let worst = finding.worst.as_ref().unwrap();
    assert!((worst.margin_db - decibels(0.75)).abs() < 1e-6, "{worst:?}");
}

#[test]
fn a_loop_of_minus_one_at_zero_frequency_is_not_resolved() {
    let family = gain_times(&[-1.0], &[1.0, 1.0], 0.0);
    let finding = judged(
        &family,
        &unity(1.0),
        Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(1e9)),
        [0.0, 1.0],
    );
    assert_ne!(finding.verdict, Verdict::Met, "{finding:?}");
}

/// Resonance w^2/(s^2 + 2 d w s + w^2) in a loop of gain g: the peak of P/(1+L) is 1/((1 + g) 2 e
/// sqrt(1 - e^2)) with e = d/sqrt(1 + g).
fn resonance_peak(gain: f64, damping: f64) -> f64 {
    let closed = damping / (1.0 + gain).sqrt();
    1.0 / ((1.0 + gain) * 2.0 * closed * (1.0 - closed * closed).sqrt())
}

#[test]
fn a_peak_a_millionth_wide_is_found() {
    for (damping, dead_time_s) in [(1e-2, 0.0), (1e-4, 0.0), (1e-7, 0.0), (1e-4, 1e-14)] {
        let family = gain_times(&[1e6], &[1.0, 2e3 * damping, 1e6], dead_time_s);
        let requirement = Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(1.0));
        let finding = judged(&family, &unity(0.3), requirement, EVERYWHERE);
        // 2/(1 + 2 g) > 1/(1 + g), but the damping of the stiffer loop is less
        let peak =
            (1..=2).map(|k| f64::from(k) * resonance_peak(0.3 * f64::from(k), damping)).fold(0.0, f64::max);
        let worst = finding.worst.as_ref().unwrap();
        assert!((worst.margin_db + decibels(peak)).abs() < 1e-4, "{damping} {dead_time_s}: {worst:?} {peak}");
        assert_eq!(finding.violations.len(), 1);
        let drawn = finding.envelope.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        assert!((drawn - worst.margin_db).abs() < 1e-4);
    }
}

/// The worst case at an end of the band does not hide the worst inside it.
#[test]
fn the_worst_interior_minimum_is_stated_in_addition_to_an_end() {
    let family = gain_times(&[1.0], &[1.0, 0.4, 1.0], 0.0);
    // |P/(1+L)| = k/|1 + k g - w^2 + 0.4 jw|, against 1/s: worst at infinity for a limit that falls even faster
    let limit = Limit::Rational(rational(&[1.0], &[0.01, 0.1, 1.0, 1.0]));
    let finding = judged(
        &family,
        &unity(0.5),
        Requirement::at_most(ClosedLoop::PlantInputDisturbance, limit),
        EVERYWHERE,
    );
    let worst = finding.worst.as_ref().unwrap();
    assert_eq!((worst.margin_db, worst.frequency_rad_per_s), (f64::NEG_INFINITY, f64::INFINITY));
    let interior = finding.interior.as_ref().unwrap();
    assert!((1.0..2.0).contains(&interior.frequency_rad_per_s), "{interior:?}");
}

/// Spread without a prefilter, for which any roll-off is suitable: k/(s + k) spreads by 2 at
/// infinity, where the limits are 4 apart, and by nothing at zero.
#[test]
fn a_spread_has_limits_at_both_ends() {
    let integrator = gain_times(&[1.0], &[1.0, 0.0], 0.0);
    let limit = |gain: f64| Limit::Rational(rational(&[gain], &[1.0, gain]));
    let tracking = Requirement::tracking(limit(0.5), limit(2.0));
    let specifications = [specification(tracking, &[], EVERYWHERE)];
    let (findings, _) = audited(&integrator, &unity(1.0), &specifications, TrackingJudgement::Spread);
    let (last, margin) = findings[0].envelope.last().copied().unwrap();
    assert!(last == f64::INFINITY && (margin - decibels(2.0)).abs() < 1e-9, "{margin}");
    check(&findings[0], 0.0, 0.0);
    assert_eq!(findings[0].verdict, Verdict::Met);
}

/// Meaningless bands, limits and plants give a result other than `Met`, without a panic.
#[test]
fn unsatisfiable_limits_are_not_met() {
    let integrator = gain_times(&[1.0], &[1.0, 0.0], 0.0);
    let requirement = |limit: f64| Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit));
    for band in [[f64::NAN, 1.0], [0.0, f64::NAN], [2.0, 1.0], [-2.0, -1.0], [f64::INFINITY, 0.0]] {
        let finding = judged(&integrator, &unity(1.0), requirement(1.5), band);
        assert_eq!((finding.verdict, finding.worst), (Verdict::NotProven, None), "{band:?}");
        assert!(!finding.remarks.is_empty());
    }
    assert_ne!(judged(&integrator, &unity(1.0), requirement(f64::NAN), EVERYWHERE).verdict, Verdict::Met);
    for scale in [1e-300, 1e-160, 1e160, 1e300] {
        let extreme = gain_times(&[scale], &[1.0, scale.sqrt(), 0.0], 0.0);
        let finding = judged(&extreme, &unity(1.0), requirement(0.5), EVERYWHERE);
        assert_ne!(finding.verdict, Verdict::Met, "{scale}: {finding:?}");
    }
}

/// Plant k/(s + 1) with 0.1 s of dead time, k from 1 to 2, with Pd = -2 s/(s + 10) and rate
/// feed-forward: Pd + K s P tends to (K k - 0.2) s at zero, where 1 + L is 1 + k, sampled or not,
/// and at infinity to -2 + K k e^(-0.1 s), which the delay makes 2 + K k.
#[test]
fn a_rate_that_is_fed_forward_contributes_at_both_ends() {
    let plant = UncertainPlant::record(vec![parameter("k", 1.0, 1.0, 2.0)], |p| PlantCoefficients {
        command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 1.0.into()] },
        disturbance: Some(RationalCoefficients {
            numerator: vec![(-2.0).into(), 0.0.into()],
            denominator: vec![1.0.into(), 10.0.into()],
        }),
        dead_time_s: 0.1.into(),
        rate: None,
    });
    let family = on_grid(plant.unwrap(), vec![along(0, Spacing::Linear, 2)]);
    // exceeds |Y/D| from zero on
    let limit = Limit::Rational(rational(&[1.0, 0.1, 0.0], &[1.0, 6.0, 9.0]));
    for (gain, at_zero) in [(1.0, 1.8 / 3.0), (0.1, 0.1 / 2.0), (-0.5, 1.2 / 3.0)] {
        for sample_time_s in [None, Some(0.1)] {
            let timing = Timing { sample_time_s, rate_feed_forward: gain, ..Timing::default() };
            let unity = TransferFunction::gain_only(1.0);
            let around = compensation(unity.clone(), unity, timing);
            let finding = judged(
                &family,
                &around,
                Requirement::at_most(ClosedLoop::LoadMotion, limit.clone()),
                [0.0, 0.5],
            );
            check(&finding, decibels(0.1 / 9.0 / at_zero), 0.0);
        }
        let timing = Timing { rate_feed_forward: gain, ..Timing::default() };
        let around = compensation(TransferFunction::gain_only(0.1), TransferFunction::gain_only(1.0), timing);
        let requirement = Requirement::at_most(ClosedLoop::LoadMotion, Limit::Constant(1.0));
        let finding = judged(&family, &around, requirement, [1e4, f64::INFINITY]);
        let worst = finding.worst.as_ref().unwrap();
        let greatest = 2.0 + 2.0 * f64::abs(gain);
        assert!((worst.margin_db + decibels(greatest)).abs() < 2e-3, "{worst:?}, not {greatest}");
    }
}
