//! One run, ready to be simulated, with its observer.

use std::cell::RefCell;
use std::rc::Rc;

use phea_dynamics::simulation::{
    Amplification, Attention, Input, InputSchedule, Observer, Outcome, Sampler, SimulationError,
    SimulationSettings, Stretch, Task,
};
use phea_hydraulics::machine::MachineOptions;
use phea_machine::{Control, ControllerSamples, Digital, Watcher};

use super::plan::{Draw, Plan};
use super::range::OutsideRange;
use super::row::{Ran, Row, RowOutcome, numbers};
use crate::rig::{RigError, actuator};
use crate::setup::Setup;
use crate::simulate::{
    COMMAND_LIMIT, ControlledMachine, Divergence, ERRORS_AMPLIFIED, Follower, LineLimits, LineWatch,
    Occurrence, PassAgreement, PassPlan, PassResult, PreparedScenario, REPEATED, Repetition, SimulateError,
    StoppedRun, amplification, machine_of, moved, occurrences, outside_model_s, prepared_scenario_of,
    run_status,
};

/// A run that is ready to be simulated.
pub(super) struct Prepared {
    pub(super) draw: Draw,
    pub(super) lumps: Option<[f64; 3]>,
    /// Controller around this machine.
    pub(super) bench: ControlledMachine,
    schedule: InputSchedule,
    scenario: PreparedScenario,
    /// Samples of a sampled controller.
    log: RefCell<ControllerSamples>,
}

