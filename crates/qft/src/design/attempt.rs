//! Search of one structure for a design:
//!
//! ```text
//! search -> prefilter, descent with both -> check between the samples -> audit -> met
//!             ^--------- descent, or a new search, with the counterexamples --+
//! ```

mod auditing;
mod beginning;
mod deployment;
mod error;
mod reached;
mod reshaping;
mod shorter_prefilter;

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::watch::{Watch, part};

pub(super) use self::beginning::{SearchEffort, StartingPoints};
use self::beginning::{best_of, search_options};
pub use self::error::LoopDesignError;
use super::Objective;
use super::counterexample::{Counterexample, counterexamples, worst_margin_db};
use super::problem::{DesignOptions, PrefilterChoice};
use super::result::{DesignRound, Starts};
use crate::closed_loop::Compensation;
use crate::loop_shaping::{
    Aim, BestSeen, DescentOptions, DesignProblem, Judgement, Samples, SearchOptions, SearchProblem,
    SearchStatus, Shaping, Structure, descend, search_seeing,
};
use crate::plant_cache::PlantCache;
use crate::prefilter::{FittedPrefilter, PrefilterBand, PrefilterOptions, PrefilterOutcome, fit_prefilter};
use crate::specification::Specification;
use crate::verification::{Audit, AuditEffort, AuditProblem, TrackingJudgement, audit_among};

/// Deficit of the worst margin of the samples beyond the tolerance, without the reserve, at which a
/// structure counts as unable to meet the specifications, dB.
const BEYOND_TOLERANCE_DB: f64 = 0.5e-3;
/// Worst margin, relative to that before the last counterexamples, below which the gradients are
/// misleading, dB.
const ASTRAY_DB: f64 = -6.0;
/// Multiples of a counterexample's frequency at which its plants are also evaluated.
pub(super) const NEIGHBOURS: [f64; 4] = [0.94, 0.97, 1.03, 1.06];
/// Largest number of audits of one structure.
const ROUNDS_MAXIMUM: usize = 40;
/// Widening of both edges of a prefilter's band for its starting point, dB.
const BAND_ROOM_DB: f64 = 3.0;
/// Order of the prefilter that is fitted first.
const FIRST_PREFILTER_ORDER: usize = 2;
/// Distance that a search stays inside its limits, dB, so that margins that the audit finds between
/// the samples still satisfy them.
const RESERVE_DB: f64 = 0.001;

impl DesignOptions {
    /// The least worst margin of the samples with which a structure may still meet the
    /// specifications, dB.
    pub(super) fn feasible_db(&self) -> f64 {
        -self.tolerance_db - BEYOND_TOLERANCE_DB
    }

    /// Aim of a search: the least relaxation, or a controller that needs none.
    pub(super) fn aim(&self, relaxes: bool) -> Aim {
        match self.objective {
            _ if relaxes => Aim::WorstMargin,
            Objective::BestWorstMargin => Aim::WorstMargin,
            Objective::LeastHighFrequencyGain | Objective::LeastBandwidth => Aim::Objective,
        }
    }

    /// Distance that such a search stays inside its limits, dB.
    pub(super) fn search_reserve_db(&self, relaxes: bool) -> f64 {
        if relaxes { 0.0 } else { RESERVE_DB + self.reserve_db }
    }
}

/// Outcome of an attempt.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum AttemptEnding {
    /// The audit finds that every specification is met.
    Met(Box<Audit>),
    /// The best worst margin over rate is this, dB; with its audit if one was requested.
    Missed { worst_margin_db: f64, audit: Option<Box<Audit>> },
    /// The search found no stable controller of the structure.
    NotStabilised,
    /// The structure does not improve the result enough to earn its poles.
    NotEarned,
    /// Search and audit did not agree.
    NotConverged(Box<Audit>),
}

/// Reason why the attempt ends before an audit agrees.
enum Leave {
    Ended(AttemptEnding),
    Failed(LoopDesignError),
}

