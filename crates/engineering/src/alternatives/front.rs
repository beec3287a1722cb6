//! Pareto fronts: every alternative over a swept number of its project, by two or three columns.

use phea_dynamics::watch::Watch;

use super::prepared::ReadingAgain;
use super::{AlternativesError, JudgeError, NoNumber};
use super::{
    ColumnKey, ColumnSense, JudgedAlternative, Judging, PreparedAlternative, PreparedLoad, dominates,
};
use crate::design::DesignVerdict;
use crate::linearize::{SweepRequest, points, range, values};
use crate::option::OptionError;
use crate::project::Motions;
use crate::quantity::{self, DisplayUnit, MotionKind};
use crate::spelling::nearest;

/// The request, as written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrontRequest {
    /// Two or three columns by their names in the output, or `swept` for the swept number; each may
    /// end in `:less` or `:more`, which states which is better.
    pub columns: Vec<String>,
    /// Range and number of points of the sweep.
    pub sweep: SweepRequest,
}

/// Number of values of a sweep in which every point is a design, if none is requested.
const POINTS: usize = 5;

/// Name of the column for satisfied specifications, which requests the relaxation: 0 if they are
/// satisfied.
const FEASIBLE: &str = "feasible";

/// A column of a front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontColumn {
    /// Key of the column.
    pub key: ColumnKey,
    /// Sense in which values are better.
    pub sense: ColumnSense,
}

/// An alternative at one value of the swept number.
#[derive(Clone, Debug)]
pub struct FrontPoint {
    /// Name of the alternative.
    pub alternative: String,
    /// Swept number, SI.
    pub value: f64,
    /// True if every specification is satisfied.
    pub feasible: Result<bool, FeasibilityUnknown>,
    /// True if the alternative satisfies the specifications, is simulated to its end, and is not
    /// contradicted by the machine: only such points dominate others, or are on a front. If the
    /// relaxation is a column, points that miss the specifications are compared too.
    pub comparable: bool,
    /// Values of the columns.
    pub values: Vec<Result<FrontValue, NoFrontValue>>,
}

/// A value of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontValue {
    /// Value, SI.
    pub value: f64,
    /// Unit for display.
    pub unit: DisplayUnit,
    /// Significant digits for display; 0 for a whole number.
    pub digits: usize,
}

/// Reason why it is not known whether a point satisfies every specification.
#[derive(Clone, Debug)]
pub enum FeasibilityUnknown {
    /// The alternative cannot be prepared with this value.
    NotPrepared(AlternativesError),
    /// The alternative has no design.
    NotDesigned(JudgeError),
    /// The design does not decide whether the specifications are satisfied.
    Undecided(DesignVerdict),
}

/// Reason why a point has no value in a column.
#[derive(Clone, Debug, PartialEq)]
pub enum NoFrontValue {
    /// The alternative cannot be prepared with the swept value.
    NotPrepared(AlternativesError),
    /// The column does not exist.
    NoColumn,
    /// The column has no number.
    NoNumber(NoNumber),
    /// One of the scenarios of the alternative has no value.
    NotInEveryScenario,
}

/// Alternatives over a swept number, to be judged.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontPlan {
    /// The motion of all alternatives.
    pub motion: MotionKind,
    /// Two or three columns.
    pub columns: Vec<FrontColumn>,
    /// The swept key.
    pub path: String,
    /// Unit for display.
    pub unit: DisplayUnit,
    /// SI unit of the values.
    pub si: &'static str,
    /// Values of the swept number, SI.
    pub values: Vec<f64>,
}

impl FrontPlan {
    /// True if the alternative may dominate others.
    fn compares(&self, judged: &JudgedAlternative) -> bool {
        let by_relaxation = self.columns.iter().any(|column| column.key == ColumnKey::Relaxation);
        judged.is_comparable() || by_relaxation && judged.is_judged() && !judged.is_contradicted()
    }
}

/// Reason why the columns of a front are invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
enum FrontColumnsError {
    #[error("a front has two or three columns, such as disturbance_peak_n,swept")]
    Count,
    #[error("`{0}` is listed twice")]
    Twice(String),
    #[error("`{0}` is neither `less` nor `more`")]
    NoSense(String),
    #[error("there is no column `{name}`; did you mean `{near}`?")]
    Misspelt { name: String, near: String },
    #[error("there is no column `{name}`; there are {}", names.join(", "))]
    NoColumn { name: String, names: Vec<String> },
}

/// Parses the request.
///
/// # Errors
/// [`OptionError`] for columns or a sweep that do not exist.
pub(super) fn plan(request: &FrontRequest, motions: Motions) -> Result<FrontPlan, OptionError> {
    let text = request.columns.join(",");
    let refused = |error: FrontColumnsError| OptionError {
        option: "front",
        text: text.clone(),
        message: error.to_string(),
    };
    if !(2..=3).contains(&request.columns.len()) {
        return Err(refused(FrontColumnsError::Count));
    }
    let columns = request.columns.iter().map(|column| column_of(column, motions.rig).map_err(refused));
    let columns = columns.collect::<Result<Vec<_>, _>>()?;
    let twice = |one: &FrontColumn| columns.iter().filter(|other| other.key == one.key).count() > 1;
    if let Some(column) = columns.iter().find(|column| twice(column)) {
        return Err(refused(FrontColumnsError::Twice(column.key.quantity().text(motions.rig).into_owned())));
    }
    let requested = range(&request.sweep.range, motions)?;
    let count = points(request.sweep.points.or(Some(POINTS)))?;
    let values = values(requested.ends, count, requested.by_ratio());
    let unit =
        quantity::fitting(requested.ends[0].abs().max(requested.ends[1].abs()), requested.key.dimension);
    Ok(FrontPlan {
        motion: motions.rig,
        columns,
        path: requested.path,
        unit,
        si: requested.key.dimension.si,
        values,
    })
}

