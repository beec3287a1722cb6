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
    /// The project has no alternatives.
    #[error(
        "the project has no [[alternative]]: add one with `name` and `set = {{ \"line.length\" = \"3 m\" }}`"
    )]
    NoAlternative,
    /// The project has no specification for a controller.
    #[error(transparent)]
    NoSpecification(DesignError),
    /// The requested front is invalid.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// The catalogue, or a changed project, cannot be read.
    #[error("{0}")]
    Refused(Refusal),
    /// An alternative cannot be prepared.
    #[error("alternative `{name}`: {reason}")]
    Alternative {
        /// Name of the alternative.
        name: String,
        /// Reason why it cannot be prepared, and the remedy.
        reason: PrepareError,
    },
}

/// Reason why an alternative cannot be prepared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PrepareError {
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The controller is not a transfer function.
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
    /// Neither hoses nor a part in place of them are to be sized.
    #[error("`size` finds the hoses of both sides: its [line] must have them")]
    NoHoses,
    /// The project would give its own properties to the hose that is found.
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
        /// Currency of this alternative.
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

/// Reason why a part of the results of an alternative is missing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JudgeError {
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The controller is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// There is no hose of the requested size.
    #[error(transparent)]
    NoHose(#[from] NoHose),
    /// No hose can be sized.
    #[error(transparent)]
    Sizing(#[from] SizingError),
    /// No controller can be designed.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// There is no controller, and hence no loop.
    #[error("no controller was designed")]
    NoController,
    /// There are no linear models.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// A scenario cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

/// Reason why `[sizing]` finds no hose for an alternative that takes the one it finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoHose {
    /// Each of them is rejected.
    #[error("no hose of the catalogue is accepted by [sizing]")]
    NoneAccepted,
    /// The chambers are soft enough without one.
    #[error("[sizing] finds that no hose is needed")]
    NoneNeeded,
}
