//! The synthesis of a prefilter, stepped by its owner.

use phea_dynamics::controller::{Compensator, Element, Timing};
use phea_dynamics::linear::{LinearError, TransferFunction};

use super::structures::structures;
use super::{PrefilterBand, PrefilterBandPoint, PrefilterError, PrefilterFit, PrefilterMargin};
use crate::loop_shaping::{Aim, Search, SearchOptions, Structure};
use crate::verification::TOLERANCE_DB;

/// Starting points for each free number.
const SAMPLES_PER_NUMBER: usize = 60;
/// Shares this near to one another count as equal.
const EQUAL_SHARE: f64 = 0.01;

/// Which prefilters are tried, and when one is good enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrefilterOptions {
    /// Least number of poles.
    pub least_order: usize,
    /// Largest number of poles.
    pub maximum_order: usize,
    /// Least number of poles less zeros, as far as the band allows it.
    pub least_relative_degree: usize,
    /// A margin of minus this much still counts as met, dB.
    pub tolerance_db: f64,
    /// Seed of the starting points: the same seed gives the same prefilter.
    pub seed: u64,
}

impl PrefilterOptions {
    /// Relative degree 1 at least, so that a step of the reference reaches the controller without a jump; the tolerance of the audit.
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

/// A prefilter that was fitted into its band.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedPrefilter {
    /// What was fitted.
    pub structure: Structure,
    /// Its free numbers.
    pub x: Vec<f64>,
    /// The prefilter.
    pub compensator: Compensator,
    /// Its worst margin: that of the least share, and of several as small to 1 % the one where the band is widest.
    pub worst: PrefilterMargin,
}

/// What the synthesis ended with.
#[derive(Clone, Debug, PartialEq)]
pub enum PrefilterOutcome {
    /// The prefilter of least order that keeps to its band, as far in the middle as it can.
    Found(FittedPrefilter),
    /// The band is closed: no prefilter of any order will do. The members of this point are the two plants that collide.
    NoBand(PrefilterBandPoint),
    /// The band is open, and no prefilter of the orders tried keeps to it; the one that comes nearest, if any was tried.
    OrderTooLow {
        /// Its worst margin is negative.
        best: Option<FittedPrefilter>,
    },
}

/// The synthesis of a prefilter, stepped by its owner, who may show its progress or stop it at any step.
///
/// Structures of growing order are fitted into the band, each by a search from many starts for the greatest worst margin over rate
/// ([`PrefilterFit`]); the first one that keeps to both edges everywhere is taken. Source of the band: thesis 3.1.5.
///
/// # Example
/// A band of 1 dB to both sides of a lag with its corner at 2 rad/s: the lag is found.
/// ```
/// use phea_dynamics::controller::{Element, Timing};
/// use phea_dynamics::portable::magnitude;
/// use phea_qft::prefilter::{PrefilterBand, PrefilterOptions, PrefilterOutcome, PrefilterRun, TrackingExtremes};
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
///     requirement: Requirement::Tracking { lower, upper },
///     frequencies_rad_per_s: vec![],
///     band_rad_per_s: [0.1, 20.0],
/// };
/// let band = PrefilterBand::new(&extremes, &tracking)?;
/// let mut run = PrefilterRun::new(band, &Timing::default(), PrefilterOptions::new(3, 1))?;
/// while run.step() {}
/// let Some(PrefilterOutcome::Found(found)) = run.outcome() else { return Err("it exists".into()) };
/// let pole = found.compensator.transfer_function()?.poles()[0];
/// assert!((pole.re + 2.0).abs() < 1e-3 && (found.worst.margin_db - 1.0).abs() < 1e-3);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct PrefilterRun {
    band: PrefilterBand,
    timing: Timing,
    options: PrefilterOptions,
    fits: Vec<PrefilterFit>,
    /// The structure that is fitted now.
    at: usize,
    search: Search,
    best: Option<(f64, FittedPrefilter)>,
    outcome: Option<PrefilterOutcome>,
}

