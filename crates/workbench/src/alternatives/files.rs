//! The files of `alternatives`: the table, each designed project, and the forces laid over each
//! other.

use phea_engineering::simulate::file_names;

use super::document::{at, parts};
use super::{AlternativeColumns, Alternatives, ColumnPart, JudgedAlternative};
use crate::answer::{Csv, OutputFile, picture_files, quoted};
use crate::figure::{FigureError, Words};
use crate::project::{IdentifiedUse, Project, print};
use crate::simulate::{ScenarioRun, laid_over};

/// All of them.
///
/// # Errors
/// A figure that the rasteriser rejects.
pub(crate) fn files(found: &Alternatives) -> Result<Vec<OutputFile>, FigureError> {
    let mut files = vec![table(found)];
    let names = file_names(found.judged.iter().map(|one| one.name.as_str()));
    for (one, name) in found.judged.iter().zip(names) {
        if let Ok(deployed) = &one.deployed {
            let mut project = Project { alternatives: vec![], ..deployed.clone() };
            // what the recordings gave stands in it as numbers: they need not lie beside it
            if let Some(identify) = &mut project.identify {
                identify.takes = IdentifiedUse::Nothing;
            }
            files.push(OutputFile::new(format!("{name}.toml"), print(&project)));
        }
    }
    let driven = |one: &JudgedAlternative| Some((one.name.clone(), one.runs.as_ref().ok()?.first()?.clone()));
    let (names, runs): (Vec<String>, Vec<ScenarioRun>) = found.judged.iter().filter_map(driven).unzip();
    if let Some(first) = runs.first() {
        let words = Words::new(
            "alternatives",
            first.name.clone(),
            "Force, command and load pressure of each alternative under the controller designed for it.",
        );
        files.extend(picture_files(&[laid_over(words, &names, &runs.iter().collect::<Vec<_>>())])?);
    }
    Ok(files)
}

/// A row for each alternative, in SI; a value that does not exist is empty.
fn table(found: &Alternatives) -> OutputFile {
    let all: Vec<AlternativeColumns> = found.judged.iter().map(JudgedAlternative::columns).collect();
    let mut named: Vec<(ColumnPart, &str)> = Vec::new();
    for part in parts(&all) {
        for (own, column) in all.iter().flat_map(|columns| &columns.0) {
            let heading = (part.clone(), column.key);
            if *own == part && !named.contains(&heading) {
                named.push(heading);
            }
        }
    }
    let headings: Vec<String> = named.iter().map(|(part, key)| heading(part, key)).collect();
    let mut csv = Csv::new(&format!("name,feasible,{}", headings.join(",")));
    for (one, columns) in found.judged.iter().zip(&all) {
        let feasible = one.feasible().map_or(String::new(), |feasible| feasible.to_string());
        let value = |(part, key): &(ColumnPart, &str)| {
            let value = at(columns, part, key).and_then(|column| column.value.clone().ok());
            value.map_or(String::new(), |value| value.to_string())
        };
        let values = named.iter().map(value).collect::<Vec<_>>().join(",");
        csv.row(&[&quoted(&one.name), &feasible, &values]);
    }
    csv.file("alternatives.csv")
}

fn heading(part: &ColumnPart, key: &str) -> String {
    match part {
        ColumnPart::Loop | ColumnPart::Rig => key.to_string(),
        ColumnPart::Specification(index, name) => quoted(&format!("{} {name}: {key}", index + 1)),
        ColumnPart::Scenario(name) => quoted(&format!("{name}: {key}")),
    }
}
