//! Elements, margins and the loop for people.

use phea_dynamics::portable;
use phea_engineering::shaping::{ProjectShaping, Shaped};
use phea_qft::bound::Placement;
use phea_qft::manual_shaping::DesignMargin;

use crate::audit::stability_sentence;
use crate::caveat;
use crate::document::{Cell, Document, Table, frequency_number};
use crate::plant_names::plant_cell;
use crate::quantity::DisplayUnit;
use crate::specification::name_words;
use phea_qft::verification::Verdict;

/// The tables and sentences of `shape`.
pub(crate) fn document(view: &ProjectShaping) -> Document {
    let what = match view.shaped {
        Shaped::Controller => "Controller",
        Shaped::Prefilter => "Prefilter",
    };
    let count = match view.elements.len() {
        0 => "no elements, which is the gain 1".to_string(),
        1 => "1 element".to_string(),
        count => format!("{count} elements"),
    };
    let mut out = Document::default();
    out.warnings(caveat::sentences(&view.problem.caveats, &view.problem.units));
    out.line(format!("{what}: {count}"));
    let elements = view.elements.iter().enumerate();
    out.sentences(elements.map(|(index, element)| format!("{}  {}", index + 1, element.print())));
    out.heading("Stability");
    out.sentences([stability_sentence(&view.stability, &view.names)]);
    let has_specifications = !view.problem.specifications.is_empty();
    if has_specifications {
        out.heading("Margins at the design frequencies, the worst first");
        out.table(margins(view));
        let unstable = view.stability.verdict == Verdict::Violated;
        out.sentences(unstable.then(|| {
            "The loop is unstable: these magnitudes do not describe a response, they only show where the loop lies."
                .to_string()
        }));
        out.heading("The nominal loop at the design frequencies");
        out.table(points(view));
    } else {
        out.heading(match view.problem.in_time.is_empty() {
            true => "The project states no [[specification]]: there are no margins and no design frequencies.",
            false => {
                "The project requires steps alone, and nothing over frequency: there are no margins and no design frequencies; `verify` judges the steps."
            }
        });
    }
    if !view.unreached_rad_per_s.is_empty() {
        let missing: Vec<String> = view.unreached_rad_per_s.iter().copied().map(frequency_number).collect();
        out.sentences([format!("Not measured at {} rad/s.", missing.join(", "))]);
    }
    let between = "Nothing is stated about the frequencies between these: `verify` examines them.";
    out.sentences(has_specifications.then(|| between.to_string()));
    out
}

fn margins(view: &ProjectShaping) -> Table {
    let row = |margin: &DesignMargin| {
        let worst = &margin.worst;
        let plants = worst.plants().map(|plant| plant_cell(&view.names, plant));
        [
            Cell::frequency(worst.frequency_rad_per_s),
            Cell::count(worst.specification + 1)
                .then(" ")
                .then(name_words(view.problem.named(worst.specification))),
            Cell::margin(worst.margin_db),
            placement(&margin.placement),
            Cell::listed(plants, "; "),
        ]
    };
    Table::new(["rad/s", "specification", "margin", "the nominal loop", "worst plant"])
        .with(view.margins.iter().map(row))
}

/// Target of a placement.
fn placement(placement: &Placement) -> Cell {
    match placement {
        Placement::Allowed { slack_db } if slack_db.is_infinite() => "any gain is allowed".into(),
        Placement::Allowed { slack_db } => {
            Cell::quantity(*slack_db, 3, DisplayUnit::DECIBEL).then(" from the bound")
        }
        Placement::Forbidden { nearest_db: None, .. } => "no gain is allowed at this phase".into(),
        Placement::Forbidden { nearest_db: Some(change), .. } => {
            let way = if *change > 0.0 { "raise by " } else { "lower by " };
            Cell::from(way).then(Cell::magnitude(*change, 3, DisplayUnit::DECIBEL))
        }
    }
}

fn points(view: &ProjectShaping) -> Table {
    let mut rows = Table::new(["rad/s", "|L0| dB", "phase deg", "among all bounds"]);
    for point in &view.points {
        let (decibels, degrees) = polar(point.nominal_loop);
        rows.row([
            Cell::frequency(point.frequency_rad_per_s),
            Cell::decimal(decibels, 2, DisplayUnit::DECIBEL),
            Cell::decimal(degrees, 2, DisplayUnit::IN_DEGREES),
            placement(&point.placement),
        ]);
    }
    rows
}

/// Magnitude in dB, and phase in degrees in (-360, 0] as on the chart.
pub(super) fn polar(response: num_complex::Complex64) -> (f64, f64) {
    let degrees = portable::argument(response).to_degrees();
    let degrees = if degrees > 0.0 { degrees - 360.0 } else { degrees };
    (20.0 * portable::log10(portable::magnitude(response)), degrees)
}
