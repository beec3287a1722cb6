//! Alternatives of one project, each the project with other settings: sized, designed for the
//! project's specifications, audited, tested on the machine and simulated through every scenario.
//!
//! ```text
//! [[alternative]] -> project -> sizing, design, audit, trial -> the designed loop, simulated -> columns -> dominance
//! ```

mod by_other_means;
mod cases;
mod column_key;
mod columns;
mod comparison;
mod error;
mod front;
mod hardware;
mod no_number;
mod port;
mod prepared;
mod recentred;

pub use cases::{JudgedCase, PreparedCase, prepared_cases};
pub use column_key::ColumnKey;
pub use columns::{AlternativeColumn, AlternativeColumns, ColumnPart};
pub use comparison::{
    ColumnSense, ComparedMeasure, ComparedMeasures, MEASURES, MEASURES_IF_STATED, dominates,
};
pub use error::{AlternativesError, JudgeError, NoHose, PrepareError};
pub use front::{FeasibilityUnknown, Front, FrontColumn, FrontPoint, FrontRequest, FrontValue, NoFrontValue};
pub use hardware::retracted_length;
pub use no_number::{LengthUnknown, NoNumber};
pub use port::IMPEDANCE_AT;
pub use prepared::{PreparedAlternative, prepared};
pub use recentred::MovedRange;

use phea_dynamics::watch::{Progress, Watch};

use crate::catalogue::{self, Catalogue};
use crate::design::{DesignError, ProjectDesign, design_project};
use crate::linearize::{Linearization, linearize};
use crate::parts::PartsCounted;
use crate::project::{ImpedanceForm, Loaded, Project};
use crate::rig::{OutsideParameter, Rig, RigError};
use crate::setup::{ControlError, Setup};
use crate::simulate::{ScenarioRun, simulate_project};
use crate::sizing::{Question, Sizing, size, sizing_problem};
use crate::source::Source;
use crate::trial::Agreement;
use prepared::ReadingAgain;

/// The project as declared and its alternatives, judged.
#[derive(Clone, Debug)]
pub struct Alternatives {
    /// The declared project first, then its alternatives in file order.
    pub judged: Vec<JudgedAlternative>,
    /// Names of the alternatives that were not finished when `watch` cancelled.
    pub not_reached: Vec<String>,
    /// Results under each load case.
    pub cases: Vec<JudgedCase>,
    /// Fronts over a swept key, if requested.
    pub front: Option<Front>,
}

/// Options for the alternatives of a project.
#[derive(Clone, Debug, PartialEq)]
pub struct AlternativesOptions {
    /// Fronts over a swept key.
    pub front: Option<FrontRequest>,
    /// Frequencies at which the impedance at the load is reported, rad/s.
    pub impedance_at: Vec<f64>,
}

impl Default for AlternativesOptions {
    fn default() -> AlternativesOptions {
        AlternativesOptions { front: None, impedance_at: IMPEDANCE_AT.to_vec() }
    }
}

/// An alternative with all results, or the reasons why they are absent.
#[derive(Clone, Debug)]
pub struct JudgedAlternative {
    /// Name of the alternative.
    pub name: String,
    /// The project with its settings.
    pub loaded: Loaded,
    /// The rig of that project.
    pub rig: Result<Rig, JudgeError>,
    /// The ranges of `[uncertainty]` that follow its rig.
    pub moved: Vec<MovedRange>,
    /// Parameters of its rig outside their ranges in `[uncertainty]`, or `None` if they are those
    /// of the project as declared.
    pub outside: Option<Vec<OutsideParameter>>,
    /// Frequencies at which the impedance is reported, rad/s.
    pub impedance_at: Vec<f64>,
    /// Attributes of parts that are counted in all compared alternatives.
    pub counted: PartsCounted,
    /// Hoses of the catalogue for the `[sizing]` of the alternative.
    pub sizing: Result<Sizing, JudgeError>,
    /// The designed controller with its audit and its trial on the machine.
    pub design: Result<ProjectDesign, JudgeError>,
    /// The project with the designed laws in place of those that it gives.
    pub deployed: Result<Project, JudgeError>,
    /// The linear models of its rig, the closed loop with the designed controller.
    pub linearization: Result<Linearization, JudgeError>,
    /// Runs of every scenario under the designed controller and prefilter; empty without a
    /// scenario, or without a machine.
    pub runs: Result<Vec<ScenarioRun>, JudgeError>,
}

