//! A transfer function as a chain of first- and second-order sections with an output tap on every
//! state.
//!
//! ```text
//! u -> 1/d_m -> ... -> 1/d_2 -> 1/d_1          d_1 ... d_m the poles, slowest first, so that the fast ones act first
//! y = D u + r_1/d_1...d_m u + r_2/d_2...d_m u + ... + r_m/d_m u
//! ```
//!
//! The taps r are the digits of the numerator in the mixed radix d_1, d_1 d_2, ...: remainders of
//! repeated division, done in twice the working precision. The poles are on the diagonal of A; the
//! companion form of the whole would lose the small ones to rounding.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::double_double::DoubleDouble;
use super::polynomial::expand;
use super::{LinearError, LinearOperation, MAXIMUM_DELAY_STATES, StateSpace, TimeDomain, TransferFunction};
use crate::order::sort_by_number;
use crate::portable::magnitude;

pub(crate) fn cascade(system: &TransferFunction) -> Result<StateSpace, LinearError> {
    let delay = match system.domain() {
        _ if system.dead_time_s() == 0.0 => 0,
        TimeDomain::Continuous => {
            return Err(LinearError::NotRational { operation: LinearOperation::StateSpace });
        }
        TimeDomain::Discrete { sample_time_s } => delay_states(system.dead_time_s() / sample_time_s)?,
    };
    let chain = chain_of(system)?;
    let result = StateSpace::new(
        chain.a,
        chain.b,
        DMatrix::from_fn(1, chain.taps.len(), |_, state| chain.taps[state].value()),
        DMatrix::from_element(1, 1, chain.feedthrough),
        system.domain(),
    )?;
    let sample = |entries: [f64; 4]| {
        let [a, b, c, d] = entries.map(|entry| DMatrix::from_element(1, 1, entry));
        StateSpace::new(a, b, c, d, system.domain())
    };
    (0..delay).try_fold(result, |result, _| result.series(&sample([0.0, 1.0, 1.0, 0.0])?))
}

/// Matrices of a chain, block upper triangular, its taps in twice the working precision: if zeros
/// are far below the poles, the taps cancel in the response.
pub(super) struct Chain {
    pub(super) a: DMatrix<f64>,
    pub(super) b: DMatrix<f64>,
    pub(super) taps: Vec<DoubleDouble>,
    pub(super) feedthrough: f64,
}

/// Chain of a transfer function without its dead time.
pub(super) fn chain_of(system: &TransferFunction) -> Result<Chain, LinearError> {
    let (zeros, poles) = (system.zeros(), system.poles());
    if zeros.len() > poles.len() {
        return Err(LinearError::Improper { zeros: zeros.len(), poles: poles.len() });
    }
    let mut numerator = expand(system.gain(), zeros);
    let mut chain = Vec::with_capacity(poles.len());
    for pole in slowest_first(poles, system.domain()) {
        let (quotient, remainder) = divided(&numerator, &denominator(pole));
        numerator = quotient;
        chain.push(ChainSection { pole, remainder, exponent: exponent_of(pole) });
    }
    let feedthrough = if zeros.len() == poles.len() { system.gain() } else { 0.0 };
    Ok(states_of(&chain, poles.len(), feedthrough))
}

/// Number of states for this many samples of dead time, a whole number up to rounding.
pub(crate) fn delay_states(samples: f64) -> Result<usize, LinearError> {
    if samples > MAXIMUM_DELAY_STATES {
        return Err(LinearError::TooManyDelayStates { samples });
    }
    Ok((0..).map(|count: u32| f64::from(count) + 0.5).take_while(|upper| *upper < samples).count())
}

/// Real pole or complex pair (by its upper member), with its digit of the numerator.
struct ChainSection {
    pole: Complex64,
    remainder: Vec<DoubleDouble>,
    /// Exponent of the power of two, near the magnitude of the pole, by which input and inner
    /// coupling are multiplied.
    exponent: i32,
}

