//! The delay that force loop and pressure feedback tolerate together: one computer closes both, and
//! what delays it delays both.
//!
//! ```text
//! 1 + L_t e^(-s tau) = 0,    1 + L_t = (1 + H_p P_p) (1 + L) = P_0/P (1 + L)
//! ```
//!
//! L_t is the whole loop, cut at the command; P the plant with the pressure feedback in it, which
//! is that of L, and P_0 the plant without. The force loop alone tolerates more: cut there, the
//! pressures are fed back as early as before.

use num_complex::Complex64;

use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::portable::{argument, magnitude};
use phea_qft::closed_loop::Member;
use phea_qft::family::Family;
use phea_qft::stability::DelayMargin;
use phea_qft::verification::{Audit, PlantPoint};

use super::margins::plants_of_margins;
use crate::robust::RobustProblem;

/// Most plants that are examined.
const PLANTS: usize = 256;
/// Points of the grid, and how far it reaches below its end.
const GRID_POINTS: usize = 2000;
const DECADES: f64 = 1e-4;
/// End of the grid of a continuous loop, rad/s.
const END_OF_CONTINUOUS: f64 = 2e4;
/// Halvings of an interval in which |L_t| passes 1.
const HALVINGS: usize = 40;

/// The least delay in s that makes a plant of the family unstable; `None` without a pressure
/// feedback, and where a response is not known.
pub(super) fn least_delay(problem: &RobustProblem, audit: &Audit) -> Option<DelayMargin> {
    let known = audit.delay_margin.as_ref()?;
    let plants = match plants_of_margins(problem, audit) {
        Family::Uncertain(family) => family.members().to_vec(),
        Family::Measured(_) => return None,
    };
    let step = plants.len().div_ceil(PLANTS).max(1);
    let some = plants.into_iter().step_by(step).map(PlantPoint::Parameters);
    let all = std::iter::once(known.plant.clone()).chain(some);
    let each = all.map(|plant| delay_margin(problem, &plant));
    let found = each.collect::<Option<Vec<DelayMargin>>>()?;
    found.into_iter().min_by(|one, other| one.delay_s.total_cmp(&other.delay_s))
}

/// The least delay in s that makes this plant unstable, which must be stable without it.
pub(super) fn delay_margin(problem: &RobustProblem, plant: &PlantPoint) -> Option<DelayMargin> {
    let whole = WholeLoop::of(problem, plant)?;
    let highest = problem.compensation.highest_frequency_rad_per_s().min(END_OF_CONTINUOUS);
    let mut least = DelayMargin { delay_s: f64::INFINITY, frequency_rad_per_s: 0.0, plant: plant.clone() };
    let frequencies = logarithmic_grid(DECADES * highest, highest, GRID_POINTS).ok()?;
    for (low, high) in frequencies.iter().zip(frequencies.iter().skip(1)) {
        let Some(frequency_rad_per_s) = whole.crossover(*low, *high) else { continue };
        let lag = argument(-whole.at(frequency_rad_per_s)?).rem_euclid(std::f64::consts::TAU);
        let delay_s = lag / frequency_rad_per_s;
        if delay_s < least.delay_s {
            least = DelayMargin { delay_s, frequency_rad_per_s, ..least };
        }
    }
    Some(least)
}

/// A plant in its loop, and the same without pressure feedback.
struct WholeLoop<'p> {
    problem: &'p RobustProblem,
    with: Member,
    without: Member,
}

impl<'p> WholeLoop<'p> {
    /// `None` where no pressure is fed back.
    fn of(problem: &'p RobustProblem, plant: &PlantPoint) -> Option<WholeLoop<'p>> {
        let PlantPoint::Parameters(values) = plant else { return None };
        let open = problem.compensation.without_inner_feedback();
        let without = match (&problem.before_feedback, &problem.family) {
            (Some(Family::Uncertain(family)), _) => open.member_of(family.plant(), values),
            (None, Family::Uncertain(family)) if problem.compensation.inner_feedback().is_some() => {
                open.member_of(family.plant(), values)
            }
            _ => return None,
        };
        Some(WholeLoop { problem, with: problem.member(plant)?, without: without.ok()? })
    }

    /// L_t
    fn at(&self, frequency_rad_per_s: f64) -> Option<Complex64> {
        let with = self.problem.response(&self.with, frequency_rad_per_s)?;
        let without = self.without.response(frequency_rad_per_s)?;
        let whole = without.plant / with.plant * (1.0 + with.open_loop()) - 1.0;
        whole.is_finite().then_some(whole)
    }

    /// The frequency between these at which |L_t| passes 1.
    fn crossover(&self, mut low: f64, mut high: f64) -> Option<f64> {
        let is_above = |frequency: f64| Some(magnitude(self.at(frequency)?) >= 1.0);
        let first = is_above(low)?;
        if first == is_above(high)? {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if is_above(middle)? == first { low = middle } else { high = middle }
        }
        Some(high)
    }
}
