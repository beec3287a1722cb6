//! Simulation of one machine through steps of its reference, and its result.

use super::first_steps::{FirstSteps, RequiredOfSteps};
use super::judge::{Driven, judge, met, not_started};
use super::prediction::{LONGEST_HOLD_S, LinearStep, SETTLING_TIMES};
use super::reason::{DampingWall, DifferenceCause, TrialFinding, TrialMachine, TrialReason};
use super::required::{HeldRequirement, held};
use super::rigs::TrialRig;
use super::steps::{CommandLimits, HeldLegs, Steps};
use super::{STAGE, TrialError};
use crate::audit::ProjectAudit;
use crate::linear_step::StepResponse;
use crate::plant_names::NamedPlant;
use crate::project::{LineMotion, Project};
use crate::quantity::Units;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::{
    RequiredSteps, RunOutput, RunStatus, ScenarioRun, SimulateError, simulate_into, stepped_references,
};
use crate::source::Source;
use phea_dynamics::simulation::Attention;
use phea_dynamics::watch::{Watch, part};

/// Agreement of a machine with its linear loop, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Agreement {
    /// The machine behaves as the linear loop predicts.
    Agrees,
    /// The machine behaves as predicted except for its settling time, which is within a factor of
    /// two of the prediction.
    AgreesButForSettling,
    /// The machine settles, but not as predicted, or meets a limit during the run.
    Differs,
    /// The machine does not behave as a met verdict promises.
    Contradicts,
}

/// Properties of a step response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialStep {
    /// Overshoot, percent of the step.
    pub overshoot_percent: Option<f64>,
    /// Settling time, s; `None` if the force does not settle within the run.
    pub settling_time_s: Option<f64>,
}

/// Size of the steps through which a machine is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepSize {
    /// A tenth of the force that the supply can produce.
    Tenth,
    /// A tenth of that force in the opposite direction.
    Reversed,
    /// The step of a scenario of the project.
    Scenario,
    /// The largest reachable step that meets no limit: see [`super::REACH`].
    Largest,
    /// The step that a requirement in time states.
    Required,
}

/// Steps of a run, in the order of simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leg {
    /// Step from the force of the operating point.
    There,
    /// Step back to the operating point.
    Back,
    /// Repetition of the first step.
    Again,
}

impl Leg {
    /// All steps of a run.
    pub const ALL: [Leg; 3] = [Leg::There, Leg::Back, Leg::Again];

    /// Steps up to this one.
    pub(super) fn up_to(last: Leg) -> impl Iterator<Item = Leg> {
        Leg::ALL.into_iter().take(last as usize + 1)
    }
}

/// Simulation of one machine through a step, the step back, and the step again.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialRun {
    /// The machine.
    pub machine_driven: TrialMachine,
    /// Size of the steps.
    pub size: StepSize,
    /// Plant of the audit from which the machine was made, if any.
    pub plant: Option<NamedPlant>,
    /// Status of the run: `completed`, or the cause of its early end.
    pub status: RunStatus,
    /// Reference before and after the first step, N; the second step returns, the third repeats the
    /// first.
    pub reference_n: [f64; 2],
    /// Prediction of the linear loop; `None` if it has no known response, or grows without bound.
    pub linear: Option<TrialStep>,
    /// Greatest overshoot and longest settling time of the machine's steps; `None` if the run did
    /// not start.
    pub machine: Option<TrialStep>,
    /// Overshoot and settling time of each simulated step: of the first one only, if that is
    /// decisive; empty if the run did not start.
    pub legs: Vec<(Leg, TrialStep)>,
    /// Worst step of the run.
    pub worst: Leg,
    /// Half the range of the force over the last fifth of a step, the largest of all steps, N: the
    /// amplitude of an oscillation that remains. `None` if the run ended earlier.
    pub remaining_amplitude_n: Option<f64>,
    /// Requirements in time of these steps, and whether the steps satisfy them; empty if the run
    /// did not start.
    pub requirements: Vec<HeldRequirement>,
    /// Units of display.
    pub units: Units,
    /// Response of the linear loop; empty if it is absent.
    pub linear_response: StepResponse,
    /// Response of the machine in its worst step; empty if the run did not start.
    pub machine_response: StepResponse,
    /// Agreement of the machine with the linear loop.
    pub agreement: Agreement,
    /// Result of the run, and the cause of a difference.
    pub reason: TrialReason,
    /// Quarter-wave frequency of the lines, rad/s, at which they begin to oscillate; `None` for a
    /// machine without waves.
    pub quarter_wave_rad_per_s: Option<f64>,
    /// Events during the run, by the names of occurrences: the limit of the command, cavitation, an
    /// end stop.
    pub met: Vec<&'static str>,
}