/// Denominator s - p, or (s - sigma)^2 + omega^2.
fn denominator(pole: Complex64) -> Vec<DoubleDouble> {
    if pole.im == 0.0 { expand(1.0, &[pole]) } else { expand(1.0, &[pole.conj(), pole]) }
}

/// Real poles and upper members of pairs, in order of distance from zero frequency.
fn slowest_first(poles: &[Complex64], domain: TimeDomain) -> Vec<Complex64> {
    let slow = match domain {
        TimeDomain::Continuous => Complex64::new(0.0, 0.0),
        TimeDomain::Discrete { .. } => Complex64::new(1.0, 0.0),
    };
    let mut upper: Vec<Complex64> = poles.iter().copied().filter(|pole| pole.im >= 0.0).collect();
    sort_by_number(&mut upper, |pole| magnitude(pole - slow));
    upper
}

/// Quotient and remainder of a polynomial by a monic one, highest power first; the remainder has
/// the divisor's degree as its number of coefficients.
fn divided(dividend: &[DoubleDouble], divisor: &[DoubleDouble]) -> (Vec<DoubleDouble>, Vec<DoubleDouble>) {
    let degree = divisor.len() - 1;
    let mut rest = dividend.to_vec();
    let count = dividend.len().saturating_sub(degree);
    for index in 0..count {
        let factor = rest[index];
        for (offset, &coefficient) in divisor.iter().enumerate().skip(1) {
            rest[index + offset] = rest[index + offset] - factor * coefficient;
        }
    }
    let remainder = rest.split_off(count);
    let padding = vec![DoubleDouble::ZERO; degree - remainder.len()];
    (rest, [padding, remainder].concat())
}

/// States of a chain whose slowest section comes first in the list and last in the signal path.
///
/// ```text
/// x   = w v/(s - p)                                    one real pole; v the input, w = 2^exponent
/// x_1 = w^2 v/d,     x_2 = w (s - sigma) v/d           a pair, d its denominator
/// ```
///
/// The output of a section is x or x_1.
fn states_of(chain: &[ChainSection], order: usize, feedthrough: f64) -> Chain {
    let mut a = DMatrix::zeros(order, order);
    let mut b = DMatrix::zeros(order, 1);
    let mut taps = vec![DoubleDouble::ZERO; order];
    // exponent of the product of all w on the signal path before the section, from the fastest on
    let mut before = 0;
    // source of the section's input: a state, or (at first) the input
    let mut source: Option<usize> = None;
    let mut end = order;
    for section in chain.iter().rev() {
        let (sigma, omega) = (section.pole.re, section.pole.im);
        let unit = libm::ldexp(1.0, section.exponent);
        let size = section.remainder.len();
        let output = end - size;
        let entry = end - 1;
        match source {
            Some(state) => a[(entry, state)] = unit,
            None => b[(entry, 0)] = unit,
        }
        for state in output..end {
            a[(state, state)] = sigma;
        }
        match section.remainder[..] {
            [slope, constant] => {
                a[(output, entry)] = unit;
                a[(entry, output)] = -omega * (omega / unit);
                // slope s + constant = slope (s - sigma) + (constant + slope sigma)
                let at_centre = constant + slope * sigma.into();
                taps[output] = scaled(at_centre, -before - 2 * section.exponent);
                taps[entry] = scaled(slope, -before - section.exponent);
                before += 2 * section.exponent;
            }
            [constant] => {
                taps[output] = scaled(constant, -before - section.exponent);
                before += section.exponent;
            }
            _ => {}
        }
        source = Some(output);
        end = output;
    }
    Chain { a, b, taps, feedthrough }
}

fn scaled(number: DoubleDouble, exponent: i32) -> DoubleDouble {
    DoubleDouble { high: libm::ldexp(number.high, exponent), low: libm::ldexp(number.low, exponent) }
}

/// Exponent of a power of two near the magnitude of a pole; zero for one at the origin.
fn exponent_of(pole: Complex64) -> i32 {
    let size = magnitude(pole);
    if size == 0.0 { 0 } else { libm::frexp(size).1 }
}
