//! Range of data, tables and samples, and cases that cannot be resolved.

use num_complex::Complex64;
use phea_dynamics::controller::{Controller, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Extent, Family, MeasuredFamily, MeasuredPlant, Spacing, UncertainFamily};
use phea_qft::specification::{ClosedLoop, Limit, LimitTable, LoopResponse, Requirement, Specification};
use phea_qft::verification::{
    Evidence, PlantPoint, Remark, SpecificationFinding, TrackingJudgement, Verdict,
};

use super::plants::{along, audited, compensation, on_grid, parameter, rational, specification, stability};

fn unity() -> Compensation {
    compensation(TransferFunction::gain_only(1.0), TransferFunction::gain_only(1.0), Timing::default())
}

fn judged(family: &Family, around: &Compensation, specification: &Specification) -> SpecificationFinding {
    let specifications = std::slice::from_ref(specification);
    audited(family, around, specifications, TrackingJudgement::Magnitude).0.remove(0)
}

/// Plants k/(s (s + 1)), measured at 40 frequencies per decade.
fn measured(gains: &[f64], from: f64, to: f64) -> Family {
    let points = (40.0 * (to / from).log10()) as usize + 1;
    let frequencies: Vec<f64> =
        (0..points).map(|point| from * (to / from).powf(point as f64 / (points - 1) as f64)).collect();
    let plant = |gain: &f64| MeasuredPlant {
        name: format!("gain {gain}"),
        frequencies_rad_per_s: frequencies.clone(),
        command: frequencies
            .iter()
            .map(|&w| {
                let s = Complex64::new(0.0, w);
                *gain / (s * (s + 1.0))
            })
            .collect(),
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    };
    Family::Measured(MeasuredFamily::new(gains.iter().map(plant).collect()).unwrap())
}

/// Largest |T| of k/(s (s + 1)) with unit feedback: damping e = 1/(2 sqrt k), peak 1/(2 e
/// sqrt(1 - e^2)).
fn servo_peak(gain: f64) -> f64 {
    let damping = 0.5 / gain.sqrt();
    1.0 / (2.0 * damping * (1.0 - damping * damping).sqrt())
}

#[test]
fn a_measured_family_is_judged_where_it_was_measured_and_not_beyond() {
    let family = measured(&[1.0, 2.0, 4.0], 0.01, 100.0);
    let inside = judged(&family, &unity(), &stability(3.0, &[1.0, 2.0], [0.01, 100.0]));
    assert_eq!((inside.verdict, inside.evidence), (Verdict::Met, Evidence::Grid));
    let worst = inside.worst.as_ref().unwrap();
    assert_eq!(worst.plant, PlantPoint::Measured(2));
    // between two points the response is interpolated: good to a thousandth here
    assert!((worst.margin_db - 20.0 * (3.0 / servo_peak(4.0)).log10()).abs() < 0.02, "{worst:?}");
    assert_eq!(inside.remarks, [Remark::Interpolated]);

    let beyond = judged(&family, &unity(), &stability(3.0, &[1.0], [0.01, 200.0]));
    assert_eq!(beyond.verdict, Verdict::NotProven);
    let reach = Remark::BeyondMeasurements { measured_rad_per_s: [0.01, 100.0] };
    assert!(beyond.remarks.contains(&reach), "{:?}", beyond.remarks);
    let everywhere = judged(&family, &unity(), &stability(3.0, &[1.0], [0.0, f64::INFINITY]));
    assert_eq!(everywhere.verdict, Verdict::NotProven);
    // a violation counts, however little is known elsewhere
    let violated = judged(&family, &unity(), &stability(1.5, &[1.0], [0.0, f64::INFINITY]));
    assert_eq!(violated.verdict, Verdict::Violated);
}

fn servo(points: usize) -> Family {
    let plant = UncertainPlant::record(vec![parameter("k", 1.0, 1.0, 4.0)], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0]],
            denominator: vec![1.0.into(), 1.0.into(), 0.0.into()],
        },
        disturbance: Some(RationalCoefficients {
            numerator: vec![(-2.0).into(), 0.0.into()],
            denominator: vec![1.0.into(), 10.0.into()],
        }),
        dead_time_s: 0.0.into(),
        rate: None,
    });
    on_grid(plant.unwrap(), vec![along(0, Spacing::Linear, points)])
}

