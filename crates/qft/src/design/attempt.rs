//! One structure on its way to a design: a search, the fit of a prefilter, a descent with both, an audit, and the descent again with what
//! the audit found.

use phea_dynamics::linear::{LinearError, TransferFunction};

use super::counterexample::{counterexamples, worst_margin_db};
use super::problem::{DesignOptions, DesignProblem, Objective, PrefilterChoice};
use super::result::DesignRound;
use crate::audit::AuditRun;
use crate::closed_loop::Compensation;
use crate::loop_shaping::{
    Aim, Descent, DescentOptions, Samples, SamplesError, Search, SearchOptions, SearchProblem, SearchStatus,
    Shaping, Structure,
};
use crate::prefilter::{
    FittedPrefilter, PrefilterBand, PrefilterError, PrefilterOptions, PrefilterOutcome, PrefilterRun,
};
use crate::specification::Requirement;
use crate::verification::{Audit, TrackingJudgement, Verdict};

/// Below this worst margin of the samples a structure counts as unable to meet the specifications, dB.
pub(super) const FEASIBLE_DB: f64 = -5e-4;
/// A relaxation is found to this, dB.
const RELAXATION_TOLERANCE_DB: f64 = 0.005;
/// Audits of one structure at most.
const ROUNDS_MAXIMUM: usize = 40;
/// How far inside its limits a search stays, dB: what the audit finds between the samples then still meets them.
const RESERVE_DB: f64 = 0.001;

