//! Closed loop around a plant that is known by its response, for computing step responses.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_qft::closed_loop::{Compensation, Member, MemberResponse};
use phea_qft::family::{FINE, tabulated};

use super::StepSignal;

/// Permitted deviation of the closed loop's response from the line between two points, as a
/// fraction of the step.
const STRAIGHT: f64 = 1e-3;
/// Least distance of two points, relative to their frequency.
const CLOSEST: f64 = 1e-6;
/// Number of points of the grid of a change before refinement.
const POINTS_OF_CHANGE: usize = 200;
/// Number of times that the lowest frequency of the plant is halved: the loop may be slower than
/// the plant, and the response below the first point is taken as constant.
const HALVINGS: u32 = 20;

/// Known responses of a plant, so that other controllers do not compute them again: its
/// frequencies, rad/s, and its response by the bits of a frequency.
#[derive(Debug, Default)]
pub(crate) struct KnownResponses {
    own: Mutex<Vec<f64>>,
    by_frequency: Mutex<HashMap<u64, Option<MemberResponse>>>,
}

impl KnownResponses {
    fn frequencies(&self, plant: &dyn RespondingPlant, range: [f64; 2]) -> Vec<f64> {
        let mut own = self.own.lock().unwrap_or_else(PoisonError::into_inner);
        if own.is_empty() {
            *own = tabulated(plant, range, FINE).frequencies_rad_per_s;
        }
        own.clone()
    }

    fn response(&self, member: &Member, frequency: f64) -> Option<MemberResponse> {
        let mut known = self.by_frequency.lock().unwrap_or_else(PoisonError::into_inner);
        *known.entry(frequency.to_bits()).or_insert_with(|| member.response(frequency))
    }
}

/// Real parts of the response of a closed loop, as fractions of a scale and without the
/// instantaneous part.
pub(super) struct ClosedParts {
    /// Frequencies, rad/s, with the real part there, linear between them.
    pub(super) parts: Vec<(f64, f64)>,
    /// Scale of the parts.
    pub(super) scale: f64,
    /// Response of a continuous loop at infinite frequency.
    pub(super) at_once: f64,
}

/// Frequencies, rad/s, with the real part of F P G/(1 + L), or of F G/(1 + L), linear between them:
/// the argument of
/// [`step_of_frequency_response`](phea_dynamics::time_response::step_of_frequency_response).
///
/// # Errors
/// [`LinearError`] if the prefilter cannot be sampled.
pub(super) fn real_parts(
    plant: &Arc<dyn RespondingPlant>,
    signal: StepSignal,
    compensation: &Compensation,
    known: &KnownResponses,
) -> Result<ClosedParts, LinearError> {
    let member = compensation.responding(plant.clone());
    let highest = compensation.highest_frequency_rad_per_s();
    let [from, to] = plant.range_rad_per_s();
    let own = known.frequencies(plant.as_ref(), [from, to.min(highest)]);
    let lowest = own.first().copied().unwrap_or(highest);
    let below = (1..=HALVINGS).rev().map(|halvings| lowest / f64::from(1_u32 << halvings));
    let grid: Vec<f64> = below.chain(own).collect();
    let prefilter = compensation.prefilter_of_step()?;
    let is_continuous = compensation.sample_time_s().is_none();
    let at_once = match signal {
        StepSignal::Command if is_continuous => {
            at_infinity(&prefilter) * at_infinity(compensation.feedback())
        }
        StepSignal::Command | StepSignal::Output => 0.0,
    };
    let closed = |frequency: f64| {
        let plant = known.response(&member, frequency)?;
        Some(closed(plant, signal, compensation, &prefilter, frequency) - at_once)
    };
    let scale = match signal {
        StepSignal::Output => 1.0,
        StepSignal::Command => {
            let sizes = grid.iter().filter_map(|frequency| closed(*frequency)).map(portable::magnitude);
            sizes.fold(f64::MIN_POSITIVE, f64::max)
        }
    };
    let parts = straight(&grid, highest, |frequency| closed(frequency).map(|value| value / scale));
    Ok(ClosedParts { parts, scale, at_once })
}

/// Response of a continuous system at infinite frequency.
fn at_infinity(system: &TransferFunction) -> f64 {
    if system.zeros().len() < system.poles().len() { 0.0 } else { system.gain() }
}

/// Frequencies, rad/s, with the real part of (1 + L)/(1 + L') - 1, linear between them: relative
/// increase of the response to a disturbance of the loop if another controller replaces L by L'.
pub(super) fn parts_of_change(
    member: &Member,
    [before, after]: [&Compensation; 2],
    range: [f64; 2],
    known: &KnownResponses,
) -> Vec<(f64, f64)> {
    let grid = logarithmic_grid(range[0], range[1], POINTS_OF_CHANGE).unwrap_or_default();
    let change = |frequency: f64| {
        let plant = known.response(member, frequency)?;
        let path = plant.plant * plant.sensor;
        let of = |around: &Compensation| 1.0 + path * around.feedback().at_frequency(frequency);
        Some(of(before) / of(after) - 1.0)
    };
    // the last point of the grid may be rounded up
    straight(&grid, f64::INFINITY, change)
}

/// Response F P G/(1 + L) or F G/(1 + L), with F as a step passes through it.
fn closed(
    plant: MemberResponse,
    signal: StepSignal,
    compensation: &Compensation,
    prefilter: &TransferFunction,
    frequency: f64,
) -> Complex64 {
    let feedback = compensation.feedback().at_frequency(frequency);
    let command =
        prefilter.at_frequency(frequency) * feedback / (1.0 + plant.plant * feedback * plant.sensor);
    match signal {
        StepSignal::Output => command * plant.plant,
        StepSignal::Command => command,
    }
}

/// Real part at these frequencies, and between them until it is linear there.
fn straight(grid: &[f64], highest: f64, response: impl Fn(f64) -> Option<Complex64>) -> Vec<(f64, f64)> {
    let at = |frequency: f64| response(frequency).map(|value| (frequency, value.re));
    let within = grid.iter().rev().filter(|frequency| **frequency <= highest);
    let mut left: Vec<(f64, f64)> = within.filter_map(|frequency| at(*frequency)).collect();
    let mut found: Vec<(f64, f64)> = left.pop().into_iter().collect();
    while let (Some(&next), Some(&last)) = (left.last(), found.last()) {
        let close = next.0 - last.0 <= CLOSEST * next.0;
        let middle = at(0.5 * (last.0 + next.0)).filter(|middle| {
            let mean = 0.5 * (last.1 + next.1);
            !close && (middle.1 - mean).abs() > STRAIGHT
        });
        match middle {
            Some(middle) => left.push(middle),
            None => found.extend(left.pop()),
        }
    }
    found
}
