use nalgebra::{DMatrix, DVector};

use super::{AntiWindup, Compensator, Controller, Section, integral_row};
use crate::linear::{LinearError, TimeDomain, TransferFunction};

/// A controller ready to run once a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledController {
    feedback: Vec<Section>,
    prefilter: Vec<Section>,
    /// Reads the integral part of the command off the states of the feedback.
    integral: Vec<f64>,
    command_limit: f64,
    anti_windup: AntiWindup,
    sample_time_s: f64,
}

/// All that changes from sample to sample.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerState {
    feedback: Vec<[f64; 2]>,
    prefilter: Vec<[f64; 2]>,
}

impl ControllerState {
    /// Every number in it: two for each section of the feedback, then of the prefilter.
    pub fn memories(&self) -> Vec<f64> {
        [self.feedback.as_flattened(), self.prefilter.as_flattened()].concat()
    }
}

/// What one sample gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerOutput {
    /// The command, within its limits.
    pub command: f64,
    /// The command before its limits.
    pub wanted: f64,
    /// Part of the command that the integral part of G holds, the error of this sample not yet in
    /// it; zero where nothing integrates.
    pub integral: f64,
    /// Whether the limit was reached.
    pub limited: bool,
    /// The reference after the prefilter.
    pub filtered_reference: f64,
}

impl Controller {
    /// The controller as it is deployed with this sample time: continuous compensators discretised
    /// by the timing's method, sampled ones taken as they are. A prefilter that acts before the
    /// samples is not part of it.
    ///
    /// # Errors
    /// A compensator that is improper, has dead time or cannot be discretised, or a sampled one
    /// with another sample time.
    pub fn sampled(&self, sample_time_s: f64) -> Result<SampledController, LinearError> {
        let sampled = |compensator: &Compensator| -> Result<TransferFunction, LinearError> {
            let function = compensator.transfer_function()?;
            match function.domain() {
                TimeDomain::Continuous => function.discretized(sample_time_s, self.timing.discretization),
                TimeDomain::Discrete { sample_time_s: own } if own == sample_time_s => Ok(function),
                TimeDomain::Discrete { .. } => Err(LinearError::DomainMismatch),
            }
        };
        let feedback = sampled(&self.feedback)?;
        let sections = Section::in_series(&feedback)?;
        let none = Compensator::default();
        let prefilter = if self.timing.continuous_prefilter { &none } else { &self.prefilter };
        Ok(SampledController {
            integral: integral_of(&feedback, &sections),
            feedback: sections,
            prefilter: Section::in_series(&sampled(prefilter)?)?,
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

    /// The same without a limit of its command.
    pub(crate) fn unlimited(&self) -> SampledController {
        SampledController { command_limit: f64::INFINITY, ..self.clone() }
    }

    /// The state at rest.
    pub fn at_rest(&self) -> ControllerState {
        ControllerState {
            feedback: vec![[0.0; 2]; self.feedback.len()],
            prefilter: vec![[0.0; 2]; self.prefilter.len()],
        }
    }

    /// The state in which it holds a command while reference and measurement do not change: an
    /// integral part carries the command, and a controller without one gives its response to the
    /// error.
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
        let mut signal = reference;
        let prefilter = self.prefilter.iter().map(|section| section.settled(&mut signal, 0.0)).collect();
        signal -= measurement;
        let feedback = self.feedback.iter().map(|section| section.settled(&mut signal, command)).collect();
        ControllerState { feedback, prefilter }
    }

    /// A state with these memories, in the order of [`ControllerState::memories`]; `None` for
    /// another number of them.
    ///
    /// # Example
    /// A controller goes on where another left off.
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
        let feedback = 2 * self.feedback.len();
        let whole = memories.len() == feedback + 2 * self.prefilter.len();
        let (of_feedback, of_prefilter) = memories.split_at_checked(feedback).filter(|_| whole)?;
        let pairs = |values: &[f64]| values.as_chunks::<2>().0.to_vec();
        Some(ControllerState { feedback: pairs(of_feedback), prefilter: pairs(of_prefilter) })
    }

    /// The steady response of prefilter and feedback to constant inputs; `None` for one that
    /// integrates.
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
        let mut filtered_reference = reference;
        for (section, memory) in self.prefilter.iter().zip(&mut state.prefilter) {
            let output = section.output(*memory, filtered_reference);
            *memory = section.advance(*memory, filtered_reference, output);
            filtered_reference = output;
        }
        let error = filtered_reference - measurement;
        let integral =
            state.feedback.iter().flatten().zip(&self.integral).map(|(state, part)| state * part).sum();
        let (command, wanted) = self.feedback_step(&mut state.feedback, error);
        ControllerOutput { command, wanted, integral, limited: command != wanted, filtered_reference }
    }

    /// The command within its limit, and before it.
    fn feedback_step(&self, state: &mut [[f64; 2]], error: f64) -> (f64, f64) {
        let before = (self.anti_windup == AntiWindup::Clamping).then(|| state.to_vec());
        let last = self.feedback.len().saturating_sub(1);
        let (mut signal, mut wanted) = (error, error);
        for (index, (section, memory)) in self.feedback.iter().zip(state.iter_mut()).enumerate() {
            let mut output = section.output(*memory, signal);
            let mut continued = output;
            if index == last {
                wanted = output;
                output = output.clamp(-self.command_limit, self.command_limit);
                if self.anti_windup == AntiWindup::BackCalculation {
                    continued = output;
                }
            }
            *memory = section.advance(*memory, signal, continued);
            signal = output;
        }
        if let Some(before) = before.filter(|_| signal != wanted && wanted * error > 0.0) {
            state.copy_from_slice(&before);
        }
        (signal, wanted)
    }
}

/// The row that reads the integral part off the states of these sections: their matrices follow
/// from the response to each state alone and to the input alone.
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
