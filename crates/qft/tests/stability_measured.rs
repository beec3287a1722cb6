//! Nyquist count on measured points: correct if the points suffice, otherwise not resolved.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Family, MeasuredFamily, MeasuredPlant};
use phea_qft::stability::{
    FamilyStability, Instability, Irresolution, MemberStability, StabilityStatus, family_stability,
    member_stability,
};
use phea_qft::verification::{Evidence, PlantPoint, Verdict};

fn function(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

fn loop_of(elements: Vec<Element>, timing: Timing) -> Compensation {
    let controller = Controller { feedback: Compensator::new(elements), timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn measured(plant: &TransferFunction, from: f64, to: f64, points: usize) -> MeasuredPlant {
    let frequencies_rad_per_s = logarithmic_grid(from, to, points).unwrap();
    let command: Vec<Complex64> = frequencies_rad_per_s.iter().map(|&w| plant.at_frequency(w)).collect();
    let unstable_poles = plant.poles().iter().filter(|pole| pole.re > 0.0).count();
    MeasuredPlant {
        name: "bench".into(),
        frequencies_rad_per_s,
        command,
        disturbance: None,
        unstable_poles,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    }
}

fn found(plant: &MeasuredPlant, compensation: &Compensation) -> MemberStability {
    member_stability(&compensation.measured(plant), compensation)
}

/// The count of unstable poles agrees with the roots of the closed loop for stable and unstable
/// plants, with and without integrators.
#[test]
fn the_count_is_that_of_the_poles() {
    let resonant = function(&[4.0], &[1.0, 0.4, 4.0, 0.0]);
    let unstable = function(&[1.0, 2.0], &[1.0, 0.0, -2.5]);
    let double = function(&[1.0, 0.3], &[1.0, 0.0, 0.0]);
    let inverting = function(&[-1.0], &[1.0, 1.0]);
    let mut counts = std::collections::BTreeSet::new();
    for plant in [resonant, unstable, double, inverting] {
        for gain in [0.1, 0.3, 0.7, 1.5, 3.0, 10.0] {
            for integral in [false, true] {
                let mut elements = vec![Element::Gain(gain)];
                if integral {
                    elements
                        .push(Element::ProportionalIntegral { proportional_gain: 1.0, integral_gain: 0.05 });
                }
                let compensation = loop_of(elements, Timing::default());
                let closed = plant.series(compensation.feedback()).unwrap();
                let closed = closed.numerator().sum(&closed.denominator());
                let expected = closed.roots().unwrap().iter().filter(|root| root.re > 0.0).count();
                let own = found(&measured(&plant, 1e-3, 1e3, 4000), &compensation).status;
                counts.insert(expected);
                match expected {
                    0 => assert_eq!(own, StabilityStatus::Stable, "{plant:?} {gain} {integral}"),
                    count => assert_eq!(own, StabilityStatus::Unstable(Instability::Poles { count })),
                }
            }
        }
    }
    assert_eq!(counts.into_iter().collect::<Vec<_>>(), [0, 1, 2]);
}

/// The margin of k/s is pi/(2 k), less the delay of the loop and half a sample.
#[test]
fn the_critical_delay_of_an_integrator() {
    let plant = measured(&function(&[2.0], &[1.0, 0.0]), 0.01, 100.0, 801);
    let whole = std::f64::consts::FRAC_PI_4;
    let prompt = found(&plant, &loop_of(vec![], Timing::default())).critical_delay.unwrap();
    assert!((prompt.delay_s - whole).abs() < 1e-12 && (prompt.frequency_rad_per_s - 2.0).abs() < 1e-12);
    let delayed = loop_of(vec![], Timing { delay_s: 0.3, ..Timing::default() });
    assert!((found(&plant, &delayed).critical_delay.unwrap().delay_s - (whole - 0.3)).abs() < 1e-12);
    assert_eq!(
        found(&plant, &loop_of(vec![], Timing { delay_s: 0.8, ..Timing::default() })).status,
        StabilityStatus::Unstable(Instability::Poles { count: 2 })
    );
    let sampled = loop_of(vec![], Timing { sample_time_s: Some(0.01), ..Timing::default() });
    assert!((found(&plant, &sampled).critical_delay.unwrap().delay_s - (whole - 0.005)).abs() < 3e-5);
}

#[test]
fn behaviour_between_sparse_points_is_not_resolved() {
    let reason = |plant: &MeasuredPlant| match found(plant, &loop_of(vec![], Timing::default())).status {
        StabilityStatus::NotResolved(reason) => reason,
        status => panic!("{status:?}"),
    };
    let resonant = function(&[4.0], &[1.0, 0.01, 4.0]);
    assert!(matches!(reason(&measured(&resonant, 0.1, 100.0, 40)), Irresolution::Coarse { .. }));
    let integrator = function(&[1.0], &[1.0, 0.0]);
    assert!(matches!(reason(&measured(&integrator, 0.1, 1.5, 400)), Irresolution::HighEnd { .. }));
    assert!(matches!(reason(&measured(&integrator, 2.5, 100.0, 400)), Irresolution::LowEnd { .. }));
    let lag = function(&[100.0], &[1.0, 1.0]);
    assert!(matches!(reason(&measured(&lag, 0.9, 1e4, 400)), Irresolution::LowEnd { .. }));
    assert!(matches!(reason(&measured(&lag, 1.0, 1.0, 1)), Irresolution::Points));
    let undamped = loop_of(
        vec![Element::ComplexPoles { natural_frequency: 3.0, damping_ratio: 0.0 }],
        Timing::default(),
    );
    let status = found(&measured(&lag, 0.01, 1e4, 400), &undamped).status;
    assert_eq!(status, StabilityStatus::NotResolved(Irresolution::UndampedController));
}

/// Measured families are judged plant by plant: one unstable plant is named; no claim is made
/// between them.
#[test]
fn a_measured_family_is_judged_plant_by_plant() {
    let third_order = |gain: f64| measured(&function(&[gain], &[1.0, 3.0, 3.0, 1.0]), 1e-3, 1e3, 2000);
    let audited = |gains: &[f64]| -> FamilyStability {
        let plants = gains.iter().map(|&gain| third_order(gain)).collect();
        let family = Family::Measured(MeasuredFamily::new(plants).unwrap());
        let compensation = loop_of(vec![], Timing::default());
        family_stability(&family, &compensation, &mut unwatched).unwrap()
    };
    // (s + 1)^3 tolerates a gain of 8
    let good = audited(&[1.0, 7.5]).finding;
    assert_eq!((good.verdict, good.evidence), (Verdict::Met, Evidence::Grid));
    assert_eq!(good.closest_approach.unwrap().plant, PlantPoint::Measured(1));
    let bad = audited(&[1.0, 8.5, 2.0]);
    assert_eq!((bad.finding.verdict, bad.finding.plant), (Verdict::Violated, PlantPoint::Measured(1)));
    assert_eq!(bad.delay_margin, None);
}
