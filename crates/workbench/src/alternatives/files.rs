//! The files of `alternatives`: the table, each designed project, and the forces laid over each
//! other.

use phea_engineering::alternatives::ColumnKey;
use phea_engineering::simulate::file_names;

use super::document::{passivity, status};
use super::front;
use super::printed::{
    DrawnImpedance, PrintedAlternative, PrintedAlternatives, PrintedColumn, PrintedPart, at, parts,
};
use super::summary::groups;
use crate::answer::{Csv, OutputFile, picture_files, quoted};
use crate::document::capital;
use crate::figure::{Figure, ImpedanceDiagram, Words};
use crate::quantity::MotionKind;
use crate::simulate::{OverlaidRun, laid_over};

/// Returns all files.
pub(crate) fn files(found: &PrintedAlternatives) -> Vec<OutputFile> {
    let mut files = vec![table("alternatives.csv", &[("", &found.judged)], found.motion)];
    if !found.cases.is_empty() {
        files.push(table("load_cases.csv", &groups(found), found.motion));
    }
    let all = groups(found).into_iter().enumerate().flat_map(|(place, (case, judged))| {
        judged.iter().map(move |one| match place {
            0 => (one.name.clone(), one),
            _ => (format!("{}, {case}", one.name), one),
        })
    });
    let all: Vec<(String, &PrintedAlternative)> = all.collect();
    let names = file_names(all.iter().map(|(name, _)| name.as_str()));
    for ((_, one), name) in all.iter().zip(names) {
        let project = one.deployed.as_ref();
        files.extend(project.map(|text| OutputFile::new(format!("{name}.toml"), text.clone())));
    }
    files.extend(found.front.as_ref().map(front::csv));
    files.extend(picture_files(&figures(found)));
    files
}

/// The forces laid over each other, and the front.
pub(crate) fn figures(found: &PrintedAlternatives) -> Vec<Figure> {
    let cases = file_names(found.cases.iter().map(|case| case.name.as_str()));
    let of_cases = found.cases.iter().zip(cases).flat_map(|(case, name)| {
        forces((&format!("alternatives-{name}"), &format!(", {}", case.name)), &case.judged, found.motion)
    });
    let forces = forces(("alternatives", ""), &found.judged, found.motion).into_iter().chain(of_cases);
    let front = found.front.as_ref().and_then(front::figure);
    forces.chain(impedances(found)).chain(front).collect()
}

/// The forces of the first scenario: the whole, and each of its events enlarged.
fn forces((file, case): (&str, &str), judged: &[PrintedAlternative], motion: MotionKind) -> Vec<Figure> {
    let driven = judged.iter().filter_map(|one| Some((one.name.clone(), one.run.as_ref()?)));
    let (names, runs): (Vec<String>, Vec<&OverlaidRun>) = driven.unzip();
    let Some(first) = runs.first() else { return vec![] };
    let caption = format!(
        "{}, command and load pressure of each alternative under the controller designed for it.",
        capital(motion.words().force)
    );
    let title = format!("{}{case}", first.name);
    laid_over((file, &title, &caption), &names, &runs)
}

/// The impedance at the load of each alternative, under its controller if that is continuous.
fn impedances(found: &PrintedAlternatives) -> Option<Figure> {
    let series = found.judged.iter().filter_map(|one| one.impedance.as_ref());
    let chart = ImpedanceDiagram {
        motion: found.motion,
        series: series.map(DrawnImpedance::series).collect(),
        ..ImpedanceDiagram::default()
    };
    let words = Words::new(
        "alternatives-impedance",
        "The impedance at the load",
        format!(
            "Z = {} of the nominal rig of each alternative under the controller designed for it: how hard it resists a load that moves.",
            found.motion.symbols().impedance
        ),
    );
    (!chart.series.is_empty()).then(|| chart.draw(&words))
}

/// A row for each alternative, in SI, after the name of its load case if there are several; a value
/// that does not exist is empty.
fn table(file: &str, groups: &[(&str, &[PrintedAlternative])], motion: MotionKind) -> OutputFile {
    let judged = groups.iter().flat_map(|(_, judged)| judged.iter());
    let all: Vec<&[PrintedColumn]> = judged.map(|one| one.columns.as_slice()).collect();
    let mut named: Vec<(PrintedPart, ColumnKey)> = Vec::new();
    for part in parts(&all) {
        for column in all.iter().copied().flatten() {
            let heading = (part.clone(), column.key);
            if column.part == part && !named.contains(&heading) {
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
    for (case, one) in rows {
        let feasible = one.feasible.map_or(String::new(), |feasible| feasible.to_string());
        let value = |(part, key): &(PrintedPart, ColumnKey)| {
            let value = at(&one.columns, part, *key).and_then(|column| column.value.clone().ok());
            value.map_or(String::new(), |value| value.to_string())
        };
        if groups.len() > 1 {
            csv.cells(&[&quoted(case)]);
        }
        csv.cells(&[&quoted(&one.name), &feasible]);
        named.iter().for_each(|column| csv.cells(&[&value(column)]));
        let [stable, machine] = [&one.stable, &one.machine].map(|outcome| status(outcome.as_ref()));
        let [open, closed] = one.passive.map(passivity);
        let [stable, machine, open, closed] =
            [stable, machine, open, closed].map(|cell| quoted(&cell.text()));
        csv.row(&[&stable, &machine, &open, &closed]);
    }
    OutputFile::new(file, csv.text())
}

fn heading(part: &PrintedPart, key: &str) -> String {
    match part {
        PrintedPart::Loop | PrintedPart::Rig => key.to_string(),
        PrintedPart::Impedance(frequency) => quoted(&format!("{frequency} rad/s: {key}")),
        PrintedPart::Specification(index, subject) => quoted(&format!("{} {subject}: {key}", index + 1)),
        PrintedPart::Scenario(name) => quoted(&format!("{name}: {key}")),
    }
}
