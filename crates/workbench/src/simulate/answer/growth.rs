//! The growth of errors in a run.

use crate::answer::{Answer, Reasoned, words};
use phea_dynamics::simulation::{Amplification, GrowthCause, UnfollowedCause, UnfollowedKinks};

/// Growth by which errors within the tolerance may become visible.
#[derive(Answer)]
pub(super) struct AmplificationAnswer {
    /// Simulated time at which the growth begins.
    from_s: f64,
    /// Simulated time at which the growth is largest.
    until_s: f64,
    /// Magnitude of the eigenvalue of the growing mode at that time.
    frequency_rad_per_s: Reasoned<f64>,
    /// Natural logarithm of the growth factor.
    growth_logarithm: f64,
    /// Cause of the growth.
    cause: GrowthCause,
}

/// Kinks, as of friction, stops and contacts, from which no deviation was carried to the next.
#[derive(Answer)]
pub(super) struct UnfollowedKinksAnswer {
    /// Number of steps that pass a kink.
    steps: u64,
    /// Reason why no deviation was carried.
    cause: UnfollowedCause,
}

words! {
    /// Cause that amplifies errors: a mode of the machine, the closed loop with its samples or
    /// delays, or the motion from kink to kink.
    GrowthCause { Mode => "mode", Loop => "closed_loop", Motion => "motion" }
}

words! {
    /// Reason why a deviation is not carried along a run: a sampled controller, a delay of a
    /// command or of a wave, or a method of integration without a matrix for it.
    UnfollowedCause { Samples => "samples", Delays => "delays", Method => "method" }
}

/// The growth of errors.
pub(super) fn amplification(grown: Amplification) -> AmplificationAnswer {
    let of_mode = (grown.cause != GrowthCause::Motion).then_some(grown.frequency_rad_per_s);
    AmplificationAnswer {
        from_s: grown.from_s,
        until_s: grown.until_s,
        frequency_rad_per_s: Reasoned::new(of_mode, "no single mode grows"),
        growth_logarithm: grown.logarithm,
        cause: grown.cause,
    }
}

/// Kinks whose amplification is not known.
pub(super) fn unfollowed(kinks: UnfollowedKinks) -> UnfollowedKinksAnswer {
    UnfollowedKinksAnswer { steps: kinks.steps, cause: kinks.cause }
}
