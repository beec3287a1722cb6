//! Variables of the search, and the friction that they represent.

use phea_dynamics::portable;
use phea_hydraulics::friction::{FRICTION_COEFFICIENTS, FrictionLevels, LuGre, Stribeck};

use super::{Around, FrictionProblem, MeasuredFriction};
use crate::friction::directions::DirectionModel;
use crate::friction::shaking::ShakenRows;

/// Number of variables that belong to no recording: the coefficients, and the zero error of the
/// force.
pub(in crate::friction) const SHARED: usize = FRICTION_COEFFICIENTS + 1;

/// Index of the damping of the bristles.
pub(in crate::friction) const DAMPING: usize = 6;

/// Index of the zero error of the force.
pub(in crate::friction) const ZERO: usize = 7;

/// Indices of the variables of one direction: static friction, its fall to Coulomb friction, and
/// viscous friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::friction) struct LevelVariables {
    pub(in crate::friction) static_friction: usize,
    pub(in crate::friction) fall: usize,
    pub(in crate::friction) viscous: usize,
}

/// Variables of positive velocity, or of both directions.
pub(in crate::friction) const EXTENDING: LevelVariables =
    LevelVariables { static_friction: 0, fall: 1, viscous: 4 };

/// Variables of negative velocity; without effect if one friction is searched for both.
pub(in crate::friction) const RETRACTING: LevelVariables =
    LevelVariables { static_friction: 8, fall: 9, viscous: 10 };

