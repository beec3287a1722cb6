//! The report: everything this workbench can say of a rig, as one page that needs nothing else.

mod audit;
mod bounds;
mod campaign;
mod chapter;
mod closed_loops;
mod derived;
mod design;
mod driving;
mod family_steps;
mod impedance;
mod load_motion;
mod models;
mod page;
mod provenance;
mod response;
mod rig;
mod simulation;
mod sizing;
mod specifications;
mod stiffness;
mod trial;
mod typeset;

use maud::{Markup, html};

pub(crate) use bounds::files as bound_files;
pub use chapter::Chapter;
pub use typeset::{prose, typeset};

use phea_qft::verification::{SpecificationFinding, Verdict};

use crate::answer::{OutputFile, significant};
use crate::audit::{ProjectAudit, audit_problem, verdict_words};
use crate::command::{CommandError, Watch};
use crate::control::{controller, sensor};
use crate::derived::derive;
use crate::figure::{Figure, FigureError};
use crate::linear_loop::{LinearLoop, LoopStability, StepView, linear_loop, settling_words};
use crate::linearize::{Linearization, linearize};
use crate::project::{Actuator, Loaded, Project, Signal};
use crate::quantity::DisplayUnit;
use crate::rig::Rig;
use crate::robust::robust_problem;
use crate::sizing::{Question, Sizing, SizingProblem, size};
use crate::source::Source;
use crate::trial::tried;

/// A report, before it is written anywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The page.
    pub html: String,
    /// Its figures, in order.
    pub figures: Vec<Figure>,
    /// Its data as tables for other programs.
    pub tables: Vec<OutputFile>,
    /// What it says in a few numbers.
    pub summary: Vec<(&'static str, String)>,
}

/// Band of the settling time where no scenario states one, percent.
const SETTLING_BAND: f64 = 1.0;

/// Scale of the figures as PNG: 1120 pixels of width.
const PNG_SCALE: f64 = 2.0;

/// The report of a project: rig, derived quantities, stiffness, sizing, linear models, impedance, response, simulation, campaign, specifications, templates
/// and bounds, the audit of the given controller, provenance; of a plant given as a transfer function, the robust part of it. Where the
/// project has `[design]`, or gives no controller, one is designed and shown beside the given one.
///
/// # Errors
/// [`CommandError`] if there is nothing to report on or something in it cannot be computed.
pub fn report(
    source: &dyn Source,
    loaded: &Loaded,
    problem: Option<&SizingProblem>,
    watch: Watch<'_>,
) -> Result<Report, CommandError> {
    let project = &loaded.project;
    let (mut chapters, mut facts) = match &project.actuator {
        Some(actuator) => rig_chapters(project, actuator, problem)?,
        None if project.specifications.is_empty() => return Err(CommandError::NothingToReport),
        None => (vec![], vec![]),
    };
    chapters.extend(simulation::chapter(source, project, watch)?);
    chapters.extend(campaign::chapter(source, loaded, watch)?);
    let mut tables = Vec::new();
    if !project.specifications.is_empty() {
        tables = robust_chapters(source, loaded, watch, (&mut chapters, &mut facts))?;
    }
    chapters.push(provenance::chapter(loaded));
    let html = page::page(&project.title, &heading(project, &facts), &chapters, &footer(loaded));
    let figures = chapters.into_iter().flat_map(|chapter| chapter.figures).collect();
    Ok(Report { html, figures, tables, summary: facts })
}

