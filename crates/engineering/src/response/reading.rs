use super::TestController;
use super::resampled::{EvenRows, Resampled, even_rows};
use crate::identify_error::IdentifyError;
use crate::project::{Findings, RecordedLoop, RecordedResponse, ResponseSignal};
use crate::quantity::{FORCE, RATIO, TIME, VOLTAGE};
use crate::source::Source;
use crate::table::{Column, Measurand, MeasuredTable, Sought, TIME_NAMES};

/// Two signals of a record, sampled at equal intervals, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledPair {
    /// Path of the file.
    pub file: String,
    /// Names of the columns: input and output.
    pub signals: [&'static str; 2],
    /// Units of the columns.
    pub units: [&'static str; 2],
    /// Time between rows, s.
    pub time_step: f64,
    /// Samples of the input.
    pub input: Vec<f64>,
    /// Samples of the output.
    pub output: Vec<f64>,
    /// Signal that excites a closed loop from outside, if the file contains it.
    pub reference: Option<ReferenceSignal>,
    /// State of the loop during the test, if the project states it.
    pub recorded_loop: Option<RecordedLoop>,
    /// Controller of a closed loop, if the project declares it.
    pub controller: Option<Box<TestController>>,
    /// Operating point of the test, if the project names it.
    pub operating_point: Option<String>,
    /// Resampling of unevenly spaced rows.
    pub resampled: Option<Resampled>,
}

/// A reference, or an excitation that is added to the command, of a closed loop.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceSignal {
    /// Origin of the signal.
    pub source: ReferenceSource,
    /// Samples, SI.
    pub values: Vec<f64>,
}

/// First column of a reference that has values: an open loop may have the column without any.
fn reference_in(
    table: &MeasuredTable,
    columns: &[Option<Column>],
    findings: &mut Findings,
) -> Option<(&'static str, Vec<f64>)> {
    MEASURANDS.iter().zip(columns).skip(REFERENCES).find_map(|((measurand, _), column)| {
        let column = column.as_ref()?;
        let numbers = table.numbers(&[column], findings);
        let gaps = numbers.gaps.first().map_or(0, Vec::len);
        let is_blank = numbers.columns.first().is_none_or(|values| values.len() == gaps);
        (!is_blank)
            .then(|| (measurand.name, table.all_numbers(&[column], findings).pop().unwrap_or_default()))
    })
}

/// Origin of the signal that excites a closed loop from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceSource {
    /// Column of this name.
    Column(&'static str),
    /// Calculation from command and force by the controller of the test.
    Controller,
}

impl ReferenceSignal {
    /// True if the signal is more than a constant set point.
    fn moves(&self) -> bool {
        self.values.iter().any(|value| Some(value) != self.values.first())
    }
}

/// Index of the first reference among the columns.
const REFERENCES: usize = 6;

const MEASURANDS: [(Measurand, &str); 9] = [
    (Measurand::of("time", &TIME).called(TIME_NAMES), "s"),
    (Measurand::of("input", &RATIO), "1"),
    (Measurand::of("command", &VOLTAGE), "V"),
    (Measurand::of("control", &VOLTAGE), "V"),
    (Measurand::of("output", &RATIO), "1"),
    (Measurand::of("force", &FORCE), "N"),
    (Measurand::of("excitation", &VOLTAGE), "V"),
    (Measurand::of("reference", &FORCE), "N"),
    (Measurand::of("set_point", &RATIO), "1"),
];

/// Records of these files, one each.
///
/// # Errors
/// All errors in the files, with their places.
pub fn sampled_pairs(
    source: &dyn Source,
    files: &[RecordedResponse],
) -> Result<Vec<SampledPair>, IdentifyError> {
    let mut findings = Findings::default();
    let mut records = Vec::new();
    for declared in files {
        let bytes = findings.bytes_of(source, &declared.file);
        records.extend(bytes.and_then(|bytes| pair(declared, bytes, &mut findings)));
    }
    findings.or_refused(records).map_err(IdentifyError::Files)
}

fn pair(declared: &RecordedResponse, bytes: Vec<u8>, findings: &mut Findings) -> Option<SampledPair> {
    let file = &declared.file;
    let stated = |name: &str| {
        let named = ResponseSignal::ALL.iter().zip(&declared.columns).find(|(one, _)| one.name() == name);
        named.and_then(|(_, column)| column.as_ref())
    };
    let sought = MEASURANDS.iter().map(|(measurand, _)| Sought {
        measurand,
        heading: stated(measurand.name).and_then(|column| column.column.as_deref()),
        unit: stated(measurand.name).and_then(|column| column.unit.as_deref()),
        is_reversed: stated(measurand.name).is_some_and(|column| column.reversed),
    });
    let sought: Vec<Sought<'_>> = sought.collect();
    let separator = declared.separator.as_ref().and_then(|text| text.chars().next());
    let table = MeasuredTable::read(file, bytes, &sought, separator, findings)?;
    let (columns, _) = table.columns(&sought, findings)?;
    let before = findings.error_count();
    let mut first_of = |range: std::ops::Range<usize>| {
        let found = range.clone().find_map(|index| Some((index, columns.get(index)?.clone()?)));
        if found.is_none() {
            let missing = sought.get(range.start + usize::from(range.len() > 1));
            missing.into_iter().for_each(|sought| findings.push(table.missing(sought)));
        }
        found
    };
    let (time, input, output) = (first_of(0..1), first_of(1..4), first_of(4..6));
    let ((_, time), (input, input_column), (output, output_column)) = (time?, input?, output?);
    let numbers = table.all_numbers(&[&time, &input_column, &output_column], findings);
    if findings.error_count() > before {
        return None;
    }
    let reference = reference_in(&table, &columns, findings);
    if findings.error_count() > before {
        return None;
    }
    let (name, values) = reference.unzip();
    let mut numbers = numbers.into_iter();
    let times = numbers.next()?;
    let EvenRows { step, signals, resampled } =
        even_rows(&table, &time, &times, numbers.chain(values).collect(), findings)?;
    let mut signals = signals.into_iter();
    let of = |index: usize| MEASURANDS.get(index).map_or(("", ""), |(one, unit)| (one.name, *unit));
    let named = [of(input), of(output)];
    table.close(findings);
    Some(SampledPair {
        file: file.clone(),
        signals: named.map(|(name, _)| name),
        units: named.map(|(_, unit)| unit),
        time_step: step,
        input: signals.next()?,
        output: signals.next()?,
        reference: name
            .zip(signals.next())
            .map(|(name, values)| ReferenceSignal { source: ReferenceSource::Column(name), values })
            .filter(ReferenceSignal::moves),
        recorded_loop: declared.recorded_loop,
        controller: None,
        operating_point: declared.operating_point.clone(),
        resampled,
    })
}
