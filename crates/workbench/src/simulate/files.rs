//! The files of `simulate`: a table for each scenario, and the state it ended in.

use std::fmt::Write as _;

use super::columns::Columns;
use super::{Look, ScenarioRun};
use crate::answer::{NumberTable, OutputFile, TableFormat};
use crate::project::Loaded;
use crate::source::{Destination, Unfinished, WriteError};

/// The state each run ended in, where that can be saved.
pub(crate) fn files(loaded: &Loaded, runs: &[ScenarioRun]) -> Vec<OutputFile> {
    let names = state_names(runs.iter().map(|run| run.name.as_str()));
    let state = |(run, name): (&ScenarioRun, String)| {
        let end = run.end.as_ref().ok()?;
        Some(OutputFile { name, bytes: end.text(&run.name, &loaded.sha256).into_bytes() })
    };
    runs.iter().zip(names).filter_map(state).collect()
}

/// Names of the files with the states of these scenarios.
pub(crate) fn state_names<'a>(scenarios: impl Iterator<Item = &'a str>) -> Vec<String> {
    names(scenarios).into_iter().map(|name| format!("{name}.state.toml")).collect()
}

/// Names of the tables of scenarios with these names, each after its own and no two alike.
pub(crate) fn table_names<'a>(scenarios: impl Iterator<Item = &'a str>, ending: &str) -> Vec<String> {
    names(scenarios).into_iter().map(|name| format!("{name}.{ending}")).collect()
}

/// Each after its own and no two alike.
fn names<'a>(scenarios: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for scenario in scenarios {
        let plain = file_name(scenario);
        let numbered = (2..).map(|number| format!("{plain} {number}"));
        let taken = |name: &String| names.iter().any(|known| known.eq_ignore_ascii_case(name));
        let name =
            std::iter::once(plain.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(plain.clone());
        names.push(name);
    }
    names
}

/// What file systems do not take in a name becomes an underscore.
fn file_name(name: &str) -> String {
    let plain =
        |letter: char| if letter.is_control() || "/\\:*?\"<>|".contains(letter) { '_' } else { letter };
    let name: String = name.chars().map(plain).collect();
    match name.trim_matches([' ', '.']) {
        "" => "scenario".to_string(),
        name => name.to_string(),
    }
}

/// A table that is written row by row, columns named with their units.
pub(crate) struct Table<'a> {
    name: String,
    columns: Columns,
    table: NumberTable<Box<dyn Unfinished + 'a>>,
    /// The row that is being written.
    values: Vec<f64>,
}

impl<'a> Table<'a> {
    /// A table with its head, and a last column for the force from outside where the load is `pushed`.
    pub(super) fn begin(
        (destination, name): (&'a dyn Destination, &str),
        format: TableFormat,
        pushed: bool,
    ) -> Result<Table<'a>, WriteError> {
        let columns = Columns::new(pushed);
        let table = NumberTable::new(destination.begin(name)?, format, &columns.names());
        let table = table.map_err(|error| unwritten(name, &error))?;
        Ok(Table { name: name.to_string(), columns, table, values: Vec::new() })
    }

    pub(super) fn row(&mut self, look: &Look) -> Result<(), WriteError> {
        self.columns.read(look, &mut self.values);
        self.table.row(&self.values).map_err(|error| unwritten(&self.name, &error))
    }

    /// Puts it under its name.
    pub(super) fn finish(self) -> Result<(), WriteError> {
        let Table { name, table, .. } = self;
        table.finish().and_then(Unfinished::finish).map_err(|error| unwritten(&name, &error))
    }
}

fn unwritten(name: &str, error: &std::io::Error) -> WriteError {
    WriteError { path: name.to_string(), reason: error.to_string() }
}

/// The shortest text that reads back as the same number.
pub(super) fn number(text: &mut String, value: f64) {
    let size = value.abs();
    let plain = size == 0.0 || (1e-4..1e15).contains(&size);
    // a text takes all that is written into it
    let _ = if plain { write!(text, "{value}") } else { write!(text, "{value:e}") };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_names_everywhere() {
        let name = |text: &str| file_name(text);
        assert_eq!(name("step and load motion"), "step and load motion");
        assert_eq!(
            (name("a/b\\c:d"), name(" .. "), name("1 ms.")),
            ("a_b_c_d".into(), "scenario".into(), "1 ms".into())
        );
    }

    #[test]
    fn tables_of_scenarios_with_like_names_have_names_of_their_own() {
        let names = table_names(["step", "Step", "a/b", "step"].into_iter(), "csv");
        assert_eq!(names, ["step.csv", "Step 2.csv", "a_b.csv", "step 3.csv"]);
    }

    #[test]
    fn numbers_read_back() {
        let number = |value: f64| {
            let mut text = String::new();
            super::number(&mut text, value);
            text
        };
        for value in [0.0, 0.001, 1.0 / 3.0, -4000.0, 6.02e23, -1.6e-19, 5e-324] {
            assert_eq!(number(value).parse(), Ok(value));
        }
        assert_eq!((number(3.1), number(2e-7)), ("3.1".to_string(), "2e-7".to_string()));
    }
}
