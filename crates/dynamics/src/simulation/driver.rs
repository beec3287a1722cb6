//! Simulation of systems under their input schedules, one in each lane.

mod between;
mod joined;
mod queued;

pub use queued::drive;

use super::Lane;
use super::carried::CarriedErrors;
use super::frozen::{Frozen, FrozenWatch};
use super::growth::GrowthWatch;
use super::history::NODES;
use super::interface::{
    Amplification, Attention, Event, Observer, Outcome, SimulationError, SimulationSettings, Status,
};
use super::kernel::Kernel;
use super::method::{Extension, StepInputs, Stepper};
use super::passage::Passage;
use super::propagator::Propagator;
use super::quartic::Quartic;
use super::slot::Slot;
use super::task::{Task, check};
use crate::order::sort_by_number;

/// All lanes and their common method.
struct Drive<'a, S, O> {
    method: Stepper<S>,
    /// The known modes of each lane.
    watches: Vec<GrowthWatch>,
    /// The growth of slower modes, and of those that delays close, in each lane without samples.
    frozen: Vec<FrozenWatch>,
    /// Exact steps of lanes that are sampled.
    propagator: Propagator<S>,
    /// Small error in each lane, propagated along its run.
    carried: CarriedErrors<S>,
    settings: SimulationSettings,
    slots: Vec<Option<Slot<'a, O>>>,
    state: Vec<S>,
    /// True if a state or its input differs from the last point of linearisation.
    fresh: bool,
    step: S,
    inputs: StepInputs<S>,
    indicators: Vec<S>,
    /// Marks of the kinks at the start of the step.
    marks: Vec<S>,
    /// Error inside a step.
    between: ErrorBetween<S>,
}

struct ErrorBetween<S> {
    /// Requested states over the step.
    extensions: Vec<Option<Extension<S>>>,
    /// True if the step used precomputed matrices.
    propagated: bool,
    /// States required by an observer, in its lane.
    wanted: Vec<Extension<f64>>,
    /// Required states as polynomials.
    quartics: Vec<Quartic>,
    /// State at the end of the step.
    end: Vec<S>,
    state: Vec<S>,
    inputs: Vec<S>,
    indicators: Vec<S>,
    /// Indicators at the end of the step.
    ends: Vec<S>,
    /// Marks at the end of the step, and within it.
    marks: Vec<S>,
    marked: Vec<S>,
    waves: Vec<S>,
}

impl<'a, S: Lane, O: Observer> Drive<'a, S, O> {
    fn new(system: &dyn Kernel<S>, settings: &SimulationSettings) -> Result<Self, SimulationError> {
        let (states, inputs, zero) = (system.states(), system.inputs(), S::from(0.0));
        let kinks = system.kinks();
        let method =
            Stepper::new(settings.method, system).ok_or(SimulationError::TooLarge { states, inputs })?;
        let none = vec![zero; inputs];
        let delayed = !system.delays().is_empty();
        let watch = GrowthWatch::new(system.sliding(), method.jacobian(), method.amplitude_lost(), delayed);
        let stages = [none.clone(), none.clone(), none.clone(), none.clone(), none.clone(), none.clone()];
        Ok(Drive {
            method,
            watches: vec![watch; S::COUNT],
            frozen: vec![FrozenWatch::default(); S::COUNT],
            propagator: Propagator::new(states),
            carried: CarriedErrors::new(states),
            settings: *settings,
            slots: (0..S::COUNT).map(|_| None).collect(),
            state: vec![zero; states],
            fresh: true,
            step: S::from(1e-6),
            inputs: StepInputs { stages, slopes: none.clone(), moving: false },
            indicators: vec![zero; system.indicators()],
            marks: vec![zero; kinks],
            between: ErrorBetween {
                extensions: vec![None; states],
                propagated: false,
                wanted: Vec::new(),
                quartics: Vec::new(),
                end: vec![zero; states],
                state: vec![zero; states],
                inputs: none,
                indicators: vec![zero; system.indicators()],
                ends: vec![zero; system.indicators()],
                marks: vec![zero; kinks],
                marked: vec![zero; kinks],
                waves: vec![zero; system.delays().len()],
            },
        })
    }

