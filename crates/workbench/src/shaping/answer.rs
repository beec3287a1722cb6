use phea_qft::bound::Placement;
use phea_qft::manual_shaping::DesignMargin;

use super::ProjectShaping;
use super::document::polar;
use crate::answer::{Body, Csv, Object, OutputFile};
use crate::audit::{self, stability_reason, stable};
use crate::caveat;
use crate::specification::kind_key;
use crate::verdict_words::verdict_key;

/// What `shape` says to programs.
pub(crate) fn body(view: &ProjectShaping) -> Object {
    let stability = &view.stability;
    let of_stability = Object::new()
        .with("verdict", verdict_key(stability.verdict))
        .with("plant", view.names.named(&stability.plant))
        .with("reason", stability_reason(stability));
    Object::new()
        .with("shaped", view.shaped.table())
        .with("changes", view.changes)
        .each("elements", view.elements.iter().enumerate(), |(index, element)| {
            Object::new()
                .with("number", index + 1)
                .with("kind", element.kind.name())
                .with("enabled", element.enabled)
                .with("element", element.print())
        })
        .and(stable(stability).into_object())
        .with("stability", of_stability)
        .each("margins", &view.margins, |margin| {
            let DesignMargin { worst, placement } = margin;
            Object::new()
                .with("specification", worst.specification + 1)
                .with("kind", kind(view, worst.specification))
                .and(audit::margin(&view.names, worst).into_object())
                .and(self::placement(placement))
        })
        .each("loop", &view.points, |point| {
            let (decibels, degrees) = polar(point.nominal_loop);
            Object::new()
                .with("frequency_rad_per_s", point.frequency_rad_per_s)
                .with("magnitude_db", decibels)
                .with("phase_deg", degrees)
                .and(placement(&point.placement))
        })
        .with("unreached_rad_per_s", view.unreached_rad_per_s.as_slice())
        .with("warnings", caveat::sentences(&view.problem.caveats, &view.problem.units))
}

fn placement(placement: &Placement) -> Object {
    match placement {
        Placement::Allowed { slack_db } => {
            Object::new().with("allowed", true).with("slack_db", *slack_db).with("gain_change_db", 0.0)
        }
        Placement::Forbidden { nearest_db, .. } => Object::new().with("allowed", false).known(
            "gain_change_db",
            *nearest_db,
            "no gain is allowed at this phase",
        ),
    }
}

fn kind(view: &ProjectShaping, specification: usize) -> &'static str {
    view.problem.specifications.get(specification).map_or("", |one| kind_key(&one.requirement))
}

/// Name of the project with the changed elements in it.
pub const SHAPED_PROJECT: &str = "shaped.toml";

/// The project file with the changed elements; then the margins as a table for other programs.
pub fn files(view: &ProjectShaping) -> Vec<OutputFile> {
    let mut csv = Csv::new("specification,kind,frequency_rad_per_s,margin_db,allowed");
    for margin in &view.margins {
        let DesignMargin { worst, placement } = margin;
        let (number, kind) = (worst.specification + 1, kind(view, worst.specification));
        let allowed = matches!(placement, Placement::Allowed { .. });
        csv.row(&[&number, &kind, &worst.frequency_rad_per_s, &worst.margin_db, &allowed]);
    }
    vec![OutputFile::new(SHAPED_PROJECT, view.saved.clone()), OutputFile::new("margins.csv", csv.text())]
}
