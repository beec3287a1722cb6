//! The numbers by which alternatives are compared, each with the reason if it is absent.

use phea_hydraulics::signal::Signal;
use phea_qft::design::DesignStatus;

use super::comparison::ColumnSense;
use super::{ColumnKey, JudgedAlternative, NoNumber, no_rig};
use crate::design::LoopFigures;
use crate::quantity::DisplayUnit;
use crate::simulate::{Metrics, RunStatus, ScenarioRun, StoppedRun, Unmeasured};
use crate::specification::SpecificationName;

/// A number of an alternative.
#[derive(Clone, Debug, PartialEq)]
pub struct AlternativeColumn {
    /// Key of the number.
    pub key: ColumnKey,
    /// Unit for display.
    pub unit: DisplayUnit,
    /// Significant digits for display; 0 for a whole number.
    pub digits: usize,
    /// Value, SI.
    pub value: Result<f64, NoNumber>,
}

/// Part of an alternative to which a column belongs.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnPart {
    /// The designed loop.
    Loop,
    /// The rig.
    Rig,
    /// The impedance at the load at a frequency, rad/s.
    Impedance(f64),
    /// A specification, by its number from 0 and its name.
    Specification(usize, SpecificationName),
    /// A scenario.
    Scenario(String),
}

/// All columns of an alternative, each with its part, in the order of the output.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AlternativeColumns(pub Vec<(ColumnPart, AlternativeColumn)>);

impl AlternativeColumns {
    /// Worst value of that column, of all specifications, scenarios or frequencies: the least if
    /// more is better, otherwise the greatest. `None` if there is none, or the force does not
    /// settle in one of them.
    pub fn worst(&self, key: ColumnKey) -> Option<f64> {
        let columns = || self.0.iter().filter(|(_, column)| column.key == key);
        if columns()
            .any(|(_, column)| matches!(column.value, Err(NoNumber::NoMetric(Unmeasured::NotSettled, _))))
        {
            return None;
        }
        let worse = match key.sense() {
            ColumnSense::More => f64::min,
            ColumnSense::Less => f64::max,
        };
        columns().filter_map(|(_, column)| column.value.clone().ok()).reduce(worse)
    }

    /// Worst value of each column.
    pub fn worst_of_each(&self) -> WorstColumns {
        let each = ColumnKey::ALL.into_iter().filter_map(|key| {
            let AlternativeColumn { unit, digits, .. } = *self.first(key)?;
            Some(WorstColumn { key, unit, digits, value: self.worst(key) })
        });
        WorstColumns(each.collect())
    }

    /// First column of that key.
    pub fn first(&self, key: ColumnKey) -> Option<&AlternativeColumn> {
        self.0.iter().map(|(_, column)| column).find(|column| column.key == key)
    }
}

/// Worst value of a column over all parts of an alternative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstColumn {
    /// Key of the number.
    pub key: ColumnKey,
    /// Unit for display.
    pub unit: DisplayUnit,
    /// Significant digits for display; 0 for a whole number.
    pub digits: usize,
    /// Value, SI, if all that count have one.
    pub value: Option<f64>,
}

/// Worst value of each column of an alternative.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorstColumns(pub Vec<WorstColumn>);

impl WorstColumns {
    /// Worst value of that column.
    pub fn value(&self, key: ColumnKey) -> Option<f64> {
        self.find(key)?.value
    }

    /// The column of that key.
    pub fn find(&self, key: ColumnKey) -> Option<&WorstColumn> {
        self.0.iter().find(|column| column.key == key)
    }
}

const DECIBEL: DisplayUnit = DisplayUnit { symbol: "dB", in_si: 1.0 };
const PERCENT: DisplayUnit = DisplayUnit { symbol: "%", in_si: 1.0 };

impl JudgedAlternative {
    /// Columns of the alternative.
    pub fn columns(&self) -> AlternativeColumns {
        let of_loop = self.loop_columns().into_iter().map(|column| (ColumnPart::Loop, column));
        let of_rig = self.rig_columns().into_iter().map(|column| (ColumnPart::Rig, column));
        let all = of_loop.chain(self.margins()).chain(of_rig).chain(self.impedances());
        AlternativeColumns(all.chain(self.scenarios()).collect())
    }

    fn loop_columns(&self) -> Vec<AlternativeColumn> {
        let figure = |of: fn(&LoopFigures) -> f64| match &self.design {
            Ok(view) => Ok(of(&view.designed.figures)),
            Err(reason) => Err(NoNumber::from(reason.clone())),
        };
        let relaxation = match &self.design {
            Ok(view) => match &view.design.status {
                DesignStatus::Infeasible(relaxation) => Ok(relaxation.relaxation_db),
                _ if self.feasible() == Some(true) => Ok(0.0),
                _ => Err(NoNumber::NotFoundInfeasible),
            },
            Err(reason) => Err(reason.clone().into()),
        };
        let of_stable = |of: fn(&LoopFigures) -> Option<f64>| {
            let found = self.design.as_ref().ok().and_then(|view| of(&view.designed.figures));
            found.ok_or(NoNumber::NotKnownStable)
        };
        let (one, milliseconds) = (DisplayUnit::ONE, DisplayUnit::MILLISECOND);
        vec![
            column(ColumnKey::Relaxation, DECIBEL, 3, relaxation),
            column(ColumnKey::Order, one, 0, figure(|figures| figures.order as f64)),
            column(ColumnKey::PrefilterOrder, one, 0, figure(|figures| figures.prefilter_order as f64)),
            column(ColumnKey::RelativeDegree, one, 0, figure(|figures| figures.relative_degree as f64)),
            column(
                ColumnKey::HighFrequencyGain,
                DECIBEL,
                4,
                figure(|figures| figures.high_frequency_gain_db),
            ),
            column(ColumnKey::ModulusMargin, one, 3, of_stable(|figures| figures.modulus_margin)),
            column(ColumnKey::DelayMargin, milliseconds, 3, of_stable(|figures| figures.delay_margin_s)),
        ]
    }

