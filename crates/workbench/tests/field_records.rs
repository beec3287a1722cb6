//! Records as practitioners write them: read like their plain form, or rejected by name.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use std::fmt::Write as _;

use phea_workbench::command::{IdentifyError, Request, SimulateRequest};
use phea_workbench::friction::{KnownCylinder, friction_recordings};
use phea_workbench::project::{self, Diagnostic, RecordedResponse};
use phea_workbench::response::{SampledPair, sampled_pairs};
use phea_workbench::source::Memory;

use crate::run_command;

/// Command and force of a record, at this time.
fn sample(time: f64) -> [f64; 2] {
    let swing = |slow: f64| (time / slow).rem_euclid(2.0) - 1.0;
    [0.02 * swing(0.31), 12.0 * swing(0.47)]
}

/// A table of 200 rows: `line` writes the row with this number and time.
fn table(head: &str, step: f64, line: impl Fn(usize, f64) -> String) -> String {
    (0..200).fold(head.to_string(), |text, row| text + &line(row, row as f64 * step) + "\n")
}

fn plain() -> String {
    table("time_s,command_v,force_n\n", 1e-3, |_, time| {
        let [command, force] = sample(time);
        format!("{time:.6},{command:.6},{force:.6}")
    })
}

fn read(
    name: &str,
    text: impl Into<Vec<u8>>,
    declared: RecordedResponse,
) -> Result<SampledPair, Vec<Diagnostic>> {
    let source = Memory::default().with(name, text);
    match sampled_pairs(&source, &[RecordedResponse { file: name.to_string(), ..declared }]) {
        Ok(mut records) => Ok(records.remove(0)),
        Err(IdentifyError::Files(refusal)) => Err(refusal.diagnostics),
        Err(error) => panic!("{error}"),
    }
}

fn accepted(text: impl Into<Vec<u8>>) -> SampledPair {
    read("record.csv", text, RecordedResponse::default()).unwrap_or_else(|found| panic!("{found:?}"))
}

fn refused(text: impl Into<Vec<u8>>) -> Vec<Diagnostic> {
    read("record.csv", text, RecordedResponse::default()).unwrap_err()
}

#[track_caller]
fn same(found: &SampledPair) {
    let plain = accepted(plain());
    assert_eq!((&found.input, &found.output), (&plain.input, &plain.output));
    assert!((found.time_step / plain.time_step - 1.0).abs() < 1e-6, "{}", found.time_step);
}

/// A measurement file of LabVIEW with these signs.
fn labview(separator: char, decimal: &str) -> String {
    let word = if separator == ',' { "Comma" } else { "Tab" };
    let number = |value: f64| format!("{value:.6}").replace('.', decimal);
    let head = format!(
        "LabVIEW Measurement\r\nWriter_Version|2\r\nSeparator|{word}\r\nDecimal_Separator|{decimal}\r\nX_Columns|One\r\nTime|12:00:00{decimal}2\r\n\
         ***End_of_Header***\r\n\r\nNotes|only channel 0 is calibrated\r\nChannels|2||\r\nY_Unit_Label|Volts|Newtons|\r\nX0|0|0|\r\n\
         ***End_of_Header***|||\r\nX_Value|command|force|Comment\r\n"
    );
    let rows = table(&head, 1e-3, |_, time| {
        let [command, force] = sample(time);
        format!("{}|{}|{}|\r", number(time), number(command), number(force))
    });
    rows.replace('|', &separator.to_string())
}

#[test]
fn a_measurement_file_of_labview_is_the_same_record() {
    for (separator, decimal) in [('\t', "."), ('\t', ","), (',', ".")] {
        same(&accepted(labview(separator, decimal)));
    }
    let several = labview('\t', ".").replace("X_Columns\tOne", "X_Columns\tMulti");
    assert!(refused(several)[0].message.contains("X_Columns Multi"));
}

#[test]
fn a_chart_is_refused_as_a_chart() {
    let head = "Current (mA) - Plot 0\tFlow (GPM) - Plot 0\tCurrent (mA) - Plot 1\tFlow (GPM) - Plot 1\n";
    let chart = table(head, 1.0, |row, _| format!("{row}00u\t25.{row}m\t\t"));
    let found = refused(chart);
    assert!(found.len() == 1 && found[0].message.contains("chart") && found[0].line == 1, "{found:?}");
}

