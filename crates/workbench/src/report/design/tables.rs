//! Laws, comparison, what binds, and the rounds of a design as tables.

use maud::{Markup, html};
use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_qft::design::{DesignRound, DesignStatus};
use phea_qft::verification::PlantPoint;

use super::super::chapter::{cell, table};
use super::super::specifications::function_text;
use super::super::typeset::{prose, typeset};
use crate::answer::significant;
use crate::audit::{PlantNames, frequency_number, margin_words};
use crate::design::{ProjectDesign, Side, compared, structure_words};

/// The laws in factored form; those of a sampled loop as they are deployed too.
pub(super) fn laws(view: &ProjectDesign) -> Result<Markup, LinearError> {
    let mut rows = side_laws("designed", &view.designed)?;
    if let Some(published) = &view.published {
        rows.extend(side_laws("given", published)?);
    }
    Ok(table(&["", "", "law"], 9, &rows))
}

fn side_laws(name: &str, side: &Side) -> Result<Vec<Vec<Markup>>, LinearError> {
    let deployed = &side.problem.compensation;
    let law = side.controller.feedback.transfer_function()?;
    let prefilter = side.controller.prefilter.transfer_function()?;
    let mut found = vec![("G", law.clone())];
    if law != *deployed.feedback() {
        found.push(("G", deployed.feedback().clone()));
    }
    if side.problem.has_prefilter {
        found.push(("F", prefilter.clone()));
        if prefilter != *deployed.prefilter() {
            found.push(("F", deployed.prefilter().clone()));
        }
    }
    let row = |(index, (symbol, function)): (usize, (&str, TransferFunction))| {
        let variable = if function.domain() == TimeDomain::Continuous { "s" } else { "z" };
        let name = if index == 0 { name } else { "" };
        vec![cell(name), typeset(&format!("{symbol}({variable})")), typeset(&function_text(&function))]
    };
    Ok(found.into_iter().enumerate().map(row).collect())
}

/// What controllers are compared by, a row each.
pub(super) fn comparison(view: &ProjectDesign) -> Markup {
    let mut headings = vec![""];
    let mut columns = Vec::new();
    if let Some(published) = &view.published {
        headings.push("given");
        columns.push(compared(published));
    }
    headings.push("designed");
    columns.push(compared(&view.designed));
    if let Some(continuous) = &view.continuous {
        headings.push("made without samples");
        columns.push(compared(continuous));
    }
    let names = compared(&view.designed).into_iter().map(|(name, _)| name).enumerate();
    let row = |(index, name): (usize, String)| {
        let cells = columns.iter().map(|column| column.get(index).map_or("-", |(_, text)| text.as_str()));
        [cell(name)].into_iter().chain(cells.map(|text| compared_cell(index, text))).collect()
    };
    table(&headings, 1, &names.map(row).collect::<Vec<_>>())
}

/// The first row holds verdicts.
fn compared_cell(row: usize, text: &str) -> Markup {
    let class = match text {
        "met" if row == 0 => "good",
        "violated" if row == 0 => "bad",
        _ => return prose(text),
    };
    html! { span class=(class) { (text) } }
}

/// A limit that is touched or in the way.
type LimitRow<'a> = (usize, f64, f64, &'a PlantPoint);

/// The limits at which the smallest relaxation is found; nothing for a design that is not infeasible.
pub(super) fn conflicts(view: &ProjectDesign) -> Markup {
    let DesignStatus::Infeasible(relaxation) = &view.design.status else { return html! {} };
    let rows = relaxation.conflicts.iter();
    let rows = rows.map(|one| (one.specification, one.frequency_rad_per_s, one.margin_db, &one.plant));
    html! {
        h3 { "What stands against one another" }
        p {
            "With every limit " (significant(relaxation.relaxation_db, 3))
            " dB wider these are all reached at once: to better one of them costs another."
        }
        (limits(view, rows))
    }
}

