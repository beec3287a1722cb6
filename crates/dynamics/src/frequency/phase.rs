//! Phase as a sum over factors, continuous in frequency.

use num_complex::Complex64;

use crate::linear::{TimeDomain, TransferFunction};
use crate::portable::{atan2, cos, magnitude, sin};

impl TransferFunction {
    /// Phase at a frequency >= 0 in rad, continuous along the frequency axis.
    ///
    /// At low frequency it starts from 0 or, when the sign of the system is negative there, from
    /// -pi, plus pi/2 for each differentiator and minus pi/2 for each integrator. Roots on the
    /// boundary of stability count as stable: passing an undamped pole drops the phase by pi.
    ///
    /// # Example
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::linear::TransferFunction;
    /// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
    /// let unstable = TransferFunction::from_factors(1.0, vec![], vec![Complex64::new(1.0, 0.0)])?;
    /// assert_eq!(unstable.phase_rad(1.0).to_degrees(), -135.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn phase_rad(&self, frequency_rad_per_s: f64) -> f64 {
        let part = |root: &Complex64| match self.domain() {
            TimeDomain::Continuous => continuous_part(*root, frequency_rad_per_s),
            TimeDomain::Discrete { sample_time_s } => {
                discrete_part(*root, frequency_rad_per_s * sample_time_s)
            }
        };
        let factors = self.zeros().iter().map(part).sum::<f64>() - self.poles().iter().map(part).sum::<f64>();
        let reversed = |roots: &[Complex64]| roots.iter().filter(|root| self.reverses_sign(**root)).count();
        let reversals = reversed(self.zeros()) + reversed(self.poles()) + usize::from(self.gain() < 0.0);
        let start = if reversals % 2 == 1 { -std::f64::consts::PI } else { 0.0 };
        start + factors - frequency_rad_per_s * self.dead_time_s()
    }

    /// True if the factor of this root is negative at zero frequency.
    fn reverses_sign(&self, root: Complex64) -> bool {
        let boundary = match self.domain() {
            TimeDomain::Continuous => 0.0,
            TimeDomain::Discrete { .. } => 1.0,
        };
        root.im == 0.0 && root.re > boundary
    }
}

/// Phase arg(jw - r), less the pi of a real root in the right half plane and the 2 pi of a pair.
fn continuous_part(root: Complex64, frequency: f64) -> f64 {
    let angle = atan2(frequency - root.im, root.re.abs());
    if root.re > 0.0 { -angle } else { angle }
}

/// Phase arg(exp(j angle) - r), less the pi of a real root beyond +1.
fn discrete_part(root: Complex64, angle: f64) -> f64 {
    let one = Complex64::new(1.0, 0.0);
    if magnitude(root) <= 1.0 {
        // exp(j angle) (1 - r exp(-j angle)), the second factor in the right half plane
        let rest = one - root * Complex64::new(cos(angle), -sin(angle));
        angle + atan2(rest.im, rest.re.max(0.0))
    } else {
        // -r (1 - exp(j angle)/r); the arguments of -r and of its conjugate cancel
        let rest = one - Complex64::new(cos(angle), sin(angle)) / root;
        let own = if root.im == 0.0 { 0.0 } else { atan2(-root.im, -root.re) };
        own + atan2(rest.im, rest.re)
    }
}
