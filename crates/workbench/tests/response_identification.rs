//! Identification of a measured family from recorded signals: the response of the nonlinear
//! machine, excited by a multisine and by noise, is its linear plant.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use crate::{answer_schema, run_command};
use num_complex::Complex64;
use phea_dynamics::portable::{exp_complex, magnitude};
use phea_dynamics::random::{normal, stream};
use phea_qft::family::{Family, MeasuredPlant};
use phea_workbench::answer::Answer;
use phea_workbench::command::{self, IdentifyError, Request, ResponseRequest, ResponseSettings};
use phea_workbench::engineering::{family::family, setup::Setup};
use phea_workbench::project::{self, Loaded};
use phea_workbench::source::Memory;
use serde_json::Value;

const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");

/// Viscous friction and four equal edges, so that the plant is the machine's derivative at null.
/// Steps of the solver are accurate to 1e-8.
const SMOOTH: [&str; 5] = [
    "simulation.tolerance=1e-8",
    "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
    "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
    "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
    "operating_point.position=\"250 mm\"",
];

/// 21 periods of 1.28 s of these lines, each with this amplitude in V; the first 16 are left out.
const PERIOD: f64 = 1.28;
const LINES: [f64; 6] = [1.0, 3.0, 8.0, 20.0, 45.0, 90.0];
const AMPLITUDE: f64 = 2e-3;
const MULTISINE: &str = "kind = \"multisine\", start = \"0 s\", duration = \"26.88 s\", \
frequencies = [\"0.78125 Hz\", \"2.34375 Hz\", \"6.25 Hz\", \"15.625 Hz\", \"35.15625 Hz\", \"70.3125 Hz\"]";

pub(crate) const SETTINGS: ResponseSettings =
    ResponseSettings { period: None, settling: Some(20.48), segment: None, coherence: 0.8 };

