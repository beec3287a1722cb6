//! Stability of every plant of a family within its loop, distance from instability, and tolerance
//! of additional dead time.
//!
//! ```text
//! poles:             zeros of c + n, of c z^k + n: their largest real part                  no dead time, or whole samples
//! argument:          turns of c + n e^(-s T) on the stability boundary                      every loop, including dead time
//! Nyquist:           turns of 1 + L                                                         measured plants, and plants without
//!                    polynomials, whose 1 + L is enclosed between successive frequencies
//! zero exclusion:    min |1 + L| over box and frequency: while it is not zero, no pole crosses from one plant to the next
//! leading coefficient:   enclosed over the box: while it is not zero, no pole passes through infinity
//! ```
//!
//! Nothing is cancelled: an unstable mode of plant, controller or sensor that the loop does not
//! move is counted. Prefilter and load-motion path are outside the loop; the audit of the family
//! requires a stable prefilter.

mod badness;
mod characteristic;
mod crossover;
mod encirclement;
mod enclosed;
mod family;
mod finding;
mod folding;
mod infinity;
mod measured;
mod poles;
mod product;
mod record;
mod resampled;
mod responding;

use phea_dynamics::linear::LinearError;

pub use crossover::CriticalDelay;
pub(crate) use family::StabilityAudit;
pub use family::{FamilyStability, family_stability};
pub use finding::{
    ClosestApproach, DelayMargin, SearchedInfinity, StabilityFinding, StabilityMethod, StabilityReason,
};
pub use resampled::borne_delay;

use crate::closed_loop::{Compensation, Member};
use characteristic::Characteristic;
pub(crate) use characteristic::FeedbackPath;
pub(crate) use measured::{LoopPoint, is_stable as is_stable_by_points, points_with_sensor};
use responding::PoleCounting;
pub(crate) use responding::own_poles;

/// Stability of one loop.
#[derive(Clone, Debug, PartialEq)]
pub enum StabilityStatus {
    /// All closed-loop poles are inside the stable region.
    Stable,
    /// The loop has a closed-loop pole outside the stable region.
    Unstable(Instability),
    /// The stability could not be decided.
    NotResolved(Irresolution),
}

/// Kind of instability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instability {
    /// A closed-loop pole with a non-negative real part.
    Pole {
        /// Real part, or ln|z|/T in a sampled loop, 1/s.
        real_part: f64,
    },
    /// Number of closed-loop poles outside the stable region.
    Poles {
        /// Number of poles.
        count: usize,
    },
    /// Dead time in a loop whose gain stays above one at arbitrarily high frequency: infinitely
    /// many unstable poles.
    GainAtInfinity,
}

/// Reason why the stability of a loop could not be decided.
#[derive(Clone, Debug, PartialEq)]
pub enum Irresolution {
    /// The loop is not valid, or cannot be computed.
    Linear(LinearError),
    /// A closed-loop pole is so near the stability boundary that rounding hides its side.
    NearBoundary {
        /// Frequency on the boundary, rad/s.
        frequency_rad_per_s: f64,
    },
    /// Too many steps along the stability boundary.
    Budget {
        /// Frequency at which the count stopped, rad/s.
        frequency_rad_per_s: f64,
    },
    /// Dead time in a loop whose gain tends to one: its poles approach the stability boundary.
    GainAtInfinity,
    /// A pole passes through infinity between plants of the box, none of which was found to be
    /// unstable.
    PoleThroughInfinity,
    /// Modes beyond half the sampling rate pass through the band more often than can be resolved by
    /// the plants examined.
    Folding,
    /// Plants without polynomials in a sampled loop, with modes between them that may fold.
    FoldingUnknown,
    /// The enclosures of the coefficients that must not vanish, so that no pole passes through
    /// infinity, still contain zero, and a search comes close to zero.
    InfinityOpen(SearchedInfinity),
    /// A controller or sensor with undamped poles away from the origin, in a loop known only by
    /// measured points.
    UndampedController,
    /// A plant whose unstable poles cannot be counted.
    OpenLoopPoles,
    /// Fewer than two points were measured below half the sampling rate.
    Points,
    /// The angle of 1 + L changes between two measured points by more than can be followed.
    Coarse {
        /// Lower of the two frequencies, rad/s.
        from_rad_per_s: f64,
        /// Upper of the two frequencies, rad/s.
        to_rad_per_s: f64,
        /// The angle, degrees.
        turn_deg: f64,
    },
    /// The measurement ends before the gain is small.
    HighEnd {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Gain |L|.
        gain: f64,
    },
    /// The behaviour of the loop below the first measured point cannot be inferred from the
    /// measurement.
    LowEnd {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Interval of d ln|L|/d ln w from there on; `None` if the points do not cover a factor of
        /// two.
        slope: Option<[f64; 2]>,
    },
    /// The slope at the lowest frequencies contradicts the stated integrators of the plant.
    Integrators {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Stated number of integrators of the loop.
        integrators: f64,
    },
    /// The disc around a measured response is so wide that 1 + L may turn in either direction.
    Confidence {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Distance |1 + L| at its centre.
        distance: f64,
        /// Radius of the disc, of L.
        radius: f64,
    },
    /// The turns do not amount to a whole number of poles.
    Count {
        /// Number of poles that the turns amount to.
        count: f64,
    },
}

/// The smallest |1 + L| along the frequency axis, the inverse of the largest sensitivity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Distance |1 + L|.
    pub distance: f64,
    /// Frequency, rad/s; infinite for a limit.
    pub frequency_rad_per_s: f64,
}

