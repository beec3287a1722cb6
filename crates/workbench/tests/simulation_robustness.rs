//! Whole projects driven to their limits: the result is right or rejected by name, and never
//! endless or without a number.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_dynamics::simulation::Status;
use phea_hydraulics::signal::Signal;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{ScenarioRun, simulate_project};
use phea_workbench::project::{self, Loaded, Project, Refusal};
use phea_workbench::source::Memory;

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");
const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

/// Steps that no case exceeds: several times those of the worst.
const MOST_STEPS: u64 = 60_000;

fn read(text: &str, settings: &[&str]) -> Result<Loaded, Refusal> {
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(&Memory::default().with("rig.toml", text), "rig.toml", &settings, &[])
}

/// The project with its first scenario only.
#[track_caller]
fn first_scenario(text: &str, settings: &[&str]) -> Project {
    let mut project = read(text, settings).unwrap_or_else(|report| panic!("{report}")).project;
    project.scenarios.truncate(1);
    project
}

/// The first scenario; checks that every number is finite.
#[track_caller]
fn run(text: &str, settings: &[&str]) -> ScenarioRun {
    let project = first_scenario(text, settings);
    let run = simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    let values = Signal::ALL.iter().flat_map(|signal| run.record.signal(*signal));
    assert_eq!(values.filter(|value| !value.is_finite()).count(), 0, "{settings:?}");
    assert!(run.work.steps < MOST_STEPS, "{:?} with {settings:?}", run.work);
    run
}

#[track_caller]
fn completed(text: &str, settings: &[&str]) -> ScenarioRun {
    let run = run(text, settings);
    assert_eq!(run.status, Status::Completed, "{settings:?}");
    run
}

/// The findings on a project that is rejected.
#[track_caller]
fn refused(text: &str, settings: &[&str]) -> String {
    read(text, settings).map(|_| ()).expect_err("refused").to_string()
}

fn happened(run: &ScenarioRun, kind: &str) -> bool {
    run.occurrences.iter().any(|occurrence| occurrence.kind == kind && occurrence.begins)
}

fn last(run: &ScenarioRun, signal: Signal) -> f64 {
    *run.record.signal(signal).last().unwrap()
}

/// The load moves by this distance in this time, and the reference stays zero.
fn moved(distance: &str, duration: &str) -> String {
    format!(
        "scenario.0.load_motion={{ kind = \"smooth_step\", start = 0.5, distance = \"{distance}\", duration = \"{duration}\" }}"
    )
}

const QUIET: [&str; 2] = ["scenario.0.reference=[]", "scenario.0.duration=1.5 s"];

/// Ten seconds without a command: leakage determines the pressures, and then nothing moves any
/// more.
#[test]
fn a_valve_that_is_shut_for_ten_seconds() {
    let text = BENCHMARK.replace("load_motion =", "# load_motion =");
    let shut = ["scenario.0.reference=[]", "controller.numerator=1e-12", "scenario.0.duration=10 s"];
    let run = completed(&text, &shut);
    let pressure = run.record.signal(Signal::PressureA);
    let count = pressure.len();
    // ORIGIN: analytic, thesis Table 5.1: p_A = p_S/(1 + (K_vin4/K_vin3)^2) where leakage in equals
    // leakage out
    assert!((pressure[count - 1] / (70e5 / (1.0 + (2.2_f64 / 2.35) * (2.2 / 2.35))) - 1.0).abs() < 0.01);
    assert!((pressure[count - 1] / pressure[count * 9 / 10] - 1.0).abs() < 1e-3);
    assert!(run.work.steps < 2000 && run.occurrences.is_empty());
}

/// A pump that gives almost nothing: the required force is not reached, the command reaches its
/// limit, and both are reported.
#[test]
fn a_supply_that_is_lost() {
    let lost = ["supply.model=pump_limited", "supply.flow=0.001 L/min", "supply.volume=0.1 L"];
    let run = completed(BENCHMARK, &lost);
    assert!(last(&run, Signal::SupplyPressure) < 10e5, "{}", last(&run, Signal::SupplyPressure));
    assert!(last(&run, Signal::Force) < 3e3 && happened(&run, "command_limit"), "{:?}", run.occurrences);
    let refusal = refused(BENCHMARK, &["supply.model=pump_limited"]);
    assert!(refusal.contains("missing `flow` in [supply]"), "{refusal}");
}

