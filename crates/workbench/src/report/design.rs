//! The chapter on the design: the controller that was found beside the one that was given, in the figures of both, and what the
//! specifications cost it.

mod loops;
mod magnitudes;
mod prefilter;
mod sampling;
mod tables;

use maud::{Markup, html};
use phea_engineering::error::ProcedureError;
use phea_qft::design::DesignStatus;
use phea_qft::verification::Verdict;

use super::audit::verdict_edge;
use super::chapter::{Chapter, place};
use super::family_steps;
use super::trial;
use super::typeset::prose;
use crate::answer::{OutputFile, significant};
use crate::audit::{basis, summary};
use crate::command::{CommandError, Watch};
use crate::design::{
    DesignError, ProjectDesign, Rounding, design_project, explanation_words, files, status_sentence,
};
use crate::figure::Figure;
use crate::project::{Loaded, Project};
use crate::robust::DesignFrequency;
use crate::setup::Setup;
use crate::source::Source;
use crate::trial::Trial;

/// Whether the report of a project looks for a controller: where it says how, or gives none.
pub(super) fn is_asked_for(project: &Project) -> bool {
    let has_law = project.controller.as_ref().is_some_and(|controller| controller.has_law());
    !project.specifications.is_empty() && (project.design.is_some() || !has_law)
}

/// What came of looking for a controller.
pub(super) enum Designed {
    Found(Box<FoundDesign>),
    /// Why there is none, in sentences.
    Nothing(Vec<String>),
}

/// A design with what the chapter compares it with.
pub(super) struct FoundDesign {
    view: ProjectDesign,
}

/// Looks for a controller.
///
/// # Errors
/// Those that leave nothing to report; that no controller is found is not among them.
pub(super) fn designed(
    source: &dyn Source,
    setup: &Setup<'_>,
    watch: Watch<'_>,
) -> Result<Designed, CommandError> {
    let view = match design_project(source, setup, None, watch) {
        Ok(view) if view.stopped => return Err(ProcedureError::Stopped.into()),
        Ok(view) => view,
        Err(ProcedureError::Design(DesignError::NoController(mut sentences))) => {
            sentences
                .insert(0, "the search ended without a controller that makes every plant stable".to_string());
            return Ok(Designed::Nothing(sentences));
        }
        Err(ProcedureError::Design(error)) => return Ok(Designed::Nothing(vec![error.to_string()])),
        Err(error) => return Err(error.into()),
    };
    Ok(Designed::Found(Box::new(FoundDesign { view })))
}

impl Designed {
    /// The design, where one was found.
    pub(super) fn found(&self) -> Option<&ProjectDesign> {
        match self {
            Designed::Found(found) => Some(&found.view),
            Designed::Nothing(_) => None,
        }
    }

    /// The chart of both loops among the bounds; `None` without a design or a nominal plant.
    ///
    /// # Errors
    /// A loop that cannot be computed.
    pub(super) fn nichols(&self, bounds: &[DesignFrequency]) -> Result<Option<Figure>, CommandError> {
        self.found().map_or(Ok(None), |view| Ok(loops::figure(view, bounds)?))
    }

    /// In a few words.
    pub(super) fn words(&self) -> String {
        let Designed::Found(found) = self else { return "none found".to_string() };
        let side = &found.view.designed;
        let prefilter = match side.problem.has_prefilter {
            true => format!(" with a prefilter of order {}", side.figures.prefilter_order),
            false => String::new(),
        };
        let order = format!("order {}{prefilter}", side.figures.order);
        match &found.view.design.status {
            DesignStatus::Met if side.view.audit.verdict == Verdict::NotProven => {
                format!("not proven: {order}")
            }
            DesignStatus::Met => format!("met: {order}"),
            DesignStatus::Infeasible(relaxation) => {
                format!("infeasible by {} dB: {order}", significant(relaxation.relaxation_db, 3))
            }
            DesignStatus::NotConverged { .. } => format!("not converged: {order}"),
            DesignStatus::NotStabilised => "none that makes every plant stable".to_string(),
        }
    }

