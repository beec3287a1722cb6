//! The exit status of every kind of outcome; with `--json`, standard output has one JSON object and
//! nothing else.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::answer_schema::parsed;

/// A folder with the example project, a binary file, an empty one, and a file instead of a folder.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("only")).expect("a folder");
    let hose = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/ybitu/hose.toml");
    let text = std::fs::read_to_string(hose).expect("the example");
    let plant = "schema = 1\ntitle = \"x\"\n[plant]\nnumerator = \"1\"\ndenominator = \"s + 1\"\n";
    let (head, tail) = text.split_once("[sizing]").expect("it has a [sizing]");
    let tail = tail.split_once("[uncertainty]").expect("and an [uncertainty]").1;
    let closed = format!(
        "{plant}[controller]\nnumerator = \"1\"\ndenominator = \"s\"\n[[specification]]\nkind = \"robust_stability\"\n\
         limit = 1.2\nfrequencies = [1]\nband = [0, inf]\n"
    );
    let measured = "schema = 1\n[family]\nmeasured = [\"drive.csv\", \"absent.csv\"]\n";
    let rows = "frequency_hz,magnitude_db,phase_deg\n1,0,0\n2,loud,0\n3,0,0,0\n";
    let timed = closed.replace("numerator = \"1\"\ndenominator = \"s\"\n[[", "sample_time = \"1 ms\"\n[[");
    // nothing that takes long
    let (driven, _) = text.split_once("[design]").expect("it has a [design]");
    let files: [(&str, &[u8]); 11] = [
        ("driven.toml", driven.as_bytes()),
        ("timed.toml", timed.as_bytes()),
        ("measured.toml", measured.as_bytes()),
        ("drive.csv", rows.as_bytes()),
        ("hose.toml", text.as_bytes()),
        ("only/hose.toml", text.as_bytes()),
        ("unsized.toml", &[head.as_bytes(), b"[uncertainty]", tail.as_bytes()].concat()),
        ("plant.toml", plant.as_bytes()),
        ("loop.toml", closed.as_bytes()),
        ("binary.toml", &[0xff, 0xfe, 0x00, 0x9c]),
        ("empty.toml", b""),
    ];
    for (name, bytes) in files {
        std::fs::write(folder.join(name), bytes).expect("a file");
    }
    folder
}

fn phea(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_phea"));
    command.current_dir(folder).args(arguments).output().expect("phea starts")
}

const OUTCOMES: &[(&[&str], i32)] = &[
    (&["check", "hose.toml"], 0),
    (&["check", "plant.toml"], 0),
    (&["size", "hose.toml"], 1),
    (&["size", "hose.toml", "--set", "line.working_pressure=140 bar"], 0),
    (&["size", "hose.toml", "--gain", "0.00025", "--set", "line.working_pressure=140 bar"], 0),
    (&["size", "hose.toml", "--length", "1.5 m", "--set", "line.working_pressure=140 bar"], 0),
    (&["linearize", "hose.toml"], 0),
    (&["report", "driven.toml", "--out", "out"], 0),
    (&["verify", "hose.toml"], 1),
    (&["verify", "hose.toml", "--set", "controller.numerator=\"1000\""], 1),
    (&["verify", "loop.toml"], 0),
    (&["verify", "plant.toml"], 2),
    (&["shape", "loop.toml"], 0),
    (&["shape", "plant.toml", "--add", "{ kind = \"integrator\" }", "--remove", "1"], 0),
    (&["shape", "loop.toml", "--pass", "gain through -6 dB at 1", "--save", "saved/shaped.toml"], 0),
    (&["shape", "loop.toml", "--prefilter", "--add", "{ kind = \"pole\", frequency = 3 }"], 0),
    (&["shape", "plant.toml", "--prefilter"], 2),
    (&["shape", "loop.toml", "--add", "lead"], 2),
    (&["shape", "loop.toml", "--remove", "2"], 2),
    (&["shape", "loop.toml", "--move", "-1=1"], 2),
    (&["shape", "loop.toml", "--pass", "pole through +20 deg at 1"], 2),
    (&["shape", "loop.toml", "--save", "empty.toml/shaped.toml"], 3),
    (&["check", "timed.toml"], 0),
    (&["verify", "timed.toml"], 2),
    (&["design", "plant.toml"], 2),
    (&["design", "loop.toml", "--seed", "-1"], 2),
    (&["design", "loop.toml", "--set", "design.seeed=2"], 2),
    (&["alternatives", "hose.toml"], 2),
    (
        &[
            "alternatives",
            "loop.toml",
            "--set",
            "alternative=[{ name = \"b\", set = { \"plant.denominator\" = \"s + 2\" } }]",
        ],
        0,
    ),
    (
        &[
            "alternatives",
            "loop.toml",
            "--set",
            "alternative=[{ name = \"b\", set = { \"plant.denominatr\" = \"s + 2\" } }]",
        ],
        2,
    ),
    (
        &[
            "check",
            "loop.toml",
            "--set",
            "alternative=[{ name = \"b\", set = { \"plant.denominatr\" = \"s + 2\" } }]",
        ],
        2,
    ),
    (&["size", "hose.toml", "--gain", "0.0005 V/N"], 1),
    (&["size", "hose.toml", "--length", "200 cm"], 1),
    (&["size", "hose.toml", "--set", "sizing.oil_velocity=[0.1, 0.2]"], 1),
    (&["size", "hose.toml", "--gain", "-1"], 2),
    (&["size", "hose.toml", "--gain", "0"], 2),
    (&["size", "hose.toml", "--gain", "nan"], 2),
    (&["size", "hose.toml", "--length", "3 bar"], 2),
    (&["size", "hose.toml", "--length", "1 m", "--gain", "1"], 2),
    (&["campaign", "hose.toml", "--runs", "2,5"], 2),
    (&["size", "unsized.toml"], 2),
    (&["size", "plant.toml"], 2),
    (&["linearize", "plant.toml"], 2),
    (&["report", "plant.toml"], 2),
    (&["check", "measured.toml"], 2),
    (&["check", "missing.toml"], 2),
    (&["check", "only"], 2),
    (&["check", "binary.toml"], 2),
    (&["check", "empty.toml"], 2),
    (&["check", "hose.toml", "--set", "supply.pressure=70 mm"], 2),
    (&["check", "hose.toml", "--set", "supply.presure=70 bar"], 2),
    (&["check", "hose.toml", "--set", "nonsense"], 2),
    (&["check", "hose.toml", "--catalogue", "nowhere"], 2),
    (&["check", "hose.toml", "--catalogue", "hose.toml"], 2),
    (&["check", "hose.toml", "--out", "empty.toml"], 3),
    (&["report", "hose.toml", "--out", "empty.toml/sub"], 3),
    // options for another kind of recording, and a line that does not exist
    (&["identify", "--of", "friction", "hose.toml", "drive.csv", "--starts", "3"], 2),
    (&["identify", "--of", "line", "hose.toml", "drive.csv", "--leakage-model", "one_curve"], 2),
    (&["identify", "--of", "response", "drive.csv", "--side", "B"], 2),
    (&["identify", "drive.csv", "--period", "2 s"], 2),
    (&["identify", "--of", "line", "hose.toml", "drive.csv", "--side", "C"], 2),
    (&["check", "hose.toml", "--frobnicate"], 2),
    (&["check"], 2),
    (&["chek", "hose.toml"], 2),
];

