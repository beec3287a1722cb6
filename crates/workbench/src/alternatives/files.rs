//! The files of `alternatives`: the table, each designed project, and the forces laid over each
//! other.

use phea_engineering::simulate::file_names;

use super::document::{at, parts};
use super::front;
use super::{AlternativeColumns, Alternatives, ColumnPart, JudgedAlternative};
use crate::answer::{Csv, OutputFile, picture_files, quoted};
use crate::figure::{Figure, FigureError, FrequencySeries, ImpedanceInput, Words, impedance};
use crate::linearize::frequency_grid;
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
    files.extend(found.front.as_ref().map(front::csv));
    files.extend(picture_files(&figures(found))?);
    Ok(files)
}

/// The forces laid over each other, and the front.
pub(crate) fn figures(found: &Alternatives) -> Vec<Figure> {
    let driven = |one: &JudgedAlternative| Some((one.name.clone(), one.runs.as_ref().ok()?.first()?.clone()));
    let (names, runs): (Vec<String>, Vec<ScenarioRun>) = found.judged.iter().filter_map(driven).unzip();
    let laid_over = runs.first().map(|first| {
        let words = Words::new(
            "alternatives",
            first.name.clone(),
            "Force, command and load pressure of each alternative under the controller designed for it.",
        );
        laid_over(words, &names, &runs.iter().collect::<Vec<_>>())
    });
    let front = found.front.as_ref().and_then(front::figure);
    laid_over.into_iter().chain(impedances(found)).chain(front).collect()
}

/// The impedance at the load of each alternative, under its controller where that is continuous.
fn impedances(found: &Alternatives) -> Option<Figure> {
    let series = found.judged.iter().filter_map(|one| {
        let models = one.linearization.as_ref().ok()?;
        let (port, words) = match models.closed_loop.as_ref().filter(|_| one.deployed.is_ok()) {
            Some(closed) => (closed, one.name.clone()),
            None => (&models.open_loop, format!("{}, open loop", one.name)),
        };
        let frequencies_rad_per_s = frequency_grid(&port.impedance).ok()?;
        let response = frequencies_rad_per_s.iter().map(|frequency| port.impedance.at_frequency(*frequency));
        let response = response.collect();
        Some(FrequencySeries { name: words, frequencies_rad_per_s, response })
    });
    let input = ImpedanceInput { series: series.collect(), ..ImpedanceInput::default() };
    let words = Words::new(
        "alternatives-impedance",
        "The impedance at the load",
        "Z = -F_e/(s X_L) of the nominal rig of each alternative under the controller designed for it: how hard it resists a load that moves.",
    );
    (!input.series.is_empty()).then(|| impedance(words, &input))
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
        ColumnPart::Impedance(frequency) => quoted(&format!("{frequency} rad/s: {key}")),
        ColumnPart::Specification(index, name) => quoted(&format!("{} {name}: {key}", index + 1)),
        ColumnPart::Scenario(name) => quoted(&format!("{name}: {key}")),
    }
}
