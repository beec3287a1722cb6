//! What the computer of a controller executes at each sample.

use phea_dynamics::controller::{
    ControllerInput, ControllerOutput, ControllerState, Converter, SampledController,
};

/// Controller as its computer executes it, behind the simulation and every export.
///
/// ```text
/// m = AD(y)                            AD rounds to the levels of its converter and ends at its range
/// v = q round(v_m/q)                   v_m the measured velocity of the load, q its resolution
/// u = DA(limit(G (F r - m) + k v - H p))
/// ```
///
/// A sample with an input that is not a finite number changes no state and repeats the last
/// command.
///
/// # Example
/// ```
/// use phea_dynamics::controller::{Compensator, Controller, Converter, Element};
/// use phea_machine::{Deployed, SampledSignals};
/// let feedback = Compensator::new(vec![Element::Gain(0.5)]);
/// let controller = Controller { feedback, ..Controller::default() }.sampled(1e-3)?;
/// let converter = Converter::new(12, [-10.0, 10.0]).ok();
/// let deployed = Deployed { command_converter: converter, ..Deployed::new(controller) };
/// let mut state = deployed.at_rest();
/// let read = |reference| SampledSignals { reference, ..SampledSignals::default() };
/// let first = deployed.step(&mut state, &read(4.0));
/// assert_eq!((first.command_v, first.is_valid), (410.0 * 20.0 / 4096.0, true));
/// let second = deployed.step(&mut state, &read(f64::NAN));
/// assert_eq!((second.command_v, second.is_valid), (first.command_v, false));
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Deployed {
    /// Controller with G, F and H in z, its limit and its anti-windup.
    pub controller: SampledController,
    /// Feedforward gain from the load's velocity to the command, V s/m; zero without one.
    pub feed_forward: f64,
    /// Resolution of that velocity, m/s; zero without rounding.
    pub velocity_resolution: f64,
    /// Converter of the measurement, if it is quantised.
    pub measurement_converter: Option<Converter>,
    /// Converter of the command, if it is quantised.
    pub command_converter: Option<Converter>,
}

/// All values that change from sample to sample.
#[derive(Clone, Debug, PartialEq)]
pub struct DeployedState {
    /// States of the sections.
    pub controller: ControllerState,
    /// Last command, V.
    pub command_v: f64,
}

/// Signals that the computer reads at a sample; one that the controller does not use is ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampledSignals {
    /// Reference of the force, N.
    pub reference: f64,
    /// Measured force before its converter, N.
    pub measurement: f64,
    /// Measured velocity of the load before rounding, m/s.
    pub velocity: f64,
    /// Pressure signal that is fed back, Pa.
    pub pressure: f64,
}

/// Outcome of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Executed {
    /// Command after its converter, V.
    pub command_v: f64,
    /// Measurement after its converter, N.
    pub measurement: f64,
    /// Outputs of the controller.
    pub output: ControllerOutput,
    /// False if an input was not a finite number.
    pub is_valid: bool,
}

impl Deployed {
    /// A controller without feedforward and converters.
    pub fn new(controller: SampledController) -> Deployed {
        Deployed {
            controller,
            feed_forward: 0.0,
            velocity_resolution: 0.0,
            measurement_converter: None,
            command_converter: None,
        }
    }

    /// State at rest, with a command of zero.
    pub fn at_rest(&self) -> DeployedState {
        DeployedState { controller: self.controller.at_rest(), command_v: 0.0 }
    }

    /// Replaces the state by one at which these signals give this command, which is neither limited
    /// nor rounded: an integral part moves on with the error, and a controller without one gives
    /// its response to the error instead. The state is unchanged if a signal or the command is not
    /// a finite number.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::{Compensator, Controller, Element};
    /// use phea_machine::{Deployed, SampledSignals};
    /// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
    /// let deployed = Deployed::new(Controller { feedback, ..Controller::default() }.sampled(1e-3)?);
    /// let mut state = deployed.at_rest();
    /// let read = SampledSignals { reference: 5.0, measurement: 5.0, ..SampledSignals::default() };
    /// deployed.hold(&mut state, &read, 0.25);
    /// assert_eq!(deployed.step(&mut state, &read).command_v, 0.25);
    /// deployed.hold(&mut state, &read, f64::NAN);
    /// assert_eq!(state.command_v, 0.25);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn hold(&self, state: &mut DeployedState, read: &SampledSignals, command_v: f64) {
        if self.is_valid(read) && command_v.is_finite() {
            let controller = self.controller.holding_with(&self.input(read), command_v);
            *state = DeployedState { controller, command_v };
        }
    }

    /// One sample: the command for these signals, and the next state.
    pub fn step(&self, state: &mut DeployedState, read: &SampledSignals) -> Executed {
        let input = self.input(read);
        let measurement = input.measurement;
        if !self.is_valid(read) {
            return self.repeated(state, measurement);
        }
        let output = self.controller.step_with(&mut state.controller, &input);
        state.command_v = self.command_converter.map_or(output.command, |one| one.rounded(output.command));
        Executed { command_v: state.command_v, measurement, output, is_valid: true }
    }

    /// True if every signal that the controller uses is a finite number.
    fn is_valid(&self, read: &SampledSignals) -> bool {
        let used = [
            Some(read.reference),
            Some(read.measurement),
            (self.feed_forward != 0.0).then_some(read.velocity),
            self.controller.reads_inner().then_some(read.pressure),
        ];
        used.iter().flatten().all(|signal| signal.is_finite())
    }

    fn input(&self, read: &SampledSignals) -> ControllerInput {
        ControllerInput {
            reference: read.reference,
            measurement: self.converted(read.measurement),
            inner: read.pressure,
            added: self.added(read),
        }
    }

    fn repeated(&self, state: &DeployedState, measurement: f64) -> Executed {
        let command = state.command_v;
        let output = ControllerOutput {
            command,
            wanted: command,
            integral: 0.0,
            limited: false,
            filtered_reference: f64::NAN,
        };
        Executed { command_v: command, measurement, output, is_valid: false }
    }

    fn converted(&self, measurement: f64) -> f64 {
        self.measurement_converter.map_or(measurement, |converter| converter.rounded(measurement))
    }

    /// Part of the command that the feedforward adds, V.
    fn added(&self, read: &SampledSignals) -> f64 {
        let resolution = self.velocity_resolution;
        match (self.feed_forward != 0.0, resolution > 0.0) {
            (false, _) => 0.0,
            (true, false) => self.feed_forward * read.velocity,
            (true, true) => self.feed_forward * (resolution * (read.velocity / resolution).round()),
        }
    }
}