impl TrialRun {
    /// Largest ratio of a reached property of the steps to the required one; zero if nothing is
    /// required.
    pub(crate) fn excess(&self) -> f64 {
        self.requirements.iter().map(|held| held.step_limits.excess(&held.reached)).fold(0.0, f64::max)
    }

    /// Largest such ratio in a narrower band.
    pub(crate) fn excess_with_room(&self) -> f64 {
        let of = |held: &HeldRequirement| held.step_limits.excess(&held.reached_with_room);
        self.requirements.iter().map(of).fold(self.excess(), f64::max)
    }

    /// True if the steps satisfy all requirements in time.
    pub fn satisfies(&self) -> bool {
        self.requirements.iter().all(|held| held.is_satisfied)
    }
}

/// Band within which the force counts as settled, percent of the step.
pub const BAND_PERCENT: f64 = 2.0;
/// Duration of a step at a corner of the box, in settling times of the linear loop, and in required
/// settling times.
const SETTLING_TIMES_AT_CORNERS: f64 = 3.0;
const REQUIRED_TIMES: f64 = 2.0;
/// Ratio of the largest step to the first from which a separate run is worth its time.
const WORTH: f64 = 1.25;
/// Ratio below which no smaller step is simulated.
const LEAST: f64 = 0.2;
/// Factor by which a step that meets a limit is reduced, and number of such reductions.
const REDUCTION: f64 = 0.75;
const REDUCTIONS: usize = 6;

/// True if a run met a limit or an end stop.
fn is_limited(driven: &ScenarioRun) -> bool {
    driven.occurrences.iter().any(|one| one.begins) || !driven.exceeded.is_empty()
}

/// A run of the steps, or the reason why there is none.
type TrialOutcome = Result<ScenarioRun, SimulateError>;

/// Steps through which a machine was simulated, and their result.
pub(super) struct DrivenSteps {
    size: StepSize,
    required: RequiredSteps,
    steps: Steps,
    outcome: TrialOutcome,
}

/// A machine and the prediction of the linear loop for it.
pub(super) struct PredictedMachine<'a> {
    trial_rig: &'a TrialRig,
    linear: LinearStep,
    required: RequiredOfSteps,
    effort: TrialEffort,
}

/// Computational effort for a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TrialEffort {
    /// Runs are repeated at smaller tolerances.
    Repeated,
    /// Every run is made once.
    Once,
    /// Every run is made once, with shorter steps, only there and back, and no steps larger than
    /// those of the scenarios.
    Corner,
}

