use phea_hydraulics::line::{Hose, Stiffening, StiffeningMember};
use phea_hydraulics::stiffness::line_fraction_for_stiffness;

use super::{Candidate, HoseOption, SizingProblem};
use crate::quantity::DisplayUnit;

/// Effect of one uncertain number on stiffness and length as it varies from low to high, everything
/// else being nominal.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// Varied number.
    pub quantity: UncertainHoseNumber,
    /// Unit for display of its values.
    pub unit: DisplayUnit,
    /// Low, nominal and high value, SI.
    pub values: [f64; 3],
    /// Least stiffness over the stroke of the chosen length, N/m, at low, nominal and high.
    pub stiffness_n_per_m: [f64; 3],
    /// Length of line A for the nominal stiffness, m, at low, nominal and high; zero if none is
    /// needed.
    pub length_m: [f64; 3],
}

/// An uncertain number on which stiffness and length depend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UncertainHoseNumber {
    /// Dynamic stiffening r_beta of the wall.
    DynamicStiffening,
    /// Bulk modulus beta_0.
    FluidBulkModulus,
    /// Volumetric expansion E.
    VolumetricExpansion,
}

/// Relative variation of numbers for which no interval is stated.
const ASSUMED_SPREAD: f64 = 0.1;

/// Influence of dynamic stiffening (its interval), fluid bulk modulus and volumetric expansion
/// (plus and minus 10 %), of both hoses if they differ; the values are those of line A.
pub fn sensitivity(problem: &SizingProblem, candidate: &Candidate) -> Vec<Influence> {
    let option = &candidate.option;
    let hose = option.hoses[0];
    let Stiffening { nominal, minimum, maximum } = hose.dynamic_stiffening;
    let fractions = [1.0 - ASSUMED_SPREAD, 1.0, 1.0 + ASSUMED_SPREAD];
    let with = |vary: &dyn Fn(Hose) -> Hose| HoseOption { hoses: option.hoses.map(vary), ..option.clone() };
    let influence = |quantity: UncertainHoseNumber,
                     unit: DisplayUnit,
                     values: [f64; 3],
                     vary: &dyn Fn(usize) -> (SizingProblem, HoseOption)| {
        let outcomes = [0, 1, 2].map(|index| {
            let (varied, option) = vary(index);
            outcome(&varied, &option, candidate)
        });
        Influence {
            quantity,
            unit,
            values,
            stiffness_n_per_m: outcomes.map(|(stiffness, _)| stiffness),
            length_m: outcomes.map(|(_, length)| length),
        }
    };
    vec![
        influence(
            UncertainHoseNumber::DynamicStiffening,
            DisplayUnit::ONE,
            [minimum, nominal, maximum],
            &|index| {
                let vary = |hose: Hose| {
                    let Stiffening { nominal, minimum, maximum } = hose.dynamic_stiffening;
                    let value = [minimum, nominal, maximum][index];
                    Hose { dynamic_stiffening: Stiffening::certain(value), ..hose }
                };
                (problem.clone(), with(&vary))
            },
        ),
        influence(
            UncertainHoseNumber::FluidBulkModulus,
            DisplayUnit::GIGAPASCAL,
            fractions.map(|fraction| problem.fluid_modulus * fraction),
            &|index| {
                let fluid_modulus = problem.fluid_modulus * fractions[index];
                (SizingProblem { fluid_modulus, ..problem.clone() }, option.clone())
            },
        ),
        // The slope is proportional to the expansion: a hose that expands more does so at every
        // pressure.
        influence(
            UncertainHoseNumber::VolumetricExpansion,
            DisplayUnit::CUBIC_CENTIMETRE_PER_METRE,
            fractions.map(|fraction| hose.volumetric_expansion * fraction),
            &|index| (problem.clone(), with(&|hose| expanding(hose, fractions[index]))),
        ),
    ]
}

fn expanding(hose: Hose, fraction: f64) -> Hose {
    let [volumetric_expansion, operating_expansion, expansion_slope] =
        [hose.volumetric_expansion, hose.operating_expansion, hose.expansion_slope]
            .map(|each| each * fraction);
    Hose { volumetric_expansion, operating_expansion, expansion_slope, ..hose }
}

/// Least stiffness at the candidate's lengths, and the length of line A at which it has the nominal
/// stiffness.
fn outcome(problem: &SizingProblem, option: &HoseOption, candidate: &Candidate) -> (f64, f64) {
    let (model, lengths) = (candidate.branch.model, candidate.branch.lengths_m);
    let stiffness = problem.stroke_stiffness(option, lengths, model).minimum;
    let proportion = match candidate.branch.is_alike() {
        true => [1.0; 2],
        false => [1.0, lengths[1] / lengths[0]],
    };
    let [line_a, line_b] = option.lines(proportion);
    let length = line_fraction_for_stiffness(
        model,
        problem.fluid_modulus,
        &problem.cylinder,
        [&line_a, &line_b],
        StiffeningMember::Nominal,
        candidate.branch.stiffness.minimum,
    );
    (stiffness, length.metres())
}
