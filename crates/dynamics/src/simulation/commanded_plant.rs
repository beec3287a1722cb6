//! Plant with its source of commands: a controller that acts continuously, or a hold between
//! samples.

use super::realization::Realization;
use super::{Plant, Sliding, System};
use crate::controller::{AntiWindup, Controller, InnerFeedback, integral_row};
use crate::linear::{LinearError, StateSpace, TransferFunction};
use crate::scalar::Scalar;

/// Plant with its source of commands.
///
/// ```text
/// in a loop   u = G (F r - y) + k d - H p,    |u| <= limit,    delayed;    inputs r and those of the plant; states of plant, G, H, F
/// on hold     u is an input, held between samples;                         inputs u, r and those of the plant; states of plant, F
/// ```
///
/// In a loop, the plant's disturbance d (a load's velocity) may be fed forward, and its inner
/// measurement p (a pressure) fed back by the controller's [`InnerFeedback`]. A limited command
/// stops the integral part according to the controller's [`AntiWindup`]: clamping holds the states
/// of G while the error drives the command further out, back calculation drives them with the error
/// that would have given the limited command. Clamping sets in over the first ten-thousandth beyond
/// the limit: with an abrupt hold, the command would chatter along its limit.
///
/// On hold, F is the prefilter that stays continuous before a sampled controller; one if the
/// prefilter is sampled too.
///
/// Both sources have one type, so that the simulation of a plant is compiled once.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandedPlant<P> {
    plant: P,
    /// Continuous control law; `None` on hold.
    law: Option<ContinuousLaw>,
    prefilter: Realization,
}

/// Continuous controller without its prefilter.
#[derive(Clone, Debug, PartialEq)]
struct ContinuousLaw {
    feedback: Realization,
    /// Row that gives the integral part of the command from the states of G.
    integral: Vec<f64>,
    limit: f64,
    anti_windup: AntiWindup,
    feed_forward: f64,
    /// Realisation of H; `None` if no inner measurement is fed back.
    inner: Option<Realization>,
    delay_s: f64,
}

impl ContinuousLaw {
    /// Input of the states of G.
    #[inline(always)]
    fn driving<T: Scalar>(&self, signals: &LoopSignals<T>) -> T {
        match self.anti_windup {
            AntiWindup::BackCalculation => {
                signals.error + (signals.command - signals.wanted).times(1.0 / self.feedback.feedthrough)
            }
            AntiWindup::None | AntiWindup::Clamping => signals.error,
        }
    }

    /// Rates of the states of G.
    #[inline(always)]
    fn rates<T: Scalar>(&self, state: &[T], signals: &LoopSignals<T>, rates: &mut [T]) {
        self.feedback.rates(state, self.driving(signals), rates);
        if self.anti_windup == AntiWindup::Clamping && self.limit.is_finite() {
            let beyond = (signals.wanted.abs() - T::from(self.limit)).times(1.0 / (HOLDING * self.limit));
            let left = (T::from(1.0) - beyond).maximum(T::from(0.0)).minimum(T::from(1.0));
            let outwards = T::from(0.0).less_than(signals.wanted * signals.error);
            for rate in rates.iter_mut() {
                *rate = T::select(outwards, *rate * left, *rate);
            }
        }
    }
}

impl<P> CommandedPlant<P> {
    /// Plant under this controller, which acts continuously, with its disturbance fed forward with
    /// this gain.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`] for a sampled controller; [`LinearError::Improper`];
    /// [`LinearError::NotRational`] for a compensator with dead time;
    /// [`LinearError::NoFeedthrough`] for back calculation through a strictly proper compensator,
    /// whose command no error can bring to its limit at once.
    pub fn in_loop(plant: P, controller: &Controller, feed_forward: f64) -> Result<Self, LinearError> {
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
        let inner = controller.timing.inner_feedback;
        let realized = |inner: InnerFeedback| Realization::new(&inner.transfer_function()?);
        let inner = (!inner.is_zero()).then(|| realized(inner)).transpose()?;
        let law = ContinuousLaw { feedback, integral, limit, anti_windup, feed_forward, inner, delay_s };
        Ok(CommandedPlant { plant, law: Some(law), prefilter })
    }

