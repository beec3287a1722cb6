//! Figures of runs over time.

use phea_engineering::simulate::{Cause, Metrics, Record, ScenarioComparison, ScenarioRun, Window};

use super::cause_words;
use super::compared::compared_titles;
use super::laid_over::{OverlaidRun, laid_over};
use super::span::{span_of, span_of_events};
use crate::answer::{OutputFile, picture_files, significant};
use crate::document::capital;
use crate::figure::axis::extent;
use crate::figure::{CurveChart, CurvePanel, CurveStyle, DisplayUnit, Figure, SettlingBand, Words};
use crate::over_time::{ForceStep, Trace, chart, measured_force, named, panel, trace, with_lines_beneath};
use crate::project::Loaded;
use crate::quantity::{MotionKind, MotionWords, Units};
use phea_hydraulics::signal::Signal;

/// Largest number of events that are all enlarged; if there are more, all that are not steps, and
/// the greatest step.
const ENLARGED: usize = 3;

/// The whole run, and each event enlarged.
pub(crate) fn pictures(run: &ScenarioRun, number: usize) -> Vec<Figure> {
    let end = run.record.times_s.last().copied().unwrap_or(0.0);
    let MotionWords { force, position, positions, piston, .. } = run.record.units.motion.words();
    let whole = Words::new(
        format!("simulation-{number}"),
        format!("Simulated: {}", run.name),
        format!("{}, voltages, pressures and {position} over {}.", capital(force), shown_words(run, end)),
    );
    let mut figures = vec![overview(&whole, run, span_of_events(run, end))];
    for (index, window) in enlarged(&run.windows, end) {
        let moved = if moves_load(window) { format!(", {positions}") } else { String::new() };
        let with_reference = if run.open_loop { "" } else { " with its reference" };
        let caption = format!(
            "Voltages, pressures of both chambers, hydraulic and measured {force}, measured {force}\
             {with_reference}{moved}. Between hydraulic and measured {force} lie the friction and the acceleration of the {piston}."
        );
        let words = Words::new(
            format!("simulation-{number}-event-{}", index + 1),
            format!("Enlarged: {}", cause_words(window, run.record.units)),
            caption,
        );
        figures.push(close_up(&words, run, window, span_of(run, window, end)));
    }
    figures.extend(overlaid(run, number, [0.0, end]));
    figures
}

/// Words for the span of an overview: the whole scenario, or its first part, after which it
/// repeats.
pub(super) fn shown_words(run: &ScenarioRun, end_s: f64) -> String {
    match span_of_events(run, end_s)[1] {
        shown if shown < end_s => {
            format!(
                "the first {} s of {} s, after which it repeats",
                significant(shown, 3),
                significant(end_s, 3)
            )
        }
        _ => "the whole scenario".to_string(),
    }
}

/// Measurement and simulation, a panel for each signal.
fn overlaid(run: &ScenarioRun, number: usize, span_s: [f64; 2]) -> Option<Figure> {
    let height = if run.measured.len() > 3 { 100.0 } else { 150.0 };
    let panels = run.measured.iter().map(|overlay| {
        let simulated = over_time(&run.record, run.record.signal(overlay.signal));
        let measured = trace(&overlay.times_s, &overlay.measured);
        let units = run.record.units;
        let title = overlay.signal.words(units.motion);
        panel(&title, overlay.display_unit(units), height, vec![simulated, measured])
    });
    let panels: Vec<CurvePanel> = panels.collect();
    let words = Words::new(
        format!("simulation-{number}-measured"),
        format!("Measured and simulated: {}", run.name),
        "What was measured on the rig, on what the nonlinear simulation of the project does.",
    );
    let legend = ["simulated", "measured"].map(String::from);
    let events = instants(&run.windows, span_s, run.record.units.motion);
    (!panels.is_empty()).then(|| chart(panels, legend, &events, span_s).draw(&words))
}

