//! A notch or peak of the controller that its samples have elsewhere.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Timing};
use phea_dynamics::linear::{Discretization, MovedRoot, TimeDomain};
use phea_dynamics::portable;

use super::Caveat;
use crate::quantity::{ANGULAR_FREQUENCY, display, significant};
use crate::setup::Setup;

/// Relative shift of a frequency from which it is reported.
const MOVED: f64 = 0.02;

/// The lightly damped zeros and poles of controller and prefilter that their sampling moves.
pub(super) fn moved_roots(setup: &Setup<'_>) -> Vec<Caveat> {
    let controller = setup.controller.as_ref().map(|given| &given.feedback);
    let prefilter = setup.prefilter.as_ref().filter(|_| !setup.timing.continuous_prefilter);
    let both = [("[controller]", controller), ("[prefilter]", prefilter)];
    let parts = both.into_iter().filter_map(|(place, part)| Some((place, part?)));
    parts.flat_map(|(place, part)| of_part(place, part, &setup.timing)).collect()
}

fn of_part(place: &str, part: &Compensator, timing: &Timing) -> Vec<Caveat> {
    let Some(sample_time_s) = timing.sample_time_s else { return vec![] };
    let function = part.transfer_function().ok().filter(|part| part.domain() == TimeDomain::Continuous);
    let moved = function.and_then(|part| part.moved_roots(sample_time_s, timing.discretization).ok());
    let shifted = moved.into_iter().flatten().filter(|root| root.shift().abs() > MOVED);
    shifted.map(|root| Caveat { sentence: sentence(place, &root, timing), unproven: false }).collect()
}

fn sentence(place: &str, moved: &MovedRoot, timing: &Timing) -> String {
    let frequency = |root: Complex64| display(portable::magnitude(root), &ANGULAR_FREQUENCY, 4);
    let (name, cure) = match timing.discretization {
        Discretization::Tustin => {
            let exact = format!(
                "discretization_frequency = \"{}\" keeps it there, and discretization = \"matched\" keeps all",
                frequency(moved.root)
            );
            ("tustin", exact)
        }
        Discretization::PrewarpedTustin { .. } => (
            "tustin",
            "discretization_frequency keeps one frequency alone, and discretization = \"matched\" keeps all"
                .to_string(),
        ),
        Discretization::ZeroOrderHold => {
            ("zero_order_hold", "discretization = \"matched\" keeps it there".to_string())
        }
        Discretization::Matched => ("matched", "a shorter sample_time keeps it there".to_string()),
    };
    format!(
        "{place}: discretization = \"{name}\" moves the {} at {} with a damping ratio of {} to {}, by {} %: {cure}",
        if moved.is_zero { "zero" } else { "pole" },
        frequency(moved.root),
        significant(-moved.root.re / portable::magnitude(moved.root), 2),
        frequency(moved.image),
        significant(100.0 * moved.shift(), 2)
    )
}