    /// Plant with its command held constant, and the reference filtered by this prefilter.
    ///
    /// # Errors
    /// Errors of [`CommandedPlant::in_loop`].
    pub fn on_hold(plant: P, prefilter: &TransferFunction) -> Result<Self, LinearError> {
        Ok(CommandedPlant { plant, law: None, prefilter: Realization::new(prefilter)? })
    }

    /// The plant.
    pub fn plant(&self) -> &P {
        &self.plant
    }

    /// The plant, mutable.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.plant
    }

    /// Number of inputs before those of the plant: the reference; on hold the command and the
    /// reference.
    #[inline(always)]
    pub fn leading_inputs(&self) -> usize {
        if self.law.is_some() { 1 } else { 2 }
    }

    /// Limit of the command's magnitude, in its unit; infinite if unlimited.
    pub fn limit(&self) -> f64 {
        self.law.as_ref().map_or(f64::INFINITY, |law| law.limit)
    }

    /// Loop without a limit of the command, and so without anti-windup.
    #[must_use]
    pub fn unlimited(self) -> Self {
        CommandedPlant { law: self.law.map(|law| ContinuousLaw { limit: f64::INFINITY, ..law }), ..self }
    }

    /// Number of states of controller and prefilter.
    pub fn controller_states(&self) -> usize {
        self.feedback_states() + self.inner_states() + self.prefilter.states
    }

    #[inline(always)]
    fn feedback_states(&self) -> usize {
        self.law.as_ref().map_or(0, |law| law.feedback.states)
    }

    #[inline(always)]
    fn inner_states(&self) -> usize {
        self.law.as_ref().and_then(|law| law.inner.as_ref()).map_or(0, |inner| inner.states)
    }

    /// Parts of the states, or of their rates: those of plant, G, H and F.
    #[inline(always)]
    fn parts<'t, S: Scalar, T>(&self, state: &'t [T]) -> [&'t [T]; 4]
    where
        P: Plant<S>,
    {
        let (of_plant, of_controller) = state.split_at(self.plant.states());
        let (of_feedback, others) = of_controller.split_at(self.feedback_states());
        let (of_inner, of_prefilter) = others.split_at(self.inner_states());
        [of_plant, of_feedback, of_inner, of_prefilter]
    }

    /// States of G, H and F, in this order, that hold a command at constant reference, measurement
    /// and inner measurement, or come nearest to it; on hold only the states of F.
    ///
    /// # Example
    /// An integrator holds any command while the error is zero.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// use phea_dynamics::simulation::CommandedPlant;
    /// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
    /// let prefilter = Compensator::new(vec![Element::RealPole { frequency: 5.0 }]);
    /// let controller = Controller { feedback, prefilter, ..Controller::default() };
    /// let closed = CommandedPlant::in_loop((), &controller, 0.0)?;
    /// assert_eq!(closed.controller_states(), 2);
    /// let states = closed.controller_at_rest(3.0, [3.0, 0.0], 0.5);
    /// assert!((2.0 * states[0] - 0.5).abs() < 1e-12 || (states[0] - 0.5).abs() < 1e-12);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn controller_at_rest(
        &self,
        reference: f64,
        [measurement, inner]: [f64; 2],
        command: f64,
    ) -> Vec<f64> {
        let of_prefilter = self.prefilter.at_rest(reference, None);
        let error = self.prefilter.output(&of_prefilter, reference) - measurement;
        let mut states = vec![];
        if let Some(law) = &self.law {
            let of_inner = law.inner.as_ref().map_or(vec![], |path| path.at_rest(inner, None));
            let subtracted = law.inner.as_ref().map_or(0.0, |path| path.output(&of_inner, inner));
            states.extend(law.feedback.at_rest(error, Some(command + subtracted)));
            states.extend(of_inner);
        }
        states.extend(of_prefilter);
        states
    }

    #[inline(always)]
    fn is_delayed(&self) -> bool {
        self.law.as_ref().is_some_and(|law| law.delay_s > 0.0)
    }

    /// Inputs of the plant among all inputs.
    #[inline(always)]
    fn own<'i, S: Scalar, T>(&self, inputs: &'i [T]) -> &'i [T]
    where
        P: Plant<S>,
    {
        let leading = self.leading_inputs();
        &inputs[leading..leading + self.plant.inputs()]
    }

    /// Command before and after its limit, error, and reference after the prefilter, for all states
    /// and inputs.
    #[inline(always)]
    pub fn signals<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> LoopSignals<T>
    where
        P: Plant<S>,
    {
        let [of_plant, of_feedback, of_inner, of_prefilter] = self.parts::<S, T>(state);
        let own = self.own::<S, T>(inputs);
        let filtered_reference = self.prefilter.output(of_prefilter, inputs[self.leading_inputs() - 1]);
        let measurement = self.plant.measurement(of_plant, own);
        let error = filtered_reference - measurement;
        let Some(law) = &self.law else {
            let [wanted, command] = [inputs[0]; 2];
            return LoopSignals { filtered_reference, measurement, error, wanted, command };
        };
        let mut wanted = law.feedback.output(of_feedback, error);
        if law.feed_forward != 0.0 {
            wanted = wanted + self.plant.disturbance(of_plant, own).times(law.feed_forward);
        }
        if let Some(inner) = &law.inner {
            wanted = wanted - inner.output(of_inner, self.plant.inner_measurement(of_plant, own));
        }
        let command = wanted.minimum(T::from(law.limit)).maximum(T::from(-law.limit));
        LoopSignals { filtered_reference, measurement, error, wanted, command }
    }

    /// Part of the command that the integral part of G holds; zero if nothing integrates.
    ///
    /// ```text
    /// G = c_1/s + ... + c_m/s^m + remainder without integration          for a simple pole, c_1 times the integral of F r - y
    /// ```
    ///
    /// # Example
    /// For 2 + 3/s a constant error of one gives an integral part of 3 t.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// use phea_dynamics::scalar::Scalar;
    /// use phea_dynamics::simulation::{CommandedPlant, Plant};
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
    /// let closed = CommandedPlant::in_loop(Still, &controller, 0.0)?;
    /// let held = closed.controller_at_rest(0.0, [0.0; 2], 0.6);
    /// assert!((closed.integral_part(&held) - 0.6).abs() < 1e-12);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn integral_part(&self, state: &[f64]) -> f64
    where
        P: Plant<f64>,
    {
        let of_feedback = state.iter().skip(self.plant.states());
        let integral = self.law.iter().flat_map(|law| &law.integral);
        of_feedback.zip(integral).map(|(state, part)| state * part).sum()
    }

    /// Command on arrival at the plant: after the delay.
    pub fn arriving_command(&self, state: &[f64], inputs: &[f64]) -> f64
    where
        P: Plant<f64>,
    {
        let delayed = inputs.get(1 + self.plant.inputs()).copied().filter(|_| self.is_delayed());
        delayed.unwrap_or_else(|| self.signals::<f64, f64>(state, inputs).command)
    }

    /// Inputs of a sampled controller: reference after the prefilter, measurement, and inner
    /// measurement.
    pub fn sampled<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> [T; 3]
    where
        P: Plant<S>,
    {
        let signals = self.signals::<S, T>(state, inputs);
        let [of_plant, ..] = self.parts::<S, T>(state);
        let inner = self.plant.inner_measurement(of_plant, self.own::<S, T>(inputs));
        [signals.filtered_reference, signals.measurement, inner]
    }
}

