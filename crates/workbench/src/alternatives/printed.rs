//! An alternative as it is printed: all that text, JSON, files and figures state about it. It is
//! much smaller than the judgement from which it is made, and can be sent between computers.

mod columns;
mod drawn;
mod encoding;
mod front;
mod joined;
mod sentences;
mod status;

pub(crate) use columns::{PrintedColumn, PrintedPart, Unprintable, at, parts};
pub(crate) use drawn::DrawnImpedance;
pub(crate) use encoding::{EncodedTask, decoded, encoded};
pub(crate) use front::{PrintedFront, PrintedPoint, PrintedValue};
pub(crate) use joined::{PrintedAlternatives, PrintedCase, joined};
pub(crate) use sentences::{AlternativeSentences, outside_words};
pub(crate) use status::{MarkedOutcome, PassivityStatus};

use phea_engineering::alternatives::{
    AlternativeTask, AlternativesPlan, JudgedAlternative, JudgedTask, WorstColumns,
};
use phea_engineering::simulate::ScenarioRun;
use phea_qft::design::{ControllerChoice, DesignStatus};
use serde::{Deserialize, Serialize};

use super::answer;
use crate::answer::{Body, Object};
use crate::project::{IdentifiedUse, Project, print};
use crate::quantity::MotionKind;
use crate::simulate::OverlaidRun;

/// Result of a task of an [`AlternativesPlan`], as it is printed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum PrintedTask {
    /// The alternative under a load.
    Alternative(Box<PrintedAlternative>),
    /// The alternative at a value of the front.
    Point(PrintedPoint),
}

impl PrintedTask {
    /// The result in a project whose alternatives have this motion.
    pub(crate) fn of(judged: JudgedTask, motion: MotionKind) -> PrintedTask {
        match judged {
            JudgedTask::Alternative(judged) => {
                PrintedTask::Alternative(Box::new(PrintedAlternative::of(&judged, motion)))
            }
            JudgedTask::Point(point) => PrintedTask::Point(PrintedPoint::of(point, motion)),
        }
    }

    /// True if the result may be that of a task of a plan: it has its alternative and value.
    pub(crate) fn is_of(&self, task: AlternativeTask, plan: &AlternativesPlan) -> bool {
        match (self, task) {
            (PrintedTask::Alternative(one), AlternativeTask::Alternative { place, .. }) => {
                plan.names.get(place) == Some(&one.name)
            }
            (PrintedTask::Point(point), AlternativeTask::Point { place, value }) => {
                let value = plan.front.as_ref().and_then(|front| front.values.get(value));
                plan.names.get(place) == Some(&point.alternative) && value == Some(&point.value)
            }
            _ => false,
        }
    }
}

/// An alternative under a load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PrintedAlternative {
    /// Name of the alternative.
    pub(crate) name: String,
    /// True if it has a design whose simulation gave results that describe the machine.
    pub(crate) is_judged: bool,
    /// True if it may dominate another.
    pub(crate) is_comparable: bool,
    /// True if the designed loop satisfies every specification; `None` if this is unknown.
    pub(crate) feasible: Option<bool>,
    /// Relaxation of every limit of infeasible specifications, dB.
    pub(crate) infeasible_by_db: Option<f64>,
    /// Greatest order of the controller, if the order was free.
    pub(crate) maximum_order: Option<usize>,
    /// True if the rig has linear models.
    pub(crate) has_models: bool,
    /// Stability of every plant of the family with the declared load.
    pub(crate) stable: Option<MarkedOutcome>,
    /// Agreement of the machine with the verdict.
    pub(crate) machine: Option<MarkedOutcome>,
    /// Passivity of the impedance at the load, of the open and of the closed loop.
    pub(crate) passive: [Option<PassivityStatus>; 2],
    /// All numbers.
    pub(crate) columns: Vec<PrintedColumn>,
    /// Worst value of each number.
    #[serde(with = "encoding::worst_columns")]
    pub(crate) worst: WorstColumns,
    /// Scenarios of the settling times with their bands, %.
    pub(crate) settling_bands: Vec<(String, f64)>,
    /// Sentences about the alternative.
    pub(crate) sentences: AlternativeSentences,
    /// The alternative in JSON.
    pub(crate) body: Object,
    /// Project file with the designed controller.
    pub(crate) deployed: Option<String>,
    /// Run of the first scenario.
    pub(crate) run: Option<OverlaidRun>,
    /// Impedance at the load.
    pub(crate) impedance: Option<DrawnImpedance>,
}

impl PrintedAlternative {
    fn of(one: &JudgedAlternative, motion: MotionKind) -> PrintedAlternative {
        let columns = one.columns();
        let runs = one.runs.as_deref().unwrap_or_default();
        PrintedAlternative {
            name: one.name.clone(),
            is_judged: one.is_judged(),
            is_comparable: one.is_comparable(),
            feasible: one.feasible(),
            infeasible_by_db: infeasible_by_db(one),
            maximum_order: maximum_order(one),
            has_models: one.linearization.is_ok(),
            stable: status::stable(one),
            machine: status::machine(one),
            passive: [false, true].map(|closed| status::passive(one, closed)),
            worst: columns.worst_of_each(),
            columns: columns.0.into_iter().map(PrintedColumn::of).collect(),
            settling_bands: runs.iter().flat_map(settling_bands).collect(),
            sentences: AlternativeSentences::of(one),
            body: answer::alternative(one).into_object().for_motion(motion),
            deployed: one.deployed.as_ref().ok().map(deployed),
            run: runs.first().map(OverlaidRun::of),
            impedance: DrawnImpedance::of(one),
        }
    }
}

fn infeasible_by_db(one: &JudgedAlternative) -> Option<f64> {
    match &one.design.as_ref().ok()?.design.status {
        DesignStatus::Infeasible(relaxation) => Some(relaxation.relaxation_db),
        _ => None,
    }
}

fn maximum_order(one: &JudgedAlternative) -> Option<usize> {
    match one.design.as_ref().ok()?.options.controller {
        ControllerChoice::Grow { maximum_order } | ControllerChoice::Any { maximum_order, .. } => {
            Some(maximum_order)
        }
        ControllerChoice::Given(_) | ControllerChoice::Named { .. } => None,
    }
}

fn settling_bands(run: &ScenarioRun) -> impl Iterator<Item = (String, f64)> {
    let settled = run.windows.iter().filter(|(_, metrics)| metrics.settling_time_s.is_ok());
    settled.map(|(_, metrics)| (run.name.clone(), metrics.settling_band_percent))
}

/// Project file of an alternative without the others.
fn deployed(project: &Project) -> String {
    let mut project = Project { alternatives: vec![], load_cases: vec![], ..project.clone() };
    // the numbers from the recordings are in the project: the recordings need not be in its folder
    if let Some(identify) = &mut project.identify {
        identify.takes = IdentifiedUse::Nothing;
    }
    print(&project)
}