/// Why a step of the design cannot be made at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// A part is no transfer function, or cannot be sampled.
    #[error("{0}")]
    Linear(#[from] LinearError),
    /// The plants cannot be looked at.
    #[error("{0}")]
    Samples(#[from] SamplesError),
    /// There is no band for a prefilter.
    #[error("{0}")]
    Prefilter(#[from] PrefilterError),
}

/// What an attempt ended with.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Ending {
    /// The audit finds every specification met.
    Met(Box<Audit>),
    /// With this worst margin over rate at best, dB; audited where that was asked for.
    Missed { worst_margin_db: f64, audit: Option<Box<Audit>> },
    /// No stable controller of the structure was found.
    NotStabilised,
    /// Search and audit did not come to agree.
    NotConverged(Box<Audit>),
}

#[derive(Clone, Debug)]
enum Stage {
    Searching(Box<Search>),
    Fitting(Box<PrefilterRun>),
    Descending(Box<Descent>),
    Auditing(Box<AuditRun>),
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
    /// Order of the prefilter that is fitted next.
    prefilter_order: usize,
    restarts: u64,
    x: Vec<f64>,
    stage: Stage,
    rounds: Vec<DesignRound>,
}

impl Attempt {
    /// An attempt that has not begun, with points to begin with. With `relaxes` it looks for the smallest common relaxation.
    pub(super) fn new(
        structure: Structure,
        mut samples: Samples,
        options: &DesignOptions,
        relaxes: bool,
        beginning: Vec<Vec<f64>>,
    ) -> Result<Attempt, DesignError> {
        samples.keep_in_reserve(if relaxes { 0.0 } else { RESERVE_DB });
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
        let search = Search::new(search_options(aim, options.seed, relaxes)).beginning_with(beginning);
        Ok(Attempt {
            shaping: Shaping::new(structure.clone(), given, options.objective, samples)?,
            structure,
            options: options.clone(),
            aim,
            relaxes,
            prefilter_order: 2,
            restarts: 0,
            x: vec![],
            stage: Stage::Searching(Box::new(search)),
            rounds: vec![],
        })
    }

    /// Does a small part of the work; whether there is more to do.
    pub(super) fn step(&mut self) -> Result<bool, DesignError> {
        let goes_on = match &mut self.stage {
            Stage::Searching(search) => search.step(&mut self.shaping),
            Stage::Fitting(run) => run.step(),
            Stage::Descending(descent) => descent.step(&mut self.shaping),
            Stage::Auditing(run) => run.step(),
            Stage::Ended(_) => return Ok(false),
        };
        if !goes_on {
            self.stage = match &self.stage {
                Stage::Searching(_) => self.after_search()?,
                Stage::Fitting(_) => self.after_fit()?,
                Stage::Descending(_) => self.after_descent()?,
                Stage::Auditing(_) => self.after_audit()?,
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
            Stage::Auditing(_) | Stage::Ended(_) => "auditing",
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

    fn after_search(&mut self) -> Result<Stage, DesignError> {
        let Stage::Searching(search) = &self.stage else { return Ok(Stage::Ended(Ending::NotStabilised)) };
        let Some(result) = search.result() else { return Ok(Stage::Ended(Ending::NotStabilised)) };
        if matches!(result.status, SearchStatus::NotStabilised { .. }) {
            return Ok(Stage::Ended(Ending::NotStabilised));
        }
        self.x = result.x;
        let worst_margin_db = result.judgement.worst_margin_db;
        if worst_margin_db < FEASIBLE_DB && !self.relaxes {
            return Ok(Stage::Ended(Ending::Missed { worst_margin_db, audit: None }));
        }
        self.fit_or(Self::audit)
    }

    /// Fits a prefilter to the loop as it is, or goes on where none is looked for.
    fn fit_or(&mut self, go_on: fn(&Self) -> Result<Stage, DesignError>) -> Result<Stage, DesignError> {
        let problem = self.shaping.samples().problem();
        let (PrefilterChoice::Grow { maximum_order }, Some(tracking)) =
            (&self.options.prefilter, tracks(problem))
        else {
            return go_on(self);
        };
        let specification = &problem.specifications[tracking];
        let samples = self.shaping.samples();
        let band = PrefilterBand::of_family(
            &self.compensation()?,
            samples.members(),
            &samples.grid_frequencies_rad_per_s(),
            specification,
        )?;
        let order = self.prefilter_order.min(*maximum_order);
        // what the band lacks the descent that follows will find: only a start is wanted here
        let band = band.relaxed(BAND_ROOM_DB);
        let options = PrefilterOptions::new(order, self.options.seed);
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
        Ok(self.descend())
    }

    fn descend(&self) -> Stage {
        let options = DescentOptions { reserve_db: 0.0, ..DescentOptions::new(self.aim) };
        Stage::Descending(Box::new(Descent::new(&self.x, options)))
    }

    fn after_descent(&mut self) -> Result<Stage, DesignError> {
        let Stage::Descending(descent) = &self.stage else { return self.audit() };
        self.x = descent.x().to_vec();
        let Some(judgement) = descent.judgement().filter(|judgement| judgement.stable) else {
            return Ok(Stage::Ended(Ending::NotStabilised));
        };
        let worst_margin_db = judgement.worst_margin_db;
        if worst_margin_db >= FEASIBLE_DB || self.relaxes {
            return self.audit();
        }
        let missed = |_: &Self| Ok(Stage::Ended(Ending::Missed { worst_margin_db, audit: None }));
        match self.options.prefilter {
            PrefilterChoice::Grow { maximum_order } if self.prefilter_order < maximum_order => {
                self.prefilter_order += 1;
                let samples = self.shaping.samples().clone();
                self.x.truncate(self.structure.dimension());
                self.shaping = Shaping::new(self.structure.clone(), None, self.options.objective, samples)?;
                self.fit_or(Self::audit)
            }
            _ => missed(self),
        }
    }

    fn compensation(&self) -> Result<Compensation, DesignError> {
        let problem = self.shaping.samples().problem();
        Ok(Compensation::new(&self.shaping.controller(&self.x), problem.sensor.clone())?)
    }

    fn audit(&self) -> Result<Stage, DesignError> {
        let problem = self.shaping.samples().problem();
        let run = AuditRun::new(
            &problem.family,
            &self.compensation()?,
            &problem.specifications,
            self.shaping.tracking(),
            self.options.tolerance_db,
        );
        Ok(Stage::Auditing(Box::new(run)))
    }

    fn after_audit(&mut self) -> Result<Stage, DesignError> {
        let Stage::Auditing(run) = &self.stage else { return self.audit() };
        let audit = Box::new(run.audit());
        let judgement = self.shaping.judge(&self.x);
        self.note(&audit, judgement.worst_margin_db, judgement.objective_db);
        if audit.verdict == Verdict::Met {
            return Ok(Stage::Ended(Ending::Met(audit)));
        }
        // under a relaxation only what is worse than all that was looked at is new
        let worst_margin_db = judgement.worst_margin_db;
        let tolerance = if self.relaxes {
            RELAXATION_TOLERANCE_DB - worst_margin_db.min(0.0)
        } else {
            0.5 * self.options.tolerance_db
        };
        let mut news = false;
        for example in counterexamples(&audit, tolerance, self.shaping.tracking()) {
            let at = example.frequency_rad_per_s.unwrap_or_else(|| self.lowest_frequency());
            news |= self.shaping.add(&example.plants, at)?;
        }
        let rounds = self.rounds.len();
        if !news || rounds >= ROUNDS_MAXIMUM {
            return Ok(Stage::Ended(if self.relaxes {
                Ending::Missed { worst_margin_db, audit: Some(audit) }
            } else {
                Ending::NotConverged(audit)
            }));
        }
        if self.shaping.judge(&self.x).stable { Ok(self.descend()) } else { self.search_anew() }
    }

    /// A plant that was added is unstable with what was found, so that margins lead nowhere from there: begins again among all plants that are
    /// known now.
    fn search_anew(&mut self) -> Result<Stage, DesignError> {
        self.restarts += 1;
        self.x.truncate(self.structure.dimension());
        if self.prefilter_is_fitted() {
            let samples = self.shaping.samples().clone();
            self.shaping = Shaping::new(self.structure.clone(), None, self.options.objective, samples)?;
        }
        let seed = self.options.seed.wrapping_add(self.restarts);
        Ok(Stage::Searching(Box::new(Search::new(search_options(self.aim, seed, self.relaxes)))))
    }

    fn prefilter_is_fitted(&self) -> bool {
        self.shaping.tracking() == TrackingJudgement::Magnitude
            && matches!(self.options.prefilter, PrefilterChoice::Grow { .. })
    }

    fn lowest_frequency(&self) -> f64 {
        self.shaping.samples().frequencies_rad_per_s().first().copied().unwrap_or(1.0)
    }

    fn note(&mut self, audit: &Audit, searched_margin_db: f64, objective_db: f64) {
        let samples = self.shaping.samples();
        self.rounds.push(DesignRound {
            structure: self.structure.clone(),
            objective_db,
            plants: samples.plants().len(),
            frequencies: samples.frequencies_rad_per_s().len(),
            searched_margin_db,
            audited_margin_db: worst_margin_db(audit),
        });
    }
}

/// Room that a start of a prefilter may take from both edges of its band, dB.
const BAND_ROOM_DB: f64 = 3.0;

/// Index of the tracking specification, if there is one.
pub(super) fn tracks(problem: &DesignProblem) -> Option<usize> {
    problem.specifications.iter().position(|one| matches!(one.requirement, Requirement::Tracking { .. }))
}

/// A search for feasibility needs many starts; one for a relaxation more of them to their end, for the answer is a number.
fn search_options(aim: Aim, seed: u64, relaxes: bool) -> SearchOptions {
    let descent = DescentOptions { reserve_db: 0.0, ..DescentOptions::new(aim) };
    let (starts, finished) = if relaxes { (12, 6) } else { (8, 3) };
    SearchOptions { starts, finished, descent, ..SearchOptions::new(aim, seed) }
}
