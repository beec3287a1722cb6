//! One structure on its way to a design: a search, the fit of a prefilter, a descent with both, an audit, and the descent again with what
//! the audit found.

mod auditing;
mod beginning;
mod deployment;
mod error;

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::watch::unwatched;

pub(super) use self::beginning::Beginning;
use self::beginning::{best_of, search_options};
pub use self::error::DesignError;
use super::counterexample::{Counterexample, counterexamples, worst_margin_db};
use super::problem::{DesignOptions, DesignProblem, Objective, PrefilterChoice};
use super::result::{DesignRound, Starts};
use crate::closed_loop::Compensation;
use crate::loop_shaping::{
    Aim, Descent, DescentOptions, Judgement, Samples, Search, SearchProblem, SearchStatus, Shaping, Structure,
};
use crate::prefilter::{FittedPrefilter, PrefilterBand, PrefilterOptions, PrefilterOutcome, PrefilterRun};
use crate::sampled::SampledPlants;
use crate::specification::Requirement;
use crate::verification::{Audit, AuditProblem, TrackingJudgement, audit_among};

/// Below this worst margin of the samples, the reserve taken off, a structure counts as unable to meet the specifications, dB.
pub(super) const FEASIBLE_DB: f64 = -1.5e-3;
/// Where a counterexample misses by this much more than all samples did, the margins of what was found lead nowhere, dB.
const ASTRAY_DB: f64 = -6.0;
/// Beside the frequency of a counterexample the same plants are looked at at these multiples of it.
const NEIGHBOURS: [f64; 4] = [0.94, 0.97, 1.03, 1.06];
/// Audits of one structure at most.
const ROUNDS_MAXIMUM: usize = 40;
/// Room that a start of a prefilter may take from both edges of its band, dB.
const BAND_ROOM_DB: f64 = 3.0;
/// How far inside its limits a search stays, dB: what the audit finds between the samples then still meets them.
const RESERVE_DB: f64 = 0.001;

/// What an attempt ended with.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Ending {
    /// The audit finds every specification met.
    Met(Box<Audit>),
    /// With this worst margin over rate at best, dB; audited where that was asked for.
    Missed { worst_margin_db: f64, audit: Option<Box<Audit>> },
    /// No stable controller of the structure was found.
    NotStabilised,
    /// The same, with the audit of what came nearest.
    Hopeless(Box<Audit>),
    /// Search and audit did not come to agree.
    NotConverged(Box<Audit>),
}

#[derive(Clone, Debug)]
enum Stage {
    Searching(Box<Search>),
    Fitting(Box<PrefilterRun>),
    Descending(Box<Descent>),
    /// The specifications over the box, from the plants of the samples alone.
    Checking,
    /// The next plant beside the family.
    Beside,
    Auditing,
    Ended(Ending),
}

/// One structure on its way.
#[derive(Clone, Debug)]
pub(super) struct Attempt {
    structure: Structure,
    shaping: Shaping,
    options: DesignOptions,
    aim: Aim,
    /// Whether the worst margin is wanted even where it is negative.
    relaxes: bool,
    /// How far inside its limits the search stays, dB.
    reserve_db: f64,
    /// How often it was drawn in for what rounding takes.
    draws: usize,
    /// Order of the prefilter that is fitted next.
    prefilter_order: usize,
    restarts: u64,
    /// The last x from which margins led on.
    sound: Vec<f64>,
    /// Points at which the nominal plant is stabilised.
    stabilising: Vec<Vec<f64>>,
    is_hard: bool,
    /// Where the starts of its last search ended.
    starts: Option<Starts>,
    /// Whether no more than an audit is wanted.
    audits_only: bool,
    x: Vec<f64>,
    stage: Stage,
    rounds: Vec<DesignRound>,
    /// The plants that its audits sampled.
    sampled: SampledPlants,
    /// The audits of the plants beside the family, of the controller that is audited.
    beside: Vec<Audit>,
}

