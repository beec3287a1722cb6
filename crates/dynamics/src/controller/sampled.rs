use nalgebra::{DMatrix, DVector};

use super::{AntiWindup, Compensator, Controller, Section, integral_row};
use crate::linear::{LinearError, TimeDomain, TransferFunction};

/// Controller ready to run once per sample.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledController {
    feedback: Vec<Section>,
    prefilter: Vec<Section>,
    /// Sections of H, which feeds an inner signal back; `None` if there is no such signal.
    inner: Option<Vec<Section>>,
    /// Row that gives the integral part of the command from the states of the feedback compensator.
    integral: Vec<f64>,
    command_limit: f64,
    anti_windup: AntiWindup,
    sample_time_s: f64,
}

/// All values that change from sample to sample.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerState {
    feedback: Vec<[f64; 2]>,
    prefilter: Vec<[f64; 2]>,
    inner: Vec<[f64; 2]>,
}

impl ControllerState {
    /// All numbers of the state: two for each section of the feedback, then of the prefilter, then
    /// of the inner feedback.
    pub fn memories(&self) -> Vec<f64> {
        [self.feedback.as_flattened(), self.prefilter.as_flattened(), self.inner.as_flattened()].concat()
    }
}

/// Values that a controller reads at a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ControllerInput {
    /// Reference r.
    pub reference: f64,
    /// Measurement y.
    pub measurement: f64,
    /// Inner signal p; H p is subtracted from the command.
    pub inner: f64,
    /// Value that is added to the command.
    pub added: f64,
}

/// Outputs of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerOutput {
    /// The command, within its limits.
    pub command: f64,
    /// Command before its limits.
    pub wanted: f64,
    /// Part of the command held by the integral part of G, before the error of this sample is
    /// added; zero if nothing integrates.
    pub integral: f64,
    /// True if the limit was reached.
    pub limited: bool,
    /// Reference after the prefilter.
    pub filtered_reference: f64,
}

impl Controller {
    /// Controller as deployed with this sample time: continuous compensators discretised by the
    /// timing's method, sampled ones unchanged. A prefilter that acts before the sampler is not
    /// part of it.
    ///
    /// # Errors
    /// Compensator that is improper, has dead time or cannot be discretised, or a sampled one with
    /// another sample time.
    pub fn sampled(&self, sample_time_s: f64) -> Result<SampledController, LinearError> {
        let sampled = |compensator: &Compensator| -> Result<TransferFunction, LinearError> {
            let function = compensator.transfer_function()?;
            match function.domain() {
                TimeDomain::Continuous => function.discretized(sample_time_s, self.timing.discretization),
                TimeDomain::Discrete { sample_time_s: own } if own == sample_time_s => Ok(function),
                TimeDomain::Discrete { .. } => Err(LinearError::DomainMismatch),
            }
        };
        let inner = self.timing.inner_feedback;
        let in_sections = || -> Result<_, LinearError> {
            let function =
                inner.transfer_function()?.discretized(sample_time_s, self.timing.discretization)?;
            Section::in_series(&function)
        };
        let feedback = sampled(&self.feedback)?;
        let sections = Section::in_series(&feedback)?;
        let none = Compensator::default();
        let prefilter = if self.timing.continuous_prefilter { &none } else { &self.prefilter };
        Ok(SampledController {
            integral: integral_of(&feedback, &sections),
            feedback: sections,
            prefilter: Section::in_series(&sampled(prefilter)?)?,
            inner: (!inner.is_zero()).then(in_sections).transpose()?,
            command_limit: self.command_limit.unwrap_or(f64::INFINITY),
            anti_windup: self.anti_windup,
            sample_time_s,
        })
    }
}

impl SampledController {
    /// Sample time in s.
    pub fn sample_time_s(&self) -> f64 {
        self.sample_time_s
    }

    /// Sections of the feedback compensator G, in the order in which they run.
    pub fn feedback_sections(&self) -> &[Section] {
        &self.feedback
    }

    /// Sections of the prefilter F, in the order in which they run; those of a gain of one if it
    /// acts before the sampler.
    pub fn prefilter_sections(&self) -> &[Section] {
        &self.prefilter
    }

    /// Sections of H, which feeds an inner signal back; empty without such a signal.
    pub fn inner_sections(&self) -> &[Section] {
        self.inner()
    }

    /// Largest magnitude of the command; infinite without a limit.
    pub fn command_limit(&self) -> f64 {
        self.command_limit
    }

    /// What the states do while the command is limited.
    pub fn anti_windup(&self) -> AntiWindup {
        self.anti_windup
    }

    /// Controller without a limit of its command.
    pub(crate) fn unlimited(&self) -> SampledController {
        SampledController { command_limit: f64::INFINITY, ..self.clone() }
    }

    /// State at rest.
    pub fn at_rest(&self) -> ControllerState {
        ControllerState {
            feedback: vec![[0.0; 2]; self.feedback.len()],
            prefilter: vec![[0.0; 2]; self.prefilter.len()],
            inner: vec![[0.0; 2]; self.inner().len()],
        }
    }

