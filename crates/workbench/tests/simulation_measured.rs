//! Measured curves on simulated ones: a measurement made from a simulation's own table has a known
//! error.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use std::fmt::Write as _;

use phea_workbench::command::{self, Request, SimulateRequest};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{ScenarioRun, SimulateError, Unmeasured, simulate_project};
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");

/// The benchmark's first 2.5 s, with these lines after its scenario and this file next to it.
fn rig(measured: &str, content: &str) -> (Memory, project::Loaded) {
    let text = format!("{BENCHMARK}\n{measured}");
    let source = Memory::default().with("rig.toml", text.as_str()).with("bench.csv", content);
    let settings = ["scenario.0.duration=2.5 s".to_string()];
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    (source, loaded)
}

fn run(measured: &str, content: &str) -> ScenarioRun {
    let (source, loaded) = rig(measured, content);
    simulate_project(&source, &Setup::new(&loaded.project).unwrap(), &mut |_| true)
        .unwrap_or_else(|error| panic!("{error}"))
        .remove(0)
}

const MAPPED: &str = "[[scenario.measured]]\nfile = \"bench.csv\"\ntime_column = \"t\"\ntime_unit = \"ms\"\noffset = \"1 s\"\n\
                      signals = [{ signal = \"force_n\", column = \"F\", unit = \"kN\" }, { signal = \"pressure_a_pa\", unit = \"bar\" }]\n";

/// Force 25 N too large, pressure unchanged; in other units, from a second before the scenario's
/// start to after its end, every 0.7 ms.
#[test]
fn a_constant_offset_has_its_nrmse() {
    let plain = run("", "");
    let (force, pressure) = (plain.record.signal(Signal::Force), plain.record.signal(Signal::PressureA));
    let at = |values: &[f64], time_s: f64| {
        let place = time_s / 0.25e-3;
        let (row, part) = ((place.floor() as usize).min(values.len() - 2), place.fract());
        values[row] + part * (values[row + 1] - values[row])
    };
    let mut text = "# from the bench\nt, F, note, pressure_a_pa\n".to_string();
    let (mut largest, mut smallest, mut within) = (f64::MIN, f64::MAX, 0);
    for row in 0..5000 {
        let time_s = -0.5 + 0.7e-3 * f64::from(row);
        let inside = (0.0..2.4999).contains(&time_s);
        let (newton, pascal) =
            if inside { (at(&force, time_s) + 25.0, at(&pressure, time_s)) } else { (9e4, 6e6) };
        if inside {
            (largest, smallest, within) = (newton.max(largest), newton.min(smallest), within + 1);
        }
        let time_ms = 1e3 * (time_s - 1.0);
        writeln!(text, "{time_ms:.4}, {:e}, x, {:e}", newton / 1e3, pascal / 1e5).unwrap();
    }
    let [on_force, on_pressure] = run(MAPPED, &text).measured.try_into().unwrap();
    assert_eq!((on_force.times_s.len(), on_force.rows_outside), (within, 5000 - within));
    // ORIGIN: analytic, the root mean square of a constant is the constant
    assert!((on_force.rmse.unwrap() - 25.0).abs() < 0.05, "{:?}", on_force.rmse);
    let nrmse = 25.0 / (largest - smallest);
    assert!((on_force.nrmse.unwrap() / nrmse - 1.0).abs() < 2e-3, "{:?} {nrmse}", on_force.nrmse);
    assert!(on_pressure.nrmse.unwrap() < 1e-6, "{:?}", on_pressure.nrmse);
}

#[test]
fn a_constant_signal_has_no_range() {
    let declared = "[[scenario.measured]]\nfile = \"bench.csv\"\nsignals = [{ signal = \"position_m\" }]\n";
    let overlay = run(declared, "time_s,position_m\n0,0.25\n1,0.25\n2,0.25\n").measured.remove(0);
    assert!(overlay.rmse.unwrap() < 1e-3);
    assert_eq!(overlay.nrmse, Err(Unmeasured::NoRange));
}

#[test]
fn the_comparison_is_in_text_json_and_a_figure() {
    let content = "t,F,pressure_a_pa\n-1000,0,35\n0,0.01,35\n1200,1.1,40\n1400,3.3,50\n";
    let (source, loaded) = rig(MAPPED, content);
    let request = Request::Simulate(SimulateRequest { figures: true, ..SimulateRequest::default() });
    let answer = command::answer(&source, &loaded, &[], &request).unwrap();
    assert!(answer.text().contains("NRMSE") && answer.text().contains("bench.csv `F`"), "{}", answer.text());
    let json: Value = parsed(&answer.json);
    let row = &json["scenarios"][0]["measured"][0];
    assert_eq!(
        (&row["signal"], &row["rows"], &row["rows_outside"]),
        (&"force_n".into(), &4.into(), &0.into())
    );
    assert!(row["nrmse"].is_f64() && row["nrmse_reason"].is_null());
    let names: Vec<&str> = answer.files.iter().map(|file| file.name.as_str()).collect();
    assert!(
        names.contains(&"simulation-1-measured.svg") && names.contains(&"simulation-1-step-1.svg"),
        "{names:?}"
    );
}

#[test]
fn an_unusable_measurement_is_refused_with_its_place() {
    let cases = [
        ("t,F,pressure_a_pa\n0,1,2\n0,1,2\n", "3:1 the time of the row before, with other values"),
        ("t,F,pressure_a_pa\n0,1,2\n1,,2\n", "3:3 there is no value"),
        ("t,F,pressure_a_pa\n0,1,2\n1,1\n", "3:1 2 values for 3 columns"),
        ("t,F,pressure_a_pa\n0,1,NaN\n", "2:5 `NaN` is not a number"),
        ("t,force,pressure_a_pa\n0,1,2\n", "1:1 there is no column `F`"),
        ("t,F,pressure_a_pa,F\n0,1,2,3\n", "1:19 a second column `F`"),
        ("time,F,pressure_a_pa\n0,1,2\n", "1:1 there is no column `t`"),
        ("t,F,pressure_a_pa\n9000,1,2\n", "2:1 no row lies within the scenario"),
    ];
    for (content, expected) in cases {
        let (source, loaded) = rig(MAPPED, content);
        let SimulateError::Motion(report) =
            simulate_project(&source, &Setup::new(&loaded.project).unwrap(), &mut |_| true).unwrap_err()
        else {
            panic!("{content}")
        };
        let found: Vec<String> =
            report.diagnostics.iter().map(|d| format!("{}:{} {}", d.line, d.column, d.message)).collect();
        assert!(found.contains(&expected.to_string()), "{found:?}, not {expected}");
    }
}
