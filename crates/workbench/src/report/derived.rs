//! The chapter on derived quantities: value, unit, equation, and what the project states instead.

use maud::{Markup, html};

use super::chapter::{Chapter, cell, table};
use crate::derived::{Derived, sentence, stated};
use crate::document::{figures, prose, typeset};

pub(super) fn chapter(derived: &[Derived]) -> Chapter {
    let mut groups: Vec<&'static str> = derived.iter().map(|quantity| quantity.group).collect();
    groups.dedup();
    let stated = stated(derived);
    let body = html! {
        p { "Everything that follows from the project, in SI units, with the equation it follows from." }
        @for group in groups {
            h3 { (group) }
            (rows(derived.iter().filter(|quantity| quantity.group == group)))
        }
        @if !stated.is_empty() {
            h3 { "Stated by the project and used instead" }
            p { "The linear models use these values. Where a stated value and the derived one part, the nonlinear machine follows the derived one." }
            ul { @for quantity in stated { li class=(if quantity.contradicts() { "bad" } else { "" }) { (prose(&sentence(quantity))) } } }
        }
    };
    Chapter { anchor: "derived", title: "Derived quantities", body, figures: vec![] }
}

fn rows<'a>(quantities: impl Iterator<Item = &'a Derived>) -> Markup {
    let rows: Vec<Vec<Markup>> = quantities
        .map(|quantity| {
            vec![
                typeset(quantity.symbol),
                cell(words(&quantity.name)),
                match quantity.value {
                    Err(reason) => cell(reason),
                    Ok(_) => typeset(quantity.equation),
                },
                quantity.value.map_or_else(|_| cell("-"), |value| figures(value, 5)),
                html! { span.unit { (unit(quantity.unit)) } },
            ]
        })
        .collect();
    table(&["", "quantity", "equation", "value", "unit"], 3, &rows)
}

/// `line.a.wave_speed` as "wave speed, line A": the group's own word is not repeated.
fn words(name: &str) -> String {
    let (group, quantity) = name.split_once('.').unwrap_or(("", name));
    match (group, quantity.split_once('.')) {
        ("line", Some((side, quantity))) => {
            format!("{}, line {}", quantity.replace('_', " "), side.to_uppercase())
        }
        _ => quantity.replace(['_', '.'], " "),
    }
}

/// A unit as it is printed: m3/(s.V) as m³/(s·V).
pub(super) fn unit(text: &str) -> String {
    if text == "1" {
        return "1".to_string();
    }
    text.replace("Pa^0.5", "√Pa").replace('2', "²").replace('3', "³").replace('.', "·")
}
