use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::node::{Binary, Node, NodeIndex, Unary};
use crate::scalar::Scalar;

/// Tape on which [`Recorded`] numbers write their operations.
#[derive(Debug, Default)]
struct Tape {
    nodes: RefCell<Vec<Node>>,
    known: RefCell<BTreeMap<[u64; 5], NodeIndex>>,
}

impl Tape {
    /// Index of this node, which is recorded now unless it already is.
    fn index(&self, node: Node) -> NodeIndex {
        let mut nodes = self.nodes.borrow_mut();
        *self.known.borrow_mut().entry(key(node)).or_insert_with(|| {
            nodes.push(node);
            nodes.len() - 1
        })
    }
}

/// Key of a node; equal keys mean equal operations on equal operands.
fn key(node: Node) -> [u64; 5] {
    match node {
        Node::Parameter(index) => [0, index as u64, 0, 0, 0],
        Node::Constant(value) => [1, value.to_bits(), 0, 0, 0],
        Node::Unary(operation, x) => [2, operation as u64, x as u64, 0, 0],
        Node::Binary(operation, x, y) => [3, operation as u64, x as u64, y as u64, 0],
        Node::Select(x, y, if_less, otherwise) => [4, x as u64, y as u64, if_less as u64, otherwise as u64],
    }
}

/// Number that remembers how it was computed. Two are equal if they are one known number or one
/// entry, not if they only have equal values for some parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recorded<'tape> {
    /// Known number, not yet on any tape.
    Constant(f64),
    /// Result of a recorded operation.
    Node(TapeEntry<'tape>),
}

impl Default for Recorded<'_> {
    fn default() -> Self {
        Recorded::Constant(0.0)
    }
}

impl PartialEq for TapeEntry<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.tape, other.tape) && self.index == other.index
    }
}

/// Position on a tape.
#[derive(Clone, Copy, Debug)]
pub struct TapeEntry<'tape> {
    tape: &'tape Tape,
    index: NodeIndex,
}

/// Equations from recorded parameters to recorded results.
type Equations<'a> = &'a mut dyn for<'tape> FnMut(&[Recorded<'tape>]) -> Vec<Recorded<'tape>>;

pub(super) fn record(parameter_count: usize, equations: Equations<'_>) -> (Vec<Node>, Vec<NodeIndex>) {
    let tape = Tape::default();
    let parameters: Vec<Recorded<'_>> = (0..parameter_count)
        .map(|index| Recorded::Node(TapeEntry { tape: &tape, index: tape.index(Node::Parameter(index)) }))
        .collect();
    let results = equations(&parameters).into_iter().map(|result| result.index_on(&tape)).collect();
    needed(&tape.nodes.take(), results)
}

/// Nodes from which some result is computed, in their order, and the positions of the results among
/// them.
pub(super) fn needed(nodes: &[Node], results: Vec<NodeIndex>) -> (Vec<Node>, Vec<NodeIndex>) {
    let mut wanted = vec![false; nodes.len()];
    for &result in &results {
        wanted[result] = true;
    }
    for index in (0..nodes.len()).rev() {
        if wanted[index] {
            nodes[index].operands().into_iter().flatten().for_each(|operand| wanted[operand] = true);
        }
    }
    let mut places = vec![0; nodes.len()];
    let mut kept = Vec::new();
    for (index, node) in nodes.iter().enumerate().filter(|(index, _)| wanted[*index]) {
        places[index] = kept.len();
        kept.push(node.moved(&places));
    }
    (kept, results.into_iter().map(|result| places[result]).collect())
}

impl<'tape> Recorded<'tape> {
    fn index_on(self, tape: &Tape) -> NodeIndex {
        match self {
            Recorded::Constant(value) => tape.index(Node::Constant(value)),
            Recorded::Node(entry) => entry.index,
        }
    }

    fn tape(self) -> Option<&'tape Tape> {
        match self {
            Recorded::Constant(_) => None,
            Recorded::Node(entry) => Some(entry.tape),
        }
    }

    fn unary(self, operation: Unary) -> Self {
        match self {
            Recorded::Constant(value) => Recorded::Constant(operation.apply(value)),
            Recorded::Node(TapeEntry { tape, index }) => {
                Recorded::Node(TapeEntry { tape, index: tape.index(Node::Unary(operation, index)) })
            }
        }
    }

    fn binary(self, operation: Binary, other: Self) -> Self {
        match (self, other, self.tape().or(other.tape())) {
            (Recorded::Constant(x), Recorded::Constant(y), _) => Recorded::Constant(operation.apply(x, y)),
            (x, y, Some(tape)) => {
                let node = Node::Binary(operation, x.index_on(tape), y.index_on(tape));
                Recorded::Node(TapeEntry { tape, index: tape.index(node) })
            }
            // two numbers without a tape are both constants, matched above
            (x, _, None) => x,
        }
    }
}

/// `x < y`, to be decided when the expression is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'tape> {
    lesser: Recorded<'tape>,
    greater: Recorded<'tape>,
}

impl From<f64> for Recorded<'_> {
    fn from(value: f64) -> Self {
        Recorded::Constant(value)
    }
}

impl Add for Recorded<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.binary(Binary::Add, other)
    }
}

impl Sub for Recorded<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.binary(Binary::Subtract, other)
    }
}

impl Mul for Recorded<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.binary(Binary::Multiply, other)
    }
}

impl Div for Recorded<'_> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.binary(Binary::Divide, other)
    }
}

impl Neg for Recorded<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Unary::Negate)
    }
}

impl<'tape> Scalar for Recorded<'tape> {
    type Mask = Comparison<'tape>;

    fn sqrt(self) -> Self {
        self.unary(Unary::SquareRoot)
    }
    fn exp(self) -> Self {
        self.unary(Unary::Exponential)
    }
    fn ln(self) -> Self {
        self.unary(Unary::Logarithm)
    }
    fn abs(self) -> Self {
        self.unary(Unary::Magnitude)
    }
    fn less_than(self, other: Self) -> Comparison<'tape> {
        Comparison { lesser: self, greater: other }
    }
    fn select(mask: Comparison<'tape>, if_true: Self, if_false: Self) -> Self {
        let operands = [mask.lesser, mask.greater, if_true, if_false];
        match (mask.lesser, mask.greater, operands.iter().find_map(|operand| operand.tape())) {
            (Recorded::Constant(x), Recorded::Constant(y), _) => {
                if x < y {
                    if_true
                } else {
                    if_false
                }
            }
            (_, _, Some(tape)) => {
                let [x, y, if_less, otherwise] = operands.map(|operand| operand.index_on(tape));
                let node = Node::Select(x, y, if_less, otherwise);
                Recorded::Node(TapeEntry { tape, index: tape.index(node) })
            }
            // a comparison of constants is decided above; any other has a tape
            (_, _, None) => if_false,
        }
    }
}
