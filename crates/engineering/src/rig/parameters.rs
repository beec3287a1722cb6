use phea_hydraulics::linear::LinearParameters;

use crate::project::{LINEAR_PARAMETERS, Project};

/// The origin of the value of a parameter of the linear model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterOrigin {
    /// Set outright in `[linear]`.
    Linear,
    /// The nominal value in `[uncertainty]`.
    Uncertainty,
    /// It follows from the rig.
    Derived,
}

/// A parameter of the linear model: its derived value and the value in use, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedParameter {
    /// Its key in `[linear]` and `[uncertainty]`.
    pub name: &'static str,
    /// The value that holds.
    pub value: f64,
    /// Who decided it.
    pub origin: ParameterOrigin,
    /// What follows from the rig.
    pub derived: f64,
    /// Its bounds, where `[uncertainty]` states them.
    pub bounds: Option<[f64; 2]>,
}

/// The only place that assigns the fields of the linear model to keys.
pub(super) fn parameter_field<'a, S>(
    parameters: &'a mut LinearParameters<S>,
    name: &str,
) -> Option<&'a mut S> {
    match name {
        "viscous_friction" => Some(&mut parameters.viscous_friction),
        "flow_gain" => Some(&mut parameters.flow_gain),
        "flow_pressure_coefficient" => Some(&mut parameters.flow_pressure_coefficient),
        "hydraulic_stiffness" => Some(&mut parameters.hydraulic_stiffness),
        "valve_natural_frequency" => Some(&mut parameters.valve_natural_frequency),
        "valve_damping_ratio" => Some(&mut parameters.valve_damping_ratio),
        "moving_mass" => Some(&mut parameters.moving_mass),
        "piston_area" => Some(&mut parameters.useful_area),
        "sensor_stiffness" => Some(&mut parameters.sensor_stiffness),
        _ => None,
    }
}

/// These parameters with the stated ones in their place, in order.
pub(super) fn replaced<'n, S: Copy>(
    derived: &LinearParameters<S>,
    stated: impl Iterator<Item = (&'n str, S)>,
) -> LinearParameters<S> {
    let mut linear = *derived;
    for (name, value) in stated {
        if let Some(slot) = parameter_field(&mut linear, name) {
            *slot = value;
        }
    }
    linear
}

/// The value of a parameter that the project states, and where.
fn stated_value(project: &Project, name: &str) -> Option<(f64, ParameterOrigin)> {
    let linear = project.linear.get(name).map(|value| (value, ParameterOrigin::Linear));
    let uncertain = project.uncertainty.iter().find(|uncertain| uncertain.name == name);
    linear.or_else(|| uncertain.map(|uncertain| (uncertain.nominal, ParameterOrigin::Uncertainty)))
}

/// The parameters of the linear model that the project states: name and value.
pub(crate) fn stated(project: &Project) -> impl Iterator<Item = (&'static str, f64)> {
    let names = LINEAR_PARAMETERS.iter().map(|parameter| parameter.key.name);
    names.filter_map(|name| stated_value(project, name).map(|(value, _)| (name, value)))
}

pub(super) fn resolve(project: &Project, derived: &LinearParameters) -> Vec<ResolvedParameter> {
    LINEAR_PARAMETERS
        .iter()
        .filter_map(|parameter| {
            let name = parameter.key.name;
            let derived = *parameter_field(&mut derived.clone(), name)?;
            let stated = stated_value(project, name);
            let (value, origin) = stated.unwrap_or((derived, ParameterOrigin::Derived));
            let uncertain = project.uncertainty.iter().find(|uncertain| uncertain.name == name);
            let bounds = uncertain.map(|uncertain| [uncertain.minimum, uncertain.maximum]);
            Some(ResolvedParameter { name, value, origin, derived, bounds })
        })
        .collect()
}
