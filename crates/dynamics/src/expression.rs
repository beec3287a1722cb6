//! Recorded expressions: a model equation is run once with [`Recorded`] numbers and becomes data.
//!
//! An [`Expression`] is a list of operations over named parameters with one or more results. It is
//! evaluated over any [`Scalar`] (numbers, dual numbers, intervals), printed, and turned into code,
//! without the function it came from. Equal sub-expressions are recorded once; operations on
//! constants are done while recording.

mod lanes;
mod memo;
mod node;
mod recording;

pub use memo::EvaluationMemo;
pub use node::{Binary, Node, NodeIndex, Unary};
pub use recording::Recorded;

use crate::scalar::{Interval, Scalar};

/// Operations over named parameters, in an order in which each uses only earlier ones, and their
/// results.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    parameters: Vec<String>,
    nodes: Vec<Node>,
    results: Vec<NodeIndex>,
}

impl Expression {
    /// Runs `equations` once on the named parameters and keeps the operations that a result needs.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::Expression;
    /// let area = Expression::record(&["width", "height"], |p| vec![p[0] * p[1]]);
    /// assert_eq!(area.evaluate(&[2.0, 3.0]), vec![6.0]);
    /// assert_eq!(area.to_string(), "width*height");
    /// ```
    pub fn record<F>(parameters: &[&str], mut equations: F) -> Expression
    where
        F: for<'tape> FnMut(&[Recorded<'tape>]) -> Vec<Recorded<'tape>>,
    {
        let (nodes, results) = recording::record(parameters.len(), &mut equations);
        Expression { parameters: parameters.iter().map(|name| name.to_string()).collect(), nodes, results }
    }

    /// Names of the parameters, in the order in which [`Expression::evaluate`] takes their values.
    pub fn parameters(&self) -> &[String] {
        &self.parameters
    }

    /// The operations; each refers only to earlier ones.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Positions of the results among the operations.
    pub fn results(&self) -> &[NodeIndex] {
        &self.results
    }

    /// Expression of operations recorded elsewhere; `None` if one refers to itself, to a later
    /// operation or to a parameter that does not exist, or if a result does not exist.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::{Binary, Expression, Node};
    /// let nodes = vec![Node::Parameter(0), Node::Binary(Binary::Add, 0, 0)];
    /// let twice = Expression::from_nodes(vec!["x".into()], nodes.clone(), vec![1]);
    /// assert_eq!(twice.map(|twice| twice.evaluate(&[2.0])), Some(vec![4.0]));
    /// assert_eq!(Expression::from_nodes(vec![], nodes, vec![1]), None);
    /// ```
    pub fn from_nodes(
        parameters: Vec<String>,
        nodes: Vec<Node>,
        results: Vec<NodeIndex>,
    ) -> Option<Expression> {
        let refers_back = nodes.iter().enumerate().all(|(index, node)| {
            let known = !matches!(node, Node::Parameter(parameter) if *parameter >= parameters.len());
            known && node.operands().into_iter().flatten().all(|operand| operand < index)
        });
        let found = results.iter().all(|result| *result < nodes.len());
        (refers_back && found).then_some(Expression { parameters, nodes, results })
    }

    /// Expression of the first results only, with the operations that they need.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::Expression;
    /// let both = Expression::record(&["x"], |p| vec![p[0] + p[0], p[0].exp()]);
    /// assert_eq!(both.first(1).nodes().len(), 2);
    /// # use phea_dynamics::scalar::Scalar;
    /// ```
    pub fn first(&self, count: usize) -> Expression {
        let results = self.results.iter().take(count).copied().collect();
        let (nodes, results) = recording::needed(&self.nodes, results);
        Expression { parameters: self.parameters.clone(), nodes, results }
    }

    /// True if any result is computed from the parameter with this index.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::Expression;
    /// let first = Expression::record(&["a", "b"], |p| vec![p[0].into()]);
    /// assert!(first.depends_on(0) && !first.depends_on(1));
    /// ```
    pub fn depends_on(&self, parameter: usize) -> bool {
        self.nodes.contains(&Node::Parameter(parameter))
    }

    /// Intervals that hold every result while the parameters run through theirs. An operation on
    /// two equal operands is recognised: a square is not negative, x - x is zero.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::Expression;
    /// use phea_dynamics::scalar::Interval;
    /// let distance = Expression::record(&["x"], |p| vec![(p[0] - 2.0.into()) * (p[0] - 2.0.into())]);
    /// assert_eq!(distance.enclosures(&[Interval::new(1.0, 5.0)]), vec![Interval::new(0.0, 9.0)]);
    /// ```
    pub fn enclosures(&self, parameters: &[Interval]) -> Vec<Interval> {
        let mut values: Vec<Interval> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let value = match *node {
                Node::Binary(Binary::Multiply, x, y) if x == y => values[x].square(),
                Node::Binary(Binary::Subtract, x, y) if x == y => Interval::from(0.0),
                // a choice between the numbers that are compared
                Node::Select(x, y, less, other) if (less, other) == (x, y) => values[x].least(values[y]),
                Node::Select(x, y, less, other) if (less, other) == (y, x) => values[x].greatest(values[y]),
                _ => node.evaluate(parameters, &values),
            };
            values.push(value);
        }
        self.results.iter().map(|&index| values[index]).collect()
    }

    /// All results for these values of the parameters. A missing value counts as NaN; a surplus one
    /// is ignored.
    pub fn evaluate<S: Scalar>(&self, parameters: &[S]) -> Vec<S> {
        let values = self.values(parameters);
        self.results.iter().map(|&index| values[index]).collect()
    }

    /// Values of all operations.
    fn values<S: Scalar>(&self, parameters: &[S]) -> Vec<S> {
        let mut values = vec![S::from(0.0); self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            values[index] = node.evaluate(parameters, &values);
        }
        values
    }

    /// First result for these numbers, as [`Expression::evaluate`] returns it; NaN if there is
    /// none. Compiled here so that searches, which spend most of their time in it, are fast in test
    /// builds too.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::Expression;
    /// let area = Expression::record(&["a", "b"], |p| vec![p[0] * p[1]]);
    /// assert_eq!(area.number(&[2.0, 3.0]), 6.0);
    /// ```
    pub fn number(&self, parameters: &[f64]) -> f64 {
        let values = self.values(parameters);
        self.results.first().map_or(f64::NAN, |&index| values[index])
    }
}

