//! Random rigs simulated by phea and by CVODE: 100 of each family, or the number in the first
//! argument (the test command requests 50, the stage `soak` 1000).
//!
//!     cargo test --release -p sundials --test random_rigs -- 1000 timed
//!
//! Four families: `any`, whose valve, lines, cylinder, friction, load, controller and its samples
//! vary over decades; `falling`, whose friction falls with the velocity where a slow load releases
//! the piston, so that it feeds the ringing on the load cell; `necks`, with accumulators behind
//! necks that empty; and `kinked`, which reach end stops, walls and stages of a telescopic piston,
//! stick and reverse. One of these words runs the full number of that family only; without one, the
//! last two are run a sixteenth and a fifth as often, at most 60 and 200 of them, the numbers of
//! the stage `soak`. For necks, an error above one thousandth at the default tolerance is a failure
//! unless the run reports that errors may be visible, and so are more than ten times the steps of
//! CVODE at 1e-9, which is their only reference. Kinked rigs are run like a project, repeated if
//! errors may be visible, and every row and metric must be right unless the run reports otherwise:
//! [`repeated`].
//!
//! The reference is CVODE at 1e-11, phea is judged at the tolerance 1e-7. The result at 1e-6, the
//! default of a project, is reported with it. Every fourth rig of the first family is compared with
//! `closed_loop.h` as well; `timed` adds the cost of CVODE at an equal error; `only=N` runs one
//! rig, `from=N` begins with it; `judged=1e-9` judges phea at that tolerance.
//!
//! No solver can follow a trajectory that diverges from its neighbours. Two runs of CVODE at 1e-11
//! measure the rate of divergence:
//!
//! ```text
//! A(t) = largest until t of |F_kicked - F|/(e F_peak)       every 10 ms, y_i -> y_i +- e scale_i by chance, e = 1e-8
//! ```
//!
//! F is computed by backward differentiation, F_kicked by Adams' method, so that rows on which the
//! two do not agree to 1e-6 are not compared either. A solver may err by its tolerance in every
//! step, and takes 32 steps between two kicks on average. Ten errors of 1e-6 grow to the allowed
//! thousandth of the peak when A exceeds 100: from there trajectories count as separated. Until
//! then an error is compared with that thousandth, afterwards with the growth of ten such errors,
//! 10 x 1e-6 A(t). The peak is that of the force, or of the reference if the loop never reaches it.
//!
//! A force without ringing would satisfy that bound too if A is large. Therefore, from then on the
//! force must also ring as strongly as CVODE's: [`roughness`].
//!
//! A rig is well posed if the forces of CVODE at 1e-9 and at 1e-11 agree to 1e-5 of the peak. An
//! ill-posed rig that fails is judged again at 1e-9: it must agree there. For well-posed rigs, the
//! error at the default tolerance is reported over all rows, together with its estimate by a run at
//! a tenth of the tolerance.

mod compare;
mod falling;
mod kinked;
mod limited;
mod necks;
mod repeated;
mod rich;
mod rig;
mod roughness;
mod shut;
mod tally;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicU64, Ordering};

use compare::{Compared, JUDGED, Manner, compare};
use rig::{Control, Refusal};
use tally::Tally;

/// Largest error, fraction of the peak.
const LARGEST_ERROR: f64 = 1e-3;

/// Family of rigs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Family {
    Any,
    Falling,
    Necks,
    Kinked,
}

impl Family {
    const ALL: [Family; 4] = [Family::Any, Family::Falling, Family::Necks, Family::Kinked];

    fn word(self) -> &'static str {
        match self {
            Family::Any => "any",
            Family::Falling => "falling",
            Family::Necks => "necks",
            Family::Kinked => "kinked",
        }
    }

    /// Number of its rigs that are run if this many of a family are: those of the last two cost
    /// more.
    fn part_of(self, count: u64) -> u64 {
        match self {
            Family::Any | Family::Falling => count,
            Family::Necks => (count / 16).clamp(4, 60),
            Family::Kinked => (count / 5).clamp(8, 200),
        }
    }
}