/// Columns named by a project are those of a record with its own headings.
#[test]
fn headings_of_another_language_are_chosen_in_the_project() {
    let text = table("Versuch 12;;\nZeit [ms];Stellgr\u{f6}\u{df}e [V];Kraft [kN]\n", 1e-3, |_, time| {
        let [command, force] = sample(time);
        format!("{:.6};{command:.6};{:.9}", 1e3 * time, 1e-3 * force).replace('.', ",")
    });
    let latin: Vec<u8> = text.chars().map(|sign| sign as u8).collect();
    let keys = "[[identify.response]]\nfile = \"m.csv\"\ntime = { column = \"Zeit\" }\ncommand = { column = \"Stellgr\u{f6}\u{df}e\" }\nforce = { column = \"Kraft\" }\n";
    let project = run_command::project_of(&format!("{}\n{keys}", run_command::HOSE), &[]);
    let declared = project.identify.unwrap().responses.remove(0);
    for bytes in [text.clone().into_bytes(), latin] {
        let found = read("m.csv", bytes, declared.clone()).unwrap_or_else(|found| panic!("{found:?}"));
        let plain = accepted(plain());
        assert_eq!(found.input, plain.input);
        let off = found.output.iter().zip(&plain.output).map(|(one, other)| (one - other).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9, "kN of nine decimals");
    }
    assert!(read("m.csv", text, RecordedResponse::default()).is_err());
}

/// Stamps in whole milliseconds, truncated or rounded, of rows that are even.
#[test]
fn rounded_stamps_of_even_rows_are_even() {
    let stamped = |step: f64, stamp: fn(f64) -> f64| {
        table("time_ms,command_v,force_n\n", step, |_, time| {
            let [command, force] = sample(time);
            format!("{},{command:.6},{force:.6}", stamp(1e3 * time + 1e-9))
        })
    };
    for step in [2.5e-3, 0.5e-3, 3.3e-3] {
        for stamp in [f64::floor, f64::round] {
            let found = accepted(stamped(step, stamp));
            assert!((found.time_step / step - 1.0).abs() < 1e-2, "{step} {}", found.time_step);
        }
    }
    // a missing row is not a rounding, and neither are late rows
    let even = stamped(1e-3, f64::round);
    let lines: Vec<&str> = even.lines().collect();
    let missing: String = [&lines[..90], &lines[91..]].concat().join("\n");
    assert!(refused(missing)[0].message.starts_with("2 ms after the row before"));
    let late = table("time_ms,command_v,force_n\n", 1e-2, |row, time| {
        let [command, force] = sample(time);
        format!("{:.0},{command:.6},{force:.6}", 1e3 * time + f64::from(u8::from(row % 3 == 0)) * 4.0)
    });
    // late rows are interpolated between their neighbours, and this is reported
    let found = accepted(late);
    let resampled = found.resampled.expect("late rows");
    assert!((found.time_step - 1e-2).abs() < 1e-5 && (resampled.longest - 1.4e-2).abs() < 1e-9);
}

