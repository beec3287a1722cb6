//! The numbers by which alternatives are compared, each with the reason where it does not exist.

use phea_hydraulics::line::Line;
use phea_qft::design::DesignStatus;

use super::{JudgedAlternative, no_rig};
use crate::design::LoopFigures;
use crate::quantity::{DisplayUnit, VOLUME, fitting};
use crate::setup::Setup;
use crate::simulate::{Metrics, NOT_SETTLED, ScenarioRun};

/// A number of an alternative.
#[derive(Clone, Debug, PartialEq)]
pub struct AlternativeColumn {
    /// Its name for programs, with its unit.
    pub key: &'static str,
    /// For people.
    pub words: &'static str,
    /// The unit for people.
    pub unit: DisplayUnit,
    /// Significant digits for people; 0 for a whole number.
    pub digits: usize,
    /// In SI, or why there is none.
    pub value: Result<f64, String>,
}

/// The part of an alternative that a column belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ColumnPart {
    /// The designed loop.
    Loop,
    /// The rig.
    Rig,
    /// A specification, by its number from 0 and its name.
    Specification(usize, String),
    /// A scenario.
    Scenario(String),
}

/// All columns of an alternative, each with its part, in the order of an answer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AlternativeColumns(pub Vec<(ColumnPart, AlternativeColumn)>);

impl AlternativeColumns {
    /// The value of the column of that name, if it exists; of a specification or a scenario: the
    /// greatest.
    pub fn greatest(&self, key: &str) -> Option<f64> {
        let values = self.0.iter().filter(|(_, column)| column.key == key);
        values.filter_map(|(_, column)| column.value.clone().ok()).reduce(f64::max)
    }
}

const DECIBEL: DisplayUnit = DisplayUnit { symbol: "dB", in_si: 1.0 };
const PERCENT: DisplayUnit = DisplayUnit { symbol: "%", in_si: 1.0 };

impl JudgedAlternative {
    /// Its columns.
    pub fn columns(&self) -> AlternativeColumns {
        let of_loop = self.loop_columns().into_iter().map(|column| (ColumnPart::Loop, column));
        let of_rig = self.rig_columns().into_iter().map(|column| (ColumnPart::Rig, column));
        let all = of_loop.chain(self.margins()).chain(of_rig);
        AlternativeColumns(all.chain(self.scenarios()).collect())
    }

