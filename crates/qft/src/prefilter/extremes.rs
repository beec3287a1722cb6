//! The greatest and the least closed loop of a family.

use phea_dynamics::portable;

use super::PrefilterError;
use crate::closed_loop::{Compensation, DiscFactors, Member};
use crate::specification::ClosedLoop;

/// Relative distance from an undamped pole of the plant, where it has no response, at which the
/// closed loop is evaluated instead.
const BESIDE: f64 = 1e-9;

/// The greatest and the least |P G/(1+L)| of a family at one frequency, without the prefilter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackingExtremes {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Greatest magnitude, max |T|.
    pub greatest: f64,
    /// Index of the member with the greatest magnitude.
    pub greatest_member: usize,
    /// Least magnitude, min |T|.
    pub least: f64,
    /// Index of the member with the least magnitude.
    pub least_member: usize,
}

/// The extremes of a family at each frequency, without the prefilter, including the discs of
/// measured plants.
///
/// ```text
/// max |T|,  min |T|,    T = P G/(1 + P G H)                thesis (3.22), (3.23) with F = 1
/// ```
///
/// At an undamped pole of a plant T is continuous: |P| grows without bound there, and T tends to
/// 1/H. It is evaluated at a frequency higher by a billionth.
///
/// # Errors
/// [`PrefilterError::NoResponse`] beyond the range of a measurement, or where a plant has no value;
/// [`PrefilterError::NoMember`] without members.
///
/// # Example
/// Plants k/s closed with gain 1, k from 1 to 4: |T| = k/|jw + k|
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::prefilter::tracking_extremes;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let member = |k: f64| {
///     let command = RationalCoefficients { numerator: vec![k], denominator: vec![1.0, 0.0] };
///     compensation.member(PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None })
/// };
/// let found = tracking_extremes(&compensation, &[member(1.0)?, member(4.0)?], &[3.0])?[0];
/// assert_eq!((found.greatest_member, found.least_member), (1, 0));
/// assert!((found.greatest - 0.8).abs() < 1e-15 && (found.least - 0.1_f64.sqrt()).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
pub fn tracking_extremes(
    compensation: &Compensation,
    members: &[Member],
    frequencies_rad_per_s: &[f64],
) -> Result<Vec<TrackingExtremes>, PrefilterError> {
    if members.is_empty() {
        return Err(PrefilterError::NoMember);
    }
    let at = |&frequency: &f64| extremes_at(compensation, members, frequency);
    frequencies_rad_per_s.iter().map(at).collect()
}

fn extremes_at(
    compensation: &Compensation,
    members: &[Member],
    frequency_rad_per_s: f64,
) -> Result<TrackingExtremes, PrefilterError> {
    let feedback = compensation.response(frequency_rad_per_s).feedback;
    let mut found = TrackingExtremes {
        frequency_rad_per_s,
        greatest: 0.0,
        greatest_member: 0,
        least: f64::INFINITY,
        least_member: 0,
    };
    for (member, plant) in members.iter().enumerate() {
        let closed = |frequency: f64| {
            let response = plant.response(frequency)?;
            let forward = response.plant * feedback;
            let open = forward * response.sensor;
            let magnitude = portable::magnitude(forward / (1.0 + open));
            let radius = plant.radius(frequency, &response) * portable::magnitude(feedback * response.sensor);
            let [least, most] = DiscFactors::of(open, radius).of_closed_loop(ClosedLoop::Tracking);
            magnitude.is_finite().then(|| [least, most].map(|one| magnitude * one.sqrt()))
        };
        // the closed loop is continuous where the plant is infinite
        let magnitude = closed(frequency_rad_per_s).or_else(|| closed(frequency_rad_per_s * (1.0 + BESIDE)));
        let Some([least, most]) = magnitude else {
            return Err(PrefilterError::NoResponse { member, frequency_rad_per_s });
        };
        if most > found.greatest {
            (found.greatest, found.greatest_member) = (most, member);
        }
        if least < found.least {
            (found.least, found.least_member) = (least, member);
        }
    }
    Ok(found)
}
