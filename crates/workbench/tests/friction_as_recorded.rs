//! Recordings of friction with the faults of test benches: zero errors, pistons that stick and
//! slip, high velocities. The true values are those of the rig, whose friction drives the bench.

#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use std::fmt::Write as _;

use crate::friction_identification::{PRESSED, SLIDING, TRUTH, identified, interval, is_open, recorded};
use phea_workbench::source::{Memory, Source};
use serde_json::Value;

/// The rows of a file of the bench, changed one by one.
fn changed(source: &Memory, file: &str, change: impl Fn(&mut [f64])) -> String {
    let table = String::from_utf8(source.read(file).unwrap()).unwrap();
    let (heading, rows) = table.split_once('\n').unwrap();
    let mut text = format!("{heading}\n");
    for row in rows.lines() {
        let mut cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        change(&mut cells);
        let cells: Vec<String> = cells.iter().map(f64::to_string).collect();
        writeln!(text, "{}", cells.join(",")).unwrap();
    }
    text
}

#[track_caller]
fn found(source: &Memory, files: &[&str]) -> Value {
    let answer = identified(source, files).unwrap_or_else(|error| panic!("{error}"));
    parsed(&answer.json)
}

/// Checks that each interval of these coefficients contains the truth, with three standard
/// deviations instead of two.
#[track_caller]
fn holds(found: &Value, coefficients: std::ops::Range<usize>) {
    for (key, truth) in &TRUTH[coefficients] {
        let [low, high] = interval(found, key);
        let value = found["friction"][key]["value"].as_f64().unwrap_or(*truth);
        let [low, high] = [value + 1.5 * (low - value), value + 1.5 * (high - value)];
        assert!(low <= *truth && *truth <= high, "{key}: {}", found["friction"][key]);
    }
}

/// A zero error of 0.3 bar at A is 47 N on the piston: more than half of its friction.
#[test]
fn a_zero_error_of_a_pressure_is_found_next_to_the_friction() {
    let source = recorded(&["bench.friction={ velocities = 7, slowest = \"2 mm/s\" }"]);
    let files = [SLIDING, PRESSED[0], PRESSED[1]];
    let shifted = files
        .iter()
        .fold(Memory::default(), |all, file| all.with(file, changed(&source, file, |cells| cells[2] += 0.3)));
    let found = found(&shifted, &files);
    let area = std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022);
    let zero = found["force_zero_n"]["value"].as_f64().unwrap();
    assert!((zero - 3e4 * area).abs() < 0.5, "{zero}");
    assert_eq!(found["converged"], true);
    holds(&found, 0..6);
    // found from the breakaways only, too
    let pressed = self::found(&shifted, &PRESSED);
    let zero = pressed["force_zero_n"]["value"].as_f64().unwrap();
    assert!((zero - 3e4 * area).abs() < 5.0, "{zero}");
}

/// Fast runs and both breakaways: the fall between them has no run, and its shape is undetermined.
#[test]
fn fast_runs_and_breakaways_leave_the_shape_of_the_fall_open() {
    let source =
        recorded(&["bench.friction={ velocities = 8, slowest = \"20 mm/s\", fastest = \"200 mm/s\" }"]);
    let found = found(&source, &[SLIDING, PRESSED[0], PRESSED[1]]);
    holds(&found, 0..6);
    for key in ["coulomb_n", "static_n", "viscous_n_s_per_m", "bristle_stiffness_n_per_m"] {
        assert!(found["friction"][key]["value"].is_f64(), "{key}: {found}");
    }
    is_open(&found, "stribeck_velocity_m_per_s", "too few runs slide on the fall");
}

/// Three speeds are three numbers, and the curve has five: coefficients that they do not determine
/// have no value, but an interval that contains the truth.
#[test]
fn three_speeds_determine_three_parameters() {
    for slowest in ["2 mm/s", "5 mm/s", "20 mm/s"] {
        let bench =
            format!("bench.friction={{ velocities = 3, slowest = \"{slowest}\", fastest = \"200 mm/s\" }}");
        let found = found(&recorded(&[&bench]), &[SLIDING]);
        holds(&found, 0..5);
        assert_eq!(found["converged"], true, "{slowest}");
        let open = &found["friction"]["stribeck_velocity_m_per_s"];
        assert!(open["value"].is_null(), "{slowest}: {open}");
    }
}

/// A piston on a spring whose other end moves at 4 mm/s, below the Stribeck velocity: it sticks and
/// slips. Rows every 1 ms with position in mm and pressures in bar, with noise of 1 um and 5 kPa.
///
/// ```text
/// M dv/dt = k (u - x) - F_fr,   dz/dt = v - sigma_0 |v| z/g        F_fr = sigma_0 z + sigma_1 dz/dt + sigma_2 v
/// ```
fn stick_slip() -> String {
    let [mass, spring, speed, step] = [13.1, 1e5, 4e-3, 1e-5];
    let rates = |[x, v, z]: [f64; 3], time: f64| {
        let curve = 80.0 + 40.0 * (-(v / 0.01) * (v / 0.01)).exp();
        let rate = v - 1e7 * v.abs() * z / curve;
        let friction = 1e7 * z + 2e3 * rate + 100.0 * v;
        [v, (spring * (speed * time - x) - friction) / mass, rate]
    };
    let moved = |at: [f64; 3], slope: [f64; 3], by: f64| [0, 1, 2].map(|index| at[index] + by * slope[index]);
    let mut state = [0.0; 3];
    let mut seed = 1_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((seed >> 33) as f64 / 1_073_741_824.0 - 1.0) * 3_f64.sqrt() / 2.0
    };
    let area = std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022);
    let mut text = "time_s,position_mm,pressure_a_bar,pressure_b_bar\n".to_string();
    for row in 0..3000 {
        let time = f64::from(row) * 1e-3;
        let force = spring * (speed * time - state[0]);
        let pressure_a = 30.0 + force / area * 1e-5 + 0.05 * noise();
        let position = 1e3 * state[0] + 1e-3 * noise();
        writeln!(text, "{time:.3},{position:.4},{pressure_a:.4},30").unwrap();
        for part in 0..100 {
            let time = time + f64::from(part) * step;
            let first = rates(state, time);
            let second = rates(moved(state, first, step / 2.0), time + step / 2.0);
            state = moved(state, second, step);
        }
    }
    text
}

/// A run whose velocity is constant only on average is reported and left out.
#[test]
fn a_run_that_sticks_and_slips_is_no_constant_velocity() {
    let bench = "bench.friction={ velocities = 8, slowest = \"2 mm/s\", fastest = \"200 mm/s\" }";
    let source = recorded(&[bench]).with("slips.csv", stick_slip());
    let answer = identified(&source, &[SLIDING, "slips.csv"]).unwrap();
    let found: Value = parsed(&answer.json);
    holds(&found, 0..5);
    let slips = &found["recordings"][1];
    assert_eq!(slips["constant_velocities"].as_array().unwrap().len(), 0, "{slips}");
    let one = &slips["varying_velocities"][0];
    assert!((one["velocity_m_per_s"].as_f64().unwrap_or(0.0) / 4e-3 - 1.0).abs() < 0.1, "{slips}");
    let ends = [0, 1].map(|end| one["velocity_range_m_per_s"][end].as_f64().unwrap());
    assert!(ends[0] < 1e-3 && ends[1] > 8e-3, "{slips}");
    assert!(answer.text().contains("slips.csv"), "{}", answer.text());
    assert!(answer.text().contains("velocities that are not constant"), "{}", answer.text());
    assert!(found["recordings"][0]["varying_velocities"].as_array().is_some_and(Vec::is_empty), "{found}");
}
