use crate::tendency::Tendency;

/// Error of signals that go against each other.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum SignError {
    /// A recorded velocity against the slope of the position.
    #[error(
        "`{velocity}` is against the slope of `{position}` (correlation {:.2} over {} blocks of rows)",
        tendency.correlation,
        tendency.rows
    )]
    Velocity { velocity: String, position: String, tendency: Tendency },
    /// A force that drives the piston against its motion.
    #[error(
        "the force that drives the piston, of {columns}, is against its motion by {motion} (correlation {:.2} over {} blocks of rows)",
        tendency.correlation,
        tendency.rows
    )]
    Force { columns: String, motion: String, tendency: Tendency },
}

/// Expectation or remedy next to such an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum SignHint {
    /// Expectation of a velocity.
    #[error("the velocity with which the position grows")]
    VelocityOfPosition,
    /// Remedy of a velocity.
    #[error("change the sign of `{velocity}` or of `{position}`")]
    ChangeOneSign { velocity: String, position: String },
    /// Expectation of a force.
    #[error("A_A p_A - A_B p_B - F_e in the direction of the motion, which friction opposes")]
    ForceAlongMotion,
    /// Remedy of a force against the motion.
    #[error(
        "{motion} grows as the rod extends, and a load cell reads positive where the rod pushes: one of them has the other sign{}",
        others(*exchanged, *shifted)
    )]
    OtherSign { motion: String, exchanged: bool, shifted: bool },
}

/// Further reason for which a force may be against the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
enum OtherReason {
    /// Both pressures, each for the other one.
    #[error(", or the columns of the ports are exchanged")]
    Exchanged,
    /// Instruments of a run in one direction.
    #[error(", or their zero is off by more than the friction")]
    Shifted,
}

fn others(exchanged: bool, shifted: bool) -> String {
    let exchanged = exchanged.then_some(OtherReason::Exchanged);
    let shifted = shifted.then_some(OtherReason::Shifted);
    exchanged.into_iter().chain(shifted).map(|reason| reason.to_string()).collect()
}
