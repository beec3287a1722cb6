//! The synthesis of a prefilter.

use phea_dynamics::controller::{Compensator, Element, Timing};
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::watch::{Watch, part};

use super::structures::structures;
use super::{PrefilterBand, PrefilterBandPoint, PrefilterError, PrefilterFit, PrefilterMargin};
use crate::loop_shaping::{Aim, SearchOptions, Structure, search};
use crate::verification::TOLERANCE_DB;

/// Number of starting points for each free number.
const SAMPLES_PER_NUMBER: usize = 60;
/// Difference of relative margins below which they count as equal.
const EQUAL_FRACTION: f64 = 0.01;

/// Candidate prefilters, and the margin at which one is good enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrefilterOptions {
    /// Least number of poles.
    pub least_order: usize,
    /// Largest number of poles.
    pub maximum_order: usize,
    /// Least relative degree (poles less zeros), as far as the band allows it.
    pub least_relative_degree: usize,
    /// Violation up to which a margin counts as met, dB.
    pub tolerance_db: f64,
    /// Seed of the starting points: equal seeds give equal prefilters.
    pub seed: u64,
}

impl PrefilterOptions {
    /// Defaults: relative degree of at least 1, so that a step of the reference reaches the
    /// controller without a jump, and the tolerance of the audit.
    pub fn new(maximum_order: usize, seed: u64) -> PrefilterOptions {
        PrefilterOptions {
            least_order: 0,
            maximum_order,
            least_relative_degree: 1,
            tolerance_db: TOLERANCE_DB,
            seed,
        }
    }
}

/// A prefilter fitted into its band.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedPrefilter {
    /// Structure that was fitted.
    pub structure: Structure,
    /// Free numbers of the structure.
    pub x: Vec<f64>,
    /// The prefilter.
    pub compensator: Compensator,
    /// Worst margin: the smallest relative to its unit or, among several equal to within 1 %, the
    /// one where the band is widest.
    pub worst: PrefilterMargin,
}

/// Outcome of the synthesis.
#[derive(Clone, Debug, PartialEq)]
pub enum PrefilterOutcome {
    /// The prefilter of least order that stays within its band, as close to the middle as possible.
    Found(FittedPrefilter),
    /// The band is closed: no prefilter of any order satisfies it. The members of this point are
    /// the two conflicting plants.
    NoBand(PrefilterBandPoint),
    /// The band is open, but no prefilter of the candidate orders stays within it.
    OrderTooLow {
        /// The nearest prefilter, with a negative worst margin; `None` if there were no candidates.
        best: Option<FittedPrefilter>,
    },
}

