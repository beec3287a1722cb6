//! Measurements on the rig, compared with the simulation.
//!
//! ```text
//! NRMSE = sqrt(mean (m - s)^2)/(max m - min m)           m measured, s simulated, over the rows within the scenario
//! ```
//!
//! The simulation is sampled every quarter of a millisecond or more often (less often, as reported,
//! in a scenario of more than 100 s) and interpolated linearly.

use phea_dynamics::order::ends;

use phea_hydraulics::signal::Signal;

use super::Sample;
use super::columns::SignalParts;
use super::metrics::{Measured, Unmeasured};
use super::motion_file::rising;
use super::plausible::{self, PhysicalColumn};
use crate::project::{Findings, MeasuredFile, MeasuredSignal, Project, Refusal, Scenario};
use crate::quantity::{DisplayUnit, TIME, Units};
use crate::source;
use crate::table::{Column, Measurand, MeasuredTable, Sought, TIMES};

/// A measured signal.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measurement {
    file: String,
    column: String,
    signal: Signal,
    /// Times of the scenario, s; rising.
    times_s: Vec<f64>,
    /// Values, SI.
    values: Vec<f64>,
}

/// A measured signal and its simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    /// Name of the file with the measurement.
    pub file: String,
    /// Heading of its column.
    pub column: String,
    /// The simulated signal.
    pub signal: Signal,
    /// Times of the compared rows, s.
    pub times_s: Vec<f64>,
    /// Measured values, SI.
    pub measured: Vec<f64>,
    /// Simulated values at these times, SI.
    pub simulated: Vec<f64>,
    /// Number of rows of the file before the beginning of the scenario or after the end of the
    /// simulation.
    pub rows_outside: usize,
    /// Root mean square of the difference, SI.
    pub rmse: Measured,
    /// Root mean square of the difference divided by the range of the measured values.
    pub nrmse: Measured,
}

impl Overlay {
    /// Unit for display of the signal, in a project with these units.
    pub fn display_unit(&self, units: Units) -> DisplayUnit {
        units.of(self.signal.dimension())
    }
}

/// All measured signals of a scenario.
///
/// # Errors
/// Every rejected row and column, with its place.
pub(super) fn measurements(
    source: &dyn source::Source,
    project: &Project,
    scenario: &Scenario,
) -> Result<Vec<Measurement>, Box<Refusal>> {
    let mut findings = Findings::default();
    let mut found = Vec::new();
    for declared in &scenario.measured {
        let path = project.path_of(&declared.file);
        if let Some(bytes) = findings.bytes_of(source, &path) {
            let taken = of_file(project, declared, scenario.duration, &path, bytes, &mut findings);
            found.extend(taken.unwrap_or_default());
        }
    }
    findings.or_refused(found)
}

