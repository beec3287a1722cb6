//! Cost and mass of the parts that make a rig yield: lines, accumulators, the spring or
//! transmission, and the valves at the chambers. All data come from the project or a catalogue.

use std::f64::consts::PI;

use phea_hydraulics::line::Line;
use phea_hydraulics::series::{SeriesElement, Transmission};

use crate::project::{
    ChamberValve, Component, DeclaredActuator, DeclaredLine, DeclaredPipe, DeclaredSeries, ElasticWall,
    LineCost, PartCost, Project,
};
use crate::quantity::{Currency, Price};
use crate::rig::{Rig, series_coil};

/// A part with its price and mass, if they are stated.
#[derive(Clone, Debug, PartialEq)]
pub struct CostedPart {
    /// Kind of the part.
    pub kind: PartKind,
    /// Chamber of its line or accumulator.
    pub side: Option<&'static str>,
    /// Price, in the currency of the project.
    pub price: Option<f64>,
    /// Mass, kg.
    pub mass: Option<f64>,
}

/// Kinds of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// A hose of a line.
    Hose,
    /// A pipe of a line.
    Pipe,
    /// An accumulator at a chamber.
    Accumulator,
    /// A valve at the chambers.
    ChamberValve {
        /// Table that declares it.
        table: &'static str,
        /// Names of one such valve and of several.
        names: [&'static str; 2],
    },
    /// The spring between force sensor and load.
    SeriesSpring,
    /// Both cylinders of a transmission between force sensor and load.
    TransmissionCylinders,
    /// The hose or pipe between these cylinders.
    TransmissionLine,
    /// The servovalve, counted only if it is stated: mostly it is identical in all compared rigs.
    Servovalve,
}

/// Reason why a sum over the parts of a rig is not known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PartsUnknown {
    /// No part states a price.
    NoPrice,
    /// No part states a mass.
    NoMass,
    /// The listed parts state no value.
    NotStated(Vec<UnstatedPart>),
}

/// A part that states no price or no mass, or a pair of parts that state none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnstatedPart {
    /// Kind of the part.
    pub kind: PartKind,
    /// Chamber of its line or accumulator; `None` for both.
    pub side: Option<&'static str>,
    /// True for a pair.
    pub both: bool,
}

/// Attributes that are counted for the parts of several compared rigs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartsCounted {
    /// Currency of the prices; `None` if none is stated.
    pub currency: Option<Currency>,
    /// True if a mass is stated, or follows from the coils of a spring.
    pub masses: bool,
    /// True if the price of a servovalve is stated, and true if its mass is.
    pub servovalve: [bool; 2],
}

impl PartsCounted {
    /// Attributes that at least one of these projects states.
    ///
    /// # Errors
    /// The two currencies, if there are two.
    pub fn of<'p>(projects: impl Iterator<Item = &'p Project>) -> Result<PartsCounted, [Currency; 2]> {
        let mut counted = PartsCounted::default();
        for declared in projects.filter_map(|project| project.actuator.as_ref()) {
            let valve = declared.valve.cost;
            counted.servovalve[0] |= valve.price.is_some();
            counted.servovalve[1] |= valve.mass.is_some();
            let costs = stated(declared);
            let is_wound = declared.series.as_ref().and_then(|series| series.spring()?.coil).is_some();
            counted.masses |= is_wound || costs.iter().any(|cost| cost.mass.is_some());
            for Price { currency, .. } in costs.into_iter().filter_map(|cost| cost.price) {
                match counted.currency {
                    Some(first) if first != currency => return Err([first, currency]),
                    _ => counted.currency = Some(currency),
                }
            }
        }
        Ok(counted)
    }
}

/// All statements of a price or a mass.
fn stated(declared: &DeclaredActuator) -> Vec<PartCost> {
    let (mut lines, mut others) = (vec![&declared.line.a, &declared.line.b], vec![declared.valve.cost]);
    others.extend(declared.chamber_valves().into_iter().map(|valve| valve.cost));
    match &declared.series {
        Some(DeclaredSeries::Spring(spring)) => others.push(spring.cost),
        Some(DeclaredSeries::Transmission(transmission)) => {
            others.push(transmission.cylinders);
            lines.push(&transmission.line);
        }
        None => {}
    }
    let of_lines = lines.into_iter().flat_map(|line| {
        let (cost, density) = match &line.component {
            Component::Hose { properties, .. } => (properties.cost, None),
            Component::Pipe { pipe, .. } => (pipe.cost, pipe.wall.and_then(|wall| wall.density)),
            Component::Volume(_) => (LineCost::default(), None),
        };
        let metre = PartCost { price: cost.price_per_length, mass: cost.mass_per_length.or(density) };
        [Some(cost.ends), Some(metre), line.accumulator.map(|gas| gas.cost)]
    });
    of_lines.flatten().chain(others).collect()
}

