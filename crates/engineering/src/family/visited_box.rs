//! The box of linear parameters that a family visits: a table such as Table 6.3 of the thesis
//! states it without its origin.

use std::collections::BTreeMap;

use phea_dynamics::expression::Expression;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::random;
use phea_qft::family::{Coordinate, Extent, Family, UncertainFamily};

use super::hydraulic::is_linear;
use super::visited::Visited;
use super::{ProjectFamilyError, family, uncertain};
use crate::setup::Setup;
use crate::source::Memory;

/// A parameter of the linear model over a family.
#[derive(Clone, Debug, PartialEq)]
pub struct VisitedRange {
    /// Its key in `[linear]`.
    pub name: &'static str,
    /// Its symbol, such as `K_H`.
    pub symbol: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// The least it is.
    pub minimum: Extreme,
    /// The most it is.
    pub maximum: Extreme,
}

/// A value and where it occurs.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// SI.
    pub value: f64,
    /// The uncertain numbers that the parameter follows from: name, and value in SI. A number
    /// without influence there is left out.
    pub at: Vec<(String, f64)>,
}

/// Name, symbol and unit of each, in the order of the results.
const PARAMETERS: [(&str, &str, &str); 4] = [
    ("flow_gain", "K_qU", "m3/(s.V)"),
    ("flow_pressure_coefficient", "K_c", "m3/(s.Pa)"),
    ("hydraulic_stiffness", "K_H", "N/m"),
    ("viscous_friction", "f_v", "N.s/m"),
];
/// What moves the spool most.
const VELOCITY: &str = "operating_point.velocity";
/// First step of the search for an extreme, as a share of each range, and its least.
const STEPS: [f64; 2] = [0.25, 1e-5];
/// Least distance within which the crest of a coefficient is searched for, number of points of a
/// scan to either side, and number of ternary steps from there on.
const NEAR: f64 = 0.02;
const SCANNED: f64 = 8.0;
const THIRDS: usize = 25;
/// Between the points of a scan a crest is taken to rise by less than this times the step from the
/// highest of them down to its lower neighbour; where it is concave, it rises by at most that step.
const RISE: f64 = 4.0;
/// Relative difference that is rounding.
const SAME: f64 = 1e-9;
/// Plants from which the search for an extreme starts, and how many are drawn in addition to the
/// members to choose them from.
const STARTS: usize = 4;
const DRAWN: usize = 500;
/// What the draws begin with.
const SEED: u64 = 1;

/// The box of K_qU, K_c, K_H and f_v that encloses the family; `None` where they depend on no
/// number of the project.
///
/// The members are evaluated first; a search inside the box starts from the most extreme of them.
///
/// # Errors
/// Those of [`family`].
pub fn visited_box(setup: &Setup<'_>) -> Result<Option<Vec<VisitedRange>>, ProjectFamilyError> {
    let project = setup.project;
    let Some(declared) = &project.actuator else { return Ok(None) };
    let parameters = uncertain::parameters(project)?;
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
    let expressions: Vec<Expression> = (0..PARAMETERS.len()).map(of).collect();
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
        |((name, symbol, unit), expression): (&(&'static str, &'static str, &'static str), &Expression)| {
            let numbers = expression.numbers(&points);
            let extreme = |sign: f64| extreme(&family, expression, sign, points.iter().zip(&numbers));
            VisitedRange { name, symbol, unit, minimum: extreme(-1.0), maximum: extreme(1.0) }
        };
    Ok(Some(PARAMETERS.iter().zip(&expressions).map(range).collect()))
}

/// The most of a result over a family with sign 1, the least with sign -1; `points` are some of its
/// plants with the result there.
fn extreme<'a>(
    family: &UncertainFamily,
    expression: &Expression,
    sign: f64,
    points: impl Iterator<Item = (&'a Vec<f64>, &'a f64)>,
) -> Extreme {
    let value = |values: &[f64]| sign * expression.number(values);
    // among plants that differ only by rounding the first is kept, which is nearest to the nominal
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
            let hill = Hill { family, expression, sign, along };
            family.values(&hill.climb(family.shares(values)))
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

/// Points of the box drawn at random.
fn drawn(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let mut state = random::stream(SEED, 0);
    let mut point = |_| {
        let shares: Vec<f64> = family.coordinates().iter().map(|_| random::share(&mut state)).collect();
        family.values(&shares)
    };
    (0..DRAWN).map(&mut point).collect()
}

/// A result over the box, as high as it is with this sign.
struct Hill<'f> {
    family: &'f UncertainFamily,
    expression: &'f Expression,
    sign: f64,
    /// The coordinate that has a crest.
    along: Option<usize>,
}

/// What is known of each crest, by the values that decide it: those of the parameters, where the
/// search begins, and how far it goes.
type Crests = BTreeMap<Vec<u64>, Crest>;

/// What is known of the crest near a point.
#[derive(Clone, Copy)]
enum Crest {
    /// It is not higher than this.
    UpTo(f64),
    /// It is here.
    At { share: f64, height: f64 },
}