/// Reason why a run cannot start.
#[derive(Debug, thiserror::Error)]
enum DrawError {
    /// The project does not accept a drawn number.
    #[error(transparent)]
    OutsideRange(#[from] OutsideRange),
    /// The path of a drawn number is not in the project.
    #[error("a path leads to no number")]
    NoNumber,
    /// The machine is invalid, or it cannot start in this state.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

/// Makes the machine of a draw.
///
/// # Errors
/// The row with the reason why the run cannot start.
pub(super) fn prepared(plan: &Plan, draw: Draw) -> Result<Prepared, Box<Row>> {
    let refused = |reason: DrawError, lumps| {
        let (run, values) = (draw.run, draw.values.clone());
        Box::new(Row { run, values, lumps, outcome: RowOutcome::Refused(reason.to_string()) })
    };
    let outside = plan.ranges().iter().zip(&draw.values).find_map(|(range, value)| range.problem(*value));
    if let Some(outside) = outside {
        return Err(refused(outside.into(), None));
    }
    let project = plan.drawn(&draw).ok_or_else(|| refused(DrawError::NoNumber, None))?;
    let rig = Setup::rig_of(&project).ok();
    let lumps = rig.as_ref().map(|rig| {
        let linear = rig.derived;
        [linear.hydraulic_stiffness, linear.flow_gain, linear.flow_pressure_coefficient]
    });
    let made = || -> Result<_, SimulateError> {
        let declared = project.actuator.as_ref().ok_or(RigError::NoActuator)?;
        let actuator = match rig {
            Some(rig) => rig.actuator,
            None => actuator(declared).map_err(RigError::from)?,
        };
        let external_force = plan.bench.machine.has_external_force();
        let moving_setting = plan.bench.machine.has_moving_setting();
        let driven = MachineOptions { external_force, moving_setting, ..MachineOptions::default() };
        let machine = machine_of(&project, &actuator, &driven)?;
        let mut bench = plan.bench.around(machine, actuator);
        bench.line_limits = LineLimits::of(&project);
        if let (Control::Sampled(sampled), Some(seed)) = (&mut bench.control, draw.noise_seed) {
            sampled.seed = u64::from(seed);
        }
        let schedule = prepared_scenario_of(&plan.driven, &bench, &plan.drawn_scenario(&draw))?;
        Ok((bench, schedule))
    };
    let (bench, schedule) = made().map_err(|error| refused(error.into(), lumps))?;
    let driving = schedule.machine_inputs();
    let reference = Input::Value(schedule.reference.clone());
    let first = match &bench.control {
        Control::Continuous(_) => vec![reference],
        Control::Sampled(_) => vec![Input::Command, reference],
        Control::Open(_) => vec![Input::Value(schedule.command.clone()), reference],
    };
    let inputs = first.into_iter().chain(driving).collect();
    let scenario = &plan.scenario;
    Ok(Prepared {
        draw,
        lumps,
        bench,
        schedule: InputSchedule {
            duration_s: scenario.duration,
            output_step_s: scenario.output_step,
            inputs,
        },
        scenario: schedule,
        log: RefCell::default(),
    })
}

impl Prepared {
    /// Task for a lane.
    pub(super) fn task<'a>(&'a self, observer: Watcher<'a>) -> Task<'a, Watcher<'a>> {
        self.task_from(self.scenario.start.clone(), observer)
    }

    fn task_from<'a>(&'a self, start: Vec<f64>, observer: Watcher<'a>) -> Task<'a, Watcher<'a>> {
        let sampler: Option<Box<dyn Sampler + 'a>> = match &self.bench.control {
            Control::Continuous(_) | Control::Open(_) => None,
            Control::Sampled(sampled) => {
                Some(Box::new(Digital::new(sampled, &self.scenario.waking, &self.log)))
            }
        };
        Task { start, schedule: &self.schedule, sampler, observer }
    }

    /// Repeats the run singly; its watcher cancels it by returning false.
    pub(super) fn again<'a>(
        &'a self,
        plan: &'a Plan,
        (pass, every_sample): (PassPlan, bool),
        watch: &mut dyn FnMut() -> bool,
    ) -> Result<DrivenPass<'a>, SimulationError> {
        self.log.replace(ControllerSamples::default());
        let mut start = self.scenario.start.clone();
        if pass.moved {
            moved(&mut start, &self.bench.control.scales());
        }
        let watched = Watched::new(plan, self, every_sample);
        let settings = SimulationSettings { tolerance: pass.tolerance, ..self.bench.settings };
        let task = self.task_from(start, watched.watcher());
        let outcome = self.bench.control.drive(task, &settings, &mut |_| watch())?;
        Ok(self.driven(outcome, watched))
    }

    /// A simulated run, with the samples of its controller.
    pub(super) fn driven<'a>(&self, outcome: Outcome, watched: Watched<'a>) -> DrivenPass<'a> {
        let inputs = self.scenario.other_inputs();
        let divergence = watched.seen.borrow().follower.divergence(&inputs);
        DrivenPass { outcome, watched, divergence, log: self.log.borrow().clone() }
    }

    /// Row with the results of a pass.
    pub(super) fn row(&self, pass: &DrivenPass<'_>, repetition: Option<&Repetition>) -> Row {
        let DrivenPass { outcome, watched, .. } = pass;
        let seen = watched.seen.borrow();
        let metrics = seen.follower.metrics();
        let stopped = StoppedRun::of(outcome.status);
        let stopped = stopped.or_else(|| pass.divergence.as_ref().map(StoppedRun::diverged));
        let mut kinds: Vec<&'static str> = Vec::new();
        let of_lines = seen.lines.found().filter_map(|exceeded| Occurrence::of(&exceeded));
        let all: Vec<Occurrence> = self.occurrences(pass).into_iter().chain(of_lines).collect();
        let outside_s = outside_model_s(&all, self.bench.machine.has_end_stops());
        let undetermined = repetition.is_some_and(|repetition| !repetition.is_determined());
        for occurrence in all.iter().filter(|occurrence| occurrence.begins) {
            if !kinds.contains(&occurrence.kind) {
                kinds.push(occurrence.kind);
            }
        }
        let agreed = |repetition: &Repetition| repetition.agreement == PassAgreement::Agreed;
        let doubt =
            pass.amplification().is_some_and(|grown| grown.may_show_errors(self.bench.settings.tolerance));
        match repetition {
            Some(repetition) if agreed(repetition) => kinds.push(REPEATED),
            Some(_) => kinds.push(ERRORS_AMPLIFIED),
            None if doubt => kinds.push(ERRORS_AMPLIFIED),
            None => {}
        }
        let ran = Ran {
            status: run_status(stopped, outside_s, undetermined),
            end_time_s: stopped.map(|stopped| stopped.time_s),
            steps: outcome.work.steps,
            occurrences: kinds,
            metrics: metrics.iter().map(numbers).collect(),
            force_n: seen.of_bands().map(|force| force as f32).collect(),
        };
        Row {
            run: self.draw.run,
            values: self.draw.values.clone(),
            lumps: self.lumps,
            outcome: RowOutcome::Driven(ran),
        }
    }

    fn occurrences(&self, DrivenPass { outcome, log, .. }: &DrivenPass<'_>) -> Vec<Occurrence> {
        let value = |input: &Input| match input {
            Input::Value(profile) => profile.value(0.0),
            Input::Rate(profile) => profile.rate(0.0),
            Input::Command => 0.0,
        };
        let mut first: Vec<f64> = self.schedule.inputs.iter().map(value).collect();
        let control = &self.bench.control;
        let [states, _] = control.size();
        let start = &self.scenario.start;
        first.extend(start.iter().skip(states));
        let mut found = occurrences(control, start, &first, &outcome.events);
        if let Some((time_s, begins)) = log.limits.first().copied() {
            found.push(Occurrence { time_s, kind: COMMAND_LIMIT, begins });
        }
        found
    }
}

