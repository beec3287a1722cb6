//! The report: all results for a rig, as one self-contained page.

mod alternatives;
mod answer;
mod assumptions;
mod audit;
mod bounds;
mod campaign;
mod chapter;
mod closed_loops;
mod design;
mod driven;
mod driving;
mod family_origin;
mod family_steps;
mod impedance;
mod judged;
mod load_motion;
mod models;
mod of_answers;
mod opening;
mod page;
mod proven;
mod provenance;
mod recorded_friction;
mod response;
mod rig;
mod sensitivity;
mod simulation;
mod sizing;
mod specifications;
mod stiffness;
mod test_bench;

pub(crate) use answer::{ReportAnswer, body};
pub use campaign::runs_within_budget;
pub(crate) use of_answers::{of_audit, of_design, of_models, of_sizing};
pub use opening::{DecidedAnswer, DecisionAnswer};
pub(crate) use stiffness::positions;

use phea_dynamics::watch::{Watch, within};
use phea_engineering::audit::{ProjectAudit, TimeFinding};
use phea_engineering::linear_loop::{LinearLoop, LoopStability, StepView, linear_loop_of};
use phea_engineering::linearize::{Linearization, linearize, stiffness_at_settings};
use phea_engineering::rig::Rig;
use phea_engineering::setup::Setup;
use phea_engineering::sizing::{Question, Sizing, SizingError, SizingProblem, size};
use phea_qft::verification::{SpecificationFinding, Verdict};

use crate::alternatives::PrintedAlternatives;
use crate::answer::{OutputFile, picture_files, significant};
use crate::audit::{CERTIFICATE_FILE, certificate_of};
use crate::derived::{self, derive};
use crate::error::CommandError;
use crate::figure::Figure;
use crate::linearize::stiffness_words;
use crate::project::{DeclaredActuator, InputSignal, Loaded, Project, WrittenUnits};
use crate::quantity::MotionKind;
use crate::sizing::{hose_name, length_words};
use crate::source::Source;
use crate::verdict_words::verdict_words;

use campaign::CampaignChapter;
use chapter::Chapter;
use driven::MachineChapter;
use judged::Judged;
use opening::{Contents, opening};
use page::Page;

/// A report, before it is written anywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The page.
    pub html: String,
    /// The figures, in order.
    pub figures: Vec<Figure>,
    /// The data as tables for other programs.
    pub tables: Vec<OutputFile>,
    /// The content in a few numbers.
    pub summary: Vec<(&'static str, String)>,
    /// What its first page says.
    pub decision: DecisionAnswer,
}

/// The fact on the linear step, which the first page states for the machine instead.
const NOMINAL_LOOP: &str = "Nominal linear loop";

/// Band of the settling time if no scenario states one, percent.
const SETTLING_BAND: f64 = 1.0;

/// The report of a project: the page that decides, then rig, sizing, simulation, campaign,
/// specifications, audit and design; in the appendix derived quantities, stiffness, linear models,
/// impedance, the linear step, the signals inside the machine, its sensitivity, templates and
/// bounds, provenance. For a plant given as a transfer function, only the robust part. If the
/// project has `[design]`, or gives no controller, one is designed, and everything is shown for
/// both.
///
/// # Errors
/// [`CommandError`] if there is nothing to report on or something in it cannot be computed.
pub fn report(
    source: &dyn Source,
    loaded: &Loaded,
    setup: &Setup<'_>,
    problem: Option<&ProblemOfSizing>,
    watch: Watch<'_>,
) -> Result<Report, CommandError> {
    report_next_to(source, loaded, (setup, problem), None, watch)
}

/// The chapters on recordings of the valve and of the friction.
fn recordings(source: &dyn Source, loaded: &Loaded, watch: Watch<'_>) -> Result<Vec<Chapter>, CommandError> {
    let of_valve = test_bench::chapter(source, loaded, &mut within(&mut *watch, [0.0, 0.6]))?;
    let of_friction = recorded_friction::chapter(source, loaded, &mut within(watch, [0.6, 1.0]))?;
    Ok(of_valve.into_iter().chain(of_friction).collect())
}

