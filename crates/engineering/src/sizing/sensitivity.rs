use phea_hydraulics::line::{Hose, Line, Stiffening, StiffeningMember};
use phea_hydraulics::stiffness::{LineLength, line_length_for_stiffness};

use super::{Candidate, SizingProblem};
use crate::quantity::DisplayUnit;

/// The effect of one uncertain number on stiffness and length as it goes from low to high,
/// everything else being nominal.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// What is varied, in words.
    pub quantity: &'static str,
    /// The unit in which people read its values.
    pub unit: DisplayUnit,
    /// Its low, nominal and high value in SI.
    pub values: [f64; 3],
    /// Least stiffness over the stroke of the chosen length, N/m, at low, nominal and high.
    pub stiffness_n_per_m: [f64; 3],
    /// Length that keeps the nominal stiffness, m, at low, nominal and high; zero where none is
    /// needed.
    pub length_m: [f64; 3],
}

impl Influence {
    /// Low, nominal and high, with their unit.
    pub fn setting_words(&self) -> String {
        self.unit.with_symbol(self.values.map(|value| self.unit.number(value, 4)).join(" · "))
    }
}

/// Relative variation of numbers for which no interval is stated.
const ASSUMED_SPREAD: f64 = 0.1;

/// Influence of dynamic stiffening (its interval), fluid bulk modulus and volumetric expansion
/// (plus and minus 10 %).
pub fn sensitivity(problem: &SizingProblem, candidate: &Candidate) -> Vec<Influence> {
    let hose = candidate.option.hose;
    let Stiffening { nominal, minimum, maximum } = hose.dynamic_stiffening;
    let around = |value: f64| [value * (1.0 - ASSUMED_SPREAD), value, value * (1.0 + ASSUMED_SPREAD)];
    let influence = |quantity: &'static str,
                     unit: DisplayUnit,
                     values: [f64; 3],
                     vary: &dyn Fn(f64) -> (SizingProblem, Hose)| {
        let outcomes = values.map(|value| {
            let (varied, hose) = vary(value);
            outcome(&varied, hose, candidate)
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
        influence("dynamic stiffening r_β", DisplayUnit::ONE, [minimum, nominal, maximum], &|value| {
            (problem.clone(), Hose { dynamic_stiffening: Stiffening::certain(value), ..hose })
        }),
        influence(
            "fluid bulk modulus β_0",
            DisplayUnit::GIGAPASCAL,
            around(problem.fluid_modulus),
            &|value| (SizingProblem { fluid_modulus: value, ..problem.clone() }, hose),
        ),
        // The slope goes with the expansion: a hose that expands more does so at every pressure.
        influence(
            "volumetric expansion E",
            DisplayUnit::CUBIC_CENTIMETRE_PER_METRE,
            around(hose.volumetric_expansion),
            &|value| {
                let share = value / hose.volumetric_expansion;
                let [operating_expansion, expansion_slope] =
                    [hose.operating_expansion, hose.expansion_slope].map(|number| number * share);
                let volumetric_expansion = value;
                let hose = Hose { volumetric_expansion, operating_expansion, expansion_slope, ..hose };
                (problem.clone(), hose)
            },
        ),
    ]
}

fn outcome(problem: &SizingProblem, hose: Hose, candidate: &Candidate) -> (f64, f64) {
    let model = candidate.branch.model;
    let stiffness = problem.stroke_stiffness(hose, candidate.length_m(), model).minimum;
    let length = line_length_for_stiffness(
        model,
        problem.fluid_modulus,
        &problem.cylinder,
        &Line::Hose { hose, length: 1.0 },
        StiffeningMember::Nominal,
        candidate.branch.stiffness.minimum,
    );
    let length = match length {
        LineLength::Length(length) => length,
        LineLength::NotNeeded { .. } => 0.0,
        LineLength::OutOfReach => f64::INFINITY,
    };
    (stiffness, length)
}