impl Alternatives {
    /// True if every alternative has a design, and every scenario ran to its end.
    pub fn is_complete(&self) -> bool {
        let front = self.front.as_ref().is_none_or(|front| front.not_reached == 0);
        let all = |judged: &[JudgedAlternative], not_reached: &[String]| {
            not_reached.is_empty() && judged.iter().all(JudgedAlternative::is_judged)
        };
        let cases = self.cases.iter().all(|case| all(&case.judged, &case.not_reached));
        front && cases && all(&self.judged, &self.not_reached)
    }
}

impl JudgedAlternative {
    /// True if the alternative has a design whose simulation gave results that describe the
    /// machine.
    pub(crate) fn is_judged(&self) -> bool {
        let reliable = |runs: &Vec<ScenarioRun>| runs.iter().all(ScenarioRun::is_reliable);
        self.design.is_ok() && self.runs.as_ref().is_ok_and(reliable)
    }

    /// True if the machine does something that the verdict excludes.
    pub(crate) fn is_contradicted(&self) -> bool {
        let trial = self.design.as_ref().ok().and_then(|view| view.trial.as_ref());
        trial.is_some_and(|trial| trial.agreement() == Agreement::Contradicts)
    }

    /// True if the alternative may dominate another: it satisfies every specification, was
    /// simulated to the end of its scenarios, and the machine does not contradict its verdict.
    pub fn is_comparable(&self) -> bool {
        self.feasible() == Some(true) && self.is_judged() && !self.is_contradicted()
    }

    /// True if the designed loop satisfies every specification, and the nonlinear rig its
    /// requirements in time; `None` if this is unknown, for the reason in the design.
    pub fn feasible(&self) -> Option<bool> {
        use phea_qft::design::DesignStatus;
        let view = self.design.as_ref().ok()?;
        match view.design.status {
            _ if view.is_met() && !view.misses_on_rig() => Some(true),
            DesignStatus::Infeasible(_) | DesignStatus::NotStabilised => Some(false),
            DesignStatus::Met
                if !view.tolerates_its_delay
                    || view.designed.view.misses_in_time()
                    || view.misses_on_rig() =>
            {
                Some(false)
            }
            DesignStatus::Met | DesignStatus::NotConverged { .. } => None,
        }
    }
}

/// Judges the project as declared, and each of its alternatives, one after the other; then all of
/// them again under each load case. If `watch` returns `false`, the current one and all later ones
/// are not reached.
///
/// # Errors
/// [`AlternativesError`]. Anything else that an alternative lacks is reported with that
/// alternative.
///
/// # Example
/// ```
/// use phea_engineering::alternatives::{AlternativesError, AlternativesOptions, judge};
/// use phea_project::{self as project, source::Memory};
/// let source = Memory::default().with("rig.toml", include_str!("../../../examples/ybitu/hose.toml"));
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let none = judge(&source, &loaded, &[], &AlternativesOptions::default(), &mut |_| true);
/// assert!(matches!(none, Err(AlternativesError::NoAlternative)));
/// # Ok::<(), phea_project::Refusal>(())
/// ```
pub fn judge(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    request: &AlternativesOptions,
    watch: Watch<'_>,
) -> Result<Alternatives, AlternativesError> {
    if loaded.project.alternatives.is_empty() {
        return Err(AlternativesError::NoAlternative);
    }
    if loaded.project.specifications.is_empty() {
        return Err(AlternativesError::NoSpecification(DesignError::NoSpecification));
    }
    let motions = loaded.project.motions();
    let planned = request.front.as_ref().map(|prepared| front::plan(prepared, motions)).transpose()?;
    let (all, counted) = prepared(source, loaded, catalogues)?;
    let cases = prepared_cases(source, loaded, catalogues)?;
    let catalogue = catalogue::load(source, catalogues).map_err(AlternativesError::Refused)?;
    let impedance_at = request.impedance_at.as_slice();
    let judging = Judging { source, catalogue: &catalogue, all: &all, impedance_at, counted };
    let swept = planned.as_ref().map_or(0, |plan| plan.values.len());
    let rounds = (1 + cases.len() + swept) as f64;
    let round = |watch: Watch<'_>, [first, last]: [f64; 2], progress: Progress| {
        watch(Progress { fraction: (first + (last - first) * progress.fraction) / rounds, ..progress })
    };
    let (judged, not_reached) =
        cases::judged(&judging, &all, true, &mut |progress| round(watch, [0.0, 1.0], progress));
    let continues = not_reached.is_empty();
    let until = 1.0 + cases.len() as f64;
    let cases = cases::judged_cases((source, &catalogue, impedance_at), cases, continues, &mut |progress| {
        round(watch, [1.0, until], progress)
    });
    let mut found = Alternatives { judged, not_reached, cases, front: None };
    if let Some(plan) = planned {
        let continues = continues && found.cases.iter().all(|case| case.not_reached.is_empty());
        let again = ReadingAgain { source, catalogues };
        let mut watched = |progress: Progress| round(watch, [until, rounds], progress);
        found.front = Some(front::swept(&judging, (&again, &all), &plan, continues, &mut watched));
    }
    Ok(found)
}

