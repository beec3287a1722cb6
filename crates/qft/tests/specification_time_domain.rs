//! A requirement in time, the limits derived from it, and their response in time.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::ln;
use phea_dynamics::time_response::{
    SecondOrder, Settling, SettlingRule, StepBaseline, step_metrics, step_response, uniform_times,
};
use phea_qft::specification::{
    ExtraRoot, LowerStepRequirement, RequirementCheck, RequirementOutcome, TimeDomainError, Translation,
    UpperStepRequirement, check_lower, check_upper, tracking_lower, tracking_upper,
};

const UPPER: UpperStepRequirement =
    UpperStepRequirement { overshoot_percent: 1.0, settling_time_s: 0.1, settling_band_percent: 1.0 };
const LOWER: LowerStepRequirement = LowerStepRequirement { settling_time_s: 0.3, settling_band_percent: 1.0 };

fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

fn factored(gain: f64, zeros: &[Complex64], poles: &[Complex64]) -> TransferFunction {
    TransferFunction::from_factors(gain, zeros.to_vec(), poles.to_vec()).unwrap()
}

fn settling(check: &RequirementCheck) -> f64 {
    check.reached.settling.time_s().unwrap()
}

fn close(value: f64, expected: f64, tolerance: f64) -> bool {
    (value - expected).abs() <= tolerance
}

/// Reproducible numbers in [0, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

// ORIGIN: recomputed by comparisons/recompute_specifications.py
#[test]
fn the_printed_limits_miss_their_requirement() {
    let pair = [c(-36.8, 27.6), c(-36.8, -27.6)];
    let upper = check_upper(&factored(2116.0 / 75.0, &[c(-75.0, 0.0)], &pair), &UPPER).unwrap();
    assert!(close(upper.reached.overshoot_percent, 2.194563521, 1e-8));
    assert!(close(settling(&upper), 0.126368769, 1e-8));
    match upper.outcome() {
        RequirementOutcome::Missed { overshoot_excess_percent, settling_excess_s } => {
            assert!(close(overshoot_excess_percent, 1.194563521, 1e-8));
            assert!(close(settling_excess_s, 0.026368769, 1e-8));
        }
        RequirementOutcome::Met => panic!("6.28 meets its wish"),
    }
    let triple = [c(-20.0, 0.0), c(-20.0, 0.0), c(-50.0, 0.0)];
    let lower = check_lower(&factored(20_000.0, &[], &triple), &LOWER).unwrap();
    assert_eq!(lower.reached.overshoot_percent, 0.0);
    assert!(close(settling(&lower), 0.356268974, 1e-8));
    // nor do the second-order models without the extra zero and pole
    let upper = check_upper(&factored(2116.0, &[], &pair), &UPPER).unwrap();
    assert!(close(upper.reached.overshoot_percent, 1.516461986, 1e-8));
    assert!(close(settling(&upper), 0.138114725, 1e-8));
    let lower = check_lower(&factored(400.0, &[], &triple[..2]), &LOWER).unwrap();
    assert!(close(settling(&lower), 0.331917603, 1e-8));
}

// ORIGIN: recomputed by comparisons/recompute_specifications.py
#[test]
fn exact_limits_are_those_of_an_independent_root_finder() {
    let at = |rad_per_s| ExtraRoot::At { rad_per_s };
    let times = |natural_frequencies| ExtraRoot::Times { natural_frequencies };
    let wide = UpperStepRequirement { overshoot_percent: 5.0, settling_band_percent: 2.0, ..UPPER };
    for (required, zero, damping, natural) in [
        (UPPER, ExtraRoot::None, 0.826085055, 41.9161150),
        (UPPER, at(75.0), 0.837470485, 36.1277855),
        (UPPER, times(1.5), 0.852504940, 33.4499794),
        (wide, at(75.0), 0.739041262, 52.2683398),
    ] {
        let limit = tracking_upper(&required, zero, Translation::Exact).unwrap();
        assert!(close(limit.damping_ratio, damping, 2e-9), "{limit:?}");
        assert!(close(limit.natural_frequency_rad_per_s, natural, 1e-6), "{limit:?}");
        assert!(close(limit.check.reached.overshoot_percent, required.overshoot_percent, 1e-8));
        assert!(close(settling(&limit.check), 0.1, 1e-9));
        assert_eq!(limit.check.outcome(), RequirementOutcome::Met);
    }
    for (pole, natural) in [(ExtraRoot::None, 22.1278402), (at(50.0), 24.1901582), (times(2.5), 23.7512649)] {
        let limit = tracking_lower(&LOWER, pole, Translation::Exact).unwrap();
        assert!(close(limit.natural_frequency_rad_per_s, natural, 1e-6), "{limit:?}");
        assert_eq!(limit.damping_ratio, 1.0);
        assert!(close(settling(&limit.check), 0.3, 1e-9));
        assert_eq!(limit.check.outcome(), RequirementOutcome::Met);
    }
}

