//! Prior findings on a problem: proven impossibilities, and probable difficulties.

mod candidate;
mod ceiling;
mod contradiction;
mod family_wide;
mod finding;
mod interpolation;
mod plane;
mod pointwise;

use phea_dynamics::controller::Controller;

pub use finding::{Constraint, ConstraintPlace, Finding, FindingSeverity, SharedLimit};

use self::candidate::{PlantWithinLoop, candidates};
use self::ceiling::Ceilings;
use self::plane::{BoundaryCells, Plane};
use super::DesignProblem;
use crate::closed_loop::Compensation;
use crate::specification::{Limit, Specification};

/// Findings without a search: limits that no controller can meet, and probable difficulties;
/// impossibilities come first.
///
/// Each impossibility holds for every linear time-invariant controller and every prefilter, because
/// a single plant of the family (or a few plants at one frequency) forbids the requirement: it is
/// never a failure of a search. The absence of findings does not mean that a controller exists. The
/// plants are the nominal one, at most 64 corners, and members up to a total of 96; limits are
/// evaluated at some hundred frequencies, and deficits below 0.1 dB are ignored.
///
/// ```text
/// S + T = 1                                          on the axis and at every point of the right half plane
/// |S(s0)| <= exp(mean ln|S|) prod |s0 - p|/|s0 + conj p|,  |T(s0)| <= exp(mean ln|T|) prod |s0 - z|/|s0 + conj z| e^(-Re(s0) T_d)
/// ```
///
/// The means are taken over the axis, weighted by the Poisson kernel of s0; poles p and zeros z of
/// P H in the right half plane; a sampled loop is treated exactly, in z. Sources: Freudenberg and
/// Looze (1985); Seron, Braslavsky and Goodwin (1997); Skogestad and Postlethwaite (2005), chapter
/// 5.
///
/// # Example
/// An unstable pole above the allowed bandwidth:
/// ```
/// # use phea_dynamics::controller::Timing;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
/// # use phea_qft::family::{Extent, Family, UncertainFamily};
/// use num_complex::Complex64;
/// use phea_qft::design::{DesignProblem, Finding, ConstraintPlace, diagnose};
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let roll_off = TransferFunction::from_factors(3.0, vec![], vec![Complex64::new(-2.0, 0.0)])?; // 3/(s + 2)
/// # let plant = UncertainPlant::record(vec![], |_| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![1.0.into()], denominator: vec![1.0.into(), (-4.0).into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// # let members = vec![plant.nominal()];
/// # let family = Family::Uncertain(UncertainFamily::new(plant, vec![], members, Extent::Members)?);
/// let problem = DesignProblem {
///     family, // 1/(s - 4)
///     additional_plants: vec![],
///     sensor: TransferFunction::gain_only(1.0),
///     timing: Timing::default(),
///     specifications: vec![Specification {
///         requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Rational(roll_off)),
///         frequencies_rad_per_s: vec![1.0],
///         band_rad_per_s: [0.0, f64::INFINITY],
///     }],
///     minimum_delay_margin_s: 0.0,
/// };
/// let findings = diagnose(&problem);
/// let Finding::RightHalfPlane { constraint, relaxation_db } = &findings[0] else { panic!("{findings:?}") };
/// assert_eq!(constraint.place, ConstraintPlace::UnstablePole(Complex64::new(4.0, 0.0)));
/// assert!((constraint.complementary - 0.5).abs() < 1e-3); // 3/(4 + 2), where T(4) = 1
/// assert!((relaxation_db - 6.02).abs() < 0.01);
/// # Ok(())
/// # }
/// ```
pub fn diagnose(problem: &DesignProblem) -> Vec<Finding> {
    let controller = Controller { timing: problem.timing, ..Controller::default() };
    let Ok(compensation) = Compensation::new(&controller, problem.sensor.clone()) else { return Vec::new() };
    let specifications = &problem.specifications;
    let candidates = candidates(&problem.family, &compensation);
    let plane = Plane { sample_time_s: compensation.sample_time_s() };
    let boundary = BoundaryCells::new(plane, &places(plane, specifications, &candidates));
    let ceilings = Ceilings::new(&boundary, specifications, &candidates);
    let continuous = compensation.sample_time_s().is_none();

    let mut findings = pointwise::crossed(specifications, &boundary.frequencies);
    findings.extend(pointwise::sum_below_one(&ceilings, &candidates));
    findings.extend(contradiction::contradictions(specifications, &candidates, &boundary));
    findings.extend(pointwise::on_the_axis(specifications, &candidates, &compensation));
    findings.extend(interpolation::findings(&ceilings, &candidates));
    findings.extend(family_wide::gain_signs(specifications, &candidates));
    if continuous {
        findings.extend(family_wide::delay_margin(problem.minimum_delay_margin_s, &candidates));
        findings.extend(family_wide::unstable_controller(&candidates));
    }
    let highest = compensation.highest_frequency_rad_per_s();
    findings.extend(family_wide::out_of_reach(specifications, &candidates, highest));
    findings.extend(pointwise::static_gains(specifications));
    findings.sort_by_key(Finding::severity);
    findings
}

/// Frequencies of interest: ends of bands, design frequencies, roots of limits and of plants.
fn places(plane: Plane, specifications: &[Specification], candidates: &[PlantWithinLoop]) -> Vec<f64> {
    let mut frequencies: Vec<f64> = Vec::new();
    for specification in specifications {
        frequencies.extend(specification.band_rad_per_s);
        frequencies.extend(&specification.frequencies_rad_per_s);
        let (lower, upper) = specification.requirement.limits();
        for limit in lower.into_iter().chain([upper]) {
            match limit {
                Limit::Constant(_) => {}
                Limit::Rational(function) => {
                    let roots = function.zeros().iter().chain(function.poles());
                    frequencies.extend(roots.map(|root| phea_dynamics::portable::magnitude(*root)));
                }
                Limit::Table(table) => {
                    let ends = table.points().first().into_iter().chain(table.points().last());
                    frequencies.extend(ends.map(|point| point.0));
                }
            }
        }
    }
    frequencies.extend(candidates.iter().take(1).flat_map(|candidate| candidate.features.iter().copied()));
    frequencies.extend(candidates.iter().map(|candidate| 1.0 / candidate.dead_time_s));
    let images = candidates.iter().flat_map(|candidate| candidate.poles.iter().chain(&candidate.zeros));
    let images = images.map(|root| phea_dynamics::portable::magnitude(*root));
    let axis = frequencies.into_iter().map(|frequency| plane.place(frequency));
    axis.chain(images).chain(plane.image_of_delay()).collect()
}
