//! The band that the closed loop leaves for the magnitude of the prefilter.

use phea_dynamics::frequency::decibels;

use super::ends::{self, TrackingDemand};
use super::{PrefilterError, TrackingExtremes, tracking_extremes};
use crate::closed_loop::{Compensation, Member};
use crate::specification::Specification;

/// Width below which a band is lost in rounding, dB.
pub(super) const RESOLVED_DB: f64 = 1e-9;
/// Distance to an edge beyond which more distance brings no benefit, dB.
const AMPLE_DB: f64 = 1.0;

/// The least and the greatest |F| at one frequency, each with the member that sets it.
///
/// ```text
/// width = upper/lower - max|T|/min|T|, in dB: allowed less actual spread               thesis (3.24), corrected
/// allowed = upper/lower, in dB                                                        thesis (3.25), corrected
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrefilterBandPoint {
    /// Frequency, rad/s; zero for the static limit.
    pub frequency_rad_per_s: f64,
    /// Lower edge lower/min|T|, dB; minus infinity without a lower limit.
    pub least_db: f64,
    /// Upper edge upper/max|T|, dB.
    pub greatest_db: f64,
    /// Allowed spread of the family upper/lower, dB.
    pub allowed_db: f64,
    /// Index of the member with the least |T|.
    pub least_member: usize,
    /// Index of the member with the greatest |T|.
    pub greatest_member: usize,
}

/// The band of the prefilter over frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct PrefilterBand {
    pub(super) points: Vec<PrefilterBandPoint>,
    /// Least and greatest relative degree that F may have.
    pub(super) relative_degree: [usize; 2],
    /// Least and greatest |F(0)|, dB.
    pub(super) gain_db: [f64; 2],
    /// Least and greatest requested positive frequency, rad/s.
    pub(super) span: [f64; 2],
}

impl PrefilterBandPoint {
    fn new(extremes: &TrackingExtremes, lower: f64, upper: f64) -> PrefilterBandPoint {
        PrefilterBandPoint {
            frequency_rad_per_s: extremes.frequency_rad_per_s,
            least_db: decibels(lower / extremes.least),
            greatest_db: decibels(upper / extremes.greatest),
            allowed_db: decibels(upper / lower),
            least_member: extremes.least_member,
            greatest_member: extremes.greatest_member,
        }
    }

    /// The residual band, dB: the spread that the specification allows less that of the family.
    /// Negative if no prefilter satisfies it.
    pub fn width_db(&self) -> f64 {
        self.greatest_db - self.least_db
    }

    /// The unit of a margin to an edge: half the width, as far as it is resolved, and at most 1 dB.
    ///
    /// If both limits meet at zero frequency, all margins shrink there with the square of the
    /// frequency; relative to the width they do not shrink, and represent the requirement on the
    /// curvature.
    pub fn rate(&self) -> f64 {
        (self.width_db() / 2.0).clamp(RESOLVED_DB, AMPLE_DB)
    }
}

impl PrefilterBand {
    /// The band at frequencies at which the extremes of the family are known, in increasing order;
    /// frequencies without a limit are omitted.
    ///
    /// # Errors
    /// [`PrefilterError::NotTracking`], [`PrefilterError::NoFrequency`].
    ///
    /// # Example
    /// Closed loops T between 0.5 and 0.8 with limits of 0.4 and 1 leave 0.8 to 1.25:
    /// ```
    /// use phea_qft::prefilter::{PrefilterBand, TrackingExtremes};
    /// use phea_qft::specification::{Limit, Requirement, Specification};
    /// let extremes = TrackingExtremes {
    ///     frequency_rad_per_s: 3.0, greatest: 0.8, greatest_member: 7, least: 0.5, least_member: 2,
    /// };
    /// let tracking = Specification {
    ///     requirement: Requirement::tracking(Limit::Constant(0.4), Limit::Constant(1.0)),
    ///     frequencies_rad_per_s: vec![3.0],
    ///     band_rad_per_s: [1.0, 10.0],
    /// };
    /// let band = PrefilterBand::new(&[extremes], &tracking)?;
    /// let point = band.points()[0];
    /// assert!((point.least_db - 20.0 * 0.8_f64.log10()).abs() < 1e-12);
    /// assert!((point.greatest_db - 20.0 * 1.25_f64.log10()).abs() < 1e-12);
    /// assert_eq!((point.least_member, point.greatest_member), (2, 7));
    /// # Ok::<(), phea_qft::prefilter::PrefilterError>(())
    /// ```
    pub fn new(
        extremes: &[TrackingExtremes],
        specification: &Specification,
    ) -> Result<PrefilterBand, PrefilterError> {
        let demand = TrackingDemand::of(specification)?;
        let point = |extremes: &TrackingExtremes| {
            let [lower, upper] = demand.at(extremes.frequency_rad_per_s)?;
            Some(PrefilterBandPoint::new(extremes, lower, upper))
        };
        let points: Vec<PrefilterBandPoint> = extremes.iter().filter_map(point).collect();
        let gain_db = points.first().map_or([0.0; 2], |lowest| [lowest.least_db, lowest.greatest_db]);
        let positive =
            points.iter().map(|point| point.frequency_rad_per_s).filter(|frequency| *frequency > 0.0);
        let span = [positive.clone().fold(f64::INFINITY, f64::min), positive.fold(0.0, f64::max)];
        if span[1] == 0.0 {
            return Err(PrefilterError::NoFrequency);
        }
        Ok(PrefilterBand { points, relative_degree: [0, usize::MAX], gain_db, span })
    }

