//! The names of the plants of a family, for people and programs.

use phea_qft::family::Family;
use phea_qft::verification::PlantPoint;

use crate::project::Project;
use crate::quantity::{Dimension, RATIO, display, parse};

/// What the numbers of a plant are called.
#[derive(Clone, Debug)]
pub enum PlantNames {
    /// Uncertain parameters in the order of the plant, with their dimensions.
    Parameters(Vec<(String, &'static Dimension)>),
    /// Names of the measurements.
    Measured(Vec<String>),
}

/// One plant with its names: of each number its name and SI value.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPlant(pub Vec<(String, NamedValue)>);

/// What a plant is named by.
#[derive(Clone, Debug, PartialEq)]
pub enum NamedValue {
    /// A parameter, SI, with its dimension.
    Number(f64, &'static Dimension),
    /// A measurement, or where the plant comes from.
    Text(String),
}

impl NamedPlant {
    /// `load.stiffness 5 kN/mm, fluid.bulk_modulus 1.2 GPa`
    pub fn words(&self) -> String {
        let part = |(name, value): &(String, NamedValue)| match value {
            NamedValue::Number(value, dimension) => {
                format!("{name} {}", place_words(name, *value, dimension))
            }
            NamedValue::Text(text) => text.clone(),
        };
        self.0.iter().map(part).collect::<Vec<String>>().join(", ")
    }
}

impl PlantNames {
    /// The names of the plants of a family.
    pub fn of_family(project: &Project, family: &Family) -> PlantNames {
        match family {
            Family::Uncertain(family) => PlantNames::of_parameters(
                project,
                family.plant().parameters().iter().map(|parameter| parameter.name.as_str()),
            ),
            Family::Measured(family) => {
                PlantNames::Measured(family.plants().iter().map(|plant| plant.name.clone()).collect())
            }
        }
    }

    /// Names of the parameters of an uncertain plant, with the dimension of those that are numbers
    /// of the project or of its linear model.
    pub fn of_parameters<'a>(project: &Project, names: impl Iterator<Item = &'a str>) -> PlantNames {
        let known = project.dimensions();
        let dimension = |name: &str| known.get(name).copied().unwrap_or(&RATIO);
        PlantNames::Parameters(names.map(|name| (name.to_string(), dimension(name))).collect())
    }

    /// Names and values of a plant, if it has any.
    pub fn numbers<'a>(
        &'a self,
        plant: &'a PlantPoint,
    ) -> Option<impl Iterator<Item = (&'a str, &'static Dimension, f64)>> {
        let (names, values) = match (self, plant) {
            (PlantNames::Parameters(names), PlantPoint::Parameters(values)) => (names, values),
            _ => return None,
        };
        Some(names.iter().zip(values).map(|((name, dimension), value)| (name.as_str(), *dimension, *value)))
    }

    /// `viscous_friction 100 N.s/m, flow_gain 5.61e-5 m3/(s.V)`, or the name of the measurement.
    pub fn text(&self, plant: &PlantPoint) -> String {
        let Some(numbers) = self.numbers(plant) else {
            return match (self, plant) {
                (_, PlantPoint::Beside(_)) => "the plant that was taken in".to_string(),
                (PlantNames::Measured(names), PlantPoint::Measured(index)) => {
                    names.get(*index).cloned().unwrap_or_default()
                }
                _ => String::new(),
            };
        };
        let parts: Vec<String> = numbers
            .map(|(name, dimension, value)| format!("{name} {}", place_words(name, value, dimension)))
            .collect();
        if parts.is_empty() { "the nominal plant".to_string() } else { parts.join(", ") }
    }

    /// The values of a plant one by one, as the columns of a table; in the order of
    /// [`PlantNames::headings`].
    pub fn cells(&self, plant: &PlantPoint) -> Vec<String> {
        match self.numbers(plant) {
            Some(numbers) => {
                numbers.map(|(name, dimension, value)| place_words(name, value, dimension)).collect()
            }
            None => vec![self.text(plant)],
        }
    }

    /// The headings of the columns of [`PlantNames::cells`].
    pub fn headings(&self) -> Vec<&str> {
        match self {
            PlantNames::Parameters(names) => names.iter().map(|(name, _)| name.as_str()).collect(),
            PlantNames::Measured(_) => vec!["measurement"],
        }
    }

    /// The plant with its names.
    pub fn named(&self, plant: &PlantPoint) -> NamedPlant {
        match self.numbers(plant) {
            Some(numbers) => NamedPlant(
                numbers
                    .map(|(name, dimension, value)| (name.to_string(), NamedValue::Number(value, dimension)))
                    .collect(),
            ),
            None => {
                let key = if matches!(plant, PlantPoint::Beside(_)) { "beside" } else { "measured" };
                NamedPlant(vec![(key.to_string(), NamedValue::Text(self.text(plant)))])
            }
        }
    }
}

/// Digits of a coefficient of a linear model.
const DIGITS: usize = 4;
/// Relative accuracy to which a number of the project reads back: a spool is at one side of null by
/// a hundred-millionth of its range.
const READS_BACK: f64 = 1e-9;

/// The value of a parameter; of a number of the project, such as `operating_point.velocity`, with
/// as many digits as it takes to read back as the same plant: its coefficients may jump there.
fn place_words(name: &str, value: f64, dimension: &'static Dimension) -> String {
    if !name.contains('.') {
        return display(value, dimension, DIGITS);
    }
    let is_same = |text: &String| {
        parse(text, dimension).is_ok_and(|read| (read - value).abs() <= READS_BACK * value.abs())
    };
    let mut texts = (DIGITS..=17).map(|digits| display(value, dimension, digits));
    texts.find(is_same).unwrap_or_else(|| display(value, dimension, DIGITS))
}