pub(crate) fn rig(amplitude: f64) -> Loaded {
    let scenario = format!(
        "scenario=[{{ name = \"shaken\", duration = \"26.88 s\", output_step = \"1 ms\", command = {{ amplitude = {amplitude}, {MULTISINE} }} }}]"
    );
    let settings: Vec<String> = SMOOTH.iter().map(|text| (*text).to_string()).chain([scenario]).collect();
    let source = Memory::default().with("rig.toml", BENCHMARK);
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

/// The table that `simulate` writes.
pub(crate) fn simulated(loaded: &Loaded) -> String {
    let source = Memory::default().with("rig.toml", BENCHMARK);
    let answer = command::answer(&source, loaded, &[], &Request::Simulate(Default::default()));
    let answer = answer.unwrap_or_else(|error| panic!("{error}"));
    let file = answer.files.iter().find(|file| file.name.ends_with(".csv")).expect("a table");
    String::from_utf8(file.bytes.clone()).unwrap()
}

/// The columns of a table by their names.
fn columns(table: &str, names: [&str; 3]) -> [Vec<f64>; 3] {
    let mut lines = table.lines();
    let headings: Vec<&str> = lines.next().unwrap().split(',').collect();
    let index = names.map(|name| headings.iter().position(|heading| *heading == name).expect(name));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    index.map(|index| rows.iter().map(|row| row[index].parse().unwrap()).collect())
}

fn table(names: &str, columns: [&[f64]; 3]) -> String {
    let [times, inputs, outputs] = columns;
    let rows = times.iter().zip(inputs).zip(outputs);
    rows.fold(format!("{names}\n"), |text, ((time, input), output)| {
        format!("{text}{time},{input},{output}\n")
    })
}

pub(crate) fn identified(
    table: &str,
    loaded: Option<&Loaded>,
    settings: &ResponseSettings,
) -> Result<Answer, IdentifyError> {
    let source = Memory::default().with("bench/shaken.csv", table);
    let files = vec!["bench/shaken.csv".to_string()];
    let request = ResponseRequest { files, settings: *settings, figures: false };
    command::response_watched(&source, loaded, &request, &mut |_| true)
}

fn member(answer: &Answer) -> Value {
    let json: Value = answer_schema::parsed(&answer.json);
    json["response"]["members"][0].clone()
}

/// Frequency in rad/s, response, radius.
fn points(member: &Value) -> Vec<(f64, Complex64, f64)> {
    let rows = member["frequencies"].as_array().unwrap();
    let point = |row: &Value| {
        let of = |name: &str| row[name].as_f64().unwrap();
        let direction = exp_complex(Complex64::new(0.0, of("phase_deg").to_radians()));
        (of("frequency_rad_per_s"), 10.0_f64.powf(of("magnitude_db") / 20.0) * direction, of("confidence_95"))
    };
    rows.iter().map(point).collect()
}

/// Two methods for one response: the nonlinear machine in time, and the linear plant of its
/// project. Without noise they agree in the limit of small commands; with noise in the force, over
/// 40 recordings, the discs contain the noise-free response at the stated rate.
#[test]
fn the_machine_shaken_by_a_multisine_shows_the_linear_plant() {
    let [loaded, gently] = [AMPLITUDE, AMPLITUDE / 2.0].map(rig);
    let plant = Setup::rig_of(&loaded.project).unwrap();
    let simulated = simulated(&loaded);
    let clean = member(&identified(&simulated, Some(&loaded), &SETTINGS).unwrap());
    assert_eq!((&clean["method"], &clean["blocks"]), (&Value::from("periods"), &Value::from(5)), "{clean}");
    assert!((clean["block_s"].as_f64().unwrap() - PERIOD).abs() < 1e-9);
    let gentle = member(&identified(&self::simulated(&gently), Some(&gently), &SETTINGS).unwrap());
    let (clean, gentle) = (points(&clean), points(&gentle));
    assert_eq!((clean.len(), gentle.len()), (LINES.len(), LINES.len()));
    let slow = plant.response(0.1);
    let pole = -0.1 * slow.re / slow.im;
    for ((frequency, response, _), (_, half, _)) in clean.iter().zip(&gentle) {
        let plant = plant.response(*frequency);
        let off = magnitude((2.0 * half - response) / plant - 1.0);
        assert!(off < remainder(*frequency, pole), "{frequency}: {off:e}");
    }
    let [times, inputs, outputs] = columns(&simulated, ["time_s", "control_v", "force_n"]);
    let (mut held, mut all) = (0, 0);
    for repetition in 0..40 {
        let mut state = stream(7, repetition);
        let noisy: Vec<f64> = outputs.iter().map(|force| force + 2.0 * normal(&mut state)).collect();
        // the last five periods and an omitted one
        let last = times.len() - 6 * 1280..;
        let table =
            table("time_s,command_v,force_n", [&times[last.clone()], &inputs[last.clone()], &noisy[last]]);
        let settings = ResponseSettings { coherence: 0.0, ..ResponseSettings::default() };
        let found = points(&member(&identified(&table, None, &settings).unwrap()));
        for (frequency, response, radius) in found {
            let without = clean.iter().find(|(one, _, _)| (one / frequency - 1.0).abs() < 1e-9);
            let (_, without, _) = without.expect("a line of the input");
            held += usize::from(magnitude(response - without) <= radius);
            all += 1;
        }
    }
    // ORIGIN: analytic, 99.8 % of a binomial distribution of 240 with 0.95
    assert!(all >= 200 && (held as f64 - 0.95 * all as f64).abs() < 10.5, "{held} of {all}");
}

/// Largest relative deviation of 2 G(a/2) - G(a) from the plant: the remainders of the curvature,
/// of the initial state, and of the solver's steps.
///
/// Below its hydraulic resonance the plant is K/(s + p), p by the flow-pressure coefficient. That
/// grows by the fraction m = K_v |u|/(2 K_vin U_n) with the edge that opens, and falls by (lambda
/// u/U_n)^2/2 with the leakage, so that
///
/// ```text
/// G(a)/G - 1 = k_1 a + k_2 a^2 + ...        |k_2 a^2| <= 3 (m_rms^2 + (lambda u_rms/U_n)^2/2) |p/(i w + p)|
/// ```
///
/// three times the mean squares, because the pressure moves with the command (the cubic of a normal
/// signal). The line through both amplitudes takes k_1 and leaves half of k_2 a^2. From rest, the
/// transient of the pole must decay: its transform over n periods T, divided by that of a line, is
/// at most
///
/// ```text
/// 2/(n T) exp(-p t_0) sum over lines of 1/|i w_j + p|
/// ```
fn remainder(frequency: f64, pole: f64) -> f64 {
    let lag = |w: f64| magnitude(Complex64::new(pole, w));
    // K_v, K_vin and lambda of the rig, U_n = 10 V
    let (opening, shape) = (3e-7 / (2.0 * 2.4e-9) / 10.0, 100.0 / 10.0);
    let mean_square = LINES.len() as f64 * AMPLITUDE * AMPLITUDE / 2.0;
    let curvature = 3.0 * (opening * opening + shape * shape / 2.0) * mean_square * pole / lag(frequency);
    let lines = LINES.map(|line| 2.0 * std::f64::consts::PI * line / PERIOD);
    let forgotten =
        (-pole * SETTINGS.settling.unwrap()).exp() * lines.map(|w| 1.0 / lag(w)).iter().sum::<f64>();
    // the force of all lines is nearly that of the first: both amplitudes err by a fraction of it
    let of_solver = 3.0 * 1e-8 * lag(frequency) / lag(lines[0]);
    0.5 * curvature + 2.0 / (5.0 * PERIOD) * forgotten + of_solver
}

/// The complete path: the identification gives a family that `verify` audits.
#[test]
fn an_identified_response_is_a_family_that_verify_audits() {
    // ten periods of 0.2 s of lines 1, 2, 4, 9 through 5/(0.05 s + 1), and some more
    let times: Vec<f64> = (0..2000).map(|n| f64::from(n) * 1e-3).collect();
    let plant = |w: f64, gain: f64| gain / Complex64::new(1.0, 0.05 * w);
    let line = |k: f64| 2.0 * std::f64::consts::PI * k / 0.2;
    let shaken = |gain: f64| -> String {
        let sum = |time: f64, shown: bool| -> f64 {
            let of = |k: &f64| {
                let turned = exp_complex(Complex64::new(0.0, line(*k) * time + k * k));
                (if shown { plant(line(*k), gain) * turned } else { turned }).re
            };
            [1.0, 2.0, 4.0, 9.0].iter().map(of).sum()
        };
        let [inputs, outputs] =
            [false, true].map(|shown| times.iter().map(|t| sum(*t, shown)).collect::<Vec<_>>());
        table("time_s,input,output", [&times, &inputs, &outputs])
    };
    let files = vec!["a/run.csv".to_string(), "b/run.csv".to_string()];
    let request = ResponseRequest { files, settings: ResponseSettings::default(), figures: true };
    let source = Memory::default().with("a/run.csv", shaken(5.0)).with("b/run.csv", shaken(8.0));
    let answer = command::response_watched(&source, None, &request, &mut |_| true).unwrap();
    let names: Vec<&str> = answer.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names[..3], ["run.response.csv", "run-2.response.csv", "measured.toml"]);
    assert_eq!(names.len(), 5, "a picture of each: {names:?}");
    let fragment = String::from_utf8(answer.files[2].bytes.clone()).unwrap();
    let project = format!(
        "schema = 1\n{fragment}\n[[specification]]\nkind = \"robust_stability\"\nlimit = 1.3\nfrequencies = [32, 60, 250]\n\n[controller]\nnumerator = \"0.5\"\ndenominator = \"s\"\n"
    );
    let source = answer.files.iter().fold(Memory::default().with("rig.toml", project), |source, file| {
        source.with(&file.name, file.bytes.clone())
    });
    let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    let Ok(Family::Measured(read)) = family(&Setup::new(&loaded.project).unwrap(), &source) else {
        panic!("no measured family")
    };
    for (member, gain) in read.plants().iter().zip([5.0, 8.0]) {
        assert_eq!(member.frequencies_rad_per_s.len(), 4);
        for (w, response) in member.frequencies_rad_per_s.iter().zip(&member.command) {
            assert!(magnitude(response / plant(*w, gain) - 1.0) < 1e-9, "{w} {response}");
        }
    }
    let verdict =
        command::answer(&source, &loaded, &[], &Request::Verify { proof: false, on_machine: false })
            .unwrap_or_else(|error| panic!("{error}"));
    let json = answer_schema::parsed(&verdict.json);
    assert_eq!(json["command"], "verify");
    assert!(!json["specifications"].as_array().unwrap().is_empty(), "{json}");
    // the discs of the records are in the family, each enlarged so that all rows hold at once
    let stated =
        |member: &MeasuredPlant| member.radii.len() == 4 && member.radii.iter().all(|one| *one > 0.0);
    assert!(read.plants().iter().all(stated));
    let text = verdict.text();
    assert!(text.contains("within the discs that hold all measured responses"), "{text}");
}

