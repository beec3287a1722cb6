//! Fronts of alternatives over a swept key, for programs.

use phea_engineering::alternatives::{ColumnKey, ColumnSense};

use super::super::front::findings;
use super::super::printed::{PrintedFront, PrintedPoint, PrintedValue};
use super::columns::{
    ImpedanceColumnsAnswer, LoopColumnsAnswer, RigColumnsAnswer, ScenarioColumnsAnswer,
    SpecificationColumnsAnswer,
};
use crate::answer::{Answer, Body, Describe, Json, KeyList, Keyed, ObjectKey, OrReason, ValueShape, words};
use crate::quantity::{MotionKind, QuantityName};

/// Alternatives over a swept key, with their front of Pareto.
#[derive(Answer)]
pub(super) struct FrontAnswer {
    /// Path of the swept key.
    key: String,
    /// Unit of its values.
    unit: &'static str,
    /// Columns by which the points are compared.
    columns: Vec<FrontColumnAnswer>,
    /// Points of each alternative.
    points: Vec<FrontPointAnswer>,
    /// Number of points that were not finished when the command was stopped.
    not_reached: usize,
    /// Front in sentences, with the cost of each step along it.
    findings: Vec<String>,
}

/// Column by which the points are compared.
#[derive(Answer)]
struct FrontColumnAnswer {
    /// Key of the column in a point.
    key: QuantityName,
    /// Better one of two values.
    better: ColumnSense,
}

words! {
    /// Better one of two values of a column, the greater or the lesser.
    ColumnSense { More => "more", Less => "less" }
}

/// Alternative at one value of the swept key.
#[derive(Answer)]
struct FrontPointAnswer {
    /// Name of the alternative.
    alternative: String,
    /// Value of the swept key.
    value: f64,
    /// True if every specification is satisfied.
    feasible: OrReason<bool>,
    /// True if the point is compared with others.
    comparable: bool,
    #[answer(flatten)]
    values: Keyed<FrontColumnKeys, OrReason<FrontNumber>>,
    /// True if no other point dominates this one.
    on_front: bool,
    /// Places in the list of the points that dominate it, from 0.
    dominated_by: Vec<usize>,
}

/// Keys of the columns by which points can be compared.
struct FrontColumnKeys;

impl KeyList for FrontColumnKeys {
    fn keys() -> Vec<(ObjectKey, String)> {
        let described = [
            LoopColumnsAnswer::members(),
            RigColumnsAnswer::members(),
            SpecificationColumnsAnswer::members(),
            ImpedanceColumnsAnswer::members(),
            ScenarioColumnsAnswer::members(),
        ];
        let described: Vec<_> = described.into_iter().flat_map(|members| members.list).collect();
        let motion = MotionKind::default();
        let column = |column: ColumnKey| {
            let key = ObjectKey::from(column.quantity());
            let own = described.iter().find(|member| member.key.text(motion) == key.text(motion));
            (key, own.map_or("Value of the swept key.".to_string(), |own| own.description.clone()))
        };
        ColumnKey::ALL.map(column).to_vec()
    }
}

/// Value of a column, printed without a decimal point if it is whole by its kind.
struct FrontNumber(PrintedValue);

impl Describe for FrontNumber {
    fn shape() -> ValueShape {
        ValueShape::Number
    }

    fn into_json(self) -> Json {
        match self.0 {
            PrintedValue { value, digits: 0, .. } => Json::Integer(value as i64),
            PrintedValue { value, .. } => Json::Number(value),
        }
    }
}

pub(super) fn front(front: &PrintedFront) -> FrontAnswer {
    let columns = front.columns.iter();
    FrontAnswer {
        key: front.path.clone(),
        unit: front.si,
        columns: columns
            .map(|column| FrontColumnAnswer { key: column.key.quantity(), better: column.sense })
            .collect(),
        points: front.placed().map(|(one, dominating)| point(front, one, dominating)).collect(),
        not_reached: front.not_reached,
        findings: findings(front),
    }
}

fn point(front: &PrintedFront, point: &PrintedPoint, dominating: &[usize]) -> FrontPointAnswer {
    let values = front.columns.iter().zip(&point.values).map(|(column, value)| {
        (ObjectKey::from(column.key.quantity()), OrReason(value.clone().map(FrontNumber)))
    });
    FrontPointAnswer {
        alternative: point.alternative.clone(),
        value: point.value,
        feasible: OrReason(point.feasible.clone()),
        comparable: point.comparable,
        values: Keyed::new(values),
        on_front: point.is_on_front(dominating),
        dominated_by: dominating.to_vec(),
    }
}
