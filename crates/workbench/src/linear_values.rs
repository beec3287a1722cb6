//! The linear values of a project as plain numbers, for applications that hand them on: transfer
//! functions by their factors, and the plants of the family.

use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_dynamics::uncertain_plant::{PlantMember, RationalCoefficients};
use phea_engineering::setup::Setup;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::{Family, MeasuredPlant};

use crate::command::{self, CommandError, Watch};
use crate::project::Loaded;
use crate::source::Source;

/// Transfer function by its factors, with dead time T.
///
/// ```text
/// gain (s - z_1)(s - z_2).../((s - p_1)(s - p_2)...) e^(-s T)
/// ```
///
/// A transfer function in z has a sample time and no dead time.
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    /// Leading coefficient.
    pub gain: f64,
    /// Zeros, as real and imaginary parts.
    pub zeros: Vec<[f64; 2]>,
    /// Poles, as real and imaginary parts.
    pub poles: Vec<[f64; 2]>,
    /// Dead time, s.
    pub dead_time_s: f64,
    /// Sample time, s; `None` for a transfer function in s.
    pub sample_time_s: Option<f64>,
}

impl Factors {
    pub(crate) fn of(function: &TransferFunction) -> Factors {
        let pairs = |roots: &[num_complex::Complex64]| roots.iter().map(|root| [root.re, root.im]).collect();
        Factors {
            gain: function.gain(),
            zeros: pairs(function.zeros()),
            poles: pairs(function.poles()),
            dead_time_s: function.dead_time_s(),
            sample_time_s: match function.domain() {
                TimeDomain::Continuous => None,
                TimeDomain::Discrete { sample_time_s } => Some(sample_time_s),
            },
        }
    }

    fn of_coefficients(
        coefficients: &RationalCoefficients<f64>,
        dead_time_s: f64,
    ) -> Result<Factors, LinearError> {
        Ok(Factors { dead_time_s, ..Factors::of(&coefficients.transfer_function()?) })
    }
}

/// Transfer functions that a project declares or that follow from its rig, by their names: `plant`
/// from the command to the force and `load_position` from the position of the load to the force,
/// of a rig with lumped lines; `controller`, `prefilter`, and of a sampled loop both in z as
/// deployed; `sensor`.
///
/// # Errors
/// [`CommandError`] for a controller that is not a transfer function, or a rig that cannot be
/// computed.
///
/// # Example
/// ```
/// use phea_workbench::linear_values::transfer_functions;
/// use phea_workbench::project;
/// use phea_workbench::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let found = transfer_functions(&loaded)?;
/// let names: Vec<_> = found.iter().map(|(name, _)| *name).collect();
/// assert_eq!(names, ["plant", "load_position", "controller", "prefilter", "sensor"]);
/// assert_eq!((found[0].1.poles.len(), found[2].1.gain), (5, 0.001));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn transfer_functions(loaded: &Loaded) -> Result<Vec<(&'static str, Factors)>, CommandError> {
    let setup = Setup::new(&loaded.project)?;
    let mut found = Vec::new();
    if loaded.project.actuator.is_some() {
        let plant = setup.rig()?.plant.coefficients();
        found.push(("plant", Factors::of_coefficients(&plant.command, plant.dead_time_s)?));
        if let Some(disturbance) = &plant.disturbance {
            found.push(("load_position", Factors::of_coefficients(disturbance, 0.0)?));
        }
    }
    if let Some(controller) = &setup.controller {
        found.push(("controller", Factors::of(&controller.feedback.transfer_function()?)));
    }
    if let Some(prefilter) = &setup.prefilter {
        found.push(("prefilter", Factors::of(&prefilter.transfer_function()?)));
    }
    if let (Some(controller), Some(_)) = (&setup.controller, setup.timing.sample_time_s) {
        let deployed = setup.compensation(controller)?;
        found.push(("deployed_controller", Factors::of(deployed.feedback())));
        if setup.prefilter.is_some() {
            found.push(("deployed_prefilter", Factors::of(deployed.prefilter())));
        }
    }
    found.push(("sensor", Factors::of(&setup.sensor)));
    Ok(found)
}

/// Family of plants: its parameters, and its members by their values.
#[derive(Clone, Debug)]
pub struct FamilyValues {
    family: Family,
    /// Loop around the plants; `None` without a controller.
    compensation: Option<Compensation>,
}