    fn loop_columns(&self) -> Vec<AlternativeColumn> {
        let figure = |of: fn(&LoopFigures) -> Result<f64, &'static str>| match &self.design {
            Ok(view) => of(&view.designed.figures).map_err(String::from),
            Err(reason) => Err(reason.clone()),
        };
        let relaxation =
            self.design.as_ref().map_err(Clone::clone).and_then(|view| match &view.design.status {
                DesignStatus::Infeasible(relaxation) => Ok(relaxation.relaxation_db),
                _ => Err("the specifications were not found infeasible".to_string()),
            });
        let unknown = "not known of a family that is not known to be stable";
        let modulus = figure(|figures| figures.modulus_margin.ok_or("")).map_err(|_| unknown.to_string());
        let delay = figure(|figures| figures.delay_margin_s.ok_or("")).map_err(|_| unknown.to_string());
        let one = DisplayUnit::ONE;
        vec![
            column("relaxation_db", "relaxation needed", DECIBEL, 3, relaxation),
            column("order", "order of G", one, 0, figure(|figures| Ok(figures.order as f64))),
            column(
                "prefilter_order",
                "order of F",
                one,
                0,
                figure(|figures| Ok(figures.prefilter_order as f64)),
            ),
            column(
                "relative_degree",
                "relative degree of G",
                one,
                0,
                figure(|figures| Ok(figures.relative_degree as f64)),
            ),
            column(
                "high_frequency_gain_db",
                "high-frequency gain",
                DECIBEL,
                4,
                figure(|figures| Ok(figures.high_frequency_gain_db)),
            ),
            column("modulus_margin", "modulus margin", one, 3, modulus),
            column("delay_margin_s", "delay tolerated", DisplayUnit::MILLISECOND, 3, delay),
        ]
    }

    /// The least margin of each specification.
    fn margins(&self) -> Vec<(ColumnPart, AlternativeColumn)> {
        let Ok(view) = &self.design else { return vec![] };
        let audited = &view.designed.view;
        let each = audited.audit.specifications.iter().enumerate().map(|(index, finding)| {
            let worst = finding.worst.as_ref().map(|worst| worst.margin_db);
            let value = worst.ok_or_else(|| "there is nothing by which to judge it".to_string());
            let part = ColumnPart::Specification(index, audited.name_of(index).to_string());
            (part, column("worst_margin_db", "least margin", DECIBEL, 3, value))
        });
        each.collect()
    }

    fn rig_columns(&self) -> Vec<AlternativeColumn> {
        let stiffness = |end: usize| {
            let found = self.linearization.as_ref().map_err(Clone::clone)?;
            Ok([found.stiffness[0].minimum, found.stiffness[0].maximum][end])
        };
        let best = self.sizing.as_ref().map_err(Clone::clone).and_then(|sizing| {
            sizing.best().ok_or_else(|| "no hose of the catalogue is accepted".to_string())
        });
        let lines = self.lines();
        let volume = lines.clone().map(|lines| lines.iter().map(Line::volume).sum::<f64>());
        let volume_unit = fitting(volume.clone().unwrap_or_default(), &VOLUME);
        let length = lines.and_then(|lines| {
            let lengths = lines.iter().map(length).collect::<Option<Vec<f64>>>();
            let lengths =
                lengths.ok_or_else(|| "a line that is stated as a volume has no length".to_string());
            Ok(lengths?.into_iter().sum())
        });
        let stiff = DisplayUnit::MEGANEWTON_PER_METRE;
        vec![
            column("stiffness_minimum_n_per_m", "least K_H", stiff, 3, stiffness(0)),
            column("stiffness_maximum_n_per_m", "greatest K_H", stiff, 3, stiffness(1)),
            column("lines_length_m", "length of both lines", DisplayUnit::METRE, 3, length),
            column("lines_volume_m3", "oil in both lines", volume_unit, 3, volume),
            column(
                "sized_length_m",
                "length by [sizing]",
                DisplayUnit::METRE,
                3,
                best.clone().map(|best| best.length_m()),
            ),
            column(
                "sized_gain_v_per_n",
                "gain by [sizing]",
                DisplayUnit::MILLIVOLT_PER_NEWTON,
                3,
                best.map(|best| best.branch.gain_v_per_n),
            ),
        ]
    }

    fn lines(&self) -> Result<[Line; 2], String> {
        let setup = Setup::new(&self.loaded.project).map_err(|error| error.to_string())?;
        let rig = setup.rig().map_err(|error| error.to_string())?;
        let components = rig.actuator.components();
        Ok([components.line_a, components.line_b])
    }

    fn scenarios(&self) -> Vec<(ColumnPart, AlternativeColumn)> {
        let declared = &self.loaded.project.scenarios;
        let columns = declared.iter().enumerate().flat_map(|(index, scenario)| {
            let run = match &self.runs {
                Ok(runs) => runs.get(index).ok_or_else(no_rig),
                Err(reason) => Err(reason.clone()),
            };
            let part = ColumnPart::Scenario(scenario.name.clone());
            driven(run).into_iter().map(move |column| (part.clone(), column))
        });
        columns.collect()
    }
}

fn column(
    key: &'static str,
    words: &'static str,
    unit: DisplayUnit,
    digits: usize,
    value: Result<f64, String>,
) -> AlternativeColumn {
    AlternativeColumn { key, words, unit, digits, value }
}

/// Length of a line, m; a plain volume has none.
fn length(line: &Line) -> Option<f64> {
    match line {
        Line::Hose { length, .. } | Line::Pipe { length, .. } => Some(*length),
        Line::Volume { .. } => None,
    }
}

/// The columns of a scenario: of each metric the greatest of all its events.
fn driven(run: Result<&ScenarioRun, String>) -> [AlternativeColumn; 5] {
    let of = |metric: fn(&Metrics) -> crate::simulate::Measured| match &run {
        Ok(run) => greatest(run, metric),
        Err(reason) => Err(reason.clone()),
    };
    let (second, newton, volt) = (DisplayUnit::SECOND, DisplayUnit::NEWTON, DisplayUnit::VOLT);
    [
        column("overshoot_percent", "overshoot", PERCENT, 3, of(|metrics| metrics.overshoot_percent)),
        column("settling_time_s", "settling", second, 3, of(|metrics| metrics.settling_time_s)),
        column("disturbance_peak_n", "disturbance", newton, 4, of(|metrics| metrics.disturbance_peak_n)),
        column("control_peak_v", "control peak", volt, 3, of(|metrics| metrics.control_peak_v)),
        column("control_rms_v", "control rms", volt, 3, of(|metrics| metrics.control_rms_v)),
    ]
}

/// The greatest value over all events; none where the run ended early, or the force does not settle
/// after one of them.
fn greatest(run: &ScenarioRun, metric: fn(&Metrics) -> crate::simulate::Measured) -> Result<f64, String> {
    if let Some(stopped) = run.stopped() {
        return Err(format!("the run ended at {} s: {}", stopped.time_s, stopped.word));
    }
    let values = || run.windows.iter().map(|(_, metrics)| metric(metrics));
    if values().any(|value| value == Err(NOT_SETTLED)) {
        return Err(NOT_SETTLED.to_string());
    }
    let reason = values().find_map(Result::err).unwrap_or("no event begins in the scenario");
    values().filter_map(Result::ok).reduce(f64::max).ok_or_else(|| reason.to_string())
}
