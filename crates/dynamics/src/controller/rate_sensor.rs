//! Dynamics of the sensor of a rate: its filter and its dead time.

use num_complex::Complex64;

use crate::analytic::Analytic;
use crate::linear::{LinearError, Polynomial, TransferFunction};

/// Sensor of a rate that is fed forward.
///
/// ```text
/// H_v(s) = e^(-s tau)                                          no filter
/// H_v(s) = e^(-s tau) w/(s + w)                                first order
/// H_v(s) = e^(-s tau) w^2/(s^2 + 2 xi w s + w^2)               second order
/// ```
///
/// H_v(0) = 1: a gain error of the sensor is an uncertain parameter of the plant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RateSensor {
    /// Low-pass filter of the sensor.
    pub filter: RateFilter,
    /// Dead time tau in s.
    pub delay_s: f64,
}

/// A low-pass filter with a static gain of 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RateFilter {
    /// No filter: the output equals the input.
    #[default]
    None,
    /// w/(s + w).
    FirstOrder {
        /// Corner frequency w in rad/s.
        frequency_rad_per_s: f64,
    },
    /// w^2/(s^2 + 2 xi w s + w^2).
    SecondOrder {
        /// Natural frequency w in rad/s.
        frequency_rad_per_s: f64,
        /// Damping ratio xi.
        damping_ratio: f64,
    },
}

impl RateFilter {
    /// Coefficients of 1/H, highest power first; the last one is 1.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::RateFilter;
    /// assert_eq!(RateFilter::None.denominator(), [1.0]);
    /// assert_eq!(RateFilter::FirstOrder { frequency_rad_per_s: 4.0 }.denominator(), [0.25, 1.0]);
    /// let second = RateFilter::SecondOrder { frequency_rad_per_s: 2.0, damping_ratio: 0.5 };
    /// assert_eq!(second.denominator(), [0.25, 0.5, 1.0]);
    /// ```
    pub fn denominator(&self) -> Vec<f64> {
        match *self {
            RateFilter::None => vec![1.0],
            RateFilter::FirstOrder { frequency_rad_per_s } => vec![1.0 / frequency_rad_per_s, 1.0],
            RateFilter::SecondOrder { frequency_rad_per_s: w, damping_ratio } => {
                vec![1.0 / (w * w), 2.0 * damping_ratio / w, 1.0]
            }
        }
    }

    /// H at s in rad/s, or over a set of values of s.
    pub fn response<A: Analytic>(&self, s: A) -> A {
        let one = A::from(1.0);
        match *self {
            RateFilter::None => one,
            RateFilter::FirstOrder { frequency_rad_per_s } => {
                one / (s.scaled(1.0 / frequency_rad_per_s) + one)
            }
            RateFilter::SecondOrder { frequency_rad_per_s: w, damping_ratio } => {
                one / ((s * s).scaled(1.0 / (w * w)) + s.scaled(2.0 * damping_ratio / w) + one)
            }
        }
    }

    /// Filter frequency w in rad/s; `None` without a filter.
    pub fn frequency_rad_per_s(&self) -> Option<f64> {
        match *self {
            RateFilter::None => None,
            RateFilter::FirstOrder { frequency_rad_per_s }
            | RateFilter::SecondOrder { frequency_rad_per_s, .. } => Some(frequency_rad_per_s),
        }
    }

    /// Largest |H(jw)| at any frequency: 1/(2 xi sqrt(1 - xi^2)) for a filter that resonates.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::RateFilter;
    /// let second = |damping_ratio| RateFilter::SecondOrder { frequency_rad_per_s: 7.0, damping_ratio }.peak();
    /// assert_eq!((second(0.8), second(0.6)), (1.0, 1.0 / (1.2 * 0.8)));
    /// ```
    pub fn peak(&self) -> f64 {
        match *self {
            RateFilter::SecondOrder { damping_ratio: xi, .. } if 2.0 * xi * xi < 1.0 => {
                1.0 / (2.0 * xi * (1.0 - xi * xi).sqrt())
            }
            _ => 1.0,
        }
    }
}

impl RateSensor {
    /// True if H_v is 1.
    pub fn is_direct(&self) -> bool {
        *self == RateSensor::default()
    }

    /// H_v(s).
    ///
    /// # Errors
    /// [`LinearError`] for a frequency or a damping ratio that is not positive, or a negative dead
    /// time.
    ///
    /// # Example
    /// A filter at its corner with 1 ms of dead time: half the power, and a lag of 45 degrees plus
    /// 0.1 rad.
    /// ```
    /// use phea_dynamics::controller::{RateFilter, RateSensor};
    /// use phea_dynamics::portable::argument;
    /// let filter = RateFilter::FirstOrder { frequency_rad_per_s: 100.0 };
    /// let shown = RateSensor { filter, delay_s: 1e-3 }.transfer_function()?.at_frequency(100.0);
    /// assert!((shown.norm_sqr() - 0.5).abs() < 1e-15);
    /// assert!((argument(shown) + std::f64::consts::FRAC_PI_4 + 0.1).abs() < 1e-14);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn transfer_function(&self) -> Result<TransferFunction, LinearError> {
        let denominator = Polynomial::new(self.filter.denominator());
        TransferFunction::from_polynomials(&Polynomial::new(vec![1.0]), &denominator)?
            .with_dead_time(self.delay_s)
    }

    /// H_v(jw).
    pub fn at_frequency(&self, frequency_rad_per_s: f64) -> Complex64 {
        let s = Complex64::new(0.0, frequency_rad_per_s);
        let filtered = self.filter.response(s);
        if self.delay_s == 0.0 { filtered } else { filtered * Analytic::exponential(-s * self.delay_s) }
    }
}