/// Column by its name in a rig of this motion, or the nearest spelling.
fn column_of(text: &str, motion: MotionKind) -> Result<FrontColumn, FrontColumnsError> {
    let (name, wanted) = match text.trim().split_once(':') {
        None => (text.trim(), None),
        Some((name, "less")) => (name, Some(ColumnSense::Less)),
        Some((name, "more")) => (name, Some(ColumnSense::More)),
        Some((_, other)) => return Err(FrontColumnsError::NoSense(other.to_string())),
    };
    let text_of = |key: ColumnKey| key.quantity().text(motion);
    let known = match name {
        FEASIBLE => Some(ColumnKey::Relaxation),
        name => ColumnKey::ALL.into_iter().find(|key| text_of(*key) == name),
    };
    let names = ColumnKey::ALL.map(text_of);
    let names = names.iter().map(|name| name.as_ref());
    let unknown = || match nearest(name, names.clone()) {
        Some(near) => FrontColumnsError::Misspelt { name: name.to_string(), near: near.to_string() },
        None => {
            let names = names.map(str::to_string).collect();
            FrontColumnsError::NoColumn { name: name.to_string(), names }
        }
    };
    let key = known.ok_or_else(unknown)?;
    Ok(FrontColumn { key, sense: wanted.unwrap_or(key.sense()) })
}

/// One point of the front, the ranges of `[uncertainty]` moved with the rig; `None` if `watch`
/// cancels it.
pub(super) fn point(
    judging: &Judging<'_>,
    prepared: &PreparedLoad,
    one: &PreparedAlternative,
    (plan, value): (&FrontPlan, f64),
    watch: Watch<'_>,
) -> Option<FrontPoint> {
    let alternative = one.name.clone();
    let again = ReadingAgain { source: judging.source, catalogues: judging.catalogues };
    let there = match at(&again, one, &plan.path, value) {
        Ok(there) => there,
        Err(error) => {
            let values = plan.columns.iter().map(|_| Err(NoFrontValue::NotPrepared(error.clone()))).collect();
            let feasible = Err(FeasibilityUnknown::NotPrepared(error));
            return Some(FrontPoint { alternative, value, feasible, comparable: false, values });
        }
    };
    let judged = judging.alternative(prepared, there, watch)?;
    let (comparable, values) = (plan.compares(&judged), values_of(&judged, plan, value));
    let feasible = judged.feasible().ok_or_else(|| match judged.design {
        Ok(view) => FeasibilityUnknown::Undecided(view.verdict()),
        Err(reason) => FeasibilityUnknown::NotDesigned(reason),
    });
    Some(FrontPoint { alternative, value, feasible, comparable, values })
}

/// The alternative with the swept number, its uncertainty ranges moved with it.
fn at(
    again: &ReadingAgain<'_>,
    one: &PreparedAlternative,
    path: &str,
    value: f64,
) -> Result<PreparedAlternative, AlternativesError> {
    let loaded = again.with(&one.loaded, &[format!("{path}={value:e}")])?.with_lines_of(&one.loaded);
    let there = PreparedAlternative::new(&one.name, loaded, one.no_hose);
    match there.loaded.project.actuator {
        Some(_) => there.recentred(again, one),
        None => Ok(there),
    }
}

fn values_of(
    judged: &JudgedAlternative,
    plan: &FrontPlan,
    value: f64,
) -> Vec<Result<FrontValue, NoFrontValue>> {
    let columns = judged.columns();
    let of = |column: &FrontColumn| {
        if column.key == ColumnKey::Swept {
            return Ok(FrontValue { value, unit: plan.unit, digits: 3 });
        }
        let found = columns.first(column.key).ok_or(NoFrontValue::NoColumn)?;
        let reason = || {
            let own = found.value.clone().err();
            own.map_or(NoFrontValue::NotInEveryScenario, NoFrontValue::NoNumber)
        };
        let value = columns.worst(column.key).ok_or_else(reason)?;
        Ok(FrontValue { value, unit: found.unit, digits: found.digits })
    };
    plan.columns.iter().map(of).collect()
}

/// Places of the points that dominate each point, by the values of the columns of all of them; a
/// point without values neither dominates nor is dominated.
///
/// # Example
/// ```
/// use phea_engineering::alternatives::{ColumnKey, ColumnSense, FrontColumn, dominating};
/// let columns = [ColumnKey::Order, ColumnKey::Swept].map(|key| FrontColumn { key, sense: ColumnSense::Less });
/// let points = [Some(vec![2.0, 1.0]), Some(vec![3.0, 1.0]), None, Some(vec![3.0, 0.5])];
/// assert_eq!(dominating(&points, &columns), [vec![], vec![0, 3], vec![], vec![]]);
/// ```
pub fn dominating(points: &[Option<Vec<f64>>], columns: &[FrontColumn]) -> Vec<Vec<usize>> {
    let senses: Vec<ColumnSense> = columns.iter().map(|column| column.sense).collect();
    let of = |own: &Option<Vec<f64>>| {
        let Some(own) = own else { return vec![] };
        let better =
            |other: &Option<Vec<f64>>| other.as_ref().is_some_and(|other| dominates(other, own, &senses));
        points.iter().enumerate().filter(|(_, other)| better(other)).map(|(place, _)| place).collect()
    };
    points.iter().map(of).collect()
}