/// Arguments of the command line.
struct Arguments {
    first: u64,
    count: u64,
    /// Number of the only rig to run.
    only: Option<u64>,
    /// True if families are named: then each is run with the whole count.
    named: bool,
    manner: Manner,
    /// True if all data of each rig are printed.
    print_each: bool,
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let has_word = |wanted: &str| words.iter().any(|word| word == wanted);
    let number = |prefix: &str| words.iter().find_map(|word| word.strip_prefix(prefix)?.parse::<u64>().ok());
    let count: u64 = words.iter().find_map(|word| word.parse().ok()).unwrap_or(100);
    let judged = words.iter().find_map(|word| word.strip_prefix("judged=")?.parse().ok()).unwrap_or(JUDGED);
    let only = number("only=");
    let first = number("from=").unwrap_or(0);
    let named = Family::ALL.iter().any(|family| has_word(family.word()));
    let arguments = Arguments {
        first,
        count,
        only,
        named,
        manner: Manner { judged, timed: has_word("timed"), repeated: false },
        print_each: only.is_some(),
    };
    let program = match compiled() {
        Ok(program) => program,
        Err(problem) => {
            eprintln!("{problem}");
            return ExitCode::FAILURE;
        }
    };
    let wanted = Family::ALL.into_iter().filter(|family| !named || has_word(family.word()));
    let failed: Vec<Family> = wanted.filter(|family| !passes(*family, &arguments, &program)).collect();
    if failed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Runs a family and reports the outcome.
fn passes(family: Family, arguments: &Arguments, program: &Path) -> bool {
    println!("family `{}`", family.word());
    let Arguments { first, count, only, named, manner, print_each } = *arguments;
    let count = if named { count } else { family.part_of(count) };
    let numbers = only.map_or(first..first + count, |only| only..only + 1);
    // Runs are timed one after the other.
    let at_once = if manner.timed {
        1
    } else {
        std::thread::available_parallelism().map_or(1, |cores| cores.get() as u64)
    };
    if family == Family::Necks {
        let costs = |number| necks::rig(number).map(|rig| shut::costs(&rig)).map_err(refused);
        return shut::passes(&of_all(numbers, at_once, costs));
    }
    let manner = Manner { repeated: family == Family::Kinked, ..manner };
    let outcomes = of_all(numbers, at_once, |number| outcome(family, number, program, manner));
    let mut tally = Tally::default();
    for (number, outcome) in &outcomes {
        tally.take(*number, outcome, print_each);
    }
    tally.print();
    tally.passes()
}

/// The results of all these rigs, in their order, with this many computed at once.
fn of_all<T: Send>(
    numbers: std::ops::Range<u64>,
    at_once: u64,
    of: impl Fn(u64) -> T + Sync,
) -> Vec<(u64, T)> {
    let next = AtomicU64::new(numbers.start);
    let mut found: Vec<(u64, T)> = std::thread::scope(|scope| {
        let worker = |_| {
            scope.spawn(|| {
                let taken = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
                let mine = taken.take_while(|number| numbers.contains(number));
                mine.map(|number| (number, of(number))).collect::<Vec<_>>()
            })
        };
        let workers: Vec<_> = (0..at_once).map(worker).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no panic")).collect()
    });
    found.sort_by_key(|(number, _)| *number);
    found
}

/// Reason why there is no such rig.
fn refused(refusal: Refusal) -> String {
    match refusal {
        Refusal::Actuator(error) => error.to_string(),
        Refusal::Machine(error) => error.to_string(),
    }
}

/// A rig and its comparison, or the reason why there is no such rig.
type Outcome = Result<(Described, Compared), String>;

struct Described {
    control: Control,
    features: Vec<&'static str>,
    /// Outcome of an ill-posed rig that fails, at [`FINER`] too.
    at_finer: Option<Result<(), String>>,
}

/// Tolerance at which ill-posed rigs are judged again.
const FINER: f64 = 1e-9;

fn outcome(family: Family, number: u64, program: &Path, manner: Manner) -> Outcome {
    let rig = match family {
        Family::Any => rig::rig(number),
        Family::Falling => falling::rig(number),
        Family::Necks => necks::rig(number),
        Family::Kinked => kinked::rig(number),
    };
    match rig {
        Ok(rig) => {
            let compared = compare(&rig, number, program, manner);
            let fails = compared.ours.is_some_and(|ours| ours.fault().is_some());
            let at_finer = (fails && !compared.well_posed && manner.judged > FINER).then(|| {
                let manner = Manner { judged: FINER, repeated: false, ..manner };
                let again = compare(&rig, number, program, manner);
                again.ours.and_then(|ours| ours.fault()).map_or(Ok(()), Err)
            });
            Ok((Described { control: rig.control, features: rig.features, at_finer }, compared))
        }
        Err(refusal) => Err(refused(refusal)),
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
