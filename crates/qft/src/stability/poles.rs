use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, Polynomial, TimeDomain};
use phea_dynamics::portable;

use super::Irresolution;
use super::characteristic::Characteristic;
use super::product::RootProduct;

/// Highest degree at which the poles of a sampled loop with whole samples of delay are computed:
/// beyond it the powers of z lose too many digits.
const HIGHEST_SAMPLED_DEGREE: usize = 24;

/// Number of sweeps over the roots of a sampled loop, and the fraction of its magnitude by which a
/// root may move in one step.
const SWEEPS_MAXIMUM: usize = 20;
const STEP_MAXIMUM: f64 = 0.1;

impl Characteristic {
    /// The largest real part of a closed-loop pole (ln|z|/T in a sampled loop), 1/s; minus infinity
    /// for a loop without poles. `None` if a delay leaves no polynomial.
    pub(super) fn largest_real_part(&self) -> Result<Option<f64>, Irresolution> {
        let Some(polynomial) = self.closed_loop_polynomial()? else { return Ok(None) };
        let mut roots = polynomial.roots().map_err(Irresolution::Linear)?;
        if let Some([numerator, denominator]) = &self.products {
            polish(&mut roots, |v| self.closed_product(numerator, denominator, v));
        }
        let real_part = |root: &Complex64| match self.domain {
            TimeDomain::Continuous => root.re,
            // ln|1 + v|
            TimeDomain::Discrete { sample_time_s } => {
                0.5 * portable::log1p((2.0 * root.re + root.norm_sqr()).max(-1.0)) / sample_time_s
            }
        };
        Ok(Some(roots.iter().map(real_part).fold(f64::NEG_INFINITY, f64::max)))
    }

    /// The characteristic function from the roots of its parts, and its derivative.
    ///
    /// ```text
    /// f = c z^k + n,    f' = c' z^k + k c z^(k-1) + n'
    /// ```
    fn closed_product(&self, n: &RootProduct, c: &RootProduct, v: Complex64) -> (Complex64, Complex64) {
        let (mut value, mut slope) = c.with_slope(v);
        let z = v + 1.0;
        let mut samples = 0.0;
        while samples < self.delay {
            (value, slope) = (value * z, slope * z + value);
            samples += 1.0;
        }
        let (numerator, numerator_slope) = n.with_slope(v);
        (value + numerator, slope + numerator_slope)
    }

    /// Polynomial c + n, or c z^k + n.
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

/// Moves roots of an expanded polynomial to those of the function it represents, simultaneously by
/// the iteration of Ehrlich and Aberth; a root whose steps do not shrink is unchanged.
fn polish(roots: &mut [Complex64], function: impl Fn(Complex64) -> (Complex64, Complex64)) {
    let mut last = vec![Some(f64::INFINITY); roots.len()];
    for _ in 0..SWEEPS_MAXIMUM {
        for (index, last) in last.iter_mut().enumerate() {
            let (Some(&root), Some(before)) = (roots.get(index), *last) else { continue };
            let (value, slope) = function(root);
            let newton = value / slope;
            let others = roots.iter().enumerate().filter(|(other, _)| *other != index);
            let repulsion: Complex64 = others.map(|(_, other)| (root - other).inv()).sum();
            let step = newton / (1.0 - newton * repulsion);
            let (size, scale) = (portable::magnitude(step), portable::magnitude(root));
            let moves = step.is_finite() && size <= STEP_MAXIMUM * scale && size < 0.5 * before;
            if let (true, Some(slot)) = (moves, roots.get_mut(index)) {
                *slot = root - step;
            }
            *last = (moves && size > 4.0 * f64::EPSILON * scale).then_some(size);
        }
        if last.iter().all(Option::is_none) {
            return;
        }
    }
}
