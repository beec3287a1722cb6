//! A hydraulic transmission from the user's side: quantities derived by `check`, the verdict of the
//! example and its machine, cavitation, alternatives, and refusals.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use phea_workbench::command::Request;
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

use crate::run_command::{answer, check, derived, load, near, retracted_length};

const TRANSMISSION: &str = include_str!("../../../examples/ybitu/transmission.toml");
/// A transmission with a pipe as long as the hose of the other, whose numbers are known by hand.
const PIPE: &str = "series={ kind = \"transmission\", piston_area = \"20 cm2\", filling_pressure = \"60 bar\", \
                    end_volume = \"20 cm3\", line = { pipe = { bore = \"10 mm\" }, length = \"2 m\" } }";

/// The example without the uncertainty of its hose.
fn certain() -> String {
    let lines: Vec<&str> = TRANSMISSION.lines().filter(|line| !line.starts_with("\"series.")).collect();
    lines.join("\n")
}

/// ORIGIN: analytic, a rigid pipe of 10 mm and 2 m, 0.157 L, with 20 mL at either end, pistons of
/// 20 cm2 and the oil of the example
#[test]
fn check_derives_its_oil() {
    let output = check(&certain(), &[PIPE]);
    let bore = std::f64::consts::FRAC_PI_4 * 1e-4;
    near(derived(&output, "series.oil_volume"), bore * 2.0 + 4e-5, 1e-12);
    near(derived(&output, "series.stiffness_of_oil"), 4e-6 * 1.45e9 / (bore * 2.0 + 4e-5), 1e-12);
    let mass = 870.0 * 2.0 * bore * (2e-3 / bore).powi(2);
    near(derived(&output, "series.reflected_mass"), mass, 1e-12);
    near(derived(&output, "series.reflected_damping"), 32.0 * 46e-6 * mass / 1e-4, 1e-12);
    near(derived(&output, "series.wave_travel_time"), 2.0 * (870.0 / 1.45e9_f64).sqrt(), 1e-12);
    let stall = derived(&output, "cylinder.stall_force");
    near(derived(&output, "series.pressure_at_stall"), 60e5 + stall / 2e-3, 1e-12);
    near(derived(&output, "series.pull_limit"), 2e-3 * (60e5 + 101_325.0), 1e-12);
    let softened = 1.0 / (1.0 / derived(&output, "linear.hydraulic_stiffness") + 1.0 / 20e6);
    let softened = 1.0 / (1.0 / softened + 1.0 / derived(&output, "series.stiffness_of_oil"));
    near(derived(&output, "dynamics.equivalent_stiffness"), softened, 1e-12);
}

/// The controller of the example satisfies every specification, stability is proven, and the
/// machine agrees with the linear loop.
#[test]
fn the_example_is_met_and_the_machine_agrees() {
    let verified =
        parsed(&answer(TRANSMISSION, &[], &[], &Request::Verify { proof: false, on_machine: true }).json);
    assert_eq!(verified["verdict"], "met", "{}", verified["specifications"]);
    for run in verified["machine"]["runs"].as_array().unwrap() {
        assert_eq!(run["agrees"], Value::from(true), "{run}");
    }
    // two uncertain numbers and two segments: polynomials of a higher degree are not enclosed
    // tightly enough
    let few = "uncertainty={ flow_gain = { nominal = 5.4e-5, minimum = 3.23e-5, maximum = 5.61e-5 }, \
               \"series.line.length\" = { nominal = 2, minimum = 1.9, maximum = 2.1 } }";
    let verified = parsed(
        &answer(
            TRANSMISSION,
            &[few, "series.segments=2"],
            &[],
            &Request::Verify { proof: true, on_machine: false },
        )
        .json,
    );
    assert_eq!(verified["proof"]["stable"]["proven"], true, "{}", verified["proof"]);
}

