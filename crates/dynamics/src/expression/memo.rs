use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Expression, Node, NodeIndex};

/// Number of operations below which evaluation costs less than finding a stored result.
const OPERATIONS_MINIMUM: usize = 200;
/// Largest number of stored results of a costly part, of some 200 bytes each.
const KEPT_MAXIMUM: usize = 200_000;

/// Stores the results of most operations of an expression, if they are computed from a few of its
/// parameters.
///
/// For a plant over an operating region nearly all operations find the steady state of valve and
/// chambers, and need force and velocity only; a search moves all parameters, and returns to equal
/// force and velocity again and again.
#[derive(Clone, Debug, Default)]
pub struct EvaluationMemo(Option<Remembered>);

#[derive(Clone, Debug)]
struct Remembered {
    expression: Arc<Expression>,
    part: CostlyPart,
    /// Results of the part, by the bits of its parameters.
    kept: BTreeMap<Vec<u64>, Vec<f64>>,
    /// Last value of each operation; within the part only if the others need it.
    values: Vec<f64>,
}

/// Operations over a few of the parameters.
#[derive(Clone, Debug, Default, PartialEq)]
struct CostlyPart {
    parameters: Vec<usize>,
    operations: Vec<NodeIndex>,
    /// Operations of the part that an operation outside it, or the reader of a result, needs.
    given: Vec<NodeIndex>,
    /// All other operations.
    others: Vec<NodeIndex>,
}

impl EvaluationMemo {
    /// All results for these numbers, bit for bit those of [`Expression::evaluate`].
    ///
    /// # Example
    /// ```
    /// use std::sync::Arc;
    /// use phea_dynamics::expression::{EvaluationMemo, Expression};
    /// let area = Arc::new(Expression::record(&["width", "height"], |p| vec![p[0] * p[1]]));
    /// let mut memo = EvaluationMemo::default();
    /// assert_eq!(memo.evaluate(&area, &[2.0, 3.0]), vec![6.0]);
    /// ```
    pub fn evaluate(&mut self, expression: &Arc<Expression>, parameters: &[f64]) -> Vec<f64> {
        if expression.nodes().len() < OPERATIONS_MINIMUM {
            return expression.evaluate(parameters);
        }
        let remembered = self.0.take().filter(|one| Arc::ptr_eq(&one.expression, expression));
        self.0.insert(remembered.unwrap_or_else(|| Remembered::new(expression))).evaluate(parameters)
    }
}

impl Remembered {
    fn new(expression: &Arc<Expression>) -> Remembered {
        Remembered {
            expression: Arc::clone(expression),
            part: CostlyPart::of(expression),
            kept: BTreeMap::new(),
            values: vec![0.0; expression.nodes().len()],
        }
    }

    fn evaluate(&mut self, parameters: &[f64]) -> Vec<f64> {
        let Remembered { expression, part, kept, values } = self;
        let compute = |operations: &[NodeIndex], values: &mut [f64]| {
            for &index in operations {
                values[index] = expression.nodes()[index].evaluate(parameters, values);
            }
        };
        let bits = |&index: &usize| parameters.get(index).unwrap_or(&f64::NAN).to_bits();
        let key: Vec<u64> = part.parameters.iter().map(bits).collect();
        match kept.get(&key) {
            Some(known) => {
                for (&index, &value) in part.given.iter().zip(known) {
                    values[index] = value;
                }
            }
            None => {
                compute(&part.operations, values);
                if kept.len() < KEPT_MAXIMUM {
                    kept.insert(key, part.given.iter().map(|&index| values[index]).collect());
                }
            }
        }
        compute(&part.others, values);
        expression.results().iter().map(|&index| values[index]).collect()
    }
}