    /// Inserts a machine into a free lane.
    fn enter(
        &mut self,
        system: &dyn Kernel<S>,
        lane: usize,
        task: Task<'a, O>,
    ) -> Result<(), SimulationError> {
        let delays: Vec<f64> = system.delays().iter().map(|delay| delay.lane(lane)).collect();
        check(system, &task, lane, &delays)?;
        for (state, &value) in self.state.iter_mut().zip(&task.start) {
            state.set_lane(lane, value);
        }
        self.method.scales = system.scales();
        let held = task.sampler.as_ref().map_or(0.0, |sampler| sampler.held());
        let mut passage = Passage::new(task.schedule, held);
        let mut inputs = vec![0.0; system.inputs()];
        passage.inputs_at(0.0, &mut inputs);
        if !delays.is_empty() {
            set_lane(&mut self.between.inputs, lane, &inputs);
            system.outgoing(&self.state, &self.between.inputs, &mut self.between.waves);
            let sent: Vec<f64> = self.between.waves.iter().map(|wave| wave.lane(lane)).collect();
            let told = task.start.get(self.state.len()..).filter(|told| !told.is_empty());
            passage = passage.with_waves(&delays, told.unwrap_or(&sent));
            passage.inputs_at(0.0, &mut inputs);
        }
        set_lane(&mut self.between.inputs, lane, &inputs);
        system.rates(&self.state, &self.between.inputs, &mut self.between.state);
        passage.begin(self.method.magnitude(&self.between.state, &self.state, lane), self.settings.tolerance);
        if !self.indicators.is_empty() {
            system.indicate(&self.state, &self.between.inputs, &mut self.between.indicators);
            for (kept, new) in self.indicators.iter_mut().zip(&self.between.indicators) {
                kept.set_lane(lane, new.lane(lane));
            }
        }
        if !self.marks.is_empty() {
            system.mark(&self.state, &self.between.inputs, &mut self.between.marks);
            self.keep_marks(lane);
        }
        self.fresh = true;
        self.propagator.forget(lane);
        self.watches[lane].forget();
        self.frozen[lane] = FrozenWatch::default();
        self.carried.forget(lane);
        let states = vec![0.0; system.states()];
        let Task { sampler, observer, .. } = task;
        passage.attention = observer.attention();
        self.slots[lane] =
            Some(Slot { passage, sampler, observer, unwatched: 1, propagated: false, states, inputs });
        Ok(())
    }

    /// Attempts one step in every lane: by its precomputed matrices if it has them, by the method
    /// if those are too inaccurate.
    fn step(&mut self, system: &dyn Kernel<S>) {
        for lane in 0..S::COUNT {
            self.prepare(lane);
        }
        // after this step, a lane that uses its matrices is at a state at which the method has not
        // linearised it
        let mut fresh = std::mem::take(&mut self.fresh);
        self.choose_propagated();
        if self.watch_propagated(system, fresh) {
            fresh = false;
        }
        if self.propagate(system) {
            return;
        }
        if fresh {
            self.linearize(system);
        }
        self.watch(system);
        let error =
            self.method.attempt(system, &self.state, self.step, &self.inputs, self.settings.tolerance);
        self.between.extensions.fill(None);
        self.between.propagated = false;
        for (place, &end) in self.between.end.iter_mut().zip(self.method.end()) {
            *place = end;
        }
        self.indicate_ends(system);
        let error = self.sample_between(system, error);
        self.learn(error);
        let mut taken = 0;
        for lane in 0..S::COUNT {
            let Some(slot) = &mut self.slots[lane] else { continue };
            if slot.passage.status.is_some() || slot.propagated {
                continue;
            }
            slot.passage.work.evaluations += self.method.evaluations();
            if slot.passage.judge(error.lane(lane)) {
                self.take(system, lane);
                taken |= 1 << lane;
            }
        }
        self.carry(system, taken);
    }

    /// Finds rates, Jacobian and slopes in time at the state of each lane.
    fn linearize(&mut self, system: &dyn Kernel<S>) {
        let mut left = self.slots.iter().flatten().filter(|slot| !slot.propagated);
        self.inputs.moving = left.any(|slot| !slot.passage.still);
        self.method.linearize(system, &self.state, &self.inputs);
    }

    /// Shortens steps that would suppress a growing mode.
    fn watch(&mut self, system: &dyn Kernel<S>) {
        for lane in 0..S::COUNT {
            let Some(slot) = &mut self.slots[lane] else { continue };
            if slot.propagated || slot.unwatched == 0 {
                continue;
            }
            let steps = std::mem::take(&mut slot.unwatched);
            let (time_s, step_s) = (slot.passage.time_s, slot.passage.step_s);
            let watch = &mut self.watches[lane];
            let growing = watch.bound(time_s, step_s, steps, self.method.jacobian(), lane);
            let (frozen, sampled) = (&mut self.frozen[lane], watch.slow_modes());
            if slot.sampler.is_none() && (frozen.grows(steps, time_s) || sampled.is_some()) {
                let known = sampled.filter(|_| slot.passage.histories.is_empty());
                let modes = known.unwrap_or_else(|| {
                    let inputs = &self.inputs.stages[0];
                    Frozen::of(system, &self.state, inputs, lane).least_stable(watch.slower())
                });
                frozen.take(time_s, modes);
            }
            if slot.passage.limit(growing) {
                self.begin_step(lane);
            }
        }
    }

