//! A valve whose coefficients do not explain the recordings that they come from.

use super::Caveat;
use crate::quantity::significant;
use crate::setup::Setup;

/// Part of the range of a signal up to which a misfit leaves a verdict on its valve as it is.
const BOUND: f64 = 5e-3;

/// The misfit of identified coefficients; beyond the bound no verdict rests on them.
pub(super) fn misfit(setup: &Setup<'_>) -> Option<Caveat> {
    let found = setup.project.actuator.as_ref()?.valve.misfit.as_ref()?;
    let [share, bound] = [found.share, BOUND].map(|share| significant(100.0 * share, 3));
    let of = found.at.as_ref().map_or_else(String::new, |at| format!(", {at}"));
    let unproven = found.share > BOUND;
    let consequence = match unproven {
        true => format!("beyond {bound} % no verdict on this valve is met"),
        false => format!("up to {bound} % a verdict on this valve stands"),
    };
    let sentence = format!(
        "the coefficients of the valve leave {share} % of the range of a recorded signal unexplained (valve.misfit{of}): {consequence}"
    );
    Some(Caveat { sentence, unproven })
}
