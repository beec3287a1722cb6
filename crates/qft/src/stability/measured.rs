//! Nyquist count on the points of a response, and other results from these points.
//!
//! ```text
//! Z = P - (1/pi) (change of arg(1 + L), w = 0 .. infinity)        P: open-loop poles in the right half plane, stated with the measurement
//! ```
//!
//! Nothing is assumed beyond the points: neither turns between two of them, nor the loop below the
//! first or above the last. If a disc is given around each point, the count holds for every
//! response within the discs.

mod low_end;

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::minimum;
use phea_dynamics::portable;

use super::{Approach, CriticalDelay, Instability, Irresolution, MemberStability, StabilityStatus};
use crate::closed_loop::{Compensation, Member};
use crate::family::MeasuredPlant;
use low_end::{LowEnd, opening};

/// Largest turn between two points, rad.
const TURN_MAXIMUM: f64 = std::f64::consts::FRAC_PI_3;
/// Tangent of [`TURN_MAXIMUM`].
const SQRT_3: f64 = 1.732_050_807_568_877_2;
/// Least distance of points of a resolved response, as a fraction of their frequency.
const CLOSEST: f64 = 1e-9;
/// Gain |L| that counts as well below one.
const SMALL_GAIN: f64 = 0.5;
/// Gain |L| that counts as well above one.
const LARGE_GAIN: f64 = 2.0;
/// Relative accuracy of the frequency of the least |1 + L|.
const POLISHED: f64 = 1e-7;

/// Open loop L, or P H, at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LoopPoint {
    /// Frequency, rad/s.
    frequency: f64,
    value: Complex64,
    /// Radius of the disc around it that contains the true response; zero if it is exact.
    radius: f64,
}

/// Open loop L at these frequencies, up to half the sampling rate.
pub(super) struct OpenLoop<'a> {
    member: &'a Member,
    compensation: &'a Compensation,
    around: MeasuredLoop,
    points: Vec<LoopPoint>,
    /// True if the response is also known between the points.
    is_known_between: bool,
}

/// Choice of the loop L.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MeasuredLoop {
    /// Loop G P H of the controller.
    Output,
    /// Loop -K P_v of a rate that is fed forward and moved by the command: its poles are those of
    /// the plant that the controller sees.
    Rate,
}

pub(super) fn stability(member: &Member, compensation: &Compensation) -> MemberStability {
    let Member::Measured { plant, sensor, .. } = member else {
        return MemberStability::not_resolved(Irresolution::Points);
    };
    let frequencies = &plant.frequencies_rad_per_s;
    let open_loop = OpenLoop::new(member, compensation, MeasuredLoop::Output, frequencies, plant.is_resolved);
    match open_loop.unstable_closed_loop_poles(plant.unstable_poles, sensor) {
        Ok(unstable) => open_loop.stability(unstable),
        Err(reason) => MemberStability::not_resolved(reason),
    }
}

/// Response P H of a measured plant at its points up to half the sampling rate: it is independent
/// of the controller. Empty for other plants.
pub(crate) fn points_with_sensor(member: &Member, compensation: &Compensation) -> Vec<LoopPoint> {
    let Member::Measured { plant, .. } = member else { return vec![] };
    let highest = compensation.highest_frequency_rad_per_s();
    let frequencies = plant.frequencies_rad_per_s.iter().take_while(|&&frequency| frequency <= highest);
    frequencies.filter_map(|&frequency| point_with_sensor(member, frequency)).collect()
}

/// Response P H; `None` if it is unknown.
fn point_with_sensor(member: &Member, frequency: f64) -> Option<LoopPoint> {
    let response = member.response(frequency)?;
    let radius = member.radius(frequency, &response) * portable::magnitude(response.sensor);
    Some(LoopPoint { frequency, value: response.plant * response.sensor, radius })
}

/// True if a measured plant is stable within its loop, given its [`points_with_sensor`]: the status
/// of [`super::member_stability`] without the other results.
pub(crate) fn is_stable(member: &Member, with_sensor: &[LoopPoint], compensation: &Compensation) -> bool {
    let Member::Measured { plant, sensor, .. } = member else { return false };
    let feedback = compensation.feedback();
    let points = with_sensor.iter().map(|point| point.times(feedback.at_frequency(point.frequency)));
    let mut open_loop = OpenLoop {
        member,
        compensation,
        around: MeasuredLoop::Output,
        points: Vec::new(),
        is_known_between: plant.is_resolved,
    };
    open_loop.extend(points);
    open_loop.unstable_closed_loop_poles(plant.unstable_poles, sensor) == Ok(0)
}

