use phea_dynamics::scalar::Scalar;

use super::{FrictionLevels, Stribeck, StribeckShape};
use crate::parameter::{ParameterError, Problems};

/// Friction of elastic bristles with mean deflection z. Units: N/m, N s/m.
///
/// ```text
/// dz/dt = v - sigma_0 |v| z/g(v)                                       thesis (4.30), corrected
/// F = sigma_0 z + sigma_1 dz/dt + sigma_2 v                            thesis (4.32)
/// ```
///
/// Source: Canudas de Wit, Olsson, Astrom and Lischinsky (1995); the thesis' (4.30) drops sigma_0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LuGre<S = f64> {
    /// Steady curve, with g(v) and sigma_2.
    pub curve: Stribeck<S>,
    /// Bristle stiffness sigma_0, N/m.
    pub bristle_stiffness: S,
    /// Bristle damping sigma_1, N s/m.
    pub bristle_damping: S,
}

/// Passivity of a LuGre model: it only absorbs energy from the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LuGrePassivity {
    /// Passive model; the viscous friction exceeds the requirement by this amount, N s/m.
    Passive {
        /// Surplus of sigma_2 over the required value, zero or positive, N s/m.
        surplus: f64,
    },
    /// Not passive: some motions gain energy; this viscous friction is required, N s/m.
    NotPassive {
        /// Required value sigma_1 (F_S - F_C)/F_C, above sigma_2, N s/m.
        required_viscous: f64,
    },
}

impl<S: Scalar> LuGre<S> {
    /// Rate of the bristle deflection at sliding velocity v in m/s and deflection z in m, m/s.
    ///
    /// ```text
    /// dz/dt = v - sigma_0 |v| z/g(v)                                       thesis (4.30), corrected
    /// ```
    ///
    /// # Example
    /// At a steady velocity the bristles settle at sigma_0 z = sign(v) g(v).
    /// ```
    /// use phea_hydraulics::friction::{LuGre, Stribeck};
    /// let curve = Stribeck {
    ///     coulomb: 80.0, static_friction: 120.0, stribeck_velocity: 0.01, stribeck_exponent: 2.0, viscous: 100.0, retracting: None,
    /// };
    /// let lugre = LuGre { curve, bristle_stiffness: 1e7, bristle_damping: 2e3 };
    /// let settled = -curve.sliding_force(-0.004) / 1e7;
    /// assert!(lugre.bristle_rate(-0.004, settled).abs() < 1e-17);
    /// let force: f64 = lugre.force(-0.004, settled);
    /// assert!((force - curve.steady_force(-0.004)).abs() < 1e-12 * force.abs());
    /// ```
    #[inline(always)]
    pub fn bristle_rate(&self, velocity: S, deflection: S) -> S {
        velocity - self.bristle_stiffness * velocity.abs() * deflection / self.curve.sliding_force(velocity)
    }

    /// Friction force in N together with dz/dt in m/s: the exponential is evaluated once.
    #[inline(always)]
    pub(crate) fn force_and_rate(&self, shape: StribeckShape, velocity: S, deflection: S) -> (S, S) {
        let spring = self.bristle_stiffness * deflection;
        let rate = velocity - velocity.abs() * spring / self.curve.sliding_force_of(shape, velocity);
        (spring + self.bristle_damping * rate + self.curve.levels(velocity).viscous * velocity, rate)
    }

    /// Friction force at sliding velocity v in m/s and bristle deflection z in m, N.
    ///
    /// ```text
    /// F = sigma_0 z + sigma_1 dz/dt + sigma_2 v                            thesis (4.32)
    /// ```
    #[inline(always)]
    pub fn force(&self, velocity: S, deflection: S) -> S {
        self.bristle_stiffness * deflection
            + self.bristle_damping * self.bristle_rate(velocity, deflection)
            + self.curve.levels(velocity).viscous * velocity
    }
}

impl LuGre {
    /// Impossible parameters of this friction; empty if there are none. Lack of passivity is
    /// possible: see [`LuGre::passivity`].
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(super::keys::BRISTLE_STIFFNESS_KEY, self.bristle_stiffness);
        problems.key(super::keys::BRISTLE_DAMPING_KEY, self.bristle_damping);
        let mut all = self.curve.problems();
        all.extend(problems.into_vec());
        all
    }

    /// Passivity by sigma_2 >= sigma_1 (F_S - F_C)/F_C, required for each direction: bristles
    /// loaded in one direction are swept onward beyond F_C of that direction.
    ///
    /// Source: Barabanov and Ortega (2000), IEEE Transactions on Automatic Control 45(4).
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::{LuGre, LuGrePassivity, Stribeck};
    /// let curve = Stribeck {
    ///     coulomb: 80.0, static_friction: 120.0, stribeck_velocity: 0.01, stribeck_exponent: 2.0, viscous: 100.0, retracting: None,
    /// };
    /// let lugre = LuGre { curve, bristle_stiffness: 1e7, bristle_damping: 2e3 };
    /// assert_eq!(lugre.passivity(), LuGrePassivity::NotPassive { required_viscous: 1000.0 });
    /// let softer = LuGre { bristle_damping: 100.0, ..lugre };
    /// assert_eq!(softer.passivity(), LuGrePassivity::Passive { surplus: 50.0 });
    /// ```
    pub fn passivity(&self) -> LuGrePassivity {
        let of = |levels: FrictionLevels| {
            let required_viscous = levels.passive_viscous(self.bristle_damping);
            (levels.viscous - required_viscous, required_viscous)
        };
        let [extending, retracting] = self.curve.both_levels().map(of);
        let (surplus, required_viscous) = if retracting.0 < extending.0 { retracting } else { extending };
        if surplus >= 0.0 {
            LuGrePassivity::Passive { surplus }
        } else {
            LuGrePassivity::NotPassive { required_viscous }
        }
    }
}

phea_dynamics::parameters! { LuGre { curve, bristle_stiffness, bristle_damping } }
