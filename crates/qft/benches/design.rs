//! Example D compared with differential evolution in NumPy, one core each, in one run:
//! `cargo bench -p phea-qft --bench design`.
//!
//! Plant P = k a/(s (s + a)): the controller of one zero and two real or complex poles with the
//! least high-frequency gain, from three seeds. The peer is `benches/peers/design.py`, run by the
//! Python in `target/venv` (made by `cargo xtask ci comparisons`) or the one named by
//! `PHEA_PYTHON`. The design of phea must pass its audit over the whole box and be within 0.1 dB of
//! the least gain; the peer evaluates only 81 plants and 180 frequencies, and so may find less.
//! Times are printed and never asserted.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use phea_dynamics::controller::Timing;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::pieces::Workers;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::design::quantization::CoefficientFormat;
use phea_qft::design::{
    ControllerChoice, Design, DesignOptions, DesignProblem, DesignStatus, Objective, PoleRange,
    PrefilterChoice, design,
};
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::TOLERANCE_DB;

type Failure = Box<dyn std::error::Error>;

/// Number of runs from each seed here; the fastest counts.
const RUNS: usize = 5;

/// Allowed distance of a result from the least gain, dB.
const ALLOWED_DB: f64 = 0.1;

/// Problem for both sides: its name at the peer, the damping ratios of the poles, and the least
/// gain found by a dense search over the whole box.
struct Task {
    poles: &'static str,
    damping_ratio: [f64; 2],
    least_db: f64,
}

// ORIGIN: recomputed by comparisons/recompute_design.py over the whole box
const TASKS: [Task; 2] = [
    Task { poles: "real", damping_ratio: [1.0, 5.0], least_db: 130.148 },
    Task { poles: "complex", damping_ratio: [0.1, 5.0], least_db: 128.792 },
];

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<bool, Failure> {
    let problem = servo()?;
    println!("one core each, fastest of {RUNS} runs here and one of the peer, by its processor time\n");
    let mut all_reached = true;
    for task in &TASKS {
        for seed in 1..=3 {
            all_reached &= compare_with_peer(task, &problem, seed)?;
        }
    }
    Ok(all_reached)
}

/// Runs both from one seed, prints times, gains and ratio; returns true if phea's result meets the
/// limits with nearly the least gain.
fn compare_with_peer(task: &Task, problem: &DesignProblem, seed: u64) -> Result<bool, Failure> {
    let (seconds, design) = timed(task, problem, seed)?;
    println!(
        "{seconds:>10.3} s  phea, {} poles, seed {seed}: {:.3} dB, {:?} after {} rounds",
        task.poles,
        design.objective_db,
        design.status,
        design.rounds.len()
    );
    let (peer_seconds, gain_db) = peer(task.poles, seed)?;
    println!(
        "{peer_seconds:>10.3} s  NumPy, {} poles, seed {seed}: {gain_db:.3} dB; {:.0} times as long",
        task.poles,
        peer_seconds / seconds
    );
    let is_reached =
        design.status == DesignStatus::Met && (design.objective_db - task.least_db).abs() < ALLOWED_DB;
    if !is_reached {
        eprintln!("{} poles, seed {seed}: the least gain is {} dB", task.poles, task.least_db);
    }
    Ok(is_reached)
}

/// The fastest of the runs from one seed, and its result.
fn timed(task: &Task, problem: &DesignProblem, seed: u64) -> Result<(f64, Design), Failure> {
    let mut fastest = f64::INFINITY;
    let mut found = None;
    for _ in 0..RUNS {
        let begun = Instant::now();
        found = design(problem, &options(task, seed), &mut unwatched)?.design;
        fastest = fastest.min(begun.elapsed().as_secs_f64());
    }
    Ok((fastest, found.ok_or("no design")?))
}

fn options(task: &Task, seed: u64) -> DesignOptions {
    let (corner, damping_ratio) = ([0.1, 1e5], task.damping_ratio);
    let parts = vec![
        StructureFactor::RealZero { frequency: corner },
        StructureFactor::PolePair { natural_frequency: corner, damping_ratio },
    ];
    DesignOptions {
        objective: Objective::LeastHighFrequencyGain,
        controller: ControllerChoice::Given(Structure { sign: 1.0, gain: [1e-2, 1e4], parts }),
        prefilter: PrefilterChoice::None,
        seed,
        tolerance_db: TOLERANCE_DB,
        reserve_db: 0.0,
        poles: PoleRange::default(),
        coefficients: CoefficientFormat::Double,
        workers: Workers::CALLER,
    }
}

/// Processor time, s, and the gain, dB, of the peer.
fn peer(poles: &str, seed: u64) -> Result<(f64, f64), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join("..");
    let usual = root.join("target").join("venv").join("bin").join("python");
    let python = std::env::var_os("PHEA_PYTHON").map_or(usual, PathBuf::from);
    let output = Command::new(&python)
        .arg(root.join("benches").join("peers").join("design.py"))
        .args([poles, &seed.to_string()])
        .env("OMP_NUM_THREADS", "1")
        .output()
        .map_err(|error| format!("cannot run {}: {error}", python.display()))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut numbers = text.lines().map(str::parse::<f64>);
    match (numbers.next(), numbers.next()) {
        (Some(Ok(seconds)), Some(Ok(gain_db))) => Ok((seconds, gain_db)),
        _ => Err(String::from_utf8_lossy(&output.stderr).into()),
    }
}

fn servo() -> Result<DesignProblem, Failure> {
    let parameter =
        |name: &str| UncertainParameter { name: name.into(), nominal: 1.0, minimum: 1.0, maximum: 10.0 };
    let plant = UncertainPlant::record(vec![parameter("k"), parameter("a")], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0] * p[1]],
            denominator: vec![1.0.into(), p[1], 0.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    })?;
    let along = |parameter| Coordinate {
        parameters: vec![parameter],
        opposed: vec![],
        spacing: vec![Spacing::Logarithmic],
        points: 7,
    };
    let coordinates = vec![along(0), along(1)];
    let members = grid(&plant, &coordinates)?;
    let family = UncertainFamily::new(plant, coordinates, members, Extent::Box)?;
    let rational = |numerator: &[f64], denominator: &[f64]| {
        let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
        TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator))
            .map(Limit::Rational)
    };
    let specifications = vec![
        Specification {
            requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)),
            frequencies_rad_per_s: vec![0.1, 0.5, 1.0, 15.0, 100.0],
            band_rad_per_s: [0.0, f64::INFINITY],
        },
        Specification {
            requirement: Requirement::tracking(
                rational(&[120.0], &[1.0, 17.0, 82.0, 120.0])?,
                rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752])?,
            ),
            frequencies_rad_per_s: vec![0.1, 0.5, 1.0, 15.0],
            band_rad_per_s: [0.0, 15.0],
        },
    ];
    Ok(DesignProblem {
        family: Family::Uncertain(family),
        additional_plants: vec![],
        sensor: TransferFunction::gain_only(1.0),
        timing: Timing::default(),
        specifications,
        minimum_delay_margin_s: 0.0,
    })
}
