//! Relative change of K_qU and K_c with numbers of the project, at its operating points.

use phea_dynamics::expression::Expression;
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::scalar::Dual;
use phea_dynamics::uncertain_plant::UncertainParameter;
use phea_hydraulics::servovalve::STATIC_COEFFICIENTS;

use super::visited::Visited;
use super::{ProjectFamilyError, uncertain};
use crate::rig::RigError;
use crate::setup::Setup;

/// Largest number of numbers: as many as static tests determine for a valve.
const MOST: usize = STATIC_COEFFICIENTS;

/// Beginning of the paths over which a region of operating points ranges.
const OPERATING_POINT: &str = "operating_point.";

/// Relative change of K_qU and of K_c for a change of each number by one, SI: one row for each of
/// the two at each operating point, which are the ends and the middle of every range of
/// `[uncertainty]` and of `[family.operating_region]`.
///
/// ```text
/// row = d ln K/d number
/// ```
///
/// # Errors
/// [`ProjectFamilyError`] for a rig that cannot be computed or is not at rest at such a point.
pub(crate) fn gain_slopes(setup: &Setup<'_>, numbers: &[&str]) -> Result<Vec<Vec<f64>>, ProjectFamilyError> {
    let project = setup.project;
    let Some(declared) = &project.actuator else { return Err(RigError::NoActuator.into()) };
    let points = uncertain::parameters(project)?;
    let points: Vec<UncertainParameter> =
        points.into_iter().filter(|one| one.name.starts_with(OPERATING_POINT)).collect();
    let stated = |name: &&str| {
        let nominal = project.number(name).unwrap_or(0.0);
        UncertainParameter { name: name.to_string(), nominal, minimum: nominal, maximum: nominal }
    };
    let parameters: Vec<UncertainParameter> =
        points.iter().cloned().chain(numbers.iter().map(stated)).collect();
    let visited = Visited::new(setup, &parameters)?;
    let open = visited.open(project, declared);
    let names: Vec<&str> = parameters.iter().map(|one| one.name.as_str()).collect();
    let gains = Expression::record(&names, |values| {
        let linear = open.place(values, visited.moved).linear;
        vec![linear.flow_gain, linear.flow_pressure_coefficient]
    });
    let mut rows = Vec::new();
    for values in combinations(&points) {
        let stated = parameters.iter().skip(points.len()).map(|one| one.nominal);
        let values: Vec<f64> = values.into_iter().chain(stated).collect();
        if let Some(reason) = visited.problem(&open, &values) {
            return Err(ProjectFamilyError::OperatingPoint {
                member: visited.member(project, &values),
                numbers: visited.numbers(),
                reason,
            });
        }
        let dual = |(index, value): (usize, &f64)| match index.checked_sub(points.len()) {
            Some(number) => Dual::<MOST>::variable(*value, number),
            None => Dual::constant(*value),
        };
        let values: Vec<Dual<MOST>> = values.iter().enumerate().map(dual).collect();
        let gains = gains.evaluate(&values);
        let relative = |gain: &Dual<MOST>| {
            gain.gradient().iter().take(numbers.len()).map(|slope| slope / gain.value()).collect()
        };
        rows.extend(gains.iter().map(relative));
    }
    Ok(rows)
}

/// Ends and middle of every range, in all combinations.
fn combinations(points: &[UncertainParameter]) -> Vec<Vec<f64>> {
    let mut all = vec![Vec::new()];
    for UncertainParameter { nominal, minimum, maximum, .. } in points {
        let places = sorted_distinct(vec![*minimum, *nominal, *maximum, 0.5 * (minimum + maximum)]);
        all = all
            .iter()
            .flat_map(|before: &Vec<f64>| places.iter().map(|place| [before.as_slice(), &[*place]].concat()))
            .collect();
    }
    all
}