/// A run that was simulated to its end, or to an early end.
pub(super) struct DrivenPass<'a> {
    outcome: Outcome,
    watched: Watched<'a>,
    divergence: Option<Divergence>,
    /// Samples of a sampled controller.
    log: ControllerSamples,
}

impl DrivenPass<'_> {
    fn amplification(&self) -> Option<Amplification> {
        amplification(&self.outcome, &self.log)
    }

    /// The part of the results by which passes are compared.
    pub(super) fn result(&self) -> PassResult {
        let seen = self.watched.seen.borrow();
        let windows = seen.plan.windows().iter().copied();
        PassResult {
            status: self.outcome.status,
            work: self.outcome.work,
            amplification: self.amplification(),
            swings: self.divergence.as_ref().is_some_and(Divergence::swings),
            metrics: windows.zip(seen.follower.metrics()).collect(),
            force_n: seen.of_bands().collect(),
        }
    }

    /// Recorded forces at all times, N.
    pub(super) fn force_n(&self) -> Vec<f64> {
        self.watched.force_n()
    }
}

/// Observer of a run, for progress and for its result.
pub(super) struct Watched<'a> {
    plan: &'a Plan,
    seen: Rc<RefCell<Seen<'a>>>,
}

/// Force and command of a run.
struct Seen<'a> {
    plan: &'a Plan,
    follower: Follower<'a>,
    lines: LineWatch,
    /// True if the force at all recorded times is stored, false if only at those of the bands.
    every_sample: bool,
    /// Force, N.
    force_n: Vec<f64>,
}

impl<'a> Watched<'a> {
    pub(super) fn new(plan: &'a Plan, prepared: &'a Prepared, every_sample: bool) -> Watched<'a> {
        let windows = (plan.windows(), plan.scenario.settling_band_percent, plan.scenario.duration);
        let reference = &plan.driven.reference;
        let follower = Follower::of(&prepared.bench, &plan.look, &prepared.log, reference, windows);
        let kept = if every_sample { plan.times_s.len() } else { plan.band_samples.len() };
        let lines = LineWatch::of(&prepared.bench, &plan.look);
        let seen = Seen { plan, follower, lines, every_sample, force_n: Vec::with_capacity(kept) };
        Watched { plan, seen: Rc::new(RefCell::new(seen)) }
    }

    /// Observer that watches the run.
    pub(super) fn watcher(&self) -> Watcher<'a> {
        Box::new(Watched { plan: self.plan, seen: Rc::clone(&self.seen) })
    }

    fn force_n(&self) -> Vec<f64> {
        self.seen.borrow().force_n.clone()
    }
}

impl Seen<'_> {
    /// Force at the times of the bands, up to the end of the run, N.
    fn of_bands(&self) -> impl Iterator<Item = f64> {
        let places = self.plan.band_samples.iter().enumerate();
        places.map_while(|(place, look)| {
            self.force_n.get(if self.every_sample { *look } else { place }).copied()
        })
    }
}

impl Observer for Watched<'_> {
    fn wanted(&self) -> &[usize] {
        &self.plan.look
    }

    fn wants_row(&self, row: u64) -> bool {
        let seen = self.seen.borrow();
        let next = self.plan.band_samples.get(seen.force_n.len());
        seen.every_sample || next.is_some_and(|look| *look as u64 == row)
    }

    fn observe(&mut self, _time_s: f64, states: &[f64], _inputs: &[f64]) {
        let seen = &mut *self.seen.borrow_mut();
        seen.force_n.push(seen.follower.force_n(states));
    }

    fn wants_inputs(&self) -> bool {
        false
    }

    fn attention(&self) -> Attention {
        Attention::Steps
    }

    fn follow(&mut self, stretch: &Stretch<'_>) {
        let seen = &mut *self.seen.borrow_mut();
        seen.follower.follow(stretch);
        seen.lines.follow(stretch);
    }

    fn needs_accurate_solution(&self, stretch: &Stretch<'_>) -> bool {
        self.seen.borrow().follower.needs_accurate_solution(stretch)
    }
}
