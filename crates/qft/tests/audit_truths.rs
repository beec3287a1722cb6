//! Audits of plants with formerly wrong verdicts: poles that decay within a sample, modes that fold
//! through the sampled band, poles that pass through infinity.
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::{Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::portable::{ln, log10};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::stability::Irresolution;
use phea_qft::verification::{
    Audit, AuditProblem, PlantPoint, StabilityReason, TOLERANCE_DB, TrackingJudgement, Verdict,
};

/// Name of a parameter, nominal value, least, greatest.
type Range = (&'static str, f64, f64, f64);

fn family<F>(ranges: &[Range], spacing: Spacing, plant: F) -> Family
where
    F: for<'t> FnMut(&[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>>,
{
    let parameters = ranges.iter().map(|&(name, nominal, minimum, maximum)| UncertainParameter {
        name: name.into(),
        nominal,
        minimum,
        maximum,
    });
    let plant = UncertainPlant::record(parameters.collect(), plant).unwrap();
    let along =
        |index| Coordinate { parameters: vec![index], opposed: vec![], spacing: vec![spacing], points: 2 };
    let coordinates: Vec<Coordinate> = (0..ranges.len()).map(along).collect();
    let members = vertices(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

fn rational<'t>(
    numerator: Vec<Recorded<'t>>,
    denominator: Vec<Recorded<'t>>,
    dead_time_s: f64,
) -> PlantCoefficients<Recorded<'t>> {
    let command = RationalCoefficients { numerator, denominator };
    PlantCoefficients { command, disturbance: None, dead_time_s: dead_time_s.into(), rate: None }
}

/// A plant with constant coefficients.
fn fixed(gain: f64, factors: &[&[f64]]) -> Family {
    let product = factors.iter().fold(Polynomial::new(vec![1.0]), |product, factor| {
        product.product(&Polynomial::new(factor.to_vec()))
    });
    family(&[], Spacing::Linear, |_| {
        let denominator = product.coefficients().iter().map(|&c| c.into()).collect();
        rational(vec![gain.into()], denominator, 0.0)
    })
}

/// Controller of a gain times a quotient of polynomials in z, highest power first.
fn sampled(gain: f64, numerator: &[f64], denominator: &[f64], sample_time_s: f64) -> Controller {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    let function =
        TransferFunction::from_polynomials(&polynomial(numerator).scaled(gain), &polynomial(denominator));
    let function = function.unwrap().in_domain(TimeDomain::Discrete { sample_time_s }).unwrap();
    let timing = Timing { sample_time_s: Some(sample_time_s), ..Timing::default() };
    Controller {
        feedback: Compensator::new(vec![Element::General(function)]),
        timing,
        ..Controller::default()
    }
}

/// Integrator gain/s by Tustin's rule.
fn sampled_integrator(gain: f64, sample_time_s: f64) -> Controller {
    let timing = Timing { sample_time_s: Some(sample_time_s), ..Timing::default() };
    let feedback = Compensator::new(vec![Element::Gain(gain), Element::Integrator]);
    Controller { feedback, timing, ..Controller::default() }
}

fn sensitivity(limit: f64) -> Specification {
    Specification {
        requirement: Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(limit)),
        frequencies_rad_per_s: vec![1.0, 2.0],
        band_rad_per_s: [0.0, f64::INFINITY],
    }
}

fn robust_stability(limit: f64) -> Specification {
    Specification {
        requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)),
        ..sensitivity(limit)
    }
}

