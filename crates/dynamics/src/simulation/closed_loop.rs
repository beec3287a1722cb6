//! A plant under a controller: one that acts continuously, or one that holds its command between samples.

use super::realization::Realization;
use super::{Plant, Sliding, System};
use crate::controller::{AntiWindup, Controller, integral_row};
use crate::linear::{LinearError, StateSpace, TransferFunction};
use crate::scalar::Scalar;

/// A plant under a continuous controller.
///
/// ```text
/// u = G (F r - y) + k d,    |u| <= limit,    delayed;        inputs r and those of the plant; states of plant, G, F
/// ```
///
/// The plant's disturbance d (a load's velocity) may be fed forward. A limited command stops the integral part as the
/// controller's [`AntiWindup`] says: clamping holds the states of G while the error drives the command further out, back
/// calculation drives them with the error that would have given the limited command. Clamping takes hold over the first
/// ten-thousandth beyond the limit: a hold at once would let the command slide along its limit, held and let go without end.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLoop<P> {
    plant: P,
    feedback: Realization,
    /// Reads the integral part of the command off the states of G.
    integral: Vec<f64>,
    prefilter: Realization,
    limit: f64,
    anti_windup: AntiWindup,
    feed_forward: f64,
    delay_s: f64,
}

impl<P> ClosedLoop<P> {
    /// This plant under this controller, the disturbance fed forward with this gain.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`] for a sampled controller; [`LinearError::Improper`]; [`LinearError::NotRational`] for a
    /// compensator with dead time; [`LinearError::NoFeedthrough`] for back calculation through a strictly proper compensator,
    /// whose command no error can bring to its limit at once.
    pub fn new(plant: P, controller: &Controller, feed_forward: f64) -> Result<Self, LinearError> {
        let function = controller.feedback.transfer_function()?;
        let feedback = Realization::new(&function)?;
        let system = StateSpace::from_transfer_function(&function)?;
        let integral = integral_row(&function, system.a(), &system.b().column(0).into_owned(), 0.0);
        let prefilter = Realization::new(&controller.prefilter.transfer_function()?)?;
        let anti_windup = controller.anti_windup;
        if anti_windup == AntiWindup::BackCalculation && feedback.feedthrough == 0.0 {
            return Err(LinearError::NoFeedthrough);
        }
        let limit = controller.command_limit.unwrap_or(f64::INFINITY);
        let delay_s = controller.timing.delay_s;
        Ok(ClosedLoop { plant, feedback, integral, prefilter, limit, anti_windup, feed_forward, delay_s })
    }

    /// The plant.
    pub fn plant(&self) -> &P {
        &self.plant
    }