fn of_file(
    project: &Project,
    declared: &MeasuredFile,
    duration_s: f64,
    path: &str,
    bytes: Vec<u8>,
    findings: &mut Findings,
) -> Option<Vec<Measurement>> {
    let measurands: Vec<Measurand> =
        declared.signals.iter().map(|one| Measurand::of(one.signal.name(), one.signal.dimension())).collect();
    let time_unit = declared.time_column.as_ref().map(|_| declared.time_unit.as_deref().unwrap_or(TIME.si));
    let time = Sought {
        measurand: &TIMES,
        heading: declared.time_column.as_deref(),
        unit: time_unit,
        is_reversed: false,
    };
    let named = declared.signals.iter().zip(&measurands).map(|(one, measurand)| Sought {
        measurand,
        heading: Some(one.column()),
        unit: Some(one.unit()),
        is_reversed: false,
    });
    let sought: Vec<Sought<'_>> = std::iter::once(time).chain(named).collect();
    let table = MeasuredTable::read(path, bytes, &sought, None, findings)?;
    let (columns, _) = table.columns(&sought, findings)?;
    for (_, sought) in columns.iter().zip(&sought).filter(|(column, _)| column.is_none()) {
        findings.push(table.missing(sought));
    }
    let columns: Vec<&Column> = columns.iter().map(Option::as_ref).collect::<Option<_>>()?;
    let mut numbers = table.all_numbers(&columns, findings).into_iter();
    let (mut times_s, time) = (numbers.next()?, columns.first()?);
    for ((signal, column), values) in
        declared.signals.iter().zip(columns.iter().skip(1)).zip(numbers.as_slice())
    {
        let column = PhysicalColumn { table: &table, column, dimension: signal.signal.dimension() };
        plausible::check(project, column, values, findings);
    }
    times_s.iter_mut().for_each(|time_s| *time_s += declared.offset);
    rising(&table, time, &times_s, findings);
    if !times_s.iter().any(|time_s| (0.0..=duration_s).contains(time_s)) && findings.error_count() == 0 {
        let found = table.error(0, time, MeasuredProblem::NoRowWithin.to_string(), findings);
        findings.push(found.help(MeasuredProblem::OffsetIsAdded.to_string()));
    }
    let measurement = |(signal, values): (&MeasuredSignal, Vec<f64>)| Measurement {
        file: declared.file.clone(),
        column: signal.column().to_string(),
        signal: signal.signal,
        times_s: times_s.clone(),
        values,
    };
    Some(declared.signals.iter().zip(numbers).map(measurement).collect())
}

/// Fault of a file of measurements, and a remark on its times.
#[derive(Debug, thiserror::Error)]
enum MeasuredProblem {
    #[error("no row lies within the scenario")]
    NoRowWithin,
    #[error("`offset` is added to the times of the file")]
    OffsetIsAdded,
}

/// A measurement that is compared with a run during sampling.
pub(super) struct Overlaying<'a> {
    measurement: &'a Measurement,
    /// Parts of the rig; `None` if it lacks the signal.
    parts: Option<SignalParts>,
    /// Time and value of the last sample.
    before: Option<(f64, f64)>,
    /// Index of the next row.
    next: usize,
    overlay: Overlay,
}

impl<'a> Overlaying<'a> {
    pub(super) fn new(measurement: &'a Measurement, parts: &SignalParts) -> Overlaying<'a> {
        let overlay = Overlay {
            file: measurement.file.clone(),
            column: measurement.column.clone(),
            signal: measurement.signal,
            times_s: Vec::new(),
            measured: Vec::new(),
            simulated: Vec::new(),
            rows_outside: 0,
            rmse: Err(Unmeasured::NoRow),
            nrmse: Err(Unmeasured::NoRow),
        };
        let parts = parts.have(measurement.signal).then_some(*parts);
        let overlay = match parts {
            Some(_) => overlay,
            None => Overlay { rmse: Err(Unmeasured::NoSignal), nrmse: Err(Unmeasured::NoSignal), ..overlay },
        };
        Overlaying { measurement, parts, before: None, next: 0, overlay }
    }

    /// Evaluates every row since the last sample, interpolated linearly between the two.
    pub(super) fn take(&mut self, sample: &Sample) {
        let Some(parts) = &self.parts else { return };
        let (now_s, now) = (sample.time_s, parts.value(self.measurement.signal, sample));
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
        if self.parts.is_some() {
            overlay.rows_outside += self.measurement.times_s.len() - self.next;
        }
        if !overlay.measured.is_empty() {
            let pairs = overlay.measured.iter().zip(&overlay.simulated);
            let squares: f64 =
                pairs.map(|(measured, simulated)| (measured - simulated) * (measured - simulated)).sum();
            let rmse = (squares / overlay.measured.len() as f64).sqrt();
            let [least, most] = ends(overlay.measured.iter().copied());
            let range = most - least;
            let found = if rmse.is_finite() { Ok(rmse) } else { Err(Unmeasured::NoSignal) };
            overlay.rmse = found;
            overlay.nrmse =
                if range > 0.0 { found.map(|rmse| rmse / range) } else { Err(Unmeasured::NoRange) };
        }
        overlay
    }
}