impl<'a> PredictedMachine<'a> {
    /// A machine with its prediction; the runs of a plant of the audit are not repeated.
    pub(super) fn of(
        trial_rig: &'a TrialRig,
        problem: &RobustProblem,
    ) -> Result<PredictedMachine<'a>, TrialError> {
        let required = RequiredOfSteps::of(&problem.in_time);
        let effort = if trial_rig.named.is_none() { TrialEffort::Repeated } else { TrialEffort::Once };
        Ok(PredictedMachine { trial_rig, linear: LinearStep::of(trial_rig, problem)?, required, effort })
    }

    /// The machine with the effort for a corner of the box.
    pub(super) fn at_corner(self) -> PredictedMachine<'a> {
        PredictedMachine { effort: TrialEffort::Corner, ..self }
    }

    /// Duration of each step, and the last step.
    fn legs(&self) -> HeldLegs {
        match self.effort {
            TrialEffort::Repeated | TrialEffort::Once => {
                HeldLegs { hold_s: self.linear.hold_s(SETTLING_TIMES), last: Leg::Again }
            }
            TrialEffort::Corner => {
                let seen_s = REQUIRED_TIMES * self.required.longest_s;
                let hold_s = self.linear.hold_s(SETTLING_TIMES_AT_CORNERS).max(seen_s.min(LONGEST_HOLD_S));
                HeldLegs { hold_s, last: Leg::Back }
            }
        }
    }

    /// True if steps larger than the first ones are simulated.
    fn drives_larger(&self) -> bool {
        let has_scenario_steps = !stepped_references(&self.trial_rig.project).is_empty();
        self.effort != TrialEffort::Corner || self.required.of_every_step && !has_scenario_steps
    }

    /// Simulates the machine through the first steps, then through the largest at which nothing
    /// saturates; `None` if `watch` cancels.
    pub(super) fn driven(
        &self,
        source: &dyn Source,
        watch: Watch<'_>,
    ) -> Result<Option<Vec<DrivenSteps>>, TrialError> {
        let setup = Setup::new(&self.trial_rig.project)?;
        let rig = setup.rig()?;
        let on = (source, &setup);
        let firsts = self.required.first_steps((&self.trial_rig.project, rig), self.legs());
        let (count, mut all) = (firsts.len() as f64, Vec::new());
        for (index, FirstSteps { size, required, steps }) in firsts.into_iter().enumerate() {
            let fraction = [index, index + 1].map(|done| 0.3 * done as f64 / count);
            let Some(outcome) = self.driven_by(on, &steps, &mut part(watch, STAGE, fraction)) else {
                return Ok(None);
            };
            all.push(DrivenSteps { size, required, steps, outcome });
        }
        let Some(DrivenSteps { outcome: Ok(driven), steps: first, .. }) = all.first() else {
            return Ok(Some(all));
        };
        if self.is_decided(first, driven) || !self.drives_larger() {
            return Ok(Some(all));
        }
        let first = *first;
        let was_limited = is_limited(driven);
        let mut steps = first.enlarged(rig, CommandLimits::of(setup.project, rig), driven);
        for reduction in 0..REDUCTIONS {
            let ratio = steps.size() / first.size();
            if (ratio < WORTH && !was_limited) || ratio < LEAST {
                break;
            }
            let from = 0.3 + 0.7 * reduction as f64 / REDUCTIONS as f64;
            let Some(outcome) = self.driven_by(on, &steps, &mut part(watch, STAGE, [from, 1.0])) else {
                return Ok(None);
            };
            if outcome.as_ref().is_ok_and(|driven| !is_limited(driven) && !steps.stalls(driven)) {
                let required = RequiredSteps::default();
                all.push(DrivenSteps { size: StepSize::Largest, required, steps, outcome });
                break;
            }
            steps = steps.scaled(REDUCTION);
        }
        Ok(Some(all))
    }

    /// Judgement of each run.
    pub(super) fn judged(
        &self,
        all: &[DrivenSteps],
        problem: &RobustProblem,
        view: &ProjectAudit,
    ) -> Vec<TrialRun> {
        all.iter().map(|driven| self.judgement(driven, (problem, view))).collect()
    }

    /// Simulates the machine; `None` if `watch` cancels. The first step is made first: if it is
    /// decisive, the other steps and the repetition at smaller tolerances would take most of the
    /// time.
    fn driven_by(
        &self,
        on: (&dyn Source, &Setup<'_>),
        steps: &Steps,
        watch: Watch<'_>,
    ) -> Option<TrialOutcome> {
        let once = RunOutput { repeats: false, ..RunOutput::new(true, None) };
        match self.effort {
            TrialEffort::Corner => {
                // the limit of a line only ends the search for a larger step
                let line_limits = self.drives_larger();
                let as_in_campaigns = RunOutput { attention: Attention::Steps, line_limits, ..once };
                return self.driven_up_to(on, (steps, steps.legs.last), as_in_campaigns, watch);
            }
            TrialEffort::Once => return self.driven_up_to(on, (steps, Leg::Again), once, watch),
            TrialEffort::Repeated => {}
        }
        let first = self.driven_up_to(on, (steps, Leg::There), once, &mut part(watch, STAGE, [0.0, 0.3]));
        if !matches!(&first, Some(Ok(driven)) if !self.is_decided(steps, driven)) {
            return first;
        }
        let whole = RunOutput::new(true, None);
        self.driven_up_to(on, (steps, Leg::Again), whole, &mut part(watch, STAGE, [0.3, 1.0]))
    }

    fn driven_up_to(
        &self,
        (source, setup): (&dyn Source, &Setup<'_>),
        (steps, last): (&Steps, Leg),
        output: RunOutput<'_>,
        watch: Watch<'_>,
    ) -> Option<TrialOutcome> {
        let project = steps.project(&self.trial_rig.project, last);
        match simulate_into(source, &setup.for_project(&project), output, watch) {
            Ok(runs) => runs.into_iter().next().filter(|driven| !driven.was_cancelled()).map(Ok),
            Err(error) => Some(Err(error)),
        }
    }

    /// True if the first step of a run is decisive: the run ends early or diverges, or settles as
    /// little as the unstable linear loop.
    fn is_decided(&self, steps: &Steps, driven: &ScenarioRun) -> bool {
        let settles = steps.step(driven, Leg::There).settling_time_s.is_some();
        driven.stopped().is_some() || (self.linear.grows && !settles)
    }

    fn judgement(
        &self,
        DrivenSteps { size, required, steps, outcome }: &DrivenSteps,
        (problem, view): (&RobustProblem, &ProjectAudit),
    ) -> TrialRun {
        let size = *size;
        let LinearStep { step: linear, ref response, grows } = self.linear;
        let blank = TrialRun {
            machine_driven: self.trial_rig.machine.clone(),
            size,
            plant: self.trial_rig.named.clone(),
            status: RunStatus::NotStarted,
            reference_n: [steps.from_n, steps.to_n],
            linear,
            machine: None,
            legs: vec![],
            worst: Leg::There,
            remaining_amplitude_n: None,
            requirements: vec![],
            units: self.trial_rig.project.units,
            linear_response: response.clone(),
            machine_response: StepResponse::default(),
            agreement: Agreement::Differs,
            reason: TrialFinding::NeitherSettles { overshoots: None }.into(),
            quarter_wave_rad_per_s: self.trial_rig.quarter_wave_rad_per_s,
            met: vec![],
        };
        let run = match outcome {
            Ok(run) => run,
            Err(error) => {
                let (agreement, finding) = not_started(error, view);
                return TrialRun { agreement, reason: finding.into(), ..blank };
            }
        };
        let legs: Vec<(Leg, TrialStep)> = steps.driven().map(|leg| (leg, steps.step(run, leg))).collect();
        let driven = Driven { run, steps, size, legs: &legs, linear, grows };
        let (agreement, finding) = judge(&driven, problem, view);
        TrialRun {
            status: run.run_status(),
            machine: Some(driven.whole()),
            worst: driven.worst(),
            remaining_amplitude_n: driven.remains().map(|[low, high]| 0.5 * (high - low)),
            requirements: held(&problem.in_time, steps, (*required, run)),
            machine_response: steps.response(run, driven.worst()),
            agreement,
            reason: finding.into(),
            met: met(run),
            legs: legs.into_iter().take(run.windows.len()).collect(),
            ..blank
        }
    }

    /// Simulates the machine through the steps of another one; `None` if `watch` cancels.
    pub(super) fn repeated(
        &self,
        source: &dyn Source,
        other: &DrivenSteps,
        (problem, view): (&RobustProblem, &ProjectAudit),
        watch: Watch<'_>,
    ) -> Result<Option<TrialRun>, TrialError> {
        let setup = Setup::new(&self.trial_rig.project)?;
        let Some(outcome) = self.driven_by((source, &setup), &other.steps, watch) else { return Ok(None) };
        let DrivenSteps { size, required, steps, .. } = *other;
        Ok(Some(self.judgement(&DrivenSteps { size, required, steps, outcome }, (problem, view))))
    }

    /// Cause of the disagreement of a run with waves: the waves, unless the rig with lumped lines
    /// agrees as little in these steps.
    pub(super) fn cause_of_waves(
        &self,
        run: &TrialRun,
        lumped: Option<&TrialRun>,
    ) -> Option<DifferenceCause> {
        let quarter_wave = self.trial_rig.quarter_wave_rad_per_s?;
        if lumped.is_some_and(|lumped| lumped.agreement >= run.agreement) {
            return Some(DifferenceCause::OtherThanWaves);
        }
        Some(DifferenceCause::Waves { quarter_wave, wall: damping_wall(&self.trial_rig.project) })
    }
}

impl DrivenSteps {
    /// True if these are the steps of `run`.
    pub(super) fn are_of(&self, run: &TrialRun) -> bool {
        self.size == run.size && [self.steps.from_n, self.steps.to_n] == run.reference_n
    }
}

/// Declaration of a wall that damps a wave in these lines, if their models include one; pipes have
/// none.
fn damping_wall(project: &Project) -> Option<DampingWall> {
    let line = &project.actuator.as_ref()?.line;
    let mut models = [&line.a, &line.b]
        .into_iter()
        .filter(|side| side.hose().is_some())
        .map(|side| &side.motion)
        .peekable();
    models.peek()?;
    let has_segments = |model| matches!(model, &LineMotion::Segments(_) | &LineMotion::Creeping { .. });
    Some(match models.all(has_segments) {
        true => DampingWall::RelaxationTime,
        false => DampingWall::SegmentsWithRelaxationTime,
    })
}
