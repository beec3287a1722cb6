//! The chapter on the origin of the family: the part of the replaced ranges that the rig reaches,
//! the reduction of the templates, and the benefit for the controller.

use phea_dynamics::watch::Watch;
use phea_engineering::audit::{ProjectAudit, audit_project};
use phea_engineering::family::visited_box;
use phea_engineering::replaced::{TemplateAreas, boxed, replaced_ranges, template_areas};
use phea_engineering::setup::Setup;

use super::chapter::Chapter;
use super::judged::Judged;
use crate::derived::{replaced_sentences, replaced_table};
use crate::document::{Cell, Document, Table};
use crate::error::CommandError;
use crate::project::Project;
use crate::quantity::DisplayUnit;
use crate::source::Source;
use crate::specification::numbered_cell;

/// The chapter; `None` if no range of the project is replaced by its family.
pub(super) fn chapter(
    source: &dyn Source,
    setup: &Setup<'_>,
    judged: &Judged,
    watch: Watch<'_>,
) -> Result<Option<Chapter>, CommandError> {
    let project = setup.project;
    let Some(boxed) = boxed(project) else { return Ok(None) };
    let visited = visited_box(setup)?.unwrap_or_default();
    let ranges = replaced_ranges(project, &visited);
    let mut out = Document::default();
    out.explanation(origin(project));
    out.table(replaced_table(&ranges));
    out.sentences(replaced_sentences(&ranges));
    let own: Vec<_> = judged.bounds.iter().map(|one| &one.template.template).collect();
    let areas = template_areas(source, project, &judged.problem, &own)?;
    out.heading("Templates");
    out.explanation("The area of a template is what the plants fill at one frequency, in degrees times dB: bounds leave the loop the more room, the smaller it is.");
    out.table(
        Table::new(["rad/s", "over the box", "over the family", "share, %"]).with(areas.iter().map(area)),
    );
    if let Some(given) = &judged.given {
        let over_box = audit_project(source, &Setup::new(&boxed)?, watch)?;
        out.heading("What the family gives the given controller");
        out.table(margins(&over_box, given));
    }
    Ok(Some(Chapter::of("family", "Where the family comes from", out)))
}

/// Origin of the family.
fn origin(project: &Project) -> String {
    let region = project.family.as_ref().and_then(|family| family.operating_region.as_ref());
    let mut parts = Vec::new();
    if region.is_some() {
        parts.push("the operating points that the rig visits, with what the pump gives".to_string());
    }
    match project.directions.len() {
        0 => {}
        1 => parts.push("one direction in which identified numbers are uncertain together".to_string()),
        count => parts.push(format!("{count} directions in which identified numbers are uncertain together")),
    }
    format!(
        "K_qU, K_c and {} are not ranges of their own here: they follow from {}, and move together. The project names the independent ranges that this replaces.",
        project.motion().symbols().stiffness,
        parts.join(", and from ")
    )
}

fn area(areas: &TemplateAreas) -> [Cell; 4] {
    let TemplateAreas { frequency_rad_per_s, replaced, visited } = *areas;
    let fraction = match visited / replaced {
        fraction if fraction.is_finite() => Cell::number_in(fraction, 2, DisplayUnit::PERCENT),
        _ => Cell::Missing,
    };
    [Cell::frequency(frequency_rad_per_s), Cell::number(replaced, 3), Cell::number(visited, 3), fraction]
}

/// The worst margins of the given controller over both families.
fn margins(over_box: &ProjectAudit, own: &ProjectAudit) -> Table {
    let rows = own.audit.specifications.iter().zip(&over_box.audit.specifications).enumerate();
    let margin = |found: &phea_qft::verification::SpecificationFinding| match &found.worst {
        Some(worst) => Cell::margin(worst.margin_db),
        None => Cell::Missing,
    };
    let row = |(index, (found, boxed))| [numbered_cell(own.named(index)), margin(boxed), margin(found)];
    Table::new(["specification", "worst margin over the box", "over the family"]).with(rows.map(row))
}
