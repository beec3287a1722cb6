//! Measurements on the rig, compared with the simulation.
//!
//! ```text
//! NRMSE = sqrt(mean (m - s)^2)/(max m - min m)           m measured, s simulated, over the rows within the scenario
//! ```
//!
//! The simulation is sampled every quarter of a millisecond or more often (less often, as reported,
//! in a scenario of more than 100 s) and interpolated linearly.

use super::Look;
use super::columns::ColumnSource;
use super::metrics::Measured;
use crate::family::measured::table::{self, MeasuredCell, MeasuredTable};
use crate::project::{Findings, MeasuredFile, Project, RawFinding, Refusal, Scenario};
use crate::quantity::{self, Dimension, DisplayUnit, TIME};
use crate::source;
use crate::spelling::nearest;

/// Columns of time that are known by their name, with their unit.
const TIMES: [(&str, &str); 2] = [("time_s", "s"), ("time_ms", "ms")];

/// A signal as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measurement {
    file: String,
    column: String,
    signal: &'static str,
    /// s, of the scenario; rising.
    times_s: Vec<f64>,
    /// SI.
    values: Vec<f64>,
}

/// A measured signal and the simulated one.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    /// Of the measurement.
    pub file: String,
    /// Its column.
    pub column: String,
    /// The simulated signal, by the name of its column in the table.
    pub signal: &'static str,
    /// Times of the rows that are compared, s.
    pub times_s: Vec<f64>,
    /// Measured, SI.
    pub measured: Vec<f64>,
    /// Simulated at the same times, SI.
    pub simulated: Vec<f64>,
    /// Rows of the file before the scenario begins or after what was simulated.
    pub rows_outside: usize,
    /// Root mean square of the difference, SI.
    pub rmse: Measured,
    /// The same over the range of the measured values.
    pub nrmse: Measured,
}

impl Overlay {
    /// The unit in which people read the signal.
    pub fn display_unit(&self) -> DisplayUnit {
        let by_ending = [
            ("_m3_per_s", DisplayUnit::LITRE_PER_MINUTE),
            ("_m_per_s", DisplayUnit::METRE_PER_SECOND),
            ("_pa", DisplayUnit::BAR),
            ("_n", DisplayUnit::NEWTON),
            ("_m", DisplayUnit::MILLIMETRE),
        ];
        let found = by_ending.into_iter().find(|(ending, _)| self.signal.ends_with(ending));
        found.map_or(DisplayUnit::VOLT, |(_, unit)| unit)
    }

    /// The signal without its unit, in words.
    pub fn quantity(&self) -> String {
        let endings = ["_m3_per_s", "_m_per_s", "_pa", "_n", "_m", "_v"];
        let name = endings.iter().find_map(|ending| self.signal.strip_suffix(ending)).unwrap_or(self.signal);
        name.replace('_', " ")
    }
}

const NO_ROW: &str = "no row of the file lies within what was simulated";
const NO_SIGNAL: &str = "the scenario has no such signal";
const NO_RANGE: &str = "what was measured does not change: there is no range to divide by";

/// Everything that was measured of a scenario.
///
/// # Errors
/// Every row and column that cannot be taken, with its place.
pub(super) fn measurements(
    source: &dyn source::Source,
    project: &Project,
    scenario: &Scenario,
) -> Result<Vec<Measurement>, Box<Refusal>> {
    let mut findings = Findings::default();
    let mut found = Vec::new();
    for declared in &scenario.measured {
        let path = project.path_of(&declared.file);
        match source.read(&path) {
            Ok(bytes) => {
                if let Some(table) = table::read(&path, &bytes, &mut findings) {
                    found.extend(of_table(declared, scenario.duration, &table, &mut findings));
                }
            }
            Err(error) => findings.unreadable(&path, &error.to_string()),
        }
    }
    if findings.error_count() > 0 { Err(Box::new(findings.report())) } else { Ok(found) }
}

/// A column of the file.
struct RecordingColumn<'u> {
    index: usize,
    unit: &'u str,
    dimension: &'static Dimension,
}

