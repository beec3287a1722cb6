//! Recorded tests from tables of loggers and spreadsheets.
//!
//! ```text
//! table -> columns by name -> rows that are used -> plausible numbers -> test
//! ```
//!
//! A column is recognised by its name, with its unit (`supply_pressure_bar`, `p_S [bar]`), or by
//! the declaration of the project. Harmless faults are corrected and reported; all others reject
//! the file.

mod assembled;
mod error;
mod plausible;
mod polarity;
mod rated;
mod rows;
mod turns;

use phea_dynamics::order::ends;
use phea_hydraulics::servovalve::PortCircuit;

use self::error::{RecordedTestError, RecordedTestHint};
use super::Known;
use super::contents::{ColumnContents, FileContents, RecordedFiles};
use super::recording::Recording;
use crate::project::{Findings, RawFinding, RecordedTest, Refusal, StaticTest, TestSignal};
use crate::source::Source;
use crate::table::{Column, Measurand, MeasuredTable, Sought, TIME_NAMES};

/// Fewest rows of a test.
const FEWEST_ROWS: usize = 20;

/// Signals that the columns of a test may contain, in the order of [`TestSignal::ALL`].
static MEASURANDS: [Measurand; 9] = [
    measurand(TestSignal::Time, TIME_NAMES),
    measurand(TestSignal::Command, &[]),
    measurand(TestSignal::SupplyPressure, &["p_S"]),
    measurand(TestSignal::TankPressure, &["p_T"]),
    measurand(TestSignal::PressureA, &["p_A"]),
    measurand(TestSignal::PressureB, &["p_B"]),
    measurand(TestSignal::LeakFlow, &[]),
    measurand(TestSignal::Flow, &[]),
    measurand(TestSignal::OilTemperature, &[]),
];

const fn measurand(signal: TestSignal, symbols: &'static [&'static str]) -> Measurand {
    Measurand {
        name: signal.name(),
        symbols,
        dimension: signal.dimension(),
        may_be_fraction: matches!(signal, TestSignal::Command),
    }
}

/// Columns that are used.
struct Chosen {
    columns: Vec<(TestSignal, Column)>,
    /// Headings of the other columns.
    unused: Vec<String>,
}

/// Used columns, over the used rows.
struct Taken {
    columns: Vec<(TestSignal, Vec<f64>)>,
}

impl Taken {
    fn of(&self, signal: TestSignal) -> Option<&[f64]> {
        self.columns.iter().find(|(one, _)| *one == signal).map(|(_, values)| values.as_slice())
    }

    fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, values)| values.len())
    }
}

/// Tests of these files, in their order, with the contents of the files and the corrected faults.
///
/// # Errors
/// All errors in the files, with their places.
pub fn recordings(
    source: &dyn Source,
    files: &[RecordedTest],
    known: &Known,
) -> Result<RecordedFiles, Box<Refusal>> {
    let mut findings = Findings::default();
    let mut recorded = RecordedFiles::default();
    for declared in files {
        let bytes = findings.bytes_of(source, &declared.file);
        let read = bytes.and_then(|bytes| recording(declared, bytes, known, &mut findings));
        if let Some((recording, contents)) = read {
            recorded.recordings.push(recording);
            recorded.contents.push(contents);
        }
    }
    if findings.error_count() > 0 {
        return findings.or_refused(recorded);
    }
    recorded.warnings = findings.report().diagnostics;
    Ok(recorded)
}

/// Signals with the project's declarations of their columns, in the order of [`TestSignal::ALL`].
fn sought(declared: &RecordedTest) -> Vec<Sought<'_>> {
    let all = TestSignal::ALL.iter().zip(&MEASURANDS);
    let of = |(signal, measurand): (&TestSignal, &'static Measurand)| {
        let column = declared.column(*signal);
        Sought {
            measurand,
            heading: column.and_then(|column| column.column.as_deref()),
            unit: column.and_then(|column| column.unit.as_deref()),
            is_reversed: column.is_some_and(|column| column.reversed),
        }
    };
    all.map(of).collect()
}

/// Test of one file.
fn recording(
    declared: &RecordedTest,
    bytes: Vec<u8>,
    known: &Known,
    findings: &mut Findings,
) -> Option<(Recording, FileContents)> {
    let separator = declared.separator.as_ref().and_then(|text| text.chars().next());
    let sought = sought(declared);
    let table = MeasuredTable::read(&declared.file, bytes, &sought, separator, findings)?;
    let Chosen { columns, unused } = columns(declared, &table, &sought, known, findings)?;
    let circuit = circuit(declared, &columns);
    let before = findings.error_count();
    let wanted: Vec<&Column> = columns.iter().map(|(_, column)| column).collect();
    let mut numbers = table.numbers(&wanted, findings);
    let fractions = columns.iter().zip(&mut numbers.columns).filter(|((_, column), _)| column.is_fraction);
    fractions.for_each(|(_, values)| values.iter_mut().for_each(|value| *value *= known.nominal_voltage));
    if findings.error_count() > before {
        return None;
    }
    let plausible_v = plausible::greatest(TestSignal::Command, known.nominal_voltage);
    let is_used =
        rows::used(&table, &columns, (&numbers, plausible_v), |signal| is_input(signal, circuit), findings);
    let left_out = is_used.iter().filter(|used| !**used).count() + usize::from(numbers.cut_off.is_some());
    let gaps: Vec<usize> = numbers.gaps.iter().map(Vec::len).collect();
    let used: Vec<usize> =
        is_used.iter().enumerate().filter(|(_, used)| **used).map(|(row, _)| row).collect();
    let taken = rows::kept(&columns, numbers, &is_used);
    if findings.error_count() == before {
        plausible::check(&table, &columns, &taken, (&used, known), findings);
        is_above_tank(&table, &columns, &taken, &used, known, findings);
    }
    if findings.error_count() == before {
        polarity::check(&table, &columns, &taken, circuit, findings);
        rated::check(&table, &columns, &taken, (circuit, known), findings);
    }
    let whole = table.header_place();
    if taken.rows() < FEWEST_ROWS && findings.error_count() == before {
        let found = RawFinding::error(whole, RecordedTestError::TooFewRows(taken.rows()).to_string());
        findings.push(found.expected(RecordedTestHint::AtLeastRows(FEWEST_ROWS).to_string()));
    }
    if findings.error_count() > before {
        return None;
    }
    let described = columns.iter().zip(gaps).map(|((signal, column), gaps)| ColumnContents {
        heading: table.heading(column).to_string(),
        signal: *signal,
        unit: column.unit.clone(),
        is_reversed: column.is_reversed,
        range: ends(taken.of(*signal).unwrap_or_default().iter().copied()),
        gaps,
    });
    let contents = FileContents {
        file: declared.file.clone(),
        test: declared.test,
        rows: taken.rows(),
        rows_left_out: left_out,
        columns: described.collect(),
        unused,
    };
    let is_test = assembled::is_test(&taken, circuit, whole, findings);
    if is_test {
        assembled::warn_of_unknown_drop(&taken, circuit, whole, findings);
    }
    // a long text and the test made of it need not be in memory at once
    table.close(findings);
    is_test.then(|| (assembled::assembled(declared, &taken, circuit, known), contents))
}