impl Attempt {
    /// An attempt that has not begun, with points to begin with, and plants that were sampled in the same loop. With `relaxes` it looks for
    /// the smallest common relaxation.
    pub(super) fn new(
        structure: Structure,
        mut samples: Samples,
        options: &DesignOptions,
        relaxes: bool,
        beginning: Beginning,
        sampled: SampledPlants,
    ) -> Result<Attempt, DesignError> {
        let reserve_db = if relaxes { 0.0 } else { RESERVE_DB };
        samples.keep_in_reserve(reserve_db);
        let aim = match options.objective {
            _ if relaxes => Aim::WorstMargin,
            Objective::BestWorstMargin => Aim::WorstMargin,
            Objective::LeastHighFrequencyGain | Objective::LeastBandwidth => Aim::Objective,
        };
        let given = match &options.prefilter {
            PrefilterChoice::Given(prefilter) if tracks(samples.problem()).is_some() => {
                Some(Structure::fixed_to(prefilter))
            }
            _ => None,
        };
        let mut shaping = Shaping::new(structure.clone(), given, options.objective, samples)?;
        let Beginning { mut simpler, stabilising, is_hard } = beginning;
        let stabilising = best_of(&mut shaping, stabilising);
        simpler.extend_from_slice(&stabilising);
        let search = Search::new(search_options(aim, options.seed, relaxes, is_hard)).beginning_with(simpler);
        Ok(Attempt {
            shaping,
            stabilising,
            is_hard,
            starts: None,
            structure,
            options: options.clone(),
            aim,
            relaxes,
            reserve_db,
            draws: 0,
            prefilter_order: 2,
            restarts: 0,
            sound: vec![],
            audits_only: false,
            x: vec![],
            stage: Stage::Searching(Box::new(search)),
            rounds: vec![],
            sampled,
            beside: vec![],
        })
    }

    /// Does a small part of the work; whether there is more to do.
    pub(super) fn step(&mut self) -> Result<bool, DesignError> {
        let goes_on = match &mut self.stage {
            Stage::Searching(search) => search.step(&mut self.shaping),
            Stage::Fitting(run) => run.step(),
            Stage::Descending(descent) => descent.step(&mut self.shaping),
            Stage::Checking | Stage::Beside | Stage::Auditing => false,
            Stage::Ended(_) => return Ok(false),
        };
        if !goes_on {
            self.stage = match &self.stage {
                Stage::Searching(_) => self.after_search()?,
                Stage::Fitting(_) => self.after_fit()?,
                Stage::Descending(_) => self.after_descent()?,
                Stage::Checking => self.after_check()?,
                Stage::Beside => self.after_beside()?,
                Stage::Auditing => self.after_audit()?,
                Stage::Ended(ending) => Stage::Ended(ending.clone()),
            };
        }
        Ok(true)
    }

