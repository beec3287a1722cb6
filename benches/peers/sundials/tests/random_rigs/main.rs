//! Random rigs through phea and through CVODE: 100 of them as a test, or as many as the first argument says.
//!
//!     cargo test --release --manifest-path benches/peers/sundials/Cargo.toml --test random_rigs -- 1000 timed
//!
//! Valve, lines, cylinder, friction, load, controller and its samples vary over decades. The reference is CVODE at 1e-11, phea is
//! judged at the tolerance 1e-7. At 1e-6, which a project has by default, two rigs in a thousand have a step whose error the method
//! does not see; these are told. Every fourth rig is compared with `closed_loop.h` as well; `timed` adds how long CVODE
//! takes at the same error; `only=N` runs one rig.
//!
//! No solver keeps near a trajectory that leaves its neighbours. How fast they part CVODE finds alone, at 1e-11:
//!
//! ```text
//! A(t) = largest until t of |F_kicked - F|/(e F_peak)       every 10 ms, y_i -> y_i +- e scale_i by chance, e = 1e-8
//! ```
//!
//! F by backward differentiation, F_kicked by Adams' method, so that rows on which the two do not agree to 1e-6 are not compared either.
//! A solver that keeps a tolerance may err by as much as that in every step, and takes 32 steps between two kicks in the mean. Ten
//! errors of 1e-6 grow to the thousandth of the peak that is allowed where A passes 100: there trajectories count as separated. Until
//! then an error is held against that thousandth, from then on against what ten such errors grow to, 10 x 1e-6 A(t). The peak is that
//! of the force, or what is asked for where the loop never brings it.

mod compare;
mod rich;
mod rig;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicU64, Ordering};

use phea_dynamics::simulation::Status;

use compare::{Compared, JUDGED, Ours, TOLERANCE, compare};
use rig::{Control, Refusal, rig};

/// Part of the peak.
const LARGEST_ERROR: f64 = 1e-3;
/// Between the machine and `closed_loop.h`, part of the peak.
const LARGEST_DIFFERENCE: f64 = 1e-4;

