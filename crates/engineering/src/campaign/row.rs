//! One run as a line of a table: its drawn numbers, its status, and its metrics.

use phea_hydraulics::machine::INDICATORS;
use phea_hydraulics::signal::Signal;
use phea_quantity::{QuantityName, STIFFNESS, Units};
use sha2::{Digest, Sha256};

use super::csv::{Csv, quoted};
use super::shortest_number;
use super::simulate::{
    COMMAND_LIMIT, Cause, ERRORS_AMPLIFIED, LINE_OCCURRENCES, Metric, Metrics, PerMetric, REPEATED,
    RunStatus, Window,
};

/// Metrics in the order of a row: a new metric is added at the end, since the columns of stored
/// rows have fixed positions.
pub const ROW_METRICS: [Metric; Metric::ALL.len()] = [
    Metric::Overshoot,
    Metric::RiseTime,
    Metric::SettlingTime,
    Metric::DisturbancePeak,
    Metric::SteadyStateError,
    Metric::ControlPeak,
    Metric::ControlRms,
    Metric::TrackingErrorPeak,
    Metric::ForcePeak,
];

/// Parameters of the linear model that a drawn machine visits: K_H, K_qU, K_c.
pub const LUMP_NAMES: [&str; 3] = ["hydraulic_stiffness", "flow_gain", "flow_pressure_coefficient"];

const LUMP_COLUMNS: [QuantityName; 3] = [
    QuantityName::moving("hydraulic_stiffness", &STIFFNESS),
    QuantityName::Fixed("flow_gain_m3_per_s_v"),
    QuantityName::Fixed("flow_pressure_coefficient_m3_per_s_pa"),
];

/// Metrics that compare the force with the reference.
const OF_A_REFERENCE: [Metric; 6] = [
    Metric::Overshoot,
    Metric::RiseTime,
    Metric::SettlingTime,
    Metric::DisturbancePeak,
    Metric::SteadyStateError,
    Metric::TrackingErrorPeak,
];

/// Hexadecimal digits of the sum that ends a row.
const CHECK_LENGTH: usize = 8;

/// Reason why a line is not a row of this campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoRow {
    /// The row belongs to another campaign, or to none.
    Other,
    /// The line ends in CR LF.
    LineEnd,
    /// The checksum is wrong.
    Changed,
}

/// One run of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Index of the run: with the seed it determines every drawn number.
    pub run: u64,
    /// Drawn values, SI, in the order of the campaign.
    pub values: Vec<f64>,
    /// [`LUMP_NAMES`] of the drawn machine, SI, if it has a linear model.
    pub lumps: Option<[f64; 3]>,
    /// Outcome of the run.
    pub outcome: RowOutcome,
}

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum RowOutcome {
    /// The drawn machine is invalid, or it cannot start in this state.
    Refused(String),
    /// The machine was simulated.
    Driven(Ran),
}

/// The results of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Ran {
    /// Status of the run.
    pub status: RunStatus,
    /// Time of an early end or of a divergence, s.
    pub end_time_s: Option<f64>,
    /// Accepted steps of the reported pass.
    pub steps: u64,
    /// Events of the run, each kind once: `cavitation_a`, `command_limit` and so on.
    pub occurrences: Vec<&'static str>,
    /// The metrics of each window; absent if there is no such number.
    pub metrics: Vec<PerMetric<Option<f64>>>,
    /// Force at the times of the bands, N; up to the end of the run.
    pub force_n: Vec<f32>,
}

impl Row {
    /// Status of the run.
    pub fn status(&self) -> RunStatus {
        match &self.outcome {
            RowOutcome::Refused(_) => RunStatus::Refused,
            RowOutcome::Driven(ran) => ran.status,
        }
    }

    /// Results of the run, if it was simulated.
    pub fn ran(&self) -> Option<&Ran> {
        match &self.outcome {
            RowOutcome::Refused(_) => None,
            RowOutcome::Driven(ran) => Some(ran),
        }
    }
}

/// The metrics of a window; absent if the window does not exist.
pub(super) fn numbers(metrics: &Metrics) -> PerMetric<Option<f64>> {
    PerMetric::of(|metric| metrics.get(metric).ok())
}

