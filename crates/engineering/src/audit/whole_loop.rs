//! Delay that the force loop and the paths within it tolerate together: one computer closes all of
//! them, and its delay acts on each.
//!
//! ```text
//! 1 + L_t e^(-s tau) = 0,    1 + L_t = P_0/P (1 + L),    P_0/P = 1 + H_p P_p - H_v P_v
//! ```
//!
//! L_t is the whole loop, cut at the command; P the plant with the pressure feedback H_p and the
//! velocity feedforward H_v in it, which is that of L, and P_0 the plant without. The force loop
//! tolerates more if it is cut there, since pressures and velocity then act without delay.

use num_complex::Complex64;

use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::order::sort_by_number;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::Family;
use phea_qft::stability::{CriticalDelay, DelayMargin, StabilityStatus, borne_delay, member_stability};
use phea_qft::verification::{Audit, PlantPoint};

use super::margins::response::{filled, phase_margins};
use super::margins::{corners, nominal_point, spread, worst_of};
use crate::robust::RobustProblem;
use crate::side_by_side::of_each;

/// Largest number of members and corners that are examined, and of plants whose delay is found by
/// sampling them anew.
const MEMBERS: usize = 150;
const CORNERS: usize = 64;
const RANKED: usize = 4;
/// Number of points of the grid, and its range below its end.
const GRID_POINTS: usize = 400;
const DECADES: f64 = 1e-4;
/// End of the grid of a continuous loop, rad/s.
const END_OF_CONTINUOUS: f64 = 2e4;
/// Fraction of that end at which a path within the loop is tested for its effect on the plant.
const TOUCH: f64 = 0.1;

/// Paths within the force loop that are delayed with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DelayedPaths {
    /// True if the feedback of the chambers' pressures is delayed.
    pub pressure_feedback: bool,
    /// True if the feedforward of the velocity of a load that the force moves is delayed.
    pub velocity_feed_forward: bool,
}

impl DelayedPaths {
    /// Delayed paths of a problem; none if the velocity of the load does not depend on the force,
    /// and nothing else is fed back.
    pub(super) fn of(problem: &RobustProblem) -> DelayedPaths {
        let RobustProblem { before_feedback, compensation, .. } = problem;
        let nominal = WholeLoop::of(problem, compensation, &nominal_point(problem));
        let closes = nominal.is_some();
        let pressure_feedback =
            closes && (before_feedback.is_some() || compensation.inner_feedback().is_some());
        let velocity_feed_forward = closes && compensation.rate_feed_forward() != 0.0;
        DelayedPaths { pressure_feedback, velocity_feed_forward }
    }

    /// True if there is a path.
    pub fn are_some(self) -> bool {
        self.pressure_feedback || self.velocity_feed_forward
    }
}

/// Least delay that makes a plant of the family unstable, s; `None` without such a path, and if no
/// response is known.
pub(super) fn least_delay(problem: &RobustProblem, audit: &Audit) -> Option<DelayMargin> {
    audit.delay_margin.as_ref()?;
    let Family::Uncertain(family) = &problem.family else { return None };
    let corners = corners(family);
    let plants = spread(family.members(), MEMBERS).chain(spread(&corners, CORNERS));
    let plants = plants.map(PlantPoint::Parameters).chain(worst_of(audit));
    let plants: Vec<PlantPoint> = plants.collect();
    let estimated = of_each(&plants, |plant| {
        Some(WholeLoop::of(problem, &problem.compensation, plant)?.critical_delay()?.delay_s)
    });
    let ranked = estimated.into_iter().zip(&plants).filter_map(|(delay_s, plant)| Some((delay_s?, plant)));
    let mut ranked: Vec<(f64, &PlantPoint)> = ranked.collect();
    sort_by_number(&mut ranked, |one| one.0);
    ranked.truncate(RANKED);
    let nearest = of_each(&ranked, |(_, plant)| delay_margin(problem, plant)).into_iter().flatten();
    nearest.min_by(|one, other| one.delay_s.total_cmp(&other.delay_s))
}

