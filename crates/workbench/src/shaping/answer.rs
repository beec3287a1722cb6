use phea_qft::bound::Placement;
use phea_qft::verification::Verdict;
use serde::Serialize;

use super::ProjectShaping;
use super::text::polar;
use crate::answer::{self, Csv, Number, OutputFile};
use crate::audit::{NamedPlant, kind_key, stability_reason, verdict_key};
use crate::project::Loaded;

#[derive(Serialize)]
struct ShapeAnswer<'a> {
    shaped: &'static str,
    changes: usize,
    elements: Vec<ElementRow>,
    stable: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stable_reason: Option<String>,
    stability: ShapeStabilityAnswer,
    margins: Vec<MarginAnswer>,
    #[serde(rename = "loop")]
    points: Vec<ShapePointAnswer>,
    unreached_rad_per_s: &'a [f64],
    warnings: Vec<&'a str>,
}

#[derive(Serialize)]
struct ElementRow {
    number: usize,
    kind: &'static str,
    enabled: bool,
    element: String,
}

#[derive(Serialize)]
struct ShapeStabilityAnswer {
    verdict: &'static str,
    plant: NamedPlant,
    reason: String,
}

#[derive(Serialize)]
struct MarginAnswer {
    specification: usize,
    kind: &'static str,
    frequency_rad_per_s: f64,
    margin_db: Number,
    plant: NamedPlant,
    #[serde(skip_serializing_if = "Option::is_none")]
    other_plant: Option<NamedPlant>,
    #[serde(flatten)]
    placement: PlacementRow,
}

#[derive(Serialize)]
struct ShapePointAnswer {
    frequency_rad_per_s: f64,
    magnitude_db: Number,
    phase_deg: Number,
    #[serde(flatten)]
    placement: PlacementRow,
}

#[derive(Serialize)]
struct PlacementRow {
    allowed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    slack_db: Option<Number>,
    gain_change_db: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    gain_change_db_reason: Option<&'static str>,
}

fn placement(placement: &Placement) -> PlacementRow {
    match placement {
        Placement::Allowed { slack_db } => PlacementRow {
            allowed: true,
            slack_db: Some(Number(*slack_db)),
            gain_change_db: Number(0.0),
            gain_change_db_reason: None,
        },
        Placement::Forbidden { nearest_db, .. } => PlacementRow {
            allowed: false,
            slack_db: None,
            gain_change_db: Number(nearest_db.unwrap_or(f64::NAN)),
            gain_change_db_reason: nearest_db.is_none().then_some("no gain is allowed at this phase"),
        },
    }
}

fn margin_rows(view: &ProjectShaping) -> Vec<MarginAnswer> {
    let kind = |index: usize| {
        view.problem
            .specifications
            .get(index)
            .map_or("", |specification| kind_key(&specification.requirement))
    };
    let row = |margin: &phea_qft::manual_shaping::DesignMargin| MarginAnswer {
        specification: margin.specification + 1,
        kind: kind(margin.specification),
        frequency_rad_per_s: margin.frequency_rad_per_s,
        margin_db: Number(margin.margin_db),
        plant: view.names.named(&margin.plant),
        other_plant: margin.other.as_ref().map(|other| view.names.named(other)),
        placement: placement(&margin.placement),
    };
    view.margins.iter().map(row).collect()
}

/// The JSON object of `shape`.
pub fn json(loaded: &Loaded, view: &ProjectShaping) -> String {
    let element = |(index, element): (usize, &crate::project::DeclaredElement)| ElementRow {
        number: index + 1,
        kind: element.kind.name(),
        enabled: element.enabled,
        element: element.print(),
    };
    let point = |point: &phea_qft::manual_shaping::DesignPoint| {
        let (decibels, degrees) = polar(point.nominal_loop);
        ShapePointAnswer {
            frequency_rad_per_s: point.frequency_rad_per_s,
            magnitude_db: Number(decibels),
            phase_deg: Number(degrees),
            placement: placement(&point.placement),
        }
    };
    let stability = &view.stability;
    let body = ShapeAnswer {
        shaped: view.shaped.table(),
        changes: view.changes,
        elements: view.elements.iter().enumerate().map(element).collect(),
        stable: match stability.verdict {
            Verdict::Met => Some(true),
            Verdict::Violated => Some(false),
            Verdict::NotProven => None,
        },
        stable_reason: (stability.verdict == Verdict::NotProven).then(|| stability_reason(stability)),
        stability: ShapeStabilityAnswer {
            verdict: verdict_key(stability.verdict),
            plant: view.names.named(&stability.plant),
            reason: stability_reason(stability),
        },
        margins: margin_rows(view),
        points: view.points.iter().map(point).collect(),
        unreached_rad_per_s: &view.unreached_rad_per_s,
        warnings: view.problem.caveats.iter().map(|caveat| caveat.sentence.as_str()).collect(),
    };
    answer::json("shape", loaded, body)
}

/// Name of the project with the changed elements in it.
pub const SHAPED_PROJECT: &str = "shaped.toml";

/// The project file with the changed elements; then the margins as a table for other programs.
pub fn files(view: &ProjectShaping) -> Vec<OutputFile> {
    let mut csv = Csv::new("specification,kind,frequency_rad_per_s,margin_db,allowed");
    for row in margin_rows(view) {
        let (margin_db, allowed) = (row.margin_db.0, row.placement.allowed);
        csv.row(&[&row.specification, &row.kind, &row.frequency_rad_per_s, &margin_db, &allowed]);
    }
    vec![OutputFile::new(SHAPED_PROJECT, view.saved.clone()), csv.file("margins.csv")]
}
