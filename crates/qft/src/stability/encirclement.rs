//! Counting closed-loop poles outside the stable region by the turns of the characteristic function
//! on its boundary.
//!
//! ```text
//! f(s) = c(s) + n(s) e^(-s T)          has no poles, so neither integrators nor an unstable plant need a detour
//! Z = N/2 - (1/pi) (change of arg f(j w), w = 0 .. infinity)       N = degree of c
//! Z = N - (1/pi) (change of arg f, w T = 0 .. pi)                  sampled: zeros on or outside the unit circle
//! ```
//!
//! The steps are chosen so that f, expanded at the left end, stays within a disc that does not
//! contain zero: no turn is missed.

use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TimeDomain};
use phea_dynamics::portable;

use super::Irresolution;
use super::characteristic::Characteristic;
use super::product::RootProduct;

/// Largest number of expansions of one loop.
const STEPS_MAXIMUM: usize = 50_000;
/// Radius of the disc around f that a step may fill, as a fraction of |f|: below 1 the disc does
/// not contain zero.
const DISC: f64 = 0.95;

/// The result of a walk along the stability boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Encirclement {
    /// Number Z of unstable poles.
    pub(super) unstable_poles: usize,
    /// The smallest |1 + L| = |f/c|, and its angle.
    pub(super) closest: (f64, f64),
}

impl Characteristic {
    /// Walks along the stability boundary.
    ///
    /// # Errors
    /// [`Irresolution::NearBoundary`] if |f| does not exceed its rounding error,
    /// [`Irresolution::Budget`], [`Irresolution::GainAtInfinity`] for a delayed loop with |L| >= 1
    /// at infinite frequency.
    pub(super) fn encirclement(&self) -> Result<Encirclement, Irresolution> {
        let mut visited: Vec<(f64, f64)> = Vec::new();
        let unstable_poles = self.walked(&mut |angle| visited.push((self.distance(angle), angle)))?;
        Ok(Encirclement { unstable_poles, closest: self.closest(&visited) })
    }

    /// Number Z of unstable poles, without the closest approach.
    ///
    /// # Errors
    /// Errors of [`Characteristic::encirclement`].
    pub(super) fn unstable_poles(&self) -> Result<usize, Irresolution> {
        self.walked(&mut |_| {})
    }

    fn walked(&self, visit: &mut dyn FnMut(f64)) -> Result<usize, Irresolution> {
        let walk = BoundaryWalk::new(self)?;
        let mut angle = 0.0;
        let mut reach = walk.end;
        let mut turned = 0.0;
        let mut previous: Option<Complex64> = None;
        for _ in 0..STEPS_MAXIMUM {
            let local = walk.expanded(angle);
            turned += previous.map_or(0.0, |previous| portable::argument(local.value / previous));
            previous = Some(local.value);
            visit(angle);
            if angle >= walk.end {
                return walk.unstable_poles(turned, local.value, angle);
            }
            reach = (2.0 * reach).min(walk.end - angle);
            let size = portable::magnitude(local.value);
            while local.change(reach, self.delay) + local.rounding >= DISC * size {
                reach *= 0.7;
                if reach <= 1e-14 * angle || reach < f64::MIN_POSITIVE {
                    return Err(Irresolution::NearBoundary { frequency_rad_per_s: self.frequency(angle) });
                }
            }
            angle = if reach >= walk.end - angle { walk.end } else { angle + reach };
        }
        Err(Irresolution::Budget { frequency_rad_per_s: self.frequency(angle) })
    }

    /// Distance |1 + L|; infinite at a pole of L.
    pub(super) fn distance(&self, angle: f64) -> f64 {
        let (denominator, numerator) = self.at(angle);
        let distance = portable::magnitude(denominator + numerator) / portable::magnitude(denominator);
        if distance.is_nan() { f64::INFINITY } else { distance }
    }

