use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Lanes, Scalar};

/// Set of variables on which a number depends, without its value: an equation evaluated with it
/// shows which of its derivatives can differ from zero anywhere.
///
/// Both sides of a choice count. Variables are counted from 0 to [`Dependence::CAPACITY`] - 1.
///
/// # Example
/// ```
/// use phea_dynamics::scalar::{Dependence, Scalar};
/// let [x, y, z] = [0, 1, 2].map(Dependence::on);
/// let result = Scalar::select(x.less_than(z), x * y, Dependence::from(3.0));
/// assert!(result.includes(0) && result.includes(1) && result.includes(2));
/// assert!(!(x + y).includes(2));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dependence([u64; 4]);

impl Dependence {
    /// Largest number of variables.
    pub const CAPACITY: usize = 256;

    /// The variable with this index; one of [`Dependence::CAPACITY`] or more is a constant.
    pub fn on(index: usize) -> Self {
        let mut bits = [0; 4];
        if let Some(word) = bits.get_mut(index / 64) {
            *word = 1 << (index % 64);
        }
        Dependence(bits)
    }

    /// True if the number depends on the variable with this index.
    pub fn includes(&self, index: usize) -> bool {
        self.0.get(index / 64).is_some_and(|word| word >> (index % 64) & 1 == 1)
    }

    fn with(self, other: Self) -> Self {
        let mut bits = self.0;
        for (word, more) in bits.iter_mut().zip(other.0) {
            *word |= more;
        }
        Dependence(bits)
    }
}

impl From<f64> for Dependence {
    fn from(_: f64) -> Self {
        Dependence([0; 4])
    }
}

impl From<Lanes> for Dependence {
    fn from(_: Lanes) -> Self {
        Dependence([0; 4])
    }
}

impl Add for Dependence {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other)
    }
}

impl Sub for Dependence {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(other)
    }
}

impl Mul for Dependence {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other)
    }
}

impl Div for Dependence {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.with(other)
    }
}

impl Neg for Dependence {
    type Output = Self;
    fn neg(self) -> Self {
        self
    }
}

impl Scalar for Dependence {
    type Mask = Dependence;

    fn sqrt(self) -> Self {
        self
    }
    fn exp(self) -> Self {
        self
    }
    fn ln(self) -> Self {
        self
    }
    fn abs(self) -> Self {
        self
    }
    fn less_than(self, other: Self) -> Dependence {
        self.with(other)
    }
    fn select(mask: Dependence, if_true: Self, if_false: Self) -> Self {
        mask.with(if_true).with(if_false)
    }
}
