//! Cost of runs with gas that is shut off and has a neck: there the oil of the neck rings for long,
//! and CVODE takes minutes at the tolerance of the reference of other rigs. Its run at a looser
//! tolerance is therefore the reference, and phea's steps are compared with its steps.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::simulation::{
    Amplification, CommandedPlant, Input, InputSchedule, Sensed, SimulationSettings, Status, Task,
};
use phea_machine::{Control as Loop, Watcher};
use sundials::{Following, Method, follow};

use crate::compare::{Rows, TOLERANCE, controller, force_of};
use crate::limited::Limited;
use crate::rig::{OUTPUT_STEP_S, Rig};

/// Tolerance of CVODE.
const LOOSER: f64 = 1e-9;
/// Largest number of its evaluations, after which the steps so far are counted.
const EVALUATIONS: u64 = 4_000_000;
/// Largest allowed ratio of phea's steps at its default tolerance to CVODE's.
const MOST_STEPS: f64 = 10.0;

/// Runs of one rig.
pub(crate) struct Costs {
    pub(crate) status: Status,
    /// Attempted steps of phea and of CVODE.
    pub(crate) steps: [u64; 2],
    /// Largest difference of the force as a fraction of its peak; `None` if CVODE did not reach the
    /// end.
    pub(crate) error: Option<f64>,
    /// True if phea reports that errors may be visible.
    pub(crate) may_show_errors: bool,
}

impl Costs {
    /// Ratio of phea's steps to CVODE's.
    pub(crate) fn ratio(&self) -> f64 {
        self.steps[0] as f64 / self.steps[1] as f64
    }

    /// Description of the failure, if there is one.
    pub(crate) fn fault(&self) -> Option<String> {
        let Costs { status, steps, error, may_show_errors } = self;
        if *status != Status::Completed {
            return Some(format!("{status:?}"));
        }
        if self.ratio() > MOST_STEPS {
            return Some(format!("{} steps, {:.1} times the {} of CVODE", steps[0], self.ratio(), steps[1]));
        }
        let error = error.filter(|error| *error >= crate::LARGEST_ERROR && !may_show_errors)?;
        Some(format!("an error of {error:.1e} of the peak, and no report of it"))
    }
}

/// Runs phea and CVODE on a rig whose controller is continuous.
pub(crate) fn costs(rig: &Rig) -> Costs {
    let sensed =
        Sensed::new(rig.machine, &TransferFunction::gain_only(1.0)).expect("a sensor without memory");
    let closed = CommandedPlant::in_loop(sensed, &controller(&rig.control), 0.0).expect("proper");
    let closed = Loop::Continuous(Box::new(closed));
    let inputs = vec![
        Input::Value(rig.reference.clone()),
        Input::Value(rig.ground.clone()),
        Input::Rate(rig.ground.clone()),
    ];
    let schedule = InputSchedule { duration_s: rig.duration_s, output_step_s: OUTPUT_STEP_S, inputs };
    let count = closed.size()[0];
    let start = rig.beginning(count);

    let settings = SimulationSettings {
        tolerance: TOLERANCE,
        maximum_steps: 2_000_000,
        ..SimulationSettings::default()
    };
    let mut states = Vec::new();
    let observer: Watcher<'_> = Box::new(Rows { wanted: (0..count).collect(), states: &mut states });
    let task = Task { start: start.clone(), schedule: &schedule, sampler: None, observer };
    let outcome = closed.drive(task, &settings, &mut |_| true).expect("a course that fits");
    let ours = force_of(rig, &states);

    let limited = Limited::new(&closed, EVALUATIONS);
    let following = Following::new(LOOSER, Method::BackwardDifferentiation);
    let theirs = follow(&limited, &start, &schedule, None, &following).ok().map(|rows| force_of(rig, &rows));
    let error = theirs.map(|theirs| {
        let peak = theirs.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        let apart = ours.iter().zip(&theirs).map(|(one, other)| (one - other).abs());
        if ours.len() == theirs.len() { apart.fold(0.0, f64::max) / peak } else { f64::INFINITY }
    });
    let [_, by_cvode] = limited.cost();
    let reports = |grown: Amplification| grown.may_show_errors(TOLERANCE);
    Costs {
        status: outcome.status,
        steps: [outcome.work.steps + outcome.work.rejected, by_cvode],
        error,
        may_show_errors: outcome.amplification.is_some_and(reports),
    }
}

/// Prints the results of all rigs and the failures; returns true if there is none.
pub(crate) fn passes(found: &[(u64, Result<Costs, String>)]) -> bool {
    let run: Vec<(u64, &Costs)> =
        found.iter().filter_map(|(number, costs)| Some((*number, costs.as_ref().ok()?))).collect();
    let failed = run.iter().filter(|(_, costs)| costs.error.is_some()).count();
    println!("{} rigs, {} refused; CVODE came to an end in {failed}", found.len(), found.len() - run.len());
    let mut ratios: Vec<f64> = run.iter().map(|(_, costs)| costs.ratio()).collect();
    crate::tally::spread("steps at the default tolerance over those of CVODE at 1e-9", &mut ratios);
    let mut errors: Vec<f64> = run.iter().filter_map(|(_, costs)| costs.error).collect();
    crate::tally::spread("error, part of the peak", &mut errors);
    let most = run.iter().map(|(_, costs)| costs.steps[0]).max().unwrap_or_default();
    let reporting = run.iter().filter(|(_, costs)| costs.may_show_errors).count();
    println!("most steps: {most}; errors may be visible: {reporting}");
    let faults: Vec<String> = run
        .iter()
        .filter_map(|(number, costs)| Some(format!("FAILED rig {number}: {}", costs.fault()?)))
        .collect();
    faults.iter().for_each(|fault| println!("{fault}"));
    faults.is_empty()
}
