//! The work of accumulators that are adjusted in a run, and what their valves throttle.

use phea_dynamics::simulation::{Stretch, gauss_points};

use super::bench::ControlledMachine;

/// What the adjustment of accumulators does over a run, in J.
///
/// ```text
/// work: integral of the power of the adjustment, of what the oil can get back from the gas: 1/2 dK/dt x^2 of a spring
/// throttled: integral of the drop times the flow of the valves between chambers and gas
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AdjustmentWork {
    /// While its power is positive.
    pub brought_j: f64,
    /// While it is negative.
    pub taken_j: f64,
    /// Lost in the valves between chambers and gas; `None` without such a valve.
    pub throttled_j: Option<f64>,
}

/// Sums the power over each step of the integration.
#[derive(Debug)]
pub(super) struct AdjustmentWatch {
    work: AdjustmentWork,
    /// Room for states and inputs.
    states: Vec<f64>,
    inputs: Vec<f64>,
}

impl AdjustmentWatch {
    /// Of a machine that has an adjustment.
    pub(super) fn of(bench: &ControlledMachine) -> Option<AdjustmentWatch> {
        let machine = &bench.machine;
        let has_valve = bench.rig.actuator.components().gas.iter().flatten().any(|gas| gas.valve().is_some());
        let [states, inputs] = bench.control.size();
        machine.has_adjustment().then(|| AdjustmentWatch {
            work: AdjustmentWork { throttled_j: has_valve.then_some(0.0), ..AdjustmentWork::default() },
            states: vec![0.0; states],
            inputs: vec![0.0; inputs],
        })
    }

    /// Takes a step, all of whose states are wanted.
    pub(super) fn follow(&mut self, bench: &ControlledMachine, stretch: &Stretch<'_>) {
        let AdjustmentWatch { work, states, inputs } = self;
        let length_s = stretch.end_s() - stretch.start_s();
        let leading = bench.control.leading_inputs();
        for (part, weight) in gauss_points() {
            states.iter_mut().zip(stretch.states).for_each(|(state, over)| *state = over.at(part));
            stretch.inputs_at(part, inputs);
            let own = inputs.get(leading..).unwrap_or_default();
            let power_w = bench.machine.signals(states, own).adjustment_power;
            work.brought_j += weight * length_s * power_w.max(0.0);
            work.taken_j -= weight * length_s * power_w.min(0.0);
            if let Some(throttled_j) = &mut work.throttled_j {
                *throttled_j += weight * length_s * bench.machine.throttled_at_gas(states, own);
            }
        }
    }

    pub(super) fn finish(self) -> AdjustmentWork {
        self.work
    }
}
