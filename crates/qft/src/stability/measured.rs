//! Nyquist's count on the points of a response, and other results from the same points.
//!
//! ```text
//! Z = P - (1/pi) (change of arg(1 + L), w = 0 .. infinity)        P: open-loop poles in the right half plane, stated with the measurement
//! ```
//!
//! Nothing is assumed that the points do not show: turns between two of them, the loop below the
//! first, and the loop above the last.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;

use super::{Approach, CriticalDelay, Instability, Irresolution, MemberStability, StabilityStatus};
use crate::closed_loop::{Compensation, Member};
use crate::minimum::between;

/// Largest turn between two points, rad.
const TURN_MAXIMUM: f64 = std::f64::consts::FRAC_PI_3;
/// tan([`TURN_MAXIMUM`])
const SQRT_3: f64 = 1.732_050_807_568_877_2;
/// Least distance of points of a resolved response, as a share of their frequency.
const CLOSEST: f64 = 1e-9;
/// |L| that is well below one.
const SMALL_GAIN: f64 = 0.5;
/// |L| that is well above one.
const LARGE_GAIN: f64 = 2.0;
/// Relative accuracy of the frequency of the least |1 + L|.
const POLISHED: f64 = 1e-7;
/// How near to a whole number of integrators the slope of ln|L| must be at the low end.
const SLOPE_TOLERANCE: f64 = 0.3;

/// L at these frequencies, up to half the sampling rate.
pub(super) struct OpenLoop<'a> {
    member: &'a Member,
    compensation: &'a Compensation,
    around: MeasuredLoop,
    points: Vec<(f64, Complex64)>,
}

/// Which loop L is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MeasuredLoop {
    /// G P H, that of the controller.
    Output,
    /// -K P_v, the loop of a rate that is fed forward and moved by the command: its poles are those
    /// of the plant that the controller sees.
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

/// P H of a measured plant at its points up to half the sampling rate, frequencies in rad/s: it
/// does not change with the controller. Empty for other plants.
pub(crate) fn points_with_sensor(member: &Member, compensation: &Compensation) -> Vec<(f64, Complex64)> {
    let Member::Measured { plant, .. } = member else { return vec![] };
    let highest = compensation.highest_frequency_rad_per_s();
    let frequencies = plant.frequencies_rad_per_s.iter().take_while(|&&frequency| frequency <= highest);
    let at = |&frequency: &f64| {
        let response = member.response(frequency)?;
        Some((frequency, response.plant * response.sensor))
    };
    frequencies.filter_map(at).collect()
}

/// Whether a measured plant is stable within its loop, given its [`points_with_sensor`]: the status
/// of [`super::member_stability`] without the other results.
pub(crate) fn is_stable(
    member: &Member,
    with_sensor: &[(f64, Complex64)],
    compensation: &Compensation,
) -> bool {
    let Member::Measured { plant, sensor, .. } = member else { return false };
    let feedback = compensation.feedback();
    let points =
        with_sensor.iter().map(|&(frequency, path)| (frequency, path * feedback.at_frequency(frequency)));
    let mut open_loop = OpenLoop { member, compensation, around: MeasuredLoop::Output, points: Vec::new() };
    open_loop.extend(points, plant.is_resolved);
    open_loop.unstable_closed_loop_poles(plant.unstable_poles, sensor) == Ok(0)
}