/// Overview of all signals.
fn overview(words: &Words, run: &ScenarioRun, span_s: [f64; 2]) -> Figure {
    let record = &run.record;
    let mut panels = vec![measured(record, 190.0)];
    panels.extend(prefiltered(record));
    panels.extend([voltages(record), pressures(record), positions(record)]);
    panels.extend(joint(record));
    panels.extend(gas(record));
    panels.extend(from_outside(record));
    panels.extend(settings(record));
    drawn(run, panels, span_s).draw(words)
}

/// The signals between command and force, in the order of Figure 6.17 of Ledezma (2019); with
/// positions where the load moves.
pub(super) fn close_up(words: &Words, run: &ScenarioRun, window: &Window, span_s: [f64; 2]) -> Figure {
    let record = &run.record;
    let forces =
        [Signal::Force, Signal::HydraulicForce].map(|signal| over_time(record, record.signal(signal)));
    let motion = record.units.motion;
    let title = motion.either("Forces F_e, F_H", "Torques T_e, T_H");
    let forces = panel(title, record.units.force, 150.0, forces.into());
    let names = motion.either(["measured force", "hydraulic force"], ["measured torque", "hydraulic torque"]);
    let forces = named(forces, names);
    let mut panels = vec![voltages(record), pressures(record), forces, measured(record, 150.0)];
    panels.extend(prefiltered(record));
    panels.extend(error_panel(record).filter(|_| matches!(window.cause, Cause::ReferenceMotion { .. })));
    if moves_load(window) {
        panels.push(positions(record));
        panels.extend(joint(record));
    }
    panels.extend(gas(record));
    if window.cause == Cause::SettingChange {
        panels.extend(settings(record));
    }
    if matches!(window.cause, Cause::ExternalForce { .. }) {
        panels.extend(from_outside(record));
    }
    drawn(run, panels, span_s).draw(words)
}

/// Largest excursion of a prefiltered reference beyond the range of force and reference, as a
/// fraction of that range, with which it is still drawn in their panel.
const LEAVES: f64 = 0.5;

/// The measured force with its reference, before and after the prefilter; a prefiltered reference
/// that would spoil the scale gets its own panel.
fn measured(record: &Record, height: f64) -> CurvePanel {
    let Units { motion, force: unit, .. } = record.units;
    let mut series = vec![over_time(record, record.signal(Signal::Force))];
    let mut names = vec![motion.either("measured force", "measured torque")];
    if fits(record) {
        series.push(over_time(record, record.signal(Signal::FilteredReference)));
        names.push("prefiltered reference");
    }
    let force = named(panel(&measured_force(motion), unit, height, series), names);
    let reference = reference_trace(record);
    let has_reference = reference.is_some();
    let mut force = with_lines_beneath(force, unit, CurveStyle::Reference, reference);
    force.named.extend(has_reference.then(|| ("reference".to_string(), CurveStyle::Reference)));
    force
}

/// The prefiltered reference in its own panel, if it does not fit the scale of the force.
fn prefiltered(record: &Record) -> Option<CurvePanel> {
    let Units { motion, force: unit, .. } = record.units;
    let title = motion.either("F F_ref", "F T_ref");
    let series = over_time(record, record.signal(Signal::FilteredReference));
    (!fits(record)).then(|| named(panel(title, unit, 90.0, vec![series]), ["prefiltered reference"]))
}

/// True if the prefiltered reference can be drawn on the scale of force and reference.
fn fits(record: &Record) -> bool {
    let (least, most) =
        extent(record.signal(Signal::Force).into_iter().chain(record.reference_n.iter().copied()));
    let (lowest, highest) = extent(record.signal(Signal::FilteredReference));
    let room = LEAVES * (most - least);
    record.signal(Signal::FilteredReference).is_empty() || (lowest >= least - room && highest <= most + room)
}

/// Reference less force, where the reference moves.
pub(super) fn tracking_error(record: &Record) -> Vec<f64> {
    let pairs = record.reference_n.iter().zip(record.signal(Signal::Force));
    pairs.map(|(reference, force)| reference - force).collect()
}

/// Label of the axis of that error.
pub(super) fn error_title(motion: MotionKind) -> &'static str {
    motion.either("F_ref - F_e", "T_ref - T_e")
}

