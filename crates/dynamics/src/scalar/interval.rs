use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Scalar;
use crate::portable;

/// All numbers between two ends: an equation evaluated with it encloses every value that it has
/// while its variables vary over their intervals.
///
/// Ends are rounded outwards, unless the result is exact. An operation that is not defined
/// everywhere (a quotient by an interval that contains zero, the logarithm of one that extends
/// below) gives the whole axis. A choice that is not decided takes both sides.
///
/// # Example
/// ```
/// use phea_dynamics::scalar::{Interval, Scalar};
/// let x = Interval::new(-1.0, 2.0);
/// let result = x * Interval::from(3.0) + x.abs();
/// assert_eq!((result.low(), result.high()), (-3.0, 8.0));
/// let third = Interval::from(1.0) / Interval::from(3.0);
/// assert!(third.low() < third.high() && third.high() - third.low() < 1e-15);
/// assert_eq!(Interval::from(1.0) / x, Interval::WHOLE);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    /// The whole axis.
    pub const WHOLE: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// Interval between two ends in either order; the whole axis if one is NaN.
    pub fn new(one: f64, other: f64) -> Interval {
        if one.is_nan() || other.is_nan() {
            return Interval::WHOLE;
        }
        Interval { low: one.min(other), high: one.max(other) }
    }

    /// Lower end.
    pub fn low(self) -> f64 {
        self.low
    }

    /// Upper end.
    pub fn high(self) -> f64 {
        self.high
    }

    /// True if it contains negative and positive numbers.
    pub fn has_both_signs(self) -> bool {
        self.low < 0.0 && self.high > 0.0
    }

    /// Square, which is not negative; a product of the interval with itself would treat the factors
    /// as independent.
    pub fn square(self) -> Interval {
        let square = self * self;
        let least = if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { square.low.max(0.0) };
        Interval { low: least, ..square }
    }

    /// Minimum of one number from each interval; if the choice is not decided, tighter than both
    /// sides.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::scalar::Interval;
    /// let limit = Interval::from(2.0);
    /// let bounded = Interval::WHOLE.least(limit).greatest(Interval::from(1.0));
    /// assert_eq!((bounded.low(), bounded.high()), (1.0, 2.0));
    /// ```
    pub fn least(self, other: Interval) -> Interval {
        Interval { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    /// Maximum of one number from each interval.
    pub fn greatest(self, other: Interval) -> Interval {
        Interval { low: self.low.max(other.low), high: self.high.max(other.high) }
    }

    fn hull(self, other: Interval) -> Interval {
        Interval::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// Both ends of an increasing function that is accurate to two units in the last place.
    fn increasing(self, function: fn(f64) -> f64) -> Interval {
        let (low, high) = (function(self.low), function(self.high));
        Interval::new(low.next_down().next_down(), high.next_up().next_up())
    }
}

/// End of an interval, with its rounding: the exact value is less or more.
#[derive(Clone, Copy)]
struct Rounded {
    value: f64,
    error: f64,
}

impl Rounded {
    #[inline]
    fn down(self) -> f64 {
        if self.error >= 0.0 { self.value } else { self.value.next_down() }
    }

    #[inline]
    fn up(self) -> f64 {
        if self.error <= 0.0 { self.value } else { self.value.next_up() }
    }
}

#[inline]
fn sum(a: f64, b: f64) -> Rounded {
    let value = a + b;
    let part = value - a;
    Rounded { value, error: (a - (value - part)) + (b - part) }
}

#[inline]
fn product(a: f64, b: f64) -> [Rounded; 2] {
    if a == 0.0 || b == 0.0 {
        return [Rounded { value: 0.0, error: 0.0 }; 2];
    }
    let value = a * b;
    let error = a.mul_add(b, -value);
    // near the least numbers the error underflows as well
    if value.abs() < 16.0 * f64::MIN_POSITIVE / f64::EPSILON {
        return [Rounded { value, error: -1.0 }, Rounded { value, error: 1.0 }];
    }
    [Rounded { value, error }; 2]
}

/// Side of zero on which an interval is.
#[derive(Clone, Copy)]
enum SideOfZero {
    Positive,
    Negative,
    Both,
}

impl SideOfZero {
    #[inline]
    fn of(interval: Interval) -> SideOfZero {
        match (interval.low >= 0.0, interval.high <= 0.0) {
            (true, _) => SideOfZero::Positive,
            (_, true) => SideOfZero::Negative,
            _ => SideOfZero::Both,
        }
    }
}

impl From<f64> for Interval {
    #[inline]
    fn from(value: f64) -> Self {
        Interval::new(value, value)
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let (low, high) = (sum(self.low, other.low).down(), sum(self.high, other.high).up());
        if low.is_nan() || high.is_nan() { Interval::WHOLE } else { Interval { low, high } }
    }
}

impl Neg for Interval {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Interval { low: -self.high, high: -self.low }
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for Interval {
    type Output = Self;
    /// Each end is a product of two ends, selected by the signs of both factors.
    #[inline]
    fn mul(self, other: Self) -> Self {
        let of = |(low, high): ((f64, f64), (f64, f64))| Interval {
            low: product(low.0, low.1)[0].down(),
            high: product(high.0, high.1)[1].up(),
        };
        let (a, b, c, d) = (self.low, self.high, other.low, other.high);
        match (SideOfZero::of(self), SideOfZero::of(other)) {
            (SideOfZero::Positive, SideOfZero::Positive) => of(((a, c), (b, d))),
            (SideOfZero::Positive, SideOfZero::Negative) => of(((b, c), (a, d))),
            (SideOfZero::Positive, SideOfZero::Both) => of(((b, c), (b, d))),
            (SideOfZero::Negative, SideOfZero::Positive) => of(((a, d), (b, c))),
            (SideOfZero::Negative, SideOfZero::Negative) => of(((b, d), (a, c))),
            (SideOfZero::Negative, SideOfZero::Both) => of(((a, d), (a, c))),
            (SideOfZero::Both, SideOfZero::Positive) => of(((a, d), (b, d))),
            (SideOfZero::Both, SideOfZero::Negative) => of(((b, c), (a, c))),
            (SideOfZero::Both, SideOfZero::Both) => {
                let (one, other) = (of(((a, d), (a, c))), of(((b, c), (b, d))));
                Interval { low: one.low.min(other.low), high: one.high.max(other.high) }
            }
        }
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.low <= 0.0 && other.high >= 0.0 {
            return Interval::WHOLE;
        }
        let ends =
            [(self.low, other.low), (self.low, other.high), (self.high, other.low), (self.high, other.high)];
        let quotients = ends.map(|(a, b)| a / b);
        if quotients.iter().any(|quotient| quotient.is_nan()) {
            return Interval::WHOLE;
        }
        let exact = |quotient: f64| quotient == 0.0 && self.low == 0.0 && self.high == 0.0;
        let low = quotients.iter().copied().fold(f64::INFINITY, f64::min);
        let high = quotients.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // if the signs of both are known, zero is an end even if a product underflows
        let (positive, negative) = (other.low > 0.0, other.high < 0.0);
        let not_below = positive && self.low >= 0.0 || negative && self.high <= 0.0;
        let not_above = positive && self.high <= 0.0 || negative && self.low >= 0.0;
        Interval::new(
            if exact(low) || low == 0.0 && not_below { low } else { low.next_down() },
            if exact(high) || high == 0.0 && not_above { high } else { high.next_up() },
        )
    }
}

impl Scalar for Interval {
    /// Result of a comparison; `None` if it holds for only some of the numbers.
    type Mask = Option<bool>;

    #[inline]
    fn times(self, factor: f64) -> Self {
        let ends = [product(self.low, factor), product(self.high, factor)];
        if ends.iter().flatten().any(|end| end.value.is_nan()) {
            return Interval::WHOLE;
        }
        let [[one_down, one_up], [other_down, other_up]] = ends;
        let (low, high) = if factor >= 0.0 { (one_down, other_up) } else { (other_down, one_up) };
        Interval { low: low.down(), high: high.up() }
    }

    fn sqrt(self) -> Self {
        if self.low < 0.0 {
            return Interval::WHOLE;
        }
        let root = self.increasing(f64::sqrt);
        Interval { low: if self.low == 0.0 { 0.0 } else { root.low }, ..root }
    }
    fn exp(self) -> Self {
        let power = self.increasing(portable::exp);
        Interval { low: power.low.max(0.0), ..power }
    }
    fn ln(self) -> Self {
        if self.low <= 0.0 { Interval::WHOLE } else { self.increasing(portable::ln) }
    }
    fn abs(self) -> Self {
        if self.has_both_signs() {
            return Interval { low: 0.0, high: self.high.max(-self.low) };
        }
        Interval::new(self.low.abs(), self.high.abs())
    }
    fn less_than(self, other: Self) -> Option<bool> {
        match (self.high < other.low, self.low >= other.high) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => None,
        }
    }
    fn select(mask: Option<bool>, if_true: Self, if_false: Self) -> Self {
        match mask {
            Some(true) => if_true,
            Some(false) => if_false,
            None => if_true.hull(if_false),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An equation with every operation, at points inside an interval.
    fn equation<S: Scalar>(x: S) -> S {
        let inner = (x * x + S::from(0.3)).sqrt() - x.abs().times(0.1);
        let choice = S::select(x.less_than(S::from(0.2)), (-x).exp(), inner / (x + S::from(3.0)));
        choice + (inner + S::from(2.0)).ln()
    }

    #[test]
    fn every_value_is_enclosed() {
        for step in 0..40 {
            let low = -1.0 + 0.05 * f64::from(step);
            for width in [0.0, 1e-3, 0.1, 0.7] {
                let enclosed = equation(Interval::new(low, low + width));
                for part in 0..=20 {
                    let value = equation(low + width * f64::from(part) / 20.0);
                    assert!(enclosed.low() <= value && value <= enclosed.high(), "{low} {width}");
                }
                assert!(width > 0.0 || enclosed.high() - enclosed.low() < 1e-14);
            }
        }
    }

    /// Least and greatest of the four products of ends, for any signs.
    fn product_of_all_ends(one: Interval, other: Interval) -> Interval {
        let products = [one.low, one.high].map(|a| [other.low, other.high].map(|b| product(a, b)));
        let products = products.as_flattened();
        let low = products.iter().map(|[product, _]| product.down()).fold(f64::INFINITY, f64::min);
        let high = products.iter().map(|[_, product]| product.up()).fold(f64::NEG_INFINITY, f64::max);
        Interval { low, high }
    }

    #[test]
    fn a_product_has_the_ends_of_all_products_of_ends() {
        let tiny = f64::MIN_POSITIVE;
        let sizes = [0.0, 5e-324, tiny, 1e-160, 0.1, 1.0 / 3.0, 7.0, 1e160, f64::MAX, f64::INFINITY];
        let ends: Vec<f64> = sizes.iter().flat_map(|size| [-size, *size]).collect();
        let pairs = || ends.iter().flat_map(|low| ends.iter().map(|high| Interval::new(*low, *high)));
        for one in pairs() {
            for other in pairs() {
                let (product, reference) = (one * other, product_of_all_ends(one, other));
                let same = (product.low, product.high) == (reference.low, reference.high);
                // a product that underflows is rounded both ways; zero as an end stays one
                let underflows = [reference.low, reference.high]
                    .iter()
                    .any(|end| (f64::from_bits(1)..1e-290).contains(&end.abs()));
                let inside = product.low >= reference.low && product.high <= reference.high;
                assert!(same || underflows && inside, "{one:?} {other:?}: {product:?} {reference:?}");
            }
        }
    }

    #[test]
    fn exact_results_stay_exact_and_zero_stays_an_end() {
        let x = Interval::new(0.0, 0.3);
        assert_eq!((x * Interval::from(0.1)).low(), 0.0);
        assert_eq!((x / Interval::from(0.1)).low(), 0.0);
        assert_eq!(Interval::new(-0.3, 0.1).square().low(), 0.0);
        let underflows = Interval::new(0.0, 1e-320) / Interval::new(-1e10, -1e9);
        assert!(underflows.low() < 0.0 && underflows.high() == 0.0);
        assert_eq!(Interval::new(-1.0, 2.0).times(-3.0), Interval::new(-6.0, 3.0));
        assert!(x.times(0.1) == x * Interval::from(0.1) && x.times(-0.1) == x * Interval::from(-0.1));
        assert_eq!(Interval::from(0.25) + Interval::from(0.5), Interval::from(0.75));
        assert_eq!(Interval::new(1.0, 2.0) - Interval::new(f64::NAN, 0.0), Interval::WHOLE);
        // ORIGIN: analytic. The double nearest to 0.1 is more than a tenth, ten times it rounds to
        // one.
        let one = Interval::from(0.1) * Interval::from(10.0);
        assert!(one.low() == 1.0 && one.high() > 1.0);
    }
}
