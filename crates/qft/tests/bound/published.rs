//! Bounds of two published examples, for only the listed plants.

use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable;
use phea_qft::bound::{BoundFunction, GainIntervals, TemplateFill};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::template::{Resolution, Template, TemplatePoint};

fn template(frequency: f64, plants: &[Complex64]) -> Template {
    let one = Complex64::new(1.0, 0.0);
    let point = |(member, &response): (usize, &Complex64)| TemplatePoint {
        member: Some(member),
        values: vec![],
        response,
        load_motion: one,
        sensor: one,
    };
    Template {
        frequency_rad_per_s: frequency,
        nominal: plants[0],
        points: plants.iter().enumerate().map(point).collect(),
        outlines: vec![],
        resolution: Resolution::Members,
    }
}

fn rational(numerator: &[f64], denominator: &[f64]) -> Limit {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    let function = TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator));
    Limit::Rational(function.unwrap())
}

fn equally_spaced(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| from + (to - from) * f64::from(index) / f64::from(count - 1))
}

/// Plant k/((s + a)(s + b)): forty plants along the edges of the family, and the nominal one.
fn example_a(frequency: f64) -> Template {
    let mut plants = vec![(1.0, 5.0, 30.0)];
    plants.extend(equally_spaced(1.0, 5.0, 10).flat_map(|a| [(10.0, a, 20.0), (1.0, a, 30.0)]));
    plants.extend(equally_spaced(1.0, 10.0, 10).flat_map(|k| [(k, 5.0, 30.0), (k, 1.0, 20.0)]));
    let s = Complex64::new(0.0, frequency);
    let responses: Vec<Complex64> = plants.iter().map(|&(k, a, b)| k / ((s + a) * (s + b))).collect();
    template(frequency, &responses)
}

fn specifications_of_a(frequency: f64) -> Vec<Requirement> {
    let mut requirements = vec![Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2))];
    if frequency <= 10.0 {
        let limit = rational(&[0.02, 1.28, 14.96, 48.0], &[1.0, 14.4, 169.0]);
        requirements.push(Requirement::at_most(ClosedLoop::Sensitivity, limit));
    }
    if frequency <= 50.0 {
        requirements.push(Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(0.01)));
    }
    requirements
}

/// Plant k a/(s (s + a)) with k and a from 1 to 10 in steps of 0.5, and the allowed spread of its
/// tracking.
fn example_b(frequency: f64) -> (Template, Requirement) {
    let s = Complex64::new(0.0, frequency);
    let range = equally_spaced(1.0, 10.0, 19);
    let plants: Vec<Complex64> =
        range.clone().flat_map(|a| range.clone().map(move |k| k * a / (s * (s + a)))).collect();
    let tracking = Requirement::tracking(
        rational(&[120.0], &[1.0, 17.0, 82.0, 120.0]),
        rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752]),
    );
    (template(frequency, &plants), tracking)
}

fn forbidden(template: &Template, requirements: &[Requirement], phase_deg: f64) -> GainIntervals {
    requirements.iter().fold(GainIntervals::default(), |union, requirement| {
        let function = BoundFunction::new(template, requirement, TemplateFill::Points).unwrap();
        union.union(&function.forbidden(phase_deg.to_radians()))
    })
}

fn decibel(gain: f64) -> f64 {
    20.0 * portable::log10(gain)
}

/// The printed values have two decimals.
fn assert_decibel(gain: f64, expected: f64) {
    assert!((decibel(gain) - expected).abs() < 0.006, "{} dB, expected {expected}", decibel(gain));
}

// ORIGIN: recomputed by comparisons/recompute_bounds.py
#[test]
fn open_bounds_of_example_a() {
    for (frequency, allowed_above) in [
        (0.1, [8.03, 8.36, 9.28, 10.57, 11.85, 14.01, 15.56]),
        (5.0, [1.39, 1.94, 3.49, 5.71, 11.55, 14.01, 15.56]),
        (10.0, [-12.93, -12.22, -11.23, -2.53, 11.78, 14.50, 15.56]),
    ] {
        for (step, expected) in (0_u8..).zip(allowed_above) {
            let found =
                forbidden(&example_a(frequency), &specifications_of_a(frequency), -30.0 * f64::from(step));
            let [[low, high]] = *found.intervals() else { panic!("{found:?}") };
            assert_eq!(low, 0.0);
            assert_decibel(high, expected);
        }
    }
}

// ORIGIN: recomputed by comparisons/recompute_bounds.py
#[test]
fn closed_bound_of_example_a() {
    let at = |phase_deg: f64| forbidden(&example_a(100.0), &specifications_of_a(100.0), phase_deg);
    for phase_deg in [0.0, -30.0, -60.0, -90.0] {
        assert!(at(phase_deg).is_empty());
    }
    for (phase_deg, below, above) in
        [(-120.0, -19.03, 8.90), (-150.0, -24.65, 14.52), (-180.0, -25.42, 15.56)]
    {
        let found = at(phase_deg);
        let [[low, high]] = *found.intervals() else { panic!("{found:?}") };
        assert_decibel(low, below);
        assert_decibel(high, above);
    }
}

// ORIGIN: recomputed by comparisons/recompute_bounds.py
#[test]
fn tracking_bounds_of_example_b() {
    for (frequency, allowed_above) in [
        (0.1, [56.47, 52.61, 37.82, 51.45, 56.14, 57.34]),
        (1.0, [16.13, 13.78, 11.72, 14.05, 17.38, 18.62]),
        (10.0, [-7.11, -8.17, -9.52, -9.60, -7.37, 3.38]),
    ] {
        let (template, tracking) = example_b(frequency);
        for (step, expected) in (1_u8..).zip(allowed_above) {
            let found = forbidden(&template, std::slice::from_ref(&tracking), -30.0 * f64::from(step));
            let [[low, high]] = *found.intervals() else { panic!("{found:?}") };
            assert_eq!(low, 0.0);
            assert_decibel(high, expected);
        }
    }
}