/// Fraction of the limit over which clamping sets in.
const HOLDING: f64 = 1e-4;

/// Number of kinks of a limited command.
const LIMITED: usize = 3;

/// Signals of a control loop at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopSignals<T> {
    /// Filtered reference F r.
    pub filtered_reference: T,
    /// Measurement y.
    pub measurement: T,
    /// Error F r - y.
    pub error: T,
    /// Command before its limit; on hold the command.
    pub wanted: T,
    /// Command within its limit, before any delay.
    pub command: T,
}

impl<S: Scalar, P: Plant<S>> System<S> for CommandedPlant<P> {
    #[inline(always)]
    fn states(&self) -> usize {
        self.plant.states() + self.controller_states()
    }

    #[inline(always)]
    fn inputs(&self) -> usize {
        self.leading_inputs() + self.plant.inputs() + usize::from(self.is_delayed())
    }

    fn scales(&self) -> Vec<S> {
        let mut scales = self.plant.scales();
        if let Some(law) = &self.law {
            scales.extend(law.feedback.scales(self.plant.command_scale()));
            let inner = law.inner.iter();
            scales.extend(inner.flat_map(|inner| inner.scales(self.plant.command_scale())));
        }
        scales.extend(self.prefilter.scales(self.plant.measurement_scale()));
        scales
    }

