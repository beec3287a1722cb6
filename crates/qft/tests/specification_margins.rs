//! Limits and the margins that they guarantee, against the loops.
#![cfg(test)]

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::frequency::{logarithmic_grid, margins};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::{cos, magnitude, sin};
use phea_qft::specification::{
    ClosedLoop, GuaranteedMargins, Limit, MarginError, Requirement, delay_margin_limit, guaranteed_margins,
    guaranteed_margins_of_robust_stability, guaranteed_margins_of_sensitivity,
    robust_stability_limit_for_gain_increase, robust_stability_limit_for_gain_reduction,
    robust_stability_limit_for_modulus_margin, robust_stability_limit_for_phase_margin,
    sensitivity_limit_for_gain_increase, sensitivity_limit_for_gain_reduction,
    sensitivity_limit_for_modulus_margin, sensitivity_limit_for_phase_margin,
};

const LIMITS: [f64; 8] = [0.3, 0.5, 0.7, 1.0, 1.2, 1.3, 2.0, 6.0];

fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

fn close(value: f64, expected: f64, tolerance: f64) -> bool {
    value == expected || (value / expected - 1.0).abs() <= tolerance
}

/// A loop k prod(s - zero)/prod(s - pole) with real roots.
fn real_loop(gain: f64, zeros: &[f64], poles: &[f64]) -> TransferFunction {
    let complex = |roots: &[f64]| roots.iter().map(|root| c(*root, 0.0)).collect();
    TransferFunction::from_factors(gain, complex(zeros), complex(poles)).unwrap()
}

fn complementary(open: Complex64) -> f64 {
    magnitude(open / (1.0 + open))
}

fn sensitivity(open: Complex64) -> f64 {
    1.0 / magnitude(1.0 + open)
}

/// Equivalence of limit and margins: whether a loop through a point satisfies the limit follows
/// from the margins, on the whole negative axis and the whole unit circle.
fn margins_draw_the_line(closed: fn(Complex64) -> f64, limit: f64, guaranteed: &GuaranteedMargins) {
    for step in 1..4000 {
        let crossing = 0.002 * f64::from(step) - 0.0007;
        // the gain may grow by 1/crossing, if that is above one, or fall to it
        let factor = 1.0 / crossing;
        let apart = if factor > 1.0 {
            factor >= guaranteed.gain_increase
        } else {
            factor < 1.0 && factor <= guaranteed.gain_reduction
        };
        assert_eq!(closed(c(-crossing, 0.0)) <= limit, apart, "{limit} at -{crossing}");
        let angle = PI * f64::from(step) / 4000.0 + 1e-5;
        let on_circle = c(-cos(angle), -sin(angle));
        assert_eq!(closed(on_circle) <= limit, angle >= guaranteed.phase_rad, "{limit} at {angle}");
    }
}

/// The least |1 + L| among points where the closed loop is exactly at the limit, by brute force.
fn nearest_on_the_circle(limit: f64, open_of_closed: fn(Complex64) -> Complex64) -> f64 {
    let points = (0..20_000).map(|step| PI * (f64::from(step) + 0.5) / 10_000.0);
    points.fold(f64::INFINITY, |nearest, angle| {
        let closed = limit * c(cos(angle), sin(angle));
        nearest.min(magnitude(1.0 + open_of_closed(closed)))
    })
}

#[test]
fn each_margin_is_where_the_limit_meets_axis_circle_and_critical_point() {
    for limit in LIMITS {
        let guaranteed = guaranteed_margins_of_robust_stability(limit).unwrap();
        margins_draw_the_line(complementary, limit, &guaranteed);
        let nearest = nearest_on_the_circle(limit, |closed| closed / (1.0 - closed));
        assert!(close(nearest, guaranteed.modulus, 1e-6), "{limit}: {nearest}");
        let guaranteed = guaranteed_margins_of_sensitivity(limit).unwrap();
        margins_draw_the_line(sensitivity, limit, &guaranteed);
        let nearest = nearest_on_the_circle(limit, |closed| closed.inv() - 1.0);
        assert!(close(nearest, guaranteed.modulus, 1e-12), "{limit}: {nearest}");
    }
}

