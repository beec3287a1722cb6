//! Requirements in time of a project: of specifications of the kind `step`, and of limits of
//! tracking that are stated in time.

use super::StepLimits;
use crate::project::{DeclaredSpecification, Project};
use crate::specification::{SpecificationError, closed_loops, requirements_in_time};

/// A requirement in time of a specification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeRequirement {
    /// Number of its specification in the file, from 1.
    pub number: usize,
    /// Index of the specification among the limits on closed loops; `None` if it limits none.
    pub limits: Option<usize>,
    /// Requirement for every step.
    pub step_limits: StepLimits,
    /// True if the limits follow from the requirement: then it is part of the verdict. Stated
    /// limits are only compared with it.
    pub follows: bool,
    /// Step of the nonlinear rig to which the requirement applies.
    pub steps: RequiredSteps,
}

/// Step to which a requirement applies on the nonlinear rig.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RequiredSteps {
    /// Size, N, with its sign; `None`: a tenth of the force that the supply can produce.
    pub amplitude_n: Option<f64>,
    /// Force before the step, N; `None`: that of the operating point.
    pub initial_force_n: Option<f64>,
}

impl RequiredSteps {
    /// True if a step is stated.
    pub fn are_stated(&self) -> bool {
        *self != RequiredSteps::default()
    }
}

/// The requirements in time of a project, one for each specification that states any: those of
/// the kind `step` first, then those of limits of tracking.
///
/// # Errors
/// [`SpecificationError`] for a requirement in time without a limit, or a limit whose step response
/// has no end.
///
/// # Example
/// ```
/// use phea_project::source::Memory;
/// let text = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s\"\n\
///             [[specification]]\nkind = \"step\"\novershoot_percent = 2\nsettling_time = \"0.25 s\"\n";
/// let source = Memory::default().with("servo.toml", text);
/// let project = phea_project::read(&source, "servo.toml", &[], &[])?.project;
/// let [required] = phea_engineering::simulate::time_requirements(&project)?[..] else { panic!() };
/// assert_eq!((required.step_limits.overshoot_percent, required.step_limits.settling_time_s), (Some(2.0), Some(0.25)));
/// assert_eq!(required.step_limits.band_percent, 2.0); // where no band is stated
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn time_requirements(project: &Project) -> Result<Vec<TimeRequirement>, SpecificationError> {
    let steps = project.specifications.iter().enumerate().filter(|(_, one)| one.closed_loop().is_none());
    let of_step = |(index, declared): (usize, &DeclaredSpecification)| {
        let DeclaredSpecification { step, .. } = declared;
        TimeRequirement {
            number: index + 1,
            limits: None,
            step_limits: StepLimits::of_step(step),
            follows: true,
            steps: RequiredSteps { amplitude_n: step.amplitude, initial_force_n: step.initial_force },
        }
    };
    let requirements_in_time = requirements_in_time(project)?;
    let of_limits = |(limits, (number, ..)): (usize, (usize, _, _))| {
        let step_limits = StepLimits::of_specification(&requirements_in_time, number)?;
        let mut own = requirements_in_time.iter().filter(|step_limits| step_limits.number == number);
        let follows = own.all(|step_limits| step_limits.follows);
        Some(TimeRequirement {
            number,
            limits: Some(limits),
            step_limits,
            follows,
            steps: RequiredSteps::default(),
        })
    };
    let tracking = closed_loops(project).enumerate().filter_map(of_limits);
    Ok(steps.map(of_step).chain(tracking).collect())
}
