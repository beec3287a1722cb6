//! Systems without a fluid: the scalar type of all model equations, recorded expressions, linear
//! systems, their frequency and time responses, controllers, the closed loops around a plant, and
//! the uncertain plant for robust design.
//!
//! ```text
//! parameters -> Expression -> UncertainPlant -> PlantMember                    the family
//! StateSpace -> TransferFunction -> FrequencyResponse -> margins, passivity    linear analysis
//! Element -> Compensator -> Controller -> SampledController                    the controller
//! System + InputSchedule + SimulationSettings -> simulate -> Trajectory, Outcome
//! Plant -> Sensed -> CommandedPlant -> System                                  the closed loop
//! f, ends, start -> x, f(x)                                                    the minimum of one variable
//! residuals, derivatives -> Minimum -> Uncertainty                             variables determined by data
//! recorded signals -> Blocks -> SpectralPoint                                  measured frequency responses
//! ```
//!
//! Quantities are in SI units, angles in radians, frequencies in rad/s, polynomials with the
//! highest power first.

pub mod analytic;
pub mod closed_loop;
pub mod controller;
pub mod expression;
pub mod frequency;
pub mod least_squares;
pub mod linear;
pub mod minimum;
pub mod order;
pub mod pieces;
pub mod portable;
pub mod random;
pub mod range;
pub mod scalar;
pub mod simulation;
pub mod spectrum;
pub mod time_response;
pub mod uncertain_plant;
pub mod watch;
