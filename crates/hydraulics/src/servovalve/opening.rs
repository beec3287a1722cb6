//! Opening of the edges by the spool.

use phea_dynamics::scalar::Scalar;

use super::{Edges, Servovalve, SpoolDirection, hyperbolic_secant};
use crate::parameter::{ParameterRequirement, Problems};

/// Dependence of an edge's area on the spool position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OpeningLaw<S = f64> {
    /// Proportional from null.
    ///
    /// ```text
    /// u+ = (|u| + u)/2        u- = (|u| - u)/2                            thesis (4.2) to (4.9)
    /// ```
    #[default]
    Proportional,
    /// Opening from the end of the lap, with decreasing slope.
    Shaped(OpeningShape<S>),
}

/// Lap and saturation of the edges.
///
/// ```text
/// s+ = u - l+            s- = -u - l-                      the travel of an edge beyond its lap
/// a  = (s + sqrt(s^2 + (r l)^2))/2,    r = 1/500           the edge is rounded over a fraction of its lap
/// u+ = a/(1 + c a)                                         c the saturation
/// ```
///
/// All are relative to the travel at the nominal voltage. An overlap is a positive lap: the spool
/// travels this far before an edge opens. An underlap is a negative lap: the edge is open at null.
/// The flow coefficients are those of an edge that has just opened, da/du = 1; without lap and
/// saturation the law is that of [`OpeningLaw::Proportional`].
///
/// # Example
/// Half-way open, an overlap of 1 % is missing; a saturation of 0.5 passes two thirds at full
/// travel:
/// ```
/// use phea_hydraulics::reference_rig::valve;
/// use phea_hydraulics::servovalve::{OpeningLaw, OpeningShape, Openings, Servovalve};
/// let of = |lap, saturation, spool| {
///     let shape = OpeningShape { lap_positive: lap, lap_negative: 0.0, saturation };
///     Openings::at(&Servovalve { opening: OpeningLaw::Shaped(shape), ..valve() }, spool).forward
/// };
/// assert!((of(0.01, 0.0, 5.0) - 0.49_f64).abs() < 1e-6);
/// assert!((of(0.0, 0.5, 10.0) - 1.0 / 1.5).abs() < 1e-12);
/// assert_eq!(of(0.0, 0.0, -3.0), 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OpeningShape<S = f64> {
    /// Lap l+ of edges 3 and 6, which a positive command opens.
    pub lap_positive: S,
    /// Lap l- of edges 4 and 5, which a negative command opens.
    pub lap_negative: S,
    /// Saturation c.
    pub saturation: S,
}

phea_dynamics::parameters! { OpeningLaw = OpeningLaw::Proportional | OpeningLaw::Shaped(shape) }

phea_dynamics::parameters! { OpeningShape { lap_positive, lap_negative, saturation } }

/// Decay of the leakage around null: lambda of sech(lambda U/U_n); the larger, the narrower; 0
/// gives constant leakage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LeakageShape<S = f64> {
    /// Common to all edges.
    Common(S),
    /// Separate for each edge; with [`super::LeakageModel::EachEdge`] only.
    ByEdge(Edges<S>),
}

phea_dynamics::parameters! { LeakageShape = LeakageShape::Common(shape) | LeakageShape::ByEdge(shapes) }

impl<S: Scalar> LeakageShape<S> {
    /// Values of lambda for each edge.
    pub fn edges(&self) -> Edges<S> {
        self.of_each(|shape| shape)
    }

    /// Least lambda, that of the edge whose leakage extends furthest from null.
    pub fn widest(&self) -> S {
        let [first, others @ ..] = self.edges().to_array();
        others.into_iter().fold(first, S::minimum)
    }

    /// Function of the lambda of each edge, computed once if all are equal.
    #[inline(always)]
    fn of_each(&self, of: impl Fn(S) -> S) -> Edges<S> {
        match self {
            LeakageShape::Common(shape) => Edges::equal(of(*shape)),
            LeakageShape::ByEdge(shapes) => Edges::from_array(shapes.to_array().map(of)),
        }
    }
}

/// Fraction of its lap over which an edge is rounded: the law has a slope everywhere, and differs
/// from a sharp edge by a thousandth of the lap at most.
const ROUNDED: f64 = 0.002;

/// Square of a negligible travel: separates the root of a sharp edge from zero.
const NO_TRAVEL: f64 = 1e-60;

/// Relative openings of the edges by the spool, and the remaining relative leakage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Openings<S> {
    /// Opening of edges 3 and 6, supply to A and B to tank, for U > 0.
    pub forward: S,
    /// Opening of edges 4 and 5, A to tank and supply to B, for U < 0.
    pub backward: S,
    /// Leakage of each edge relative to that at null: sech(lambda U/U_n).
    pub leakage: Edges<S>,
}

