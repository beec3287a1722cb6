//! The closed loops of the family with both controllers against each limit (thesis, Figure 6.15).

use phea_dynamics::linear::LinearError;
use phea_engineering::design::ProjectDesign;
use phea_engineering::specification::kind_key;
use phea_qft::specification::Requirement;

use super::super::closed_loops::{LoopFamily, magnitudes};
use super::super::specifications::titled;

use crate::figure::{FamilyMagnitude, Figure, Words};
use crate::specification::name_words;

/// A figure for each specification to which a loop has a margin.
pub(in crate::report) fn figures(view: &ProjectDesign) -> Result<Vec<Figure>, LinearError> {
    let sides = [("designed", Some(&view.designed)), ("given", view.published.as_deref())];
    let sides = sides.into_iter().filter_map(|(name, side)| Some((name, side?)));
    let loops = sides.map(|(name, side)| LoopFamily::new(name, &side.problem, &side.view));
    let loops: Vec<LoopFamily<'_>> = loops.collect::<Result<_, _>>()?;
    let specifications = view.designed.problem.specifications.iter().enumerate();
    let figures = specifications.filter_map(|(index, specification)| {
        let (chart, by_spread) = magnitudes(&loops, index, specification)?;
        let name = titled(view.designed.view.number_of(index), name_words(view.designed.view.named(index)));
        let words = words((index, &name), &specification.requirement, &chart, by_spread);
        Some(FamilyMagnitude { members: vec![], ..chart }.draw(&words))
    });
    Ok(figures.collect())
}

fn words(
    (index, name): (usize, &str),
    requirement: &Requirement,
    chart: &FamilyMagnitude,
    by_spread: bool,
) -> Words {
    let quantity = &chart.quantity;
    let whose = if chart.envelopes.len() == 1 { "the designed loop" } else { "both loops" };
    let extremes = match requirement.limits().0 {
        Some(_) if !by_spread => "The greatest and the least",
        _ => "The greatest",
    };
    let caption = format!("{extremes} {quantity} of the family in {whose}, compared with what is allowed.");
    let title = format!("{name}, of {whose}");
    Words::new(format!("design_{}_{}", index + 1, kind_key(requirement)), title, caption)
}