#[test]
fn nothing_is_demanded_beyond_the_ends_of_a_table() {
    let table = |points: &[(f64, f64)]| Limit::Table(LimitTable::new(points.to_vec()).unwrap());
    let everywhere = [0.0, f64::INFINITY];
    // the peak of the worst plant is at sqrt(4 - 1/2) rad/s, beyond this table
    let low = Requirement::at_most(ClosedLoop::RobustStability, table(&[(0.1, 1.5), (1.0, 1.5)]));
    let low = judged(&servo(2), &unity(), &specification(low, &[0.5], everywhere));
    assert_eq!(low.verdict, Verdict::Met);
    assert!(low.worst.as_ref().unwrap().frequency_rad_per_s <= 1.0);
    assert_eq!(low.remarks, [Remark::TableEnds { table_rad_per_s: [0.1, 1.0] }]);
    let through = Requirement::at_most(ClosedLoop::RobustStability, table(&[(0.1, 1.5), (10.0, 1.5)]));
    let through = judged(&servo(2), &unity(), &specification(through, &[], everywhere));
    let worst = through.worst.as_ref().unwrap();
    assert!((worst.margin_db - 20.0 * (1.5 / servo_peak(4.0)).log10()).abs() < 1e-6);
    assert!((worst.frequency_rad_per_s - 3.5f64.sqrt()).abs() < 1e-6);
    // a table outside the band sets no limit, which does not count as met
    let outside = Requirement::at_most(ClosedLoop::RobustStability, table(&[(20.0, 1.5), (30.0, 1.5)]));
    let outside = judged(&servo(2), &unity(), &specification(outside, &[], [0.1, 10.0]));
    assert_eq!((outside.verdict, outside.worst), (Verdict::NotProven, None));
}

/// Load motion acts directly on the plant: |Pd/(1+L)|, with Pd = -2 s/(s + 10), is 2 at infinity
/// and peaks where |S| does.
#[test]
fn load_motion_has_a_path_of_its_own() {
    let requirement = Requirement::at_most(ClosedLoop::LoadMotion, Limit::Constant(1.0));
    let finding = judged(&servo(3), &unity(), &specification(requirement, &[2.0], [0.0, f64::INFINITY]));
    let worst = finding.worst.as_ref().unwrap();
    assert_eq!(worst.frequency_rad_per_s, f64::INFINITY);
    assert!((worst.margin_db + 20.0 * 2f64.log10()).abs() < 1e-9);
    let s = Complex64::new(0.0, 2.0);
    let size = |k: f64| (-2.0 * s / (s + 10.0) / (1.0 + k / (s * (s + 1.0)))).norm_sqr().sqrt();
    let truth = (0..=3000).map(|index| size(1.0 + f64::from(index) / 1000.0)).fold(0.0, f64::max);
    assert!((finding.at_design_frequencies[0].margin_db + 20.0 * truth.log10()).abs() < 1e-5);
}

/// A sensor in the loop, a hold and a delay: the audit agrees with the specification's definition
/// on a dense grid.
#[test]
fn a_sampled_loop_is_judged_up_to_half_its_sampling_frequency() {
    for (sensor, rate_feed_forward) in
        [(TransferFunction::gain_only(1.0), 0.0), (rational(&[20.0], &[1.0, 20.0]), 0.6)]
    {
        let timing =
            Timing { sample_time_s: Some(0.1), delay_s: 0.03, rate_feed_forward, ..Timing::default() };
        let controller = Controller { timing, ..Controller::default() };
        let around = Compensation::new(&controller, sensor).unwrap();
        let nyquist = std::f64::consts::PI / 0.1;
        for requirement in [
            Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(2.0)),
            Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(2.0)),
            Requirement::at_most(ClosedLoop::LoadMotion, Limit::Constant(2.0)),
            Requirement::tracking(Limit::Constant(1e-4), Limit::Constant(1.3)),
        ] {
            let demanded = specification(requirement, &[1.0], [0.0, f64::INFINITY]);
            let finding = judged(&servo(2), &around, &demanded);
            let (mut truth, mut at) = (f64::INFINITY, 0.0);
            let Family::Uncertain(family) = &servo(31) else { panic!("a box") };
            for values in family.members() {
                let member = around.member(family.plant().coefficients(values).unwrap()).unwrap();
                for point in 1..=3000 {
                    let w = nyquist * 1e-4f64.powf(1.0 - f64::from(point) / 3000.0);
                    let w = w.min(nyquist);
                    let (plant, compensator) = (member.response(w).unwrap(), around.response(w));
                    let response = LoopResponse {
                        plant: plant.plant,
                        load_motion: plant.load_motion,
                        controller: compensator.feedback,
                        prefilter: compensator.prefilter,
                        sensor: plant.sensor,
                    };
                    let margin = demanded.margin_db(&response, w).unwrap();
                    (truth, at) = if margin < truth { (margin, w) } else { (truth, at) };
                }
            }
            let worst = finding.worst.as_ref().unwrap();
            assert!((worst.margin_db - truth).abs() < 1e-3, "{truth} at {at}, {worst:?}");
            assert!(finding.remarks.contains(&Remark::BandEndsAtNyquist { nyquist_rad_per_s: nyquist }));
        }
    }
}