/// Frequencies at which noise hides the output are incoherent, and are listed with the reason.
#[test]
fn frequencies_hidden_by_noise_are_left_out_with_the_reason() {
    let mut state = stream(3, 0);
    let times: Vec<f64> = (0..4096).map(|n| f64::from(n) * 2e-3).collect();
    let inputs: Vec<f64> = times.iter().map(|_| normal(&mut state)).collect();
    // the mean of two neighbours vanishes at half of the sampling frequency
    let means = std::iter::once(0.0).chain(inputs.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0));
    let outputs: Vec<f64> = means.map(|mean| mean + 0.1 * normal(&mut state)).collect();
    let text = table("time [s],input,output", [&times, &inputs, &outputs]);
    let answer = identified(&text, None, &ResponseSettings::default()).unwrap();
    let found = member(&answer);
    assert_eq!(found["method"], "local_polynomials");
    let left_out = found["rows_left_out"].as_array().unwrap();
    assert!(!left_out.is_empty() && left_out.len() < points(&found).len());
    for row in left_out {
        assert_eq!(row["reason"], "the coherence is below the threshold");
        assert!(row["frequency_rad_per_s"].as_f64().unwrap() > 800.0, "{row}");
    }
    assert!(answer.text().contains("Left out, because the squared coherence is below"), "{}", answer.text());
}

