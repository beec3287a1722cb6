//! A campaign's table on the disk: one writer at a time, and no part is written over another.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROJECT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/benchmark/campaign.toml");

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A short campaign of eight runs.
fn campaign(folder: &Path, more: &[&str]) -> Output {
    let settings =
        ["duration=0.1 s", "load_motion.start=0.05 s", "load_motion.duration=20 ms", "reference=[]"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_phea"));
    command.current_dir(folder).args(["campaign", PROJECT, "--runs", "8"]).args(more);
    for setting in settings {
        command.args(["--set", &format!("scenario.0.{setting}")]);
    }
    command.output().expect("phea starts")
}

fn complaint(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A second writer is rejected while the first has the table, leaves it unchanged, and continues as
/// soon as the first has ended.
#[test]
fn a_table_has_one_writer() {
    let folder = folder("campaign_lock");
    assert_eq!(campaign(&folder, &["--out", "out"]).status.code(), Some(0));
    let path = folder.join("out/runs.csv");
    let before = fs::read(&path).expect("a table");
    let first = File::options().read(true).write(true).open(&path).expect("a table");
    first.try_lock().expect("nobody else has it");
    let refused = campaign(&folder, &["--out", "out"]);
    assert_eq!(refused.status.code(), Some(3), "{}", complaint(&refused));
    assert!(
        complaint(&refused).contains("another phea campaign is writing out/runs.csv: wait until it ends")
    );
    assert_eq!(fs::read(&path).expect("a table"), before);
    drop(first);
    let again = campaign(&folder, &["--out", "out"]);
    assert_eq!(again.status.code(), Some(0), "{}", complaint(&again));
    assert_eq!(fs::read(&path).expect("a table"), before);
}

/// A table that was torn on the disk continues to the bytes of an intact one.
#[test]
fn a_torn_table_is_made_whole() {
    let folder = folder("campaign_torn");
    assert_eq!(campaign(&folder, &["--out", "out"]).status.code(), Some(0));
    let path = folder.join("out/runs.csv");
    let whole = fs::read(&path).expect("a table");
    fs::write(&path, &whole[..whole.len() * 2 / 3]).expect("written");
    assert_eq!(campaign(&folder, &["--out", "out"]).status.code(), Some(0));
    assert_eq!(fs::read(&path).expect("a table"), whole);
}

#[test]
fn obstacles_and_impossible_requests_have_plain_messages() {
    let folder = folder("campaign_words");
    fs::write(folder.join("afile"), "").expect("written");
    for (more, status, words) in [
        (["--out", "afile"], 3, "cannot write afile: a file of that name is in the way"),
        (["--threads", "0"], 2, "0 is not in 1.."),
    ] {
        let output = campaign(&folder, &more);
        assert_eq!(output.status.code(), Some(status));
        assert!(complaint(&output).contains(words), "{}", complaint(&output));
    }
}

/// A campaign that is rejected because the project lacks something leaves neither an empty table
/// nor a lock, and a table of another kind remains unchanged.
#[test]
fn a_refused_campaign_leaves_no_table() {
    let folder = folder("campaign_refused");
    let without = PROJECT.replace("campaign.toml", "closed_loop.toml");
    let refused = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_phea"));
        command.current_dir(&folder).args(["campaign", &without, "--runs", "2", "--out", "out"]);
        command.output().expect("phea starts")
    };
    let path = folder.join("out/runs.csv");
    assert_eq!(refused().status.code(), Some(2));
    assert!(!path.exists(), "an empty table");
    fs::write(&path, "").expect("an empty table of one's own");
    assert_eq!(refused().status.code(), Some(2));
    assert!(path.exists(), "it was there before");
}
