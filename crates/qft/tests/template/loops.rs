use num_complex::Complex64;
use phea_dynamics::controller::{Controller, Timing};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::magnitude;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::Spacing::Logarithmic;
use phea_qft::family::{Coordinate, Extent, Family, MeasuredFamily, MeasuredPlant, UncertainFamily};
use phea_qft::template::{Resolution, TemplateError, TemplateOptions, template};

use super::support::{coefficients, family, plain_loop, polar};

fn motor() -> UncertainFamily {
    family(&[("k", 1.0, 4.0, Logarithmic), ("a", 1.0, 2.0, Logarithmic)], 2, |p| {
        coefficients(vec![p[0] * p[1]], vec![1.0.into(), p[1], 0.0.into()])
    })
}

/// Small sample time and H = 1/(0.1 s + 1): every point is P H within the lag of the hold, half a
/// sample.
#[test]
fn sampling_delay_and_sensor_are_within_the_points() {
    let sensor =
        TransferFunction::from_polynomials(&Polynomial::new(vec![1.0]), &Polynomial::new(vec![0.1, 1.0]))
            .unwrap();
    let timing = Timing { sample_time_s: Some(1e-3), delay_s: 5e-3, ..Timing::default() };
    let sampled = Compensation::new(&Controller { timing, ..Controller::default() }, sensor).unwrap();
    let options = TemplateOptions::default();
    let motor = motor();
    let built = template(&Family::Uncertain(motor.clone()), &sampled, 3.0, &options).unwrap();
    assert!(matches!(built.template.resolution, Resolution::Resolved { .. }));
    for point in &built.template.points {
        let plant = motor.plant().response(&point.values, 3.0).unwrap();
        let lag = polar(1.0, -3.0 * 5.5e-3) / Complex64::new(1.0, 0.3);
        assert!(magnitude(point.response / (plant * lag) - 1.0) < 1e-5);
        assert!(magnitude(point.sensor * Complex64::new(1.0, 0.3) - 1.0) < 1e-2);
    }
}

/// A plant's response at one frequency is that of its member, which is factored first.
#[test]
fn a_response_needs_no_factors() {
    let lag =
        TransferFunction::from_polynomials(&Polynomial::new(vec![2.0]), &Polynomial::new(vec![0.1, 1.0]));
    let motor = motor();
    for sensor in [TransferFunction::gain_only(3.0), lag.unwrap().with_dead_time(0.013).unwrap()] {
        for sample_time_s in [None, Some(0.05)] {
            for delay_s in [0.0, 0.02, 0.05, 0.135] {
                let timing = Timing { sample_time_s, delay_s, ..Timing::default() };
                let controller = Controller { timing, ..Controller::default() };
                let compensation = Compensation::new(&controller, sensor.clone()).unwrap();
                let mut plant = motor.plant().coefficients(&[3.0, 1.5]).unwrap();
                plant.disturbance = Some(plant.command.clone());
                for frequency in [0.01, 1.0, 10.0, 55.0] {
                    let member = compensation.member(plant.clone()).unwrap().response(frequency).unwrap();
                    let response = compensation.plant_response(plant.clone(), frequency).unwrap();
                    assert!(magnitude(response.plant / member.plant - 1.0) < 1e-11);
                    assert!(magnitude(response.sensor / member.sensor - 1.0) < 1e-11);
                    assert_eq!(response.load_motion, member.load_motion);
                }
            }
        }
    }
}

#[test]
fn a_box_without_uncertainty_is_its_nominal_plant() {
    let motor = motor();
    let family = UncertainFamily::new(motor.plant().clone(), vec![], vec![], Extent::Box).unwrap();
    let built =
        template(&Family::Uncertain(family), &plain_loop(), 1.0, &TemplateOptions::default()).unwrap();
    assert_eq!((built.template.points.len(), built.template.outlines.len(), built.evaluations), (1, 0, 1));
    assert_eq!(built.template.resolution, Resolution::Resolved { phase_deg: 0.0, magnitude_db: 0.0 });
}

#[test]
fn no_enclosure_is_claimed_between_members() {
    let motor = motor();
    let members = motor.members().to_vec();
    let nominal_only =
        UncertainFamily::new(motor.plant().clone(), motor.coordinates().to_vec(), members, Extent::Members)
            .unwrap();
    let measured = |name: &str, gain: f64| MeasuredPlant {
        name: name.into(),
        frequencies_rad_per_s: vec![0.5, 2.0],
        command: vec![Complex64::new(gain, 0.0), Complex64::new(0.0, -gain)],
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    };
    let measured = MeasuredFamily::new(vec![measured("first", 1.0), measured("second", 2.0)]).unwrap();
    let options = TemplateOptions::default();
    for (family, count) in [(Family::Uncertain(nominal_only), 4), (Family::Measured(measured), 2)] {
        let built = template(&family, &plain_loop(), 0.5, &options).unwrap();
        assert_eq!((built.template.points.len(), built.evaluations), (count, count));
        assert!(built.template.outlines.is_empty());
        assert_eq!(built.template.resolution, Resolution::Members);
        assert_eq!(built.template.nominal, built.template.points[0].response);
        if count == 2 {
            let beyond = template(&family, &plain_loop(), 3.0, &options);
            assert_eq!(beyond, Err(TemplateError::OutOfReach { frequency_rad_per_s: 3.0 }));
        }
    }
}

/// Two parameters that rise together are one coordinate: a line, not an area.
#[test]
fn correlated_parameters_draw_a_line() {
    let motor = motor();
    let together = Coordinate {
        parameters: vec![0, 1],
        opposed: vec![],
        spacing: vec![Logarithmic, Logarithmic],
        points: 2,
    };
    let corner = motor.plant().parameters().iter().map(|parameter| parameter.maximum).collect();
    let family =
        UncertainFamily::new(motor.plant().clone(), vec![together], vec![corner], Extent::Box).unwrap();
    let built =
        template(&Family::Uncertain(family), &plain_loop(), 1.0, &TemplateOptions::default()).unwrap();
    assert!(matches!(built.template.resolution, Resolution::Resolved { .. }));
    for point in &built.template.points {
        // k from 1 to 4 while a goes from 1 to 2, both by equal factors: k = a^2
        assert!((point.values[0] / (point.values[1] * point.values[1]) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn impossible_requests_are_refused() {
    let family = Family::Uncertain(motor());
    for (phase_deg, magnitude_db) in [(0.0, 0.5), (90.0, 0.5), (2.0, -1.0), (2.0, f64::NAN)] {
        let options = TemplateOptions { phase_deg, magnitude_db, ..TemplateOptions::default() };
        let refused = template(&family, &plain_loop(), 1.0, &options);
        assert!(matches!(refused, Err(TemplateError::Tolerance { .. })));
    }
    // an integrator has no response at zero frequency
    let refused = template(&family, &plain_loop(), 0.0, &TemplateOptions::default());
    assert!(matches!(refused, Err(TemplateError::NotFinite { member: 0, .. })));
}