impl FrictionProblem<'_> {
    /// Number of variables: the shared ones; for each constant velocity the initial state of the
    /// bristles; for each press its initial position, and its force at each knot; for each shake
    /// its initial state, and the coefficients of its force.
    pub(in crate::friction) fn count(&self) -> usize {
        let shaken: usize = self.shakes.iter().map(ShakenRows::variable_count).sum();
        self.first_of_shakes() + shaken
    }

    /// Index of the first variable of a shake.
    pub(in crate::friction) fn first_of_shakes(&self) -> usize {
        let pressed: usize = self.presses.iter().map(|press| 1 + press.force.knots.len()).sum();
        SHARED + self.slides.len() + pressed
    }

    /// Shared variables that are not searched.
    pub(in crate::friction) fn known_variables(&self) -> Vec<usize> {
        let damping = self.shakes.is_empty().then_some(DAMPING);
        let zero = (!self.finds_zero()).then_some(ZERO);
        let LevelVariables { static_friction, fall, viscous } = RETRACTING;
        let one_friction = self.directions == DirectionModel::SameBothWays;
        let back = [static_friction, fall, viscous].into_iter().filter(|_| one_friction);
        damping.into_iter().chain(zero).chain(back).collect()
    }

    /// True if the zero error of the force is searched: with levels for each direction it is not
    /// identifiable.
    pub(in crate::friction) fn finds_zero(&self) -> bool {
        self.goes_both_ways && self.directions == DirectionModel::SameBothWays
    }

    /// Friction and zero error for these variables.
    pub(in crate::friction) fn friction(&self, variables: &[f64]) -> MeasuredFriction {
        let at = |index: usize| variables.get(index).copied().unwrap_or(0.0);
        let Around { lugre, force, damping, .. } = self.around;
        let by = |value: f64, index: usize| value * portable::exp(at(index));
        let levels = |of: LevelVariables| FrictionLevels {
            coulomb: (at(of.static_friction) - at(of.fall)) * force,
            static_friction: at(of.static_friction) * force,
            viscous: at(of.viscous) * damping[0],
        };
        let FrictionLevels { coulomb, static_friction, viscous } = levels(EXTENDING);
        let curve = Stribeck {
            coulomb,
            static_friction,
            stribeck_velocity: by(lugre.curve.stribeck_velocity, 2),
            stribeck_exponent: by(lugre.curve.stribeck_exponent, 3),
            viscous,
            retracting: match self.directions {
                DirectionModel::SameBothWays => None,
                DirectionModel::DiffersByDirection => Some(levels(RETRACTING)),
            },
        };
        let bristle_stiffness = by(lugre.bristle_stiffness, 5);
        let lugre = LuGre { curve, bristle_stiffness, bristle_damping: at(DAMPING) * damping[1] };
        MeasuredFriction { lugre, zero: at(ZERO) * force }
    }

    /// Derivatives with respect to the shared variables from those with respect to the
    /// coefficients.
    pub(in crate::friction) fn shared_slopes(&self, lugre: &LuGre, gradient: &[f64]) -> [f64; SHARED] {
        let of = |index: usize| gradient.get(index).copied().unwrap_or(0.0);
        let Around { force, damping, .. } = self.around;
        // variables of one direction count for both only if the directions are equal
        let (back, own) = match self.directions {
            DirectionModel::SameBothWays => (1.0, 0.0),
            DirectionModel::DiffersByDirection => (0.0, 1.0),
        };
        let [coulomb, static_friction, viscous] =
            [(0, 7), (1, 8), (4, 9)].map(|(one, other)| [of(one), of(other)]);
        let both = |[one, other]: [f64; 2]| one + back * other;
        [
            (both(coulomb) + both(static_friction)) * force,
            -both(coulomb) * force,
            of(2) * lugre.curve.stribeck_velocity,
            of(3) * lugre.curve.stribeck_exponent,
            both(viscous) * damping[0],
            of(5) * lugre.bristle_stiffness,
            of(6) * damping[1],
            0.0,
            own * (coulomb[1] + static_friction[1]) * force,
            -own * coulomb[1] * force,
            own * viscous[1] * damping[0],
        ]
    }

    /// Start of a search from a curve and a zero error of the force.
    pub(super) fn start(&self, (curve, zero): &(Stribeck, f64)) -> Vec<f64> {
        let Around { lugre, force, damping, .. } = self.around;
        let over = |value: f64, usual: f64| portable::ln(value / usual);
        let mut start = vec![
            curve.static_friction / force,
            (curve.static_friction - curve.coulomb) / force,
            over(curve.stribeck_velocity, lugre.curve.stribeck_velocity),
            over(curve.stribeck_exponent, lugre.curve.stribeck_exponent),
            curve.viscous / damping[0],
            0.0,
            lugre.bristle_damping / damping[1],
            zero / force,
        ];
        start.extend(match self.directions {
            DirectionModel::SameBothWays => [0.0; 3],
            DirectionModel::DiffersByDirection => {
                let FrictionLevels { coulomb, static_friction, viscous } = curve.levels(-1.0);
                [static_friction / force, (static_friction - coulomb) / force, viscous / damping[0]]
            }
        });
        start.extend(self.slides.iter().map(|_| 0.0));
        for press in self.presses {
            start.push(0.0);
            start.extend(press.force.forces.iter().map(|value| value / force));
        }
        start.extend(self.shakes.iter().flat_map(|shake| self.shake_start(shake)));
        start
    }

    /// Bounds of each variable. Without shakes the damping of the bristles is fixed: a slow force
    /// does not show it, and a free oscillation would follow the noise.
    pub(in crate::friction) fn bounds(&self) -> Vec<[f64; 2]> {
        let damping = self.around.lugre.bristle_damping / self.around.damping[1];
        let exponent = self.around.lugre.curve.stribeck_exponent;
        let exponents = [0.2, 10.0].map(|end| portable::ln(end / exponent));
        let softest = portable::ln(self.around.softest / self.around.lugre.bristle_stiffness);
        let stiffness = [softest.clamp(-9.0, 0.0), 9.0];
        let [of_static, of_fall, of_viscous] = [[1e-4, 1e3], [0.0, 1e3], [0.0, 1e4]];
        let mut bounds = vec![of_static, of_fall, [-7.0, 7.0], exponents, of_viscous, stiffness];
        bounds.extend([[0.0, 1e3], [-100.0, 100.0], of_static, of_fall, of_viscous]);
        for known in self.known_variables() {
            let value = if known == DAMPING { damping } else { 0.0 };
            bounds.iter_mut().skip(known).take(1).for_each(|bound| *bound = [value; 2]);
        }
        // the force of bristles is between -F_S and F_S
        bounds.extend(self.slides.iter().map(|_| [-4.0, 4.0]));
        for press in self.presses {
            bounds.push([-1e6, 1e6]);
            bounds.extend(press.force.forces.iter().map(|_| [-1e3, 1e3]));
        }
        bounds.extend(self.shakes.iter().flat_map(Self::shake_bounds));
        bounds
    }
}