#[test]
fn exact_limits_meet_any_requirement_for_every_extra_root() {
    let mut numbers = Numbers(7);
    for _ in 0..20 {
        let overshoot_percent = numbers.between(0.1, 40.0);
        let settling_time_s = numbers.between(0.01, 10.0);
        let settling_band_percent = numbers.between(0.5, 8.0);
        let required = UpperStepRequirement { overshoot_percent, settling_time_s, settling_band_percent };
        // zeros below the natural frequency make the second-order part overdamped
        let extra = [
            ExtraRoot::None,
            ExtraRoot::At { rad_per_s: numbers.between(6.0, 100.0) / settling_time_s },
            ExtraRoot::Times { natural_frequencies: numbers.between(0.3, 4.0) },
        ];
        for zero in extra {
            let limit = tracking_upper(&required, zero, Translation::Exact).unwrap();
            assert_eq!(limit.check.outcome(), RequirementOutcome::Met, "{required:?} {zero:?} {limit:?}");
            let overshoot = limit.check.reached.overshoot_percent;
            assert!(close(overshoot, overshoot_percent, 1e-7), "{overshoot} {required:?} {zero:?}");
            // slightly slower in frequency is too late in time
            let (settled, slower) = (settling(&limit.check), 1.0 - 1e-6);
            assert!(settled <= settling_time_s * (1.0 + 1e-9));
            if zero == ExtraRoot::None {
                let natural = limit.natural_frequency_rad_per_s * slower;
                let late = SecondOrder::new(natural, limit.damping_ratio).unwrap().transfer_function();
                let late = check_upper(&late, &required).unwrap();
                assert!(settling(&late) > settling_time_s, "{late:?}");
            }
        }
        let required = LowerStepRequirement { settling_time_s, settling_band_percent };
        for pole in extra {
            let limit = tracking_lower(&required, pole, Translation::Exact).unwrap();
            assert_eq!(limit.check.outcome(), RequirementOutcome::Met, "{required:?} {pole:?} {limit:?}");
            assert!(close(settling(&limit.check) / settling_time_s, 1.0, 1e-8), "{required:?} {pole:?}");
        }
    }
}

/// The settling time jumps where an extreme of the response reaches the band; no natural frequency
/// then settles at exactly the required time, and the faster side of the jump is used.
#[test]
fn at_a_jump_of_the_settling_time_the_requirement_is_met_early() {
    let required =
        UpperStepRequirement { overshoot_percent: 99.9, settling_time_s: 0.1, settling_band_percent: 1.0 };
    let zero = ExtraRoot::At { rad_per_s: 30.0 };
    let limit = tracking_upper(&required, zero, Translation::Exact).unwrap();
    assert_eq!(limit.check.outcome(), RequirementOutcome::Met);
    assert!(settling(&limit.check) < 0.099, "{limit:?}");
    // the third extreme, half a period after the second, is as large as the band
    let damped = limit.natural_frequency_rad_per_s * (1.0 - limit.damping_ratio * limit.damping_ratio).sqrt();
    let times = uniform_times(0.1 + 4.0 / damped, 40_001).unwrap();
    let values = step_response(&limit.function, &times).unwrap();
    let later =
        times.iter().zip(&values).filter(|(time, _)| **time > 0.1).map(|(_, value)| (value - 1.0).abs());
    assert!(close(later.fold(0.0, f64::max), 0.01, 1e-8));
}

#[test]
fn a_requirement_ten_times_as_fast_has_limits_ten_times_as_fast() {
    let fast = UpperStepRequirement { settling_time_s: UPPER.settling_time_s / 10.0, ..UPPER };
    for (zero, scaled) in [
        (ExtraRoot::None, ExtraRoot::None),
        (ExtraRoot::Times { natural_frequencies: 1.5 }, ExtraRoot::Times { natural_frequencies: 1.5 }),
        (ExtraRoot::At { rad_per_s: 75.0 }, ExtraRoot::At { rad_per_s: 750.0 }),
    ] {
        let slow = tracking_upper(&UPPER, zero, Translation::Exact).unwrap();
        let fast = tracking_upper(&fast, scaled, Translation::Exact).unwrap();
        assert!(close(fast.damping_ratio, slow.damping_ratio, 1e-9));
        let ratio = fast.natural_frequency_rad_per_s / slow.natural_frequency_rad_per_s;
        assert!(close(ratio, 10.0, 1e-8), "{ratio}");
    }
    // a fixed zero far above has almost no effect; so the damping changes
    let fixed = ExtraRoot::At { rad_per_s: 75.0 };
    let [slow, fast] =
        [UPPER, fast].map(|required| tracking_upper(&required, fixed, Translation::Exact).unwrap());
    assert!((fast.damping_ratio - slow.damping_ratio).abs() > 0.01);
}

