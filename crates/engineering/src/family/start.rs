//! Polynomials near the operating points of a family, from which Newton steps converge to all
//! digits: bisections make choices, and polynomials cannot follow a choice.
//!
//! ```text
//! U, p_A, p_B = c_0 + (x - x_0)(c_1 + (x - x_1)(...)),      x_k = cos((k + 1/2) pi/n),      x in [-1, 1] over a piece
//! ```
//!
//! A piece of the box whose polynomials are too inaccurate is halved. If one number moves the spool
//! through null, a narrow piece around null separates both sides: the slopes of the edges jump
//! there.

use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::UncertainParameter;
use phea_hydraulics::operating_point::{Balance, Settled, Steady};

use super::hydraulic::Open;
use super::visited::Visited;
use crate::project::{Project, SupplyModel};
use crate::rig::UnsolvedRig;

/// Number of points of a polynomial along each number, for one, two and three numbers that move the
/// operating point.
const POINTS: [usize; 3] = [7, 5, 4];
/// Number of points along each number at which the polynomial is tested.
const TESTED: [usize; 3] = [41, 9, 6];
/// Largest number of pieces.
const PIECES_MAXIMUM: usize = 32;
/// Largest relative error after the Newton steps.
const EXACT: f64 = 1e-9;
/// Half width of the piece around null, as a fraction of the width over which the edges leak.
const AROUND_NULL: f64 = 1e-3;
/// Number of bisections to find null.
const HALVINGS: usize = 60;

/// Starts for the balance of a family.
pub(super) struct BalanceStart {
    /// Numbers that move the operating point, as indices of parameters.
    movers: Vec<usize>,
    pieces: StartPieces,
}

/// Pieces of a box.
enum StartPieces {
    Piece(Polynomials),
    Cut { parameter: usize, at: f64, parts: Box<[StartPieces; 2]> },
}

/// Command and both pressures over a piece.
struct Polynomials {
    /// Middle and half width of the piece along each mover.
    ranges: Vec<[f64; 2]>,
    /// Newton's divided differences, with the index of the last mover fastest; command, p_A, p_B.
    differences: [Vec<f64>; 3],
}

impl BalanceStart {
    /// Starts for the operating points of a family; `None` if they need none, or if a few pieces do
    /// not suffice.
    pub(super) fn of(
        visited: &Visited,
        project: &Project,
        parameters: &[UncertainParameter],
    ) -> Option<BalanceStart> {
        let declared = project.actuator.as_ref()?;
        if matches!(declared.supply.model, SupplyModel::PumpLimited(_)) {
            return None;
        }
        let fitted = Fitted { visited, open: visited.open(project, declared), parameters };
        let is_range = |index: &&usize| parameters.get(**index).is_some_and(|one| one.minimum < one.maximum);
        let movers: Vec<usize> = visited.movers.iter().filter(is_range).copied().collect();
        let nominal: Vec<f64> = parameters.iter().map(|one| one.nominal).collect();
        let UnsolvedRig { steady, balance, .. } = fitted.open.balanced(&nominal);
        let halves = match steady {
            Steady::Moving { .. } => true,
            Steady::Command(_) => balance.across.is_some() || balance.outward.is_some(),
            Steady::Matched(..) => false,
        };
        if !halves || movers.is_empty() || movers.len() > POINTS.len() {
            return None;
        }
        let whole: Vec<[f64; 2]> =
            movers.iter().map(|&index| [parameters[index].minimum, parameters[index].maximum]).collect();
        let mut left = PIECES_MAXIMUM;
        let pieces = fitted.around_null(&movers, &whole, &balance, &mut left)?;
        Some(BalanceStart { movers, pieces })
    }

    /// Start at these values of the parameters.
    pub(super) fn at<S: Scalar>(&self, values: &[S]) -> Settled<S> {
        let [command, a, b] = self.pieces.at(&self.movers, values);
        Settled { command, pressures: [a, b] }
    }
}

