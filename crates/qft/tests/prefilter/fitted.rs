//! Fitted prefilters, and reasons why others are not found.

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{Discretization, TransferFunction};
use phea_dynamics::portable::magnitude;
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::Compensation;
use phea_qft::loop_shaping::{SearchProblem, Structure, StructureFactor};
use phea_qft::prefilter::{
    FittedPrefilter, PrefilterBand, PrefilterFit, PrefilterOptions, PrefilterOutcome, TrackingExtremes,
    fit_prefilter,
};
use phea_qft::specification::Limit;
use phea_qft::verification::{AuditProblem, TrackingJudgement, Verdict, audit_specifications};

use super::loops::{integrators, member, servo, servo_controller, servo_family, spaced, tracking};

const DECIBELS_PER_NEPER: f64 = 20.0 / std::f64::consts::LN_10;

fn run(band: PrefilterBand, timing: &Timing, options: PrefilterOptions) -> PrefilterOutcome {
    let mut before = 0.0;
    let outcome = fit_prefilter(&band, timing, &options, &mut |progress| {
        assert!(progress.fraction >= before && progress.fraction <= 1.0);
        before = progress.fraction;
        true
    });
    outcome.unwrap()
}

#[track_caller]
fn found(outcome: PrefilterOutcome) -> FittedPrefilter {
    match outcome {
        PrefilterOutcome::Found(found) => found,
        other => panic!("{other:?}"),
    }
}

/// A band of this many decibels to both sides of a prefilter.
fn around_prefilter(prefilter: &TransferFunction, half_db: f64, frequencies: &[f64]) -> PrefilterBand {
    let extremes: Vec<TrackingExtremes> = frequencies
        .iter()
        .map(|&frequency_rad_per_s| {
            let needed = 1.0 / magnitude(prefilter.at_frequency(frequency_rad_per_s));
            TrackingExtremes {
                frequency_rad_per_s,
                greatest: needed,
                greatest_member: 0,
                least: needed,
                least_member: 0,
            }
        })
        .collect();
    let limit = |decibels: f64| Limit::Constant(10f64.powf(decibels / 20.0));
    let specification = tracking(limit(-half_db), limit(half_db), [0.0, f64::INFINITY]);
    PrefilterBand::new(&extremes, &specification).unwrap()
}

/// Band of constant width around a prefilter: that prefilter is found in the middle; no prefilter
/// exceeds half of the width, and none of lower order reaches it.
#[test]
fn the_middle_of_a_band_is_found() {
    let mut frequencies = spaced(0.05, 200.0, 60);
    frequencies.insert(0, 0.0);
    let pair = |natural_frequency, damping_ratio| Element::ComplexPoles { natural_frequency, damping_ratio };
    let zeros = Element::ComplexZeros { natural_frequency: 9.0, damping_ratio: 0.5 };
    for (elements, order) in [
        (vec![Element::RealPole { frequency: 2.0 }], 1),
        (vec![pair(4.0, 0.5)], 2),
        (vec![pair(4.0, 2.5), Element::RealZero { frequency: 11.0 }], 2),
        (vec![pair(6.0, 0.6), Element::RealPole { frequency: 1.0 }], 3),
        (vec![pair(6.0, 0.6), Element::RealPole { frequency: 1.0 }, Element::RealZero { frequency: 0.3 }], 3),
        (vec![pair(20.0, 0.7), Element::RealPole { frequency: 1.0 }, zeros], 3),
    ] {
        let middle = Compensator::new(elements.clone()).transfer_function().unwrap();
        let half_db = 0.05;
        let band = around_prefilter(&middle, half_db, &frequencies);
        let fitted = found(run(band, &Timing::default(), PrefilterOptions::new(3, 7)));
        let function = fitted.compensator.transfer_function().unwrap();
        assert_eq!(function.poles().len(), order, "{elements:?}");
        assert!((fitted.worst.margin_db - half_db).abs() < 1e-3, "{elements:?} {:?}", fitted.worst);
        for (pole, known) in function.poles().iter().zip(middle.poles()) {
            assert!(magnitude(pole - known) < 0.02 * magnitude(*known), "{elements:?} {pole} {known}");
        }
        if order > 1 {
            let band = around_prefilter(&middle, half_db, &frequencies);
            let outcome = run(band, &Timing::default(), PrefilterOptions::new(order - 1, 7));
            let PrefilterOutcome::OrderTooLow { best: Some(best) } = outcome else { panic!("{outcome:?}") };
            assert!(best.worst.margin_db < -0.001);
        }
    }
}