/// The metrics that a window can have, in the order of a row; an open loop has no reference.
pub fn meaningful(window: &Window, open_loop: bool) -> impl Iterator<Item = Metric> + use<> {
    let left_out: &[Metric] = match window.cause {
        Cause::ReferenceStep { .. } => {
            &[Metric::DisturbancePeak, Metric::TrackingErrorPeak, Metric::ForcePeak]
        }
        Cause::ReferenceMotion { .. } => &[
            Metric::Overshoot,
            Metric::RiseTime,
            Metric::SettlingTime,
            Metric::DisturbancePeak,
            Metric::ForcePeak,
        ],
        Cause::CommandStep { .. } | Cause::CommandMotion { .. } => &OF_A_REFERENCE,
        Cause::LoadMotion | Cause::ExternalForce { .. } | Cause::SettingChange if open_loop => {
            &OF_A_REFERENCE
        }
        Cause::LoadMotion | Cause::ExternalForce { .. } | Cause::SettingChange => {
            &[Metric::Overshoot, Metric::RiseTime, Metric::TrackingErrorPeak, Metric::ForcePeak]
        }
    };
    ROW_METRICS.into_iter().filter(move |metric| !left_out.contains(metric))
}

/// The columns of a campaign's table.
#[derive(Clone, Debug)]
pub(super) struct CampaignColumns {
    /// The mark that distinguishes these rows from those of any other campaign.
    pub(super) mark: String,
    pub(super) paths: Vec<String>,
    pub(super) windows: Vec<Window>,
    /// True if a stated command drives the valve.
    pub(super) open_loop: bool,
    /// Times of the bands, s.
    pub(super) times_s: Vec<f64>,
    /// Units that name the columns: forces and positions, or torques and angles.
    pub(super) units: Units,
}

impl CampaignColumns {
    /// The header line above the rows.
    pub(super) fn header(&self) -> String {
        let mut csv = Csv::default();
        csv.cells(&[&"run,campaign,status,reason,end_time_s,steps,occurrences"]);
        let motion = self.units.motion;
        self.paths.iter().for_each(|path| csv.cells(&[path]));
        LUMP_COLUMNS.iter().for_each(|lump| csv.cells(&[&lump.text(motion)]));
        for (number, window) in self.windows.iter().enumerate() {
            for metric in meaningful(window, self.open_loop) {
                csv.cells(&[&format!("event{}_{}", number + 1, metric.quantity().text(motion))]);
            }
        }
        for time_s in &self.times_s {
            csv.cells(&[&format!("{}_at_{time_s}_s", Signal::Force.quantity().text(motion))]);
        }
        csv.row(&[&"check"]);
        csv.text().to_string()
    }

    /// Beginning of the line of a run.
    pub(super) fn beginning(&self, run: u64) -> String {
        format!("{run},{},", self.mark)
    }

    /// A row as a line.
    pub(super) fn line(&self, row: &Row) -> String {
        let text = self.text(row);
        format!("{text},{}\n", check(&text))
    }

    /// Checksum at the end of the line of a row.
    pub(super) fn check(&self, row: &Row) -> String {
        check(&self.text(row))
    }

    /// Text of a row without its checksum.
    fn text(&self, row: &Row) -> String {
        let mut csv = Csv::default();
        csv.cells(&[&row.run, &self.mark, &row.status().key()]);
        let ran = row.ran();
        csv.cells(&[&match &row.outcome {
            RowOutcome::Refused(reason) => quoted(&reason.replace(['\n', '\r'], " ")),
            RowOutcome::Driven(_) => String::new(),
        }]);
        cell(&mut csv, ran.and_then(|ran| ran.end_time_s));
        csv.cells(&[&ran.map_or(String::new(), |ran| ran.steps.to_string())]);
        csv.cells(&[&ran.map_or(String::new(), |ran| ran.occurrences.join(";"))]);
        row.values.iter().for_each(|value| cell(&mut csv, Some(*value)));
        for lump in 0..LUMP_NAMES.len() {
            cell(&mut csv, row.lumps.map(|lumps| lumps[lump]));
        }
        for (number, window) in self.windows.iter().enumerate() {
            let metrics = ran.and_then(|ran| ran.metrics.get(number));
            for metric in meaningful(window, self.open_loop) {
                cell(&mut csv, metrics.and_then(|metrics| metrics[metric]));
            }
        }
        for index in 0..self.times_s.len() {
            let force = ran.and_then(|ran| ran.force_n.get(index));
            csv.cells(&[&force.map_or(String::new(), f32::to_string)]);
        }
        csv.text().to_string()
    }

