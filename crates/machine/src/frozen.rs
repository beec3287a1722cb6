//! Loop from sample to sample, linearised at a sample.

use phea_dynamics::controller::ControllerState;
use phea_dynamics::simulation::{Frozen, FrozenMode, Plant, SampledLaw};

use super::control::Sampled;
use super::deployed::Deployed;

/// Sample at which the loop is linearised.
pub(crate) struct FrozenSample<'a> {
    /// States of the plant.
    pub(crate) state: &'a [f64],
    /// Inputs of the plant.
    pub(crate) inputs: &'a [f64],
    /// State of the controller before the sample.
    pub(crate) memory: ControllerState,
    /// Filtered reference and measurement, N, and inner signal, Pa.
    pub(crate) read: [f64; 3],
}

/// Least stable mode of the loop.
pub(crate) fn least_stable(sampled: &Sampled, sample: &FrozenSample<'_>) -> Option<FrozenMode> {
    let Sampled { held, deployed: Deployed { controller, feed_forward, .. }, delay_s, .. } = sampled;
    let FrozenSample { state, inputs, memory, read } = sample;
    let frozen = Frozen::at(held, state, inputs);
    let rows = [0, 1, 2].map(|place| {
        frozen.row(state, inputs, |state, inputs| held.sampled::<f64, f64>(state, inputs)[place])
    });
    let law = SampledLaw::new(controller, *delay_s, memory, *read).reading(rows);
    if *feed_forward == 0.0 {
        return frozen.least_stable_sampled(&law);
    }
    let own: usize = Plant::<f64>::states(held.plant());
    let velocity =
        frozen.row(state, inputs, |state, inputs| held.plant().disturbance(&state[..own], &inputs[2..]));
    frozen.least_stable_sampled(&law.fed(*feed_forward, velocity))
}