/// What the report says in a few numbers: name and text.
type Facts = Vec<(&'static str, String)>;

/// Adds the chapters on the robust method with their facts, and gives their tables.
fn robust_chapters(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
    (chapters, facts): (&mut Vec<Chapter>, &mut Facts),
) -> Result<Vec<OutputFile>, CommandError> {
    let project = &loaded.project;
    let robust = robust_problem(source, project)?;
    chapters.push(specifications::chapter(project, &robust)?);
    let view = match robust.has_controller {
        true => Some(audit_problem(&robust, watch)?),
        false => None,
    };
    let found = robust.at_design_frequencies(watch)?;
    chapters.push(bounds::chapter(&robust, &found, view.as_ref())?);
    let mut tables = bounds::files(&robust, &found);
    if let Some(view) = &view {
        let trial = tried(source, project, &robust, view, watch)?;
        chapters.push(audit::chapter(&robust, view, trial.as_ref())?);
        facts.push(("Audit of the controller", audit_words(view)));
        facts.extend(trial.map(|trial| ("Controller on the machine", trial::words(&trial))));
        tables.extend(crate::audit::files(view));
    }
    if design::is_asked_for(project) {
        let designed = design::designed(source, loaded, watch)?;
        chapters.push(designed.chapter(&found)?);
        facts.push(("Designed controller", designed.words()));
        facts.extend(
            designed.trial().map(|trial| ("Designed controller on the machine", trial::words(trial))),
        );
        tables.extend(designed.files(loaded));
    }
    Ok(tables)
}

/// The chapters on an actuator, and its facts.
fn rig_chapters(
    project: &Project,
    actuator: &Actuator,
    problem: Option<&SizingProblem>,
) -> Result<(Vec<Chapter>, Facts), CommandError> {
    let rig = Rig::new(project)?;
    let controller = controller(project)?;
    let sensor = sensor(project)?;
    let linearization = linearize(&rig, controller.as_ref(), &sensor)?;
    let derived = derive(project, &rig);
    let sizing = problem.map(|problem| size(problem, Question::Both));
    let band = project.scenarios.first().map_or(SETTLING_BAND, |scenario| scenario.settling_band_percent);
    let given = controller
        .as_ref()
        .map(|given| linear_loop(&linearization.plant.command, given, &sensor, band))
        .transpose()?;

    let mut chapters = vec![
        rig::chapter(project, actuator, &rig),
        derived::chapter(&derived),
        stiffness::chapter(&rig, &linearization),
    ];
    if let (Some(problem), Some(sizing)) = (problem, &sizing) {
        chapters.push(sizing::chapter(problem, sizing));
    }
    chapters.push(models::chapter(&linearization)?);
    chapters.push(impedance::chapter(project, &linearization)?);
    chapters.push(response::chapter(project, given.as_ref(), reference(project)));
    let facts = summary(&linearization, sizing.as_ref(), problem, given.as_ref());
    Ok((chapters, facts))
}

/// The verdict of the audit in a few words.
fn audit_words(view: &ProjectAudit) -> String {
    let kept = |finding: &&SpecificationFinding| finding.verdict == Verdict::Met;
    let findings = &view.audit.specifications;
    let met = findings.iter().filter(kept).count();
    let stable = match view.audit.stability.verdict {
        Verdict::Met => "stable",
        Verdict::Violated => "unstable",
        Verdict::NotProven => "not proven stable",
    };
    format!("{}: {stable}, {met} of {} specifications met", verdict_words(view.audit.verdict), findings.len())
}

impl Report {
    /// The page.
    pub fn page_file(&self) -> OutputFile {
        OutputFile { name: "report.html".to_string(), bytes: self.html.clone().into_bytes() }
    }

    /// The page and every figure as SVG and PNG.
    ///
    /// # Errors
    /// A figure that the rasteriser refuses.
    pub fn files(&self) -> Result<Vec<OutputFile>, FigureError> {
        let mut files = vec![self.page_file()];
        files.extend(self.tables.iter().cloned());
        for figure in &self.figures {
            let svg = figure.to_svg_standalone().into_bytes();
            files.push(OutputFile { name: format!("{}.svg", figure.name), bytes: svg });
            files.push(OutputFile { name: format!("{}.png", figure.name), bytes: figure.to_png(PNG_SCALE)? });
        }
        Ok(files)
    }
}

/// Height of the first reference step of the scenarios, N.
fn reference(project: &Project) -> Option<f64> {
    project
        .scenarios
        .iter()
        .flat_map(|scenario| &scenario.reference)
        .flat_map(Signal::steps)
        .map(|(_, force)| force)
        .find(|force| *force != 0.0)
}

fn summary(
    linearization: &Linearization,
    sizing: Option<&Sizing>,
    problem: Option<&SizingProblem>,
    given: Option<&LinearLoop>,
) -> Vec<(&'static str, String)> {
    let stiffness = linearization.stiffness[0];
    let mega = |value: f64| DisplayUnit::MEGANEWTON_PER_METRE.number(value, 3);
    let mut facts = vec![(
        "Hydraulic stiffness",
        format!("{} to {} MN/m", mega(stiffness.minimum), mega(stiffness.maximum)),
    )];
    let best = sizing.zip(problem).and_then(|(sizing, problem)| {
        sizing.candidates.iter().find(|c| c.accepted() && c.branch.model == problem.model)
    });
    if let Some(best) = best {
        let gain = significant(best.branch.gain_v_per_n, 3);
        facts.push(("Hose", format!("{} m a line at K_p = {gain} V/N", significant(best.length_m(), 3))));
    } else if sizing.is_some() {
        facts.push(("Hose", "none of the catalogue fits".to_string()));
    }
    let port =
        |view: &crate::linearize::PortView| if view.passivity.passive { "passive" } else { "not passive" };
    let mut passive = format!("open loop {}", port(&linearization.open_loop));
    if let Some(view) = &linearization.closed_loop {
        passive.push_str(&format!(", closed loop {}", port(view)));
    }
    facts.push(("Towards the load", passive));
    facts.extend(given.map(|given| ("Nominal linear loop", loop_words(given))));
    facts
}

/// The linear loop in a few words: its step, or that there is none.
fn loop_words(given: &LinearLoop) -> String {
    match (&given.stability, &given.step) {
        (LoopStability::Unstable, _) => "unstable".to_string(),
        (_, Err(reason)) => format!("no step response: {reason}"),
        (_, Ok(StepView { metrics, .. })) => {
            let verb = if metrics.settling.time_s().is_some() { "settles in " } else { "" };
            let overshoot = significant(metrics.overshoot_percent, 2);
            format!("{overshoot} % overshoot, {verb}{}", settling_words(metrics))
        }
    }
}

fn heading(project: &Project, summary: &[(&'static str, String)]) -> Markup {
    html! {
        header {
            h1 { (project.title) }
            p.subtitle {
                @if project.actuator.is_some() { "Hydraulic force control through added compliance: sizing, linear models, robust control" }
                @else { "Robust control of an uncertain plant" }
            }
            dl.facts { @for (name, value) in summary { div class=(fact_class(value)) { dt { (name) } dd { (prose(value)) } } } }
        }
    }
}

/// The class of a fact: its edge tells what its first word says too.
fn fact_class(value: &str) -> &'static str {
    match value.split([':', ' ']).next() {
        Some("met" | "agrees") => "fact good-edge",
        Some("violated" | "contradicts" | "infeasible" | "unstable" | "none") => "fact bad-edge",
        _ => "fact",
    }
}

fn footer(loaded: &Loaded) -> Markup {
    html! {
        p { "Made by phea " (env!("CARGO_PKG_VERSION")) " from a project with SHA-256 " code { (loaded.sha256) } "." }
        p { "Equations are numbered as in Ledezma (2019), Universidade Federal de Santa Catarina; corrected where its book of errata says so." }
    }
}
