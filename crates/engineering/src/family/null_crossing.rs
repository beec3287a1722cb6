//! Plants of a box next to those whose spool is at null.
//!
//! K_qU of unequal edges jumps there, and K_c has its least values within the few hundredths of a
//! volt in which the edges leak: between the corners of a box nothing indicates them. They are
//! members of the family, from which every search inside the box starts.

use std::collections::BTreeSet;

use phea_qft::family::{Extent, UncertainFamily};

use super::ProjectFamilyError;
use super::jumps::jumps;
use super::visited::{Visited, lines};
use crate::setup::Setup;

/// Largest number of coordinates of a box that is crossed from its corners too; others are crossed
/// from their nominal plant only.
const CORNER_COORDINATES: usize = 6;
/// Largest number of crossings that become members.
const CROSSINGS: usize = 64;
/// Number of bisections of a coordinate: down to far less than the change that moves a spool away
/// from null.
const HALVINGS: usize = 40;
/// Fraction of the nominal voltage by which a spool is next to null.
const BESIDE: f64 = 1e-8;

/// The family with the plants on both sides of null, if its operating points cross it: on the edges
/// of the box, and along each coordinate from the nominal plant.
pub(super) fn with_crossings(
    setup: &Setup<'_>,
    family: UncertainFamily,
) -> Result<UncertainFamily, ProjectFamilyError> {
    if setup.project.actuator.is_none() || family.extent() != Extent::Box {
        return Ok(family);
    }
    let visited = Visited::new(setup, family.plant().parameters())?;
    let mut found = crossings(&visited, &family);
    found.extend(jumps(&visited, setup.project, &family));
    if found.is_empty() {
        return Ok(family);
    }
    let mut seen = BTreeSet::new();
    let bits = |values: &Vec<f64>| values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
    let all = family.members().iter().cloned().chain(found);
    let members: Vec<Vec<f64>> = all.filter(|values| seen.insert(bits(values))).collect();
    let coordinates = family.coordinates().to_vec();
    Ok(UncertainFamily::new(family.plant().clone(), coordinates, members, Extent::Box)?)
}

/// Plants on either side of each crossing.
fn crossings(visited: &Visited, family: &UncertainFamily) -> Vec<Vec<f64>> {
    let mut found = Vec::new();
    for axis in visited.axes(family) {
        let beside = |from: Vec<f64>| near_null(visited, family, &from, axis);
        found.extend(lines(family, axis, CORNER_COORDINATES).map(beside).filter(|two| !two.is_empty()));
    }
    let step = found.len().div_ceil(CROSSINGS).max(1);
    found.into_iter().step_by(step).flatten().collect()
}

/// Plants along one coordinate between which the spool passes through null, slightly below and
/// above it: exactly at null it has no side. Only one of them if the box ends at null.
fn near_null(visited: &Visited, family: &UncertainFamily, from: &[f64], axis: usize) -> Vec<Vec<f64>> {
    let beside = BESIDE * visited.rig.actuator.components().valve.nominal_voltage;
    let at = |fraction: f64| {
        let mut fractions = from.to_vec();
        fractions[axis] = fraction;
        family.values(&fractions)
    };
    let mut found = Vec::new();
    for sign in [-1.0, 1.0] {
        let is_there = |fraction: f64| sign * visited.command(&at(fraction)) > beside;
        for [mut there, mut beyond] in [[0.0, 1.0], [1.0, 0.0]] {
            if !is_there(there) || is_there(beyond) {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (there + beyond);
                if is_there(middle) {
                    there = middle;
                } else {
                    beyond = middle;
                }
            }
            found.push(at(there));
        }
    }
    found
}
