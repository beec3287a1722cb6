//! Runs side by side: a machine in each lane, each with its own time and step.

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::scalar::Lanes;
use phea_dynamics::simulation::{
    ClosedLoop, HeldPlant, Lane, Outcome, Queue, Sensed, SimulationError, Status, Task, drive,
};
use phea_hydraulics::machine::Machine;

use super::plan::Plan;
use super::prepared::{Prepared, Watched, prepared};
use super::row::{Row, RowOutcome};
use super::supply::Supply;
use crate::setup::Setup;
use crate::simulate::{Control, SimulateError};

use super::CampaignError;

/// Lanes of a vector: two registers of the widest kind that is common, which hide the time that divisions and roots take.
pub(super) const LANES: usize = 4;

/// Machines that a thread makes before it forgets them: its lanes run empty at the end of so many runs.
pub(super) const MACHINES: usize = 256;

/// What all threads share.
pub(super) struct Shared<'p> {
    pub(super) plan: &'p Plan,
    /// Whether everything is to end.
    pub(super) stop: AtomicBool,
    /// Runs that are done.
    pub(super) done: AtomicU64,
    /// How often rows were collected: all that threads know of time, and no result depends on it.
    pub(super) rounds: AtomicU64,
    /// Whether the force at every look is asked for.
    forces: bool,
    supply: Mutex<Supply>,
}

impl<'p> Shared<'p> {
    pub(super) fn new(
        plan: &'p Plan,
        (runs, known): (Range<u64>, BTreeSet<u64>),
        threads: usize,
        forces: bool,
    ) -> Shared<'p> {
        let supply = Mutex::new(Supply { runs, known, idle: threads });
        let (done, rounds) = (AtomicU64::new(0), AtomicU64::new(0));
        Shared { plan, stop: AtomicBool::new(false), done, rounds, forces, supply }
    }

    /// Whether a thread finds work.
    pub(super) fn has_more(&self) -> bool {
        let mut supply = self.supply.lock().unwrap_or_else(PoisonError::into_inner);
        !self.stop.load(Ordering::Relaxed) && supply.left() > 0
    }

    fn take(&self, driving: usize, works: &mut bool) -> Option<u64> {
        let mut supply = self.supply.lock().unwrap_or_else(PoisonError::into_inner);
        if self.stop.load(Ordering::Relaxed) { None } else { supply.take(driving, works) }
    }

    /// A thread drives nothing any more.
    fn rest(&self) {
        self.supply.lock().unwrap_or_else(PoisonError::into_inner).idle += 1;
    }
}

/// A run with the force at every look, where that is asked for.
pub(super) struct Finished {
    pub(super) row: Row,
    pub(super) force_n: Vec<f64>,
}

/// Takes each run when it is done.
pub(super) type Give<'g> = &'g mut dyn FnMut(Finished);