/// Parts of a rig. A line that is stated as a volume is drilled or cast, and no part.
pub fn parts(declared: &DeclaredActuator, rig: &Rig) -> Vec<CostedPart> {
    let sides = [("A", &declared.line.a), ("B", &declared.line.b)];
    let mut found: Vec<CostedPart> =
        sides.iter().filter_map(|(side, line)| line_part(Some(side), line)).collect();
    let whole = |kind, side, PartCost { price, mass }: PartCost| CostedPart {
        kind,
        side,
        price: price.map(|price| price.amount),
        mass,
    };
    found.extend(sides.iter().filter_map(|(side, line)| {
        Some(whole(PartKind::Accumulator, Some(*side), line.accumulator.as_ref()?.cost))
    }));
    found.extend(declared.chamber_valves().into_iter().map(|ChamberValve { table, names, side, cost }| {
        whole(PartKind::ChamberValve { table, names }, side, cost)
    }));
    match &declared.series {
        Some(DeclaredSeries::Spring(spring)) => {
            let coils = series_coil(declared, rig).map(|pair| pair.mass);
            let cost = PartCost { mass: spring.cost.mass.or(coils), ..spring.cost };
            found.push(whole(PartKind::SeriesSpring, None, cost));
        }
        Some(DeclaredSeries::Transmission(transmission)) => {
            found.push(whole(PartKind::TransmissionCylinders, None, transmission.cylinders));
            let line = line_part(None, &transmission.line);
            found.extend(line.map(|line| CostedPart { kind: PartKind::TransmissionLine, ..line }));
        }
        None => {}
    }
    found.push(whole(PartKind::Servovalve, None, declared.valve.cost));
    found
}

/// A hose or a pipe.
///
/// ```text
/// price    ends + price_per_length L
/// mass     ends + mass_per_length L       mass_per_length = pi (D + t) t rho of a wall with a density
/// ```
fn line_part(side: Option<&'static str>, line: &DeclaredLine) -> Option<CostedPart> {
    let (kind, cost, by_wall) = match &line.component {
        Component::Hose { properties, .. } => (PartKind::Hose, properties.cost, moving_wall(line)),
        Component::Pipe { pipe, .. } => (PartKind::Pipe, pipe.cost, tube(pipe)),
        Component::Volume(_) => return None,
    };
    let length = line.length().unwrap_or_default();
    let price = sum(
        cost.ends.price.map(|price| price.amount),
        cost.price_per_length.map(|price| price.amount * length),
    );
    let by_length = cost.mass_per_length.or(by_wall.filter(|_| cost.ends.mass.is_none()));
    Some(CostedPart { kind, side, price, mass: sum(cost.ends.mass, by_length.map(|each| each * length)) })
}

/// Sum of the stated values; `None` if neither is stated.
fn sum(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    match (one, other) {
        (None, None) => None,
        (one, other) => Some(one.unwrap_or(0.0) + other.unwrap_or(0.0)),
    }
}

/// Mass per length of a hose whose wall moves, kg/m.
fn moving_wall(line: &DeclaredLine) -> Option<f64> {
    match &line.motion {
        crate::project::LineMotion::TwoWave { wall, .. } => wall.as_ref()?.mass_per_length,
        _ => None,
    }
}

/// Mass per length of a pipe whose wall has a density, kg/m.
fn tube(pipe: &DeclaredPipe) -> Option<f64> {
    let ElasticWall { thickness, density, .. } = pipe.wall?;
    Some(PI * (pipe.bore + thickness) * thickness * density?)
}

/// Total price of all parts, in the counted currency.
///
/// # Errors
/// [`PartsUnknown`] if parts state no price.
pub fn price(parts: &[CostedPart], counted: PartsCounted) -> Result<f64, PartsUnknown> {
    if counted.currency.is_none() {
        return Err(PartsUnknown::NoPrice);
    }
    let wanted = parts.iter().filter(|part| part.kind != PartKind::Servovalve || counted.servovalve[0]);
    total(wanted, |part| part.price)
}

/// Total mass of all parts, with the oil in both lines and in a transmission, kg.
///
/// # Errors
/// [`PartsUnknown`] if parts state no mass.
pub fn mass(parts: &[CostedPart], rig: &Rig, counted: PartsCounted) -> Result<f64, PartsUnknown> {
    if !counted.masses {
        return Err(PartsUnknown::NoMass);
    }
    let wanted = parts.iter().filter(|part| part.kind != PartKind::Servovalve || counted.servovalve[1]);
    Ok(total(wanted, |part| part.mass)? + oil_in_lines(rig))
}

/// The transmission between force sensor and load, if there is one.
pub(crate) fn transmission(rig: &Rig) -> Option<&Transmission> {
    match rig.actuator.components().series.as_ref()? {
        SeriesElement::Transmission(transmission) => Some(transmission),
        SeriesElement::Spring(_) => None,
    }
}

/// Mass of the oil in both lines and in a transmission, kg.
pub fn oil_in_lines(rig: &Rig) -> f64 {
    let components = rig.actuator.components();
    let volume: f64 = [&components.line_a, &components.line_b].map(Line::volume).iter().sum();
    let closed = transmission(rig).map_or(0.0, |transmission| transmission.oil_volume());
    (volume + closed) * components.fluid.density
}

fn total<'p>(
    parts: impl Iterator<Item = &'p CostedPart> + Clone,
    of: fn(&CostedPart) -> Option<f64>,
) -> Result<f64, PartsUnknown> {
    let lacking: Vec<&CostedPart> = parts.clone().filter(|part| of(part).is_none()).collect();
    if lacking.is_empty() {
        return Ok(parts.filter_map(of).sum());
    }
    let mut unstated: Vec<UnstatedPart> = Vec::new();
    for part in &lacking {
        let both = lacking.iter().filter(|other| other.kind == part.kind).count() == 2;
        let one = UnstatedPart { kind: part.kind, side: part.side.filter(|_| !both), both };
        if !unstated.contains(&one) {
            unstated.push(one);
        }
    }
    Err(PartsUnknown::NotStated(unstated))
}