    fn inner(&self) -> &[Section] {
        self.inner.as_deref().unwrap_or_default()
    }

    /// True if it feeds an inner signal back.
    pub fn reads_inner(&self) -> bool {
        self.inner.is_some()
    }

    /// State in which the controller holds a command while reference and measurement do not change:
    /// an integral part carries the command, and a controller without one gives its response to the
    /// error. Without feedback of an inner signal: see [`SampledController::holding_with`].
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
    /// let prefilter = Compensator::new(vec![Element::RealPole { frequency: 5.0 }]);
    /// let controller = Controller { feedback, prefilter, ..Controller::default() };
    /// let sampled = controller.sampled(0.1)?;
    /// let mut state = sampled.holding(3.0, 3.0, 0.5);
    /// for _ in 0..10 {
    ///     assert!((sampled.step(&mut state, 3.0, 3.0).command - 0.5).abs() < 1e-12);
    /// }
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn holding(&self, reference: f64, measurement: f64, command: f64) -> ControllerState {
        self.holding_with(&ControllerInput { reference, measurement, ..ControllerInput::default() }, command)
    }

    /// State in which the controller holds a command while reference, measurement and the inner
    /// signal do not change.
    ///
    /// # Example
    /// The integral part balances the inner signal that is fed back without a high pass.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, ControllerInput, Element, InnerFeedback, Timing};
    /// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
    /// let inner_feedback = InnerFeedback { gain: 3.0, low_pass_rad_per_s: Some(4.0), ..InnerFeedback::default() };
    /// let timing = Timing { inner_feedback, ..Timing::default() };
    /// let sampled = Controller { feedback, timing, ..Controller::default() }.sampled(0.1)?;
    /// let read = ControllerInput { reference: 1.0, measurement: 1.0, inner: 7.0, added: 0.0 };
    /// let mut state = sampled.holding_with(&read, 0.5);
    /// for _ in 0..10 {
    ///     assert!((sampled.step_with(&mut state, &read).command - 0.5).abs() < 1e-12);
    /// }
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn holding_with(&self, read: &ControllerInput, command: f64) -> ControllerState {
        let mut signal = read.reference;
        let prefilter = self.prefilter.iter().map(|section| section.settled(&mut signal, 0.0)).collect();
        let mut error = signal - read.measurement;
        let mut back = read.inner;
        let inner = self.inner().iter().map(|section| section.settled(&mut back, 0.0)).collect();
        let subtracted = if self.reads_inner() { back } else { 0.0 };
        let held = command + subtracted - read.added;
        let feedback = self.feedback.iter().map(|section| section.settled(&mut error, held)).collect();
        ControllerState { feedback, prefilter, inner }
    }

