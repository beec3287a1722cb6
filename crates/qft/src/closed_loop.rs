//! The loop around a plant: controller, prefilter, sensor, delay and sampling, and the closed loops
//! of one member.

mod disc;
mod fed_forward;
mod folded;
mod images;
mod member;
mod plant_response;
mod sampled_end;
mod trial;

use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::controller::{Controller, RateSensor, Timing};
use phea_dynamics::linear::{Discretization, LinearError, LinearOperation, TimeDomain, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_dynamics::uncertain_plant::{PlantCoefficients, PlantMember, RationalCoefficients, UncertainPlant};

use crate::family::MeasuredPlant;
pub(crate) use disc::DiscFactors;
use fed_forward::{FedBack, inner_path, rate_path};
pub use fed_forward::{FedForward, InnerPath};
pub(crate) use fed_forward::{closed, closed_at_rest, moved_rate};
pub use trial::{HeldResponse, ModalPlant, TrialPlant};

/// The part of the loop common to every plant: G, F, H, the delay of the loop, and its sampling.
///
/// ```text
/// continuous:  L = P G H e^(-s T_d),  T = P G e^(-s T_d)/(1 + L)                                   thesis 3.1, 3.2
/// sampled:     L = Z{(1 - e^(-sT))/s P H e^(-s T_d)} G(z), at z = e^(jwT), up to pi/T
/// ```
///
/// ```text
/// P/(1 - K H_v P_v)    the plant seen by the loop if a rate v = P_v u + V_d d, which the command also moves, is fed forward
/// Pd + K H_v V_d P     the path of its disturbance, P with its hold and delay; V_d = s if v is the rate of d itself
/// P/(1 + H_p P_p)      the plant of a sampled loop with inner feedback of p = P_p u + I_d d; its disturbance path is Pd - H_p I_d P
/// ```
///
/// H_v is the sensor of that rate: its filter and its dead time, before the samples.
///
/// For a sinusoidal disturbance the samples of the output obey this exactly: P and P_v are the
/// sampled responses.
///
/// The prefilter of a sampled loop is F(z), or F(s) if it acts on the reference before sampling.
/// For a sinusoidal reference below pi/T the samples after F(s) are F(jw) times the samples of the
/// sine: F T is evaluated with F(jw), and holds for references without content beyond pi/T.
#[derive(Clone, Debug, PartialEq)]
pub struct Compensation {
    feedback: TransferFunction,
    prefilter: TransferFunction,
    sensor: TransferFunction,
    sample_time_s: Option<f64>,
    delay_s: f64,
    rate_feed_forward: f64,
    rate_sensor: RateSensor,
    /// Inner feedback H_p in z; `None` if no inner signal is fed back, or the plant includes it.
    inner_feedback: Option<TransferFunction>,
}

/// Responses G and F at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensationResponse {
    /// Feedback G.
    pub feedback: Complex64,
    /// Prefilter F.
    pub prefilter: Complex64,
}

/// One plant within a loop, ready to be evaluated.
#[derive(Clone, Debug)]
pub enum Member {
    /// A rational plant with dead time in a continuous loop.
    Continuous {
        /// P and Pd as coefficients, with the dead time of plant and loop together.
        plant: PlantCoefficients<f64>,
        /// Sensor H.
        sensor: TransferFunction,
        /// Feed-forward path K H_v V_d.
        fed_forward: FedForward,
    },
    /// A plant held by a zero-order hold and sampled.
    Sampled {
        /// P with hold and delay, in z.
        command: TransferFunction,
        /// P H with hold and delay, in z.
        with_sensor: TransferFunction,
        /// Path Pd, continuous: the motion acts on the plant itself.
        disturbance: Option<RationalCoefficients<f64>>,
        /// Feed-forward path K H_v V_d; its feedback part is within P.
        fed_forward: FedForward,
        /// Rate path H_v P_v/(1 - K H_v P_v) with hold and delay, in z; `None` if nothing is fed
        /// back.
        rate: Option<TransferFunction>,
        /// Inner signal P_p/(1 + H_p P_p) with hold and delay, in z.
        inner: Option<TransferFunction>,
    },
    /// A plant without polynomials, with the delay of the loop; sampling adds the lag of the hold.
    Responding {
        /// The plant.
        plant: Arc<dyn RespondingPlant>,
        /// Sensor H.
        sensor: TransferFunction,
        /// Delay of the loop plus, if it is sampled, half a sample, s.
        delay_s: f64,
        /// Sample time for the magnitude of the hold, s.
        sample_time_s: Option<f64>,
        /// Feed-forward gain K.
        rate_feed_forward: f64,
        /// Sensor H_v of the rate.
        rate_sensor: RateSensor,
        /// Inner feedback H_p in z.
        inner_feedback: Option<TransferFunction>,
    },
    /// A measured plant, with the delay of the loop; sampling adds the lag of the hold.
    Measured {
        /// The measurement.
        plant: MeasuredPlant,
        /// Sensor H.
        sensor: TransferFunction,
        /// Delay of the loop plus, if it is sampled, half a sample, s.
        delay_s: f64,
        /// Sample time for the magnitude of the hold, s.
        sample_time_s: Option<f64>,
    },
}