    /// Ends machines that exceed the allowed number of steps.
    fn limit_work(&mut self) {
        for Slot { passage, .. } in self.slots.iter_mut().flatten() {
            let tried = passage.work.steps + passage.work.rejected;
            if tried >= self.settings.maximum_steps && passage.status.is_none() {
                passage.status = Some(passage.out_of_steps());
            }
        }
    }

    /// Runs the sampler, chooses the step and sets its inputs in one lane.
    fn prepare(&mut self, lane: usize) {
        let Some(slot) = &mut self.slots[lane] else { return };
        let Slot { passage, sampler, states, inputs, .. } = slot;
        if let Some(sampler) = sampler
            && passage.samples_now(sampler.sample_time_s())
        {
            for (place, value) in states.iter_mut().zip(&self.state) {
                *place = value.lane(lane);
            }
            passage.inputs_at(passage.time_s, inputs);
            passage.act(sampler.as_mut(), states, inputs);
        }
        self.begin_step(lane);
    }

    /// Chooses the step and sets its inputs in one lane.
    fn begin_step(&mut self, lane: usize) {
        let Some(Slot { passage, sampler, inputs, .. }) = &mut self.slots[lane] else { return };
        passage.choose(sampler.as_ref().map(|sampler| sampler.sample_time_s()));
        self.step.set_lane(lane, passage.step_s);
        if passage.is_constant() {
            return;
        }
        for (part, stage) in self.method.stage_times().iter().zip(&mut self.inputs.stages) {
            if *part == 0.0 || !passage.still {
                passage.inputs_within(*part, inputs);
            }
            set_lane(stage, lane, inputs);
        }
        passage.slopes(inputs);
        set_lane(&mut self.inputs.slopes, lane, inputs);
    }

    /// State over the step, found once for all lanes.
    fn extension(&mut self, index: usize) -> &Extension<S> {
        let (method, propagator, state) = (&self.method, &self.propagator, &self.state);
        let (end, step, propagated) = (&self.between.end, self.step, self.between.propagated);
        self.between.extensions[index].get_or_insert_with(|| {
            if propagated {
                let slopes = propagator.rates.each_ref().map(|rates| rates[index] * step);
                Extension::cubic([state[index], end[index]], slopes)
            } else {
                method.extension(index, state[index])
            }
        })
    }

    /// Advances one lane to the end of its accepted step.
    fn take(&mut self, system: &dyn Kernel<S>, lane: usize) {
        self.fresh = true;
        if let Some(slot) = &mut self.slots[lane] {
            slot.unwatched += 1;
        }
        self.send_waves(system, lane);
        self.find_events(system, lane);
        self.observe(lane);
        self.count_kinks(lane);
        self.keep_marks(lane);
        let Some(slot) = &mut self.slots[lane] else { return };
        for (state, end) in self.state.iter_mut().zip(&self.between.end) {
            state.set_lane(lane, end.lane(lane));
        }
        slot.passage.arrive();
        if slot.passage.status == Some(Status::Completed) {
            slot.observe_end(&self.state, lane);
        }
    }

    /// Passes every row before the end of the step to the observer of a lane, and the step itself
    /// if required.
    fn observe(&mut self, lane: usize) {
        let Some(slot) = &self.slots[lane] else { return };
        let follows = slot.passage.attention != Attention::Rows;
        if !follows && slot.passage.next_row_s() >= slot.passage.end_s() {
            return;
        }
        self.want(lane);
        if let Some(slot) = &mut self.slots[lane] {
            slot.observe(&self.between.wanted);
            if follows {
                slot.follow(&self.between.wanted, &mut self.between.quartics);
            }
        }
    }

    /// Finds the states over the step that the observer of a lane requires.
    fn want(&mut self, lane: usize) {
        self.between.wanted.clear();
        for place in 0.. {
            let wanted =
                self.slots[lane].as_ref().and_then(|slot| slot.observer.wanted().get(place).copied());
            let Some(index) = wanted else { break };
            let extension = self.extension(index).lane(lane);
            self.between.wanted.push(extension);
        }
    }

    /// Finds state and inputs of one lane at a fraction of its accepted step.
    fn sample(&mut self, lane: usize, part: f64) {
        for index in 0..self.state.len() {
            self.between.state[index] = self.extension(index).at(S::from(part));
        }
        let Some(slot) = &mut self.slots[lane] else { return };
        slot.passage.inputs_within(part, &mut slot.inputs);
        set_lane(&mut self.between.inputs, lane, &slot.inputs);
    }