fn audit(family: &Family, controller: &Controller, specifications: &[Specification]) -> Audit {
    let compensation = Compensation::new(controller, TransferFunction::gain_only(1.0)).unwrap();
    let problem = AuditProblem {
        family,
        compensation: &compensation,
        specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    phea_qft::audit::audit(&problem, &mut unwatched).unwrap()
}

fn close(found: f64, truth: f64, tolerance: f64) {
    assert!((found - truth).abs() <= tolerance * truth.abs(), "{found} is not {truth}");
}

fn value(plant: &PlantPoint) -> f64 {
    match plant {
        PlantPoint::Parameters(values) => values[0],
        PlantPoint::Measured(_) | PlantPoint::Additional(_) => f64::NAN,
    }
}

/// Poles of 3740 and 6800 rad/s at 10 ms decay to exp(-37).
// ORIGIN: recomputed by comparisons/recompute_sampling.py
#[test]
fn two_fast_poles_are_a_delay_of_one_sample() {
    let plant = fixed(1.0, &[&[1.0 / 6800.0, 1.0], &[1.0 / 3740.0, 1.0]]);
    let found = audit(&plant, &sampled(0.6, &[1.0], &[1.0, -1.0], 0.01), &[sensitivity(1.6)]);
    assert_eq!(found.verdict, Verdict::Violated);
    assert_eq!(found.stability.verdict, Verdict::Met);
    let worst = found.specifications[0].worst.as_ref().unwrap();
    close(worst.margin_db, -4.794_366_012_192, 1e-9);
    close(worst.frequency_rad_per_s, 91.132_178, 1e-5);
    close(found.stability.largest_real_part.unwrap(), ln(0.6) / 0.02, 1e-9);
}

// ORIGIN: recomputed by comparisons/recompute_sampling.py
#[test]
fn two_faster_poles_are_stable() {
    let plant = fixed(1.0, &[&[1.0 / 15000.0, 1.0], &[1.0 / 5550.0, 1.0]]);
    let found = audit(&plant, &sampled(0.5, &[1.0], &[1.0, -1.0], 0.01), &[sensitivity(2.2)]);
    assert_eq!(found.verdict, Verdict::Met);
    close(found.stability.largest_real_part.unwrap(), -34.657_359_027_997, 1e-9);
    // |S| reaches 6.838 dB
    let margin_db = found.specifications[0].worst.as_ref().unwrap().margin_db;
    assert!((margin_db - (20.0 * log10(2.2) - 6.838_056_810)).abs() < 1e-8, "{margin_db}");
}

// ORIGIN: recomputed by comparisons/recompute_sampling.py
#[test]
fn a_slow_resonance_next_to_fast_poles_is_unstable() {
    let (fast, slow): (f64, f64) = (391.422, 0.606991);
    let factors: [&[f64]; 3] = [
        &[1.0 / 375.266, 1.0],
        &[1.0 / (fast * fast), 1.6264 / fast, 1.0],
        &[1.0 / (slow * slow), 0.4916 / slow, 1.0],
    ];
    let found =
        audit(&fixed(1.0, &factors), &sampled(0.2931, &[1.0], &[1.0, -1.0], 1.0), &[sensitivity(1.0)]);
    assert_eq!(found.stability.verdict, Verdict::Violated);
    close(found.stability.largest_real_part.unwrap(), 0.018_115_567_606_715, 1e-9);
}

/// A mode of 4 to 16 rad/s, sampled each second, folds back to every frequency of the band four
/// times.
// ORIGIN: recomputed by comparisons/recompute_sampling.py
#[test]
fn a_mode_that_folds_is_followed_to_its_worst() {
    let plant = family(&[("w", 4.0, 4.0, 16.0)], Spacing::Linear, |p| {
        let (w, square) = (p[0], p[0] * p[0]);
        // (2 s + 1)(s^2 + 0.01 w s + w^2)
        let denominator =
            vec![2.0.into(), w.times(0.02) + 1.0.into(), square.times(2.0) + w.times(0.01), square];
        rational(vec![square], denominator, 0.0)
    });
    let specifications = [robust_stability(1.4), sensitivity(2.4)];
    let found = audit(&plant, &sampled_integrator(0.3, 1.0), &specifications);
    assert_eq!(found.stability.verdict, Verdict::Met);
    assert_eq!(found.specifications[0].verdict, Verdict::Violated);
    let worst = found.specifications[0].worst.as_ref().unwrap();
    close(worst.margin_db, -1.375_741_054_9, 1e-6);
    close(value(&worst.plant), 6.631_067_6, 1e-5);
}

// ORIGIN: recomputed by comparisons/recompute_sampling.py
#[test]
fn a_mode_that_folds_is_unstable_in_a_hundredth_of_the_box() {
    let plant = family(&[("w", 60.0, 60.0, 180.0)], Spacing::Linear, |p| {
        let square = p[0] * p[0];
        rational(vec![square], vec![1.0.into(), p[0].times(0.0014), square], 0.0)
    });
    let found = audit(&plant, &sampled_integrator(0.095_827_252_092_597_61, 1.0), &[sensitivity(40.0)]);
    assert_eq!(found.verdict, Verdict::Violated);
    assert_eq!(found.stability.verdict, Verdict::Violated);
    // at w = 62.451 it is 0.00417 within 1e-5
    assert!(found.stability.largest_real_part.unwrap() > 0.00415);
}

/// Three modes that fold independently pass through the band in more combinations than can be
/// examined.
#[test]
fn modes_that_fold_too_often_leave_the_verdict_open() {
    let ranges = [("u", 10.0, 10.0, 40.0), ("v", 50.0, 50.0, 90.0), ("w", 100.0, 100.0, 150.0)];
    let plant = family(&ranges, Spacing::Linear, |p| {
        let start = vec![Recorded::from(1.0)];
        let denominator = p.iter().fold(start, |product, &w| {
            let factor = [1.0.into(), w.times(0.02), w * w];
            let mut next = vec![Recorded::from(0.0); product.len() + 2];
            for (i, &a) in product.iter().enumerate() {
                for (j, &b) in factor.iter().enumerate() {
                    next[i + j] = next[i + j] + a * b;
                }
            }
            next
        });
        rational(vec![p[0] * p[0] * p[1] * p[1] * p[2] * p[2]], denominator, 0.0)
    });
    let found = audit(&plant, &sampled_integrator(0.01, 1.0), &[sensitivity(40.0)]);
    assert_eq!(found.verdict, Verdict::NotProven);
    assert_eq!(found.stability.reason, StabilityReason::NotResolved(Irresolution::Folding));
    assert_eq!(found.specifications[0].verdict, Verdict::NotProven);
}

fn leading<'t>(p: &[Recorded<'t>]) -> Recorded<'t> {
    let from = p[0] - 0.37.into();
    from * from - 0.001.into()
}