/// Fraction of the progress that the design takes; the scenarios take the rest.
const DESIGNING: f64 = 0.7;

/// Common inputs for the judgement of every alternative.
pub(crate) struct Judging<'a> {
    source: &'a dyn Source,
    catalogue: &'a Catalogue,
    all: &'a [PreparedAlternative],
    impedance_at: &'a [f64],
    counted: PartsCounted,
}

impl Judging<'_> {
    /// A judged alternative; `None` if `watch` cancels.
    fn judged(&self, prepared: PreparedAlternative, watch: Watch<'_>) -> Option<JudgedAlternative> {
        let outside = prepared.outside(self.all);
        let PreparedAlternative { name, loaded, rig, no_hose, moved } = prepared;
        let mut designing =
            |progress: Progress| watch(Progress { fraction: DESIGNING * progress.fraction, ..progress });
        let project = in_impedance_form(&loaded.project);
        let setup = Setup::around(&project, rig.clone());
        let setup = setup.as_ref().map_err(Clone::clone);
        let design = match no_hose {
            Some(reason) => Err(reason.into()),
            None => match designed(self.source, setup.clone(), &mut designing) {
                Err(DesignError::Stopped(_)) => return None,
                Ok(view) if view.is_stopped() => return None,
                design => design.map_err(JudgeError::from),
            },
        };
        let deployed = match &design {
            Ok(view) => Ok(view.deployed(&project)),
            Err(_) => Err(JudgeError::NoController),
        };
        let mut driving = |progress: Progress| {
            watch(Progress { fraction: DESIGNING + (1.0 - DESIGNING) * progress.fraction, ..progress })
        };
        let last = Setup::new(deployed.as_ref().unwrap_or(&loaded.project));
        let last = last.as_ref().map_err(Clone::clone);
        let runs = deployed.as_ref().map_err(Clone::clone);
        let runs = runs.and_then(|deployed| driven(self.source, deployed, last.clone(), &mut driving));
        if runs.as_ref().is_ok_and(|runs| runs.iter().any(ScenarioRun::was_cancelled)) {
            return None;
        }
        Some(JudgedAlternative {
            name,
            moved,
            outside,
            impedance_at: self.impedance_at.to_vec(),
            counted: self.counted,
            rig: rig.map_err(JudgeError::from),
            sizing: sized(setup, self.catalogue),
            linearization: linearized(last),
            design,
            deployed,
            runs,
            loaded,
        })
    }
}

/// The project with a controller of the force in place of that of an inner position loop; the loop
/// is unchanged, and a design finds this form.
///
/// ```text
/// C_x = G (M_v s^2 + B_v s + K_v)
/// ```
fn in_impedance_form(project: &Project) -> Project {
    let mut project = project.clone();
    if let Some(impedance) = project.controller.as_mut().and_then(|own| own.impedance.as_mut()) {
        impedance.form = ImpedanceForm::Impedance;
    }
    project
}

type AssembledSetup<'a> = Result<&'a Setup<'a>, ControlError>;

fn designed(
    source: &dyn Source,
    setup: AssembledSetup<'_>,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    design_project(source, setup?, None, watch)
}

fn sized(setup: AssembledSetup<'_>, catalogue: &Catalogue) -> Result<Sizing, JudgeError> {
    Ok(size(&sizing_problem(setup?, catalogue)?, Question::Both))
}

fn linearized(setup: AssembledSetup<'_>) -> Result<Linearization, JudgeError> {
    let setup = setup?;
    Ok(linearize(setup.rig()?, setup.controller.as_ref(), &setup.sensor)?)
}

fn driven(
    source: &dyn Source,
    project: &Project,
    setup: AssembledSetup<'_>,
    watch: Watch<'_>,
) -> Result<Vec<ScenarioRun>, JudgeError> {
    if project.actuator.is_none() || project.scenarios.is_empty() {
        return Ok(vec![]);
    }
    Ok(simulate_project(source, setup?, watch)?)
}

/// Reason for the absent results of a machine.
fn no_rig() -> NoNumber {
    NoNumber::NotJudged(RigError::NoActuator.into())
}
