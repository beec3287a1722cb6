//! The damping of the bristles from a piston that is shaken on them: recordings of the bench, of
//! equations that are written and integrated here, and of the complete machine.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use crate::friction_identification::{
    SHAKEN, SLIDING, TRUTH, found, identified, interval, is_open, recorded,
};
use crate::run_command::{HOSE, answer, load};
use phea_dynamics::portable;
use phea_dynamics::random::{normal, stream};
use phea_workbench::command::{FrictionRequest, Request, friction_watched};
use phea_workbench::source::{Memory, Source};
use serde_json::Value;

const STIFFNESS: &str = "bristle_stiffness_n_per_m";
const DAMPING: &str = "bristle_damping_n_s_per_m";

/// Checks that stiffness and damping are within 1.5 half widths of their true values, and
/// determined to this relative accuracy.
#[track_caller]
fn identifies_damping(found: &Value, tolerance: f64) {
    for (key, truth) in &TRUTH[5..] {
        let one = &found["friction"][key];
        let value = one["value"].as_f64().unwrap_or_else(|| panic!("{key}: {one}"));
        let [low, high] = interval(found, key);
        assert!((value - truth).abs() < 1.5 * (high - low) / 2.0, "{key}: {one}");
        assert!((high - low) / 2.0 < tolerance * truth, "{key}: {one}");
    }
}

fn found_in(source: &Memory, files: &[&str]) -> Value {
    let answer = identified(source, files).unwrap_or_else(|error| panic!("{error}"));
    parsed(&answer.json)
}

/// The information in the default run (1 um and 5 kPa of noise, 5000 rows in a second, a force of
/// 40 N) leaves a standard deviation of 3.7 % of the damping, and of 0.7 % of the stiffness.
#[test]
fn a_shaken_piston_identifies_the_damping_of_its_bristles() {
    // ORIGIN: analytic, by differences of the integrated equations: 1.96 times 3.7 %, and a margin
    // of a third
    identifies_damping(&found(&["bench.friction={ velocities = 8 }"], &[SLIDING, SHAKEN]), 0.1);
}

/// A scale with a resolution of 1 um gives readings no worse than its noise.
#[test]
fn a_quantised_position_identifies_it_too() {
    let settings = ["bench.friction={ velocities = 8, position_resolution = \"1 um\" }"];
    identifies_damping(&found(&settings, &[SLIDING, SHAKEN]), 0.1);
}

/// The damping is recovered with very little noise, except for the effect of the integration's
/// steps.
#[test]
fn the_damping_comes_back_with_next_to_no_noise() {
    let shaken = "shaken = { periods = 6 }";
    let friction = format!("bench.friction={{ velocities = 8, position_noise = 0, {shaken} }}");
    let settings = ["bench.pressure_noise=\"10 Pa\"", "bench.converter_bits=0", &friction];
    let found = found(&settings, &[SLIDING, SHAKEN]);
    for (key, truth) in &TRUTH[5..] {
        let value = found["friction"][key]["value"].as_f64().unwrap_or_else(|| panic!("{key}: {found}"));
        assert!((value / truth - 1.0).abs() < 0.01, "{key}: {value}");
    }
}

/// Frequencies without a common period, over a time that is no multiple of any.
const SINES: [(f64, f64, f64); 6] = [
    (71.3, 8.0, 0.3),
    (104.9, 6.0, 2.1),
    (131.7, 5.0, -1.2),
    (152.2, 5.0, 0.9),
    (183.8, 8.0, -2.6),
    (217.1, 12.0, 1.7),
];

fn shaking_force(time: f64) -> f64 {
    let sine = |(hertz, size, phase): &(f64, f64, f64)| {
        size * portable::sin(2.0 * std::f64::consts::PI * hertz * time + phase)
    };
    3.0 + SINES.iter().map(sine).sum::<f64>()
}

