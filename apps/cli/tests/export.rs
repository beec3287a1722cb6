//! `phea export`: files that compile, the exit status, and requests that cannot be met.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A sampled loop that is met, quick to audit, with a limit.
const LOOP: &str = "schema = 1
title = \"Small loop\"
[plant]
numerator = \"k\"
denominator = \"s + 1\"
[uncertainty]
k = { nominal = 1, minimum = 1, maximum = 2, points = 2 }
[controller]
numerator = \"2\"
denominator = \"s\"
sample_time = \"1 ms\"
saturation = \"10 V\"
[[specification]]
kind = \"robust_stability\"
limit = 2.2
frequencies = [1]
band = [0, inf]
";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("loop.toml"), LOOP).unwrap();
    folder
}

fn phea(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_phea"));
    command.current_dir(folder).args(arguments).output().expect("phea starts")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).map(|entries| entries.collect::<Vec<_>>()).unwrap_or_default();
    entries.into_iter().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn the_same_project_gives_the_same_bytes_in_any_folder() {
    let (one, other) = (folder("export_one"), folder("export_other"));
    for kind in ["c", "st", "ros2", "matlab", "python"] {
        let words = ["export", kind, "loop.toml", "--out", kind];
        let outputs = [&one, &other].map(|folder| phea(folder, &words));
        for output in &outputs {
            assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        }
        let written = names(&one.join(kind));
        assert!(!written.is_empty());
        for name in written {
            let [first, second] =
                [&one, &other].map(|folder| fs::read(folder.join(kind).join(&name)).unwrap());
            assert_eq!(first, second, "{name}");
            let text = String::from_utf8(first).unwrap();
            let says =
                text.contains("SHA-256") || ["package.xml", "small_loop_plugin.xml"].contains(&name.as_str());
            assert!(says, "{name}");
            assert!(!text.contains(&*one.to_string_lossy()), "{name}");
        }
    }
}

#[test]
fn the_self_test_passes_and_finds_another_coefficient() {
    let folder = folder("export_self_test");
    assert_eq!(phea(&folder, &["export", "c", "loop.toml", "--out", "c"]).status.code(), Some(0));
    let run = || {
        let line = "cc -std=c99 small_loop.c small_loop_self_test.c example_main.c -o run && ./run";
        Command::new("sh").args(["-c", line]).current_dir(folder.join("c")).output().unwrap()
    };
    let output = run();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let source = folder.join("c/small_loop.c");
    let text = fs::read_to_string(&source).unwrap();
    let changed = text.replacen("clamped(wanted, 0x1.4", "clamped(wanted, 0x1.3", 1);
    assert_ne!(text, changed);
    fs::write(source, changed).unwrap();
    assert_eq!(run().status.code(), Some(1));
}

#[test]
fn a_verdict_that_is_not_met_is_written_with_status_one() {
    let folder = folder("export_violated");
    let words = ["export", "c", "loop.toml", "--out", "c", "--set", "specification.0.limit=1.0001"];
    let output = phea(&folder, &words);
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(folder.join("c/small_loop.h")).unwrap();
    assert!(text.contains("Verdict: violated") && text.contains("specification.0.limit=1.0001"), "{text}");
}

/// Changes of the project by replacement, more words of the command, and what the message contains.
type Refusal =
    (&'static [(&'static str, &'static str)], &'static str, &'static [&'static str], &'static [&'static str]);

const SAMPLE_TIME: &str = "sample_time = \"1 ms\"\n";

