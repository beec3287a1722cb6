use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Steady friction curve. Units: N, m/s, N s/m.
///
/// ```text
/// F(v) = sign(v) g(v) + sigma_2 v                                      thesis (4.33)
/// g(v) = F_C + (F_S - F_C) exp(-|v/v_S|^alpha)                         thesis (4.31), corrected
/// ```
///
/// If a seal resists one direction more than the other, F_C, F_S and sigma_2 for v < 0 are those of
/// `retracting`. F is zero or jumps at v = 0 in either case, so that this adds no jump.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stribeck<S = f64> {
    /// Coulomb friction F_C, N; with `retracting`, for v > 0.
    pub coulomb: S,
    /// Static (breakaway) friction F_S, N.
    pub static_friction: S,
    /// Stribeck velocity v_S, m/s.
    pub stribeck_velocity: S,
    /// Stribeck exponent alpha.
    pub stribeck_exponent: S,
    /// Viscous coefficient sigma_2, N s/m.
    pub viscous: S,
    /// Levels for v < 0; if absent, those for v > 0. A table states them apart from its curve.
    pub retracting: Option<FrictionLevels<S>>,
}

/// Levels of a steady curve, which may differ by direction. Units: N, N s/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionLevels<S = f64> {
    /// Coulomb friction F_C, N.
    pub coulomb: S,
    /// Static (breakaway) friction F_S, N.
    pub static_friction: S,
    /// Viscous coefficient sigma_2, N s/m.
    pub viscous: S,
}

/// Evaluation of the exponent of a [`Stribeck`] curve: a power takes a logarithm and an exponential
/// more than a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StribeckShape {
    /// Exponent 2: g(v) = F_C + (F_S - F_C) exp(-(v/v_S)^2).
    Squared,
    /// Any exponent.
    Power,
}

impl<S: Scalar> Stribeck<S> {
    /// Levels for v > 0.
    #[inline(always)]
    pub(super) fn extending(&self) -> FrictionLevels<S> {
        let Stribeck { coulomb, static_friction, viscous, .. } = *self;
        FrictionLevels { coulomb, static_friction, viscous }
    }

    /// Levels in the direction of a velocity in m/s.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::{FrictionLevels, Stribeck};
    /// let retracting = FrictionLevels { coulomb: 110.0, static_friction: 150.0, viscous: 130.0 };
    /// let curve = Stribeck {
    ///     coulomb: 80.0, static_friction: 120.0, stribeck_velocity: 0.01, stribeck_exponent: 2.0, viscous: 100.0,
    ///     retracting: Some(retracting),
    /// };
    /// assert_eq!(curve.levels(-0.1), retracting);
    /// assert_eq!((curve.steady_force(0.5), curve.steady_force(-0.5)), (130.0, -175.0));
    /// ```
    #[inline(always)]
    pub fn levels(&self, velocity: S) -> FrictionLevels<S> {
        let extending = self.extending();
        let Some(back) = self.retracting else { return extending };
        let FrictionLevels { coulomb, static_friction, viscous } = extending;
        let is_back = velocity.less_than(S::from(0.0));
        FrictionLevels {
            coulomb: S::select(is_back, back.coulomb, coulomb),
            static_friction: S::select(is_back, back.static_friction, static_friction),
            viscous: S::select(is_back, back.viscous, viscous),
        }
    }

    /// Sliding force g(v) as [`Stribeck::sliding_force`], with the shape known beforehand, N.
    #[inline(always)]
    pub(crate) fn sliding_force_of(&self, shape: StribeckShape, velocity: S) -> S {
        match shape {
            StribeckShape::Squared => {
                let square = (velocity / self.stribeck_velocity).squared();
                let FrictionLevels { coulomb, static_friction, .. } = self.levels(velocity);
                coulomb + (static_friction - coulomb) * (-square).exp()
            }
            StribeckShape::Power => self.sliding_force(velocity),
        }
    }

    /// Smooth form of the steady curve as a function of the velocity, for equations that are
    /// integrated, N.
    ///
    /// ```text
    /// F(v) = g(v) v/sqrt(v^2 + v_r^2) + sigma_2 v
    /// ```
    ///
    /// The sign of thesis (4.33) is replaced by a quotient that reaches 99 % of it at 7 v_r. A
    /// piston that should stick under a force F creeps instead, at about v_r F/F_S: to hold a load,
    /// use [`super::LuGre`].
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::{Stribeck, StribeckShape};
    /// let curve = Stribeck {
    ///     coulomb: 80.0, static_friction: 120.0, stribeck_velocity: 0.01, stribeck_exponent: 2.0, viscous: 100.0, retracting: None,
    /// };
    /// let smooth: f64 = curve.regular_force(StribeckShape::Squared, 0.1, 1e-5);
    /// assert!((smooth - curve.steady_force(0.1)).abs() < 1e-5);
    /// assert_eq!(curve.regular_force(StribeckShape::Power, 0.0, 1e-5), 0.0);
    /// ```
    #[inline(always)]
    pub fn regular_force(&self, shape: StribeckShape, velocity: S, regular_velocity: S) -> S {
        let speed = (velocity.squared() + regular_velocity.squared()).sqrt();
        self.sliding_force_of(shape, velocity) * velocity / speed + self.levels(velocity).viscous * velocity
    }