/// The limit that leaves the loop least room at each design frequency.
pub(super) fn binding(view: &ProjectDesign) -> Markup {
    let rows = view.design.binding.iter();
    let rows = rows.map(|one| (one.specification, one.frequency_rad_per_s, one.margin_db, &one.plant));
    html! {
        p {
            "The specification that leaves the designed loop least room at each design frequency, with the plant that sets it. Where the margin is next to nothing the limit costs: eased there it would leave a controller of less gain; easing any other gains nothing. The head of the chapter names where each specification is worst over its whole band, which may lie between these frequencies."
        }
        (limits(view, rows))
    }
}

/// Limits by frequency; of plants with many parameters a letter, with the plants in a table of their own.
fn limits<'a>(view: &ProjectDesign, rows: impl Iterator<Item = LimitRow<'a>>) -> Markup {
    let names = &view.designed.view.names;
    let lettered = names.headings().len() > NAMED_IN_PLACE;
    let mut plants: Vec<&PlantPoint> = Vec::new();
    let mut cells = Vec::new();
    for (specification, frequency, margin_db, plant) in rows {
        let number = plants.iter().position(|other| *other == plant).unwrap_or(plants.len());
        if number == plants.len() {
            plants.push(plant);
        }
        cells.push(vec![
            cell(view.designed.view.numbered(specification)),
            cell(frequency_number(frequency)),
            cell(margin_words(margin_db)),
            cell(if lettered { plant_letter(number) } else { names.text(plant) }),
        ]);
    }
    html! {
        (table(&["specification", "rad/s", "margin", "plant"], 1, &cells))
        @if lettered { (plant_tables(names, &plants)) }
    }
}

/// Parameters of a plant that are told in the row of its limit.
const NAMED_IN_PLACE: usize = 2;
/// Plants side by side in one table, as many as a page is wide.
const PLANTS_IN_A_TABLE: usize = 4;

/// A to Z, then numbers.
fn plant_letter(number: usize) -> String {
    let letter = u8::try_from(number).ok().filter(|number| *number < 26);
    letter.map_or_else(|| (number + 1).to_string(), |number| char::from(b'A' + number).to_string())
}

fn plant_tables(names: &PlantNames, plants: &[&PlantPoint]) -> Markup {
    let width = plants.len().div_ceil(plants.len().div_ceil(PLANTS_IN_A_TABLE).max(1)).max(1);
    let tables = plants.chunks(width).enumerate().map(|(chunk, plants)| {
        let letters = (0..plants.len()).map(|index| plant_letter(width * chunk + index));
        let mut headings = vec!["plant".to_string()];
        headings.extend(letters);
        let values: Vec<Vec<String>> = plants.iter().map(|plant| names.cells(plant)).collect();
        let rows = names.headings().into_iter().enumerate().map(|(index, parameter)| {
            let values = values.iter().map(|one| cell(one.get(index).cloned().unwrap_or_default()));
            [html! { code { (parameter) } }].into_iter().chain(values).collect()
        });
        let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
        table(&headings, 1, &rows.collect::<Vec<_>>())
    });
    html! { @for table in tables { (table) } }
}

/// Each search with the audit that followed it.
pub(super) fn rounds(view: &ProjectDesign) -> Markup {
    let rounds = &view.design.rounds;
    let row = |(index, round): (usize, &DesignRound)| {
        vec![
            cell((index + 1).to_string()),
            cell(structure_words(&round.structure)),
            cell(format!("{} dB", significant(round.objective_db, 5))),
            cell(round.plants.to_string()),
            cell(round.frequencies.to_string()),
            cell(margin_words(round.searched_margin_db)),
            cell(round.audited_margin_db.map_or("unstable".to_string(), margin_words)),
        ]
    };
    let headings = ["", "structure", "objective", "plants", "frequencies", "searched", "audited"];
    html! {
        p {
            "A search over some plants and frequencies, then an audit over the whole family and band, whose worst plants and frequencies the next search looks at too, until both agree. "
            (rounds.len()) @if rounds.len() == 1 { " round was" } @else { " rounds were" }
            " made, with the seed " (view.options.seed) "; the same seed finds the same controller."
        }
        details {
            summary { "Every round" }
            (table(&headings, 2, &rounds.iter().enumerate().map(row).collect::<Vec<_>>()))
        }
    }
}
