//! Recordings of a valve whose signs contradict each other: the columns that are named, and the
//! setting that reverses them.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::run_command::{HOSE, load};
use phea_workbench::command::{ResponseRequest, response_watched};
use phea_workbench::engineering::friction::{KnownCylinder, friction_recordings};
use phea_workbench::engineering::identify::{Known, RecordedFiles, recordings};
use phea_workbench::project::{self, RecordedTest, Refusal};
use phea_workbench::source::Memory;
use serde_json::Value;

const ROWS: usize = 120;

/// Factors of the columns of a metering test: command, flow, and the drop p_A - p_B.
#[derive(Clone, Copy)]
struct Factors {
    command: f64,
    flow: f64,
    drop: f64,
}

const RIGHT: Factors = Factors { command: 1.0, flow: 1.0, drop: 1.0 };

/// A flow of 4 L/min per volt, and a meter whose drop is 0.02 bar at 1 L/min.
fn metering(factors: Factors, indicates_direction: bool) -> String {
    let mut text =
        String::from("time_s,command_v,supply_pressure_bar,pressure_a_bar,pressure_b_bar,flow_l_per_min\n");
    for row in 0..ROWS {
        let command = 3.0 * (TAU * row as f64 / ROWS as f64).sin();
        let flow = 4.0 * command;
        let drop = 0.02 * flow * flow.abs();
        let half = factors.drop * drop / 2.0;
        let shown = if indicates_direction { factors.flow * flow } else { flow.abs() };
        writeln!(
            text,
            "{row},{:.6},70,{:.6},{:.6},{shown:.6}",
            factors.command * command,
            35.0 + half,
            35.0 - half
        )
        .unwrap();
    }
    text
}

fn read(text: &str, keys: &str) -> Result<RecordedFiles, Box<Refusal>> {
    let project = format!("{HOSE}\n[[identify.recording]]\nfile = \"flow.csv\"\n{keys}");
    let source = Memory::default().with("rig.toml", project).with("flow.csv", text);
    let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    let declared: Vec<RecordedTest> = loaded.project.identify.unwrap().recordings;
    recordings(&source, &declared, &Known::default())
}

/// The settings that a message proposes.
fn proposed(help: &str) -> String {
    help.split('`').filter(|part| part.contains(" = {")).collect::<Vec<_>>().join("\n")
}

#[test]
fn one_wrong_sign_is_named_and_the_proposed_setting_turns_it() {
    let right = read(&metering(RIGHT, true), "").unwrap();
    let cases = [
        (Factors { command: -1.0, ..RIGHT }, "the command is reversed", "`command_v` rises"),
        (Factors { flow: -1.0, ..RIGHT }, "the flow meter is reversed", "`flow_l_per_min` falls"),
        (
            Factors { drop: -1.0, ..RIGHT },
            "the pressures of the ports are exchanged",
            "`pressure_a_bar` less `pressure_b_bar` falls while `command_v` rises",
        ),
    ];
    for (factors, cause, signals) in cases {
        let text = metering(factors, true);
        let refusal = read(&text, "").unwrap_err();
        let [found] = refusal.diagnostics.as_slice() else { panic!("{refusal}") };
        let help = found.help.as_deref().unwrap();
        assert!(help.starts_with(cause), "{help}");
        assert!(found.message.contains(signals), "{}", found.message);
        let turned = read(&text, &proposed(help)).unwrap_or_else(|refusal| panic!("{refusal}"));
        assert_eq!(turned.recordings, right.recordings, "{help}");
    }
}

/// The drop of the meter is not known without both port pressures: a warning is given, and none if
/// both are recorded.
#[test]
fn an_unrecorded_pressure_drop_has_a_warning() {
    let messages = |text: &str| -> Vec<String> {
        let read = read(text, "").unwrap_or_else(|refusal| panic!("{refusal}"));
        read.warnings.into_iter().map(|one| one.message).collect()
    };
    let text = metering(RIGHT, true);
    let of_drop =
        |text: &str| messages(text).into_iter().filter(|message| message.contains("counts as zero"));
    assert_eq!(of_drop(&text).count(), 0);
    let [one] = of_drop(&text.replace("pressure_b_bar", "beside")).collect::<Vec<_>>().try_into().unwrap();
    assert!(one.starts_with("without `pressure_b` the drop"), "{one}");
    let neither = text.replace("pressure_a_bar", "one").replace("pressure_b_bar", "other");
    let [both] = of_drop(&neither).collect::<Vec<_>>().try_into().unwrap();
    assert!(both.starts_with("without `pressure_a` and `pressure_b` the drop"), "{both}");
}