/// The fitted prefilter meets the specification between the frequencies and at zero frequency,
/// which the published one just misses, and for every plant of the box.
#[test]
fn a_servo_gets_a_prefilter_that_its_audit_meets() {
    let (around, members, specification) = servo();
    let band = |frequencies: &[f64]| {
        PrefilterBand::of_family(&around, &members, frequencies, &specification).unwrap()
    };
    let searched = band(&spaced(0.01, 10.0, 40));
    let fractions = [1, 2, 3].map(|seed| {
        let outcome = run(searched.clone(), &Timing::default(), PrefilterOptions::new(3, seed));
        let again = run(searched.clone(), &Timing::default(), PrefilterOptions::new(3, seed));
        assert_eq!(format!("{outcome:?}"), format!("{again:?}"));
        let fitted = found(outcome);
        let function = fitted.compensator.transfer_function().unwrap();
        assert!(function.poles().len() == 2 && function.zeros().is_empty());
        assert!(fitted.compensator.stages.iter().all(|stage| stage.element != Element::Gain(1.0)));
        assert!((function.dc_gain() - 1.0).abs() < 1e-15);
        let dense = band(&spaced(0.001, 10.0, 700)).margins(&function);
        assert!(
            dense[0].fraction() > 0.6 && dense[0].fraction() <= fitted.worst.fraction(),
            "{:?}",
            dense[0]
        );
        fitted.worst.fraction()
    });
    assert!(fractions.iter().all(|fraction| (fraction - fractions[0]).abs() < 0.0101), "{fractions:?}");
    let prefilter = found(run(searched, &Timing::default(), PrefilterOptions::new(3, 1))).compensator;
    let feedback = Compensator::new(vec![Element::General(servo_controller())]);
    let controller = Controller { feedback, prefilter, ..Controller::default() };
    let both = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let problem = AuditProblem {
        family: &servo_family(),
        compensation: &both,
        specifications: &[specification],
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: 0.0,
    };
    let (findings, _) = audit_specifications(&problem, &mut unwatched).unwrap();
    let finding = &findings[0];
    assert_eq!(finding.verdict, Verdict::Met);
    assert_eq!(finding.worst.as_ref().map(|worst| worst.frequency_rad_per_s), Some(0.0)); // where there is no slack
}

/// Closed loop T = k/(s + k): at 3 rad/s 0.8 and 0.3162, which limits of 1.5 to 1 cannot both
/// contain.
#[test]
fn a_closed_band_names_the_two_plants() {
    let (compensation, members) = integrators(&[2.0, 1.0, 4.0]);
    let specification = tracking(Limit::Constant(1.0), Limit::Constant(1.5), [1.0, 10.0]);
    let band = PrefilterBand::of_family(&compensation, &members, &[1.0, 3.0], &specification).unwrap();
    let outcome = run(band.clone(), &Timing::default(), PrefilterOptions::new(3, 1));
    let PrefilterOutcome::NoBand(point) = outcome else { panic!("{outcome:?}") };
    assert_eq!((point.frequency_rad_per_s, point.least_member, point.greatest_member), (3.0, 1, 2));
    let width_db = 20.0 * (1.5 * 0.1f64.sqrt() / 0.8).log10();
    assert!((point.width_db() - width_db).abs() < 1e-12);
    // half of the deficit opens it, and no less
    assert!(band.clone().relaxed(-width_db / 2.0 - 0.01).closed(0.001).is_some());
    let eased = band.relaxed(-width_db / 2.0 + 0.01);
    assert_eq!(eased.closed(0.001), None);
    let fitted = found(run(eased, &Timing::default(), PrefilterOptions::new(2, 1)));
    assert!(fitted.worst.margin_db > 0.0);
}

/// Band closed by less than the tolerance, whose middle still counts as met.
#[test]
fn a_band_closed_by_less_than_the_tolerance_is_met_within_it() {
    let lag = Element::RealPole { frequency: 2.0 }.transfer_function().unwrap();
    let mut frequencies = spaced(0.05, 200.0, 40);
    frequencies.insert(0, 0.0);
    let fitted_into = |half_db: f64| {
        let band = around_prefilter(&lag, half_db, &frequencies);
        run(band, &Timing::default(), PrefilterOptions { tolerance_db: 0.01, ..PrefilterOptions::new(1, 1) })
    };
    let fitted = found(fitted_into(-0.005));
    assert!((fitted.worst.margin_db + 0.005).abs() < 1e-3, "{:?}", fitted.worst);
    assert!(matches!(fitted_into(-0.015), PrefilterOutcome::NoBand(_)));
}