    /// The band of a family at these frequencies (positive, increasing), with the conditions at the
    /// ends of the frequency axis: see [`PrefilterBand::with_ends`].
    ///
    /// # Errors
    /// Errors of [`PrefilterBand::new`] and [`tracking_extremes`].
    pub fn of_family(
        compensation: &Compensation,
        members: &[Member],
        frequencies_rad_per_s: &[f64],
        specification: &Specification,
    ) -> Result<PrefilterBand, PrefilterError> {
        let extremes = tracking_extremes(compensation, members, frequencies_rad_per_s)?;
        PrefilterBand::new(&extremes, specification)?.with_ends(compensation, members, specification)
    }

    /// Adds the conditions at the ends of the frequency axis.
    ///
    /// ```text
    /// w -> 0           F(0) between the limits over T(0); if both limits meet there, F(0) is that value even if the band of the
    ///                  limits begins above. Frequencies, each a decade lower, are added until the edges follow c w^2
    /// w -> infinity    if the tracking limits extend to infinity: the relative degrees that F may have, and three decades of frequencies
    /// ```
    ///
    /// For a measured family there are no ends, and the band remains unchanged.
    ///
    /// # Errors
    /// Errors of [`tracking_extremes`].
    pub fn with_ends(
        mut self,
        compensation: &Compensation,
        members: &[Member],
        specification: &Specification,
    ) -> Result<PrefilterBand, PrefilterError> {
        ends::towards_zero(&mut self, compensation, members, specification)?;
        ends::towards_infinity(&mut self, compensation, members, specification)?;
        Ok(self)
    }

    /// The band at one more frequency; `None` without limits there.
    pub(super) fn point(
        compensation: &Compensation,
        members: &[Member],
        frequency_rad_per_s: f64,
        demand: TrackingDemand,
    ) -> Result<Option<PrefilterBandPoint>, PrefilterError> {
        let Some([lower, upper]) = demand.at(frequency_rad_per_s) else { return Ok(None) };
        let found = tracking_extremes(compensation, members, &[frequency_rad_per_s])?;
        Ok(found.first().map(|extremes| PrefilterBandPoint::new(extremes, lower, upper)))
    }

    /// Relaxes every limit: upper ones are raised and lower ones reduced by this, dB. F(0) is
    /// unchanged.
    pub fn relaxed(mut self, relaxation_db: f64) -> PrefilterBand {
        for point in &mut self.points {
            point.least_db -= relaxation_db;
            point.greatest_db += relaxation_db;
            point.allowed_db += 2.0 * relaxation_db;
        }
        self
    }

    /// The band over frequency, in increasing order.
    pub fn points(&self) -> &[PrefilterBandPoint] {
        &self.points
    }

    /// Least and greatest relative degree that F may have according to the limits at infinite
    /// frequency.
    pub fn relative_degree(&self) -> [usize; 2] {
        self.relative_degree
    }

    /// The narrowest point of the band, if it is so narrow that a margin of minus this many
    /// decibels at both edges is not enough.
    pub fn closed(&self, tolerance_db: f64) -> Option<&PrefilterBandPoint> {
        let narrowest = self.points.iter().min_by(|left, right| left.width_db().total_cmp(&right.width_db()));
        narrowest.filter(|point| point.width_db() < -2.0 * tolerance_db.max(RESOLVED_DB))
    }
}