impl PrefilterRun {
    /// A synthesis that has not begun, for a loop with this timing.
    ///
    /// # Errors
    /// [`PrefilterError::Linear`] for a sample time or a prewarping frequency that cannot be.
    pub fn new(
        band: PrefilterBand,
        timing: &Timing,
        options: PrefilterOptions,
    ) -> Result<PrefilterRun, PrefilterError> {
        let timing = timing.of_prefilter();
        let tolerance_db = options.tolerance_db;
        let outcome = band.closed(tolerance_db).copied().map(PrefilterOutcome::NoBand);
        let structures =
            structures(&band, options.least_relative_degree, options.least_order..=options.maximum_order);
        let fits: Vec<PrefilterFit> = structures
            .into_iter()
            .map(|structure| PrefilterFit::new(&band, structure, &timing, tolerance_db))
            .collect::<Result<_, _>>()?;
        let search = search(fits.first(), &options);
        Ok(PrefilterRun { band, timing, options, fits, at: 0, search, best: None, outcome })
    }

    /// The band that is fitted into.
    pub fn band(&self) -> &PrefilterBand {
        &self.band
    }

    /// Does a small part of the work; whether there is more to do.
    pub fn step(&mut self) -> bool {
        if self.outcome.is_some() {
            return false;
        }
        match self.fits.get_mut(self.at).map(|fit| self.search.step(fit)) {
            Some(true) => {}
            Some(false) => self.finish_structure(),
            None => self.outcome = Some(self.ended()),
        }
        self.outcome.is_none()
    }

    /// The share of the work that is done, 0 to 1, were all orders needed; 1 when it has ended.
    pub fn progress(&self) -> f64 {
        match self.outcome {
            Some(_) => 1.0,
            None => (self.at as f64 + self.search.progress()) / (self.fits.len() as f64 + 1.0),
        }
    }

    /// What it ended with; `None` as long as it goes on.
    pub fn outcome(&self) -> Option<&PrefilterOutcome> {
        self.outcome.as_ref()
    }

    /// Takes what the search of one structure found, and goes on to the next structure if that does not keep to the band.
    fn finish_structure(&mut self) {
        let found = self.search.result().zip(self.fits.get(self.at));
        let found = found.and_then(|(result, fit)| {
            Some((result.judgement.worst_margin_db, self.fitted(fit.structure(), result.x)?))
        });
        if let Some((share, fitted)) = found {
            if share >= 0.0 {
                self.outcome = Some(PrefilterOutcome::Found(fitted));
                return;
            }
            if self.best.as_ref().is_none_or(|(best, _)| share > *best) {
                self.best = Some((share, fitted));
            }
        }
        self.at += 1;
        self.search = search(self.fits.get(self.at), &self.options);
    }

    /// What remains when no structure keeps to the band to the last digit: the tolerance may forgive the best.
    fn ended(&mut self) -> PrefilterOutcome {
        let best = self.best.take().map(|(_, best)| best);
        let forgiven = |fitted: &FittedPrefilter| {
            let margins = self.margins(&fitted.compensator).unwrap_or_default();
            margins.iter().all(|margin| margin.margin_db >= -self.options.tolerance_db)
        };
        match best {
            Some(best) if forgiven(&best) => PrefilterOutcome::Found(best),
            best => PrefilterOutcome::OrderTooLow { best },
        }
    }

    fn fitted(&self, structure: &Structure, x: Vec<f64>) -> Option<FittedPrefilter> {
        let mut compensator = structure.compensator(&x);
        compensator.stages.retain(|stage| stage.element != Element::Gain(1.0));
        let margins = self.margins(&compensator).ok()?;
        let least = margins.first()?.share();
        let equals = margins.into_iter().take_while(|margin| margin.share() <= least + EQUAL_SHARE);
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

/// The search for one structure, from the more starts the more free numbers it has.
fn search(fit: Option<&PrefilterFit>, options: &PrefilterOptions) -> Search {
    let numbers = fit.map_or(0, |fit| fit.structure().dimension());
    let samples = SAMPLES_PER_NUMBER * numbers;
    Search::new(SearchOptions { samples, ..SearchOptions::new(Aim::WorstMargin, options.seed) })
}
