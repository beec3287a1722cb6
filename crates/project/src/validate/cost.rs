//! Prices: all of one project must be in one currency.

use super::Check;
use crate::{ChamberValve, Component, DeclaredActuator, DeclaredLine, DeclaredSeries, LineCost};
use phea_quantity::Price;

pub(super) fn prices(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let mut first: Option<Price> = None;
    for (path, price) in stated(actuator, check) {
        let Some(first) = first.filter(|first| first.currency != price.currency) else {
            first = first.or(Some(price));
            continue;
        };
        let [one, other] = [first, price].map(|price| price.currency.code());
        let message = format!("prices in {one} and in {other} cannot be added: no rate is known");
        check.error_with_help(&path, message, format!("state all prices in {one}, or all in {other}"));
        return;
    }
}

/// All prices with their paths, in the order of the tables.
fn stated(actuator: &DeclaredActuator, check: &Check<'_, '_>) -> Vec<(String, Price)> {
    let mut found = vec![("valve.price".to_string(), actuator.valve.cost.price)];
    let of_side = |table: &str, side: &str, key: &str| {
        let own = format!("{table}.{side}.{key}");
        if check.declared(&own) { own } else { format!("{table}.{key}") }
    };
    for (side, line) in [("a", &actuator.line.a), ("b", &actuator.line.b)] {
        let at = |key: &str| of_side("line", side, key);
        found.extend(of_line(line, &at));
        found.extend(line.accumulator.iter().map(|gas| (at("accumulator.price"), gas.cost.price)));
    }
    found.extend(actuator.chamber_valves().into_iter().map(|ChamberValve { table, side, cost, .. }| {
        let path = match side {
            Some(side) => of_side(table, &side.to_lowercase(), "price"),
            None => format!("{table}.price"),
        };
        (path, cost.price)
    }));
    match &actuator.series {
        Some(DeclaredSeries::Spring(spring)) => found.push(("series.price".to_string(), spring.cost.price)),
        Some(DeclaredSeries::Transmission(transmission)) => {
            found.push(("series.price".to_string(), transmission.cylinders.price));
            found.extend(of_line(&transmission.line, &|key| format!("series.line.{key}")));
        }
        None => {}
    }
    found.into_iter().filter_map(|(path, price)| Some((path, price?))).collect()
}

/// Prices of a hose or pipe, whose keys are at these paths.
fn of_line(line: &DeclaredLine, at: &dyn Fn(&str) -> String) -> Vec<(String, Option<Price>)> {
    let of = |cost: &LineCost, table: &str| {
        [("price", cost.ends.price), ("price_per_length", cost.price_per_length)]
            .map(|(key, price)| (at(&format!("{table}{key}")), price))
            .to_vec()
    };
    match &line.component {
        Component::Hose { properties, .. } => of(&properties.cost, ""),
        Component::Pipe { pipe, .. } => of(&pipe.cost, "pipe."),
        Component::Volume(_) => Vec::new(),
    }
}
