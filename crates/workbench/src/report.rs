//! The report: everything this workbench can say of a rig, as one page that needs nothing else.

mod chapter;
mod derived;
mod impedance;
mod load_motion;
mod models;
mod page;
mod provenance;
mod response;
mod rig;
mod sizing;
mod stiffness;
mod typeset;

use maud::{Markup, html};

pub use chapter::Chapter;
pub use typeset::{prose, typeset};

use crate::answer::{OutputFile, significant};
use crate::command::CommandError;
use crate::control::{controller, sensor};
use crate::derived::derive;
use crate::figure::{Figure, FigureError};
use crate::linear_loop::{LinearLoop, LoopStability, StepView, linear_loop, settling_words};
use crate::linearize::{Linearization, linearize};
use crate::project::{Loaded, Project};
use crate::quantity::DisplayUnit;
use crate::rig::{Rig, RigError};
use crate::sizing::{Question, Sizing, SizingProblem, size};

/// A report, before it is written anywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The page.
    pub html: String,
    /// Its figures, in order.
    pub figures: Vec<Figure>,
    /// What it says in a few numbers.
    pub summary: Vec<(&'static str, String)>,
}

/// Band of the settling time where no scenario states one, percent.
const SETTLING_BAND: f64 = 1.0;

/// Scale of the figures as PNG: 1120 pixels of width.
const PNG_SCALE: f64 = 2.0;

/// The report of a project: rig, derived quantities, stiffness, sizing, linear models, impedance, response, provenance.
///
/// # Errors
/// [`CommandError`] if the project is about another plant or something in it cannot be computed.
pub fn report(loaded: &Loaded, problem: Option<&SizingProblem>) -> Result<Report, CommandError> {
    let project = &loaded.project;
    let rig = Rig::new(project)?;
    let actuator = project.actuator.as_ref().ok_or(RigError::NoActuator)?;
    let controller = controller(project)?;
    let sensor = sensor(project)?;
    let linearization = linearize(&rig, controller.as_ref(), &sensor)?;
    let derived = derive(project, &rig);
    let sizing = problem.map(|problem| size(problem, Question::Both));
    let band = project.scenarios.first().map_or(SETTLING_BAND, |scenario| scenario.settling_band_percent);
    let given = controller
        .as_ref()
        .map(|given| linear_loop(&linearization.full.command, given, &sensor, band))
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
    chapters.push(response::chapter(given.as_ref(), reference(project)));
    chapters.push(provenance::chapter(loaded));

    let summary = summary(&linearization, sizing.as_ref(), problem, given.as_ref());
    let html = page::page(&project.title, &heading(project, &summary), &chapters, &footer(loaded));
    let figures = chapters.into_iter().flat_map(|chapter| chapter.figures).collect();
    Ok(Report { html, figures, summary })
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
        .map(|step| step.force)
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
            p.subtitle { "Hydraulic force control through added compliance: sizing and linear models" }
            dl.facts { @for (name, value) in summary { div.fact { dt { (name) } dd { (prose(value)) } } } }
        }
    }
}

fn footer(loaded: &Loaded) -> Markup {
    html! {
        p { "Made by phea " (env!("CARGO_PKG_VERSION")) " from a project with SHA-256 " code { (loaded.sha256) } "." }
        p { "Equations are numbered as in Ledezma (2019), Universidade Federal de Santa Catarina; corrected where its book of errata says so." }
    }
}
