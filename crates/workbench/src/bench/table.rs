//! The record of a test: as a file, for people and for programs.

use std::io;

use phea_dynamics::order::ends;

use crate::answer::{Answer, NumberTable, OutputFile, TableFormat};
use crate::document::{Cell, Document, Table};
use crate::quantity::{DisplayUnit, TIME, display};

/// File of a virtual test.
#[derive(Answer)]
pub(super) struct BenchFileAnswer {
    /// Name of the test.
    name: &'static str,
    /// Name of the file with its rows.
    file: String,
    /// Number of rows.
    rows: usize,
    /// Time of the last row from the start.
    duration_s: f64,
}

/// Record of a virtual test.
#[derive(Answer)]
pub(super) struct BenchRecordAnswer {
    #[answer(flatten)]
    file: BenchFileAnswer,
    /// Recorded signals.
    signals: Vec<BenchSignalAnswer>,
}

/// Recorded signal of a virtual test.
#[derive(Answer)]
struct BenchSignalAnswer {
    /// Name of the quantity.
    name: &'static str,
    /// SI unit of the range, not of the file; degrees Celsius of a temperature.
    unit: &'static str,
    /// Smallest and largest value.
    #[answer(interval)]
    range: [f64; 2],
}

/// The table of a test.
pub(super) struct BenchTable {
    /// Name of the test and its file.
    pub(super) name: &'static str,
    /// Title for people.
    pub(super) title: &'static str,
    /// Times of the rows, s.
    pub(super) times: Vec<f64>,
    /// Columns other than time.
    pub(super) columns: Vec<BenchColumn>,
}

/// A column of the table.
pub(super) struct BenchColumn {
    /// Name in the file.
    pub(super) name: &'static str,
    /// Quantity, for people.
    pub(super) quantity: &'static str,
    /// Unit in the file, and the values in it.
    pub(super) unit: DisplayUnit,
    pub(super) printed: Vec<f64>,
    /// SI unit, and the values in it.
    pub(super) si: &'static str,
    pub(super) values: Vec<f64>,
}

impl BenchColumn {
    /// A column of values in SI, shown in another unit.
    pub(super) fn of(
        [name, quantity, si]: [&'static str; 3],
        unit: DisplayUnit,
        values: Vec<f64>,
    ) -> BenchColumn {
        let printed = values.iter().map(|value| unit.of(*value)).collect();
        BenchColumn { name, quantity, unit, printed, si, values }
    }

    /// Smallest and largest value, SI.
    pub(super) fn range(&self) -> [f64; 2] {
        ends(self.values.iter().copied())
    }
}

impl BenchTable {
    fn file_name(&self) -> String {
        format!("{}.csv", self.name)
    }

    fn duration_s(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The table as a file.
    pub(super) fn file(&self) -> OutputFile {
        // writing to memory cannot fail
        OutputFile { name: self.file_name(), bytes: self.csv().unwrap_or_default() }
    }

    fn csv(&self) -> io::Result<Vec<u8>> {
        let names: Vec<&str> =
            std::iter::once("time_s").chain(self.columns.iter().map(|column| column.name)).collect();
        let mut table = NumberTable::new(Vec::new(), TableFormat::Csv, &names)?;
        for (row, time_s) in self.times.iter().enumerate() {
            let printed = self.columns.iter().filter_map(|column| column.printed.get(row).copied());
            table.row(&std::iter::once(*time_s).chain(printed).collect::<Vec<f64>>())?;
        }
        table.finish()
    }

    /// A section that shows the range of each column.
    pub(super) fn write_ranges(&self, digits: usize, out: &mut Document) {
        let rows = self.columns.iter().map(|column| {
            let [least, most] = column.range().map(|value| Cell::number_in(value, digits, column.unit));
            [Cell::from(column.quantity), least, most, Cell::unit(column.unit.symbol)]
        });
        out.section(self.title, Table::new(["recorded", "least", "most", "unit"]).with(rows));
        let duration = display(self.duration_s(), &TIME, 4);
        out.sentences([format!("{} rows in {duration}.", self.times.len())]);
    }

    /// The table without its rows.
    pub(super) fn file_answer(&self) -> BenchFileAnswer {
        BenchFileAnswer {
            name: self.name,
            file: self.file_name(),
            rows: self.times.len(),
            duration_s: self.duration_s(),
        }
    }

    /// The same with the smallest and the largest value of each column.
    pub(super) fn answer(&self) -> BenchRecordAnswer {
        let signal = |column: &BenchColumn| BenchSignalAnswer {
            name: column.quantity,
            unit: column.si,
            range: column.range(),
        };
        BenchRecordAnswer { file: self.file_answer(), signals: self.columns.iter().map(signal).collect() }
    }
}
