use super::list::List;
use super::{
    Derived, accumulator, chamber_valves, dynamics, flow, friction, impedance, linear, lines, linkage,
};
use super::{moving, operating_point, parts, series, sizing, stiffness, valve};
use crate::rig::{Rig, RigError};
use crate::setup::Setup;

/// The quantities that follow from one part of a rig, or from all of them together.
type DerivedChapter = fn(&Setup<'_>, &Rig, &mut List);

/// All chapters, in the order in which their quantities follow from each other.
const CHAPTERS: [DerivedChapter; 16] = [
    moving::moving,
    lines::lines,
    stiffness::stiffness,
    accumulator::accumulators,
    series::series,
    parts::costs,
    linkage::linkage,
    valve::valve,
    operating_point::operating_point,
    chamber_valves::chamber_valves,
    linear::linear,
    dynamics::dynamics,
    impedance::impedance,
    friction::friction,
    flow::flow,
    sizing::sizing,
];

/// Every derived quantity of a rig.
///
/// # Errors
/// Errors of [`Setup::rig`].
pub fn derive(setup: &Setup<'_>) -> Result<Vec<Derived>, RigError> {
    let rig = setup.rig()?;
    let mut list = List::new(setup.project.motion());
    CHAPTERS.iter().for_each(|chapter| chapter(setup, rig, &mut list));
    Ok(list.into_entries())
}
