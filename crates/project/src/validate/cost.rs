//! Prices: all of one project are in one currency.

use super::Check;
use crate::{Component, DeclaredActuator, LineCost};
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

/// Every price with its path, in the order of the tables.
fn stated(actuator: &DeclaredActuator, check: &Check<'_, '_>) -> Vec<(String, Price)> {
    let mut found = vec![("valve.price".to_string(), actuator.valve.cost.price)];
    for (side, line) in [("a", &actuator.line.a), ("b", &actuator.line.b)] {
        let at = |key: &str| {
            let own = format!("line.{side}.{key}");
            if check.declared(&own) { own } else { format!("line.{key}") }
        };
        let of = |cost: &LineCost, table: &str| {
            [("price", cost.ends.price), ("price_per_length", cost.price_per_length)]
                .map(|(key, price)| (at(&format!("{table}{key}")), price))
        };
        match &line.component {
            Component::Hose { properties, .. } => found.extend(of(&properties.cost, "")),
            Component::Pipe { pipe, .. } => found.extend(of(&pipe.cost, "pipe.")),
            Component::Volume(_) => {}
        }
        found.extend(line.accumulator.iter().map(|gas| (at("accumulator.price"), gas.cost.price)));
    }
    found.extend(actuator.cross_port.iter().map(|port| ("cross_port.price".to_string(), port.cost.price)));
    found.extend(actuator.series.iter().map(|spring| ("series.price".to_string(), spring.cost.price)));
    found.into_iter().filter_map(|(path, price)| Some((path, price?))).collect()
}
