//! Statistics of all runs of a campaign: counts, quantiles, bands over time, and the worst runs.

use super::plan::Plan;
use super::required::{CampaignRequirement, required};
use super::row::{LUMP_NAMES, ROW_METRICS, Ran, Row, RowOutcome, meaningful};
use super::simulate::RunStatus;
use super::spread::{Spread, quantiles, spread};
use crate::simulate::{Metric, PerMetric};
use phea_dynamics::order::sort_numbers;

/// Quantiles of the force over time, of all runs that lasted until that time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bands {
    /// Times, s.
    pub times_s: Vec<f64>,
    /// [`QUANTILES`](super::QUANTILES) of the force at each time, N.
    pub force_n: Vec<[f64; 5]>,
}

/// A run that deserves inspection, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorstRun {
    /// Index of the run.
    pub run: u64,
    /// Windows, counted from 0, and metrics in which the run is worst.
    pub of: Vec<(usize, Metric)>,
}

/// Statistics of the runs of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Number of runs of each status of [`RunStatus::OF_ROWS`].
    pub statuses: [usize; RunStatus::OF_ROWS.len()],
    /// Runs without a machine, with the reason.
    pub refused: Vec<(u64, String)>,
    /// Runs that ended early, with their status and the time, s.
    pub early_ends: Vec<(u64, RunStatus, f64)>,
    /// Events of the runs: kind, number of runs, and the first of them.
    pub occurrences: Vec<(&'static str, usize, u64)>,
    /// Spread of each metric that occurs in a window, for every window.
    pub metrics: Vec<PerMetric<Option<Spread>>>,
    /// Spread of each of [`LUMP_NAMES`].
    pub lumps: [Option<Spread>; LUMP_NAMES.len()],
    /// Number of runs whose machine has each parameter outside its bounds in `[uncertainty]`, if
    /// there are bounds.
    pub outside: [Option<usize>; LUMP_NAMES.len()],
    /// Bands of the force.
    pub bands: Bands,
    /// Requirements in time, with the number of runs that satisfy them.
    pub requirements: Vec<CampaignRequirement>,
    /// Runs that deserve inspection, in the order of the metrics in which they are worst.
    pub worst: Vec<WorstRun>,
}

impl Summary {
    /// Number of runs that were simulated, to their end or not.
    pub fn driven(&self) -> usize {
        self.statuses.iter().sum::<usize>() - self.refused.len()
    }

    /// Statistics of rows.
    pub fn of(plan: &Plan, rows: &[Row]) -> Summary {
        let driven: Vec<(u64, &Ran)> = rows.iter().filter_map(|row| Some((row.run, row.ran()?))).collect();
        let metrics: Vec<PerMetric<Option<Spread>>> = (0..plan.windows().len())
            .map(|window| {
                let mut spreads = PerMetric::default();
                let of_window = |window| meaningful(window, plan.is_open_loop());
                for metric in plan.windows().get(window).into_iter().flat_map(of_window) {
                    spreads[metric] = spread(driven.iter().map(|(run, ran)| {
                        (*run, ran.metrics.get(window).and_then(|numbers| numbers[metric]))
                    }));
                }
                spreads
            })
            .collect();
        let lump = |lump: usize| spread(rows.iter().map(|row| (row.run, row.lumps.map(|lumps| lumps[lump]))));
        let refused = |row: &Row| match &row.outcome {
            RowOutcome::Refused(reason) => Some((row.run, reason.clone())),
            RowOutcome::Driven(_) => None,
        };
        Summary {
            statuses: RunStatus::OF_ROWS
                .map(|status| rows.iter().filter(|row| row.status() == status).count()),
            refused: rows.iter().filter_map(refused).collect(),
            early_ends: driven
                .iter()
                .filter_map(|(run, ran)| Some((*run, ran.status, ran.end_time_s?)))
                .collect(),
            occurrences: occurrences(&driven),
            worst: worst(&metrics),
            requirements: required(plan, rows),
            metrics,
            lumps: [lump(0), lump(1), lump(2)],
            outside: [outside(plan, rows, 0), outside(plan, rows, 1), outside(plan, rows, 2)],
            bands: bands(&plan.columns.times_s, &driven),
        }
    }
}

fn outside(plan: &Plan, rows: &[Row], lump: usize) -> Option<usize> {
    let [low, high] = plan.bounds(LUMP_NAMES[lump])?;
    // a draw that equals a bound up to rounding is within it
    let beyond = |value: f64| value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9);
    Some(rows.iter().filter(|row| row.lumps.is_some_and(|lumps| beyond(lumps[lump]))).count())
}

fn occurrences(driven: &[(u64, &Ran)]) -> Vec<(&'static str, usize, u64)> {
    let mut found: Vec<(&'static str, usize, u64)> = Vec::new();
    for (run, kind) in
        driven.iter().flat_map(|(run, ran)| ran.occurrences.iter().map(move |kind| (*run, *kind)))
    {
        match found.iter_mut().find(|(known, _, _)| *known == kind) {
            Some((_, count, _)) => *count += 1,
            None => found.push((kind, 1, run)),
        }
    }
    found
}

fn bands(times_s: &[f64], driven: &[(u64, &Ran)]) -> Bands {
    let mut bands = Bands::default();
    for (index, time_s) in times_s.iter().enumerate() {
        let forces = driven.iter().filter_map(|(_, ran)| ran.force_n.get(index));
        let mut forces: Vec<f64> = forces.map(|force| f64::from(*force)).collect();
        sort_numbers(&mut forces);
        let Some(five) = quantiles(&forces) else { break };
        bands.times_s.push(*time_s);
        bands.force_n.push(five);
    }
    bands
}

fn worst(metrics: &[PerMetric<Option<Spread>>]) -> Vec<WorstRun> {
    let mut found: Vec<WorstRun> = Vec::new();
    for (window, spreads) in metrics.iter().enumerate() {
        for metric in ROW_METRICS {
            let Some((_, run)) = spreads[metric].map(|spread| spread.worst) else { continue };
            match found.iter_mut().find(|known| known.run == run) {
                Some(known) => known.of.push((window, metric)),
                None => found.push(WorstRun { run, of: vec![(window, metric)] }),
            }
        }
    }
    found
}
