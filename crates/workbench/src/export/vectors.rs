//! Test vectors: samples of a controller with the outputs that it must give.

use phea_machine::{Deployed, DeployedState, Executed, SampledSignals};

/// Number of test vectors.
const VECTORS: usize = 256;

/// Operation of a test vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorOperation {
    /// One sample.
    Step,
    /// Reset to rest, then one sample.
    ResetAndStep,
    /// State that holds the stated command, then one sample.
    HoldAndStep,
}

/// One sample with its outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestVector {
    /// Operation before the outputs are compared.
    pub operation: VectorOperation,
    /// Signals that are read.
    pub signals: SampledSignals,
    /// Command that is held, V.
    pub held_v: f64,
    /// Outcome.
    pub executed: Executed,
}

/// SignalSizes of the signals of the test vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SignalSizes {
    force: f64,
    velocity: f64,
    pressure: f64,
}

/// Test vectors of a controller for forces of this magnitude: rest, steps both ways, saturation
/// both ways and the return from it, an invalid input, reset, and a held command.
///
/// # Example
/// ```
/// use phea_workbench::export::test_vectors;
/// # use phea_dynamics::controller::{Compensator, Controller, Element};
/// # use phea_machine::Deployed;
/// let feedback = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
/// let limited = Controller { feedback, command_limit: Some(1.0), ..Controller::default() };
/// let deployed = Deployed::new(limited.sampled(0.1)?);
/// let vectors = test_vectors(&deployed, 10.0);
/// assert_eq!(vectors.len(), 256);
/// assert!(vectors.iter().any(|vector| vector.executed.command_v == -1.0));
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn test_vectors(deployed: &Deployed, force: f64) -> Vec<TestVector> {
    let amplitudes = SignalSizes { force, velocity: 0.1, pressure: 1e5 };
    let saturating = saturating(deployed, amplitudes);
    let mut state = deployed.at_rest();
    (0..VECTORS).map(|index| vector(deployed, &mut state, (amplitudes, saturating), index)).collect()
}

/// Multiple of the force, a power of two, whose error reaches the limit of the command within 24
/// samples; that of the largest tried if none does.
fn saturating(deployed: &Deployed, amplitudes: SignalSizes) -> f64 {
    let reaches = |factor: f64| {
        let mut state = deployed.at_rest();
        let signals = SampledSignals { reference: factor * amplitudes.force, ..SampledSignals::default() };
        (0..24).any(|_| deployed.step(&mut state, &signals).output.limited)
    };
    let mut factor = 1.0;
    while factor < 1e9 && !reaches(factor) {
        factor *= 2.0;
    }
    factor
}

fn vector(
    deployed: &Deployed,
    state: &mut DeployedState,
    (amplitudes, saturating): (SignalSizes, f64),
    index: usize,
) -> TestVector {
    let wave = |period: usize| (index % period) as f64 / period as f64 - 0.5;
    let force = amplitudes.force;
    // a ripple that repeats after primes, so that each sample differs
    let ripple = 0.1 * force * wave(7);
    let (reference, measurement) = match index {
        0..16 => (0.0, 0.0),
        16..56 => (force, ripple + 0.3 * force),
        56..96 => (-0.5 * force, ripple),
        96..120 => (saturating * force, ripple),
        120..136 => (0.0, ripple),
        136..160 => (-saturating * force, ripple),
        160..176 => (0.0, ripple),
        176 => (f64::NAN, ripple),
        177 => (force, f64::INFINITY),
        178..216 => (0.25 * force, ripple),
        _ => (0.5 * force, 0.5 * force + ripple),
    };
    let signals = SampledSignals {
        reference,
        measurement,
        velocity: amplitudes.velocity * wave(11),
        pressure: amplitudes.pressure * wave(13),
    };
    let limit = deployed.controller.command_limit();
    let held_v = if limit.is_finite() { 0.25 * limit } else { 0.25 };
    let operation = match index {
        // the states of a controller without anti-windup would not return in time
        136 | 200 => VectorOperation::ResetAndStep,
        216 => VectorOperation::HoldAndStep,
        _ => VectorOperation::Step,
    };
    match operation {
        VectorOperation::Step => {}
        VectorOperation::ResetAndStep => *state = deployed.at_rest(),
        VectorOperation::HoldAndStep => deployed.hold(state, &signals, held_v),
    }
    TestVector { operation, signals, held_v, executed: deployed.step(state, &signals) }
}
