use phea_dynamics::linear::LinearError;

use crate::design::DesignError;
use crate::option::OptionError;
use crate::project::Refusal;
use crate::quantity::Currency;
use crate::rig::RigError;
use crate::setup::ControlError;
use crate::simulate::SimulateError;
use crate::sizing::{OtherMeansError, SizingError};

/// Reason why no alternatives are judged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AlternativesError {
    /// There is only the project itself.
    #[error(
        "the project has no [[alternative]]: add one with `name` and `set = {{ \"line.length\" = \"3 m\" }}`"
    )]
    NoAlternative,
    /// There is no specification for a controller.
    #[error(transparent)]
    NoSpecification(DesignError),
    /// The requested front is invalid.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// The catalogue, or a project that was changed, cannot be read.
    #[error("{0}")]
    Refused(Refusal),
    /// An alternative that cannot be prepared.
    #[error("alternative `{name}`: {reason}")]
    Alternative {
        /// Its name.
        name: String,
        /// Reason why it cannot be prepared, and the remedy.
        reason: PrepareError,
    },
}

/// Reason why an alternative cannot be prepared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PrepareError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// Its controller is no transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// No hose can be sized.
    #[error(transparent)]
    Sizing(#[from] SizingError),
    /// The part in place of the hose cannot be sized.
    #[error(transparent)]
    OtherMeans(#[from] OtherMeansError),
    /// The table is missing, or no hose is accepted.
    #[error(
        "gas, a spring, a pipe and a valve are sized by [sizing.other_means], with a hose that is accepted: state that table"
    )]
    NoOtherMeans,
    /// No valve reaches the damping ratio.
    #[error("no valve between the chambers damps the load cell so much")]
    NoValve,
    /// Neither hoses are to be sized nor a part in place of them.
    #[error("`size` finds the hoses of both sides: its [line] must have them")]
    NoHoses,
    /// The project would give the hose that is found properties of its own.
    #[error(
        "[line] states properties of its own hose, which the hose that [sizing] finds would take over: state them in a catalogue"
    )]
    OwnHose,
    /// A price is in another currency than those before it.
    #[error(
        "it states a price in {} where others are in {}, and no rate is known: state all in one currency",
        other.code(),
        first.code()
    )]
    TwoCurrencies {
        /// Currency of the alternatives before it.
        first: Currency,
        /// Its own.
        other: Currency,
    },
    /// A range around zero cannot follow the rig.
    #[error(
        "`recentre` cannot move the range of {parameter}, which is zero as it is declared: state it in `set`"
    )]
    ZeroRange {
        /// Name of the parameter of the linear model.
        parameter: String,
    },
}

/// Reason why a part of what is found about an alternative is missing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JudgeError {
    /// The rig cannot be computed with.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// Its controller is no transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// No hose of the requested size.
    #[error(transparent)]
    NoHose(#[from] NoHose),
    /// No hose can be sized.
    #[error(transparent)]
    Sizing(#[from] SizingError),
    /// No controller can be designed.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// There is no loop to compute with.
    #[error("no controller was designed")]
    NoController,
    /// There are no linear models.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// A scenario cannot be run.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

/// Reason why `[sizing]` finds no hose for an alternative that takes the one it finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoHose {
    /// Something rejects each of them.
    #[error("no hose of the catalogue is accepted by [sizing]")]
    NoneAccepted,
    /// The chambers are soft enough without one.
    #[error("[sizing] finds that no hose is needed")]
    NoneNeeded,
}
