//! Plants of a box on both sides of a switch in its equations: gas that is shut off, a wall that is
//! touched, a relief valve that closes.
//!
//! ```text
//! choice:     y < z,     |y|               g = y - z,     g = y               a jump if g changes its sign
//! ```
//!
//! The equations never branch on a value, so that every choice is an operation of the recorded
//! plant, with spool and pressures as inputs. The plants next to a jump are members of the family,
//! from which every search inside the box starts: between the corners nothing indicates them. For
//! the null of the spool see [`super::null_crossing`].

use phea_dynamics::expression::{Binary, Expression, Node, Unary};
use phea_hydraulics::operating_point::Settled;
use phea_hydraulics::servovalve::Supply;
use phea_qft::family::UncertainFamily;

use super::hydraulic::Open;
use super::visited::{Visited, lines};
use crate::project::Project;

/// Largest number of coordinates of a box that is searched from its corners too; others are
/// searched from their nominal plant only.
const CORNER_COORDINATES: usize = 5;
/// Number of points along a line between which signs are compared.
const ALONG: usize = 6;
/// Number of bisections to find a change of sign.
const HALVINGS: usize = 34;
/// Largest number of jumps that become members, of two plants each.
const JUMPS: usize = 32;
/// Relative change of a coefficient that counts as a jump.
const JUMP: f64 = 1e-6;
/// Fraction of the nominal voltage within which the spool is at null.
const AT_NULL: f64 = 1e-6;
/// Solved variables: spool, both pressures, and that of the supply.
const SOLVED: [&str; 4] = ["spool", "pressure_a", "pressure_b", "supply_pressure"];

/// Choices of a family's equations.
struct Choices<'a> {
    visited: &'a Visited,
    open: Open<'a>,
    family: &'a UncertainFamily,
    /// Sign function g of each choice, in terms of the parameters and the solved variables.
    signs: Expression,
}

/// Plants on either side of each jump: on the edges of the box, and along each coordinate from the
/// nominal plant.
pub(super) fn jumps(visited: &Visited, project: &Project, family: &UncertainFamily) -> Vec<Vec<f64>> {
    let Some(declared) = &project.actuator else { return Vec::new() };
    let open = visited.open(project, declared);
    let Some(signs) = signs(visited, &open, family) else { return Vec::new() };
    let choices = Choices { visited, open, family, signs };
    let mut found = Vec::new();
    for axis in 0..family.coordinates().len() {
        for from in lines(family, axis, CORNER_COORDINATES) {
            found.extend(choices.along(&from, axis));
        }
    }
    let step = found.len().div_ceil(JUMPS).max(1);
    found.into_iter().step_by(step).flatten().collect()
}

/// Sign functions g of all choices on which the plant depends; `None` if there is none.
fn signs(visited: &Visited, open: &Open<'_>, family: &UncertainFamily) -> Option<Expression> {
    let own: Vec<&str> = family.plant().parameters().iter().map(|one| one.name.as_str()).collect();
    let names: Vec<&str> = own.iter().copied().chain(SOLVED).collect();
    let recorded = Expression::record(&names, |values| {
        let (own, solved) = values.split_at(own.len());
        let &[command, a, b, pressure] = solved else { return Vec::new() };
        let supply = Supply { pressure, ..open.unsolved(own).balance.supply };
        let solved = (supply, Settled { command, pressures: [a, b] });
        let plant = open.plant_at(own, solved, visited.equal).1.coefficients();
        let paths = [Some(plant.command), plant.disturbance].into_iter().flatten();
        paths.flat_map(|path| path.numerator.into_iter().chain(path.denominator)).collect()
    });
    let mut nodes = recorded.nodes().to_vec();
    let mut results = Vec::new();
    for node in recorded.nodes() {
        match *node {
            Node::Select(y, z, ..) => {
                nodes.push(Node::Binary(Binary::Subtract, y, z));
                results.push(nodes.len() - 1);
            }
            Node::Unary(Unary::Magnitude, y) => results.push(y),
            _ => {}
        }
    }
    results.sort_unstable();
    results.dedup();
    if results.is_empty() {
        return None;
    }
    Expression::from_nodes(recorded.parameters().to_vec(), nodes, results)
}

impl Choices<'_> {
    /// Sign functions g of all choices at a plant, and the spool there, V.
    fn at(&self, values: &[f64]) -> (Vec<f64>, f64) {
        let (supply, Settled { command, pressures: [a, b] }) = self.open.solved(values, self.visited.moved);
        let all: Vec<f64> = values.iter().copied().chain([command, a, b, supply.pressure]).collect();
        (self.signs.evaluate(&all), command)
    }

    /// Both plants next to each jump along one coordinate.
    fn along(&self, from: &[f64], axis: usize) -> Vec<[Vec<f64>; 2]> {
        let at = |fraction: f64| {
            let mut fractions = from.to_vec();
            fractions[axis] = fraction;
            self.family.values(&fractions)
        };
        let places: Vec<f64> = (0..ALONG).map(|place| place as f64 / (ALONG - 1) as f64).collect();
        let seen: Vec<Vec<f64>> = places.iter().map(|&fraction| self.at(&at(fraction)).0).collect();
        let full = self.open.rig.actuator.components().valve.nominal_voltage;
        let mut found: Vec<[Vec<f64>; 2]> = Vec::new();
        for (pair, ends) in seen.windows(2).zip(places.windows(2)) {
            for choice in 0..pair[0].len() {
                let is_below = |of: &[f64]| of.get(choice).is_some_and(|sign| *sign < 0.0);
                if is_below(&pair[0]) == is_below(&pair[1]) {
                    continue;
                }
                let [mut low, mut high] = [ends[0], ends[1]];
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if is_below(&self.at(&at(middle)).0) == is_below(&pair[0]) {
                        low = middle
                    } else {
                        high = middle
                    }
                }
                let both = [at(low), at(high)];
                if self.at(&both[0]).1.abs() > AT_NULL * full && self.is_jump(&both) && !found.contains(&both)
                {
                    found.push(both);
                }
            }
        }
        found
    }

    /// True if a coefficient of the plant jumps between two plants.
    fn is_jump(&self, both: &[Vec<f64>; 2]) -> bool {
        let Some(recorded) = self.family.plant().expression() else { return false };
        let [one, other] = both.each_ref().map(|values| recorded.evaluate(values));
        one.iter().zip(&other).any(|(one, other)| (one - other).abs() > JUMP * one.abs().max(other.abs()))
    }
}
