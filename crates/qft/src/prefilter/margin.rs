//! Margins of a given prefilter to its band.

use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;

use super::band::RESOLVED_DB;
use super::{PrefilterBand, PrefilterBandPoint};

/// An edge of the band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BandEdge {
    /// Lower edge lower/min|T|.
    Least,
    /// Upper edge upper/max|T|.
    Greatest,
}

/// The smaller of the margins of |F| to the edges of its band at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrefilterMargin {
    /// Frequency, rad/s; zero for the static limit.
    pub frequency_rad_per_s: f64,
    /// The nearer edge.
    pub edge: BandEdge,
    /// Distance to it, dB; negative if F is beyond it.
    pub margin_db: f64,
    /// Unit of the margin, dB: see [`PrefilterBandPoint::rate`].
    pub rate: f64,
    /// Index of the member that sets the edge.
    pub member: usize,
}

impl PrefilterMargin {
    /// The margin in its unit: 1 in the middle of a band that is narrower than 2 dB.
    pub fn fraction(&self) -> f64 {
        self.margin_db / self.rate
    }
}

impl PrefilterBand {
    /// The margins of a prefilter, given or synthesised, the smallest relative to its unit first:
    /// one for each frequency; the prefilter must be sampled if the loop is (as
    /// `Compensation::prefilter` is). At zero frequency, where the band may be a single value, only
    /// a violation is listed.
    ///
    /// # Example
    /// A lag with its corner at 2 rad/s with limits of 0.5 and 1 at 3 rad/s:
    /// ```
    /// use phea_dynamics::controller::Element;
    /// use phea_qft::prefilter::{BandEdge, PrefilterBand, TrackingExtremes};
    /// # use phea_qft::specification::{Limit, Requirement, Specification};
    /// # let extremes =
    /// #     TrackingExtremes { frequency_rad_per_s: 3.0, greatest: 1.0, greatest_member: 0, least: 1.0, least_member: 0 };
    /// # let tracking = Specification {
    /// #     requirement: Requirement::tracking(Limit::Constant(0.5), Limit::Constant(1.0)),
    /// #     frequencies_rad_per_s: vec![3.0],
    /// #     band_rad_per_s: [1.0, 10.0],
    /// # };
    /// let band = PrefilterBand::new(&[extremes], &tracking)?;
    /// let worst = band.margins(&Element::RealPole { frequency: 2.0 }.transfer_function()?)[0];
    /// assert_eq!(worst.edge, BandEdge::Least);
    /// let magnitude = 1.0 / (1.0_f64 + 2.25).sqrt();
    /// assert!((worst.margin_db - 20.0 * (magnitude / 0.5).log10()).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn margins(&self, prefilter: &TransferFunction) -> Vec<PrefilterMargin> {
        let margin = |point: &PrefilterBandPoint| {
            let magnitude = portable::magnitude(prefilter.at_frequency(point.frequency_rad_per_s));
            let margin = point.margin(decibels(magnitude));
            (point.frequency_rad_per_s > 0.0 || margin.margin_db < -RESOLVED_DB).then_some(margin)
        };
        let mut margins: Vec<PrefilterMargin> = self.points.iter().filter_map(margin).collect();
        sort_by_number(&mut margins, PrefilterMargin::fraction);
        margins
    }
}

impl PrefilterBandPoint {
    /// The smaller margin of this |F|; minus infinity if it is NaN, as at a pole on the imaginary
    /// axis.
    fn margin(&self, magnitude_db: f64) -> PrefilterMargin {
        let magnitude_db = if magnitude_db.is_nan() { f64::INFINITY } else { magnitude_db };
        let [above, below] = [magnitude_db - self.least_db, self.greatest_db - magnitude_db];
        let (edge, margin_db, member) = if above < below {
            (BandEdge::Least, above, self.least_member)
        } else {
            (BandEdge::Greatest, below, self.greatest_member)
        };
        let frequency_rad_per_s = self.frequency_rad_per_s;
        PrefilterMargin { frequency_rad_per_s, edge, margin_db, rate: self.rate(), member }
    }
}
