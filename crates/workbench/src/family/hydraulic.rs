//! The uncertain plant of an actuator: the fifth-order model, thesis (6.7), over parameters of the linear model and over
//! physical numbers that reach it by a formula.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, UncertainParameter, UncertainPlant};
use phea_hydraulics::linear::linear_model_coefficients;
use phea_hydraulics::two_pressure::reduce;

use super::FamilyError;
use super::machine::Machine;
use crate::project::{LINEAR_PARAMETERS, Project};
use crate::rig::{ParameterOrigin, Rig, parameter_field};

/// Records the model with the uncertain numbers open and all others at the values that hold.
pub(super) fn uncertain_plant(
    project: &Project,
    rig: &Rig,
    parameters: Vec<UncertainParameter>,
) -> Result<UncertainPlant, FamilyError> {
    let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
    // A trial with numbers finds every path without a formula before the recording, which cannot fail, begins.
    let mut trial = Machine::new(project, rig);
    for name in names.iter().filter(|name| !is_linear(name)) {
        if !trial.set(name, 1.0) {
            return Err(FamilyError::Path { path: name.clone(), reason: reason(name) });
        }
    }
    Ok(UncertainPlant::record(parameters, |values| coefficients(project, rig, &names, values))?)
}

/// Physical numbers first; what `[linear]` and `[uncertainty]` state of the linear model goes before what follows from them.
fn coefficients<S: Scalar>(
    project: &Project,
    rig: &Rig,
    names: &[String],
    values: &[S],
) -> PlantCoefficients<S> {
    let mut machine = Machine::new(project, rig).map();
    for (name, value) in names.iter().zip(values).filter(|(name, _)| !is_linear(name)) {
        machine.set(name, *value);
    }
    let mut linear = reduce(&machine.linear_parameters(rig));
    for parameter in rig.parameters.iter().filter(|one| one.origin != ParameterOrigin::Derived) {
        if let Some(slot) = parameter_field(&mut linear, parameter.name) {
            *slot = S::from(parameter.value);
        }
    }
    for (name, value) in names.iter().zip(values).filter(|(name, _)| is_linear(name)) {
        if let Some(slot) = parameter_field(&mut linear, name) {
            *slot = *value;
        }
    }
    linear_model_coefficients(&linear)
}

fn is_linear(name: &str) -> bool {
    LINEAR_PARAMETERS.iter().any(|parameter| parameter.key.name == name)
}

