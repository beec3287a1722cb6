//! The output of `bench`: text, JSON and tables.

mod answer;
mod document;
mod friction;
mod line;
mod table;

use phea_engineering::line_test::KnownLine;
use phea_engineering::setup::Setup;

use crate::line_test::remark;
use crate::project::IdentifiedUse;

pub use answer::files;
pub(crate) use answer::{BenchAnswer, body};
pub(crate) use document::document;
pub(crate) use line::line_files;

/// Parts of the project that the tests leave out, in sentences; none if nothing is left out.
pub(crate) fn remarks(setup: &Setup<'_>) -> Vec<&'static str> {
    let takes = setup.project.identify.as_ref().map(|identify| identify.takes).unwrap_or_default();
    let valve = (takes != IdentifiedUse::Nothing).then_some(
        "The valve under test is the declared one: `identify.use` takes the recordings in every command but this.",
    );
    let line = setup.project.bench.line.and_then(|bench| remark(&KnownLine::of(setup, bench.side).ok()?));
    valve.into_iter().chain(line).collect()
}
