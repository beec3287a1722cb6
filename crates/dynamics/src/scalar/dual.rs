use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Scalar;
use crate::portable;

/// A number and its gradient with respect to N variables: exact first derivatives of a model equation.
///
/// ```text
/// (u, u') (v, v') = (u v, u' v + u v')                  forward-mode differentiation
/// ```
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
pub struct Dual<const N: usize> {
    value: f64,
    gradient: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A number that depends on no variable.
    pub fn constant(value: f64) -> Self {
        Dual { value, gradient: [0.0; N] }
    }

    /// The variable with this index, at this value. An index of N or more belongs to no variable: a constant.
    pub fn variable(value: f64, index: usize) -> Self {
        let mut gradient = [0.0; N];
        if let Some(slot) = gradient.get_mut(index) {
            *slot = 1.0;
        }
        Dual { value, gradient }
    }

    /// The value.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The partial derivatives, one a variable.
    pub fn gradient(&self) -> &[f64; N] {
        &self.gradient
    }

    /// f(u), given f(u) and f'(u) as numbers.
    fn chain(self, value: f64, slope: f64) -> Self {
        Dual { value, gradient: self.gradient.map(|g| slope * g) }
    }

    /// f(u, v), given its value and its two partial derivatives.
    fn chain_two(self, other: Self, value: f64, slope: f64, other_slope: f64) -> Self {
        let mut gradient = [0.0; N];
        for ((g, a), b) in gradient.iter_mut().zip(self.gradient).zip(other.gradient) {
            *g = slope * a + other_slope * b;
        }
        Dual { value, gradient }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    fn from(value: f64) -> Self {
        Dual::constant(value)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.chain_two(other, self.value + other.value, 1.0, 1.0)
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.chain_two(other, self.value - other.value, 1.0, -1.0)
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.chain_two(other, self.value * other.value, other.value, self.value)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.chain_two(other, quotient, 1.0 / other.value, -quotient / other.value)
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> Scalar for Dual<N> {
    type Mask = bool;

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    fn exp(self) -> Self {
        let value = portable::exp(self.value);
        self.chain(value, value)
    }
    fn ln(self) -> Self {
        self.chain(portable::ln(self.value), 1.0 / self.value)
    }
    fn abs(self) -> Self {
        let slope = if self.value == 0.0 { 0.0 } else { self.value.signum() };
        self.chain(self.value.abs(), slope)
    }
    fn less_than(self, other: Self) -> bool {
        self.value < other.value
    }
    fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
        if mask { if_true } else { if_false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation against a central difference of the same text evaluated with plain numbers.
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