    /// The plant, to be changed.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.plant
    }

    /// Limit of the command's magnitude, in its unit; infinite where there is none.
    pub fn limit(&self) -> f64 {
        self.limit
    }

    /// The same loop without a limit of the command, and so without anti-windup.
    #[must_use]
    pub fn unlimited(self) -> Self {
        ClosedLoop { limit: f64::INFINITY, ..self }
    }

    /// How many states controller and prefilter have.
    pub fn controller_states(&self) -> usize {
        self.feedback.states + self.prefilter.states
    }

    /// States of G and F, in this order, that hold a command while reference and measurement stand still: where none do, those
    /// that come nearest.
    ///
    /// # Example
    /// An integrator holds any command while there is no error.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// use phea_dynamics::simulation::ClosedLoop;
    /// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
    /// let prefilter = Compensator::new(vec![Element::RealPole { frequency: 5.0 }]);
    /// let closed = ClosedLoop::new((), &Controller { feedback, prefilter, ..Controller::default() }, 0.0)?;
    /// assert_eq!(closed.controller_states(), 2);
    /// let states = closed.controller_at_rest(3.0, 3.0, 0.5);
    /// assert!((2.0 * states[0] - 0.5).abs() < 1e-12 || (states[0] - 0.5).abs() < 1e-12);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn controller_at_rest(&self, reference: f64, measurement: f64, command: f64) -> Vec<f64> {
        let of_prefilter = self.prefilter.at_rest(reference, None);
        let error = self.prefilter.output(&of_prefilter, reference) - measurement;
        let mut states = self.feedback.at_rest(error, Some(command));
        states.extend(of_prefilter);
        states
    }

    #[inline(always)]
    fn is_delayed(&self) -> bool {
        self.delay_s > 0.0
    }

    /// Command before and after its limit, error, and reference behind the prefilter, for states and inputs of the loop.
    #[inline(always)]
    pub fn signals<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> LoopSignals<T>
    where
        P: Plant<S>,
    {
        let (of_plant, of_controller) = state.split_at(self.plant.states());
        let (of_feedback, of_prefilter) = of_controller.split_at(self.feedback.states);
        let own = &inputs[1..1 + self.plant.inputs()];
        let filtered_reference = self.prefilter.output(of_prefilter, inputs[0]);
        let measurement = self.plant.measurement(of_plant, own);
        let error = filtered_reference - measurement;
        let mut wanted = self.feedback.output(of_feedback, error);
        if self.feed_forward != 0.0 {
            wanted = wanted + self.plant.disturbance(of_plant, own).times(self.feed_forward);
        }
        let command = wanted.minimum(T::from(self.limit)).maximum(T::from(-self.limit));
        LoopSignals { filtered_reference, measurement, error, wanted, command }
    }

    /// Part of the command that the integral part of G holds; zero where nothing integrates.
    ///
    /// ```text
    /// G = c_1/s + ... + c_m/s^m + what does not integrate          of a simple pole c_1 times the integral of F r - y
    /// ```
    ///
    /// # Example
    /// Of 2 + 3/s the error of one leaves 3 t.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// use phea_dynamics::scalar::Scalar;
    /// use phea_dynamics::simulation::{ClosedLoop, Plant};
    /// # struct Still;
    /// # impl Plant<f64> for Still {
    /// #     fn states(&self) -> usize { 0 }
    /// #     fn inputs(&self) -> usize { 0 }
    /// #     fn scales(&self) -> Vec<f64> { vec![] }
    /// #     fn command_scale(&self) -> f64 { 1.0 }
    /// #     fn measurement_scale(&self) -> f64 { 1.0 }
    /// #     fn rates<T: Scalar + From<f64>>(&self, _: &[T], _: T, _: &[T], _: &mut [T]) {}
    /// #     fn measurement<T: Scalar + From<f64>>(&self, _: &[T], _: &[T]) -> T { T::from(0.0) }
    /// # }
    /// let law = Element::ProportionalIntegral { proportional_gain: 2.0, integral_gain: 3.0 };
    /// let controller = Controller { feedback: Compensator::new(vec![law]), ..Controller::default() };
    /// let closed = ClosedLoop::new(Still, &controller, 0.0)?;
    /// let held = closed.controller_at_rest(0.0, 0.0, 0.6);
    /// assert!((closed.integral_part(&held) - 0.6).abs() < 1e-12);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn integral_part(&self, state: &[f64]) -> f64
    where
        P: Plant<f64>,
    {
        let of_feedback = state.iter().skip(self.plant.states());
        of_feedback.zip(&self.integral).map(|(state, part)| state * part).sum()
    }

    /// The command as it comes to the plant: behind the delay.
    pub fn arriving_command(&self, state: &[f64], inputs: &[f64]) -> f64
    where
        P: Plant<f64>,
    {
        let delayed = inputs.get(1 + self.plant.inputs()).copied().filter(|_| self.is_delayed());
        delayed.unwrap_or_else(|| self.signals::<f64, f64>(state, inputs).command)
    }

    /// What drives the states of G.
    #[inline(always)]
    fn driving<T: Scalar>(&self, signals: &LoopSignals<T>) -> T {
        match self.anti_windup {
            AntiWindup::BackCalculation => {
                signals.error + (signals.command - signals.wanted).times(1.0 / self.feedback.feedthrough)
            }
            AntiWindup::None | AntiWindup::Clamping => signals.error,
        }
    }
}

/// Part of the limit over which clamping takes hold.
const HOLDING: f64 = 1e-4;

/// Signals of a control loop at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopSignals<T> {
    /// F r.
    pub filtered_reference: T,
    /// y.
    pub measurement: T,
    /// F r - y.
    pub error: T,
    /// The command before its limit.
    pub wanted: T,
    /// The command within its limit, before any delay.
    pub command: T,
}

impl<S: Scalar, P: Plant<S>> System<S> for ClosedLoop<P> {
    #[inline(always)]
    fn states(&self) -> usize {
        self.plant.states() + self.feedback.states + self.prefilter.states
    }

    #[inline(always)]
    fn inputs(&self) -> usize {
        1 + self.plant.inputs() + usize::from(self.is_delayed())
    }

    fn scales(&self) -> Vec<S> {
        let mut scales = self.plant.scales();
        scales.extend(self.feedback.scales(self.plant.command_scale()));
        scales.extend(self.prefilter.scales(self.plant.measurement_scale()));
        scales
    }