impl<E: Into<LoopDesignError>> From<E> for Leave {
    fn from(error: E) -> Leave {
        Leave::Failed(error.into())
    }
}

/// Name of the stage in progress reports.
pub(super) const SHAPING: &str = "shaping the loop";
const CHECKING: &str = "looking between samples";
const AUDITING: &str = "auditing";
const WHOLE: [f64; 2] = [0.0, 1.0];

/// One structure in progress.
#[derive(Clone, Debug)]
pub(super) struct Attempt {
    structure: Structure,
    shaping: Shaping,
    options: DesignOptions,
    aim: Aim,
    /// True if the worst margin is maximised even when negative.
    relaxes: bool,
    /// Distance that the search stays inside its limits, dB.
    reserve_db: f64,
    /// Number of times the limits were tightened to make up for rounding.
    draws: usize,
    /// Order of the prefilter to be fitted next.
    prefilter_order: usize,
    restarts: u64,
    /// The worst margin before the last counterexamples were added, dB, at most 0; unused unless a
    /// relaxation is sought.
    missing_db: f64,
    /// The last x from which the margins could still be improved.
    sound: Vec<f64>,
    /// Points that the first search evaluates before those spread over the bounds.
    given: Vec<Vec<f64>>,
    /// Points at which the nominal plant is stabilised.
    stabilising: Vec<Vec<f64>>,
    effort: SearchEffort,
    /// Value that the samples must reach for the structure to earn its poles, see
    /// [`Attempt::reached_db`].
    earns: Option<f64>,
    /// Ends of the starts of the last search.
    starts: Option<Starts>,
    x: Vec<f64>,
    rounds: Vec<DesignRound>,
    /// The audits of the additional plants, for the audited controller.
    additional_audits: Vec<Audit>,
}

impl Attempt {
    /// A new attempt with its starting points. With `relaxes` it seeks the smallest common
    /// relaxation.
    pub(super) fn new(
        structure: Structure,
        mut samples: Samples,
        options: &DesignOptions,
        relaxes: bool,
        beginning: StartingPoints,
    ) -> Result<Attempt, LoopDesignError> {
        let reserve_db = options.search_reserve_db(relaxes);
        samples.keep_in_reserve(reserve_db);
        let aim = options.aim(relaxes);
        let given = match &options.prefilter {
            PrefilterChoice::Given(prefilter) if tracks(samples.problem()).is_some() => {
                Some(Structure::fixed_to(prefilter))
            }
            _ => None,
        };
        let mut shaping = Shaping::new(structure.clone(), given, options.objective, samples)?;
        let StartingPoints { mut simpler, stabilising, effort } = beginning;
        let stabilising = best_of(&mut shaping, stabilising);
        simpler.extend_from_slice(&stabilising);
        Ok(Attempt {
            shaping,
            stabilising,
            effort,
            earns: None,
            starts: None,
            structure,
            options: options.clone(),
            aim,
            relaxes,
            reserve_db,
            draws: 0,
            prefilter_order: FIRST_PREFILTER_ORDER,
            restarts: 0,
            missing_db: 0.0,
            sound: vec![],
            given: simpler,
            x: vec![],
            rounds: vec![],
            additional_audits: vec![],
        })
    }

    /// Shapes the loop and audits it, again with every counterexample, until search and audit
    /// agree. Plants that were already sampled in this loop are not sampled again.
    ///
    /// # Errors
    /// [`LoopDesignError::Stopped`] by the watch; the results until then remain.
    pub(super) fn run(
        &mut self,
        cache: &PlantCache,
        watch: Watch<'_>,
    ) -> Result<AttemptEnding, LoopDesignError> {
        match self.until_agreed(cache, watch) {
            Ok(ending) | Err(Leave::Ended(ending)) => Ok(ending),
            Err(Leave::Failed(error)) => Err(error),
        }
    }

