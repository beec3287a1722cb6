//! Rows of a campaign as an Apache Parquet table: the columns of its text, absent numbers null.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

use super::row::{CampaignColumns, Row, RowOutcome, meaningful};

/// Number of rows of a group, whose columns are in memory while it is written.
const GROUP: usize = 10_000;

/// Table of these rows.
///
/// # Errors
/// The error message of the format's library.
pub(super) fn table(columns: &CampaignColumns, rows: &[Row]) -> Result<Vec<u8>, String> {
    written(columns, rows).map_err(|error| error.to_string())
}

/// A column with its values.
enum ParquetColumn {
    Whole(Vec<Option<i64>>),
    Text(Vec<Option<ByteArray>>),
    Double(Vec<Option<f64>>),
    Single(Vec<Option<f32>>),
}

/// Reason why the table cannot be written.
#[derive(Debug, thiserror::Error)]
enum TableError {
    /// Error of the format's library.
    #[error(transparent)]
    Parquet(#[from] ParquetError),
    /// A column of the rows is missing in the header.
    #[error("Parquet error: more columns than names")]
    ColumnWithoutName,
}

fn written(columns: &CampaignColumns, rows: &[Row]) -> Result<Vec<u8>, TableError> {
    let header = columns.header();
    let names = header.trim_end().split(',');
    let kinds = contents(columns, &[]);
    let fields = names.zip(&kinds).map(|(name, column)| field(name, column)).collect::<Result<_, _>>()?;
    let schema = Arc::new(Type::group_type_builder("campaign").with_fields(fields).build()?);
    let properties = Arc::new(WriterProperties::builder().build());
    let mut file = SerializedFileWriter::new(Vec::new(), schema, properties)?;
    for rows in rows.chunks(GROUP) {
        let mut group = file.next_row_group()?;
        for column in &contents(columns, rows) {
            match column {
                ParquetColumn::Whole(values) => write::<Int64Type>(&mut group, values)?,
                ParquetColumn::Text(values) => write::<ByteArrayType>(&mut group, values)?,
                ParquetColumn::Double(values) => write::<DoubleType>(&mut group, values)?,
                ParquetColumn::Single(values) => write::<FloatType>(&mut group, values)?,
            }
        }
        group.close()?;
    }
    Ok(file.into_inner()?)
}

fn field(name: &str, column: &ParquetColumn) -> Result<TypePtr, ParquetError> {
    let (physical, logical) = match column {
        ParquetColumn::Whole(_) => (Physical::INT64, None),
        ParquetColumn::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        ParquetColumn::Double(_) => (Physical::DOUBLE, None),
        ParquetColumn::Single(_) => (Physical::FLOAT, None),
    };
    let field = Type::primitive_type_builder(name, physical);
    Ok(Arc::new(field.with_repetition(Repetition::OPTIONAL).with_logical_type(logical).build()?))
}

fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: &[Option<T::T>],
) -> Result<(), TableError> {
    let mut column = group.next_column()?.ok_or(TableError::ColumnWithoutName)?;
    let present: Vec<T::T> = values.iter().flatten().cloned().collect();
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    column.typed::<T>().write_batch(&present, Some(&levels), None)?;
    Ok(column.close()?)
}

/// Columns with their values, in the order of the header.
fn contents(columns: &CampaignColumns, rows: &[Row]) -> Vec<ParquetColumn> {
    let text = |of: &dyn Fn(&Row) -> Option<String>| {
        ParquetColumn::Text(
            rows.iter().map(|row| of(row).map(|text| ByteArray::from(text.as_str()))).collect(),
        )
    };
    let double = |of: &dyn Fn(&Row) -> Option<f64>| ParquetColumn::Double(rows.iter().map(of).collect());
    let whole = |of: &dyn Fn(&Row) -> Option<i64>| ParquetColumn::Whole(rows.iter().map(of).collect());
    let reason = |row: &Row| match &row.outcome {
        RowOutcome::Refused(reason) => Some(reason.clone()),
        RowOutcome::Driven(_) => None,
    };
    let mut all = vec![
        whole(&|row| i64::try_from(row.run).ok()),
        text(&|_| Some(columns.mark.clone())),
        text(&|row| Some(row.status().key().to_string())),
        text(&reason),
        double(&|row| row.ran()?.end_time_s),
        whole(&|row| i64::try_from(row.ran()?.steps).ok()),
        text(&|row| Some(row.ran()?.occurrences.join(";"))),
    ];
    all.extend((0..columns.paths.len()).map(|place| double(&|row| row.values.get(place).copied())));
    all.extend((0..3).map(|lump| double(&|row| row.lumps.map(|lumps| lumps[lump]))));
    for (number, window) in columns.windows.iter().enumerate() {
        all.extend(
            meaningful(window, columns.open_loop)
                .map(|metric| double(&|row| row.ran()?.metrics.get(number)?[metric])),
        );
    }
    let force = |index: usize| rows.iter().map(|row| row.ran()?.force_n.get(index).copied()).collect();
    all.extend((0..columns.times_s.len()).map(|index| ParquetColumn::Single(force(index))));
    all.push(text(&|row| Some(columns.check(row))));
    all
}