/// Plant with ((x - 0.37)^2 - 0.001) s^2 + s: a pole at 1/(0.001 - (x - 0.37)^2), unstable for |x -
/// 0.37| < 0.0316.
#[test]
fn a_pole_that_passes_through_infinity_is_found() {
    let plant = family(&[("x", 0.0, 0.0, 1.0)], Spacing::Linear, |p| {
        rational(vec![1.0.into()], vec![leading(p), 1.0.into(), 0.0.into()], 0.0)
    });
    let lag =
        TransferFunction::from_polynomials(&Polynomial::new(vec![4.0]), &Polynomial::new(vec![0.05, 1.0]));
    let feedback = Compensator::new(vec![Element::General(lag.unwrap())]);
    let controller = Controller { feedback, ..Controller::default() };
    let specifications = [robust_stability(2.0), sensitivity(3.0)];
    let found = audit(&plant, &controller, &specifications);
    assert_eq!(found.stability.verdict, Verdict::Violated);
    // the pole at x = 0.37 is 1000, and larger ones are nearer to the change
    assert!((value(&found.stability.plant) - 0.37).abs() < 0.001_f64.sqrt());
    assert!(found.stability.largest_real_part.unwrap() > 999.0);
    // sampled every 10 ms, where a pole of 70,000 exceeds the range of numbers within one sample
    let found = audit(&plant, &sampled(4.0, &[1.0], &[1.0], 0.01), &specifications);
    assert_eq!(found.stability.verdict, Verdict::Violated);
    assert!((value(&found.stability.plant) - 0.37).abs() < 0.001_f64.sqrt());
}

/// Denominator (x - 0.5)^2 s^2 + s, which loses its highest power for one plant without a change of
/// sign: its pole is at -1/(x - 0.5)^2. No enclosure can distinguish the expanded square from a
/// change of sign.
#[test]
fn a_pole_that_touches_infinity_is_reported_if_the_square_is_recorded() {
    let build = |expanded: bool| {
        family(&[("x", 0.0, 0.0, 1.0)], Spacing::Linear, move |p| {
            let from = p[0] - 0.5.into();
            let square = if expanded { p[0] * p[0] - p[0] + 0.25.into() } else { from * from };
            rational(vec![1.0.into()], vec![square, 1.0.into(), 0.0.into()], 0.0)
        })
    };
    let controller = Controller::default();
    assert_eq!(audit(&build(false), &controller, &[sensitivity(3.0)]).verdict, Verdict::Met);
    let found = audit(&build(true), &controller, &[sensitivity(3.0)]);
    assert_eq!(found.verdict, Verdict::NotProven);
    let StabilityReason::NotResolved(Irresolution::PoleThroughInfinity | Irresolution::InfinityOpen(_)) =
        found.stability.reason
    else {
        panic!("{:?}", found.stability)
    };
}

/// A leading coefficient 1 - x share, recorded so that the enclosure over a part of the box is
/// unbounded: the two squares are equal, and their difference retains the width of both.
#[test]
fn a_leading_coefficient_without_enclosures_is_searched_for() {
    let build = |fraction: f64| {
        family(&[("x", 0.0, 0.0, 1.0)], Spacing::Linear, move |p| {
            let from = p[0] - 0.5.into();
            let unit = (p[0] * p[0] - p[0] + 0.25.into() - from * from + 1e-7.into()).times(1e7);
            let leading = -(p[0].times(fraction) / unit) + 1.0.into();
            rational(vec![1.0.into()], vec![leading, 1.0.into(), 0.0.into()], 0.0)
        })
    };
    let stable = audit(&build(0.6), &Controller::default(), &[sensitivity(3.0)]);
    assert_eq!(stable.stability.verdict, Verdict::Met, "{:?}", stable.stability);
    let found = stable.stability.infinity.expect("a search");
    assert!((found.least_fraction - 0.4).abs() < 1e-6 && found.parameters == [0], "{found:?}");
    assert_eq!(value(&found.plant), 1.0);
    let changed = audit(&build(1.25), &Controller::default(), &[sensitivity(3.0)]);
    assert_eq!(changed.stability.verdict, Verdict::Violated, "{:?}", changed.stability);
    assert!(value(&changed.stability.plant) > 0.8);
}

