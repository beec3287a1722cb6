//! Benchmark of proofs for the rig of the examples on one core: `taskset -c 0 cargo bench -p
//! phea-workbench --bench proof`.
//!
//! The published controller and two designs, continuous and sampled: seconds of the search, of the
//! proof and of checking its certificate again, leaves, bytes. Every claim about a design must be
//! proven, or the bench fails. Times are printed and never asserted.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::process::ExitCode;
use std::time::Instant;

use phea_qft::proof::ClaimStatus;
use phea_workbench::audit::{CERTIFICATE_FILE, audit_problem, check_certificate, prove_audit};
use phea_workbench::command::{self, Request};
use phea_workbench::project;
use phea_workbench::robust::robust_problem;
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

/// Number of runs of each; the fastest counts.
const RUNS: usize = 5;

type Failure = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    println!("search s, proof s, check s, leaves, bytes");
    let sampled = ["controller.sample_time=1 ms", "controller.delay=0.5 ms"];
    let tasks: [(&str, bool, &[&str]); 4] = [
        ("published", false, &[]),
        ("published, sampled at 1 kHz", false, &sampled),
        ("designed", true, &[]),
        ("designed, sampled at 1 kHz", true, &sampled),
    ];
    let mut all_well = true;
    for (name, is_designed, settings) in tasks {
        if let Err(problem) = measured(name, is_designed, settings) {
            eprintln!("{name}: {problem}");
            all_well = false;
        }
    }
    if all_well { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn measured(name: &str, is_designed: bool, settings: &[&str]) -> Result<(), Failure> {
    let mut text = HOSE.to_string();
    let mut settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    if is_designed {
        let source = Memory::default().with("rig.toml", text.as_str());
        let loaded = project::read(&source, "rig.toml", &settings, &[])?;
        let request = Request::Design { seed: None, stages: false, repair: false };
        let designed = command::answer(&source, &loaded, &[], &request)?;
        let file = designed.files.iter().find(|file| file.name == "designed.toml");
        text = String::from_utf8(file.ok_or("no design")?.bytes.clone())?;
        settings.clear();
    }
    let source = Memory::default().with("rig.toml", text.as_str());
    let loaded = project::read(&source, "rig.toml", &settings, &[])?;
    let setup = Setup::new(&loaded.project)?;
    let problem = robust_problem(&source, &setup)?;
    let (search_s, view) = fastest(|| Ok(audit_problem(&problem, &mut |_| true)?))?;
    let (proof_s, view) = fastest(|| {
        let mut view = view.clone();
        prove_audit(&problem, &mut view, &mut |_| true)?;
        Ok(view)
    })?;
    let request = Request::Verify { proof: true, on_machine: false };
    let answer = command::answer(&source, &loaded, &[], &request)?;
    let file = answer.files.iter().find(|file| file.name == CERTIFICATE_FILE).ok_or("no certificate")?;
    let certificate = String::from_utf8(file.bytes.clone())?;
    let (check_s, checked) = fastest(|| Ok(check_certificate(&certificate)?.affirmative))?;
    let proof = view.proof.as_ref().ok_or("nothing is proven")?;
    let leaves = proof.certificate.as_ref().map_or(0, |certificate| certificate.leaves());
    println!("{search_s:.3}, {proof_s:.3}, {check_s:.3}, {leaves}, {}: {name}", certificate.len());
    let each = proof.specifications.iter().map(|own| &own.claim_status);
    let is_proven = std::iter::once(&proof.stability).chain(each).all(|one| *one == ClaimStatus::Proven);
    if !checked || (is_designed && !is_proven) {
        return Err("not everything is proven".into());
    }
    Ok(())
}

/// The shortest time, and the last result.
fn fastest<T>(run: impl Fn() -> Result<T, Failure>) -> Result<(f64, T), Failure> {
    let mut least = f64::INFINITY;
    let mut last = None;
    for _ in 0..RUNS {
        let begun = Instant::now();
        last = Some(run()?);
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Ok((least, last.ok_or("no run")?))
}
