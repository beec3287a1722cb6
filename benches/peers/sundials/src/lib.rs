//! CVODE (Hindmarsh and others, 2005) for right-hand sides written in Rust.
//!
//! [`integrate`] is for any right-hand side, [`follow`] for a system and an input schedule of phea,
//! delayed waves included. Built against SUNDIALS 6 as packaged by Debian 12; another major version
//! is rejected at run time, because its C interface differs.

mod following;
mod interface;
mod session;
mod waves;

pub use following::{Equations, Following, Kicks, follow};
use session::Session;

/// Method of CVODE's steps; all solve their implicit equations by Newton's method with a dense
/// Jacobian of difference quotients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Backward differentiation of order one to five.
    BackwardDifferentiation,
    /// Backward differentiation with detection of its stability limit, which reduces the order
    /// where eigenvalues are lightly damped.
    StabilityLimit,
    /// Adams and Moulton's formulas of order one to twelve.
    Adams,
}

/// The right-hand side: time, states, and the array for their rates.
pub type Rates<'a> = dyn FnMut(f64, &[f64], &mut [f64]) + 'a;

/// Reason why there is no solution.
#[derive(Clone, Debug, PartialEq)]
pub enum CvodeError {
    /// The library found when the program was started is not of version 6.
    Version {
        /// Major version that the library reports.
        major: i32,
    },
    /// An argument that CVODE does not accept, with its name.
    Argument(&'static str),
    /// The library could not create one of its objects.
    Memory,
    /// CVODE gave up: its negative status, and the time that it had reached.
    Failed {
        /// Status as documented: -1 too much work, -3 error test, -4 convergence, -9 and -10 the
        /// right-hand side, and others.
        status: i32,
        /// Time that was reached, in the unit of `times`.
        time: f64,
    },
}

impl std::fmt::Display for CvodeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Version { major } => write!(f, "SUNDIALS {major} is not SUNDIALS 6"),
            Self::Argument(problem) => f.write_str(problem),
            Self::Memory => f.write_str("SUNDIALS made no object"),
            Self::Failed { status, time } => write!(f, "CVODE fails with {status} at {time}"),
        }
    }
}

impl std::error::Error for CvodeError {}

/// Largest number of steps of a piece between stops.
pub const MOST_STEPS: i64 = 20_000_000;

/// The states at each of `times`, from `start` at the first of them.
///
/// ```text
/// dy/dt = rates(t, y),   error of state i against  relative_tolerance |y_i| + absolute_tolerances_i
/// ```
///
/// CVODE restarts at each of `stops`, where rates may jump or bend. Rates are taken as continuous
/// from the right: a piece that ends at a stop is evaluated up to the last number below it, the
/// piece that begins there at the stop itself, so that `t >= stop` distinguishes them. A rate that
/// is not finite makes CVODE attempt a shorter step. A panic of `rates` is propagated.
///
/// # Errors
///
/// Times that do not ascend, tolerances that are not positive, lengths that differ; CVODE's own
/// failures.
///
/// # Example
///
/// ```
/// let mut decay = |_: f64, state: &[f64], rates: &mut [f64]| rates[0] = -state[0];
/// let method = sundials::Method::Adams;
/// let states = sundials::integrate(&mut decay, &[1.0], &[0.0, 1.0], 1e-10, &[1e-12], method, &[])?;
/// assert!((states[1][0] - (-1.0f64).exp()).abs() < 1e-9);
/// # Ok::<(), sundials::CvodeError>(())
/// ```
pub fn integrate(
    rates: &mut Rates,
    start: &[f64],
    times: &[f64],
    relative_tolerance: f64,
    absolute_tolerances: &[f64],
    method: Method,
    stops: &[f64],
) -> Result<Vec<Vec<f64>>, CvodeError> {
    let (first, last) = check(start, times, relative_tolerance, absolute_tolerances)?;
    let mut session = Session::new(rates, start, first, relative_tolerance, absolute_tolerances, method)?;
    let mut pieces: Vec<f64> = stops.iter().copied().filter(|stop| *stop > first && *stop < last).collect();
    pieces.sort_by(f64::total_cmp);
    pieces.dedup();

    let mut states = vec![start.to_vec()];
    let mut wanted = times.iter().copied().skip(1).peekable();
    for stop in pieces {
        session.set_end(stop)?;
        while let Some(time) = wanted.next_if(|time| *time <= stop) {
            states.push(session.advance(time)?);
        }
        session.advance(stop)?;
        session.restart(stop)?;
    }
    session.set_end(last)?;
    for time in wanted {
        states.push(session.advance(time)?);
    }
    Ok(states)
}

/// The first and the last time, if the arguments fit together.
fn check(start: &[f64], times: &[f64], relative: f64, absolute: &[f64]) -> Result<(f64, f64), CvodeError> {
    let refuse = |problem| Err(CvodeError::Argument(problem));
    let (&[first, ..], &[.., last]) = (times, times) else { return refuse("there are no times") };
    if !times.is_sorted_by(|earlier, later| earlier < later) || !first.is_finite() || !last.is_finite() {
        return refuse("the times do not ascend");
    }
    if start.is_empty() || start.len() != absolute.len() {
        return refuse("each state needs one absolute tolerance");
    }
    if start.iter().any(|value| !value.is_finite()) {
        return refuse("a state is not finite at the start");
    }
    if !(relative > 0.0 && absolute.iter().all(|tolerance| *tolerance > 0.0)) {
        return refuse("a tolerance is not positive");
    }
    Ok((first, last))
}
