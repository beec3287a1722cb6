//! The audits of an attempt: of each plant beside its family by itself, then of the family, which takes longer.

use phea_dynamics::linear::LinearError;
use phea_dynamics::watch::unwatched;

use super::{Attempt, DesignError, Ending, Stage};
use crate::audit::audit_with;
use crate::design::counterexample::{
    Counterexample, audited_margin_db, counterexamples, of_beside, too_little_delay, unstable_plant,
    worst_over_rate_db,
};
use crate::family::{Family, UncertainFamily};
use crate::loop_shaping::{Aim, Judgement};
use crate::sampled::SampledPlants;
use crate::verification::{Audit, AuditProblem, Verdict};

/// A relaxation is found to this, dB.
const RELAXATION_TOLERANCE_DB: f64 = 0.005;

impl Attempt {
    /// The audits of the plants beside the family, once it has ended with an audit.
    pub(in crate::design) fn beside(&self) -> &[Audit] {
        &self.beside
    }

    /// The audit of the next plant beside the family, or of the family after the last of them.
    pub(super) fn audit(&mut self) -> Result<Stage, DesignError> {
        match self.beside.len() < self.shaping.samples().problem().beside.len() {
            true => Ok(Stage::Beside),
            false => Ok(Stage::Auditing),
        }
    }

    fn audit_of(&self, family: &Family, sampled: &SampledPlants) -> Result<Audit, DesignError> {
        let problem = AuditProblem {
            family,
            compensation: &self.compensation()?,
            specifications: &self.shaping.samples().problem().specifications,
            tracking: self.shaping.tracking(),
            tolerance_db: self.options.tolerance_db,
        };
        audit_with(&problem, sampled, &mut unwatched).map_err(|_| LinearError::ZeroPolynomial.into())
    }

    pub(super) fn after_beside(&mut self) -> Result<Stage, DesignError> {
        let problem = self.shaping.samples().problem();
        let Some(plant) = problem.beside.get(self.beside.len()) else { return self.audit() };
        let alone = Family::Uncertain(UncertainFamily::of_nominal(plant.clone()));
        let audit = self.audit_of(&alone, &SampledPlants::default())?;
        let judgement = self.judgement();
        let examples = of_beside(self.beside.len(), self.examples(&audit, &judgement));
        if !examples.is_empty() && !self.audits_only {
            self.note(audited_margin_db(&audit), &judgement);
            if let Some(next) = self.with(&examples)? {
                return Ok(next);
            }
        }
        self.beside.push(audit);
        self.audit()
    }

    pub(super) fn after_audit(&mut self) -> Result<Stage, DesignError> {
        let audit = Box::new(self.audit_of(&self.shaping.samples().problem().family, &self.sampled)?);
        if self.audits_only {
            return Ok(Stage::Ended(Ending::Hopeless(audit)));
        }
        let judgement = self.judgement();
        self.note(audited_margin_db(&audit), &judgement);
        let all = || self.beside.iter().chain([&*audit]);
        let problem = self.shaping.samples().problem();
        let is_met = |one: &Audit| one.verdict == Verdict::Met && too_little_delay(one, problem).is_empty();
        if all().all(is_met) {
            return Ok(Stage::Ended(Ending::Met(audit)));
        }
        let stable = all().all(|one| one.stability.verdict == Verdict::Met);
        let over_rate = |one: &Audit| worst_over_rate_db(&one.specifications, self.shaping.tracking());
        let audited_db = all().map(over_rate).fold(f64::INFINITY, f64::min);
        let examples = self.examples(&audit, &judgement);
        Ok(self.with(&examples)?.unwrap_or(Stage::Ended(if self.relaxes && stable {
            Ending::Missed { worst_margin_db: judgement.worst_margin_db.min(audited_db), audit: Some(audit) }
        } else {
            Ending::NotConverged(audit)
        })))
    }

    /// What an audit teaches the search.
    fn examples(&self, audit: &Audit, judgement: &Judgement) -> Vec<Counterexample> {
        let mut examples = unstable_plant(audit);
        examples.extend(too_little_delay(audit, self.shaping.samples().problem()));
        let tolerance_db = self.new_below_db(judgement);
        examples.extend(counterexamples(&audit.specifications, tolerance_db, self.shaping.tracking()));
        examples
    }

    /// An attempt that found nothing stable, whose nearest controller is audited all the same.
    pub(in crate::design) fn audited_as_it_is(mut self) -> Result<Attempt, DesignError> {
        self.audits_only = true;
        self.beside.clear();
        self.stage = self.audit()?;
        Ok(self)
    }

    /// Margins below minus these are new, of single limits and of tracking: where the worst margin itself is looked for, what is worse than all
    /// that was looked at. Limits of tracking may meet, and a margin to them counts by its share of the room: a negative one is new.
    pub(super) fn new_below_db(&self, judgement: &Judgement) -> [f64; 2] {
        let worst_db = judgement.worst_margin_db;
        let ordinary = 0.5 * self.options.tolerance_db;
        match self.aim {
            Aim::WorstMargin if self.relaxes => [RELAXATION_TOLERANCE_DB - worst_db.min(0.0); 2],
            Aim::WorstMargin => [ordinary.min(RELAXATION_TOLERANCE_DB - worst_db), ordinary],
            Aim::Objective => [ordinary; 2],
        }
    }
}