#[track_caller]
fn refused(text: &str, settings: &ResponseSettings, expected: &[&str]) {
    run_command::refused(identified(text, None, settings), expected);
}

#[test]
fn records_that_give_no_response_are_refused_with_the_place_and_the_reason() {
    let usual = ResponseSettings::default();
    let times: Vec<f64> = (0..400).map(|n| f64::from(n) * 0.01).collect();
    let wave: Vec<f64> = times.iter().map(|t| (20.0 * t).sin() + (33.0 * t).sin()).collect();
    let mut late = times.clone();
    late[57] += 0.004;
    let jittery = table("time_s,input,output", [&late, &wave, &wave]);
    refused(&jittery, &usual, &["shaken.csv:59", "14 ms after the row before", "10 ms apart"]);
    let gap: String = table("time_s,input,output", [&times, &wave, &wave])
        .lines()
        .enumerate()
        .filter(|(line, _)| *line != 100)
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    refused(&gap, &usual, &["shaken.csv:101", "20 ms after the row before"]);
    let flat = vec![1.0; times.len()];
    refused(&table("time_s,input,output", [&times, &flat, &wave]), &usual, &["the input never moves"]);
    refused(&table("time_s,input,force_kg", [&times, &wave, &wave]), &usual, &["`kg` is not a unit of"]);
    refused(
        &table("time_s,command_v,angle", [&times, &wave, &wave]),
        &usual,
        &["there is no column `force`"],
    );
    let few = table("time_s,input,output", [&times[..20], &wave[..20], &wave[..20]]);
    refused(&few, &usual, &["20 rows are too few"]);
    let record = table("time_s,input,output", [&times, &wave, &wave]);
    let period = |seconds: f64| ResponseSettings { period: Some(seconds), ..ResponseSettings::default() };
    refused(&record, &period(0.314), &["31.4000 rows", "0.31 s or 0.32 s"]);
    refused(&record, &period(2.0), &["too short", "at least two periods"]);
}

