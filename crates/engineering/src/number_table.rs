//! A table of numbers, written row by row: as text with commas, or as Apache Parquet.

use std::io::{self, Write};
use std::sync::Arc;

use crate::csv::Csv;
use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

/// Format of a table of numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TableFormat {
    /// Text with commas, a first row of names; an absent number is an empty cell.
    #[default]
    Csv,
    /// Apache Parquet, columns of doubles; an absent number is null.
    Parquet,
}

impl TableFormat {
    /// File extension.
    pub fn ending(self) -> &'static str {
        match self {
            TableFormat::Csv => "csv",
            TableFormat::Parquet => "parquet",
        }
    }
}

/// Error for a format in which no table can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a table is written as `csv` or `parquet`")]
pub struct UnknownTableFormat;

impl std::str::FromStr for TableFormat {
    type Err = UnknownTableFormat;

    /// Format with this file extension.
    fn from_str(text: &str) -> Result<TableFormat, UnknownTableFormat> {
        match text {
            "csv" => Ok(TableFormat::Csv),
            "parquet" => Ok(TableFormat::Parquet),
            _ => Err(UnknownTableFormat),
        }
    }
}

/// Error for a row with more values than columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{values} values for {columns} columns")]
struct SurplusValues {
    values: usize,
    columns: usize,
}

/// Number of rows of a group, which is in memory until it is written: half a megabyte for each
/// column.
const GROUP: usize = 65_536;

/// A table of numbers that grows by rows. Text is written as it is computed, Parquet by groups of
/// rows.
///
/// # Example
/// ```
/// use phea_engineering::number_table::{NumberTable, TableFormat};
/// let mut table = NumberTable::new(Vec::new(), TableFormat::Csv, &["time_s", "force_n"])?;
/// table.row(&[0.0, -4000.0])?;
/// table.row(&[2.5e-4, f64::NAN])?;
/// assert_eq!(table.finish()?, b"time_s,force_n\n0,-4000\n0.00025,\n");
/// # Ok::<(), std::io::Error>(())
/// ```
pub struct NumberTable<W: Write + Send>(Writing<W>);

enum Writing<W: Write + Send> {
    Csv { sink: W, line: Csv, columns: usize },
    Parquet { file: Box<SerializedFileWriter<W>>, group: Vec<Vec<f64>> },
}

impl<W: Write + Send> NumberTable<W> {
    /// A table with these columns and no row yet.
    ///
    /// # Errors
    /// The errors of the sink, and an error for a name that the format does not accept.
    pub fn new(mut sink: W, format: TableFormat, columns: &[&str]) -> io::Result<Self> {
        let writing = match format {
            TableFormat::Csv => {
                sink.write_all(Csv::new(&columns.join(",")).text().as_bytes())?;
                Writing::Csv { sink, line: Csv::default(), columns: columns.len() }
            }
            TableFormat::Parquet => {
                let field = |name: &&str| {
                    let double = Type::primitive_type_builder(name, Physical::DOUBLE);
                    Ok(Arc::new(double.with_repetition(Repetition::OPTIONAL).build()?))
                };
                let fields = columns.iter().map(field).collect::<Result<_, _>>().map_err(refused)?;
                let schema =
                    Type::group_type_builder("table").with_fields(fields).build().map_err(refused)?;
                let properties = Arc::new(WriterProperties::builder().build());
                let file = SerializedFileWriter::new(sink, Arc::new(schema), properties).map_err(refused)?;
                Writing::Parquet { file: Box::new(file), group: vec![Vec::new(); columns.len()] }
            }
        };
        Ok(NumberTable(writing))
    }

    /// Adds a row, a value for each column; missing values are absent, surplus values are rejected.
    ///
    /// # Errors
    /// The errors of the sink; [`io::ErrorKind::InvalidInput`] for more values than columns.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        let count = match &self.0 {
            Writing::Csv { columns, .. } => *columns,
            Writing::Parquet { group, .. } => group.len(),
        };
        if values.len() > count {
            let surplus = SurplusValues { values: values.len(), columns: count };
            return Err(io::Error::new(io::ErrorKind::InvalidInput, surplus));
        }
        let row = (0..count).map(|column| values.get(column).copied().unwrap_or(f64::NAN));
        match &mut self.0 {
            Writing::Csv { sink, line, .. } => {
                line.clear();
                row.for_each(|value| push_number(line.cell(), value));
                line.end_row();
                sink.write_all(line.text().as_bytes())
            }
            Writing::Parquet { file, group } => {
                for (column, value) in group.iter_mut().zip(row) {
                    column.push(value);
                }
                if group.first().is_some_and(|column| column.len() >= GROUP) {
                    write_group(file, group)?;
                }
                Ok(())
            }
        }
    }

    /// Ends the table and returns the sink.
    ///
    /// # Errors
    /// The errors of the sink.
    pub fn finish(self) -> io::Result<W> {
        match self.0 {
            Writing::Csv { sink, .. } => Ok(sink),
            Writing::Parquet { mut file, mut group } => {
                write_group(&mut file, &mut group)?;
                file.into_inner().map_err(refused)
            }
        }
    }
}

fn refused(error: parquet::errors::ParquetError) -> io::Error {
    io::Error::other(error.to_string())
}

fn write_group<W: Write + Send>(
    file: &mut SerializedFileWriter<W>,
    columns: &mut [Vec<f64>],
) -> io::Result<()> {
    if columns.iter().all(Vec::is_empty) {
        return Ok(());
    }
    let mut group = file.next_row_group().map_err(refused)?;
    for values in columns {
        let Some(mut column) = group.next_column().map_err(refused)? else { break };
        let levels: Vec<i16> = values.iter().map(|value| i16::from(!value.is_nan())).collect();
        values.retain(|value| !value.is_nan());
        column.typed::<DoubleType>().write_batch(values, Some(&levels), None).map_err(refused)?;
        column.close().map_err(refused)?;
        values.clear();
    }
    group.close().map_err(refused).map(|_| ())
}

/// Appends the shortest text that reads back as an identical number; nothing for an absent number.
fn push_number(text: &mut String, value: f64) {
    if value.is_finite() {
        let mut buffer = zmij::Buffer::new();
        let digits = buffer.format_finite(value);
        text.push_str(digits.strip_suffix(".0").unwrap_or(digits));
    } else if !value.is_nan() {
        text.push_str(if value > 0.0 { "inf" } else { "-inf" });
    }
}
