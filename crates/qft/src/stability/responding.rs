//! Stability of a plant without polynomials within its loop.

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::portable::{log10, magnitude};
use phea_dynamics::uncertain_plant::responding::RespondingPlant;

use super::enclosed::EnclosedLoop;
use super::measured::{MeasuredLoop, OpenLoop};
use super::{Irresolution, MemberStability, StabilityStatus};
use crate::closed_loop::{Compensation, Member};
use crate::family::{COARSE, tabulated};

/// Points per decade of a first evaluation, which does not count poles.
const POINTS_PER_DECADE: f64 = 30.0;
/// Gain |L| reached by integrators at the start of an evaluation, and number of decades searched
/// below the range of the plant.
const LARGE_GAIN: f64 = 2.0;
const DECADES_BELOW: i32 = 9;

/// Method of counting closed-loop poles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PoleCounting {
    /// Enclosure of 1 + L between successive frequencies; points in a sampled loop.
    Enclosed,
    /// Points between which 1 + L turns little, for a box that is searched for the least |1 + L|
    /// anyway.
    OnPoints,
}

pub(super) fn stability(
    member: &Member,
    compensation: &Compensation,
    count: PoleCounting,
) -> MemberStability {
    let Member::Responding { plant, sensor, delay_s, sample_time_s, .. } = member else {
        return MemberStability::not_resolved(Irresolution::Points);
    };
    let points = || on_points(member, plant.as_ref(), compensation, MeasuredLoop::Output);
    let fed_back = own_poles(member, compensation);
    let counted = match (sample_time_s, count) {
        (None, PoleCounting::Enclosed) if fed_back.is_none() => {
            let enclosed = EnclosedLoop { plant: plant.as_ref(), sensor, delay_s: *delay_s, compensation };
            enclosed.unstable_poles()
        }
        _ => {
            let own = fed_back.unwrap_or_else(|| plant.unstable_poles().ok_or(Irresolution::OpenLoopPoles));
            own.and_then(|own| points().unstable_closed_loop_poles(own, sensor))
        }
    };
    match counted {
        Ok(0) => points().stability(0),
        Ok(unstable) => MemberStability {
            status: StabilityStatus::Unstable(super::Instability::Poles { count: unstable }),
            largest_real_part: None,
            closest_approach: None,
            critical_delay: None,
        },
        Err(reason) => MemberStability::not_resolved(reason),
    }
}

/// Number of unstable poles of a plant with internal feedback of a rate or inner signal, as the
/// controller sees it; `None` if nothing is fed back. H_p has no poles there.
pub(crate) fn own_poles(member: &Member, compensation: &Compensation) -> Option<Result<usize, Irresolution>> {
    let Member::Responding { plant, rate_feed_forward, inner_feedback, .. } = member else { return None };
    let [_, highest] = plant.range_rad_per_s();
    let moved = *rate_feed_forward != 0.0 && plant.rate(highest)[0] != Complex64::ZERO;
    if !moved && inner_feedback.is_none() {
        return None;
    }
    let own = plant.unstable_poles().ok_or(Irresolution::OpenLoopPoles);
    Some(own.and_then(|own| {
        on_points(member, plant.as_ref(), compensation, MeasuredLoop::Rate).unstable_poles(own)
    }))
}

fn on_points<'a>(
    member: &'a Member,
    plant: &dyn RespondingPlant,
    compensation: &'a Compensation,
    around: MeasuredLoop,
) -> OpenLoop<'a> {
    let range = range(member, plant, compensation);
    let table = tabulated(plant, range, COARSE);
    OpenLoop::new(member, compensation, around, &table.frequencies_rad_per_s, true)
}

/// Open loop L on an even grid: cheap enough for a search to evaluate at every plant.
pub(super) fn first_sample<'a>(member: &'a Member, compensation: &'a Compensation) -> Option<OpenLoop<'a>> {
    let Member::Responding { plant, .. } = member else { return None };
    let [from, to] = range(member, plant.as_ref(), compensation);
    let decades = log10(to / from);
    let count = (POINTS_PER_DECADE * decades).ceil() as usize;
    let grid = logarithmic_grid(from, to, count).ok()?;
    Some(OpenLoop::new(member, compensation, MeasuredLoop::Output, &grid, true))
}

/// Frequencies of interest of the loop, rad/s: an integrator slower than the plant has its
/// crossover below the range of the plant.
fn range(member: &Member, plant: &dyn RespondingPlant, compensation: &Compensation) -> [f64; 2] {
    let [mut from, to] = plant.range_rad_per_s();
    let integrates =
        compensation.feedback().poles().iter().any(|pole| compensation.is_at_zero_frequency(*pole));
    for _ in 0..DECADES_BELOW {
        let gain = member.response(from).map_or(f64::INFINITY, |response| {
            let open_loop = response.plant * response.sensor * compensation.feedback().at_frequency(from);
            magnitude(open_loop)
        });
        if !integrates || gain > LARGE_GAIN {
            break;
        }
        from /= 10.0;
    }
    [from, to.min(compensation.highest_frequency_rad_per_s())]
}