/// The table of a file's contents states which column was reversed, with its own range.
#[test]
fn a_column_that_is_reversed_is_described_so() {
    let read = read(&metering(Factors { flow: -1.0, ..RIGHT }, true), "flow = { reversed = true }").unwrap();
    let reversed: Vec<&str> = read.contents[0]
        .columns
        .iter()
        .filter(|column| column.is_reversed)
        .map(|column| column.heading.as_str())
        .collect();
    assert_eq!(reversed, ["flow_l_per_min"]);
}

/// Two causes explain a drop that falls with the command, if the direction of the flow is not
/// indicated.
#[test]
fn a_meter_without_direction_leaves_two_causes_open() {
    for factors in [Factors { command: -1.0, ..RIGHT }, Factors { drop: -1.0, ..RIGHT }] {
        let refusal = read(&metering(factors, false), "").unwrap_err();
        let help = refusal.diagnostics[0].help.clone().unwrap();
        assert!(help.contains("if the command is reversed"), "{help}");
        assert!(help.contains("if the pressures of the ports are exchanged"), "{help}");
    }
    assert!(read(&metering(RIGHT, false), "").is_ok());
}

/// A drift of the transducers over one sine has a correlation of sqrt(6)/pi with the command, and
/// gives no information on signs.
#[test]
fn a_drift_is_not_a_wrong_sign() {
    for drift in [0.5, -0.5] {
        let mut text = String::from(
            "time_s,command_v,supply_pressure_bar,pressure_a_bar,pressure_b_bar,flow_l_per_min\n",
        );
        for row in 0..ROWS {
            let part = row as f64 / ROWS as f64;
            let command = 3.0 * (TAU * part).sin();
            writeln!(
                text,
                "{row},{command:.6},70,{:.6},{:.6},{:.6}",
                35.0 + drift * part,
                35.0 - drift * part,
                4.0 * command.abs()
            )
            .unwrap();
        }
        read(&text, "").unwrap_or_else(|refusal| panic!("{refusal}"));
    }
}

/// A run of the cylinder that slides in both directions at 20 mm/s against 100 N, and its signs.
struct Run {
    position: f64,
    velocity: f64,
    exchanged: bool,
}

/// Rod areas of the example, 50 mm and 22 mm: A_A = 1963.5 mm2, A_B = 1583.4 mm2.
fn sliding(run: &Run) -> String {
    let mut text = String::from("time_s,position_mm,velocity [mm/s],pressure_a_bar,pressure_b_bar\n");
    for row in 0..800 {
        let (turn, part) = (row / 200, f64::from(row % 200));
        let way = if turn % 2 == 0 { 1.0 } else { -1.0 };
        let position = if way > 0.0 { 0.2 * part } else { 40.0 - 0.2 * part };
        let [area_a, area_b] = [1.9635e-3, 1.5834e-3];
        let b = 20e5;
        let a = (area_b * b + 100.0 * way) / area_a;
        let [a, b] = if run.exchanged { [b, a] } else { [a, b] };
        writeln!(
            text,
            "{:.2},{:.3},{:.1},{:.5},{:.5}",
            f64::from(row) * 0.01,
            run.position * position,
            run.velocity * 20.0 * way,
            a / 1e5,
            b / 1e5
        )
        .unwrap();
    }
    text
}

#[test]
fn a_run_against_its_own_force_is_refused_with_the_signals() {
    let known = KnownCylinder::of(&load(HOSE, &[], &[]).project).unwrap();
    let read = |run: &Run| {
        let source = Memory::default().with("run.csv", sliding(run));
        friction_recordings(&source, &["run.csv".to_string()], &known).map_err(|error| error.to_string())
    };
    let right = Run { position: 1.0, velocity: 1.0, exchanged: false };
    read(&right).unwrap();
    let wrong = [
        (Run { position: -1.0, velocity: -1.0, ..right }, "is against its motion by `position_mm`"),
        (Run { exchanged: true, ..right }, "of `pressure_a_bar`, `pressure_b_bar`, is against its motion"),
        (Run { velocity: -1.0, ..right }, "`velocity [mm/s]` is against the slope of `position_mm`"),
    ];
    for (run, named) in wrong {
        let error = read(&run).unwrap_err();
        assert!(error.contains(named), "{error}");
    }
}

/// A force F = k/(1 + s T) U, sampled over four periods of five sines after settling.
fn shaken(sign: f64) -> String {
    let (gain, lag, period, rows) = (500.0, 0.3, 2.0, 200);
    let mut text = String::from("time_s,command_v,force_n\n");
    for row in 0..5 * rows {
        let time = period * row as f64 / rows as f64;
        let (mut command, mut force) = (0.0, 0.0);
        for line in [1.0, 2.0, 5.0, 9.0, 14.0_f64] {
            let (frequency, phase) = (TAU * line / period, line * line);
            let angle = frequency * time + phase;
            let slow = frequency * lag;
            command += 0.1 * angle.sin();
            force += sign * 0.1 * gain * (angle.sin() - slow * angle.cos()) / (1.0 + slow * slow);
        }
        writeln!(text, "{time:.4},{command:.8},{force:.6}").unwrap();
    }
    text
}

