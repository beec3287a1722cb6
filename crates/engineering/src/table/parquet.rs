//! Reader of a table in Apache Parquet format.

use std::fmt::Write as _;

use bytes::Bytes;
use parquet::basic::{Compression, ConvertedType, LogicalType, TimeUnit};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use super::column::Column;
use super::error::{MeasuredTableError, ParquetColumnError, RowError, TableHint};
use super::faults::Faults;
use super::{ColumnNumbers, Heading};
use crate::project::{Findings, Place, RawFinding};

/// Magic bytes at the beginning and end of a file.
pub(super) const MAGIC: &[u8] = b"PAR1";

/// The rows of a file.
pub(super) struct ParquetRows {
    /// Index among the texts of the findings, of an empty one.
    text: usize,
    file: SerializedFileReader<Bytes>,
    pub(super) count: usize,
}

/// Number of values of one type that are decoded at once.
const BATCH: usize = 8192;
/// Largest number of rows for which memory is reserved before they are read: a file may state any
/// number.
const MOST_RESERVED: usize = 1 << 20;

/// Opens a file: names of its columns, and rows that are read on request.
pub(super) fn open(
    file: &str,
    bytes: Vec<u8>,
    findings: &mut Findings,
) -> Option<(Vec<Heading>, ParquetRows)> {
    let opened = SerializedFileReader::new(Bytes::from(bytes));
    let opened = opened
        .map_err(|error| findings.unreadable(file, &MeasuredTableError::NoParquet(error).to_string()))
        .ok()?;
    let text = findings.add_text(file, "", 0);
    let metadata = opened.metadata().file_metadata();
    let count = usize::try_from(metadata.num_rows()).unwrap_or(0);
    let headings = metadata.schema_descr().columns().iter().map(|column| Heading {
        text: column.path().string(),
        place: Place { text, start: 0, end: 0 },
        unit: is_moment(column).then(|| "s".to_string()),
    });
    let headings = headings.collect();
    let chunks = opened.metadata().row_groups().iter().flat_map(|group| group.columns());
    let packed = chunks.map(|chunk| chunk.compression());
    if let Some(codec) = packed.into_iter().find(|codec| !is_readable(*codec)) {
        let (codec, place) = (codec.to_string(), Place { text, start: 0, end: 0 });
        let name = codec.split('(').next().unwrap_or_default();
        let found = RawFinding::error(place, MeasuredTableError::Codec(name.to_string()).to_string());
        findings.push(found.help(TableHint::SnappyOrNone.to_string()));
        return None;
    }
    if count == 0 {
        let place = Place { text, start: 0, end: 0 };
        findings.push(RawFinding::error(place, MeasuredTableError::NoRows.to_string()));
        return None;
    }
    Some((headings, ParquetRows { text, file: opened, count }))
}

/// Number of a row, from 1, and the column, as a place in a table without lines.
pub(super) fn number_of(row: usize, heading: &str) -> String {
    format!("row {}, column `{heading}`", row + 1)
}

fn is_readable(codec: Compression) -> bool {
    matches!(codec, Compression::UNCOMPRESSED | Compression::SNAPPY)
}

/// True if values are points in time.
fn is_moment(column: &ColumnDescriptor) -> bool {
    matches!(ParquetInteger::of(column), Some(ParquetInteger::Since(_)))
}

/// Meaning of the whole numbers of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ParquetInteger {
    /// Signed number.
    Number,
    /// Unsigned number.
    Unsigned,
    /// Number times ten to this power.
    Power(i32),
    /// Point in time, in seconds times ten to this power, counted from the first.
    Since(i32),
}

impl ParquetInteger {
    fn of(column: &ColumnDescriptor) -> Option<ParquetInteger> {
        let second = |unit: &TimeUnit| match unit {
            TimeUnit::MILLIS => -3,
            TimeUnit::MICROS => -6,
            TimeUnit::NANOS => -9,
        };
        match (column.logical_type_ref(), column.converted_type()) {
            (Some(LogicalType::Timestamp(moment)), _) => Some(ParquetInteger::Since(second(&moment.unit))),
            (Some(LogicalType::Time(moment)), _) => Some(ParquetInteger::Since(second(&moment.unit))),
            (None, ConvertedType::TIMESTAMP_MILLIS | ConvertedType::TIME_MILLIS) => {
                Some(ParquetInteger::Since(-3))
            }
            (None, ConvertedType::TIMESTAMP_MICROS | ConvertedType::TIME_MICROS) => {
                Some(ParquetInteger::Since(-6))
            }
            (Some(LogicalType::Decimal(decimal)), _) => Some(ParquetInteger::Power(-decimal.scale)),
            (None, ConvertedType::DECIMAL) => Some(ParquetInteger::Power(-column.type_scale())),
            (Some(LogicalType::Integer(whole)), _) if !whole.is_signed => Some(ParquetInteger::Unsigned),
            (
                None,
                ConvertedType::UINT_8
                | ConvertedType::UINT_16
                | ConvertedType::UINT_32
                | ConvertedType::UINT_64,
            ) => Some(ParquetInteger::Unsigned),
            (None | Some(LogicalType::Integer(_)), _) => Some(ParquetInteger::Number),
            _ => None,
        }
    }

    /// Writes a number as text; `first` is the first of its column.
    fn write(self, value: i64, first: i64, mask: u64, text: &mut String) {
        text.clear();
        // writing to a text cannot fail
        let _ = match self {
            ParquetInteger::Number => write!(text, "{value}"),
            ParquetInteger::Unsigned => write!(text, "{}", value.cast_unsigned() & mask),
            ParquetInteger::Power(ten) => write!(text, "{value}e{ten}"),
            ParquetInteger::Since(ten) => write!(text, "{}e{ten}", i128::from(value) - i128::from(first)),
        };
    }
}

