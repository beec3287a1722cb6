//! The conditions of a band towards zero and infinite frequency.

use phea_dynamics::frequency::decibels;

use super::band::RESOLVED_DB;
use super::{PrefilterBand, PrefilterBandPoint, PrefilterError};
use crate::closed_loop::{Compensation, Member};
use crate::specification::{Limit, Specification};
use crate::verification::{AxisEnd, tracking_ratio};

/// Change of the edges' curvature from one decade to the next, as a fraction of their distance,
/// below which the edges have settled.
const SETTLED_FRACTION: f64 = 0.01;
/// Decades that are examined below the lowest frequency and above the highest.
const DECADES: [usize; 2] = [9, 3];

/// Both limits and their band.
#[derive(Clone, Copy)]
pub(super) struct TrackingDemand<'a> {
    lower: &'a Limit,
    upper: &'a Limit,
    band: [f64; 2],
}

impl TrackingDemand<'_> {
    pub(super) fn of(specification: &Specification) -> Result<TrackingDemand<'_>, PrefilterError> {
        match specification.requirement.limits() {
            (Some(lower), upper) => Ok(TrackingDemand { lower, upper, band: specification.band_rad_per_s }),
            _ => Err(PrefilterError::NotTracking),
        }
    }

    /// Both limits; `None` outside their band.
    pub(super) fn at(self, frequency: f64) -> Option<[f64; 2]> {
        let demanded = self.band[0] <= frequency && frequency <= self.band[1];
        let limits = || Some([self.lower.magnitude(frequency)?, self.upper.magnitude(frequency)?]);
        demanded.then(limits).flatten()
    }
}

/// Adds the limit at zero frequency, and lower frequencies until the edges follow c w^2.
pub(super) fn towards_zero(
    band: &mut PrefilterBand,
    compensation: &Compensation,
    members: &[Member],
    specification: &Specification,
) -> Result<(), PrefilterError> {
    let demand = TrackingDemand::of(specification)?;
    let Some(rest) = at_rest(compensation, members, demand) else { return Ok(()) };
    let meet = rest.allowed_db <= RESOLVED_DB;
    let known = meet && rest.width_db() >= -RESOLVED_DB;
    if demand.band[0] > 0.0 && !known {
        return Ok(());
    }
    band.gain_db = [rest.least_db, rest.greatest_db];
    if meet {
        let middle = (rest.least_db + rest.greatest_db) / 2.0;
        band.gain_db = [if middle.abs() < RESOLVED_DB { 0.0 } else { middle }; 2];
    }
    let mut added = Vec::new();
    let lowest = band.points.iter().position(|point| point.frequency_rad_per_s > 0.0);
    let mut last = lowest.and_then(|index| band.points.get(index)).copied();
    for _ in 0..DECADES[0] {
        let Some(before) = last.filter(|_| known) else { break };
        let frequency = before.frequency_rad_per_s / 10.0;
        let Some(point) = PrefilterBand::point(compensation, members, frequency, demand)? else { break };
        if point.width_db().abs() < RESOLVED_DB {
            break;
        }
        added.push(point);
        last = (!settled(&rest, &before, &point)).then_some(point);
    }
    added.push(rest);
    added.reverse();
    band.points.retain(|point| point.frequency_rad_per_s > 0.0);
    band.points.splice(0..0, added);
    Ok(())
}

/// True if both edges of two points follow one c w^2, starting from the value at zero frequency.
fn settled(rest: &PrefilterBandPoint, before: &PrefilterBandPoint, point: &PrefilterBandPoint) -> bool {
    let square = |point: &PrefilterBandPoint| point.frequency_rad_per_s * point.frequency_rad_per_s;
    let curvatures = |point: &PrefilterBandPoint| {
        [point.least_db - rest.least_db, point.greatest_db - rest.greatest_db]
            .map(|edge| edge / square(point))
    };
    let [least, greatest] = curvatures(point);
    let changes = curvatures(before).into_iter().zip([least, greatest]).map(|(old, new)| (new - old).abs());
    changes.fold(0.0, f64::max) <= SETTLED_FRACTION * (greatest - least).abs()
}

/// The limit of the band as w -> 0; `None` if it has none, or if T vanishes or grows there
/// differently from its limits.
fn at_rest(
    compensation: &Compensation,
    members: &[Member],
    demand: TrackingDemand,
) -> Option<PrefilterBandPoint> {
    let mut point = PrefilterBandPoint {
        frequency_rad_per_s: 0.0,
        least_db: f64::NEG_INFINITY,
        greatest_db: f64::INFINITY,
        allowed_db: 0.0,
        least_member: 0,
        greatest_member: 0,
    };
    for (index, member) in members.iter().enumerate() {
        let ratio = |limit: &Limit| {
            let ratio = tracking_ratio(compensation, member, limit, AxisEnd::Zero)?;
            (ratio.power == 0 && ratio.coefficient != 0.0).then(|| decibels(ratio.coefficient.abs()))
        };
        let (least_db, greatest_db) = (ratio(demand.lower)?, ratio(demand.upper)?);
        if index == 0 {
            point.allowed_db = greatest_db - least_db;
        }
        if least_db > point.least_db {
            (point.least_db, point.least_member) = (least_db, index);
        }
        if greatest_db < point.greatest_db {
            (point.greatest_db, point.greatest_member) = (greatest_db, index);
        }
    }
    Some(point)
}

/// Adds the relative degrees that the limits allow, and higher frequencies, if the tracking limits
/// extend to infinity.
///
/// ```text
/// F -> f s^-r,   limit/|T| -> c s^n:        r >= -n of the upper limit,  r <= -n of the lower one
/// ```
pub(super) fn towards_infinity(
    band: &mut PrefilterBand,
    compensation: &Compensation,
    members: &[Member],
    specification: &Specification,
) -> Result<(), PrefilterError> {
    let demand = TrackingDemand::of(specification)?;
    if demand.band[1] < f64::INFINITY || compensation.sample_time_s().is_some() {
        return Ok(());
    }
    let [mut least, mut greatest] = [0, i32::MAX];
    for member in members {
        let degree = |limit: &Limit| {
            tracking_ratio(compensation, member, limit, AxisEnd::Infinity).map(|ratio| -ratio.power)
        };
        let (Some(lower), Some(upper)) = (degree(demand.lower), degree(demand.upper)) else { return Ok(()) };
        (least, greatest) = (least.max(upper), greatest.min(lower));
    }
    band.relative_degree = [least, greatest].map(|degree| usize::try_from(degree).unwrap_or(0));
    let mut frequency = band.span[1];
    for _ in 0..DECADES[1] {
        frequency *= 10.0;
        band.points.extend(PrefilterBand::point(compensation, members, frequency, demand)?);
    }
    Ok(())
}