impl<S: Scalar> Openings<S> {
    /// Openings at spool position U_Csp in V.
    ///
    /// The openings follow [`OpeningLaw`]. The positive part is (U + |U|)/2 and the negative (|U| -
    /// U)/2, so that a derivative taken exactly at U = 0 is the mean of the two one-sided ones.
    #[inline(always)]
    pub fn at(valve: &Servovalve<S>, spool: S) -> Openings<S> {
        let relative = spool / valve.nominal_voltage;
        let leakage = valve.leakage_shape.of_each(|shape| hyperbolic_secant(shape * relative));
        match valve.opening {
            OpeningLaw::Proportional => {
                let half = S::from(0.5);
                Openings {
                    forward: half * (relative.abs() + relative),
                    backward: half * (relative.abs() - relative),
                    leakage,
                }
            }
            OpeningLaw::Shaped(shape) => Openings {
                forward: shape.opening(relative, shape.lap_positive),
                backward: shape.opening(-relative, shape.lap_negative),
                leakage,
            },
        }
    }

    /// Derivatives d/dU of the openings and of the relative leakage, 1/V. `direction` selects the
    /// side if an edge is exactly at its sharp end.
    pub(super) fn slopes(valve: &Servovalve<S>, spool: S, direction: SpoolDirection<S>) -> Openings<S> {
        let one = S::from(1.0);
        let zero = S::from(0.0);
        let [forward, backward] = match valve.opening {
            OpeningLaw::Proportional => {
                let backward_or_null = S::select(spool.less_than(zero), -one, direction.side());
                let sign = S::select(zero.less_than(spool), one, backward_or_null);
                let half = S::from(0.5);
                [half * (one + sign), half * (one - sign)]
            }
            OpeningLaw::Shaped(shape) => {
                let relative = spool / valve.nominal_voltage;
                let side = direction.side();
                [
                    shape.slope(relative, shape.lap_positive, side),
                    shape.slope(-relative, shape.lap_negative, -side),
                ]
            }
        };
        let falling = |shape: S| {
            let argument = shape * spool / valve.nominal_voltage;
            let decay = (S::from(-2.0) * argument.abs()).exp();
            let side = S::select(argument.less_than(zero), -one, one);
            let tangent = side * (one - decay) / (one + decay);
            let leakage = hyperbolic_secant(shape * (spool / valve.nominal_voltage));
            -shape / valve.nominal_voltage * leakage * tangent
        };
        Openings {
            forward: forward / valve.nominal_voltage,
            backward: -backward / valve.nominal_voltage,
            leakage: valve.leakage_shape.of_each(falling),
        }
    }
}

impl<S: Scalar> OpeningLaw<S> {
    /// Relative openings at full travel, of the edges opened by a positive and by a negative
    /// command: one without lap and saturation.
    pub fn full(&self) -> [S; 2] {
        match self {
            OpeningLaw::Proportional => [S::from(1.0); 2],
            OpeningLaw::Shaped(shape) => {
                [shape.lap_positive, shape.lap_negative].map(|lap| shape.opening(S::from(1.0), lap))
            }
        }
    }
}

impl<S: Scalar> OpeningShape<S> {
    /// Relative opening of an edge with this lap, at this travel of the spool to its side.
    #[inline(always)]
    fn opening(&self, travel: S, lap: S) -> S {
        let [area, _] = rounded(travel, lap);
        area / (S::from(1.0) + self.saturation * area)
    }

    /// Slope of the opening over the relative travel; `side` is -1 to 1 if the edge is exactly at
    /// its sharp end.
    fn slope(&self, travel: S, lap: S, side: S) -> S {
        let [area, apart] = rounded(travel, lap);
        let beyond = travel - lap;
        let is_at_end = apart.squared().less_than(S::from(2.0 * NO_TRAVEL));
        let tangent = S::select(is_at_end, side, beyond / apart);
        let passed = S::from(1.0) + self.saturation * area;
        S::from(0.5) * (S::from(1.0) + tangent) / passed.squared()
    }
}

impl OpeningShape {
    /// True if a lap is not less than the full travel of the spool.
    pub(super) fn exceeds_travel(lap: f64) -> bool {
        lap.abs() >= 1.0
    }

    pub(super) fn check(&self, problems: &mut Problems) {
        let OpeningShape { lap_positive, lap_negative, saturation } = *self;
        for (name, lap) in [("lap.positive", lap_positive), ("lap.negative", lap_negative)] {
            problems.require(name, lap, !Self::exceeds_travel(lap), ParameterRequirement::WithinTravel);
        }
        problems.key(super::keys::SATURATION_KEY, saturation);
    }
}

/// Area of a rounded edge over the relative travel, and sqrt(s^2 + (r l)^2).
#[inline(always)]
fn rounded<S: Scalar>(travel: S, lap: S) -> [S; 2] {
    let beyond = travel - lap;
    let radius = lap.times(ROUNDED);
    let apart = (beyond.squared() + radius.squared()).maximum(S::from(NO_TRAVEL)).sqrt();
    [S::from(0.5) * (beyond + apart), apart]
}
