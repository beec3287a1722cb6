//! What `simulate` and `compare` say to people.

use super::check;
use super::{BeyondExpansion, Cause, Comparison, Metrics, Occurrence, Overlay, ScenarioRun, Stopped, Window};
use super::{Measured, NOT_SETTLED, exceeded_words};
use crate::answer::{significant, table};
use crate::project::Loaded;
use crate::quantity::{DisplayUnit, FORCE, PRESSURE, TIME, VOLTAGE, display};

/// Occurrences that are told one by one; more are counted.
const TOLD: usize = 8;

/// The tables and sentences of `simulate`.
pub(crate) fn text(loaded: &Loaded, runs: &[ScenarioRun]) -> String {
    let mut out = String::new();
    for run in runs {
        out.push_str(&format!("{}\n", headline(run)));
        if !run.windows.is_empty() {
            out.push_str(&format!("{}\n", windows(run)));
        }
        if !run.measured.is_empty() {
            out.push_str(&format!("{}\n", measured(run)));
        }
        let checked = run.check.iter().flat_map(check::sentences);
        for sentence in coarse_sentence(run).into_iter().chain(checked).chain(occurrence_sentences(run)) {
            out.push_str(&format!("  {sentence}\n"));
        }
        out.push('\n');
    }
    out.push_str(&not_run(loaded, runs));
    out
}

fn not_run(loaded: &Loaded, runs: &[ScenarioRun]) -> String {
    match loaded.project.scenarios.len().saturating_sub(runs.len()) {
        0 => String::new(),
        1 => "One scenario was not begun.\n".to_string(),
        more => format!("{more} scenarios were not begun.\n"),
    }
}

/// Name and end of a run, and what it cost.
pub(crate) fn headline(run: &ScenarioRun) -> String {
    let work = format!("{} steps, {} rejected", run.work.steps, run.work.rejected);
    let loop_words = if run.open_loop { " open loop" } else { "" };
    match run.stopped() {
        None => format!("{}: completed{loop_words} ({work})", run.name),
        Some(stopped) => {
            let why = why(&stopped);
            format!("{}: ended{loop_words} at {} s, {why} ({work})", run.name, significant(stopped.time_s, 6))
        }
    }
}

fn why(stopped: &Stopped) -> String {
    let told = match (stopped.word, stopped.mode) {
        (_, Some(mode)) => {
            return format!(
                "an oscillation at {} rad/s that grows by {} 1/s would take more steps than `simulation.maximum_steps` allows",
                significant(mode.frequency_rad_per_s, 4),
                significant(mode.growth_per_s, 3)
            );
        }
        ("cancelled", _) => "stopped",
        ("step_too_small", _) => "no step is short enough for the tolerance",
        ("not_finite", _) => "a rate is no longer a number",
        _ => "the steps it may take are used up",
    };
    told.to_string()
}

/// Metrics that have a column only where some window has them.
const RARE: [&str; 2] = ["tracking error peak", "force peak"];

fn windows(run: &ScenarioRun) -> String {
    let band = run.settling_band_percent;
    let cells: Vec<[String; METRICS.len()]> =
        run.windows.iter().map(|(_, metrics)| cells_of(metrics)).collect();
    let has = |metric: usize| cells.iter().any(|cells| cells[metric] != ABSENT);
    let always = |name: &str| !run.open_loop && !RARE.contains(&name);
    let shown: Vec<usize> =
        (0..METRICS.len()).filter(|metric| always(METRICS[*metric]) || has(*metric)).collect();
    let head = |metric: &usize| match METRICS[*metric] {
        "settling" => format!("settling ({band} %)"),
        "disturbance peak" => "disturbance".to_string(),
        name => name.to_string(),
    };
    let heads: Vec<String> = std::iter::once("event".to_string()).chain(shown.iter().map(head)).collect();
    let mut rows = table(&heads.iter().map(String::as_str).collect::<Vec<_>>());
    for ((window, _), cells) in run.windows.iter().zip(&cells) {
        let shown = shown.iter().map(|metric| cells[*metric].clone());
        rows.add_row(std::iter::once(cause_words(window)).chain(shown).collect::<Vec<_>>());
    }
    rows.trim_fmt()
}

fn measured(run: &ScenarioRun) -> String {
    let mut rows = table(&MEASURED);
    for overlay in &run.measured {
        rows.add_row(measured_cells(overlay));
    }
    rows.trim_fmt()
}

