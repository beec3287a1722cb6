use crate::scalar::Scalar;

/// Position of a node in its expression.
pub type NodeIndex = usize;

/// An operation on one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// -x
    Negate,
    /// Square root.
    SquareRoot,
    /// Natural exponential.
    Exponential,
    /// Natural logarithm.
    Logarithm,
    /// |x|
    Magnitude,
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// x + y
    Add,
    /// x - y
    Subtract,
    /// x y
    Multiply,
    /// x / y
    Divide,
}

/// One recorded operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Node {
    /// The parameter with this index.
    Parameter(usize),
    /// A number.
    Constant(f64),
    /// An operation on one earlier node.
    Unary(Unary, NodeIndex),
    /// An operation on two earlier nodes.
    Binary(Binary, NodeIndex, NodeIndex),
    /// The third node if the first is less than the second, otherwise the fourth.
    Select(NodeIndex, NodeIndex, NodeIndex, NodeIndex),
}

impl Node {
    // inlined even with little optimisation: most of the time of a search is spent here
    #[inline(always)]
    pub(super) fn evaluate<S: Scalar>(&self, parameters: &[S], earlier: &[S]) -> S {
        match *self {
            Node::Parameter(index) => parameters.get(index).copied().unwrap_or(S::from(f64::NAN)),
            Node::Constant(value) => S::from(value),
            Node::Unary(operation, x) => operation.apply(earlier[x]),
            Node::Binary(operation, x, y) => operation.apply(earlier[x], earlier[y]),
            Node::Select(x, y, if_less, otherwise) => {
                S::select(earlier[x].less_than(earlier[y]), earlier[if_less], earlier[otherwise])
            }
        }
    }
}

impl Node {
    /// Earlier nodes from which this one is computed.
    pub(super) fn operands(&self) -> [Option<NodeIndex>; 4] {
        match *self {
            Node::Parameter(_) | Node::Constant(_) => [None; 4],
            Node::Unary(_, x) => [Some(x), None, None, None],
            Node::Binary(_, x, y) => [Some(x), Some(y), None, None],
            Node::Select(x, y, if_less, otherwise) => [x, y, if_less, otherwise].map(Some),
        }
    }

    /// The operation with its operands moved to `places`.
    pub(super) fn moved(&self, places: &[NodeIndex]) -> Node {
        match *self {
            Node::Parameter(_) | Node::Constant(_) => *self,
            Node::Unary(operation, x) => Node::Unary(operation, places[x]),
            Node::Binary(operation, x, y) => Node::Binary(operation, places[x], places[y]),
            Node::Select(x, y, if_less, otherwise) => {
                Node::Select(places[x], places[y], places[if_less], places[otherwise])
            }
        }
    }
}

impl Unary {
    #[inline(always)]
    pub(super) fn apply<S: Scalar>(self, x: S) -> S {
        match self {
            Unary::Negate => -x,
            Unary::SquareRoot => x.sqrt(),
            Unary::Exponential => x.exp(),
            Unary::Logarithm => x.ln(),
            Unary::Magnitude => x.abs(),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Unary::Negate => "-",
            Unary::SquareRoot => "sqrt",
            Unary::Exponential => "exp",
            Unary::Logarithm => "ln",
            Unary::Magnitude => "abs",
        }
    }
}

impl Binary {
    #[inline(always)]
    pub(super) fn apply<S: Scalar>(self, x: S, y: S) -> S {
        match self {
            Binary::Add => x + y,
            Binary::Subtract => x - y,
            Binary::Multiply => x * y,
            Binary::Divide => x / y,
        }
    }

    /// Sign between the operands, precedence of the operation, and the precedence that its right
    /// operand must exceed.
    fn sign(self) -> (&'static str, u8, u8) {
        match self {
            Binary::Add => (" + ", 1, 0),
            Binary::Subtract => (" - ", 1, 1),
            Binary::Multiply => ("*", 2, 1),
            Binary::Divide => ("/", 2, 2),
        }
    }
}

/// Formula of one node, with the fewest parentheses that preserve its meaning.
pub(super) fn text(nodes: &[Node], parameters: &[String], index: NodeIndex) -> String {
    strength_and_text(nodes, parameters, index).1
}

fn strength_and_text(nodes: &[Node], parameters: &[String], index: NodeIndex) -> (u8, String) {
    const ATOM: u8 = 4;
    let part = |index: NodeIndex| strength_and_text(nodes, parameters, index);
    let enclosed = |(strength, text): (u8, String), least: u8| {
        if strength > least { text } else { format!("({text})") }
    };
    match nodes[index] {
        Node::Parameter(parameter) => (ATOM, parameters[parameter].clone()),
        Node::Constant(value) => (if value < 0.0 { 0 } else { ATOM }, format!("{value}")),
        Node::Unary(Unary::Negate, x) => (0, format!("-{}", enclosed(part(x), 1))),
        Node::Unary(operation, x) => (ATOM, format!("{}({})", operation.name(), part(x).1)),
        Node::Binary(operation, x, y) => {
            let (sign, strength, right_least) = operation.sign();
            (strength, format!("{}{sign}{}", enclosed(part(x), strength - 1), enclosed(part(y), right_least)))
        }
        Node::Select(x, y, if_less, otherwise) => {
            let parts = [x, y, if_less, otherwise].map(|index| part(index).1);
            (ATOM, format!("if({} < {}, {}, {})", parts[0], parts[1], parts[2], parts[3]))
        }
    }
}