fn error_panel(record: &Record) -> Option<CurvePanel> {
    let error = tracking_error(record);
    let Units { motion, force: unit, .. } = record.units;
    (!error.is_empty()).then(|| {
        named(panel(error_title(motion), unit, 90.0, vec![over_time(record, error)]), ["error"])
            .with_zero_line()
    })
}

/// The reference; none in an open loop.
pub(super) fn reference_trace(record: &Record) -> Option<Trace> {
    (!record.reference_n.is_empty()).then(|| over_time(record, record.reference_n.clone()))
}

/// True if the event of a window moves the load.
pub(super) fn moves_load(window: &Window) -> bool {
    matches!(window.cause, Cause::LoadMotion | Cause::ExternalForce { .. })
}

/// The external force or torque on the load, in words.
fn external_words(record: &Record) -> &'static str {
    if turns(record) || record.units.motion.is_rotary() { "external torque" } else { "external force" }
}

/// Words for the position of the load; with a linkage, the position is that of the rod's end.
fn load_words(record: &Record) -> &'static str {
    if turns(record) { "rod's end" } else { "load" }
}

/// The external force on the load, or the torque on one that turns, if there is one.
fn external_force(record: &Record) -> Option<Vec<f64>> {
    let signals = [Signal::ExternalForce, Signal::ExternalTorque].map(|signal| record.signal(signal));
    signals.into_iter().find(|values| !values.is_empty())
}

/// The panel of that force.
fn from_outside(record: &Record) -> Option<CurvePanel> {
    let series = over_time(record, external_force(record)?);
    Some(match turns(record) {
        false => {
            let title = record.units.motion.either("Force F_x", "Torque T_x");
            let force = panel(title, record.units.force, 90.0, vec![series]);
            named(force, [external_words(record)])
        }
        true => named(
            panel("Torque τ_x", DisplayUnit::NEWTON_METRE, 90.0, vec![series]),
            [external_words(record)],
        ),
    })
}

/// The settings of accumulators that are adjusted, if there are any.
fn settings(record: &Record) -> Option<CurvePanel> {
    if !record.parts.adjustment {
        return None;
    }
    let series = [Signal::SettingA, Signal::SettingB].map(|signal| over_time(record, record.signal(signal)));
    Some(named(panel("Settings s_A, s_B", DisplayUnit::ONE, 90.0, series.into()), ["s_A", "s_B"]))
}

/// True if the load is driven through a linkage and turns.
pub(crate) fn turns(record: &Record) -> bool {
    record.parts.linkage
}

/// The angle of the joint, if there is a linkage.
fn joint(record: &Record) -> Option<CurvePanel> {
    let series = turns(record).then(|| over_time(record, record.signal(Signal::JointAngle)))?;
    Some(named(panel("Joint θ", DisplayUnit::DEGREE, 90.0, vec![series]), ["joint"]))
}

/// The pressures of the gas in accumulators with a neck, and the temperatures of the gas that
/// exchanges heat, if there are any; relative to the wall temperature if the working temperature is
/// not stated.
fn gas(record: &Record) -> Vec<CurvePanel> {
    let unstated = [0, 1].map(|side| match record.parts.gas_wall_celsius[side] {
        None => record.signal([Signal::GasTemperatureRatioA, Signal::GasTemperatureRatioB][side]),
        Some(_) => vec![],
    });
    let panels = [
        (
            "Gas p_g",
            record.units.pressure,
            [Signal::GasPressureA, Signal::GasPressureB].map(|signal| record.signal(signal)),
        ),
        (
            "Gas T",
            DisplayUnit::DEGREE_CELSIUS,
            [Signal::GasTemperatureA, Signal::GasTemperatureB].map(|signal| record.signal(signal)),
        ),
        ("Gas T/T_w", DisplayUnit::ONE, unstated),
    ];
    let there = panels.into_iter().filter(|(_, _, sides)| sides.iter().any(|side| !side.is_empty()));
    let drawn = there.map(|(quantity, unit, sides)| {
        // a side without such gas retains its colour, but has no points
        named(
            panel(quantity, unit, 90.0, sides.map(|values| over_time(record, values)).into()),
            ["at A", "at B"],
        )
    });
    drawn.collect()
}

