//! Full disk: the exit status reports it, and no incomplete file is left.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Runs the command under a limit on the length of files, in blocks of a shell, 512 or 1024 bytes:
/// writing beyond it fails.
fn limited(folder: &Path, blocks: u32, arguments: &[&str]) -> Output {
    under("trap '' XFSZ; ", folder, blocks, arguments)
}

/// Runs the command after another command in a shell.
fn under(before: &str, folder: &Path, blocks: u32, arguments: &[&str]) -> Output {
    let script = format!("{before}ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command.current_dir(folder).args(["-c", &script, env!("CARGO_BIN_EXE_phea")]).args(arguments);
    command.output().expect("sh starts")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).map(|entries| entries.collect::<Vec<_>>()).unwrap_or_default();
    entries.into_iter().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

#[track_caller]
fn not_written(output: &Output) {
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{complaint}");
    assert!(complaint.contains("error: cannot write"), "{complaint}");
}

/// A table of two thousand rows, and a project that is saved over another.
#[test]
fn a_file_that_does_not_fit_is_absent() {
    let folder = folder("full_disk");
    let closed = format!("{EXAMPLES}/benchmark/closed_loop.toml");
    let simulate = ["simulate", &closed, "--out", "out", "--set", "scenario.0.duration=2 s"];
    for more in [&[] as &[&str], &["--json"]] {
        let output = limited(&folder, 64, &[&simulate, more].concat());
        not_written(&output);
        assert_eq!(names(&folder.join("out")), [] as [String; 0]);
        assert_eq!(String::from_utf8_lossy(&output.stdout).contains("\"errors\""), !more.is_empty());
    }
    // existing files remain unchanged
    fs::write(folder.join("out/step and load motion.csv"), "before").unwrap();
    not_written(&limited(&folder, 64, &simulate));
    let names = names(&folder.join("out"));
    let stored = names.first().map(|name| fs::read_to_string(folder.join("out").join(name)).unwrap());
    assert_eq!((names.len(), stored.as_deref()), (1, Some("before")));
    not_written(&limited(&folder, 1, &["new", "rig"]));
    assert_eq!(self::names(&folder.join("rig")), [] as [String; 0]);
}

/// A file that grows too large is an error of the write and does not end the process, if no one
/// ignores its signal; the message has the folder of a table that is written row by row.
#[test]
fn a_signal_about_a_large_file_is_an_error() {
    let folder = folder("full_disk_signal");
    let closed = format!("{EXAMPLES}/benchmark/closed_loop.toml");
    let simulate = ["simulate", &closed, "--out", "out", "--set", "scenario.0.duration=2 s"];
    let output = under("", &folder, 64, &simulate);
    not_written(&output);
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(complaint.contains("cannot write out/step and load motion.csv"), "{complaint}");
    assert_eq!(names(&folder.join("out")), [] as [String; 0]);
    not_written(&under("", &folder, 1, &["new", "rig"]));
    not_written(&under("", &folder, 1, &["schema", "--out", "editor"]));
    for empty in ["rig", "editor"] {
        assert_eq!(names(&folder.join(empty)), [] as [String; 0]);
    }
}

/// The files of a command receive their names together: if one does not fit, none is there, and
/// those of an earlier run remain.
#[test]
fn all_files_are_absent_if_one_does_not_fit() {
    let folder = folder("full_disk_together");
    let project = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s + 1\"\n[[specification]]\n\
                   kind = \"robust_stability\"\nlimit = 1.2\nfrequencies = [1]\nband = [0, inf]\n";
    fs::write(folder.join("loop.toml"), project).unwrap();
    let design = ["design", "loop.toml", "--out", "out"];
    let whole = Command::new(env!("CARGO_BIN_EXE_phea")).current_dir(&folder).args(design).output().unwrap();
    assert_eq!(whole.status.code(), Some(0), "{}", String::from_utf8_lossy(&whole.stderr));
    let written = names(&folder.join("out"));
    let sizes = written.iter().map(|file| fs::metadata(folder.join("out").join(file)).unwrap().len());
    let (fit, too_long): (Vec<u64>, Vec<u64>) = sizes.partition(|size| *size < 4096);
    assert!(!fit.is_empty() && too_long.iter().any(|size| *size > 8192), "{fit:?} {too_long:?}");
    not_written(&limited(&folder, 8, &["design", "loop.toml", "--out", "none"]));
    assert_eq!(names(&folder.join("none")), [] as [String; 0]);
    for file in &written {
        fs::write(folder.join("out").join(file), "before").unwrap();
    }
    not_written(&limited(&folder, 8, &design));
    let is_unchanged = |file: &String| fs::read_to_string(folder.join("out").join(file)).unwrap() == "before";
    assert!(written.iter().all(is_unchanged) && names(&folder.join("out")).len() == written.len());
}

/// A campaign has complete rows only, and continues once there is room again.
#[test]
fn a_campaign_on_a_full_disk_continues_once_space_is_free() {
    let folder = folder("full_disk_campaign");
    let project = format!("{EXAMPLES}/benchmark/campaign.toml");
    let campaign = |out: &'static str| {
        let short = ["--set", "scenario.0.duration=0.1 s", "--set", "scenario.0.reference=[]"];
        [&["campaign", &project, "--runs", "200", "--out", out], &short[..]].concat().join("\n")
    };
    let text = |out: &str| fs::read_to_string(folder.join(out).join("runs.csv")).unwrap();
    let arguments = campaign("full");
    let arguments: Vec<&str> = arguments.lines().collect();
    not_written(&limited(&folder, 32, &arguments));
    let stored = text("full");
    assert!(stored.is_empty() || stored.ends_with('\n'), "{} bytes", stored.len());
    let whole = campaign("whole");
    for arguments in [arguments, whole.lines().collect()] {
        let output = Command::new(env!("CARGO_BIN_EXE_phea")).current_dir(&folder).args(arguments).output();
        assert_eq!(output.unwrap().status.code(), Some(0));
    }
    assert!(text("full").starts_with(&stored) && text("full") == text("whole"));
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_printed_is_a_failure() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("the device");
    let project = format!("{EXAMPLES}/ybitu/hose.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_phea"));
    let output = command.args(["check", &project]).stdout(full).output().expect("phea starts");
    not_written(&output);
}
