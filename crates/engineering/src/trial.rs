//! Test of the verdict on the machine: the nonlinear rig under the deployed controller, compared
//! with the prediction of the linear loop.
//!
//! ```text
//! project, audit -> rigs::rigs -> TrialRig { project, plant } -> PredictedMachine::driven, the first steps and the largest -> judge -> Run { linear, machine, agreement, reason } -> answer
//! all satisfy the requirements -> corners of the box and plants inside -> the worst of them
//! ```

mod corners;
mod first_steps;
mod judge;
mod prediction;
mod reason;
mod required;
mod rigs;
mod run;
mod steps;
pub use judge::{OVERSHOOT_ROOM_PERCENT, SETTLING_RATIO, SETTLING_ROOM};

pub use crate::linear_step::StepResponse;
use corners::{runs_of_corners, worst_of};
pub use first_steps::MOST_OF_SCENARIOS;
use first_steps::RequiredOfSteps;
pub use reason::{
    DampingWall, DifferenceCause, MissedParameter, NoRig, NotDriven, OvershootNote, TrialFinding,
    TrialMachine, TrialReason, UnsettledEnd, WorstOf,
};
pub(crate) use required::BAND_WITH_ROOM;
pub use required::HeldRequirement;
pub(crate) use rigs::waves_only;
pub use rigs::with_waves;
pub use run::{Agreement, BAND_PERCENT, Leg, StepSize, TrialRun, TrialStep};
use run::{DrivenSteps, PredictedMachine};
pub use steps::REACH;

use crate::audit::ProjectAudit;
use crate::rig::RigError;
use crate::robust::RobustProblem;
use crate::setup::{ControlError, Setup};
use crate::side_by_side::side_by_side;
use crate::source::Source;
use phea_dynamics::linear::LinearError;
use phea_dynamics::time_response::TimeResponseError;
use phea_dynamics::watch::{Stopped, Watch, within};

/// Reason why a verdict cannot be tested on the machine.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrialError {
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The controller, prefilter or sensor is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The linear loop cannot be sampled.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// The step response of the linear loop cannot be measured.
    #[error("a response: {0}")]
    Time(#[from] TimeResponseError),
    /// The progress callback cancelled the trial.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Work for the corners of the box and the plants inside, in multiples of the work for one rig.
const CORNERS_FRACTION: f64 = 4.0;
/// Name of the stage in progress reports.
const STAGE: &str = "nonlinear simulation";

/// All runs, in the order in which they were simulated: the rig as declared first.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Runs, at least one.
    pub runs: Vec<TrialRun>,
    /// Simulated runs of all corners of the box and plants inside, whose worst are among `runs`.
    pub corners: Vec<TrialRun>,
    /// Plants for which no rig was found, with the reason, and steps that were omitted.
    pub not_driven: Vec<NotDriven>,
}

/// Condition for simulating the corners of the box and the plants inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrivenCorners {
    /// Always: a search needs the contribution of the rig there.
    Always,
    /// If everything else satisfies the requirements: a run that misses one gives as much
    /// information.
    WhereElseSatisfies,
}

/// Ratio to the required settling time beyond which a step in a narrower band lacks room.
const LATE_WITHOUT_ROOM: f64 = 1.1;

impl Trial {
    /// True if every run satisfies its requirements in time; `None` if nothing is required.
    pub fn satisfies(&self) -> Option<bool> {
        let required = self.runs.iter().any(|run| !run.requirements.is_empty());
        required.then(|| self.runs.iter().all(TrialRun::satisfies))
    }

    /// All runs, including those at the corners of the box and inside it.
    fn all(&self) -> impl Iterator<Item = &TrialRun> {
        self.runs.iter().chain(&self.corners)
    }

    /// Largest ratio of a reached property to the required one in all runs: at most 1 if all
    /// requirements in time are met, 0 without a run.
    pub(crate) fn worst_run(&self) -> f64 {
        self.all().map(TrialRun::excess).fold(0.0, f64::max)
    }

    /// Largest such ratio with room for the plants between the simulated ones.
    pub(crate) fn worst_run_with_room(&self) -> f64 {
        self.all().map(TrialRun::excess_with_room).fold(0.0, f64::max)
    }

    /// True if every run satisfies the requirements in time, but one swings back so near to the
    /// edge of its band that in nine tenths of the band it settles later than required by a tenth.
    pub fn lacks_room(&self) -> bool {
        self.worst_run() <= 1.0 && self.worst_run_with_room() > LATE_WITHOUT_ROOM
    }

    /// True if corners of the box were simulated, but not through the largest step.
    pub fn corners_lack_largest_step(&self) -> bool {
        let has_largest = |runs: &[TrialRun]| runs.iter().any(|run| run.size == StepSize::Largest);
        !self.corners.is_empty() && has_largest(&self.runs) && !has_largest(&self.corners)
    }

    /// Worst agreement of all runs.
    pub fn agreement(&self) -> Agreement {
        self.runs.iter().map(|run| run.agreement).max().unwrap_or(Agreement::Agrees)
    }
}

