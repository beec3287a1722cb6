//! Figures of one scenario under several controllers: one machine and one reference, a colour for
//! each controller.

use super::figures::{
    close_up, enlarged, error_title, instants, load_pressure, moves_load, over_time, reference_trace,
    shown_words, tracking_error,
};
use super::span::{are_alike, span_of, span_of_events};
use super::{
    Cause, Record, ScenarioRun, StepLimits, Window, cause_words, required_overshoot, required_settling,
};
use crate::document::capital;
use crate::figure::{CurveChart, CurvePanel, CurveRange, CurveStyle, DisplayUnit, Figure, Words};
use crate::over_time::{Trace, chart, has, measured_force, panel, trace, with_lines_beneath};
use crate::quantity::{MotionWords, Units};
use phea_hydraulics::signal::Signal;

/// A run with the name of its controller.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NamedRun<'a> {
    /// Name of the controller, such as `designed`.
    pub(crate) name: &'static str,
    /// The run of the scenario that all have in common.
    pub(crate) run: &'a ScenarioRun,
}

/// The whole run, and each event enlarged, every controller in each figure.
pub(crate) fn together(
    runs: &[NamedRun<'_>],
    number: usize,
    requirement: Option<&StepLimits>,
) -> Vec<Figure> {
    let Some(first) = runs.first() else { return vec![] };
    let MotionWords { force, piston, .. } = units(runs).motion.words();
    let end = end_of(runs);
    let words = Words::new(
        format!("simulation-{number}"),
        format!("Simulated: {}", first.run.name),
        format!(
            "{}, command, load pressure and {piston} over {}, {}.",
            capital(force),
            shown_words(first.run, end),
            whose(runs)
        ),
    );
    let mut figures =
        vec![drawn(&words, runs, span_of_events(first.run, end), ([190.0, 110.0], true), requirement)];
    for (index, window) in enlarged(&first.run.windows, end) {
        if are_alike(longest(runs, window, end), span_of_events(first.run, end)) {
            continue;
        }
        let words = Words::new(
            format!("simulation-{number}-event-{}", index + 1),
            format!("Enlarged: {}", cause_words(window, units(runs))),
            format!("What the event does to {force}, command and load pressure, {}.", whose(runs)),
        );
        let shown = ([190.0, 110.0], moves_load(window));
        figures.push(drawn(&words, runs, longest(runs, window, end), shown, requirement));
    }
    figures
}

/// Force and command from the first event to a little after the last, or over the whole run if
/// nothing begins.
pub(crate) fn at_a_glance(
    name: &str,
    runs: &[NamedRun<'_>],
    requirement: Option<&StepLimits>,
) -> Option<Figure> {
    let first = runs.first()?;
    let end = end_of(runs);
    let spans = || first.run.windows.iter().map(|(window, _)| longest(runs, window, end));
    let from = spans().map(|span| span[0]).fold(end, f64::min);
    let until = spans().map(|span| span[1]).fold(0.0, f64::max);
    let span = if from < until { [from, until] } else { [0.0, end] };
    let force = capital(units(runs).motion.words().force);
    let title = format!("{force} over time: {}", first.run.name);
    let caption = format!("The nonlinear simulation, {}{}.", whose(runs), required_words(requirement));
    let mut panels = forces_enlarged(runs, [220.0, 110.0], span, requirement);
    panels.extend(errors(runs, span));
    panels.push(commands(runs, 90.0));
    Some(with_events(runs, panels, span).draw(&Words::new(name, title, caption)))
}

/// The signals inside the machine at each event, for one controller, in the layout of Figure 6.17
/// of Ledezma (2019).
pub(crate) fn close_ups(named: NamedRun<'_>, number: usize) -> Vec<Figure> {
    let NamedRun { name, run } = named;
    let force = run.record.units.motion.words().force;
    let end = end_of(&[named]);
    let events = enlarged(&run.windows, end).into_iter();
    let figure = |(index, window): (usize, &Window)| {
        let words = Words::new(
            format!("simulation-{number}-{name}-event-{}", index + 1),
            format!(
                "Inside the simulated rig, {name} controller: {}, {}",
                run.name,
                cause_words(window, run.record.units)
            ),
            format!(
                "Voltages, pressures of both chambers, hydraulic and measured {force}, measured {force}."
            ),
        );
        close_up(&words, run, window, span_of(run, window, end))
    };
    events.map(figure).collect()
}

/// Measurement and simulation under each controller: a panel for each signal.
pub(crate) fn measured_together(runs: &[NamedRun<'_>], number: usize) -> Option<Figure> {
    let first = runs.first()?;
    let overlays = &first.run.measured;
    let height = if overlays.len() > 3 { 100.0 } else { 170.0 };
    let panels = overlays.iter().map(|overlay| {
        let simulated = runs.iter().map(|named| {
            let record = &named.run.record;
            over_time(record, record.signal(overlay.signal))
        });
        let measured = trace(&overlay.times_s, &overlay.measured);
        let series = simulated.chain([measured]).collect();
        let reference = reference_trace(&first.run.record).filter(|_| overlay.signal == Signal::Force);
        let units = first.run.record.units;
        let (title, unit) = (overlay.signal.words(units.motion), overlay.display_unit(units));
        with_lines_beneath(panel(&title, unit, height, series), unit, CurveStyle::Reference, reference)
    });
    let panels: Vec<CurvePanel> = panels.collect();
    let words = Words::new(
        format!("simulation-{number}-measured"),
        format!("Measured and simulated: {}", first.run.name),
        format!("What was measured on the rig, on what its machine does, {}.", whose(runs)),
    );
    let names = runs.iter().map(|named| named.name).chain(["measured"]).map(String::from);
    let span_s = [0.0, end_of(runs)];
    let events = instants(&first.run.windows, span_s, units(runs).motion);
    (!overlays.is_empty()).then(|| chart(panels, names, &events, span_s).draw(&words))
}

fn end_of(runs: &[NamedRun<'_>]) -> f64 {
    runs.iter().filter_map(|named| named.run.record.times_s.last().copied()).fold(0.0, f64::max)
}

/// The time that shows an event under every controller.
fn longest(runs: &[NamedRun<'_>], window: &Window, end_s: f64) -> [f64; 2] {
    let spans = runs.iter().map(|named| match named.run.windows.iter().find(|(own, _)| own == window) {
        Some((own, _)) => span_of(named.run, own, end_s),
        None => [window.start_s, window.start_s],
    });
    let all = spans.fold([f64::INFINITY, 0.0], |all: [f64; 2], one| [all[0].min(one[0]), all[1].max(one[1])]);
    [all[0].min(window.start_s), all[1]]
}

/// `under the designed and the given controller`.
fn whose(runs: &[NamedRun<'_>]) -> String {
    let names: Vec<String> = runs.iter().map(|named| format!("the {}", named.name)).collect();
    format!("under {} controller", names.join(" and "))
}

fn required_words(requirement: Option<&StepLimits>) -> String {
    let words =
        requirement.map(|requirement| [required_overshoot(requirement), required_settling(requirement)]);
    let words: Vec<String> = words.into_iter().flatten().flatten().collect();
    if words.is_empty() { String::new() } else { format!("; required: {}", words.join(", ")) }
}

fn drawn(
    words: &Words,
    runs: &[NamedRun<'_>],
    span_s: [f64; 2],
    ([tall, low], positions): ([f64; 2], bool),
    requirement: Option<&StepLimits>,
) -> Figure {
    // a step is compared with its requirement; motions of the load, and the whole run, show the
    // piston
    let mut panels = match positions {
        true => vec![forces(runs, tall, span_s, requirement)],
        false => forces_enlarged(runs, [tall, low], span_s, requirement),
    };
    panels.extend(errors(runs, span_s));
    panels.push(commands(runs, low));
    panels.push(panel("p_A - p_B", units(runs).pressure, low, each(runs, load_pressure)));
    if positions {
        let piston = each(runs, |record| record.signal(Signal::Position));
        let Units { motion, position, .. } = units(runs);
        panels.push(panel(&capital(motion.words().piston), position, 90.0, piston));
    }
    with_events(runs, panels, span_s).draw(words)
}

/// Reference less force, where the reference moves.
fn errors(runs: &[NamedRun<'_>], span_s: [f64; 2]) -> Option<CurvePanel> {
    let Units { motion, force: unit, .. } = units(runs);
    moves_reference(runs, span_s)
        .then(|| panel(error_title(motion), unit, 90.0, each(runs, tracking_error)).with_zero_line())
}

/// True if the reference begins to move within a span, other than by steps.
fn moves_reference(runs: &[NamedRun<'_>], [start_s, end_s]: [f64; 2]) -> bool {
    let windows = runs.iter().flat_map(|named| &named.run.windows);
    let within = windows.filter(|(window, _)| (start_s..end_s).contains(&window.start_s));
    within.into_iter().any(|(window, _)| matches!(window.cause, Cause::ReferenceMotion { .. }))
}

/// Panels with the name of each controller and the events.
fn with_events(runs: &[NamedRun<'_>], panels: Vec<CurvePanel>, span_s: [f64; 2]) -> CurveChart {
    let windows = runs.first().map(|named| named.run.windows.as_slice()).unwrap_or_default();
    let measured = force_measured(runs).map(|_| "measured");
    let names = runs.iter().map(|named| named.name).chain(measured).map(String::from);
    chart(panels, names, &instants(windows, span_s, units(runs).motion), span_s)
}

fn each(runs: &[NamedRun<'_>], values: impl Fn(&Record) -> Vec<f64>) -> Vec<Trace> {
    runs.iter().map(|named| over_time(&named.run.record, values(&named.run.record))).collect()
}

/// The units in which these runs are drawn.
fn units(runs: &[NamedRun<'_>]) -> Units {
    runs.first().map_or(Units::default(), |named| named.run.record.units)
}

/// The force as measured on the rig, if it was measured.
fn force_measured(runs: &[NamedRun<'_>]) -> Option<Trace> {
    let overlay = runs.first()?.run.measured.iter().find(|overlay| overlay.signal == Signal::Force)?;
    Some(trace(&overlay.times_s, &overlay.measured))
}

fn forces(
    runs: &[NamedRun<'_>],
    height: f64,
    span_s: [f64; 2],
    requirement: Option<&StepLimits>,
) -> CurvePanel {
    let mut curves = each(runs, |record| record.signal(Signal::Force));
    curves.extend(force_measured(runs));
    let first = runs.first().map(|named| named.run);
    let windows = first.map(|run| run.windows.as_slice()).unwrap_or_default();
    let limits =
        requirement.map(|requirement| requirement.lines(windows.iter().map(|(window, _)| window), span_s));
    let limits = limits.into_iter().flatten();
    let limits = limits.map(|line| line.iter().map(|[time_s, value]| (*time_s, *value)).collect());
    let Units { motion, force: unit, .. } = units(runs);
    let panel = with_lines_beneath(
        panel(&measured_force(motion), unit, height, curves),
        unit,
        CurveStyle::Limit,
        limits,
    );
    with_lines_beneath(panel, unit, CurveStyle::Reference, first.and_then(|run| reference_trace(&run.record)))
}

/// The force and, below it, an enlargement around the reference of the only step in the frame, if
/// there is a requirement for it.
fn forces_enlarged(
    runs: &[NamedRun<'_>],
    [tall, low]: [f64; 2],
    span_s: [f64; 2],
    requirement: Option<&StepLimits>,
) -> Vec<CurvePanel> {
    let whole = forces(runs, tall, span_s, requirement);
    let near = near_reference(runs, span_s, requirement).filter(|_| has(&whole, CurveStyle::Limit));
    let Units { motion, force: unit, .. } = units(runs);
    let enlarged = near.map(|ends| CurvePanel {
        title: unit.title(motion.either("F_e enlarged", "T_e enlarged")),
        range: CurveRange::Between(ends.map(|end| unit.of(end))),
        height: low,
        ..whole.clone()
    });
    std::iter::once(whole).chain(enlarged).collect()
}

/// Range around the reference that is enlarged: the required band or the allowed overshoot,
/// whichever is wider; larger above if the force overshoots by more.
const BANDS: f64 = 2.0;
const OVERSHOOTS: f64 = 1.2;

/// The range around the reference after the only step that begins in a span; `None` if none or
/// several do.
fn near_reference(
    runs: &[NamedRun<'_>],
    span_s: [f64; 2],
    requirement: Option<&StepLimits>,
) -> Option<[f64; 2]> {
    let requirement = requirement?;
    let required = BANDS * 0.01 * requirement.band_percent.max(requirement.overshoot_percent.unwrap_or(0.0));
    let [start_s, end_s] = span_s;
    let seen = |window: &Window| (start_s..end_s).contains(&window.start_s);
    let first = runs.first()?.run;
    let mut steps = first.windows.iter().enumerate().filter_map(|(index, (window, _))| match window.cause {
        Cause::ReferenceStep { from_n, to_n } if seen(window) => Some((index, to_n, to_n - from_n)),
        _ => None,
    });
    let ((index, to_n, step_n), None) = (steps.next()?, steps.next()) else { return None };
    let metrics = runs.iter().filter_map(|named| named.run.windows.get(index));
    let overshoots = metrics.filter_map(|(_, metrics)| metrics.overshoot_percent.ok());
    let above = overshoots.fold(required, |most, percent| most.max(0.01 * OVERSHOOTS * percent));
    let ends = [to_n - required * step_n, to_n + above * step_n];
    (above.is_finite() && above < 1.0).then(|| [ends[0].min(ends[1]), ends[0].max(ends[1])])
}

fn commands(runs: &[NamedRun<'_>], height: f64) -> CurvePanel {
    // the longer title does not fit next to a low frame
    let title = if height < 100.0 { "U_C" } else { "Command U_C" };
    panel(title, DisplayUnit::VOLT, height, each(runs, |record| record.signal(Signal::Control)))
}