    /// Force that the bristles carry in steady sliding at v in m/s, N.
    ///
    /// ```text
    /// g(v) = F_C + (F_S - F_C) exp(-|v/v_S|^alpha)                         thesis (4.31), corrected
    /// ```
    pub fn sliding_force(&self, velocity: S) -> S {
        // The least positive number replaces zero velocity, whose logarithm does not exist; its
        // power is zero.
        let least = S::from(f64::MIN_POSITIVE);
        let relative = (velocity / self.stribeck_velocity).abs().maximum(least);
        let power = (self.stribeck_exponent * relative.ln()).exp();
        let FrictionLevels { coulomb, static_friction, .. } = self.levels(velocity);
        coulomb + (static_friction - coulomb) * (-power).exp()
    }

    /// Steady friction force, N; zero at standstill, where any force up to F_S is possible.
    ///
    /// ```text
    /// F(v) = sign(v) g(v) + sigma_2 v                                      thesis (4.33)
    /// ```
    ///
    /// # Example
    /// Odd in the velocity, and Coulomb plus viscous friction far above the Stribeck velocity:
    /// ```
    /// use phea_hydraulics::friction::Stribeck;
    /// let curve = Stribeck {
    ///     coulomb: 80.0, static_friction: 120.0, stribeck_velocity: 0.01, stribeck_exponent: 2.0, viscous: 100.0, retracting: None,
    /// };
    /// assert_eq!(curve.steady_force(0.5), 130.0);
    /// assert_eq!(curve.steady_force(-0.003), -curve.steady_force(0.003));
    /// assert!((curve.steady_force(1e-9) - 120.0_f64).abs() < 1e-6);
    /// ```
    pub fn steady_force(&self, velocity: S) -> S {
        let (zero, one) = (S::from(0.0), S::from(1.0));
        let negative_or_zero = S::select(velocity.less_than(zero), -one, zero);
        let sign = S::select(zero.less_than(velocity), one, negative_or_zero);
        sign * self.sliding_force(velocity) + self.levels(velocity).viscous * velocity
    }
}

impl Stribeck {
    /// Impossible parameters of this curve; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let [extending, retracting] = self.both_levels().map(|levels| levels.problems());
        let mut problems = Problems::default();
        problems.all(extending);
        problems.key(super::keys::STRIBECK_VELOCITY_KEY, self.stribeck_velocity);
        problems.key(super::keys::STRIBECK_EXPONENT_KEY, self.stribeck_exponent);
        if self.retracting.is_some() {
            problems.component("retracting", retracting);
        }
        problems.into_vec()
    }

    /// Levels of both directions, those of positive velocity first.
    pub fn both_levels(&self) -> [FrictionLevels; 2] {
        [1.0, -1.0].map(|velocity| self.levels(velocity))
    }

    /// Best evaluation of the exponent.
    #[inline(always)]
    pub fn shape(&self) -> StribeckShape {
        if self.stribeck_exponent == 2.0 { StribeckShape::Squared } else { StribeckShape::Power }
    }
}

impl FrictionLevels {
    /// True if it breaks away at less than it slides with.
    pub(super) fn is_reversed(&self) -> bool {
        self.static_friction < self.coulomb
    }

    fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(super::keys::COULOMB_KEY, self.coulomb);
        let requirement = ParameterRequirement::AtLeastCoulomb;
        problems.require("static", self.static_friction, !self.is_reversed(), requirement);
        problems.key(super::keys::VISCOUS_KEY, self.viscous);
        problems.into_vec()
    }

    /// Viscous coefficient sigma_2 that LuGre friction with this damping of its bristles requires
    /// to be passive, N s/m.
    ///
    /// ```text
    /// sigma_2 >= sigma_1 (F_S - F_C)/F_C
    /// ```
    pub fn passive_viscous(&self, bristle_damping: f64) -> f64 {
        bristle_damping * (self.static_friction - self.coulomb) / self.coulomb
    }
}

phea_dynamics::parameters! { FrictionLevels { coulomb, static_friction, viscous } }

phea_dynamics::parameters! {
    Stribeck { coulomb, static_friction, stribeck_velocity, stribeck_exponent, viscous, retracting }
}
