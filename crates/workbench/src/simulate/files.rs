//! The files of `simulate`: a table for each scenario.

use std::fmt::Write as _;

use phea_hydraulics::machine::SIGNALS;

use super::ScenarioRun;
use crate::answer::OutputFile;

/// The machine's signals that come first, in this order; the others follow as the machine lists them.
const FIRST: [&str; 5] = ["spool_v", "pressure_a_pa", "pressure_b_pa", "position_m", "velocity_m_per_s"];

/// One table for each scenario, named after it.
pub(crate) fn files(runs: &[ScenarioRun]) -> Vec<OutputFile> {
    let mut names: Vec<String> = Vec::new();
    let mut files = Vec::new();
    for run in runs {
        let plain = file_name(&run.name);
        let numbered = (2..).map(|number| format!("{plain} {number}"));
        let taken = |name: &String| names.iter().any(|known| known.eq_ignore_ascii_case(name));
        let name =
            std::iter::once(plain.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(plain.clone());
        files.push(OutputFile { name: format!("{name}.csv"), bytes: table(run).into_bytes() });
        names.push(name);
    }
    files
}

/// What file systems do not take in a name becomes an underscore.
fn file_name(name: &str) -> String {
    let plain =
        |letter: char| if letter.is_control() || "/\\:*?\"<>|".contains(letter) { '_' } else { letter };
    let name: String = name.chars().map(plain).collect();
    match name.trim_matches([' ', '.']) {
        "" => "scenario".to_string(),
        name => name.to_string(),
    }
}

/// Rows at the output step, columns named with their units.
fn table(run: &ScenarioRun) -> String {
    let place = |name: &&str| SIGNALS.iter().position(|signal| signal == name);
    let first: Vec<usize> = FIRST.iter().filter_map(place).collect();
    let force = place(&"force_n");
    let rest = (0..SIGNALS.len()).filter(|index| Some(*index) != force && !first.contains(index));
    let order: Vec<usize> = first.iter().copied().chain(rest).collect();
    let mut text = "time_s,reference_n,force_n,control_v".to_string();
    for name in order.iter().filter_map(|index| SIGNALS.get(*index)) {
        text.push(',');
        text.push_str(name);
    }
    text.push_str(",filtered_reference_n\n");
    let record = &run.record;
    let columns = [&record.times_s, &record.reference_n, &record.control_v, &record.filtered_reference_n];
    for (row, signals) in record.signals.iter().enumerate().step_by(run.looks_per_row) {
        let [Some(time), Some(reference), Some(control), Some(filtered)] =
            columns.map(|column| column.get(row).copied())
        else {
            break;
        };
        let force = force.and_then(|index| signals.get(index)).copied().unwrap_or(f64::NAN);
        let _ = write!(text, "{},{},{},{}", number(time), number(reference), number(force), number(control));
        for value in order.iter().filter_map(|index| signals.get(*index)) {
            let _ = write!(text, ",{}", number(*value));
        }
        let _ = writeln!(text, ",{}", number(filtered));
    }
    text
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e15).contains(&size) { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_names_everywhere() {
        let name = |text: &str| file_name(text);
        assert_eq!(name("step and load motion"), "step and load motion");
        assert_eq!(
            (name("a/b\\c:d"), name(" .. "), name("1 ms.")),
            ("a_b_c_d".into(), "scenario".into(), "1 ms".into())
        );
    }

    #[test]
    fn numbers_read_back() {
        for value in [0.0, 0.001, 1.0 / 3.0, -4000.0, 6.02e23, -1.6e-19, 5e-324] {
            assert_eq!(number(value).parse(), Ok(value));
        }
        assert_eq!((number(3.1), number(2e-7)), ("3.1".to_string(), "2e-7".to_string()));
    }
}
