//! Monte Carlo campaigns: many simulations of the nonlinear model with drawn numbers, through one
//! scenario.
//!
//! ```text
//! seed, index -> numbers -> machine, start -> simulated in lanes -> row -> table, quantiles, bands, worst runs
//! ```
//!
//! Seed and index determine a run completely. Rows are in the order of the runs and have identical
//! bytes for any number of threads, in lanes or one by one; a draw that does not give a machine
//! becomes a row that reports this, and is not repeated.

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

pub use ledger::{RequestedRuns, RowStore, lines_of_runs, stored_runs};
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
    /// The project declares no campaign.
    #[error(
        "the project has no [campaign]: name the numbers that vary in [campaign.parameters], such as `\"supply.pressure\" = {{ minimum = \"60 bar\", maximum = \"70 bar\" }}`"
    )]
    Absent,
    /// The campaign varies nothing.
    #[error("[campaign] varies nothing: name numbers in [campaign.parameters]")]
    Nothing,
    /// The project has no scenario to simulate.
    #[error(
        "there is nothing to drive: the project has no [[scenario]]: add one, such as `name = \"step\"`, `duration = \"2 s\"` and `reference = {{ at = \"1 s\", force = \"1 kN\" }}`"
    )]
    NoScenario,
    /// The scenario of the campaign does not exist.
    #[error("[campaign] names a scenario \"{name}\" that the project does not have")]
    NoSuchScenario {
        /// Name as written.
        name: String,
    },
    /// The path does not lead to a number.
    #[error("[campaign] varies `{path}`, but this project has no such number")]
    Unknown {
        /// Path as written.
        path: String,
    },
    /// The scenario starts in equilibrium, which has no numbers to vary.
    #[error("[campaign] varies `{path}`, but the scenario states no `start` and begins in equilibrium")]
    NoStart {
        /// Path as written.
        path: String,
    },
    /// The scenario starts from a saved state, which cannot be varied.
    #[error("[campaign] varies `{path}`, but the scenario continues from a saved state")]
    SavedStart {
        /// Path as written.
        path: String,
    },
    /// The spread is around zero or an absent number.
    #[error(
        "[campaign] spreads `{path}` around a number that is not stated or zero: give `minimum` and `maximum`"
    )]
    NotStated {
        /// Path as written.
        path: String,
    },
    /// The spread is logarithmic, but the number has no logarithm.
    #[error("[campaign] draws the logarithm of `{path}`, whose least value is {minimum}")]
    NoLogarithm {
        /// Path as written.
        path: String,
        /// Least value, SI.
        minimum: f64,
    },
    /// The watch stopped the campaign.
    #[error("stopped")]
    Cancelled,
    /// The number of runs is larger than can be stored at once.
    #[error("{runs} runs are more than {} at once: choose another seed for more", ledger::MOST_RUNS)]
    TooMany {
        /// Number of requested runs.
        runs: u64,
    },
    /// The stored rows belong to another campaign.
    #[error(
        "line {line} of the kept table {stored_seed}, and this campaign has seed {seed}: choose another folder, or remove the table"
    )]
    OtherCampaign {
        /// Line number, from 1.
        line: usize,
        /// Requested seed.
        seed: u32,
        /// Seed of the row.
        stored_seed: StoredSeed,
    },
    /// A stored row has been altered.
    #[error(
        "line {line} of the kept table {fault}: remove it and all lines after it (head -n {} keeps those before), and the same command drives them again",
        .line - 1
    )]
    Damaged {
        /// Line number, from 1.
        line: usize,
        /// Fault of the row.
        fault: RowFault,
    },
    /// Another program has rewritten the table.
    #[error(
        "line {line} of the kept table ends in CR LF, where LF was written: give it back its line ends, or remove the table"
    )]
    LineEnds {
        /// Line number, from 1.
        line: usize,
    },
    /// More rows are stored than requested.
    #[error(
        "the kept table has {stored} rows, more than the {requested} that are requested with seed {seed}: choose another folder, or request {stored} runs or more"
    )]
    MoreStored {
        /// Seed of the rows.
        seed: u32,
        /// Number of rows.
        stored: u64,
        /// Number of runs.
        requested: u64,
    },
    /// Rows cannot be stored.
    #[error("{0}")]
    RowStore(String),
    /// The machine or its controller cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A limit stated in time has no response.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// A run, written as settings, is no longer a valid project.
    #[error("{0}")]
    Settings(Box<Refusal>),
}

/// Seed of a stored row that belongs to another campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StoredSeed {
    /// A campaign of this project with this seed has the row.
    #[error("was drawn with seed {0}")]
    Other(u32),
    /// No campaign of this project with a small seed has it.
    #[error("is of another project or an unknown seed")]
    Unknown,
}

/// Fault of a line of the stored table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RowFault {
    /// The checksum is wrong.
    #[error("is not as it was written")]
    Changed,
    /// The index does not match the position of the row.
    #[error("belongs to another run")]
    OfAnotherRun,
    /// The numbers are not those that follow from the index.
    #[error("has other numbers than its run draws")]
    OtherNumbers,
}
