//! The output of `simulate` and `compare` for people.

use phea_engineering::simulate::{
    AdjustmentWork, BeyondExpansion, Cause, GasRange, Metric, Metrics, Occurrence, Overlay, PerMetric,
    RunStatus, ScenarioComparison, ScenarioRun, StepLimits, StoppedRun, TimeRequirement, Window, concerns,
};

use super::check;
use super::compared::compared_headings;
use super::exceeded_words;
use super::metrics::{cells_of, label_cell, label_within, metric_cell};
use super::repetition::{divergence_words, sentences as doubts, work_words};
use super::required::requirement_sentences;
use super::status_words;
use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::project::{InputSignal, Loaded, Scenario};
use crate::quantity::{DisplayUnit, MotionKind, TIME, Units, VOLTAGE, ZERO_CELSIUS};

/// Number of occurrences that are listed one by one; more are counted.
const LISTED: usize = 8;

/// The tables and sentences of `simulate`.
pub(crate) fn document(loaded: &Loaded, runs: &[ScenarioRun]) -> Document {
    let mut out = Document::default();
    for run in runs {
        out.heading(headline(run));
        out.tables([windows(run, None, None), measured(&[(None, run)])]);
        let checked = run.check.iter().flat_map(|found| check::sentences(found, run.record.units));
        let adjusted = adjustment_sentence(run);
        let sentences =
            requirement_sentences(&loaded.project, run).into_iter().map(|held| format!("The run {held}."));
        let sentences =
            sentences.chain(coarse_sentence(run)).chain(checked).chain(adjusted).chain(gas_sentence(run));
        out.sentences(sentences.chain(occurrence_sentences(run)));
    }
    if !runs.is_empty() {
        out.gap();
    }
    match loaded.project.scenarios.len().saturating_sub(runs.len()) {
        0 => {}
        1 => out.line("One scenario was not begun."),
        more => out.line(format!("{more} scenarios were not begun.")),
    }
    out
}

/// Name and end of a run, and its effort.
pub(crate) fn headline(run: &ScenarioRun) -> String {
    let work = work_words(run);
    let loop_words = if run.open_loop { " open loop" } else { "" };
    match StoppedRun::of(run.status) {
        None => {
            let word = match run.run_status() {
                RunStatus::OutsideModel => "completed outside its model",
                RunStatus::Undetermined => "completed without a result",
                status => status_words(status),
            };
            let comma = if run.open_loop && !run.is_reliable() { "," } else { "" };
            format!("{}: {word}{comma}{loop_words} ({work})", run.name)
        }
        Some(stopped) => {
            let why = why(&stopped);
            format!("{}: ended{loop_words} at {} s, {why} ({work})", run.name, significant(stopped.time_s, 6))
        }
    }
}

fn why(stopped: &StoppedRun) -> String {
    let reason = match (stopped.status, stopped.mode) {
        (_, Some(mode)) => {
            return format!(
                "an oscillation at {} rad/s that grows by {} 1/s would take more steps than `simulation.maximum_steps` allows",
                significant(mode.frequency_rad_per_s, 4),
                significant(mode.growth_per_s, 3)
            );
        }
        (RunStatus::Cancelled, _) => "stopped",
        (RunStatus::StepTooSmall, _) => "no step is short enough for the tolerance",
        (RunStatus::NotFinite, _) => "a rate is no longer a number",
        _ => "the steps it may take are used up",
    };
    reason.to_string()
}

/// Metrics that have a column only if some window has them.
const RARE: [Metric; 2] = [Metric::TrackingErrorPeak, Metric::ForcePeak];