impl Hill<'_> {
    fn height(&self, shares: &[f64]) -> f64 {
        self.sign * self.expression.number(&self.family.values(shares))
    }

    /// Steps along each coordinate, and along all of them together, while they increase the value,
    /// with decreasing length. After each step the coordinate `along` moves to the best place
    /// nearby: a coefficient has a crest where the spool is at null, and steps away from it
    /// decrease the value.
    fn climb(&self, shares: Vec<f64>) -> Vec<f64> {
        let [mut step, least] = STEPS;
        let mut crests = Crests::new();
        let start = self.at_crest(shares.clone(), 1.0, f64::NEG_INFINITY, &mut crests);
        let (mut shares, mut best) = start.unwrap_or((shares, f64::NEG_INFINITY));
        let mut state = random::stream(SEED, 1);
        while step > least {
            let mut higher = false;
            let axes = shares.len();
            for direction in 0..2 * axes {
                let course: Vec<f64> = (0..axes)
                    .map(|axis| match direction < axes {
                        true => f64::from(u8::from(axis == direction)),
                        false => 2.0 * random::share(&mut state) - 1.0,
                    })
                    .collect();
                for side in [-step, step] {
                    let moved = shares.iter().zip(&course);
                    let next = moved.map(|(share, course)| (share + side * course).clamp(0.0, 1.0)).collect();
                    let wanted = best + SAME * best.abs();
                    if let Some(found) = self.at_crest(next, step, wanted, &mut crests) {
                        ((shares, best), higher) = (found, true);
                    }
                }
            }
            if !higher {
                step *= 0.5;
            }
        }
        shares
    }

    /// These shares with the coordinate `along` at the best place nearby, and the height there,
    /// where it is more than `wanted`. Many steps end at a corner of the box, or move what the
    /// result does not depend on: they are searched once.
    fn at_crest(
        &self,
        mut shares: Vec<f64>,
        step: f64,
        wanted: f64,
        crests: &mut Crests,
    ) -> Option<(Vec<f64>, f64)> {
        let start = self.along.and_then(|axis| Some((axis, *shares.get(axis)?)));
        let Some((axis, middle)) = start else {
            let height = self.height(&shares);
            return (height > wanted).then_some((shares, height));
        };
        let within = step.max(NEAR);
        let values = self.family.values(&shares);
        let felt = values.iter().enumerate().filter(|(index, _)| self.expression.depends_on(*index));
        let key = felt.map(|(_, value)| *value).chain([middle, within]).map(f64::to_bits).collect();
        let known = crests.entry(key).or_insert(Crest::UpTo(f64::INFINITY));
        if matches!(known, Crest::UpTo(height) if *height > wanted) {
            *known = self.crest(&shares, axis, within, wanted);
        }
        match *known {
            Crest::At { share, height } if height > wanted => {
                shares[axis] = share;
                Some((shares, height))
            }
            _ => None,
        }
    }

    /// The crest along one coordinate within a distance: by a scan, then by ternary search around
    /// the best point of it, where that may come to more than `wanted`.
    fn crest(&self, shares: &[f64], axis: usize, within: f64, wanted: f64) -> Crest {
        let middle = shares[axis];
        let heights = |places: &[f64]| -> Vec<f64> {
            let at = |place: &f64| {
                let mut moved = shares.to_vec();
                moved[axis] = place.clamp(0.0, 1.0);
                self.family.values(&moved)
            };
            let points: Vec<Vec<f64>> = places.iter().map(at).collect();
            self.expression.numbers(&points).into_iter().map(|number| self.sign * number).collect()
        };
        let spacing = within / SCANNED;
        let mut places = vec![middle - within];
        while let Some(next) =
            places.last().map(|last| last + spacing).filter(|next| *next <= middle + within)
        {
            places.push(next);
        }
        places.push(middle);
        let scanned = heights(&places);
        let (between, at_middle) = (&scanned[..scanned.len() - 1], scanned[scanned.len() - 1]);
        let mut best = (at_middle, middle);
        for (&height, &place) in between.iter().zip(&places) {
            if height > best.0 {
                best = (height, place);
            }
        }
        let near = between.iter().zip(&places).filter(|(_, place)| (*place - best.1).abs() < 1.5 * spacing);
        let reach = best.0 + RISE * near.fold(0.0, |fall: f64, (height, _)| fall.max(best.0 - height));
        if reach <= wanted {
            return Crest::UpTo(reach);
        }
        let [mut low, mut high] = [best.1 - spacing, best.1 + spacing];
        for _ in 0..THIRDS {
            let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            let is_rising = matches!(heights(&thirds)[..], [first, second] if first < second);
            if is_rising {
                low = thirds[0];
            } else {
                high = thirds[1];
            }
        }
        let found = 0.5 * (low + high);
        let height = heights(&[found]);
        match height[..] {
            [height] if height > best.0 => Crest::At { share: found.clamp(0.0, 1.0), height },
            _ => Crest::At { share: best.1.clamp(0.0, 1.0), height: best.0 },
        }
    }
}