impl CostlyPart {
    /// The part with the fewest parameters from which three quarters of the operations are
    /// computed; empty if that takes all parameters.
    fn of(expression: &Expression) -> CostlyPart {
        let nodes = expression.nodes();
        let needs = needs(nodes);
        let mut choices = needs.clone();
        choices.sort_by_key(|choice| (choice.count_ones(), *choice));
        choices.dedup();
        let all = choices.iter().fold(0, |all, one| all | one);
        let within = |choice: u64| move |need: &u64| need & !choice == 0;
        let is_most = |choice: u64| {
            4 * needs.iter().copied().filter(|need| within(choice)(need)).count() >= 3 * nodes.len()
        };
        let chosen = choices.into_iter().find(|&choice| choice != all && is_most(choice));
        let Some(chosen) = chosen.filter(|_| expression.parameters().len() <= 64) else {
            return CostlyPart { others: (0..nodes.len()).collect(), ..CostlyPart::default() };
        };
        let (operations, others): (Vec<NodeIndex>, Vec<NodeIndex>) =
            (0..nodes.len()).partition(|&index| within(chosen)(&needs[index]));
        let mut is_given = vec![false; nodes.len()];
        let of_others = others.iter().flat_map(|&index| nodes[index].operands()).flatten();
        of_others.chain(expression.results().iter().copied()).for_each(|index| is_given[index] = true);
        let given = operations.iter().copied().filter(|&index| is_given[index]).collect();
        let parameters =
            (0..expression.parameters().len()).filter(|index| chosen >> index & 1 == 1).collect();
        CostlyPart { parameters, operations, given, others }
    }
}

/// Parameters from which each operation is computed, a bit each.
fn needs(nodes: &[Node]) -> Vec<u64> {
    let mut needs: Vec<u64> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let own = match node {
            Node::Parameter(parameter) => 1_u64.checked_shl(*parameter as u32).unwrap_or(0),
            _ => 0,
        };
        needs.push(node.operands().into_iter().flatten().fold(own, |all, operand| all | needs[operand]));
    }
    needs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Scalar;

    /// Most operations over a and b, a few over c too.
    fn expression() -> Arc<Expression> {
        Arc::new(Expression::record(&["a", "c", "b"], |p| {
            let [a, c, b] = [p[0], p[1], p[2]];
            let settled = (0..OPERATIONS_MINIMUM).fold(a, |sum, _| (sum / b).exp() - a);
            let first = Scalar::select(settled.less_than(c), settled * c, b.sqrt());
            vec![first, -c, settled, 3.0.into(), a]
        }))
    }

    fn bits(numbers: Vec<f64>) -> Vec<u64> {
        numbers.into_iter().map(f64::to_bits).collect()
    }

    /// Repeated points, zeros of both signs, NaN, and another expression in between.
    #[test]
    fn what_is_remembered_has_the_bits_of_what_is_computed() {
        let (expression, other) = (expression(), expression());
        let points = [
            [1.0, 2.0, 3.0],
            [1.0, 5.0, 3.0],
            [0.5, 5.0, 3.0],
            [1.0, 0.1, 3.0],
            [7.0, 1.0, 0.0],
            [7.0, 1.0, -0.0],
            [7.0, 2.0, 0.0],
            [f64::NAN, -0.0, 0.0],
            [f64::NAN, 0.0, 0.0],
            [1.0, f64::NAN, 3.0],
        ];
        let mut memo = EvaluationMemo::default();
        for (index, point) in points.iter().chain(&points).enumerate() {
            let expression = if index == 4 { &other } else { &expression };
            let found = memo.evaluate(expression, point);
            assert_eq!(bits(found), bits(expression.evaluate(point)), "{point:?}");
        }
        assert_eq!(memo.0.as_ref().map(|one| one.kept.len()), Some(5));
        // a missing value counts as NaN, not as zero
        for point in [&[1.0, 2.0, 0.0][..], &[1.0, 2.0]] {
            assert_eq!(
                bits(memo.evaluate(&expression, point)),
                bits(expression.evaluate(point)),
                "{point:?}"
            );
        }
    }

    #[test]
    fn the_part_is_that_of_the_fewest_parameters() {
        let expression = expression();
        let part = CostlyPart::of(&expression);
        assert_eq!(part.parameters, [0, 2]);
        assert_eq!(part.operations.len() + part.others.len(), expression.nodes().len());
        assert!(part.others.len() < 10 && part.given.len() < 10, "{part:?}");
        let all = Expression::record(&["a", "b"], |p| vec![(0..300).fold(p[0], |sum, _| (sum * p[1]).exp())]);
        assert_eq!(CostlyPart::of(&all).operations, []);
    }
}
