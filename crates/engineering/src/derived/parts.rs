use super::list::List;
use crate::parts::{self, Part, PartKind, PartsCounted, parts};
use crate::project::Project;
use crate::rig::Rig;

const NOT_STATED: &str = "not stated";
const NOT_ALL: &str = "not stated for each of these parts";

/// What the parts cost and weigh, where any of them states it.
pub(super) fn costs(project: &Project, rig: &Rig, list: &mut List) {
    let Some(declared) = &project.actuator else { return };
    let counted = PartsCounted::of(std::iter::once(project)).unwrap_or_default();
    let all = parts(declared, rig);
    list.group("Parts");
    if let Some(currency) = counted.currency {
        let line = "declared; of a line its ends and P_L L_{ho}";
        let each = |part: &Part| part.price;
        one_by_one(&all, (each, counted.servovalve[0]), ("price", "P", currency.code(), line), list);
        let sum = parts::price(&all, counted).map_err(|_| NOT_ALL);
        add("parts.price", ("P", currency.code(), "Σ P of these parts"), sum, list);
    }
    if counted.masses {
        let line = "declared; of a line its ends and m_L L_{ho}, of a tube m_L = π (D + t) t ρ_w";
        let each = |part: &Part| part.mass;
        one_by_one(&all, (each, counted.servovalve[1]), ("mass", "m", "kg", line), list);
        list.add("parts.oil_in_lines.mass", "m", parts::oil_in_lines(rig), "kg", "ρ (V_{ho,A} + V_{ho,B})");
        let sum = parts::mass(&all, rig, counted).map_err(|_| NOT_ALL);
        add("parts.mass", ("m", "kg", "Σ m of these parts, with the oil in both lines"), sum, list);
    }
}

type Words = (&'static str, &'static str, &'static str, &'static str);

fn one_by_one(
    all: &[Part],
    (of, servovalve): (fn(&Part) -> Option<f64>, bool),
    (quantity, symbol, unit, equation): Words,
    list: &mut List,
) {
    for part in all.iter().filter(|part| part.kind != PartKind::Servovalve || servovalve) {
        let name = format!("parts.{}.{quantity}", part.name());
        add(name, (symbol, unit, equation), of(part).ok_or(NOT_STATED), list);
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
