//! Benchmark of a campaign on one core next to a loop over CVODE: `cargo bench -p phea-workbench
//! --bench campaign -- [RUNS]`.
//!
//! The runs are those of examples/benchmark/campaign.toml, seed 1: processor time per run in lanes,
//! one by one, and of CVODE (BDF with stability-limit detection, 1e-6, the program of
//! benches/peers) on equal draws. The force of 200 runs is compared with that at tolerance 1e-10,
//! and that with CVODE at 1e-12. Values are compared, and fail the bench; times are printed and
//! never asserted. If CVODE cannot be compiled (Debian: libsundials-dev), only phea is timed.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use phea_workbench::engineering::campaign::{Effort, Plan};
use phea_workbench::project;
use phea_workbench::source::Memory;

const CAMPAIGN: &str = include_str!("../../../examples/benchmark/campaign.toml");

/// Number of runs in lanes; a tenth of them are repeated one by one.
const RUNS: u64 = 10_000;
/// Number of runs that are repeated more accurately.
const REPEATED: u64 = 200;
/// Number of runs of CVODE, and of those at 1e-12.
const PEER_RUNS: u64 = 100;
const PEER_CHECKS: u64 = 5;
/// Largest permitted error of the force in N, for the median run and for all but one in a hundred.
const MEDIAN_ERROR: f64 = 0.02;
const RARE_ERROR: f64 = 0.2;
/// Largest difference in N between two solvers at their highest accuracy.
const AGREEMENT: f64 = 5e-3;

/// Parameters of the peer for each path.
const NAMES: [(&str, &[&str]); 18] = [
    ("supply.pressure", &["supply_pressure"]),
    ("valve.flow_coefficients.supply_to_a", &["flow_supply_to_a"]),
    ("valve.flow_coefficients.a_to_tank", &["flow_a_to_tank"]),
    ("valve.flow_coefficients.supply_to_b", &["flow_supply_to_b"]),
    ("valve.flow_coefficients.b_to_tank", &["flow_b_to_tank"]),
    ("valve.leakage_coefficients.supply_to_a", &["leakage_supply_to_a"]),
    ("valve.leakage_coefficients.a_to_tank", &["leakage_a_to_tank"]),
    ("valve.leakage_coefficients.supply_to_b", &["leakage_supply_to_b"]),
    ("valve.leakage_coefficients.b_to_tank", &["leakage_b_to_tank"]),
    ("cylinder.friction.coulomb", &["coulomb"]),
    ("cylinder.friction.static", &["static_friction"]),
    ("cylinder.friction.stribeck_velocity", &["stribeck_velocity"]),
    ("cylinder.friction.bristle_stiffness", &["bristle_stiffness"]),
    ("cylinder.friction.bristle_damping", &["bristle_damping"]),
    ("cylinder.friction.viscous", &["viscous"]),
    ("line.volume", &["line_volume_a", "line_volume_b"]),
    ("force_sensor.stiffness", &["sensor_stiffness"]),
    ("cylinder.moving_mass", &["moving_mass"]),
];

