use phea_dynamics::scalar::Scalar;

use super::Servovalve;
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Stiffness of a sticking spool relative to its own spring: it follows 1/(1 + this) of a command
/// within the threshold.
pub(super) const STICKING_STIFFNESS: f64 = 20.0;

/// Imperfections of real spools in addition to the second-order model. Units: V, V/s.
/// [`SpoolImperfection::default`] adds nothing.
///
/// ```text
/// u = U_C within -U_n and U_n                    the amplifier saturates
/// dU/dt = r within -R and R                      the first stage delivers no more than the rate limit R
/// dr/dt = w_nv^2 (u - U - f) - 2 xi_v w_nv r     thesis (4.1) without a limit: r = dU/dt
/// df/dt = 20 (dU/dt - |dU/dt| f/h_f)             friction of the spool, h_f half the threshold
/// dz/dt = 1/2 (dU/dt - |dU/dt| z/h_z)            lag of the torque motor's iron, h_z half of width less threshold
/// y = U - U_0 - z                                position of the edges, U_0 the null bias
/// ```
///
/// Both memories are of Dahl (1976), "Solid friction damping of mechanical vibrations", AIAA
/// Journal 14(12): independent of the rate, bounded by their half widths, and without a branch.
/// After a reversal far from null, y does not change while the command covers the threshold, and
/// finally lags by the whole width (ISO 10770-1 on hysteresis and threshold).
///
/// Values measured on the valve of the thesis (section 5.2.1): null at 0.078 V rising and -0.05 V
/// falling, so that the bias is 0.014 V and the width 0.128 V. The source does not state the
/// threshold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpoolImperfection<S = f64> {
    /// Spool position U_0 at which the valve is at null, V.
    pub null_bias: S,
    /// Greatest difference between two commands that give one opening over a slow full cycle,
    /// including the threshold, V.
    pub hysteresis_width: Option<S>,
    /// Change of command that a reversal requires, V.
    pub threshold: Option<S>,
    /// Greatest rate R of the spool, V/s.
    pub rate_limit: Option<S>,
}

/// States of the spool, or their rates. Units: V, V/s; the memories are zero if the valve has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpoolState<S> {
    /// Spool position U, V.
    pub spool: S,
    /// Drive r of the spool, V/s: its rate without a limit.
    pub spool_rate: S,
    /// Friction f, V.
    pub spool_friction: S,
    /// Magnetic lag z, V.
    pub magnetic_lag: S,
}

impl SpoolImperfection {
    /// True if a hysteresis of this width does not include this threshold, both in V.
    pub(super) fn lacks_threshold(width: f64, threshold: f64) -> bool {
        width <= threshold
    }

    /// Impossible parameters of this spool; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.require("null_bias", self.null_bias, true, ParameterRequirement::FiniteNumber);
        let threshold = self.threshold.unwrap_or(0.0);
        if let Some(threshold) = self.threshold {
            problems.key(super::keys::THRESHOLD_KEY, threshold);
        }
        if let Some(width) = self.hysteresis_width {
            let includes = !SpoolImperfection::lacks_threshold(width, threshold);
            problems.require("hysteresis_width", width, includes, ParameterRequirement::AboveThreshold);
        }
        if let Some(limit) = self.rate_limit {
            problems.key(super::keys::RATE_LIMIT_KEY, limit);
        }
        problems.into_vec()
    }
}

phea_dynamics::parameters! {
    SpoolImperfection { null_bias, hysteresis_width, threshold, rate_limit }
}

impl<S: Scalar> SpoolImperfection<S> {
    /// Position of the edges: that of the spool less null bias and lag, V.
    #[inline(always)]
    pub fn opening(&self, state: &SpoolState<S>) -> S {
        let unbiased = state.spool - self.null_bias;
        if self.hysteresis_width.is_some() { unbiased - state.magnetic_lag } else { unbiased }
    }

    /// Rates of the spool's states at a command in V: the equations in the type's documentation.
    ///
    /// # Example
    /// A command beyond the nominal voltage acts like the nominal voltage:
    /// ```
    /// use phea_hydraulics::reference_rig::valve;
    /// use phea_hydraulics::servovalve::{SpoolImperfection, SpoolState};
    /// let rest = SpoolState { spool: 0.0, spool_rate: 0.0, spool_friction: 0.0, magnetic_lag: 0.0 };
    /// let at = |command: f64| SpoolImperfection::default().rates(&valve(), &rest, command).spool_rate;
    /// assert_eq!(at(1e3), at(10.0));
    /// assert_eq!(at(-3.0), -3.0 * 1099.0 * 1099.0);
    /// ```
    #[inline(always)]
    pub fn rates(&self, valve: &Servovalve<S>, state: &SpoolState<S>, command: S) -> SpoolState<S> {
        let SpoolState { spool, spool_rate, spool_friction, magnetic_lag } = *state;
        let half = S::from(0.5);
        let nominal = valve.nominal_voltage;
        let given = command.maximum(-nominal).minimum(nominal);
        let rate = match self.rate_limit {
            Some(limit) => spool_rate.maximum(-limit).minimum(limit),
            None => spool_rate,
        };
        let frequency = valve.natural_frequency;
        let threshold = self.threshold.unwrap_or(S::from(0.0));
        let held = if self.threshold.is_some() { spool_friction } else { S::from(0.0) };
        let friction_rate = self.threshold.map_or(S::from(0.0), |threshold| {
            S::from(STICKING_STIFFNESS) * memory_rate(rate, spool_friction, half * threshold)
        });
        let lag_rate = self
            .hysteresis_width
            .map_or(S::from(0.0), |width| half * memory_rate(rate, magnetic_lag, half * (width - threshold)));
        SpoolState {
            spool: rate,
            spool_rate: frequency.squared() * (given - spool - held)
                - S::from(2.0) * valve.damping_ratio * frequency * spool_rate,
            spool_friction: friction_rate,
            magnetic_lag: lag_rate,
        }
    }
}

/// Rate of a memory that follows a motion until it reaches its bound: v - |v| z/h.
fn memory_rate<S: Scalar>(rate: S, memory: S, bound: S) -> S {
    rate - rate.abs() * memory / bound
}