    /// Least margin of each specification.
    fn margins(&self) -> Vec<(ColumnPart, AlternativeColumn)> {
        let Ok(view) = &self.design else { return vec![] };
        let audited = &view.designed.view;
        let named = audited.audit.specifications.iter().zip(&audited.specification_names).enumerate();
        let each = named.map(|(index, (finding, name))| {
            let worst = finding.worst.as_ref().map(|worst| worst.margin_db);
            let value = worst.ok_or(NoNumber::NothingToJudgeBy);
            let part = ColumnPart::Specification(index, *name);
            (part, column(ColumnKey::WorstMargin, DECIBEL, 3, value))
        });
        each.collect()
    }

    fn scenarios(&self) -> Vec<(ColumnPart, AlternativeColumn)> {
        let declared = &self.loaded.project.scenarios;
        let columns = declared.iter().enumerate().flat_map(|(index, scenario)| {
            let run = match &self.runs {
                Ok(runs) => runs.get(index).ok_or_else(no_rig),
                Err(reason) => Err(reason.clone().into()),
            };
            let part = ColumnPart::Scenario(scenario.name.clone());
            driven(run, self.loaded.project.units.force).into_iter().map(move |column| (part.clone(), column))
        });
        columns.collect()
    }
}

pub(super) fn column(
    key: ColumnKey,
    unit: DisplayUnit,
    digits: usize,
    value: Result<f64, NoNumber>,
) -> AlternativeColumn {
    AlternativeColumn { key, unit, digits, value }
}

/// Columns of a scenario: for each metric the greatest of all its events.
fn driven(run: Result<&ScenarioRun, NoNumber>, force: DisplayUnit) -> [AlternativeColumn; 6] {
    let of = |metric: fn(&Metrics) -> crate::simulate::Measured| match &run {
        Ok(run) => greatest(run, metric),
        Err(reason) => Err(reason.clone()),
    };
    let energy = run.as_ref().map_err(Clone::clone).and_then(|run| energy_from_supply(run));
    let (second, volt) = (DisplayUnit::SECOND, DisplayUnit::VOLT);
    [
        column(ColumnKey::Overshoot, PERCENT, 3, of(|metrics| metrics.overshoot_percent)),
        column(ColumnKey::SettlingTime, second, 3, of(|metrics| metrics.settling_time_s)),
        column(ColumnKey::DisturbancePeak, force, 4, of(|metrics| metrics.disturbance_peak_n)),
        column(ColumnKey::ControlPeak, volt, 3, of(|metrics| metrics.control_peak_v)),
        column(ColumnKey::ControlRms, volt, 3, of(|metrics| metrics.control_rms_v)),
        column(ColumnKey::EnergyFromSupply, DisplayUnit::JOULE, 3, energy),
    ]
}

/// Energy that the valve takes from the supply over a run, J, including the tare flow.
///
/// ```text
/// E = integral of p_S q_S dt                  trapezoidal rule over the samples of the record
/// ```
fn energy_from_supply(run: &ScenarioRun) -> Result<f64, NoNumber> {
    if let Some(reason) = without_result(run) {
        return Err(reason);
    }
    let record = &run.record;
    let [pressure, flow] = [Signal::SupplyPressure, Signal::SupplyFlow].map(|signal| record.signal(signal));
    let power: Vec<f64> = pressure.iter().zip(&flow).map(|(pressure, flow)| pressure * flow).collect();
    let steps = record.times_s.windows(2).zip(power.windows(2));
    Ok(steps.map(|(times, powers)| 0.5 * (powers[0] + powers[1]) * (times[1] - times[0])).sum())
}

/// Reason why a run has no numbers of the machine; `None` if it has.
fn without_result(run: &ScenarioRun) -> Option<NoNumber> {
    if let Some(StoppedRun { time_s, status, .. }) = run.stopped() {
        return Some(NoNumber::Stopped { time_s, status });
    }
    match (run.run_status(), run.outside_model_s) {
        (RunStatus::Undetermined, _) => Some(NoNumber::Undetermined),
        (_, Some(time_s)) => Some(NoNumber::OutsideModel { time_s }),
        _ => None,
    }
}

/// Greatest value over all events; absent if the run has no result, or the force does not settle
/// after one of them.
fn greatest(run: &ScenarioRun, metric: fn(&Metrics) -> crate::simulate::Measured) -> Result<f64, NoNumber> {
    if let Some(reason) = without_result(run) {
        return Err(reason);
    }
    let motion = run.record.units.motion;
    let values = || run.windows.iter().map(|(_, metrics)| metric(metrics));
    if values().any(|value| value == Err(Unmeasured::NotSettled)) {
        return Err(NoNumber::NoMetric(Unmeasured::NotSettled, motion));
    }
    let reason =
        || values().find_map(Result::err).map_or(NoNumber::NoEvent, |why| NoNumber::NoMetric(why, motion));
    values().filter_map(Result::ok).reduce(f64::max).ok_or_else(reason)
}
