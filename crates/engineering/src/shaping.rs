//! Shaping by hand on a project: the elements of its controller or prefilter are changed one by
//! one, judged at the design frequencies, and written back into its file.

mod change;
mod element_request;
mod piece;
mod refused;
mod save;
mod workpiece;

pub use change::{Change, RequestedChange};
pub use element_request::solved_kinds;
pub use refused::{ChangeProblem, RefusedChange};

use num_complex::Complex64;
use phea_dynamics::controller::Compensator;
use phea_qft::manual_shaping::{DesignChart, DesignMargin, DesignPoint, apply};
use phea_qft::stability::family_stability;
use phea_qft::template::{TemplateError, TemplateOptions, Templates};
use phea_qft::verification::{StabilityFinding, TrackingJudgement};

use crate::plant_names::PlantNames;
use crate::project::{self, DeclaredElement, Loaded, Refusal, RewriteError};
use crate::robust::{BoundsError, RobustError, RobustProblem, robust_problem};
use crate::setup::{ControlError, Setup, is_of_position};
use crate::source::Source;
use phea_dynamics::linear::LinearError;
use phea_dynamics::watch::{Stopped, Watch, part};
use workpiece::Workpiece;

/// Object of the shaping: the controller or the prefilter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shaped {
    /// Controller G.
    #[default]
    Controller,
    /// Prefilter F.
    Prefilter,
}

impl Shaped {
    /// Name of the table in the project file.
    pub fn table(self) -> &'static str {
        match self {
            Shaped::Controller => "controller",
            Shaped::Prefilter => "prefilter",
        }
    }
}

/// Reason why a controller cannot be shaped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapingError {
    /// A change cannot be made.
    #[error(transparent)]
    Change(#[from] Box<RefusedChange>),
    /// The reader of projects rejects elements, each with its place.
    #[error("{0}")]
    Refused(Refusal),
    /// A prefilter is shaped without a loop.
    #[error("the project gives no [controller]: shape it first, the prefilter stands in front of its loop")]
    NoController,
    /// The controller is that of a position.
    #[error(
        "the elements of the controller of the force are shaped, and controller.impedance.form = \"admittance\" states that of the position: \
         shape with form = \"impedance\", which is the same loop with G = C_x/(M_v s^2 + B_v s + K_v)"
    )]
    Admittance,
    /// The file cannot be rewritten.
    #[error(transparent)]
    Rewrite(RewriteError),
    /// The file would not read back as the intended elements.
    #[error("the project file cannot be rewritten: it would not read back as these elements")]
    NotWritten,
    /// The controller, prefilter or sensor is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The nominal plant cannot be sampled.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// The project is not a problem of the robust method.
    #[error(transparent)]
    Robust(#[from] RobustError),
    /// Templates or bounds cannot be computed.
    #[error(transparent)]
    Bounds(BoundsError),
    /// The progress callback cancelled the computation.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<RewriteError> for ShapingError {
    fn from(error: RewriteError) -> ShapingError {
        match error {
            RewriteError::Refused(refusal) => ShapingError::Refused(refusal),
            error => ShapingError::Rewrite(error),
        }
    }
}

impl From<BoundsError> for ShapingError {
    fn from(error: BoundsError) -> ShapingError {
        match error {
            BoundsError::Stopped(stopped) => ShapingError::Stopped(stopped),
            error => ShapingError::Bounds(error),
        }
    }
}

/// A project with its elements changed, and the margins of every plant.
#[derive(Clone, Debug)]
pub struct ProjectShaping {
    /// Object of the shaping.
    pub shaped: Shaped,
    /// Number of changes.
    pub changes: usize,
    /// The elements, including disabled ones.
    pub elements: Vec<DeclaredElement>,
    /// The problem with these elements in its loop.
    pub problem: RobustProblem,
    /// Names of the parameters of a plant.
    pub names: PlantNames,
    /// Stability of every plant.
    pub stability: StabilityFinding,
    /// Margins at the design frequencies, the worst first.
    pub margins: Vec<DesignMargin>,
    /// Nominal loop at the design frequencies.
    pub points: Vec<DesignPoint>,
    /// Design frequencies that a measurement does not reach, rad/s.
    pub unreached_rad_per_s: Vec<f64>,
    /// The project file with these elements, everything else unchanged.
    pub saved: Vec<u8>,
}