fn voltages(record: &Record) -> CurvePanel {
    let series = [Signal::Control, Signal::Spool]
        .map(|signal| record.signal(signal))
        .map(|values| over_time(record, values));
    named(panel("Voltage", DisplayUnit::VOLT, 110.0, series.into()), ["command", "spool"])
}

fn pressures(record: &Record) -> CurvePanel {
    let series =
        [Signal::PressureA, Signal::PressureB].map(|signal| over_time(record, record.signal(signal)));
    named(panel("Pressure", record.units.pressure, 110.0, series.into()), ["p_A", "p_B"])
}

fn positions(record: &Record) -> CurvePanel {
    let series =
        [Signal::Position, Signal::LoadPosition].map(|signal| over_time(record, record.signal(signal)));
    let MotionWords { position, piston, .. } = record.units.motion.words();
    let positions = panel(&capital(position), record.units.position, 90.0, series.into());
    named(positions, [*piston, load_words(record)])
}

/// Panels of one run, with its events.
fn drawn(run: &ScenarioRun, panels: Vec<CurvePanel>, span_s: [f64; 2]) -> CurveChart {
    chart(panels, [], &instants(&run.windows, span_s, run.record.units.motion), span_s)
}

/// The events that have their own figure, with their indices among all.
pub(super) fn enlarged(windows: &[(Window, Metrics)], end_s: f64) -> Vec<(usize, &Window)> {
    let events: Vec<(f64, Option<f64>)> =
        windows.iter().map(|(window, _)| (window.start_s, step_height(window))).collect();
    let places = enlarged_places(&events, end_s).into_iter();
    places.filter_map(|place| Some((place, &windows.get(place)?.0))).collect()
}

/// Height of the step with which an event begins.
pub(super) fn step_height(window: &Window) -> Option<f64> {
    match window.cause {
        Cause::ReferenceStep { from_n, to_n } => Some((to_n - from_n).abs()),
        Cause::CommandStep { from_v, to_v } => Some((to_v - from_v).abs()),
        _ => None,
    }
}

/// Places of the events that have their own figure; each event has its start and the height of its
/// step.
pub(super) fn enlarged_places(events: &[(f64, Option<f64>)], end_s: f64) -> Vec<usize> {
    let begun = events.iter().enumerate().filter(|(_, (start_s, _))| *start_s < end_s);
    let begun: Vec<(usize, Option<f64>)> = begun.map(|(place, (_, step))| (place, *step)).collect();
    let all = begun.iter().map(|(place, _)| *place);
    if begun.len() <= ENLARGED {
        return all.collect();
    }
    let heights = || begun.iter().map(|(_, step)| step.unwrap_or_default());
    let greatest = heights().fold(0.0, f64::max);
    let first = heights().position(|height| height == greatest);
    let chosen =
        begun.iter().enumerate().filter(|(index, (_, step))| step.is_none() || Some(*index) == first);
    chosen.map(|(_, (place, _))| *place).collect()
}

/// The events of windows that are within the frame.
pub(super) fn instants(
    windows: &[(Window, Metrics)],
    [start, end]: [f64; 2],
    motion: MotionKind,
) -> Vec<(f64, String)> {
    let seen = windows.iter().map(|(window, _)| window);
    let seen = seen.filter(|window| window.start_s >= start && window.start_s < end);
    seen.map(|window| (window.start_s, window.cause.label(motion).to_string())).collect()
}

/// Values of a signal at the times of its record.
pub(super) fn over_time(record: &Record, values: Vec<f64>) -> Trace {
    trace(&record.times_s, &values)
}

/// Figures of each scenario over time, its events enlarged, and its steps with their settling
/// bands, as SVG.
pub(crate) fn figure_files(runs: &[ScenarioRun]) -> Vec<OutputFile> {
    let of_run = |(number, run): (usize, &ScenarioRun)| {
        let mut figures = pictures(run, number + 1);
        figures.extend(steps(run, number + 1));
        figures
    };
    picture_files(&runs.iter().enumerate().flat_map(of_run).collect::<Vec<_>>())
}

