//! Designs for a computer that stores few bits of each coefficient.

use phea_dynamics::controller::{Controller, Element, Section, Timing};
use phea_dynamics::watch::unwatched;
use phea_qft::design::quantization::{
    CoefficientFormat, Converter, Quantization, QuantizationError, rounded,
};
use phea_qft::design::{
    Design, DesignOptions, DesignProblem, DesignStatus, LoopDesignError, Objective, design,
};
use phea_qft::family::{Family, Spacing};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::specification::{ClosedLoop, Requirement};
use phea_qft::verification::{SpecificationMargin, TrackingJudgement, Verdict};

use super::problems::{
    EVERYWHERE, assert_met, audited, boxed, demand, designed, least_gain, problem, rational, stability,
    uncertain,
};

const SAMPLE: f64 = 0.01;

/// Plant k/(s + 1), k from 1 to 2.
fn lag() -> Family {
    let plant = uncertain(&[("k", 1.0, 1.0, 2.0)], |p| (vec![p[0]], vec![1.0.into(), 1.0.into()]));
    boxed(plant, Spacing::Linear, 3)
}

/// Limits |T| <= 1.3 and |S| <= 2 |s/(s + 3)| at 100 Hz.
fn regulation() -> DesignProblem {
    let frequencies = [0.1, 1.0, 10.0];
    let sensitivity = Requirement::at_most(ClosedLoop::Sensitivity, rational(&[2.0, 0.0], &[1.0, 3.0]));
    let specifications = vec![stability(1.3, &frequencies), demand(sensitivity, &frequencies, EVERYWHERE)];
    let timing = Timing { sample_time_s: Some(SAMPLE), ..Timing::default() };
    DesignProblem { timing, ..problem(lag(), specifications) }
}

