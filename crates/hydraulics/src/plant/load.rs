use phea_dynamics::analytic::Analytic;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::PlantCoefficients;

use super::LinearPlant;
use crate::linear::polynomial::scaled;

/// Load on the force sensor, linearised at the operating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinearLoad<S = f64> {
    /// Prescribed motion, for any force.
    Prescribed,
    /// Mass that yields, held to its ground by a spring and a damper; a wall in contact is the
    /// spring.
    Yielding {
        /// Mass m, kg.
        mass: S,
        /// Damping c, N s/m.
        damping: S,
        /// Stiffness k, N/m; zero without contact with a wall.
        stiffness: S,
    },
    /// Mass tied to its ground by a damper only. Its position is undetermined and no force depends
    /// on it: the common factor s of all polynomials is omitted.
    Free {
        /// Mass m, kg.
        mass: S,
        /// Damping c, N s/m.
        damping: S,
    },
    /// Load that turns behind a linkage, with X_0 = r Theta_0 the displacement of the rod that
    /// follows from the angle of its ground.
    ///
    /// ```text
    /// (J s^2 + c s + k + k_g + k_w) X_L = r^2 F_L + (c s + k) X_0,     k_g = -F g''(theta) at a force F
    /// ```
    ///
    /// No term is divided by r, so that an interval of positions preserves the sign of J.
    Linked {
        /// Inertia J, kg m2.
        inertia: S,
        /// Damping c, N m s/rad.
        damping: S,
        /// Stiffness k of the connection to its ground, N m/rad.
        stiffness: S,
        /// Stiffness k_g from the change of the lever arm under the force there, N m/rad, and k_w
        /// from that of the load's weight; may be negative.
        geometric_stiffness: S,
        /// Lever arm r = g', m.
        lever_arm: S,
    },
}

/// Polynomials of a load that yields, highest power first.
///
/// ```text
/// Z X_L = share F_L + T X_0
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LoadTerms<S> {
    /// Mass m or inertia J.
    mass: S,
    /// Polynomial T: c and k, which tie the load to its ground.
    pub(super) ground: [S; 2],
    /// Geometric stiffness k_g.
    geometric: Option<S>,
    /// Factor r^2 of a linkage; `None` for one.
    pub(super) fraction: Option<S>,
}

impl<S: Scalar> LinearLoad<S> {
    /// Polynomials of the load; `None` if its motion is prescribed.
    pub(super) fn terms(&self) -> Option<LoadTerms<S>> {
        match *self {
            LinearLoad::Prescribed => None,
            LinearLoad::Yielding { mass, damping, stiffness } => {
                Some(LoadTerms { mass, ground: [damping, stiffness], geometric: None, fraction: None })
            }
            LinearLoad::Free { mass, damping } => {
                Some(LoadTerms { mass, ground: [damping, S::from(0.0)], geometric: None, fraction: None })
            }
            LinearLoad::Linked { inertia, damping, stiffness, geometric_stiffness, lever_arm } => {
                Some(LoadTerms {
                    mass: inertia,
                    ground: [damping, stiffness],
                    geometric: Some(geometric_stiffness),
                    fraction: Some(lever_arm.squared()),
                })
            }
        }
    }
}

impl LinearLoad {
    /// Stiffness in N/m that holds the load against a force of the rod at rest, behind a linkage
    /// (k + k_g)/r^2; `None` if there is no such stiffness: a prescribed motion, a free mass, an
    /// unstable linkage.
    ///
    /// # Example
    /// Behind a lever arm of half a metre a torsion spring is four times as stiff:
    /// ```
    /// use phea_hydraulics::plant::LinearLoad;
    /// let turned = LinearLoad::Linked {
    ///     inertia: 1.0, damping: 0.0, stiffness: 250.0, geometric_stiffness: 50.0, lever_arm: 0.5,
    /// };
    /// assert_eq!(turned.stiffness_at_rest(), Some(4.0 * 300.0));
    /// let free = LinearLoad::Yielding { mass: 1.0, damping: 2.0, stiffness: 0.0 };
    /// assert_eq!(free.stiffness_at_rest(), None);
    /// ```
    pub fn stiffness_at_rest(&self) -> Option<f64> {
        let [_, _, stiffness] = self.terms()?.reflected();
        (stiffness > 0.0).then_some(stiffness)
    }
}

impl<S: Scalar> LinearPlant<S> {
    /// Coefficients for a free mass without the common factor s; the factor is not common if the
    /// output or the piston depends on the position.
    pub(super) fn of_free_load(&self, mut plant: PlantCoefficients<S>) -> PlantCoefficients<S> {
        let LinearLoad::Free { .. } = self.load else { return plant };
        if self.virtual_impedance.is_some() || self.area_stiffness.is_some() {
            return plant;
        }
        let second = plant.disturbance.as_mut();
        let rate = plant.rate.as_mut();
        let paths = [Some(&mut plant.command), second].into_iter().flatten();
        let of_paths = paths.flat_map(|path| [&mut path.numerator, &mut path.denominator]);
        let of_rate = rate.into_iter().flat_map(|rate| {
            let inner = rate.inner.iter_mut().flatten();
            [&mut rate.command, &mut rate.disturbance].into_iter().chain(inner)
        });
        for polynomial in of_paths.chain(of_rate) {
            polynomial.pop();
        }
        plant
    }
}

impl<S: Scalar> LoadTerms<S> {
    /// Polynomial Z: m, c and k with k_g.
    pub(super) fn own(&self) -> [S; 3] {
        let [damping, stiffness] = self.ground;
        [self.mass, damping, self.geometric.map_or(stiffness, |geometric| stiffness + geometric)]
    }

    /// Number of the rod's force times the factor of its effect on this load.
    pub(super) fn moved_by(&self, number: S) -> S {
        self.fraction.map_or(number, |fraction| number * fraction)
    }

    /// Polynomial times this factor.
    pub(super) fn moved(&self, polynomial: Vec<S>) -> Vec<S> {
        match self.fraction {
            None => polynomial,
            Some(fraction) => scaled(fraction, &polynomial),
        }
    }
}

impl LoadTerms<f64> {
    /// Polynomial Z over the factor of the rod force's effect on the load.
    pub(super) fn reflected(&self) -> [f64; 3] {
        let own = self.own();
        self.fraction.map_or(own, |fraction| own.map(|number| number / fraction))
    }

    /// Value times this factor.
    pub(super) fn moved_at<A: Analytic>(&self, value: A) -> A {
        self.fraction.map_or(value, |fraction| value.scaled(fraction))
    }

    /// Polynomial Z and the connection to ground, at s.
    pub(super) fn at<A: Analytic>(&self, s: A) -> [A; 2] {
        let [damping, stiffness] = self.ground;
        let tied = s.scaled(damping) + A::from(stiffness);
        let own = (s * s).scaled(self.mass) + tied;
        [self.geometric.map_or(own, |geometric| own + A::from(geometric)), tied]
    }
}
