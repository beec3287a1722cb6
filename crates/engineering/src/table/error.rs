//! Errors of tables of measurements, with the hints that go with them.

use parquet::errors::ParquetError;

use crate::quantity::{PRESSURE, display};

/// Error of a file that is not a table of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum ForeignFile {
    /// A ZIP archive, as spreadsheets are.
    #[error("the file is not text with a table but a spreadsheet or an archive: save the sheet as CSV")]
    Archive,
    /// A spreadsheet in a compound file.
    #[error("the file is not text with a table but a spreadsheet of an old kind: save the sheet as CSV")]
    OldSpreadsheet,
    /// A file compressed by gzip.
    #[error("the file is not text with a table but compressed: unpack it first")]
    Compressed,
    /// A file of MATLAB.
    #[error(
        "the file is not text with a table but a file of MATLAB: save the signals with `writetable` or `parquetwrite`"
    )]
    Matlab,
    /// A file of HDF5.
    #[error(
        "the file is not text with a table but a file of HDF5, as MATLAB too writes them: save the signals as CSV or Parquet"
    )]
    Hdf5,
    /// A binary file of LabVIEW.
    #[error("the file is not text with a table but a file of LabVIEW: save the signals as CSV or Parquet")]
    Labview,
    /// A document for printing.
    #[error("the file is not text with a table but a document: save the table as CSV")]
    Document,
    /// Bytes that no text has.
    #[error("the file is not text")]
    NotText,
}

/// Error of a column, its heading or its unit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum ColumnError {
    /// One column for several signals.
    #[error("`{heading}` is taken for {signals} signals")]
    TakenForSeveral { heading: String, signals: usize },
    /// A second column with the heading that a project states.
    #[error("a second column `{0}`")]
    SecondStated(String),
    /// A second column of a signal.
    #[error("`{heading}` is a second column of `{signal}`")]
    SecondOfSignal { heading: String, signal: &'static str },
    /// A heading has no unit.
    #[error("`{0}` has no unit")]
    NoUnit(String),
    /// A unit of another quantity, or of none.
    #[error("`{written}` is not a unit of {dimension}")]
    NotAUnit { written: String, dimension: &'static str },
    /// A stated unit that differs from that of the heading.
    #[error("`{heading}` is read in {stated}, as the project says, and not in {other}")]
    ReadInStatedUnit { heading: String, stated: String, other: String },
    /// A signal has no column.
    #[error("there is no column `{0}`")]
    Missing(String),
    /// A column belongs to no known signal.
    #[error("unknown column `{0}`")]
    Unknown(String),
    /// Gauge pressures below a vacuum, Pa.
    #[error("`{heading}` falls to {}, which is below a vacuum, in {count} of {rows} rows", shown(*least))]
    BelowVacuum { heading: String, least: f64, count: usize, rows: usize },
    /// Gauge pressures below the atmosphere, Pa.
    #[error(
        "`{heading}` is below the atmosphere in {count} of {rows} rows, by {}: the zero of its transducer may be off",
        shown(*by)
    )]
    BelowAtmosphere { heading: String, by: f64, count: usize, rows: usize },
    /// Whole numbers that continue those with a sign between thousands.
    #[error(
        "`{number}` continues the whole numbers next to it as {without_sign}: a sign stands between thousands in {rows} rows"
    )]
    SignBetweenThousands { number: String, without_sign: String, rows: usize },
}

/// Pressure, Pa, with three digits.
fn shown(pressure: f64) -> String {
    display(pressure, &PRESSURE, 3)
}

/// Error of a row, or of a number in it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum RowError {
    /// A row contains neither numbers nor units.
    #[error("there is no number in this row")]
    NoNumber,
    /// An empty cell.
    #[error("there is no value")]
    NoValue,
    /// A text.
    #[error("`{0}` is not a number")]
    NotANumber(String),
    /// A row of Parquet that ends early, from 1.
    #[error("row {0} is incomplete")]
    Incomplete(usize),
    /// A single value.
    #[error("one value for {columns} columns")]
    OneValue { columns: usize },
    /// More or fewer values than columns.
    #[error("{values} values for {columns} columns")]
    OtherCount { values: usize, columns: usize },
    /// A decimal comma and a decimal point.
    #[error("`{comma}` has a comma where `{point}` has a point")]
    TwoDecimalSigns { comma: String, point: String },
    /// A time equals that of the row before.
    #[error("the time of the row before, with other values")]
    SameTime,
    /// A time after that of the next row, or equal to it.
    #[error("a time that is not before that of the next row")]
    NotBeforeNext,
    /// A time is earlier than that of the row before.
    #[error("a time before that of the row before")]
    BeforePrevious,
}