/// P, Pd and H of one member at one frequency; delay and hold are included in P.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemberResponse {
    /// Plant P.
    pub plant: Complex64,
    /// Load-motion path Pd, including the feed-forward of the disturbance's rate; zero if the plant
    /// has no such path.
    pub load_motion: Complex64,
    /// Sensor H.
    pub sensor: Complex64,
}

impl Compensation {
    /// The loop of a controller with this sensor (1 if the output itself is fed back).
    ///
    /// # Errors
    /// [`LinearError`] if a part is not a transfer function or cannot be sampled;
    /// [`LinearError::DomainMismatch`] for a controller or prefilter in z with another sample time
    /// than the loop's; [`LinearError::WrongDomain`] for a sensor in z.
    ///
    /// # Example
    /// The published force controller with 1 ms of delay: at 100 rad/s L lags by 0.1 rad more.
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
    /// use phea_dynamics::linear::TransferFunction;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
    /// use phea_qft::closed_loop::Compensation;
    /// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
    /// let integral = Element::ProportionalIntegral { proportional_gain: 0.001, integral_gain: 0.008 };
    /// let feedback = Compensator::new(vec![integral]);
    /// let timing = Timing { delay_s: 0.001, ..Timing::default() };
    /// let controller = Controller { feedback, timing, ..Controller::default() };
    /// let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
    /// let command = RationalCoefficients { numerator: vec![1e5], denominator: vec![1.0, 0.0] }; // 1e5/s
    /// let member = compensation.member(PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None })?;
    /// let plant = member.response(100.0).unwrap().plant;
    /// let expected = Complex64::new(-0.1_f64.sin(), -0.1_f64.cos()) * 1000.0; // -90 degrees and 0.1 rad
    /// assert!((plant - expected).norm_sqr() < 1e-20);
    /// # Ok(())
    /// # }
    /// ```
    pub fn new(controller: &Controller, sensor: TransferFunction) -> Result<Compensation, LinearError> {
        let timing = &controller.timing;
        let feedback = deployed(controller.feedback.transfer_function()?, timing)?;
        let prefilter = deployed(controller.prefilter.transfer_function()?, &timing.of_prefilter())?;
        if sensor.domain() != TimeDomain::Continuous {
            return Err(LinearError::WrongDomain {
                operation: LinearOperation::Sensor,
                needed: "continuous",
            });
        }
        let inner = timing.inner_feedback;
        let is_sampled = timing.sample_time_s.is_some() && !inner.is_zero();
        let inner_feedback = is_sampled.then(|| deployed(inner.transfer_function()?, timing)).transpose()?;
        Ok(Compensation {
            feedback,
            prefilter,
            sensor,
            inner_feedback,
            sample_time_s: timing.sample_time_s,
            delay_s: timing.delay_s,
            rate_feed_forward: timing.rate_feed_forward,
            rate_sensor: timing.rate_sensor,
        })
    }

    /// Feedback G, sampled if the loop is.
    pub fn feedback(&self) -> &TransferFunction {
        &self.feedback
    }

    /// Prefilter F, in z if the loop samples it.
    pub fn prefilter(&self) -> &TransferFunction {
        &self.prefilter
    }

