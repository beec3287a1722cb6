use num_complex::Complex64;

/// Corners n_k of [`UNSTEADY_FRICTION`] in units of nu/R^2, and weights m_k.
///
/// ```text
/// W(tau) = sum over the zeros of J_2 of exp(-j_2n^2 tau)  ~  sum m_k exp(-n_k tau),    tau = nu t/R^2     Zielke (1968)
/// ```
///
/// Corners from the first squared zero upwards by factors of five; weights fitted to the friction
/// factor within 0.5 % for viscous frequencies w R^2/nu from 0.5 to 3e4 (W itself within 4.5 % for
/// tau from 3e-4 to 0.05).
// ORIGIN: recomputed by comparisons/recompute_lines.py
pub(super) const UNSTEADY_FRICTION: [(f64, f64); 5] =
    [(26.3744, 1.122127), (131.872, 3.123206), (659.36, 6.431796), (3296.8, 12.243534), (16484.0, 68.188558)];

/// Ratio of apparent to true inertia of a laminar oscillating flow, friction included, at s R^2/nu.
///
/// ```text
/// N = I_0(z)/I_2(z),   z^2 = s R^2/nu          dp/dx = -(rho/A) N s q
/// N -> 8 nu/(s R^2) + 4/3 for slow flow (Poiseuille),   N -> 1 + 2/z for fast flow (a boundary layer)
/// ```
///
/// Newtonian fluid, round rigid tube, small velocities: no turbulence. Evaluated by the continued
/// fraction of the ratios of modified Bessel functions, from its end backwards. Source: Zielke
/// (1968), Journal of Basic Engineering 90(1). `viscous_frequency` must not be a negative real
/// number.
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_hydraulics::line::friction_factor;
/// let slow = Complex64::new(0.0, 1e-4);
/// assert!((friction_factor(slow) - (8.0 / slow + 4.0 / 3.0)).norm_sqr() < 1e-8);
/// let fast = Complex64::new(0.0, 1e8);
/// assert!((friction_factor(fast) - 1.0).norm_sqr() < 1e-7);
/// ```
pub fn friction_factor(viscous_frequency: Complex64) -> Complex64 {
    let z = phea_dynamics::portable::sqrt_complex(viscous_frequency);
    // I_(n+1)/I_n = 1/(2 (n + 1)/z + I_(n+2)/I_(n+1)); terms beyond |z| die out faster than
    // geometrically
    let magnitude = phea_dynamics::portable::magnitude(z);
    if magnitude > 2e3 {
        // two terms of the asymptotic series leave less than 1e-9
        return Complex64::new(1.0, 0.0) + 2.0 / z + 3.0 / (z * z) + 15.0 / (4.0 * z * z * z);
    }
    let terms = 40 + (1.5 * magnitude) as u32;
    let mut ratio = Complex64::new(0.0, 0.0);
    for order in (2..terms).rev() {
        ratio = (2.0 * f64::from(order) / z + ratio).inv();
    }
    let second_over_first = ratio;
    let first_over_zeroth = (2.0 / z + second_over_first).inv();
    (first_over_zeroth * second_over_first).inv()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Zielke's weighting function: the first zeros of J_2 squared, and his expansion for short
    /// times.
    fn exact_weighting(tau: f64) -> f64 {
        // ORIGIN: Zielke (1968): zeros and coefficients of the expansion
        let zeros_squared = [26.3744, 70.8493, 135.0198, 218.9216, 322.5544];
        let half_powers = [0.282095, -1.25, 1.057855, 0.9375, 0.396696, -0.351563];
        if tau > 0.02 {
            return zeros_squared.iter().map(|zero| phea_dynamics::portable::exp(-zero * tau)).sum();
        }
        let root = tau.sqrt();
        half_powers.iter().rev().fold(0.0, |sum, coefficient| sum * root + coefficient) / root
    }

    #[test]
    fn fitted_weights_follow_the_weighting_function_of_zielke() {
        for (tau, tolerance) in [(3e-4, 0.045), (1e-3, 0.02), (3e-3, 0.02), (1e-2, 0.02), (3e-2, 0.045)] {
            let fitted: f64 = UNSTEADY_FRICTION
                .iter()
                .map(|(corner, weight)| weight * phea_dynamics::portable::exp(-corner * tau))
                .sum();
            let error = fitted / exact_weighting(tau) - 1.0;
            assert!(error.abs() < tolerance, "W({tau}) is {error} off");
        }
        // at long times friction adds a third to the inertia: 4 W integrated over tau
        let inertia: f64 = UNSTEADY_FRICTION.iter().map(|(corner, weight)| 4.0 * weight / corner).sum();
        assert!((inertia - 1.0 / 3.0).abs() < 3e-3, "{inertia}");
    }

    #[test]
    fn fitted_weights_give_the_friction_factor() {
        let mut viscous = 0.5;
        while viscous < 3e4 {
            let s = Complex64::new(0.0, viscous);
            let unsteady: Complex64 =
                UNSTEADY_FRICTION.iter().map(|(corner, weight)| 4.0 * weight / (s + corner)).sum();
            let fitted = 1.0 + 8.0 / s + unsteady;
            let error = (fitted / friction_factor(s) - 1.0).norm_sqr().sqrt();
            assert!(error < 5e-3, "{error} at {viscous}");
            viscous *= 1.3;
        }
    }

    #[test]
    fn the_two_ways_to_the_friction_factor_meet() {
        let below = friction_factor(Complex64::new(0.0, 3.999e6));
        let above = friction_factor(Complex64::new(0.0, 4.001e6));
        assert!((below - above).norm_sqr().sqrt() < 1e-6);
    }
}
