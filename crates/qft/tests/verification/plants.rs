//! Plants, loops and specifications shared by several tests.

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{
    AuditProblem, AuditWork, SpecificationFinding, TOLERANCE_DB, TrackingJudgement, audit_specifications,
};

pub(crate) fn parameter(name: &str, nominal: f64, minimum: f64, maximum: f64) -> UncertainParameter {
    UncertainParameter { name: name.into(), nominal, minimum, maximum }
}

pub(crate) fn along(index: usize, spacing: Spacing, points: usize) -> Coordinate {
    Coordinate { parameters: vec![index], opposed: vec![], spacing: vec![spacing], points }
}

/// The box of a plant on a grid.
pub(crate) fn on_grid(plant: UncertainPlant, coordinates: Vec<Coordinate>) -> Family {
    let members = grid(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

pub(crate) fn rational(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

pub(crate) fn compensation(
    feedback: TransferFunction,
    prefilter: TransferFunction,
    timing: Timing,
) -> Compensation {
    let one = |function| Compensator::new(vec![Element::General(function)]);
    let controller =
        Controller { feedback: one(feedback), prefilter: one(prefilter), timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

pub(crate) fn specification(requirement: Requirement, frequencies: &[f64], band: [f64; 2]) -> Specification {
    Specification { requirement, frequencies_rad_per_s: frequencies.to_vec(), band_rad_per_s: band }
}

pub(crate) fn stability(limit: f64, frequencies: &[f64], band: [f64; 2]) -> Specification {
    specification(
        Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)),
        frequencies,
        band,
    )
}

pub(crate) fn audited(
    family: &Family,
    compensation: &Compensation,
    specifications: &[Specification],
    tracking: TrackingJudgement,
) -> (Vec<SpecificationFinding>, AuditWork) {
    let problem = AuditProblem { family, compensation, specifications, tracking, tolerance_db: TOLERANCE_DB };
    let mut before = 0.0;
    let found = audit_specifications(&problem, &mut |progress| {
        assert!(progress.fraction >= before && progress.fraction <= 1.0);
        before = progress.fraction;
        true
    });
    found.unwrap()
}
