//! What runs cost over gas that is shut off behind its neck: there the oil of the neck rings for
//! long, and CVODE takes minutes at the tolerance at which other rigs have their reference. So its
//! run at a looser one is the reference, and its steps are what those of phea are held against.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::simulation::{
    Amplification, CommandedPlant, Input, InputSchedule, Sensed, SimulationSettings, Status, Task,
};
use phea_machine::{Control as Loop, Watcher};
use sundials::{Following, Method, follow};

use crate::compare::{Rows, TOLERANCE, controller, force_of};
use crate::patient::Patient;
use crate::rig::{OUTPUT_STEP_S, Rig};

/// Of CVODE.
const LOOSER: f64 = 1e-9;
/// Its evaluations, after which the steps so far are what counts.
const EVALUATIONS: u64 = 4_000_000;
/// Times its steps that phea may try at its default tolerance.
const MOST_STEPS: f64 = 10.0;

/// Runs of one rig.
pub(crate) struct Costs {
    pub(crate) status: Status,
    /// Steps tried: by phea, and by CVODE.
    pub(crate) steps: [u64; 2],
    /// Largest difference of the force as a part of its peak; `None` where CVODE came to no end.
    pub(crate) error: Option<f64>,
    /// Whether phea reports that errors may be visible.
    pub(crate) may_show_errors: bool,
}

impl Costs {
    /// phea's steps over those of CVODE.
    pub(crate) fn ratio(&self) -> f64 {
        self.steps[0] as f64 / self.steps[1] as f64
    }

    /// What is wrong with them.
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

/// phea and CVODE over one rig whose controller is continuous.
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
    let course = InputSchedule { duration_s: rig.duration_s, output_step_s: OUTPUT_STEP_S, inputs };
    let count = closed.size()[0];
    let start = rig.beginning(count);

    let settings = SimulationSettings {
        tolerance: TOLERANCE,
        maximum_steps: 2_000_000,
        ..SimulationSettings::default()
    };
    let mut states = Vec::new();
    let observer: Watcher<'_> = Box::new(Rows { wanted: (0..count).collect(), states: &mut states });
    let task = Task { start: start.clone(), course: &course, sampler: None, observer };
    let outcome = closed.drive(task, &settings, &mut |_| true).expect("a course that fits");
    let ours = force_of(rig, &states);

    let patient = Patient::new(&closed, EVALUATIONS);
    let following = Following::new(LOOSER, Method::BackwardDifferentiation);
    let theirs = follow(&patient, &start, &course, None, &following).ok().map(|rows| force_of(rig, &rows));
    let error = theirs.map(|theirs| {
        let peak = theirs.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        let apart = ours.iter().zip(&theirs).map(|(one, other)| (one - other).abs());
        if ours.len() == theirs.len() { apart.fold(0.0, f64::max) / peak } else { f64::INFINITY }
    });
    let [_, by_cvode] = patient.cost();
    let reports = |grown: Amplification| grown.may_show_errors(TOLERANCE);
    Costs {
        status: outcome.status,
        steps: [outcome.work.steps + outcome.work.rejected, by_cvode],
        error,
        may_show_errors: outcome.amplification.is_some_and(reports),
    }
}

/// Prints what came of all rigs and what is wrong with some; whether nothing is.
pub(crate) fn passes(found: &[(u64, Result<Costs, String>)]) -> bool {
    let run: Vec<(u64, &Costs)> =
        found.iter().filter_map(|(number, costs)| Some((*number, costs.as_ref().ok()?))).collect();
    let ended = run.iter().filter(|(_, costs)| costs.error.is_some()).count();
    println!("{} rigs, {} refused; CVODE came to an end in {ended}", found.len(), found.len() - run.len());
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
