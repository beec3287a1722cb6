//! A linkage, from the project's keys to the family that follows the position, to the machine and
//! to the output.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_dynamics::random::{stream, uniform};
use phea_dynamics::uncertain_plant::PlantCoefficients;
use phea_hydraulics::signal::Signal;
use phea_qft::family::Family;
use phea_workbench::command::Request;
use phea_workbench::family::family;
use phea_workbench::linearize::{LinkagePosition, linkage_places};
use phea_workbench::project::Project;
use phea_workbench::report::report;
use phea_workbench::setup::Setup;
use phea_workbench::simulate::{ControlledMachine, Metric, ScenarioRun, simulate_project};
use phea_workbench::source::Memory;

use super::run_command::{HOSE, load, project_of, try_answer};

const KNEE: &str = include_str!("../../../examples/leg/knee.toml");
const FREQUENCIES: [f64; 6] = [0.1, 3.0, 30.0, 300.0, 2000.0, 9000.0];

/// Largest relative difference of the two plants.
fn difference(one: &PlantCoefficients<f64>, other: &PlantCoefficients<f64>) -> f64 {
    let paths = |plant: &PlantCoefficients<f64>, w: f64| {
        [plant.command.at_frequency(w), plant.disturbance.as_ref().unwrap().at_frequency(w)]
    };
    let at = |w: f64| {
        let pairs = paths(one, w).into_iter().zip(paths(other, w));
        pairs.map(|(one, other)| (one / other - 1.0).norm_sqr().sqrt()).fold(0.0, f64::max)
    };
    FREQUENCIES.into_iter().map(at).fold(0.0, f64::max)
}

/// The family is, everywhere in its box of positions and forces, the rig that declares them, lever
/// arm and geometric stiffness included.
#[test]
fn the_family_follows_the_position() {
    follows_the_position(KNEE);
}

/// The family with an uncertain payload.
#[test]
fn the_family_follows_a_payload() {
    let weight =
        "[linkage.weight]\nmass = \"4 kg\"\ncentre_distance = \"0.3 m\"\nlevel_angle = \"40 deg\"\n\n[load]";
    let payload = "\"linkage.weight.mass\" = { nominal = \"4 kg\", minimum = \"1 kg\", maximum = \"9 kg\", points = 2 }";
    let text =
        KNEE.replacen("[load]", weight, 1).replace("[uncertainty]\n", &format!("[uncertainty]\n{payload}\n"));
    follows_the_position(&text);
}

/// The family with a progressive spring or a transmission on the rod, whose deflection follows from
/// the position of the joint.
#[test]
fn the_family_follows_the_spring_in_series() {
    for series in SERIES {
        follows_the_position(&KNEE.replacen("[linkage]", &format!("[series]\n{series}\n[linkage]"), 1));
    }
}

const SERIES: [&str; 2] = [
    "stiffness = \"400 N/mm\"\ndamping = \"80 N.s/m\"\nmass = \"0.2 kg\"\ntravel = \"12 mm\"\nprogression = 0.5\n",
    "kind = \"transmission\"\npiston_area = \"2 cm2\"\nfilling_pressure = \"170 bar\"\nend_volume = \"2 mL\"\n\
     line = { pipe = { bore = \"6 mm\" }, length = \"0.8 m\" }\n",
];

fn follows_the_position(text: &str) {
    let uncertain = "\"load.mass\" = { nominal = \"0.6 kg.m2\", minimum = \"0.3 kg.m2\", maximum = \"0.8 kg.m2\", points = 2 }";
    let project = project_of(&text.replace("[uncertainty]\n", &format!("[uncertainty]\n{uncertain}\n")), &[]);
    let setup = Setup::new(&project).unwrap();
    let Family::Uncertain(family) = family(&setup, &Memory::default()).unwrap() else { panic!("a box") };
    let plant = family.plant();
    let names: Vec<&str> = plant.parameters().iter().map(|one| one.name.as_str()).collect();
    assert!(names.contains(&"operating_point.position") && names.contains(&"load.mass"), "{names:?}");
    let mut state = stream(9, 1);
    let mut arms = [f64::INFINITY, 0.0_f64];
    for _ in 0..30 {
        let of = |one: &phea_dynamics::uncertain_plant::UncertainParameter, fraction: f64| {
            one.minimum + (one.maximum - one.minimum) * fraction
        };
        let values: Vec<f64> = plant.parameters().iter().map(|one| of(one, uniform(&mut state))).collect();
        let mut stated = project.without_uncertainty();
        for (name, value) in names.iter().zip(&values) {
            stated = match *name {
                "viscous_friction" => stated.with_number("cylinder.friction.viscous", *value).unwrap(),
                "valve_natural_frequency" => stated.with_number("valve.natural_frequency", *value).unwrap(),
                path => stated.with_number(path, *value).unwrap(),
            };
        }
        let rig = Setup::rig_of(&stated).unwrap();
        let arm = linkage_places(&rig)
            .iter()
            .find(|place| place.at == LinkagePosition::OperatingPoint)
            .unwrap()
            .lever_arm_m;
        arms = [arms[0].min(arm), arms[1].max(arm)];
        let apart = difference(&rig.plant.coefficients(), &plant.coefficients(&values).unwrap());
        assert!(apart < 1e-8, "{values:?}: {apart}");
    }
    assert!(arms[0] < 0.04 && arms[1] > 0.0499, "{arms:?}");
}