/// A plant with more zeros than poles cannot be held and sampled: it is not proven.
#[test]
fn a_plant_that_cannot_be_sampled_is_not_proven() {
    let plant = UncertainPlant::record(vec![parameter("k", 1.0, 1.0, 2.0)], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0], 1.0.into(), 1.0.into()],
            denominator: vec![1.0.into(), 1.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    });
    let family = UncertainFamily::new(plant.unwrap(), vec![], vec![], Extent::Members).unwrap();
    let timing = Timing { sample_time_s: Some(0.1), ..Timing::default() };
    let controller = Controller { timing, ..Controller::default() };
    let around = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let finding = judged(&Family::Uncertain(family), &around, &stability(2.0, &[1.0], [0.1, 1.0]));
    assert_eq!((finding.verdict, finding.worst), (Verdict::NotProven, None));
    let cannot = |remark: &Remark| matches!(remark, Remark::NotSampled { .. });
    assert!(finding.remarks.iter().any(cannot), "{:?}", finding.remarks);
}

/// A bilinear prefilter, a bilinear controller, and a prefilter of second order have zeros at z =
/// -1: at pi/T the reference has no effect, so that no lower limit is met there, and this is
/// reported; with a band that ends below pi/T, or without a zero, it is not reported.
#[test]
fn no_lower_limit_is_met_if_the_prefilter_tends_to_zero() {
    let plant = UncertainPlant::record(vec![], |_| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![1.0.into()],
            denominator: vec![1.0.into(), 0.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    })
    .unwrap();
    let family = Family::Uncertain(UncertainFamily::of_nominal(plant));
    let timing = Timing { sample_time_s: Some(0.1), ..Timing::default() };
    let highest = std::f64::consts::PI / 0.1;
    let lag = || rational(&[1.0], &[0.1, 1.0]);
    let one = || TransferFunction::gain_only(1.0);
    let tracking = |to: f64| {
        let limits = (Limit::Constant(1e-9), Limit::Constant(2.0));
        specification(Requirement::tracking(limits.0, limits.1), &[1.0], [0.1, to])
    };
    let cases = [(one(), lag()), (lag(), one()), (one(), rational(&[1.0], &[0.01, 0.2, 1.0]))];
    for (feedback, prefilter) in cases {
        let around = compensation(feedback, prefilter, timing);
        let whole = judged(&family, &around, &tracking(f64::INFINITY));
        assert_eq!(whole.verdict, Verdict::Violated);
        assert!(whole.remarks.contains(&Remark::ZeroAtNyquist { nyquist_rad_per_s: highest }), "{whole:?}");
        let worst = whole.worst.as_ref().unwrap();
        assert_eq!((worst.margin_db, worst.frequency_rad_per_s), (f64::NEG_INFINITY, highest));
        let below = judged(&family, &around, &tracking(0.99 * highest));
        assert_eq!(below.verdict, Verdict::Met, "{below:?}");
        assert!(!below.remarks.iter().any(|one| matches!(one, Remark::ZeroAtNyquist { .. })));
    }
    let without = judged(&family, &compensation(one(), one(), timing), &tracking(f64::INFINITY));
    assert_eq!((without.verdict, without.remarks.len()), (Verdict::Met, 1), "{without:?}");
}