/// Columns that are used, and headings of the others.
fn columns(
    declared: &RecordedTest,
    table: &MeasuredTable,
    sought: &[Sought<'_>],
    known: &Known,
    findings: &mut Findings,
) -> Option<Chosen> {
    let before = findings.error_count();
    let (found, unused) = table.columns(sought, findings)?;
    let [has_leakage, has_flow] = declared.test.map_or([true, true], StaticTest::measures_flow);
    let is_of_test = |signal: TestSignal| match signal {
        TestSignal::LeakFlow => has_leakage,
        TestSignal::Flow => has_flow,
        _ => true,
    };
    let mut columns = Vec::new();
    let mut unused: Vec<usize> = unused;
    for ((signal, sought), column) in TestSignal::ALL.into_iter().zip(sought).zip(found) {
        let is_stated = declared.column(signal).is_some();
        let is_needed = matches!(signal, TestSignal::Time | TestSignal::Command)
            || (declared.test == Some(StaticTest::Leakage) && signal == TestSignal::LeakFlow)
            || (declared.test == Some(StaticTest::Metering) && signal == TestSignal::Flow)
            || (known.supply_pressure.is_none() && signal == TestSignal::SupplyPressure);
        match column {
            Some(column) if is_of_test(signal) => columns.push((signal, column)),
            Some(column) => unused.push(column.index),
            None if is_needed || is_stated => findings.push(table.missing(sought)),
            None => {}
        }
    }
    let of = |signal: TestSignal| columns.iter().any(|(one, _)| *one == signal);
    if declared.test.is_none() && of(TestSignal::LeakFlow) && of(TestSignal::Flow) {
        let found = RawFinding::error(table.header_place(), RecordedTestError::TwoTests.to_string());
        findings.push(found.help(RecordedTestHint::TestOfProject.to_string()));
    }
    unused.sort_unstable();
    let names = unused.iter().filter_map(|index| table.headings.get(*index));
    let unused = names.map(|heading| heading.text.clone()).collect();
    (findings.error_count() == before).then_some(Chosen { columns, unused })
}

/// Circuit of the ports: as declared for the test, or from the column of a flow.
fn circuit(declared: &RecordedTest, columns: &[(TestSignal, Column)]) -> PortCircuit {
    let has_flow = columns.iter().any(|(signal, _)| *signal == TestSignal::Flow);
    let by_columns = if has_flow { PortCircuit::Connected } else { PortCircuit::Blocked };
    declared.test.map_or(by_columns, StaticTest::circuit)
}

/// True if the model needs a signal in every row.
fn is_input(signal: TestSignal, circuit: PortCircuit) -> bool {
    match signal {
        TestSignal::LeakFlow | TestSignal::Flow | TestSignal::OilTemperature => false,
        TestSignal::PressureA | TestSignal::PressureB => circuit == PortCircuit::Connected,
        _ => true,
    }
}

/// Reports rows whose supply pressure is not above the tank pressure.
fn is_above_tank(
    table: &MeasuredTable,
    columns: &[(TestSignal, Column)],
    taken: &Taken,
    rows: &[usize],
    known: &Known,
    findings: &mut Findings,
) {
    let [supply, tank] =
        [TestSignal::SupplyPressure, TestSignal::TankPressure].map(|signal| taken.of(signal));
    let is_dry = |row: &usize| {
        let at = |values: Option<&[f64]>| values.and_then(|values| values.get(*row).copied());
        at(supply).or(known.supply_pressure) <= Some(at(tank).unwrap_or(known.tank_pressure))
    };
    let dry: Vec<usize> = (0..taken.rows()).filter(is_dry).collect();
    let named = |signal| columns.iter().find(|(one, _)| *one == signal);
    let column = named(TestSignal::TankPressure).or(named(TestSignal::SupplyPressure));
    let (Some(first), Some((_, column))) = (dry.first(), column) else { return };
    let message = RecordedTestError::TankAboveSupply { count: dry.len(), rows: taken.rows() };
    let row = rows.get(*first).copied().unwrap_or(0);
    let found = table.error(row, column, message.to_string(), findings);
    findings.push(match dry.len() == taken.rows() {
        true => found.help(RecordedTestHint::ExchangedColumns.to_string()),
        false => found,
    });
}