impl<'a> OpenLoop<'a> {
    /// Open loop L at these frequencies, rad/s; if the response is known between them, with as many
    /// additional ones as needed for 1 + L to turn little between neighbours.
    pub(super) fn new(
        member: &'a Member,
        compensation: &'a Compensation,
        around: MeasuredLoop,
        frequencies_rad_per_s: &[f64],
        is_known_between: bool,
    ) -> OpenLoop<'a> {
        let highest = compensation.highest_frequency_rad_per_s();
        let frequencies = frequencies_rad_per_s.iter().take_while(|&&frequency| frequency <= highest);
        let mut open_loop = OpenLoop { member, compensation, around, points: Vec::new(), is_known_between };
        let points: Vec<LoopPoint> = frequencies.filter_map(|&one| open_loop.at(one)).collect();
        open_loop.extend(points.into_iter());
        open_loop
    }

    /// Adds these points, with as many between them as 1 + L needs if the response is known there.
    fn extend(&mut self, points: impl Iterator<Item = LoopPoint>) {
        for point in points {
            if self.is_known_between {
                self.fill_up_to(point);
            }
            self.points.push(point);
        }
    }

    /// Stability results for a loop with this number of unstable poles.
    pub(super) fn stability(&self, unstable: usize) -> MemberStability {
        let stable = unstable == 0;
        MemberStability {
            status: if stable {
                StabilityStatus::Stable
            } else {
                StabilityStatus::Unstable(Instability::Poles { count: unstable })
            },
            largest_real_part: None,
            closest_approach: stable.then(|| self.closest_approach()),
            critical_delay: stable.then(|| self.critical_delay()),
        }
    }

    /// Inserts points between the last one and this one, as many as needed for 1 + L to turn little
    /// between neighbours.
    fn fill_up_to(&mut self, end: LoopPoint) {
        let mut ahead = vec![end];
        while let (Some(&next), Some(&last)) = (ahead.last(), self.points.last()) {
            let close = next.frequency - last.frequency <= CLOSEST * next.frequency;
            let near = close || turns_little(last.value, next.value);
            let middle = (last.frequency * next.frequency).sqrt();
            match Some(middle).filter(|_| !near).and_then(|middle| self.at(middle)) {
                Some(point) => ahead.push(point),
                None => {
                    ahead.pop();
                    if !ahead.is_empty() {
                        self.points.push(next);
                    }
                }
            }
        }
    }

    /// Open loop L at any frequency; `None` if it is unknown.
    fn at(&self, frequency: f64) -> Option<LoopPoint> {
        if self.around == MeasuredLoop::Rate {
            let back = self.member.fed_back(frequency)?;
            return Some(LoopPoint { frequency, value: -back, radius: 0.0 });
        }
        let feedback = self.compensation.feedback().at_frequency(frequency);
        point_with_sensor(self.member, frequency).map(|point| point.times(feedback))
    }

    /// Number of poles less zeros of L at the origin, if stated for the plant.
    fn integrators(&self) -> Option<f64> {
        let Member::Measured { plant: MeasuredPlant { integrators, .. }, sensor, .. } = self.member else {
            return None;
        };
        let at_origin = |function: &TransferFunction| {
            let origin = zero_frequency(function);
            let count = |roots: &[Complex64]| roots.iter().filter(|root| **root == origin).count() as f64;
            count(function.poles()) - count(function.zeros())
        };
        Some(
            integrators.as_ref().map(|own| *own as f64)?
                + at_origin(sensor)
                + at_origin(self.compensation.feedback()),
        )
    }

    /// Number of poles of the closed loop outside the stable region, given the number for the
    /// plant.
    pub(super) fn unstable_closed_loop_poles(
        &self,
        of_plant: usize,
        sensor: &TransferFunction,
    ) -> Result<usize, Irresolution> {
        let own = outside_of_stable_region(self.compensation.feedback())?
            + outside_of_stable_region(sensor)?
            + of_plant;
        self.unstable_poles(own)
    }

    /// Number of zeros of 1 + L outside the stable region, given the number of poles of L there.
    pub(super) fn unstable_poles(&self, own: usize) -> Result<usize, Irresolution> {
        let &[first, _, ..] = self.points.as_slice() else { return Err(Irresolution::Points) };
        let low =
            LowEnd { points: &self.points, integrators: self.integrators(), is_known: self.is_known_between };
        let turned_below = low.turn()?;
        let mut rounds = 0.0;
        for pair in self.points.windows(2) {
            let &[from, to] = pair else { continue };
            followed(from, to)?;
            rounds += rounds_begun(1.0 + from.value, 1.0 + to.value);
        }
        let last = self.points.last().ok_or(Irresolution::Points)?;
        let gain = portable::magnitude(last.value) + last.radius;
        if gain.is_nan() || gain > SMALL_GAIN {
            return Err(Irresolution::HighEnd { frequency_rad_per_s: last.frequency, gain });
        }
        // from the first point to the last, 1 + L turns by 2 pi rounds and the difference of the
        // angles there, then from the last back to zero
        let turned =
            turned_below - portable::argument(1.0 + first.value) + 2.0 * std::f64::consts::PI * rounds;
        let count = own as f64 - turned / std::f64::consts::PI;
        if (count - count.round()).abs() > 1e-6 || count.round() < 0.0 {
            return Err(Irresolution::Count { count });
        }
        Ok(count.round() as usize)
    }

    /// The least |1 + L|: over the points, refined around the least of them if the response is
    /// known; the least within their discs.
    pub(super) fn closest_approach(&self) -> Approach {
        let order =
            |one: &&[LoopPoint], other: &&[LoopPoint]| one[1].distance().total_cmp(&other[1].distance());
        let none = Approach { distance: f64::INFINITY, frequency_rad_per_s: f64::INFINITY };
        let least = self.points.iter().fold(none, |nearest, next| match next.distance() {
            distance if distance < nearest.distance => {
                Approach { distance, frequency_rad_per_s: next.frequency }
            }
            _ => nearest,
        });
        let Some(&[before, nearest, after]) =
            self.points.windows(3).min_by(order).and_then(|points| points.first_chunk())
        else {
            return least;
        };
        if nearest.frequency != least.frequency_rad_per_s {
            return least;
        }
        let at = |frequency: f64| self.at(frequency).map_or(f64::INFINITY, |point| point.distance());
        let start = (nearest.frequency, least.distance);
        let ends = [before.frequency, after.frequency];
        let (frequency_rad_per_s, found) = minimum::between(at, ends, start, POLISHED * nearest.frequency);
        if found < least.distance { Approach { distance: found, frequency_rad_per_s } } else { least }
    }

    /// Critical delay at the crossovers: where the line between two points crosses one, and where a
    /// disc touches the unit circle.
    pub(super) fn critical_delay(&self) -> CriticalDelay {
        let mut least = CriticalDelay::NONE;
        let mut take = |point: &LoopPoint| {
            if let Some(delay_s) = point.critical_delay().filter(|delay_s| *delay_s < least.delay_s) {
                least = CriticalDelay { delay_s, frequency_rad_per_s: point.frequency };
            }
        };
        self.points.iter().filter(|point| point.radius > 0.0).for_each(&mut take);
        for pair in self.points.windows(2) {
            if let &[before, after] = pair
                && before.is_above_one() != after.is_above_one()
                && let Some(crossing) = self.crossing(before, after)
            {
                take(&crossing);
            }
        }
        least
    }

    /// Point where |L| passes one between two points.
    fn crossing(&self, before: LoopPoint, after: LoopPoint) -> Option<LoopPoint> {
        let (mut low, mut high) = (before.frequency, after.frequency);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.at(middle).is_some_and(|point| point.is_above_one() == before.is_above_one()) {
                low = middle;
            } else {
                high = middle;
            }
        }
        let crossing = self.at(high)?;
        Some(LoopPoint { value: crossing.value / portable::magnitude(crossing.value), ..crossing })
    }
}