#[test]
fn limits_give_margins_and_margins_give_the_limits_back() {
    for limit in LIMITS {
        let stability = guaranteed_margins_of_robust_stability(limit).unwrap();
        let back = [
            robust_stability_limit_for_gain_increase(stability.gain_increase),
            robust_stability_limit_for_modulus_margin(stability.modulus),
        ];
        assert!(back.iter().all(|value| close(*value.as_ref().unwrap(), limit, 1e-14)), "{back:?}");
        let sensitive = guaranteed_margins_of_sensitivity(limit).unwrap();
        let back = [
            sensitivity_limit_for_gain_reduction(sensitive.gain_reduction),
            sensitivity_limit_for_modulus_margin(sensitive.modulus),
        ];
        assert!(back.iter().all(|value| close(*value.as_ref().unwrap(), limit, 1e-14)), "{back:?}");
        if limit >= 0.5 {
            let back = [
                robust_stability_limit_for_phase_margin(stability.phase_rad).unwrap(),
                sensitivity_limit_for_phase_margin(sensitive.phase_rad).unwrap(),
            ];
            assert!(back.iter().all(|value| close(*value, limit, 1e-14)), "{back:?}");
        } else {
            assert_eq!([stability.phase_rad, sensitive.phase_rad], [f64::INFINITY; 2]);
        }
        if limit > 1.0 {
            let back = [
                robust_stability_limit_for_gain_reduction(stability.gain_reduction).unwrap(),
                sensitivity_limit_for_gain_increase(sensitive.gain_increase).unwrap(),
            ];
            assert!(back.iter().all(|value| close(*value, limit, 1e-14)), "{back:?}");
        } else {
            assert_eq!((stability.gain_reduction, sensitive.gain_increase), (0.0, f64::INFINITY));
        }
    }
}

#[test]
fn no_loop_has_less_than_its_own_peaks_guarantee() {
    let mut gains_bound = 0;
    for (poles, top) in [(vec![0.0], 20.0), (vec![0.0, -1.0], 20.0), (vec![0.0, -1.0, -2.0], 5.9)] {
        for fraction in [0.01, 0.1, 0.3, 0.6, 0.8, 0.9] {
            let open = real_loop(top * fraction, &[], &poles);
            let grid = logarithmic_grid(1e-4, 1e4, 40_000).unwrap();
            // the peak between the points of the grid is higher by no more than this
            let peak = |closed: fn(Complex64) -> f64| {
                grid.iter().map(|w| closed(open.at_frequency(*w))).fold(0.0, f64::max) * (1.0 + 1e-4)
            };
            let actual = margins(&open);
            let of_stability = guaranteed_margins_of_robust_stability(peak(complementary)).unwrap();
            let of_sensitivity = guaranteed_margins_of_sensitivity(peak(sensitivity)).unwrap();
            for guaranteed in [of_stability, of_sensitivity] {
                assert!(actual.gain_increase_factor() >= guaranteed.gain_increase);
                assert!(actual.gain_decrease_factor() <= guaranteed.gain_reduction);
                assert!(actual.phase_margin_deg().to_radians() >= guaranteed.phase_rad);
                assert!(actual.modulus_margin.distance >= guaranteed.modulus);
                gains_bound += usize::from(actual.gain_increase_factor().is_finite());
            }
            // the modulus margin is exactly the inverse peak of the sensitivity
            assert!(close(of_sensitivity.modulus, actual.modulus_margin.distance, 2e-4));
        }
    }
    assert_eq!(gains_bound, 12);
}

#[test]
fn only_constant_limits_on_the_two_loop_functions_imply_margins() {
    let rational = Limit::Rational(real_loop(1.0, &[], &[-1.0]));
    for (requirement, expected) in [
        (
            Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.3)),
            guaranteed_margins_of_robust_stability(1.3).ok(),
        ),
        (
            Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(1.3)),
            guaranteed_margins_of_sensitivity(1.3).ok(),
        ),
        (Requirement::at_most(ClosedLoop::RobustStability, rational.clone()), None),
        (Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(1.3)), None),
        (Requirement::at_most(ClosedLoop::LoadMotion, Limit::Constant(1.3)), None),
    ] {
        assert_eq!(guaranteed_margins(&requirement), Ok(expected), "{requirement:?}");
    }
}