/// Chambers above the supply return oil to it; a tank above the supply is rejected.
#[test]
fn pressures_that_are_reversed() {
    let above = ["scenario.0.start.pressure_a=90 bar", "scenario.0.start.pressure_b=85 bar"];
    let run = completed(BENCHMARK, &above);
    let taken = run.record.signal(Signal::SupplyFlow);
    assert!(taken.iter().copied().fold(0.0, f64::min) < 0.0);
    assert!((last(&run, Signal::Force) - 4000.0).abs() < 1.0);
    let refusal = refused(BENCHMARK, &["supply.tank_pressure=80 bar"]);
    assert!(refusal.contains("`tank_pressure` must be below `pressure`"), "{refusal}");
}

/// A load that takes the piston beyond its stroke: stopped where there are stops, reported where
/// there are none.
#[test]
fn a_load_beyond_the_end_of_the_stroke() {
    for distance in ["252 mm", "-252 mm"] {
        let beyond = moved(distance, "0.5 s");
        let stop = if distance.starts_with('-') { "end_stop_a" } else { "end_stop_b" };
        let stopped = [QUIET[0], QUIET[1], &beyond, "cylinder.end_stops={ stiffness = \"500 MN/m\" }"];
        let run = completed(BENCHMARK, &stopped);
        let outside =
            run.record.signal(Signal::Position).iter().map(|x| (x - 0.25).abs() - 0.25).fold(0.0, f64::max);
        assert!(happened(&run, stop) && outside > 0.0 && outside < 1e-3, "{distance}: {outside}");
        let free = self::run(BENCHMARK, &[QUIET[0], QUIET[1], &beyond]);
        assert!(happened(&free, stop), "{distance}: {:?}", free.occurrences);
        let outside = free.occurrences.iter().find(|one| one.begins && one.kind != "command_limit");
        assert_eq!(free.outside_model_s, outside.map(|one| one.time_s), "from where nothing stops it");
    }
}

/// A hose of no length is rejected at its key; a very short one is a stiff machine.
#[test]
fn hoses_without_length() {
    for (text, setting, words) in [
        (HOSE, "line.length=0 m", "`length` must be above 0 m"),
        (HOSE, "line.length=-1 m", "`length` must be above 0 m"),
        (BENCHMARK, "line.volume=0 L", "without the volume of a line a chamber is empty"),
    ] {
        let refusal = refused(text, &[setting]);
        assert!(refusal.contains(words), "{refusal}");
        assert!(refusal.contains("--set"), "it says where that is written: {refusal}");
    }
    for (text, short) in [(HOSE, "line.length=1e-6 m"), (BENCHMARK, "line.volume=1e-12 m3")] {
        let run = completed(text, &[short]);
        assert!((last(&run, Signal::Force) - 4000.0).abs() < 20.0, "{short}: {}", last(&run, Signal::Force));
    }
}

/// Largest difference in N between the forces of a scenario by the implicit method and by the
/// explicit one.
#[track_caller]
fn apart(text: &str, settings: &[&str]) -> f64 {
    let force = |more: &[&str]| {
        let project = first_scenario(text, &[settings, more].concat());
        let run = simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true)
            .unwrap()
            .remove(0);
        assert_eq!(run.status, Status::Completed, "{settings:?}");
        run.record.signal(Signal::Force).to_vec()
    };
    let implicit = force(&["simulation.tolerance=1e-8"]);
    let explicit = force(&["simulation.method=dormand_prince", "simulation.tolerance=1e-8"]);
    assert_eq!(implicit.len(), explicit.len());
    implicit.iter().zip(&explicit).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