/// State of reading the numbers of a column, each from its shortest text, so that the table in text
/// form gives identical numbers.
struct ParquetReading<'c> {
    rows: &'c ParquetRows,
    column: &'c Column,
    /// Heading of the column.
    name: &'c str,
    values: Vec<f64>,
    gaps: Vec<usize>,
    /// Rows with a value that is not a number.
    wrong: Faults,
    text: String,
    /// First whole number.
    first: Option<i64>,
}

impl ParquetReading<'_> {
    fn gap(&mut self) {
        self.gaps.push(self.values.len());
        self.values.push(f64::NAN);
    }

    fn text(&mut self, text: &str) {
        let value = self.column.scale.read(text);
        if value.is_none() {
            let row = self.values.len();
            self.wrong.add(|| {
                let message = RowError::NotANumber(text.to_string());
                let message = format!("{}: {message}", number_of(row, self.name));
                RawFinding::error(self.rows.place(row), message).expected(self.column.expected())
            });
        }
        self.values.push(value.unwrap_or(f64::NAN));
    }

    fn double(&mut self, value: Option<f64>) {
        match value.filter(|value| !value.is_nan()) {
            Some(value) => self.text(zmij::Buffer::new().format(value)),
            None => self.gap(),
        }
    }

    fn float(&mut self, value: Option<f32>) {
        match value.filter(|value| !value.is_nan()) {
            Some(value) => self.text(zmij::Buffer::new().format(value)),
            None => self.gap(),
        }
    }

    fn whole(&mut self, value: Option<i64>, whole: ParquetInteger, mask: u64) {
        let Some(value) = value else { return self.gap() };
        let first = *self.first.get_or_insert(value);
        let mut text = std::mem::take(&mut self.text);
        whole.write(value, first, mask, &mut text);
        self.text(&text);
        self.text = text;
    }
}

impl ParquetRows {
    /// Place of a row, which has none in a text; only the order of findings depends on it.
    pub(super) fn place(&self, row: usize) -> Place {
        Place { text: self.text, start: row + 1, end: row + 1 }
    }

    /// Numbers of columns; unreadable ones are reported.
    pub(super) fn numbers(
        &self,
        headings: &[Heading],
        columns: &[&Column],
        findings: &mut Findings,
    ) -> ColumnNumbers {
        let mut numbers = ColumnNumbers::default();
        for column in columns {
            let name = headings.get(column.index).map_or("", |heading| &heading.text);
            let mut reading = ParquetReading {
                rows: self,
                column,
                name,
                values: Vec::with_capacity(self.count.min(MOST_RESERVED)),
                gaps: Vec::new(),
                wrong: Faults::default(),
                text: String::new(),
                first: None,
            };
            if let Err(why) = self.column(column.index, &mut reading) {
                let place = Place { text: self.text, start: 0, end: 0 };
                findings.push(RawFinding::error(place, format!("column `{name}`: {why}")));
            }
            reading.wrong.finding(self.count).into_iter().for_each(|found| findings.push(found));
            numbers.columns.push(reading.values);
            numbers.gaps.push(reading.gaps);
        }
        numbers
    }

    /// Reads a column.
    fn column(&self, index: usize, reading: &mut ParquetReading<'_>) -> Result<(), ParquetColumnError> {
        let description = self.file.metadata().file_metadata().schema_descr().column(index);
        if description.max_rep_level() > 0 {
            return Err(ParquetColumnError::Lists);
        }
        let level = description.max_def_level();
        let whole = ParquetInteger::of(&description).ok_or(ParquetColumnError::NotNumbers)?;
        for group in 0..self.file.num_row_groups() {
            let group = self.file.get_row_group(group)?;
            match group.get_column_reader(index)? {
                ColumnReader::DoubleColumnReader(reader) => {
                    each(reader, level, |value| reading.double(value))?;
                }
                ColumnReader::FloatColumnReader(reader) => each(reader, level, |value| reading.float(value))?,
                ColumnReader::Int64ColumnReader(reader) => {
                    each(reader, level, |value| reading.whole(value, whole, u64::MAX))?;
                }
                ColumnReader::Int32ColumnReader(reader) => each(reader, level, |value| {
                    reading.whole(value.map(i64::from), whole, u64::from(u32::MAX));
                })?,
                _ => return Err(ParquetColumnError::NotNumbers),
            }
        }
        match reading.values.len() == self.count {
            true => Ok(()),
            false => Err(ParquetColumnError::OtherCount { values: reading.values.len(), rows: self.count }),
        }
    }
}

/// Reads all values of a column in a group of rows; `None` is a gap.
fn each<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    level: i16,
    mut take: impl FnMut(Option<T::T>),
) -> Result<(), ParquetError> {
    let (mut found, mut levels) = (Vec::new(), Vec::new());
    loop {
        found.clear();
        levels.clear();
        let of_levels = (level > 0).then_some(&mut levels);
        let (records, _, _) = reader.read_records(BATCH, of_levels, None, &mut found)?;
        if records == 0 {
            return Ok(());
        }
        let mut found = found.drain(..);
        if level == 0 {
            found.for_each(|value| take(Some(value)));
        } else {
            levels.iter().for_each(|one| take(if *one == level { found.next() } else { None }));
        }
    }
}
