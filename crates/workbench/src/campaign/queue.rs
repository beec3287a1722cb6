//! Runs side by side: a machine in each lane, each with its own time and step.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use phea_dynamics::scalar::Lanes;
use phea_dynamics::simulation::{
    ClosedLoop, HeldPlant, Lane, Outcome, Queue, Sensed, SimulationError, Status, Task, drive,
};
use phea_hydraulics::machine::Machine;

use super::plan::Plan;
use super::prepared::{Prepared, Watched, prepared};
use super::row::{Row, RowOutcome};
use crate::control::{controller, sensor};
use crate::simulate::{Control, SimulateError};

use super::CampaignError;

/// Lanes of a vector: two registers of the widest kind that is common, which hide the time that divisions and roots take.
pub(super) const LANES: usize = 4;

/// What the runs of a batch share with all others.
pub(super) struct Shared<'p> {
    pub(super) plan: &'p Plan,
    /// Whether everything is to end.
    pub(super) stop: AtomicBool,
    /// Runs that are done.
    pub(super) done: AtomicU64,
}

/// A run with the force at every look.
pub(super) struct Finished {
    pub(super) row: Row,
    pub(super) force_n: Vec<f64>,
}

/// Drives runs one by one. It is what lanes are held to.
///
/// # Errors
/// As [`batch_in_lanes`].
pub(super) fn batch_one_by_one(
    shared: &Shared<'_>,
    runs: std::ops::Range<u64>,
) -> Result<Vec<Option<Finished>>, CampaignError> {
    let bench = &shared.plan.bench;
    let settings = &bench.settings;
    driven(shared, runs, |batch| match &bench.control {
        Control::Continuous(closed) => {
            let machine: fn(&mut ClosedLoop<Sensed<Machine>>) -> &mut Machine = in_loop;
            drive::<f64, _, _>(&mut closed.as_ref().clone(), &mut Lanewise { batch, machine }, settings)
        }
        Control::Sampled(sampled) => {
            let machine: fn(&mut HeldPlant<Sensed<Machine>>) -> &mut Machine = in_hold;
            drive::<f64, _, _>(&mut sampled.held.clone(), &mut Lanewise { batch, machine }, settings)
        }
        Control::Open(held) => {
            let machine: fn(&mut HeldPlant<Sensed<Machine>>) -> &mut Machine = in_hold;
            drive::<f64, _, _>(&mut held.as_ref().clone(), &mut Lanewise { batch, machine }, settings)
        }
    })
}

/// Drives runs in lanes; those that were stopped are absent. Under a sampled controller they are driven one by one: from sample to
/// sample a machine goes by its own matrices, and where one has to leave them its neighbours wait. Lanes have the same bits there,
/// and take as long.
///
/// # Errors
/// A start or course that does not fit the machine.
pub(super) fn batch_in_lanes<const L: usize>(
    shared: &Shared<'_>,
    runs: std::ops::Range<u64>,
) -> Result<Vec<Option<Finished>>, CampaignError> {
    let plan = shared.plan;
    if !matches!(plan.bench.control, Control::Continuous(_)) {
        return batch_one_by_one(shared, runs);
    }
    let settings = &plan.bench.settings;
    let machine = plan.bench.machine.convert(&mut |value| Lanes([value; L]));
    let sensed = Sensed::new(machine, &sensor(&plan.project).map_err(SimulateError::from)?)
        .map_err(SimulateError::from)?;
    let control = controller(&plan.project).map_err(SimulateError::from)?;
    let control = control.ok_or(SimulateError::NoController)?;
    let gain = plan.bench.feed_forward;
    let mut closed = ClosedLoop::new(sensed, &control, gain).map_err(SimulateError::from)?;
    let machine: fn(&mut ClosedLoop<Sensed<Machine<Lanes<L>>>>) -> &mut Machine<Lanes<L>> = in_loop;
    driven(shared, runs, |batch| drive(&mut closed, &mut Lanewise { batch, machine }, settings))
}