    fn send_waves(&mut self, system: &dyn Kernel<S>, lane: usize) {
        if self.between.waves.is_empty() {
            return;
        }
        let mut sent = vec![[0.0; NODES.len()]; self.between.waves.len()];
        for (node, part) in NODES.into_iter().enumerate() {
            self.sample(lane, part);
            system.outgoing(&self.between.state, &self.between.inputs, &mut self.between.waves);
            for (values, wave) in sent.iter_mut().zip(&self.between.waves) {
                values[node] = wave.lane(lane);
            }
        }
        if let Some(Slot { passage, .. }) = &mut self.slots[lane] {
            let (start_s, length_s) = (passage.time_s, passage.end_s() - passage.time_s);
            for (history, values) in passage.histories.iter_mut().zip(sent) {
                history.send(start_s, length_s, values);
            }
        }
    }

    /// Evaluates indicators and marks at the end of the step, in every lane, with the inputs of the
    /// last stage.
    fn indicate_ends(&mut self, system: &dyn Kernel<S>) {
        let [.., inputs] = &self.inputs.stages;
        if !self.indicators.is_empty() {
            system.indicate(&self.between.end, inputs, &mut self.between.ends);
        }
        if !self.marks.is_empty() {
            system.mark(&self.between.end, inputs, &mut self.between.marks);
        }
    }

    /// Takes the marks at the end of a lane's step as those at the start of its next step.
    fn keep_marks(&mut self, lane: usize) {
        for (before, after) in self.marks.iter_mut().zip(&self.between.marks) {
            before.set_lane(lane, after.lane(lane));
        }
    }

    fn find_events(&mut self, system: &dyn Kernel<S>, lane: usize) {
        let mut any = false;
        for (before, after) in self.indicators.iter().zip(&self.between.ends) {
            any |= (before.lane(lane) > 0.0) != (after.lane(lane) > 0.0);
        }
        if any {
            for index in 0..self.indicators.len() {
                self.find_event(system, lane, index);
            }
        }
        for (before, after) in self.indicators.iter_mut().zip(&self.between.ends) {
            before.set_lane(lane, after.lane(lane));
        }
    }

    /// Finds the time at which an indicator changed its sign within the step, if it did.
    fn find_event(&mut self, system: &dyn Kernel<S>, lane: usize, index: usize) {
        let (before, after) = (self.indicators[index].lane(lane), self.between.ends[index].lane(lane));
        if (before > 0.0) == (after > 0.0) {
            return;
        }
        let mut same = |part| (self.indicator(system, lane, index, part) > 0.0) == (before > 0.0);
        // a break may have changed the sign at once
        let (mut low, mut high) = if same(0.0) { (0.0, 1.0) } else { (0.0, 0.0) };
        while high - low > 1e-12 {
            let middle = 0.5 * (low + high);
            (low, high) = if same(middle) { (middle, high) } else { (low, middle) };
        }
        if let Some(Slot { passage, .. }) = &mut self.slots[lane] {
            let time_s = passage.time_s + high * passage.step_s;
            passage.events.push(Event { time_s, indicator: index, rising: after > 0.0 });
        }
    }

    fn indicator(&mut self, system: &dyn Kernel<S>, lane: usize, index: usize, part: f64) -> f64 {
        self.sample(lane, part);
        system.indicate(&self.between.state, &self.between.inputs, &mut self.between.indicators);
        self.between.indicators[index].lane(lane)
    }

    /// Removes a finished machine from its lane.
    fn leave(&mut self, lane: usize) -> Option<(Outcome, O)> {
        let status = self.slots[lane].as_ref()?.passage.status?;
        let Slot { passage, observer, sampler, .. } = self.slots[lane].take()?;
        let unfollowed = self.unfollowed(&passage, sampler.is_some());
        let mut events = passage.events;
        sort_by_number(&mut events, |event| event.time_s);
        let end = self.state.iter().map(|state| state.lane(lane)).collect();
        let of_mode = Amplification::larger([
            self.watches[lane].amplification(),
            self.frozen[lane].amplification_at_end(passage.time_s),
        ]);
        let of_motion = self.carried.amplification(lane);
        let amplification = Amplification::named(of_mode, of_motion, self.settings.tolerance);
        Some((Outcome { status, events, work: passage.work, end, amplification, unfollowed }, observer))
    }
}

fn set_lane<S: Lane>(places: &mut [S], lane: usize, values: &[f64]) {
    for (place, &value) in places.iter_mut().zip(values) {
        place.set_lane(lane, value);
    }
}
