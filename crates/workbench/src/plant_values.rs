//! Plants of a family as plain values: their factors, parameters and responses.

use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_dynamics::uncertain_plant::{PlantMember, RationalCoefficients};
use phea_engineering::robust::RobustProblem;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::{Family, MeasuredPlant};

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

    pub(crate) fn of_coefficients(
        coefficients: &RationalCoefficients<f64>,
        dead_time_s: f64,
    ) -> Result<Factors, LinearError> {
        Ok(Factors { dead_time_s, ..Factors::of(&coefficients.transfer_function()?) })
    }
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

impl FamilyValues {
    pub(crate) fn of(problem: &RobustProblem) -> FamilyValues {
        let compensation = problem.has_controller.then(|| problem.compensation.clone());
        FamilyValues { family: problem.family.clone(), compensation }
    }

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
