//! The chapter on the nonlinear machine: each scenario over time, what is read off it, and what changes with what is not known.

use maud::{Markup, html};

use super::chapter::{Chapter, cell, grouped, place, table, unbroken};
use super::driving;
use super::typeset::prose;
use crate::answer::significant;
use crate::command::{CommandError, Watch};
use crate::figure::{DisplayUnit, Figure};
use crate::project::{FrictionModel, Project, Scenario};
use crate::simulate::{
    ABSENT, Cause, MEASURED, METRICS, Metrics, ScenarioRun, SimulateError, Window, cause_words, cells_of,
    coarse_sentence, headline, measured_cells, occurrence_sentences, pictures, simulate_project,
};
use crate::source::Source;

/// Factors of the sensitivity.
const STIFFNESS_FACTORS: [f64; 4] = [0.1, 0.5, 1.0, 2.0];
const FRICTION_FACTORS: [(f64, &str); 4] = [(0.0, "none"), (0.5, "half"), (1.0, "all of it"), (2.0, "twice")];

/// The chapter; `None` for a project without scenarios.
///
/// # Errors
/// [`CommandError::Stopped`] where the watch stops it.
pub(super) fn chapter(
    source: &dyn Source,
    project: &Project,
    watch: Watch<'_>,
) -> Result<Option<Chapter>, CommandError> {
    if project.scenarios.is_empty() {
        return Ok(None);
    }
    let (anchor, title) = ("simulation", "Simulation of the nonlinear machine");
    let runs = match simulate_project(source, project, watch) {
        Ok(runs) => runs,
        Err(error) => return Ok(Some(Chapter { anchor, title, body: refused(&error), figures: vec![] })),
    };
    if runs.iter().any(ScenarioRun::was_cancelled) {
        return Err(CommandError::Stopped);
    }
    let sensitivity = sensitivity(source, project, watch)?;
    let mut figures = Vec::new();
    let mut parts = Vec::new();
    for (number, (run, declared)) in runs.iter().zip(&project.scenarios).enumerate() {
        let drawn = pictures(run, number + 1);
        parts.push(scenario(run, declared, &drawn));
        figures.extend(drawn);
    }
    let body = html! {
        p { "The machine as a whole: spool with saturation, the flow of each edge, chambers that grow and shrink, friction as declared, load cell and load, under the controller as it is deployed. Peaks and settling times are those of the solution over each step of the integration, so that they do not depend on the rows of the table." }
        @for part in &parts { (part) }
        (sensitivity_table(&sensitivity))
    };
    Ok(Some(Chapter { anchor, title, body, figures }))
}

fn refused(error: &SimulateError) -> Markup {
    html! { div.callout.bad-edge { p { "Not simulated: " (error) "." } } }
}

fn scenario(run: &ScenarioRun, declared: &Scenario, figures: &[Figure]) -> Markup {
    let told = told(run.windows.iter());
    let mut heads = vec!["event"];
    heads.extend(told.iter().map(|metric| METRICS[*metric]));
    let mut rows: Vec<Vec<Markup>> = Vec::new();
    for (window, metrics) in &run.windows {
        let of = |cells: [String; METRICS.len()]| {
            told.iter().map(|metric| cell(&cells[*metric])).collect::<Vec<_>>()
        };
        rows.push([vec![unbroken(&cause_words(window))], of(cells_of(metrics))].concat());
        let published = published(declared, window);
        rows.extend(published.map(|(source, cells)| [vec![unbroken(source)], of(cells)].concat()));
    }
    let cells = |overlay| measured_cells(overlay).iter().map(cell).collect::<Vec<_>>();
    let measured: Vec<Vec<Markup>> = run.measured.iter().map(cells).collect();
    let remarks = declared.reference.iter().filter_map(|step| step.published.as_ref()?.remark.as_ref());
    html! {
        h3 { (run.name) }
        p { (headline(run)) "." }
        @for sentence in driving::sentences(declared) { p { (sentence) } }
        @for figure in figures { (place(figure)) }
        @if !rows.is_empty() {
            (table(&heads, 1, &rows))
            p { "Settling is to " (run.settling_band_percent) " % of the step, or of the reference that a load motion disturbs; the steady-state error is reference less force, averaged over the last tenth of the window; the rise is from 10 to 90 % of the step." }
        }
        @if !run.measured.is_empty() {
            (table(&MEASURED, 2, &measured))
            p { "NRMSE is the root mean square of measured less simulated, over the range of what was measured." }
        }
        @for remark in remarks { p { (remark) } }
        @if let Some(sentence) = coarse_sentence(run) { p { (sentence) "." } }
        @for sentence in occurrence_sentences(run) { p { (sentence) "." } }
    }
}

/// The metrics that some of these windows can have.
fn told<'a>(windows: impl Iterator<Item = &'a (Window, Metrics)>) -> Vec<usize> {
    let cells: Vec<[String; METRICS.len()]> = windows.map(|(_, metrics)| cells_of(metrics)).collect();
    (0..METRICS.len()).filter(|metric| cells.iter().any(|cells| cells[*metric] != ABSENT)).collect()
}

