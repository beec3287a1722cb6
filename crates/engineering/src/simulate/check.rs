//! A second run at a tenth of the tolerance: its difference from the first is an estimate of the
//! first one's error.

use phea_hydraulics::signal::Signal;

use super::metrics::{Measured, Unmeasured};
use super::{
    Metric, Metrics, PassPlan, PerMetric, Record, RunOutput, Sample, ScenarioRun, SimulateError, StoppedRun,
    Window, prepared, simulate_into,
};
use crate::number_table::TableFormat;
use crate::setup::Setup;
use crate::source::{Destination, Source};
use phea_dynamics::watch::{Progress, Watch};

/// Ratio of the first run's tolerance to that of the second.
pub(super) const FOLD: f64 = 10.0;
/// Fraction of the peak above which a difference of the force is reported.
pub(super) const LARGEST_PART: f64 = 1e-3;

/// Difference between the reported run and a run at a tenth of the tolerance.
///
/// ```text
/// d = max over t of |F_h(t) - F_h/10(t)|,      part = d/max(|F_h|, |F_h/10|, |F_ref|)
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ToleranceCheck {
    /// Tolerance of the second run.
    pub tolerance: f64,
    /// Early end of the second run, if there is one: the comparison extends until then.
    pub stopped: Option<StoppedRun>,
    /// Time between two compared samples, s.
    pub sample_interval_s: f64,
    /// Difference of the force; `None` if the two runs have no sample in common.
    pub force: Option<Difference>,
    /// Differences of the command and of all signals of the machine.
    pub signals: Vec<Difference>,
    /// Differences of each window's metrics, in order.
    pub metrics: Vec<MetricDifferences>,
}

/// Largest difference of one signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Compared signal.
    pub signal: Signal,
    /// Difference, in the SI unit of the signal.
    pub difference: f64,
    /// Time of the difference, s.
    pub time_s: f64,
    /// Largest magnitude in both runs and, for the force, of the reference.
    pub peak: f64,
}

/// Differences of the metrics of a window.
#[derive(Clone, Debug, PartialEq)]
pub struct MetricDifferences {
    /// Compared window.
    pub window: Window,
    /// Magnitude of the difference of each metric.
    pub differences: PerMetric<Measured>,
}

impl Difference {
    /// Ratio of the difference to the peak; zero if nothing moves.
    pub fn part_of_peak(&self) -> f64 {
        if self.peak > 0.0 { self.difference / self.peak } else { 0.0 }
    }
}

impl ToleranceCheck {
    /// True if the force differs by more than a thousandth of its peak.
    pub fn is_doubtful(&self) -> bool {
        self.force.as_ref().is_some_and(|force| force.part_of_peak() > LARGEST_PART)
    }
}

/// Simulates as [`simulate_into`] with samples, and each scenario once more at a tenth of its last
/// tolerance, which fills [`ScenarioRun::check`].
///
/// # Errors
/// The errors of [`simulate_into`].
pub fn simulate_checked(
    source: &dyn Source,
    setup: &Setup<'_>,
    table: Option<(&dyn Destination, TableFormat)>,
    watch: Watch<'_>,
) -> Result<Vec<ScenarioRun>, SimulateError> {
    let half = |progress: Progress| Progress { fraction: 0.5 * progress.fraction, ..progress };
    let output = RunOutput { ledger: true, ..RunOutput::new(true, table) };
    let mut runs = simulate_into(source, setup, output, &mut |progress| watch(half(progress)))?;
    if runs.iter().any(ScenarioRun::was_cancelled) {
        return Ok(runs);
    }
    let output = RunOutput::new(true, None);
    let whole: f64 = setup.project.scenarios.iter().map(|scenario| scenario.duration).sum();
    let mut before = 0.0;
    for (run, prepared) in runs.iter_mut().zip(&prepared(source, setup)?) {
        let mut watched = |time_s: f64| {
            let fraction = 0.5 + 0.5 * (before + time_s) / whole;
            watch(Progress { stage: "tolerance check", fraction })
        };
        let plan = PassPlan { tolerance: run.tolerance / FOLD, moved: false };
        let other = prepared.pass(plan, (&output, ""), &mut watched)?.run;
        run.check = Some(check(run, &other, plan.tolerance));
        before += prepared.scenario.duration;
        if other.was_cancelled() {
            break;
        }
    }
    Ok(runs)
}

fn check(run: &ScenarioRun, other: &ScenarioRun, tolerance: f64) -> ToleranceCheck {
    let signals = differences(&run.record, &other.record);
    let metrics = run.windows.iter().zip(&other.windows).map(metric_differences).collect();
    ToleranceCheck {
        tolerance,
        stopped: StoppedRun::of(other.status),
        sample_interval_s: run.sample_interval_s * run.record.stride.max(other.record.stride) as f64,
        force: signals.iter().find(|signal| signal.signal == Signal::Force).cloned(),
        signals,
        metrics,
    }
}

/// Differences of all signals, over the samples that both records contain.
fn differences(one: &Record, other: &Record) -> Vec<Difference> {
    let rows = common_rows(one, other);
    let reference = one.reference_n.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let is_compared = |signal: &Signal| {
        let is_of_machine = |sample: &Sample| sample.machine.get(*signal).is_some();
        *signal == Signal::Control || one.samples.first().is_some_and(is_of_machine)
    };
    let compared = one.parts.signals().into_iter().filter(is_compared);
    let of_signal = |signal: Signal| {
        let value = |record: &Record, row: usize| record.parts.value(signal, &record.samples[row]);
        let values = |row: &(usize, usize)| [value(one, row.0), value(other, row.1)];
        difference(signal, &rows, &one.times_s, values)
    };
    let mut found: Vec<Difference> = compared.filter_map(of_signal).collect();
    for force in found.iter_mut().filter(|signal| signal.signal == Signal::Force) {
        force.peak = force.peak.max(reference);
    }
    found
}

/// Indices of the samples at common times: one record may have been thinned out more than the
/// other.
fn common_rows(one: &Record, other: &Record) -> Vec<(usize, usize)> {
    let apart = one.stride.max(other.stride);
    let [first, second] = [one, other].map(|record| (apart / record.stride) as usize);
    let rows = (0..one.times_s.len()).step_by(first).zip((0..other.times_s.len()).step_by(second));
    rows.collect()
}

fn difference(
    signal: Signal,
    rows: &[(usize, usize)],
    times_s: &[f64],
    values: impl Fn(&(usize, usize)) -> [f64; 2],
) -> Option<Difference> {
    let (&(first, _), _) = rows.split_first()?;
    let mut found = Difference { signal, difference: 0.0, time_s: times_s[first], peak: 0.0 };
    for row in rows {
        let [here, there] = values(row);
        found.peak = found.peak.max(here.abs()).max(there.abs());
        if (here - there).abs() > found.difference {
            (found.difference, found.time_s) = ((here - there).abs(), times_s[row.0]);
        }
    }
    Some(found)
}

fn metric_differences(
    ((window, one), (_, other)): (&(Window, Metrics), &(Window, Metrics)),
) -> MetricDifferences {
    let difference = |metric: Metric| match (one.get(metric), other.get(metric)) {
        (Ok(here), Ok(there)) => Ok((here - there).abs()),
        (Err(reason), Err(_)) => Err(reason),
        _ => Err(Unmeasured::OneRunHasNone),
    };
    MetricDifferences { window: *window, differences: PerMetric::of(difference) }
}
