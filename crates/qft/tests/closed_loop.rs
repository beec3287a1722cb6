//! Members of sampled, continuous and measured loops against closed forms.

#![allow(clippy::expect_used, clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{LinearError, LinearOperation, Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
use phea_qft::closed_loop::{Compensation, MemberResponse};
use phea_qft::family::MeasuredPlant;

const SAMPLE_TIME: f64 = 0.01;
/// Frequencies up to the highest of a sampled loop, rad/s.
const FREQUENCIES: [f64; 6] = [0.01, 1.0, 17.0, 99.0, 250.0, 314.0];

fn rational(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

fn plant(numerator: &[f64], denominator: &[f64], dead_time_s: f64) -> PlantCoefficients<f64> {
    let command = RationalCoefficients { numerator: numerator.to_vec(), denominator: denominator.to_vec() };
    PlantCoefficients { command, disturbance: None, dead_time_s, rate: None }
}

fn timing(sample_time_s: Option<f64>, delay_s: f64) -> Timing {
    Timing { sample_time_s, delay_s, ..Timing::default() }
}

fn compensation(timing: Timing, sensor: TransferFunction) -> Compensation {
    Compensation::new(&Controller { timing, ..Controller::default() }, sensor).unwrap()
}

fn z(frequency: f64) -> Complex64 {
    let angle = frequency * SAMPLE_TIME;
    Complex64::new(portable::cos(angle), portable::sin(angle))
}

#[track_caller]
fn close(found: Complex64, expected: Complex64) {
    let error = portable::magnitude(found - expected) / portable::magnitude(expected);
    assert!(error < 1e-12, "{found} is not {expected}: {error:e}");
}

/// Checks a member of a sampled loop at every frequency.
fn sampled(
    plant: PlantCoefficients<f64>,
    delay_s: f64,
    sensor: TransferFunction,
    examine: impl Fn(Complex64, MemberResponse),
) {
    let member = compensation(timing(Some(SAMPLE_TIME), delay_s), sensor).member(plant).unwrap();
    for frequency in FREQUENCIES {
        examine(z(frequency), member.response(frequency).unwrap());
    }
}

fn unity() -> TransferFunction {
    TransferFunction::gain_only(1.0)
}

/// Plant 1/s becomes T/(z - 1), and a/(s + a) becomes (1 - e)/(z - e) with e = exp(-a T).
#[test]
fn integrator_and_lag_are_held_exactly() {
    let integrator = plant(&[1.0], &[1.0, 0.0], 0.0);
    sampled(integrator, 0.0, unity(), |z, found| close(found.plant, SAMPLE_TIME / (z - 1.0)));
    let e = portable::exp(-30.0 * SAMPLE_TIME);
    sampled(plant(&[30.0], &[1.0, 30.0], 0.0), 0.0, unity(), |z, found| {
        close(found.plant, (1.0 - e) / (z - e));
        close(found.sensor, Complex64::new(1.0, 0.0));
    });
}

/// Prefilter a/(s + a) before the sampling: a/(jw + a) at every frequency; for a step of the
/// reference it acts as (1 - e)/(z - e), e = exp(-a T).
#[test]
fn a_prefilter_before_the_samples_is_not_sampled() {
    let a = 200.0;
    let timing = Timing { continuous_prefilter: true, ..timing(Some(SAMPLE_TIME), 0.0) };
    let around = |prefilter| {
        let controller = Controller { prefilter, timing, ..Controller::default() };
        Compensation::new(&controller, unity())
    };
    let compensation = around(Compensator::new(vec![Element::RealPole { frequency: a }])).unwrap();
    let of_step = compensation.prefilter_of_step().unwrap();
    let e = portable::exp(-a * SAMPLE_TIME);
    for frequency in FREQUENCIES {
        close(compensation.response(frequency).prefilter, a / Complex64::new(a, frequency));
        close(of_step.at_frequency(frequency), (1.0 - e) / (z(frequency) - e));
        close(compensation.response(frequency).feedback, Complex64::new(1.0, 0.0));
    }
    let sampled = unity().in_domain(TimeDomain::Discrete { sample_time_s: SAMPLE_TIME }).unwrap();
    let refused = around(Compensator::new(vec![Element::General(sampled)]));
    assert_eq!(refused.unwrap_err(), LinearError::DomainMismatch);
}

/// A dead time d of a fraction of a sample splits the step: with r = exp(-a (T - d)), a/(s + a)
/// becomes (1 - r + (r - e)/z)/(z - e). Plant and loop delay add up, whole samples are powers of
/// 1/z.
#[test]
fn fractions_of_a_sample_are_exact() {
    let (a, dead_time) = (30.0, 0.0037);
    let (e, r) = (portable::exp(-a * SAMPLE_TIME), portable::exp(-a * (SAMPLE_TIME - dead_time)));
    let lag = |z: Complex64| (1.0 - r + (r - e) / z) / (z - e);
    let late = |z: Complex64| (SAMPLE_TIME - dead_time + dead_time / z) / (z - 1.0);
    for (in_plant, in_loop, samples) in
        [(dead_time, 0.0, 0), (0.0, dead_time, 0), (0.002, 0.0017, 0), (0.03, dead_time, 3)]
    {
        let shift = |z: Complex64| (0..samples).fold(Complex64::new(1.0, 0.0), |product, _| product / z);
        sampled(plant(&[a], &[1.0, a], in_plant), in_loop, unity(), |z, found| {
            close(found.plant, lag(z) * shift(z));
        });
        sampled(plant(&[1.0], &[1.0, 0.0], in_plant), in_loop, unity(), |z, found| {
            close(found.plant, late(z) * shift(z));
        });
    }
}

/// Plant and sensor P H are held together: b/(s (s + b)) becomes ((bT - 1 + e) z + 1 - e - bT e)/(b
/// (z - 1)(z - e)). The dead time of the sensor adds to the loop's.
#[test]
fn plant_and_sensor_are_held_together() {
    let b = 80.0;
    let (e, turn) = (portable::exp(-b * SAMPLE_TIME), b * SAMPLE_TIME);
    let both = |z: Complex64| ((turn - 1.0 + e) * z + 1.0 - e - turn * e) / (b * (z - 1.0) * (z - e));
    let sensor = rational(&[b], &[1.0, b]);
    sampled(plant(&[1.0], &[1.0, 0.0], 0.0), 0.0, sensor.clone(), |z, found| {
        close(found.plant, SAMPLE_TIME / (z - 1.0));
        close(found.plant * found.sensor, both(z));
    });
    let late = sensor.with_dead_time(2.0 * SAMPLE_TIME).unwrap();
    sampled(plant(&[1.0], &[1.0, 0.0], 0.0), SAMPLE_TIME, late, |z, found| {
        close(found.plant, SAMPLE_TIME / (z - 1.0) / z);
        close(found.plant * found.sensor, both(z) / (z * z * z));
    });
}

#[test]
fn a_continuous_loop_carries_delay_and_sensor() {
    let sensor = rational(&[80.0], &[1.0, 80.0]).with_dead_time(0.004).unwrap();
    let disturbance = Some(RationalCoefficients { numerator: vec![-3.0, 0.0], denominator: vec![1.0, 30.0] });
    let member = PlantCoefficients { disturbance, ..plant(&[30.0], &[1.0, 30.0], 0.003) };
    let member = compensation(timing(None, 0.001), sensor).member(member).unwrap();
    for frequency in FREQUENCIES {
        let s = Complex64::new(0.0, frequency);
        let found = member.response(frequency).unwrap();
        close(found.plant, 30.0 / (s + 30.0) * portable::exp_complex(-s * 0.004));
        close(found.sensor, 80.0 / (s + 80.0) * portable::exp_complex(-s * 0.004));
        close(found.load_motion, -3.0 * s / (s + 30.0));
    }
}

/// Gain K in U = G (F R - Y) + K s D gives a path parallel to Pd: Pd + K jw P, with P delayed in a
/// continuous loop, and sampled in a sampled one, where a/(s + a) becomes (1 - r + (r - e)/z)/(z
/// (z - e)) after a sample and a fraction of one. The loop is unchanged.
#[test]
fn a_rate_that_is_fed_forward_is_a_path_of_the_disturbance() {
    let (a, gain, fraction) = (30.0, 0.7, 0.0037);
    let disturbance = Some(RationalCoefficients { numerator: vec![-3.0, 0.0], denominator: vec![1.0, 5.0] });
    let plant = PlantCoefficients { disturbance, ..plant(&[a], &[1.0, a], 0.0) };
    let sensor = rational(&[80.0], &[1.0, 80.0]);
    let (e, r) = (portable::exp(-a * SAMPLE_TIME), portable::exp(-a * (SAMPLE_TIME - fraction)));
    for sample_time_s in [None, Some(SAMPLE_TIME)] {
        let own = timing(sample_time_s, SAMPLE_TIME + fraction);
        let [fed, own] = [Timing { rate_feed_forward: gain, ..own }, own]
            .map(|timing| compensation(timing, sensor.clone()));
        let member = fed.member(plant.clone()).unwrap();
        for frequency in FREQUENCIES {
            let (s, z) = (Complex64::new(0.0, frequency), z(frequency));
            let late = match sample_time_s {
                None => a / (s + a) * portable::exp_complex(-s * (SAMPLE_TIME + fraction)),
                Some(_) => (1.0 - r + (r - e) / z) / (z - e) / z,
            };
            let without = own.plant_response(plant.clone(), frequency).unwrap();
            for found in
                [member.response(frequency).unwrap(), fed.plant_response(plant.clone(), frequency).unwrap()]
            {
                close(found.load_motion, -3.0 * s / (s + 5.0) + gain * s * late);
                close(found.plant, without.plant);
                close(found.sensor, without.sensor);
            }
        }
    }
}

fn measured_lag(a: f64) -> MeasuredPlant {
    measured_lag_at(a, 500)
}

/// Measurement of a lag at this number of points, from 0.5 rad/s in steps of 1.3 %.
fn measured_lag_at(a: f64, points: i32) -> MeasuredPlant {
    let frequencies_rad_per_s: Vec<f64> =
        (0..points).map(|k| 0.5 * portable::exp(f64::from(k) * 0.013)).collect();
    let lag = |frequency: &f64| a / (Complex64::new(0.0, *frequency) + a);
    let command = frequencies_rad_per_s.iter().map(lag).collect();
    MeasuredPlant {
        name: "lag".into(),
        frequencies_rad_per_s,
        command,
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    }
}

/// A measured plant equals the plant at its points, is close to it between them, and does not exist
/// beyond them.
#[test]
fn a_measured_plant_replaces_the_plant() {
    let (a, sensor) = (30.0, rational(&[80.0], &[1.0, 80.0]));
    let around = compensation(timing(None, 0.003), sensor);
    let (measured, exact) =
        (around.measured(&measured_lag(a)), around.member(plant(&[a], &[1.0, a], 0.0)).unwrap());
    let point = measured_lag(a).frequencies_rad_per_s[123];
    let (found, expected) = (measured.response(point).unwrap(), exact.response(point).unwrap());
    close(found.plant, expected.plant);
    close(found.sensor, expected.sensor);
    // Linear interpolation over a step h of ln w: the error is below h^2/8 times the second
    // derivative of ln P, at most 1/2.
    let between = point * 1.0065;
    let ratio = measured.response(between).unwrap().plant / exact.response(between).unwrap().plant;
    assert!(portable::magnitude(ratio - 1.0) < 0.013 * 0.013 / 16.0, "{ratio}");
    assert_eq!([0.4, 400.0].map(|frequency| measured.response(frequency)), [None, None]);
}

/// A sampled measured plant has the hold's lag and droop; only the images above pi/T are missing.
/// For a lag a/(s + a) their sum is w a T^2/12 of its gain at low frequency: the sum of a (w
/// T)/(w - 2 pi n/T)^2 over all n but zero.
#[test]
fn a_measured_plant_is_held_up_to_its_images() {
    let a = 30.0;
    let around = compensation(timing(Some(SAMPLE_TIME), 0.0), unity());
    let (measured, exact) =
        (around.measured(&measured_lag(a)), around.member(plant(&[a], &[1.0, a], 0.0)).unwrap());
    for frequency in [0.7, 5.0, 20.0] {
        let [found, expected] = [measured.response(frequency), exact.response(frequency)];
        let error = portable::magnitude(found.unwrap().plant - expected.unwrap().plant);
        let images = frequency * a * SAMPLE_TIME * SAMPLE_TIME / 12.0;
        assert!((error / images - 1.0).abs() < 0.1, "{frequency}: {error:e} {images:e}");
    }
}

/// Images of a measurement up to many times pi/T: they are also summed, and the remainder falls
/// with the square of the range; if the range is too short for them, the response near pi/T is
/// unknown.
#[test]
fn the_images_of_a_measured_plant_are_summed() {
    let a = 30.0;
    let around = compensation(timing(Some(SAMPLE_TIME), 0.004), rational(&[400.0], &[1.0, 400.0]));
    let exact = around.member(plant(&[a], &[1.0, a], 0.0)).unwrap();
    // to 0.5 e^9.2 and 0.5 e^10.6 rad/s: 5000 and 20000
    let errors = [710, 817].map(|points| {
        let measured = around.measured(&measured_lag_at(a, points));
        let relative = |frequency: f64| {
            let (found, expected) =
                (measured.response(frequency).unwrap(), exact.response(frequency).unwrap());
            let loops = [found.plant * found.sensor, expected.plant * expected.sensor];
            portable::magnitude(loops[0] / loops[1] - 1.0)
                .max(portable::magnitude(found.plant / expected.plant - 1.0))
        };
        [5.0, 99.0, 250.0].map(relative).into_iter().fold(0.0, f64::max)
    });
    assert!(errors[0] < 0.01 && errors[1] < 0.4 * errors[0], "{errors:?}");
    let short = around.measured(&measured_lag(a));
    assert!(short.response(5.0).is_some() && short.response(250.0).is_none());
}

#[test]
fn a_plant_with_negative_delay_is_refused() {
    for sample_time in [None, Some(SAMPLE_TIME)] {
        let around = compensation(timing(sample_time, 0.004), unity());
        let early = plant(&[1.0], &[1.0, 1.0], -0.001);
        let refused = Some(LinearError::DeadTime { dead_time_s: -0.001 });
        assert_eq!(around.member(early.clone()).err(), refused);
        assert_eq!(around.plant_response(early, 1.0).err(), refused);
    }
}

#[test]
fn controllers_of_other_samples_and_sensors_in_z_are_refused() {
    let discrete = |sample_time_s| unity().in_domain(TimeDomain::Discrete { sample_time_s }).unwrap();
    let general = |function| Compensator::new(vec![Element::General(function)]);
    let refused = |feedback, prefilter, timing| {
        Compensation::new(&Controller { feedback, prefilter, timing, ..Controller::default() }, unity()).err()
    };
    let mismatch = Some(LinearError::DomainMismatch);
    let plain = Compensator::default;
    assert_eq!(refused(general(discrete(0.01)), plain(), timing(None, 0.0)), mismatch);
    assert_eq!(refused(plain(), general(discrete(0.02)), timing(Some(0.01), 0.0)), mismatch);
    assert_eq!(refused(general(discrete(0.01)), plain(), timing(Some(0.01), 0.0)), None);
    let sensor = Compensation::new(&Controller::default(), discrete(0.01)).err();
    assert_eq!(
        sensor,
        Some(LinearError::WrongDomain { operation: LinearOperation::Sensor, needed: "continuous" })
    );
}
