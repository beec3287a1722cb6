//! Points of a front, as they are printed.

use phea_engineering::alternatives::{FrontColumn, FrontPlan, FrontPoint, FrontValue, dominating};
use serde::{Deserialize, Serialize};

use super::super::words::{no_front_value_words, unknown_words};
use crate::quantity::{DisplayUnit, MotionKind};

/// Alternatives over a swept number.
#[derive(Clone, Debug)]
pub(crate) struct PrintedFront {
    /// The motion of all alternatives.
    pub(crate) motion: MotionKind,
    /// The swept key.
    pub(crate) path: String,
    /// Unit for display.
    pub(crate) unit: DisplayUnit,
    /// SI unit of the values.
    pub(crate) si: &'static str,
    /// Two or three columns.
    pub(crate) columns: Vec<FrontColumn>,
    /// Points of each alternative, in the order of the output.
    pub(crate) points: Vec<PrintedPoint>,
    /// Places of the points that dominate each point.
    pub(crate) dominating: Vec<Vec<usize>>,
    /// Number of points that were not reached before the command was stopped.
    pub(crate) not_reached: usize,
}

/// An alternative at one value of the swept number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PrintedPoint {
    /// Name of the alternative.
    pub(crate) alternative: String,
    /// Swept number, SI.
    pub(crate) value: f64,
    /// True if every specification is satisfied, or the reason why this is unknown.
    pub(crate) feasible: Result<bool, String>,
    /// True if the point is compared with others.
    pub(crate) comparable: bool,
    /// Values of the columns, or the reasons why they are absent.
    pub(crate) values: Vec<Result<PrintedValue, String>>,
}

/// A value of a column.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PrintedValue {
    /// Value, SI.
    pub(crate) value: f64,
    /// Unit for display.
    #[serde(with = "crate::unit_encoding")]
    pub(crate) unit: DisplayUnit,
    /// Significant digits for display; 0 for a whole number.
    pub(crate) digits: usize,
}

impl PrintedFront {
    /// The front of these points.
    pub(super) fn of(plan: &FrontPlan, points: Vec<PrintedPoint>, not_reached: usize) -> PrintedFront {
        let compared: Vec<Option<Vec<f64>>> =
            points.iter().map(|point| point.numbers().filter(|_| point.comparable)).collect();
        PrintedFront {
            motion: plan.motion,
            path: plan.path.clone(),
            unit: plan.unit,
            si: plan.si,
            columns: plan.columns.clone(),
            dominating: dominating(&compared, &plan.columns),
            points,
            not_reached,
        }
    }

    /// The points, each with the places of those that dominate it.
    pub(crate) fn placed(&self) -> impl Iterator<Item = (&PrintedPoint, &[usize])> {
        self.points.iter().zip(self.dominating.iter().map(Vec::as_slice))
    }
}

impl PrintedPoint {
    pub(super) fn of(point: FrontPoint, motion: MotionKind) -> PrintedPoint {
        let FrontPoint { alternative, value, feasible, comparable, values } = point;
        let printed = |FrontValue { value, unit, digits }| PrintedValue { value, unit, digits };
        let values = values.into_iter();
        PrintedPoint {
            alternative,
            value,
            feasible: feasible.map_err(|reason| unknown_words(&reason, motion)),
            comparable,
            values: values
                .map(|value| value.map(printed).map_err(|reason| no_front_value_words(&reason)))
                .collect(),
        }
    }

    /// Values of the point, SI, if all exist.
    pub(crate) fn numbers(&self) -> Option<Vec<f64>> {
        self.values.iter().map(|value| Some(value.as_ref().ok()?.value)).collect()
    }

    /// True if no other point dominates this one.
    pub(crate) fn is_on_front(&self, dominating: &[usize]) -> bool {
        self.comparable && dominating.is_empty() && self.numbers().is_some()
    }
}