/// u = 0.004 (r - y), held for a row, around 1000/(0.1 s + 1), with a disturbance of the force that
/// acts through the controller: time, reference, command and force.
fn closed_loop(rows: usize, moves: f64) -> [Vec<f64>; 4] {
    let mut state = stream(5, 0);
    let decay = (-0.01_f64).exp();
    let [mut times, mut references, mut inputs, mut outputs] = [const { Vec::new() }; 4];
    let (mut reference, mut disturbance, mut moved) = (0.0, 0.0, 0.0);
    for row in 0..rows {
        reference = 0.95 * reference + moves * normal(&mut state);
        disturbance = 0.98 * disturbance + 8.0 * normal(&mut state);
        let force: f64 = moved + disturbance;
        let command = 0.004 * (reference - force);
        times.push(row as f64 * 1e-3);
        references.push(reference);
        inputs.push(command);
        outputs.push(force);
        moved = decay * moved + 1000.0 * (1.0 - decay) * command;
    }
    [times, references, inputs, outputs]
}

fn with_reference([times, references, inputs, outputs]: &[Vec<f64>; 4]) -> String {
    let mut text = "time_s,reference_n,command_v,force_n\n".to_string();
    for (row, time) in times.iter().enumerate() {
        text += &format!("{time},{},{},{}\n", references[row], inputs[row], outputs[row]);
    }
    text
}

/// A closed loop is rejected without its reference, and with it gives the plant instead of -1/C.
#[test]
fn a_closed_loop_identifies_its_plant_from_the_reference() {
    let usual = ResponseSettings::default();
    let signals = closed_loop(20_000, 60.0);
    let [times, _, inputs, outputs] = &signals;
    let without = table("time_s,command_v,force_n", [times, inputs, outputs]);
    refused(&without, &usual, &["the loop was closed", "-1/C", "`reference`", "loop = \"open\""]);
    let segments = ResponseSettings { segment: Some(0.5), ..usual };
    refused(&without, &segments, &["the loop was closed"]);
    let strongly = with_reference(&closed_loop(20_000, 300.0));
    let found = member(&identified(&strongly, None, &usual).unwrap());
    assert_eq!(
        (&found["method"], &found["reference"]),
        (&"local_polynomials".into(), &"reference".into()),
        "{found}"
    );
    let decay = (-0.01_f64).exp();
    let (mut held, mut all) = (0, 0);
    for (frequency, response, radius) in points(&found) {
        let shift = exp_complex(Complex64::new(0.0, frequency * 1e-3));
        held += usize::from(magnitude(response - 1000.0 * (1.0 - decay) / (shift - decay)) <= radius);
        all += 1;
    }
    // ORIGIN: analytic, 99.8 % of a binomial distribution: 3.1 standard deviations
    let expected = 0.95 * f64::from(all);
    assert!(all > 20 && held as f64 > expected - 3.1 * (0.05 * expected).sqrt(), "{held} of {all}");
}

/// The loop stated in a project is used: an open one is not tested, a closed one needs its
/// reference.
#[test]
fn the_project_may_state_the_loop() {
    let [times, _, inputs, outputs] = &closed_loop(20_000, 60.0);
    let text = table("time_s,command_v,force_n", [times, inputs, outputs]);
    let stated = |word: &str| {
        let project =
            format!("{BENCHMARK}\n[[identify.response]]\nfile = \"shaken.csv\"\nloop = \"{word}\"\n");
        let source = Memory::default().with("rig.toml", project).with("shaken.csv", text.as_str());
        let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
        let request = ResponseRequest::default();
        command::response_watched(&source, Some(&loaded), &request, &mut |_| true)
    };
    run_command::refused(stated("closed"), &["no column says what moved it"]);
    assert_eq!(member(&stated("open").unwrap())["method"], "local_polynomials");
}

