//! Identified numbers that replace those declared in a project, for people.

use super::COVERAGE;
use crate::answer::{significant, unchanged_because};
use crate::document::{Cell, Document, Table};
use crate::project::{FromRecordings, IdentifiedFamily, Loaded};
use crate::quantity::{PRESSURE, display};

/// Heading and table above the output of every command; empty if recordings gave nothing.
pub(crate) fn in_use_above(loaded: &Loaded) -> Document {
    let mut out = Document::default();
    if let Some(recorded) = &loaded.recorded {
        out.heading("The valve as identified from its recordings");
        write_in_use(recorded, &mut out);
        out.gap();
    }
    out
}

/// The files, the numbers with the declared ones, the numbers that remain as declared, and the
/// family.
pub(crate) fn write_in_use(recorded: &FromRecordings, out: &mut Document) {
    let files = recorded.files.iter().map(|file| format!("From {}, SHA-256 `{}`.", file.path, file.sha256));
    out.sentences(files);
    let headings = ["value", "from the recordings", "95 % from", "to", "declared", "unit"];
    let rows = recorded.numbers.iter().map(|one| {
        let [low, high] = one.interval;
        let declared = one.declared.map_or(Cell::Missing, |value| Cell::number(value, 4));
        [
            Cell::Code(one.path.clone()),
            Cell::number(one.value, 5),
            Cell::number(low, 4),
            Cell::number(high, 4),
            declared,
            Cell::unit(one.unit),
        ]
    });
    out.table(Table::new(headings).with(rows));
    out.sentences(tare_pressure(recorded));
    let unchanged = recorded
        .unchanged
        .iter()
        .map(|one| format!("{} stays as declared: {}.", one.path, unchanged_because(one.reason)));
    out.sentences(unchanged.chain(recorded.family.as_ref().map(family)));
}

/// The pressures at which the tare flow holds, in a sentence.
fn tare_pressure(recorded: &FromRecordings) -> Option<String> {
    let tare = recorded.numbers.iter().find(|one| one.path == "valve.tare_flow")?;
    let [identified, declared] = recorded.tare_pressures.map(|drop| display(drop, &PRESSURE, 4));
    let other = tare.declared.filter(|_| declared != identified);
    let other = other.map_or(String::new(), |_| format!(", the declared one that at {declared}"));
    Some(format!("`valve.tare_flow` is that at {identified} from supply to tank{other}."))
}

/// Uncertainty that remains after identification, in a sentence.
fn family(family: &IdentifiedFamily) -> String {
    let half_width = significant(family.deviations, 3);
    let coverage = significant(100.0 * COVERAGE, 2);
    let left_out = significant(100.0 * family.effect_left_out, 2);
    let all = family.effects.len() + family.left_out;
    let unchanged = match family.effects.as_slice() {
        [] => "none of them matters, so that the valve is as identified".to_string(),
        [only] => format!(
            "one of them is in the family and moves K_qU and K_c by up to {} %",
            significant(100.0 * only, 2)
        ),
        [first, ..] => format!(
            "{} of them are in the family, the first of which moves K_qU and K_c by up to {} %",
            family.effects.len(),
            significant(100.0 * first, 2)
        ),
    };
    let others = match family.left_out {
        0 => String::new(),
        _ => format!("; those left out move K_qU and K_c by at most {left_out} % together"),
    };
    format!(
        "What the recordings leave uncertain ({coverage} %) has {all} independent directions of {half_width} standard deviations to either side: {unchanged}{others}."
    )
}
