//! Elements, margins and the loop for people.

use phea_dynamics::portable;
use phea_qft::bound::Placement;

use super::{Shaped, Shaping};
use crate::answer::{significant, table};
use crate::audit::{frequency_number, margin_words, stability_sentence};
use phea_qft::verification::Verdict;

/// The tables and sentences of `shape`.
pub fn text(view: &Shaping) -> String {
    let what = match view.shaped {
        Shaped::Controller => "Controller",
        Shaped::Prefilter => "Prefilter",
    };
    let count = match view.elements.len() {
        0 => "no elements, which is the gain 1".to_string(),
        1 => "1 element".to_string(),
        count => format!("{count} elements"),
    };
    let mut out = String::new();
    for caveat in &view.problem.caveats {
        out.push_str(&format!("warning: {}\n", caveat.sentence));
    }
    out.push_str(&format!("{what}: {count}\n"));
    for (index, element) in view.elements.iter().enumerate() {
        out.push_str(&format!("  {}  {}\n", index + 1, element.print()));
    }
    out.push_str(&format!("\nStability\n  {}\n", stability_sentence(&view.stability, &view.names)));
    if view.problem.specifications.is_empty() {
        out.push_str(
            "\nThe project states no [[specification]]: there are no margins and no design frequencies.\n",
        );
    } else {
        out.push_str(&format!("\nMargins at the design frequencies, the worst first\n{}\n", margins(view)));
        if view.stability.verdict == Verdict::Violated {
            out.push_str(
                "  The loop is unstable: these are magnitudes of no response, and tell where it lies only.\n",
            );
        }
        out.push_str(&format!("\nThe nominal loop at the design frequencies\n{}\n", points(view)));
    }
    if !view.unreached_rad_per_s.is_empty() {
        let missing: Vec<String> = view.unreached_rad_per_s.iter().copied().map(frequency_number).collect();
        out.push_str(&format!("  Not measured at {} rad/s.\n", missing.join(", ")));
    }
    if !view.problem.specifications.is_empty() {
        out.push_str("  Nothing is said of what lies between these frequencies: `verify` looks there.\n");
    }
    out
}

fn margins(view: &Shaping) -> String {
    let mut rows = table(&["rad/s", "specification", "margin", "the nominal loop", "worst plant"]);
    for margin in &view.margins {
        let name = format!("{} {}", margin.specification + 1, view.problem.name_of(margin.specification));
        let plant = match &margin.other {
            None => view.names.text(&margin.plant),
            Some(other) => format!("{}; {}", view.names.text(&margin.plant), view.names.text(other)),
        };
        rows.add_row([
            frequency_number(margin.frequency_rad_per_s),
            name,
            margin_words(margin.margin_db),
            placement(&margin.placement),
            plant,
        ]);
    }
    rows.trim_fmt()
}

/// What a placement asks for.
fn placement(placement: &Placement) -> String {
    match placement {
        Placement::Allowed { slack_db } if slack_db.is_infinite() => "any gain is allowed".to_string(),
        Placement::Allowed { slack_db } => format!("{} dB from the bound", significant(*slack_db, 3)),
        Placement::Forbidden { nearest_db: None, .. } => "no gain is allowed at this phase".to_string(),
        Placement::Forbidden { nearest_db: Some(change), .. } => {
            let way = if *change > 0.0 { "raise" } else { "lower" };
            format!("{way} by {} dB", significant(change.abs(), 3))
        }
    }
}

fn points(view: &Shaping) -> String {
    let mut rows = table(&["rad/s", "|L0| dB", "phase deg", "among all bounds"]);
    for point in &view.points {
        let (decibels, degrees) = polar(point.nominal_loop);
        rows.add_row([
            frequency_number(point.frequency_rad_per_s),
            format!("{decibels:.2}"),
            format!("{degrees:.2}"),
            placement(&point.placement),
        ]);
    }
    rows.trim_fmt()
}

/// dB, and degrees in (-360, 0] as on the chart.
pub(super) fn polar(response: num_complex::Complex64) -> (f64, f64) {
    let degrees = portable::argument(response).to_degrees();
    let degrees = if degrees > 0.0 { degrees - 360.0 } else { degrees };
    (20.0 * portable::log10(portable::magnitude(response)), degrees)
}
