//! The equilibrium of the closed loop: the start of a scenario that states none.

use phea_dynamics::simulation::EquilibriumError;
use phea_hydraulics::machine::{InitialCondition, SIGNALS};
use phea_machine::{HeldInputs, Rest, at_rest};

use super::SimulateError;
use super::bench::ControlledMachine;

/// A loop in equilibrium.
pub(super) struct RestedLoop {
    pub(super) rest: Rest,
    /// Position of the load's ground, m.
    pub(super) ground_m: f64,
}

/// The equilibrium of the loop under constant inputs, with the piston at the position of the
/// initial guess: all simulated rates are zero.
pub(super) fn rest(
    bench: &ControlledMachine,
    guess: &[f64],
    beginning: &InitialCondition,
    standing: HeldInputs,
    name: &str,
) -> Result<RestedLoop, SimulateError> {
    let reference_n = standing.reference_n;
    let named = |error| match error {
        EquilibriumError::NotFound { state, rate } => {
            SimulateError::NoRest { name: name.to_string(), reference_n, what: what(state), rate }
        }
        error => SimulateError::Rest { name: name.to_string(), error },
    };
    let rest = at_rest(&bench.control, guess, beginning, standing).map_err(named)?;
    let (command_v, limit_v) = (rest.command_v, rest.limit_v);
    if command_v.abs() > limit_v {
        let name = name.to_string();
        return Err(SimulateError::RestBeyondLimit { name, reference_n, command_v, limit_v });
    }
    // only its position depends on that of the ground
    let place = SIGNALS.iter().position(|signal| *signal == "position_m");
    let own = beginning.all_inputs();
    let position =
        |start: &[f64]| place.map_or(0.0, |place| bench.machine.outputs::<f64>(start, &own)[place]);
    let [ground_m, _] = beginning.inputs;
    let ground_m = ground_m - (position(&rest.start) - position(&beginning.state));
    Ok(RestedLoop { rest, ground_m })
}

/// A state in words, by its index: [`phea_hydraulics::machine::MachineState`].
fn what(state: usize) -> &'static str {
    let first = [
        "the spool",
        "the spool",
        "the pressure of chamber A",
        "the pressure of chamber B",
        "the force",
        "the piston",
    ];
    first.get(state).copied().unwrap_or("a state other than force, pressures and spool")
}
