//! Tables of numbers, read back after writing.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use phea_workbench::answer::{NumberTable, TableFormat};

#[test]
fn numbers_read_back() {
    let text = |value| {
        let mut table = NumberTable::new(Vec::new(), TableFormat::Csv, &["a"]).unwrap();
        table.row(&[value]).unwrap();
        let text = String::from_utf8(table.finish().unwrap()).unwrap();
        text.strip_prefix("a\n").and_then(|text| text.strip_suffix('\n')).unwrap().to_string()
    };
    for value in [0.0, 0.001, 1.0 / 3.0, -4000.0, 6.02e23, -1.6e-19, 5e-324, f64::MAX, 1e15, 123_456_789.0] {
        assert_eq!(text(value).parse(), Ok(value), "{}", text(value));
    }
    let short = [(0.0, "0"), (3.1, "3.1"), (3_500_000.0, "3500000"), (2e-7, "2e-7"), (f64::INFINITY, "inf")];
    for (value, expected) in short {
        assert_eq!(text(value), expected);
    }
}

/// Both formats give identical numbers, over several groups of rows.
#[test]
fn both_formats_hold_the_same_numbers() {
    // ORIGIN: written by hand, three rows beyond a group
    let rows = 65_536 + 3;
    let value = |row: usize, column: usize| match (row, column) {
        (7, 1) => f64::NAN,
        _ => (row as f64 - 5.0) / (column as f64 + 3.0),
    };
    let write = |format| {
        let mut table = NumberTable::new(Vec::new(), format, &["a", "b"]).unwrap();
        for row in 0..rows {
            table.row(&[value(row, 0), value(row, 1)]).unwrap();
        }
        assert!(table.row(&[1.0, 2.0, 3.0]).is_err());
        table.finish().unwrap()
    };
    let text = String::from_utf8(write(TableFormat::Csv)).unwrap();
    let reader = SerializedFileReader::new(bytes::Bytes::from(write(TableFormat::Parquet))).unwrap();
    assert!(reader.num_row_groups() > 1);
    let mut count = 0;
    for (line, record) in text.lines().skip(1).zip(reader.get_row_iter(None).unwrap()) {
        let record = record.unwrap();
        for (column, cell) in line.split(',').enumerate() {
            assert_eq!(cell.parse().ok(), record.get_double(column).ok(), "row {count}");
        }
        count += 1;
    }
    assert_eq!(count, rows);
}
