use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, Polynomial, TimeDomain};
use phea_dynamics::portable;

use super::Irresolution;
use super::characteristic::Characteristic;

/// Highest degree at which the poles of a sampled loop with whole samples of delay are computed: beyond it the powers of z lose too
/// many digits.
const HIGHEST_SAMPLED_DEGREE: usize = 24;

impl Characteristic {
    /// The largest real part of a closed-loop pole in 1/s, ln|z|/T in a sampled loop; minus infinity for a loop without poles.
    /// `None` where a delay leaves no polynomial.
    pub(super) fn largest_real_part(&self) -> Result<Option<f64>, Irresolution> {
        let Some(polynomial) = self.closed_loop_polynomial()? else { return Ok(None) };
        let roots = polynomial.roots().map_err(Irresolution::Linear)?;
        let real_part = |root: &Complex64| match self.domain {
            TimeDomain::Continuous => root.re,
            // ln|1 + v|
            TimeDomain::Discrete { sample_time_s } => {
                0.5 * portable::log1p((2.0 * root.re + root.norm_sqr()).max(-1.0)) / sample_time_s
            }
        };
        Ok(Some(roots.iter().map(real_part).fold(f64::NEG_INFINITY, f64::max)))
    }

    /// c + n, or c z^k + n.
    fn closed_loop_polynomial(&self) -> Result<Option<Polynomial>, Irresolution> {
        let mut denominator = self.denominator.clone();
        if self.delay > 0.0 {
            let degree = denominator.degree() as f64 + self.delay;
            if self.domain == TimeDomain::Continuous || degree > HIGHEST_SAMPLED_DEGREE as f64 {
                return Ok(None);
            }
            let z = Polynomial::new(vec![1.0, 1.0]);
            let mut samples = 0.0;
            while samples < self.delay {
                denominator = denominator.product(&z);
                samples += 1.0;
            }
        }
        let closed = denominator.sum(&self.numerator);
        if closed.degree() < denominator.degree().max(self.numerator.degree()) || closed.is_zero() {
            return Err(Irresolution::Linear(LinearError::IllPosedLoop));
        }
        Ok(Some(closed))
    }
}