/// Stability results of one loop.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberStability {
    /// Status of the loop.
    pub status: StabilityStatus,
    /// Largest real part of a closed-loop pole (ln|z|/T in a sampled loop), 1/s; minus infinity
    /// without poles, `None` if dead time or a measurement prevents their computation.
    pub largest_real_part: Option<f64>,
    /// Closest approach of L to -1; for a stable loop.
    pub closest_approach: Option<Approach>,
    /// The additional dead time that it tolerates; for a stable loop.
    pub critical_delay: Option<CriticalDelay>,
}

/// Stability of one plant within its loop.
///
/// For a rational loop both the poles and the turns of the characteristic function must indicate
/// stability; otherwise it is not resolved. In a sampled loop the critical delay is phase over
/// frequency at the crossovers of the sampled L: exact if it is a whole number of samples; between
/// whole samples a delay also changes the sampled plant. [`family_stability`] resamples the worst
/// plants, unless a rate is fed back within the plant: for such a plant it is the delay of the
/// controller's path.
///
/// # Example
/// Plant k e^(-s)/s, stable for 0 < k < pi/2, which tolerates pi/(2 k) of dead time:
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::stability::{StabilityStatus, member_stability};
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let found = |gain: f64| {
///     let command = RationalCoefficients { numerator: vec![gain], denominator: vec![1.0, 0.0] };
///     let member = compensation.member(PlantCoefficients { command, disturbance: None, dead_time_s: 1.0, rate: None })?;
///     Ok::<_, phea_dynamics::linear::LinearError>(member_stability(&member, &compensation))
/// };
/// let stable = found(1.0)?;
/// assert_eq!(stable.status, StabilityStatus::Stable);
/// let delay = stable.critical_delay.map(|critical| critical.delay_s);
/// assert!(delay.is_some_and(|delay| (delay - (std::f64::consts::FRAC_PI_2 - 1.0)).abs() < 1e-12));
/// assert!(matches!(found(1.6)?.status, StabilityStatus::Unstable(_)));
/// # Ok(())
/// # }
/// ```
pub fn member_stability(member: &Member, compensation: &Compensation) -> MemberStability {
    match FeedbackPath::new(compensation) {
        Ok(path) => of_member(member, compensation, &path),
        Err(reason) => MemberStability::not_resolved(reason),
    }
}

fn of_member(member: &Member, compensation: &Compensation, path: &FeedbackPath) -> MemberStability {
    match characteristic(member, path) {
        Some(Ok(characteristic)) => of_characteristic(&characteristic),
        Some(Err(reason)) => MemberStability::not_resolved(reason),
        None if matches!(member, Member::Responding { .. }) => {
            responding::stability(member, compensation, PoleCounting::Enclosed)
        }
        None => measured::stability(member, compensation),
    }
}

/// Characteristic equation; `None` for a plant without polynomials.
fn characteristic(member: &Member, path: &FeedbackPath) -> Option<Result<Characteristic, Irresolution>> {
    match member {
        Member::Continuous { plant, .. } => Some(path.around(plant)),
        Member::Sampled { with_sensor, .. } => Some(path.around_sampled(with_sensor)),
        Member::Responding { .. } | Member::Measured { .. } => None,
    }
}

/// True if all closed-loop poles of a rational plant have real parts below this one (ln|z|/T in a
/// sampled loop), 1/s, including dead time: determined by the turns of the characteristic function
/// on a parallel to the stability boundary.
pub(crate) fn poles_lie_below(
    member: &Member,
    path: &FeedbackPath,
    real_part: f64,
) -> Result<bool, Irresolution> {
    let characteristic = characteristic(member, path).ok_or(Irresolution::Points)??;
    let moved = characteristic.moved(real_part);
    let improper = characteristic.gain_at_infinity().is_none();
    if (improper && characteristic.has_gain_above_one_at_infinity()) || moved.has_gain_above_one_at_infinity()
    {
        return Ok(false);
    }
    Ok(moved.unstable_poles()? == 0)
}

fn of_characteristic(characteristic: &Characteristic) -> MemberStability {
    let real_part = match characteristic.largest_real_part() {
        Ok(real_part) => real_part,
        Err(reason) => return MemberStability::not_resolved(reason),
    };
    let found = |status| MemberStability {
        status,
        largest_real_part: real_part,
        closest_approach: None,
        critical_delay: None,
    };
    if let Some(real_part) = real_part.filter(|real_part| *real_part >= 0.0) {
        return found(StabilityStatus::Unstable(Instability::Pole { real_part }));
    }
    if characteristic.has_gain_above_one_at_infinity() {
        return found(StabilityStatus::Unstable(Instability::GainAtInfinity));
    }
    let encirclement = match characteristic.encirclement() {
        Ok(encirclement) => encirclement,
        Err(reason) => return found(StabilityStatus::NotResolved(reason)),
    };
    let (distance, angle) = encirclement.closest;
    let frequency_rad_per_s = characteristic.frequency(angle);
    match (encirclement.unstable_poles, real_part) {
        (0, _) => match characteristic.critical_delay() {
            Ok(critical_delay) => MemberStability {
                closest_approach: Some(Approach { distance, frequency_rad_per_s }),
                critical_delay: Some(critical_delay),
                ..found(StabilityStatus::Stable)
            },
            Err(reason) => found(StabilityStatus::NotResolved(reason)),
        },
        (count, None) => found(StabilityStatus::Unstable(Instability::Poles { count })),
        // the poles indicate stability and the turns do not: rounding
        (_, Some(_)) => {
            found(StabilityStatus::NotResolved(Irresolution::NearBoundary { frequency_rad_per_s }))
        }
    }
}

impl MemberStability {
    fn not_resolved(reason: Irresolution) -> MemberStability {
        MemberStability {
            status: StabilityStatus::NotResolved(reason),
            largest_real_part: None,
            closest_approach: None,
            critical_delay: None,
        }
    }
}