fn in_loop<S>(system: &mut ClosedLoop<Sensed<Machine<S>>>) -> &mut Machine<S> {
    system.plant_mut().plant_mut()
}

fn in_hold(system: &mut HeldPlant<Sensed<Machine>>) -> &mut Machine {
    system.plant_mut().plant_mut()
}

/// Prepares the runs and lets them be driven.
fn driven(
    shared: &Shared<'_>,
    runs: std::ops::Range<u64>,
    drive: impl for<'a> FnOnce(&mut Batch<'a>) -> Result<(), SimulationError>,
) -> Result<Vec<Option<Finished>>, CampaignError> {
    let plan = shared.plan;
    let ready: Vec<Result<Prepared, Box<Row>>> = runs.map(|run| prepared(plan, plan.draw(run))).collect();
    let mut finished: Vec<Option<Finished>> = (0..ready.len()).map(|_| None).collect();
    for (place, one) in finished.iter_mut().zip(&ready) {
        if let Err(row) = one {
            shared.done.fetch_add(1, Ordering::Relaxed);
            *place = Some(Finished { row: row.as_ref().clone(), force_n: Vec::new() });
        }
    }
    let mut batch = Batch { shared, ready: &ready, next: 0, in_lanes: Vec::new(), finished };
    drive(&mut batch)
        .map_err(|error| SimulateError::Simulation { name: plan.scenario.name.clone(), error })?;
    Ok(batch.finished)
}

/// Runs that wait, those under way in each lane, and what came of the others.
struct Batch<'a> {
    shared: &'a Shared<'a>,
    ready: &'a [Result<Prepared, Box<Row>>],
    next: usize,
    in_lanes: Vec<usize>,
    finished: Vec<Option<Finished>>,
}

/// A batch for a kind of system, and where its machine is.
struct Lanewise<'b, 'a, E, S> {
    batch: &'b mut Batch<'a>,
    machine: fn(&mut E) -> &mut Machine<S>,
}

impl<'a, E, S: Lane> Queue<'a, E> for Lanewise<'_, 'a, E, S> {
    type Observer = Watched<'a>;

    fn next(&mut self, system: &mut E, lane: usize) -> Option<Task<'a, Watched<'a>>> {
        let Batch { shared, ready, next, in_lanes, finished } = &mut *self.batch;
        if shared.stop.load(Ordering::Relaxed) {
            return None;
        }
        loop {
            let place = *next;
            let one = ready.get(place)?;
            *next += 1;
            let Ok(prepared) = one else { continue };
            if let Err(error) = (self.machine)(system).put(lane, &prepared.bench.machine) {
                let outcome = RowOutcome::Refused(error.to_string());
                let Prepared { draw, lumps, .. } = prepared;
                let row = Row { run: draw.run, values: draw.values.clone(), lumps: *lumps, outcome };
                finished[place] = Some(Finished { row, force_n: Vec::new() });
                continue;
            }
            in_lanes.resize(in_lanes.len().max(lane + 1), 0);
            in_lanes[lane] = place;
            return Some(prepared.task(shared.plan));
        }
    }

    fn done(&mut self, lane: usize, outcome: Outcome, observer: Watched<'a>) {
        let Batch { shared, ready, in_lanes, finished, .. } = &mut *self.batch;
        let place = in_lanes.get(lane).copied().unwrap_or_default();
        let stopped = matches!(outcome.status, Status::Cancelled { .. });
        if let (false, Some(Ok(prepared))) = (stopped, ready.get(place)) {
            let row = prepared.row(shared.plan, &outcome, &observer);
            finished[place] = Some(Finished { row, force_n: observer.force_n });
            shared.done.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn goes_on(&mut self, _lane: usize, _time_s: f64) -> bool {
        !self.batch.shared.stop.load(Ordering::Relaxed)
    }
}