/// The answer for a record of a closed loop without its reference, with this `[controller]`.
fn by_controller(signals: &[Vec<f64>; 4], controller: &str) -> Result<Answer, IdentifyError> {
    let [times, _, inputs, outputs] = signals;
    let project = format!(
        "schema = 1\n[plant]\nnumerator = \"1000\"\ndenominator = \"0.1*s + 1\"\n[controller]\n{controller}\n[[identify.response]]\nfile = \"shaken.csv\"\ncontroller = \"declared\"\n"
    );
    let text = table("time_s,command_v,force_n", [times, inputs, outputs]);
    let source = Memory::default().with("rig.toml", project).with("shaken.csv", text);
    let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    command::response_watched(&source, Some(&loaded), &ResponseRequest::default(), &mut |_| true)
}

/// A controller that is a gain reconstructs the reference that was not recorded.
#[test]
fn a_declared_controller_replaces_the_reference() {
    let law =
        |gain: f64| format!("elements = [{{ kind = \"gain\", value = {gain} }}]\nsample_time = \"1 ms\"");
    let signals = closed_loop(20_000, 300.0);
    let found = member(&by_controller(&signals, &law(0.004)).unwrap());
    assert_eq!((&found["controller"], &found["reference"]), (&"declared".into(), &Value::Null), "{found}");
    let recorded =
        member(&identified(&with_reference(&signals), None, &ResponseSettings::default()).unwrap());
    let (found, recorded) = (points(&found), points(&recorded));
    assert!(found.len() > 20 && found.len() == recorded.len());
    for ((frequency, response, radius), (same, expected, expected_radius)) in found.iter().zip(&recorded) {
        assert_eq!(frequency, same);
        assert!(magnitude(response / expected - 1.0) < 1e-9 && (radius / expected_radius - 1.0).abs() < 1e-9);
    }
    for moves in [0.0, 20.0] {
        let half = by_controller(&closed_loop(20_000, moves), &law(0.002));
        run_command::refused(half, &["[controller] was not that of the test", "y + u/C"]);
    }
    let still = closed_loop(20_000, 0.0);
    run_command::refused(by_controller(&still, &law(0.004)), &["nothing moved the loop from outside"]);
    let limited = format!("{}\nsaturation = \"1 V\"", law(0.004));
    let at_limit = ["`command` is at the limit of [controller] in"];
    run_command::refused(by_controller(&signals, &limited), &at_limit);
}

/// A controller that integrates, acts in every fourth row and two rows late: the discs contain the
/// plant from row to row.
#[test]
fn a_declared_controller_has_its_samples_and_its_delay() {
    let mut state = stream(6, 0);
    let decay = (-0.01_f64).exp();
    let [mut times, mut references, mut inputs, mut outputs] = [const { Vec::new() }; 4];
    let (mut reference, mut disturbance, mut moved) = (0.0, 0.0, 0.0);
    let (mut integral, mut wanted) = (0.0, vec![0.0; 2]);
    for row in 0..20_000 {
        reference = 0.95 * reference + 400.0 * normal(&mut state);
        disturbance = 0.98 * disturbance + 8.0 * normal(&mut state);
        let force: f64 = moved + disturbance;
        let last = wanted.last().copied().unwrap();
        wanted.push(if row % 4 == 0 { 0.002 * (reference - force) + integral } else { last });
        if row % 4 == 0 {
            integral += 0.04 * 4e-3 * (reference - force);
        }
        let command = wanted[row];
        times.push(row as f64 * 1e-3);
        references.push(reference);
        inputs.push(command);
        outputs.push(force);
        moved = decay * moved + 1000.0 * (1.0 - decay) * command;
    }
    let law = "numerator = \"0.002*z - 0.00184\"\ndenominator = \"z - 1\"\nsample_time = \"4 ms\"\ndelay = \"2 ms\"";
    let found = member(&by_controller(&[times, references, inputs, outputs], law).unwrap());
    let (mut held, mut all) = (0, 0);
    for (frequency, response, radius) in points(&found) {
        let shift = exp_complex(Complex64::new(0.0, frequency * 1e-3));
        held += usize::from(magnitude(response - 1000.0 * (1.0 - decay) / (shift - decay)) <= radius);
        all += 1;
    }
    // ORIGIN: analytic, 99.8 % of a binomial distribution: 3.1 standard deviations
    let expected = 0.95 * f64::from(all);
    assert!(all > 20 && held as f64 > expected - 3.1 * (0.05 * expected).sqrt(), "{held} of {all}");
}

