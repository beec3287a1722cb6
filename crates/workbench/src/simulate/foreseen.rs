//! Signals of scenarios that a rig cannot follow, in sentences.

use phea_engineering::simulate::{BeyondRig, Foreseen};

use super::force_limits::{exceeded_force, force};
use crate::project::LateError;
use crate::quantity::{LENGTH, TIME, Units, display};

/// Foreseen obstacle, at its key.
pub(crate) fn foreseen_late(foreseen: Foreseen, units: &Units) -> LateError {
    match foreseen {
        Foreseen::AbsentRecording(error) => error,
        Foreseen::InScenario { index, name, beyond } => LateError {
            path: format!("scenario[{index}].{}", beyond.key()),
            message: format!("scenario \"{name}\": {}", beyond_rig(&beyond, units)),
            help: String::new(),
        },
    }
}

fn beyond_rig(beyond: &BeyondRig, units: &Units) -> String {
    match beyond {
        BeyondRig::Reference { time, force: goes_to, exceeded } => format!(
            "the reference goes to {} at {}, {}",
            force(*goes_to, units),
            display(*time, &TIME, 4),
            exceeded_force(exceeded, units).0
        ),
        BeyondRig::Motion { time, moved_by, from, stroke } => {
            let length = |value: f64| display(value, units.motion.dimension(&LENGTH), 4);
            format!(
                "the load moves by {} until {} and takes the {} from {} to {}, beyond its stroke of {}",
                length(*moved_by),
                display(*time, &TIME, 4),
                units.motion.words().piston,
                length(*from),
                length(from + moved_by),
                length(*stroke)
            )
        }
    }
}