    /// The smallest distance: each minimum near the smallest visited point is refined between its
    /// neighbours.
    fn closest(&self, visited: &[(f64, f64)]) -> (f64, f64) {
        const NEAR: f64 = 1.25;
        let nearer = |best: (f64, f64), next: (f64, f64)| if next.0 < best.0 { next } else { best };
        let smallest = visited.iter().copied().fold((f64::INFINITY, 0.0), nearer);
        let mut best = smallest;
        for (index, visit) in visited.iter().enumerate() {
            let &(distance, _) = visit;
            let before = index.checked_sub(1).and_then(|before| visited.get(before)).unwrap_or(visit);
            let after = visited.get(index + 1).unwrap_or(visit);
            if distance <= NEAR * smallest.0 && distance <= before.0 && distance <= after.0 {
                best = nearer(best, self.golden_section(before.1, after.1));
            }
        }
        match self.gain_at_infinity() {
            Some(gain) if self.domain == TimeDomain::Continuous && gain != 0.0 => {
                let limit = if self.delay > 0.0 { (1.0 - gain.abs()).abs() } else { (1.0 + gain).abs() };
                nearer(best, (limit, f64::INFINITY))
            }
            _ => best,
        }
    }

    fn golden_section(&self, low: f64, high: f64) -> (f64, f64) {
        const FRACTION: f64 = 0.381_966_011_250_105_1;
        let (mut low, mut high) = (low, high);
        let at = |angle: f64| (self.distance(angle), angle);
        let (mut left, mut right) = (at(low + FRACTION * (high - low)), at(high - FRACTION * (high - low)));
        for _ in 0..40 {
            if left.0 < right.0 {
                (high, right) = (right.1, left);
                left = at(low + FRACTION * (high - low));
            } else {
                (low, left) = (left.1, right);
                right = at(high - FRACTION * (high - low));
            }
        }
        if left.0 < right.0 { left } else { right }
    }
}

/// Function f split into the parts without and with the delay, and the end of the walk.
struct BoundaryWalk<'a> {
    characteristic: &'a Characteristic,
    prompt: Polynomial,
    delayed: Polynomial,
    end: f64,
}

/// Expansion of f around one point of the boundary, f(s + u) = sum a_k u^k + e^(-u T) sum b_k u^k:
/// bounds on the magnitudes of a_k and b_k.
struct Expansion {
    value: Complex64,
    rounding: f64,
    prompt: Vec<f64>,
    delayed: Vec<f64>,
}

