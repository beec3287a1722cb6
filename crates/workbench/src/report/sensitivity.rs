//! The appendix on uncertain quantities: the first scenario with multiples of the load cell's
//! stiffness and of the friction.

use phea_dynamics::watch::{Stopped, Watch};
use phea_engineering::setup::Setup;
use phea_engineering::simulate::{Metrics, ScenarioRun, Window, simulate_project};
use phea_hydraulics::friction::Friction;

use super::chapter::Chapter;
use super::driven::MachineChapter;
use super::simulation::shown_metrics;
use crate::document::{Document, Table};
use crate::error::CommandError;
use crate::figure::DisplayUnit;
use crate::project::{DeclaredActuator, Project, RetractingFriction};
use crate::simulate::{cause_words, label_within, metrics_row};
use crate::source::Source;

/// Factors of the sensitivity.
const STIFFNESS_FACTORS: [f64; 4] = [0.1, 0.5, 1.0, 2.0];
const FRICTION_FACTORS: [(f64, &str); 4] = [(0.0, "none"), (0.5, "half"), (1.0, "all of it"), (2.0, "twice")];

/// The chapter, for the first controller that was driven, with its project; `None` if none was.
///
/// # Errors
/// [`CommandError::Stopped`] if the watch stops it.
pub(super) fn chapter(
    source: &dyn Source,
    project: &Project,
    driven: &MachineChapter,
    watch: Watch<'_>,
) -> Result<Option<Chapter>, CommandError> {
    let Some(side) = driven.sides.first().filter(|side| side.runs.is_ok()) else { return Ok(None) };
    let varied = sensitivity(source, project, watch)?;
    if varied.is_empty() {
        return Ok(None);
    }
    let mut out = Document::default();
    let prescribed =
        project.actuator.as_ref().is_some_and(|actuator| actuator.load == crate::project::Load::Prescribed);
    let sensor = project.motion().words().force_sensor;
    let suffix = if prescribed { format!("of {sensor} and environment") } else { format!("of the {sensor}") };
    out.explanation(format!("The first scenario again with one quantity changed: the stiffness K_S {suffix}, and all friction. Neither is known accurately for a real rig, and the overshoot depends on both. The controller is the {} one.", side.name));
    let refused = varied.iter().filter_map(|varied| Some((varied, varied.run.as_ref().err()?)));
    out.explanations(
        refused.map(|(varied, reason)| format!("{}, {}: {reason}.", varied.quantity, varied.value)),
    );
    let events = varied.iter().filter_map(|varied| Some(varied.run.as_ref().ok()?.windows.len())).max();
    out.tables((0..events.unwrap_or(0)).filter_map(|event| event_table(&varied, event)));
    Ok(Some(Chapter::of("sensitivity", "Sensitivity of the first scenario", out)))
}

/// A quantity multiplied by a factor, and the result of the first scenario.
struct VariedQuantity {
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
) -> Result<Vec<VariedQuantity>, CommandError> {
    let mut first = project.clone();
    first.scenarios.truncate(1);
    let mut varied = Vec::new();
    for factor in STIFFNESS_FACTORS {
        let mut project = first.clone();
        if let Some(actuator) = &mut project.actuator {
            actuator.force_sensor.stiffness *= factor;
            let unit = actuator.motion().unit(DisplayUnit::MEGANEWTON_PER_METRE);
            let shown = unit.text(actuator.force_sensor.stiffness, 3);
            varied.push(vary(source, &project, ("Sensor stiffness K_S", factor, shown), watch)?);
        }
    }
    for (factor, word) in FRICTION_FACTORS {
        let mut project = first.clone();
        let Some(friction) = project.actuator.as_mut().and_then(DeclaredActuator::friction_mut) else {
            break;
        };
        *friction.law.viscous_mut() *= factor;
        for level in friction.retracting.iter_mut().flat_map(RetractingFriction::each_mut) {
            *level *= factor;
        }
        if factor == 0.0 {
            friction.law = Friction::default();
            friction.retracting = None;
        }
        if let Some(curve) = friction.law.curve_mut() {
            curve.coulomb *= factor;
            curve.static_friction *= factor;
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
) -> Result<VariedQuantity, CommandError> {
    let run = match simulate_project(source, &Setup::new(project)?, watch) {
        Ok(runs) if runs.iter().any(ScenarioRun::was_cancelled) => return Err(Stopped.into()),
        Ok(runs) => runs.into_iter().next().ok_or_else(|| "no scenario".to_string()),
        Err(error) => Err(error.to_string()),
    };
    Ok(VariedQuantity { quantity, factor, value, run })
}

/// The results of one event, quantity by quantity.
fn event_table(varied: &[VariedQuantity], event: usize) -> Option<Table> {
    let seen = |varied: &VariedQuantity| Some(*varied.run.as_ref().ok()?.windows.get(event)?);
    let windows: Vec<(Window, Metrics)> = varied.iter().filter_map(seen).collect();
    let units = varied.iter().find_map(|varied| Some(varied.run.as_ref().ok()?.record.units))?;
    let shown = shown_metrics(windows.iter());
    let event = cause_words(&windows.first()?.0, units);
    let bands = || windows.iter().map(|(_, metrics)| metrics.settling_band_percent);
    let heads =
        std::iter::once(event).chain(shown.iter().map(|metric| label_within(*metric, bands(), units.motion)));
    let mut rows = Table::grouped_by("quantity", heads);
    let mut quantity = "";
    for varied in varied {
        let Some((_, metrics)) = seen(varied) else { continue };
        if varied.quantity != std::mem::replace(&mut quantity, varied.quantity) {
            rows.group(varied.quantity);
        }
        let as_declared = if varied.factor == 1.0 { ", as declared" } else { "" };
        rows.row(metrics_row(
            format!("{}{as_declared}", varied.value).into(),
            &shown,
            (&metrics, units),
            None,
        ));
    }
    Some(rows)
}
