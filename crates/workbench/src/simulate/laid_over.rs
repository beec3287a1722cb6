//! Figures of one scenario for several rigs.

use phea_engineering::simulate::{Record, ScenarioRun, Window};
use phea_hydraulics::signal::Signal;
use serde::{Deserialize, Serialize};

use super::cause_words;
use super::figures::{enlarged_places, load_pressure, step_height};
use super::span::{around, shown_after};
use crate::figure::{CurveStyle, DisplayUnit, Figure, Words};
use crate::over_time::{Trace, chart, measured_force, panel, trace, with_lines_beneath};

/// A run with the signals that are drawn over those of other rigs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct OverlaidRun {
    /// Name of the scenario.
    pub(crate) name: String,
    /// Name and symbol of the measured force or torque.
    force_words: String,
    #[serde(with = "crate::unit_encoding")]
    force_unit: DisplayUnit,
    #[serde(with = "crate::unit_encoding")]
    pressure_unit: DisplayUnit,
    times_s: Vec<f64>,
    /// Measured force, N.
    force: Vec<f64>,
    /// Command, V.
    command: Vec<f64>,
    /// Difference of the pressures of both chambers, Pa.
    load_pressure: Vec<f64>,
    /// Reference, N; empty without one.
    reference: Vec<f64>,
    events: Vec<OverlaidEvent>,
}

/// An event of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct OverlaidEvent {
    start_s: f64,
    /// Height of the step with which it begins.
    step: Option<f64>,
    label: String,
    /// Cause with its time, for titles.
    cause: String,
    /// Time shown after its start, s.
    shown_after_s: f64,
}

impl OverlaidRun {
    /// The drawn signals of a run.
    pub(crate) fn of(run: &ScenarioRun) -> OverlaidRun {
        let record: &Record = &run.record;
        let units = record.units;
        let event = |window: &Window| OverlaidEvent {
            start_s: window.start_s,
            step: step_height(window),
            label: window.cause.label(units.motion).to_string(),
            cause: cause_words(window, units),
            shown_after_s: shown_after(run, window),
        };
        OverlaidRun {
            name: run.name.clone(),
            force_words: measured_force(units.motion),
            force_unit: units.force,
            pressure_unit: units.pressure,
            times_s: record.times_s.clone(),
            force: record.signal(Signal::Force),
            command: record.signal(Signal::Control),
            load_pressure: load_pressure(record),
            reference: record.reference_n.clone(),
            events: run.windows.iter().map(|(window, _)| event(window)).collect(),
        }
    }
}

/// Figures of one scenario for several rigs: the whole, and each event of the first rig enlarged.
pub(crate) fn laid_over(
    (file, title, caption): (&str, &str, &str),
    titles: &[String],
    runs: &[&OverlaidRun],
) -> Vec<Figure> {
    let Some((first, _)) = runs.split_first() else { return vec![] };
    let ends = runs.iter().filter_map(|run| run.times_s.last().copied());
    let end = ends.fold(0.0, f64::max);
    let words = |suffix: String, title: String| Words::new(format!("{file}{suffix}"), title, caption);
    let whole = words(String::new(), title.to_string());
    let mut figures = vec![side_by_side(&whole, titles, (first, runs), [0.0, end])];
    let events: Vec<_> = first.events.iter().map(|event| (event.start_s, event.step)).collect();
    let enlarged = enlarged_places(&events, end).into_iter();
    for (place, event) in enlarged.filter_map(|place| Some((place, first.events.get(place)?))) {
        let words = words(format!("-event-{}", place + 1), format!("Enlarged: {}", event.cause));
        let span = around(event.start_s, event.shown_after_s, end);
        figures.push(side_by_side(&words, titles, (first, runs), span));
    }
    figures
}

/// The runs in one figure, with the events and in the units of the first.
fn side_by_side(
    words: &Words,
    titles: &[String],
    (first, runs): (&OverlaidRun, &[&OverlaidRun]),
    [start, end]: [f64; 2],
) -> Figure {
    let each = |values: fn(&OverlaidRun) -> &[f64]| -> Vec<Trace> {
        runs.iter().map(|run| trace(&run.times_s, values(run))).collect()
    };
    let reference = runs.iter().find(|run| !run.reference.is_empty());
    let reference = reference.map(|run| trace(&run.times_s, &run.reference));
    let unit = first.force_unit;
    let forces = panel(&first.force_words, unit, 230.0, each(|run| &run.force));
    let panels = vec![
        with_lines_beneath(forces, unit, CurveStyle::Reference, reference),
        panel("Command U_C", DisplayUnit::VOLT, 130.0, each(|run| &run.command)),
        panel("p_A - p_B", first.pressure_unit, 130.0, each(|run| &run.load_pressure)),
    ];
    let seen = first.events.iter().filter(|event| event.start_s >= start && event.start_s < end);
    let instants: Vec<(f64, String)> = seen.map(|event| (event.start_s, event.label.clone())).collect();
    chart(panels, titles.to_vec(), &instants, [start, end]).draw(words)
}