/// Each outcome is run once, as a program would request it; for people, the text on standard error
/// and the status are identical.
#[test]
fn every_outcome_has_its_exit_status_and_one_json_object() {
    let folder = folder("exit_status");
    for (arguments, expected) in OUTCOMES {
        let output = phea(&folder, &[arguments, ["--json"].as_slice()].concat());
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(*expected), "{arguments:?}: {complaint}");
        assert_eq!(complaint.contains("error: "), *expected >= 2, "{arguments:?}: {complaint}");
        assert!(!complaint.contains("panicked"), "{arguments:?}: {complaint}");
        let object = parsed(&String::from_utf8(output.stdout).expect("text"));
        for key in ["schema", "version", "command", "project_sha256"] {
            assert!(object.get(key).is_some(), "{arguments:?} lacks {key}");
        }
        let refused = object.get("errors").and_then(serde_json::Value::as_array);
        assert_eq!(refused.is_some_and(|errors| !errors.is_empty()), *expected >= 2, "{arguments:?}");
    }
}

/// A refusal is printed to standard error only, and an answer to standard output.
#[test]
fn a_refusal_is_printed_on_standard_error() {
    let folder = folder("people");
    let outcomes: [(&[&str], i32); 7] = [
        (&["check", "plant.toml"], 0),
        (&["size", "hose.toml", "--length", "200 cm"], 1),
        (&["verify", "plant.toml"], 2),
        (&["check", "missing.toml"], 2),
        (&["check", "binary.toml"], 2),
        (&["check", "hose.toml", "--out", "empty.toml"], 3),
        (&["chek", "hose.toml"], 2),
    ];
    for (arguments, expected) in outcomes {
        let output = phea(&folder, arguments);
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(expected), "{arguments:?}: {complaint}");
        assert_eq!(output.stdout.is_empty(), expected >= 2, "{arguments:?}");
        assert_eq!(complaint.contains("error: "), expected >= 2, "{arguments:?}: {complaint}");
    }
}

/// An error in a measured response is reported with its place, to people and to programs.
#[test]
fn a_bad_row_of_a_measurement_has_its_place() {
    let folder = folder("measurement");
    let output = phea(&folder, &["check", "measured.toml", "--json"]);
    let object = parsed(&String::from_utf8(output.stdout).expect("text"));
    let rows: Vec<_> = object["errors"].as_array().expect("a list").iter().collect();
    let place = |row: &serde_json::Value| (row["file"].clone(), row["line"].as_u64(), row["column"].as_u64());
    let places: Vec<_> = rows.iter().map(|row| place(row)).collect();
    let csv = |line, column| ("drive.csv".into(), Some(line), Some(column));
    assert_eq!(places, [csv(3, 3), csv(4, 1), ("absent.csv".into(), None, None)]);
    assert_eq!(
        (&rows[0]["message"], &rows[0]["expected"]),
        (&"`loud` is not a number".into(), &"a number in dB".into())
    );
    assert!(object["project_sha256"].is_string());
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(complaint.contains("--> drive.csv:3:3"), "{complaint}");
}