/// A time of day, with or without a date, even over midnight, is converted to the time since the
/// first row.
#[test]
fn stamps_of_a_clock_are_times() {
    let stamped = |name: &str, stamp: fn(f64) -> String| {
        table(&format!("{name},command_v,force_n\n"), 1e-3, |_, time| {
            let [command, force] = sample(time);
            format!("{},{command:.6},{force:.6}", stamp(time))
        })
    };
    let morning: fn(f64) -> String = |time| format!("10:00:{time:06.3}");
    let midnight: fn(f64) -> String = |time| match time {
        time if time < 0.0995 => format!("23:59:{:06.3}", 59.9 + time),
        time => format!("00:00:{:06.3}", time - 0.1),
    };
    let february: fn(f64) -> String = |time| format!("2024-02-{}", if time < 0.0995 { "28" } else { "29" });
    same(&accepted(stamped("time", morning)));
    same(&accepted(stamped("Time [ms]", morning)));
    same(&accepted(stamped("time", midnight)));
    same(&accepted(stamped("Timestamp", |time| format!("2026-11-27T10:00:{time:06.3}"))));
    same(&accepted(stamped("Date/Time", |time| format!("27.11.2026 10:00:{time:06.3}"))));
    let leap = |time: f64| format!("{}T{}", february(time), midnight(time));
    let rows = (0..200).map(|row| leap(f64::from(row) * 1e-3)).collect::<Vec<_>>();
    let text = stamped("time", |time| format!("row{:.0}", 1e3 * time));
    let dated = |zone: &str| {
        let replaced = |(row, stamp): (usize, &String)| (format!("row{row},"), format!("{stamp}{zone},"));
        rows.iter().enumerate().map(replaced).fold(text.clone(), |text, (from, to)| text.replace(&from, &to))
    };
    same(&accepted(dated("")));
    same(&accepted(dated("Z")));
    same(&accepted(dated("-03:00")));
    let commas = stamped("time", morning).replace(',', ";").replace('.', ",");
    same(&accepted(commas));
    // a number among stamps, and an hour that no day has
    let mixed = refused(stamped("time", morning).replace("10:00:00.050", "0.050"));
    assert!(mixed[0].message.contains("`0.050` is not a number") && mixed[0].line == 52, "{mixed:?}");
    let late = refused(stamped("time", morning).replace("10:00:00.050", "25:00:00.050"));
    assert!(late[0].help.as_deref().unwrap_or("").contains("2026-11-27T10:00:00.001"), "{late:?}");
}

/// A late stamp is named itself, and not the row after it, which is early relative to it.
#[test]
fn the_first_wrong_stamp_is_named() {
    for late in [0.3e-3, 0.9e-3, 2.5e-3] {
        let text = table("time_s,command_v,force_n\n", 1e-3, |row, time| {
            let [command, force] = sample(time);
            let late = if row == 58 { late } else { 0.0 };
            format!("{:.6},{command:.6},{force:.6}", time + late)
        });
        let found = refused(text);
        assert_eq!((found.len(), found[0].line), (1, 60), "{late}: {found:?}");
    }
}

/// A run that is moved at a constant velocity, logged by software: late rows change nothing.
#[test]
fn a_run_of_the_cylinder_may_have_late_rows() {
    let known = KnownCylinder { areas: [1e-3, 8e-4], moving_mass: 10.0 };
    let run = |late: fn(usize) -> f64| {
        let text = table("time_s\tposition_mm\tforce_n\n", 1e-2, |row, time| {
            let time = time + late(row);
            format!("{time:.3}\t{:.6}\t{:.6}", 1e3 * 0.02 * time, -40.0 - 300.0 * time)
        });
        let source = Memory::default().with("run.txt", text);
        friction_recordings(&source, &["run.txt".to_string()], &known).unwrap().remove(0)
    };
    let (even, late) = (run(|_| 0.0), run(|row| [0.0, 1e-3, 3e-3, 0.0, 2e-3][row % 5]));
    assert!((late.time_step / even.time_step - 1.0).abs() < 0.2);
    for run in [&even, &late] {
        for (row, (position, force)) in run.positions.iter().zip(&run.forces).enumerate() {
            let time = row as f64 * run.time_step;
            // ORIGIN: analytic, both are linear in time
            assert!(
                (position - 0.02 * time).abs() < 1e-8 && (force - 40.0 - 300.0 * time).abs() < 1e-4,
                "{row}"
            );
        }
    }
}

