//! The JSON object of `campaign`.

use super::{CampaignRequirement, RequestedRuns};
use super::{Draw, Plan};
use super::{LUMP_NAMES, meaningful};
use super::{QUANTILES, Spread};
use super::{Summary, WorstRun};
use crate::answer::Object;
use crate::project::Loaded;
use crate::simulate::{self, RunStatus, ScenarioRun};
use crate::simulate::{not_judged_words, required_words};
use phea_hydraulics::signal::Signal;

/// What a campaign says to programs. Runs are counted from 0; `until` is beyond the last.
pub(crate) fn body(plan: &Plan, wanted: RequestedRuns, rows: usize, summary: &Summary) -> Object {
    let runs = wanted.shard.runs_of(wanted.runs);
    let counted = Object::new()
        .with("asked", wanted.runs)
        .with("from", runs.start)
        .with("until", runs.end)
        .with("rows", rows);
    let mut statuses: Vec<_> =
        RunStatus::OF_ROWS.map(RunStatus::key).into_iter().zip(summary.statuses).collect();
    statuses.sort_unstable();
    let statuses = statuses.into_iter().fold(Object::new(), |all, (word, count)| all.with(word, count));
    let bands = Object::new().with("time_s", summary.bands.times_s.as_slice()).each(
        Signal::Force.quantity(),
        0..QUANTILES.len(),
        |quantile| summary.bands.force_n.iter().map(|forces| forces[quantile]).collect::<Vec<f64>>(),
    );
    Object::new()
        .with("scenario", plan.scenario())
        .with("seed", plan.seed())
        .with("runs", counted)
        .with("complete", rows as u64 == runs.end - runs.start)
        .each("parameters", plan.ranges(), |range| {
            Object::new()
                .with("path", range.path.as_str())
                .with("distribution", range.distribution_word())
                .with("minimum", range.minimum)
                .with("maximum", range.maximum)
        })
        .with("statuses", statuses)
        .each("refused", &summary.refused, |(run, reason)| {
            Object::new().with("run", *run).with("reason", reason.as_str())
        })
        .each("ended", &summary.ended, |(run, status, time_s)| {
            Object::new().with("run", *run).with("status", status.key()).with("time_s", *time_s)
        })
        .each("occurrences", &summary.occurrences, |(kind, runs, first_run)| {
            Object::new().with("kind", *kind).with("runs", *runs).with("first_run", *first_run)
        })
        .with("quantiles_percent", QUANTILES)
        .with("metrics", events(plan, summary))
        .with("lumps", lumps(plan, summary))
        .each("beyond_box", plan.beyond_box(), |one| {
            Object::new()
                .with("path", one.range.path.as_str())
                .with("minimum", one.range.minimum)
                .with("maximum", one.range.maximum)
                .told("box", one.designed_for.ok_or("[uncertainty] does not name it"))
        })
        .with("bands", bands)
        .each("requirements", &summary.requirements, requirement)
        .each("worst_runs", &summary.worst, |worst| worst_run(plan, worst))
}

/// What one run says to programs.
pub(crate) fn run_body(
    (plan, draw): (&Plan, &Draw),
    settings: &[String],
    (drawn, runs): (&Loaded, &[ScenarioRun]),
) -> Object {
    Object::new()
        .with("scenario", plan.scenario())
        .with("seed", plan.seed())
        .with("run", draw.run)
        .with("run_settings", settings)
        .and(simulate::body(drawn, runs))
}

fn events(plan: &Plan, summary: &Summary) -> Vec<Object> {
    let windows = plan.windows().iter().zip(&summary.metrics);
    let event = |(window, spreads): (&simulate::Window, &simulate::PerMetric<Option<Spread>>)| {
        Object::new()
            .with("kind", window.cause.word())
            .with("time_s", window.start_s)
            .with("until_s", window.end_s)
            .each("metrics", meaningful(window, plan.is_open_loop()), |metric| {
                let name = Object::new().with("name", metric.quantity());
                name.and(spread_row(spreads[metric], summary.driven()))
            })
    };
    windows.map(event).collect()
}

/// Number of runs that could have such a number.
fn spread_row(spread: Option<Spread>, runs: usize) -> Object {
    let worst = spread.map(|spread| Object::new().with("value", spread.worst.0).with("run", spread.worst.1));
    Object::new()
        .with("count", spread.map_or(0, |spread| spread.count))
        .with("missing", spread.map_or(runs, |spread| spread.missing))
        .with("quantiles", spread.map(|spread| spread.quantiles))
        .with("minimum", spread.map(|spread| spread.extremes[0]))
        .with("maximum", spread.map(|spread| spread.extremes[1]))
        .with("worst", worst)
        .with("reason", spread.is_none().then_some("no run has one"))
}

/// How many runs satisfy a requirement in time, or why that is not known.
fn requirement(one: &CampaignRequirement) -> Object {
    let wish = &one.wish;
    let object = Object::new()
        .with("specification", one.number)
        .with("requirement", required_words(wish))
        .maybe("overshoot_percent", wish.overshoot_percent)
        .maybe("settling_time_s", wish.settling_time_s)
        .maybe("rise_time_s", wish.rise_time_s)
        .with("settling_band_percent", wish.band_percent);
    match one.judged {
        Ok(judged) => {
            let worst = judged.worst.map(|(run, reached)| {
                Object::new()
                    .with("run", run)
                    .with("overshoot_percent", reached.overshoot_percent)
                    .with("settling_time_s", reached.settling_time_s)
                    .with("rise_time_s", reached.rise_time_s)
            });
            object
                .with("satisfied", judged.satisfied)
                .with("runs", judged.runs)
                .with("confidence_95", judged.confidence_95())
                .maybe("worst", worst)
        }
        Err(why) => {
            let none: Option<usize> = None;
            object
                .known("satisfied", none, not_judged_words(why))
                .known("runs", none, not_judged_words(why))
                .known("confidence_95", none, not_judged_words(why))
        }
    }
}

/// `bounds` are those of the uncertain parameter; `outside` counts the runs whose machine is
/// outside them.
fn lumps(plan: &Plan, summary: &Summary) -> Vec<Object> {
    let rows = LUMP_NAMES.iter().zip(summary.lumps).zip(summary.outside);
    rows.map(|((name, spread), outside)| {
        Object::new()
            .with("name", *name)
            .told("bounds", plan.bounds(name).ok_or("[uncertainty] does not name it"))
            .with("outside", outside)
            .and(spread_row(spread, summary.statuses.iter().sum()))
    })
    .collect()
}

fn worst_run(plan: &Plan, worst: &WorstRun) -> Object {
    Object::new()
        .with("run", worst.run)
        .each("of", &worst.of, |(window, metric)| {
            format!("event {} {}", window + 1, metric.quantity().text(plan.motion()))
        })
        .with("settings", plan.settings(&plan.draw(worst.run)))
}