impl StartPieces {
    fn at<S: Scalar>(&self, movers: &[usize], values: &[S]) -> [S; 3] {
        match self {
            StartPieces::Piece(polynomials) => polynomials.at(movers, values),
            StartPieces::Cut { parameter, at, parts } => {
                let is_below = values[*parameter].less_than(S::from(*at));
                let [below, above] = parts.each_ref().map(|part| part.at(movers, values));
                std::array::from_fn(|result| S::select(is_below, below[result], above[result]))
            }
        }
    }
}

impl Polynomials {
    fn at<S: Scalar>(&self, movers: &[usize], values: &[S]) -> [S; 3] {
        let places: Vec<S> = movers
            .iter()
            .zip(&self.ranges)
            .map(|(&index, [middle, half])| (values[index] - S::from(*middle)) / S::from(*half))
            .collect();
        let nodes = nodes(places.len());
        self.differences.each_ref().map(|differences| nested(&nodes, &places, differences))
    }
}

/// Newton's form over all places, the first outermost.
fn nested<S: Scalar>(nodes: &[f64], places: &[S], differences: &[f64]) -> S {
    let Some((place, inner)) = places.split_first() else {
        return S::from(differences.first().copied().unwrap_or(0.0));
    };
    let stride = differences.len() / nodes.len();
    let parts = differences.chunks(stride).zip(nodes).rev();
    parts.fold(S::from(0.0), |sum, (part, node)| sum * (*place - S::from(*node)) + nested(nodes, inner, part))
}

/// Chebyshev points for this number of movers.
fn nodes(movers: usize) -> Vec<f64> {
    let count = POINTS[movers - 1];
    let angle = |index: usize| (index as f64 + 0.5) * std::f64::consts::PI / count as f64;
    (0..count).map(|index| portable::cos(angle(index))).collect()
}

/// Functions to which polynomials are fitted.
struct Fitted<'a> {
    visited: &'a Visited,
    open: Open<'a>,
    parameters: &'a [UncertainParameter],
}