    /// The row that a line contains.
    ///
    /// # Errors
    /// [`NoRow`] for a line that contains no row of this campaign.
    pub(super) fn row(&self, line: &str) -> Result<Row, NoRow> {
        let (text, sum) = line.rsplit_once(',').ok_or(NoRow::Other)?;
        if text.split(',').nth(1) != Some(self.mark.as_str()) {
            return Err(NoRow::Other);
        }
        if sum.ends_with('\r') {
            return Err(NoRow::LineEnd);
        }
        if sum != check(text) {
            return Err(NoRow::Changed);
        }
        self.read(text).ok_or(NoRow::Other)
    }

    fn read(&self, text: &str) -> Option<Row> {
        let cells = cells(text);
        let mut cells = cells.iter().map(String::as_str);
        let run = cells.next()?.parse().ok()?;
        let _mark = cells.next()?;
        let status = RunStatus::of_row(cells.next()?)?;
        let reason = cells.next()?.to_string();
        let end_time_s = number(cells.next()?)?;
        let steps = cells.next()?;
        let happened = cells.next()?;
        let values = self.paths.iter().map(|_| number(cells.next()?)?).collect::<Option<Vec<f64>>>()?;
        let lumps = [number(cells.next()?)?, number(cells.next()?)?, number(cells.next()?)?];
        let lumps = match lumps {
            [Some(one), Some(other), Some(third)] => Some([one, other, third]),
            _ => None,
        };
        let mut metrics = vec![PerMetric::default(); self.windows.len()];
        for (window, numbers) in self.windows.iter().zip(&mut metrics) {
            for metric in meaningful(window, self.open_loop) {
                numbers[metric] = number(cells.next()?)?;
            }
        }
        let forces = self.times_s.iter().map(|_| cells.next()).collect::<Option<Vec<&str>>>()?;
        if cells.next().is_some() {
            return None;
        }
        if status == RunStatus::Refused {
            return Some(Row { run, values, lumps, outcome: RowOutcome::Refused(reason) });
        }
        let more = [&COMMAND_LIMIT, &ERRORS_AMPLIFIED, &REPEATED];
        let known = || INDICATORS.iter().chain(&LINE_OCCURRENCES).chain(more);
        let kinds = happened.split(';').filter(|kind| !kind.is_empty());
        let occurrences = kinds.map(|kind| known().find(|known| **known == kind).copied());
        let went = forces.iter().take_while(|force| !force.is_empty());
        let outcome = RowOutcome::Driven(Ran {
            status,
            end_time_s,
            steps: steps.parse().ok()?,
            occurrences: occurrences.collect::<Option<Vec<_>>>()?,
            metrics,
            force_n: went.map(|force| force.parse().ok()).collect::<Option<Vec<f32>>>()?,
        });
        Some(Row { run, values, lumps, outcome })
    }
}

/// The checksum of a row: the first digits of SHA-256 of its text.
fn check(text: &str) -> String {
    let sum: String = Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect();
    sum.chars().take(CHECK_LENGTH).collect()
}

/// Number in a cell: an empty cell means no number; any other must be a number.
fn number(cell: &str) -> Option<Option<f64>> {
    if cell.is_empty() { Some(None) } else { cell.parse().ok().map(Some) }
}

/// The next cell; empty if there is no number.
fn cell(csv: &mut Csv, value: Option<f64>) {
    let text = csv.cell();
    if let Some(value) = value {
        shortest_number::number(text, value);
    }
}

/// Cells of a line, split at the commas outside quotes; a doubled quote inside is one quote.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut inside = false;
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if inside && letters.next_if_eq(&'"').is_some() => push(&mut cells, '"'),
            '"' => inside = !inside,
            ',' if !inside => cells.push(String::new()),
            letter => push(&mut cells, letter),
        }
    }
    cells
}

