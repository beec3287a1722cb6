//! Threads that simulate runs one by one, and their rows in the order of the runs.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;
use std::sync::mpsc;
use std::thread::sleep;
use std::time::Duration;

use super::plan::Plan;
use super::queue::{Finished, MACHINES, Shared, in_lanes, one_by_one};
use super::{CampaignError, Row};
use crate::side_by_side::all_cores;

/// Duration of a round, in which rows are collected before they are reported and `watch` is called
/// again.
const ROUND: Duration = Duration::from_millis(20);
/// Number of rounds until a row pending for earlier ones is reported: about a second.
const LATE: u32 = 50;
/// Number of rounds beyond which a run is simulated singly: four runs in lanes take little more
/// than twice as long as one, but none of them finishes earlier, and at most some four seconds of
/// work may be lost at any time.
const LONG: u64 = 85;

/// Computational effort of a campaign; its rows do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Number of threads that simulate machines; at least one is used.
    pub threads: usize,
    /// True if several machines are simulated at once in the lanes of vectors, not one by one.
    pub lanes: bool,
}

/// One thread with lanes.
impl Default for Effort {
    fn default() -> Effort {
        Effort { threads: 1, lanes: true }
    }
}

/// Notification for the caller of a campaign.
pub(super) enum News {
    /// Number of requested runs that are done.
    Done(u64),
    /// The next rows.
    Rows(Vec<Finished>),
    /// Rows pending for an earlier run. They are passed on again in their turn.
    Ahead(Vec<Row>),
}

impl Effort {
    /// One thread for each core, with lanes.
    pub fn on_all_cores() -> Effort {
        Effort { threads: all_cores().at_once, ..Effort::default() }
    }
}

/// Receiver of notifications; the campaign stops soon after it returns `false`.
pub(super) type Tell<'t> = &'t mut dyn FnMut(News) -> Result<bool, CampaignError>;

/// Requested runs.
pub(super) struct MissingRuns {
    pub(super) runs: std::ops::Range<u64>,
    /// Existing rows of some of these runs.
    pub(super) known: BTreeMap<u64, Row>,
    /// True if the force at every recorded time is requested too.
    pub(super) forces: bool,
}

/// Simulates runs and reports them, rows in the order of the runs; if `report_progress` returns
/// `false`, everything ends soon with the rows obtained so far. Each thread takes a run as soon as
/// one is free, and takes more into its lanes if there are more runs than threads.
///
/// # Errors
/// [`CampaignError`] if a run does not fit the machine, or a notification fails.
pub(super) fn run(
    plan: &Plan,
    requested: MissingRuns,
    effort: Effort,
    report_progress: Tell<'_>,
) -> Result<(), CampaignError> {
    let threads = effort.threads.max(1);
    let MissingRuns { runs, known, forces } = requested;
    let first = runs.start;
    if !report_progress(News::Done(0))? {
        return Ok(());
    }
    let shared = Shared::new(plan, (runs, known.keys().copied().collect()), threads, forces);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let (sender, shared) = (sender.clone(), &shared);
            scope.spawn(move || work(shared, effort, &sender));
        }
        drop(sender);
        let told = in_order(&shared, &receiver, (first, known), report_progress);
        shared.stop.store(true, Ordering::Relaxed);
        told
    })
}

type Message = Result<Finished, CampaignError>;

/// Loop of one thread, as long as there are runs. The thread simulates a single run and, if that
/// was short, then as many in lanes as it has machines; then a single one again.
fn work(shared: &Shared<'_>, effort: Effort, sender: &mpsc::Sender<Message>) {
    // without a receiver, everything is cancelled
    let mut give = |finished| drop(sender.send(Ok(finished)));
    let mut in_lanes_next = false;
    while shared.has_more() {
        let begun = shared.rounds.load(Ordering::Relaxed);
        let outcome = match (effort.lanes, in_lanes_next) {
            (false, _) => one_by_one(shared, MACHINES, &mut give),
            (true, false) => one_by_one(shared, 1, &mut give),
            (true, true) => in_lanes(shared, MACHINES, &mut give),
        };
        if let Err(error) = outcome {
            drop(sender.send(Err(error)));
            return;
        }
        let took = shared.rounds.load(Ordering::Relaxed).saturating_sub(begun);
        in_lanes_next = !in_lanes_next && took <= LONG;
    }
}

