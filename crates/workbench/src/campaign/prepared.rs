//! One run, ready to be driven, and who looks at it.

use std::cell::RefCell;

use phea_dynamics::simulation::{Course, Input, Observer, Outcome, Plant, Sampler, System, Task};
use phea_hydraulics::machine::{Machine, MachineOptions};

use super::plan::{Draw, Plan};
use super::row::{Ran, Row, RowOutcome, numbers};
use crate::rig::{Rig, RigError, actuator};
use crate::simulate::{
    Bench, COMMAND_LIMIT, Control, Digital, Occurrence, Samples, Seen, SimulateError, Stopped, Waking,
    course_of, metrics_seen, occurrences, options,
};

/// A run ready to be driven.
pub(super) struct Prepared {
    pub(super) draw: Draw,
    pub(super) lumps: Option<[f64; 3]>,
    /// The controller around this machine.
    pub(super) bench: Bench,
    course: Course,
    start: Vec<f64>,
    waking: Waking,
    /// What a sampled controller did.
    log: RefCell<Samples>,
}

/// Makes the machine of a draw.
///
/// # Errors
/// Why there is none, as a row.
pub(super) fn prepared(plan: &Plan, draw: Draw) -> Result<Prepared, Box<Row>> {
    let refused = |reason: String, lumps| {
        let (run, values) = (draw.run, draw.values.clone());
        Box::new(Row { run, values, lumps, outcome: RowOutcome::Refused(reason) })
    };
    let outside = plan.ranges().iter().zip(&draw.values).find_map(|(range, value)| range.problem(*value));
    if let Some(problem) = outside {
        return Err(refused(problem, None));
    }
    let project = plan.drawn(&draw).ok_or_else(|| refused("a path leads to no number".to_string(), None))?;
    let lumps = Rig::new(&project).ok().map(|rig| {
        let linear = rig.derived;
        [linear.hydraulic_stiffness, linear.flow_gain, linear.flow_pressure_coefficient]
    });
    let made = || -> Result<_, SimulateError> {
        let declared = project.actuator.as_ref().ok_or(RigError::NoActuator)?;
        let actuator = actuator(declared).map_err(RigError::from)?;
        let external_force = plan.bench.machine.has_external_force();
        let options = MachineOptions { external_force, ..options(&project, &actuator)? };
        let machine = Machine::new(&actuator, &options).map_err(SimulateError::Machine)?;
        let mut bench = plan.bench.around(machine, actuator);
        if let (Control::Sampled(sampled), Some(seed)) = (&mut bench.control, draw.noise_seed) {
            sampled.seed = u64::from(seed);
        }
        let course = course_of(&plan.driven, &bench, &plan.drawn_scenario(&draw))?;
        Ok((bench, course))
    };
    let (bench, course) = made().map_err(|error| refused(error.to_string(), lumps))?;
    let driving = course.machine_inputs();
    let reference = Input::Value(course.reference);
    let first = match &bench.control {
        Control::Continuous(_) => vec![reference],
        Control::Sampled(_) => vec![Input::Command, reference],
        Control::Open(_) => vec![Input::Value(course.command), reference],
    };
    let inputs = first.into_iter().chain(driving).collect();
    let scenario = &plan.scenario;
    Ok(Prepared {
        draw,
        lumps,
        bench,
        course: Course { duration_s: scenario.duration, output_step_s: scenario.output_step, inputs },
        start: course.start,
        waking: course.waking,
        log: RefCell::default(),
    })
}

