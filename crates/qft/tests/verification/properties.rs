//! Properties for any plant: no random point is worse than the worst case stated; limits and
//! frequencies scale.

use phea_dynamics::controller::Timing;
use phea_dynamics::expression::Recorded;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Family, Spacing};
use phea_qft::specification::{ClosedLoop, Limit, LoopResponse, Requirement, Specification};
use phea_qft::verification::{SpecificationFinding, TrackingJudgement};

use super::plants::{along, audited, compensation, on_grid, parameter, rational, specification};

/// A linear congruential generator (Knuth's MMIX constants), so that the draws are identical
/// everywhere.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    /// A number uniform in [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number between these two, uniform in its logarithm.
    pub(crate) fn factor(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.uniform())
    }
}

/// Plant k w^2 (1 + s/z)/((1 + s/a) (s^2 + 2 d w s + w^2)) in units of `scale` rad/s; parameters k,
/// a, d, w.
fn resonant<'t>(p: &[Recorded<'t>], zero: f64, scale: f64) -> PlantCoefficients<Recorded<'t>> {
    let [k, a, d, w] = [p[0], p[1], p[2], p[3]];
    let number = |value: f64| Recorded::from(value);
    let (a, w, zero) = (a * number(scale), w * number(scale), number(zero * scale));
    let gain = k * w * w * a;
    let damping = d * w + d * w;
    PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![gain / zero, gain],
            denominator: vec![number(1.0), damping + a, w * w + damping * a, w * w * a],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    }
}

pub(crate) struct Case {
    pub(crate) family: Family,
    pub(crate) around: Compensation,
    pub(crate) specifications: Vec<Specification>,
}

pub(crate) const COARSE: [usize; 4] = [2, 3, 2, 3];

/// A random box and loop; every frequency times `scale`, every limit times `factor`.
fn case(seed: u64, scale: f64, factor: f64, points: [usize; 4]) -> Case {
    damped_case(seed, [0.003, 0.5], scale, factor, points)
}

/// A random box and loop with a random least damping ratio between these two.
pub(crate) fn damped_case(seed: u64, damping: [f64; 2], scale: f64, factor: f64, points: [usize; 4]) -> Case {
    let mut draw = Draw(seed);
    let mut range = |name: &str, low: f64, high: f64| {
        let minimum = draw.factor(low, high);
        let maximum = minimum * draw.factor(1.1, 4.0);
        parameter(name, minimum + 0.3 * (maximum - minimum), minimum, maximum)
    };
    let parameters = vec![
        range("k", 0.3, 3.0),
        range("a", 0.1, 10.0),
        range("d", damping[0], damping[1]),
        range("w", 1.0, 20.0),
    ];
    let zero = draw.factor(0.5, 50.0);
    let plant = UncertainPlant::record(parameters, |p| resonant(p, zero, scale)).unwrap();
    let coordinates = (0..4).map(|index| along(index, Spacing::Logarithmic, points[index])).collect();
    let (gain, corner) = (draw.factor(0.05, 2.0), draw.factor(0.2, 5.0) * scale);
    let roll_off = draw.factor(20.0, 200.0) * scale;
    let feedback = rational(&[gain, gain * corner], &[1.0 / (roll_off * roll_off), 1.4 / roll_off, 1.0, 0.0]);
    let constant = |value: f64| Limit::Constant(value * factor);
    let tracking = Requirement::tracking(constant(0.5), constant(1.2));
    let sloped = Limit::Rational(rational(&[2.0 * factor, 0.0], &[1.0, scale]));
    let design = [0.3 * scale, 3.0 * scale, 30.0 * scale];
    let everywhere = [0.0, f64::INFINITY];
    Case {
        family: on_grid(plant, coordinates),
        around: compensation(feedback, rational(&[scale], &[1.0, scale]), Timing::default()),
        specifications: vec![
            specification(
                Requirement::at_most(ClosedLoop::RobustStability, constant(1.5)),
                &design,
                everywhere,
            ),
            specification(Requirement::at_most(ClosedLoop::Sensitivity, sloped), &design, everywhere),
            specification(
                Requirement::at_most(ClosedLoop::PlantInputDisturbance, constant(2.0)),
                &design,
                everywhere,
            ),
            specification(
                Requirement::at_most(ClosedLoop::ControlEffort, constant(3.0)),
                &design,
                everywhere,
            ),
            specification(tracking, &design, [0.01 * scale, scale]),
        ],
    }
}

fn findings(case: &Case) -> Vec<SpecificationFinding> {
    audited(&case.family, &case.around, &case.specifications, TrackingJudgement::Magnitude).0
}

fn worst(finding: &SpecificationFinding) -> f64 {
    finding.worst.as_ref().unwrap().margin_db
}