/// The metrics of each event of a run, judged by the requirement in time. Next to published values
/// only metrics that some event has are shown.
pub(crate) fn windows(
    run: &ScenarioRun,
    required: Option<&TimeRequirement>,
    declared: Option<&Scenario>,
) -> Table {
    let cells: Vec<_> = run.windows.iter().map(|(_, metrics)| cells_of(metrics, run.record.units)).collect();
    let always = |metric: &Metric| declared.is_none() && !run.open_loop && !RARE.contains(metric);
    let has = |metric: &Metric| cells.iter().any(|cells| cells[*metric] != Cell::Missing);
    let shown: Vec<Metric> = Metric::ALL.into_iter().filter(|metric| always(metric) || has(metric)).collect();
    let head = |metric: &Metric| match metric {
        Metric::DisturbancePeak => "disturbance".to_string(),
        other => label_within(*other, [run.settling_band_percent], run.record.units.motion),
    };
    let units = run.record.units;
    let mut rows = Table::new(std::iter::once("event".to_string()).chain(shown.iter().map(head)));
    for (window, metrics) in &run.windows {
        let requirement = requirement_of(required, window);
        rows.row(metrics_row(cause_cell(window, units), &shown, (metrics, units), requirement));
        if let Some((source, cells)) = declared.and_then(|declared| published(declared, window, units)) {
            rows.row(published_row(source, &shown, cells));
        }
    }
    rows
}

/// Requirement in time for a window; `None` if the requirement does not apply to it.
pub(crate) fn requirement_of<'r>(
    required: Option<&'r TimeRequirement>,
    window: &Window,
) -> Option<&'r StepLimits> {
    required.filter(|required| concerns(required, window)).map(|required| &required.step_limits)
}

/// The metrics of one event, with marks on those that have a requirement.
pub(crate) fn metrics_row(
    name: Cell,
    shown: &[Metric],
    (metrics, units): (&Metrics, Units),
    requirement: Option<&StepLimits>,
) -> Vec<Cell> {
    let mut cells = cells_of(metrics, units);
    for (metric, held) in [
        (Metric::Overshoot, requirement.and_then(|requirement| requirement.overshoot_satisfied(metrics))),
        (Metric::SettlingTime, requirement.and_then(|requirement| requirement.settling_satisfied(metrics))),
    ] {
        if let Some(is_satisfied) = held {
            cells[metric] = std::mem::take(&mut cells[metric]).marked(is_satisfied);
        }
    }
    std::iter::once(name).chain(shown.iter().map(|metric| std::mem::take(&mut cells[*metric]))).collect()
}

/// The published values of an event.
pub(crate) fn published_row(source: &str, shown: &[Metric], mut cells: PerMetric<Cell>) -> Vec<Cell> {
    std::iter::once(source.into())
        .chain(shown.iter().map(|metric| std::mem::take(&mut cells[*metric])))
        .collect()
}

/// The published values of the step that begins this window, with their source; `None` if there are
/// no numbers.
pub(crate) fn published<'a>(
    declared: &'a Scenario,
    window: &Window,
    units: Units,
) -> Option<(&'a str, PerMetric<Cell>)> {
    let begins = |step: &&InputSignal| matches!(step, InputSignal::Step { at, .. } if *at == window.start_s);
    let step = declared.reference.iter().find(begins)?;
    let published = step.published().filter(|_| matches!(window.cause, Cause::ReferenceStep { .. }))?;
    let known =
        [(Metric::Overshoot, published.overshoot_percent), (Metric::SettlingTime, published.settling_time)];
    let mut cells: PerMetric<Cell> = PerMetric::default();
    for (metric, value) in known {
        cells[metric] = value.map_or(Cell::Missing, |value| metric_cell(metric, value, units));
    }
    let any = known.iter().any(|(_, value)| value.is_some());
    any.then_some((published.source.as_deref().unwrap_or("published"), cells))
}

