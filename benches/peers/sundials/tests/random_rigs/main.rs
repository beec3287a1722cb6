//! Random rigs through phea and through CVODE: 100 of them as a test, or as many as the first argument says.
//!
//!     cargo test --release --manifest-path benches/peers/sundials/Cargo.toml --test random_rigs -- 1000 timed
//!
//! Valve, lines, cylinder, friction, load, controller and its samples vary over decades. The reference is CVODE at 1e-11, by two methods:
//! a loop is compared up to where these two separate by 1e-5 of the largest force, which unstable and hunting loops do.
//! A rig whose error at the tolerance 1e-6 is more than 1e-3 of its peak is run again at 1e-8 and 1e-10 and counted: what amplifies
//! errors amplifies those of a looser tolerance too. Every fourth rig is compared with `closed_loop.h` as well. `timed` adds how long
//! CVODE takes at the same error; `only=N` runs one rig.

mod compare;
mod rig;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use phea_dynamics::simulation::Status;

use compare::{Compared, compare};
use rig::{Control, Refusal, rig};

/// Part of the peak.
const LARGEST_ERROR: f64 = 1e-3;
/// Between the machine and `closed_loop.h`, part of the peak.
const LARGEST_DIFFERENCE: f64 = 1e-3;

/// What was found over all rigs.
#[derive(Default)]
struct Tally {
    run: usize,
    refused: BTreeMap<String, usize>,
    without_reference: usize,
    hunting: usize,
    separating: Vec<u64>,
    tightened: BTreeMap<u64, f64>,
    errors: Vec<f64>,
    steps: u64,
    twins: Vec<f64>,
    ratios: Vec<f64>,
    failures: Vec<String>,
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let timed = words.iter().any(|word| word == "timed");
    let only = words.iter().find_map(|word| word.strip_prefix("only=")?.parse::<u64>().ok());
    let count: u64 = words.iter().find_map(|word| word.parse().ok()).unwrap_or(100);
    let program = match compiled() {
        Ok(program) => program,
        Err(problem) => {
            eprintln!("{problem}");
            return ExitCode::FAILURE;
        }
    };
    let numbers = only.map_or(0..count, |only| only..only + 1);
    // Times are taken one after the other.
    let at_once =
        if timed { 1 } else { std::thread::available_parallelism().map_or(1, |cores| cores.get() as u64) };
    let mut outcomes: Vec<(u64, Outcome)> = std::thread::scope(|scope| {
        let share = |worker: u64| {
            let (numbers, program) = (numbers.clone(), &program);
            let mine = numbers.filter(move |number| number % at_once == worker);
            scope.spawn(move || {
                mine.map(|number| (number, outcome(number, program, timed))).collect::<Vec<_>>()
            })
        };
        let workers: Vec<_> = (0..at_once).map(share).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no panic")).collect()
    });
    outcomes.sort_by_key(|(number, _)| *number);
    let mut tally = Tally::default();
    for (number, outcome) in &outcomes {
        tally.take(*number, outcome, only.is_some());
    }
    tally.print();
    if tally.failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The comparison of a rig with its controller, or why there is no such rig.
type Outcome = Result<(Control, Compared), String>;

fn outcome(number: u64, program: &Path, timed: bool) -> Outcome {
    match rig(number) {
        Ok(rig) => Ok((rig.control, compare(&rig, number, program, timed))),
        Err(Refusal::Actuator(error)) => Err(error.to_string()),
        Err(Refusal::Machine(error)) => Err(error.to_string()),
    }
}

/// The driver of `closed_loop.h`, compiled.
fn compiled() -> Result<PathBuf, String> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cvode_closed_loop.c");
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cvode_closed_loop");
    let flags = ["-O2", "-lsundials_cvode", "-lsundials_nvecserial", "-lm", "-o"];
    let status = Command::new("cc").arg(source).args(flags).arg(&program).status();
    match status {
        Ok(status) if status.success() => Ok(program),
        Ok(status) => Err(format!("cc: {status}")),
        Err(error) => Err(format!("cc: {error}")),
    }
}