#[test]
fn a_force_against_its_command_is_warned_of_with_the_key() {
    let warnings = |sign: f64, keys: &str| -> Vec<String> {
        let project = format!("{HOSE}\n[[identify.response]]\nfile = \"shaken.csv\"\n{keys}");
        let source = Memory::default().with("rig.toml", project).with("shaken.csv", shaken(sign));
        let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap();
        let request = ResponseRequest::default();
        let answer = response_watched(&source, Some(&loaded), &request, &mut |_| true).unwrap();
        let json: Value = parsed(&answer.json);
        let warnings = json["response"]["members"][0]["warnings"].as_array().cloned().unwrap_or_default();
        warnings.iter().map(|warning| warning.as_str().unwrap().to_string()).collect()
    };
    assert_eq!(warnings(1.0, ""), [""; 0]);
    let messages = warnings(-1.0, "");
    assert!(messages.len() == 1 && messages[0].contains("`force = { reversed = true }`"), "{messages:?}");
    assert_eq!(warnings(-1.0, "force = { reversed = true }"), [""; 0]);
    assert_eq!(warnings(-1.0, "command = { reversed = true }"), [""; 0]);
}

/// The flow of the example's valve at each command, times a factor.
#[test]
fn a_flow_that_the_declared_valve_does_not_pass_is_named_with_its_unit() {
    // K of edges 3 and 6 in series, and of 5 and 4. ORIGIN: thesis Table 5.1
    let path = |one: f64, other: f64| one * other / (one * one + other * other).sqrt();
    let [positive, negative] = [path(3.2e-7, 3.85e-7), path(2.0e-7, 2.5e-7)];
    let known = Known::of(&load(HOSE, &[], &[]).project);
    let read = |factor: f64| {
        let mut text = String::from(
            "time_s,command_v,supply_pressure_bar,pressure_a_bar,pressure_b_bar,flow_l_per_min\n",
        );
        for row in 0..ROWS {
            let command = 3.0 * (TAU * row as f64 / ROWS as f64).sin();
            let path = if command > 0.0 { positive } else { negative };
            let flow = path * command.abs() / 10.0 * 70e5_f64.sqrt() * 6e4;
            writeln!(text, "{row},{command:.6},70,35,35,{:.6}", factor * flow).unwrap();
        }
        let source = Memory::default().with("flow.csv", text);
        recordings(&source, &[RecordedTest::of("flow.csv")], &known)
    };
    assert!(read(1.0).unwrap().warnings.is_empty());
    assert!(read(1.5).unwrap().warnings.is_empty());
    let gallons = read(1.0 / 3.785).unwrap();
    let [warned] = gallons.warnings.as_slice() else { panic!("{:?}", gallons.warnings) };
    assert!(warned.help.as_deref().unwrap().contains("unit = \"gpm\""), "{warned:?}");
    let refusal = read(1000.0).unwrap_err();
    assert!(refusal.to_string().contains("unit = \"mL/min\""), "{refusal}");
}

/// Blocked ports vary from tank to supply pressure: a transducer that reads 0.5 bar too little is
/// below the atmosphere for half of the test, and one that reads 2 bar too little below a vacuum.
#[test]
fn a_gauge_below_the_atmosphere_is_warned_of_and_below_a_vacuum_refused() {
    let read = |offset: f64| {
        let mut text = String::from("time_s,command_v,supply_pressure_bar,pressure_a_bar,pressure_b_bar\n");
        for row in 0..ROWS {
            let command = 3.0 * (TAU * row as f64 / ROWS as f64).sin();
            let half = 35.0 * (4.0 * command).tanh();
            writeln!(text, "{row},{command:.6},70,{:.6},{:.6}", 35.0 + half, 35.0 - half + offset).unwrap();
        }
        read(&text, "")
    };
    assert!(read(0.0).unwrap().warnings.is_empty());
    assert!(read(-0.1).unwrap().warnings.is_empty());
    let warned = read(-0.5).unwrap().warnings;
    assert!(warned.len() == 1 && warned[0].message.contains("`pressure_b_bar` is below the atmosphere"));
    let refused = read(-2.0).unwrap_err().to_string();
    assert!(refused.contains("`pressure_b_bar` falls to -2 bar, which is below a vacuum"), "{refused}");
}
