//! The closed loop of the performance benchmark, at the tolerance that its project files state,
//! compared with the golden reference.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_hydraulics::signal::Signal;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{ScenarioRun, simulate_project};
use phea_workbench::project;
use phea_workbench::source::Memory;

const CONTINUOUS: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
const SAMPLED: &str = include_str!("../../../examples/benchmark/closed_loop_sampled.toml");
// ORIGIN: recomputed by comparisons/recompute_closed_loop.py
const REFERENCE: &str = include_str!("golden/closed_loop.csv");
const REFERENCE_SAMPLED: &str = include_str!("golden/closed_loop_sampled.csv");

fn run(text: &str, settings: &[&str]) -> ScenarioRun {
    let source = Memory::default().with("rig.toml", text);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    simulate_project(&source, &Setup::new(&loaded.project).unwrap(), &mut |_| true).unwrap().remove(0)
}

/// Largest difference of the force in N, at the times of the reference.
fn force_error(run: &ScenarioRun, reference: &str) -> f64 {
    let rows = reference.lines().filter(|line| !line.starts_with(['#', 't']));
    let force = run.record.signal(Signal::Force);
    let (mut next, mut worst, mut compared) = (0, 0.0_f64, 0);
    for row in rows {
        let numbers: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
        next += run.record.times_s[next..].iter().position(|time| (time - numbers[0]).abs() < 1e-9).unwrap();
        worst = worst.max((force[next] - numbers[1]).abs());
        compared += 1;
    }
    assert_eq!(compared, 879);
    worst
}

#[test]
fn at_its_tolerance_the_force_is_right_to_twenty_millinewtons() {
    let cases = [(CONTINUOUS, REFERENCE, 600), (SAMPLED, REFERENCE_SAMPLED, 5_500)];
    for (text, reference, most_steps) in cases {
        let run = run(text, &[]);
        let error = force_error(&run, reference);
        assert!(error <= 0.02, "{error} N, {:?}", run.work);
        let steps = run.work.steps + run.work.rejected;
        assert!(steps <= most_steps, "{:?}", run.work);
    }
}

/// Other tolerances nearby give equal accuracy, and a small one is ten times more accurate.
#[test]
fn other_tolerances_do_as_well_or_better() {
    let cases = [
        (CONTINUOUS, REFERENCE, [8e-7, 7e-7, 5e-7, 4e-7, 3e-7]),
        (SAMPLED, REFERENCE_SAMPLED, [2e-6, 1.5e-6, 1.2e-6, 8e-7, 6e-7]),
    ];
    for (text, reference, nearby) in cases {
        let error = |tolerance: f64| {
            let setting = format!("simulation.tolerance={tolerance:e}");
            force_error(&run(text, &[&setting]), reference)
        };
        for tolerance in nearby {
            assert!(error(tolerance) <= 0.02, "{tolerance:e}: {} N", error(tolerance));
        }
        assert!(error(1e-8) <= 0.002, "{} N", error(1e-8));
    }
}