/// Simulates the machine of a project, whose controller is the audited one; `None` for a project
/// without an actuator.
///
/// # Errors
/// [`TrialError`] for a controller or a sensor that is not a transfer function, and for
/// cancellation by `watch`.
pub fn simulated_trial(
    source: &dyn Source,
    setup: &Setup<'_>,
    (problem, view): (&RobustProblem, &ProjectAudit),
    corners: DrivenCorners,
    watch: Watch<'_>,
) -> Result<Option<Trial>, TrialError> {
    if setup.project.actuator.is_none() {
        return Ok(None);
    }
    let rig = setup.rig()?;
    let (rigs, mut not_driven) = rigs::rigs(setup, rig, problem, view);
    let left_out = RequiredOfSteps::of(&problem.in_time).left_out((setup.project, rig));
    not_driven.extend(left_out.into_iter().map(NotDriven::SmallerStep));
    let count = rigs.len() as f64 + CORNERS_FRACTION;
    let from = rigs.len() as f64 / count;
    let all = driven(source, &rigs, problem, &mut within(&mut *watch, [0.0, 0.9 * from]))?;
    let mut runs: Vec<TrialRun> = Vec::new();
    for (index, (rig, own)) in rigs.iter().zip(&all).enumerate() {
        let driven = all.first().filter(|_| rig.is_declared).unwrap_or(own);
        let fraction = [index, index + 1].map(|done| from * (0.9 + 0.1 * done as f64 / rigs.len() as f64));
        for mut run in PredictedMachine::of(rig, problem)?.judged(driven, problem, view) {
            if rig.quarter_wave_rad_per_s.is_some() && run.agreement >= Agreement::Differs {
                let seen = (driven.as_slice(), &run, runs.as_slice());
                let declared = rigs.first().unwrap_or(rig);
                let on = (source, [rig, declared]);
                run.reason.cause = cause(on, seen, (problem, view), &mut within(&mut *watch, fraction))?;
            }
            runs.push(run);
        }
    }
    let mut trial = Trial { runs, corners: vec![], not_driven };
    let wanted = match corners {
        DrivenCorners::Always => trial.satisfies().is_some(),
        DrivenCorners::WhereElseSatisfies => trial.satisfies() == Some(true),
    };
    if wanted {
        trial.corners = runs_of_corners(source, setup, (problem, view), &mut within(watch, [from, 1.0]))?;
        trial.runs.extend(worst_of(&trial.corners));
    }
    Ok(Some(trial))
}

/// Steps of each rig; empty for one whose machine is that of the first, the rig as declared.
fn driven(
    source: &dyn Source,
    rigs: &[rigs::TrialRig],
    problem: &RobustProblem,
    watch: Watch<'_>,
) -> Result<Vec<Vec<DrivenSteps>>, TrialError> {
    let steps_of = |index: usize, watch: Watch<'_>| -> Result<Option<Vec<DrivenSteps>>, TrialError> {
        match rigs.get(index).filter(|rig| !rig.is_declared) {
            Some(rig) => PredictedMachine::of(rig, problem)?.driven(source, watch),
            None => Ok(Some(vec![])),
        }
    };
    let each = side_by_side(rigs.len(), STAGE, watch, |index, watch| steps_of(index, watch).transpose())?;
    each.into_iter().collect()
}

/// Cause of the disagreement of a run with waves in its lines: repeating the steps without the
/// noise of the sensors, and with lumped lines, distinguishes noise from waves.
fn cause(
    (source, [waves, declared]): (&dyn Source, [&rigs::TrialRig; 2]),
    (driven, run, runs): (&[DrivenSteps], &TrialRun, &[TrialRun]),
    (problem, view): (&RobustProblem, &ProjectAudit),
    watch: Watch<'_>,
) -> Result<Option<DifferenceCause>, TrialError> {
    let machine = PredictedMachine::of(waves, problem)?;
    let Some(steps) = driven.iter().find(|steps| steps.are_of(run)) else {
        return Ok(machine.cause_of_waves(run, None));
    };
    let mut repeated = |rig: &rigs::TrialRig| -> Result<TrialRun, TrialError> {
        let machine = PredictedMachine::of(rig, problem)?;
        let run = machine.repeated(source, steps, (problem, view), &mut *watch)?;
        Ok(run.ok_or(Stopped)?)
    };
    let quiet = [waves, declared].map(rigs::without_noise);
    let [quiet_waves, quiet_declared] = &quiet;
    if let Some(rig) = quiet_waves
        && repeated(rig)?.agreement < Agreement::Differs
    {
        return Ok(Some(DifferenceCause::Noise));
    }
    let is_same =
        |one: &&TrialRun| one.machine_driven == declared.machine && one.reference_n == run.reference_n;
    let known = runs.iter().find(is_same).filter(|_| quiet_declared.is_none());
    let lumped = match known {
        Some(known) => known.clone(),
        None => repeated(quiet_declared.as_ref().unwrap_or(declared))?,
    };
    Ok(machine.cause_of_waves(run, Some(&lumped)))
}
