//! The chapter on derived quantities: value, unit, equation, and what the project states instead.

use maud::{Markup, html};

use super::chapter::{Chapter, cell, table};
use super::typeset::typeset;
use crate::answer::significant;
use crate::derived::{Derived, sentence};

pub(super) fn chapter(derived: &[Derived]) -> Chapter {
    let mut groups: Vec<&'static str> = derived.iter().map(|quantity| quantity.group).collect();
    groups.dedup();
    let stated: Vec<&Derived> = derived.iter().filter(|quantity| quantity.stated.is_some()).collect();
    let body = html! {
        p { "Everything that follows from the project, in SI units, with the equation it follows from." }
        @for group in groups {
            h3 { (group) }
            (rows(derived.iter().filter(|quantity| quantity.group == group)))
        }
        @if !stated.is_empty() {
            h3 { "Stated by the project and used instead" }
            p { "The linear models use these values. Where a stated value and the derived one part, the nonlinear machine follows the derived one." }
            ul { @for quantity in stated { li class=(if quantity.contradicts() { "bad" } else { "" }) { (typeset(&sentence(quantity))) } } }
        }
    };
    Chapter { anchor: "derived", title: "Derived quantities", body, figures: vec![] }
}

fn rows<'a>(quantities: impl Iterator<Item = &'a Derived>) -> Markup {
    let rows: Vec<Vec<Markup>> = quantities
        .map(|quantity| {
            let value =
                if quantity.value.is_nan() { "-".to_string() } else { significant(quantity.value, 5) };
            vec![
                typeset(quantity.symbol),
                cell(quantity.name.rsplit('.').next().unwrap_or(&quantity.name).replace('_', " ")),
                match &quantity.reason {
                    Some(reason) => cell(reason),
                    None => typeset(quantity.equation),
                },
                cell(value),
                html! { span.unit { (quantity.unit) } },
            ]
        })
        .collect();
    table(&["", "quantity", "equation", "value", "unit"], 3, &rows)
}
