//! A campaign from its first row or from an interruption, its rows stored as they are computed.

use std::collections::BTreeMap;
use std::ops::Range;

use super::plan::Plan;
use super::row::{NoRow, Row};
use super::workers::{MissingRuns, News, run};
use super::{CampaignError, Effort, RowFault, StoredSeed};
use phea_dynamics::watch::{Progress, Watch};

/// Largest number of rows that are stored at once.
pub(super) const MOST_RUNS: u64 = 1_000_000;

/// The requested runs of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RequestedRuns {
    /// Number of runs.
    pub runs: u64,
    /// Computational effort.
    pub effort: Effort,
}

/// Store for the rows of a campaign while it runs: a text that grows at its end.
pub trait RowStore {
    /// Returns the whole text.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    fn stored(&mut self) -> Result<String, String>;

    /// Truncates the text to this number of bytes.
    ///
    /// # Errors
    /// The reason why it cannot be truncated.
    fn cut(&mut self, bytes: usize) -> Result<(), String>;

    /// Appends to the text.
    ///
    /// # Errors
    /// The reason why it cannot be written.
    fn append(&mut self, text: &str) -> Result<(), String>;

    /// Returns rows pending for an earlier one, as stored by [`RowStore::keep_ahead`]; anything
    /// else there is ignored.
    ///
    /// # Errors
    /// The reason why they cannot be read.
    fn ahead(&mut self) -> Result<String, String> {
        Ok(String::new())
    }

    /// Stores rows pending for an earlier one, so that they are not simulated again after an
    /// interruption. A ledger may store none.
    ///
    /// # Errors
    /// The reason why they cannot be written.
    fn keep_ahead(&mut self, _text: &str) -> Result<(), String> {
        Ok(())
    }

    /// Deletes the pending rows: all are in the table.
    ///
    /// # Errors
    /// The reason why they cannot be deleted.
    fn forget_ahead(&mut self) -> Result<(), String> {
        Ok(())
    }
}

/// Simulates the missing runs of a campaign, each row stored in the ledger if there is one, and
/// returns all rows: fewer than requested if it was cancelled.
///
/// # Errors
/// [`CampaignError`] if the ledger contains another campaign or cannot be written.
pub fn campaign(
    plan: &Plan,
    wanted: RequestedRuns,
    mut ledger: Option<&mut dyn RowStore>,
    watch: Watch<'_>,
) -> Result<Vec<Row>, CampaignError> {
    let requested = wanted.runs;
    if requested > MOST_RUNS {
        return Err(CampaignError::TooMany { runs: requested });
    }
    let mut rows = match ledger.as_deref_mut() {
        Some(ledger) => resumed(plan, requested, ledger)?,
        None => vec![],
    };
    let missing = rows.len() as u64..requested;
    let known = match ledger.as_deref_mut() {
        Some(ledger) => ahead(plan, &missing, ledger)?,
        None => BTreeMap::new(),
    };
    let before = (rows.len() + known.len()) as u64;
    let mut report_progress = |news: News| match news {
        News::Done(done) => {
            let fraction = (before + done) as f64 / (requested.max(1)) as f64;
            Ok(watch(Progress { stage: "driving", fraction }))
        }
        News::Rows(more) => {
            if let Some(ledger) = ledger.as_deref_mut() {
                let text: String = more.iter().map(|one| plan.columns.line(&one.row)).collect();
                ledger.append(&text).map_err(CampaignError::RowStore)?;
            }
            rows.extend(more.into_iter().map(|one| one.row));
            Ok(true)
        }
        News::Ahead(more) => {
            if let Some(ledger) = ledger.as_deref_mut() {
                let text: String = more.iter().map(|row| plan.columns.line(row)).collect();
                ledger.keep_ahead(&text).map_err(CampaignError::RowStore)?;
            }
            Ok(true)
        }
    };
    run(plan, MissingRuns { runs: missing, known, forces: false }, wanted.effort, &mut report_progress)?;
    if rows.len() as u64 == requested
        && let Some(ledger) = ledger
    {
        ledger.forget_ahead().map_err(CampaignError::RowStore)?;
    }
    Ok(rows)
}

