use crate::identify::IdentifyError;
use crate::project::{Findings, RawFinding};
use crate::quantity::{FORCE, RATIO, TIME, VOLTAGE, display};
use crate::source::Source;
use crate::table::{Column, Measurand, MeasuredTable, Sought};

/// Two signals of a record, sampled at equal intervals. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledPair {
    /// Where it is from.
    pub file: String,
    /// What the columns are called: input and output.
    pub signals: [&'static str; 2],
    /// Their units.
    pub units: [&'static str; 2],
    /// s between rows.
    pub time_step: f64,
    /// The input.
    pub input: Vec<f64>,
    /// The output.
    pub output: Vec<f64>,
}

/// Share of the time between rows by which a row may be early or late.
pub const UNEVEN: f64 = 0.1;

/// Fewest rows that say anything of a frequency.
const FEWEST_ROWS: usize = 32;

const MEASURANDS: [(Measurand, &str); 6] = [
    (Measurand::of("time", &TIME), "s"),
    (Measurand::of("input", &RATIO), "1"),
    (Measurand::of("command", &VOLTAGE), "V"),
    (Measurand::of("control", &VOLTAGE), "V"),
    (Measurand::of("output", &RATIO), "1"),
    (Measurand::of("force", &FORCE), "N"),
];

/// The records of these files, one each.
///
/// # Errors
/// Everything that is wrong in the files, with its places.
pub fn sampled_pairs(source: &dyn Source, files: &[String]) -> Result<Vec<SampledPair>, IdentifyError> {
    let mut findings = Findings::default();
    let mut records = Vec::new();
    for file in files {
        let bytes = findings.bytes_of(source, file);
        records.extend(bytes.and_then(|bytes| pair(file, bytes, &mut findings)));
    }
    findings.or_refused(records).map_err(IdentifyError::Files)
}

fn pair(file: &str, bytes: Vec<u8>, findings: &mut Findings) -> Option<SampledPair> {
    let sought: Vec<Sought<'_>> = MEASURANDS.iter().map(|(one, _)| Sought::by_name(one)).collect();
    let table = MeasuredTable::read(file, bytes, &sought, None, findings)?;
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
    let [times, inputs, outputs] = <[Vec<f64>; 3]>::try_from(numbers).ok()?;
    let time_step = time_step(&table, &time, &times, "a frequency response", findings)?;
    let of = |index: usize| MEASURANDS.get(index).map_or(("", ""), |(one, unit)| (one.name, *unit));
    let named = [of(input), of(output)];
    table.close(findings);
    Some(SampledPair {
        file: file.to_string(),
        signals: named.map(|(name, _)| name),
        units: named.map(|(_, unit)| unit),
        time_step,
        input: inputs,
        output: outputs,
    })
}

/// The time between rows, in s; rows that are early or late by more than [`UNEVEN`] of it are
/// refused: what is calculated takes the samples as evenly spaced. `purpose` says what that is.
pub fn time_step(
    table: &MeasuredTable,
    column: &Column,
    times: &[f64],
    purpose: &str,
    findings: &mut Findings,
) -> Option<f64> {
    let place = table.header_place();
    if times.len() < FEWEST_ROWS {
        let message = format!("{} rows are too few for {purpose}", times.len());
        findings.push(RawFinding::error(place, message).expected(format!("at least {FEWEST_ROWS} rows")));
        return None;
    }
    let (first, last) = times.first().zip(times.last())?;
    let step = (last - first) / (times.len() - 1) as f64;
    let usual = median_step(times);
    let late = |(row, time): (usize, &f64)| {
        let expected = first + row as f64 * step;
        ((time - expected).abs() > UNEVEN * step.abs() || step <= 0.0).then_some(row)
    };
    if times.iter().enumerate().find_map(late).is_none() {
        return Some(step);
    }
    // the row where the usual step is left, rather than the one where the sum of all is
    let jump = times.windows(2).position(|pair| match pair {
        [one, next] => ((next - one) - usual).abs() > UNEVEN * usual.abs() || next <= one,
        _ => false,
    });
    let row = jump.map_or_else(|| times.iter().enumerate().find_map(late).unwrap_or(0), |row| row + 1);
    let since =
        times.get(row).zip(times.get(row.saturating_sub(1))).map_or(0.0, |(one, before)| one - before);
    let message = format!("{} after the row before", display(since, &TIME, 4));
    let found = table.error(row, column, message, findings);
    findings.push(
        found.expected(format!("evenly sampled rows: {} apart, as most are", display(usual, &TIME, 4))).help(
            "interpolating would filter the signals: export the record at the rate it was sampled with",
        ),
    );
    None
}

fn median_step(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> =
        times.windows(2).filter_map(|pair| Some(pair.last()? - pair.first()?)).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return 0.0;
    }
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}
