//! Families: coordinates of the box, members, and interpolation between measured points.

#![allow(clippy::expect_used, clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::family::{
    Coordinate, Extent, FamilyError, MeasuredFamily, MeasuredPlant, MeasurementError, Spacing,
    UncertainFamily, grid, random, vertices,
};

/// Plant p0/(s + p1 + p2 + p3), each parameter between 1 and 100 except the last, which is 5.
fn plant() -> UncertainPlant {
    let parameter = |name: &str, minimum: f64, maximum: f64| UncertainParameter {
        name: name.into(),
        nominal: 5.0,
        minimum,
        maximum,
    };
    let parameters = vec![
        parameter("k", 1.0, 100.0),
        parameter("a", 1.0, 100.0),
        parameter("b", 1.0, 100.0),
        parameter("c", 5.0, 5.0),
    ];
    UncertainPlant::record(parameters, |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0]],
            denominator: vec![1.0.into(), p[1] + p[2] + p[3]],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    })
    .unwrap()
}

fn coordinate(parameters: &[usize], opposed: &[usize], spacing: &[Spacing], points: usize) -> Coordinate {
    Coordinate {
        parameters: parameters.to_vec(),
        opposed: opposed.to_vec(),
        spacing: spacing.to_vec(),
        points,
    }
}

const LOG: Spacing = Spacing::Logarithmic;
const LINEAR: Spacing = Spacing::Linear;

/// Coordinates for k, and for b opposed to a.
fn coordinates() -> Vec<Coordinate> {
    vec![coordinate(&[0], &[], &[LOG], 5), coordinate(&[3, 1, 2], &[2], &[LINEAR, LINEAR, LOG], 4)]
}

#[test]
fn fractions_and_values_are_inverse_to_each_other() {
    let members = random(&plant(), &coordinates(), 200, 42).unwrap();
    let family = UncertainFamily::new(plant(), coordinates(), members, Extent::Box).unwrap();
    for values in &family.members()[1..] {
        let fractions = family.fractions(values);
        let again = family.values(&fractions);
        for (one, other) in values.iter().zip(&again) {
            assert!((one / other - 1.0).abs() < 1e-13, "{values:?} {again:?}");
        }
        assert!((fractions[1] - (values[1] - 1.0) / 99.0).abs() < 1e-14);
        assert!((fractions[1] - (1.0 - portable::ln(values[2]) / portable::ln(100.0))).abs() < 1e-13);
    }
    // Fractions beyond the ends are clamped to them, missing ones count as zero; the ends are
    // exact.
    assert_eq!(family.values(&[2.0, -1.0]), [100.0, 1.0, 100.0, 5.0]);
    assert_eq!(family.values(&[]), [1.0, 1.0, 100.0, 5.0]);
}

#[test]
fn a_grid_contains_its_corners_and_remains_within_the_box() {
    let (all, corners) =
        (grid(&plant(), &coordinates()).unwrap(), vertices(&plant(), &coordinates()).unwrap());
    assert_eq!((all.len(), corners.len()), (20, 4));
    assert!(corners.iter().all(|corner| all.contains(corner)));
    let inside = |values: &Vec<f64>| values[..3].iter().all(|value| (1.0..=100.0).contains(value));
    assert!(all.iter().all(inside));
    // Equal factors: the fourth root of 100 from point to point, the last coordinate varying
    // fastest.
    for index in 0..4 {
        assert!((all[4 * (index + 1)][0] / all[4 * index][0] - 10.0_f64.sqrt()).abs() < 1e-13);
    }
    // A grid without coordinates consists of one plant.
    assert_eq!(grid(&plant(), &[]).unwrap(), [[5.0; 4]]);
}