/// A file of a scenario that is read in another unit than that in which it was written.
#[test]
fn numbers_that_no_rig_of_this_size_has_are_refused_with_their_unit() {
    let scenario = |keys: &str| {
        format!("{}\n[[scenario]]\nname = \"file\"\nduration = \"0.1 s\"\n{keys}\n", run_command::HOSE)
    };
    let cases = [
        (
            "reference = { kind = \"file\", start = \"0 s\", file = \"f.csv\" }",
            "force_kn",
            "3000",
            "plausible in N",
        ),
        (
            "reference = { kind = \"file\", start = \"0 s\", file = \"f.csv\" }",
            "force_n",
            "3",
            "plausible in kN",
        ),
        (
            "command = { kind = \"file\", start = \"0 s\", file = \"f.csv\" }",
            "voltage_v",
            "4000",
            "plausible in mV",
        ),
        (
            "load_motion = { kind = \"file\", start = \"0 s\", file = \"f.csv\" }\nreference = { at = \"0 s\", force = \"1 kN\" }",
            "position_m",
            "120",
            "plausible in mm",
        ),
    ];
    for (keys, heading, value, remedy) in cases {
        let text = scenario(keys);
        let source = run_command::source(&text)
            .with("f.csv", format!("time_s;{heading}\n0;0\n0.05;{value}\n0.1;{value}\n"));
        let loaded = project::read(&source, "rig.toml", &[], &[]);
        let Ok(loaded) = loaded else { panic!("{keys}: {}", loaded.unwrap_err()) };
        let request = Request::Simulate(SimulateRequest::default());
        let error = phea_workbench::command::answer(&source, &loaded, &[], &request).unwrap_err();
        let found = &error.refusal().unwrap_or_else(|| panic!("{error}")).diagnostics[0];
        assert!(found.message.contains(heading) && found.file == "f.csv" && found.line == 1, "{found:?}");
        assert!(found.help.as_deref().unwrap_or("").contains(remedy), "{found:?}");
    }
}

/// Frequency responses with the headings of analysers and of people give an identical plant.
#[test]
fn a_response_is_read_by_its_usual_headings() {
    let rows = |head: &str, form: fn(f64) -> [f64; 3]| {
        (1..40).fold(head.to_string(), |mut text, k| {
            let [first, second, third] = form(f64::from(k));
            writeln!(text, "{first}\t{second}\t{third}").unwrap();
            text
        })
    };
    let in_hertz: fn(f64) -> [f64; 3] = |k| [k, -2.0 * k, -0.5 * k];
    let nominal = |csv: String| {
        let text = "schema = 1\n[family]\nmeasured = [\"a.csv\"]\n";
        let source = Memory::default().with("p.toml", text).with("a.csv", csv);
        let loaded = project::read(&source, "p.toml", &[], &[]).unwrap();
        let setup = phea_workbench::setup::Setup::new(&loaded.project).unwrap();
        phea_workbench::family::family(&setup, &source)
            .map(|family| format!("{family:?}"))
            .map_err(|error| error.to_string())
    };
    let right = nominal(rows("frequency_hz\tphase_deg\tmagnitude_db\n", in_hertz)).unwrap();
    for head in [
        "Frequency (Hz)\tPhase (degrees)\tGain (dB)\n",
        "Freq(Hz)\tPhase(deg)\tMag(dB)\n",
        "f [Hz]\tphi [deg]\tAmplitude [dB]\n",
    ] {
        assert_eq!(nominal(rows(head, in_hertz)).unwrap(), right, "{head}");
    }
    assert!(nominal(rows("Omega (rad/s)\tPhase (rad)\tGain\n", |k| [k, -0.01 * k, 1.0 / k])).is_ok());
    // each heading that is not read is named in one run
    let all = nominal(rows("Frequency (Hz)\tPhase (deg)\tLautheit (sone)\tQ\n", in_hertz)).unwrap_err();
    assert!(all.contains("Lautheit") && all.contains("`Q`"), "{all}");
    let one = nominal(rows("Frequency (Hz)\tPhase (turns)\tGain (dB)\n", in_hertz)).unwrap_err();
    assert!(one.contains("`turns`") && !one.contains("`Frequency"), "{one}");
}

fn places(text: &str, settings: &[&str], request: &Request) -> Vec<Diagnostic> {
    let error = run_command::try_answer(text, settings, &[], request).map(|answer| answer.text).unwrap_err();
    error.refusal().unwrap_or_else(|| panic!("without a place: {error}")).diagnostics.clone()
}

