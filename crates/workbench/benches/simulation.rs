//! Benchmark of the closed loop of the examples on one core: `cargo bench -p phea-workbench --bench
//! simulation`.
//!
//! Machine and controller are those of the project files of `examples/benchmark`; only the force is
//! sampled, as in the runs of a campaign. The output has the time per run, the best and the mean of
//! many, the largest error of the force relative to the golden reference, and the work; the bench
//! fails if that error exceeds 0.02 N at the file's own tolerance. Times are printed and never
//! asserted.
//!
//! Its arguments are those of the drivers in `benches/peers`, which `closed_loop_times.py` runs in
//! turn with it: `closed_loop|closed_loop_sampled TOLERANCE|file [repeats=N] [output=FILE]`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::cell::RefCell;
use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Instant;

use phea_dynamics::simulation::{
    Input, InputSchedule, Observer, Outcome, Profile, Sampler, SimulationSettings, Status, Task,
};
use phea_engineering::simulate;
use phea_hydraulics::machine::StartValues;
use phea_machine::{Control, Digital, Waking, Watcher};
use phea_workbench::project::{self, InputSignal, MotionShape, Project};
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

/// Name, project file and golden reference.
type Case = (&'static str, &'static str, &'static str);

const CASES: [Case; 2] = [
    (
        "closed_loop",
        include_str!("../../../examples/benchmark/closed_loop.toml"),
        include_str!("../tests/golden/closed_loop.csv"),
    ),
    (
        "closed_loop_sampled",
        include_str!("../../../examples/benchmark/closed_loop_sampled.toml"),
        include_str!("../tests/golden/closed_loop_sampled.csv"),
    ),
];
/// Index of the load cell's deflection among the machine's states.
const DEFLECTION: usize = 4;
const LARGEST_ERROR_N: f64 = 0.02;

type Fault = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    match run_arguments(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

fn run_arguments(words: &[String]) -> Result<(), Fault> {
    if let [name, tolerance, options @ ..] = words {
        let case = CASES.iter().find(|case| case.0 == name).ok_or("no such case")?;
        let option = |name: &str| options.iter().find_map(|word| word.strip_prefix(name)?.strip_prefix('='));
        let repeats = option("repeats").map_or(Ok(1), str::parse)?;
        let tolerance = if tolerance == "file" { None } else { Some(tolerance.parse()?) };
        let timed = time(case, tolerance, repeats)?;
        if let Some(file) = option("output") {
            std::fs::write(file, table(&timed.forces))?;
        }
        return Ok(());
    }
    for case in &CASES {
        let timed = time(case, None, 200)?;
        let error = error_n(&timed.forces, case.2)?;
        println!("largest error of the force {error:.4} N");
        if error > LARGEST_ERROR_N {
            return Err(format!("{}: an error of {error} N", case.0).into());
        }
    }
    Ok(())
}

/// The rows of one run, time in s and force in N.
struct Timed {
    forces: Vec<[f64; 2]>,
}

/// Runs a case repeatedly, and prints the best and the mean time of a run.
fn time(case: &Case, tolerance: Option<f64>, repeats: u32) -> Result<Timed, Fault> {
    let project = read(case.1)?;
    let tolerance = tolerance.unwrap_or(project.simulation.tolerance);
    let bench = Bench::new(&project)?;
    let (mut best, mut total, mut last) = (f64::INFINITY, 0.0, None);
    for _ in 0..repeats.max(1) {
        let begun = Instant::now();
        let run = bench.run(tolerance)?;
        let seconds = begun.elapsed().as_secs_f64();
        (best, total, last) = (best.min(seconds), total + seconds, Some(run));
    }
    let (outcome, forces) = last.ok_or("no run")?;
    if outcome.status != Status::Completed {
        return Err(format!("{:?}", outcome.status).into());
    }
    println!(
        "{} {tolerance:e} best_ms {:.4} mean_ms {:.4} steps {} rejected {} evaluations {}",
        case.0,
        1e3 * best,
        1e3 * total / f64::from(repeats.max(1)),
        outcome.work.steps,
        outcome.work.rejected,
        outcome.work.evaluations
    );
    Ok(Timed { forces })
}

fn read(text: &str) -> Result<Project, Fault> {
    let source = Memory::default().with("rig.toml", text);
    let loaded = project::read(&source, "rig.toml", &[], &[]).map_err(|report| report.to_string())?;
    Ok(loaded.project)
}

/// Data common to the runs of one project: the kernel of the command, compiled as for the command.
struct Bench {
    control: Control,
    settings: SimulationSettings,
    start: Vec<f64>,
    schedule: InputSchedule,
    stiffness: f64,
}

impl Bench {
    fn new(project: &Project) -> Result<Bench, Fault> {
        let common = simulate::ControlledMachine::new(&Setup::new(project)?)?;
        let scenario = project.scenarios.first().ok_or("no scenario")?;
        let stated = scenario.start.as_ref().ok_or("no start")?;
        let beginning = common.machine.start(&StartValues {
            position: stated.position.unwrap_or(0.0),
            pressure_a: stated.pressure_a.unwrap_or(0.0),
            pressure_b: stated.pressure_b.unwrap_or(0.0),
            ..StartValues::default()
        })?;
        let steps: Vec<(f64, f64)> = scenario.reference.iter().flat_map(InputSignal::steps).collect();
        let reference = Input::Value(Profile::steps(0.0, &steps)?);
        let declared = scenario.load_motion.as_ref().ok_or("no motion")?;
        let MotionShape::SmoothStep { duration, distance } = declared.shape else {
            return Err("no smooth step".into());
        };
        let motion = Profile::smooth_step(declared.start, duration, distance)?;
        let ground = motion.shifted(beginning.inputs[0]);
        let mut inputs = vec![reference, Input::Value(ground.clone()), Input::Rate(ground)];
        if matches!(common.control, Control::Sampled(_)) {
            inputs.insert(0, Input::Command);
        }
        let [states, _] = common.control.size();
        let mut start = beginning.state;
        start.resize(states, 0.0);
        let schedule =
            InputSchedule { duration_s: scenario.duration, output_step_s: scenario.output_step, inputs };
        let stiffness = common.rig.actuator.components().force_sensor.stiffness;
        Ok(Bench { control: common.control, settings: common.settings, start, schedule, stiffness })
    }

    fn run(&self, tolerance: f64) -> Result<(Outcome, Vec<[f64; 2]>), Fault> {
        let settings = SimulationSettings { tolerance, ..self.settings };
        let log = RefCell::default();
        let sampler = match &self.control {
            Control::Sampled(sampled) => {
                Some(Box::new(Digital::new(sampled, &Waking::AtRest, &log)) as Box<dyn Sampler + '_>)
            }
            Control::Continuous(_) | Control::Open(_) => None,
        };
        let mut force = Force { stiffness: self.stiffness, rows: Vec::new() };
        let observer: Watcher<'_> = Box::new(&mut force);
        let task = Task { start: self.start.clone(), schedule: &self.schedule, sampler, observer };
        let outcome = self.control.drive(task, &settings, &mut |_| true)?;
        Ok((outcome, force.rows))
    }
}

/// Records only the force.
struct Force {
    stiffness: f64,
    rows: Vec<[f64; 2]>,
}

impl Observer for Force {
    fn wanted(&self) -> &[usize] {
        &[DEFLECTION]
    }

    fn observe(&mut self, time_s: f64, states: &[f64], _inputs: &[f64]) {
        self.rows.extend(states.first().map(|deflection| [time_s, self.stiffness * deflection]));
    }

    fn wants_inputs(&self) -> bool {
        false
    }
}

/// Largest difference of the force in N at the times of a reference.
fn error_n(forces: &[[f64; 2]], reference: &str) -> Result<f64, Fault> {
    let mut rows = forces.iter();
    let mut worst = 0.0_f64;
    for line in reference.lines().filter(|line| line.starts_with(|first: char| first.is_ascii_digit())) {
        let mut numbers = line.split(',').map(str::parse::<f64>);
        let [time_s, force_n] = [numbers.next().ok_or("no time")??, numbers.next().ok_or("no force")??];
        let row =
            rows.find(|row| (row[0] - time_s).abs() < 1e-9).ok_or("a row of the reference is missing")?;
        worst = worst.max((row[1] - force_n).abs());
    }
    Ok(worst)
}

/// The rows in the format of the drivers in C.
fn table(forces: &[[f64; 2]]) -> String {
    let mut text = "time_s,force_n\n".to_string();
    for [time_s, force_n] in forces {
        // writing to a string cannot fail
        let _ = writeln!(text, "{time_s:.15e},{force_n:.15e}");
    }
    text
}