/// Why no formula carries a path into the linear model, and what to use instead.
fn reason(path: &str) -> String {
    let reached = LINEAR_PARAMETERS.iter().filter(|parameter| parameter.follows_from(path));
    let names: Vec<String> = reached.map(|parameter| format!("`{}`", parameter.key.name)).collect();
    let instead = format!("give a range to {} instead", names.join(", "));
    match names.is_empty() {
        true => "it does not enter the linear model".to_string(),
        false if path.starts_with("supply.") || path.starts_with("valve.") => {
            format!("it moves the operating point, whose pressures follow from no formula: {instead}")
        }
        false => format!("no formula carries it into the linear model: {instead}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project;
    use crate::source::Memory;

    fn loaded(text: &str) -> Project {
        let source = Memory::default().with("p.toml", text);
        project::read(&source, "p.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}")).project
    }

    const HOSE: &str = include_str!("../../../../examples/ybitu/hose.toml");

    fn recorded(project: &Project) -> Result<UncertainPlant, FamilyError> {
        let rig = Rig::new(project).unwrap();
        uncertain_plant(project, &rig, crate::family::uncertain::parameters(project))
    }

    /// Values within the ranges: multiples of the golden ratio fill the unit interval evenly.
    fn points(plant: &UncertainPlant) -> Vec<Vec<f64>> {
        let mut share = 0.0_f64;
        let mut value = |parameter: &UncertainParameter| {
            share = (share + 0.618_033_988_75).fract();
            parameter.minimum + share * (parameter.maximum - parameter.minimum)
        };
        (0..50).map(|_| plant.parameters().iter().map(&mut value).collect()).collect()
    }

    /// The recorded coefficients are those of the equations run with numbers, inside the box and at its corners.
    #[test]
    fn the_recorded_rig_is_the_linear_model() {
        let project = loaded(HOSE);
        let plant = recorded(&project).unwrap();
        let rig = Rig::new(&project).unwrap();
        assert_eq!(plant.coefficients(&plant.nominal()), linear_model_coefficients(&rig.linear));
        for values in points(&plant) {
            let mut linear = rig.linear;
            for (parameter, value) in plant.parameters().iter().zip(&values) {
                *parameter_field(&mut linear, &parameter.name).unwrap() = *value;
            }
            assert_eq!(plant.coefficients(&values), linear_model_coefficients(&linear));
        }
    }

    /// A project whose `[linear]` and `[uncertainty]` are replaced.
    fn with_uncertain(text: &str, ranges: &[(&str, [f64; 3])]) -> String {
        let start = text.find("[uncertainty]").unwrap();
        let end = text.find("[[specification]]").unwrap_or(text.len());
        let lines: String = ranges
            .iter()
            .map(|(name, [low, nominal, high])| {
                format!("\"{name}\" = {{ nominal = {nominal:e}, minimum = {low:e}, maximum = {high:e} }}\n")
            })
            .collect();
        format!("{}[uncertainty]\n{lines}{}", &text[..start], &text[end..])
    }

    /// Every path, recorded, gives what the whole rig gives when the project itself states the number.
    #[track_caller]
    fn follows_the_rig(text: &str, ranges: &[(&str, [f64; 3])]) {
        let project = loaded(&with_uncertain(text, ranges));
        let plant = recorded(&project).unwrap();
        for values in points(&plant) {
            let mut stated = project.clone();
            stated.uncertainty.clear();
            for (parameter, value) in plant.parameters().iter().zip(&values) {
                stated = stated.with_number(&parameter.name, *value).unwrap();
            }
            let expected = linear_model_coefficients(&Rig::new(&stated).unwrap().linear);
            let found = plant.coefficients(&values);
            let [found, expected] = [found, expected].map(|member| {
                let disturbance = member.disturbance.unwrap();
                [member.command.numerator, member.command.denominator, disturbance.numerator].concat()
            });
            for (one, other) in found.iter().zip(&expected) {
                assert!((one - other).abs() <= 1e-12 * other.abs(), "{values:?}: {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn physical_paths_reach_the_model_as_through_the_rig() {
        follows_the_rig(
            HOSE,
            &[
                ("cylinder.moving_mass", [10.0, 13.1, 20.0]),
                ("cylinder.friction.viscous", [50.0, 100.0, 3e4]),
                ("cylinder.piston_diameter", [0.049, 0.05, 0.052]),
                ("cylinder.rod_diameter", [0.02, 0.022, 0.024]),
                ("cylinder.stroke", [0.3, 0.5, 0.6]),
                ("force_sensor.stiffness", [1e7, 2e7, 1e8]),
                ("valve.natural_frequency", [879.0, 1099.0, 1319.0]),
                ("valve.damping_ratio", [0.7, 0.9, 1.1]),
                ("fluid.bulk_modulus", [1e9, 1.45e9, 1.6e9]),
                ("line.length", [0.5, 1.5, 3.0]),
                ("line.bore", [0.01, 0.0127, 0.0159]),
                ("line.dynamic_stiffening.nominal", [4.0, 5.0, 5.0]),
            ],
        );
        let asymmetric = include_str!("../../tests/project_valid/asymmetric.toml");
        let free = asymmetric.replace("hydraulic_stiffness =", "# ").replace("flow_gain = \"3.4", "# \"");
        follows_the_rig(
            &free,
            &[
                ("fluid.entrained_air", [0.0, 0.005, 0.02]),
                ("fluid.polytropic_exponent", [1.0, 1.0, 1.4]),
                ("line.a.length", [0.5, 1.2, 1.5]),
                ("line.b.length", [0.3, 0.4, 0.5]),
                ("line.b.pipe.bore", [0.008, 0.01, 0.012]),
                ("line.b.pipe.wall_thickness", [0.001, 0.002, 0.003]),
                ("line.b.pipe.youngs_modulus", [7e10, 2.06e11, 2.1e11]),
                ("line.a.dynamic_stiffening", [1.0, 4.5, 5.0]),
            ],
        );
        let volumes = include_str!("../../tests/project_valid/volumes.toml");
        let free = volumes.replace("piston_area = \"15.83 cm2\"\n", "");
        follows_the_rig(
            &free,
            &[
                ("cylinder.piston_area", [1e-3, 1.583e-3, 2e-3]),
                ("cylinder.dead_volume", [0.0, 0.0, 1e-4]),
                ("line.volume", [1e-4, 1.9e-4, 2e-4]),
                ("line.effective_bulk_modulus", [2e8, 2.6e8, 3e8]),
            ],
        );
    }

    // ORIGIN: written by hand, the numbers are those of examples/ybitu/hose.toml
    #[test]
    fn a_path_without_a_formula_is_refused_with_what_to_use_instead() {
        let refused = |path: &str, value: f64| {
            let text = with_uncertain(HOSE, &[(path, [0.9 * value, value, 1.1 * value])]);
            recorded(&loaded(&text)).unwrap_err().to_string()
        };
        assert_eq!(
            refused("supply.pressure", 70e5),
            "[uncertainty] `supply.pressure`: it moves the operating point, whose pressures follow from no formula: \
             give a range to `flow_gain`, `flow_pressure_coefficient`, `hydraulic_stiffness` instead"
        );
        assert_eq!(
            refused("fluid.density", 870.0),
            "[uncertainty] `fluid.density`: it does not enter the linear model"
        );
        assert_eq!(
            refused("line.volumetric_expansion_slope", 2.236e-12),
            "[uncertainty] `line.volumetric_expansion_slope`: no formula carries it into the linear model: \
             give a range to `hydraulic_stiffness` instead"
        );
    }
}
