//! Design of inner feedback, before the loop around it: gain and corner of its high pass for the
//! largest gain of a proportional loop around every plant.
//!
//! ```text
//! u = -K y - H p,   y = P u,   p = Q u        P' = P/(1 + H Q)        H(s) = k s/(s + w_h) w_l/(s + w_l)
//! maximise over k, w_h   K(k, w_h) min |P'(j w_0)|                    over all plants, w_0 below the resonances
//! K      largest gain up to which  |1 + K P'| >= m,  |K P'/(1 + K P')| <= 1/sqrt(2) from w_b on,
//!        and no delay up to T_m makes H Q + K P reach -1
//! k      up to where the loop H Q also satisfies these limits, and its noise moves the command by no more than allowed
//! ```
//!
//! The design proceeds from the inside out: the inner loop is fast and has separate margins, so
//! that it remains stable if the outer one is opened, limited or reshaped. A plant with one lightly
//! damped resonance w in series with an integrator reaches a loop gain of 2 xi w (1 - m): there the
//! criterion amounts to the damping. Both limits on a gain are closed forms at each frequency, so
//! no search over loops is needed: one that completes whole designs would repeat minutes of work
//! for each corner.

mod limits;
mod search;

use num_complex::Complex64;
use phea_dynamics::controller::{InnerFeedback, Timing};
use phea_dynamics::linear::{LinearError, TransferFunction};

/// A plant at one frequency, with hold and delay of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerPoint {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Response P from the command to the output.
    pub plant: Complex64,
    /// Response Q from the command to the inner signal.
    pub signal: Complex64,
}

/// A plant that is stable without feedback, at increasing frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct InnerPlant {
    /// Frequencies dense enough for its resonances, up to pi/T of a sampled loop.
    pub points: Vec<InnerPoint>,
    /// The frequency w_0 at which loop gains are compared, common to every plant.
    pub reference: InnerPoint,
}

/// Limits on both loops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerLoopLimits {
    /// Least distance m of either loop from -1.
    pub modulus_margin: f64,
    /// Delay T_m that both loops together must tolerate, s.
    pub delay_margin_s: f64,
    /// Frequency w_b above which the outer loop must be below -3 dB, rad/s; infinite if any
    /// bandwidth is allowed.
    pub highest_bandwidth_rad_per_s: f64,
    /// Noise of the inner signal at the samples and the command that it may cause, both rms; `None`
    /// without noise or without a limit.
    pub noise: Option<[f64; 2]>,
}

/// Plants and limits for which the feedback is designed.
#[derive(Clone, Debug, PartialEq)]
pub struct InnerLoopProblem {
    /// The plants.
    pub plants: Vec<InnerPlant>,
    /// Sampling of the loop, and the rule by which H is discretised.
    pub timing: Timing,
    /// Corner w_l of the low pass, rad/s; `None` without a low pass.
    pub low_pass_rad_per_s: Option<f64>,
    /// Least and greatest corner w_h of the high pass, rad/s.
    pub high_pass_rad_per_s: [f64; 2],
    /// Limits on both loops.
    pub limits: InnerLoopLimits,
}

/// Performance of the plants with an inner feedback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerLoopReach {
    /// Least loop gain K min |P'(j w_0)|.
    pub loop_gain: f64,
    /// Outer gain K.
    pub outer_gain: f64,
    /// The plant that limits K.
    pub plant: usize,
    /// Frequency at which the plant limits K, rad/s.
    pub frequency_rad_per_s: f64,
}

/// The best feedback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundInnerFeedback {
    /// Inner feedback H.
    pub feedback: InnerFeedback,
    /// Performance with the feedback.
    pub reach: InnerLoopReach,
    /// Performance without the feedback.
    pub without: InnerLoopReach,
}