impl LoopPoint {
    fn times(self, factor: Complex64) -> LoopPoint {
        LoopPoint {
            value: self.value * factor,
            radius: if self.radius == 0.0 { 0.0 } else { self.radius * portable::magnitude(factor) },
            ..self
        }
    }

    /// The least |1 + L| within the disc.
    fn distance(&self) -> f64 {
        (portable::magnitude(1.0 + self.value) - self.radius).max(0.0)
    }

    fn is_above_one(&self) -> bool {
        portable::magnitude(self.value) >= 1.0
    }

    /// The least delay that rotates a point of the disc with |L| = 1 to -1, s; `None` if there is
    /// no such point.
    ///
    /// ```text
    /// cos(opening) = (1 + |L|^2 - r^2)/(2 |L|)
    /// ```
    fn critical_delay(&self) -> Option<f64> {
        let size = portable::magnitude(self.value);
        let cosine = (1.0 + size * size - self.radius * self.radius) / (2.0 * size);
        // except for rounding of a crossover, whose disc is a point
        let opening = if self.radius == 0.0 {
            0.0
        } else {
            portable::acos(Some(cosine).filter(|one| one.abs() <= 1.0)?)
        };
        let lag = portable::argument(-self.value);
        let lag = if lag < 0.0 { lag + 2.0 * std::f64::consts::PI } else { lag };
        Some((lag - opening).max(0.0) / self.frequency)
    }
}

