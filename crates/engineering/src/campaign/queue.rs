//! Concurrent runs: a machine in each lane, each with its own time and step.

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use phea_dynamics::simulation::{Outcome, SimulationError, Status, Task};
use phea_hydraulics::machine::{Machine, MachineError};
use phea_machine::{Control, Fleet, Lanewise, Watcher};

use super::plan::Plan;
use super::prepared::{DrivenPass, Prepared, Watched, prepared};
use super::remaining_runs::RemainingRuns;
use super::row::{Row, RowOutcome};
use crate::simulate::{Repetition, SimulateError, repeated};

use super::CampaignError;

/// Number of machines that a thread builds before it discards them: its lanes run empty after this
/// number of runs.
pub(super) const MACHINES: usize = 256;

/// State common to all threads.
pub(super) struct Shared<'p> {
    pub(super) plan: &'p Plan,
    /// True if everything is to end.
    pub(super) stop: AtomicBool,
    /// Number of runs that are done.
    pub(super) done: AtomicU64,
    /// Number of times that rows were collected: the only measure of time for threads; no result
    /// depends on it.
    pub(super) rounds: AtomicU64,
    /// True if the force at every recorded time is requested.
    forces: bool,
    supply: Mutex<RemainingRuns>,
}

impl<'p> Shared<'p> {
    pub(super) fn new(
        plan: &'p Plan,
        (runs, known): (Range<u64>, BTreeSet<u64>),
        threads: usize,
        forces: bool,
    ) -> Shared<'p> {
        let supply = Mutex::new(RemainingRuns { runs, known, idle: threads });
        let (done, rounds) = (AtomicU64::new(0), AtomicU64::new(0));
        Shared { plan, stop: AtomicBool::new(false), done, rounds, forces, supply }
    }

    /// True if a thread finds work.
    pub(super) fn has_more(&self) -> bool {
        let mut supply = self.supply.lock().unwrap_or_else(PoisonError::into_inner);
        !self.stop.load(Ordering::Relaxed) && supply.left() > 0
    }

    fn take(&self, driving: usize, works: &mut bool) -> Option<u64> {
        let mut supply = self.supply.lock().unwrap_or_else(PoisonError::into_inner);
        if self.stop.load(Ordering::Relaxed) { None } else { supply.take(driving, works) }
    }

    /// Records that a thread has finished.
    fn rest(&self) {
        self.supply.lock().unwrap_or_else(PoisonError::into_inner).idle += 1;
    }
}

/// A run, with the force at every recorded time if requested.
pub(super) struct Finished {
    pub(super) row: Row,
    pub(super) force_n: Vec<f64>,
}

/// Receiver of each run when it is done.
pub(super) type Give<'g> = &'g mut dyn FnMut(Finished);

/// Simulates runs one by one, until none remain or this number is done. Simulations in lanes must
/// agree with it.
///
/// # Errors
/// The errors of [`in_lanes`].
pub(super) fn one_by_one(shared: &Shared<'_>, most: usize, give: Give<'_>) -> Result<(), CampaignError> {
    let bench = &shared.plan.bench;
    driven(shared, (most, give), |batch| phea_machine::one_by_one(&bench.control, batch, &bench.settings))
}

/// Simulates at most this number of runs in lanes; cancelled runs are not returned. Under a sampled
/// controller they are simulated one by one: from sample to sample a machine follows its own
/// matrices, and its neighbours are idle while it has to leave them. Lanes would give equal bits
/// there, and take as long. All runs are simulated one by one on a processor without the vector
/// instructions that lanes need.
///
/// # Errors
/// [`CampaignError`] for a start or input schedule that does not fit the machine.
pub(super) fn in_lanes(shared: &Shared<'_>, most: usize, give: Give<'_>) -> Result<(), CampaignError> {
    let plan = shared.plan;
    if matches!(plan.bench.control, Control::Sampled(_)) || !Lanewise::is_available() {
        return one_by_one(shared, most, give);
    }
    let law = plan.law.as_ref().map(|(controller, fed)| (controller, *fed));
    let lanes = Lanewise::new(&plan.bench.machine, &plan.sensor, law);
    let mut lanes = lanes.map_err(SimulateError::from)?;
    driven(shared, (most, give), |batch| lanes.in_lanes(batch, &plan.bench.settings))
}

