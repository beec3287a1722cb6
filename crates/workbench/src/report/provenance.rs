//! The chapter on provenance: the origin of each number, the assumptions, and the claims that were
//! not proven.

use super::assumptions::assumptions;
use super::chapter::Chapter;
use crate::document::{Cell, Document, StatusMark, Table};
use crate::identify::write_in_use;
use crate::line_choice;
use crate::project::{Loaded, Origin, Project};

/// The chapter of a report in which a controller was judged or not.
pub(super) fn chapter(loaded: &Loaded, is_judged: bool) -> Chapter {
    let catalogue = loaded.provenance.iter().filter_map(|entry| match &entry.origin {
        Origin::Catalogue { name, source } => {
            Some([Cell::Code(entry.path.clone()), name.as_str().into(), source.as_str().into()])
        }
        _ => None,
    });
    let coded = |words: &[&str]| words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(" ");
    let settings: Vec<&str> = loaded.settings.iter().map(String::as_str).collect();
    let set = if settings.is_empty() { String::new() } else { format!(" Settings: {}.", coded(&settings)) };
    let defaults: Vec<&str> = paths(loaded, |origin| matches!(origin, Origin::Default));
    let mut out = Document::default();
    out.explanation(format!("Project {}, SHA-256 `{}`.{set}", loaded.project.title, loaded.sha256));
    if !loaded.warnings.is_empty() {
        out.heading("Warnings");
        out.marked(loaded.warnings.iter().map(|warning| {
            let help = warning.help.as_ref().map_or(String::new(), |help| format!(" {help}"));
            (Some(StatusMark::Note), format!("{}{help}", warning.message))
        }));
    }
    if let Some(recorded) = &loaded.recorded {
        out.heading("From recordings");
        out.explanation("These values are identified from the recordings that the project names, and take the place of the declared ones in every chapter. The SHA-256 of the project is that of its file followed by the recordings.");
        write_in_use(recorded, &mut out);
    }
    out.section("From the catalogue", Table::new(["value", "entry", "source"]).with(catalogue));
    if !defaults.is_empty() {
        out.heading("Defaults");
        out.explanation(format!("Not stated by the project: {}", coded(&defaults)));
    }
    out.heading("Assumptions");
    out.sentences(line_choice::sentence(loaded).into_iter().chain(assumptions(&loaded.project)));
    out.heading("Not proven here");
    out.explanation(not_proven(&loaded.project, is_judged));
    Chapter::of("provenance", "Provenance and assumptions", out)
}

fn paths(loaded: &Loaded, selects: impl Fn(&Origin) -> bool) -> Vec<&str> {
    loaded.provenance.iter().filter(|entry| selects(&entry.origin)).map(|entry| entry.path.as_str()).collect()
}

/// Statement on the scope that this report does not cover.
fn not_proven(project: &Project, is_judged: bool) -> String {
    match (is_judged && !project.specifications.is_empty(), project.actuator.is_some()) {
        (true, true) => {
            "What is not proven of the linear models was searched for, and a search is not a proof. What the nonlinear simulation does is shown for the steps and scenarios that were driven, and for no others.".to_string()
        }
        (true, false) => "What is not proven was searched for, and a search is not a proof.".to_string(),
        (false, true) => {
            let computed = if project.sizing.is_some() { "linear models and a sizing" } else { "linear models" };
            format!("This report computes nominal {computed}. It does not say that a controller holds for every plant of the declared uncertainty; what the nonlinear simulation does is shown for the scenarios that were driven, and for no others.")
        }
        (false, false) => "No controller was given, and none was judged.".to_string(),
    }
}