    #[inline(always)]
    fn rates<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let signals = self.signals::<S, T>(state, inputs);
        let (of_plant, of_controller) = state.split_at(self.plant.states());
        let (of_feedback, of_prefilter) = of_controller.split_at(self.feedback.states);
        let (plant_rates, controller_rates) = rates.split_at_mut(of_plant.len());
        let (feedback_rates, prefilter_rates) = controller_rates.split_at_mut(of_feedback.len());
        let plant_inputs = self.plant.inputs();
        let command = if self.is_delayed() { inputs[1 + plant_inputs] } else { signals.command };
        self.plant.rates(of_plant, command, &inputs[1..1 + plant_inputs], plant_rates);
        self.feedback.rates(of_feedback, self.driving(&signals), feedback_rates);
        if self.anti_windup == AntiWindup::Clamping && self.limit.is_finite() {
            let beyond = (signals.wanted.abs() - T::from(self.limit)).times(1.0 / (HOLDING * self.limit));
            let left = (T::from(1.0) - beyond).maximum(T::from(0.0)).minimum(T::from(1.0));
            let outwards = T::from(0.0).less_than(signals.wanted * signals.error);
            for rate in feedback_rates.iter_mut() {
                *rate = T::select(outwards, *rate * left, *rate);
            }
        }
        self.prefilter.rates(of_prefilter, inputs[0], prefilter_rates);
    }

    fn delays(&self) -> Vec<S> {
        let mut delays = self.plant.delays();
        if self.is_delayed() {
            delays.push(S::from(self.delay_s));
        }
        delays
    }

    fn outgoing<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        let own = &inputs[1..1 + self.plant.inputs()];
        let plant_waves = waves.len() - usize::from(self.is_delayed());
        self.plant.outgoing(&state[..self.plant.states()], own, &mut waves[..plant_waves]);
        if self.is_delayed() {
            waves[plant_waves] = self.signals::<S, T>(state, inputs).command;
        }
    }

    fn sliding(&self) -> Option<Sliding> {
        self.plant.sliding()
    }

    fn indicators(&self) -> usize {
        self.plant.indicators() + usize::from(self.limit.is_finite())
    }

    fn indicate<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], indicators: &mut [T]) {
        let own = &inputs[1..1 + self.plant.inputs()];
        let of_plant = self.plant.indicators();
        self.plant.indicate(&state[..self.plant.states()], own, &mut indicators[..of_plant]);
        if let Some(limited) = indicators.get_mut(of_plant) {
            *limited = self.signals::<S, T>(state, inputs).wanted.abs() - T::from(self.limit);
        }
    }
}

/// A plant whose command is held between samples, its reference filtered continuously.
///
/// ```text
/// inputs u, r and those of the plant; states of the plant and of F
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HeldPlant<P> {
    plant: P,
    prefilter: Realization,
}

impl<P> HeldPlant<P> {
    /// This plant behind a hold, the reference behind this prefilter (one for a prefilter that is sampled too).
    ///
    /// # Errors
    /// As [`ClosedLoop::new`].
    pub fn new(plant: P, prefilter: &TransferFunction) -> Result<Self, LinearError> {
        Ok(HeldPlant { plant, prefilter: Realization::new(prefilter)? })
    }

    /// The plant.
    pub fn plant(&self) -> &P {
        &self.plant
    }

    /// The plant, to be changed.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.plant
    }

    /// States of F while the reference stands still.
    pub fn prefilter_at_rest(&self, reference: f64) -> Vec<f64> {
        self.prefilter.at_rest(reference, None)
    }

    /// What the controller samples: reference behind the prefilter, and measurement.
    pub fn sampled<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> [T; 2]
    where
        P: Plant<S>,
    {
        let (of_plant, of_prefilter) = state.split_at(self.plant.states());
        [self.prefilter.output(of_prefilter, inputs[1]), self.plant.measurement(of_plant, &inputs[2..])]
    }
}

impl<S: Scalar, P: Plant<S>> System<S> for HeldPlant<P> {
    #[inline(always)]
    fn states(&self) -> usize {
        self.plant.states() + self.prefilter.states
    }

    #[inline(always)]
    fn inputs(&self) -> usize {
        2 + self.plant.inputs()
    }

    fn scales(&self) -> Vec<S> {
        let mut scales = self.plant.scales();
        scales.extend(self.prefilter.scales(self.plant.measurement_scale()));
        scales
    }

    #[inline(always)]
    fn rates<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let (of_plant, of_prefilter) = state.split_at(self.plant.states());
        let (plant_rates, prefilter_rates) = rates.split_at_mut(of_plant.len());
        self.plant.rates(of_plant, inputs[0], &inputs[2..], plant_rates);
        self.prefilter.rates(of_prefilter, inputs[1], prefilter_rates);
    }

    fn delays(&self) -> Vec<S> {
        self.plant.delays()
    }

    fn outgoing<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        self.plant.outgoing(&state[..self.plant.states()], &inputs[2..], waves);
    }

    fn sliding(&self) -> Option<Sliding> {
        self.plant.sliding()
    }

    fn indicators(&self) -> usize {
        self.plant.indicators()
    }

    fn indicate<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], indicators: &mut [T]) {
        self.plant.indicate(&state[..self.plant.states()], &inputs[2..], indicators);
    }
}
