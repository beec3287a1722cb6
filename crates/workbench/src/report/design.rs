//! The chapter on the design: the designed controller compared with the given one, in figures of
//! both, and the cost of the specifications.

mod loops;
mod magnitudes;
mod prefilter;
mod sampling;

use phea_dynamics::watch::{Stopped, Watch};
use phea_engineering::design::{DesignError, ProjectDesign, design_project};
use phea_engineering::robust::DesignFrequency;
use phea_engineering::setup::Setup;
use phea_engineering::trial::Trial;
use phea_qft::design::DesignStatus;
use phea_qft::verification::Verdict;

pub(super) use magnitudes::figures as magnitudes;
pub(super) use prefilter::figures as prefilters;

use super::chapter::Chapter;
use super::family_steps;
use crate::answer::{OutputFile, significant};
use crate::audit::basis;
use crate::design::{
    costs, files, laws, limits, manual, pressure_feedback, side_by_side, status, structures,
};
use crate::document::{Document, StatusMark};
use crate::error::CommandError;
use crate::explanation::explanation_sentence;
use crate::figure::Figure;
use crate::impossible_steps::late_of_steps;
use crate::project::{LateError, Loaded, Project};
use crate::source::Source;
use crate::trial;

/// True if the report of a project designs a controller: the project has `[design]`, or gives no
/// controller.
pub(super) fn is_requested(project: &Project) -> bool {
    let has_law = project.controller.as_ref().is_some_and(|controller| controller.has_law());
    !project.specifications.is_empty() && (project.design.is_some() || !has_law)
}

/// The result of the design.
pub(super) enum Designed {
    Found(Box<FoundDesign>),
    /// Reason why there is none, in sentences.
    Nothing(Vec<String>),
    /// Required steps that no controller makes on the rig, in sentences.
    Impossible(Vec<String>),
}

/// A design with the results that the chapter compares it with.
pub(super) struct FoundDesign {
    view: ProjectDesign,
}

/// Searches for a controller.
///
/// # Errors
/// Errors that leave nothing to report; a search that finds no controller is not an error.
pub(super) fn designed(
    source: &dyn Source,
    setup: &Setup<'_>,
    watch: Watch<'_>,
) -> Result<Designed, CommandError> {
    let view = match design_project(source, setup, None, watch).map_err(CommandError::from) {
        Ok(view) if view.is_stopped() => return Err(Stopped.into()),
        Ok(view) => view,
        Err(CommandError::Design(DesignError::NoController(known))) => {
            let none = "the search ended without a controller that makes every plant stable".to_string();
            let known = known.iter().map(explanation_sentence);
            return Ok(Designed::Nothing(std::iter::once(none).chain(known).collect()));
        }
        Err(CommandError::Design(DesignError::ImpossibleSteps(found))) => {
            return Ok(Designed::Impossible(late_of_steps(&found).iter().map(LateError::sentence).collect()));
        }
        Err(CommandError::Design(error)) => return Ok(Designed::Nothing(vec![error.to_string()])),
        Err(error) => return Err(error),
    };
    Ok(Designed::Found(Box::new(FoundDesign { view })))
}

impl Designed {
    /// The design, if one was found.
    pub(super) fn found(&self) -> Option<&ProjectDesign> {
        match self {
            Designed::Found(found) => Some(&found.view),
            Designed::Nothing(_) | Designed::Impossible(_) => None,
        }
    }

    /// The chart of both loops among the bounds; `None` without a design or a nominal plant.
    ///
    /// # Errors
    /// A loop that cannot be computed.
    pub(super) fn nichols(&self, bounds: &[DesignFrequency]) -> Result<Option<Figure>, CommandError> {
        self.found().map_or(Ok(None), |view| Ok(loops::figure(view, bounds)?))
    }