impl Tally {
    fn take(&mut self, number: u64, outcome: &Outcome, told: bool) {
        self.run += 1;
        match outcome {
            Ok((control, compared)) => {
                if told {
                    tell(control, compared);
                }
                self.judge(number, compared);
            }
            Err(refusal) => {
                println!("rig {number}: refused: {refusal}");
                let kind = refusal.split(' ').filter(|word| !word.contains(|c: char| c.is_ascii_digit()));
                *self.refused.entry(kind.collect::<Vec<_>>().join(" ")).or_default() += 1;
            }
        }
    }

    fn judge(&mut self, number: u64, compared: &Compared) {
        let Some((first, last)) = compared.ours.first().zip(compared.ours.last()) else { return };
        if let Some(reason) = &compared.without_reference {
            self.without_reference += 1;
            println!("rig {number}: {reason}; phea: {:?}", first.status);
            return;
        }
        self.hunting += usize::from(compared.hunts);
        if compared.separates {
            self.separating.push(number);
        }
        if compared.ours.len() > 1 {
            self.tightened.insert(number, last.tolerance);
            let tried: Vec<String> = compared
                .ours
                .iter()
                .map(|ours| format!("{:.1e} at {:e}", ours.error, ours.tolerance))
                .collect();
            let until = if compared.separates { format!(", {} rows", compared.rows) } else { String::new() };
            let theirs = compared.error_of_cvode.map_or("none".to_string(), |error| format!("{error:.1e}"));
            println!("rig {number}: error {}{until}; of CVODE {theirs} at 1e-6", tried.join(", "));
        }
        if last.status != Status::Completed && !(compared.separates && last.error < LARGEST_ERROR) {
            self.failures.push(format!("rig {number}: {:?}, where CVODE goes on", last.status));
        } else if last.error >= LARGEST_ERROR {
            self.failures.push(format!("rig {number}: an error of {:.1e} of the peak", last.error));
        }
        if let Some(twin) = compared.twin {
            self.twins.push(twin);
            if twin >= LARGEST_DIFFERENCE {
                self.failures.push(format!("rig {number}: {twin:.1e} of the peak from closed_loop.h"));
            }
        }
        self.errors.push(first.error);
        self.steps += first.work.steps + first.work.rejected;
        self.ratios.extend(compared.seconds_of_cvode.map(|seconds| seconds / first.seconds));
    }

    fn print(&mut self) {
        let refused: usize = self.refused.values().sum();
        println!(
            "{} rigs: {refused} refused {:?}, {} without reference",
            self.run, self.refused, self.without_reference
        );
        println!("hunting at the end: {}", self.hunting);
        println!("separate before the end: {} {:?}", self.separating.len(), self.separating);
        println!("run again at a tighter tolerance: {:?}", self.tightened);
        for (name, values) in [
            ("error at 1e-6, part of the peak", &mut self.errors),
            ("difference to closed_loop.h, part of the peak", &mut self.twins),
            ("CVODE's time over phea's at equal error", &mut self.ratios),
        ] {
            values.sort_by(f64::total_cmp);
            let at = |share: f64| values.get((share * values.len().saturating_sub(1) as f64) as usize);
            if let (Some(least), Some(middle), Some(ninetieth), Some(most)) =
                (at(0.1), at(0.5), at(0.9), at(1.0))
            {
                let count = values.len();
                println!(
                    "{name}: tenth {least:.2e}, median {middle:.2e}, ninetieth {ninetieth:.2e}, most {most:.2e} ({count})"
                );
            }
        }
        println!("steps at 1e-6: {}", self.steps);
        for failure in &self.failures {
            println!("FAILED {failure}");
        }
    }
}

fn tell(control: &Control, compared: &Compared) {
    println!(
        "{control:?}\npeak {} N over {} rows, separates: {}",
        compared.peak, compared.rows, compared.separates
    );
    for ours in &compared.ours {
        println!(
            "{:e}: {:?} {:.2e} {:?} {:.4} s",
            ours.tolerance, ours.status, ours.error, ours.work, ours.seconds
        );
    }
}
