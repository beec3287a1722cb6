//! The dead time that brings a loop to the stability boundary.
//!
//! Dead time rotates L and leaves |L| unchanged, so that poles can cross only at frequencies
//! where |n| = |c|. These are roots of one real polynomial, in w^2 or in |z - 1|^2: none of them is
//! missed between the points of a grid.

use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, Polynomial, TimeDomain};
use phea_dynamics::portable;

use super::Irresolution;
use super::characteristic::{Characteristic, evaluate};

/// The least additional dead time at which a closed-loop pole reaches the stability boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalDelay {
    /// Delay, s; infinite if no dead time does.
    pub delay_s: f64,
    /// The gain crossover, rad/s; infinite if |L| does not fall below one.
    pub frequency_rad_per_s: f64,
}

impl CriticalDelay {
    pub(super) const NONE: CriticalDelay =
        CriticalDelay { delay_s: f64::INFINITY, frequency_rad_per_s: f64::INFINITY };
}

impl Characteristic {
    /// The least of (arg L + pi)/w over all gain crossovers, with the angle in [0, 2 pi).
    pub(super) fn critical_delay(&self) -> Result<CriticalDelay, Irresolution> {
        let continuous = self.domain == TimeDomain::Continuous;
        if continuous && self.gain_at_infinity().is_none_or(|gain| gain.abs() >= 1.0) {
            return Ok(CriticalDelay { delay_s: 0.0, frequency_rad_per_s: f64::INFINITY });
        }
        let mut least = CriticalDelay::NONE;
        for angle in self.gain_crossovers()? {
            let (denominator, numerator) = self.at(angle);
            let turn = 2.0 * std::f64::consts::PI;
            let lag = portable::argument(-numerator / denominator);
            let lag = if lag < -1e-12 { lag + turn } else { lag.max(0.0) };
            let delay_s = lag / angle * self.time_unit();
            if delay_s < least.delay_s {
                least = CriticalDelay { delay_s, frequency_rad_per_s: self.frequency(angle) };
            }
        }
        Ok(least)
    }

    /// Angles in (0, infinity) or (0, pi] at which |n| = |c|.
    fn gain_crossovers(&self) -> Result<Vec<f64>, Irresolution> {
        let difference = self
            .squared_magnitude(&self.denominator)
            .sum(&self.squared_magnitude(&self.numerator).scaled(-1.0));
        if difference.is_zero() {
            return Ok(Vec::new());
        }
        let angles = self.angles_of_roots(&difference).map_err(Irresolution::Linear)?;
        Ok(angles.into_iter().map(|angle| self.polished(angle)).collect())
    }

    /// The largest |L| where |L| is stationary over frequency, such as at a resonance; `None` if it
    /// is stationary nowhere.
    pub(super) fn largest_peak(&self) -> Option<f64> {
        let (c, n) = (self.squared_magnitude(&self.denominator), self.squared_magnitude(&self.numerator));
        let slope = n.derivative().product(&c).sum(&n.product(&c.derivative()).scaled(-1.0));
        let peaks = self.angles_of_roots(&slope).ok()?.into_iter().map(|angle| {
            let (denominator, numerator) = self.at(angle);
            portable::magnitude(numerator) / portable::magnitude(denominator)
        });
        peaks.reduce(f64::max)
    }

    /// The angles at which a polynomial in q has its positive roots.
    fn angles_of_roots(&self, polynomial: &Polynomial) -> Result<Vec<f64>, LinearError> {
        let roots = polynomial.roots()?;
        let squares = roots.iter().filter(|root| root.im == 0.0 && root.re > 0.0).map(|root| root.re);
        let angles = squares.filter_map(|square| match self.domain {
            TimeDomain::Continuous => Some(square.sqrt()),
            // |z - 1| = 2 sin(angle/2)
            TimeDomain::Discrete { .. } => (square <= 4.0).then(|| 2.0 * portable::asin(0.5 * square.sqrt())),
        });
        Ok(angles.collect())
    }

    /// Squared magnitude |p|^2 on the stability boundary as a polynomial in q = |s|^2 or q = |v|^2.
    ///
    /// ```text
    /// continuous:  s^2 = -q:          p = a(q) + b(q) s,    |p|^2 = a^2 + b^2 q
    /// sampled:     v^2 = -q v - q:    p = a(q) + b(q) v,    |p|^2 = a^2 - a b q + b^2 q    since v + conj(v) = -q
    /// ```
    fn squared_magnitude(&self, polynomial: &Polynomial) -> Polynomial {
        let continuous = self.domain == TimeDomain::Continuous;
        let times_q = |p: &Polynomial| {
            Polynomial::new(p.coefficients().iter().copied().chain(std::iter::once(0.0)).collect())
        };
        let zero = Polynomial::new(vec![0.0]);
        let (mut a, mut b) = (zero.clone(), zero);
        for &coefficient in polynomial.coefficients() {
            let minus_q_b = times_q(&b).scaled(-1.0);
            let next = if continuous { a } else { a.sum(&minus_q_b) };
            a = minus_q_b.sum(&Polynomial::new(vec![coefficient]));
            b = next;
        }
        let squares = a.product(&a).sum(&times_q(&b.product(&b)));
        if continuous { squares } else { squares.sum(&times_q(&a.product(&b)).scaled(-1.0)) }
    }

    /// Refines a crossover by Newton's method on ln|n| - ln|c| along the boundary; one that it does
    /// not improve is unchanged.
    fn polished(&self, start: f64) -> f64 {
        let (slope_c, slope_n) = (self.denominator.derivative(), self.numerator.derivative());
        let mut angle = start;
        for _ in 0..3 {
            let point = self.boundary_point(angle);
            let speed = match self.domain {
                TimeDomain::Continuous => Complex64::new(0.0, 1.0),
                TimeDomain::Discrete { .. } => Complex64::new(0.0, 1.0) * (point + 1.0),
            };
            let (c, n) = (evaluate(&self.denominator, point), evaluate(&self.numerator, point));
            let excess = portable::ln(portable::magnitude(n) / portable::magnitude(c));
            let slope = (speed * (evaluate(&slope_n, point) / n - evaluate(&slope_c, point) / c)).re;
            let step = excess / slope;
            if step.is_nan() || step.abs() > 1e-3 * angle {
                return start;
            }
            angle -= step;
        }
        angle
    }
}
