//! The worst plant at a given frequency, if the resonance there belongs to no plant of the grid.

use phea_dynamics::controller::Timing;
use phea_dynamics::expression::Recorded;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Family, Spacing};
use phea_qft::specification::{LoopResponse, Specification};
use phea_qft::verification::{PlantPoint, TrackingJudgement};

use super::plants::{along, audited, compensation, on_grid, parameter, rational, stability};
use super::properties::{COARSE, Case, Draw, damped_case};

/// Plant k/(s^2 (s^2 + 2 k)).
fn carts<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
    let zero = || Recorded::from(0.0);
    PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0]],
            denominator: vec![1.0.into(), zero(), p[0] + p[0], zero(), zero()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    }
}

/// Two carts and a spring (Wie and Bernstein 1992): the grid has plants next to those whose
/// resonance is at the frequency.
// ORIGIN: recomputed by comparisons/recompute_audit.py
#[test]
fn a_spring_between_two_of_the_grid_resonates_at_the_given_frequency() {
    let plant = UncertainPlant::record(vec![parameter("k", 1.0, 0.5, 2.0)], carts).unwrap();
    let family = on_grid(plant, vec![along(0, Spacing::Linear, 21)]);
    let around =
        compensation(rational(&[0.32, 0.032], &[4.0, 2.0, 1.0]), rational(&[1.0], &[1.0]), Timing::default());
    let truths = [(0.99, 5.93238, 0.50101), (1.01, 5.99426, 0.52047)];
    let limit = stability(2.25, &truths.map(|truth| truth.0), [0.0, f64::INFINITY]);
    let (findings, _) = audited(&family, &around, &[limit], TrackingJudgement::Magnitude);
    for (found, (frequency, margin_db, stiffness)) in findings[0].at_design_frequencies.iter().zip(truths) {
        assert_eq!(found.frequency_rad_per_s, frequency);
        assert!((found.margin_db - margin_db).abs() < 1e-5, "{found:?}");
        let PlantPoint::Parameters(values) = &found.plant else { panic!("a plant with parameters") };
        assert!((values[0] - stiffness).abs() < 1e-5, "{found:?}");
    }
}

/// Margin by the specification's definition.
fn margin_db(
    around: &Compensation,
    specification: &Specification,
    plant: PlantCoefficients<f64>,
    frequency: f64,
) -> f64 {
    let (plant, controller) =
        (around.member(plant).unwrap().response(frequency).unwrap(), around.response(frequency));
    let response = LoopResponse {
        plant: plant.plant,
        load_motion: plant.load_motion,
        sensor: plant.sensor,
        controller: controller.feedback,
        prefilter: controller.prefilter,
    };
    specification.margin_db(&response, frequency).unwrap()
}

/// Fractions of plants, closely spaced in the last coordinate.
fn dense_fractions() -> impl Iterator<Item = [f64; 4]> {
    (0..3 * 3 * 2 * 400).map(|index| {
        let (near, far) = (index % 400, index / 400);
        [f64::from(far % 3) / 2.0, f64::from(far / 3 % 3) / 2.0, f64::from(far / 9), f64::from(near) / 399.0]
    })
}

/// The least margin of each specification over a box.
fn least(case: &Case, frequency: f64) -> Vec<f64> {
    let Family::Uncertain(family) = &case.family else { panic!("a box") };
    let mut least = vec![f64::INFINITY; case.specifications.len()];
    for fractions in dense_fractions() {
        for (least, specification) in least.iter_mut().zip(&case.specifications) {
            let plant = family.plant().coefficients(&family.values(&fractions)).unwrap();
            *least = least.min(margin_db(&case.around, specification, plant, frequency));
        }
    }
    least
}

/// Remainder of the spread that a tracking specification allows over this box, dB.
fn spread_left(case: &Case, frequency: f64, allowed: f64) -> f64 {
    let Family::Uncertain(family) = &case.family else { panic!("a box") };
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    for fractions in dense_fractions() {
        let member =
            case.around.member(family.plant().coefficients(&family.values(&fractions)).unwrap()).unwrap();
        let open = member.response(frequency).unwrap().plant * case.around.response(frequency).feedback;
        let closed = (open.norm_sqr() / (1.0 + open).norm_sqr()).sqrt();
        (least, greatest) = (least.min(closed), greatest.max(closed));
    }
    20.0 * (allowed * least / greatest).log10()
}

/// Lightly damped boxes whose resonances pass the given frequencies, 24 of them: none of 7,200
/// plants is worse than the result.
#[test]
fn no_plant_of_a_dense_grid_is_worse_at_a_given_frequency() {
    let mut missed = Vec::new();
    for seed in 0..24 {
        let mut case = damped_case(100 + seed, [0.002, 0.02], 1.0, 1.0, COARSE);
        case.specifications.truncate(4);
        let Family::Uncertain(family) = &case.family else { panic!("a box") };
        let mut draw = Draw(2000 + seed);
        let given: Vec<f64> = (0..3).map(|_| family.values(&[0.0, 0.0, 0.0, draw.uniform()])[3]).collect();
        for specification in &mut case.specifications {
            specification.frequencies_rad_per_s.clone_from(&given);
        }
        let (findings, work) =
            audited(&case.family, &case.around, &case.specifications, TrackingJudgement::Magnitude);
        assert!(work.responses < 1_500_000, "{work:?}");
        for (place, &frequency) in given.iter().enumerate() {
            for (finding, truth) in findings.iter().zip(least(&case, frequency)) {
                let found = &finding.at_design_frequencies[place];
                assert_eq!(found.frequency_rad_per_s, frequency);
                if found.margin_db > truth + 0.01 {
                    missed.push((seed, truth, found.clone()));
                }
            }
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

/// Spread of both plants over twelve boxes of this kind: none is worse than the result.
#[test]
fn no_two_plants_of_a_dense_grid_spread_further_at_a_given_frequency() {
    let mut missed = Vec::new();
    for seed in 0..12 {
        let mut case = damped_case(200 + seed, [0.002, 0.02], 1.0, 1.0, COARSE);
        let mut tracking = case.specifications.remove(4);
        let Family::Uncertain(family) = &case.family else { panic!("a box") };
        let frequency = family.values(&[0.0, 0.0, 0.0, Draw(3000 + seed).uniform()])[3];
        tracking.frequencies_rad_per_s = vec![frequency];
        tracking.band_rad_per_s = [0.0, f64::INFINITY];
        let (findings, _) = audited(&case.family, &case.around, &[tracking], TrackingJudgement::Spread);
        let found = &findings[0].at_design_frequencies[0];
        let truth = spread_left(&case, frequency, 1.2 / 0.5);
        if found.margin_db > truth + 0.01 {
            missed.push((seed, truth, found.clone()));
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}
