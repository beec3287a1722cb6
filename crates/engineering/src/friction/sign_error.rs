use crate::tendency::Tendency;

/// Error of signals with opposite signs.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum SignError {
    /// A recorded velocity is opposite to the slope of the position.
    #[error(
        "`{velocity}` is against the slope of `{position}` (correlation {:.2} over {} blocks of rows)",
        tendency.correlation,
        tendency.rows
    )]
    Velocity { velocity: String, position: String, tendency: Tendency },
    /// The force that drives the piston is opposite to its motion.
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

/// Further reason why a force may be opposite to the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
enum OtherReason {
    /// The pressures of both ports are exchanged.
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
