//! Nonlinear model with its source of commands: a continuous controller, a computer that samples,
//! or a stated command.
//!
//! ```text
//! Machine (hydraulics) -> Sensed -> Control { Continuous | Sampled | Open }
//! Control + Task  -> Control::drive                 -> Outcome      one machine
//! Control + Fleet -> one_by_one, Lanewise::in_lanes -> Outcome...   many, a machine in each lane
//! Control         -> at_rest, Control::orbit, Control::shaken       rest, small signals, sines
//! ```
//!
//! The methods of [`phea_dynamics::simulation`] are generic; here they are instantiated for the
//! only machine, so that each is compiled once, and optimised in test builds too.

mod control;
mod deployed;
mod digital;
mod frozen;
mod lanes;
mod rest;
mod samples;
mod shaken;

pub use control::{Commanded, Control, Sampled, Watcher};
pub use deployed::{Deployed, DeployedState, Executed, SampledSignals};
pub use digital::{Digital, DigitalMemory, Waking};
pub use lanes::{FedMotion, Fleet, Lanewise, one_by_one};
pub use rest::{HeldInputs, Rest, at_rest};
pub use samples::{ControllerSample, ControllerSamples};
pub use shaken::{Shaken, force, force_amplitude};