#[test]
fn no_overshoot_means_critical_damping_or_a_zero_that_cancels_the_slow_pole() {
    let required = UpperStepRequirement { overshoot_percent: 0.0, ..UPPER };
    let none = tracking_upper(&required, ExtraRoot::None, Translation::Exact).unwrap();
    let lower = tracking_lower(
        &LowerStepRequirement { settling_time_s: 0.1, settling_band_percent: 1.0 },
        ExtraRoot::None,
        Translation::Exact,
    );
    assert_eq!(none.function, lower.unwrap().function);
    let slow = ExtraRoot::Times { natural_frequencies: 0.5 };
    let limit = tracking_upper(&required, slow, Translation::Exact).unwrap();
    let natural = limit.natural_frequency_rad_per_s;
    // (s + w/2) cancels, w^2/(w/2) = 2 w remains: a lag that settles after ln 100 of its time
    // constants
    assert!(close(limit.damping_ratio, 1.25, 1e-12));
    assert!(close(natural * 2.0 * 0.1, ln(100.0), 1e-7), "{natural}");
    assert_eq!(limit.check.outcome(), RequirementOutcome::Met);
}

#[test]
fn rules_of_thumb_follow_the_thesis_within_their_band() {
    let rule = Translation::Rule(SettlingRule::OnePercentThesis);
    let upper = tracking_upper(&UPPER, ExtraRoot::At { rad_per_s: 75.0 }, rule).unwrap();
    assert!(close(upper.natural_frequency_rad_per_s * upper.damping_ratio * 0.1, 5.0, 1e-12));
    assert_eq!(upper.extra_root_rad_per_s, Some(75.0));
    // the zero adds overshoot that the rule ignores
    assert!(matches!(upper.check.outcome(), RequirementOutcome::Missed { settling_excess_s: 0.0, .. }));
    // critical damping settles later than an envelope of the same sigma
    let lower = tracking_lower(&LOWER, ExtraRoot::None, rule).unwrap();
    assert!(matches!(
        lower.check.outcome(),
        RequirementOutcome::Missed { overshoot_excess_percent: 0.0, .. }
    ));
    let two = Translation::Rule(SettlingRule::TwoPercent);
    assert_eq!(
        tracking_lower(&LOWER, ExtraRoot::None, two),
        Err(TimeDomainError::RuleBand { rule_percent: 2.0, required_percent: 1.0 })
    );
}

#[test]
fn a_root_too_slow_is_refused_at_its_own_settling_time() {
    let lower = |pole: f64| tracking_lower(&LOWER, ExtraRoot::At { rad_per_s: pole }, Translation::Exact);
    // the lag without the other poles would settle after ln(100)/p
    let fastest = ln(100.0) / LOWER.settling_time_s;
    assert!(lower(fastest * (1.0 + 1e-4)).is_ok());
    assert!(matches!(lower(fastest * (1.0 - 1e-4)), Err(TimeDomainError::ExtraRootTooSlow { .. })));
    // the tail due to a zero is as large as the overshoot: it takes ln(overshoot/band)/z
    let upper = |zero: f64, overshoot_percent: f64| {
        let required = UpperStepRequirement { overshoot_percent, ..UPPER };
        tracking_upper(&required, ExtraRoot::At { rad_per_s: zero }, Translation::Exact)
    };
    assert!(matches!(upper(1.0, 5.0), Err(TimeDomainError::ExtraRootTooSlow { .. })));
    assert_eq!(upper(1.0, 1.0).unwrap().check.outcome(), RequirementOutcome::Met);
}