const REFUSALS: &[Refusal] = &[
    (&[(SAMPLE_TIME, "")], "c", &[], &["acts continuously", "loop.toml:8:"]),
    (&[(SAMPLE_TIME, "")], "st", &[], &["acts continuously", "sample_time"]),
    (&[(SAMPLE_TIME, "")], "ros2", &[], &["acts continuously"]),
    (&[(SAMPLE_TIME, "")], "matlab", &[], &["acts continuously"]),
    (&[(SAMPLE_TIME, "")], "python", &[], &["acts continuously"]),
    (&[("\"1 ms\"", "\"1.5 ms\"")], "ros2", &[], &["whole number of times", "loop.toml:"]),
    (&[("\"1 ms\"", "\"-1 ms\"")], "c", &[], &["loop.toml:11:"]),
    (&[("\"1 ms\"", "\"1 mm\"")], "c", &[], &["loop.toml:11:"]),
    (&[("Small loop", "")], "c", &[], &["title", "loop.toml:"]),
    (&[("Small loop", "2 loops")], "c", &[], &["begin it with a letter", "loop.toml:2:"]),
    (&[("Small loop", "While")], "c", &[], &["begin it with a letter"]),
    (&[("Small loop", "Reference")], "st", &[], &["begin it with a letter"]),
    (&[("Small loop", "Öl")], "c", &[], &["begin it with a letter"]),
    (&[("Small loop", "_x")], "python", &[], &["begin it with a letter"]),
    (&[("numerator = \"2\"\ndenominator = \"s\"\n", "")], "c", &[], &["controller", "loop.toml:"]),
    (&[("\"2\"\n", "\"s^2\"\n")], "c", &[], &["loop.toml:"]),
    (&[("\"2\"\n", "\"2*\"\n")], "c", &[], &["loop.toml:9:"]),
    (
        &[(
            "[[specification]]\nkind = \"robust_stability\"\nlimit = 2.2\nfrequencies = [1]\nband = [0, inf]\n",
            "",
        )],
        "c",
        &[],
        &["[[specification]]", "loop.toml:"],
    ),
    (&[("saturation", "saturatoin")], "c", &[], &["did you mean `saturation`", "loop.toml:12:"]),
    (&[("schema = 1", "schema = 9")], "c", &[], &["schema", "loop.toml:1:"]),
    (&[("[plant]", "[plant")], "c", &[], &["loop.toml:3:"]),
    (
        &[(
            SAMPLE_TIME,
            "sample_time = \"1 ms\"\nquantization = { coefficients = { integer_bits = 0, fraction_bits = 3 } }\n",
        )],
        "c",
        &[],
        &["loop.toml:"],
    ),
    (
        &[(SAMPLE_TIME, "sample_time = \"1 ms\"\nquantization = { command_bits = 12 }\n")],
        "c",
        &[],
        &["loop.toml:"],
    ),
    (
        &[(
            SAMPLE_TIME,
            "sample_time = \"1 ms\"\nquantization = { command_bits = 99, command_range = [\"-10 V\", \"10 V\"] }\n",
        )],
        "c",
        &[],
        &["loop.toml:"],
    ),
    (
        &[("[[spec", "[prefilter]\nnumerator = \"1\"\ndenominator = \"s + 1\"\ncontinuous = true\n[[spec")],
        "c",
        &[],
        &["acts before the sampler", "loop.toml:"],
    ),
    (&[], "pascal", &[], &["invalid value 'pascal'", "ros2"]),
    (&[], "c", &["--set", "controller.sample_tim=1 ms"], &["sample_time"]),
    (&[], "c", &["--set", "controller.sample_time=soon"], &["soon"]),
    (&[], "c", &["--catalogue", "absent.toml"], &["absent.toml"]),
];

#[test]
fn requests_that_cannot_be_met_are_refused_with_the_place() {
    let folder = folder("export_refusals");
    for (changes, kind, more, expected) in REFUSALS {
        let text = changes.iter().fold(LOOP.to_string(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        fs::write(folder.join("loop.toml"), text).unwrap();
        let output = phea(&folder, &[&["export", kind, "loop.toml", "--out", "out"], *more].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{changes:?} {kind} {more:?}: {message}");
        for words in *expected {
            assert!(message.contains(words), "{changes:?} {kind} {more:?}: {words:?} is not in {message}");
        }
        assert!(!folder.join("out").exists(), "{changes:?}");
    }
}

#[test]
fn folders_that_cannot_be_written_are_refused() {
    let folder = folder("export_folders");
    let refused = |arguments: &[&str], status: i32, words: &str| {
        let output = phea(&folder, arguments);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{message}");
        assert!(message.contains(words), "{message}");
    };
    refused(&["export", "c", "loop.toml"], 2, "--out");
    refused(&["export", "c", "absent.toml", "--out", "out"], 2, "absent.toml");
    refused(&["export", "c", "loop.toml", "--out", "loop.toml"], 3, "loop.toml");
    refused(&["export", "c", "loop.toml", "--out", "loop.toml/c"], 3, "loop.toml");
    assert_eq!(names(&folder), ["loop.toml"]);
    // a disk that is full after the first files
    let script = "trap '' XFSZ; ulimit -f 16; exec \"$0\" export c loop.toml --out full";
    let mut command = Command::new("sh");
    command.current_dir(&folder).args(["-c", script, env!("CARGO_BIN_EXE_phea")]);
    assert_eq!(command.output().unwrap().status.code(), Some(3));
    assert_eq!(names(&folder.join("full")), [] as [String; 0]);
}
