//! A controller with free numbers.

use phea_dynamics::controller::Element;

/// One factor of a structure. Every free number has its least and greatest value; frequencies in rad/s.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// An element without free numbers, such as an integrator.
    Fixed(Element),
    /// s/z + 1
    RealZero {
        /// z
        frequency: [f64; 2],
    },
    /// 1/(s/p + 1)
    RealPole {
        /// p
        frequency: [f64; 2],
    },
    /// s^2/w^2 + 2 zeta s/w + 1; two real zeros where zeta is 1 or more
    ZeroPair {
        /// w
        natural_frequency: [f64; 2],
        /// zeta
        damping_ratio: [f64; 2],
    },
    /// 1/(s^2/w^2 + 2 zeta s/w + 1); two real poles where zeta is 1 or more
    PolePair {
        /// w
        natural_frequency: [f64; 2],
        /// zeta
        damping_ratio: [f64; 2],
    },
}

/// A controller with free numbers: a gain of known sign and factors in series.
///
/// ```text
/// G(s; x) = sign k part_1(s) part_2(s) ...,      x = (ln k, ln of each free number in turn)
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Sign of the gain: 1 or -1.
    pub sign: f64,
    /// Least and greatest magnitude of the gain k.
    pub gain: [f64; 2],
    /// The factors.
    pub parts: Vec<Part>,
}
