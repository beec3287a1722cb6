//! Structures against the controllers that they represent.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Discretization, LinearError, TransferFunction};
use phea_dynamics::portable::magnitude;
use phea_qft::closed_loop::Compensation;
use phea_qft::loop_shaping::{Structure, StructureFactor};

use super::random::{Draw, structure};

const PERIOD: f64 = 0.004;
const DISCRETIZATIONS: [Discretization; 4] = [
    Discretization::Tustin,
    Discretization::PrewarpedTustin { frequency_rad_per_s: 60.0 },
    Discretization::ZeroOrderHold,
    Discretization::Matched,
];

fn timings() -> Vec<Timing> {
    let sampled = DISCRETIZATIONS.map(|discretization| Timing {
        sample_time_s: Some(PERIOD),
        discretization,
        ..Timing::default()
    });
    [vec![Timing::default()], sampled.to_vec()].concat()
}

fn frequencies() -> Vec<f64> {
    logarithmic_grid(0.1, 780.0, 25).unwrap()
}

/// Response of the structure: equal to that of the loop around the controller, continuous or
/// sampled by any rule.
#[test]
fn the_response_is_that_of_the_controller_in_its_loop() {
    let mut draw = Draw(3);
    for timing in timings() {
        for _ in 0..10 {
            let structure = structure(&mut draw);
            let x = draw.point(&structure.bounds());
            let controller =
                Controller { feedback: structure.compensator(&x), timing, ..Controller::default() };
            let around = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
            let found = structure.response(&timing, &frequencies()).unwrap().values(&x).unwrap();
            for (frequency, found) in frequencies().into_iter().zip(found) {
                let expected = around.response(frequency).feedback;
                let error = magnitude(found - expected) / magnitude(expected);
                assert!(error < 1e-10, "{timing:?} {frequency}: {found} is not {expected}, {error:e}");
            }
        }
    }
}

#[test]
fn slopes_are_those_of_central_differences() {
    let mut draw = Draw(4);
    for timing in timings() {
        let structure = structure(&mut draw);
        let x = draw.point(&structure.bounds());
        let response = structure.response(&timing, &frequencies()).unwrap();
        let slopes = response.slopes(&x).unwrap();
        for moved in 0..x.len() {
            let at = |step: f64| {
                let mut x = x.clone();
                x[moved] += step;
                response.values(&x).unwrap()
            };
            let (below, above) = (at(-1e-4), at(1e-4));
            for (index, slopes) in slopes.iter().enumerate() {
                let expected = (above[index] - below[index]) / (above[index] + below[index]) / 1e-4;
                assert!(magnitude(slopes[moved] - expected) < 1e-6, "{timing:?} {moved} {index}");
            }
        }
    }
}

/// Value of s^r G at a frequency far beyond all corners, and its slopes.
#[test]
fn the_high_frequency_gain_is_a_limit() {
    let mut draw = Draw(5);
    for _ in 0..20 {
        let structure = structure(&mut draw);
        let x = draw.point(&structure.bounds());
        assert_eq!((structure.order().unwrap(), structure.relative_degree().unwrap()), (5, 1));
        let function = structure.compensator(&x).transfer_function().unwrap();
        let far = 1e9;
        let expected = 20.0 * (far * magnitude(function.at_frequency(far))).log10();
        let found = structure.high_frequency_gain_db(&x).unwrap();
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        let slopes = structure.high_frequency_slopes_db();
        for (index, slope) in slopes.iter().enumerate() {
            let mut moved = x.clone();
            moved[index] += 0.5;
            let change = structure.high_frequency_gain_db(&moved).unwrap() - found;
            assert!((change - 0.5 * slope).abs() < 1e-9);
        }
    }
}

/// Value of G at pi/T without its zeros there, which by Tustin's rule equals this limit.
#[test]
fn the_high_frequency_gain_of_a_sampled_controller_follows_from_its_zeros() {
    let mut draw = Draw(6);
    let structure = structure(&mut draw);
    let x = draw.point(&structure.bounds());
    let function = structure.compensator(&x).transfer_function().unwrap();
    let sampled = function.discretized(PERIOD, Discretization::Tustin).unwrap();
    let frequency = (1.0 - 1e-7) * std::f64::consts::PI / PERIOD;
    let s = 2.0 / PERIOD * (0.5 * frequency * PERIOD).tan();
    let left = 20.0 * (s * magnitude(sampled.at_frequency(frequency))).log10();
    assert!((left - structure.high_frequency_gain_db(&x).unwrap()).abs() < 1e-5);
}