    #[inline(always)]
    fn rates<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let leading = self.leading_inputs();
        let [of_plant, of_feedback, of_inner, of_prefilter] = self.parts::<S, T>(state);
        let (plant_rates, controller_rates) = rates.split_at_mut(of_plant.len());
        let (feedback_rates, other_rates) = controller_rates.split_at_mut(of_feedback.len());
        let (inner_rates, prefilter_rates) = other_rates.split_at_mut(of_inner.len());
        let mut command = inputs[0];
        if let Some(law) = &self.law {
            let signals = self.signals::<S, T>(state, inputs);
            command = if self.is_delayed() { inputs[1 + self.plant.inputs()] } else { signals.command };
            law.rates(of_feedback, &signals, feedback_rates);
            if let Some(inner) = law.inner.as_ref().filter(|inner| inner.states > 0) {
                let own = self.own::<S, T>(inputs);
                inner.rates(of_inner, self.plant.inner_measurement(of_plant, own), inner_rates);
            }
        }
        self.plant.rates(of_plant, command, self.own::<S, T>(inputs), plant_rates);
        self.prefilter.rates(of_prefilter, inputs[leading - 1], prefilter_rates);
    }

    fn delays(&self) -> Vec<S> {
        let mut delays = self.plant.delays();
        if let Some(law) = self.law.iter().find(|law| law.delay_s > 0.0) {
            delays.push(S::from(law.delay_s));
        }
        delays
    }

    fn outgoing<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        let own = self.own::<S, T>(inputs);
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
        self.plant.indicators() + usize::from(self.limit().is_finite())
    }

    fn indicate<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], indicators: &mut [T]) {
        let own = self.own::<S, T>(inputs);
        let of_plant = self.plant.indicators();
        self.plant.indicate(&state[..self.plant.states()], own, &mut indicators[..of_plant]);
        if let Some(limited) = indicators.get_mut(of_plant) {
            *limited = self.signals::<S, T>(state, inputs).wanted.abs() - T::from(self.limit());
        }
    }

    fn kinks(&self) -> usize {
        self.plant.kinks() + if self.limit().is_finite() { LIMITED } else { 0 }
    }

    /// Kinks of the plant, and those where the command reaches its limit, where clamping holds, and
    /// where the error reverses, at which clamping releases.
    fn mark<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], marks: &mut [T]) {
        let own = self.own::<S, T>(inputs);
        let limited = if self.limit().is_finite() { LIMITED } else { 0 };
        let (of_plant, own_marks) = marks.split_at_mut(marks.len() - limited);
        self.plant.mark(&state[..self.plant.states()], own, of_plant);
        if limited > 0 {
            let LoopSignals { wanted, error, .. } = self.signals::<S, T>(state, inputs);
            let beyond = wanted.abs() - T::from(self.limit());
            let held = beyond - T::from(HOLDING * self.limit());
            // irrelevant within the limit
            let reversal = T::select(beyond.less_than(T::from(0.0)), T::from(1.0), error * wanted);
            own_marks.copy_from_slice(&[beyond, held, reversal]);
        }
    }
}