impl<'a> OpenLoop<'a> {
    /// L at these frequencies in rad/s; where the response is known between them, at as many more
    /// as are needed for 1 + L to turn little from each to the next.
    pub(super) fn new(
        member: &'a Member,
        compensation: &'a Compensation,
        around: MeasuredLoop,
        frequencies_rad_per_s: &[f64],
        is_known_between: bool,
    ) -> OpenLoop<'a> {
        let highest = compensation.highest_frequency_rad_per_s();
        let frequencies = frequencies_rad_per_s.iter().take_while(|&&frequency| frequency <= highest);
        let mut open_loop = OpenLoop { member, compensation, around, points: Vec::new() };
        let points = frequencies.filter_map(|&frequency| Some((frequency, open_loop.at(frequency)?)));
        let points: Vec<(f64, Complex64)> = points.collect();
        open_loop.extend(points.into_iter(), is_known_between);
        open_loop
    }

    /// Adds these points, with as many between them as 1 + L needs where the response is known
    /// there.
    fn extend(&mut self, points: impl Iterator<Item = (f64, Complex64)>, is_known_between: bool) {
        for point in points {
            if is_known_between {
                self.fill_up_to(point);
            }
            self.points.push(point);
        }
    }

    /// What is known about a loop with this number of unstable poles.
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

    /// Points between the last one and this one, as many as are needed for 1 + L to turn little
    /// from each to the next.
    fn fill_up_to(&mut self, end: (f64, Complex64)) {
        let mut ahead = vec![end];
        while let (Some(&next), Some(&last)) = (ahead.last(), self.points.last()) {
            let near = next.0 - last.0 <= CLOSEST * next.0 || turns_little(last.1, next.1);
            let middle = (last.0 * next.0).sqrt();
            match Some(middle).filter(|_| !near).and_then(|middle| self.at(middle)) {
                Some(value) => ahead.push((middle, value)),
                None => {
                    ahead.pop();
                    if !ahead.is_empty() {
                        self.points.push(next);
                    }
                }
            }
        }
    }

    fn at(&self, frequency: f64) -> Option<Complex64> {
        if self.around == MeasuredLoop::Rate {
            return self.member.fed_back(frequency).map(|back| -back);
        }
        let response = self.member.response(frequency)?;
        Some(response.plant * response.sensor * self.compensation.feedback().at_frequency(frequency))
    }

    /// Number of poles of the closed loop outside the stable region, given the number of those of
    /// the plant.
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
        let &[first, second, ..] = self.points.as_slice() else { return Err(Irresolution::Points) };
        let turned_below = turn_below(first, second)?;
        let mut rounds = 0.0;
        for pair in self.points.windows(2) {
            let &[(from_rad_per_s, before), (to_rad_per_s, after)] = pair else { continue };
            if !turns_little(before, after) {
                let turn_deg = turn(before, after).to_degrees();
                return Err(Irresolution::Coarse { from_rad_per_s, to_rad_per_s, turn_deg });
            }
            rounds += rounds_begun(1.0 + before, 1.0 + after);
        }
        let &(frequency_rad_per_s, last) = self.points.last().ok_or(Irresolution::Points)?;
        let gain = portable::magnitude(last);
        if gain.is_nan() || gain > SMALL_GAIN {
            return Err(Irresolution::HighEnd { frequency_rad_per_s, gain });
        }
        // from the first point to the last 1 + L turns by 2 pi rounds and the difference of the
        // angles there, from the last on back to zero
        let turned = turned_below - portable::argument(1.0 + first.1) + 2.0 * std::f64::consts::PI * rounds;
        let count = own as f64 - turned / std::f64::consts::PI;
        if (count - count.round()).abs() > 1e-6 || count.round() < 0.0 {
            return Err(Irresolution::Count { count });
        }
        Ok(count.round() as usize)
    }

    /// The least |1 + L|: that of the points, refined around the least of them where the response
    /// is known.
    pub(super) fn closest_approach(&self) -> Approach {
        let distance = |value: Complex64| portable::magnitude(1.0 + value);
        let order = |one: &&[(f64, Complex64)], other: &&[(f64, Complex64)]| {
            distance(one[1].1).total_cmp(&distance(other[1].1))
        };
        let ends = self
            .points
            .iter()
            .map(|&(frequency_rad_per_s, value)| Approach { distance: distance(value), frequency_rad_per_s });
        let none = Approach { distance: f64::INFINITY, frequency_rad_per_s: f64::INFINITY };
        let least =
            ends.fold(none, |nearest, next| if next.distance < nearest.distance { next } else { nearest });
        let Some(&[before, nearest, after]) =
            self.points.windows(3).min_by(order).and_then(|points| points.first_chunk())
        else {
            return least;
        };
        if nearest.0 != least.frequency_rad_per_s {
            return least;
        }
        let at = |frequency: f64| self.at(frequency).map_or(f64::INFINITY, distance);
        let start = (nearest.0, least.distance);
        let (frequency_rad_per_s, found) = between(at, [before.0, after.0], start, POLISHED * nearest.0);
        if found < least.distance { Approach { distance: found, frequency_rad_per_s } } else { least }
    }

    /// Crossovers lie where the line between two points crosses one.
    pub(super) fn critical_delay(&self) -> CriticalDelay {
        let above = |value: Complex64| portable::magnitude(value) >= 1.0;
        let mut least = CriticalDelay::NONE;
        for pair in self.points.windows(2) {
            let &[(mut low, before), (mut high, after)] = pair else { continue };
            if above(before) == above(after) {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if self.at(middle).is_some_and(|value| above(value) == above(before)) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let Some(value) = self.at(high) else { continue };
            let lag = portable::argument(-value);
            let lag = if lag < 0.0 { lag + 2.0 * std::f64::consts::PI } else { lag };
            if lag / high < least.delay_s {
                least = CriticalDelay { delay_s: lag / high, frequency_rad_per_s: high };
            }
        }
        least
    }
}

