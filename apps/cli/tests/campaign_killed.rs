//! Campaigns that are killed at any time continue to the bytes of one that was never killed.
//!
//! The kill signal cannot be caught (SIGKILL). The test command sends twelve; `PHEA_KILLS=100`
//! sends a hundred, and prints with `--nocapture` the number of rows that each left and the seconds
//! of work that were lost.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "what went is printed for who asks")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const PROJECT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/benchmark/campaign.toml");
const KILLS: usize = 12;
const RUNS: usize = 400;

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("campaign_killed");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn campaign(folder: &Path, threads: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_phea"))
        .args(["campaign", PROJECT, "--runs", &RUNS.to_string(), "--threads", threads, "--out"])
        .arg(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("phea starts")
}

/// Every file of a campaign with its bytes, except those that a killed process left incomplete.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    let whole = entries.filter(|path| !name(path).ends_with(".part"));
    let mut files: Vec<(String, Vec<u8>)> =
        whole.map(|path| (name(&path), fs::read(&path).expect("a file"))).collect();
    files.sort();
    files
}

/// Number of runs whose rows are on the disk, in the table or ahead of it.
fn rows(folder: &Path) -> usize {
    let lines = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_default();
    let (table, ahead) = (lines("runs.csv"), lines("runs.csv.ahead"));
    let whole = table.matches('\n').count();
    let run = |line: &str| line.split(',').next().and_then(|run| run.parse::<usize>().ok());
    let beyond = ahead.lines().filter_map(run).filter(|run| *run + 1 >= whole);
    whole.saturating_sub(1) + beyond.collect::<std::collections::BTreeSet<_>>().len()
}

/// Fraction between 0 and 1, spread evenly over all starts: multiples of the golden section.
fn spread(start: u32) -> f64 {
    (f64::from(start) * 0.5 * (5.0_f64.sqrt() - 1.0)).fract()
}

/// Files with their final names are complete after any kill, and repeating the command produces all
/// of them.
#[test]
fn a_campaign_continues_after_any_kill_to_the_same_bytes() {
    let folder = folder();
    let requested = std::env::var("PHEA_KILLS").ok().and_then(|text| text.parse().ok());
    let begun = Instant::now();
    assert!(campaign(&folder.join("whole"), "1").wait().expect("phea ends").success());
    let took = begun.elapsed().as_secs_f64();
    let whole = files(&folder.join("whole"));
    let (mut kills, mut starts) = (0, 0);
    while kills < requested.unwrap_or(KILLS) {
        let threads = ["1", "2", "4"][kills % 3];
        let out = folder.join("killed");
        let _ = fs::remove_dir_all(&out);
        loop {
            let before = rows(&out);
            let begun = Instant::now();
            let mut child = campaign(&out, threads);
            starts += 1;
            sleep(Duration::from_secs_f64(0.6 * took * spread(starts)));
            let ended = child.try_wait().expect("its status can be read").is_some();
            child.kill().expect("it can be killed");
            let (ran, _) = (begun.elapsed().as_secs_f64(), child.wait().expect("it is gone"));
            if ended {
                break;
            }
            kills += 1;
            let stored = rows(&out);
            assert!(stored >= before, "{stored} rows after {before}");
            let lost = ran - (stored - before) as f64 * took / RUNS as f64;
            println!(
                "kill {kills}, {threads} threads, {ran:.2} s: {stored} of {RUNS} rows, {lost:.2} s more than they take"
            );
            for (name, bytes) in files(&out).iter().filter(|(name, _)| !name.starts_with("runs.csv")) {
                assert!(whole.contains(&(name.clone(), bytes.clone())), "{name} is not whole");
            }
        }
        assert!(files(&out) == whole, "after kill {kills}, on {threads} threads");
    }
}