    fn until_agreed(&mut self, cache: &PlantCache, watch: Watch<'_>) -> Result<AttemptEnding, Leave> {
        let given = std::mem::take(&mut self.given);
        self.search(given, (self.options.seed, self.effort), watch)?;
        if self
            .earns
            .is_some_and(|most_db| !self.reached_db().is_some_and(|reached_db| reached_db <= most_db))
        {
            return Ok(AttemptEnding::NotEarned);
        }
        self.audited_until_agreed(cache, watch)
    }

    /// Audits from the search result onwards.
    fn audited_until_agreed(&mut self, cache: &PlantCache, watch: Watch<'_>) -> Result<AttemptEnding, Leave> {
        loop {
            self.draw_in(watch)?;
            if !self.learns_between_samples(cache, watch)?
                && let Some(ending) = self.audited(cache, watch)?
            {
                return Ok(ending);
            }
            self.shape_again(watch)?;
        }
    }

    /// Attempt at this structure that is abandoned once its samples show that it cannot reach this
    /// value of [`Attempt::reached_db`].
    pub(super) fn that_earns(self, most_db: Option<f64>) -> Attempt {
        Attempt { earns: most_db, ..self }
    }

    pub(super) fn structure(&self) -> &Structure {
        &self.structure
    }

    pub(super) fn options(&self) -> &DesignOptions {
        &self.options
    }

    pub(super) fn shaping(&self) -> &Shaping {
        &self.shaping
    }

    /// Feedback G found so far.
    pub(super) fn feedback(&self) -> Option<TransferFunction> {
        let own = self.x.get(..self.structure.dimension())?;
        self.structure.compensator(own).transfer_function().ok()
    }

    /// Ends of the starts of the last search.
    pub(super) fn starts(&self) -> Option<&Starts> {
        self.starts.as_ref()
    }

    pub(super) fn x(&self) -> &[f64] {
        &self.x
    }

    /// The worst margin of its controller over its samples, dB; `None` without a controller.
    pub(super) fn worst_margin_db(&mut self) -> Option<f64> {
        let judgement = (!self.x.is_empty()).then(|| self.shaping.judge(&self.x))?;
        judgement.stable.then_some(judgement.worst_margin_db)
    }

    pub(super) fn rounds(&self) -> &[DesignRound] {
        &self.rounds
    }

    /// All plants and frequencies that were evaluated, for the next attempt.
    pub(super) fn samples(&self) -> Samples {
        self.shaping.samples().clone()
    }

    /// Searches, and fits a prefilter to the resulting loop.
    fn search(
        &mut self,
        given: Vec<Vec<f64>>,
        (seed, effort): (u64, SearchEffort),
        watch: Watch<'_>,
    ) -> Result<(), Leave> {
        let options = search_options(self.aim, seed, self.relaxes, effort);
        let options = SearchOptions { workers: self.options.workers, ..options };
        let mut seen = BestSeen::new(self.aim);
        let found =
            search_seeing(&mut self.shaping, given, (&options, &mut seen), &mut part(watch, SHAPING, WHOLE));
        if found.is_err() {
            self.x = seen.x().unwrap_or_default();
        }
        let Some(result) = found? else { return Err(Leave::Ended(AttemptEnding::NotStabilised)) };
        self.starts = Some(Starts::of(&result));
        self.x = result.x;
        if matches!(result.status, SearchStatus::NotStabilised { .. }) {
            return Err(Leave::Ended(AttemptEnding::NotStabilised));
        }
        if self.options.objective == Objective::BestWorstMargin && !self.relaxes {
            self.shaping.count_fractions_of_room();
        }
        let worst_margin_db = result.judgement.worst_margin_db;
        if worst_margin_db < self.options.feasible_db() && !self.relaxes {
            return Err(Leave::Ended(AttemptEnding::Missed { worst_margin_db, audit: None }));
        }
        if self.fits_prefilter(watch)? { self.descend(false, watch) } else { Ok(()) }
    }

