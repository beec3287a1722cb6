//! Spool in a test so slow that only its memories lag.

use phea_dynamics::scalar::Scalar;

use super::SpoolImperfection;
use super::spool::STICKING_STIFFNESS;

/// Newton steps for a sticking spool; its friction curve bends in one direction, so that each step
/// stays on one side.
const STICKING_STEPS: usize = 12;

/// Memory of a slowly moved spool. Units: V.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowSpool<S = f64> {
    /// Position U of the spool.
    pub spool: S,
    /// Friction f of the spool, as command.
    pub friction: S,
    /// Lag z of the torque motor's iron.
    pub magnetic_lag: S,
}

/// Delay of the spool behind a command that rises or falls steadily, s.
///
/// ```text
/// U'' = w^2 (U_C - U) - 2 xi w U' = 0    ->    U_C - U = (2 xi/w) U'            thesis (4.1)
/// ```
///
/// # Example
/// The spool of 175 Hz with a damping ratio of 0.9 lags a command of 0.1 V/s by 0.16 mV:
/// ```
/// use phea_hydraulics::servovalve::ramp_delay;
/// assert!((0.1 * ramp_delay(1100.0, 0.9) - 1.6363636e-4_f64).abs() < 1e-10);
/// ```
pub fn ramp_delay<S: Scalar>(natural_frequency: S, damping_ratio: S) -> S {
    damping_ratio.times(2.0) / natural_frequency
}

impl<S: Scalar> SlowSpool<S> {
    /// Spool at rest at a command, without memory.
    pub fn at(command: S) -> SlowSpool<S> {
        SlowSpool { spool: command, friction: S::from(0.0), magnetic_lag: S::from(0.0) }
    }
}

impl<S: Scalar> SpoolImperfection<S> {
    /// Position of the edges in V after the command moved monotonically to a new value in V,
    /// infinitely slowly: [`SpoolImperfection::rates`] integrated along the path.
    ///
    /// ```text
    /// U + f = U_C                                                     thesis (4.1) at rest
    /// f = s h_f + (f_0 - s h_f) exp(-20 |dU|/h_f)                     h_f half the threshold, s the sign of dU
    /// z = s h_z + (z_0 - s h_z) exp(-|dU|/(2 h_z))                    h_z half of width less threshold
    /// y = U - U_0 - z
    /// ```
    ///
    /// The caller must avoid commands beyond the nominal voltage.
    ///
    /// # Example
    /// Far from a reversal the opening lags by half the width in either direction:
    /// ```
    /// use phea_hydraulics::servovalve::{SlowSpool, SpoolImperfection};
    /// let spool = SpoolImperfection { null_bias: 0.014, hysteresis_width: Some(0.128), ..Default::default() };
    /// let mut memory = SlowSpool::at(-3.0);
    /// assert!((spool.slow_opening(&mut memory, 0.078) - 0.0_f64).abs() < 1e-9);
    /// spool.slow_opening(&mut memory, 3.0);
    /// assert!((spool.slow_opening(&mut memory, -0.05) - 0.0_f64).abs() < 1e-9);
    /// ```
    pub fn slow_opening(&self, memory: &mut SlowSpool<S>, command: S) -> S {
        let zero = S::from(0.0);
        let falls = command.less_than(memory.spool + memory.friction);
        let toward = |half_width: S| S::select(falls, -half_width, half_width);
        let before = memory.spool;
        memory.spool = command;
        let threshold = self.threshold.unwrap_or(zero);
        if self.threshold.is_some() {
            let bound = threshold.times(0.5);
            let (end, stiffness) = (toward(bound), S::from(STICKING_STIFFNESS));
            let [mut spool, mut friction] = [before, memory.friction];
            for _ in 0..STICKING_STEPS {
                let slope = S::from(1.0) + stiffness * (S::from(1.0) - friction / end);
                spool = spool - (spool + friction - command) / slope;
                friction =
                    end + (memory.friction - end) * (-stiffness * (spool - before).abs() / bound).exp();
            }
            (memory.spool, memory.friction) = (spool, friction);
        }
        if let Some(width) = self.hysteresis_width {
            let bound = (width - threshold).times(0.5);
            let end = toward(bound);
            let travelled = (memory.spool - before).abs();
            memory.magnetic_lag = end + (memory.magnetic_lag - end) * (-travelled / bound.times(2.0)).exp();
            return memory.spool - self.null_bias - memory.magnetic_lag;
        }
        memory.spool - self.null_bias
    }
}
