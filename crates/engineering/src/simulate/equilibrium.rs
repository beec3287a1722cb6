//! Equilibrium of the closed loop: the start of a scenario that states none.

use phea_dynamics::simulation::EquilibriumError;
use phea_hydraulics::machine::InitialCondition;
use phea_machine::{HeldInputs, Rest, at_rest};

use super::SimulateError;
use super::bench::ControlledMachine;
use crate::quantity::{MotionKind, MotionWords};

/// A loop in equilibrium.
pub(super) struct RestedLoop {
    pub(super) rest: Rest,
    /// Position of the load's ground, m; with a linkage its angle, rad.
    pub(super) ground_m: f64,
}

/// Equilibrium of the loop under constant inputs, with the piston at the position of the initial
/// guess: all simulated time derivatives are zero.
pub(super) fn rest(
    bench: &ControlledMachine,
    guess: &[f64],
    beginning: &InitialCondition,
    held_inputs: HeldInputs,
    name: &str,
) -> Result<RestedLoop, SimulateError> {
    let (motion, reference_n) = (bench.rig.motion, held_inputs.reference_n);
    let named = |error| match error {
        EquilibriumError::NotFound { state, rate } => {
            let (name, what) = (name.to_string(), MovingState::of(state));
            SimulateError::NoRest { motion, name, reference_n, what, rate }
        }
        error => SimulateError::Rest { name: name.to_string(), error },
    };
    let rest = at_rest(&bench.control, guess, beginning, held_inputs).map_err(&named)?;
    let (command_v, limit_v) = (rest.command_v, rest.limit_v);
    if command_v.abs() > limit_v {
        let name = name.to_string();
        return Err(SimulateError::RestBeyondLimit { motion, name, reference_n, command_v, limit_v });
    }
    let position =
        |start: &[f64], inputs: &[f64]| bench.machine.signals::<f64>(start, inputs).piston.position;
    let own = beginning.all_inputs();
    let wanted_m = position(&beginning.state, &own);
    let [mut ground_m, _] = beginning.inputs;
    if !bench.machine.has_linkage() {
        // only its position depends on that of the ground
        ground_m -= position(&rest.start, &own) - wanted_m;
        return Ok(RestedLoop { rest, ground_m });
    }
    // with a linkage the torque depends on it too
    let (mut rest, mut from) = (rest, beginning.clone());
    for _ in 0..GROUNDS {
        let inputs = from.all_inputs();
        let ahead_m = position(&rest.start, &inputs) - wanted_m;
        if ahead_m.abs() <= AT_POSITION_M {
            return Ok(RestedLoop { rest, ground_m });
        }
        ground_m -=
            bench.machine.turn_of(bench.machine.signals::<f64>(&rest.start, &inputs).joint.position, ahead_m);
        from.inputs[0] = ground_m;
        rest = at_rest(&bench.control, &rest.start, &from, held_inputs).map_err(&named)?;
    }
    Err(SimulateError::NoRestThere { name: name.to_string(), reference_n, position_m: wanted_m })
}

/// Largest distance of the resting piston from its required position with a linkage, m, and largest
/// number of motions of its ground.
const AT_POSITION_M: f64 = 1e-9;
const GROUNDS: usize = 60;

/// State that moves although all should rest, by its place in
/// [`MachineState`](phea_hydraulics::machine::MachineState).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovingState {
    /// Position or velocity of the spool.
    Spool,
    /// Pressure of a chamber.
    ChamberPressure(char),
    /// Force of the load cell.
    Force,
    /// Piston.
    Piston,
    /// Another state.
    Other,
}

/// Name of a state in an error.
#[derive(Debug, thiserror::Error)]
enum NamedState {
    #[error("the {0}")]
    Part(&'static str),
    #[error("the pressure of chamber {0}")]
    ChamberPressure(char),
    #[error("a state other than {0}, pressures and spool")]
    OtherThan(&'static str),
}

impl MovingState {
    /// Name of the state on a rig of this motion.
    pub fn words(self, motion: MotionKind) -> String {
        let MotionWords { force, piston, .. } = motion.words();
        let named = match self {
            MovingState::Spool => NamedState::Part("spool"),
            MovingState::ChamberPressure(side) => NamedState::ChamberPressure(side),
            MovingState::Force => NamedState::Part(force),
            MovingState::Piston => NamedState::Part(piston),
            MovingState::Other => NamedState::OtherThan(force),
        };
        named.to_string()
    }

    fn of(place: usize) -> MovingState {
        match place {
            0 | 1 => MovingState::Spool,
            2 => MovingState::ChamberPressure('A'),
            3 => MovingState::ChamberPressure('B'),
            4 => MovingState::Force,
            5 => MovingState::Piston,
            _ => MovingState::Other,
        }
    }
}
