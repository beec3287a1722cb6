//! Rows are written as they are computed and never stored in memory: gigabytes of them need the
//! memory of a page.
//!
//! `cargo xtask ci soak` requests it, with `PHEA_KILLS=100`; `--nocapture` prints the bytes
//! written, the time and the memory.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "how fast it was is printed for who asks")]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The benchmark with a row every microsecond: five million of them, of 27 columns.
const FINE: &str = "output_step = \"1 us\"";
const LEAST_BYTES: u64 = 2_000_000_000;
const MOST_MEMORY_KB: u64 = 200_000;

/// The most memory in kB that a process has used so far; `None` once it has ended.
fn most_memory_kb(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
#[ignore = "writes two gigabytes"]
fn rows_are_streamed_to_the_disk() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("streamed_rows");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    let declared = include_str!("../../../examples/benchmark/closed_loop.toml");
    assert!(declared.contains("output_step = \"1 ms\""));
    let project = folder.join("fine.toml");
    fs::write(&project, declared.replace("output_step = \"1 ms\"", FINE)).expect("a project");
    let begun = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_phea"))
        .args(["simulate", "--no-figures", "--out"])
        .args([&folder.join("out"), &project])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("phea starts");
    let mut most = 0;
    let status = loop {
        most = most.max(most_memory_kb(child.id()).unwrap_or(0));
        if let Some(status) = child.try_wait().expect("its status can be read") {
            break status;
        }
        sleep(Duration::from_millis(20));
    };
    let took = begun.elapsed().as_secs_f64();
    assert!(status.success());
    let entries = fs::read_dir(folder.join("out")).expect("a folder");
    let bytes: u64 = entries.map(|entry| entry.unwrap().metadata().unwrap().len()).sum();
    println!(
        "{:.2} GB in {took:.1} s, {:.1} GB a minute, within {:.0} MB",
        bytes as f64 / 1e9,
        bytes as f64 / 1e9 * 60.0 / took,
        most as f64 / 1e3
    );
    fs::remove_dir_all(&folder).expect("it can be removed");
    assert!(bytes >= LEAST_BYTES, "{bytes}");
    assert!((1..=MOST_MEMORY_KB).contains(&most), "{most} kB");
}