fn of_table(
    declared: &MeasuredFile,
    duration_s: f64,
    table: &MeasuredTable<'_>,
    findings: &mut Findings,
) -> Vec<Measurement> {
    let time = time_column(declared, table, findings);
    let columns: Vec<Option<RecordingColumn<'_>>> = declared
        .signals
        .iter()
        .map(|signal| {
            let index = named(signal.column(), table, findings)?;
            Some(RecordingColumn { index, unit: signal.unit(), dimension: signal.dimension() })
        })
        .collect();
    let (Some(time), Some(columns)) = (time, columns.into_iter().collect::<Option<Vec<_>>>()) else {
        return Vec::new();
    };
    let mut times_s: Vec<f64> = Vec::with_capacity(table.rows.len());
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
    for row in &table.rows {
        if !table.is_complete(row, findings) {
            continue;
        }
        let Some(time_s) = time.value(row, findings).map(|time_s| time_s + declared.offset) else { continue };
        if times_s.last().is_some_and(|last| *last >= time_s) {
            let place = row.get(time.index).map(|cell| cell.place).unwrap_or_default();
            findings.push(
                RawFinding::error(place, "times must increase from row to row").expected("a later time"),
            );
            return Vec::new();
        }
        times_s.push(time_s);
        for (column, values) in columns.iter().zip(&mut values) {
            values.extend(column.value(row, findings));
        }
    }
    if !times_s.iter().any(|time_s| (0.0..=duration_s).contains(time_s)) && findings.error_count() == 0 {
        let place = table.rows.first().and_then(|row| row.get(time.index)).map(|cell| cell.place);
        let found = RawFinding::error(place.unwrap_or_default(), "no row lies within the scenario");
        findings.push(found.help("`offset` is added to the times of the file"));
    }
    let signals = declared.signals.iter().zip(values);
    signals
        .map(|(signal, values)| Measurement {
            file: declared.file.clone(),
            column: signal.column().to_string(),
            signal: signal.signal,
            times_s: times_s.clone(),
            values,
        })
        .collect()
}

/// The column of times: the one that is named, or one with a known name.
fn time_column<'u>(
    declared: &'u MeasuredFile,
    table: &MeasuredTable<'_>,
    findings: &mut Findings,
) -> Option<RecordingColumn<'u>> {
    let unit = declared.time_unit.as_deref().unwrap_or(TIME.si);
    if let Some(name) = &declared.time_column {
        return Some(RecordingColumn { index: named(name, table, findings)?, unit, dimension: &TIME });
    }
    let known =
        |cell: &MeasuredCell<'_>| TIMES.iter().find(|(name, _)| *name == cell.text).map(|(_, unit)| *unit);
    let mut found = table.header.iter().enumerate().filter_map(|(index, cell)| Some((index, known(cell)?)));
    let (first, second) = (found.next(), found.next());
    let place = |index: usize| table.header.get(index).map(|cell| cell.place).unwrap_or_default();
    if let Some((index, _)) = second {
        findings.push(RawFinding::error(
            place(index),
            "this column is there twice, here in another unit or again",
        ));
        return None;
    }
    if first.is_none() {
        let [(one, _), (other, _)] = TIMES;
        let message = format!("the columns lack `{one}` or `{other}`, and no `time_column` is named");
        findings.push(RawFinding::error(place(0), message));
    }
    first.map(|(index, unit)| RecordingColumn { index, unit, dimension: &TIME })
}

/// The index of the only column with this name.
fn named(name: &str, table: &MeasuredTable<'_>, findings: &mut Findings) -> Option<usize> {
    let mut found = table.header.iter().enumerate().filter(|(_, cell)| cell.text == name);
    let (first, second) = (found.next(), found.next());
    if let Some((_, cell)) = second {
        findings.push(RawFinding::error(cell.place, format!("a second column `{name}`")));
        return None;
    }
    if first.is_none() {
        let place = table.header.first().map(|cell| cell.place).unwrap_or_default();
        let names = || table.header.iter().map(|cell| cell.text);
        let missing = RawFinding::error(place, format!("there is no column `{name}`"));
        findings.push(match nearest(name, names()) {
            Some(near) => missing.help(format!("did you mean `{near}`?")),
            None => missing.help(format!("there are: {}", names().collect::<Vec<_>>().join(", "))),
        });
    }
    first.map(|(index, _)| index)
}

