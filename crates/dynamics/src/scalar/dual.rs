use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Lanes, LocalFunction, Scalar};

/// Number and its gradient with respect to N variables: exact first derivatives of a model
/// equation.
///
/// ```text
/// (u, u') (v, v') = (u v, u' v + u v')                  forward-mode differentiation
/// ```
///
/// The number itself may be any scalar S, so that lanes have derivatives too.
///
/// # Example
/// d(x² y)/dx = 2 x y and d(x² y)/dy = x²
/// ```
/// use phea_dynamics::scalar::{Dual, Scalar};
/// let x = Dual::<2>::variable(3.0, 0);
/// let y = Dual::<2>::variable(5.0, 1);
/// assert_eq!((x.squared() * y).gradient(), &[30.0, 9.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize, S = f64> {
    value: S,
    gradient: [S; N],
}

impl<const N: usize, S: Scalar> Dual<N, S> {
    /// A number with this gradient.
    pub fn new(value: S, gradient: [S; N]) -> Self {
        Dual { value, gradient }
    }

    /// A number that depends on no variable.
    pub fn constant(value: S) -> Self {
        Dual { value, gradient: [S::from(0.0); N] }
    }

    /// Variable with this index, at this value. An index of N or more gives a constant.
    pub fn variable(value: S, index: usize) -> Self {
        let mut gradient = [S::from(0.0); N];
        if let Some(slot) = gradient.get_mut(index) {
            *slot = S::from(1.0);
        }
        Dual { value, gradient }
    }

    /// The value.
    pub fn value(&self) -> S {
        self.value
    }

    /// Replaces the value, and keeps the derivatives.
    #[inline]
    pub(crate) fn set_value(&mut self, value: S) {
        self.value = value;
    }

    /// Partial derivatives, one for each variable.
    pub fn gradient(&self) -> &[S; N] {
        &self.gradient
    }

    /// Function f(u), given f(u) and f'(u) as numbers.
    #[inline]
    fn chain(self, value: S, slope: S) -> Self {
        let mut gradient = self.gradient;
        for g in &mut gradient {
            *g = slope * *g;
        }
        Dual { value, gradient }
    }

    /// Function f(u, v), given its value and its two partial derivatives.
    #[inline]
    fn chain_two(self, other: Self, value: S, slope: S, other_slope: S) -> Self {
        let mut gradient = self.gradient;
        for (g, b) in gradient.iter_mut().zip(other.gradient) {
            *g = slope * *g + other_slope * b;
        }
        Dual { value, gradient }
    }
}

impl<const N: usize, S: Scalar> From<f64> for Dual<N, S> {
    #[inline]
    fn from(value: f64) -> Self {
        Dual::constant(S::from(value))
    }
}

impl<const N: usize> From<Lanes> for Dual<N, Lanes> {
    #[inline]
    fn from(value: Lanes) -> Self {
        Dual::constant(value)
    }
}

impl<const N: usize, S: Scalar> Add for Dual<N, S> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let mut gradient = self.gradient;
        for (g, b) in gradient.iter_mut().zip(other.gradient) {
            *g = *g + b;
        }
        Dual { value: self.value + other.value, gradient }
    }
}

impl<const N: usize, S: Scalar> Sub for Dual<N, S> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        let mut gradient = self.gradient;
        for (g, b) in gradient.iter_mut().zip(other.gradient) {
            *g = *g - b;
        }
        Dual { value: self.value - other.value, gradient }
    }
}

impl<const N: usize, S: Scalar> Mul for Dual<N, S> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.chain_two(other, self.value * other.value, other.value, self.value)
    }
}

impl<const N: usize, S: Scalar> Div for Dual<N, S> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        let slope = S::from(1.0) / other.value;
        self.chain_two(other, quotient, slope, -quotient * slope)
    }
}

impl<const N: usize, S: Scalar> Neg for Dual<N, S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        let mut gradient = self.gradient;
        for g in &mut gradient {
            *g = -*g;
        }
        Dual { value: -self.value, gradient }
    }
}

impl<const N: usize, S: Scalar> Default for Dual<N, S> {
    fn default() -> Self {
        Dual::constant(S::default())
    }
}

impl<const N: usize, S: Scalar> Scalar for Dual<N, S> {
    type Mask = S::Mask;