/// Heads of the table of what was measured, and its cells.
pub(crate) const MEASURED: [&str; 5] = ["measured", "as column of", "NRMSE", "RMSE", "rows"];

pub(crate) fn measured_cells(overlay: &Overlay) -> [String; 5] {
    let unit = overlay.display_unit();
    let percent = |ratio: f64| format!("{} %", significant(100.0 * ratio, 3));
    let rows = match overlay.rows_outside {
        0 => overlay.times_s.len().to_string(),
        outside => format!("{}, {outside} more outside", overlay.times_s.len()),
    };
    [
        overlay.signal.to_string(),
        format!("{} `{}`", overlay.file, overlay.column),
        overlay.nrmse.map_or(ABSENT.to_string(), percent),
        overlay.rmse.map_or(ABSENT.to_string(), |rmse| unit.text(rmse, 3)),
        rows,
    ]
}

/// What began a window.
pub(crate) fn cause_words(window: &Window) -> String {
    let at = display(window.start_s, &TIME, 4);
    match window.cause {
        Cause::ReferenceStep { to_n, .. } => format!("step to {} at {at}", display(to_n, &FORCE, 4)),
        Cause::ReferenceMotion { kind } => format!("{kind} at {at}"),
        Cause::CommandStep { to_v, .. } => format!("command to {} at {at}", display(to_v, &VOLTAGE, 4)),
        Cause::CommandMotion { kind } => format!("{kind} of the command at {at}"),
        Cause::LoadMotion => format!("load motion at {at}"),
        Cause::ExternalForce => format!("force from outside at {at}"),
    }
}

/// Names and cells of the metrics, in one order.
pub(crate) const METRICS: [&str; 9] = [
    "overshoot",
    "rise",
    "settling",
    "disturbance peak",
    "tracking error peak",
    "force peak",
    "steady-state error",
    "control peak",
    "control rms",
];

/// In place of a metric that there is not.
pub(crate) const ABSENT: &str = "-";

/// Each metric with its unit; [`ABSENT`] where there is none.
pub(crate) fn cells_of(metrics: &Metrics) -> [String; METRICS.len()] {
    let cell = |measured: Measured, digits: usize, unit: &str| {
        measured.map_or(ABSENT.to_string(), |value| format!("{} {unit}", significant(value, digits)))
    };
    let settling = match metrics.settling_time_s {
        Ok(time_s) => format!("{} s", significant(time_s, 3)),
        Err(NOT_SETTLED) => "not settled".to_string(),
        Err(_) => ABSENT.to_string(),
    };
    let error = metrics.steady_state_error_n.map(small_as_zero);
    [
        cell(metrics.overshoot_percent, 3, "%"),
        cell(metrics.rise_time_s, 3, "s"),
        settling,
        cell(metrics.disturbance_peak_n, 4, "N"),
        cell(metrics.tracking_error_peak_n, 4, "N"),
        cell(metrics.force_peak_n, 4, "N"),
        cell(error, 2, "N"),
        cell(metrics.control_peak_v, 3, "V"),
        cell(metrics.control_rms_v, 3, "V"),
    ]
}

/// A steady error below a millinewton is what the method leaves, not what the loop does.
pub(crate) fn small_as_zero(error_n: f64) -> f64 {
    if error_n.abs() < 1e-3 { 0.0 } else { error_n }
}

/// What the figures of a long scenario do not show.
pub(crate) fn coarse_sentence(run: &ScenarioRun) -> Option<String> {
    run.is_coarse().then(|| {
        let look = DisplayUnit::MILLISECOND.number(run.look_s, 3);
        format!("so long a scenario is drawn from looks every {look} ms only; its numbers are those of the solution between them too")
    })
}

/// What happened on the way, a sentence each.
pub(crate) fn occurrence_sentences(run: &ScenarioRun) -> Vec<String> {
    let found = &run.occurrences;
    let mut sentences: Vec<String> = found.iter().take(TOLD).map(occurrence_words).collect();
    if found.len() > TOLD {
        sentences.push(format!("and {} more changes of this kind, listed in the JSON", found.len() - TOLD));
    }
    sentences.extend(run.beyond_expansion.iter().map(beyond_words));
    sentences.extend(run.exceeded.iter().map(exceeded_words));
    sentences.extend(run.outside_model_s.map(|time_s| {
        let from = DisplayUnit::SECOND.number(time_s, 5);
        format!("from {from} s on the equations do not hold: what follows is theirs, not that of a machine")
    }));
    sentences
}