/// The steps of the reference that have a figure, each until the next event.
fn steps(run: &ScenarioRun, number: usize) -> Vec<Figure> {
    let end = run.record.times_s.last().copied().unwrap_or(0.0);
    let steps = enlarged(&run.windows, end);
    steps.into_iter().filter_map(|(index, window)| step(run, window, (number, index + 1))).collect()
}

fn step(run: &ScenarioRun, window: &Window, (number, event): (usize, usize)) -> Option<Figure> {
    let Cause::ReferenceStep { to_n, .. } = window.cause else { return None };
    let (_, metrics) = run.windows.iter().find(|(one, _)| one == window)?;
    let settling = metrics.settling_time_s.ok();
    // three settling times show the result; without one, the whole window
    let until = settling.map_or(window.end_s, |time_s| window.end_s.min(window.start_s + 3.0 * time_s));
    let span = [(window.start_s - 0.05 * (until - window.start_s)).max(0.0), until];
    let record = &run.record;
    let of = |values: &[f64]| -> Vec<f64> {
        let pairs = record.times_s.iter().zip(values);
        pairs.filter(|(time, _)| (span[0]..=span[1]).contains(*time)).map(|(_, value)| *value).collect()
    };
    let percent = run.settling_band_percent;
    let shown = ForceStep {
        times_s: &of(&record.times_s),
        reference: &of(&record.reference_n),
        force: &of(&record.signal(Signal::Force)),
        filtered_reference: &of(&record.signal(Signal::FilteredReference)),
        command: &of(&record.signal(Signal::Control)),
        units: record.units,
        settling_band: (to_n != 0.0).then_some(SettlingBand { level: to_n, percent }),
        settled: settling
            .map(|time_s| (window.start_s + time_s, format!("t_s = {} s", significant(time_s, 3)))),
    };
    let title = format!("Step response: {}", cause_words(window, record.units));
    let caption = format!(
        "Measured {}, reference before and after the prefilter, and the command; the band is that of the settling time.",
        record.units.motion.words().force
    );
    Some(shown.chart().draw(&Words::new(format!("simulation-{number}-step-{event}"), title, caption)))
}

/// Figures of a comparison, with all projects in one figure for each scenario and each of its
/// events, as SVG.
pub(crate) fn comparison_files(comparison: &ScenarioComparison<'_>) -> Vec<OutputFile> {
    let scenarios = comparison.scenarios().into_iter().enumerate();
    let figures = scenarios.flat_map(|(number, name)| compared(comparison, name, number + 1));
    picture_files(&figures.collect::<Vec<_>>())
}

/// Figures of one scenario for all projects that have it: the whole, and each event of the first
/// project.
fn compared(comparison: &ScenarioComparison<'_>, name: &str, number: usize) -> Vec<Figure> {
    let projects: Vec<&Loaded> = comparison.projects.iter().map(|(loaded, _)| *loaded).collect();
    let titles = compared_titles(&projects).into_iter();
    let (titles, runs): (Vec<String>, Vec<&ScenarioRun>) =
        titles.zip(comparison.runs_of(name)).filter_map(|(title, run)| Some((title, run?))).unzip();
    let motion = runs.first().map(|run| run.record.units.motion).unwrap_or_default();
    let force = capital(motion.words().force);
    let caption = format!("{force}, command and load pressure of each project.");
    let runs: Vec<OverlaidRun> = runs.into_iter().map(OverlaidRun::of).collect();
    laid_over((&format!("compare-{number}"), name, &caption), &titles, &runs.iter().collect::<Vec<_>>())
}

/// The difference of the pressures of both chambers.
pub(super) fn load_pressure(record: &Record) -> Vec<f64> {
    let (one, other) = (record.signal(Signal::PressureA), record.signal(Signal::PressureB));
    one.iter().zip(&other).map(|(one, other)| one - other).collect()
}
