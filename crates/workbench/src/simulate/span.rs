//! The time that a figure of an event shows: until a step has settled, or two cycles of a repeating
//! input.

use phea_engineering::simulate::{Cause, Metrics, Record, ScenarioRun, Window};
use phea_hydraulics::signal::Signal;

/// Time shown before an event, as a fraction of the time after it.
const BEFORE: f64 = 0.05;
/// Time shown of a step or a disturbance, in settling times.
const SETTLING_TIMES: f64 = 3.0;
/// Time shown after an event that neither settles nor repeats, s.
const AFTER_S: f64 = 0.5;
/// Shortest time shown after an event, s.
const SHORTEST_S: f64 = 0.05;
/// Time shown of a reference that repeats, in cycles.
const CYCLES: f64 = 2.0;

/// The time that the figure of an event shows, within the run.
pub(crate) fn span_of(run: &ScenarioRun, window: &Window, end_s: f64) -> [f64; 2] {
    around(window.start_s, shown_after(run, window), end_s)
}

/// Time shown after the start of an event, s.
pub(super) fn shown_after(run: &ScenarioRun, window: &Window) -> f64 {
    let metrics = run.windows.iter().find(|(own, _)| own == window).map(|(_, metrics)| metrics);
    match window.cause {
        Cause::ReferenceMotion { .. } => moving(&run.record, &run.record.reference_n, window),
        Cause::CommandMotion { .. } => moving(&run.record, &run.record.signal(Signal::Control), window),
        _ => settled(metrics),
    }
}

/// The time around the start of an event, this long after it.
pub(crate) fn around(start_s: f64, after_s: f64, end_s: f64) -> [f64; 2] {
    let after_s = after_s.max(SHORTEST_S);
    [(start_s - BEFORE * after_s).max(0.0), (start_s + after_s).min(end_s)]
}

/// Three settling times; a fixed time if the force does not settle.
fn settled(metrics: Option<&Metrics>) -> f64 {
    let settling_s = metrics.and_then(|metrics| metrics.settling_time_s.ok());
    settling_s.map_or(AFTER_S, |time_s| SETTLING_TIMES * time_s)
}

/// Two cycles of an input that repeats; otherwise the time until it rests.
fn moving(record: &Record, values: &[f64], window: &Window) -> f64 {
    let rows = record.times_s.iter().copied().zip(values.iter().copied());
    let within: Vec<(f64, f64)> =
        rows.filter(|(time_s, _)| (window.start_s..=window.end_s).contains(time_s)).collect();
    if let Some(period_s) = period(&within).filter(|_| repeats(window)) {
        return CYCLES * period_s;
    }
    let last = within.last().map(|(_, value)| *value);
    let moves = within.iter().rev().find(|(_, value)| Some(*value) != last);
    moves.map_or(AFTER_S, |(time_s, _)| time_s - window.start_s + AFTER_S)
}

/// True if an event begins a repeating input: a sine.
fn repeats(window: &Window) -> bool {
    matches!(window.cause, Cause::ReferenceMotion { kind: SINE } | Cause::CommandMotion { kind: SINE })
}

const SINE: &str = "sine";

/// True if two spans are equal within a tenth.
pub(crate) fn are_alike([start, end]: [f64; 2], [other_start, other_end]: [f64; 2]) -> bool {
    let room = 0.1 * (end - start).max(other_end - other_start);
    (start - other_start).abs() <= room && (end - other_end).abs() <= room
}

/// Time between two upward crossings of the middle, if there are three, so that the signal repeats
/// twice.
pub(crate) fn period(rows: &[(f64, f64)]) -> Option<f64> {
    let (least, most) = rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), (_, value)| {
        (least.min(*value), most.max(*value))
    });
    let middle = 0.5 * (least + most);
    let mut crossings = rows.windows(2).filter_map(|pair| match pair {
        [(_, before), (time_s, after)] if *before <= middle && *after > middle => Some(*time_s),
        _ => None,
    });
    let (first, second) = (crossings.next()?, crossings.next()?);
    crossings.next().map(|_| second - first)
}

/// The part of a run that shows all its events: from the beginning to the end of the last event's
/// figure, if the rest would only repeat it.
pub(crate) fn span_of_events(run: &ScenarioRun, end_s: f64) -> [f64; 2] {
    let ends = run.windows.iter().map(|(window, _)| span_of(run, window, end_s)[1]);
    let last = ends.fold(0.0, f64::max);
    let ends_so = run.windows.last().is_some_and(|(window, _)| repeats(window));
    [0.0, if ends_so && last > 0.0 { last } else { end_s }]
}
