//! Force and command as sums of states and inputs.

use phea_dynamics::simulation::{Plant, System};
use phea_hydraulics::machine::SIGNALS;

use super::bench::{Bench, Control};
use super::sum::Sum;

/// Number of states and of inputs of a loop.
pub(crate) fn size(control: &Control) -> [usize; 2] {
    match control {
        Control::Continuous(closed) => {
            [System::<f64>::states(closed.as_ref()), System::<f64>::inputs(closed.as_ref())]
        }
        Control::Sampled(sampled) => {
            [System::<f64>::states(&sampled.held), System::<f64>::inputs(&sampled.held)]
        }
        Control::Open(held) => [System::<f64>::states(held.as_ref()), System::<f64>::inputs(held.as_ref())],
    }
}

/// How many inputs of a loop come before those of its machine.
fn others(control: &Control) -> usize {
    match control {
        Control::Continuous(_) => 1,
        Control::Sampled(_) | Control::Open(_) => 2,
    }
}

/// The pressures of chambers A and B.
pub(crate) fn pressures(bench: &Bench, wanted: &[usize]) -> [Sum; 2] {
    let others = others(&bench.control);
    ["pressure_a_pa", "pressure_b_pa"].map(|name| {
        let place = SIGNALS.iter().position(|signal| *signal == name).unwrap_or_default();
        let pressure = |state: &[f64], inputs: &[f64]| bench.machine.outputs(state, &inputs[others..])[place];
        Sum::of(wanted, size(&bench.control), pressure)
    })
}

/// The machine's own force, whatever a sensor makes of it.
pub(crate) fn force(bench: &Bench, wanted: &[usize]) -> Sum {
    let others = others(&bench.control);
    let force = |state: &[f64], inputs: &[f64]| bench.machine.measurement(state, &inputs[others..]);
    Sum::of(wanted, size(&bench.control), force)
}

/// What a continuous controller wants before the limit, or what is stated in an open loop; nothing of a sampled one.
pub(crate) fn command(bench: &Bench, wanted: &[usize]) -> Sum {
    match &bench.control {
        Control::Continuous(closed) => {
            let wants = |state: &[f64], inputs: &[f64]| closed.signals::<f64, f64>(state, inputs).wanted;
            Sum::of(wanted, size(&bench.control), wants)
        }
        Control::Sampled(_) => Sum::default(),
        Control::Open(_) => {
            let stated = |_: &[f64], inputs: &[f64]| inputs.first().copied().unwrap_or_default();
            Sum::of(wanted, size(&bench.control), stated)
        }
    }
}