fn proportional_integral() -> Structure {
    let parts = vec![
        StructureFactor::Fixed(Element::Integrator),
        StructureFactor::RealZero { frequency: [0.1, 100.0] },
    ];
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

/// A proportional-integral law in z is b0 + b1/z over 1 - 1/z, its integral gain (b0 + b1)/T: steps
/// of 2^-6 in b0 and b1 are steps of 1.6/s in that gain. Rounding the least gain that satisfies the
/// sensitivity violates it; the design for those steps satisfies it.
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
        // the audit is that of the returned controller, whose coefficients have these bits
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

/// The limits that bind a design are the active ones: at the design frequencies, and where a
/// specification is worst between them.
#[test]
fn binding_limits_are_touched_ones() {
    let problem = regulation();
    for objective in [Objective::LeastHighFrequencyGain, Objective::BestWorstMargin] {
        let options = DesignOptions { objective, ..least_gain(proportional_integral(), 1) };
        let design = designed(&problem, options);
        let worst = design.audit.specifications.iter().map(|finding| finding.worst.as_ref().unwrap());
        let least = worst.clone().map(|case| case.margin_db).fold(f64::INFINITY, f64::min);
        let base = if objective == Objective::BestWorstMargin { least.max(0.0) } else { 0.0 };
        assert!(design.binding.iter().all(|one| one.margin_db <= base + 0.05), "{:?}", design.binding);
        // each specification where it is worst, if there is no slack
        for (index, case) in worst.enumerate().filter(|(_, case)| case.margin_db <= base + 0.05) {
            let is_it = |one: &SpecificationMargin| {
                (one.specification, one.frequency_rad_per_s) == (index, case.frequency_rad_per_s)
            };
            assert!(design.binding.iter().any(is_it), "{case:?} of {:?}", design.binding);
        }
        // the search ended at a limit, which is between the design frequencies
        let at_design = |one: &SpecificationMargin| [0.1, 1.0, 10.0].contains(&one.frequency_rad_per_s);
        assert!(design.binding.iter().any(|one| !at_design(one)), "{:?}", design.binding);
    }
}

/// Coefficients of 24 bits have no visible effect.
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

/// A controller that needs a proportional gain above one cannot be stored in numbers below one.
#[test]
fn a_format_without_a_representable_controller_is_reported() {
    let options = least_gain(proportional_integral(), 1);
    let options = DesignOptions { coefficients: fixed(0, 12), ..options };
    let error = design(&regulation(), &options, &mut unwatched).unwrap_err();
    assert!(matches!(error, LoopDesignError::Quantization(QuantizationError::TooLarge { .. })), "{error}");
}

/// A continuous controller has no coefficients to round.
#[test]
fn a_continuous_controller_is_not_rounded() {
    let problem = DesignProblem { timing: Timing::default(), ..regulation() };
    let options = DesignOptions { coefficients: fixed(0, 1), ..least_gain(proportional_integral(), 1) };
    let design = designed(&problem, options);
    assert_eq!((design.status, design.controller), (DesignStatus::Met, design.law));
}

/// Converter of 9 bits over 8 units, for a command or a measurement.
fn converter() -> Converter {
    Converter::new(9, [-4.0, 4.0]).unwrap()
}

/// Output and command of k/(s + 1) sample by sample for a varying reference, with and without the
/// rounding of this computer: the rms of the differences.
fn rms_of_rounding(controller: &Controller, k: f64, quantization: &Quantization) -> [f64; 2] {
    let sampled = controller.sampled(SAMPLE).unwrap();
    let decay = (-SAMPLE).exp();
    let mut seed = 7_u64;
    let mut state = [sampled.at_rest(), sampled.at_rest()];
    let (mut output, mut squares, mut reference) = ([0.0; 2], [0.0; 2], 0.0);
    let samples = 100_000;
    for _ in 0..samples {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let uniform = (seed >> 11) as f64 / (1_u64 << 53) as f64;
        reference += 0.02 * (uniform - 0.5) - 0.001 * reference;
        let mut command = [0.0; 2];
        for (rounds, state) in state.iter_mut().enumerate() {
            let round = |converter: Option<Converter>, value: f64| match converter {
                Some(converter) if rounds == 1 => converter.rounded(value),
                _ => value,
            };
            let measured = round(quantization.measurement, output[rounds]);
            let command_of = sampled.step(state, reference, measured).command;
            command[rounds] = round(quantization.command, command_of);
            output[rounds] = decay * output[rounds] + (1.0 - decay) * k * command[rounds];
        }
        squares[0] += (output[1] - output[0]) * (output[1] - output[0]);
        squares[1] += (command[1] - command[0]) * (command[1] - command[0]);
    }
    squares.map(|sum| (sum / f64::from(samples)).sqrt())
}

/// The design with the greatest worst margin among those with no more than this effect of rounding,
/// rms.
fn allowed(quantization: &Quantization, of_output: f64, of_command: f64) -> (DesignProblem, Design) {
    let mut problem = regulation();
    let frequencies = vec![0.1, 1.0, 10.0, 100.0];
    problem.specifications.extend(quantization.force_specification(of_output, frequencies.clone()));
    problem.specifications.extend(quantization.command_specification(of_command, frequencies));
    let objective = Objective::BestWorstMargin;
    let options = DesignOptions { objective, ..least_gain(proportional_integral(), 1) };
    let design = designed(&problem, options);
    assert_met(&problem, &design, TrackingJudgement::Spread);
    (problem, design)
}

fn binds(design: &Design, specification: usize) -> bool {
    let worst = |index: usize| design.audit.specifications[index].worst.as_ref().unwrap().margin_db;
    let least = (0..design.audit.specifications.len()).map(worst).fold(f64::INFINITY, f64::min);
    worst(specification) < least + 0.01 && design.binding.iter().any(|one| one.specification == specification)
}

/// Allowed effect of the rounded measurement on the command, which limits |G/(1+L)|: the smaller it
/// is, the less gain the controller has at pi/T, and the command of the loop with rounding
/// satisfies it.
#[test]
fn an_allowed_error_of_the_command_binds_the_gain() {
    let quantization = Quantization { measurement: Some(converter()), ..Quantization::default() };
    let step = converter().step();
    let mut last = f64::INFINITY;
    for allowed_rms in [20.0 * step, 8.0 * step, 3.5 * step] {
        let (_, design) = allowed(&quantization, 1.0, allowed_rms);
        let function = design.law.feedback.transfer_function().unwrap();
        let gain = function.gain().abs();
        assert!(gain < 0.9 * last, "{gain} after {last}");
        last = gain;
        assert!(allowed_rms > 10.0 * step || binds(&design, 2), "{allowed_rms}: {:?}", design.binding);
        for k in [1.0, 1.5, 2.0] {
            let [_, rms] = rms_of_rounding(&design.controller, k, &quantization);
            assert!(rms < allowed_rms && rms > 0.02 * allowed_rms, "{rms} of {allowed_rms}");
        }
    }
}

/// Allowed effect of the rounded command on the output, which limits |P/(1+L)|, equal to 1/|G|
/// where the loop gain is high: the smaller it is, the more gain is required.
#[test]
fn an_allowed_error_of_the_output_binds_the_loop() {
    let quantization = Quantization { command: Some(converter()), ..Quantization::default() };
    let step = converter().step();
    let mut last = 0.0;
    for allowed_rms in [0.1 * step, 0.016 * step] {
        let (_, design) = allowed(&quantization, allowed_rms, 1.0);
        let gain = design.law.feedback.transfer_function().unwrap().gain().abs();
        assert!(gain > 1.1 * last, "{gain} after {last}");
        last = gain;
        for k in [1.0, 1.5, 2.0] {
            let [rms, _] = rms_of_rounding(&design.controller, k, &quantization);
            assert!(rms < allowed_rms && rms > 0.02 * allowed_rms, "{rms} of {allowed_rms}");
        }
    }
}
