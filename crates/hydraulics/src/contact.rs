//! Surface that is pressed into: an end stop, a wall.

mod keys;

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, Problems};

/// Surface that pushes back and never pulls. Units: N/m, s/m.
///
/// ```text
/// F = K d+ (1 + c d')+                    d penetration, d' its rate, + the positive part
/// ```
///
/// Source: Hunt and Crossley (1975), "Coefficient of restitution interpreted as damping in
/// vibroimpact", Journal of Applied Mechanics 42(2), with a flat contact (exponent 1). The damping
/// grows with the penetration, so that the force has no jump at touch; its coefficient of
/// restitution is 1 - 2 c v/3 for slow impacts at v. It absorbs energy in any motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact<S = f64> {
    /// Stiffness K in N/m.
    pub stiffness: S,
    /// Damping c relative to the elastic force, in s/m.
    pub relative_damping: S,
}

impl Contact {
    /// Impossible parameters of this contact; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(keys::STIFFNESS_KEY, self.stiffness);
        problems.key(keys::RELATIVE_DAMPING_KEY, self.relative_damping);
        problems.into_vec()
    }
}

phea_dynamics::parameters! { Contact { stiffness, relative_damping } }

impl<S: Scalar> Contact<S> {
    /// Force in N at a penetration in m that grows at a rate in m/s; zero without penetration.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::contact::Contact;
    /// let stop = Contact { stiffness: 1e8, relative_damping: 0.5 };
    /// assert_eq!(stop.force(-1e-6, 0.3), 0.0);
    /// assert_eq!(stop.force(0.5, 0.0), 5e7);
    /// assert!(stop.force(1e-5, 0.1) > 1e3 && stop.force(1e-5, -0.1) < 1e3);
    /// assert_eq!(stop.force(1e-5, -10.0), 0.0);
    /// ```
    #[inline(always)]
    pub fn force(&self, penetration: S, rate: S) -> S {
        let zero = S::from(0.0);
        let damping = (S::from(1.0) + self.relative_damping * rate).maximum(zero);
        self.stiffness * penetration.maximum(zero) * damping
    }

    /// Elastic energy in J at a penetration in m.
    pub(crate) fn stored_energy(&self, penetration: S) -> S {
        S::from(0.5) * self.stiffness * penetration.maximum(S::from(0.0)).squared()
    }

    /// Power in W that the contact turns into heat: never negative.
    pub(crate) fn dissipated(&self, penetration: S, rate: S) -> S {
        let elastic = self.stiffness * penetration.maximum(S::from(0.0));
        (self.force(penetration, rate) - elastic) * rate
    }
}
