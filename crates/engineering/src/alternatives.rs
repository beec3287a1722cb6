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
mod plan;
mod port;
mod prepared;
mod recentred;

pub use cases::{JudgedLoad, PreparedLoad, prepared_load};
pub use column_key::ColumnKey;
pub use columns::{AlternativeColumn, AlternativeColumns, ColumnPart, WorstColumn, WorstColumns};
pub use comparison::{
    ColumnSense, ComparedMeasure, ComparedMeasures, MEASURES, MEASURES_IF_STATED, dominates,
};
pub use error::{AlternativesError, JudgeError, NoHose, PrepareError};
pub use front::{
    FeasibilityUnknown, FrontColumn, FrontPlan, FrontPoint, FrontRequest, FrontValue, NoFrontValue,
    dominating,
};
pub use hardware::retracted_length;
pub use no_number::{LengthUnknown, NoNumber};
pub use plan::{AlternativeTask, AlternativesPlan, PlannedCase};
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

impl JudgedAlternative {
    /// True if the alternative has a design whose simulation gave results that describe the
    /// machine.
    pub fn is_judged(&self) -> bool {
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

/// Fraction of the progress that the design takes; the scenarios take the rest.
const DESIGNING: f64 = 0.7;

/// Result of an [`AlternativeTask`].
#[derive(Clone, Debug)]
pub enum JudgedTask {
    /// The alternative under a load.
    Alternative(Box<JudgedAlternative>),
    /// The alternative at a value of the front.
    Point(FrontPoint),
}

/// Common inputs for the judgement of every alternative.
pub struct Judging<'a> {
    source: &'a dyn Source,
    catalogues: &'a [String],
    catalogue: Catalogue,
    plan: &'a AlternativesPlan,
}

impl<'a> Judging<'a> {
    /// The inputs for a plan.
    ///
    /// # Errors
    /// [`AlternativesError::Refused`] for a catalogue that cannot be read.
    pub fn new(
        source: &'a dyn Source,
        catalogues: &'a [String],
        plan: &'a AlternativesPlan,
    ) -> Result<Judging<'a>, AlternativesError> {
        let catalogue = catalogue::load(source, catalogues).map_err(AlternativesError::Refused)?;
        Ok(Judging { source, catalogues, catalogue, plan })
    }

    /// Result of a task on the alternatives under its load; `None` if `watch` cancels, and for a
    /// task of another plan. Anything that an alternative lacks is reported with that alternative.
    pub fn judged(
        &self,
        prepared: &PreparedLoad,
        task: AlternativeTask,
        watch: Watch<'_>,
    ) -> Option<JudgedTask> {
        match task {
            AlternativeTask::Alternative { place, .. } => {
                let one = prepared.all.get(place)?.clone();
                let judged = self.alternative(prepared, one, watch)?;
                Some(JudgedTask::Alternative(Box::new(judged)))
            }
            AlternativeTask::Point { place, value } => {
                let plan = self.plan.front.as_ref()?;
                let at = (plan, *plan.values.get(value)?);
                front::point(self, prepared, prepared.all.get(place)?, at, watch).map(JudgedTask::Point)
            }
        }
    }

    /// An alternative of those under a load; `None` if `watch` cancels.
    fn alternative(
        &self,
        among: &PreparedLoad,
        one: PreparedAlternative,
        watch: Watch<'_>,
    ) -> Option<JudgedAlternative> {
        let outside = one.outside(&among.all);
        let PreparedAlternative { name, loaded, rig, no_hose, moved } = one;
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
            impedance_at: self.plan.impedance_at.clone(),
            counted: among.counted,
            rig: rig.map_err(JudgeError::from),
            sizing: sized(setup, &self.catalogue),
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