/// A microsecond between samples is practically continuous; a tenth of a second is far too long for
/// this loop, and the run still ends.
#[test]
fn samples_of_a_microsecond_and_of_a_tenth_of_a_second() {
    let early = ["scenario.0.reference=[{ at = 0.01, force = 4000 }]", "scenario.0.duration=0.05 s"];
    let of = |sample: &[&str]| completed(BENCHMARK, &[&early[..], sample].concat());
    let (continuous, sampled) = (of(&[]), of(&["controller.sample_time=1 us"]));
    assert_eq!(continuous.record.times_s.len(), sampled.record.times_s.len());
    let forces = [&continuous, &sampled].map(|run| run.record.signal(Signal::Force));
    let difference =
        forces[0].iter().zip(&forces[1]).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    assert!(last(&continuous, Signal::Force) > 500.0 && difference < 0.5, "{difference} N");
    let slow = completed(BENCHMARK, &["controller.sample_time=100 ms"]);
    assert!(slow.record.signal(Signal::Control).iter().all(|command| command.abs() <= 10.0));
    let slowly =
        ["controller.sample_time=100 ms", "scenario.0.duration=1 s", "scenario.0.reference.0.at=0.1"];
    assert!(apart(BENCHMARK, &slowly) < 1e-5 * 4000.0);
}

/// Motion of 20 mm in 10 ms, with every load and line: it follows the load, and an explicit method
/// gives an equal force.
#[test]
fn twenty_millimetres_in_ten_milliseconds() {
    let torn = moved("20 mm", "10 ms");
    let quiet = [QUIET[0], QUIET[1], &torn];
    let soft =
        "load={ model = \"spring_mass_damper\", mass = \"10 kg\", stiffness = \"1 MN/m\", damping = 500 }";
    let wall = "load={ model = \"wall\", mass = \"10 kg\", stiffness = \"10 MN/m\", damping = 500 }";
    for (text, more) in [
        (BENCHMARK, ""),
        (BENCHMARK, soft),
        (BENCHMARK, wall),
        (BENCHMARK, "controller.sample_time=1 ms"),
        (HOSE, ""),
        (HOSE, "line.model=transmission_line"),
        (HOSE, "line.model=two_wave"),
        (HOSE, "line.compliance=by_volume"),
    ] {
        let settings: Vec<&str> = quiet.iter().copied().chain((!more.is_empty()).then_some(more)).collect();
        let run = completed(text, &settings);
        assert!(
            (last(&run, Signal::LoadPosition) - 0.27).abs() < 0.02,
            "{more}: {}",
            last(&run, Signal::LoadPosition)
        );
        let peak =
            run.record.signal(Signal::Force).iter().fold(0.0, |peak: f64, force| peak.max(force.abs()));
        assert!(peak > 300.0, "{more}: {peak} N");
        // waves of the wall are too fast for an explicit method
        if more.ends_with("two_wave") {
            continue;
        }
        let shorter: Vec<&str> = settings.into_iter().chain(["scenario.0.duration=0.8 s"]).collect();
        let apart = apart(text, &shorter);
        assert!(apart < 1e-5 * peak, "{more}: {apart} N");
    }
}

/// A scenario with its last row before the end is complete nevertheless: its metrics are those of
/// rows that reach the end.
#[test]
fn rows_that_do_not_divide_the_scenario() {
    let settling = |step: &str| -> Vec<f64> {
        let run = completed(BENCHMARK, &[step]);
        run.windows.iter().map(|(_, metrics)| metrics.settling_time_s.unwrap()).collect()
    };
    let whole = settling("scenario.0.output_step=1 ms");
    for step in
        ["scenario.0.output_step=0.3 ms", "scenario.0.output_step=3 ms", "scenario.0.output_step=7 ms"]
    {
        let found = settling(step);
        assert_eq!(found.len(), whole.len());
        assert!(
            found.iter().zip(&whole).all(|(one, other)| (one - other).abs() < 1e-3),
            "{found:?} {whole:?}"
        );
    }
}

/// A scenario whose table no disk could hold is rejected at its key, with the requested and the
/// allowed size.
#[test]
fn more_rows_than_are_stored() {
    for (setting, rows_requested) in [
        ("scenario.0.duration=1e6 s", "1.00e9"),
        ("scenario.0.output_step=1e-12 s", "5.00e12"),
        ("scenario.0.output_step=1e-320 s", "inf"),
    ] {
        let refusal = refused(BENCHMARK, &[setting]);
        assert!(refusal.contains(&format!("asks for {rows_requested} rows")), "{refusal}");
        assert!(
            refusal.contains("all scenarios together may have 10000000") && refusal.contains("--set"),
            "{refusal}"
        );
    }
    assert!(read(BENCHMARK, &["scenario.0.duration=9999 s"]).is_ok());
}