/// Measurements compared with the simulation, under each of several controllers.
pub(crate) fn measured(runs: &[(Option<&'static str>, &ScenarioRun)]) -> Table {
    let several = runs.iter().any(|(name, _)| name.is_some());
    let mut heads = vec!["measured", "as column of", "NRMSE", "RMSE", "rows"];
    if several {
        heads.insert(2, "simulated with");
    }
    let mut rows = Table::new(heads);
    let signals = runs.first().map_or(0, |(_, run)| run.measured.len());
    for index in 0..signals {
        for (name, run) in runs {
            let Some(overlay) = run.measured.get(index) else { continue };
            let mut row = measured_cells(overlay, run.record.units).to_vec();
            if several {
                row.insert(2, name.unwrap_or_default().into());
            }
            rows.row(row);
        }
    }
    rows
}

fn measured_cells(overlay: &Overlay, units: Units) -> [Cell; 5] {
    let percent = |ratio: f64| Cell::quantity(ratio, 3, DisplayUnit::PERCENT);
    let inside = Cell::count(overlay.times_s.len());
    let rows = match overlay.rows_outside {
        0 => inside,
        outside => inside.then(", ").then(Cell::count(outside)).then(" more outside"),
    };
    [
        overlay.signal.quantity().text(units.motion).into_owned().into(),
        format!("{} `{}`", overlay.file, overlay.column).into(),
        overlay.nrmse.map_or(Cell::Missing, percent),
        overlay.rmse.map_or(Cell::Missing, |rmse| Cell::quantity(rmse, 3, overlay.display_unit(units))),
        rows,
    ]
}

/// Cause of a window.
pub(crate) fn cause_words(window: &Window, units: Units) -> String {
    cause_cell(window, units).text()
}

/// Cause of a window in a cell.
pub(crate) fn cause_cell(window: &Window, units: Units) -> Cell {
    let cause = match window.cause {
        Cause::ReferenceStep { to_n, .. } => Cell::from("step to ").then(Cell::short(to_n, 4, units.force)),
        Cause::ReferenceMotion { kind } => kind.into(),
        Cause::CommandStep { to_v, .. } => Cell::from("command to ").then(Cell::customary(to_v, 4, &VOLTAGE)),
        Cause::CommandMotion { kind } => format!("{kind} of the command").into(),
        Cause::LoadMotion => "load motion".into(),
        Cause::ExternalForce { .. } => window.cause.label(units.motion).into(),
        Cause::SettingChange => "setting of the accumulators".into(),
    };
    cause.then(" at ").then(Cell::customary(window.start_s, 4, &TIME))
}

/// The resolution of the figures of a long scenario.
pub(crate) fn coarse_sentence(run: &ScenarioRun) -> Option<String> {
    run.is_coarse().then(|| {
        let interval_ms = DisplayUnit::MILLISECOND.number(run.sample_interval_s, 3);
        format!("a scenario this long is drawn from samples every {interval_ms} ms only; its metrics are those of the solution in between too")
    })
}

/// The work of accumulators that are adjusted.
pub(crate) fn adjustment_sentence(run: &ScenarioRun) -> Option<String> {
    let AdjustmentWork { brought_j, taken_j, throttled_j } = run.adjustment?;
    let joule = |work: f64| DisplayUnit::JOULE.text(work, 3);
    let works = (brought_j, taken_j) != (0.0, 0.0);
    let moved = works.then(|| {
        format!(
            "the adjustment of the accumulators brings {} into the oil and takes {} out of it, the work of 1/2 dK/dt x^2: a setting that \
             moves is not passive",
            joule(brought_j),
            joule(taken_j)
        )
    });
    let throttled = throttled_j.map(|throttled_j| {
        format!(
            "the valves between chambers and gas throttle {}, which is lost: one that opens at a drop dp between two compliances loses \
             1/2 C_1 C_2/(C_1 + C_2) dp^2, at equal pressures nothing",
            joule(throttled_j)
        )
    });
    let sentences: Vec<String> = moved.into_iter().chain(throttled).collect();
    (!sentences.is_empty()).then(|| sentences.join("; "))
}

/// Compression and heating of the gas at the chambers.
pub(crate) fn gas_sentence(run: &ScenarioRun) -> Option<String> {
    let of = |gas: &GasRange| {
        let pressure = run.record.units.pressure.short(gas.peak_pa, 4);
        let heat = match (gas.temperature_ratios, gas.wall_celsius) {
            (None, _) => String::new(),
            (Some(ratios), Some(wall)) => {
                let [low, high] =
                    ratios.map(|ratio| significant(ratio * (wall + ZERO_CELSIUS) - ZERO_CELSIUS, 3));
                format!(", at {low} to {high} degC")
            }
            (Some(ratios), None) => {
                let [low, high] = ratios.map(|ratio| significant(ratio, 4));
                format!(", at {low} to {high} times the absolute temperature of its wall")
            }
        };
        format!("the gas at chamber {} reaches {pressure}{heat}", gas.chamber.to_ascii_uppercase())
    };
    let sentences: Vec<String> = run.gas.iter().map(of).collect();
    (!sentences.is_empty()).then(|| sentences.join("; "))
}

/// The events of a run, a sentence each.
pub(crate) fn occurrence_sentences(run: &ScenarioRun) -> Vec<String> {
    let (found, units) = (&run.occurrences, run.record.units);
    let mut sentences: Vec<String> =
        found.iter().take(LISTED).map(|one| occurrence_words(one, units.motion)).collect();
    if found.len() > LISTED {
        sentences.push(format!("and {} more changes of this kind, listed in the JSON", found.len() - LISTED));
    }
    sentences.extend(run.divergence.as_ref().map(|found| divergence_words(found, units)));
    sentences.extend(doubts(run));
    sentences.extend(run.beyond_expansion.iter().map(|beyond| beyond_words(beyond, units)));
    sentences.extend(run.exceeded.iter().map(|exceeded| exceeded_words(exceeded, units)));
    sentences.extend(outside_words(run));
    sentences
}

/// The time from which the equations do not hold.
fn outside_words(run: &ScenarioRun) -> Option<String> {
    let from = DisplayUnit::SECOND.number(run.outside_model_s?, 5);
    Some(format!("from {from} s on the equations do not hold: what follows no longer describes a machine"))
}

fn beyond_words(beyond: &BeyondExpansion, units: Units) -> String {
    let [peak, stated] = [beyond.peak_pa, beyond.stated_pa].map(|pressure| units.pressure.short(pressure, 4));
    let chamber = beyond.chamber.to_ascii_uppercase();
    format!(
        "chamber {chamber} comes to {peak}; the expansion of its hose is stated at {stated}, and extrapolated along its slope"
    )
}

fn occurrence_words(&Occurrence { kind, time_s, begins }: &Occurrence, motion: MotionKind) -> String {
    let of_chamber = [("_a", "A"), ("_b", "B")];
    let of_chamber = of_chamber.iter().find_map(|(end, chamber)| Some((kind.strip_suffix(end)?, *chamber)));
    let (kind, chamber) = of_chamber.unwrap_or((kind, ""));
    let [first, then] = match kind {
        "cavitation" => ["chamber # cavitates", "chamber # is above vapour pressure again"],
        "cavitation_line" => ["the line to chamber # cavitates", "the line to chamber # is filled again"],
        "working_pressure" => [
            "the line to chamber # is above its working pressure",
            "the line to chamber # is within its working pressure again",
        ],
        "burst_pressure" => [
            "the line to chamber # is above its burst pressure",
            "the line to chamber # is below its burst pressure again",
        ],
        "turbulent_line" => [
            "the flow in the line to chamber # is turbulent",
            "the flow in the line to chamber # is laminar again",
        ],
        "turbulent_neck" => [
            "the flow in the neck at chamber # is turbulent",
            "the flow in the neck at chamber # is laminar again",
        ],
        "turbulent_transmission" => {
            ["the flow in the transmission is turbulent", "the flow in the transmission is laminar again"]
        }
        "end_stop" => motion.either(
            ["the piston reaches the end of chamber #", "the piston leaves the end of chamber #"],
            ["the shaft reaches the end of chamber #", "the shaft leaves the end of chamber #"],
        ),
        "empty" => ["chamber # has no volume left", "chamber # has volume again"],
        "load_contact" => ["the load touches the wall", "the load leaves the wall"],
        "accumulator_empty" => {
            ["the gas at chamber # is shut off: below the precharge", "the gas at chamber # is in use again"]
        }
        "accumulator_overpressure" => [
            "the gas at chamber # is above its maximum_pressure_ratio",
            "the gas at chamber # is within its maximum_pressure_ratio again",
        ],
        "series_end" => [
            "the series spring reaches the end of its travel",
            "the series spring is within its travel again",
        ],
        "cavitation_transmission" => [
            "the oil of the transmission cavitates",
            "the pressure in the transmission is above vapour pressure again",
        ],
        "relief_valve" => ["the relief valve of chamber # opens", "the relief valve of chamber # closes"],
        "check_valve" => ["the check valve of chamber # opens", "the check valve of chamber # closes"],
        "supply_lost" => ["the supply falls below the tank", "the supply is above the tank again"],
        _ => ["the command reaches its limit", "the command leaves its limit"],
    };
    let first = match (kind, time_s) {
        ("load_contact", 0.0) => motion.either(
            "the load touches the wall from the start: the force or weight that it carries there closes its gap",
            "the load touches the wall from the start: the torque or weight that it carries there closes its gap",
        ),
        _ => first,
    };
    let what = if begins { first } else { then }.replace('#', chamber);
    format!("{} s: {what}", DisplayUnit::SECOND.number(time_s, 5))
}

/// The tables of `compare`: a row for each metric, a column for each project; projects that were
/// not begun are named.
pub(crate) fn comparison(comparison: &ScenarioComparison<'_>, requested: &[Loaded]) -> Document {
    let units = units_of(comparison);
    let mut out = Document::default();
    let headings = compared_headings(&requested.iter().collect::<Vec<_>>());
    let heading = |number: usize| headings.get(number).map_or("", String::as_str);
    for (number, (_, runs)) in comparison.projects.iter().enumerate() {
        out.line(format!("{}  {}", letter(number), heading(number)));
        for run in runs.iter().filter(|run| !run.is_reliable()) {
            out.line(format!("   {}", headline(run)));
        }
    }
    for number in comparison.projects.len()..requested.len() {
        out.line(format!("{}  {}", letter(number), heading(number)));
        out.line("   not begun");
    }
    for name in comparison.scenarios() {
        let columns: Vec<Option<&ScenarioRun>> = comparison.runs_of(name).collect();
        out.heading(name);
        out.table(side_by_side(&columns, units));
        for (number, (run, (loaded, _))) in columns.iter().zip(&comparison.projects).enumerate() {
            let required = run.iter().flat_map(|run| requirement_sentences(&loaded.project, run));
            let exceeded = run.iter().flat_map(|run| &run.exceeded).map(|found| exceeded_words(found, units));
            let diverges =
                run.and_then(|run| run.divergence.as_ref()).map(|found| divergence_words(found, units));
            let doubts = run.iter().flat_map(|run| doubts(run));
            let outside = run.and_then(outside_words);
            for sentence in required.chain(diverges).chain(doubts).chain(exceeded).chain(outside) {
                out.line(format!("   {}: {sentence}", letter(number)));
            }
        }
    }
    out
}

/// The units of a comparison: those of its first project.
pub(crate) fn units_of(comparison: &ScenarioComparison<'_>) -> Units {
    comparison.projects.first().map_or(Units::default(), |(loaded, _)| loaded.project.units)
}

fn letter(number: usize) -> String {
    char::from_u32('A' as u32 + number as u32 % 26).unwrap_or('?').to_string()
}

fn side_by_side(columns: &[Option<&ScenarioRun>], units: Units) -> Table {
    let letters = (0..columns.len()).map(letter);
    let mut rows = Table::grouped_by("event", std::iter::once("metric".to_string()).chain(letters));
    let most = columns.iter().flatten().map(|run| run.windows.len()).max().unwrap_or(0);
    for index in 0..most {
        let windows: Vec<Option<&(Window, Metrics)>> =
            columns.iter().map(|run| run.and_then(|run| run.windows.get(index))).collect();
        let Some((first, _)) = windows.iter().flatten().next() else { continue };
        rows.group(cause_cell(first, units));
        let bands = || windows.iter().flatten().map(|(_, metrics)| metrics.settling_band_percent);
        let cells: Vec<_> =
            windows.iter().map(|window| window.map(|(_, metrics)| cells_of(metrics, units))).collect();
        for metric in Metric::ALL {
            let of = |cells: &Option<PerMetric<Cell>>| cells.as_ref().map(|cells| cells[metric].clone());
            let values: Vec<Cell> = cells.iter().map(|cells| of(cells).unwrap_or_default()).collect();
            if values.iter().any(|value| *value != Cell::Missing) {
                rows.row(std::iter::once(label_cell(metric, bands(), units.motion)).chain(values));
            }
        }
    }
    rows
}
