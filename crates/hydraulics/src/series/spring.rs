use phea_dynamics::scalar::Scalar;

use super::ForceFrom;
use crate::contact::Contact;
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Spring with damper and mass between force sensor and load. Units: N/m, N s/m, kg.
///
/// ```text
/// F_f(d) = k d (1 + b (d/t)^2)                        spring; b is zero for a linear one
/// F_L = F_f(d) + c d' + F_ends(d, d')                 on the load, F_ends of Contact beyond the travel t
/// m dv_m/dt = K_S (x - x_m) - F_L,   d = x_m - x_L    without a mass both forces are equal
/// ```
///
/// Source: Pratt and Williamson (1995), "Series elastic actuators", IROS, for the arrangement.
///
/// # Example
/// Its force grows faster than its deflection, by the progression at the end of the travel:
/// ```
/// use phea_hydraulics::series::{ForceFrom, SeriesSpring, SeriesTravel};
/// let travel = SeriesTravel { travel: 0.01, progression: Some(0.5), ends: None };
/// let spring = SeriesSpring {
///     stiffness: 2.24e6, damping: None, mass: None, travel: Some(travel), force_from: ForceFrom::Sensor,
/// };
/// assert!((spring.spring_force(0.01) / 33.6e3 - 1.0_f64).abs() < 1e-12);
/// assert!((spring.deflection_under(33.6e3) - 0.01).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesSpring<S = f64> {
    /// Stiffness k of the spring; of a progressive one at rest.
    pub stiffness: S,
    /// Damping c parallel to the spring; `None` for no damper.
    pub damping: Option<S>,
    /// Mass m between sensor and spring; `None` for a massless connection.
    pub mass: Option<S>,
    /// Travel of the spring; `None` for unlimited travel.
    pub travel: Option<SeriesTravel<S>>,
    /// Source of the measured force.
    pub force_from: ForceFrom,
}

/// Travel of a spring to either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesTravel<S = f64> {
    /// Travel t to either side, m.
    pub travel: S,
    /// Progression b: fraction by which the force at the end of the travel exceeds k t; `None` for
    /// a linear spring.
    pub progression: Option<S>,
    /// Stops at the ends; `None` if the ends are only reported.
    pub ends: Option<Contact<S>>,
}

impl SeriesSpring {
    /// Impossible parameters of this spring; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(super::keys::STIFFNESS_KEY, self.stiffness);
        if let Some(damping) = self.damping {
            problems.positive("damping", damping);
        }
        if let Some(mass) = self.mass {
            problems.positive("mass", mass);
        }
        if let Some(SeriesTravel { travel, progression, ends }) = self.travel {
            problems.key(super::keys::TRAVEL_KEY, travel);
            problems.key(super::keys::PROGRESSION_KEY, progression.unwrap_or(0.0));
            if let Some(ends) = ends {
                problems.key(super::keys::STOP_STIFFNESS_KEY, ends.stiffness);
                let damped = ends.relative_damping;
                let free = is_free(self.damping, self.mass);
                match free {
                    true => problems.require(
                        "stop_damping",
                        damped,
                        damped == 0.0,
                        ParameterRequirement::NothingMovesAgainstStop,
                    ),
                    false => problems.key(super::keys::STOP_DAMPING_KEY, damped),
                }
            }
        }
        problems.into_vec()
    }

    /// Deflection at which it holds a force in N at rest, including its ends, m.
    ///
    /// ```text
    /// F_f(d) + F_ends(d, 0) = F
    /// ```
    pub fn deflection_under(&self, force: f64) -> f64 {
        // the force is odd and convex from zero on, so that Newton steps from beyond the root
        // return to it from one side
        let mut deflection = force / self.stiffness;
        for _ in 0..STEPS_MAXIMUM {
            let step = (self.elastic_force(deflection) - force) / self.elastic_slope(deflection);
            let next = deflection - step;
            if next == deflection {
                break;
            }
            deflection = next;
        }
        deflection
    }
}

/// True if only the force determines the velocity of a spring: with a damper or a mass, something
/// moves against its stops.
pub(super) fn is_free(damping: Option<f64>, mass: Option<f64>) -> bool {
    damping.is_none() && mass.is_none()
}

/// Largest number of Newton steps for a deflection: three suffice for a linear spring, about ten
/// for any other.
const STEPS_MAXIMUM: usize = 60;

phea_dynamics::parameters! { SeriesSpring { stiffness, damping, mass, travel, force_from: kept } }
phea_dynamics::parameters! { SeriesTravel { travel, progression, ends } }

impl<S: Scalar> SeriesSpring<S> {
    /// Force F_f of the spring without damper and ends at a deflection in m, N.
    #[inline(always)]
    pub fn spring_force(&self, deflection: S) -> S {
        match self.progressive() {
            None => self.stiffness * deflection,
            Some((travel, progression)) => {
                let grown = progression * (deflection / travel).squared();
                self.stiffness * deflection * (S::from(1.0) + grown)
            }
        }
    }

    /// Slope of this force, N/m.
    fn spring_slope(&self, deflection: S) -> S {
        match self.progressive() {
            None => self.stiffness,
            Some((travel, progression)) => {
                let grown = progression * (deflection / travel).squared();
                self.stiffness * (S::from(1.0) + S::from(3.0) * grown)
            }
        }
    }

    fn progressive(&self) -> Option<(S, S)> {
        let travel = self.travel?;
        Some((travel.travel, travel.progression?))
    }

    /// Deflection beyond the upper and the lower end of the travel, m, and the contact.
    fn beyond(&self, deflection: S) -> Option<([S; 2], Contact<S>)> {
        let SeriesTravel { travel, ends, .. } = self.travel?;
        Some(([deflection - travel, -deflection - travel], ends?))
    }