impl RecordingColumn<'_> {
    /// SI; a gap is reported like any other text that is not a number.
    fn value(&self, row: &[MeasuredCell<'_>], findings: &mut Findings) -> Option<f64> {
        let cell = row.get(self.index)?;
        let bare = cell.text.parse::<f64>().is_ok_and(f64::is_finite);
        let text = format!("{} {}", cell.text, self.unit);
        let value = bare.then(|| quantity::parse(&text, self.dimension).ok()).flatten();
        let value = value.filter(|value| value.is_finite());
        if value.is_none() {
            let message = if cell.text.is_empty() {
                "there is no value".to_string()
            } else {
                format!("`{}` is no number", cell.text)
            };
            findings
                .push(RawFinding::error(cell.place, message).expected(format!("a number in {}", self.unit)));
        }
        value
    }
}

/// A measurement that is compared with a run while it is sampled.
pub(super) struct Overlaying<'a> {
    measurement: &'a Measurement,
    source: Option<ColumnSource>,
    /// Time and value of the last sample.
    before: Option<(f64, f64)>,
    /// The next row.
    next: usize,
    overlay: Overlay,
}

impl<'a> Overlaying<'a> {
    pub(super) fn new(measurement: &'a Measurement) -> Overlaying<'a> {
        let overlay = Overlay {
            file: measurement.file.clone(),
            column: measurement.column.clone(),
            signal: measurement.signal,
            times_s: Vec::new(),
            measured: Vec::new(),
            simulated: Vec::new(),
            rows_outside: 0,
            rmse: Err(NO_ROW),
            nrmse: Err(NO_ROW),
        };
        let source = ColumnSource::named(measurement.signal);
        Overlaying { measurement, source, before: None, next: 0, overlay }
    }

    /// Takes every row since the last sample, interpolated linearly between the two.
    pub(super) fn take(&mut self, look: &Look) {
        let Some(source) = self.source else { return };
        let (now_s, now) = (look.time_s, source.of(look));
        while let Some((&time_s, &measured)) =
            self.measurement.times_s.get(self.next).zip(self.measurement.values.get(self.next))
            && time_s <= now_s
        {
            self.next += 1;
            let simulated = match self.before {
                _ if time_s == now_s => now,
                Some((before_s, before)) => {
                    before + (time_s - before_s) / (now_s - before_s) * (now - before)
                }
                None => {
                    self.overlay.rows_outside += 1;
                    continue;
                }
            };
            self.overlay.times_s.push(time_s);
            self.overlay.measured.push(measured);
            self.overlay.simulated.push(simulated);
        }
        self.before = Some((now_s, now));
    }

    pub(super) fn finish(self) -> Overlay {
        let mut overlay = self.overlay;
        overlay.rows_outside += self.measurement.times_s.len() - self.next;
        if !overlay.measured.is_empty() {
            let pairs = overlay.measured.iter().zip(&overlay.simulated);
            let squares: f64 =
                pairs.map(|(measured, simulated)| (measured - simulated) * (measured - simulated)).sum();
            let rmse = (squares / overlay.measured.len() as f64).sqrt();
            let largest = overlay.measured.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let range = largest - overlay.measured.iter().copied().fold(f64::INFINITY, f64::min);
            let found = if rmse.is_finite() { Ok(rmse) } else { Err(NO_SIGNAL) };
            overlay.rmse = found;
            overlay.nrmse = if range > 0.0 { found.map(|rmse| rmse / range) } else { Err(NO_RANGE) };
        }
        overlay
    }
}
