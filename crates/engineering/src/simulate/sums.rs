//! Force and command as sums of states and inputs.

use phea_dynamics::simulation::Plant;
use phea_hydraulics::machine::SIGNALS;
use phea_machine::Control;

use super::bench::Bench;
use super::sum::Sum;

/// The pressures of chambers A and B.
pub(super) fn pressures(bench: &Bench, wanted: &[usize]) -> [Sum; 2] {
    let others = bench.control.leading_inputs();
    ["pressure_a_pa", "pressure_b_pa"].map(|name| {
        let place = SIGNALS.iter().position(|signal| *signal == name).unwrap_or_default();
        let pressure = |state: &[f64], inputs: &[f64]| bench.machine.outputs(state, &inputs[others..])[place];
        Sum::of(wanted, bench.control.size(), pressure)
    })
}

/// The machine's own force, whatever a sensor makes of it.
pub(super) fn force(bench: &Bench, wanted: &[usize]) -> Sum {
    let others = bench.control.leading_inputs();
    let force = |state: &[f64], inputs: &[f64]| bench.machine.measurement(state, &inputs[others..]);
    Sum::of(wanted, bench.control.size(), force)
}

/// What a continuous controller wants before the limit, or what is stated in an open loop; nothing
/// of a sampled one.
pub(super) fn command(bench: &Bench, wanted: &[usize]) -> Sum {
    match &bench.control {
        Control::Continuous(closed) => {
            let wants = |state: &[f64], inputs: &[f64]| closed.signals::<f64, f64>(state, inputs).wanted;
            Sum::of(wanted, bench.control.size(), wants)
        }
        Control::Sampled(_) => Sum::default(),
        Control::Open(_) => {
            let stated = |_: &[f64], inputs: &[f64]| inputs.first().copied().unwrap_or_default();
            Sum::of(wanted, bench.control.size(), stated)
        }
    }
}
