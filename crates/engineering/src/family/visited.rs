//! Operating points of a family: recorded with the numbers that determine them, checked at its
//! plants, and the box of linear parameters that they visit.

use std::collections::BTreeSet;

use phea_dynamics::expression::Expression;
use phea_dynamics::uncertain_plant::UncertainParameter;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use phea_hydraulics::operating_point::{Settled, operating_point};
use phea_qft::family::{Coordinate, Extent, UncertainFamily};

use super::hydraulic::Open;
use super::moved::{self, MovedNumber};
use super::{NoOperatingPoint, ProjectFamilyError};
use crate::project::{DeclaredActuator, OpenRig, Project};
use crate::rig::{Equal, OfMotion, Rig, RigError, UnsolvedRig, are_equal, sides, states_one_pressure};
use crate::setup::Setup;

/// Relative error of a pressure that is negligible.
const EXACT: f64 = 1e-9;
/// Largest number of corners of a box that are examined one by one.
const CORNERS: usize = 4096;
/// Number of points within a box at which equality of the chambers is tested.
const WITHIN: usize = 64;

/// The rig of a family with its uncertain numbers as parameters.
#[derive(Debug)]
pub(super) struct Visited {
    pub(super) rig: Rig,
    /// Names of the parameters, then of the numbers that their directions move.
    names: Vec<String>,
    /// The rig with these numbers open.
    table: OpenRig,
    /// Numbers that directions move.
    by_directions: Vec<MovedNumber>,
    /// True if the pressures depend on an uncertain number.
    pub(super) moved: bool,
    /// Parameters that are equal on both sides in every plant.
    pub(super) equal: Equal,
    /// Uncertain numbers on which the pressures depend.
    pub(super) movers: Vec<usize>,
    /// Command and both pressures.
    pub(super) settled: Expression,
}

impl Visited {
    pub(super) fn new(
        setup: &Setup<'_>,
        parameters: &[UncertainParameter],
    ) -> Result<Visited, ProjectFamilyError> {
        let (project, rig) = (setup.project, setup.rig()?.clone());
        let Some(declared) = &project.actuator else { return Err(RigError::NoActuator.into()) };
        let own: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
        let by_directions = moved::moved(project, &own);
        let names = moved::names(&own, &by_directions);
        let table = OpenRig::new(declared, &project.resolved_operating_point(), &names);
        let moved = &by_directions;
        let open = Open { project, declared, rig: &rig, names: &names, table: &table, moved, start: None };
        let all: Vec<&str> = own.iter().map(String::as_str).collect();
        let settled = Expression::record(&all, |values| {
            let UnsolvedRig { steady, balance, .. } = open.balanced(values);
            let Settled { command, pressures: [a, b] } = balance.settle(steady);
            vec![command, a, b]
        });
        let movers: Vec<usize> = (0..own.len()).filter(|index| settled.depends_on(*index)).collect();
        let moved = !movers.is_empty();
        let both = Expression::record(&all, |values| {
            let place = open.place(values, moved);
            let edges = place.supply.map_or([0.0.into(); 2], |supply| supply.edges);
            [edges].into_iter().chain(sides(&place.chambers)).flatten().collect()
        });
        let plants = within(parameters);
        let nominal: Vec<f64> = parameters.iter().map(|parameter| parameter.nominal).collect();
        let pairs: Vec<Vec<[f64; 2]>> = [&nominal]
            .into_iter()
            .chain(&plants)
            .map(|values| both.evaluate(values).chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
            .collect();
        let equal = |from: usize, to: usize| {
            pairs.iter().all(|pairs| are_equal(pairs.iter().copied().take(to).skip(from)))
        };
        let chambers = are_equal(sides(&rig.two_pressure)) && equal(1, usize::MAX);
        let is_stated = states_one_pressure(&rig.parameters, &names);
        let equal = Equal::new(declared, [chambers, equal(0, 1)], is_stated);
        Ok(Visited { rig, names, table, by_directions, moved, equal, movers, settled })
    }

    /// The rig with its uncertain numbers as variables.
    pub(super) fn open<'a>(&'a self, project: &'a Project, declared: &'a DeclaredActuator) -> Open<'a> {
        let Visited { rig, names, table, by_directions: moved, .. } = self;
        Open { project, declared, rig, names, table, moved, start: None }
    }

    /// Error at a plant; `None` if its recorded pressures are those of its operating point.
    pub(super) fn problem(&self, open: &Open<'_>, values: &[f64]) -> Option<NoOperatingPoint> {
        let UnsolvedRig { components, position, steady, balance } = open.balanced(values);
        let results = self.settled.evaluate(values);
        let &[command, pressure_a, pressure_b] = results.first_chunk()?;
        let settled = Settled { command, pressures: [pressure_a, pressure_b] };
        let sound = balance.error(steady, &settled) <= EXACT
            && command.abs() <= balance.valve.nominal_voltage
            && pressure_a.min(pressure_b) > -ATMOSPHERIC_PRESSURE_ABSOLUTE
            && components.cylinder.stroke.contains(position);
        if sound && balance.is_unique(steady) {
            return None;
        }
        let components = Components { supply: balance.supply, ..components };
        let afresh = Actuator::new(components).map_err(NoOperatingPoint::Actuator).and_then(|actuator| {
            let unbalanced =
                |error| NoOperatingPoint::Unbalanced(OfMotion { motion: open.declared.motion(), error });
            operating_point(&actuator, position, steady.into()).map_err(unbalanced)
        });
        let point = match afresh {
            Err(reason) => return Some(reason),
            Ok(point) => point,
        };
        let drop = balance.supply.pressure - balance.supply.tank_pressure;
        let error = (command - point.command).abs() / balance.valve.nominal_voltage
            + (pressure_a - point.pressure_a).abs() / drop
            + (pressure_b - point.pressure_b).abs() / drop;
        (error.is_nan() || error > EXACT).then_some(NoOperatingPoint::Missed { fraction: error })
    }

    /// Command of the operating point at a plant, V.
    pub(super) fn command(&self, values: &[f64]) -> f64 {
        self.settled.evaluate(values).first().copied().unwrap_or(f64::NAN)
    }

    /// Coordinates of a family that move its operating points.
    pub(super) fn axes(&self, family: &UncertainFamily) -> Vec<usize> {
        let moves = |one: &Coordinate| one.parameters.iter().any(|index| self.movers.contains(index));
        (0..family.coordinates().len()).filter(|&axis| moves(&family.coordinates()[axis])).collect()
    }

    /// Chamber, A or B, whose pressure is below the precharge of its gas at a plant.
    pub(super) fn shut_gas(&self, open: &Open<'_>, values: &[f64]) -> Option<char> {
        let &[_, pressure_a, pressure_b] = self.settled.evaluate(values).first_chunk()?;
        let components = open.rig_with(values).components();
        let is_shut = |side: usize, pressure: f64| {
            components.gas_in_use(side).is_some_and(|gas| pressure < gas.at_rest().precharge_pressure)
        };
        let chambers = [('A', 0, pressure_a), ('B', 1, pressure_b)];
        chambers.into_iter().find(|(_, side, pressure)| is_shut(*side, *pressure)).map(|(name, ..)| name)
    }

    /// The parameters that determine the operating point, with their values.
    pub(super) fn member(&self, project: &Project, values: &[f64]) -> String {
        let named =
            self.movers.iter().filter_map(|&index| Some((self.names.get(index)?, values.get(index)?)));
        let named: Vec<String> =
            named.map(|(name, value)| format!("{name} = {}", project.in_words(name, *value))).collect();
        named.join(", ")
    }

    /// The names of the parameters that determine the operating point.
    pub(super) fn numbers(&self) -> Vec<String> {
        self.movers.iter().filter_map(|&index| self.names.get(index).cloned()).collect()
    }

    /// Plants of a family, and corners of its box, that differ in the numbers that determine the
    /// operating point.
    fn places(&self, family: &UncertainFamily) -> Vec<Vec<f64>> {
        let axes = self.axes(family);
        let count = match family.extent() {
            Extent::Box => 1_usize.checked_shl(axes.len() as u32).unwrap_or(CORNERS).min(CORNERS),
            Extent::Members => 0,
        };
        let nominal = family.fractions(&family.plant().nominal());
        let corner = |corner: usize| {
            let mut fractions = nominal.clone();
            for (place, &axis) in axes.iter().enumerate() {
                fractions[axis] = f64::from(u8::from(corner >> place & 1 == 1));
            }
            family.values(&fractions)
        };
        let mut seen = BTreeSet::new();
        let bits = |values: &Vec<f64>| -> Vec<u64> {
            self.movers.iter().filter_map(|&index| values.get(index)).map(|value| value.to_bits()).collect()
        };
        let all = family.members().iter().cloned().chain((0..count).map(corner));
        all.filter(|values| seen.insert(bits(values))).collect()
    }
}