fn main() -> ExitCode {
    let runs = std::env::args().skip(1).find_map(|argument| argument.parse().ok());
    match bench(runs.unwrap_or(RUNS)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

fn bench(runs: u64) -> Result<bool, Box<dyn Error>> {
    let plan = plan(&[])?;
    let lanes = milliseconds(runs, || plan.rows(0..runs, Effort::default()).map(|_| ()))?;
    let few = (runs / 10).max(1);
    let scalar = milliseconds(few, || plan.rows(0..few, ONE_BY_ONE).map(|_| ()))?;
    println!("{lanes:9.4} ms a run in lanes ({runs} runs)");
    println!("{scalar:9.4} ms one by one ({few} runs): {:.2} times as long", scalar / lanes);

    let exact = self::plan(&["simulation.tolerance=1e-10".to_string()])?;
    let (found, reference) =
        (plan.forces(0..REPEATED, Effort::default())?, exact.forces(0..REPEATED, Effort::default())?);
    let errors = sorted(found.iter().zip(&reference).map(|(one, other)| largest(one, other)));
    let (median, rare) = (quantile(&errors, 0.5), quantile(&errors, 0.99));
    let worst = quantile(&errors, 1.0);
    println!(
        "largest error of the force over {REPEATED} runs: median {median:.2e} N, 99 % {rare:.2e} N, worst {worst:.2e} N"
    );
    let mut well = median <= MEDIAN_ERROR && rare <= RARE_ERROR;
    match peer()? {
        None => println!("CVODE: not compiled here"),
        Some(program) => well &= compare_with_peer(&program, &plan, (lanes, &reference))?,
    }
    Ok(well)
}

const ONE_BY_ONE: Effort = Effort { threads: 1, lanes: false };

/// Times of CVODE next to those of phea, and the agreement of the two at their highest accuracy.
fn compare_with_peer(
    program: &Path,
    plan: &Plan,
    (lanes, reference): (f64, &[Vec<f64>]),
) -> Result<bool, Box<dyn Error>> {
    let (mut total, mut errors) = (0.0, Vec::new());
    for (run, exact) in (0..PEER_RUNS).zip(reference) {
        let (milliseconds, force) = cvode(program, plan, run, "1e-6")?;
        total += milliseconds;
        errors.push(largest(&force, exact));
    }
    let mean = total / PEER_RUNS as f64;
    let errors = sorted(errors.into_iter());
    println!("{mean:9.4} ms a run of CVODE, BDF with stability-limit detection, 1e-6 ({PEER_RUNS} runs)");
    println!(
        "          its error: median {:.2e} N, 99 % {:.2e} N",
        quantile(&errors, 0.5),
        quantile(&errors, 0.99)
    );
    println!("          in lanes: {:.1} times as fast", mean / lanes);
    let mut well = true;
    for (run, exact) in (0..PEER_CHECKS).zip(reference) {
        let (_, force) = cvode(program, plan, run, "1e-12")?;
        let apart = largest(&force, exact);
        println!("          run {run}: {apart:.1e} N between CVODE at 1e-12 and phea at 1e-10");
        well &= apart <= AGREEMENT;
    }
    Ok(well)
}

fn plan(settings: &[String]) -> Result<Plan, Box<dyn Error>> {
    let source = Memory::default().with("campaign.toml", CAMPAIGN);
    let loaded =
        project::read(&source, "campaign.toml", settings, &[]).map_err(|report| report.to_string())?;
    Ok(Plan::new(&source, &loaded, 1)?)
}

/// Processor time per run of this number of runs, for this process with all its threads.
fn milliseconds<E: Error + 'static>(
    runs: u64,
    work: impl FnOnce() -> Result<(), E>,
) -> Result<f64, Box<dyn Error>> {
    let (before, begun) = (processor_seconds(), Instant::now());
    work()?;
    let seconds = match (before, processor_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => begun.elapsed().as_secs_f64(),
    };
    Ok(1e3 * seconds / runs as f64)
}

/// Processor time in the units of Linux, ticks of a hundredth of a second.
fn processor_seconds() -> Option<f64> {
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / 100.0)
}

/// The program of benches/peers; `None` if it cannot be compiled.
fn peer() -> Result<Option<PathBuf>, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = root.join("target/peers");
    fs::create_dir_all(&folder)?;
    let program = folder.join("cvode_closed_loop");
    let compiled = Command::new("cc")
        .args(["-O3", "-march=native"])
        .arg(root.join("benches/peers/cvode_closed_loop.c"))
        .arg("-o")
        .arg(&program)
        .args(["-lsundials_cvode", "-lsundials_nvecserial", "-lm"])
        .output();
    Ok(compiled.is_ok_and(|output| output.status.success()).then_some(program))
}

/// Milliseconds and force of a run on CVODE.
fn cvode(program: &Path, plan: &Plan, run: u64, tolerance: &str) -> Result<(f64, Vec<f64>), Box<dyn Error>> {
    let rows = program.with_extension("csv");
    let mut command = Command::new(program);
    command.args(["bdf_stability", tolerance, "repeats=3"]).arg(format!("output={}", rows.display()));
    for (range, value) in plan.ranges().iter().zip(&plan.draw(run).values) {
        let known = NAMES.iter().find(|(path, _)| *path == range.path);
        let (_, names) = known.ok_or_else(|| format!("the peer has no {}", range.path))?;
        command.args(names.iter().map(|name| format!("{name}={value:e}")));
    }
    let output = command.output()?;
    let report = String::from_utf8_lossy(&output.stdout).to_string();
    let mut words = report.split_whitespace().skip_while(|word| *word != "best_ms");
    let time = words.nth(1).ok_or_else(|| String::from_utf8_lossy(&output.stderr).to_string())?;
    let table = fs::read_to_string(&rows)?;
    let force = table.lines().skip(1).map(|line| line.split(',').nth(1).unwrap_or_default().parse());
    Ok((time.parse()?, force.collect::<Result<_, _>>()?))
}

/// Largest difference; infinite if one series is shorter.
fn largest(one: &[f64], other: &[f64]) -> f64 {
    if one.len() != other.len() {
        return f64::INFINITY;
    }
    one.iter().zip(other).fold(0.0, |largest, (one, other)| (one - other).abs().max(largest))
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

fn quantile(sorted: &[f64], fraction: f64) -> f64 {
    let place = (fraction * (sorted.len().saturating_sub(1)) as f64).ceil() as usize;
    sorted.get(place).copied().unwrap_or(f64::NAN)
}