/// Drives runs one by one, until there are none or so many were. It is what lanes are held to.
///
/// # Errors
/// As [`in_lanes`].
pub(super) fn one_by_one(shared: &Shared<'_>, most: usize, give: Give<'_>) -> Result<(), CampaignError> {
    let bench = &shared.plan.bench;
    let settings = &bench.settings;
    driven(shared, (most, give), |batch| match &bench.control {
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

/// Drives so many runs at most in lanes; those that were stopped are not given. Under a sampled controller they are driven one by
/// one: from sample to sample a machine goes by its own matrices, and where one has to leave them its neighbours wait. Lanes have
/// the same bits there, and take as long.
///
/// # Errors
/// A start or course that does not fit the machine.
pub(super) fn in_lanes<const L: usize>(
    shared: &Shared<'_>,
    most: usize,
    give: Give<'_>,
) -> Result<(), CampaignError> {
    let plan = shared.plan;
    if matches!(plan.bench.control, Control::Sampled(_)) {
        return one_by_one(shared, most, give);
    }
    let settings = &plan.bench.settings;
    let machine = plan.bench.machine.convert(&mut |value| Lanes([value; L]));
    let setup = Setup::new(&plan.project).map_err(SimulateError::from)?;
    let sensed = Sensed::new(machine, &setup.sensor).map_err(SimulateError::from)?;
    if plan.is_open_loop() {
        let prefilter = TransferFunction::gain_only(1.0);
        let mut held = HeldPlant::new(sensed, &prefilter).map_err(SimulateError::from)?;
        let machine: fn(&mut HeldPlant<Sensed<Machine<Lanes<L>>>>) -> &mut Machine<Lanes<L>> = in_hold;
        return driven(shared, (most, give), |batch| {
            drive(&mut held, &mut Lanewise { batch, machine }, settings)
        });
    }
    let control = setup.controller.ok_or(SimulateError::NoController)?;
    let gain = plan.bench.feed_forward;
    let mut closed = ClosedLoop::new(sensed, &control, gain).map_err(SimulateError::from)?;
    let machine: fn(&mut ClosedLoop<Sensed<Machine<Lanes<L>>>>) -> &mut Machine<Lanes<L>> = in_loop;
    driven(shared, (most, give), |batch| drive(&mut closed, &mut Lanewise { batch, machine }, settings))
}

fn in_loop<S>(system: &mut ClosedLoop<Sensed<Machine<S>>>) -> &mut Machine<S> {
    system.plant_mut().plant_mut()
}

fn in_hold<S>(system: &mut HeldPlant<Sensed<Machine<S>>>) -> &mut Machine<S> {
    system.plant_mut().plant_mut()
}

/// Lets runs be driven, each made when its turn comes.
fn driven(
    shared: &Shared<'_>,
    (most, give): (usize, Give<'_>),
    drive: impl for<'a> FnOnce(&mut Batch<'a>) -> Result<(), SimulationError>,
) -> Result<(), CampaignError> {
    let made: Vec<OnceCell<Prepared>> = (0..most).map(|_| OnceCell::new()).collect();
    let mut batch = Batch { shared, made: &made, next: 0, in_lanes: Vec::new(), works: false, give };
    let outcome = drive(&mut batch);
    if batch.works {
        shared.rest();
    }
    let name = || shared.plan.scenario.name.clone();
    Ok(outcome.map_err(|error| SimulateError::Simulation { name: name(), error })?)
}

/// Machines that were made, and those under way in each lane.
struct Batch<'a> {
    shared: &'a Shared<'a>,
    made: &'a [OnceCell<Prepared>],
    /// The first place that is free.
    next: usize,
    in_lanes: Vec<Option<&'a Prepared>>,
    /// Whether a run was taken.
    works: bool,
    give: Give<'a>,
}

impl Batch<'_> {
    fn refuse(&mut self, row: Row) {
        self.shared.done.fetch_add(1, Ordering::Relaxed);
        (self.give)(Finished { row, force_n: Vec::new() });
    }
}

/// A batch for a kind of system, and where its machine is.
struct Lanewise<'b, 'a, E, S> {
    batch: &'b mut Batch<'a>,
    machine: fn(&mut E) -> &mut Machine<S>,
}

impl<'a, E, S: Lane> Queue<'a, E> for Lanewise<'_, 'a, E, S> {
    type Observer = Watched<'a>;

    fn next(&mut self, system: &mut E, lane: usize) -> Option<Task<'a, Watched<'a>>> {
        let batch = &mut *self.batch;
        let (shared, made) = (batch.shared, batch.made);
        loop {
            let place = made.get(batch.next)?;
            let driving = batch.in_lanes.iter().flatten().count();
            let run = shared.take(driving, &mut batch.works)?;
            let prepared = match prepared(shared.plan, shared.plan.draw(run)) {
                Ok(prepared) => prepared,
                Err(row) => {
                    batch.refuse(*row);
                    continue;
                }
            };
            if let Err(error) = (self.machine)(system).put(lane, &prepared.bench.machine) {
                let outcome = RowOutcome::Refused(error.to_string());
                let Prepared { draw, lumps, .. } = prepared;
                batch.refuse(Row { run: draw.run, values: draw.values, lumps, outcome });
                continue;
            }
            let prepared = place.get_or_init(|| prepared);
            batch.next += 1;
            batch.in_lanes.resize(batch.in_lanes.len().max(lane + 1), None);
            batch.in_lanes[lane] = Some(prepared);
            return Some(prepared.task(shared.plan, shared.forces));
        }
    }

    fn done(&mut self, lane: usize, outcome: Outcome, observer: Watched<'a>) {
        let Batch { shared, in_lanes, give, .. } = &mut *self.batch;
        let prepared = in_lanes.get_mut(lane).and_then(Option::take);
        let stopped = matches!(outcome.status, Status::Cancelled { .. });
        if let (false, Some(prepared)) = (stopped, prepared) {
            let row = prepared.row(&outcome, &observer);
            let force_n = if shared.forces { observer.force_n } else { Vec::new() };
            shared.done.fetch_add(1, Ordering::Relaxed);
            give(Finished { row, force_n });
        }
    }

    fn goes_on(&mut self, _lane: usize, _time_s: f64) -> bool {
        !self.batch.shared.stop.load(Ordering::Relaxed)
    }
}
