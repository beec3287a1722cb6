//! A scenario that states no start begins with the closed loop at rest: nothing moves until an
//! event.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_hydraulics::signal::Signal;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{ScenarioRun, SimulateError, simulate_project};
use phea_workbench::project;
use phea_workbench::source::Memory;

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");
const EVERYTHING: &str = include_str!("../../project/tests/valid/simulation.toml");
const EXAMPLES: [&str; 5] = [
    BENCHMARK,
    include_str!("../../../examples/benchmark/closed_loop.toml"),
    include_str!("../../../examples/benchmark/closed_loop_sampled.toml"),
    include_str!("../../../examples/ybitu/hose.toml"),
    include_str!("../../../examples/ybitu/pipe.toml"),
];

/// A project with this scenario instead of its own.
fn still(text: &str, reference: &str) -> String {
    let before = text.split("[[scenario]]").next().unwrap();
    let settings = text.find("[simulation]").map_or("", |place| &text[place..]);
    let own = settings.split("[[").next().unwrap();
    let table = if before.contains("[simulation]") { "" } else { own };
    format!(
        "{before}\n{table}\n[[scenario]]\nname = \"still\"\nduration = \"1 s\"\noutput_step = \"10 ms\"\n{reference}\n"
    )
}

fn run(text: &str, settings: &[String]) -> Result<ScenarioRun, SimulateError> {
    let source = Memory::default().with("rig.toml", text);
    let loaded =
        project::read(&source, "rig.toml", settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    simulate_project(&source, &Setup::new(&loaded.project).unwrap(), &mut |_| true)
        .map(|mut runs| runs.remove(0))
}

/// Largest permitted change of a signal in a second, by the ending of its name: a part in a hundred
/// thousand of its change in a run.
fn allowed(name: &str) -> f64 {
    let of_a_joint = [("_rad_per_s", 1e-6), ("_rad", 1e-8), ("_n_m", 1e-3)];
    let of_gas = [("_ratio", 1e-6), ("_w", 1e-6)];
    let parts =
        [("_pa", 10.0), ("_m_per_s", 1e-7), ("_m3_per_s", 1e-10), ("_n", 1e-2), ("_v", 1e-5), ("_m", 1e-9)];
    of_a_joint.into_iter().chain(of_gas).chain(parts).find(|(end, _)| name.ends_with(end)).unwrap().1
}

#[track_caller]
fn check_still(text: &str, settings: &[String], force_n: f64) {
    let run = run(text, settings).unwrap_or_else(|error| panic!("{settings:?}: {error}"));
    assert_eq!(run.stopped(), None, "{settings:?}");
    assert_eq!(run.windows, [], "{settings:?}");
    let force = run.record.signal(Signal::Force);
    assert!((force[0] - force_n).abs() < 1e-3, "{settings:?}: {} N at the start", force[0]);
    for signal in Signal::ALL.iter().copied().filter(|signal| *signal != Signal::Time) {
        let (name, values) = (signal.name(), run.record.signal(signal));
        if values.is_empty() {
            continue;
        }
        let moved = values.iter().map(|value| (value - values[0]).abs()).fold(0.0, f64::max);
        assert!(moved <= allowed(name), "{settings:?}: {name} moves by {moved} from {}", values[0]);
    }
    let commands = &run.record.signal(Signal::Control);
    let moved = commands.iter().map(|value| (value - commands[0]).abs()).fold(0.0, f64::max);
    assert!(moved <= 1e-5, "{settings:?}: the command moves by {moved} V");
}

fn settings(all: &[&str]) -> Vec<String> {
    all.iter().map(|one| (*one).to_string()).collect()
}

#[test]
fn every_example_rests_at_its_reference() {
    for text in EXAMPLES {
        for (reference, force_n) in [("", 0.0), ("reference = [{ at = \"0 s\", force = \"2 kN\" }]", 2e3)] {
            check_still(&still(text, reference), &[], force_n);
        }
    }
}

/// The benchmark with a rod on one side only and leakage across its piston.
fn asymmetric(text: &str) -> String {
    let Some((before, after)) = text.split_once("piston_area = \"1.583e-3 m2\"") else { panic!("{text}") };
    let after = after.split_once("stroke").unwrap().1;
    let unequal =
        "piston_diameter = \"50 mm\"\nrod_diameters = [\"0 mm\", \"28 mm\"]\ninternal_leakage = 1e-12";
    format!("{before}{unequal}\nstroke{after}")
}

/// The pressures that the open valve would leave cause a force of more than a kilonewton.
#[test]
fn leakage_across_an_asymmetric_piston_is_held() {
    check_still(&asymmetric(&still(EXAMPLES[1], "")), &[], 0.0);
    check_still(&asymmetric(&still(EXAMPLES[2], "")), &[], 0.0);
}

const LINES: [&[&str]; 6] = [
    &[],
    &["line.model=creeping", "line.relaxation_time=50 ms"],
    &["line.model=segments", "line.segments=4"],
    &["line.model=segments", "line.segments=3", "line.friction=steady"],
    &["line.model=transmission_line"],
    &["line.model=two_wave"],
];
const SUPPLIES: [&[&str]; 3] = [
    &[],
    &["supply.model=pump_limited", "supply.volume=0.8 L"],
    &[
        "supply.model=pump_limited",
        "supply.volume=0.8 L",
        "supply.accumulator={ gas_volume = \"1 L\", precharge_pressure = \"50 bar\" }",
    ],
];
const LOADS: [&[&str]; 3] = [
    &[],
    &["load.model=spring_mass_damper", "load.mass=20 kg", "load.stiffness=2 MN/m", "load.damping=500 N.s/m"],
    &[
        "load.model=wall",
        "load.mass=20 kg",
        "load.stiffness=5 MN/m",
        "load.damping=2000 N.s/m",
        "load.gap=2 mm",
    ],
];
const CONTROLLERS: [&[&str]; 4] = [
    &[],
    &["controller.sample_time=1 ms", "controller.delay=0.5 ms"],
    &["controller.anti_windup=back_calculation", "sensor={ numerator = \"600\", denominator = \"s + 600\" }"],
    &["controller.delay=0.2 ms", "controller.load_velocity_feed_forward={}"],
];
const OTHERS: [&[&str]; 4] = [
    &[],
    &["cylinder.internal_leakage=2e-13", "valve.null_bias=30 mV"],
    &["valve.hysteresis=0.1 V", "valve.threshold=20 mV"],
    &["cylinder.end_stops={ stiffness = \"100 MN/m\", relative_damping = \"0.5 s/m\" }"],
];

/// Lines, supplies, loads, sensors, controllers and friction of every kind, combined in a fixed
/// pattern.
#[test]
fn machines_of_all_components_rest() {
    for number in 0..36 {
        let chosen = [
            // some of these loops are unstable: rounding errors have no time to grow
            ["controller.numerator=0.0002*s + 0.002", "scenario.0.duration=0.2 s"].as_slice(),
            LINES[number % 6],
            SUPPLIES[number % 3],
            LOADS[(number / 2) % 3],
            CONTROLLERS[(number / 3) % 4],
            OTHERS[(number / 5) % 4],
        ];
        let force_n = if number % 2 == 0 { 0.0 } else { 1500.0 };
        let reference = format!("reference = [{{ at = 0, force = {force_n} }}]");
        check_still(&still(EXAMPLES[3], &reference), &settings(&chosen.concat()), force_n);
    }
}

/// A machine with valve memory, a yielding pump and a distant wall stays at rest, apart from noise.
#[test]
fn a_machine_with_everything_rests_against_its_wall() {
    let quiet = ["force_sensor.noise=0 N", "simulation.method=rosenbrock"];
    let of = |force_n: f64| format!("reference = [{{ at = 0, force = {force_n} }}]");
    for force_n in [0.0, 1e3] {
        let text = still(EVERYTHING, &of(force_n));
        // converters give the command in steps, so they are removed
        let text = text.replace("[controller.quantization]", "[unused]");
        let text = match text.split_once("[unused]") {
            Some((before, after)) => format!("{before}{}", &after[after.find("[prefilter]").unwrap()..]),
            None => text,
        };
        check_still(&text, &settings(&quiet), force_n);
    }
}

/// A loop without an integral part rests with an error: it begins in the equilibrium of the closed
/// loop.
///
/// ```text
/// u = k (r - F)
/// ```
#[test]
fn a_proportional_controller_rests_with_its_error() {
    for more in ["controller.anti_windup=none", "controller.sample_time=1 ms"] {
        let proportional = [
            "controller.numerator=2e-4",
            "controller.denominator=1",
            "prefilter={ numerator = \"1\", denominator = \"1\" }",
        ];
        let mut all = settings(&proportional);
        all.push(more.to_string());
        let text = asymmetric(&still(EXAMPLES[1], "reference = [{ at = 0, force = \"2 kN\" }]"));
        let run = run(&text, &all).unwrap();
        let force = run.record.signal(Signal::Force);
        let moved = force.iter().map(|value| (value - force[0]).abs()).fold(0.0, f64::max);
        assert!(moved < 1e-2, "{moved} N");
        let error = 2e3 - force[0];
        assert!(error.abs() > 1.0, "{error} N");
        assert!((run.record.signal(Signal::Control)[0] - 2e-4 * error).abs() < 1e-8);
    }
}

#[test]
fn an_absent_rest_has_its_reason() {
    // more than the supply can provide
    let text = still(BENCHMARK, "reference = [{ at = 0, force = \"50 kN\" }]");
    let error = run(&text, &[]).unwrap_err();
    assert!(matches!(error, SimulateError::NoRest { .. }), "{error}");
    assert!(error.to_string().contains("has no equilibrium at its reference of 50 kN"), "{error}");
    // a command beyond the limit of the controller
    let limited = settings(&["controller.saturation=1 mV"]);
    let error = run(&asymmetric(&still(EXAMPLES[1], "")), &limited).unwrap_err();
    let SimulateError::RestBeyondLimit { command_v, limit_v, .. } = error else { panic!("{error}") };
    assert!(command_v.abs() > limit_v && limit_v == 1e-3);
    assert!(error.to_string().ends_with("beyond the limit of 1 mV"), "{error}");
}

/// An input at time zero that is not a reference acts from there: rest is before it.
#[test]
fn a_step_later_is_a_step() {
    let text =
        still(BENCHMARK, "reference = [{ at = 0, force = \"1 kN\" }, { at = \"0.1 s\", force = \"2 kN\" }]");
    let run = run(&text, &[]).unwrap();
    let [(window, metrics)] = run.windows.as_slice() else { panic!("{:?}", run.windows) };
    assert_eq!(window.start_s, 0.1);
    assert!(metrics.rise_time_s.is_ok() && metrics.overshoot_percent.is_ok());
}