/// Gain at infinity |L(inf)| = 1.001 - (x - 0.37)^2, which exceeds one for |x - 0.37| < 0.0316:
/// with dead time infinitely many poles are unstable there.
#[test]
fn a_gain_at_infinity_that_passes_one_inside_the_box_is_found() {
    let build = |dead_time_s: f64| {
        family(&[("x", 0.0, 0.0, 1.0)], Spacing::Linear, move |p| {
            let gain = -leading(p) + 1.0.into();
            rational(vec![gain, gain.times(2.0)], vec![1.0.into(), 3.0.into()], dead_time_s)
        })
    };
    let specifications = [robust_stability(1e5), sensitivity(1e5)]
        .map(|one| Specification { band_rad_per_s: [0.0, 1.0], ..one });
    let controller = Controller::default();
    let found = audit(&build(0.1), &controller, &specifications);
    assert_eq!(found.stability.verdict, Verdict::Violated);
    assert!((value(&found.stability.plant) - 0.37).abs() < 0.001_f64.sqrt());
    // (1 + g) s + 3 + 2 g = 0 has one stable pole without dead time
    let found = audit(&build(0.0), &controller, &specifications);
    assert_eq!(found.verdict, Verdict::Met);
}

/// Damping that is negative only for |x - 0.37| < 0.002: no search for the largest real part starts
/// there, but the resonance passes the design frequency there. A plant found by one audit is
/// evaluated by the other.
#[test]
fn the_worst_plant_of_a_specification_is_judged_for_stability() {
    let plant = family(&[("x", 0.0, 0.0, 1.0)], Spacing::Linear, |p| {
        let from = p[0] - 0.37.into();
        let damping = (from * from).times(-1e5).exp().times(-0.03) + 0.02.into();
        let square = (p[0] + 1.0.into()).squared();
        rational(vec![square], vec![1.0.into(), damping, square], 0.0)
    });
    let feedback = Compensator::new(vec![Element::Gain(0.44)]);
    let controller = Controller { feedback, ..Controller::default() };
    // the closed loop resonates at 1.2 (1 + x)
    let specification = Specification { frequencies_rad_per_s: vec![1.644], ..sensitivity(1e3) };
    let found = audit(&plant, &controller, &[specification]);
    assert_eq!(found.stability.verdict, Verdict::Violated, "{:?}", found.stability);
    // the largest real part is that of x = 0.37
    close(found.stability.largest_real_part.unwrap(), 0.005, 1e-6);
    assert!(found.specifications[0].worst.is_none());
}

/// Five parameters, sampled more slowly than half of the modes.
#[test]
fn five_parameters_sampled() {
    let ranges = [
        ("k0", 1.11966, 0.746439, 1.11966),
        ("m1", 2.84905, 0.949685, 2.84905),
        ("c2", 3.13057, 3.13057, 6.26114),
        ("q3", 648.836, 324.418, 973.254),
        ("b4", 108.817, 104.313, 156.47),
    ];
    let modes = [(14.6368, 0.00352503), (287.846, 0.0158693), (86.4713, 0.307165)];
    let fixed = modes.iter().fold(Polynomial::new(vec![1.0]), |product, &(w, z)| {
        product.product(&Polynomial::new(vec![1.0, 2.0 * z * w, w * w]))
    });
    let gain: f64 = modes.iter().map(|(w, _)| w * w).product();
    let plant = family(&ranges, Spacing::Logarithmic, |p| {
        let own = [p[1], p[2], p[3]];
        let mut denominator = vec![Recorded::from(0.0); 9];
        for (i, &c) in fixed.coefficients().iter().enumerate() {
            for (j, &factor) in own.iter().enumerate() {
                denominator[i + j] = denominator[i + j] + factor.times(c);
            }
        }
        let numerator = vec![p[0].times(gain) / p[4], p[0].times(gain)];
        rational(numerator, denominator, 0.0)
    });
    let controller = sampled(
        2.486_011_030_266_43,
        &[10.646070218682306, 9.205240462212043, 7.22175349032756],
        &[1.0, 0.5912126744344637, 0.14757282926955312],
        0.397824,
    );
    let specification = Specification {
        frequencies_rad_per_s: vec![1.312361303809098],
        band_rad_per_s: [1.1811251734281882, 1.443597434190008],
        ..robust_stability(1e7)
    };
    let found = audit(&plant, &controller, &[specification]);
    assert_eq!(found.verdict, Verdict::Met, "{:?}", found.stability);
    // the worst of 20,000 random plants, and as many around their worst, has -0.0009
    let largest = found.stability.largest_real_part.unwrap();
    assert!(largest > -0.0009 && largest < 0.0, "{largest}");
}