#[test]
fn the_check_agrees_with_dense_samples_of_any_response() {
    let mut numbers = Numbers(3);
    for _ in 0..15 {
        let mut poles = vec![c(-numbers.between(1.0, 30.0), 0.0)];
        let (natural, ratio) = (numbers.between(2.0, 40.0), numbers.between(0.08, 0.95));
        let imaginary = natural * (1.0 - ratio * ratio).sqrt();
        poles.extend([c(-natural * ratio, imaginary), c(-natural * ratio, -imaginary)]);
        // sometimes as many zeros as poles: a response that jumps
        let zeros: Vec<Complex64> =
            (0..(4.0 * numbers.next()) as usize).map(|_| c(-numbers.between(5.0, 60.0), 0.0)).collect();
        let unscaled = factored(1.0, &zeros, &poles);
        let function = factored(1.0 / unscaled.dc_gain(), &zeros, &poles).with_dead_time(0.05).unwrap();
        let required = UpperStepRequirement {
            overshoot_percent: 10.0,
            settling_time_s: 1.0,
            settling_band_percent: 2.0,
        };
        let check = check_upper(&function, &required).unwrap();
        let times = uniform_times(20.0, 80_001).unwrap();
        let values = step_response(&function, &times).unwrap();
        let metrics = step_metrics(&times, &values, StepBaseline::unit(), 2.0).unwrap();
        let overshoot = check.reached.overshoot_percent;
        assert!(overshoot >= metrics.overshoot_percent - 1e-9, "{overshoot} {metrics:?}");
        assert!(close(overshoot, metrics.overshoot_percent, 1e-2), "{overshoot} {metrics:?}");
        let sampled = metrics.settling.time_s().unwrap();
        assert!(close(settling(&check), sampled, 2.6e-4), "{check:?} {sampled} {function:?}");
    }
}

#[test]
fn modes_far_apart_and_light_damping_are_followed_to_the_end() {
    // a lag of ten seconds in series with one of ten microseconds
    let spread = factored(0.1 * 1e5, &[], &[c(-0.1, 0.0), c(-1e5, 0.0)]);
    let check =
        check_lower(&spread, &LowerStepRequirement { settling_time_s: 50.0, settling_band_percent: 1.0 })
            .unwrap();
    assert!(close(settling(&check), 10.0 * ln(100.0), 1e-3));
    assert_eq!(check.outcome(), RequirementOutcome::Met);
    let ringing = SecondOrder::new(10.0, 0.004).unwrap();
    let check = check_upper(&ringing.transfer_function(), &UPPER).unwrap();
    assert!(close(check.reached.overshoot_percent, ringing.overshoot_percent(), 1e-8));
    assert!(close(settling(&check), ringing.settling_time_s(1.0).unwrap().unwrap(), 1e-6));
    let endless = SecondOrder::new(10.0, 1e-5).unwrap().transfer_function();
    assert!(matches!(check_upper(&endless, &UPPER), Err(TimeDomainError::RingsTooLong { .. })));
}

#[test]
fn unsolvable_requirements_are_refused_and_unsettled_responses_reported() {
    let half = factored(5.0, &[], &[c(-10.0, 0.0)]);
    let check = check_lower(&half, &LOWER).unwrap();
    assert!(
        matches!(check.reached.settling, Settling::NotSettled { deviation_percent } if close(deviation_percent, 50.0, 1e-6))
    );
    assert_eq!(
        check.outcome(),
        RequirementOutcome::Missed { overshoot_excess_percent: 0.0, settling_excess_s: f64::INFINITY }
    );
    let integrator = factored(1.0, &[], &[c(0.0, 0.0)]);
    assert_eq!(check_lower(&integrator, &LOWER), Err(TimeDomainError::NotStable { real_part: 0.0 }));
    let improper = factored(1.0, &[c(-1.0, 0.0)], &[]);
    assert!(matches!(check_lower(&improper, &LOWER), Err(TimeDomainError::Response(_))));
    for required in [
        UpperStepRequirement { overshoot_percent: 100.0, ..UPPER },
        UpperStepRequirement { overshoot_percent: -1.0, ..UPPER },
        UpperStepRequirement { overshoot_percent: f64::NAN, ..UPPER },
        UpperStepRequirement { settling_time_s: 0.0, ..UPPER },
        UpperStepRequirement { settling_band_percent: 100.0, ..UPPER },
    ] {
        let refused = tracking_upper(&required, ExtraRoot::None, Translation::Exact);
        assert!(matches!(refused, Err(TimeDomainError::OutOfRange { .. })), "{required:?}");
    }
    for zero in [ExtraRoot::At { rad_per_s: 0.0 }, ExtraRoot::Times { natural_frequencies: f64::INFINITY }] {
        let refused = tracking_upper(&UPPER, zero, Translation::Exact);
        assert!(matches!(refused, Err(TimeDomainError::OutOfRange { .. })), "{zero:?}");
    }
}
