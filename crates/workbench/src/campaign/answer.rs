//! The answers of `campaign`.

mod requirement;
mod spread;

use phea_engineering::campaign::{Draw, Plan, QUANTILES, RequestedRuns, Summary, VariedRange, WorstRun};
use phea_engineering::simulate::{RunStatus, ScenarioRun};

use crate::answer::{Answer, Reasoned, words};
use crate::project::{DISTRIBUTIONS, Distribution, Loaded};
use crate::quantity::QuantityName;
use crate::simulate::{self, CampaignOccurrenceKind, ScenariosAnswer};
use phea_hydraulics::signal::Signal;
use requirement::{CampaignRequirementAnswer, requirement};
use spread::{CampaignEventAnswer, CampaignLumpAnswer, events, lumps};

/// Answer of `campaign` about all runs.
#[derive(Answer)]
pub(crate) struct CampaignAnswer {
    /// Name of the scenario that is run.
    scenario: String,
    /// Seed of all random numbers.
    seed: u32,
    /// Runs of the campaign, counted from 0.
    runs: CampaignRunsAnswer,
    /// True if every run has its row.
    complete: bool,
    /// Varied numbers.
    parameters: Vec<VariedRangeAnswer>,
    /// Number of runs of each status.
    statuses: CampaignStatusesAnswer,
    /// Runs whose drawn numbers give no machine, or whose machine cannot start.
    refused: Vec<RefusedRunAnswer>,
    /// Runs that ended early, or diverged.
    early_ends: Vec<EarlyEndAnswer>,
    /// Conditions that the machines met, in the order of their first run.
    occurrences: Vec<CampaignOccurrenceAnswer>,
    /// Percentages of the runs below each of the quantiles.
    quantiles_percent: [u8; QUANTILES.len()],
    /// Metrics of the events of the scenario.
    metrics: Vec<CampaignEventAnswer>,
    /// Parameters of the linear models of the drawn machines.
    lumps: Vec<CampaignLumpAnswer>,
    /// Numbers that are drawn beyond the box for which the controller is judged.
    beyond_box: Vec<BeyondBoxAnswer>,
    /// Quantiles of the force over time.
    bands: ForceBandsAnswer,
    /// Requirements in time, each with the number of runs that satisfy it.
    requirements: Vec<CampaignRequirementAnswer>,
    /// Runs that are worst in a metric.
    worst_runs: Vec<WorstRunAnswer>,
    /// Misfits of identified parts, which the runs do not contain, if any.
    #[answer(optional)]
    warnings: Option<Vec<String>>,
}

/// Answer of `campaign` about one run.
#[derive(Answer)]
pub(crate) struct CampaignRunAnswer {
    /// Name of the scenario that is run.
    scenario: String,
    /// Seed of all random numbers.
    seed: u32,
    /// Index of the run, from 0.
    run: u64,
    /// Drawn numbers of the run, as settings `path=value` of the project.
    run_settings: Vec<String>,
    #[answer(flatten)]
    scenarios: ScenariosAnswer,
    /// Misfits of identified parts, which the run does not contain, if any.
    #[answer(optional)]
    warnings: Option<Vec<String>>,
}

/// Runs of a campaign.
#[derive(Answer)]
struct CampaignRunsAnswer {
    /// Number of requested runs.
    requested: u64,
    /// Index of the first run, 0.
    from: u64,
    /// Index after that of the last run.
    until: u64,
    /// Number of rows, one of each run that is done.
    rows: usize,
}

/// Varied number.
#[derive(Answer)]
struct VariedRangeAnswer {
    /// Key of the project file, or `start.` and a state.
    path: String,
    /// Distribution of the number.
    distribution: Distribution,
    /// Lower end in SI, of a normal distribution two standard deviations below the middle.
    minimum: f64,
    /// Upper end in SI, of a normal distribution two standard deviations above the middle.
    maximum: f64,
    /// SI unit of the number; empty for a pure number.
    unit: &'static str,
}

words! {
    /// Distribution of a varied number.
    Distribution in DISTRIBUTIONS
}

/// Numbers of runs by their status.
#[derive(Answer, Default)]
struct CampaignStatusesAnswer {
    /// Runs to the end, with numbers that describe the machine.
    completed: usize,
    /// Runs to the end that diverge.
    diverged: usize,
    /// Runs that ended because a rate is no longer a number.
    not_finite: usize,
    /// Runs to the end that left the validity of their equations.
    outside_model: usize,
    /// Runs that were not begun because there is no such machine or it cannot start.
    refused: usize,
    /// Runs that ended because no step is short enough for the tolerance.
    step_too_small: usize,
    /// Runs that ended because the permitted steps are used up.
    too_many_steps: usize,
    /// Runs to the end whose repetitions do not agree.
    undetermined: usize,
    /// Runs that ended because an oscillation grows that needs more steps than are permitted.
    unresolved_oscillation: usize,
}

/// Run without a machine.
#[derive(Answer)]
struct RefusedRunAnswer {
    /// Index of the run, from 0.
    run: u64,
    /// Reason for which there is no machine, or it cannot start.
    reason: String,
}

/// Run that ended early, or diverged.
#[derive(Answer)]
struct EarlyEndAnswer {
    /// Index of the run, from 0.
    run: u64,
    /// Status of the run.
    status: RunStatus,
    /// Simulated time at which it ended or diverged.
    time_s: f64,
}

/// Condition that machines met.
#[derive(Answer)]
struct CampaignOccurrenceAnswer {
    /// Condition.
    kind: CampaignOccurrenceKind,
    /// Number of runs with the condition.
    runs: usize,
    /// First run with the condition, from 0.
    first_run: u64,
}