#[test]
fn invalid_families_are_refused() {
    let refused = |coordinates: Vec<Coordinate>, members: Vec<Vec<f64>>| {
        UncertainFamily::new(plant(), coordinates, members, Extent::Members).unwrap_err()
    };
    assert_eq!(refused(vec![], vec![vec![1.0; 3]]), FamilyError::Values { member: 0, found: 3, expected: 4 });
    for wrong in [0.5, 101.0, f64::NAN] {
        let error = refused(vec![], vec![vec![1.0, 1.0, 1.0, 5.0], vec![1.0, wrong, 1.0, 5.0]]);
        assert!(matches!(error, FamilyError::Outside { member: 1, parameter, .. } if parameter == "a"));
    }
    let twice = vec![coordinate(&[0], &[], &[LINEAR], 2), coordinate(&[1, 0], &[], &[LINEAR], 2)];
    assert_eq!(refused(twice, vec![]), FamilyError::Coordinate(0));
    assert_eq!(refused(vec![coordinate(&[4], &[], &[LINEAR], 2)], vec![]), FamilyError::Coordinate(4));
    let many = [0, 1, 2].map(|index| coordinate(&[index], &[], &[LINEAR], 1000));
    assert_eq!(grid(&plant(), &many), Err(FamilyError::TooManyMembers(1e9, 2_000_000)));
    assert!(matches!(random(&plant(), &many, 3_000_000, 1), Err(FamilyError::TooManyMembers(..))));
}

fn measured(frequencies: &[f64], command: Vec<Complex64>) -> MeasuredPlant {
    MeasuredPlant {
        name: "bench".into(),
        frequencies_rad_per_s: frequencies.to_vec(),
        command,
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    }
}

/// Linear interpolation in dB and phase over the logarithm of frequency: c (jw)^n is exact between
/// its points.
#[test]
fn powers_of_s_are_interpolated_exactly() {
    let power = |w: f64| 3.0 / (Complex64::new(0.0, w) * Complex64::new(0.0, w) * Complex64::new(0.0, w));
    let frequencies = [0.1, 0.7, 40.0];
    let plant = measured(&frequencies, frequencies.map(power).to_vec());
    for w in [0.1, 0.3, 0.7, 5.0, 39.0, 40.0] {
        let (found, _) = plant.response(w).unwrap();
        assert!(portable::magnitude(found / power(w) - 1.0) < 1e-13, "{w}");
    }
    assert_eq!([0.099, 41.0].map(|w| plant.response(w)), [None, None]);
}

/// The shorter way from 170 to -170 degrees passes through 180.
#[test]
fn the_phase_is_interpolated_along_the_shorter_arc() {
    let turn = |degrees: f64| {
        let angle = degrees * std::f64::consts::PI / 180.0;
        Complex64::new(portable::cos(angle), portable::sin(angle))
    };
    let mut plant = measured(&[1.0, 100.0], vec![turn(170.0), 4.0 * turn(-170.0)]);
    plant.disturbance = Some(vec![Complex64::new(0.0, 0.0), Complex64::new(2.0, 0.0)]);
    let (command, disturbance) = plant.response(10.0).unwrap();
    assert!(portable::magnitude(command - 2.0 * turn(180.0)) < 1e-14);
    // Zero has no logarithm: interpolation from it is linear.
    assert!(portable::magnitude(disturbance.unwrap() - 1.0) < 1e-14);
}

#[test]
fn measurements_out_of_order_are_refused_by_their_point() {
    let one = Complex64::new(1.0, 0.0);
    let refused = |frequencies: &[f64], command: Vec<Complex64>| {
        MeasuredFamily::new(vec![measured(&[1.0], vec![one]), measured(frequencies, command)]).err()
    };
    let point = |point| Some(MeasurementError::Point { plant: "bench".into(), point });
    assert_eq!(refused(&[1.0, 2.0], vec![one; 2]), None);
    assert_eq!(refused(&[1.0, 1.0], vec![one; 2]), point(1));
    assert_eq!(refused(&[0.0, 1.0], vec![one; 2]), point(0));
    assert_eq!(refused(&[1.0, f64::INFINITY], vec![one; 2]), point(1));
    assert_eq!(refused(&[1.0, 2.0], vec![one, Complex64::new(0.0, 0.0)]), point(1));
    assert_eq!(refused(&[1.0, 2.0], vec![one, Complex64::new(f64::NAN, 0.0)]), point(1));
    assert_eq!(refused(&[1.0, 2.0], vec![one]), point(1));
    assert_eq!(refused(&[1.0], vec![one; 2]), point(1));
    assert_eq!(refused(&[], vec![]), point(0));
    assert_eq!(MeasuredFamily::new(vec![]).err(), Some(MeasurementError::Empty));
}
