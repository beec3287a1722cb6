use std::ops::{Add, Div, Mul, Neg, Sub};

use num_complex::Complex64;

use super::{Analytic, Disc};

/// Value of a function over a set of arguments, and its derivative over that set.
///
/// # Example
/// Over a short interval the excess of the disc shrinks with the square of the interval's length.
/// ```
/// use phea_dynamics::analytic::{Analytic, Disc, Jet};
/// let square_less_itself = |s: Jet| s * s - s;
/// let stretch = Disc::of_frequencies([1.0, 1.01]);
/// let plain = stretch * stretch - stretch;
/// let tight = Jet::enclosed(stretch, square_less_itself);
/// assert!(tight.radius() < 0.8 * plain.radius());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    value: Disc,
    slope: Disc,
}

impl Jet {
    /// A disc that contains the image of a disc under a function, by the mean value theorem.
    ///
    /// ```text
    /// f(D) in f(c) + f'(D) (D - c)
    /// ```
    pub fn enclosed<F: Fn(Jet) -> Jet>(set: Disc, function: F) -> Disc {
        let slope = function(Jet { value: set, slope: Disc::from(1.0) }).slope;
        let centre = Disc::from(set.centre());
        function(Jet { value: centre, slope: Disc::from(0.0) }).value + slope * (set - centre)
    }
}

impl From<f64> for Jet {
    fn from(value: f64) -> Jet {
        Jet { value: value.into(), slope: Disc::from(0.0) }
    }
}

impl From<Complex64> for Jet {
    fn from(value: Complex64) -> Jet {
        Jet { value: value.into(), slope: Disc::from(0.0) }
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, other: Jet) -> Jet {
        Jet { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet { value: -self.value, slope: -self.slope }
    }
}

impl Mul for Jet {
    type Output = Jet;
    fn mul(self, other: Jet) -> Jet {
        Jet { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl Div for Jet {
    type Output = Jet;
    fn div(self, other: Jet) -> Jet {
        let value = self.value / other.value;
        Jet { value, slope: (self.slope - value * other.slope) / other.value }
    }
}

impl Analytic for Jet {
    fn scaled(self, factor: f64) -> Jet {
        Jet { value: self.value.scaled(factor), slope: self.slope.scaled(factor) }
    }

    fn exponential(self) -> Jet {
        let value = self.value.exponential();
        Jet { value, slope: value * self.slope }
    }

    /// ```text
    /// m(z) = (1 - e^(-z))/z,     m' = (e^(-z) - m)/z
    /// ```
    fn mean_of_decay(self) -> Jet {
        let value = self.value.mean_of_decay();
        let slope = self.value.slope_of_mean_of_decay(value);
        Jet { value, slope: slope * self.slope }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::portable;

    fn function<A: Analytic>(s: A) -> A {
        let delayed = (-s.scaled(0.3)).exponential();
        (s * s + A::from(4.0)).scaled(0.5) * delayed / (s + A::from(1.0)) - s.scaled(0.7).mean_of_decay()
    }

    /// The enclosure contains the function at every point, and its excess falls by a factor of a
    /// hundred over an interval ten times shorter.
    #[test]
    fn enclosures_hold_and_shrink_by_the_square() {
        for middle in [0.0, 0.2, 1.0, 5.0, 40.0] {
            let mut excess = Vec::new();
            for length in [1e-2, 1e-3] {
                let set = Disc::of_frequencies([middle, middle + length]);
                let held = Jet::enclosed(set, function);
                let ends = [0.0, 0.3, 0.7, 1.0].map(|fraction| {
                    let at = function(Complex64::new(0.0, middle + fraction * length));
                    assert!(held.contains(at), "{middle} {length}");
                    at
                });
                excess.push(held.radius() - 0.5 * portable::magnitude(ends[3] - ends[0]));
            }
            assert!(excess[1] < 0.02 * excess[0] + 1e-13, "{middle} {excess:?}");
        }
    }
}
