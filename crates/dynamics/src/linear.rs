//! Linear time-invariant systems, continuous or sampled: factored transfer functions, polynomials
//! and state space.
//!
//! The roots of hydraulic systems spread over many decades (a load-holding pole at 0.01 rad/s and a
//! mechanical resonance at 3000 rad/s and an oil column at 1e6), where the coefficients of a
//! polynomial no longer determine its roots. So a [`TransferFunction`] keeps gain, zeros and poles,
//! and is evaluated from them; [`Polynomial`]s are for text and for other tools; a [`StateSpace`]
//! is solved, never expanded.
//!
//! # Example
//! A closed loop from factors, and its poles:
//! ```
//! use num_complex::Complex64;
//! use phea_dynamics::linear::TransferFunction;
//! # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
//! let pole = Complex64::new(-2.0, 0.0);
//! let plant = TransferFunction::from_factors(6.0, vec![], vec![pole])?;
//! let closed = plant.feedback(&TransferFunction::gain_only(1.0))?;
//! assert_eq!(closed.poles(), [Complex64::new(-8.0, 0.0)]);
//! assert_eq!(closed.dc_gain(), 0.75);
//! # Ok(())
//! # }
//! ```

mod discretization;
pub(crate) mod double_double;
mod eigenvalues;
pub(crate) mod even_part;
mod held;
mod hessenberg;
mod interconnection;
pub(crate) mod matrix_exponential;
mod moved_roots;
mod polynomial;
mod quantities;
mod realization;
mod refinement;
mod roots;
mod state_space;
mod structure;
mod transfer_function;
mod wide;
mod zeros;

use num_complex::Complex64;

pub use discretization::Discretization;
pub(crate) use eigenvalues::working_eigenvalues;
pub use held::{HeldFactors, HeldModes, HeldPoint};
pub use moved_roots::MovedRoot;
pub use polynomial::Polynomial;
pub use quantities::{LinearNumber, LinearOperation};
pub use state_space::StateSpace;
pub(crate) use structure::irreducible_blocks;
pub use transfer_function::TransferFunction;

/// Time domain of a system: continuous (variable s) or sampled (variable z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeDomain {
    /// Continuous time: the imaginary axis is s = jw.
    Continuous,
    /// Sampled every `sample_time_s` seconds: the imaginary axis becomes the circle z = exp(jwT).
    Discrete {
        /// Sample time T in s, positive.
        sample_time_s: f64,
    },
}

/// Largest number of samples of dead time that may become states of a sampled system.
const MAXIMUM_DELAY_STATES: f64 = 200.0;

/// Error for a linear system that cannot be built or computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// A number of the input that is infinite or NaN.
    #[error("{what} is not a finite number")]
    NotFinite {
        /// Name of the number.
        what: LinearNumber,
    },
    /// A zero polynomial where roots or a denominator are needed.
    #[error("the polynomial is zero everywhere")]
    ZeroPolynomial,
    /// Values for which an uncertain plant has no plant.
    #[error("there is no plant with these parameters")]
    NoPlant,
    /// A complex zero or pole without its conjugate: the system would not be real.
    #[error("the root {root} has no conjugate partner")]
    MissingConjugate {
        /// Root without a conjugate.
        root: Complex64,
    },
    /// The iteration for the roots of a polynomial did not converge.
    #[error("the roots of a polynomial of degree {degree} did not converge")]
    RootsNotConverged {
        /// Degree of the polynomial.
        degree: usize,
    },
    /// The iteration for the eigenvalues of a matrix did not converge.
    #[error("the eigenvalues of a matrix of order {order} did not converge")]
    EigenvaluesNotConverged {
        /// Order of the matrix.
        order: usize,
    },
    /// The computed zeros of a sampled plant do not reproduce its response.
    #[error(
        "the zeros of a sampled plant of order {order} could not be found to the accuracy of its response"
    )]
    SampledZeros {
        /// Order of the sampled plant.
        order: usize,
    },
    /// A matrix whose shape does not fit the others.
    #[error("{matrix} is {} by {}, expected {} by {}", found.0, found.1, expected.0, expected.1)]
    Shape {
        /// Name of the matrix.
        matrix: &'static str,
        /// Rows and columns of the matrix.
        found: (usize, usize),
        /// Rows and columns that are required.
        expected: (usize, usize),
    },
    /// An input or output number that the system does not have.
    #[error("there is no {port} {index}; the system has {count}")]
    NoSuchPort {
        /// `"input"` or `"output"`.
        port: &'static str,
        /// Number requested, counted from zero.
        index: usize,
        /// Number of inputs or outputs.
        count: usize,
    },
    /// Two systems in different time domains, or with different sample times, that cannot be
    /// connected.
    #[error("the systems live in different time domains")]
    DomainMismatch,
    /// An operation that needs the other time domain.
    #[error("{operation} needs a {needed} system")]
    WrongDomain {
        /// Requested operation.
        operation: LinearOperation,
        /// `"continuous"` or `"sampled"`.
        needed: &'static str,
    },
    /// A strictly proper compensator where the output must follow the input at once.
    #[error("the compensator is strictly proper: no error brings its output to a limit at once")]
    NoFeedthrough,
    /// A sample time that is zero, negative or not finite.
    #[error("a sample time must be positive, not {sample_time_s} s")]
    SampleTime {
        /// The sample time given, s.
        sample_time_s: f64,
    },
    /// A dead time that is negative or not finite.
    #[error("a dead time must be zero or positive, not {dead_time_s} s")]
    DeadTime {
        /// The dead time given, s.
        dead_time_s: f64,
    },
    /// A dead time that is not a whole number of samples where one is needed.
    #[error("the dead time {dead_time_s} s is not a whole number of samples of {sample_time_s} s")]
    FractionalDeadTime {
        /// The dead time, s.
        dead_time_s: f64,
        /// The sample time, s.
        sample_time_s: f64,
    },
    /// A dead time of so many samples that it would need too many states.
    #[error(
        "a dead time of {samples} samples is too long to become states; at most {MAXIMUM_DELAY_STATES} may"
    )]
    TooManyDelayStates {
        /// Dead time in samples.
        samples: f64,
    },
    /// A result that would not be a rational function: dead time inside a sum or a loop, or in a
    /// state space.
    #[error("{operation} with dead time is not a rational function")]
    NotRational {
        /// Requested operation.
        operation: LinearOperation,
    },
    /// A real root that Tustin's map takes to infinity: the sample time does not fit the system.
    #[error("a root at {root_rad_per_s} rad/s has no image at this sample time")]
    NoImage {
        /// The root, equal to 2/T, rad/s.
        root_rad_per_s: f64,
    },
    /// More zeros than poles where a realisable system is needed.
    #[error("the system has {zeros} zeros but only {poles} poles")]
    Improper {
        /// Number of zeros.
        zeros: usize,
        /// Number of poles.
        poles: usize,
    },
    /// A loop whose gain at infinite frequency is -1: it has no solution.
    #[error("the loop is not well posed: its gain at infinite frequency is -1")]
    IllPosedLoop,
    /// The inverse of a system that is zero everywhere.
    #[error("a system with zero gain has no inverse")]
    NoInverse,
    /// A frequency outside the range in which the operation has a meaning.
    #[error("the frequency {frequency_rad_per_s} rad/s is outside the range of {operation}")]
    Frequency {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Requested operation.
        operation: LinearOperation,
    },
}
