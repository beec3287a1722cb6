//! Published designs, with their true margins on dense grids.

use phea_dynamics::controller::Timing;
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{SpecificationFinding, TrackingJudgement, Verdict};

use super::plants::{along, audited, compensation, on_grid, parameter, rational, specification, stability};

const EVERYWHERE: [f64; 2] = [0.0, f64::INFINITY];

fn product(factors: &[&[f64]]) -> Vec<f64> {
    let multiplied = |left: Vec<f64>, right: &[f64]| {
        let mut product = vec![0.0; left.len() + right.len() - 1];
        for (i, a) in left.iter().enumerate() {
            for (j, b) in right.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        product
    };
    factors.iter().fold(vec![1.0], |left, right| multiplied(left, right))
}

fn recorded(
    parameters: Vec<UncertainParameter>,
    coefficients: impl for<'t> Fn(&[Recorded<'t>]) -> (Vec<Recorded<'t>>, Vec<Recorded<'t>>),
) -> UncertainPlant {
    UncertainPlant::record(parameters, |p| {
        let (numerator, denominator) = coefficients(p);
        PlantCoefficients {
            command: RationalCoefficients { numerator, denominator },
            disturbance: None,
            dead_time_s: 0.0.into(),
            rate: None,
        }
    })
    .unwrap()
}

fn feedback(function: TransferFunction) -> Compensation {
    compensation(function, TransferFunction::gain_only(1.0), Timing::default())
}

fn judged(
    family: &Family,
    around: &Compensation,
    specifications: &[Specification],
) -> Vec<SpecificationFinding> {
    audited(family, around, specifications, TrackingJudgement::Magnitude).0
}

/// The finding's worst excess over its limit, dB, and its frequency.
fn excess(finding: &SpecificationFinding) -> (f64, f64) {
    let worst = finding.worst.as_ref().unwrap();
    (-worst.margin_db, worst.frequency_rad_per_s)
}

/// Plant k/((s + a)(s + b)): 40 plants along the edges of a template, without any between them.
fn edge_plants() -> Family {
    let parameters =
        vec![parameter("k", 1.0, 1.0, 10.0), parameter("a", 5.0, 1.0, 5.0), parameter("b", 30.0, 20.0, 30.0)];
    let plant = recorded(parameters, |p| (vec![p[0]], vec![1.0.into(), p[1] + p[2], p[1] * p[2]]));
    let fraction = |index: usize| index as f64 / 9.0;
    let members = (0..10).flat_map(|index| {
        let (a, k) = (1.0 + 4.0 * fraction(index), 1.0 + 9.0 * fraction(index));
        [vec![10.0, a, 20.0], vec![1.0, a, 30.0], vec![k, 5.0, 30.0], vec![k, 1.0, 20.0]]
    });
    let members = members.collect();
    Family::Uncertain(UncertainFamily::new(plant, vec![], members, Extent::Members).unwrap())
}

// ORIGIN: recomputed by comparisons/recompute_audit.py
#[test]
fn forty_edge_plants_with_both_published_controllers() {
    let family = edge_plants();
    let limit = rational(&[0.02, 1.28, 14.96, 48.0], &[1.0, 14.4, 169.0]);
    let specifications = [
        stability(1.2, &[0.1, 5.0, 10.0, 100.0], EVERYWHERE),
        specification(
            Requirement::at_most(ClosedLoop::Sensitivity, Limit::Rational(limit)),
            &[0.1, 5.0, 10.0],
            [0.0, 10.0],
        ),
        specification(
            Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(0.01)),
            &[0.1, 5.0, 10.0],
            [0.0, 50.0],
        ),
    ];
    let zero = [379.0 / 42.0, 379.0];
    let complex = feedback(rational(&zero, &[1.0 / (247.0 * 247.0), 1.0 / 247.0, 1.0]));
    let findings = judged(&family, &complex, &specifications);
    for (finding, truth) in findings.iter().zip([-0.3353, -0.0144, -11.6185]) {
        assert_eq!(finding.verdict, Verdict::Met);
        assert!((excess(finding).0 - truth).abs() < 1e-3, "{:?}", finding.worst);
    }
    // met at all its design frequencies, but not between them
    let real = feedback(rational(&zero, &[1.0 / 165.0, 1.0]));
    let findings = judged(&family, &real, &specifications[..1]);
    let (worst, frequency) = excess(&findings[0]);
    assert_eq!(findings[0].verdict, Verdict::Violated);
    assert!((worst - 0.2537).abs() < 1e-3 && (frequency / 67.11 - 1.0).abs() < 1e-3, "{worst} {frequency}");
    assert!(findings[0].at_design_frequencies.iter().all(|case| case.margin_db > 0.0));
}

/// Plant k a/(s (s + a)).
fn servo() -> Family {
    let parameters = vec![parameter("k", 1.0, 1.0, 10.0), parameter("a", 1.0, 1.0, 10.0)];
    let plant = recorded(parameters, |p| (vec![p[0] * p[1]], vec![1.0.into(), p[1], 0.0.into()]));
    on_grid(plant, vec![along(0, Spacing::Logarithmic, 5), along(1, Spacing::Logarithmic, 5)])
}