    /// Prefilter F as a step of the reference passes through it, in the domain of the loop: if it
    /// acts before the sampling, the F(z) whose step response matches that of F(s) at the samples.
    ///
    /// # Errors
    /// [`LinearError`] if F(s) cannot be sampled.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
    /// use phea_dynamics::linear::TransferFunction;
    /// use phea_qft::closed_loop::Compensation;
    /// let timing = Timing { sample_time_s: Some(0.1), continuous_prefilter: true, ..Timing::default() };
    /// let prefilter = Compensator::new(vec![Element::RealPole { frequency: 5.0 }]);
    /// let controller = Controller { prefilter, timing, ..Controller::default() };
    /// let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
    /// assert_eq!(compensation.prefilter().poles()[0].re, -5.0);
    /// let sampled = compensation.prefilter_of_step()?;
    /// assert!((sampled.poles()[0].re - (-0.5_f64).exp()).abs() < 1e-15 && (sampled.dc_gain() - 1.0).abs() < 1e-12);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn prefilter_of_step(&self) -> Result<TransferFunction, LinearError> {
        match (self.sample_time_s, self.prefilter.domain()) {
            (Some(sample_time_s), TimeDomain::Continuous) => {
                self.prefilter.discretized(sample_time_s, Discretization::ZeroOrderHold)
            }
            _ => Ok(self.prefilter.clone()),
        }
    }

    /// Sensor H, continuous.
    pub fn sensor(&self) -> &TransferFunction {
        &self.sensor
    }

    /// True if H = 1.
    fn senses_the_output(&self) -> bool {
        self.sensor == TransferFunction::gain_only(1.0)
    }

    /// Sample time, s; `None` for a continuous loop.
    pub fn sample_time_s(&self) -> Option<f64> {
        self.sample_time_s
    }

    /// Computation and transport delay of the loop, s.
    pub fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// Gain K from the rate of a disturbance to the command.
    pub fn rate_feed_forward(&self) -> f64 {
        self.rate_feed_forward
    }

    /// Sensor H_v of that rate.
    pub fn rate_sensor(&self) -> RateSensor {
        self.rate_sensor
    }

    /// Inner feedback H_p in z of a sampled controller.
    pub fn inner_feedback(&self) -> Option<&TransferFunction> {
        self.inner_feedback.as_ref()
    }

    /// Copy of this loop without rate feed-forward and inner feedback.
    #[must_use]
    pub fn without_inner_paths(&self) -> Compensation {
        Compensation { rate_feed_forward: 0.0, inner_feedback: None, ..self.clone() }
    }

    /// Copy of this loop without inner feedback.
    #[must_use]
    pub fn without_inner_feedback(&self) -> Compensation {
        Compensation { inner_feedback: None, ..self.clone() }
    }

    /// Copy of this loop with another delay.
    pub fn with_delay(&self, delay_s: f64) -> Compensation {
        Compensation { delay_s, ..self.clone() }
    }

    /// Copy of this loop with another controller.
    pub(crate) fn with_feedback(&self, feedback: TransferFunction) -> Result<Compensation, LinearError> {
        if feedback.domain() != self.feedback.domain() {
            return Err(LinearError::DomainMismatch);
        }
        Ok(Compensation { feedback, ..self.clone() })
    }

    /// True if the controller has a root at zero frequency: s = 0, or z = 1.
    pub(crate) fn is_at_zero_frequency(&self, root: Complex64) -> bool {
        root == Complex64::new(if self.sample_time_s.is_some() { 1.0 } else { 0.0 }, 0.0)
    }

    /// The highest meaningful frequency, rad/s: pi/T, or infinity.
    pub fn highest_frequency_rad_per_s(&self) -> f64 {
        self.sample_time_s.map_or(f64::INFINITY, |sample_time_s| std::f64::consts::PI / sample_time_s)
    }

    /// G and F at a frequency.
    pub fn response(&self, frequency_rad_per_s: f64) -> CompensationResponse {
        CompensationResponse {
            feedback: self.feedback.at_frequency(frequency_rad_per_s),
            prefilter: self.prefilter.at_frequency(frequency_rad_per_s),
        }
    }

    /// A rational plant within this loop.
    ///
    /// # Errors
    /// [`LinearError`] if the plant has a negative dead time or cannot be sampled; a continuous
    /// loop accepts every other plant.
    pub fn member(&self, mut plant: PlantCoefficients<f64>) -> Result<Member, LinearError> {
        check_dead_time(plant.dead_time_s)?;
        plant.dead_time_s += self.delay_s;
        let (gain, rate_sensor) = (self.rate_feed_forward, self.rate_sensor);
        let inner_feedback = self.inner_feedback.as_ref();
        let fed_forward = FedForward::of(gain, rate_sensor, inner_feedback, &plant);
        let Some(sample_time_s) = self.sample_time_s else {
            let plant = closed(gain, rate_sensor, plant)?;
            return Ok(Member::Continuous { plant, sensor: self.sensor.clone(), fed_forward });
        };
        let rate = rate_path(gain, rate_sensor, &plant)?;
        let inner = inner_path(inner_feedback, &plant)?;
        let rational = plant.command.transfer_function()?;
        // The dead time of the plant acts after the hold; for the sensor signal it adds to that of
        // the sensor.
        let held = |function: TransferFunction| {
            let dead_time_s = function.dead_time_s() + plant.dead_time_s;
            function.with_dead_time(dead_time_s)?.discretized(sample_time_s, Discretization::ZeroOrderHold)
        };
        let [rate, inner] = [rate.map(held).transpose()?, inner.map(held).transpose()?];
        let back = FedBack::of(rate.as_ref().map(|rate| (gain, rate)), inner_feedback.zip(inner.as_ref()))?;
        let within = |function| match &back {
            Some(back) => back.around(&held(function)?),
            None => held(function),
        };
        let command = within(rational.clone())?;
        let with_sensor =
            if self.senses_the_output() { command.clone() } else { within(rational.series(&self.sensor)?)? };
        let closed = |path: Option<TransferFunction>| {
            back.as_ref().zip(path).map(|(back, path)| back.around(&path)).transpose()
        };
        let (rate, inner) = (closed(rate)?, closed(inner)?);
        Ok(Member::Sampled { command, with_sensor, disturbance: plant.disturbance, fed_forward, rate, inner })
    }

    /// The plant of a family with these parameter values within this loop.
    ///
    /// # Errors
    /// Errors of [`Compensation::member`], and [`LinearError::NoPlant`].
    pub fn member_of(&self, plant: &UncertainPlant, values: &[f64]) -> Result<Member, LinearError> {
        self.around(plant.member(values).ok_or(LinearError::NoPlant)?)
    }

    /// A plant of a family within this loop.
    ///
    /// # Errors
    /// Errors of [`Compensation::member`].
    ///
    /// # Example
    /// An integrator of 4/s at 2 rad/s
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::controller::Controller;
    /// use phea_dynamics::linear::TransferFunction;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, PlantMember, RationalCoefficients};
    /// use phea_qft::closed_loop::Compensation;
    /// let command = RationalCoefficients { numerator: vec![4.0], denominator: vec![1.0, 0.0] };
    /// let plant = PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None };
    /// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
    /// let response = compensation.around(PlantMember::Rational(plant))?.response(2.0).ok_or("a pole")?;
    /// assert!((response.plant - Complex64::new(0.0, -2.0)).norm_sqr() < 1e-24);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn around(&self, plant: PlantMember) -> Result<Member, LinearError> {
        match plant {
            PlantMember::Rational(coefficients) => self.member(coefficients),
            PlantMember::Responding(plant) => Ok(self.responding(plant)),
        }
    }

    /// P, Pd and H of the plant of a family with these parameter values at one frequency.
    ///
    /// # Errors
    /// Errors of [`Compensation::member_of`].
    pub fn response_of(
        &self,
        plant: &UncertainPlant,
        values: &[f64],
        frequency_rad_per_s: f64,
    ) -> Result<MemberResponse, LinearError> {
        match plant.member(values).ok_or(LinearError::NoPlant)? {
            PlantMember::Rational(coefficients) => self.plant_response(coefficients, frequency_rad_per_s),
            PlantMember::Responding(plant) => {
                self.responding(plant).response(frequency_rad_per_s).ok_or(LinearError::NoPlant)
            }
        }
    }

    /// A plant without polynomials within this loop.
    pub fn responding(&self, plant: Arc<dyn RespondingPlant>) -> Member {
        Member::Responding {
            plant,
            sensor: self.sensor.clone(),
            delay_s: self.delay_s + self.sample_time_s.unwrap_or(0.0) / 2.0,
            sample_time_s: self.sample_time_s,
            rate_feed_forward: self.rate_feed_forward,
            rate_sensor: self.rate_sensor,
            inner_feedback: self.inner_feedback.clone(),
        }
    }

    /// A measured plant within this loop.
    pub fn measured(&self, plant: &MeasuredPlant) -> Member {
        Member::Measured {
            plant: plant.clone(),
            sensor: self.sensor.clone(),
            delay_s: self.delay_s + self.sample_time_s.unwrap_or(0.0) / 2.0,
            sample_time_s: self.sample_time_s,
        }
    }
}

