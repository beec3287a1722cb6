use phea_engineering::parts::{self, CostedPart, PartKind, PartsCounted, parts};

use super::list::List;
use crate::rig::Rig;
use crate::setup::Setup;

const NOT_STATED: &str = "not stated";
const NOT_ALL: &str = "not stated for each of these parts";

/// Cost and mass of the parts, if any of them states them.
pub(super) fn costs(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let project = setup.project;
    let Some(declared) = &project.actuator else { return };
    let counted = PartsCounted::of(std::iter::once(project)).unwrap_or_default();
    let all = parts(declared, rig);
    list.group("Parts");
    if let Some(currency) = counted.currency {
        let each = |part: &CostedPart| part.price;
        one_by_one(&all, (each, counted.servovalve[0]), ("price", "P", currency.code()), list);
        let sum = parts::price(&all, counted).map_err(|_| NOT_ALL);
        add("parts.price", ("P", currency.code(), "Σ P of these parts"), sum, list);
    }
    if counted.masses {
        let each = |part: &CostedPart| part.mass;
        one_by_one(&all, (each, counted.servovalve[1]), ("mass", "m", "kg"), list);
        list.add("parts.oil_in_lines.mass", "m", parts::oil_in_lines(rig), "kg", "ρ (V_{ho,A} + V_{ho,B})");
        let sum = parts::mass(&all, rig, counted).map_err(|_| NOT_ALL);
        add("parts.mass", ("m", "kg", "Σ m of these parts, with the oil in both lines"), sum, list);
    }
}

fn one_by_one(
    all: &[CostedPart],
    (of, servovalve): (fn(&CostedPart) -> Option<f64>, bool),
    (quantity, symbol, unit): (&'static str, &'static str, &'static str),
    list: &mut List,
) {
    for part in all.iter().filter(|part| part.kind != PartKind::Servovalve || servovalve) {
        let name = format!("parts.{}.{quantity}", part_name(part));
        let equation = equation(part.kind, quantity == "price");
        add(name, (symbol, unit, equation), of(part).ok_or(NOT_STATED), list);
    }
}

/// The name of a part in the list, such as `hose.a`.
fn part_name(part: &CostedPart) -> String {
    let name = match part.kind {
        PartKind::Hose => "hose",
        PartKind::Pipe => "pipe",
        PartKind::Accumulator => "accumulator",
        PartKind::ChamberValve { table, .. } => table,
        PartKind::SeriesSpring | PartKind::TransmissionCylinders => "series",
        PartKind::TransmissionLine => "series.line",
        PartKind::Servovalve => "valve",
    };
    part.side.map_or(name.to_string(), |side| format!("{name}.{}", side.to_lowercase()))
}

fn equation(kind: PartKind, is_price: bool) -> &'static str {
    match (kind, is_price) {
        (PartKind::Hose | PartKind::Pipe, true) => "P + P_L L_{ho}, of its ends and of its length",
        (PartKind::Hose, false) => "m + m_L L_{ho}, of its ends and of its length",
        (PartKind::Pipe, false) => "m + m_L L_{ho}, or m_L = π (D + t) t ρ_w",
        (PartKind::SeriesSpring, false) => "declared, or that of its coils",
        _ => "declared",
    }
}

fn add(
    name: impl Into<String>,
    (symbol, unit, equation): (&'static str, &'static str, &'static str),
    value: Result<f64, &'static str>,
    list: &mut List,
) {
    match value {
        Ok(value) => list.add(name, symbol, value, unit, equation),
        Err(reason) => list.absent(name, symbol, unit, equation, reason),
    }
}