fn following(to: f64) -> Specification {
    let requirement = Requirement::tracking(
        Limit::Rational(rational(&[120.0], &[1.0, 17.0, 82.0, 120.0])),
        Limit::Rational(rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752])),
    );
    specification(requirement, &[0.1, 0.5, 1.0, 2.0], [0.0, to])
}

// ORIGIN: recomputed by comparisons/recompute_audit.py
#[test]
fn two_servo_designs() {
    let family = servo();
    let servo = [stability(1.2, &[0.1, 100.0], EVERYWHERE), following(10.0)];
    let published = rational(&[3.0787e6, 3.5365e8, 3.8529e8], &[1.0, 1528.8, 1.0636e6, 4.281e7]);
    let prefilter = rational(&[1.0], &[1.0 / 16.0, 0.35, 1.0]);
    let findings = judged(&family, &compensation(published, prefilter, Timing::default()), &servo);
    assert!((excess(&findings[0]).0 + 0.1256).abs() < 1e-4, "{:?}", findings[0].worst);
    // exceeded by 4e-5 dB, within the tolerance
    let worst = findings[1].worst.as_ref().unwrap();
    assert!((worst.margin_db + 4.11e-5).abs() < 1e-7 && findings[1].verdict == Verdict::Met, "{worst:?}");

    let poles = product(&[&[1.0, 931.27], &[1.0, 946.83]]);
    let optimised = rational(&[3462219.0, 3462219.0 * 3.85], &poles);
    let specifications = [stability(1.2, &[0.1, 100.0], EVERYWHERE), following(15.0)];
    let (findings, _) = audited(&family, &feedback(optimised), &specifications, TrackingJudgement::Spread);
    let (worst, frequency) = excess(&findings[0]);
    assert_eq!(findings[0].verdict, Verdict::Violated);
    assert!((worst - 0.0239).abs() < 1e-3 && (frequency / 2.912 - 1.0).abs() < 2e-3, "{worst} {frequency}");
    // the spread without a prefilter is just allowed at the upper end of the band, and has no slack
    // at zero frequency
    let tracking = &findings[1];
    let (last, margin) = tracking.envelope.last().copied().unwrap();
    assert!(tracking.verdict == Verdict::Met && last == 15.0 && (margin - 2.410e-4).abs() < 2e-7, "{margin}");
    assert_eq!(excess(tracking), (0.0, 0.0));
}

/// Two masses and a spring, k/(s^2 (s^2 + 2 k)): every plant is undamped.
// ORIGIN: recomputed by comparisons/recompute_audit.py
#[test]
fn an_undamped_plant_is_an_ordinary_point() {
    let parameters = vec![parameter("k", 1.0, 0.5, 2.0)];
    let plant = recorded(parameters, |p| {
        let zero = Recorded::from(0.0);
        (vec![p[0]], vec![1.0.into(), zero, p[0] + p[0], zero, zero])
    });
    let family = on_grid(plant, vec![along(0, Spacing::Linear, 4)]);
    let around = feedback(rational(&[0.32, 0.032], &[4.0, 2.0, 1.0]));
    let resonance = 2f64.sqrt();
    let findings = judged(&family, &around, &[stability(2.25, &[0.01, 0.1, resonance], EVERYWHERE)]);
    assert_eq!(findings[0].verdict, Verdict::Met);
    assert!((excess(&findings[0]).0 + 2.8638).abs() < 1e-3, "{:?}", findings[0].worst);
}

// ORIGIN: recomputed by comparisons/recompute_audit.py
#[test]
fn between_its_design_frequencies_this_design_fails() {
    let parameters = vec![
        parameter("k", 2.0, 2.0, 5.0),
        parameter("a", 1.0, 1.0, 3.0),
        parameter("z", 0.3, 0.3, 0.6),
        parameter("w", 4.0, 4.0, 8.0),
    ];
    let plant = recorded(parameters, |p| {
        let [k, a, z, w] = [p[0], p[1], p[2], p[3]];
        (vec![k * w * w, k * a * w * w], vec![1.0.into(), z * w + z * w, w * w])
    });
    let coordinates =
        (0..4).map(|index: usize| Coordinate { points: 3, ..along(index, Spacing::Linear, 3) }).collect();
    let family = on_grid(plant, coordinates);
    let numerator = product(&[&[2.5], &[0.2, 1.0], &[1.0 / 16.0, 0.3, 1.0]]);
    let denominator = product(&[&[1.0, 0.0], &[1.0, 1.0], &[1.0 / 3.2, 1.0], &[1.0 / 26.0, 1.0]]);
    let six_db = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(10f64.powf(0.3)));
    let design = [0.2, 0.5, 1.0, 3.0, 5.0, 7.0, 10.0, 20.0, 50.0];
    let findings = judged(
        &family,
        &feedback(rational(&numerator, &denominator)),
        &[specification(six_db, &design, [0.2, 50.0])],
    );
    let (worst, frequency) = excess(&findings[0]);
    assert_eq!(findings[0].verdict, Verdict::Violated);
    assert!((worst - 0.3331).abs() < 1e-3 && (frequency / 6.105 - 1.0).abs() < 2e-3, "{worst} {frequency}");
    assert!(findings[0].at_design_frequencies.iter().all(|case| case.margin_db > 0.07));
}
