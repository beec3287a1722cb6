//! Threads that take batches of runs, and their rows in the order of the runs.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc;
use std::time::Duration;

use super::plan::Plan;
use super::queue::{Finished, LANES, Shared, batch_in_lanes, batch_one_by_one};
use super::{CampaignError, Row};

/// Runs that a thread takes at once: lanes run empty at the end of each batch alone.
const BATCH: u64 = 256;
/// How long the rows of a batch are waited for before whoever watches is asked again.
const PATIENCE: Duration = Duration::from_millis(100);

/// How a campaign is computed; its rows do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Threads that drive machines; at least one is taken.
    pub threads: usize,
    /// Whether several machines are driven at once in the lanes of vectors, and not one by one.
    pub lanes: bool,
}

/// One thread with lanes.
impl Default for Effort {
    fn default() -> Effort {
        Effort { threads: 1, lanes: true }
    }
}

/// What whoever asked for a campaign is told.
pub(super) enum News<'r> {
    /// So many runs of those that were asked for are done.
    Done(u64),
    /// The next rows.
    Rows(&'r [Row]),
}

/// Drives runs and tells of them, rows in the order of the runs; where the answer is `false`, everything ends soon and the rows
/// so far are all there will be.
///
/// # Errors
/// [`CampaignError`] where a run does not fit the machine, or whoever is told fails.
pub(super) fn run(
    plan: &Plan,
    runs: std::ops::Range<u64>,
    effort: Effort,
    tell: &mut dyn FnMut(News<'_>) -> Result<bool, CampaignError>,
) -> Result<(), CampaignError> {
    let shared = Shared { plan, stop: AtomicBool::new(false), done: AtomicU64::new(0) };
    let count = runs.end.saturating_sub(runs.start).div_ceil(BATCH);
    let batch = |number: u64| {
        let start = runs.start + number * BATCH;
        start..(start + BATCH).min(runs.end)
    };
    let next = AtomicU64::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..effort.threads.max(1) {
            let (sender, shared, next) = (sender.clone(), &shared, &next);
            scope.spawn(move || {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count || shared.stop.load(Ordering::Relaxed) {
                        return;
                    }
                    let finished = driven(shared, batch(number), effort);
                    if sender.send((number, finished)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let told = in_order(&shared, &receiver, tell);
        shared.stop.store(true, Ordering::Relaxed);
        told
    })
}

fn driven(
    shared: &Shared<'_>,
    runs: std::ops::Range<u64>,
    effort: Effort,
) -> Result<Vec<Option<Finished>>, CampaignError> {
    if effort.lanes { batch_in_lanes::<LANES>(shared, runs) } else { batch_one_by_one(shared, runs) }
}

type Message = (u64, Result<Vec<Option<Finished>>, CampaignError>);

/// Passes the rows of batches on in their order, up to the first run that was stopped.
fn in_order(
    shared: &Shared<'_>,
    receiver: &mpsc::Receiver<Message>,
    tell: &mut dyn FnMut(News<'_>) -> Result<bool, CampaignError>,
) -> Result<(), CampaignError> {
    let mut waiting = BTreeMap::new();
    let mut next = 0;
    let mut broken = false;
    loop {
        if !tell(News::Done(shared.done.load(Ordering::Relaxed)))? {
            shared.stop.store(true, Ordering::Relaxed);
        }
        match receiver.recv_timeout(PATIENCE) {
            Ok((number, finished)) => {
                waiting.insert(number, finished?);
            }
            Err(mpsc::RecvTimeoutError::Timeout) => continue,
            Err(mpsc::RecvTimeoutError::Disconnected) => return Ok(()),
        }
        while let Some(finished) = waiting.remove(&next).filter(|_| !broken) {
            let expected = finished.len();
            let rows: Vec<Row> = finished.into_iter().map_while(|one| one.map(|one| one.row)).collect();
            broken = rows.len() < expected;
            next += 1;
            if !rows.is_empty() && !tell(News::Rows(&rows))? {
                shared.stop.store(true, Ordering::Relaxed);
            }
        }
    }
}

impl Plan {
    /// Rows of runs, in their order.
    ///
    /// # Errors
    /// [`CampaignError`] where a run does not fit the machine.
    pub fn rows(&self, runs: std::ops::Range<u64>, effort: Effort) -> Result<Vec<Row>, CampaignError> {
        let mut rows = Vec::new();
        run(self, runs, effort, &mut |news| {
            if let News::Rows(more) = news {
                rows.extend_from_slice(more);
            }
            Ok(true)
        })?;
        Ok(rows)
    }

    /// Force in N at each row of the scenario, of runs in their order; empty for one that was refused.
    ///
    /// # Errors
    /// [`CampaignError`] where a run does not fit the machine.
    pub fn forces(&self, runs: std::ops::Range<u64>, effort: Effort) -> Result<Vec<Vec<f64>>, CampaignError> {
        let shared = Shared { plan: self, stop: AtomicBool::new(false), done: AtomicU64::new(0) };
        let finished = driven(&shared, runs, effort)?;
        Ok(finished.into_iter().flatten().map(|one| one.force_n).collect())
    }

    /// The text of rows, as a campaign writes it.
    pub fn table(&self, rows: &[Row]) -> String {
        let lines = rows.iter().map(|row| self.columns.line(row));
        std::iter::once(self.columns.header()).chain(lines).collect()
    }
}
