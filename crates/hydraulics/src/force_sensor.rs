//! Force sensor: a stiff spring between rod and load, whose deflection is the measurement.

mod keys;

pub use keys::DeclaredForceSensor;

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, Problems};

/// Load cell, in series with its foundation if the load is a prescribed motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSensor<S = f64> {
    /// Stiffness K_S, N/m.
    pub stiffness: S,
}

impl ForceSensor {
    /// Impossible parameters of this sensor; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(keys::STIFFNESS_KEY, self.stiffness);
        problems.into_vec()
    }
}

/// Force on the load for a deflection x_p - x_L in m, positive when the rod pushes, N.
///
/// ```text
/// F_e = K_S (x_p - x_L)
/// ```
#[inline(always)]
pub fn force<S: Scalar>(stiffness: S, deflection: S) -> S {
    stiffness * deflection
}

/// Stiffness of two springs in series, N/m.
///
/// ```text
/// K = K_1 K_2/(K_1 + K_2)                     K_eq of thesis (6.12) is that of K_H and K_S
/// ```
///
/// # Example
/// A load cell of 9.81e7 N/m (1 t per 0.1 mm) on an environment of 2.51e7 N/m:
/// ```
/// use phea_hydraulics::force_sensor::in_series;
/// assert!((in_series(9.81e7, 2.51e7) - 2.0e7_f64).abs() < 0.5e5);
/// ```
/// In series with a rigid spring, the stiffness of the other remains:
/// ```
/// assert_eq!(phea_hydraulics::force_sensor::in_series(f64::INFINITY, 2.0e7), 2.0e7);
/// ```
pub fn in_series<S: Scalar>(first: S, second: S) -> S {
    let one = S::from(1.0);
    one / (one / first + one / second)
}