    /// What is being done.
    pub(super) fn stage(&self) -> &'static str {
        match self.stage {
            Stage::Searching(_) | Stage::Descending(_) => "shaping the loop",
            Stage::Fitting(_) => "fitting the prefilter",
            Stage::Checking => "looking between the samples",
            Stage::Beside | Stage::Auditing | Stage::Ended(_) => "auditing",
        }
    }

    pub(super) fn ending(&self) -> Option<&Ending> {
        match &self.stage {
            Stage::Ended(ending) => Some(ending),
            _ => None,
        }
    }

    pub(super) fn structure(&self) -> &Structure {
        &self.structure
    }

    pub(super) fn shaping(&self) -> &Shaping {
        &self.shaping
    }

    /// G as far as it was found.
    pub(super) fn feedback(&self) -> Option<TransferFunction> {
        let own = self.x.get(..self.structure.dimension())?;
        self.structure.compensator(own).transfer_function().ok()
    }

    /// Where the starts of its last search ended.
    pub(super) fn starts(&self) -> Option<&Starts> {
        self.starts.as_ref()
    }

    pub(super) fn x(&self) -> &[f64] {
        &self.x
    }

    pub(super) fn rounds(&self) -> &[DesignRound] {
        &self.rounds
    }

    /// Everything that was looked at, for the next attempt.
    pub(super) fn samples(&self) -> Samples {
        self.shaping.samples().clone()
    }

    /// Hands over the plants that were sampled, once it has ended.
    pub(super) fn take_sampled(&mut self) -> SampledPlants {
        std::mem::take(&mut self.sampled)
    }

    fn after_search(&mut self) -> Result<Stage, DesignError> {
        let Stage::Searching(search) = &self.stage else { return Ok(Stage::Ended(Ending::NotStabilised)) };
        let Some(result) = search.result() else { return Ok(Stage::Ended(Ending::NotStabilised)) };
        self.starts = Some(Starts::of(&result));
        self.x = result.x;
        if matches!(result.status, SearchStatus::NotStabilised { .. }) {
            return Ok(Stage::Ended(Ending::NotStabilised));
        }
        if self.options.objective == Objective::BestWorstMargin && !self.relaxes {
            self.shaping.count_shares_of_room();
        }
        let worst_margin_db = result.judgement.worst_margin_db;
        if worst_margin_db < FEASIBLE_DB && !self.relaxes {
            return Ok(Stage::Ended(Ending::Missed { worst_margin_db, audit: None }));
        }
        self.fit_or(Self::check)
    }

    /// Fits a prefilter to the loop as it is, or goes on where none is looked for.
    fn fit_or(&mut self, go_on: fn(&mut Self) -> Result<Stage, DesignError>) -> Result<Stage, DesignError> {
        let missing_db = if self.relaxes { -self.shaping.judge(&self.x).worst_margin_db } else { 0.0 };
        let room_db = BAND_ROOM_DB + missing_db.max(0.0);
        let problem = self.shaping.samples().problem();
        let (PrefilterChoice::Grow { maximum_order }, Some(tracking)) =
            (&self.options.prefilter, tracks(problem))
        else {
            return go_on(self);
        };
        let specification = &problem.specifications[tracking];
        let samples = self.shaping.samples();
        let around = Compensation::new(&self.shaping.controller(&self.x), problem.sensor.clone())?;
        let band = PrefilterBand::of_family(
            &around,
            samples.members(),
            &samples.grid_frequencies_rad_per_s(),
            specification,
        )?;
        let order = self.prefilter_order.min(*maximum_order);
        // what the band lacks the descent that follows will find: only a start is wanted here
        let band = band.relaxed(room_db);
        let options =
            PrefilterOptions { least_order: order, ..PrefilterOptions::new(order, self.options.seed) };
        Ok(Stage::Fitting(Box::new(PrefilterRun::new(band, &problem.timing, options)?)))
    }

    fn after_fit(&mut self) -> Result<Stage, DesignError> {
        let Stage::Fitting(run) = &self.stage else { return Ok(Stage::Ended(Ending::NotStabilised)) };
        let fitted = match run.outcome() {
            Some(PrefilterOutcome::Found(fitted)) => Some(fitted.clone()),
            Some(PrefilterOutcome::OrderTooLow { best }) => best.clone(),
            Some(PrefilterOutcome::NoBand(_)) | None => None,
        };
        let Some(FittedPrefilter { structure, x, .. }) = fitted else {
            let judgement = self.shaping.judge(&self.x);
            let worst_margin_db = judgement.worst_margin_db.min(-2.0 * BAND_ROOM_DB);
            return Ok(Stage::Ended(Ending::Missed { worst_margin_db, audit: None }));
        };
        let own = &self.x[..self.structure.dimension().min(self.x.len())];
        self.x = [own, &x].concat();
        let samples = self.shaping.samples().clone();
        self.shaping =
            Shaping::new(self.structure.clone(), Some(structure), self.options.objective, samples)?;
        Ok(self.descend(false))
    }

    fn descend(&self, is_near: bool) -> Stage {
        let options = DescentOptions { reserve_db: 0.0, is_near, ..DescentOptions::new(self.aim) };
        Stage::Descending(Box::new(Descent::new(&self.x, options)))
    }

    fn after_descent(&mut self) -> Result<Stage, DesignError> {
        let Stage::Descending(descent) = &self.stage else { return self.check() };
        let is_near = descent.options().is_near;
        self.x = descent.x().to_vec();
        let Some(judgement) = descent.judgement().filter(|judgement| judgement.stable) else {
            return Ok(Stage::Ended(Ending::NotStabilised));
        };
        let worst_margin_db = judgement.worst_margin_db;
        if worst_margin_db >= FEASIBLE_DB || self.relaxes {
            return self.check();
        }
        if is_near {
            return Ok(self.descend(false));
        }
        match self.options.prefilter {
            PrefilterChoice::Grow { maximum_order } if self.prefilter_order < maximum_order => {
                self.prefilter_order += 1;
                let samples = self.shaping.samples().clone();
                self.x.truncate(self.structure.dimension());
                self.shaping = Shaping::new(self.structure.clone(), None, self.options.objective, samples)?;
                self.fit_or(Self::check)
            }
            _ => Ok(Stage::Ended(Ending::Missed { worst_margin_db, audit: None })),
        }
    }

    /// Looks between the samples: over the whole box, but beginning from the plants of the samples.
    fn check(&mut self) -> Result<Stage, DesignError> {
        if let Some(next) = self.drawn_in() {
            return Ok(next);
        }
        Ok(Stage::Checking)
    }

    fn after_check(&mut self) -> Result<Stage, DesignError> {
        let samples = self.shaping.samples();
        let problem = AuditProblem {
            family: &samples.family(),
            compensation: &self.compensation()?,
            specifications: &samples.problem().specifications,
            tracking: self.shaping.tracking(),
            tolerance_db: self.options.tolerance_db,
        };
        let checked = audit_among(&problem, &[], &self.sampled, &mut unwatched);
        let findings = checked.map(|(findings, _)| findings).unwrap_or_default();
        let judgement = self.judgement();
        let tolerance_db = self.new_below_db(&judgement);
        let audited_db = worst_margin_db(&findings);
        let examples = counterexamples(&findings, tolerance_db, self.shaping.tracking());
        if !examples.is_empty() {
            self.note(Some(audited_db), &judgement);
            if let Some(next) = self.with(&examples)? {
                return Ok(next);
            }
        }
        self.beside.clear();
        self.audit()
    }

    /// The descent again, with these among the samples; `None` if they are among them already, or it was made often enough.
    fn with(&mut self, examples: &[Counterexample]) -> Result<Option<Stage>, DesignError> {
        let mut news = false;
        let missing_db =
            if self.relaxes { self.shaping.judge(&self.x).worst_margin_db.min(0.0) } else { 0.0 };
        let [lowest, highest] = self.frequency_range();
        for example in examples {
            // towards the ends of the axis a decade at a time
            let at = match example.frequency_rad_per_s {
                None => lowest,
                Some(frequency) if frequency <= 0.0 => 0.1 * lowest,
                Some(frequency) if frequency.is_infinite() => 10.0 * highest,
                Some(frequency) => frequency,
            };
            news |= self.shaping.add(&example.plants, at)?;
            // a peak moves with the next controller: its neighbourhood is looked at too
            for share in NEIGHBOURS.into_iter().filter(|_| example.frequency_rad_per_s.is_some()) {
                self.shaping.add(&example.plants, (at * share).clamp(lowest, highest))?;
            }
        }
        if !news || self.rounds.len() >= ROUNDS_MAXIMUM {
            return Ok(None);
        }
        let judgement = self.shaping.judge(&self.x);
        let leads_on = judgement.stable && judgement.worst_margin_db > missing_db + ASTRAY_DB;
        if leads_on {
            self.sound = self.x.clone();
            return Ok(Some(self.descend(true)));
        }
        Ok(Some(self.search_anew()?))
    }

    /// A plant that was added is unstable with what was found, or nearly so, and margins lead nowhere from there: begins again among all plants
    /// that are known now, where they last led on besides.
    fn search_anew(&mut self) -> Result<Stage, DesignError> {
        self.restarts += 1;
        self.x.truncate(self.structure.dimension());
        if self.prefilter_is_fitted() {
            let samples = self.shaping.samples().clone();
            self.shaping = Shaping::new(self.structure.clone(), None, self.options.objective, samples)?;
        }
        let seed = self.options.seed.wrapping_add(self.restarts);
        let sound = self.sound.get(..self.structure.dimension()).map(<[f64]>::to_vec);
        let search = Search::new(search_options(self.aim, seed, self.relaxes, self.is_hard));
        let given = sound.into_iter().chain(self.stabilising.iter().cloned()).collect();
        Ok(Stage::Searching(Box::new(search.beginning_with(given))))
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

/// Index of the tracking specification, if there is one.
fn tracks(problem: &DesignProblem) -> Option<usize> {
    problem.specifications.iter().position(|one| matches!(one.requirement, Requirement::Tracking { .. }))
}