/// An error that is found only when the rig is computed has the line of its key.
#[test]
fn errors_of_the_computed_rig_have_a_place() {
    let line_of = |text: &str, key: &str| text.lines().position(|line| line.starts_with(key)).unwrap() + 1;
    let tracking = format!(
        "{}\n[[specification]]\nkind = \"tracking\"\nfrequencies = [1, 50]\nlower = {{ numerator = \"10\", denominator = \"s + 10\" }}\nupper = {{ numerator = \"2\", denominator = \"s + 2\" }}\n",
        run_command::HOSE
    );
    let output = run_command::answer(&tracking, &[], &[], &Request::Check).text;
    let line = format!("(line {})", line_of(&tracking, "lower = { numerator = \"10\""));
    assert!(output.contains("limits cross") && output.contains(&line), "{output}");
    let design = Request::Design { seed: None, stages: false, repair: true };
    let found = places(&tracking, &[], &design);
    assert_eq!(found[0].line, line_of(&tracking, "lower = { numerator = \"10\""), "{found:?}");
    // ORIGIN: analytic, 10/|50i + 10| = 0.196 and 2/|50i + 2| = 0.04, most apart at the highest
    // frequency
    assert!(found[0].message.contains("50.00 rad/s") && found[0].message.contains("0.196"), "{found:?}");
    let point = format!(
        "{}\n[operating_point]\nload_force = \"400 kN\"\n",
        without(run_command::HOSE, "operating_point")
    );
    let found = places(&point, &[], &Request::Check);
    assert!(found[0].line >= line_of(&point, "[operating_point]"), "{found:?}");
    let start = format!(
        "{}\n[[scenario]]\nname = \"far\"\nduration = \"0.1 s\"\nreference = {{ at = \"0 s\", force = \"900 kN\" }}\n",
        run_command::HOSE
    );
    let found = places(&start, &[], &Request::Simulate(SimulateRequest::default()));
    assert!(found[0].line > line_of(&start, "duration = \"0.1 s\"") - 3, "{found:?}");
}

/// An absent table that a command needs is reported at the end of the file; one that the command
/// rejects has its line.
#[test]
fn errors_about_absent_tables_have_a_place() {
    let simulate = Request::Simulate(SimulateRequest::default());
    let verify = Request::Verify { proof: false, on_machine: false };
    let design = Request::Design { seed: None, stages: false, repair: true };
    let cases = [
        ("sizing", run_command::size_request(None, None)),
        ("scenario", simulate),
        ("specification", verify.clone()),
        ("specification", design),
        ("controller", verify),
    ];
    for (table, request) in cases {
        let text = without(run_command::HOSE, table);
        let found = places(&text, &[], &request);
        let end = text.lines().count() + usize::from(text.ends_with('\n'));
        assert_eq!(found[0].line, end, "{table}: {found:?}");
        assert!(found[0].message.contains(&format!("[{table}]")), "{found:?}");
    }
    let motor = include_str!("../../../examples/rotary/vane.toml");
    let found = places(motor, &[], &Request::Bench);
    let line = motor.lines().position(|line| line.starts_with("[motor]")).unwrap() + 1;
    assert!(found[0].line == line && found[0].message.contains("is for a [cylinder]"), "{found:?}");
}

/// A project without one of its tables.
fn without(text: &str, table: &str) -> String {
    let mut is_in = false;
    let others = text.lines().filter(|line| {
        if line.starts_with('[') {
            is_in = line.trim_start_matches('[').starts_with(table);
        }
        !is_in
    });
    others.collect::<Vec<_>>().join("\n")
}

/// K_c of the leakiest valve in a data sheet's range is that of a valve with this leakage.
#[test]
fn check_prints_the_slope_of_the_leakiest_valve() {
    let of = |settings: &[&str], name: &str| {
        let check = run_command::json(project::STARTER, settings, &[], &Request::Check);
        run_command::derived(&check, &format!("valve.flow_pressure_coefficient_{name}"))
    };
    for way in ["extending", "retracting"] {
        let most = of(&[], &format!("{way}_maximum"));
        assert_eq!(most.to_bits(), of(&["valve.null_leakage=0.61 gpm"], way).to_bits());
        assert!(most > of(&[], way));
    }
}