impl Fitted<'_> {
    /// Values of all parameters with the movers at these places.
    fn values(&self, movers: &[usize], at: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = self.parameters.iter().map(|one| one.nominal).collect();
        for (&index, value) in movers.iter().zip(at) {
            values[index] = *value;
        }
        values
    }

    /// Pieces of a box, cut at both ends of null if a single number crosses it.
    fn around_null(
        &self,
        movers: &[usize],
        whole: &[[f64; 2]],
        balance: &Balance,
        left: &mut usize,
    ) -> Option<StartPieces> {
        let &[parameter] = movers else { return self.pieces(movers, whole, 0, left) };
        let [low, high] = whole[0];
        let width = balance.valve.nominal_voltage / balance.valve.leakage_shape.widest().max(1.0);
        let command = |value: f64| self.visited.command(&self.values(movers, &[value]));
        let rises = command(high) > command(low);
        let mut cuts = [-AROUND_NULL, AROUND_NULL].map(|fraction| {
            let is_above = |value: f64| (command(value) > fraction * width) == rises;
            if is_above(low) || !is_above(high) {
                return None;
            }
            let [mut below, mut above] = [low, high];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (below + above);
                if is_above(middle) { above = middle } else { below = middle }
            }
            Some(above)
        });
        if !rises {
            cuts.reverse();
        }
        let inner: Vec<f64> = cuts.into_iter().flatten().filter(|at| low < *at && *at < high).collect();
        let ends: Vec<f64> = [&[low][..], &inner, &[high]].concat();
        let mut parts = Vec::new();
        for ends in ends.windows(2) {
            parts.push(self.pieces(movers, &[[ends[0], ends[1]]], 0, left)?);
        }
        let mut parts = parts.into_iter().rev();
        let last = parts.next()?;
        Some(parts.zip(inner.into_iter().rev()).fold(last, |above, (below, at)| StartPieces::Cut {
            parameter,
            at,
            parts: Box::new([below, above]),
        }))
    }

    /// Pieces of a box, halved along one number after the other until each has polynomials.
    fn pieces(
        &self,
        movers: &[usize],
        box_of: &[[f64; 2]],
        depth: usize,
        left: &mut usize,
    ) -> Option<StartPieces> {
        let polynomials = self.fit(movers, box_of);
        if self.is_near(movers, box_of, &polynomials) {
            *left = left.checked_sub(1)?;
            return Some(StartPieces::Piece(polynomials));
        }
        if depth > PIECES_MAXIMUM || *left < 2 {
            return None;
        }
        let axis = depth % movers.len();
        let [low, high] = box_of[axis];
        let at = 0.5 * (low + high);
        let mut part = |ends: [f64; 2]| {
            let mut own = box_of.to_vec();
            own[axis] = ends;
            self.pieces(movers, &own, depth + 1, left)
        };
        let parts = Box::new([part([low, at])?, part([at, high])?]);
        Some(StartPieces::Cut { parameter: movers[axis], at, parts })
    }

    fn fit(&self, movers: &[usize], box_of: &[[f64; 2]]) -> Polynomials {
        let nodes = nodes(movers.len());
        let ranges: Vec<[f64; 2]> =
            box_of.iter().map(|[low, high]| [0.5 * (low + high), 0.5 * (high - low)]).collect();
        let found: Vec<[f64; 3]> = grid(&ranges, &nodes)
            .map(|at| {
                let settled = self.visited.settled.evaluate(&self.values(movers, &at));
                settled.first_chunk().copied().unwrap_or([f64::NAN; 3])
            })
            .collect();
        let differences = std::array::from_fn(|result| {
            let values = found.iter().map(|of| of[result]).collect();
            divided(values, &nodes, movers.len())
        });
        Polynomials { ranges, differences }
    }

    /// True if Newton steps from the polynomials end at the solution, everywhere in their piece.
    fn is_near(&self, movers: &[usize], box_of: &[[f64; 2]], polynomials: &Polynomials) -> bool {
        let count = TESTED[movers.len() - 1];
        let places: Vec<f64> =
            (0..count).map(|index| 2.0 * index as f64 / (count - 1) as f64 - 1.0).collect();
        let ranges: Vec<[f64; 2]> =
            box_of.iter().map(|[low, high]| [0.5 * (low + high), 0.5 * (high - low)]).collect();
        grid(&ranges, &places).all(|at| {
            let values = self.values(movers, &at);
            let UnsolvedRig { steady, balance, .. } = self.open.balanced(&values);
            let [command, a, b] = polynomials.at(movers, &values);
            let found = balance.settle_from(steady, Settled { command, pressures: [a, b] });
            let settled = self.visited.settled.evaluate(&values);
            let Some(&[command, a, b]) = settled.first_chunk() else { return false };
            let drop = balance.supply.pressure - balance.supply.tank_pressure;
            let error = (found.command - command).abs() / balance.valve.nominal_voltage
                + (found.pressures[0] - a).abs() / drop
                + (found.pressures[1] - b).abs() / drop;
            error <= EXACT
        })
    }
}

/// All points with these places along each range, with the index of the last range fastest.
fn grid<'a>(ranges: &'a [[f64; 2]], places: &'a [f64]) -> impl Iterator<Item = Vec<f64>> + 'a {
    let (count, axes) = (places.len(), ranges.len());
    (0..count.pow(axes as u32)).map(move |number| {
        let along = |axis: usize| {
            let [middle, half] = ranges[axis];
            middle + half * places[number / count.pow((axes - 1 - axis) as u32) % count]
        };
        (0..axes).map(along).collect()
    })
}

/// Divided differences along every axis of a cube of values.
fn divided(mut values: Vec<f64>, nodes: &[f64], axes: usize) -> Vec<f64> {
    let count = nodes.len();
    for axis in 0..axes {
        let stride = count.pow((axes - 1 - axis) as u32);
        for order in 1..count {
            for place in (0..values.len()).rev() {
                let along = place / stride % count;
                if along >= order {
                    values[place] =
                        (values[place] - values[place - stride]) / (nodes[along] - nodes[along - order]);
                }
            }
        }
    }
    values
}
