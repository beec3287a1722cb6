//! Force and command as sums of states and inputs.

use phea_dynamics::simulation::Plant;
use phea_machine::Control;

use super::bench::ControlledMachine;
use super::sum::SignalSum;

/// Pressures of chambers A and B.
pub(super) fn pressures<'a>(bench: &'a ControlledMachine, wanted: &[usize]) -> [SignalSum<'a>; 2] {
    let others = bench.control.leading_inputs();
    [0, 1].map(|side| {
        let pressure = move |state: &[f64], inputs: &[f64]| {
            bench.machine.signals(state, &inputs[others..]).pressures[side]
        };
        SignalSum::of(wanted, bench.control.size(), pressure)
    })
}

/// Force of the machine, before the sensor.
pub(super) fn force<'a>(bench: &'a ControlledMachine, wanted: &[usize]) -> SignalSum<'a> {
    let others = bench.control.leading_inputs();
    let force = move |state: &[f64], inputs: &[f64]| bench.machine.measurement(state, &inputs[others..]);
    SignalSum::of(wanted, bench.control.size(), force)
}

/// Command of a continuous controller before its limit, or the stated command of an open loop; zero
/// for a sampled controller.
pub(super) fn command<'a>(bench: &'a ControlledMachine, wanted: &[usize]) -> SignalSum<'a> {
    match &bench.control {
        Control::Continuous(closed) => {
            let wants = |state: &[f64], inputs: &[f64]| closed.signals::<f64, f64>(state, inputs).wanted;
            SignalSum::of(wanted, bench.control.size(), wants)
        }
        Control::Sampled(_) => SignalSum::default(),
        Control::Open(_) => {
            let stated = |_: &[f64], inputs: &[f64]| inputs.first().copied().unwrap_or_default();
            SignalSum::of(wanted, bench.control.size(), stated)
        }
    }
}
