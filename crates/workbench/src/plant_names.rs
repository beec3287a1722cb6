//! The names of the plants of a family, for people.

pub use phea_engineering::plant_names::*;

use phea_qft::verification::PlantPoint;

use crate::quantity::{Dimension, display, parse};

/// `load.stiffness 5 kN/mm, fluid.bulk_modulus 1.2 GPa`
pub(crate) fn plant_words(plant: &NamedPlant) -> String {
    let part = |(name, value): &(String, NamedValue)| match value {
        NamedValue::Number(value, dimension) => format!("{name} {}", value_words(name, *value, dimension)),
        NamedValue::Measurement(name) => name.clone(),
        NamedValue::Added => ADDED.to_string(),
    };
    plant.0.iter().map(part).collect::<Vec<String>>().join(", ")
}

/// A plant that was added to a family.
pub(crate) const ADDED: &str = "the plant that was taken in";

/// `viscous_friction 100 N.s/m, flow_gain 5.61e-5 m3/(s.V)`, or the name of the measurement.
pub fn plant_text(names: &PlantNames, plant: &PlantPoint) -> String {
    match (names, plant) {
        (_, PlantPoint::Additional(_)) => ADDED.to_string(),
        (PlantNames::Parameters(own), PlantPoint::Parameters(values))
            if own.is_empty() || values.is_empty() =>
        {
            "the nominal plant".to_string()
        }
        _ => plant_words(&names.named(plant)),
    }
}

/// The values of a plant one by one, as the columns of a table; in the order of
/// [`PlantNames::headings`].
pub fn plant_cells(names: &PlantNames, plant: &PlantPoint) -> Vec<String> {
    match names.numbers(plant) {
        Some(numbers) => {
            numbers.map(|(name, dimension, value)| value_words(name, value, dimension)).collect()
        }
        None => vec![plant_text(names, plant)],
    }
}

/// Digits of a coefficient of a linear model.
const DIGITS: usize = 4;
/// Relative accuracy to which a number of the project reads back: a spool is at one side of null by
/// a hundred-millionth of its range.
const READS_BACK: f64 = 1e-9;

/// The value of a parameter. A number of the project, such as `operating_point.velocity`, gets as
/// many digits as are needed to read back as an identical plant: its coefficients may jump there.
fn value_words(name: &str, value: f64, dimension: &'static Dimension) -> String {
    if !name.contains('.') {
        return display(value, dimension, DIGITS);
    }
    let is_same = |text: &String| {
        parse(text, dimension).is_ok_and(|read| (read - value).abs() <= READS_BACK * value.abs())
    };
    let mut texts = (DIGITS..=17).map(|digits| display(value, dimension, digits));
    texts.find(is_same).unwrap_or_else(|| display(value, dimension, DIGITS))
}