/// The report, with the chapter on the alternatives of the project if they were judged.
///
/// # Errors
/// Errors of [`report`].
pub(crate) fn report_next_to(
    source: &dyn Source,
    loaded: &Loaded,
    (setup, problem): (&Setup<'_>, Option<&ProblemOfSizing>),
    alternatives: Option<&PrintedAlternatives>,
    watch: Watch<'_>,
) -> Result<Report, CommandError> {
    let project = &loaded.project;
    if project.actuator.is_none() && project.specifications.is_empty() {
        return Err(CommandError::NothingToReport);
    }
    let mut rig = rig_part(setup, loaded, problem)?;
    let judged = judged::judged(source, setup, &mut within(&mut *watch, [0.0, 0.6]))?;
    let deployed = judged.as_ref().and_then(Judged::found).map(|view| view.deployed(project));
    let driven = driven::driven(source, setup, deployed.as_ref(), &mut within(&mut *watch, [0.6, 0.75]))?;
    let campaign = campaign_of(source, loaded, deployed.as_ref(), &mut within(&mut *watch, [0.75, 0.85]))?;
    let mut facts = rig.as_ref().map(|rig| rig.facts.clone()).unwrap_or_default();
    let mut results: Facts = driven.iter().flat_map(MachineChapter::facts).collect();
    results.extend(campaign.as_ref().and_then(|campaign| campaign.fact.clone()));
    let contents = Contents {
        setup,
        judged: judged.as_ref(),
        driven: driven.as_ref(),
        facts: &facts,
        results: &results,
        campaign: campaign.as_ref().map(|campaign| campaign.steps.as_slice()).unwrap_or_default(),
        no_hose_fits: rig.as_ref().is_some_and(|rig| rig.no_hose_fits),
    };
    let charts = judged.as_ref().map(charts).transpose()?.unwrap_or_default();
    let (first, decision) = opening(&contents, charts.opening);
    facts.extend(results);
    facts.extend(judged.iter().flat_map(verdict_facts));

    let mut chapters: Vec<Chapter> =
        rig.as_mut().map(|rig| std::mem::take(&mut rig.chapters)).unwrap_or_default();
    let mut appendix: Vec<Chapter> = rig.map(|rig| rig.appendix).unwrap_or_default();
    chapters.extend(recordings(source, loaded, &mut within(&mut *watch, [0.85, 0.9]))?);
    if let Some(driven) = &driven {
        chapters.push(simulation::chapter(project, driven));
        appendix.extend(simulation::inside(project, driven));
        let has_given = driven.sides.first().is_some_and(|side| side.name == driven::GIVEN);
        let varied = deployed.as_ref().filter(|_| !has_given).unwrap_or(project);
        appendix.extend(sensitivity::chapter(source, varied, driven, &mut within(&mut *watch, [0.9, 0.95]))?);
    }
    chapters.extend(campaign.map(|campaign| campaign.chapter));
    chapters.extend(alternatives::chapter(project, alternatives));
    let mut tables = Vec::new();
    if let Some(judged) = &judged {
        let watch = &mut within(watch, [0.95, 1.0]);
        chapters.extend(family_origin::chapter(source, setup, judged, watch)?);
        chapters.extend(robust_chapters(project, judged)?);
        appendix.push(bounds::chapter(&judged.problem, &judged.bounds, charts.appendix));
        tables = robust_tables(loaded, judged);
    }
    appendix.push(provenance::chapter(loaded, has_law(project) || deployed.is_some()));
    let page = Page {
        title: &project.title,
        subtitle: subtitle(project),
        opening: &first,
        chapters: &chapters,
        appendix: &appendix,
        sha256: &loaded.sha256,
    };
    let html = page.html();
    let all = std::iter::once(first).chain(chapters).chain(appendix);
    let figures = all.flat_map(|chapter| chapter.document.into_figures()).collect();
    Ok(Report { html, figures, tables, summary: facts, decision })
}

/// The input of the sizing procedure, or the reason why it does not apply to the rig.
pub type ProblemOfSizing = Result<SizingProblem, SizingError>;

/// The campaign of a project; of one without a controller under the designed one.
fn campaign_of(
    source: &dyn Source,
    loaded: &Loaded,
    deployed: Option<&Project>,
    watch: Watch<'_>,
) -> Result<Option<CampaignChapter>, CommandError> {
    match deployed.filter(|_| !has_law(&loaded.project)) {
        None => campaign::driven(source, (loaded, false), watch),
        Some(deployed) => {
            let designed = Loaded { project: deployed.clone(), ..loaded.clone() };
            campaign::driven(source, (&designed, true), watch)
        }
    }
}

/// True if a project gives a controller.
fn has_law(project: &Project) -> bool {
    project.controller.as_ref().is_some_and(|controller| controller.has_law())
}

/// The report in a few numbers: name and text.
type Facts = Vec<(&'static str, String)>;

/// Nichols charts: the one of the first page, and the one of the given loop only, if it is
/// different.
#[derive(Default)]
struct Charts {
    opening: Option<Figure>,
    appendix: Option<Figure>,
}

fn charts(judged: &Judged) -> Result<Charts, CommandError> {
    let Judged { problem, bounds, given, designed, .. } = judged;
    let given = bounds::chart(problem, bounds, given.as_ref())?;
    let both = designed.as_ref().map(|designed| designed.nichols(bounds)).transpose()?.flatten();
    Ok(match both {
        Some(both) => Charts { opening: Some(both), appendix: given },
        None => Charts { opening: given, appendix: None },
    })
}

/// The chapters on specifications, audit and design.
fn robust_chapters(project: &Project, judged: &Judged) -> Result<Vec<Chapter>, CommandError> {
    let mut chapters = vec![specifications::chapter(project, &judged.problem)?];
    if let Some(view) = &judged.given {
        chapters.push(audit::chapter(&judged.problem, view, judged.given_trial.as_ref())?);
    }
    if let Some(designed) = &judged.designed {
        chapters.push(designed.chapter()?);
    }
    chapters.extend(proven::chapter(project, judged));
    Ok(chapters)
}

/// Bounds, margins and the designed project as files.
fn robust_tables(loaded: &Loaded, judged: &Judged) -> Vec<OutputFile> {
    let mut tables = crate::design::bound_files(&judged.problem, &judged.bounds);
    tables.extend(judged.given.iter().flat_map(crate::audit::files));
    let certificate = |view| certificate_of(loaded, view, CERTIFICATE_FILE);
    tables.extend(judged.given.iter().filter_map(certificate));
    tables.extend(judged.designed.iter().flat_map(|designed| designed.files(loaded)));
    tables
}

/// The verdicts in a few words.
fn verdict_facts(judged: &Judged) -> Facts {
    let mut facts = Vec::new();
    facts.extend(judged.given.as_ref().map(|view| ("Audit of the controller", audit_words(view))));
    facts.extend(
        judged
            .given_trial
            .as_ref()
            .map(|trial| ("Controller in the nonlinear simulation", crate::trial::words(trial))),
    );
    if let Some(designed) = &judged.designed {
        facts.push(("Designed controller", designed.words()));
        facts.extend(
            designed
                .trial()
                .map(|trial| ("Designed controller in the nonlinear simulation", crate::trial::words(trial))),
        );
    }
    facts
}

/// The chapters on an actuator, independent of its controller.
struct RigPart {
    chapters: Vec<Chapter>,
    appendix: Vec<Chapter>,
    facts: Facts,
    no_hose_fits: bool,
}

fn rig_part(
    setup: &Setup<'_>,
    loaded: &Loaded,
    problem: Option<&ProblemOfSizing>,
) -> Result<Option<RigPart>, CommandError> {
    let Some(actuator) = &setup.project.actuator else { return Ok(None) };
    let refused = problem.and_then(|problem| problem.as_ref().err());
    let problem = problem.and_then(|problem| problem.as_ref().ok());
    let (project, rig, sensor) = (setup.project, setup.rig()?, &setup.sensor);
    let linearization = linearize(rig, setup.controller.as_ref(), sensor)?;
    let derived = derive(setup)?;
    let sizing = problem.map(|problem| size(problem, Question::Both));
    let band = project.scenarios.first().map_or(SETTLING_BAND, |scenario| scenario.settling_band_percent);
    let seen = rig.in_loop().plant.coefficients();
    let given =
        setup.controller.as_ref().map(|given| linear_loop_of(&seen, given, sensor, band)).transpose()?;

    let mut chapters = vec![rig::chapter(project, actuator, rig)];
    if let (Some(problem), Some(sizing)) = (problem, &sizing) {
        chapters.push(sizing::chapter(problem, sizing, &project.units));
    }
    chapters.extend(refused.map(sizing::refused));
    let appendix = vec![
        stiffness::chapter(actuator, rig, &linearization, project.units),
        Chapter::of("derived", "Derived quantities", derived::document(&derived, &WrittenUnits::of(loaded))),
        models::chapter(setup, &linearization)?,
        impedance::chapter(setup, &linearization)?,
        response::chapter(setup, given.as_ref(), reference(project)),
    ];
    let mut facts = vec![("Load", rig::load_words(actuator)), ("Lines", rig::lines_words(actuator))];
    facts.extend(summary((&linearization, rig), sizing.as_ref(), problem));
    let lumped = if project.has_waves() { " (with lumped lines)" } else { "" };
    facts.extend(given.as_ref().map(|given| (NOMINAL_LOOP, loop_words(given) + lumped)));
    let no_hose_fits = sizing.is_some_and(|sizing| sizing.best().is_none());
    Ok(Some(RigPart { chapters, appendix, facts, no_hose_fits }))
}

/// The verdict of the audit in a few words. A required step counts as a specification, and limits
/// that follow from a requirement in time count as met only if its steps satisfy it too.
fn audit_words(view: &ProjectAudit) -> String {
    let findings = &view.audit.specifications;
    let is_met = |(index, finding): &(usize, &SpecificationFinding)| {
        finding.verdict == Verdict::Met && !view.in_time_of(*index).is_some_and(TimeFinding::violates)
    };
    let mut steps: Vec<&TimeFinding> = view.in_time.iter().collect();
    steps.retain(|finding| finding.requirement.limits.is_none());
    let satisfied = steps.iter().filter(|finding| finding.verdict() == Some(Verdict::Met)).count();
    let met = findings.iter().enumerate().filter(is_met).count() + satisfied;
    let all = findings.len() + steps.len();
    let stable = match view.audit.stability.verdict {
        Verdict::Met => "stable",
        Verdict::Violated => "unstable",
        Verdict::NotProven => "not proven stable",
    };
    format!("{}: {stable}, {met} of {all} specifications met", verdict_words(view.verdict()))
}

impl Report {
    /// The page.
    pub(crate) fn page_file(&self) -> OutputFile {
        OutputFile::new("report.html", self.html.clone())
    }

    /// The page and every figure as SVG.
    pub fn files(&self) -> Vec<OutputFile> {
        let mut files = vec![self.page_file()];
        files.extend(self.tables.iter().cloned());
        files.extend(picture_files(&self.figures));
        files
    }
}

/// Height of the first reference step of the scenarios, N.
fn reference(project: &Project) -> Option<f64> {
    project
        .scenarios
        .iter()
        .flat_map(|scenario| &scenario.reference)
        .flat_map(InputSignal::steps)
        .map(|(_, force)| force)
        .find(|force| *force != 0.0)
}

fn summary(
    (linearization, rig): (&Linearization, &Rig),
    sizing: Option<&Sizing>,
    problem: Option<&SizingProblem>,
) -> Vec<(&'static str, String)> {
    let stiffness = linearization.stiffness[0];
    let [words, _] = stiffness_words(linearization.motion, &stiffness);
    let elsewhere = stiffness_at_settings(rig).into_iter().map(|(setting, stiffness)| {
        let [words, _] = stiffness_words(linearization.motion, &stiffness);
        format!("; at setting {setting} {words}")
    });
    let mut facts = vec![("Hydraulic stiffness", words + &elsewhere.collect::<String>())];
    let best = sizing.zip(problem).and_then(|(sizing, problem)| {
        sizing.candidates.iter().find(|c| c.fits() && c.branch.model == problem.model)
    });
    if let Some(best) = best {
        let gain = significant(best.branch.gain_v_per_n, 3);
        let length = length_words(&best.branch, 3);
        let open = if best.accepted() { "" } else { "; not accepted before its working pressure is stated" };
        facts.push(("Hose", format!("{}, {length} at K_p = {gain} V/N{open}", hose_name(&best.option.name))));
    } else if sizing.is_some() {
        facts.push(("Hose", "none of the catalogue fits".to_string()));
    }
    let port = |view: &phea_engineering::linearize::PortView| {
        if view.passivity.passive { "passive" } else { "not passive" }
    };
    let mut passive = format!("open loop {}", port(&linearization.open_loop));
    if let Some(view) = &linearization.closed_loop {
        passive.push_str(&format!(", closed loop {}", port(view)));
    }
    facts.push(("Towards the load", passive));
    facts
}

/// The linear loop in a few words: its step, or the statement that there is none.
fn loop_words(given: &LinearLoop) -> String {
    match (&given.stability, &given.step) {
        (LoopStability::Unstable, _) => "unstable".to_string(),
        (_, Err(reason)) => format!("no step response: {reason}"),
        (_, Ok(StepView { metrics, .. })) => {
            let verb = if metrics.settling.time_s().is_some() { "settles in " } else { "" };
            let overshoot = significant(metrics.overshoot_percent, 2);
            format!("{overshoot} % overshoot, {verb}{}", response::settling_words(metrics))
        }
    }
}

fn subtitle(project: &Project) -> &'static str {
    match project.actuator.as_ref().map(DeclaredActuator::motion) {
        Some(MotionKind::Linear) => {
            "Hydraulic force control through added compliance: sizing, linear models, robust control"
        }
        Some(MotionKind::Rotary) => {
            "Hydraulic torque control through added compliance: linear models, robust control"
        }
        None => "Robust control of an uncertain plant",
    }
}
