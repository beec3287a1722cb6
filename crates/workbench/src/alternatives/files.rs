//! The files of `alternatives`: the table, each designed project, and the forces laid over each
//! other.

use phea_engineering::alternatives::{
    AlternativeColumns, Alternatives, ColumnKey, ColumnPart, JudgedAlternative,
};
use phea_engineering::linearize::frequency_grid;
use phea_engineering::simulate::{ScenarioRun, file_names};

use super::document::{at, parts, port, stable};
use super::front;
use super::summary::{groups, machine, motion_of};
use crate::answer::{Csv, OutputFile, picture_files, quoted};
use crate::document::capital;
use crate::figure::{Figure, FrequencySeries, ImpedanceDiagram, Words};
use crate::project::{IdentifiedUse, Project, print};
use crate::simulate::laid_over;
use crate::specification::subject_words;

/// Returns all files.
pub(crate) fn files(found: &Alternatives) -> Vec<OutputFile> {
    let mut files = vec![table("alternatives.csv", &[("", &found.judged)])];
    if !found.cases.is_empty() {
        files.push(table("load_cases.csv", &groups(found)));
    }
    let all = groups(found).into_iter().enumerate().flat_map(|(place, (case, judged))| {
        judged.iter().map(move |one| match place {
            0 => (one.name.clone(), one),
            _ => (format!("{}, {case}", one.name), one),
        })
    });
    let all: Vec<(String, &JudgedAlternative)> = all.collect();
    let names = file_names(all.iter().map(|(name, _)| name.as_str()));
    for ((_, one), name) in all.iter().zip(names) {
        if let Ok(deployed) = &one.deployed {
            let mut project = Project { alternatives: vec![], load_cases: vec![], ..deployed.clone() };
            // the numbers from the recordings are in the project: the recordings need not be in its
            // folder
            if let Some(identify) = &mut project.identify {
                identify.takes = IdentifiedUse::Nothing;
            }
            files.push(OutputFile::new(format!("{name}.toml"), print(&project)));
        }
    }
    files.extend(found.front.as_ref().map(front::csv));
    files.extend(picture_files(&figures(found)));
    files
}

/// The forces laid over each other, and the front.
pub(crate) fn figures(found: &Alternatives) -> Vec<Figure> {
    let cases = file_names(found.cases.iter().map(|case| case.name.as_str()));
    let of_cases = found.cases.iter().zip(cases).flat_map(|(case, name)| {
        forces(&format!("alternatives-{name}"), &format!(", {}", case.name), &case.judged)
    });
    let forces = forces("alternatives", "", &found.judged).into_iter().chain(of_cases);
    let front = found.front.as_ref().and_then(front::figure);
    forces.chain(impedances(found)).chain(front).collect()
}

/// The forces of the first scenario: the whole, and each of its events enlarged.
fn forces(file: &str, case: &str, judged: &[JudgedAlternative]) -> Vec<Figure> {
    let driven = |one: &JudgedAlternative| Some((one.name.clone(), one.runs.as_ref().ok()?.first()?.clone()));
    let (names, runs): (Vec<String>, Vec<ScenarioRun>) = judged.iter().filter_map(driven).unzip();
    let Some(first) = runs.first() else { return vec![] };
    let caption = format!(
        "{}, command and load pressure of each alternative under the controller designed for it.",
        capital(first.record.units.motion.words().force)
    );
    let title = format!("{}{case}", first.name);
    laid_over((file, &title, &caption), &names, &runs.iter().collect::<Vec<_>>())
}

/// The impedance at the load of each alternative, under its controller if that is continuous.
fn impedances(found: &Alternatives) -> Option<Figure> {
    let series = found.judged.iter().filter_map(|one| {
        let models = one.linearization.as_ref().ok()?;
        let (port, words) = match models.closed_loop.as_ref().filter(|_| one.deployed.is_ok()) {
            Some(closed) => (closed, one.name.clone()),
            None => (&models.open_loop, format!("{}, open loop", one.name)),
        };
        let grid = frequency_grid(&port.impedance).ok()?;
        Some(FrequencySeries::new(words, &grid, |frequency| port.impedance.at_frequency(frequency)))
    });
    let chart = ImpedanceDiagram {
        motion: motion_of(found),
        series: series.collect(),
        ..ImpedanceDiagram::default()
    };
    let words = Words::new(
        "alternatives-impedance",
        "The impedance at the load",
        format!(
            "Z = {} of the nominal rig of each alternative under the controller designed for it: how hard it resists a load that moves.",
            motion_of(found).symbols().impedance
        ),
    );
    (!chart.series.is_empty()).then(|| chart.draw(&words))
}

/// A row for each alternative, in SI, after the name of its load case if there are several; a value
/// that does not exist is empty.
fn table(file: &str, groups: &[(&str, &[JudgedAlternative])]) -> OutputFile {
    let all: Vec<AlternativeColumns> =
        groups.iter().flat_map(|(_, judged)| judged.iter().map(JudgedAlternative::columns)).collect();
    // alternatives of a project have one kind of motion: none replaces its cylinder by a motor
    let mut judged = groups.iter().flat_map(|(_, judged)| judged.iter());
    let motion = judged.next().map(|one| one.loaded.project.motion()).unwrap_or_default();
    let mut named: Vec<(ColumnPart, ColumnKey)> = Vec::new();
    for part in parts(&all) {
        for (own, column) in all.iter().flat_map(|columns| &columns.0) {
            let heading = (part.clone(), column.key);
            if *own == part && !named.contains(&heading) {
                named.push(heading);
            }
        }
    }
    let headings: Vec<String> =
        named.iter().map(|(part, key)| heading(part, &key.quantity().text(motion))).collect();
    let case = if groups.len() > 1 { "load_case," } else { "" };
    let words = "stable_with_its_load,machine,passive_open_loop,passive_closed_loop";
    let mut csv = Csv::new(&format!("{case}name,feasible,{},{words}", headings.join(",")));
    let rows = groups.iter().flat_map(|(case, judged)| judged.iter().map(move |one| (*case, one)));
    for ((case, one), columns) in rows.zip(&all) {
        let feasible = one.feasible().map_or(String::new(), |feasible| feasible.to_string());
        let value = |(part, key): &(ColumnPart, ColumnKey)| {
            let value = at(columns, part, *key).and_then(|column| column.value.clone().ok());
            value.map_or(String::new(), |value| value.to_string())
        };
        if groups.len() > 1 {
            csv.cells(&[&quoted(case)]);
        }
        csv.cells(&[&quoted(&one.name), &feasible]);
        named.iter().for_each(|column| csv.cells(&[&value(column)]));
        let [stable, machine, open, closed] =
            [stable(one), machine(one), port(one, false), port(one, true)].map(|cell| quoted(&cell.text()));
        csv.row(&[&stable, &machine, &open, &closed]);
    }
    OutputFile::new(file, csv.text())
}

fn heading(part: &ColumnPart, key: &str) -> String {
    match part {
        ColumnPart::Loop | ColumnPart::Rig => key.to_string(),
        ColumnPart::Impedance(frequency) => quoted(&format!("{frequency} rad/s: {key}")),
        ColumnPart::Specification(index, name) => {
            quoted(&format!("{} {}: {key}", index + 1, subject_words(*name)))
        }
        ColumnPart::Scenario(name) => quoted(&format!("{name}: {key}")),
    }
}