/// The machine rests at the operating point with the lever arm of the plant.
#[test]
fn the_machine_rests_where_the_plant_is() {
    let other = ["operating_point.position=\"12 mm\"", "operating_point.load_force=\"1.1 kN\""];
    let texts = ["", SERIES[0], SERIES[1]].map(|series| match series {
        "" => KNEE.to_string(),
        series => KNEE.replacen("[linkage]", &format!("[series]\n{series}\n[linkage]"), 1),
    });
    let cases = texts.iter().flat_map(|text| [(text, &[][..]), (text, &other[..])]);
    for (text, settings) in cases {
        let project = project_of(text, settings);
        let bench = ControlledMachine::new(&Setup::new(&project).unwrap()).unwrap();
        let rest = bench.machine.rest_under_load(&bench.rig.point).unwrap();
        let outputs = bench.machine.signals::<f64>(&rest.state, &rest.all_inputs());
        let signal = |signal: Signal| outputs.get(signal).unwrap();
        let places = linkage_places(&bench.rig);
        let place = places.iter().find(|place| place.at == LinkagePosition::OperatingPoint).unwrap();
        assert!((signal(Signal::JointAngle) - place.angle_rad).abs() < 1e-9, "{settings:?}");
        let arm = signal(Signal::JointTorque) / signal(Signal::Force);
        assert!((arm / place.lever_arm_m - 1.0).abs() < 1e-9, "{settings:?}: {arm} {}", place.lever_arm_m);
        let inertia = place.reflected_mass_kg.unwrap() * arm * arm;
        assert!((inertia - 0.6).abs() < 1e-9);
    }
}

/// A load that yields rests against its weight if no load force is stated.
#[test]
fn a_weight_is_held_at_rest() {
    let weight =
        "[linkage.weight]\nmass = \"4 kg\"\ncentre_distance = \"0.3 m\"\nlevel_angle = \"40 deg\"\n\n[load]";
    let text = KNEE.replacen("[load]", weight, 1).replacen("load_force = \"600 N\"\n", "", 1);
    // a spring as soft as the weight on its lever arm
    let soft =
        "series={ stiffness = \"20 N/mm\", damping = \"80 N.s/m\", travel = \"400 mm\", progression = 0.5 }";
    for settings in [
        &["family={}"][..],
        &["family={}", "load.stiffness=3", "operating_point.position=\"15 mm\""],
        &["family={}", soft],
    ] {
        let project = project_of(&text, settings);
        let bench = ControlledMachine::new(&Setup::new(&project).unwrap()).unwrap();
        let rest = bench.machine.rest_under_load(&bench.rig.point).unwrap();
        let outputs = bench.machine.signals::<f64>(&rest.state, &rest.all_inputs());
        let signal = |signal: Signal| outputs.get(signal).unwrap();
        // ORIGIN: analytic, 4 kg 9.80665 m/s2 0.3 m cos(theta - 40 deg)
        let level = signal(Signal::JointAngle) - 40_f64.to_radians();
        let torque = 4.0 * 9.80665 * 0.3 * phea_dynamics::portable::cos(level);
        let held = signal(Signal::JointTorque);
        assert!((held / torque - 1.0).abs() < 1e-9, "{settings:?}: {held} {torque}");
    }
}