/// Parts of a loop around one plant, in s, or in z if the loop is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopFactors {
    /// Controller G as deployed.
    pub controller: Factors,
    /// Prefilter F as a step of the reference passes through it.
    pub prefilter: Factors,
    /// Plant P with the delay of the loop, behind the hold of a sampled loop.
    pub plant: Factors,
    /// P H, likewise.
    pub plant_and_sensor: Factors,
}

/// Measured plant from the command to the force.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredValues {
    /// Name of the plant.
    pub name: String,
    /// Frequencies, rad/s.
    pub frequencies_rad_per_s: Vec<f64>,
    /// Response at each frequency, as real and imaginary part.
    pub responses: Vec<[f64; 2]>,
}

/// Family of a project, with the valve identified from its recordings if the project requires that.
///
/// # Errors
/// [`CommandError`] for a project without a family.
///
/// # Example
/// ```
/// use phea_workbench::linear_values::family_values;
/// use phea_workbench::project;
/// use phea_workbench::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let family = family_values(&source, &loaded, &mut |_| true)?;
/// let nominal = &family.members()[0];
/// assert_eq!(family.parameters().len(), nominal.len());
/// let plant = family.member(nominal).ok_or("a rational plant")?;
/// let [real, imaginary] = family.response(nominal, 1.0).ok_or("a response")?;
/// assert_eq!(plant.poles.len(), 5);
/// assert!(real.is_finite() && imaginary < 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn family_values(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<FamilyValues, CommandError> {
    let problem = command::robust_problem_of(source, loaded, watch)?;
    let compensation = problem.has_controller.then_some(problem.compensation);
    Ok(FamilyValues { family: problem.family, compensation })
}

impl FamilyValues {
    /// Names of the parameters; empty for measured plants.
    pub fn parameters(&self) -> Vec<&str> {
        match &self.family {
            Family::Uncertain(family) => {
                family.plant().parameters().iter().map(|one| one.name.as_str()).collect()
            }
            Family::Measured(_) => vec![],
        }
    }

    /// Values of the parameters of each member, SI, in the order of [`FamilyValues::parameters`];
    /// the nominal plant is the first. Empty lists for measured plants.
    pub fn members(&self) -> Vec<Vec<f64>> {
        match &self.family {
            Family::Uncertain(family) => family.members().to_vec(),
            Family::Measured(family) => vec![vec![]; family.plants().len()],
        }
    }

    /// Plant with these values, from the command to the force; `None` without polynomials.
    pub fn member(&self, values: &[f64]) -> Option<Factors> {
        let Family::Uncertain(family) = &self.family else { return None };
        match family.plant().member(values)? {
            PlantMember::Rational(plant) => Factors::of_coefficients(&plant.command, plant.dead_time_s).ok(),
            PlantMember::Responding(_) => None,
        }
    }

    /// Parts of the loop around the plant with these values; `None` without a controller, or
    /// without polynomials. Feed-forward and inner feedback are not among them.
    pub fn in_loop(&self, values: &[f64]) -> Option<LoopFactors> {
        let compensation = self.compensation.as_ref()?;
        let Family::Uncertain(family) = &self.family else { return None };
        let [plant, with_sensor] = match compensation.member_of(family.plant(), values).ok()? {
            Member::Continuous { plant, sensor, .. } => {
                let path = plant.command.transfer_function().ok()?.with_dead_time(plant.dead_time_s).ok()?;
                [path.clone(), path.series(&sensor).ok()?]
            }
            Member::Sampled { command, with_sensor, .. } => [command, with_sensor],
            _ => return None,
        };
        Some(LoopFactors {
            controller: Factors::of(compensation.feedback()),
            prefilter: Factors::of(&compensation.prefilter_of_step().ok()?),
            plant: Factors::of(&plant),
            plant_and_sensor: Factors::of(&with_sensor),
        })
    }

    /// Response from the command to the force of the plant with these values, at a frequency in
    /// rad/s, as real and imaginary part; `None` if there is no such plant.
    pub fn response(&self, values: &[f64], frequency: f64) -> Option<[f64; 2]> {
        let Family::Uncertain(family) = &self.family else { return None };
        family.plant().response(values, frequency).map(|found| [found.re, found.im])
    }

    /// Measured plants; empty for any other family.
    pub fn measured(&self) -> Vec<MeasuredValues> {
        let Family::Measured(family) = &self.family else { return vec![] };
        let values = |plant: &MeasuredPlant| MeasuredValues {
            name: plant.name.clone(),
            frequencies_rad_per_s: plant.frequencies_rad_per_s.clone(),
            responses: plant.command.iter().map(|value| [value.re, value.im]).collect(),
        };
        family.plants().iter().map(values).collect()
    }
}