// ORIGIN: recomputed by comparisons/recompute_specifications.py
#[test]
fn the_thesis_limit_of_one_point_three_is_a_little_less_than_its_five_decibels() {
    let guaranteed = guaranteed_margins_of_robust_stability(1.3).unwrap();
    assert!(close(phea_dynamics::frequency::decibels(guaranteed.gain_increase), 4.95568967, 1e-8));
    assert!(close(guaranteed.phase_rad.to_degrees(), 45.2397299, 1e-8));
}

#[test]
fn the_delay_limit_permits_no_more_delay_than_a_loop_tolerates() {
    let loops = [
        real_loop(1.0, &[], &[0.0]),
        real_loop(30.0, &[], &[0.0]),
        real_loop(0.2, &[], &[0.0, -1.0]),
        real_loop(3.0, &[], &[0.0, -1.0]),
        real_loop(1.5, &[], &[0.0, -1.0, -2.0]),
        real_loop(8.0, &[-2.0], &[0.0, 0.0, -9.0]),
        real_loop(320.0, &[-1.5], &[1.0, -9.0, -20.0]),
    ];
    let band = [1e-4, 1e4];
    let grid = logarithmic_grid(band[0], band[1], 20_000).unwrap();
    for open in loops {
        let closed = open.feedback(&TransferFunction::gain_only(1.0)).unwrap();
        assert!(closed.is_stable());
        let true_margin = margins(&open).delay_margin_s();
        // the longest delay whose limit is satisfied, by bisection
        let satisfies = |delay: f64| {
            let limit = delay_margin_limit(delay).unwrap();
            grid.iter().all(|w| complementary(open.at_frequency(*w)) <= limit.magnitude(*w).unwrap())
        };
        let (mut satisfied, mut broken) = (0.0, 4.0 * true_margin);
        for _ in 0..20 {
            let middle = 0.5 * (satisfied + broken);
            if satisfies(middle) { satisfied = middle } else { broken = middle }
        }
        assert!(0.3 * true_margin < satisfied && satisfied <= true_margin, "{satisfied} {true_margin}");
    }
}

#[test]
fn an_integrator_tolerates_a_quarter_turn_and_is_guaranteed_one_radian() {
    let gain = 7.0;
    let open = real_loop(gain, &[], &[0.0]);
    assert!(close(margins(&open).delay_margin_s(), PI / 2.0 / gain, 1e-12));
    // |L/(1+L)| = k/sqrt(w^2 + k^2) tends to k/w from below: the limit 1/(w tau) is met with tau =
    // 1/k, but with no longer delay
    let satisfied = |delay: f64| {
        let limit = delay_margin_limit(delay).unwrap();
        [1e-3, 1.0, 1e3, 1e6]
            .iter()
            .all(|w| complementary(open.at_frequency(*w)) <= limit.magnitude(*w).unwrap())
    };
    assert!(satisfied(1.0 / gain) && !satisfied(1.01 / gain));
}

#[test]
fn invalid_margins_have_no_limit() {
    let refused = |result: Result<f64, MarginError>| matches!(result, Err(MarginError::OutOfRange { .. }));
    for value in [1.0, 0.5, -2.0, f64::NAN, f64::INFINITY] {
        assert!(refused(robust_stability_limit_for_gain_increase(value)), "{value}");
        assert!(refused(sensitivity_limit_for_gain_increase(value)), "{value}");
    }
    for value in [0.0, 1.0, 2.0, f64::NAN] {
        assert!(refused(robust_stability_limit_for_gain_reduction(value)), "{value}");
        assert!(refused(sensitivity_limit_for_gain_reduction(value)), "{value}");
        assert!(refused(robust_stability_limit_for_modulus_margin(value)), "{value}");
    }
    for value in [0.0, 3.2, -1.0, f64::NAN] {
        assert!(refused(robust_stability_limit_for_phase_margin(value)), "{value}");
        assert!(refused(sensitivity_limit_for_phase_margin(value)), "{value}");
    }
    for value in [0.0, f64::INFINITY, f64::NAN] {
        assert!(refused(sensitivity_limit_for_modulus_margin(value)), "{value}");
        assert!(guaranteed_margins_of_robust_stability(value).is_err());
        assert!(guaranteed_margins_of_sensitivity(value).is_err());
        assert!(delay_margin_limit(value).is_err());
    }
}
