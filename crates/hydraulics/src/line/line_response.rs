use num_complex::Complex64;
use phea_dynamics::portable::{exp_complex, sqrt_complex};

use super::Conduit;

/// Response of a line that is symmetric between its ends, at one complex frequency.
///
/// ```text
/// p_1 = p_2, q_1 = q_2 into the line:  in_phase = p/q           p_1 = -p_2, q_1 = -q_2:  in_opposition = p/q
/// ```
///
/// Impedances in Pa s/m3. A line is passive if both have a non-negative real part on the imaginary
/// axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineResponse {
    /// Impedance with both ends in phase: the compliance of the line.
    pub in_phase: Complex64,
    /// Impedance with both ends in opposition: the resistance to flow through the line.
    pub in_opposition: Complex64,
}

impl LineResponse {
    /// Response of one wave in each direction: Z coth(Gamma/2) and Z tanh(Gamma/2).
    pub(super) fn of_wave(impedance: Complex64, propagation: Complex64) -> LineResponse {
        let passed = exp_complex(-propagation);
        let coth = (1.0 + passed) / (1.0 - passed);
        LineResponse { in_phase: impedance * coth, in_opposition: impedance / coth }
    }

    /// Transfer matrix t with (p_1, q_1) = t (p_2, q_2), flows counted from end 1 to end 2; its
    /// determinant is 1.
    ///
    /// # Example
    /// A short lossless line is a capacity between two inertances.
    /// ```
    /// use num_complex::Complex64;
    /// use phea_hydraulics::line::Conduit;
    /// let conduit = Conduit {
    ///     length: 0.01, bore: 12.7e-3, density: 870.0, kinematic_viscosity: 46e-6, effective_bulk_modulus: 2.609e8,
    /// };
    /// let s = Complex64::new(0.0, 10.0);
    /// let [[_, inertia], [capacity, _]] = conduit.response(s, Complex64::new(1.0, 0.0)).transfer_matrix();
    /// assert!((inertia / (s * conduit.inertance()) - 1.0).norm_sqr() < 1e-12);
    /// assert!((capacity / (s * conduit.compliance()) - 1.0).norm_sqr() < 1e-12);
    /// ```
    pub fn transfer_matrix(&self) -> [[Complex64; 2]; 2] {
        let own = (self.in_phase + self.in_opposition) / 2.0;
        let mutual = (self.in_phase - self.in_opposition) / 2.0;
        let straight = own / mutual;
        [[straight, self.in_phase * self.in_opposition / mutual], [mutual.inv(), straight]]
    }
}

impl Conduit {
    /// Response of the exact line at s in rad/s, for this factor of its inertia.
    ///
    /// ```text
    /// Gamma = s T sqrt(N)      Z = Z_c sqrt(N)      p_1 = p_2 cosh Gamma + q_2 Z sinh Gamma
    /// ```
    ///
    /// N = 1 without friction, N = 1 + 8 nu/(s R^2) with that of steady flow, and
    /// [`super::friction_factor`] of s/[`Conduit::viscous_rate`] with that of laminar flow. Source:
    /// D'Souza and Oldenburger (1964), Journal of Basic Engineering 86(3).
    pub fn response(&self, s: Complex64, factor: Complex64) -> LineResponse {
        let root = sqrt_complex(factor);
        LineResponse::of_wave(self.characteristic_impedance() * root, s * self.delay() * root)
    }
}
