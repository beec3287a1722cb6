//! CVODE (Hindmarsh and others, 2005) for right-hand sides written in Rust.
//!
//! [`integrate`] for any right-hand side, [`follow`] for a system and a course of phea, delayed
//! waves included. Built against SUNDIALS 6 as Debian 12 packages it; another major version is
//! refused when it is met, because its C interface differs.

mod course;
mod interface;
mod session;
mod waves;

pub use course::{Equations, Following, Kicks, follow};
use session::Session;

/// How CVODE steps; both solve their implicit equations by Newton's method with a dense Jacobian of
/// difference quotients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Backward differentiation of order one to five.
    BackwardDifferentiation,
    /// The same with the detection of its stability limit, which lowers the order where eigenvalues
    /// are lightly damped.
    StabilityLimit,
    /// Adams and Moulton's formulas of order one to twelve.
    Adams,
}

/// The right-hand side: time, states, and where their rates go.
pub type Rates<'a> = dyn FnMut(f64, &[f64], &mut [f64]) + 'a;

/// Why there is no solution.
#[derive(Clone, Debug, PartialEq)]
pub enum CvodeError {
    /// The library found when the program was started is not of version 6.
    Version {
        /// What it says it is.
        major: i32,
    },
    /// An argument that CVODE cannot be given; says which.
    Argument(&'static str),
    /// The library could not make one of its objects.
    Memory,
    /// CVODE gave up: its negative status, and the time that it had reached.
    Failed {
        /// As documented: -1 too much work, -3 error test, -4 convergence, -9 and -10 the
        /// right-hand side, and others.
        status: i32,
        /// In the unit of `times`.
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

/// Steps that one piece between stops may take.
pub const MOST_STEPS: i64 = 20_000_000;

/// The states at each of `times`, from `start` at the first of them.
///
/// ```text
/// dy/dt = rates(t, y),   error of state i against  relative_tolerance |y_i| + absolute_tolerances_i
/// ```
///
/// CVODE starts anew at each of `stops`, where rates may jump or bend. Rates are taken as
/// continuous from the right: a piece that ends at a stop sees the last number below it, the piece
/// that begins there sees the stop itself, so that `t >= stop` distinguishes them. A rate that is
/// not finite makes CVODE try a shorter step. A panic of `rates` passes through.
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
