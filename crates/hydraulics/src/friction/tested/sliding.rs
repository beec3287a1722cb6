use phea_dynamics::scalar::{Dual, Scalar};

use super::FRICTION_COEFFICIENTS;
use crate::friction::LuGre;

/// Number of variables of the force over a block: the coefficients, and the bristle force remaining
/// from the time when the velocity became constant.
pub const SLIDING_VARIABLES: usize = FRICTION_COEFFICIENTS + 1;

/// Rows of a recording over which a piston slides at a constant velocity, taken together. Units: m,
/// m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidBlock {
    /// Velocity v, not zero.
    pub velocity: f64,
    /// Distance slid from where the velocity became constant to the middle of the block.
    pub distance: f64,
    /// Half of the distance slid within the block, positive.
    pub half_length: f64,
}

impl SlidBlock {
    /// Mean friction force over the block, N.
    ///
    /// ```text
    /// F = sign(v) g(v) + sigma_2 v + c e^(-k d) sinh(k h)/(k h)        k = sigma_0/g(v)
    /// ```
    ///
    /// with d the distance to the middle of the block and 2 h its length. At a constant velocity
    /// dz/dt = v - sigma_0 |v| z/g(v) is linear in z: the initial excess force of the bristles, c
    /// in N, decays with the distance slid, by a factor of e on each g/sigma_0; the last term is
    /// its mean. Source: Canudas de Wit, Olsson, Astrom and Lischinsky (1995), equations 2 and 4,
    /// solved.
    ///
    /// # Example
    /// Far from a reversal only the steady curve remains.
    /// ```
    /// use phea_hydraulics::friction::{LuGre, SlidBlock};
    /// let lugre = LuGre::same_both_ways([80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3]);
    /// let block = |distance| SlidBlock { velocity: -0.004, distance, half_length: 1e-6 };
    /// let steady = lugre.curve.steady_force(-0.004);
    /// assert!((block(1e-3).force(&lugre, 150.0) - steady).abs() < 1e-9);
    /// // just after it, all of it
    /// assert!((block(1e-6).force(&lugre, 150.0) - steady) > 120.0);
    /// ```
    pub fn force<S: Scalar>(&self, lugre: &LuGre<S>, left: S) -> S {
        let velocity = S::from(self.velocity);
        let decay = lugre.bristle_stiffness / lugre.curve.sliding_force(velocity);
        let faded = |distance: f64| (-(decay.times(distance))).exp();
        let first = (self.distance - self.half_length).max(0.0);
        let last = self.distance + self.half_length;
        let mean = (faded(first) - faded(last)) / decay.times(last - first);
        lugre.curve.steady_force(velocity) + left * mean
    }

    /// Force with its derivatives over the coefficients, in the order of [`LuGre::to_array`], and
    /// over c.
    pub fn sensitive_force(&self, lugre: &LuGre, left: f64) -> (f64, [f64; SLIDING_VARIABLES]) {
        type SlidingSlope = Dual<SLIDING_VARIABLES>;
        let numbers = lugre.to_array();
        let open =
            LuGre::from_array(std::array::from_fn(|index| SlidingSlope::variable(numbers[index], index)));
        let force = self.force(&open, SlidingSlope::variable(left, FRICTION_COEFFICIENTS));
        (force.value(), *force.gradient())
    }
}