/// Whether [`turn`] is at most [`TURN_MAXIMUM`], by products alone.
fn turns_little(before: Complex64, after: Complex64) -> bool {
    let is_small = |value: Complex64| value.norm_sqr() <= SMALL_GAIN * SMALL_GAIN;
    is_turned_little(1.0 + before, 1.0 + after)
        && (is_small(before) && is_small(after) || is_turned_little(before, after))
}

/// Whether the angle between two numbers is at most [`TURN_MAXIMUM`]; false where one of them is
/// zero or NaN.
///
/// ```text
/// |arg(b/a)| <= pi/3          where |Im(b a*)| <= sqrt(3) Re(b a*)
/// ```
fn is_turned_little(before: Complex64, after: Complex64) -> bool {
    let product = after * before.conj();
    product.re > 0.0 && product.im.abs() <= SQRT_3 * product.re && product.is_finite()
}

/// 1 where the argument of a number that turns by less than a right angle goes beyond pi, -1 where
/// it goes back.
fn rounds_begun(before: Complex64, after: Complex64) -> f64 {
    match (before.im.is_sign_negative(), after.im.is_sign_negative()) {
        (false, true) if after.re < 0.0 => 1.0,
        (true, false) if after.re < 0.0 => -1.0,
        _ => 0.0,
    }
}

/// The angle that 1 + L turns by from one point to the next, and L itself where it is not small,
/// whichever is wider, rad.
fn turn(before: Complex64, after: Complex64) -> f64 {
    let own = portable::argument((1.0 + after) / (1.0 + before)).abs();
    if portable::magnitude(before).max(portable::magnitude(after)) > SMALL_GAIN {
        own.max(portable::argument(after / before).abs())
    } else {
        own
    }
}

/// Poles outside of the stable region; those at zero frequency show in the measured loop.
pub(super) fn outside_of_stable_region(function: &TransferFunction) -> Result<usize, Irresolution> {
    let continuous = function.domain() == TimeDomain::Continuous;
    let excess = |pole: &Complex64| if continuous { pole.re } else { portable::magnitude(*pole) - 1.0 };
    let at_zero_frequency = if continuous { Complex64::new(0.0, 0.0) } else { Complex64::new(1.0, 0.0) };
    let poles = || function.poles().iter().filter(|pole| **pole != at_zero_frequency);
    if poles().any(|pole| excess(pole) == 0.0) {
        return Err(Irresolution::UndampedController);
    }
    Ok(poles().filter(|pole| excess(pole) > 0.0).count())
}

/// The change of arg(1 + L) from zero frequency, where 1 + L is real, to the first point, passing m
/// integrators on the right: -m pi/2 and the small deviation of the first point. The slope of |L|
/// there determines m.
fn turn_below(first: (f64, Complex64), second: (f64, Complex64)) -> Result<f64, Irresolution> {
    let unknown = Err(Irresolution::LowEnd { frequency_rad_per_s: first.0 });
    let gain = portable::magnitude(first.1);
    let slope = portable::ln(portable::magnitude(second.1) / gain) / portable::ln(second.0 / first.0);
    let integrators = (-slope).round();
    if gain <= SMALL_GAIN && integrators <= 0.0 {
        return Ok(portable::argument(1.0 + first.1));
    }
    let whole = (slope + integrators).abs() <= SLOPE_TOLERANCE;
    if !whole || integrators < 0.0 || (integrators > 0.0 && gain < LARGE_GAIN) {
        return unknown;
    }
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut rest = 1.0 + first.1;
    let mut done = 0.0;
    while done < integrators {
        rest *= Complex64::new(0.0, 1.0);
        done += 1.0;
    }
    let off = portable::argument(if rest.re < 0.0 { -rest } else { rest });
    if off.abs() > TURN_MAXIMUM { unknown } else { Ok(off - integrators * quarter) }
}
