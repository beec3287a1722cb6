//! From a project to the family of plants that robust design works on.

mod measured;
mod uncertain;

use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant, UncertainPlantError,
};
use phea_hydraulics::linear::{LinearParameters, linear_model_coefficients};
use phea_qft::family::{Family, MeasurementError};

use crate::project::{
    Delay, FormulaError, LINEAR_PARAMETERS, Plant, Project, Rational, Report, SpecificationKind,
};
use crate::rig::{Rig, RigError, parameter_field};
use crate::source::Source;

/// Why a project has no uncertain plant.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FamilyError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The box is empty or its coefficients are.
    #[error("[uncertainty]: {0}")]
    Plant(#[from] UncertainPlantError),
    /// The members are no plants of the box.
    #[error("[uncertainty]: {0}")]
    Members(#[from] phea_qft::family::FamilyError),
    /// A dead time that is negative, or no number, at a member.
    #[error("[plant] `delay` is {delay_s} s at {member}")]
    Delay {
        /// What the formula gives, s.
        delay_s: f64,
        /// The member's parameters with their values.
        member: String,
    },
    /// Files of measured responses that cannot be taken as they are, with every place.
    #[error("{0}")]
    Measurement(Box<Report>),
    /// Measured responses that are no family.
    #[error("[family] `measured`: {0}")]
    Measured(#[from] MeasurementError),
    /// A limit on load motion, and a measured plant without that path.
    #[error("\"load_motion\" needs the columns `load_motion_...`, which {0} lacks")]
    LoadMotion(String),
    /// The plant's text is no ratio of polynomials.
    #[error("[plant]: {message}", message = .0.message)]
    Formula(FormulaError),
    /// An uncertain path that is no parameter of the linear model: it would have to be carried through the whole rig.
    #[error("[uncertainty] `{0}`: only the parameters of the linear model span an uncertain plant")]
    Path(String),
}

/// The family of a project: the linear model of its actuator, or the transfer function it states, over the box of
/// `[uncertainty]`; or the plants that were measured.
///
/// `[family]` says which plants of the box are looked at: its `grid`, its `vertices`, points at `random`, explicit `cases`, or several
/// of them together; the grid where it says nothing. Where the `cases` stand alone nothing between them belongs to the family.
///
/// # Errors
/// [`FamilyError`] if there is no rig, an uncertain name is no parameter of the plant, or a member lies outside of the box.
///
/// # Example
/// ```
/// use phea_qft::family::{Family, MeasurementError};
/// use phea_workbench::source::Memory;
/// let text = "schema = 1\n[plant]\nnumerator = \"k\"\ndenominator = \"s\"\n\
///             [uncertainty]\nk = { nominal = 2, minimum = 1, maximum = 4, points = 3, spacing = \"log\" }\n";
/// let source = Memory::default().with("servo.toml", text);
/// let project = phea_workbench::project::read(&source, "servo.toml", &[], &[])?.project;
/// let Family::Uncertain(family) = phea_workbench::family::family(&project, &source)? else { panic!("a box") };
/// let gains: Vec<f64> = family.members().iter().map(|values| values[0].round()).collect();
/// assert_eq!(gains, [2.0, 1.0, 4.0]); // the nominal plant first, then what else is on the grid
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn family(project: &Project, source: &dyn Source) -> Result<Family, FamilyError> {
    let family = match &project.family {
        Some(declared) if !declared.measured.is_empty() => {
            Family::Measured(measured::family(project, declared, source)?)
        }
        _ => Family::Uncertain(uncertain::family(project, uncertain_plant(project)?)?),
    };
    check_second_path(project, &family)?;
    Ok(family)
}

/// A limit on load motion needs a path from it.
fn check_second_path(project: &Project, family: &Family) -> Result<(), FamilyError> {
    let wanted = project.specifications.iter().any(|one| one.kind == SpecificationKind::LoadMotion);
    match family {
        Family::Measured(family) if wanted => {
            let without = family.plants().iter().find(|plant| plant.disturbance.is_none());
            without.map_or(Ok(()), |plant| Err(FamilyError::LoadMotion(plant.name.clone())))
        }
        _ => Ok(()),
    }
}

/// The plant over the box of its uncertain parameters.
fn uncertain_plant(project: &Project) -> Result<UncertainPlant, FamilyError> {
    let parameters = uncertain::parameters(project);
    match &project.plant {
        Some(plant) => from_formula(plant, parameters),
        None => from_rig(&Rig::new(project)?, parameters),
    }
}

/// The fifth-order model, thesis (6.7), with the uncertain parameters open and all others at the values that hold.
fn from_rig(rig: &Rig, parameters: Vec<UncertainParameter>) -> Result<UncertainPlant, FamilyError> {
    let known = |name: &str| LINEAR_PARAMETERS.iter().any(|parameter| parameter.key.name == name);
    if let Some(path) = parameters.iter().find(|parameter| !known(&parameter.name)) {
        return Err(FamilyError::Path(path.name.clone()));
    }
    let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
    Ok(UncertainPlant::record(parameters, |values| {
        let mut linear = lifted(&rig.linear);
        for (name, value) in names.iter().zip(values) {
            if let Some(slot) = parameter_field(&mut linear, name) {
                *slot = *value;
            }
        }
        linear_model_coefficients(&linear)
    })?)
}

/// The same numbers as constants of another scalar.
fn lifted<S: Scalar>(linear: &LinearParameters) -> LinearParameters<S> {
    LinearParameters {
        useful_area: S::from(linear.useful_area),
        moving_mass: S::from(linear.moving_mass),
        viscous_friction: S::from(linear.viscous_friction),
        flow_gain: S::from(linear.flow_gain),
        flow_pressure_coefficient: S::from(linear.flow_pressure_coefficient),
        hydraulic_stiffness: S::from(linear.hydraulic_stiffness),
        sensor_stiffness: S::from(linear.sensor_stiffness),
        valve_natural_frequency: S::from(linear.valve_natural_frequency),
        valve_damping_ratio: S::from(linear.valve_damping_ratio),
    }
}

fn from_formula(plant: &Plant, parameters: Vec<UncertainParameter>) -> Result<UncertainPlant, FamilyError> {
    let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
    // A trial with numbers finds every error of the text before the recording, which cannot fail, begins.
    let nominal: Vec<f64> = parameters.iter().map(|parameter| parameter.nominal).collect();
    coefficients(plant, &names, &nominal).map_err(FamilyError::Formula)?;
    Ok(UncertainPlant::record(parameters, |values| {
        coefficients(plant, &names, values).unwrap_or_else(|_| PlantCoefficients {
            command: RationalCoefficients { numerator: vec![], denominator: vec![] },
            disturbance: None,
            dead_time_s: 0.0.into(),
        })
    })?)
}

fn coefficients<S: Scalar>(
    plant: &Plant,
    names: &[String],
    values: &[S],
) -> Result<PlantCoefficients<S>, FormulaError> {
    let value = |name: &str| {
        names.iter().position(|known| known == name).and_then(|index| values.get(index)).copied()
    };
    let rational = |text: &Rational| {
        let (upper, lower) = (text.numerator.ratio(&value)?, text.denominator.ratio(&value)?);
        Ok(RationalCoefficients {
            numerator: product(&upper.numerator, &lower.denominator),
            denominator: product(&upper.denominator, &lower.numerator),
        })
    };
    Ok(PlantCoefficients {
        command: rational(&plant.transfer)?,
        disturbance: plant.disturbance.as_ref().map(rational).transpose()?,
        dead_time_s: match &plant.delay {
            Delay::Constant(seconds) => S::from(*seconds),
            Delay::Formula(formula) => {
                formula.ratio(&value)?.numerator.first().copied().unwrap_or(S::from(0.0))
            }
        },
    })
}

/// Product of two polynomials, highest power first.
fn product<S: Scalar>(one: &[S], other: &[S]) -> Vec<S> {
    let mut sum = vec![S::from(0.0); (one.len() + other.len()).saturating_sub(1)];
    for (index, a) in one.iter().enumerate() {
        for (slot, b) in sum.iter_mut().skip(index).zip(other) {
            *slot = *slot + *a * *b;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project;
    use crate::source::Memory;

    fn loaded(text: &str) -> Project {
        project::read(&Memory::default().with("p.toml", text), "p.toml", &[], &[]).unwrap().project
    }

    /// The recorded coefficients are those of the equations run with numbers, inside the box and at its corners.
    #[test]
    fn the_recorded_rig_is_the_linear_model() {
        let project = loaded(include_str!("../../../examples/ybitu/hose.toml"));
        let plant = uncertain_plant(&project).unwrap();
        let rig = Rig::new(&project).unwrap();
        assert_eq!(plant.coefficients(&plant.nominal()), linear_model_coefficients(&rig.linear));
        let mut share = 0.0_f64;
        for _ in 0..50 {
            let values: Vec<f64> = plant
                .parameters()
                .iter()
                .map(|parameter| {
                    // Multiples of the golden ratio fill the unit interval evenly.
                    share = (share + 0.618_033_988_75).fract();
                    parameter.minimum + share * (parameter.maximum - parameter.minimum)
                })
                .collect();
            let mut linear = rig.linear;
            for (parameter, value) in plant.parameters().iter().zip(&values) {
                *parameter_field(&mut linear, &parameter.name).unwrap() = *value;
            }
            assert_eq!(plant.coefficients(&values), linear_model_coefficients(&linear));
        }
    }

    #[test]
    fn a_formula_becomes_the_plant_it_states() {
        let project = loaded(
            "schema = 1\ntitle = \"servo\"\n[plant]\nnumerator = \"k*a/2\"\ndenominator = \"s*(s + a)\"\ndelay = \"10 ms\"\n\
             [uncertainty]\nk = { nominal = 1, minimum = 1, maximum = 10 }\na = { nominal = 1, minimum = 1, maximum = 10 }\n",
        );
        let plant = uncertain_plant(&project).unwrap();
        let member = plant.coefficients(&[3.0, 4.0]);
        assert_eq!(member.dead_time_s, 0.01);
        // P = 12/(2 s^2 + 8 s) = 6/(s (s + 4)); at j2: 6/(2 sqrt(20)) in magnitude
        let magnitude = member.command.at_frequency(2.0).norm_sqr();
        assert!((magnitude - 36.0 / 80.0).abs() < 1e-14, "{magnitude}");
    }

    #[test]
    fn an_uncertain_path_is_refused_by_name() {
        let text = include_str!("../../../examples/ybitu/hose.toml");
        let project =
            loaded(&text.replace("viscous_friction          =", "\"cylinder.moving_mass\" =").replace(
                "\"100 N.s/m\", minimum = \"100 N.s/m\", maximum = \"3e4 N.s/m\"",
                "13, minimum = 12, maximum = 14",
            ));
        assert_eq!(uncertain_plant(&project), Err(FamilyError::Path("cylinder.moving_mass".to_string())));
    }
}