impl InnerLoopProblem {
    /// Performance of the plants with this feedback; `None` if the inner loop violates a limit, and
    /// without plants.
    ///
    /// # Errors
    /// [`LinearError`] for a feedback that cannot be sampled.
    ///
    /// # Example
    /// A resonance of 10 rad/s with a damping ratio of 0.01, in series with an integrator, reaches
    /// 2 xi w (1 - m) = 0.1 rad/s; reference 1 rad/s.
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::controller::{InnerFeedback, Timing};
    /// use phea_qft::inner_loop::{InnerLoopLimits, InnerLoopProblem, InnerPlant, InnerPoint};
    /// let at = |frequency_rad_per_s: f64| {
    ///     let s = Complex64::new(0.0, frequency_rad_per_s);
    ///     InnerPoint { frequency_rad_per_s, plant: 100.0 / (s * (s * s + 0.2 * s + 100.0)), signal: Complex64::ZERO }
    /// };
    /// let points = (1..=2000).map(|step| at(0.01 * f64::from(step))).collect();
    /// let limits = InnerLoopLimits {
    ///     modulus_margin: 0.5, delay_margin_s: 0.0, highest_bandwidth_rad_per_s: f64::INFINITY, noise: None,
    /// };
    /// let problem = InnerLoopProblem {
    ///     plants: vec![InnerPlant { points, reference: at(1.0) }],
    ///     timing: Timing::default(), low_pass_rad_per_s: None, high_pass_rad_per_s: [0.1, 1.0], limits,
    /// };
    /// let reach = problem.reach(&InnerFeedback::default())?.ok_or("it has a plant")?;
    /// assert!((reach.loop_gain - 0.1).abs() < 2e-3 && (reach.frequency_rad_per_s - 10.0).abs() < 0.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn reach(&self, feedback: &InnerFeedback) -> Result<Option<InnerLoopReach>, LinearError> {
        let all: Vec<usize> = (0..self.plants.len()).collect();
        let unit = limits::FedBackPlants::new(self, &InnerFeedback { gain: 1.0, ..*feedback }, &all)?;
        Ok(unit.reach(feedback.gain))
    }

    /// The feedback with the largest loop gain, with the inner loop within its limits for every
    /// plant; `None` without plants, or if no positive gain satisfies the limits.
    ///
    /// # Errors
    /// [`LinearError`] for a feedback that cannot be sampled.
    ///
    /// # Example
    /// A mass on two springs, one of them of oil: feedback of the pressure damps it.
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::controller::Timing;
    /// use phea_qft::inner_loop::{InnerLoopLimits, InnerLoopProblem, InnerPlant, InnerPoint};
    /// let at = |frequency_rad_per_s: f64| {
    ///     let s = Complex64::new(0.0, frequency_rad_per_s);
    ///     let resonance = s * s + 0.2 * s + 100.0;
    ///     let (plant, signal) = (2304.0 / (s * resonance), 36.0 * (s * s + 64.0) / (s * resonance));
    ///     InnerPoint { frequency_rad_per_s, plant, signal }
    /// };
    /// let points = (1..=2000).map(|step| at(0.01 * f64::from(step))).collect();
    /// let limits = InnerLoopLimits {
    ///     modulus_margin: 0.5, delay_margin_s: 0.0, highest_bandwidth_rad_per_s: f64::INFINITY, noise: None,
    /// };
    /// let problem = InnerLoopProblem {
    ///     plants: vec![InnerPlant { points, reference: at(1.0) }],
    ///     timing: Timing::default(), low_pass_rad_per_s: None, high_pass_rad_per_s: [0.1, 10.0], limits,
    /// };
    /// let found = problem.best()?.ok_or("it has a plant")?;
    /// assert!(found.feedback.gain > 0.0 && found.reach.loop_gain > 4.0 * found.without.loop_gain);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn best(&self) -> Result<Option<FoundInnerFeedback>, LinearError> {
        search::best(self)
    }

    /// Inner feedback H as deployed.
    fn deployed(&self, feedback: &InnerFeedback) -> Result<TransferFunction, LinearError> {
        let function = feedback.transfer_function()?;
        match self.timing.sample_time_s {
            Some(sample_time_s) => function.discretized(sample_time_s, self.timing.discretization),
            None => Ok(function),
        }
    }
}