/// A part of the controller, converted to the domain of its timing.
fn deployed(function: TransferFunction, timing: &Timing) -> Result<TransferFunction, LinearError> {
    match (timing.sample_time_s, function.domain()) {
        (None, TimeDomain::Continuous) => Ok(function),
        (None, TimeDomain::Discrete { .. }) => Err(LinearError::DomainMismatch),
        (Some(sample_time_s), TimeDomain::Continuous) => {
            function.discretized(sample_time_s, timing.discretization)
        }
        (Some(sample_time_s), domain) if domain == TimeDomain::Discrete { sample_time_s } => Ok(function),
        (Some(_), TimeDomain::Discrete { .. }) => Err(LinearError::DomainMismatch),
    }
}

/// Rejects a negative dead time: the plant would be non-causal.
fn check_dead_time(dead_time_s: f64) -> Result<(), LinearError> {
    if dead_time_s.is_finite() && dead_time_s >= 0.0 {
        Ok(())
    } else {
        Err(LinearError::DeadTime { dead_time_s })
    }
}

/// Phase factor e^(-j w T) of a delay.
fn turned(frequency_rad_per_s: f64, delay_s: f64) -> Complex64 {
    if delay_s == 0.0 {
        return Complex64::new(1.0, 0.0);
    }
    let angle = -frequency_rad_per_s * delay_s;
    Complex64::new(portable::cos(angle), portable::sin(angle))
}
