//! Problems shared by several tests.

use phea_dynamics::controller::Timing;
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::design::{Constraint, DesignProblem, Finding, FindingSeverity, diagnose};
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::specification::{Limit, Requirement, Specification};

pub(crate) const EVERYWHERE: [f64; 2] = [0.0, f64::INFINITY];

/// A single plant without uncertainty.
pub(crate) fn single(numerator: &[f64], denominator: &[f64], dead_time_s: f64) -> Family {
    let numbers = |coefficients: &[f64]| coefficients.iter().map(|&c| Recorded::from(c)).collect();
    let plant = UncertainPlant::record(vec![], |_| PlantCoefficients {
        command: RationalCoefficients { numerator: numbers(numerator), denominator: numbers(denominator) },
        disturbance: None,
        dead_time_s: dead_time_s.into(),
        rate: None,
    })
    .unwrap();
    let members = vec![plant.nominal()];
    Family::Uncertain(UncertainFamily::new(plant, vec![], members, Extent::Members).unwrap())
}

/// The box of parameters `(name, nominal, least, greatest)` on a grid of this number of points
/// each.
pub(crate) fn boxed(
    parameters: &[(&str, f64, f64, f64)],
    points: usize,
    plant: impl for<'t> Fn(&[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>>,
) -> Family {
    let parameter = |&(name, nominal, minimum, maximum): &(&str, f64, f64, f64)| UncertainParameter {
        name: name.into(),
        nominal,
        minimum,
        maximum,
    };
    let plant = UncertainPlant::record(parameters.iter().map(parameter).collect(), plant).unwrap();
    let along = |index| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Linear],
        points,
    };
    let coordinates: Vec<Coordinate> = (0..parameters.len()).map(along).collect();
    let members = grid(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

pub(crate) fn plain<'t>(
    numerator: Vec<Recorded<'t>>,
    denominator: Vec<Recorded<'t>>,
    dead_time_s: f64,
) -> PlantCoefficients<Recorded<'t>> {
    let command = RationalCoefficients { numerator, denominator };
    PlantCoefficients { command, disturbance: None, dead_time_s: dead_time_s.into(), rate: None }
}

pub(crate) fn rational(numerator: &[f64], denominator: &[f64]) -> Limit {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    Limit::Rational(
        TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap(),
    )
}

pub(crate) fn demand(requirement: Requirement, frequencies: &[f64], band: [f64; 2]) -> Specification {
    Specification { requirement, frequencies_rad_per_s: frequencies.to_vec(), band_rad_per_s: band }
}

pub(crate) fn everywhere(requirement: Requirement) -> Specification {
    demand(requirement, &[], EVERYWHERE)
}

pub(crate) fn problem(family: Family, specifications: Vec<Specification>) -> DesignProblem {
    DesignProblem {
        family,
        additional_plants: vec![],
        sensor: TransferFunction::gain_only(1.0),
        timing: Timing::default(),
        specifications,
        minimum_delay_margin_s: 0.0,
    }
}

pub(crate) fn sampled(problem: DesignProblem, sample_time_s: f64, delay_s: f64) -> DesignProblem {
    let timing = Timing { sample_time_s: Some(sample_time_s), delay_s, ..Timing::default() };
    DesignProblem { timing, ..problem }
}

pub(crate) fn impossibilities(problem: &DesignProblem) -> Vec<Finding> {
    let mut findings = diagnose(problem);
    findings.retain(|finding| finding.severity() == FindingSeverity::Impossible);
    findings
}

/// The constraints of the right half plane among the findings, with the relaxation required by
/// each.
pub(crate) fn constraints(problem: &DesignProblem) -> Vec<(Constraint, f64)> {
    let of = |finding| match finding {
        Finding::RightHalfPlane { constraint, relaxation_db } => Some((constraint, relaxation_db)),
        _ => None,
    };
    impossibilities(problem).into_iter().filter_map(of).collect()
}

/// The highest forced peak, dB.
pub(crate) fn forced_peak_db(problem: &DesignProblem) -> Option<f64> {
    diagnose(problem).into_iter().find_map(|finding| match finding {
        Finding::ForcedPeak { peak_db, .. } => Some(peak_db),
        _ => None,
    })
}

pub(crate) fn decibels(ratio: f64) -> f64 {
    20.0 * ratio.log10()
}
