//! Box of linear parameters that a family visits, which a table such as Table 6.3 of the thesis
//! states without its origin.

use phea_dynamics::expression::Expression;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::random;
use phea_qft::family::{Coordinate, Extent, Family, UncertainFamily};
use phea_quantity::{DAMPING, MotionKind, STIFFNESS};

use super::hill::{Hill, SAME, SEED};
use super::hydraulic::is_linear;
use super::visited::Visited;
use super::{ProjectFamilyError, family, null_sides};
use crate::rig::stand_in_coefficient;
use crate::setup::Setup;
use crate::source::Memory;

/// A parameter of the linear model over a family.
#[derive(Clone, Debug, PartialEq)]
pub struct VisitedRange {
    /// Key in `[linear]`.
    pub name: &'static str,
    /// Symbol, such as `K_H`.
    pub symbol: &'static str,
    /// SI unit of the parameter.
    pub unit: &'static str,
    /// Least value.
    pub minimum: Extreme,
    /// Greatest value.
    pub maximum: Extreme,
}

/// A value and the plant at which it occurs.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// Value, SI.
    pub value: f64,
    /// Uncertain numbers from which the parameter follows: name, and value, SI. A number without
    /// influence there is omitted.
    pub at: Vec<(String, f64)>,
}

/// Name, symbol and unit of each enclosed parameter, in the order of the results.
fn enclosed(motion: MotionKind) -> [(&'static str, &'static str, &'static str); 4] {
    let of_motion = |dimension| motion.dimension(dimension).si;
    [
        ("flow_gain", "K_qU", "m3/(s.V)"),
        ("flow_pressure_coefficient", "K_c", "m3/(s.Pa)"),
        ("hydraulic_stiffness", motion.symbols().stiffness, of_motion(&STIFFNESS)),
        ("viscous_friction", "f_v", of_motion(&DAMPING)),
    ]
}
/// Parameter with the greatest effect on the spool.
const VELOCITY: &str = "operating_point.velocity";
/// Number of plants from which the search for an extreme starts, and number of random ones in
/// addition to the members from which they are chosen.
const STARTS: usize = 4;
const DRAWN: usize = 500;

/// Box of K_qU, K_c, K_H and f_v that encloses the family; `None` if they depend on no number of
/// the project.
///
/// The members are evaluated first; a search inside the box starts from the most extreme of them.
///
/// # Errors
/// The errors of [`family`].
pub fn visited_box(setup: &Setup<'_>) -> Result<Option<Vec<VisitedRange>>, ProjectFamilyError> {
    let project = setup.project;
    let Some(declared) = &project.actuator else { return Ok(None) };
    if project.family.as_ref().is_some_and(|declared| !declared.measured.is_empty()) {
        return Ok(None);
    }
    let parameters = null_sides::parameters(setup)?;
    if parameters.iter().all(|parameter| is_linear(&parameter.name)) {
        return Ok(None);
    }
    let Family::Uncertain(family) = family(setup, &Memory::default())? else { return Ok(None) };
    let visited = Visited::new(setup, &parameters)?;
    let open = visited.open(project, declared);
    let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    let of = |result: usize| {
        Expression::record(&names, |values| {
            let linear = open.place(values, visited.moved).linear;
            let all = [
                linear.flow_gain,
                linear.flow_pressure_coefficient,
                linear.hydraulic_stiffness,
                linear.viscous_friction,
            ];
            all.get(result).copied().into_iter().collect()
        })
    };
    let enclosed = enclosed(setup.project.motion());
    let expressions: Vec<Expression> = (0..enclosed.len()).map(of).collect();
    let physical = |expression: &Expression| {
        names.iter().enumerate().any(|(index, name)| !is_linear(name) && expression.depends_on(index))
    };
    if !expressions.iter().any(physical) {
        return Ok(None);
    }
    let points = match family.extent() {
        Extent::Box => [family.members(), &drawn(&family)].concat(),
        Extent::Members => family.members().to_vec(),
    };
    let range =
        |((name, symbol, unit), expression): ((&'static str, &'static str, &'static str), &Expression)| {
            let numbers = expression.numbers(&points);
            let extreme = |sign: f64| extreme(&family, expression, sign, points.iter().zip(&numbers));
            VisitedRange { name, symbol, unit, minimum: extreme(-1.0), maximum: extreme(1.0) }
        };
    let ranges = enclosed.into_iter().zip(&expressions).map(range);
    let stand_in = setup.rig()?.actuator.components();
    Ok(Some(ranges.map(|range| in_the_limit(range, stand_in_coefficient(stand_in))).collect()))
}

/// A range of K_c without the leakage of the substitute for an ideal valve, which is at most this.
fn in_the_limit(range: VisitedRange, most: Option<f64>) -> VisitedRange {
    let limit = |end: Extreme| match most {
        Some(most) if range.symbol == "K_c" && end.value <= most => Extreme { value: 0.0, at: vec![] },
        _ => end,
    };
    VisitedRange { minimum: limit(range.minimum), maximum: limit(range.maximum), ..range }
}

/// Greatest value of a result over a family with sign 1, least value with sign -1; `points` are
/// some of its plants with their results.
fn extreme<'a>(
    family: &UncertainFamily,
    expression: &Expression,
    sign: f64,
    points: impl Iterator<Item = (&'a Vec<f64>, &'a f64)>,
) -> Extreme {
    let value = |values: &[f64]| sign * expression.number(values);
    // among plants that differ only by rounding the first is used, which is nearest to the nominal
    // one
    let unit = SAME * value(&family.plant().nominal()).abs();
    let rounded_of = |value: f64| (value / unit).round();
    let rounded = |values: &[f64]| rounded_of(value(values));
    let names = |coordinate: &Coordinate| {
        let name = |index: &usize| family.plant().parameters().get(*index).map(|one| one.name.as_str());
        coordinate
            .parameters
            .iter()
            .any(|index| expression.depends_on(*index) && name(index) == Some(VELOCITY))
    };
    let along = family.coordinates().iter().position(names);
    let mut starts: Vec<(f64, &Vec<f64>)> =
        points.map(|(values, number)| (rounded_of(sign * number), values)).collect();
    sort_by_number(&mut starts, |start| -start.0);
    starts.dedup_by_key(|start| start.0);
    starts.truncate(if family.extent() == Extent::Box { STARTS } else { 1 });
    let climbed = starts.into_iter().map(|(_, values)| match family.extent() {
        Extent::Box => {
            let hill = Hill::new(family, expression, sign, along);
            family.values(&hill.climb(family.fractions(values)))
        }
        Extent::Members => values.clone(),
    });
    let best = climbed.reduce(|one, other| if rounded(&other) > rounded(&one) { other } else { one });
    let best = best.unwrap_or_else(|| family.plant().nominal());
    let matters = |index: usize, nominal: f64| {
        let mut other = best.clone();
        other[index] = nominal;
        expression.depends_on(index) && rounded(&other) != rounded(&best)
    };
    let parameters = family.plant().parameters().iter().zip(&best).enumerate();
    let named = parameters.filter(|(index, (parameter, value))| {
        parameter.nominal == **value && expression.depends_on(*index) || matters(*index, parameter.nominal)
    });
    Extreme {
        value: sign * value(&best),
        at: named.map(|(_, (parameter, value))| (parameter.name.clone(), *value)).collect(),
    }
}

/// Random points of the box.
fn drawn(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let mut state = random::stream(SEED, 0);
    let mut point = |_| {
        let fractions: Vec<f64> = family.coordinates().iter().map(|_| random::uniform(&mut state)).collect();
        family.values(&fractions)
    };
    (0..DRAWN).map(&mut point).collect()
}