/// Twenty-four random boxes with 5 specifications each and 10,000 plants and frequencies each,
/// evaluated by the specification's definition.
#[test]
fn no_plant_and_frequency_drawn_at_random_is_worse_than_the_worst_case_found() {
    for seed in 0..24 {
        let case = case(seed, 1.0, 1.0, COARSE);
        let findings = findings(&case);
        let Family::Uncertain(family) = &case.family else { panic!("a box") };
        let mut draw = Draw(1000 + seed);
        for _ in 0..10_000 {
            let fractions: Vec<f64> = (0..4).map(|_| draw.uniform()).collect();
            let values = family.values(&fractions);
            let member = case.around.member(family.plant().coefficients(&values).unwrap()).unwrap();
            // half of the draws near the resonance
            let near = values[3] * (1.0 + 0.2 * (draw.uniform() - 0.5));
            let frequency = if draw.uniform() < 0.5 { near } else { draw.factor(1e-3, 1e3) };
            let (plant, controller) = (member.response(frequency).unwrap(), case.around.response(frequency));
            let response = LoopResponse {
                plant: plant.plant,
                load_motion: plant.load_motion,
                sensor: plant.sensor,
                controller: controller.feedback,
                prefilter: controller.prefilter,
            };
            for (specification, finding) in case.specifications.iter().zip(&findings) {
                let [from, to] = specification.band_rad_per_s;
                if frequency < from || frequency > to {
                    continue;
                }
                let margin = specification.margin_db(&response, frequency).unwrap();
                assert!(
                    margin >= worst(finding) - 1e-5,
                    "seed {seed}, {:?}: {margin} at {frequency}, {values:?}; found {:?}",
                    specification.requirement,
                    finding.worst
                );
            }
        }
    }
}

/// The worst case inside the box does not depend on the grid from which its search started.
#[test]
fn a_finer_grid_finds_the_same_worst_case() {
    let mut compared = 0;
    for seed in 0..12 {
        let coarse = findings(&case(seed, 1.0, 1.0, COARSE));
        let fine = findings(&case(seed, 1.0, 1.0, [3, 4, 3, 5]));
        for (coarse, fine) in coarse.iter().zip(&fine) {
            // a box that extends to the stability boundary has unbounded peaks
            if worst(fine) > -40.0 {
                compared += 1;
                assert!(
                    (worst(coarse) - worst(fine)).abs() < 1e-4,
                    "{seed}: {:?} {:?}",
                    coarse.worst,
                    fine.worst
                );
            }
        }
    }
    assert!(compared > 20, "{compared}");
}

/// Limits higher by x dB give margins larger by x dB.
#[test]
fn margins_follow_limits() {
    let factor = 10f64.powf(0.15);
    let mut compared = 0;
    for seed in 0..8 {
        let (low, high) = (case(seed, 1.0, 1.0, COARSE), case(seed, 1.0, factor, COARSE));
        for (low, high) in findings(&low).iter().zip(&findings(&high)).take(4) {
            if worst(low) < -40.0 {
                continue;
            }
            compared += 1;
            assert!(
                (worst(high) - worst(low) - 3.0).abs() < 1e-6,
                "{seed}: {:?} {:?}",
                low.worst,
                high.worst
            );
            for (low, high) in low.at_design_frequencies.iter().zip(&high.at_design_frequencies) {
                assert!((high.margin_db - low.margin_db - 3.0).abs() < 1e-6);
            }
        }
    }
    assert!(compared > 10, "{compared}");
}

/// Problems a hundred times faster have equal margins at a hundred times the frequency.
#[test]
fn frequency_scales() {
    let mut compared = 0;
    for seed in 0..8 {
        let slow = findings(&case(seed, 1.0, 1.0, COARSE));
        let fast = findings(&case(seed, 100.0, 1.0, COARSE));
        for (slow, fast) in slow.iter().zip(&fast) {
            let (slow, fast) = (slow.worst.as_ref().unwrap(), fast.worst.as_ref().unwrap());
            if slow.margin_db < -40.0 {
                continue;
            }
            compared += 1;
            assert!((slow.margin_db - fast.margin_db).abs() < 1e-6, "{seed}: {slow:?} {fast:?}");
            let ratio = fast.frequency_rad_per_s / slow.frequency_rad_per_s;
            assert!(ratio.is_nan() || (ratio / 100.0 - 1.0).abs() < 1e-5, "{slow:?} {fast:?}");
        }
    }
    assert!(compared > 10, "{compared}");
}

/// Repeated audits give equal findings and equal work.
#[test]
fn an_audit_repeats_itself() {
    let one = case(5, 1.0, 1.0, COARSE);
    let run = || audited(&one.family, &one.around, &one.specifications, TrackingJudgement::Spread);
    assert_eq!(run(), run());
}
