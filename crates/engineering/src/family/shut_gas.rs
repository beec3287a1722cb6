//! Plants of a family in which the gas at a chamber is shut off.

use phea_qft::family::{Extent, UncertainFamily};

use super::null_sides::SIDE;
use super::visited::Visited;
use super::{ProjectFamilyError, uncertain, uncertain_plant};
use crate::quantity::Dimension;
use crate::setup::Setup;

/// Plants in which the pressure of a chamber is below the precharge of its gas: they are as stiff
/// as without it.
#[derive(Clone, Debug, PartialEq)]
pub struct ShutGas {
    /// Number of such plants among those examined: the members, and the corners of the box.
    pub count: usize,
    /// Number of examined plants.
    pub examined: usize,
    /// Chamber of the first such plant, A or B.
    pub side: char,
    /// Uncertain numbers of the first such plant that are not nominal.
    pub at: Vec<NumberAt>,
}

/// An uncertain number at a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberAt {
    /// Path of the number in the project, or name of the parameter.
    pub name: String,
    /// Value, SI.
    pub value: f64,
    /// Dimension; `None` if the project has no number of this name.
    pub dimension: Option<&'static Dimension>,
}

/// Largest number of uncertain numbers whose corners are all examined.
const MOST_AXES: usize = 10;

/// Plants of a family in which the gas at a chamber is shut off; `None` if it is in use in every
/// examined plant, or if there is no gas.
///
/// ```text
/// P_A < P_0 of accumulator A,   or   P_B < P_0 of accumulator B            at the operating point of the plant
/// ```
///
/// # Errors
/// The errors of [`family`](super::family()).
pub fn shut_gas(setup: &Setup<'_>) -> Result<Option<ShutGas>, ProjectFamilyError> {
    let project = setup.project;
    let Some(declared) = &project.actuator else { return Ok(None) };
    if [&declared.line.a, &declared.line.b].iter().all(|line| line.accumulator.is_none()) {
        return Ok(None);
    }
    let family = uncertain::family(project, uncertain_plant(setup)?)?;
    let parameters = family.plant().parameters();
    let visited = Visited::new(setup, parameters)?;
    let open = visited.open(project, declared);
    let plants = examined(&family);
    let mut shut = plants.iter().filter_map(|values| Some((values, visited.shut_gas(&open, values)?)));
    let Some((first, side)) = shut.next() else { return Ok(None) };
    let count = 1 + shut.count();
    let moved =
        parameters.iter().zip(first).filter(|(one, value)| one.name != SIDE && one.nominal != **value);
    let dimensions = project.dimensions();
    let at = moved.map(|(one, value)| NumberAt {
        name: one.name.clone(),
        value: *value,
        dimension: dimensions.get(&one.name).copied(),
    });
    Ok(Some(ShutGas { count, examined: plants.len(), side, at: at.collect() }))
}

/// Members, and corners of a box of a few numbers.
fn examined(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let axes = family.coordinates().len();
    let corners = match family.extent() {
        Extent::Box if axes <= MOST_AXES => 1_usize << axes,
        _ => 0,
    };
    let corner = |corner: usize| {
        let fractions: Vec<f64> =
            (0..axes).map(|axis| f64::from(u8::from(corner >> axis & 1 == 1))).collect();
        family.values(&fractions)
    };
    let mut all = family.members().to_vec();
    for values in (0..corners).map(corner) {
        if !all.contains(&values) {
            all.push(values);
        }
    }
    all
}