    /// The design in a few words.
    pub(super) fn words(&self) -> String {
        let Designed::Found(found) = self else { return "none found".to_string() };
        let side = &found.view.designed;
        let prefilter = match side.problem.has_prefilter {
            true => format!(" with a prefilter of order {}", side.figures.prefilter_order),
            false => String::new(),
        };
        let order = format!("order {}{prefilter}", side.figures.order);
        match &found.view.design.status {
            DesignStatus::Met if side.view.verdict() == Verdict::NotProven => {
                format!("not proven: {order}")
            }
            DesignStatus::Met if side.view.misses_in_time() => format!("missed in time: {order}"),
            DesignStatus::Met if found.view.misses_on_rig() => {
                format!("missed in time by the nonlinear rig: {order}")
            }
            DesignStatus::Met => format!("met: {order}"),
            DesignStatus::Infeasible(relaxation) => {
                format!("infeasible by {} dB: {order}", significant(relaxation.relaxation_db, 3))
            }
            DesignStatus::NotConverged { .. } => format!("not converged: {order}"),
            DesignStatus::NotStabilised => "none that makes every plant stable".to_string(),
        }
    }

    /// The trial of the designed controller on the machine.
    pub(super) fn trial(&self) -> Option<&Trial> {
        match self {
            Designed::Found(found) => found.view.trial.as_ref(),
            Designed::Nothing(_) | Designed::Impossible(_) => None,
        }
    }

    /// The project with the designed controller and prefilter.
    pub(super) fn files(&self, loaded: &Loaded) -> Vec<OutputFile> {
        match self {
            Designed::Found(found) => files(loaded, &found.view),
            Designed::Nothing(_) | Designed::Impossible(_) => vec![],
        }
    }

    /// The chapter.
    ///
    /// # Errors
    /// A loop that cannot be computed.
    pub(super) fn chapter(&self) -> Result<Chapter, CommandError> {
        match self {
            Designed::Found(design) => chapter(design),
            Designed::Nothing(sentences) | Designed::Impossible(sentences) => {
                let mut out = Document::default();
                out.verdict(StatusMark::Bad, "No controller was designed", sentences.clone());
                Ok(Chapter::of(ANCHOR, TITLE, out))
            }
        }
    }
}

const ANCHOR: &str = "design";
const TITLE: &str = "Design of the controller";

/// Name and title of the figure of the trial.
const MACHINE_STEPS: [&str; 2] =
    ["design_machine_steps", "The designed controller in the nonlinear simulation"];

/// The figures of the trial of the designed controller.
pub(super) fn figures_of_trial(trial: &Trial) -> Vec<Figure> {
    trial::document(trial, Some(MACHINE_STEPS)).into_figures()
}

/// Step responses of the family with the designed controller, or the reason why there are none;
/// empty if no tracking is specified.
pub(super) fn family_steps_of(view: &ProjectDesign) -> Document {
    let side = &view.designed;
    let names = ["design_steps", "Step responses of the family with the designed controller"];
    let mut out = Document::default();
    match family_steps::figure(&side.problem, &side.view, names) {
        Some(Ok(figure)) => out.figures([figure]),
        Some(Err(reason)) => out.explanation(format!("No step responses of the family: {reason}.")),
        None => {}
    }
    out
}

fn chapter(found: &FoundDesign) -> Result<Chapter, CommandError> {
    let view = &found.view;
    let side = &view.designed;
    let mut out = status(view);
    if let Some(trial) = &view.trial {
        out.append(trial::document(trial, Some(MACHINE_STEPS)));
    }
    out.append(pressure_feedback(view));
    out.heading("The designed controller");
    out.append(laws(side)?);
    out.append(manual(view));
    if let Some(published) = &view.published {
        out.heading("The given controller");
        out.append(laws(published)?);
    }
    out.append(side_by_side(view));
    if let Some(continuous) = &view.continuous {
        out.explanation(sampling::sentence(side, continuous));
    }
    out.explanation("The first page has the Nichols chart.");
    out.figures_below("The closed loops of the family", magnitudes::figures(view)?);
    out.figures_below("The prefilter", prefilter::figures(view)?);
    out.append(family_steps_of(view));
    out.append(structures(view));
    out.append(limits(view));
    out.append(costs(view));
    out.heading("What this rests on");
    out.sentences(basis(&side.view));
    Ok(Chapter::of(ANCHOR, TITLE, out))
}
