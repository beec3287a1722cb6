//! The chapter on the nonlinear machine: each scenario over time, what is read off it, and what changes with what is not known.

use maud::{Markup, html};

use super::chapter::{Chapter, cell, place, table};
use crate::answer::significant;
use crate::command::{CommandError, Watch};
use crate::figure::{DisplayUnit, Figure};
use crate::project::{FrictionModel, Project, Scenario};
use crate::simulate::{
    Cause, METRICS, Metrics, ScenarioRun, SimulateError, Window, cause_words, cells_of, headline,
    occurrence_sentences, pictures, simulate_project,
};
use crate::source::Source;

/// Factors of the sensitivity.
const STIFFNESS_FACTORS: [f64; 4] = [0.1, 0.5, 1.0, 2.0];
const FRICTION_FACTORS: [f64; 4] = [0.0, 0.5, 1.0, 2.0];

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
        p { "The machine as a whole: spool with saturation, the flow of each edge, chambers that grow and shrink, friction as declared, load cell and load, under the controller as it is deployed. Peaks are those of parabolas between looks at most a quarter of a millisecond apart, so that they do not depend on the rows of the table." }
        @for part in &parts { (part) }
        (sensitivity_table(&sensitivity))
    };
    Ok(Some(Chapter { anchor, title, body, figures }))
}

fn refused(error: &SimulateError) -> Markup {
    html! { div.callout.bad-edge { p { "Not simulated: " (error) "." } } }
}

fn scenario(run: &ScenarioRun, declared: &Scenario, figures: &[Figure]) -> Markup {
    let mut heads = vec!["event"];
    heads.extend(METRICS);
    let mut rows: Vec<Vec<Markup>> = Vec::new();
    for (window, metrics) in &run.windows {
        let cells = cells_of(metrics).into_iter().map(cell);
        rows.push(std::iter::once(cell(cause_words(window))).chain(cells).collect());
        rows.extend(published_row(declared, window));
    }
    let remarks = declared.reference.iter().filter_map(|step| step.published.as_ref()?.remark.as_ref());
    html! {
        h3 { (run.name) }
        p { (headline(run)) "." }
        @for figure in figures { (place(figure)) }
        @if !rows.is_empty() {
            (table(&heads, 1, &rows))
            p { "Settling is to " (run.settling_band_percent) " % of the step, or of the reference that a load motion disturbs; the steady-state error is reference less force, averaged over the last tenth of the window." }
        }
        @for remark in remarks { p { (remark) } }
        @for sentence in occurrence_sentences(&run.occurrences) { p { (sentence) "." } }
    }
}

/// What was published of the step that begins this window.
fn published_row(declared: &Scenario, window: &Window) -> Option<Vec<Markup>> {
    let step = declared.reference.iter().find(|step| step.at == window.start_s)?;
    let published = step.published.as_ref().filter(|_| window.cause != Cause::LoadMotion)?;
    let source = published.source.as_deref().unwrap_or("published");
    let overshoot = published.overshoot_percent.map(|percent| format!("{} %", significant(percent, 3)));
    let settling = published.settling_time.map(|time| format!("{} s", significant(time, 3)));
    let known = [overshoot, settling].map(|text| text.unwrap_or_else(|| "-".to_string()));
    let unknown = METRICS.iter().skip(known.len()).map(|_| cell("-"));
    Some(std::iter::once(cell(source)).chain(known.iter().map(cell)).chain(unknown).collect())
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
            varied.push(vary(source, &project, ("load stiffness K_S", factor, shown), watch)?);
        }
    }
    for factor in FRICTION_FACTORS {
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
        let shown =
            if factor == 0.0 { "none".to_string() } else { format!("{} times", significant(factor, 2)) };
        varied.push(vary(source, &project, ("friction", factor, shown), watch)?);
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

fn sensitivity_table(varied: &[Varied]) -> Markup {
    let rows: Vec<Vec<Markup>> = varied.iter().flat_map(varied_rows).collect();
    let mut heads = vec!["quantity", "value", "event"];
    heads.extend(METRICS);
    html! {
        @if !rows.is_empty() {
            h3 { "Sensitivity" }
            p { "The first scenario again with one quantity changed: the stiffness K_S of load cell and environment, and all friction. Neither is known well of a real rig, and the overshoot follows both." }
            (table(&heads, 3, &rows))
        }
    }
}

fn varied_rows(varied: &Varied) -> Vec<Vec<Markup>> {
    let head = |event: String| {
        let as_declared = if varied.factor == 1.0 { " (as declared)" } else { "" };
        vec![cell(varied.quantity), cell(format!("{}{as_declared}", varied.value)), cell(event)]
    };
    match &varied.run {
        Err(reason) => vec![head(reason.clone())],
        Ok(run) => {
            let row = |(window, metrics): &(Window, Metrics)| {
                let mut row = head(cause_words(window));
                row.extend(cells_of(metrics).into_iter().map(cell));
                row
            };
            run.windows.iter().map(row).collect()
        }
    }
}