/// Fits the prefilter of least order into its band, for a loop with this timing.
///
/// Structures of growing order are fitted into the band, each by a search from many starts for the
/// greatest worst margin over rate ([`PrefilterFit`]); the first one that satisfies both edges
/// everywhere is returned. Source of the band: thesis 3.1.5.
///
/// # Errors
/// [`PrefilterError::Linear`] for an invalid sample time or prewarping frequency;
/// [`PrefilterError::Stopped`] by the watch.
///
/// # Example
/// A band of 1 dB on both sides of a lag with its corner at 2 rad/s: the lag is found.
/// ```
/// use phea_dynamics::controller::{Element, Timing};
/// use phea_dynamics::portable::magnitude;
/// use phea_dynamics::watch::unwatched;
/// use phea_qft::prefilter::{PrefilterBand, PrefilterOptions, PrefilterOutcome, TrackingExtremes, fit_prefilter};
/// use phea_qft::specification::{Limit, Requirement, Specification};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let lag = Element::RealPole { frequency: 2.0 }.transfer_function()?;
/// let extremes = [0.1, 0.3, 1.0, 2.0, 5.0, 20.0].map(|frequency_rad_per_s| {
///     let needed = 1.0 / magnitude(lag.at_frequency(frequency_rad_per_s));
///     TrackingExtremes { frequency_rad_per_s, greatest: needed, greatest_member: 0, least: needed, least_member: 0 }
/// });
/// let decibel = 10.0_f64.powf(0.05);
/// let (lower, upper) = (Limit::Constant(1.0 / decibel), Limit::Constant(decibel));
/// let tracking = Specification {
///     requirement: Requirement::tracking(lower, upper),
///     frequencies_rad_per_s: vec![],
///     band_rad_per_s: [0.1, 20.0],
/// };
/// let band = PrefilterBand::new(&extremes, &tracking)?;
/// let outcome = fit_prefilter(&band, &Timing::default(), &PrefilterOptions::new(3, 1), &mut unwatched)?;
/// let PrefilterOutcome::Found(found) = outcome else { return Err("it exists".into()) };
/// let pole = found.compensator.transfer_function()?.poles()[0];
/// assert!((pole.re + 2.0).abs() < 1e-3 && (found.worst.margin_db - 1.0).abs() < 1e-3);
/// # Ok(())
/// # }
/// ```
pub fn fit_prefilter(
    band: &PrefilterBand,
    timing: &Timing,
    options: &PrefilterOptions,
    watch: Watch<'_>,
) -> Result<PrefilterOutcome, PrefilterError> {
    let synthesis = Synthesis { band, timing: timing.of_prefilter() };
    let orders = options.least_order..=options.maximum_order;
    let structures = structures(band, options.least_relative_degree, orders);
    let fit = |structure| PrefilterFit::new(band, structure, &synthesis.timing, options.tolerance_db);
    let mut fits: Vec<PrefilterFit> = structures.into_iter().map(fit).collect::<Result<_, _>>()?;
    if let Some(closed) = band.closed(options.tolerance_db) {
        return Ok(PrefilterOutcome::NoBand(*closed));
    }
    let all = fits.len() as f64 + 1.0;
    let mut best: Option<(f64, FittedPrefilter)> = None;
    for (done, fit) in fits.iter_mut().enumerate() {
        let fractions = [done as f64 / all, (done as f64 + 1.0) / all];
        // more free numbers need more starts
        let samples = SAMPLES_PER_NUMBER * fit.structure().dimension();
        let options = SearchOptions { samples, ..SearchOptions::new(Aim::WorstMargin, options.seed) };
        let found = search(fit, vec![], &options, &mut part(watch, "fitting the prefilter", fractions))?;
        let Some(result) = found else { continue };
        let fraction = result.judgement.worst_margin_db;
        let Some(fitted) = synthesis.fitted(fit.structure(), result.x) else { continue };
        if fraction >= 0.0 {
            return Ok(PrefilterOutcome::Found(fitted));
        }
        if best.as_ref().is_none_or(|(best, _)| fraction > *best) {
            best = Some((fraction, fitted));
        }
    }
    // no prefilter satisfies the band to the last digit: the best may be within the tolerance
    let best = best.map(|(_, best)| best);
    Ok(match best {
        Some(best) if synthesis.is_within(&best, options.tolerance_db) => PrefilterOutcome::Found(best),
        best => PrefilterOutcome::OrderTooLow { best },
    })
}

/// The data common to all structures.
struct Synthesis<'a> {
    band: &'a PrefilterBand,
    timing: Timing,
}

impl Synthesis<'_> {
    fn is_within(&self, fitted: &FittedPrefilter, tolerance_db: f64) -> bool {
        let margins = self.margins(&fitted.compensator).unwrap_or_default();
        margins.iter().all(|margin| margin.margin_db >= -tolerance_db)
    }

    fn fitted(&self, structure: &Structure, x: Vec<f64>) -> Option<FittedPrefilter> {
        let mut compensator = structure.compensator(&x);
        compensator.stages.retain(|stage| stage.element != Element::Gain(1.0));
        let margins = self.margins(&compensator).ok()?;
        let least = margins.first()?.fraction();
        let equals = margins.into_iter().take_while(|margin| margin.fraction() <= least + EQUAL_FRACTION);
        let worst = equals.max_by(|left, right| left.rate.total_cmp(&right.rate))?;
        Some(FittedPrefilter { structure: structure.clone(), x, compensator, worst })
    }

    fn margins(&self, compensator: &Compensator) -> Result<Vec<PrefilterMargin>, LinearError> {
        let continuous: TransferFunction = compensator.transfer_function()?;
        let prefilter = match self.timing.sample_time_s {
            Some(sample_time_s) => continuous.discretized(sample_time_s, self.timing.discretization)?,
            None => continuous,
        };
        Ok(self.band.margins(&prefilter))
    }
}