/// Checks at every plant of the family, and at every corner of its box, that the recorded pressures
/// are those of its operating point.
///
/// # Errors
/// [`ProjectFamilyError::OperatingPoint`] with the first plant where they are not, and the reason.
pub(super) fn check(setup: &Setup<'_>, family: &UncertainFamily) -> Result<(), ProjectFamilyError> {
    let project = setup.project;
    let Some(declared) = &project.actuator else { return Ok(()) };
    let visited = Visited::new(setup, family.plant().parameters())?;
    if !visited.moved {
        return Ok(());
    }
    let open = visited.open(project, declared);
    for values in visited.places(family) {
        if let Some(reason) = visited.problem(&open, &values) {
            return Err(ProjectFamilyError::OperatingPoint {
                member: visited.member(project, &values),
                numbers: visited.numbers(),
                reason,
            });
        }
    }
    Ok(())
}

/// Both ends of a box and points within it: multiples of the golden ratio fill the unit interval
/// evenly.
pub(super) fn within(parameters: &[UncertainParameter]) -> Vec<Vec<f64>> {
    let mut fraction = 0.0_f64;
    let at = |parameter: &UncertainParameter, fraction: f64| {
        parameter.minimum + fraction * (parameter.maximum - parameter.minimum)
    };
    let mut next = |parameter: &UncertainParameter| {
        fraction = (fraction + 0.618_033_988_749_895).fract();
        at(parameter, fraction)
    };
    let mut points: Vec<Vec<f64>> = (0..WITHIN).map(|_| parameters.iter().map(&mut next).collect()).collect();
    points.extend([0.0, 1.0].map(|fraction| parameters.iter().map(|one| at(one, fraction)).collect()));
    points
}

/// Fractions of the box from which lines extend along one coordinate: those of the nominal plant,
/// and its edges, if it has no more coordinates than this.
pub(super) fn lines(
    family: &UncertainFamily,
    axis: usize,
    most: usize,
) -> impl Iterator<Item = Vec<f64>> + use<> {
    let nominal = family.fractions(&family.plant().nominal());
    let count = nominal.len();
    let corners = if count <= most { 1_usize << count } else { 0 };
    let lower = (0..corners).filter(move |corner| corner >> axis & 1 == 0);
    let corner = move |corner: usize| -> Vec<f64> {
        (0..count).map(|axis| f64::from(u8::from(corner >> axis & 1 == 1))).collect()
    };
    std::iter::once(nominal).chain(lower.map(corner))
}
