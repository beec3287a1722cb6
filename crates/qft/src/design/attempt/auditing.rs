//! The audits of an attempt: first of each additional plant by itself, then of the family, which
//! takes longer.

use phea_dynamics::watch::{Watch, part};

use super::{AUDITING, Attempt, AttemptEnding, LoopDesignError, WHOLE};
use crate::audit::audit_with;
use crate::design::counterexample::{
    Counterexample, audited_margin_db, counterexamples, of_beside, too_little_delay, unstable_plant,
    worst_over_rate_db,
};
use crate::family::{Family, UncertainFamily};
use crate::kept_plants::KeptPlants;
use crate::loop_shaping::{Aim, Judgement};
use crate::verification::{Audit, AuditProblem, Verdict};

/// Accuracy to which a relaxation is found, dB.
const RELAXATION_TOLERANCE_DB: f64 = 0.005;

impl Attempt {
    /// The audits of the additional plants, once the attempt has ended with an audit.
    pub(in crate::design) fn beside(&self) -> &[Audit] {
        &self.beside
    }

    fn audit_of(
        &self,
        family: &Family,
        kept: &KeptPlants,
        watch: Watch<'_>,
    ) -> Result<Audit, LoopDesignError> {
        let problem = AuditProblem {
            family,
            compensation: &self.compensation()?,
            specifications: &self.shaping.samples().problem().specifications,
            tracking: self.shaping.tracking(),
            tolerance_db: self.options.tolerance_db,
        };
        Ok(audit_with(&problem, kept, &mut part(watch, AUDITING, WHOLE))?)
    }

    fn audit_of_family(&self, kept: &KeptPlants, watch: Watch<'_>) -> Result<Audit, LoopDesignError> {
        self.audit_of(&self.shaping.samples().problem().family, kept, watch)
    }

    /// The audits of the additional plants, one by one.
    fn audit_of_next(&self, watch: Watch<'_>) -> Result<Option<Audit>, LoopDesignError> {
        let beside = &self.shaping.samples().problem().beside;
        let Some(plant) = beside.get(self.beside.len()) else { return Ok(None) };
        let alone = Family::Uncertain(UncertainFamily::of_nominal(plant.clone()));
        self.audit_of(&alone, &KeptPlants::default(), watch).map(Some)
    }

    /// The outcome of the attempt by its audits; `None` where they found counterexamples, which
    /// were added to the samples.
    pub(super) fn audited(
        &mut self,
        kept: &KeptPlants,
        watch: Watch<'_>,
    ) -> Result<Option<AttemptEnding>, LoopDesignError> {
        self.beside.clear();
        while let Some(audit) = self.audit_of_next(watch)? {
            let judgement = self.judgement();
            let examples = of_beside(self.beside.len(), self.examples(&audit, &judgement));
            if !examples.is_empty() {
                self.note(audited_margin_db(&audit), &judgement);
                if self.takes_in(&examples)? {
                    return Ok(None);
                }
            }
            self.beside.push(audit);
        }
        let audit = Box::new(self.audit_of_family(kept, watch)?);
        let judgement = self.judgement();
        self.note(audited_margin_db(&audit), &judgement);
        let all = || self.beside.iter().chain([&*audit]);
        let problem = self.shaping.samples().problem();
        let is_met = |one: &Audit| one.verdict == Verdict::Met && too_little_delay(one, problem).is_empty();
        if all().all(is_met) {
            return Ok(Some(AttemptEnding::Met(audit)));
        }
        let stable = all().all(|one| one.stability.verdict == Verdict::Met);
        let over_rate = |one: &Audit| worst_over_rate_db(&one.specifications, self.shaping.tracking());
        let audited_db = all().map(over_rate).fold(f64::INFINITY, f64::min);
        let examples = self.examples(&audit, &judgement);
        if self.takes_in(&examples)? {
            return Ok(None);
        }
        let worst_margin_db = judgement.worst_margin_db.min(audited_db);
        Ok(Some(match self.relaxes && stable {
            true => AttemptEnding::Missed { worst_margin_db, audit: Some(audit) },
            false => AttemptEnding::NotConverged(audit),
        }))
    }

    /// The audit of an attempt as it stands, if it has not ended or has ended without a stable
    /// loop.
    pub(in crate::design) fn audited_as_it_is(
        &mut self,
        kept: &KeptPlants,
        watch: Watch<'_>,
    ) -> Result<Audit, LoopDesignError> {
        self.beside.clear();
        while let Some(audit) = self.audit_of_next(watch)? {
            self.beside.push(audit);
        }
        self.audit_of_family(kept, watch)
    }

    /// What an audit teaches the search.
    fn examples(&self, audit: &Audit, judgement: &Judgement) -> Vec<Counterexample> {
        let mut examples = unstable_plant(audit);
        examples.extend(too_little_delay(audit, self.shaping.samples().problem()));
        let tolerance_db = self.new_below_db(judgement);
        examples.extend(counterexamples(&audit.specifications, tolerance_db, self.shaping.tracking()));
        examples
    }

    /// Margins below minus these values count as new, for single limits and for tracking: where the
    /// worst margin itself is sought, a margin is new if it is worse than all that were evaluated.
    /// Limits of tracking may meet, and a margin to them counts by its share of the room: a
    /// negative one is new.
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
