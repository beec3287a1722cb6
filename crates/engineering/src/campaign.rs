//! Monte Carlo campaigns: the nonlinear model with drawn numbers, many times, through one
//! scenario.
//!
//! ```text
//! seed, index -> numbers -> machine, start -> driven in lanes -> row -> table, quantiles, bands, worst runs
//! ```
//!
//! A run follows from seed and index alone. Rows are in the order of the runs and the same bytes
//! for any number of threads, in lanes or one by one; a draw that does not give a machine becomes a
//! row that says so, and is not repeated.

mod ledger;
mod parquet;
mod plan;
mod prepared;
mod queue;
mod range;
mod remaining_runs;
mod required;
mod row;
mod spread;
mod statistics;
mod varied;
mod workers;

pub use ledger::{RequestedRuns, RowStore, Shard};
pub use plan::{BeyondBox, Draw, FamilyBox, Plan};
pub use range::VariedRange;
pub use required::{CampaignRequirement, SatisfiedRuns};
pub use row::{LUMP_NAMES, ROW_METRICS, Ran, Row, RowOutcome};
pub use spread::{QUANTILES, Spread};
pub use statistics::{Bands, Summary, WorstRun};
pub use workers::Effort;

pub use ledger::campaign;
pub use row::meaningful;

use crate::csv;
use crate::project::{self, Refusal};
use crate::quantity;
use crate::simulate::{self, SimulateError, shortest_number};
use crate::specification::SpecificationError;

/// Reason why a valid project has no campaign.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CampaignError {
    /// It declares none.
    #[error(
        "the project has no [campaign]: name the numbers that vary in [campaign.parameters], such as `\"supply.pressure\" = {{ minimum = \"60 bar\", maximum = \"70 bar\" }}`"
    )]
    Absent,
    /// It varies nothing.
    #[error("[campaign] varies nothing: name numbers in [campaign.parameters]")]
    Nothing,
    /// There is nothing to drive.
    #[error(
        "there is nothing to drive: the project has no [[scenario]]: add one, such as `name = \"step\"`, `duration = \"2 s\"` and `reference = {{ at = \"1 s\", force = \"1 kN\" }}`"
    )]
    NoScenario,
    /// The scenario that it names does not exist.
    #[error("[campaign] names a scenario \"{name}\" that the project does not have")]
    NoSuchScenario {
        /// As named.
        name: String,
    },
    /// A path that does not lead to a number.
    #[error("[campaign] varies `{path}`, but this project has no such number")]
    Unknown {
        /// As written.
        path: String,
    },
    /// A start that is an equilibrium has no numbers to vary.
    #[error("[campaign] varies `{path}`, but the scenario states no `start` and begins in equilibrium")]
    NoStart {
        /// As written.
        path: String,
    },
    /// A saved start cannot be varied.
    #[error("[campaign] varies `{path}`, but the scenario continues from a saved state")]
    SavedStart {
        /// As written.
        path: String,
    },
    /// A spread around nothing.
    #[error(
        "[campaign] spreads `{path}` around a number that is not stated or zero: give `minimum` and `maximum`"
    )]
    NotStated {
        /// As written.
        path: String,
    },
    /// A logarithmic spread of a number that has no logarithm.
    #[error("[campaign] draws the logarithm of `{path}`, whose least value is {minimum}")]
    NoLogarithm {
        /// As written.
        path: String,
        /// In SI.
        minimum: f64,
    },
    /// The part of a campaign is invalid.
    #[error("--shard {text}: a part has the form 2/4, the second of four")]
    NoShard {
        /// As written.
        text: String,
    },
    /// More runs than can be held at once.
    #[error("{runs} runs are more than {} at once: draw shards of them", ledger::MOST_RUNS)]
    TooMany {
        /// As asked for.
        runs: u64,
    },
    /// The stored rows belong to another campaign.
    #[error(
        "line {line} of the kept table is not a row of this campaign: choose another folder, or remove the table"
    )]
    OtherCampaign {
        /// Counted from 1.
        line: usize,
    },
    /// A stored row has been altered.
    #[error(
        "line {line} of the kept table {fault}: remove it and all lines after it (head -n {} keeps those before), and the same command drives them again",
        .line - 1
    )]
    Damaged {
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        fault: RowFault,
    },
    /// Another program has rewritten the table.
    #[error(
        "line {line} of the kept table ends in CR LF, where LF was written: give it back its line ends, or remove the table"
    )]
    LineEnds {
        /// Counted from 1.
        line: usize,
    },
    /// More rows are stored than were requested.
    #[error(
        "the kept table has {kept} rows, more than the {asked} that are asked for: choose another folder"
    )]
    MoreKept {
        /// Rows.
        kept: u64,
        /// Runs.
        asked: u64,
    },
    /// Rows cannot be kept.
    #[error("{0}")]
    RowStore(String),
    /// The machine or its controller cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A limit that is stated in time has no response.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// A run, written as settings, is no longer a valid project.
    #[error("{0}")]
    Settings(Box<Refusal>),
}

/// Fault of a line of the kept table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RowFault {
    /// Its checksum is wrong.
    #[error("is not as it was written")]
    Changed,
    /// Its index is not that of its place.
    #[error("belongs to another run")]
    OfAnotherRun,
    /// Its numbers are not those of its index.
    #[error("has other numbers than its run draws")]
    OtherNumbers,
}