/// Number that is drawn beyond the box for which the controller is judged.
#[derive(Answer)]
struct BeyondBoxAnswer {
    /// Key of the project file.
    path: String,
    /// Lower end of the draws in SI, of a normal distribution two standard deviations below the
    /// middle.
    minimum: f64,
    /// Upper end of the draws in SI, of a normal distribution two standard deviations above the
    /// middle.
    maximum: f64,
    /// Range in the box, from low to high.
    #[answer(key = "box", interval)]
    designed_for: Reasoned<[f64; 2]>,
}

/// Quantiles of the force over time, of all runs that lasted until then.
#[derive(Answer)]
struct ForceBandsAnswer {
    /// Times of the values.
    time_s: Vec<f64>,
    /// Force at these times, a list for each of `quantiles_percent`.
    #[answer(key = Signal::Force.quantity())]
    force: Vec<Vec<f64>>,
}

/// Run that is worst in a metric.
#[derive(Answer)]
struct WorstRunAnswer {
    /// Index of the run, from 0.
    run: u64,
    /// Events and metrics in which it is worst, such as `event 1 overshoot_percent`.
    of: Vec<String>,
    /// Drawn numbers of the run, as settings `path=value` of the project.
    settings: Vec<String>,
}

/// All runs, with these warnings.
pub(crate) fn body(
    plan: &Plan,
    wanted: RequestedRuns,
    (rows, summary): (usize, &Summary),
    warnings: Vec<String>,
) -> CampaignAnswer {
    let refused = summary.refused.iter();
    let early_ends = summary.early_ends.iter();
    let occurrences = summary.occurrences.iter();
    CampaignAnswer {
        scenario: plan.scenario().to_string(),
        seed: plan.seed(),
        complete: rows as u64 == wanted.runs,
        runs: CampaignRunsAnswer { requested: wanted.runs, from: 0, until: wanted.runs, rows },
        parameters: plan.ranges().iter().map(range).collect(),
        statuses: statuses(summary),
        refused: refused
            .map(|(run, reason)| RefusedRunAnswer { run: *run, reason: reason.clone() })
            .collect(),
        early_ends: early_ends.map(|&(run, status, time_s)| EarlyEndAnswer { run, status, time_s }).collect(),
        occurrences: occurrences
            .map(|&(kind, runs, first_run)| CampaignOccurrenceAnswer {
                kind: CampaignOccurrenceKind(kind),
                runs,
                first_run,
            })
            .collect(),
        quantiles_percent: QUANTILES,
        metrics: events(plan, summary),
        lumps: lumps(plan, summary),
        beyond_box: beyond_box(plan),
        bands: bands(summary),
        requirements: summary.requirements.iter().map(requirement).collect(),
        worst_runs: summary.worst.iter().map(|worst| worst_run(plan, worst)).collect(),
        warnings: Some(warnings).filter(|all| !all.is_empty()),
    }
}

/// One run, with these warnings.
pub(crate) fn run_body(
    (plan, draw): (&Plan, &Draw),
    settings: Vec<String>,
    (drawn, runs): (&Loaded, &[ScenarioRun]),
    warnings: Vec<String>,
) -> CampaignRunAnswer {
    CampaignRunAnswer {
        scenario: plan.scenario().to_string(),
        seed: plan.seed(),
        run: draw.run,
        run_settings: settings,
        scenarios: simulate::scenarios(drawn, runs),
        warnings: Some(warnings).filter(|all| !all.is_empty()),
    }
}

fn range(range: &VariedRange) -> VariedRangeAnswer {
    VariedRangeAnswer {
        path: range.path.clone(),
        distribution: range.distribution,
        minimum: range.minimum,
        maximum: range.maximum,
        unit: range.si_unit(),
    }
}

fn statuses(summary: &Summary) -> CampaignStatusesAnswer {
    let mut all = CampaignStatusesAnswer::default();
    for (status, count) in RunStatus::OF_ROWS.into_iter().zip(summary.statuses) {
        let own = match status {
            RunStatus::Completed => &mut all.completed,
            RunStatus::Refused => &mut all.refused,
            RunStatus::StepTooSmall => &mut all.step_too_small,
            RunStatus::NotFinite => &mut all.not_finite,
            RunStatus::TooManySteps => &mut all.too_many_steps,
            RunStatus::UnresolvedOscillation => &mut all.unresolved_oscillation,
            RunStatus::Diverged => &mut all.diverged,
            RunStatus::OutsideModel => &mut all.outside_model,
            RunStatus::Undetermined => &mut all.undetermined,
            // no status of a row
            RunStatus::Cancelled | RunStatus::NotStarted => continue,
        };
        *own = count;
    }
    all
}

fn beyond_box(plan: &Plan) -> Vec<BeyondBoxAnswer> {
    let all = plan.beyond_box().into_iter();
    all.map(|one| BeyondBoxAnswer {
        path: one.range.path.clone(),
        minimum: one.range.minimum,
        maximum: one.range.maximum,
        designed_for: Reasoned::new(one.designed_for, "[uncertainty] does not name it"),
    })
    .collect()
}

fn bands(summary: &Summary) -> ForceBandsAnswer {
    let force = |quantile: usize| summary.bands.force_n.iter().map(|forces| forces[quantile]).collect();
    ForceBandsAnswer {
        time_s: summary.bands.times_s.clone(),
        force: (0..QUANTILES.len()).map(force).collect(),
    }
}

fn worst_run(plan: &Plan, worst: &WorstRun) -> WorstRunAnswer {
    let name = |name: QuantityName| name.text(plan.motion());
    let of = worst.of.iter();
    WorstRunAnswer {
        run: worst.run,
        of: of.map(|(window, metric)| format!("event {} {}", window + 1, name(metric.quantity()))).collect(),
        settings: plan.settings(&plan.draw(worst.run)),
    }
}
