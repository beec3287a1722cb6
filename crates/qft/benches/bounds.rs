//! Bounds of ten thousand plants compared with NumPy, one core each, in one run:
//! `cargo bench -p phea-qft --bench bounds`.
//!
//! The peer is `benches/peers/bounds.py`, run by the Python in `target/venv` (made by
//! `cargo xtask ci comparisons`) or the one named by `PHEA_PYTHON`. Both evaluate the plants k a/(s
//! (s + a)) and bound them at common phases; every value of the peer is compared, and a difference
//! fails the bench. Times are printed and never asserted.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable;
use phea_qft::bound::{BoundError, BoundFunction, GainIntervals, TemplateFill};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::template::{Resolution, Template, TemplatePoint};

/// Number of values of k and of a.
const SIDE: u32 = 100;

/// Number of runs here, together about as long as one of the peer: on a shared machine a short run
/// is either undisturbed or not.
const RUNS: usize = 50;

/// Number of runs of the peer, timed by its processor time. The fastest run of each side counts.
const PEER_RUNS: usize = 9;

/// Requirement, frequencies in rad/s, number of phases, and the matching drivers of the peer.
struct Task {
    name: &'static str,
    drivers: &'static [&'static str],
    requirement: Requirement,
    frequencies: &'static [f64],
    phases: u32,
}

fn main() -> ExitCode {
    let tasks = match tasks() {
        Ok(tasks) => tasks,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    println!(
        "{} plants, one core each, fastest of {RUNS} runs and of {PEER_RUNS} of the peer\n",
        SIDE * SIDE
    );
    let compared: Vec<bool> = tasks.iter().map(compare).collect();
    if compared.into_iter().all(|agreed| agreed) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn tasks() -> Result<[Task; 2], phea_dynamics::linear::LinearError> {
    let rational = |numerator: &[f64], denominator: &[f64]| {
        let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
        Ok(Limit::Rational(TransferFunction::from_polynomials(
            &polynomial(numerator),
            &polynomial(denominator),
        )?))
    };
    Ok([
        Task {
            name: "margin",
            drivers: &["margin", "margin_by_phase"],
            requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)),
            frequencies: &[0.1, 0.5, 1.0, 2.0, 15.0, 100.0],
            phases: 361,
        },
        Task {
            name: "tracking",
            drivers: &["tracking"],
            requirement: Requirement::tracking(
                rational(&[120.0], &[1.0, 17.0, 82.0, 120.0])?,
                rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752])?,
            ),
            frequencies: &[0.1, 0.5, 1.0, 2.0],
            phases: 73,
        },
    ])
}

/// Runs both, prints times and ratio; returns true if all values agree.
fn compare(task: &Task) -> bool {
    let (mut seconds, mut bounds) = (f64::INFINITY, Vec::new());
    for _ in 0..RUNS {
        let start = Instant::now();
        match task.frequencies.iter().map(|&frequency| bound(task, frequency)).collect() {
            Ok(found) => bounds = found,
            Err(error) => {
                eprintln!("{}: {error}", task.name);
                return false;
            }
        }
        seconds = seconds.min(start.elapsed().as_secs_f64());
    }
    println!(
        "{:>10.2} ms  phea, {}: {} frequencies, {} phases",
        seconds * 1e3,
        task.name,
        task.frequencies.len(),
        task.phases
    );
    let ours: Vec<GainIntervals> = bounds.into_iter().flatten().collect();
    task.drivers.iter().all(|driver| compare_with_peer(task, driver, seconds, &ours))
}

/// Compares with one driver.
fn compare_with_peer(task: &Task, driver: &str, seconds: f64, ours: &[GainIntervals]) -> bool {
    let mut fastest = f64::INFINITY;
    let mut values = Vec::new();
    for _ in 0..PEER_RUNS {
        match peer(driver, task.phases) {
            Ok((seconds, found)) => {
                fastest = fastest.min(seconds);
                values = found;
            }
            Err(problem) => {
                eprintln!("{driver}: {problem}");
                return false;
            }
        }
    }
    let differences: Vec<f64> =
        ours.iter().zip(&values).map(|(ours, theirs)| difference_db(ours, theirs)).collect();
    let greatest = differences.iter().copied().fold(0.0, f64::max);
    println!(
        "{:>10.2} ms  NumPy, {driver}: {:.1} times as long; {} bounds, greatest difference {greatest:.1e} dB",
        fastest * 1e3,
        fastest / seconds,
        differences.len(),
    );
    // A bisection from 1 dB in 24 steps ends within 1e-7 dB.
    let agreed = values.len() == ours.len() && greatest < 1e-6;
    if !agreed {
        eprintln!("{driver}: {} bounds here, {} there, and they differ", ours.len(), values.len());
    }
    agreed
}

/// Evaluates the plants at a frequency and bounds them at phases from 0 to -360 degrees.
fn bound(task: &Task, frequency: f64) -> Result<Vec<GainIntervals>, BoundError> {
    let one = Complex64::new(1.0, 0.0);
    let s = Complex64::new(0.0, frequency);
    let value = |index: u32| 1.0 + 9.0 * f64::from(index) / f64::from(SIDE - 1);
    let response = |k: f64, a: f64| k * a / (s * (s + a));
    let points = (0..SIDE * SIDE).map(|index| TemplatePoint {
        member: Some(index as usize),
        values: Vec::new(),
        response: response(value(index % SIDE), value(index / SIDE)),
        load_motion: one,
        sensor: one,
    });
    let template = Template {
        frequency_rad_per_s: frequency,
        nominal: response(1.0, 1.0),
        points: points.collect(),
        outlines: Vec::new(),
        resolution: Resolution::Members,
    };
    let function = BoundFunction::new(&template, &task.requirement, TemplateFill::Points)?;
    let phase = |index: u32| -TAU * f64::from(index) / f64::from(task.phases - 1);
    Ok((0..task.phases).map(|index| function.forbidden(phase(index))).collect())
}

/// Greatest difference between the outer ends of a union and the values of the peer: one value is
/// the upper end, two are both.
fn difference_db(ours: &GainIntervals, theirs: &[f64]) -> f64 {
    let mut ends = ours.intervals().iter().flatten().map(|gain| 20.0 * portable::log10(*gain));
    let ours = [ends.next(), ends.next_back()];
    let paired = ours.iter().skip(2_usize.saturating_sub(theirs.len())).zip(theirs);
    paired.fold(0.0, |most, (ours, theirs)| match ours {
        Some(ours) => f64::max(most, (ours - theirs).abs()),
        None if theirs.is_nan() => most,
        None => f64::INFINITY,
    })
}

/// Processor time, s, and the bounds, dB, of the peer.
fn peer(driver: &str, phases: u32) -> Result<(f64, Vec<Vec<f64>>), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join("..");
    let usual = root.join("target").join("venv").join("bin").join("python");
    let python = std::env::var_os("PHEA_PYTHON").map_or(usual, PathBuf::from);
    let output = Command::new(&python)
        .arg(root.join("benches").join("peers").join("bounds.py"))
        .args([driver, &SIDE.to_string(), &phases.to_string()])
        .env("OMP_NUM_THREADS", "1")
        .output()
        .map_err(|error| format!("cannot run {}: {error}", python.display()))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut lines = text.lines();
    let seconds = lines.next().and_then(|line| line.parse().ok());
    let Some(seconds) = seconds else {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    };
    let numbers = |line: &str| line.split(' ').map(str::parse).collect::<Result<Vec<f64>, _>>();
    let values = lines.map(numbers).collect::<Result<_, _>>().map_err(|error| error.to_string())?;
    Ok((seconds, values))
}