/// Simulates runs, each prepared in its turn.
fn driven(
    shared: &Shared<'_>,
    (most, give): (usize, Give<'_>),
    drive: impl for<'a> FnOnce(&mut Batch<'a>) -> Result<(), SimulationError>,
) -> Result<(), CampaignError> {
    let made: Vec<OnceCell<Prepared>> = (0..most).map(|_| OnceCell::new()).collect();
    let mut batch =
        Batch { shared, made: &made, next: 0, in_lanes: Vec::new(), works: false, give, fault: None };
    let outcome = drive(&mut batch);
    let outcome = outcome.and(batch.fault.take().map_or(Ok(()), Err));
    if batch.works {
        shared.rest();
    }
    let name = || shared.plan.scenario.name.clone();
    Ok(outcome.map_err(|error| SimulateError::Simulation { name: name(), error })?)
}

/// Machines that were made, and those in progress in each lane.
struct Batch<'a> {
    shared: &'a Shared<'a>,
    made: &'a [OnceCell<Prepared>],
    /// Index of the first free machine.
    next: usize,
    in_lanes: Vec<Option<(&'a Prepared, Watched<'a>)>>,
    /// True if a run was taken.
    works: bool,
    give: Give<'a>,
    /// Reason why a run could not be repeated.
    fault: Option<SimulationError>,
}

impl Batch<'_> {
    /// A run after its first pass, repeated singly if its errors may be visible; `None` if it was
    /// cancelled.
    fn repeated<'a>(
        &self,
        prepared: &'a Prepared,
        first: DrivenPass<'a>,
    ) -> Result<Option<Finished>, SimulationError>
    where
        Self: 'a,
    {
        let shared = self.shared;
        let mut continues = || !shared.stop.load(Ordering::Relaxed);
        let again = |pass| prepared.again(shared.plan, (pass, shared.forces), &mut continues);
        let (last, _, repetition) =
            repeated((prepared.bench.settings.tolerance, first), DrivenPass::result, again)?;
        if repetition.as_ref().is_some_and(Repetition::was_cancelled) {
            return Ok(None);
        }
        let force_n = if shared.forces { last.force_n() } else { Vec::new() };
        Ok(Some(Finished { row: prepared.row(&last, repetition.as_ref()), force_n }))
    }

    fn refuse(&mut self, row: Row) {
        self.shared.done.fetch_add(1, Ordering::Relaxed);
        (self.give)(Finished { row, force_n: Vec::new() });
    }
}

impl<'a> Fleet<'a> for Batch<'a> {
    fn next(
        &mut self,
        lane: usize,
        put: &mut dyn FnMut(&Machine) -> Result<(), MachineError>,
    ) -> Option<Task<'a, Watcher<'a>>> {
        let (shared, made) = (self.shared, self.made);
        loop {
            let place = made.get(self.next)?;
            let driving = self.in_lanes.iter().flatten().count();
            let run = shared.take(driving, &mut self.works)?;
            let prepared = match prepared(shared.plan, shared.plan.draw(run)) {
                Ok(prepared) => prepared,
                Err(row) => {
                    self.refuse(*row);
                    continue;
                }
            };
            if let Err(error) = put(&prepared.bench.machine) {
                let outcome = RowOutcome::Refused(error.to_string());
                let Prepared { draw, lumps, .. } = prepared;
                self.refuse(Row { run: draw.run, values: draw.values, lumps, outcome });
                continue;
            }
            let prepared = place.get_or_init(|| prepared);
            self.next += 1;
            self.in_lanes.resize_with(self.in_lanes.len().max(lane + 1), || None);
            let watched = Watched::new(shared.plan, prepared, shared.forces);
            let task = prepared.task(watched.watcher());
            self.in_lanes[lane] = Some((prepared, watched));
            return Some(task);
        }
    }

    fn done(&mut self, lane: usize, outcome: Outcome) {
        let found = self.in_lanes.get_mut(lane).and_then(Option::take);
        let stopped = matches!(outcome.status, Status::Cancelled { .. });
        let (false, Some((prepared, watched))) = (stopped, found) else { return };
        match self.repeated(prepared, prepared.driven(outcome, watched)) {
            Ok(Some(finished)) => {
                self.shared.done.fetch_add(1, Ordering::Relaxed);
                (self.give)(finished);
            }
            Ok(None) => {}
            Err(error) => self.fault = Some(error),
        }
    }

    fn continues(&mut self) -> bool {
        !self.shared.stop.load(Ordering::Relaxed)
    }
}