impl Prepared {
    /// What is to be done in a lane.
    pub(super) fn task<'a>(&'a self, plan: &'a Plan) -> Task<'a, Watched<'a>> {
        let sampler: Option<Box<dyn Sampler + 'a>> = match &self.bench.control {
            Control::Continuous(_) | Control::Open(_) => None,
            Control::Sampled(sampled) => Some(Box::new(Digital::new(sampled, &self.waking, &self.log))),
        };
        let observer = Watched::new(plan, self);
        Task { start: self.start.clone(), course: &self.course, sampler, observer }
    }

    /// How many states and inputs there are.
    fn size(&self) -> (usize, usize) {
        match &self.bench.control {
            Control::Continuous(closed) => {
                (System::<f64>::states(closed.as_ref()), System::<f64>::inputs(closed.as_ref()))
            }
            Control::Sampled(sampled) => {
                (System::<f64>::states(&sampled.held), System::<f64>::inputs(&sampled.held))
            }
            Control::Open(held) => {
                (System::<f64>::states(held.as_ref()), System::<f64>::inputs(held.as_ref()))
            }
        }
    }

    /// The machine's own force, whatever a sensor makes of it, and what a continuous controller wants before the limit.
    fn signals(&self, state: &[f64], inputs: &[f64]) -> (f64, f64) {
        let force = |others: usize| self.bench.machine.measurement(state, &inputs[others..]);
        match &self.bench.control {
            Control::Continuous(closed) => (force(1), closed.signals::<f64, f64>(state, inputs).wanted),
            Control::Sampled(_) => (force(2), 0.0),
            Control::Open(_) => (force(2), inputs.first().copied().unwrap_or_default()),
        }
    }

    /// What came of it.
    pub(super) fn row(&self, plan: &Plan, outcome: &Outcome, seen: &Watched<'_>) -> Row {
        let looks = seen.force_n.len().min(plan.times_s.len());
        let all = Seen {
            times_s: plan.times_s.get(..looks).unwrap_or_default(),
            force_n: seen.force_n.get(..looks).unwrap_or_default(),
            reference_n: plan.reference_n.get(..looks).unwrap_or_default(),
            control_v: seen.control_v.get(..looks).unwrap_or_default(),
        };
        let band = plan.scenario.settling_band_percent;
        let metrics = plan.windows().iter().map(|window| numbers(&metrics_seen(&all, *window, band)));
        let stopped = Stopped::of(outcome.status);
        let mut kinds: Vec<&'static str> = Vec::new();
        for occurrence in self.occurrences(outcome).iter().filter(|occurrence| occurrence.begins) {
            if !kinds.contains(&occurrence.kind) {
                kinds.push(occurrence.kind);
            }
        }
        let seen_at = plan.band_looks.iter().map_while(|look| all.force_n.get(*look));
        let ran = Ran {
            status: stopped.map_or("completed", |stopped| stopped.word),
            ended_s: stopped.map(|stopped| stopped.time_s),
            steps: outcome.work.steps,
            occurrences: kinds,
            metrics: metrics.collect(),
            force_n: seen_at.map(|force| *force as f32).collect(),
        };
        Row {
            run: self.draw.run,
            values: self.draw.values.clone(),
            lumps: self.lumps,
            outcome: RowOutcome::Driven(ran),
        }
    }

    fn occurrences(&self, outcome: &Outcome) -> Vec<Occurrence> {
        let value = |input: &Input| match input {
            Input::Value(profile) => profile.value(0.0),
            Input::Rate(profile) => profile.rate(0.0),
            Input::Command => 0.0,
        };
        let mut first: Vec<f64> = self.course.inputs.iter().map(value).collect();
        match &self.bench.control {
            Control::Continuous(closed) => {
                first.extend(self.start.iter().skip(System::<f64>::states(closed.as_ref())));
                occurrences(closed.as_ref(), &self.start, &first, &outcome.events)
            }
            Control::Sampled(sampled) => {
                first.extend(self.start.iter().skip(System::<f64>::states(&sampled.held)));
                let mut found = occurrences(&sampled.held, &self.start, &first, &outcome.events);
                if let Some((time_s, begins)) = self.log.borrow().limits.first().copied() {
                    found.push(Occurrence { time_s, kind: COMMAND_LIMIT, begins });
                }
                found
            }
            Control::Open(held) => {
                first.extend(self.start.iter().skip(System::<f64>::states(held.as_ref())));
                occurrences(held.as_ref(), &self.start, &first, &outcome.events)
            }
        }
    }
}

/// Looks at force and command, which are sums of states and inputs with weights that a machine keeps.
///
/// ```text
/// F_e = sum of f_i v_i,    u = sum of g_i v_i within its limit          v the states that matter, then the inputs
/// ```
pub(super) struct Watched<'a> {
    plan: &'a Plan,
    prepared: &'a Prepared,
    /// Those that are not zero, each with the place of its value among the states that matter and then the inputs.
    force_weights: Vec<(usize, f64)>,
    /// Of a continuous controller.
    command_weights: Vec<(usize, f64)>,
    pub(super) force_n: Vec<f64>,
    control_v: Vec<f64>,
}

impl<'a> Watched<'a> {
    fn new(plan: &'a Plan, prepared: &'a Prepared) -> Watched<'a> {
        let (states, inputs) = prepared.size();
        let places = &plan.look.states;
        let count = places.len() + inputs;
        let (mut force_weights, mut command_weights) = (Vec::new(), Vec::new());
        for index in 0..count {
            let (mut state, mut input) = (vec![0.0; states], vec![0.0; inputs]);
            match places.get(index) {
                Some(place) => state[*place] = 1.0,
                None => input[index - places.len()] = 1.0,
            }
            let (force, command) = prepared.signals(&state, &input);
            force_weights.push((index, force));
            command_weights.push((index, command));
        }
        force_weights.retain(|(_, weight)| *weight != 0.0);
        command_weights.retain(|(_, weight)| *weight != 0.0);
        let looks = plan.times_s.len();
        Watched {
            plan,
            prepared,
            force_weights,
            command_weights,
            force_n: Vec::with_capacity(looks),
            control_v: Vec::with_capacity(looks),
        }
    }
}

impl Observer for Watched<'_> {
    fn wanted(&self) -> &[usize] {
        &self.plan.look.states
    }

    fn observe(&mut self, _time_s: f64, states: &[f64], inputs: &[f64]) {
        let reference = [self.plan.reference_n.get(self.force_n.len()).copied().unwrap_or_default()];
        let driving = if self.plan.look.inputs { inputs } else { &reference };
        let sum = |weights: &[(usize, f64)]| {
            weights.iter().fold(0.0, |sum, &(place, weight)| {
                let driven = || driving.get(place - states.len());
                sum + weight * states.get(place).or_else(driven).copied().unwrap_or_default()
            })
        };
        let command = match &self.prepared.bench.control {
            Control::Open(_) => sum(&self.command_weights),
            Control::Continuous(_) => sum(&self.command_weights).clamp(-self.plan.limit, self.plan.limit),
            Control::Sampled(_) => self.prepared.log.borrow().last.map_or(0.0, |sample| sample.command_v),
        };
        self.force_n.push(sum(&self.force_weights));
        self.control_v.push(command);
    }

    fn wants_inputs(&self) -> bool {
        self.plan.look.inputs
    }
}