fn beyond_words(beyond: &BeyondExpansion) -> String {
    let [peak, stated] = [beyond.peak_pa, beyond.stated_pa].map(|pressure| display(pressure, &PRESSURE, 4));
    let chamber = beyond.chamber.to_ascii_uppercase();
    format!(
        "chamber {chamber} comes to {peak}; the expansion of its hose is stated at {stated}, and carried on along its slope"
    )
}

fn occurrence_words(occurrence: &Occurrence) -> String {
    let (begins, ends) = match occurrence.kind {
        "cavitation_a" => ("chamber A cavitates", "chamber A is above vapour pressure again"),
        "cavitation_b" => ("chamber B cavitates", "chamber B is above vapour pressure again"),
        "end_stop_a" => ("the piston reaches the end of chamber A", "the piston leaves the end of chamber A"),
        "end_stop_b" => ("the piston reaches the end of chamber B", "the piston leaves the end of chamber B"),
        "empty_a" => ("chamber A has no volume left", "chamber A has volume again"),
        "empty_b" => ("chamber B has no volume left", "chamber B has volume again"),
        "load_contact" => ("the load touches the wall", "the load leaves the wall"),
        "supply_lost" => ("the supply falls below the tank", "the supply is above the tank again"),
        _ => ("the command reaches its limit", "the command leaves its limit"),
    };
    let what = if occurrence.begins { begins } else { ends };
    format!("{} s: {what}", DisplayUnit::SECOND.number(occurrence.time_s, 5))
}

/// The tables of `compare`: a row for each metric, a column for each project; projects that were not begun are named.
pub(crate) fn compare_text(comparison: &Comparison<'_>, asked: &[Loaded]) -> String {
    let mut out = String::new();
    for (number, (loaded, runs)) in comparison.projects.iter().enumerate() {
        out.push_str(&format!("{}  {} ({})\n", letter(number), loaded.project.title, loaded.path));
        for run in runs.iter().filter(|run| run.stopped().is_some()) {
            out.push_str(&format!("   {}\n", headline(run)));
        }
    }
    for (number, loaded) in asked.iter().enumerate().skip(comparison.projects.len()) {
        let (letter, title) = (letter(number), &loaded.project.title);
        out.push_str(&format!("{letter}  {title} ({})\n   not begun\n", loaded.path));
    }
    for name in comparison.scenarios() {
        let columns: Vec<Option<&ScenarioRun>> = comparison.runs_of(name).collect();
        out.push_str(&format!("\n{name}\n{}\n", side_by_side(&columns)));
        for (number, run) in columns.iter().enumerate() {
            for exceeded in run.iter().flat_map(|run| &run.exceeded) {
                out.push_str(&format!("   {}: {}\n", letter(number), exceeded_words(exceeded)));
            }
        }
    }
    out
}

fn letter(number: usize) -> String {
    char::from_u32('A' as u32 + number as u32 % 26).unwrap_or('?').to_string()
}

fn side_by_side(columns: &[Option<&ScenarioRun>]) -> String {
    let letters: Vec<String> = (0..columns.len()).map(letter).collect();
    let mut head = vec!["event", "metric"];
    head.extend(letters.iter().map(String::as_str));
    let mut rows = table(&head);
    let most = columns.iter().flatten().map(|run| run.windows.len()).max().unwrap_or(0);
    for index in 0..most {
        let windows: Vec<Option<&(Window, Metrics)>> =
            columns.iter().map(|run| run.and_then(|run| run.windows.get(index))).collect();
        let Some((first, _)) = windows.iter().flatten().next() else { continue };
        let mut name = cause_words(first);
        let cells: Vec<Option<[String; METRICS.len()]>> =
            windows.iter().map(|window| window.map(|(_, metrics)| cells_of(metrics))).collect();
        for (row, metric) in METRICS.iter().enumerate() {
            let values = cells.iter().map(|cells| cells.as_ref().map_or(ABSENT, |cells| cells[row].as_str()));
            let values: Vec<String> = values.map(str::to_string).collect();
            if values.iter().all(|value| value == ABSENT) {
                continue;
            }
            rows.add_row([vec![std::mem::take(&mut name), (*metric).to_string()], values].concat());
        }
    }
    rows.trim_fmt()
}