/// Rates of velocity, deflection and position: the LuGre model as published, with the rig's
/// coefficients.
fn rates([velocity, deflection, _]: [f64; 3], force: f64) -> [f64; 3] {
    let over = velocity / 0.01;
    let curve = 80.0 + 40.0 * portable::exp(-over * over);
    let bristle = velocity - 1e7 * velocity.abs() / curve * deflection;
    let friction = 1e7 * deflection + 2e3 * bristle + 100.0 * velocity;
    [(force - friction) / 13.1, bristle, velocity]
}

/// Positions of the shaken mass every 0.2 ms, by the method of Runge and Kutta in steps of 10 us.
fn integrated(rows: usize) -> Vec<[f64; 2]> {
    let (step, between) = (1e-5, 20);
    let mut state = [0.0, 0.0, 0.25];
    let mut found = Vec::new();
    for index in 0..rows * between {
        let time = index as f64 * step;
        if index % between == 0 {
            found.push([state[2], shaking_force(time)]);
        }
        let add = |rate: [f64; 3], by: f64| std::array::from_fn(|i| state[i] + by * rate[i]);
        let middle = shaking_force(time + step / 2.0);
        let first = rates(state, shaking_force(time));
        let second = rates(add(first, step / 2.0), middle);
        let third = rates(add(second, step / 2.0), middle);
        let fourth = rates(add(third, step), shaking_force(time + step));
        state = std::array::from_fn(|i| {
            state[i] + step / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + fourth[i])
        });
    }
    found
}

/// A table of a machine that moves the rod: times in s, positions in m and the forces on the piston
/// in N, with noise of the position in um and of the force in N, from a separate stream for each
/// seed.
fn table(rows: &[[f64; 2]], noise: [f64; 2], seed: u64) -> String {
    let mut state = stream(seed, 0);
    let row = |(index, [position, force]): (usize, &[f64; 2])| {
        let position = 1e6 * position + noise[0] * normal(&mut state);
        let force = force + noise[1] * normal(&mut state);
        format!("{},{position},{}\n", index as f64 * 2e-4, -force)
    };
    format!("time_s,position_um,force_n\n{}", rows.iter().enumerate().map(row).collect::<String>())
}

/// A sum of sines needs no common period, and may begin in motion: the first 100 rows are not
/// recorded.
#[test]
fn independently_written_equations_are_recovered() {
    let rows = integrated(4137);
    let source = recorded(&["bench.friction={ velocities = 8 }"]);
    let source = source.with("own.csv", table(&rows[100..], [0.5, 5.0], 1));
    identifies_damping(&found_in(&source, &[SLIDING, "own.csv"]), 0.08);
}

/// The rod of the complete machine is held by a load cell and its environment, and its valve is
/// shaken: chambers, hoses, spool and load cell take part.
#[test]
fn the_whole_machine_identifies_the_damping_of_its_bristles() {
    let (before, _) = HOSE.split_once("[[scenario]]").unwrap();
    let scenario = r#"
[[scenario]]
name = "shaken"
duration = "1.5 s"
output_step = "0.2 ms"
command = [
  { kind = "multisine", start = "10 ms", amplitude = "0.1 V", frequencies = ["73 Hz", "101 Hz", "139 Hz", "179 Hz", "211 Hz", "240 Hz", "283 Hz"] },
]
"#;
    let request = Request::Simulate(Default::default());
    let simulated = answer(&format!("{before}{scenario}"), &[], &[], &request);
    let run = simulated.files.iter().find(|file| file.name.ends_with(".csv")).unwrap();
    let text = String::from_utf8(run.bytes.clone()).unwrap();
    let heads: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let at = |name: &str| heads.iter().position(|head| *head == name).unwrap_or_else(|| panic!("{heads:?}"));
    let places = ["position_m", "pressure_a_pa", "pressure_b_pa", "force_n"].map(at);
    let mut noise = stream(1, 0);
    let mut table = "time_s,position_um,pressure_a_pa,pressure_b_pa,force_n\n".to_string();
    for (index, line) in text.lines().skip(1 + 2500).enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        let [position, a, b, force] = places.map(|place| cells[place].parse::<f64>().unwrap());
        let mut with = |value: f64, size: f64| value + size * normal(&mut noise);
        let (position, a, b) = (with(1e6 * position, 0.2), with(a, 2e3), with(b, 2e3));
        table += &format!("{},{position},{a},{b},{}\n", index as f64 * 2e-4, with(force, 2.0));
    }
    let source = recorded(&["bench.friction={ velocities = 8 }"]).with("machine.csv", table);
    let found = found_in(&source, &[SLIDING, "machine.csv"]);
    // a valve excites more than the sines of its command, partly hidden by the noise: over six
    // seeds of the noise the stiffness was 4 % too low at most, and the damping 20 % too high
    for ((key, truth), tolerance) in TRUTH[5..].iter().zip([0.06, 0.3]) {
        let value = found["friction"][key]["value"].as_f64().unwrap_or_else(|| panic!("{key}: {found}"));
        assert!((value / truth - 1.0).abs() < tolerance, "{key}: {value}");
    }
}