    /// Force of spring and ends at rest, N.
    pub(crate) fn elastic_force(&self, deflection: S) -> S {
        self.spring_force(deflection) + self.ends_force(deflection, S::from(0.0))
    }

    /// Slope of this force, N/m.
    pub(crate) fn elastic_slope(&self, deflection: S) -> S {
        let spring = self.spring_slope(deflection);
        let Some((beyond, ends)) = self.beyond(deflection) else { return spring };
        let zero = S::from(0.0);
        let pressed = |depth: S| S::select(zero.less_than(depth), ends.stiffness, zero);
        spring + pressed(beyond[0]) + pressed(beyond[1])
    }

    /// Force of the ends of the travel at a deflection in m that grows at a rate in m/s, N.
    pub(crate) fn ends_force(&self, deflection: S, rate: S) -> S {
        let Some(([above, below], ends)) = self.beyond(deflection) else { return S::from(0.0) };
        ends.force(above, rate) - ends.force(below, -rate)
    }

    /// Rate of the deflection at which a damped element without mass holds a force, m/s.
    ///
    /// ```text
    /// c w + K d+ (1 + e w)+ = F - F_f = P         w = min(P/c, (P - K d+)/(c + K d+ e)) at the upper end
    /// ```
    pub(crate) fn rate_under(&self, damping: S, force: S, deflection: S) -> S {
        let left = force - self.spring_force(deflection);
        let Some(([above, below], ends)) = self.beyond(deflection) else { return left / damping };
        let zero = S::from(0.0);
        let towards = |left: S, depth: S| {
            let elastic = ends.stiffness * depth.maximum(zero);
            let pressed = (left - elastic) / (damping + elastic * ends.relative_damping);
            (left / damping).minimum(pressed)
        };
        S::select(zero.less_than(below), -towards(-left, below), towards(left, above))
    }

    /// Elastic energy of spring and ends, J.
    pub(crate) fn stored_energy(&self, deflection: S) -> S {
        let half = S::from(0.5);
        let spring = half * self.stiffness * deflection.squared();
        let spring = self.progressive().map_or(spring, |(travel, progression)| {
            spring * (S::from(1.0) + half * progression * (deflection / travel).squared())
        });
        let Some(([above, below], ends)) = self.beyond(deflection) else { return spring };
        spring + ends.stored_energy(above) + ends.stored_energy(below)
    }

    /// Power that damper and ends turn into heat, never negative, W.
    pub(crate) fn dissipated(&self, deflection: S, rate: S) -> S {
        let damper = self.damping.map_or(S::from(0.0), |damping| damping * rate.squared());
        let Some(([above, below], ends)) = self.beyond(deflection) else { return damper };
        damper + ends.dissipated(above, rate) + ends.dissipated(below, -rate)
    }

    /// Remaining distance to the nearer end of the travel, m; negative beyond it; one metre without
    /// ends.
    pub(crate) fn clearance(&self, deflection: S) -> S {
        self.travel.map_or(S::from(1.0), |travel| travel.travel - deflection.abs())
    }

    /// Stiffness of the spring for small motions about the deflection at which it holds a force in
    /// N, N/m.
    ///
    /// ```text
    /// k_t = k (1 + 3 b (d/t)^2) = k (r + 1/r - 1),    r^3 = 1 + 2 z^2 + 2 |z| root(1 + z^2),    z = 3 root(3 b) F/(2 k t)
    /// ```
    ///
    /// The formula is the solution of the cubic F_f(d) = F by hyperbolic functions: sinh 3w = z, r
    /// = e^2w.
    ///
    /// # Example
    /// At the end of its travel a spring with progression 0.5 is 2.5 times as stiff as at rest:
    /// ```
    /// use phea_hydraulics::series::{ForceFrom, SeriesSpring, SeriesTravel};
    /// let travel = SeriesTravel { travel: 0.01, progression: Some(0.5), ends: None };
    /// let spring = SeriesSpring {
    ///     stiffness: 2.24e6, damping: None, mass: None, travel: Some(travel), force_from: ForceFrom::Sensor,
    /// };
    /// assert!((spring.stiffness_under(33.6e3) / (2.5 * 2.24e6) - 1.0_f64).abs() < 1e-12);
    /// assert_eq!(spring.stiffness_under(0.0), 2.24e6);
    /// ```
    pub fn stiffness_under(&self, force: S) -> S {
        let Some((travel, progression)) = self.progressive() else { return self.stiffness };
        let (one, r) = (S::from(1.0), self.grown(force, travel, progression));
        self.stiffness * (r + one / r - one)
    }

    /// Deflection at which the spring without its ends holds a force in N, by this solution, m.
    ///
    /// ```text
    /// d = 3 F/(k (1 + r + 1/r))
    /// ```
    pub fn held_deflection(&self, force: S) -> S {
        let Some((travel, progression)) = self.progressive() else { return force / self.stiffness };
        let (one, r) = (S::from(1.0), self.grown(force, travel, progression));
        S::from(3.0) * force / (self.stiffness * (one + r + one / r))
    }

    /// Variable r of [`SeriesSpring::stiffness_under`].
    fn grown(&self, force: S, travel: S, progression: S) -> S {
        let (one, two) = (S::from(1.0), S::from(2.0));
        let z = S::from(1.5) * (S::from(3.0) * progression).sqrt() * force / (self.stiffness * travel);
        let square = z.squared();
        let cubed = one + two * square + two * z.abs() * (one + square).sqrt();
        (cubed.ln() / S::from(3.0)).exp()
    }
}