/// Makes the changes in order, and judges the result.
///
/// # Errors
/// [`ShapingError`], for example for a change that cannot be made.
pub fn shape(
    source: &dyn Source,
    loaded: &Loaded,
    shaped: Shaped,
    changes: &[RequestedChange],
    watch: Watch<'_>,
) -> Result<ProjectShaping, ShapingError> {
    let has_law = loaded.project.controller.as_ref().is_some_and(project::DeclaredController::has_law);
    if shaped == Shaped::Prefilter && !has_law {
        return Err(ShapingError::NoController);
    }
    if shaped == Shaped::Controller && is_of_position(&loaded.project) {
        return Err(ShapingError::Admittance);
    }
    // without the elements, since the original ones may make sampling impossible
    let bare = workpiece::with_elements(&loaded.project, shaped, &[]);
    let bare = Setup::new(&bare)?;
    let mut workpiece = Workpiece::new(&loaded.project, &bare.timing, shaped)?;
    let bare = robust_problem(source, &bare)?;
    let mut shaping = workpiece.given().clone();
    for requested in changes {
        let edit = change::edit(requested, &mut workpiece, &shaping, &bare)?;
        shaping = apply(&shaping, &edit).map_err(|error| change::refused(requested, error))?;
    }
    let elements = workpiece.declared(&shaping);
    let saved = save::saved(source, loaded, shaped, &elements)?;
    let edited = workpiece::with_elements(&loaded.project, shaped, &elements);
    let problem = robust_problem(source, &Setup::new(&edited)?)?;
    let (chart, unreached_rad_per_s) = chart(&problem, watch)?;
    let tracking =
        if problem.has_prefilter { TrackingJudgement::Magnitude } else { TrackingJudgement::Spread };
    Ok(ProjectShaping {
        shaped,
        changes: changes.len(),
        elements,
        names: problem.names.clone(),
        stability: family_stability(&problem.family, &problem.compensation, watch)?.finding,
        margins: chart.margins(&problem.compensation, tracking),
        points: chart.points(&problem.compensation),
        unreached_rad_per_s,
        problem,
        saved,
    })
}

/// Templates and bounds at the design frequencies, and the frequencies that the family does not
/// reach.
fn chart(problem: &RobustProblem, watch: Watch<'_>) -> Result<(DesignChart, Vec<f64>), ShapingError> {
    let frequencies = problem.design_frequencies();
    let options = TemplateOptions::default();
    let (mut found, mut unreached) = (Vec::new(), Vec::new());
    let mut templates = Templates::new(&problem.family, &problem.compensation, &frequencies, options);
    let fraction = |done: usize| done as f64 / frequencies.len().max(1) as f64;
    for index in 0..frequencies.len() {
        let own = [index, index + 1].map(fraction);
        match templates.next_watched(&mut part(&mut *watch, "templates", own)) {
            None => {}
            Some(Err(TemplateError::OutOfReach { frequency_rad_per_s })) => {
                unreached.push(frequency_rad_per_s);
            }
            Some(built) => found.push(built.map_err(BoundsError::from)?.template),
        }
    }
    let frequency_rad_per_s = found.first().map_or(f64::NAN, |template| template.frequency_rad_per_s);
    let chart = DesignChart::new(&problem.family, found, &problem.specifications)
        .map_err(|error| BoundsError::Bound { frequency_rad_per_s, error })?;
    Ok((chart, unreached))
}

/// Value of the shaped object at a frequency: the nominal loop L0, or the prefilter F. `None` if it
/// is not known.
fn present(
    workpiece: &Workpiece<'_>,
    bare: &RobustProblem,
    compensator: &Compensator,
    frequency_rad_per_s: f64,
) -> Result<Option<Complex64>, ShapingError> {
    let own = workpiece.response(compensator, frequency_rad_per_s)?;
    if workpiece.shaped() == Shaped::Prefilter {
        return Ok(Some(own));
    }
    let nominal = bare.nominal()?.and_then(|member| member.response(frequency_rad_per_s));
    Ok(nominal.map(|plant| plant.plant * plant.sensor * own))
}