/// Rows that are early and late throughout are resampled to even ones, and this is reported.
#[test]
fn uneven_rows_are_resampled_and_reported() {
    let mut state = stream(8, 0);
    let plant = |w: f64| 5.0 / Complex64::new(1.0, 0.05 * w);
    let lines: Vec<f64> =
        (0..120).map(|line| 2.0 * std::f64::consts::PI * (0.31 + 0.167 * f64::from(line))).collect();
    let times: Vec<f64> =
        (0..20_000).map(|row| 1e-3 * (f64::from(row) + 0.35 * normal(&mut state).clamp(-1.0, 1.0))).collect();
    let sum = |time: f64, of: &dyn Fn(f64) -> Complex64| -> f64 {
        lines.iter().map(|w| (of(*w) * exp_complex(Complex64::new(0.0, w * time + w * w))).re).sum()
    };
    let inputs: Vec<f64> = times.iter().map(|time| sum(*time, &|_| Complex64::ONE)).collect();
    let outputs: Vec<f64> = times.iter().map(|time| sum(*time, &plant) + 0.3 * normal(&mut state)).collect();
    let answer = identified(
        &table("time_s,input,output", [&times, &inputs, &outputs]),
        None,
        &ResponseSettings::default(),
    )
    .unwrap();
    let found = member(&answer);
    let warning = found["warnings"][0].as_str().unwrap();
    assert!(warning.contains("the rows are not even") && answer.text().contains(warning), "{warning}");
    let gap = found["resampled"]["longest_gap_s"].as_f64().unwrap();
    let highest = found["resampled"]["highest_frequency_rad_per_s"].as_f64().unwrap();
    assert!((highest * gap - 0.2 * std::f64::consts::PI).abs() < 1e-9);
    for (frequency, response, radius) in points(&found) {
        assert!(frequency <= highest);
        let error = magnitude(response - plant(frequency));
        assert!(error < 2.0 * radius + 0.01 * magnitude(response), "{frequency} {error} {radius}");
    }
}

/// A square that is added to the output falls on even lines of an odd multisine.
#[test]
fn nonlinear_responses_have_a_warning() {
    let angle = |row: i32, line: f64| 2.0 * std::f64::consts::PI * f64::from(row % 500) / 500.0 * line;
    let times: Vec<f64> = (0..3000).map(|row| f64::from(row) * 1e-3).collect();
    let inputs: Vec<f64> =
        (0..3000).map(|row| [1.0, 3.0, 7.0].iter().map(|line| angle(row, *line).sin()).sum()).collect();
    let bent = |size: f64| -> Vec<f64> { inputs.iter().map(|u| 2.0 * u + size * u * u).collect() };
    let found = |outputs: &[f64]| {
        let text = table("time_s,input,output", [&times, &inputs, outputs]);
        member(&identified(&text, None, &ResponseSettings::default()).unwrap())
    };
    let (straight, curved) = (found(&bent(0.0)), found(&bent(0.2)));
    assert!(straight["warnings"].is_null(), "{straight}");
    assert_eq!(curved["distortion"]["odd"], 0.0);
    assert!(curved["distortion"]["even"].as_f64().unwrap() > 0.05, "{curved}");
    assert!(curved["warnings"][0].as_str().unwrap().contains("does not follow `input` linearly"), "{curved}");
}