    /// State with these memories, in the order of [`ControllerState::memories`]; `None` for another
    /// number of them.
    ///
    /// # Example
    /// A controller continues from the memories of another.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
    /// let sampled = Controller { feedback, ..Controller::default() }.sampled(0.1)?;
    /// let mut state = sampled.at_rest();
    /// sampled.step(&mut state, 1.0, 0.0);
    /// assert_eq!(sampled.resumed(&state.memories()), Some(state));
    /// assert_eq!(sampled.resumed(&[]), None);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn resumed(&self, memories: &[f64]) -> Option<ControllerState> {
        let (feedback, prefilter) = (2 * self.feedback.len(), 2 * self.prefilter.len());
        let whole = memories.len() == feedback + prefilter + 2 * self.inner().len();
        let (of_feedback, others) = memories.split_at_checked(feedback).filter(|_| whole)?;
        let (of_prefilter, of_inner) = others.split_at_checked(prefilter)?;
        let [feedback, prefilter, inner] =
            [of_feedback, of_prefilter, of_inner].map(|values| values.as_chunks::<2>().0.to_vec());
        Some(ControllerState { feedback, prefilter, inner })
    }

    /// Steady gains of prefilter and feedback for constant inputs; `None` for one that integrates.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
    /// let prefilter = Compensator::new(vec![Element::RealPole { frequency: 5.0 }]);
    /// let controller = Controller { feedback, prefilter, ..Controller::default() };
    /// let [of_prefilter, of_feedback] = controller.sampled(0.1)?.steady_gains();
    /// assert!(of_prefilter.is_some_and(|gain| (gain - 1.0).abs() < 1e-12) && of_feedback.is_none());
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn steady_gains(&self) -> [Option<f64>; 2] {
        [&self.prefilter, &self.feedback].map(|sections| {
            sections.iter().try_fold(1.0, |gain, section| Some(gain * section.steady_gain()?))
        })
    }

    /// Steady gain of the inner feedback; zero without one.
    pub fn steady_inner_gain(&self) -> f64 {
        let gains = self.inner.iter().flatten().map(|section| section.steady_gain().unwrap_or(0.0));
        if self.reads_inner() { gains.product() } else { 0.0 }
    }

    /// One sample: the command for this reference and measurement, and the next state.
    ///
    /// # Example
    /// An integrator of 2/s, sampled every 0.1 s by the bilinear rule, driven by an error of one
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// let integrator = vec![Element::Gain(2.0), Element::Integrator];
    /// let controller = Controller { feedback: Compensator::new(integrator), ..Controller::default() };
    /// let sampled = controller.sampled(0.1)?;
    /// let mut state = sampled.at_rest();
    /// let commands = [1.0; 3].map(|reference| sampled.step(&mut state, reference, 0.0).command);
    /// for (command, expected) in commands.iter().zip([0.1, 0.3, 0.5]) {
    ///     assert!((command - expected).abs() < 1e-15);
    /// }
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn step(&self, state: &mut ControllerState, reference: f64, measurement: f64) -> ControllerOutput {
        self.step_with(state, &ControllerInput { reference, measurement, ..ControllerInput::default() })
    }

    /// One sample with a value added to the command and an inner signal that is fed back; the limit
    /// applies to the sum.
    ///
    /// ```text
    /// u = limit(G (F r - y) - H p + a)
    /// ```
    ///
    /// # Example
    /// A feedback command of six and an added value of nine reach the limit of ten.
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, ControllerInput, Element};
    /// let feedback = Compensator::new(vec![Element::Gain(2.0)]);
    /// let limited = Controller { feedback, command_limit: Some(10.0), ..Controller::default() }.sampled(0.1)?;
    /// let read = |added| ControllerInput { reference: 3.0, added, ..ControllerInput::default() };
    /// let step = |added| limited.step_with(&mut limited.at_rest(), &read(added));
    /// assert_eq!((step(9.0).command, step(9.0).wanted, step(-9.0).command), (10.0, 15.0, -3.0));
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn step_with(&self, state: &mut ControllerState, read: &ControllerInput) -> ControllerOutput {
        let mut filtered_reference = read.reference;
        for (section, memory) in self.prefilter.iter().zip(&mut state.prefilter) {
            let output = section.output(*memory, filtered_reference);
            *memory = section.advance(*memory, filtered_reference, output);
            filtered_reference = output;
        }
        let error = filtered_reference - read.measurement;
        let mut back = read.inner;
        for (section, memory) in self.inner().iter().zip(&mut state.inner) {
            let output = section.output(*memory, back);
            *memory = section.advance(*memory, back, output);
            back = output;
        }
        let beside = if self.reads_inner() { read.added - back } else { read.added };
        let integral =
            state.feedback.iter().flatten().zip(&self.integral).map(|(state, part)| state * part).sum();
        let (command, wanted) = self.feedback_step(&mut state.feedback, error, beside);
        ControllerOutput { command, wanted, integral, limited: command != wanted, filtered_reference }
    }

    /// Command within its limit and command before it, including the value added to the feedback.
    fn feedback_step(&self, state: &mut [[f64; 2]], error: f64, beside: f64) -> (f64, f64) {
        let before = (self.anti_windup == AntiWindup::Clamping).then(|| state.to_vec());
        let last = self.feedback.len().saturating_sub(1);
        let (mut signal, mut wanted) = (error, error + beside);
        for (index, (section, memory)) in self.feedback.iter().zip(state.iter_mut()).enumerate() {
            let mut output = section.output(*memory, signal);
            let mut continued = output;
            if index == last {
                wanted = output + beside;
                output = within(wanted, self.command_limit, beside, output);
                if self.anti_windup == AntiWindup::BackCalculation {
                    continued = output;
                }
            }
            *memory = section.advance(*memory, signal, continued);
            signal = output;
        }
        let command = wanted.clamp(-self.command_limit, self.command_limit);
        if let Some(before) = before.filter(|_| command != wanted && wanted * error > 0.0) {
            state.copy_from_slice(&before);
        }
        (command, wanted)
    }
}

/// Part of the output that feedback may have so that the sum stays within its limit.
fn within(wanted: f64, limit: f64, beside: f64, output: f64) -> f64 {
    let command = wanted.clamp(-limit, limit);
    if command == wanted { output } else { command - beside }
}

/// Row that gives the integral part from the states of these sections: their matrices follow from
/// the response to each single state and to the input.
fn integral_of(function: &TransferFunction, sections: &[Section]) -> Vec<f64> {
    let states = 2 * sections.len();
    let next = |state: &[f64], input: f64| -> Vec<f64> {
        let mut signal = input;
        let mut next = Vec::with_capacity(states);
        for (section, memory) in sections.iter().zip(state.chunks_exact(2)) {
            let memory = [memory[0], memory[1]];
            let output = section.output(memory, signal);
            next.extend(section.advance(memory, signal, output));
            signal = output;
        }
        next
    };
    let unit = |place: usize| -> Vec<f64> { (0..states).map(|index| f64::from(index == place)).collect() };
    let columns: Vec<f64> = (0..states).flat_map(|place| next(&unit(place), 0.0)).collect();
    let dynamics = DMatrix::from_vec(states, states, columns);
    let drive = DVector::from_vec(next(&vec![0.0; states], 1.0));
    // a first-order section leaves its second state unused: it has no information
    integral_row(function, &dynamics, &drive, 1.0)
}
