//! The names of the plants of a family, for people.

use phea_engineering::plant_names::{NamedPlant, NamedValue, PlantNames};
use phea_qft::verification::PlantPoint;

use crate::document::Cell;
use crate::quantity::{Dimension, display, parse};

/// `load.stiffness 5 kN/mm, fluid.bulk_modulus 1.2 GPa`
pub(crate) fn plant_words(plant: &NamedPlant) -> String {
    cell_of(plant).text()
}

/// The plant in one cell.
fn cell_of(plant: &NamedPlant) -> Cell {
    let part = |(name, value): &(String, NamedValue)| match value {
        NamedValue::Number(value, dimension) => {
            Cell::from(format!("{name} ")).then(value_cell(name, *value, dimension))
        }
        NamedValue::Measurement(name) => Cell::Code(name.clone()),
        NamedValue::Added => ADDED.into(),
    };
    Cell::listed(plant.0.iter().map(part), ", ")
}

/// A plant that was added to a family.
pub(crate) const ADDED: &str = "the plant that was taken in";

/// `viscous_friction 100 N.s/m, flow_gain 5.61e-5 m3/(s.V)`, or the name of the measurement.
pub fn plant_text(names: &PlantNames, plant: &PlantPoint) -> String {
    plant_cell(names, plant).text()
}

/// A plant in one cell, in the words of [`plant_text`].
pub(crate) fn plant_cell(names: &PlantNames, plant: &PlantPoint) -> Cell {
    match (names, plant) {
        (_, PlantPoint::Additional(_)) => ADDED.into(),
        (PlantNames::Parameters(own), PlantPoint::Parameters(values))
            if own.is_empty() || values.is_empty() =>
        {
            "the nominal plant".into()
        }
        _ => cell_of(&names.named(plant)),
    }
}

/// The values of a plant one by one, as the columns of a table; in the order of
/// [`PlantNames::headings`].
pub(crate) fn plant_cells(names: &PlantNames, plant: &PlantPoint) -> Vec<Cell> {
    match names.numbers(plant) {
        Some(numbers) => numbers.map(|(name, dimension, value)| value_cell(name, value, dimension)).collect(),
        None => vec![plant_cell(names, plant)],
    }
}

/// Digits of a coefficient of a linear model.
const DIGITS: usize = 4;
/// Relative accuracy to which a number of the project reads back: a spool is at one side of null by
/// a hundred-millionth of its range.
const READS_BACK: f64 = 1e-9;

/// The value of a parameter. A number of the project, such as `operating_point.velocity`, gets as
/// many digits as are needed to read back as an identical plant: its coefficients may jump there.
fn value_cell(name: &str, value: f64, dimension: &'static Dimension) -> Cell {
    let reads_back = |digits: &usize| {
        let read = parse(&display(value, dimension, *digits), dimension);
        read.is_ok_and(|read| (read - value).abs() <= READS_BACK * value.abs())
    };
    let exact = (DIGITS..=17).find(reads_back).filter(|_| name.contains('.'));
    Cell::customary(value, exact.unwrap_or(DIGITS), dimension)
}