/// A recording that does not determine them is reported with the change that would.
#[test]
fn insufficient_shaking_is_reported_with_a_sufficient_one() {
    let files = [SLIDING, SHAKEN];
    let with =
        |shaken: &str| found(&[&format!("bench.friction={{ velocities = 6, shaken = {shaken} }}")], &files);
    let slow = with("{ sample_time = \"2 ms\", frequencies = [\"40 Hz\", \"100 Hz\"] }");
    // eight rows in a period of 7.19 ms
    is_open(&slow, DAMPING, "too few rows in a period of its ringing: record one every 870 us or oftener");
    let weak = with("{ force = \"10 N\", frequencies = [\"15 Hz\", \"25 Hz\"] }");
    is_open(&weak, DAMPING, "noise hides it: a force");
    // none of it is visible
    let nothing = with("{ force = \"0.5 N\" }");
    is_open(&nothing, DAMPING, "slow runs do not show it: shake the piston below the static friction of");
}

/// A force that is not a sum of sines is not known between its rows.
#[test]
fn a_blow_is_not_taken_for_a_sum_of_sines() {
    let mut rows = integrated(1000);
    let mut state = [0.0, 0.0, 0.0];
    for (index, row) in rows.iter_mut().enumerate() {
        let force = if index == 300 { 400.0 } else { 0.0 };
        for _ in 0..20 {
            let rate = rates(state, force);
            state = std::array::from_fn(|i| state[i] + 1e-5 * rate[i]);
        }
        *row = [state[2], force];
    }
    let source = recorded(&["bench.friction={ velocities = 8 }"]);
    let source = source.with("blow.csv", table(&rows, [0.2, 1.0], 1));
    let found = found_in(&source, &[SLIDING, "blow.csv"]);
    is_open(&found, DAMPING, "slow runs do not show it");
    is_open(&found, STIFFNESS, "record one that rises slowly");
}

/// The files of `[identify]` are read if none is named.
#[test]
fn the_project_may_name_the_recordings() {
    let source = recorded(&["bench.friction={ velocities = 6 }"]);
    let named = identified(&source, &[SLIDING]).unwrap();
    let declares = load(HOSE, &["identify.friction=[\"sliding.csv\"]"], &[]);
    let request = FrictionRequest::default();
    let declared = friction_watched(&source, Some(&declares), &request, &mut |_| true).unwrap();
    assert_eq!(declared.text(), named.text());
    assert!(source.read(SHAKEN).is_ok());
    let error = friction_watched(&source, Some(&load(HOSE, &[], &[])), &request, &mut |_| true).unwrap_err();
    assert!(error.to_string().contains("declare `friction` in `[identify]`"), "{error}");
}
