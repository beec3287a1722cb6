//! Templates and bounds of a project as plain numbers, as `design --out` and `report --out` write
//! them.

use num_complex::Complex64;
use phea_engineering::robust::{DesignFrequency, RobustProblem};
use phea_engineering::specification::kind_key;
use phea_qft::bound::Bound;
use phea_qft::family::Family;

use crate::command::{self, CommandError, Watch};
use crate::project::Loaded;
use crate::source::Source;

/// Templates and bounds at the design frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundValues {
    /// Names of the parameters of the plants; empty for measured plants.
    pub parameters: Vec<String>,
    /// Number of members of the family, which are the first plants of every template.
    pub members: usize,
    /// Values at each design frequency that the family reaches, increasing.
    pub frequencies: Vec<FrequencyValues>,
}

/// Template and bounds at one design frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyValues {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Parameters of each plant of the template, SI: the members, then the plants that refinement
    /// found on the outline.
    pub plants: Vec<Vec<f64>>,
    /// Response P H of each of these plants, with the delay and the hold of the loop, as real and
    /// imaginary part.
    pub responses: Vec<[f64; 2]>,
    /// Nominal loop L0, as real and imaginary part; `None` without a controller.
    pub nominal_loop: Option<[f64; 2]>,
    /// Bound of each specification that has one at this frequency.
    pub specifications: Vec<SpecificationBoundValues>,
    /// Gains that any specification forbids.
    pub together: ForbiddenGains,
}

/// Bound of one specification.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecificationBoundValues {
    /// Number in the file, from 1; `None` for a limit that is not declared there.
    pub number: Option<usize>,
    /// Kind of the specification, such as `tracking`.
    pub kind: &'static str,
    /// Gains that it forbids.
    pub forbidden: ForbiddenGains,
}

/// Gains |L0| of the nominal loop that are forbidden over its phase.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForbiddenGains {
    /// Phases at which the bound is known, degrees, increasing from -360 to 0.
    pub phases_deg: Vec<f64>,
    /// Phase of each forbidden interval of gains, degrees.
    pub phase_deg: Vec<f64>,
    /// Lower end of each interval; 0 if every smaller gain is forbidden.
    pub from_gain: Vec<f64>,
    /// Upper end of each interval; infinity if every larger gain is forbidden.
    pub to_gain: Vec<f64>,
}

impl ForbiddenGains {
    fn of(bound: &Bound) -> ForbiddenGains {
        let mut gains = ForbiddenGains {
            phases_deg: bound.phases_rad.iter().map(|phase| phase.to_degrees()).collect(),
            ..ForbiddenGains::default()
        };
        for (phase, forbidden) in bound.phases_rad.iter().zip(&bound.forbidden) {
            for [from, to] in forbidden.intervals() {
                gains.phase_deg.push(phase.to_degrees());
                gains.from_gain.push(*from);
                gains.to_gain.push(*to);
            }
        }
        gains
    }
}

/// Templates and bounds of a project, with the valve identified from its recordings if the project
/// requires that.
///
/// # Errors
/// [`CommandError`] for a project without a family, a template that cannot be computed, and a watch
/// that stops the computation.
///
/// # Example
/// ```
/// use phea_workbench::bound_values::bound_values;
/// use phea_workbench::project;
/// use phea_workbench::source::Memory;
/// let source = Memory::default().with("servo.toml", include_str!("../../../examples/qft/servo.toml"));
/// let loaded = project::read(&source, "servo.toml", &[], &[])?;
/// let found = bound_values(&source, &loaded, &mut |_| true)?;
/// assert_eq!((found.parameters.len(), found.members), (2, 49));
/// let first = &found.frequencies[0];
/// assert!(first.responses.len() >= 49 && first.plants.len() == first.responses.len());
/// assert_eq!(first.specifications[0].number, Some(1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bound_values(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<BoundValues, CommandError> {
    let problem = command::robust_problem_of(source, loaded, &mut *watch)?;
    let found = problem.at_design_frequencies(watch)?;
    let (parameters, members) = match &problem.family {
        Family::Uncertain(family) => {
            let names = family.plant().parameters().iter().map(|one| one.name.clone());
            (names.collect(), family.members().len())
        }
        Family::Measured(family) => (vec![], family.plants().len()),
    };
    let frequencies = found.iter().map(|one| values(&problem, one)).collect();
    Ok(BoundValues { parameters, members, frequencies })
}

fn values(problem: &RobustProblem, one: &DesignFrequency) -> FrequencyValues {
    let pair = |value: Complex64| [value.re, value.im];
    let points = &one.template.template.points;
    let specification = |part: &phea_qft::bound::SpecificationBound| {
        let own = problem.specifications.get(part.specification)?;
        Some(SpecificationBoundValues {
            number: problem.number_of(part.specification),
            kind: kind_key(&own.requirement),
            forbidden: ForbiddenGains::of(&part.bound),
        })
    };
    FrequencyValues {
        frequency_rad_per_s: one.frequency_rad_per_s,
        plants: points.iter().map(|point| point.values.clone()).collect(),
        responses: points.iter().map(|point| pair(point.response)).collect(),
        nominal_loop: problem.has_controller.then(|| pair(one.nominal_loop)),
        specifications: one.bounds.parts.iter().filter_map(specification).collect(),
        together: ForbiddenGains::of(&one.bounds.union),
    }
}