    /// Fits a prefilter to the present loop, as a start for the combined descent; false if no
    /// prefilter is designed.
    fn fits_prefilter(&mut self, watch: Watch<'_>) -> Result<bool, Leave> {
        let missing_db = if self.relaxes { -self.shaping.judge(&self.x).worst_margin_db } else { 0.0 };
        let room_db = BAND_ROOM_DB + missing_db.max(0.0);
        let samples = self.shaping.samples();
        let problem = samples.problem();
        let (PrefilterChoice::Grow { maximum_order }, Some(tracking)) =
            (&self.options.prefilter, tracks(problem))
        else {
            return Ok(false);
        };
        let around = Compensation::new(&self.shaping.controller(&self.x), problem.sensor.clone())?;
        let frequencies = samples.grid_frequencies_rad_per_s();
        let band = PrefilterBand::of_family(&around, samples.members(), &frequencies, tracking)?;
        let order = self.prefilter_order.min(*maximum_order);
        let options =
            PrefilterOptions { least_order: order, ..PrefilterOptions::new(order, self.options.seed) };
        // only a starting point is needed here; the descent that follows restores the band
        let band = band.relaxed(room_db);
        let outcome = fit_prefilter(&band, &problem.timing, &options, watch)?;
        let fitted = match outcome {
            PrefilterOutcome::Found(fitted) => Some(fitted),
            PrefilterOutcome::OrderTooLow { best } => best,
            PrefilterOutcome::NoBand(_) => None,
        };
        let Some(FittedPrefilter { structure, x, .. }) = fitted else {
            let judgement = self.shaping.judge(&self.x);
            let worst_margin_db = judgement.worst_margin_db.min(-2.0 * BAND_ROOM_DB);
            return Err(Leave::Ended(AttemptEnding::Missed { worst_margin_db, audit: None }));
        };
        self.x.truncate(self.structure.dimension());
        self.x.extend(x);
        self.shape_with(Some(structure))?;
        Ok(true)
    }

    /// Reshapes with these samples and this controller, with another prefilter or none.
    fn shape_with(&mut self, prefilter: Option<Structure>) -> Result<(), LoopDesignError> {
        let samples = self.shaping.samples().clone();
        self.shaping = Shaping::new(self.structure.clone(), prefilter, self.options.objective, samples)?;
        Ok(())
    }

    /// Descends until the samples satisfy the specifications: from the present point, then with the
    /// step sizes of a new start, then with prefilters of more poles.
    fn descend(&mut self, mut is_near: bool, watch: Watch<'_>) -> Result<(), Leave> {
        loop {
            let options = DescentOptions { reserve_db: 0.0, is_near, ..DescentOptions::new(self.aim) };
            let found = descend(&mut self.shaping, &self.x, options, &mut part(watch, SHAPING, WHOLE))?;
            self.x = found.x;
            let Some(judgement) = found.judgement.filter(|judgement| judgement.stable) else {
                return Err(Leave::Ended(AttemptEnding::NotStabilised));
            };
            let worst_margin_db = judgement.worst_margin_db;
            if worst_margin_db >= self.options.feasible_db() || self.relaxes {
                return Ok(());
            }
            if is_near {
                is_near = false;
                continue;
            }
            match self.options.prefilter {
                PrefilterChoice::Grow { maximum_order } if self.prefilter_order < maximum_order => {
                    self.prefilter_order += 1;
                    self.x.truncate(self.structure.dimension());
                    self.shape_with(None)?;
                }
                _ => return Err(Leave::Ended(AttemptEnding::Missed { worst_margin_db, audit: None })),
            }
            if !self.fits_prefilter(watch)? {
                return Ok(());
            }
        }
    }

    /// Examines the plants of the samples between their frequencies, and the corners of the box;
    /// the interior of the box is left to the audit. Returns true if counterexamples were added.
    fn learns_between_samples(&mut self, cache: &PlantCache, watch: Watch<'_>) -> Result<bool, Leave> {
        let samples = self.shaping.samples();
        let problem = AuditProblem {
            family: &samples.family(),
            compensation: &self.compensation()?,
            specifications: &samples.problem().specifications,
            tracking: self.shaping.tracking(),
            tolerance_db: self.options.tolerance_db,
        };
        let known = (cache, AuditEffort::KnownPlants);
        let (findings, _) = audit_among(&problem, &[], known, &mut part(watch, CHECKING, WHOLE))?;
        let judgement = self.judgement();
        let new = self.new_margins(&judgement);
        let examples = counterexamples(&findings, new, self.shaping.tracking());
        if examples.is_empty() {
            return Ok(false);
        }
        self.note(Some(worst_margin_db(&findings)), &judgement);
        Ok(self.takes_in(&examples)?)
    }