/// Lines of these runs, as a campaign stores them: the unit of work of several computers, whose
/// lines, in the order of the runs, are the table of the whole campaign.
///
/// # Errors
/// [`CampaignError::Cancelled`] if the watch stopped it.
pub fn lines_of_runs(
    plan: &Plan,
    runs: Range<u64>,
    effort: Effort,
    watch: Watch<'_>,
) -> Result<String, CampaignError> {
    let requested = runs.end.saturating_sub(runs.start);
    let mut lines = String::new();
    let mut stored = 0;
    let mut report_progress = |news: News| match news {
        News::Done(done) => {
            let fraction = done as f64 / requested.max(1) as f64;
            Ok(watch(Progress { stage: "driving", fraction }))
        }
        News::Rows(more) => {
            stored += more.len() as u64;
            lines.extend(more.iter().map(|one| plan.columns.line(&one.row)));
            Ok(true)
        }
        News::Ahead(_) => Ok(true),
    };
    let missing = MissingRuns { runs, known: BTreeMap::new(), forces: false };
    run(plan, missing, effort, &mut report_progress)?;
    if stored < requested { Err(CampaignError::Cancelled) } else { Ok(lines) }
}

/// Number of runs whose rows are stored, each verified; an empty store receives its header.
///
/// # Errors
/// [`CampaignError`] if the store contains another campaign or cannot be written.
pub fn stored_runs(plan: &Plan, requested: u64, ledger: &mut dyn RowStore) -> Result<u64, CampaignError> {
    Ok(resumed(plan, requested, ledger)?.len() as u64)
}

/// Stored rows of these runs that are pending for earlier ones; a run whose line was altered is
/// simulated again.
fn ahead(
    plan: &Plan,
    missing: &Range<u64>,
    ledger: &mut dyn RowStore,
) -> Result<BTreeMap<u64, Row>, CampaignError> {
    let text = ledger.ahead().map_err(CampaignError::RowStore)?;
    let rows = text.lines().filter_map(|line| plan.columns.row(line).ok());
    let ours = |row: &Row| missing.contains(&row.run) && row.values == plan.draw(row.run).values;
    Ok(rows.filter(ours).map(|row| (row.run, row)).collect())
}

/// Error for a line of another campaign, with its seed if that can be found.
fn other_campaign(plan: &Plan, line: usize, text: &str) -> CampaignError {
    let mark = text.split(',').nth(1).unwrap_or_default();
    let stored_seed = plan.seed_of_mark(mark).map_or(StoredSeed::Unknown, StoredSeed::Other);
    CampaignError::OtherCampaign { line, seed: plan.seed(), stored_seed }
}

/// A stored row, verified to be the one that was written for that run.
fn kept_row(plan: &Plan, run: u64, text: &str, line: usize) -> Result<Row, CampaignError> {
    let row = plan.columns.row(text).map_err(|fault| match fault {
        NoRow::Other => other_campaign(plan, line, text),
        NoRow::LineEnd => CampaignError::LineEnds { line },
        NoRow::Changed => CampaignError::Damaged { line, fault: RowFault::Changed },
    })?;
    if row.run != run {
        return Err(CampaignError::Damaged { line, fault: RowFault::OfAnotherRun });
    }
    if row.values != plan.draw(run).values {
        return Err(CampaignError::Damaged { line, fault: RowFault::OtherNumbers });
    }
    Ok(row)
}

/// The rows that are already stored; an incomplete line at the end is dropped, and an empty ledger
/// is started.
fn resumed(plan: &Plan, requested: u64, ledger: &mut dyn RowStore) -> Result<Vec<Row>, CampaignError> {
    let text = ledger.stored().map_err(CampaignError::RowStore)?;
    let (whole, torn) = text.split_at(text.rfind('\n').map_or(0, |last| last + 1));
    let header = plan.columns.header();
    let (mut rows, mut lines) = (Vec::new(), whole.split_terminator('\n').zip(1..));
    if let Some((first, line)) = lines.next()
        && first != header.trim_end()
    {
        return Err(match first.strip_suffix('\r') == Some(header.trim_end()) {
            true => CampaignError::LineEnds { line },
            false => other_campaign(plan, line, first),
        });
    }
    for (text, line) in lines {
        rows.push(kept_row(plan, rows.len() as u64, text, line)?);
    }
    let stored = rows.len() as u64;
    let beginning = if whole.is_empty() { header.clone() } else { plan.columns.beginning(stored) };
    if !(torn.starts_with(&beginning) || beginning.starts_with(torn)) {
        return Err(other_campaign(plan, whole.lines().count() + 1, torn));
    }
    if stored > requested {
        return Err(CampaignError::MoreStored { seed: plan.seed(), stored, requested });
    }
    if !torn.is_empty() {
        ledger.cut(whole.len()).map_err(CampaignError::RowStore)?;
    }
    if whole.is_empty() {
        ledger.append(&header).map_err(CampaignError::RowStore)?;
    }
    Ok(rows)
}