#[test]
fn a_controller_and_its_point_belong_together() {
    let mut draw = Draw(7);
    for _ in 0..50 {
        let structure = structure(&mut draw);
        let x = draw.point(&structure.bounds());
        let given = structure.compensator(&x);
        // this function in another form
        let general = Compensator::new(vec![Element::General(given.transfer_function().unwrap())]);
        for compensator in [&given, &general] {
            let found = structure.point_of(compensator).unwrap();
            let response = structure.response(&Timing::default(), &frequencies()).unwrap();
            let (found, expected) = (response.values(&found).unwrap(), response.values(&x).unwrap());
            for (found, expected) in found.iter().zip(&expected) {
                assert!(magnitude(found - expected) < 1e-7 * magnitude(*expected));
            }
        }
        let (around, point) = Structure::around(&given.transfer_function().unwrap(), 3.0).unwrap();
        assert_eq!(around.order().unwrap(), 5);
        let bounds = around.bounds();
        for (x, [low, high]) in point.iter().zip(&bounds) {
            assert!((0.5 * (low + high) - x).abs() < 1e-12 && (high - low - 2.0 * 3f64.ln()).abs() < 1e-12);
        }
        let found = around.response(&Timing::default(), &[3.0]).unwrap().values(&point).unwrap()[0];
        let expected = given.transfer_function().unwrap().at_frequency(3.0);
        assert!(magnitude(found - expected) < 1e-10 * magnitude(expected));
    }
}

#[test]
fn unrepresentable_controllers_have_no_point() {
    let corner = [1.0, 10.0];
    let parts =
        vec![StructureFactor::Fixed(Element::Integrator), StructureFactor::RealZero { frequency: corner }];
    let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts };
    let integral = |gain: f64, zero: f64| {
        Compensator::new(vec![
            Element::Gain(gain),
            Element::Integrator,
            Element::RealZero { frequency: zero },
        ])
    };
    assert!(structure.point_of(&integral(1.0, 5.0)).is_some());
    for (gain, zero) in [(1.0, 11.0), (20.0, 5.0), (-1.0, 5.0), (1.0, -5.0)] {
        assert_eq!(structure.point_of(&integral(gain, zero)), None);
    }
    let without_integrator = Compensator::new(vec![Element::RealZero { frequency: 5.0 }]);
    assert_eq!(structure.point_of(&without_integrator), None);
}

/// Roots that cannot be expressed by logarithms remain fixed.
#[test]
fn unstable_and_undamped_roots_are_not_free() {
    let pair = |re: f64, im: f64| [Complex64::new(re, im), Complex64::new(re, -im)];
    let zeros = [vec![Complex64::new(4.0, 0.0)], pair(0.0, 9.0).to_vec()].concat();
    let poles = [vec![Complex64::new(0.0, 0.0), Complex64::new(2.0, 0.0)], pair(-3.0, 4.0).to_vec()].concat();
    let function = TransferFunction::from_factors(-7.0, zeros, poles).unwrap();
    let (structure, x) = Structure::around(&function, 2.0).unwrap();
    assert_eq!(structure.dimension(), 3); // the gain and one pair
    assert!((x[1].exp() - 5.0).abs() < 1e-12 && (x[2].exp() - 0.6).abs() < 1e-12);
    assert_eq!(structure.sign, -1.0);
    let found = structure.response(&Timing::default(), &[3.0]).unwrap().values(&x).unwrap()[0];
    assert!(magnitude(found - function.at_frequency(3.0)) < 1e-13 * magnitude(found));
    assert_eq!(structure.point_of(&structure.compensator(&x)).map(|found| found.len()), Some(3));
}

#[test]
fn more_zeros_than_poles_cannot_be_sampled() {
    let parts = vec![StructureFactor::RealZero { frequency: [1.0, 2.0] }];
    let structure = Structure { sign: 1.0, gain: [1.0, 2.0], parts };
    let timing = Timing { sample_time_s: Some(0.1), ..Timing::default() };
    assert_eq!(structure.response(&timing, &[1.0]), Err(LinearError::Improper { zeros: 1, poles: 0 }));
    assert!(structure.response(&Timing::default(), &[1.0]).is_ok());
    let never = Timing { sample_time_s: Some(0.0), ..Timing::default() };
    let gain = Structure { parts: vec![], ..structure };
    assert!(matches!(gain.response(&never, &[1.0]), Err(LinearError::SampleTime { .. })));
}
