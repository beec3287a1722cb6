//! Caveat for a notch or peak of the controller that sampling moves.

use phea_dynamics::controller::{Compensator, Timing};
use phea_dynamics::linear::{MovedRoot, TimeDomain};

use super::{Caveat, UncountedEffect};
use crate::setup::Setup;

/// Relative shift of a frequency above which it is reported.
const MOVED: f64 = 0.02;

/// Lightly damped zeros and poles of controller and prefilter that sampling moves.
pub(super) fn moved_roots(setup: &Setup<'_>) -> Vec<Caveat> {
    let controller = setup.controller.as_ref().map(|given| &given.feedback);
    let prefilter = setup.prefilter.as_ref().filter(|_| !setup.timing.continuous_prefilter);
    let both = [("[controller]", controller), ("[prefilter]", prefilter)];
    let parts = both.into_iter().filter_map(|(place, part)| Some((place, part?)));
    parts.flat_map(|(place, part)| of_part(place, part, &setup.timing)).collect()
}

fn of_part(table: &'static str, part: &Compensator, timing: &Timing) -> Vec<Caveat> {
    let Some(sample_time_s) = timing.sample_time_s else { return vec![] };
    let function = part.transfer_function().ok().filter(|part| part.domain() == TimeDomain::Continuous);
    let moved = function.and_then(|part| part.moved_roots(sample_time_s, timing.discretization).ok());
    let shifted = moved.into_iter().flatten().filter(|root| root.shift().abs() > MOVED);
    let of_root = |root: MovedRoot| {
        let discretization = timing.discretization;
        Caveat::noted(UncountedEffect::MovedRoot { table, root, discretization })
    };
    shifted.map(of_root).collect()
}