/// Row pending for earlier rows.
struct QueuedRow {
    finished: Finished,
    /// Number of rounds since.
    rounds: u32,
    /// True if it was reported as pending.
    told: bool,
}

/// Passes rows on in their order, up to the first run that was stopped.
fn in_order(
    shared: &Shared<'_>,
    receiver: &mpsc::Receiver<Message>,
    (mut next, known): (u64, BTreeMap<u64, Row>),
    report_progress: Tell<'_>,
) -> Result<(), CampaignError> {
    let known = known.into_iter().map(|(run, row)| {
        let finished = Finished { row, force_n: Vec::new() };
        (run, QueuedRow { finished, rounds: 0, told: true })
    });
    let mut waiting: BTreeMap<u64, QueuedRow> = known.collect();
    loop {
        if !report_progress(News::Done(shared.done.load(Ordering::Relaxed)))? {
            shared.stop.store(true, Ordering::Relaxed);
        }
        sleep(ROUND);
        shared.rounds.fetch_add(1, Ordering::Relaxed);
        let (news, over) = collected(receiver)?;
        waiting.values_mut().for_each(|one| one.rounds = one.rounds.saturating_add(1));
        let arrived = news
            .into_iter()
            .map(|finished| (finished.row.run, QueuedRow { finished, rounds: 0, told: false }));
        waiting.extend(arrived);
        let mut rows = Vec::new();
        while let Some(one) = waiting.remove(&next) {
            rows.push(one.finished);
            next += 1;
        }
        if !rows.is_empty() && !report_progress(News::Rows(rows))? {
            shared.stop.store(true, Ordering::Relaxed);
        }
        let late = |one: &&mut QueuedRow| !one.told && (over || one.rounds >= LATE);
        let ahead: Vec<Row> = waiting
            .values_mut()
            .filter(late)
            .map(|one| {
                one.told = true;
                one.finished.row.clone()
            })
            .collect();
        if !ahead.is_empty() {
            report_progress(News::Ahead(ahead))?;
        }
        if over {
            return Ok(());
        }
    }
}

/// Received items, and true if no more will follow.
fn collected(receiver: &mpsc::Receiver<Message>) -> Result<(Vec<Finished>, bool), CampaignError> {
    let mut news = Vec::new();
    loop {
        match receiver.try_recv() {
            Ok(message) => news.push(message?),
            Err(error) => return Ok((news, error == mpsc::TryRecvError::Disconnected)),
        }
    }
}

impl Plan {
    /// Rows of runs, in order.
    ///
    /// # Errors
    /// [`CampaignError`] if a run does not fit the machine.
    pub fn rows(&self, runs: std::ops::Range<u64>, effort: Effort) -> Result<Vec<Row>, CampaignError> {
        let rows = self.finished(runs, effort, false)?;
        Ok(rows.into_iter().map(|one| one.row).collect())
    }

    /// Force at each row of the scenario, N, for runs in order; empty for a rejected run.
    ///
    /// # Errors
    /// [`CampaignError`] if a run does not fit the machine.
    pub fn forces(&self, runs: std::ops::Range<u64>, effort: Effort) -> Result<Vec<Vec<f64>>, CampaignError> {
        let rows = self.finished(runs, effort, true)?;
        Ok(rows.into_iter().map(|one| one.force_n).collect())
    }

    fn finished(
        &self,
        runs: std::ops::Range<u64>,
        effort: Effort,
        forces: bool,
    ) -> Result<Vec<Finished>, CampaignError> {
        let mut rows = Vec::new();
        run(self, MissingRuns { runs, known: BTreeMap::new(), forces }, effort, &mut |news| {
            if let News::Rows(more) = news {
                rows.extend(more);
            }
            Ok(true)
        })?;
        Ok(rows)
    }

    /// Text of rows in the format of a campaign.
    pub fn table(&self, rows: &[Row]) -> String {
        let lines = rows.iter().map(|row| self.columns.line(row));
        std::iter::once(self.columns.header()).chain(lines).collect()
    }
}