/// Checks that 1 + L can be followed from one point to the next, anywhere in their discs.
fn followed(from: LoopPoint, to: LoopPoint) -> Result<(), Irresolution> {
    let open = [from, to].map(|point| opening(1.0 + point.value, point.radius));
    let turn_rad = turn(from.value, to.value);
    if !turns_little(from.value, to.value) {
        return Err(Irresolution::Coarse {
            from_rad_per_s: from.frequency,
            to_rad_per_s: to.frequency,
            turn_deg: turn_rad.to_degrees(),
        });
    }
    if open[0] + open[1] + turn_rad.min(TURN_MAXIMUM) < std::f64::consts::PI {
        return Ok(());
    }
    let wider = if open[1] > open[0] { to } else { from };
    Err(Irresolution::Confidence {
        frequency_rad_per_s: wider.frequency,
        distance: portable::magnitude(1.0 + wider.value),
        radius: wider.radius,
    })
}

/// The point of the stability boundary at zero frequency: s = 0, or z = 1.
fn zero_frequency(function: &TransferFunction) -> Complex64 {
    Complex64::new(if function.domain() == TimeDomain::Continuous { 0.0 } else { 1.0 }, 0.0)
}

/// True if [`turn`] is at most [`TURN_MAXIMUM`], using only products.
fn turns_little(before: Complex64, after: Complex64) -> bool {
    let is_small = |value: Complex64| value.norm_sqr() <= SMALL_GAIN * SMALL_GAIN;
    is_turned_little(1.0 + before, 1.0 + after)
        && (is_small(before) && is_small(after) || is_turned_little(before, after))
}

/// True if the angle between two numbers is at most [`TURN_MAXIMUM`]; false if one of them is zero
/// or NaN.
///
/// ```text
/// |arg(b/a)| <= pi/3          where |Im(b a*)| <= sqrt(3) Re(b a*)
/// ```
fn is_turned_little(before: Complex64, after: Complex64) -> bool {
    let product = after * before.conj();
    product.re > 0.0 && product.im.abs() <= SQRT_3 * product.re && product.is_finite()
}

/// Change of the number of rounds: 1 if the argument of a number that turns by less than a right
/// angle passes pi, -1 if it passes back.
fn rounds_begun(before: Complex64, after: Complex64) -> f64 {
    match (before.im.is_sign_negative(), after.im.is_sign_negative()) {
        (false, true) if after.re < 0.0 => 1.0,
        (true, false) if after.re < 0.0 => -1.0,
        _ => 0.0,
    }
}

/// Angle by which 1 + L, or L itself if it is not small, turns from one point to the next,
/// whichever is larger, rad.
fn turn(before: Complex64, after: Complex64) -> f64 {
    let own = portable::argument((1.0 + after) / (1.0 + before)).abs();
    if portable::magnitude(before).max(portable::magnitude(after)) > SMALL_GAIN {
        own.max(portable::argument(after / before).abs())
    } else {
        own
    }
}

/// Number of poles outside the stable region; those at zero frequency are visible in the measured
/// loop.
pub(super) fn outside_of_stable_region(function: &TransferFunction) -> Result<usize, Irresolution> {
    let continuous = function.domain() == TimeDomain::Continuous;
    let excess = |pole: &Complex64| if continuous { pole.re } else { portable::magnitude(*pole) - 1.0 };
    let at_zero_frequency = zero_frequency(function);
    let poles = || function.poles().iter().filter(|pole| **pole != at_zero_frequency);
    if poles().any(|pole| excess(pole) == 0.0) {
        return Err(Irresolution::UndampedController);
    }
    Ok(poles().filter(|pole| excess(pole) > 0.0).count())
}
