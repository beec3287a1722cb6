//! Designs for a computer that keeps few bits of each coefficient.

use phea_dynamics::controller::{Controller, Element, Section, Timing};
use phea_qft::design::quantisation::{CoefficientFormat, QuantisationError, rounded};
use phea_qft::design::{DesignError, DesignOptions, DesignProblem, DesignRun, DesignStatus};
use phea_qft::family::{Family, Spacing};
use phea_qft::loop_shaping::{Part, Structure};
use phea_qft::specification::Requirement;
use phea_qft::verification::{TrackingJudgement, Verdict};

use crate::problems::{
    EVERYWHERE, assert_met, audited, boxed, demand, designed, least_gain, problem, rational, stability,
    uncertain,
};

/// k/(s + 1), k from 1 to 2.
fn lag() -> Family {
    let plant = uncertain(&[("k", 1.0, 1.0, 2.0)], |p| (vec![p[0]], vec![1.0.into(), 1.0.into()]));
    boxed(plant, Spacing::Linear, 3)
}

/// |T| <= 1.3 and |S| <= 2 |s/(s + 3)| at 100 Hz.
fn regulation() -> DesignProblem {
    let frequencies = [0.1, 1.0, 10.0];
    let sensitivity = Requirement::Sensitivity(rational(&[2.0, 0.0], &[1.0, 3.0]));
    let specifications = vec![stability(1.3, &frequencies), demand(sensitivity, &frequencies, EVERYWHERE)];
    let timing = Timing { sample_time_s: Some(0.01), ..Timing::default() };
    DesignProblem { timing, ..problem(lag(), specifications) }
}

fn proportional_integral() -> Structure {
    let parts = vec![Part::Fixed(Element::Integrator), Part::RealZero { frequency: [0.1, 100.0] }];
    Structure { sign: 1.0, gain: [0.1, 100.0], parts }
}

fn fixed(integer_bits: u8, fraction_bits: u8) -> CoefficientFormat {
    CoefficientFormat::Fixed { integer_bits, fraction_bits }
}

fn coefficients(controller: &Controller) -> Vec<f64> {
    let function = controller.feedback.transfer_function().unwrap();
    let sections = Section::in_series(&function).unwrap();
    sections.iter().flat_map(|one| [&one.numerator[..], &one.denominator[..]].concat()).collect()
}

/// A proportional-integral law in z is b0 + b1/z over 1 - 1/z, its integral gain (b0 + b1)/T: steps of 2^-6 in b0 and b1 are steps of 1.6/s in
/// that gain. Rounding the least that keeps to the sensitivity breaks it; the design for those steps keeps to it.
#[test]
fn coarse_coefficients_are_designed_for() {
    let problem = regulation();
    let exact = designed(&problem, least_gain(proportional_integral(), 1));
    assert_met(&problem, &exact, TrackingJudgement::Spread);
    assert_eq!(exact.controller, exact.law);
    for fraction_bits in [6, 7] {
        let format = fixed(4, fraction_bits);
        let mut afterwards = exact.clone();
        afterwards.controller = rounded(&exact.law, format).unwrap().controller;
        let broken = audited(&problem, &afterwards, TrackingJudgement::Spread);
        assert_eq!(broken.verdict, Verdict::Violated);
        let options = least_gain(proportional_integral(), 1);
        let design = designed(&problem, DesignOptions { coefficients: format, ..options });
        // its audit is that of the controller which it hands out, and that one has the bits
        assert_met(&problem, &design, TrackingJudgement::Spread);
        assert_eq!(design.controller, rounded(&design.law, format).unwrap().controller);
        let step = 2.0_f64.powi(-i32::from(fraction_bits));
        for coefficient in coefficients(&design.controller) {
            let steps = coefficient / step;
            assert!((steps - steps.round()).abs() < 1e-9, "{coefficient}");
        }
        assert!(design.objective_db > exact.objective_db, "{} {}", design.objective_db, exact.objective_db);
        assert!(design.objective_db < exact.objective_db + 6.0, "{:?}", design.rounds);
    }
}

/// Of 24 bits nothing is lost that would be seen.
#[test]
fn fine_coefficients_cost_nothing() {
    let problem = regulation();
    let options = least_gain(proportional_integral(), 1);
    let exact = designed(&problem, options.clone());
    let single = designed(&problem, DesignOptions { coefficients: CoefficientFormat::Single, ..options });
    assert_met(&problem, &single, TrackingJudgement::Spread);
    assert_ne!(single.controller, single.law);
    assert!((single.objective_db - exact.objective_db).abs() < 0.01, "{}", single.objective_db);
}

/// Nothing that needs a proportional gain above one can be kept in numbers below one.
#[test]
fn a_format_that_holds_no_controller_is_told() {
    let options = least_gain(proportional_integral(), 1);
    let mut run = DesignRun::new(regulation(), DesignOptions { coefficients: fixed(0, 12), ..options });
    let error = loop {
        match run.step() {
            Ok(true) => {}
            Ok(false) => panic!("{:?}", run.design().map(|design| &design.status)),
            Err(error) => break error,
        }
    };
    assert!(matches!(error, DesignError::Quantisation(QuantisationError::TooLarge { .. })), "{error}");
}

/// A continuous controller has no coefficients that could be rounded.
#[test]
fn a_continuous_controller_is_not_rounded() {
    let problem = DesignProblem { timing: Timing::default(), ..regulation() };
    let options = DesignOptions { coefficients: fixed(0, 1), ..least_gain(proportional_integral(), 1) };
    let design = designed(&problem, options);
    assert_eq!((design.status, design.controller), (DesignStatus::Met, design.law));
}
