//! The names of the plants of a family.

use phea_qft::family::Family;
use phea_qft::verification::PlantPoint;

use crate::project::Project;
use crate::quantity::{Dimension, RATIO};

/// Names of the numbers of a plant.
#[derive(Clone, Debug)]
pub enum PlantNames {
    /// Uncertain parameters in the order of the plant, with their dimensions.
    Parameters(Vec<(String, &'static Dimension)>),
    /// Names of the measurements.
    Measured(Vec<String>),
}

/// One plant with its names: name and SI value of each number.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPlant(pub Vec<(String, NamedValue)>);

/// Value by which a plant is named.
#[derive(Clone, Debug, PartialEq)]
pub enum NamedValue {
    /// A parameter, SI, with its dimension.
    Number(f64, &'static Dimension),
    /// The name of a measurement.
    Measurement(String),
    /// A plant that was added to the family.
    Added,
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

    /// Names of the values of a plant, in their order.
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
            None => NamedPlant(vec![match (self, plant) {
                (_, PlantPoint::Additional(_)) => ("additional".to_string(), NamedValue::Added),
                (PlantNames::Measured(names), PlantPoint::Measured(index)) => {
                    let name = names.get(*index).cloned().unwrap_or_default();
                    ("measured".to_string(), NamedValue::Measurement(name))
                }
                _ => ("measured".to_string(), NamedValue::Measurement(String::new())),
            }]),
        }
    }
}
