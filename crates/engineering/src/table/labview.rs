//! Texts of LabVIEW: measurement files (`.lvm`) state separator and units in lines above the names;
//! charts export plots, not records.

use super::cell::{Cells, Separator};
use super::error::{MeasuredTableError, TableHint};
use super::layout::{TextLayout, lines};
use crate::project::{Place, RawFinding};

/// Beginning of a measurement file.
const MEASUREMENT: &str = "LabVIEW Measurement";
/// Largest number of lines above the names.
const MOST_ABOVE: usize = 200;

/// Data of a measurement file about its columns.
pub(super) struct LabviewHeader {
    pub(super) layout: TextLayout,
    /// Unit of each column, as written; the first one is the time.
    pub(super) units: Vec<String>,
}

/// Header of a measurement file; `None` for any other text.
///
/// # Errors
/// An error for a file without a single column of times, and for one whose names are not in their
/// place.
pub(super) fn header(text: usize, content: &str) -> Option<Result<LabviewHeader, RawFinding>> {
    content.starts_with(MEASUREMENT).then(|| read(text, content))
}

fn read(text: usize, content: &str) -> Result<LabviewHeader, RawFinding> {
    let mut separator = Separator::Sign(b'\t');
    let mut units = vec!["s".to_string()];
    for (line, start) in lines(content, 0).take(MOST_ABOVE) {
        let place = Place { text, start, end: start + line.trim_end().len() };
        let mut cells = Cells::new(content, start, separator).map(|cell| cell.text);
        match (cells.next(), cells.next()) {
            (Some("X_Value"), _) => {
                return Ok(LabviewHeader { layout: TextLayout { separator, header: start }, units });
            }
            (Some("X_Columns"), Some(kind)) if kind != "One" => {
                let found =
                    RawFinding::error(place, MeasuredTableError::LabviewTimes(kind.to_string()).to_string());
                return Err(found.help(TableHint::OneTimeColumn.to_string()));
            }
            (Some("Y_Unit_Label"), first) => {
                units.extend(first.into_iter().chain(cells).map(str::to_string));
            }
            _ if line.starts_with("Separator,") => separator = Separator::Sign(b','),
            _ => {}
        }
    }
    let place = Place { text, start: 0, end: MEASUREMENT.len() };
    Err(RawFinding::error(place, MeasuredTableError::LabviewNames.to_string()))
}

/// Suffix that LabVIEW adds to the name of a plot.
const PLOT: &str = " - Plot ";

/// Rejects the export of a chart: several plots next to each other, and no time.
///
/// # Errors
/// An error at the row of names.
pub(super) fn refuse_chart(text: usize, content: &str) -> Result<(), RawFinding> {
    let is_chart = |(line, _): &(&str, usize)| line.matches(PLOT).count() > 1;
    let Some((line, start)) = lines(content, 0).take(MOST_ABOVE).find(is_chart) else { return Ok(()) };
    let place = Place { text, start, end: start + line.trim_end().len() };
    let found = RawFinding::error(place, MeasuredTableError::LabviewChart.to_string());
    let found = found.expected(TableHint::RecordWithTimes.to_string());
    Err(found.help(TableHint::MeasurementFile.to_string()))
}