fn push(cells: &mut [String], letter: char) {
    if let Some(last) = cells.last_mut() {
        last.push(letter);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> CampaignColumns {
        let step = Cause::ReferenceStep { from_n: 0.0, to_n: 4e3 };
        CampaignColumns {
            mark: "abc".to_string(),
            paths: vec!["supply.pressure".to_string(), "start.position".to_string()],
            windows: vec![
                Window { cause: step, start_s: 1.0, end_s: 2.0 },
                Window { cause: Cause::LoadMotion, start_s: 2.0, end_s: 3.0 },
            ],
            open_loop: false,
            times_s: vec![0.0, 1.5, 3.0],
            units: Units::default(),
        }
    }

    #[test]
    fn a_row_has_every_metric_once() {
        assert_eq!(ROW_METRICS.len(), Metric::ALL.len());
        assert!(Metric::ALL.iter().all(|metric| ROW_METRICS.contains(metric)));
    }

    /// Values of a row as metrics, in the order of a row.
    fn in_order(values: [Option<f64>; 9]) -> PerMetric<Option<f64>> {
        let value = |metric| values[ROW_METRICS.iter().position(|one| *one == metric).unwrap()];
        PerMetric::of(value)
    }

    fn driven() -> Row {
        let ran = Ran {
            status: RunStatus::TooManySteps,
            end_time_s: Some(2.5),
            steps: 17,
            occurrences: vec![INDICATORS[0], COMMAND_LIMIT],
            metrics: [
                [Some(1.0 / 3.0), Some(0.15), None, None, Some(-2e-7), Some(3.0), Some(0.0), None, None],
                [None, None, Some(0.25), Some(2015.0), None, Some(-0.0), Some(6e22), None, None],
            ]
            .map(in_order)
            .to_vec(),
            force_n: vec![0.1, -4e-9],
        };
        let lumps = Some([2.2e6, 5.6e-5, 6.4e-13]);
        Row { run: 12, values: vec![7e6, 0.25], lumps, outcome: RowOutcome::Driven(ran) }
    }

    #[test]
    fn lines_read_back_as_the_rows_they_are_of() {
        let columns = columns();
        let reason = "a \"bad\" one, twice".to_string();
        let outcome = RowOutcome::Refused(reason);
        let refused = Row { run: 13, values: vec![-7e6, 0.1], lumps: None, outcome };
        for row in [driven(), refused] {
            let line = columns.line(&row);
            assert_eq!(line.matches('\n').count(), 1);
            assert_eq!(columns.row(line.trim_end()), Ok(row));
        }
    }

    #[test]
    fn a_line_has_a_cell_for_each_name() {
        let columns = columns();
        let count = columns.header().split(',').count();
        assert_eq!(cells(&columns.line(&driven())).len(), count);
    }

    #[test]
    fn lines_of_other_campaigns_and_torn_ones_hold_no_row() {
        let (columns, line) = (columns(), columns().line(&driven()));
        let other = CampaignColumns { mark: "other".to_string(), ..columns.clone() };
        assert_eq!(other.row(line.trim_end()), Err(NoRow::Other));
        let torn = line.rsplit_once(',').unwrap().0;
        assert_eq!(columns.row(torn), Err(NoRow::Changed));
        assert_eq!(columns.row(""), Err(NoRow::Other));
    }

    /// A change of any letter of a row is detected.
    #[test]
    fn a_changed_line_holds_no_row() {
        let (columns, line) = (columns(), columns().line(&driven()));
        let line = line.trim_end();
        for at in 0..line.len() {
            let letter = if line[at..].starts_with('7') { "8" } else { "7" };
            let changed = format!("{}{letter}{}", &line[..at], &line[at + 1..]);
            assert!(columns.row(&changed).is_err(), "{changed}");
        }
        assert_eq!(columns.row(&format!("{line}\r")), Err(NoRow::LineEnd));
    }

    #[test]
    fn the_sum_of_a_row_is_that_of_other_programs() {
        // ORIGIN: paper, FIPS 180-4 (2015), the published sum of "abc"
        assert_eq!(check("abc"), "ba7816bf");
    }
}
