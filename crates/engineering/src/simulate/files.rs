//! Files of `simulate`: a table for each scenario, and its final state.

use phea_hydraulics::signal::Signal;

use super::columns::SignalParts;
use super::file_names::state_names;
use super::{ControlledMachine, Sample, ScenarioRun};
use crate::project::Loaded;
use crate::source::{Destination, Unfinished, WriteError};
use crate::{
    number_table::{NumberTable, TableFormat},
    source::OutputFile,
};

/// Final state of each run, if it can be saved.
pub fn files(loaded: &Loaded, runs: &[ScenarioRun]) -> Vec<OutputFile> {
    let names = state_names(runs.iter().map(|run| run.name.as_str()));
    let state = |(run, name): (&ScenarioRun, String)| {
        let end = run.end.as_ref().ok()?;
        Some(OutputFile::new(name, end.text(&run.name, &loaded.sha256)))
    };
    runs.iter().zip(names).filter_map(state).collect()
}

/// A table that is written row by row, with columns named with their units.
pub struct RunTable<'a> {
    /// Path of the table, for messages.
    path: String,
    parts: SignalParts,
    columns: Vec<Signal>,
    table: NumberTable<Box<dyn Unfinished + 'a>>,
    /// The row that is being written.
    values: Vec<f64>,
}

impl<'a> RunTable<'a> {
    /// A table with its headings; `bench` determines its columns.
    pub(super) fn begin(
        destination: &'a dyn Destination,
        name: &str,
        format: TableFormat,
        bench: &ControlledMachine,
    ) -> Result<RunTable<'a>, WriteError> {
        let parts = SignalParts::of(bench);
        let columns = parts.signals();
        let names: Vec<_> = columns.iter().map(|signal| signal.quantity().text(bench.units.motion)).collect();
        let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
        let path = destination.path_of(name);
        let table = NumberTable::new(destination.begin(name)?, format, &names);
        let table = table.map_err(|error| unwritten(&path, &error))?;
        Ok(RunTable { path, parts, columns, table, values: Vec::new() })
    }

    pub(super) fn row(&mut self, sample: &Sample) -> Result<(), WriteError> {
        self.values.clear();
        self.values.extend(self.columns.iter().map(|signal| self.parts.value(*signal, sample)));
        self.table.row(&self.values).map_err(|error| unwritten(&self.path, &error))
    }

    /// Stores the table under its name.
    pub(super) fn finish(self) -> Result<(), WriteError> {
        let RunTable { path, table, .. } = self;
        table.finish().and_then(Unfinished::finish).map_err(|error| unwritten(&path, &error))
    }
}

fn unwritten(path: &str, error: &std::io::Error) -> WriteError {
    WriteError { path: path.to_string(), reason: error.to_string() }
}