/// Small steps with every load, and with waves in the lines of the rig as well. The capacity of the
/// sensor leaves no room for larger steps.
#[test]
fn small_steps_on_the_machine_are_those_of_the_linear_loop() {
    let viscous = "cylinder.friction={ model = \"viscous\", viscous = \"1 kN.s/m\" }";
    let sprung = ["load.model=spring_mass_damper", "load.mass=100", "load.stiffness=2e6", "load.damping=500"];
    let loop_of_force = [
        "controller={ numerator = \"4e-4*s + 4e-3\", denominator = \"s\" }",
        "force_sensor.capacity=3.4 kN",
        "prefilter={ numerator = \"1\", denominator = \"1\" }",
        "uncertainty={}",
    ];
    let waves = ["line.model=transmission_line"];
    for other in [&[][..], &sprung, &waves] {
        let settings = [&[viscous, "series.segments=2"][..], &loop_of_force, other].concat();
        let verified = parsed(
            &answer(&certain(), &settings, &[], &Request::Verify { proof: false, on_machine: true }).json,
        );
        let run = &verified["machine"]["runs"][0];
        assert_eq!(run["agrees"], Value::from(true), "{other:?}: {run}");
    }
}

/// A pull of 2 kN on oil with a filling pressure of 2 bar tears it off, which is an event of the
/// run and a warning before it.
#[test]
fn a_run_reports_where_the_oil_column_separates() {
    let scenario = "scenario=[{ name = \"pull\", duration = \"1 s\", reference = [{ at = \"0.1 s\", force = \"-2 kN\" }] }]";
    let verified = answer(
        TRANSMISSION,
        &[scenario, "series.filling_pressure=2 bar"],
        &[],
        &Request::Simulate(Default::default()),
    );
    assert!(verified.text().contains("the oil of the transmission cavitates"), "{}", verified.text());
    assert!(verified.json.contains("\"cavitation_transmission\""), "{}", verified.json);
    let filled = answer(TRANSMISSION, &[scenario], &[], &Request::Simulate(Default::default()));
    assert!(!filled.text().contains("cavitates"), "{}", filled.text());
    let warned = load(TRANSMISSION, &["series.filling_pressure=2 bar"], &[]).warnings;
    assert!(warned.iter().any(|one| one.message.contains("the oil tears off at a pull of")), "{warned:?}");
}

/// Length, price and mass of an alternative include both cylinders, the hose and its oil.
#[test]
fn cost_and_mass_are_reported() {
    let length = |settings: &[&str]| retracted_length(&load(TRANSMISSION, settings, &[]).project);
    // ORIGIN: analytic, 0.5 m of stroke, 0.3 m and two cylinders of 0.2 m
    near(length(&["cylinder.dead_length=0.3 m"]).unwrap(), 1.2, 1e-12);
    let unstated = length(&["cylinder.dead_length=0.3 m", PIPE]).unwrap_err();
    assert_eq!(unstated, phea_workbench::engineering::alternatives::LengthUnknown::NoSeriesCylinderLength);
    let costs = [
        "series.price=180 EUR",
        "series.cylinders_mass=3 kg",
        "series.line.price_per_length=15 EUR/m",
        "series.line.mass_per_length=0.3 kg/m",
    ];
    let output = check(TRANSMISSION, &costs);
    // ORIGIN: analytic
    near(derived(&output, "parts.series.price"), 180.0, 1e-12);
    near(derived(&output, "parts.series.line.price"), 30.0, 1e-12);
    near(derived(&output, "parts.series.mass"), 3.0, 1e-12);
    near(derived(&output, "parts.series.line.mass"), 0.6, 1e-12);
    let lines = 2.0 * 870.0 * derived(&output, "line.volume");
    near(
        derived(&output, "parts.oil_in_lines.mass"),
        lines + 870.0 * derived(&output, "series.oil_volume"),
        1e-12,
    );
}

/// Models with one load pressure treat its oil as a spring, and report this.
#[test]
fn the_reduced_models_report_their_neglected_effects() {
    let page = answer(TRANSMISSION, &["series.segments=1"], &[], &Request::Linearize { sweep: None });
    assert!(
        page.text().contains(
            "inertia and resistance of the transmission are counted in the plant and its impedance alone"
        ),
        "{}",
        page.text()
    );
}

/// A motor cannot have a transmission; a linkage can.
#[test]
fn a_motor_refuses_a_transmission() {
    let read = |rig: &str| {
        let source = Memory::default().with("rig.toml", rig);
        project::read(&source, "rig.toml", &[PIPE.to_string()], &[]).map(|_| ())
    };
    let refused = read(include_str!("../../project/tests/valid/motor.toml")).unwrap_err().to_string();
    assert!(refused.contains("a spring or transmission between force sensor and load"), "{refused}");
    assert!(refused.contains("remove [series]"), "{refused}");
    assert!(read(include_str!("../../project/tests/valid/linkage.toml")).is_ok());
}
