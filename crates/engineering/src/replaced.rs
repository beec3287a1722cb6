//! A family compared with the box of ranges that it replaces.

use phea_dynamics::uncertain_plant::Spacing;
use phea_qft::family::Family;
use phea_qft::template::{Template, TemplateError, TemplateOptions, Templates};

use crate::family::{ProjectFamilyError, VisitedRange, family};
use crate::project::{DeclaredFamily, Project};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::source::Source;

/// A range that is replaced according to the project, and the range that its family visits instead.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplacedRange {
    /// The parameter's symbol, such as `K_c`.
    pub symbol: &'static str,
    /// SI unit of the parameter.
    pub unit: &'static str,
    /// Replaced range.
    pub stated: [f64; 2],
    /// Range that the family visits.
    pub visited: [f64; 2],
    /// Visited fraction of the range: of its logarithm if it is spaced by equal factors.
    pub fraction: f64,
}

impl ReplacedRange {
    /// True for each end, lower and upper, if the family goes beyond it.
    pub fn beyond(&self) -> [bool; 2] {
        let ([least, most], [low, high]) = (self.stated, self.visited);
        [low < least * (1.0 - ROUNDED), high > most * (1.0 + ROUNDED)]
    }
}

/// Relative difference of ranges that may be due to printing to three digits.
const ROUNDED: f64 = 0.01;

/// Areas of both templates at a frequency, degrees times dB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TemplateAreas {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Area of the template of the box.
    pub replaced: f64,
    /// Area of the template of the family.
    pub visited: f64,
}

/// Ranges that are replaced according to a project, with the visited ones.
pub fn replaced_ranges(project: &Project, visited: &[VisitedRange]) -> Vec<ReplacedRange> {
    let declared = project.family.iter().flat_map(|family| &family.replaces);
    let range = |one: &crate::project::Uncertain| {
        let visited = visited.iter().find(|visited| visited.name == one.name)?;
        let scale = |value: f64| match one.spacing {
            Spacing::Logarithmic => phea_dynamics::portable::ln(value),
            Spacing::Linear => value,
        };
        let (low, high) = (visited.minimum.value, visited.maximum.value);
        let both = (scale(high.min(one.maximum)) - scale(low.max(one.minimum))).max(0.0);
        Some(ReplacedRange {
            symbol: visited.symbol,
            unit: visited.unit,
            stated: [one.minimum, one.maximum],
            visited: [low, high],
            fraction: both / (scale(one.maximum) - scale(one.minimum)),
        })
    };
    declared.filter_map(range).collect()
}

/// Areas of the templates at the design frequencies of a problem, and those of the box that it
/// replaces according to the project; empty if it replaces none. `own` are those of the problem's
/// family.
///
/// # Errors
/// The errors of the family of the box and of its templates.
pub fn template_areas(
    source: &dyn Source,
    project: &Project,
    problem: &RobustProblem,
    own: &[&Template],
) -> Result<Vec<TemplateAreas>, ReplacedError> {
    let Some(boxed) = boxed(project) else { return Ok(Vec::new()) };
    let setup = Setup::new(&boxed)?;
    let replaced: Family = family(&setup, source)?;
    let frequencies: Vec<f64> = own.iter().map(|one| one.frequency_rad_per_s).collect();
    let templates =
        Templates::new(&replaced, &problem.compensation, &frequencies, TemplateOptions::default());
    let areas = templates.zip(own).map(|(built, own)| {
        let Template { frequency_rad_per_s, .. } = **own;
        let replaced = built?.template.area_deg_db();
        Ok(TemplateAreas { frequency_rad_per_s, replaced, visited: own.area_deg_db() })
    });
    areas.collect()
}

/// Reason why there is no comparison.
#[derive(Debug, thiserror::Error)]
pub enum ReplacedError {
    /// The box has no plants.
    #[error("[family.replaces]: {0}")]
    Family(#[from] ProjectFamilyError),
    /// A template of the box cannot be built.
    #[error("[family.replaces]: {0}")]
    Template(#[from] TemplateError),
    /// The controller is not a transfer function.
    #[error(transparent)]
    Control(#[from] crate::setup::ControlError),
}

/// The project with the replaced ranges, and without the data that replace them; `None` if none are
/// replaced.
pub fn boxed(project: &Project) -> Option<Project> {
    let declared = project.family.as_ref().filter(|family| !family.replaces.is_empty())?;
    let family = DeclaredFamily { operating_region: None, replaces: Vec::new(), ..declared.clone() };
    let uncertainty = project.uncertainty.iter().chain(&declared.replaces).cloned().collect();
    Some(Project { uncertainty, directions: Vec::new(), family: Some(family), ..project.clone() })
}
