//! What `simulate` and `compare` say to people.

use super::metrics::{Measured, NOT_SETTLED};
use super::{Cause, Comparison, Metrics, Occurrence, ScenarioRun, Stopped, Window};
use crate::answer::{significant, table};
use crate::project::Loaded;
use crate::quantity::{DisplayUnit, FORCE, TIME, display};

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
        for sentence in coarse_sentence(run).into_iter().chain(occurrence_sentences(run)) {
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
    match run.stopped() {
        None => format!("{}: completed ({work})", run.name),
        Some(stopped) => {
            let why = why(&stopped);
            format!("{}: ended at {} s, {why} ({work})", run.name, significant(stopped.time_s, 6))
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

fn windows(run: &ScenarioRun) -> String {
    let band = run.settling_band_percent;
    let settling = format!("settling ({band} %)");
    let mut rows = table(&[
        "event",
        "overshoot",
        "rise",
        settling.as_str(),
        "disturbance",
        "steady-state error",
        "control peak",
        "control rms",
    ]);
    for (window, metrics) in &run.windows {
        let mut cells = vec![cause_words(window)];
        cells.extend(cells_of(metrics));
        rows.add_row(cells);
    }
    rows.trim_fmt()
}

/// What began a window.
pub(crate) fn cause_words(window: &Window) -> String {
    let at = display(window.start_s, &TIME, 4);
    match window.cause {
        Cause::ReferenceStep { to_n, .. } => format!("step to {} at {at}", display(to_n, &FORCE, 4)),
        Cause::LoadMotion => format!("load motion at {at}"),
    }
}

/// Names and cells of the metrics, in one order.
pub(crate) const METRICS: [&str; 7] = [
    "overshoot",
    "rise",
    "settling",
    "disturbance peak",
    "steady-state error",
    "control peak",
    "control rms",
];

/// In place of a metric that there is not.
pub(crate) const ABSENT: &str = "-";

/// Each metric with its unit; [`ABSENT`] where there is none.
pub(crate) fn cells_of(metrics: &Metrics) -> [String; 7] {
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
        cell(error, 2, "N"),
        cell(metrics.control_peak_v, 3, "V"),
        cell(metrics.control_rms_v, 3, "V"),
    ]
}

/// A steady error below a millinewton is what the method leaves, not what the loop does.
pub(crate) fn small_as_zero(error_n: f64) -> f64 {
    if error_n.abs() < 1e-3 { 0.0 } else { error_n }
}

/// What the numbers of a long scenario are not.
pub(crate) fn coarse_sentence(run: &ScenarioRun) -> Option<String> {
    run.is_coarse().then(|| {
        let look = DisplayUnit::MILLISECOND.number(run.look_s, 3);
        format!("so long a scenario is looked at every {look} ms only: what is shorter is not seen, and peaks may be larger")
    })
}

/// What happened on the way, a sentence each.
pub(crate) fn occurrence_sentences(run: &ScenarioRun) -> Vec<String> {
    let found = &run.occurrences;
    let mut sentences: Vec<String> = found.iter().take(TOLD).map(occurrence_words).collect();
    if found.len() > TOLD {
        sentences.push(format!("and {} more changes of this kind, listed in the JSON", found.len() - TOLD));
    }
    sentences.extend(run.outside_model_s.map(|time_s| {
        let from = DisplayUnit::SECOND.number(time_s, 5);
        format!("from {from} s on the equations do not hold: what follows is theirs, not that of a machine")
    }));
    sentences
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
        let cells: Vec<Option<[String; 7]>> =
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