/// What was published of the step that begins this window, and where; `None` where that are no numbers.
fn published<'a>(declared: &'a Scenario, window: &Window) -> Option<(&'a str, [String; METRICS.len()])> {
    let step = declared.reference.iter().find(|step| step.at == Some(window.start_s))?;
    let published =
        step.published.as_ref().filter(|_| matches!(window.cause, Cause::ReferenceStep { .. }))?;
    let overshoot = published.overshoot_percent.map(|percent| format!("{} %", significant(percent, 3)));
    let settling = published.settling_time.map(|time| format!("{} s", significant(time, 3)));
    if overshoot.is_none() && settling.is_none() {
        return None;
    }
    let cells = METRICS.map(|metric| {
        let known = match metric {
            "overshoot" => &overshoot,
            "settling" => &settling,
            _ => &None,
        };
        known.clone().unwrap_or_else(|| ABSENT.to_string())
    });
    Some((published.source.as_deref().unwrap_or("published"), cells))
}

/// A quantity multiplied by a factor, and what comes of the first scenario.
struct Varied {
    quantity: &'static str,
    factor: f64,
    value: String,
    run: Result<ScenarioRun, String>,
}

/// The first scenario with the stiffness of the load cell and with the friction multiplied.
fn sensitivity(
    source: &dyn Source,
    project: &Project,
    watch: Watch<'_>,
) -> Result<Vec<Varied>, CommandError> {
    let mut first = project.clone();
    first.scenarios.truncate(1);
    let mut varied = Vec::new();
    for factor in STIFFNESS_FACTORS {
        let mut project = first.clone();
        if let Some(actuator) = &mut project.actuator {
            actuator.force_sensor.stiffness *= factor;
            let shown = DisplayUnit::MEGANEWTON_PER_METRE.text(actuator.force_sensor.stiffness, 3);
            varied.push(vary(source, &project, ("Load stiffness K_S", factor, shown), watch)?);
        }
    }
    for (factor, word) in FRICTION_FACTORS {
        let mut project = first.clone();
        let Some(friction) =
            project.actuator.as_mut().and_then(|actuator| actuator.cylinder.friction.as_mut())
        else {
            break;
        };
        friction.viscous *= factor;
        friction.coulomb = friction.coulomb.map(|force| force * factor);
        friction.static_friction = friction.static_friction.map(|force| force * factor);
        if factor == 0.0 {
            friction.model = FrictionModel::Viscous;
        }
        varied.push(vary(source, &project, ("Friction", factor, word.to_string()), watch)?);
    }
    Ok(varied)
}

fn vary(
    source: &dyn Source,
    project: &Project,
    (quantity, factor, value): (&'static str, f64, String),
    watch: Watch<'_>,
) -> Result<Varied, CommandError> {
    let run = match simulate_project(source, project, watch) {
        Ok(runs) if runs.iter().any(ScenarioRun::was_cancelled) => return Err(CommandError::Stopped),
        Ok(runs) => runs.into_iter().next().ok_or_else(|| "no scenario".to_string()),
        Err(error) => Err(error.to_string()),
    };
    Ok(Varied { quantity, factor, value, run })
}

/// One table for each event, in which a column is read downwards.
fn sensitivity_table(varied: &[Varied]) -> Markup {
    let events =
        varied.iter().filter_map(|varied| varied.run.as_ref().ok()).map(|run| run.windows.len()).max();
    let refused = varied.iter().filter_map(|varied| Some((varied, varied.run.as_ref().err()?)));
    let tables = (0..events.unwrap_or(0)).filter_map(|event| event_table(varied, event));
    html! {
        @if !varied.is_empty() {
            h3 { "Sensitivity" }
            p { (prose("The first scenario again with one quantity changed: the stiffness K_S of load cell and environment, and all friction. Neither is known well of a real rig, and the overshoot follows both.")) }
            @for (varied, reason) in refused { p { (prose(varied.quantity)) ", " (varied.value) ": " (reason) "." } }
            @for table in tables { (table) }
        }
    }
}

/// What comes of one event, quantity by quantity.
fn event_table(varied: &[Varied], event: usize) -> Option<Markup> {
    let seen = |varied: &Varied| Some(*varied.run.as_ref().ok()?.windows.get(event)?);
    let windows: Vec<(Window, Metrics)> = varied.iter().filter_map(seen).collect();
    let told = told(windows.iter());
    let event = cause_words(&windows.first()?.0);
    let mut heads = vec![event.as_str()];
    heads.extend(told.iter().map(|metric| METRICS[*metric]));
    let mut groups: Vec<(String, Vec<Vec<Markup>>)> = Vec::new();
    for varied in varied {
        let Some((_, metrics)) = seen(varied) else { continue };
        let as_declared = if varied.factor == 1.0 { ", as declared" } else { "" };
        let cells = cells_of(&metrics);
        let mut row = vec![unbroken(&format!("{}{as_declared}", varied.value))];
        row.extend(told.iter().map(|metric| cell(&cells[*metric])));
        match groups.last_mut().filter(|(quantity, _)| quantity == varied.quantity) {
            Some((_, rows)) => rows.push(row),
            None => groups.push((varied.quantity.to_string(), vec![row])),
        }
    }
    Some(grouped(&heads, 1, &groups))
}