impl<'a> BoundaryWalk<'a> {
    fn new(characteristic: &'a Characteristic) -> Result<BoundaryWalk<'a>, Irresolution> {
        let Characteristic { denominator, numerator, delay, domain, .. } = characteristic;
        let (prompt, delayed) = if *delay > 0.0 {
            (denominator.clone(), numerator.clone())
        } else {
            (denominator.sum(numerator), Polynomial::new(vec![0.0]))
        };
        let end = match domain {
            TimeDomain::Continuous => end_of_axis(&prompt, &delayed)?,
            TimeDomain::Discrete { .. } => std::f64::consts::PI,
        };
        Ok(BoundaryWalk { characteristic, prompt, delayed, end })
    }

    fn expanded(&self, angle: f64) -> Expansion {
        let point = self.characteristic.boundary_point(angle);
        if let Some([numerator, denominator]) = &self.characteristic.products {
            return self.expanded_products(angle, numerator, denominator);
        }
        let (prompt, delayed) = (taylor(&self.prompt, point), taylor(&self.delayed, point));
        let first = |terms: &[Complex64]| terms.first().copied().unwrap_or_default();
        let radius = portable::magnitude(point);
        let scale = |polynomial: &Polynomial| {
            polynomial.coefficients().iter().fold(0.0, |sum, c| sum * radius + c.abs())
        };
        let degree = self.prompt.degree().max(self.delayed.degree()) as f64;
        let turn = angle * self.characteristic.delay;
        Expansion {
            value: first(&prompt) + first(&delayed) * self.characteristic.lag(angle),
            rounding: f64::EPSILON
                * (4.0 * (degree + 1.0) * (scale(&self.prompt) + scale(&self.delayed))
                    + turn * scale(&self.delayed)),
            prompt: prompt.iter().map(size).collect(),
            delayed: delayed.iter().map(size).collect(),
        }
    }

    /// Expansion of a sampled loop by its roots.
    fn expanded_products(&self, angle: f64, numerator: &RootProduct, denominator: &RootProduct) -> Expansion {
        let point = self.characteristic.boundary_point(angle);
        let (c, n) = (denominator.at(point), numerator.at(point));
        let (size_c, size_n) = (portable::magnitude(c), portable::magnitude(n));
        let factors = (denominator.roots.len() + numerator.roots.len()) as f64;
        let turn = angle * self.characteristic.delay;
        Expansion {
            value: c + n * self.characteristic.lag(angle),
            rounding: f64::EPSILON * (4.0 * (factors + 1.0) * (size_c + size_n) + turn * size_n),
            prompt: denominator.majorant(point),
            delayed: numerator.majorant(point),
        }
    }

    /// Number Z of unstable poles, from the change of arg f along the upper half of the boundary.
    fn unstable_poles(&self, turned: f64, last: Complex64, end: f64) -> Result<usize, Irresolution> {
        let pi = std::f64::consts::PI;
        let count = match self.characteristic.domain {
            TimeDomain::Continuous => {
                // beyond the end, f stays within a half plane around c_0 (j w)^N
                let mut direction = Complex64::new(self.prompt.leading_coefficient(), 0.0);
                for _ in 0..self.prompt.degree() {
                    direction *= Complex64::new(0.0, 1.0);
                }
                self.prompt.degree() as f64 / 2.0 + (portable::argument(last / direction) - turned) / pi
            }
            TimeDomain::Discrete { .. } => self.characteristic.sampled_degree() - turned / pi,
        };
        let whole = count.round();
        if (count - whole).abs() > 1e-6 || whole < 0.0 {
            return Err(Irresolution::Budget { frequency_rad_per_s: self.characteristic.frequency(end) });
        }
        Ok(whole as usize)
    }
}

impl Expansion {
    /// Upper bound on the change of f within a distance along the boundary.
    fn change(&self, distance: f64, delay: f64) -> f64 {
        let sum = |sizes: &[f64]| sizes.iter().skip(1).rev().fold(0.0, |sum, size| (sum + size) * distance);
        let turned = self.delayed.first().copied().unwrap_or(0.0) * (delay * distance).min(2.0);
        sum(&self.prompt) + sum(&self.delayed) + turned
    }
}

/// Bound |Re| + |Im|, which is never below the magnitude.
fn size(value: &Complex64) -> f64 {
    value.re.abs() + value.im.abs()
}

/// Coefficients of p(s + u) in u, lowest power first, by repeated synthetic division.
fn taylor(polynomial: &Polynomial, point: Complex64) -> Vec<Complex64> {
    let mut terms: Vec<Complex64> =
        polynomial.coefficients().iter().map(|&c| Complex64::new(c, 0.0)).collect();
    for last in (0..terms.len()).rev() {
        let mut sum = Complex64::new(0.0, 0.0);
        for term in terms.iter_mut().take(last + 1) {
            sum = sum * point + *term;
            *term = sum;
        }
    }
    terms.reverse();
    terms
}

/// Frequency above which the highest power dominates: beyond it |f/(c_0 s^N) - 1| stays below 1 in
/// the whole right half plane.
fn end_of_axis(prompt: &Polynomial, delayed: &Polynomial) -> Result<f64, Irresolution> {
    let leading = prompt.leading_coefficient().abs();
    let improper = delayed.degree() > prompt.degree();
    let same = delayed.degree() == prompt.degree();
    let gain = if same { delayed.leading_coefficient().abs() / leading } else { 0.0 };
    if improper || gain >= 1.0 {
        return Err(Irresolution::GainAtInfinity);
    }
    // (|c_1| s^(N-1) + ... + |n_0| s^m + ...)/(|c_0| s^N)
    let fraction = |frequency: f64| {
        let rest = |polynomial: &Polynomial, skipped: usize| {
            let cache = polynomial.coefficients().iter().skip(skipped);
            let sum = cache.rev().fold(0.0, |sum, c| sum / frequency + c.abs());
            (0..prompt.degree() - polynomial.degree() + skipped).fold(sum, |sum, _| sum / frequency)
        };
        (rest(prompt, 1) + rest(delayed, 0)) / leading
    };
    let allowed = (0.9_f64).max(0.5 * (1.0 + gain));
    let mut end = 1.0;
    for _ in 0..1000 {
        if fraction(end) <= allowed {
            break;
        }
        end *= 2.0;
    }
    for _ in 0..1000 {
        if fraction(0.5 * end) > allowed {
            break;
        }
        end *= 0.5;
    }
    if fraction(end) <= allowed { Ok(end) } else { Err(Irresolution::GainAtInfinity) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roots with real parts of either sign over six decades, some of them close to the axis.
    fn random_roots(random: &mut impl FnMut() -> f64, count: usize) -> Vec<Complex64> {
        let mut roots = Vec::new();
        while roots.len() < count {
            let size = portable::exp(13.8 * (random() - 0.5));
            let damping = if random() < 0.3 { 1e-6 } else { random() };
            let real = size * damping * if random() < 0.2 { 1.0 } else { -1.0 };
            if count - roots.len() > 1 && random() < 0.6 {
                let imaginary = size * (1.0 - damping * damping).sqrt();
                roots.extend([Complex64::new(real, imaginary), Complex64::new(real, -imaginary)]);
            } else {
                roots.push(Complex64::new(real, 0.0));
            }
        }
        roots
    }

    /// The turns count the prescribed roots, whichever part of the polynomial is the numerator.
    #[test]
    fn turns_count_the_roots_outside() {
        let mut seed = 7_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut resolved = 0;
        for trial in 0..300 {
            let roots = random_roots(&mut random, 1 + trial % 7);
            let closed = Polynomial::from_roots(2.0, &roots).unwrap();
            let outside = roots.iter().filter(|root| root.re > 0.0).count();
            // any part of the polynomial may be the numerator
            let part = |cache: &dyn Fn(usize) -> bool| {
                let terms = closed.coefficients().iter().enumerate();
                Polynomial::new(terms.map(|(i, &c)| if cache(i) { c } else { 0.0 }).collect())
            };
            let continuous = Characteristic {
                denominator: part(&|index| index <= trial % 5),
                numerator: part(&|index| index > trial % 5),
                products: None,
                delay: 0.0,
                domain: TimeDomain::Continuous,
            };
            let found = continuous.encirclement().unwrap();
            assert_eq!(found.unstable_poles, outside, "{roots:?}");

            // these roots mapped to samples by (2 + s)/(2 - s), less one
            let shifted: Vec<Complex64> = roots.iter().map(|root| 2.0 * root / (2.0 - root)).collect();
            let sampled = Characteristic {
                denominator: Polynomial::from_roots(1.0, &shifted).unwrap(),
                numerator: Polynomial::new(vec![0.0]),
                products: Some([
                    RootProduct { gain: 0.0, roots: vec![] },
                    RootProduct { gain: 1.0, roots: shifted },
                ]),
                delay: 0.0,
                domain: TimeDomain::Discrete { sample_time_s: 1.0 },
            };
            // fast roots are crowded around z = -1, where some cannot be distinguished from the
            // circle
            if let Ok(found) = sampled.encirclement() {
                assert_eq!(found.unstable_poles, outside, "{roots:?}");
                resolved += 1;
            }
        }
        assert!(resolved > 270, "{resolved}");
    }
}
