//! Figures of one scenario under several controllers: the same machine, the same reference, a colour for each controller.

use super::figures::{
    AFTER_S, BEFORE_S, around, asked_for, close_up, enlarged, instant, moves_load, over_time, panel,
};
use super::{Cause, Record, ScenarioRun, TrackingWish, Window, cause_words};
use crate::figure::{DisplayUnit, Figure, TimePanel, TimePanelsInput, TimeSeries, Words, time_panels};
use crate::quantity::MotionKind;

/// A run with the name of its controller.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NamedRun<'a> {
    /// Such as `designed`.
    pub(crate) name: &'static str,
    /// Of the scenario that all have in common.
    pub(crate) run: &'a ScenarioRun,
}

/// The whole run, and each event enlarged, every controller in each figure.
pub(crate) fn together(runs: &[NamedRun<'_>], number: usize, wish: Option<&TrackingWish>) -> Vec<Figure> {
    let Some(first) = runs.first() else { return vec![] };
    let end = end_of(runs);
    let words = Words::new(
        format!("simulation-{number}"),
        format!("Simulated: {}", first.run.name),
        format!("Force, command, load pressure and piston over the whole scenario, {}.", whose(runs)),
    );
    let mut figures = vec![drawn(words, runs, [0.0, end], ([190.0, 110.0], true), wish)];
    for (index, window) in enlarged(&first.run.windows, end) {
        let words = Words::new(
            format!("simulation-{number}-event-{}", index + 1),
            format!("Enlarged: {}", cause_words(window)),
            format!("What the event does to force, command and load pressure, {}.", whose(runs)),
        );
        let shown = ([190.0, 110.0], moves_load(window));
        figures.push(drawn(words, runs, around(window, end), shown, wish));
    }
    figures
}

/// Force and command from the first event to a little after the last, or of the whole run where nothing begins.
pub(crate) fn at_a_glance(name: &str, runs: &[NamedRun<'_>], wish: Option<&TrackingWish>) -> Option<Figure> {
    let first = runs.first()?;
    let end = end_of(runs);
    let starts = || first.run.windows.iter().map(|(window, _)| window.start_s);
    let from = starts().fold(end, f64::min);
    let until = starts().fold(0.0, f64::max) + AFTER_S;
    let span = if from < end { [(from - BEFORE_S).max(0.0), until.min(end)] } else { [0.0, end] };
    let title = format!("Force over time: {}", first.run.name);
    let caption = format!("The nonlinear machine, {}{}.", whose(runs), of_wish(wish));
    let mut input =
        TimePanelsInput { panels: forces_enlarged(runs, [220.0, 110.0], span, wish), ..input(runs, span) };
    input.panels.push(commands(runs, 90.0));
    Some(time_panels(Words::new(name, title, caption), &input))
}

/// The signals inside the machine at each event, for one controller: as Figure 6.17 of Ledezma
/// (2019).
pub(crate) fn close_ups(named: NamedRun<'_>, number: usize) -> Vec<Figure> {
    let NamedRun { name, run } = named;
    let end = end_of(&[named]);
    let events = enlarged(&run.windows, end).into_iter();
    let figure = |(index, window): (usize, &Window)| {
        let words = Words::new(
            format!("simulation-{number}-{name}-event-{}", index + 1),
            format!("Inside the machine, {name} controller: {}, {}", run.name, cause_words(window)),
            "Voltages, pressures of both chambers, hydraulic and measured force, measured force.",
        );
        close_up(words, run, window, around(window, end))
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
        let measured = curve(&overlay.times_s, &overlay.measured);
        let series = simulated.chain([measured]).collect();
        let reference = asked_for(&first.run.record).filter(|_| overlay.signal == "force_n");
        TimePanel { reference, ..panel(&overlay.quantity(), overlay.display_unit(), height, series) }
    });
    let panels: Vec<TimePanel> = panels.collect();
    let words = Words::new(
        format!("simulation-{number}-measured"),
        format!("Measured and simulated: {}", first.run.name),
        format!("What was measured on the rig, on what its machine does, {}.", whose(runs)),
    );
    let mut input = TimePanelsInput { panels, ..input(runs, [0.0, end_of(runs)]) };
    input.legend.truncate(runs.len());
    input.legend.push("measured".to_string());
    (!overlays.is_empty()).then(|| time_panels(words, &input))
}

fn curve(times_s: &[f64], values: &[f64]) -> TimeSeries {
    TimeSeries { name: String::new(), times_s: times_s.to_vec(), values: values.to_vec() }
}

fn end_of(runs: &[NamedRun<'_>]) -> f64 {
    runs.iter().filter_map(|named| named.run.record.times_s.last().copied()).fold(0.0, f64::max)
}

/// `under the designed and the given controller`.
fn whose(runs: &[NamedRun<'_>]) -> String {
    let names: Vec<String> = runs.iter().map(|named| format!("the {}", named.name)).collect();
    format!("under {} controller", names.join(" and "))
}

fn of_wish(wish: Option<&TrackingWish>) -> String {
    let wished = wish.map(|wish| [wish.overshoot_words(), wish.settling_words()]);
    let words: Vec<String> = wished.into_iter().flatten().flatten().collect();
    if words.is_empty() { String::new() } else { format!("; wished: {}", words.join(", ")) }
}

fn drawn(
    words: Words,
    runs: &[NamedRun<'_>],
    span_s: [f64; 2],
    ([tall, low], positions): ([f64; 2], bool),
    wish: Option<&TrackingWish>,
) -> Figure {
    let load_pressure = |record: &Record| {
        let (one, other) = (record.signal("pressure_a_pa"), record.signal("pressure_b_pa"));
        one.iter().zip(&other).map(|(one, other)| one - other).collect()
    };
    // a step is compared with its wish; motions of the load, and the whole run, show the piston
    let mut panels = match positions {
        true => vec![forces(runs, tall, span_s, wish)],
        false => forces_enlarged(runs, [tall, low], span_s, wish),
    };
    panels.push(commands(runs, low));
    panels.push(panel("p_A - p_B", DisplayUnit::BAR, low, each(runs, load_pressure)));
    if positions {
        let piston = each(runs, |record| record.signal("position_m"));
        panels.push(panel("Piston", motion(runs).unit(DisplayUnit::MILLIMETRE), 90.0, piston));
    }
    time_panels(words, &TimePanelsInput { panels, ..input(runs, span_s) })
}

/// Names, span and events; the panels follow.
fn input(runs: &[NamedRun<'_>], span_s: [f64; 2]) -> TimePanelsInput {
    let windows = runs.first().map(|named| named.run.windows.as_slice()).unwrap_or_default();
    let mut legend: Vec<String> = runs.iter().map(|named| named.name.to_string()).collect();
    if force_measured(runs).is_some() {
        legend.push("measured".to_string());
    }
    TimePanelsInput {
        panels: vec![],
        legend,
        reference: "reference".to_string(),
        events: windows.iter().filter_map(|(window, _)| instant(window, span_s)).collect(),
        span_s,
    }
}

fn each(runs: &[NamedRun<'_>], values: impl Fn(&Record) -> Vec<f64>) -> Vec<TimeSeries> {
    runs.iter().map(|named| over_time(&named.run.record, values(&named.run.record))).collect()
}

/// How the rigs of these runs move.
fn motion(runs: &[NamedRun<'_>]) -> MotionKind {
    runs.first().map_or(MotionKind::Linear, |named| named.run.record.motion)
}

/// The force as measured on the rig, if it was measured.
fn force_measured(runs: &[NamedRun<'_>]) -> Option<TimeSeries> {
    let overlay = runs.first()?.run.measured.iter().find(|overlay| overlay.signal == "force_n")?;
    Some(curve(&overlay.times_s, &overlay.measured))
}

fn forces(runs: &[NamedRun<'_>], height: f64, span_s: [f64; 2], wish: Option<&TrackingWish>) -> TimePanel {
    let mut curves = each(runs, |record| record.signal("force_n"));
    curves.extend(force_measured(runs));
    let first = runs.first().map(|named| named.run);
    let windows = first.map(|run| run.windows.as_slice()).unwrap_or_default();
    let lines = wish.map(|wish| {
        wish.lines(windows.iter().map(|(window, _)| window), span_s).iter().map(|line| series(line)).collect()
    });
    TimePanel {
        reference: first.and_then(|run| asked_for(&run.record)),
        wished: lines.unwrap_or_default(),
        ..panel("Force F_e", motion(runs).unit(DisplayUnit::KILONEWTON), height, curves)
    }
}

/// The force and, below it, an enlargement around the reference of the only step in the frame, if
/// there is a wish for it.
fn forces_enlarged(
    runs: &[NamedRun<'_>],
    [tall, low]: [f64; 2],
    span_s: [f64; 2],
    wish: Option<&TrackingWish>,
) -> Vec<TimePanel> {
    let whole = forces(runs, tall, span_s, wish);
    let near = near_reference(runs, span_s).filter(|_| !whole.wished.is_empty());
    let enlarged = near.map(|shown| TimePanel {
        quantity: "F_e enlarged".to_string(),
        shown: Some(shown),
        height: low,
        ..whole.clone()
    });
    std::iter::once(whole).chain(enlarged).collect()
}

/// Range around the reference that is shown enlarged, as shares of the step; more if the force
/// overshoots by more.
const BELOW: f64 = 0.06;
const ABOVE: f64 = 0.04;
const OVERSHOOTS: f64 = 1.2;

/// The range around the reference after the only step that begins in a span; `None` if none or
/// several do.
fn near_reference(runs: &[NamedRun<'_>], span_s: [f64; 2]) -> Option<[f64; 2]> {
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
    let above = overshoots.fold(ABOVE, |most, percent| most.max(0.01 * OVERSHOOTS * percent));
    let ends = [to_n - BELOW * step_n, to_n + above * step_n];
    (above.is_finite() && above < 1.0).then(|| [ends[0].min(ends[1]), ends[0].max(ends[1])])
}

fn commands(runs: &[NamedRun<'_>], height: f64) -> TimePanel {
    // the longer title does not fit next to a low frame
    let title = if height < 100.0 { "U_C" } else { "Command U_C" };
    panel(title, DisplayUnit::VOLT, height, each(runs, |record| record.control_v.clone()))
}

/// A line that the force should not cross.
fn series(line: &[[f64; 2]]) -> TimeSeries {
    let (times_s, values) = line.iter().map(|[time_s, value]| (*time_s, *value)).unzip();
    TimeSeries { name: String::new(), times_s, values }
}
