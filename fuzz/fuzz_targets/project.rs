//! Any bytes as a project file: the reader neither panics nor hangs, and what it accepts it prints
//! and reads again.
//!
//! `cargo +nightly fuzz run project crates/project/tests/malformed crates/project/tests/valid`

#![no_main]

use libfuzzer_sys::fuzz_target;
use phea_workbench::project;
use phea_workbench::source::Memory;

fuzz_target!(|bytes: &[u8]| {
    match project::read(&Memory::default().with("x.toml", bytes), "x.toml", &[], &[]) {
        Ok(loaded) => {
            let text = project::print(&loaded.project);
            let again = project::read(&Memory::default().with("y.toml", text), "y.toml", &[], &[]);
            assert!(again.is_ok_and(|again| again.project == loaded.project));
        }
        Err(report) => assert!(!report.to_string().is_empty()),
    }
});