/// Least delay that makes this plant unstable, s; the plant must be stable without it. A sampled
/// loop is sampled anew with each delay: between whole samples a delay also changes |L_t|.
pub(super) fn delay_margin(problem: &RobustProblem, plant: &PlantPoint) -> Option<DelayMargin> {
    let whole = WholeLoop::of(problem, &problem.compensation, plant)?;
    let remaining = |delay_s: f64| {
        let delayed = problem.compensation.with_delay(problem.compensation.delay_s() + delay_s);
        let whole = WholeLoop::of(problem, &delayed, plant)?;
        let is_stable = member_stability(&whole.with, &delayed).status == StabilityStatus::Stable;
        whole.critical_delay().filter(|_| is_stable)
    };
    let found = match problem.compensation.sample_time_s() {
        Some(_) => borne_delay(&remaining)?,
        None => whole.critical_delay()?,
    };
    let CriticalDelay { delay_s, frequency_rad_per_s } = found;
    Some(DelayMargin { delay_s, frequency_rad_per_s, plant: plant.clone() })
}

/// A plant in its loop, and the plant without the paths within the loop.
struct WholeLoop<'c> {
    compensation: &'c Compensation,
    with: Member,
    without: Member,
}

impl<'c> WholeLoop<'c> {
    /// `None` if no path within the loop changes the plant.
    fn of(
        problem: &RobustProblem,
        compensation: &'c Compensation,
        plant: &PlantPoint,
    ) -> Option<WholeLoop<'c>> {
        let (PlantPoint::Parameters(values), Family::Uncertain(family)) = (plant, &problem.family) else {
            return None;
        };
        let before = match &problem.before_feedback {
            Some(Family::Uncertain(before)) => before,
            _ if compensation.inner_feedback().is_some() || compensation.rate_feed_forward() != 0.0 => family,
            _ => return None,
        };
        let without = compensation.without_inner_paths().member_of(before.plant(), values).ok()?;
        let with = compensation.member_of(family.plant(), values).ok()?;
        let whole = WholeLoop { compensation, with, without };
        (!whole.is_force_loop()).then_some(whole)
    }

    /// True if the paths within the loop do not change the plant.
    fn is_force_loop(&self) -> bool {
        let at = TOUCH * self.highest();
        self.with.response(at).map(|seen| seen.plant) == self.without.response(at).map(|seen| seen.plant)
    }

    fn highest(&self) -> f64 {
        self.compensation.highest_frequency_rad_per_s().min(END_OF_CONTINUOUS)
    }

    /// Response of L_t.
    fn at(&self, frequency_rad_per_s: f64) -> Option<Complex64> {
        let [with, without] =
            [self.with.response(frequency_rad_per_s)?, self.without.response(frequency_rad_per_s)?];
        let open_loop = with.plant * with.sensor * self.compensation.response(frequency_rad_per_s).feedback;
        let whole = without.plant / with.plant * (1.0 + open_loop) - 1.0;
        whole.is_finite().then_some(whole)
    }

    /// Least phase over frequency at which |L_t| passes 1.
    fn critical_delay(&self) -> Option<CriticalDelay> {
        let highest = self.highest();
        let frequencies = logarithmic_grid(DECADES * highest, highest, GRID_POINTS).ok()?;
        let at = |frequency: f64| Some((frequency, self.at(frequency)?));
        let crossings = phase_margins(&filled(frequencies.into_iter(), &at), &at).into_iter();
        let least = crossings.min_by(|one, other| one.delay_s.total_cmp(&other.delay_s));
        Some(CriticalDelay {
            delay_s: least.as_ref().map_or(f64::INFINITY, |margin| margin.delay_s),
            frequency_rad_per_s: least.map_or(f64::INFINITY, |margin| margin.frequency_rad_per_s),
        })
    }
}
