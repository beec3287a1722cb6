//! Virtual impedance of an outer loop: mass, damper and spring between a load and its rest
//! position.

use crate::analytic::Analytic;
use crate::linear::{LinearError, Polynomial, TransferFunction};

/// Virtual impedance: the force by which the reference yields to the position of a load.
///
/// ```text
/// Z_v(s) = (M_v s^2 + B_v s + K_v)/(tau s + 1)^n        n = 2 with a mass, 1 with a damper, 0 with only a spring
/// u = G (F r - y),    y = H (F_e + Z_v (x_L - x_0))
/// ```
///
/// The filter makes damper and mass proper; without damper and mass there is no filter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VirtualImpedance {
    /// Virtual mass M_v in kg.
    pub mass: f64,
    /// Virtual damping B_v in N s/m.
    pub damping: f64,
    /// Virtual stiffness K_v in N/m.
    pub stiffness: f64,
    /// Filter time constant tau in s.
    pub filter_time_s: f64,
}

impl VirtualImpedance {
    /// True if Z_v is zero.
    pub fn is_zero(&self) -> bool {
        self.mass == 0.0 && self.damping == 0.0 && self.stiffness == 0.0
    }

    /// Coefficients of M_v s^2 + B_v s + K_v, highest power first, without leading zeros.
    pub fn numerator(&self) -> Vec<f64> {
        let all = vec![self.mass, self.damping, self.stiffness];
        all.into_iter().skip(2 - self.order()).collect()
    }

    /// Coefficients of (tau s + 1)^n, highest power first; the last one is 1.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::VirtualImpedance;
    /// let spring = VirtualImpedance { stiffness: 8.0, ..VirtualImpedance::default() };
    /// assert_eq!((spring.numerator(), spring.denominator()), (vec![8.0], vec![1.0]));
    /// let damped = VirtualImpedance { damping: 3.0, filter_time_s: 0.5, ..spring };
    /// assert_eq!((damped.numerator(), damped.denominator()), (vec![3.0, 8.0], vec![0.5, 1.0]));
    /// let heavy = VirtualImpedance { mass: 2.0, ..damped };
    /// assert_eq!((heavy.numerator(), heavy.denominator()), (vec![2.0, 3.0, 8.0], vec![0.25, 1.0, 1.0]));
    /// ```
    pub fn denominator(&self) -> Vec<f64> {
        let tau = self.filter_time_s;
        match self.order() {
            0 => vec![1.0],
            1 => vec![tau, 1.0],
            _ => vec![tau * tau, 2.0 * tau, 1.0],
        }
    }

    /// Number of poles n.
    pub fn order(&self) -> usize {
        match (self.mass != 0.0, self.damping != 0.0) {
            (true, _) => 2,
            (false, true) => 1,
            (false, false) => 0,
        }
    }

    /// Z_v.
    ///
    /// # Errors
    /// [`LinearError`] for a damper or a mass without a filter.
    pub fn transfer_function(&self) -> Result<TransferFunction, LinearError> {
        TransferFunction::from_polynomials(
            &Polynomial::new(self.numerator()),
            &Polynomial::new(self.denominator()),
        )
    }

    /// 1/(M_v s^2 + B_v s + K_v), without the filter: the displacement of the load per unit of
    /// force. In series with a position controller it gives a force controller, see the theory of
    /// impedance control.
    ///
    /// # Errors
    /// [`LinearError`] for an impedance of zero.
    pub fn admittance(&self) -> Result<TransferFunction, LinearError> {
        TransferFunction::from_polynomials(&Polynomial::new(vec![1.0]), &Polynomial::new(self.numerator()))
    }

    /// Z_v at s in rad/s, or over a set of values of s.
    pub fn response<A: Analytic>(&self, s: A) -> A {
        let own = (s * s).scaled(self.mass) + s.scaled(self.damping) + A::from(self.stiffness);
        let lag = s.scaled(self.filter_time_s) + A::from(1.0);
        match self.order() {
            0 => own,
            1 => own / lag,
            _ => own / (lag * lag),
        }
    }

    /// Upper bound of |Z_v(jv)| for every v: each term at its largest.
    ///
    /// # Example
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::controller::VirtualImpedance;
    /// let heavy = VirtualImpedance { mass: 2.0, damping: 3.0, stiffness: 8.0, filter_time_s: 0.5 };
    /// for frequency in [0.1, 1.0, 10.0, 1e4] {
    ///     assert!(heavy.response(Complex64::new(0.0, frequency)).norm_sqr().sqrt() <= heavy.bound());
    /// }
    /// ```
    pub fn bound(&self) -> f64 {
        let tau = self.filter_time_s;
        match self.order() {
            0 => self.stiffness,
            1 => self.stiffness + self.damping / tau,
            _ => self.stiffness + self.damping / (2.0 * tau) + self.mass / (tau * tau),
        }
    }

    /// Half-power frequency of the filter in rad/s, where the impedance begins to lag; `None`
    /// without a filter.
    pub fn corner_rad_per_s(&self) -> Option<f64> {
        (self.order() > 0 && self.filter_time_s > 0.0).then(|| 1.0 / self.filter_time_s)
    }
}