/// Output of `linearize` and the report on the impedance about the joint, for a spring K instead of
/// Z s: the torque F g' of a force F_0 - K (x - x_0) falls with the angle by r^2 (K + k_g).
#[test]
fn the_impedance_about_the_joint_is_reported() {
    let project = project_of(KNEE, &[]);
    let setup = Setup::new(&project).unwrap();
    let rig = setup.rig().unwrap();
    let linkage = rig.actuator.components().linkage.as_ref().unwrap();
    let here = linkage_places(rig).into_iter().find(|at| at.at == LinkagePosition::OperatingPoint).unwrap();
    let rows = phea_workbench::derived::derive(&setup).unwrap();
    let geometric = rows.iter().find(|row| row.name == "linkage.geometric_stiffness").unwrap().value.unwrap();
    let (force, stiffness, step) = (rig.point.hydraulic_force, 2e5, 1e-5);
    let torque = |angle: f64| {
        let end = linkage.end(angle);
        (force - stiffness * (end.position - here.position_m)) * end.lever_arm
    };
    let falls = (torque(here.angle_rad - step) - torque(here.angle_rad + step)) / (2.0 * step);
    let expected_rate = here.lever_arm_m * here.lever_arm_m * (stiffness + geometric);
    assert!((falls / expected_rate - 1.0).abs() < 1e-6, "{falls} {expected_rate}");
    // the geometric stiffness is not lost in rounding
    assert!((geometric / stiffness).abs() > 1e-3, "{geometric}");
    let sentence = "about the joint it is r² (Z + k_g/s), in N·m·s/rad, with the lever arm r = 49.84 mm";
    let found_answer =
        |text: &str| try_answer(text, &[], &[], &Request::Linearize { sweep: None }).unwrap().text;
    assert!(found_answer(KNEE).contains(sentence));
    assert!(!found_answer(HOSE).contains("joint"));
}

fn run(project: &Project) -> ScenarioRun {
    simulate_project(&Memory::default(), &Setup::new(project).unwrap(), &mut |_| true).unwrap().remove(0)
}

/// A run with a linkage starts at rest only at the operating point.
#[test]
fn a_run_starts_at_the_operating_point() {
    for settings in [&[][..], &["operating_point.position=\"15 mm\"", "load.stiffness=400"]] {
        let project = project_of(KNEE, settings);
        let run = run(&project);
        let at_start = |signal: Signal| run.record.signal(signal)[0];
        let wanted = project.operating_point.position.unwrap();
        assert!(
            (at_start(Signal::Position) - wanted).abs() < 1e-8,
            "{settings:?}: {}",
            at_start(Signal::Position)
        );
        assert!((at_start(Signal::Force) - 600.0).abs() < 1e-3);
        assert!(at_start(Signal::JointVelocity).abs() < 1e-9);
    }
}

/// A table that is a straight line gives the plant and the run of a load in linear quantities.
#[test]
fn a_straight_table_is_a_load_in_other_units() {
    let (before, rest) = KNEE.split_once("[linkage]").unwrap();
    let (_, after) = rest.split_once("[operating_point]").unwrap();
    let after = after.split("[[alternative]]").next().unwrap();
    let straight = format!(
        "{before}[linkage]\nkind = \"table\"\nextensions = [0, 0.08]\nangles = [0.3, 1.9]\n\n[load]\n\
         model = \"spring_mass_damper\"\nmass = 0.6\nstiffness = 900\ndamping = 8\n\n[operating_point]{after}"
    );
    // the arm is 50 mm
    let plain = format!(
        "{before}[load]\nmodel = \"spring_mass_damper\"\nmass = 240\nstiffness = 360e3\ndamping = 3200\n\n[operating_point]{}",
        after.replace("\"-10 deg\"", &format!("{:?}", -10.0_f64.to_radians() * 0.05))
    );
    let [turned, plain] = [straight, plain].map(|text| project_of(&text, &[]));
    let [one, other] = [&turned, &plain].map(|project| Setup::rig_of(project).unwrap().plant.coefficients());
    assert!(difference(&one, &other) < 1e-9);
    let [one, other] = [&turned, &plain].map(run);
    for ((_, one), (_, other)) in one.windows.iter().zip(&other.windows) {
        for metric in Metric::ALL {
            let (Ok(one), Ok(other)) = (one.get(metric), other.get(metric)) else { continue };
            assert!((one - other).abs() <= 2e-4 * other.abs() + 1e-3, "{metric:?}: {one} {other}");
        }
    }
    let end = |run: &ScenarioRun, signal: Signal| *run.record.signal(signal).last().unwrap();
    for signal in [Signal::Force, Signal::Position, Signal::LoadPosition, Signal::PressureA] {
        let (one, other) = (end(&one, signal), end(&other, signal));
        assert!((one / other - 1.0).abs() < 1e-5, "{signal:?}: {one} {other}");
    }
}

/// The load turns, and its weight is a mass at a length.
#[test]
fn a_report_describes_the_load() {
    let weight = include_str!("../../project/tests/valid/linkage_weight.toml");
    let loaded = load(weight, &[], &[]);
    let setup = Setup::new(&loaded.project).unwrap();
    let found = report(&Memory::default(), &loaded, &setup, None, &mut |_| true).unwrap();
    let load = found.summary.iter().find(|(name, _)| *name == "Load").unwrap();
    assert!(load.1.starts_with("spring, inertia and damper: 0.6 kg.m2"), "{}", load.1);
    assert!(load.1.ends_with("weighs 3 kg, 400 mm from its joint"), "{}", load.1);
}