    /// Adds counterexamples to the samples; false if they are already among them, or if the number
    /// of rounds is exhausted.
    fn takes_in(&mut self, examples: &[Counterexample]) -> Result<bool, LoopDesignError> {
        let mut news = false;
        self.missing_db =
            if self.relaxes { self.shaping.judge(&self.x).worst_margin_db.min(0.0) } else { 0.0 };
        let [lowest, highest] = self.frequency_range();
        for example in examples {
            // one decade at a time towards the ends of the frequency axis
            let at = match example.frequency_rad_per_s {
                None => lowest,
                Some(frequency) if frequency <= 0.0 => 0.1 * lowest,
                Some(frequency) if frequency.is_infinite() => 10.0 * highest,
                Some(frequency) => frequency,
            };
            news |= self.shaping.add(&example.plants, at)?;
            // a peak moves with the next controller, so that its neighbourhood is also evaluated
            for fraction in NEIGHBOURS.into_iter().filter(|_| example.frequency_rad_per_s.is_some()) {
                self.shaping.add(&example.plants, (at * fraction).clamp(lowest, highest))?;
            }
        }
        Ok(news && self.rounds.len() < ROUNDS_MAXIMUM)
    }

    /// Descends again, with the counterexamples among the samples; starts a new search if their
    /// margins cannot be improved from here.
    fn shape_again(&mut self, watch: Watch<'_>) -> Result<(), Leave> {
        let judgement = self.shaping.judge(&self.x);
        if judgement.stable && judgement.worst_margin_db > self.missing_db + ASTRAY_DB {
            self.sound = self.x.clone();
            return self.descend(true, watch);
        }
        self.search_anew(watch)
    }

    /// Starts a new search with all plants known by now, for an added plant that is unstable or
    /// nearly so with the present controller, so that its margins cannot be improved from there.
    /// The starts include the last point where the margins could be improved.
    fn search_anew(&mut self, watch: Watch<'_>) -> Result<(), Leave> {
        self.restarts += 1;
        self.x.truncate(self.structure.dimension());
        if self.prefilter_is_fitted() {
            self.shape_with(None)?;
        }
        let seed = self.options.seed.wrapping_add(self.restarts);
        let sound = self.sound.get(..self.structure.dimension()).map(<[f64]>::to_vec);
        let given = sound.into_iter().chain(self.stabilising.iter().cloned()).collect();
        self.search(given, (seed, self.effort.again()), watch)
    }

    fn prefilter_is_fitted(&self) -> bool {
        self.shaping.tracking() == TrackingJudgement::Magnitude
            && matches!(self.options.prefilter, PrefilterChoice::Grow { .. })
    }

    fn frequency_range(&self) -> [f64; 2] {
        let frequencies = self.shaping.samples().frequencies_rad_per_s();
        [frequencies.first().copied().unwrap_or(1.0), frequencies.last().copied().unwrap_or(1.0)]
    }

    fn note(&mut self, audited_margin_db: Option<f64>, judgement: &Judgement) {
        let samples = self.shaping.samples();
        self.rounds.push(DesignRound {
            structure: self.structure.clone(),
            objective_db: judgement.objective_db,
            plants: samples.plants().len(),
            frequencies: samples.frequencies_rad_per_s().len(),
            searched_margin_db: judgement.worst_margin_db,
            audited_margin_db,
        });
    }
}

/// The tracking specification, if any.
fn tracks(problem: &DesignProblem) -> Option<&Specification> {
    problem.specifications.iter().find(|one| one.requirement.is_tracking())
}