/// Margins in a sampled loop, which are those of the sampled prefilter for every discretisation.
#[test]
fn a_sampled_prefilter_has_the_margins_that_were_searched() {
    for discretization in [Discretization::Tustin, Discretization::Matched] {
        let timing = Timing { sample_time_s: Some(0.02), discretization, delay_s: 0.01, ..Timing::default() };
        let one = |element| Compensator::new(vec![element]);
        let sampled = |prefilter: Compensator| {
            let controller =
                Controller { feedback: one(Element::Gain(2.0)), prefilter, timing, ..Controller::default() };
            Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
        };
        let compensation = sampled(Compensator::default());
        let members = [1.0, 1.5, 2.0].map(|k| member(&compensation, &[k], &[1.0, 0.0]));
        let limit = |corner: f64| Element::ComplexPoles { natural_frequency: corner, damping_ratio: 1.0 };
        let limit = |corner: f64| Limit::Rational(limit(corner).transfer_function().unwrap());
        let specification = tracking(limit(0.8), limit(6.0), [0.0, 60.0]);
        let frequencies = spaced(0.1, 60.0, 40);
        let band = PrefilterBand::of_family(&compensation, &members, &frequencies, &specification).unwrap();
        let fitted = found(run(band.clone(), &timing, PrefilterOptions::new(3, 1)));
        assert!(fitted.worst.fraction() > 0.0);
        let worst = band.margins(sampled(fitted.compensator.clone()).prefilter())[0];
        assert!(
            (0.0..0.0101).contains(&(fitted.worst.fraction() - worst.fraction())),
            "{worst:?} {:?}",
            fitted.worst
        );
        // the continuous prefilter differs at 60 rad/s, where the trapezoidal rule shifts it by a
        // seventh
        let continuous = fitted.compensator.transfer_function().unwrap();
        assert!(band.margins(&continuous)[0] != worst);
    }
}

/// Prefilter before the sampling, fitted as in a continuous loop, with the band of the sampled one.
#[test]
fn a_prefilter_before_the_samples_is_fitted_in_s() {
    let lag = Element::RealPole { frequency: 2.0 }.transfer_function().unwrap();
    let fitted = |timing: &Timing| {
        let band = around_prefilter(&lag, 0.5, &spaced(0.05, 60.0, 40));
        found(run(band, timing, PrefilterOptions::new(2, 1)))
    };
    let sampled = Timing { sample_time_s: Some(0.05), ..Timing::default() };
    let continuous = fitted(&Timing::default());
    assert_eq!(fitted(&Timing { continuous_prefilter: true, ..sampled }), continuous);
    assert_ne!(fitted(&sampled).compensator, continuous.compensator);
}

/// Analytic slopes of every margin against central differences, and the worst of them is the one
/// that is evaluated.
#[test]
fn the_slopes_of_a_fit_are_those_of_its_margins() {
    let range = [0.1, 100.0];
    let pair = ([0.1, 100.0], [0.1, 10.0]);
    let parts = vec![
        StructureFactor::PolePair { natural_frequency: pair.0, damping_ratio: pair.1 },
        StructureFactor::RealPole { frequency: range },
        StructureFactor::ZeroPair { natural_frequency: pair.0, damping_ratio: pair.1 },
        StructureFactor::RealZero { frequency: range },
    ];
    let structure = Structure { sign: 1.0, gain: [0.5, 2.0], parts };
    let (compensation, members, specification) = servo();
    let band =
        PrefilterBand::of_family(&compensation, &members, &spaced(0.1, 10.0, 9), &specification).unwrap();
    let mut fit = PrefilterFit::new(&band, structure, &Timing::default(), 0.001).unwrap();
    let x: Vec<f64> = [1.1, 3.0, 0.6, 8.0, 5.0, 1.5, 20.0].iter().map(|number: &f64| number.ln()).collect();
    let here = fit.slopes(&x);
    assert_eq!(
        here.margins.len(),
        2 * band.points().iter().filter(|point| point.frequency_rad_per_s > 0.0).count()
    );
    let least = here.margins.iter().map(|row| row.margin_db / row.rate).fold(f64::INFINITY, f64::min);
    assert_eq!(fit.judge(&x).worst_margin_db, least);
    let step = 1e-5;
    for moved in 0..x.len() {
        let mut at = |step: f64| {
            let mut x = x.clone();
            x[moved] += step;
            fit.slopes(&x).margins
        };
        let (below, above) = (at(-step), at(step));
        for ((row, below), above) in here.margins.iter().zip(&below).zip(&above) {
            assert_eq!((row.sample, row.sample), (below.sample, above.sample));
            let difference = (above.margin_db - below.margin_db) / (2.0 * step);
            let scale = row.margin_db.abs() + DECIBELS_PER_NEPER;
            assert!((row.slopes[moved] - difference).abs() < 1e-6 * scale, "{moved} {row:?} {difference}");
        }
    }
}
