//! Flow through a sharp edge.

use phea_dynamics::scalar::Scalar;

/// Square root of a pressure drop with its sign, smooth at zero, Pa^0.5.
///
/// ```text
/// root(dp) = dp / (dp^2 + dp_t^2)^(1/4)  ->  sign(dp) sqrt|dp|  for |dp| >> dp_t
/// ```
///
/// Value and slope are continuous at zero drop, where the slope is 1/sqrt(dp_t). At ten times the
/// transition pressure dp_t the square root is reached to 0.25 %. With dp_t = 0 the slope at zero
/// drop does not exist.
///
/// # Example
/// ```
/// use phea_dynamics::scalar::Dual;
/// use phea_hydraulics::orifice::regular_root;
/// assert!((regular_root(4e6, 1e3) - 2e3_f64).abs() < 1e-4);
/// assert_eq!(regular_root(-4e6, 1e3), -regular_root(4e6, 1e3));
/// let at_zero = regular_root(Dual::<1>::variable(0.0, 0), Dual::constant(100.0));
/// assert_eq!((at_zero.value(), at_zero.gradient()[0]), (0.0, 0.1));
/// ```
#[inline(always)]
pub fn regular_root<S: Scalar>(drop: S, transition_pressure: S) -> S {
    drop / (drop.squared() + transition_pressure.squared()).sqrt().sqrt()
}

/// Slope of [`regular_root`] over the drop, Pa^-0.5.
///
/// ```text
/// d root/d(dp) = (dp^2/2 + dp_t^2) / (dp^2 + dp_t^2)^(5/4)
/// ```
///
/// # Example
/// ```
/// use phea_dynamics::scalar::Dual;
/// use phea_hydraulics::orifice::{regular_root, regular_root_slope};
/// let root = regular_root(Dual::<1>::variable(700.0, 0), Dual::constant(1e3));
/// assert!((root.gradient()[0] / regular_root_slope(700.0, 1e3) - 1.0).abs() < 1e-14);
/// ```
pub fn regular_root_slope<S: Scalar>(drop: S, transition_pressure: S) -> S {
    let drop_squared = drop.squared();
    let transition_squared = transition_pressure.squared();
    let square = drop_squared + transition_squared;
    (drop_squared / S::from(2.0) + transition_squared) / (square * square.sqrt().sqrt())
}

/// Flow through a sharp edge, laminar below the transition pressure, m3/s; positive along a
/// positive drop.
///
/// ```text
/// q = K sign(dp) sqrt|dp|                                              the edges of thesis (4.2) to (4.9)
/// ```
///
/// K in m3/(s Pa^0.5), the drop in Pa. A rigid edge, no cavitation.
///
/// # Example
/// Four times the drop gives twice the flow:
/// ```
/// use phea_hydraulics::orifice::flow;
/// let ratio: f64 = flow(3e-7, 4e6, 1e3) / flow(3e-7, 1e6, 1e3);
/// assert!((ratio - 2.0).abs() < 1e-6);
/// ```
#[inline(always)]
pub fn flow<S: Scalar>(coefficient: S, drop: S, transition_pressure: S) -> S {
    coefficient * regular_root(drop, transition_pressure)
}