    /// What the machine does under the designed controller.
    pub(super) fn trial(&self) -> Option<&Trial> {
        match self {
            Designed::Found(found) => found.view.trial.as_ref(),
            Designed::Nothing(_) => None,
        }
    }

    /// The project with the designed laws in it.
    pub(super) fn files(&self, loaded: &Loaded) -> Vec<OutputFile> {
        match self {
            Designed::Found(found) => files(loaded, &found.view),
            Designed::Nothing(_) => vec![],
        }
    }

    /// The chapter.
    ///
    /// # Errors
    /// A loop that cannot be computed.
    pub(super) fn chapter(&self) -> Result<Chapter, CommandError> {
        match self {
            Designed::Found(design) => chapter(design),
            Designed::Nothing(sentences) => Ok(Chapter {
                anchor: ANCHOR,
                title: TITLE,
                body: html! {
                    div.callout.bad-edge {
                        p { b { "No controller was designed." } }
                        ul { @for sentence in sentences { li { (prose(sentence)) } } }
                    }
                },
                figures: vec![],
            }),
        }
    }
}

const ANCHOR: &str = "design";
const TITLE: &str = "Design of the controller";

fn chapter(found: &FoundDesign) -> Result<Chapter, CommandError> {
    let view = &found.view;
    let side = &view.designed;
    let magnitudes = magnitudes::figures(view)?;
    let prefilters = prefilter::figures(view)?;
    let steps = family_steps::figure(
        &side.problem,
        &side.view,
        ["design_steps", "Step responses of the family with the designed controller"],
    );
    let driven = trial::figure(
        view.trial.as_ref(),
        ["design_machine_steps", "The designed controller on the machine"],
    );
    let body = html! {
        (status(view))
        (trial::section(view.trial.as_ref(), driven.as_ref()))
        h3 { "The laws" }
        (tables::laws(view)?)
        h3 { @if view.published.is_some() { "Given and designed side by side" } @else { "What it reaches" } }
        (tables::comparison(view))
        @if let Some(continuous) = &view.continuous { p { (sampling::sentence(side, continuous)) } }
        p { "The first page has the Nichols chart." }
        (opened("The closed loops of the family", &magnitudes.iter().collect::<Vec<_>>()))
        (opened("The prefilter", &prefilters.iter().collect::<Vec<_>>()))
        @match &steps {
            Some(Ok(figure)) => (place(figure)),
            Some(Err(reason)) => p { "No step responses of the family: " (reason) "." },
            None => {},
        }
        (tables::conflicts(view))
        h3 { "What the specifications cost" }
        (tables::binding(view))
        h3 { "How it was found" }
        (tables::rounds(view))
        h3 { "What this rests on" }
        ul { @for sentence in basis(&side.view) { li { (prose(&sentence)) } } }
    };
    let mut figures: Vec<Figure> = driven.into_iter().chain(magnitudes).chain(prefilters).collect();
    figures.extend(steps.and_then(Result::ok));
    Ok(Chapter { anchor: ANCHOR, title: TITLE, body, figures })
}

/// A heading above figures; nothing without them.
fn opened(heading: &str, figures: &[&Figure]) -> Markup {
    html! {
        @if !figures.is_empty() { h3 { (heading) } }
        @for figure in figures { (place(figure)) }
    }
}

/// How the search ended, what can be said whatever a search finds, and what the audit says of what was found.
fn status(view: &ProjectDesign) -> Markup {
    html! {
        div class=(verdict_edge(view.designed.view.audit.verdict)) {
            p { b { "Design " (status_sentence(view)) "." } }
            ul {
                @for explanation in &view.explanations { li { (prose(&explanation_words(view, explanation))) } }
                @for sentence in summary(&view.designed.view) { li { (prose(&sentence)) } }
                @for sentence in view.rounding.iter().flat_map(Rounding::sentences) { li { (prose(&sentence)) } }
            }
        }
    }
}
