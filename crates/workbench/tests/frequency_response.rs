//! The machine excited by sines, compared with linear systems with which it must agree for small
//! motions.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use crate::answer_schema::parsed;
use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_workbench::answer::Answer;
use phea_workbench::command::{self, FrequencyOptions, Request, SimulateRequest};
use phea_workbench::engineering::linearize::linearize;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{
    FrequencyRequest, MachineResponses, NoClosedLoop, ResponsePoint, frequency_response,
};
use phea_workbench::project::{self, Loaded};
use phea_workbench::quantity::MotionKind;
use phea_workbench::source::Memory;
use serde_json::Value;

const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");

/// Viscous friction and four equal edges: nothing has a kink, so that derivatives exist at null.
const SMOOTH: [&str; 3] = [
    "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
    "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
    "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
];

fn load(settings: &[&str]) -> Loaded {
    let source = Memory::default().with("rig.toml", BENCHMARK);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn smooth(more: &[&str]) -> Loaded {
    load(&[&SMOOTH[..], more].concat())
}

fn shaken(loaded: &Loaded, frequencies: &[f64], amplitudes: [f64; 2]) -> MachineResponses {
    let request = FrequencyRequest {
        frequencies_rad_per_s: frequencies.to_vec(),
        command_amplitude_v: Some(amplitudes[0]),
        reference_amplitude_n: Some(amplitudes[1]),
    };
    let found = frequency_response(&Setup::new(&loaded.project).unwrap(), &request, &mut |_| true).unwrap();
    assert!(found.is_settled(), "{found:?}");
    found
}

/// Relative difference of two complex numbers.
fn apart(one: Complex64, other: Complex64) -> f64 {
    (one / other - 1.0).norm_sqr().sqrt()
}

fn worst(points: &[ResponsePoint], of: impl Fn(&ResponsePoint) -> f64) -> f64 {
    points.iter().map(of).fold(0.0, f64::max)
}

/// Small sines: the machine agrees with its derivatives, these with the linearised two-pressure
/// model, and the closed loop of the linear plant with that of the machine.
#[test]
fn small_sines_give_the_linear_plant() {
    let loaded = smooth(&[]);
    let found = shaken(&loaded, &[1.0, 30.0, 1000.0], [1e-4, 1.0]);
    let rig = Setup::rig_of(&loaded.project).unwrap();
    let two_pressure = linearize(&rig, None, &TransferFunction::gain_only(1.0)).unwrap().two_pressure.command;
    for point in &found.open_loop.points {
        let linearised = point.linearised_machine.unwrap();
        let exact = two_pressure.at_frequency(point.frequency_rad_per_s);
        assert!(apart(linearised, exact) < 1e-6, "{point:?} {exact}");
        assert!(apart(point.machine, linearised) < 1e-3 && point.distortion < 1e-2, "{point:?}");
        assert!(apart(point.machine, point.linear_plant) < 1e-3, "{point:?}");
    }
    for point in &found.closed_loop.unwrap().points {
        assert!(apart(point.linearised_machine.unwrap(), point.linear_plant) < 1e-6, "{point:?}");
        assert!(apart(point.machine, point.linear_plant) < 1e-3, "{point:?}");
    }
}

/// Terms that the derivatives leave out vanish as the amplitude decreases, and the harmonics with
/// them.
#[test]
fn the_amplitude_goes_to_zero_and_with_it_the_difference() {
    let loaded = smooth(&[]);
    let [large, middle, small] = [0.4, 0.04, 0.004].map(|amplitude| {
        let points = shaken(&loaded, &[100.0], [amplitude, 100.0]).open_loop.points;
        let difference = worst(&points, |point| apart(point.machine, point.linearised_machine.unwrap()));
        [difference, points[0].distortion]
    });
    for (more, less) in [(large, middle), (middle, small)] {
        assert!(less[0] < 0.2 * more[0] && less[1] < 0.2 * more[1], "{more:?} {less:?}");
    }
}

/// Waves in the lines, a delayed command and a sensor that lags: the linearised machine has delays,
/// and agrees with small sines.
#[test]
fn delays_are_included_in_the_linearisation() {
    let line = "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
    let late = "controller.delay=2 ms";
    let sensor = "sensor={ numerator = \"2000\", denominator = \"s + 2000\", delay = \"0.5 ms\" }";
    let gain = "controller.numerator=0.0001*s + 0.0008";
    let found = shaken(&smooth(&[line, late, sensor, gain]), &[30.0, 300.0], [1e-3, 1.0]);
    let closed = found.closed_loop.unwrap();
    for point in found.open_loop.points.iter().chain(&closed.points) {
        assert!(apart(point.machine, point.linearised_machine.unwrap()) < 2e-3, "{point:?}");
    }
    // the linear plant has lumped lines: at 30 rad/s waves are far away, and delay and sensor are
    // in both
    assert!(apart(closed.points[0].linearised_machine.unwrap(), closed.points[0].linear_plant) < 0.05);
}

/// The velocity of a load that yields, fed forward, closes a further loop, which the linear loop
/// contains, with lumped lines and with waves.
#[test]
fn a_load_velocity_that_is_fed_forward_is_in_the_linear_loop() {
    let sprung = "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"500 N.s/m\" }";
    let waves =
        "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
    let gain = "controller.numerator=0.0001*s + 0.0008";
    let fed = "controller.load_velocity_feed_forward.gain=20";
    let late = "controller.delay=2 ms";
    for lines in [&[][..], &[waves, gain], &[late], &[waves, gain, late]] {
        let with = [&[sprung, fed][..], lines].concat();
        let [with, without] = [&with[..], &with[..1]]
            .map(|settings| shaken(&smooth(settings), &[5.0, 40.0, 300.0], [1e-4, 1.0]).closed_loop.unwrap());
        for (point, other) in with.points.iter().zip(&without.points) {
            assert!(apart(point.linearised_machine.unwrap(), point.linear_plant) < 1e-5, "{point:?}");
            assert!(apart(point.machine, point.linear_plant) < 1e-3, "{point:?}");
            assert!(apart(other.machine, point.linear_plant) > 0.01, "{point:?} {other:?}");
        }
    }
}

/// Sampled feed-forward: the fundamental of the force between the samples is that of the command,
/// with the feedback included.
#[test]
fn a_load_velocity_that_is_sampled_is_in_the_linear_loop() {
    let sprung = "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"500 N.s/m\" }";
    let waves =
        "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
    let gain = "controller.numerator=0.0001*s + 0.0008";
    let [sampled, fed] = ["controller.sample_time=2 ms", "controller.load_velocity_feed_forward.gain=20"];
    for lines in [&[][..], &["controller.delay=1.5 ms"], &[waves, gain]] {
        let settings = [&[sprung, sampled, fed][..], lines].concat();
        let closed = shaken(&smooth(&settings), &[5.0, 40.0, 150.0], [1e-3, 1.0]).closed_loop.unwrap();
        for point in &closed.points {
            assert!(apart(point.machine, point.linear_plant) < 5e-3, "{settings:?} {point:?}");
        }
    }
}

/// A pump that gives little more than the leakage, an override of 40 bar and a load that the piston
/// presses: the supply pressure acts on the force, and the linear plant includes this.
#[test]
fn a_supply_that_yields_is_in_the_linear_plant() {
    let pump = [
        "supply.model=pump_limited",
        "supply.flow=1.5 L/min",
        "supply.relief_override=40 bar",
        "supply.volume=50 mL",
        "operating_point.load_force=4 kN",
    ];
    let waves =
        "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
    for lines in [&[][..], &[waves, "controller.numerator=0.0001*s + 0.0008"]] {
        let settings = [&pump[..], lines].concat();
        let loaded = smooth(&settings);
        let found = shaken(&loaded, &[1.0, 30.0, 300.0], [1e-4, 1.0]);
        let closed = found.closed_loop.unwrap();
        for point in found.open_loop.points.iter().chain(&closed.points) {
            assert!(apart(point.linearised_machine.unwrap(), point.linear_plant) < 1e-5, "{point:?}");
            assert!(apart(point.machine, point.linear_plant) < 1e-3, "{point:?}");
        }
        let mut rig = Setup::rig_of(&loaded.project).unwrap();
        let counted = rig.plant.coefficients().command.at_frequency(1.0);
        rig.plant.supply = None;
        assert!(apart(rig.plant.coefficients().command.at_frequency(1.0), counted) > 0.01);
    }
}

/// The fundamental between the samples of a sampled loop is that of the held command.
#[test]
fn a_sampled_loop_is_that_of_the_linear_plant_after_its_hold() {
    for settings in [
        vec!["controller.sample_time=1 ms"],
        vec![
            "controller.sample_time=1 ms",
            "controller.delay=1 ms",
            "controller.numerator=0.0001*s + 0.0008",
            "prefilter.continuous=true",
        ],
    ] {
        let closed = shaken(&smooth(&settings), &[40.0, 200.0], [1e-3, 1.0]).closed_loop.unwrap();
        for point in &closed.points {
            assert!(apart(point.machine, point.linear_plant) < 2e-3, "{settings:?} {point:?}");
        }
    }
}

/// Waves under a sampled controller: the loop is that of the plant in motion, with the images of
/// its response folded onto one another.
#[test]
fn a_sampled_loop_around_waves_is_that_of_their_response() {
    let waves =
        "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
    let gain = "controller.numerator=0.0002*s + 0.0016";
    let sensor = "sensor={ numerator = \"2000\", denominator = \"s + 2000\", delay = \"0.5 ms\" }";
    for more in [
        &["controller.sample_time=1 ms"][..],
        &["controller.sample_time=2 ms", "controller.delay=1 ms", sensor],
    ] {
        let settings = [&[waves, gain][..], more].concat();
        let closed = shaken(&smooth(&settings), &[5.0, 40.0, 150.0, 300.0, 600.0], [1e-3, 1.0]).closed_loop;
        for point in &closed.unwrap().points {
            assert!(apart(point.machine, point.linear_plant) < 5e-3, "{settings:?} {point:?}");
        }
    }
}

/// A progressive spring under load is stiffer than at rest: without other parts, with a damper, and
/// in front of a mass, the linearised machine is that of the loaded state.
#[test]
fn a_preloaded_progressive_spring_is_linearised_under_its_load() {
    for more in ["", ", damping = 500", ", damping = 500, mass = 2"] {
        let spring =
            format!("series={{ stiffness = \"2.24 MN/m\", progression = 0.5, travel = \"5.5 mm\"{more} }}");
        let settings =
            [spring.as_str(), "operating_point.load_force=4 kN", "controller.numerator=0.0001*s + 0.0008"];
        let found = shaken(&smooth(&settings), &[1.0, 30.0, 200.0], [2e-4, 1.0]);
        let closed = found.closed_loop.unwrap();
        for point in found.open_loop.points.iter().chain(&closed.points) {
            assert!(apart(point.linearised_machine.unwrap(), point.linear_plant) < 1e-6, "{more} {point:?}");
            assert!(apart(point.machine, point.linear_plant) < 1e-3, "{more} {point:?}");
        }
    }
}

/// A sensor with a DC gain of 2: the loop rests where the sensor reads twice the force of the
/// operating point, and is linearised there.
#[test]
fn a_loop_rests_at_its_sensor_reading() {
    let sensor = "sensor={ numerator = \"4000\", denominator = \"s + 2000\" }";
    let leaky = "controller.denominator=s + 1";
    for more in [&[][..], &[leaky], &[leaky, "controller.sample_time=1 ms"]] {
        let law = "controller.numerator=0.0001*s + 0.0008";
        let settings = [&[sensor, law, "operating_point.load_force=4 kN"], more].concat();
        let found = shaken(&smooth(&settings), &[1.0, 30.0, 200.0], [2e-4, 1.0]);
        for point in &found.closed_loop.unwrap().points {
            assert!(apart(point.machine, point.linear_plant) < 2e-3, "{more:?} {point:?}");
        }
    }
}

/// Bristles hold the piston: below their break-away the machine is stiffer than any plant with
/// viscous friction, and the sines show this. A spring of 1e7 N/m in addition to the load cell of
/// 2e7 N/m leaves two thirds of the force.
#[test]
fn sines_below_break_away_see_the_bristles() {
    let found = shaken(&load(&SMOOTH[1..]), &[20.0], [1e-4, 1.0]);
    let point = &found.open_loop.points[0];
    assert!(apart(point.machine, point.linearised_machine.unwrap()) < 0.02, "{point:?}");
    let held = point.machine.norm_sqr().sqrt() / point.linear_plant.norm_sqr().sqrt();
    assert!((held - 2.0 / 3.0).abs() < 0.05, "{held}");
}

fn output(settings: &[&str], options: FrequencyOptions, figures: bool) -> Result<Answer, String> {
    let requested =
        SimulateRequest { frequency_response: Some(options), figures, ..SimulateRequest::default() };
    let request = Request::Simulate(requested);
    command::answer(&Memory::default(), &load(settings), &[], &request).map_err(|error| error.to_string())
}

#[test]
fn the_answer_has_its_keys_files_and_figures() {
    let options =
        FrequencyOptions { frequencies: Some("20, 50 rad/s".to_string()), ..FrequencyOptions::default() };
    let answer = output(&SMOOTH, options, true).unwrap();
    assert!(answer.affirmative);
    let json: Value = parsed(&answer.json);
    assert_eq!((&json["command"], &json["scenarios"]), (&"simulate".into(), &serde_json::json!([])));
    let response = &json["frequency_response"];
    for (name, amplitude) in [("open_loop", "amplitude_v"), ("closed_loop", "amplitude_n")] {
        let points = response[name]["points"].as_array().unwrap();
        assert_eq!(points.len(), 2);
        for key in ["frequency_rad_per_s", amplitude, "difference_db", "difference_deg", "distortion_percent"]
        {
            assert!(points[0][key].is_f64(), "{name}.{key}: {}", points[0]);
        }
        assert!(points[1]["machine"].as_array().is_some_and(|pair| pair.len() == 2));
        assert_eq!(points[1]["settled"], true);
    }
    let names: Vec<&str> = answer.files.iter().map(|file| file.name.as_str()).collect();
    let expected = [
        "frequency_response_open_loop.csv",
        "frequency_response_closed_loop.csv",
        "frequency-response-open-loop.svg",
        "frequency-response-closed-loop.svg",
    ];
    assert_eq!(names, expected);
    assert!(answer.text().contains("minus linear plant"), "{}", answer.text());
}

#[test]
fn invalid_options_are_refused() {
    let cases = [
        (
            FrequencyOptions { amplitude: Some("0 V".into()), ..Default::default() },
            "--amplitude 0 V: must be positive",
        ),
        (FrequencyOptions { amplitude: Some("3 N".into()), ..Default::default() }, "--amplitude 3 N: "),
        (
            FrequencyOptions { reference_amplitude: Some("1 V".into()), ..Default::default() },
            "--reference-amplitude 1 V: ",
        ),
        (
            FrequencyOptions { frequencies: Some("1, 2 kN".into()), ..Default::default() },
            "--frequencies 1, 2 kN: ",
        ),
    ];
    for (options, words) in cases {
        let error = output(&[], options, false).unwrap_err();
        assert!(error.starts_with(words), "{error}");
    }
}

/// A machine without a controller can be excited as well.
#[test]
fn an_open_loop_needs_no_controller() {
    let bare = BENCHMARK.split("[controller]").next().unwrap();
    let source = Memory::default().with("rig.toml", bare);
    let settings: Vec<String> = SMOOTH.iter().map(|text| (*text).to_string()).collect();
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    let found = shaken(&loaded, &[50.0], [1e-2, 1.0]);
    assert_eq!(found.closed_loop, Err(NoClosedLoop::NoController));
    assert_eq!(found.open_loop.points.len(), 1);
}

#[test]
fn a_unit_holds_for_the_numbers_before_it() {
    let frequencies = |text: &str| {
        FrequencyOptions { frequencies: Some(text.to_string()), ..FrequencyOptions::default() }
            .request(MotionKind::Linear)
    };
    // ORIGIN: analytic, 2 pi rad/s is 1 Hz
    let turn = std::f64::consts::TAU;
    for (text, expected) in [
        ("1, 10,100", vec![1.0, 10.0, 100.0]),
        ("1, 2 Hz", vec![turn, 2.0 * turn]),
        ("1 rad/s, 1e1, 2e0 Hz", vec![1.0, 10.0 * turn, 2.0 * turn]),
    ] {
        let found = frequencies(text).unwrap().frequencies_rad_per_s;
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12 * expected, "{text}: {found} {expected}");
        }
    }
    for text in ["", "1,", "0", "-1 Hz", "1 kN", "fast"] {
        assert!(frequencies(text).is_err(), "{text}");
    }
}

#[test]
fn the_amplitude_of_a_motor_s_reference_is_a_torque() {
    let requested = |text: &str, motion: MotionKind| {
        FrequencyOptions { reference_amplitude: Some(text.to_string()), ..FrequencyOptions::default() }
            .request(motion)
            .map(|request| request.reference_amplitude_n)
            .map_err(|error| error.to_string())
    };
    assert_eq!(requested("400 N.m", MotionKind::Rotary), Ok(Some(400.0)));
    assert_eq!(requested("4 kN", MotionKind::Linear), Ok(Some(4000.0)));
    let refused = requested("400 N", MotionKind::Rotary).unwrap_err();
    assert!(refused.contains("expected a torque, found a force"), "{refused}");
}