    #[inline]
    fn times(self, factor: f64) -> Self {
        let mut gradient = self.gradient;
        for g in &mut gradient {
            *g = g.times(factor);
        }
        Dual { value: self.value.times(factor), gradient }
    }
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, S::from(0.5) / root)
    }
    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), S::from(1.0) / self.value)
    }
    #[inline]
    fn abs(self) -> Self {
        let zero = S::from(0.0);
        let negative = S::select(self.value.less_than(zero), S::from(-1.0), zero);
        let slope = S::select(zero.less_than(self.value), S::from(1.0), negative);
        self.chain(self.value.abs(), slope)
    }
    #[inline]
    fn less_than(self, other: Self) -> S::Mask {
        self.value.less_than(other.value)
    }
    #[inline]
    fn select(mask: S::Mask, if_true: Self, if_false: Self) -> Self {
        let mut gradient = if_true.gradient;
        for (g, b) in gradient.iter_mut().zip(if_false.gradient) {
            *g = S::select(mask, *g, b);
        }
        Dual { value: S::select(mask, if_true.value, if_false.value), gradient }
    }
    #[inline]
    fn local<P: Copy, const K: usize, const M: usize>(
        function: &impl LocalFunction<P, K, M>,
        variables: [Self; K],
    ) -> [Self; M]
    where
        Self: From<P>,
    {
        let own = std::array::from_fn(|index| Dual::<K, S>::variable(variables[index].value, index));
        let results = function.at(own, |parameter| Dual::constant(Self::from(parameter).value));
        let mut local = [Dual::constant(S::from(0.0)); M];
        for (local, result) in local.iter_mut().zip(&results) {
            local.value = result.value;
            for (variable, &slope) in variables.iter().zip(&result.gradient) {
                for (sum, &part) in local.gradient.iter_mut().zip(&variable.gradient) {
                    *sum = *sum + slope * part;
                }
            }
        }
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function evaluated on its own variables has the derivatives of its text over all
    /// variables.
    #[test]
    fn a_local_function_has_the_derivatives_of_its_text() {
        struct Text(f64);
        impl LocalFunction<f64, 2, 2> for Text {
            fn at<T: Scalar>(&self, [u, v]: [T; 2], constant: impl Fn(f64) -> T + Copy) -> [T; 2] {
                [constant(self.0) * (u * v).sqrt(), (u - v).abs() / u.exp()]
            }
        }
        let [x, y, z] = [1.7, 0.4, 2.2].map(|value| value);
        let variables = [Dual::<3>::variable(x, 0), Dual::variable(y, 1), Dual::variable(z, 2)];
        let [u, v] = [variables[0] * variables[1], variables[2] - variables[0]];
        let (local, text) = (Dual::local(&Text(3.0), [u, v]), Text(3.0).at([u, v], Dual::from));
        for (local, text) in local.iter().zip(&text) {
            assert_eq!(local.value(), text.value());
            for (one, other) in local.gradient().iter().zip(text.gradient()) {
                assert!((one - other).abs() < 1e-14 && *other != 0.0, "{one} {other}");
            }
        }
    }

    /// Every operation against a central difference of its text evaluated with plain numbers.
    #[test]
    fn derivatives_agree_with_central_differences() {
        fn equation<S: Scalar>(x: S, y: S) -> S {
            let mixed = (x * y - y / x).abs().sqrt() + (-x).exp() * y.ln();
            S::select(x.less_than(y), mixed + x.squared(), mixed - y) + x.maximum(y) * x.minimum(S::from(2.0))
        }
        for (x, y) in [(0.7, 2.5), (3.0, 1.2), (1.9, 1.8)] {
            let dual = equation(Dual::<2>::variable(x, 0), Dual::<2>::variable(y, 1));
            let h = 1e-6;
            let by_x = (equation(x + h, y) - equation(x - h, y)) / (2.0 * h);
            let by_y = (equation(x, y + h) - equation(x, y - h)) / (2.0 * h);
            assert_eq!(dual.value(), equation(x, y));
            assert!((dual.gradient()[0] - by_x).abs() < 1e-8 * by_x.abs().max(1.0));
            assert!((dual.gradient()[1] - by_y).abs() < 1e-8 * by_y.abs().max(1.0));
        }
    }
}