/// What was found over all rigs.
#[derive(Default)]
struct Tally {
    run: usize,
    refused: BTreeMap<String, usize>,
    without_reference: usize,
    /// Which phea ends where a chamber has emptied.
    without_model: usize,
    features: BTreeMap<&'static str, usize>,
    hunting: usize,
    /// Parts of their rows that are compared.
    separating: Vec<f64>,
    errors: Vec<f64>,
    /// Whose error exceeds the largest in any row, separated or not.
    exceeding: usize,
    beyond: Vec<f64>,
    steps: u64,
    /// Of the runs at the default tolerance: errors, and what would be failures.
    default_errors: Vec<f64>,
    default_faults: Vec<String>,
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
    let next = AtomicU64::new(numbers.start);
    let mut outcomes: Vec<(u64, Outcome)> = std::thread::scope(|scope| {
        let share = |_| {
            scope.spawn(|| {
                let taken = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
                let mine = taken.take_while(|number| numbers.contains(number));
                mine.map(|number| (number, outcome(number, &program, timed))).collect::<Vec<_>>()
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

/// A rig and its comparison, or why there is no such rig.
type Outcome = Result<(Described, Compared), String>;

struct Described {
    control: Control,
    features: Vec<&'static str>,
}

fn outcome(number: u64, program: &Path, timed: bool) -> Outcome {
    match rig(number) {
        Ok(rig) => {
            let compared = compare(&rig, number, program, timed);
            Ok((Described { control: rig.control, features: rig.features }, compared))
        }
        Err(Refusal::Actuator(error)) => Err(error.to_string()),
        Err(Refusal::Machine(error)) => Err(error.to_string()),
        Err(Refusal::Line(error)) => Err(error.to_string()),
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
            Ok((described, compared)) => {
                if told {
                    tell(described, compared);
                }
                for feature in &described.features {
                    *self.features.entry(feature).or_default() += 1;
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
        let Some(ours) = compared.ours else { return };
        if let Some(reason) = &compared.without_reference {
            self.without_reference += 1;
            println!("rig {number}: {reason}; phea: {:?}", ours.status);
            return;
        }
        self.hunting += usize::from(compared.hunts);
        self.exceeding += usize::from(ours.error_of_all >= LARGEST_ERROR);
        let (rows, of) = (compared.rows, compared.growth.len());
        if compared.separates() {
            self.separating.push(rows as f64 / of as f64);
            self.beyond.push(ours.beyond);
            let growth = compared.growth.last().copied().unwrap_or_default();
            println!(
                "rig {number}: separates after {rows} of {of} rows, growth {growth:.1e}; error {:.1e} until then, {:.1e} in all, \
                 {:.1} times the growth of one tolerance",
                ours.error, ours.error_of_all, ours.beyond
            );
        }
        if compared.leaves_the_model() {
            println!("rig {number}: {:?}, where a chamber has no fluid any more", ours.status);
            self.without_model += 1;
        } else {
            self.failures.extend(ours.fault().map(|fault| format!("rig {number}: {fault}")));
            self.take_default(number, compared.by_default);
        }
        if let Some(twin) = compared.twin {
            self.twins.push(twin);
            if twin >= LARGEST_DIFFERENCE {
                self.failures.push(format!("rig {number}: {twin:.1e} of the peak from closed_loop.h"));
            }
        }
        self.errors.push(ours.error);
        self.steps += ours.work.steps + ours.work.rejected;
        self.ratios.extend(compared.seconds_of_cvode.map(|seconds| seconds / ours.seconds));
    }

    fn take_default(&mut self, number: u64, run: Option<Ours>) {
        let Some(run) = run else { return };
        self.default_errors.push(run.error);
        if let Some(fault) = run.fault() {
            let told = format!("rig {number}, at {TOLERANCE:e}: {fault}");
            let list =
                if run.status == Status::Completed { &mut self.default_faults } else { &mut self.failures };
            list.push(told);
        }
    }

    fn print(&mut self) {
        let refused: usize = self.refused.values().sum();
        println!(
            "{} rigs: {refused} refused {:?}, {} without reference, {} end where a chamber has emptied",
            self.run, self.refused, self.without_reference, self.without_model
        );
        println!("of the others have: {:?}", self.features);
        println!("hunting at the end: {}", self.hunting);
        println!("separate before the end: {}", self.separating.len());
        println!("error above {LARGEST_ERROR:e} in any row: {}", self.exceeding);
        for (name, values) in [
            ("part of the rows before those separate", &mut self.separating),
            ("error, part of the peak", &mut self.errors),
            ("the same at the default tolerance", &mut self.default_errors),
            ("error after separation over the growth of one tolerance", &mut self.beyond),
            ("difference to closed_loop.h, part of the peak", &mut self.twins),
            ("CVODE's time over phea's at equal error", &mut self.ratios),
        ] {
            values.sort_by(f64::total_cmp);
            let at = |share: f64| values.get((share * values.len().saturating_sub(1) as f64) as usize);
            if let (Some(tenth), Some(middle), Some(ninetieth), Some(most)) =
                (at(0.1), at(0.5), at(0.9), at(1.0))
            {
                let count = values.len();
                println!(
                    "{name}: tenth {tenth:.2e}, median {middle:.2e}, ninetieth {ninetieth:.2e}, most {most:.2e} ({count})"
                );
            }
        }
        println!("steps at {JUDGED:e}: {}", self.steps);
        for fault in &self.default_faults {
            println!("{fault}");
        }
        for failure in &self.failures {
            println!("FAILED {failure}");
        }
    }
}

fn tell(described: &Described, compared: &Compared) {
    println!("{:?}\n{:?}\npeak {} N", described.features, described.control, compared.peak);
    if let Some(ours) = compared.ours {
        println!("{ours:?}\n{:?}", compared.by_default);
    }
}