/// Error of a table as a whole.
#[derive(Debug, thiserror::Error)]
pub(super) enum MeasuredTableError {
    /// The file contains only empty rows.
    #[error("the file is empty")]
    Empty,
    /// There is no row of names.
    #[error("no row has the names of columns")]
    NoNames,
    /// Names without rows.
    #[error("the file has no rows below the names of its columns")]
    NothingBelowNames,
    /// A measurement file of LabVIEW does not have exactly one column of times.
    #[error("a LabVIEW file with X_Columns {0} has no time, or several")]
    LabviewTimes(String),
    /// A measurement file of LabVIEW without names.
    #[error("this LabVIEW file has no row of names that begins with X_Value")]
    LabviewNames,
    /// The export of a chart of LabVIEW.
    #[error(
        "this is the export of a LabVIEW chart: plots next to each other, without time, in numbers such as 25.1m"
    )]
    LabviewChart,
    /// A file that begins as Parquet does.
    #[error("no table of Parquet: {0}")]
    NoParquet(ParquetError),
    /// A codec of Parquet that is not read.
    #[error("the file is compressed by {0}")]
    Codec(String),
    /// A table of Parquet without rows.
    #[error("the file has no rows")]
    NoRows,
}

/// Error of a column of Parquet.
#[derive(Debug, thiserror::Error)]
pub(super) enum ParquetColumnError {
    /// Texts, bytes or truth values.
    #[error("its values are not numbers")]
    NotNumbers,
    /// Several values in a row.
    #[error("its values are lists")]
    Lists,
    /// More or fewer values than rows.
    #[error("{values} values for {rows} rows")]
    OtherCount { values: usize, rows: usize },
    /// Bytes that cannot be decoded.
    #[error(transparent)]
    Library(#[from] ParquetError),
}

/// Expectation or remedy next to an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum TableHint {
    /// Expectation of a row.
    #[error("a number in each column")]
    NumberInEachColumn,
    /// Expectation of a file.
    #[error("one decimal sign in the whole file")]
    OneDecimalSign,
    /// Expectation of a first row.
    #[error("a row with the names of the columns")]
    RowOfNames,
    /// Expectation of a first row, with examples.
    #[error("a row with names such as {0}")]
    NamesSuchAs(String),
    /// Expectation of times.
    #[error("times that increase from row to row")]
    IncreasingTimes,
    /// Expectation of a gauge pressure: the least one, Pa.
    #[error("a gauge pressure above {}", display(*.0, &PRESSURE, 4))]
    GaugePressureAbove(f64),
    /// Expectation of an export of LabVIEW.
    #[error("a record: a row for each sample, with its time")]
    RecordWithTimes,
    /// Headings of a signal.
    #[error("one of {0}")]
    OneOf(String),
    /// Some headings of a signal.
    #[error("one such as {0}")]
    OneSuchAs(String),
    /// A name or unit that is spelled like what was read.
    #[error("did you mean `{0}`?")]
    Near(String),
    /// A name that is spelled like one word of several.
    #[error("`{word}`: did you mean `{near}`?")]
    NearWord { word: String, near: String },
    /// All headings of a file.
    #[error("there are: {0}")]
    Headings(String),
    /// All names of signals.
    #[error("known here: {0}")]
    KnownNames(String),
    /// Tables of a project with headings.
    #[error(
        "a project names other headings: [[identify.recording]] for tests of a valve, [[identify.response]] for frequency responses"
    )]
    HeadingsInProject,
    /// Remedy of a command that is a current.
    #[error("divide the current by the nominal one and head the column `{0}_percent`")]
    CurrentAsPercent(&'static str),
    /// Remedy of an absolute pressure.
    #[error("pressures are gauge here: subtract the atmospheric pressure")]
    AbsolutePressure,
    /// Remedy of an impossible gauge pressure.
    #[error("is the zero of its transducer off, or the sign or unit wrong?")]
    ZeroSignOrUnit,
    /// Remedy of too many values.
    #[error("where the decimal sign is a comma, separate values with semicolons or tabs")]
    SemicolonsOrTabs,
    /// Remedy of digits in groups.
    #[error("write numbers without signs between thousands")]
    NoThousandsSigns,
    /// Remedy of times that cannot be read.
    #[error("write times as seconds from the start, 10:00:00.001 or 2026-11-27T10:00:00.001")]
    TimesAsSeconds,
    /// Remedy of equal times.
    #[error("write times with all their digits")]
    AllDigitsOfTimes,
    /// Remedy of times that decrease.
    #[error("sort the rows by time; where the clock started anew, write two files")]
    SortByTime,
    /// Remedy of an export with several times, or without.
    #[error("save it with one time column")]
    OneTimeColumn,
    /// Remedy of the export of a chart.
    #[error("write the recorded signals to a measurement file (`.lvm`) or CSV instead of the chart")]
    MeasurementFile,
    /// Remedy of a codec that is not read.
    #[error("write it with Snappy (`compression=\"snappy\"`) or without a compression")]
    SnappyOrNone,
}
