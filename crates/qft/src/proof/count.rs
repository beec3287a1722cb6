//! The number of poles of a sampled loop outside the unit circle, from the winding of its
//! characteristic function.
//!
//! ```text
//! f = (1 + L) D Hd Gd,    chi(z) = (1 + L) Gd z^n product of (z - e^(s_i T)),    s_i the roots of D Hd
//! turn of f - turn of D' Hd' - i pi/2 = pi (degree of Gd + roots of D Hd to the right - poles of the loop outside)     from 0 to pi/T
//! ```
//!
//! with D Hd = s^i D' Hd'. Both are followed along leaves, each with a direction from which its
//! function deviates by less than a quarter turn, so that the directions of two adjacent leaves
//! differ by less than half a turn.

use std::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex64;
use phea_dynamics::portable;

use super::certificate::{FrequencyPanel, LEAF, PoleCount};
use super::claimed::{Claimed, Loop};
use super::over_panel::Complex;
use super::polynomial::Decimal;

/// Distance from a whole number within which a number of half turns is known: four values whose
/// directions are known to [`CLEAR`] change it by at most 0.2.
const WHOLE: f64 = 0.2;
/// Fraction of a value's magnitude to which its parts must be known for its direction to be known;
/// the deviation in rad is then at most one and a half times that.
const CLEAR: f64 = 0.1;

/// The number of poles outside the unit circle with one plant; `None` if it cannot be determined.
/// The panels are those of a proof that neither function is zero.
pub(super) fn poles_outside<S: Decimal>(
    around: &Loop<S>,
    controller_poles: usize,
    count: &PoleCount,
    pi_over_t: S,
) -> Option<usize> {
    let (denominator, zeros) = around.denominator_claimed();
    let characteristic = turn(&around.stability(), &count.characteristic, Some(pi_over_t))?;
    let within = turn(&denominator, &count.denominator, Some(pi_over_t))?;
    let whole = [&count.denominator[..], &count.beyond[..]].concat();
    let all = turn(&denominator, &whole, None)?;
    let degree = denominator.of_s().next()?.degree()?;
    // a root on the left turns it by a quarter turn forwards, one on the right backwards
    let to_right = whole_number(0.5 * (degree as f64 - all / FRAC_PI_2))?;
    let turned = (characteristic - within - zeros as f64 * FRAC_PI_2) / PI;
    let outside = (controller_poles + to_right) as f64 - turned;
    whole_number(outside)
}

fn whole_number(value: f64) -> Option<usize> {
    ((value - value.round()).abs() < WHOLE && value > -0.5).then_some(value.round() as usize)
}

/// The angle by which U turns over panels, rad: up to a frequency slightly below the end of the
/// last, or to infinity.
fn turn<S: Decimal>(claimed: &Claimed<S>, panels: &[FrequencyPanel], to: Option<S>) -> Option<f64> {
    let directions: Vec<Complex64> = panels.iter().flat_map(directions).collect();
    let (first, last) = (directions.first()?, directions.last()?);
    let begin = claimed.value_of_u(S::from(0.0))?;
    let end = match to {
        // at the end of the last panel, with little turn in between
        Some(frequency) => claimed.value_of_u(frequency.up_to(S::decimal(panels.last()?.to)))?,
        None => claimed.direction_at_infinity()?,
    };
    let inner: f64 = directions.windows(2).map(|pair| between(pair[0], pair[1])).sum();
    Some(between(clear(begin)?, *first) + inner + between(*last, clear(end)?))
}

/// The angle from one direction to another, rad.
fn between(one: Complex64, other: Complex64) -> f64 {
    portable::argument(other * one.conj())
}

/// The direction of a value, if it is known accurately enough.
fn clear<S: Decimal>([re, im]: Complex<S>) -> Option<Complex64> {
    let value = Complex64::new(re.middle(), im.middle());
    let beside = 0.5 * (re.most() - re.least()).max(im.most() - im.least());
    (beside <= CLEAR * portable::magnitude(value) && value != Complex64::ZERO).then_some(value)
}

/// Directions of the leaves of a panel in the order of the frequency; for a well-formed tree.
fn directions(panel: &FrequencyPanel) -> Vec<Complex64> {
    let mut out = vec![];
    let mut bytes = panel.tree.iter().copied();
    while let Some(byte) = bytes.next() {
        if byte == LEAF {
            let mut number = || Some(f64::from(i16::from_be_bytes([bytes.next()?, bytes.next()?])));
            let Some((re, im)) = number().zip(number()) else { break };
            out.push(Complex64::new(re, im));
        }
    }
    // towards infinity the variable is the inverse of the frequency
    if panel.to.is_infinite() {
        out.reverse();
    }
    out
}