/// Changes are made in the order of the command line; the file is written to the stated path, and
/// is identical if nothing changes.
#[test]
fn shape_writes_the_requested_files_only() {
    let folder = folder("shape");
    let text = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a text");
    let before = text("loop.toml");
    let pole = "{ kind = \"pole\", frequency = 3 }";
    let zero = "{ kind = \"zero\", frequency = 9 }";
    let saved = |arguments: &[&str]| {
        let output = phea(&folder, &[&["shape", "loop.toml", "--save", "new.toml"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        text("new.toml")
    };
    assert_eq!(saved(&[]), before);
    let one = saved(&["--add", pole, "--add", zero, "--remove", "2"]);
    assert!(one.contains("kind = \"zero\"") && !one.contains("kind = \"pole\""), "{one}");
    let other = saved(&["--add", zero, "--remove", "2", "--add", pole]);
    assert!(other.contains("kind = \"pole\"") && !other.contains("kind = \"zero\""), "{other}");
    let files = |of: &str| {
        let mut names: Vec<_> = std::fs::read_dir(folder.join(of))
            .expect("a folder")
            .map(|file| file.expect("a file").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    };
    let there = files(".");
    assert_eq!(phea(&folder, &["shape", "loop.toml", "--add", pole]).status.code(), Some(0));
    assert_eq!((text("loop.toml"), files(".")), (before.clone(), there));
    assert_eq!(phea(&folder, &["shape", "loop.toml", "--out", "out"]).status.code(), Some(0));
    assert_eq!(files("out"), ["margins.csv", "shaped.toml"]);
    // a project is not overwritten; the new one is written next to it
    let here = ["shape", "loop.toml", "--add", pole, "--save", "loop.toml"];
    assert_eq!((phea(&folder, &here).status.code(), text("loop.toml")), (Some(2), before));
    assert_eq!(saved(&["--add", pole]).matches(r#"{ kind = "pole", frequency = "3 rad/s" }"#).count(), 1);
}

#[test]
fn a_closed_pipe_is_no_error() {
    let folder = folder("pipe");
    let mut child = Command::new(env!("CARGO_BIN_EXE_phea"))
        .current_dir(&folder)
        .args(["linearize", "hose.toml", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("phea starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("phea ends");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Ctrl-C during the runs: completed runs are stored, and repeating the command leads to the bytes
/// of a campaign that was never interrupted.
#[cfg(unix)]
#[test]
fn a_campaign_continues_after_ctrl_c() {
    let folder = folder("ctrl_c");
    let campaign = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/benchmark/campaign.toml");
    std::fs::copy(campaign, folder.join("campaign.toml")).expect("the example");
    let arguments = |out: &str, runs: usize| -> Vec<String> {
        let (short, runs) = ("scenario.0.duration=0.1 s", runs.to_string());
        ["campaign", "campaign.toml", "--set", short, "--runs", &runs, "--out", out]
            .map(String::from)
            .to_vec()
    };
    let mut child = Command::new(env!("CARGO_BIN_EXE_phea"))
        .current_dir(&folder)
        .args(arguments("stopped", 200_000))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("phea starts");
    let table = |out: &str| std::fs::read_to_string(folder.join(out).join("runs.csv")).unwrap_or_default();
    while table("stopped").lines().count() < 2 {
        assert!(child.try_wait().expect("its status can be read").is_none(), "it ended before the signal");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(killed.success());
    assert_eq!(child.wait().expect("phea ends").code(), Some(1));
    let stored = table("stopped");
    let rows = stored.lines().count() - 1;
    assert!(rows > 0 && rows < 200_000 && stored.ends_with('\n'), "{rows} rows");
    for out in ["stopped", "whole"] {
        let arguments = arguments(out, rows + 10);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        assert_eq!(phea(&folder, &arguments).status.code(), Some(0), "{out}");
    }
    assert!(table("stopped").starts_with(&stored) && table("stopped") == table("whole"));
}

#[test]
fn new_writes_a_valid_project_and_replaces_none() {
    let folder = folder("new");
    assert_eq!(phea(&folder, &["new", "rig"]).status.code(), Some(0));
    // the user must state the working pressure of the hose
    let stated = ["--set", "line.working_pressure=140 bar"];
    for command in ["check", "size", "linearize"] {
        let arguments = [&[command, "rig/project.toml"], &stated[..]].concat();
        assert_eq!(phea(&folder, &arguments).status.code(), Some(0), "{command}");
    }
    assert_eq!(phea(&folder, &["new", "rig"]).status.code(), Some(2));
    assert_eq!(phea(&folder, &["new", "empty.toml"]).status.code(), Some(2));
}