impl std::fmt::Display for Expression {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let texts: Vec<String> =
            self.results.iter().map(|&index| node::text(&self.nodes, &self.parameters, index)).collect();
        formatter.write_str(&texts.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Dual;

    fn equations<S: Scalar>(p: &[S]) -> Vec<S> {
        let shared = (p[0] + p[1]).sqrt();
        vec![
            shared * p[1] - S::from(3.0) / (shared + S::from(1.0)),
            S::select(p[0].less_than(p[1]), p[0].exp(), (-p[1]).abs().ln()),
        ]
    }

    #[test]
    fn recording_and_running_agree_to_the_bit() {
        let expression = Expression::record(&["a", "b"], |p| equations(p));
        for values in [[0.5, 2.0], [2.0, 0.5], [1.0, 1.0]] {
            assert_eq!(expression.evaluate(&values), equations(&values));
            let duals = [Dual::<2>::variable(values[0], 0), Dual::<2>::variable(values[1], 1)];
            assert_eq!(expression.evaluate(&duals), equations(&duals));
        }
    }

    #[test]
    fn equal_terms_are_recorded_once_and_constants_folded() {
        let expression = Expression::record(&["a"], |p| {
            let two = Recorded::from(1.0) + Recorded::from(1.0);
            vec![(p[0] * two) + (p[0] * two)]
        });
        // a, 2, a*2, (a*2)+(a*2)
        assert_eq!(expression.nodes().len(), 4);
        assert_eq!(expression.evaluate(&[3.0]), vec![12.0]);
    }

    #[test]
    fn several_points_at_a_time_give_the_same_bits() {
        let expression = Expression::record(&["a", "b"], |p| equations(p));
        let points = [[0.5, 2.0], [2.0, 0.5], [1.0, 1.0], [-0.0, 0.0], [3.0, 0.1], [0.7, 4.0]].map(Vec::from);
        for count in 0..=points.len() {
            let singly = points.iter().take(count).map(|point| expression.number(point).to_bits());
            let together = expression.numbers(&points[..count]);
            assert!(singly.eq(together.into_iter().map(f64::to_bits)), "{count}");
        }
    }

    #[test]
    fn text_keeps_the_precedence() {
        let expression =
            Expression::record(&["a", "b"], |p| vec![(p[0] - (p[1] - p[0])) / (p[0] * p[1]), -p[0]]);
        assert_eq!(expression.to_string(), "(a - (b - a))/(a*b); -a");
    }
}
