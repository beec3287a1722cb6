use num_complex::Complex64;

use super::discretization::prewarped;
use super::{Discretization, LinearError, TransferFunction};
use crate::portable::{argument, ln, magnitude};

/// Damping ratio below which a zero or a pole makes a narrow notch or peak.
const LIGHT_DAMPING: f64 = 0.3;

/// Lightly damped zero or pole of a continuous system, and its image in the sampled system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedRoot {
    /// True for a zero, false for a pole.
    pub is_zero: bool,
    /// Root in rad/s; the member of a pair in the upper half plane.
    pub root: Complex64,
    /// Image in rad/s: ln(z)/T of the root z.
    pub image: Complex64,
}

impl MovedRoot {
    /// Magnitude of the image over that of the root, less one.
    pub fn shift(&self) -> f64 {
        magnitude(self.image) / magnitude(self.root) - 1.0
    }
}

impl Discretization {
    /// Rate kappa of s = kappa (z - 1)/(z + 1) in rad/s; `None` if the method is not bilinear.
    ///
    /// ```text
    /// Tustin 2/T,     exact at a frequency w: w/tan(w T/2)
    /// ```
    ///
    /// # Errors
    /// [`LinearError::Frequency`] for a prewarping frequency at or above pi/T.
    pub fn bilinear_rate(self, sample_time_s: f64) -> Result<Option<f64>, LinearError> {
        match self {
            Discretization::Tustin => Ok(Some(2.0 / sample_time_s)),
            Discretization::PrewarpedTustin { frequency_rad_per_s } => {
                prewarped(frequency_rad_per_s, sample_time_s).map(Some)
            }
            Discretization::ZeroOrderHold | Discretization::Matched => Ok(None),
        }
    }
}

impl TransferFunction {
    /// Lightly damped zeros and poles of this continuous system, each with its image among the
    /// zeros or poles of the sampled one; a root at or above pi/T, which the samples cannot
    /// represent, has the image defined by the method.
    ///
    /// # Errors
    /// Errors of [`TransferFunction::discretized`].
    ///
    /// # Example
    /// Tustin's rule takes the frequency w to 2/T atan(w T/2); a rule prewarped to w preserves it.
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::linear::{Discretization, TransferFunction};
    /// let pair = |w: f64| vec![Complex64::new(0.0, w), Complex64::new(0.0, -w)];
    /// let (w, period) = (1000.0, 2e-3);
    /// let notch = TransferFunction::from_factors(1.0, pair(w), vec![Complex64::new(-w, 0.0); 2])?;
    /// let moved = notch.moved_roots(period, Discretization::Tustin)?;
    /// assert!((moved[0].image.im - 1000.0 * (0.25 * std::f64::consts::PI)).abs() < 1e-9);
    /// let kept = notch.moved_roots(period, Discretization::PrewarpedTustin { frequency_rad_per_s: w })?;
    /// assert!(kept[0].shift().abs() < 1e-12 && kept[0].is_zero && kept.len() == 1);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn moved_roots(
        &self,
        sample_time_s: f64,
        method: Discretization,
    ) -> Result<Vec<MovedRoot>, LinearError> {
        let rate = method.bilinear_rate(sample_time_s)?;
        let sampled = self.discretized(sample_time_s, method)?;
        let back = |z: Complex64| Complex64::new(ln(magnitude(z)), argument(z)) / sample_time_s;
        let mut moved = Vec::new();
        for (is_zero, own, images) in
            [(true, self.zeros(), sampled.zeros()), (false, self.poles(), sampled.poles())]
        {
            for &root in
                own.iter().filter(|root| root.im > 0.0 && -root.re < LIGHT_DAMPING * magnitude(**root))
            {
                let image = match rate {
                    Some(rate) => Some(back((rate + root) / (rate - root))),
                    None => images
                        .iter()
                        .map(|z| back(*z))
                        .min_by(|one, other| magnitude(one - root).total_cmp(&magnitude(other - root))),
                };
                moved.extend(image.map(|image| MovedRoot { is_zero, root, image }));
            }
        }
        Ok(moved)
    }
}
