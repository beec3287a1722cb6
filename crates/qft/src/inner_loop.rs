//! The feedback of an inner signal, found before the loop around it: gain and corner of its high
//! pass with which a proportional loop around every plant may have the largest gain.
//!
//! ```text
//! u = -K y - H p,   y = P u,   p = Q u        P' = P/(1 + H Q)        H(s) = k s/(s + w_h) w_l/(s + w_l)
//! maximise over k, w_h   K(k, w_h) min |P'(j w_0)|                    over all plants, w_0 below the resonances
//! K      largest gain up to which  |1 + K P'| >= m,  |K P'/(1 + K P')| <= 1/sqrt(2) from w_b on,
//!        and no delay up to T_m makes H Q + K P reach -1
//! k      up to where the same holds of H Q alone, and its noise moves the command by no more than allowed
//! ```
//!
//! Inside out: the inner loop is fast and has its own margins, so that it remains stable where the
//! outer one is opened, limited or shaped anew. A plant with one lightly damped resonance
//! w behind an integrator reaches a loop gain of 2 xi w (1 - m): there the measure is the damping.
//! Both limits on a gain are closed forms at each frequency, so no loop is searched for: a
//! search that closes whole designs would repeat minutes of work for each corner.

mod limits;
mod search;

use num_complex::Complex64;
use phea_dynamics::controller::{InnerFeedback, Timing};
use phea_dynamics::linear::{LinearError, TransferFunction};

/// A plant at one frequency, with hold and delay of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerPoint {
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// P: from the command to the output.
    pub plant: Complex64,
    /// Q: from the command to the inner signal.
    pub signal: Complex64,
}

/// A plant that is stable without feedback, at increasing frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct InnerPlant {
    /// Frequencies dense enough for its resonances, up to pi/T of a sampled loop.
    pub points: Vec<InnerPoint>,
    /// The frequency w_0 at which loop gains are compared, the same for every plant.
    pub reference: InnerPoint,
}

/// What both loops must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerLoopLimits {
    /// m: least distance of either loop from -1.
    pub modulus_margin: f64,
    /// T_m: delay that both loops together must tolerate, s.
    pub delay_margin_s: f64,
    /// w_b in rad/s, from where on the outer loop has fallen to -3 dB; infinite where it may have
    /// any bandwidth.
    pub highest_bandwidth_rad_per_s: f64,
    /// Noise of the inner signal at the samples and the command that it may cause, both as root
    /// mean squares; `None` where there is no noise or no limit.
    pub noise: Option<[f64; 2]>,
}

/// Plants and limits among which the feedback is found.
#[derive(Clone, Debug, PartialEq)]
pub struct InnerLoopProblem {
    /// The plants.
    pub plants: Vec<InnerPlant>,
    /// Samples of the loop, and the rule by which H is sampled.
    pub timing: Timing,
    /// w_l in rad/s; `None` without a low pass.
    pub low_pass_rad_per_s: Option<f64>,
    /// Least and greatest w_h, rad/s.
    pub high_pass_rad_per_s: [f64; 2],
    /// What both loops must keep.
    pub limits: InnerLoopLimits,
}

/// What a feedback makes of the plants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerLoopReach {
    /// K min |P'(j w_0)|.
    pub loop_gain: f64,
    /// K
    pub outer_gain: f64,
    /// The plant that limits K.
    pub plant: usize,
    /// Where it does, rad/s.
    pub frequency_rad_per_s: f64,
}

/// The best feedback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundInnerFeedback {
    /// H
    pub feedback: InnerFeedback,
    /// With it.
    pub reach: InnerLoopReach,
    /// Without.
    pub without: InnerLoopReach,
}

impl InnerLoopProblem {
    /// What a feedback makes of the plants; `None` where the inner loop alone breaks a limit, and
    /// without plants.
    ///
    /// # Errors
    /// [`LinearError`] for a feedback that cannot be sampled.
    ///
    /// # Example
    /// A resonance of 10 rad/s, damped by 0.01, behind an integrator reaches 2 xi w (1 - m) = 0.1
    /// rad/s; reference 1 rad/s.
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
        let unit = limits::PlantsBehind::new(self, &InnerFeedback { gain: 1.0, ..*feedback }, &all)?;
        Ok(unit.reach(feedback.gain))
    }

    /// The feedback with the largest loop gain, the inner loop keeping its limits for every plant;
    /// `None` without plants, or where no positive gain keeps them.
    ///
    /// # Errors
    /// [`LinearError`] for a feedback that cannot be sampled.
    ///
    /// # Example
    /// A mass on two springs, one of them of oil: feeding the pressure back damps it.
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

    /// H as the loop runs it.
    fn deployed(&self, feedback: &InnerFeedback) -> Result<TransferFunction, LinearError> {
        let function = feedback.transfer_function()?;
        match self.timing.sample_time_s {
            Some(sample_time_s) => function.discretized(sample_time_s, self.timing.discretization),
            None => Ok(function),
        }
    }
}
