//! The audits of an attempt: first of each additional plant separately, then of the family, which
//! takes longer.

use phea_dynamics::watch::{Watch, part};

use super::{AUDITING, Attempt, AttemptEnding, LoopDesignError, WHOLE};
use crate::audit::audit_with;
use crate::design::counterexample::{
    Counterexample, NewMargins, audited_margin_db, counterexamples, of_additional, too_little_delay,
    unstable_plant, worst_over_rate_db,
};
use crate::family::{Family, UncertainFamily};
use crate::loop_shaping::{Aim, Judgement};
use crate::plant_cache::PlantCache;
use crate::verification::{Audit, AuditEffort, AuditProblem, Verdict};

/// Accuracy to which a relaxation is found, dB.
const RELAXATION_TOLERANCE_DB: f64 = 0.005;

/// Distance beyond the threshold for new margins that ends an audit, dB.
const CLEARLY_DB: f64 = 0.05;

impl Attempt {
    /// The audits of the additional plants, once the attempt has ended with an audit.
    pub(in crate::design) fn additional_audits(&self) -> &[Audit] {
        &self.additional_audits
    }

    fn audit_of(
        &self,
        family: &Family,
        (cache, effort): (&PlantCache, AuditEffort),
        watch: Watch<'_>,
    ) -> Result<(Audit, bool), LoopDesignError> {
        let problem = AuditProblem {
            family,
            compensation: &self.compensation()?,
            specifications: &self.shaping.samples().problem().specifications,
            tracking: self.shaping.tracking(),
            tolerance_db: self.options.tolerance_db,
        };
        Ok(audit_with(&problem, (cache, effort), &mut part(watch, AUDITING, WHOLE))?)
    }

    /// The audit of the family, and true if it is complete.
    fn audit_of_family(
        &self,
        cache: &PlantCache,
        effort: AuditEffort,
        watch: Watch<'_>,
    ) -> Result<(Audit, bool), LoopDesignError> {
        self.audit_of(&self.shaping.samples().problem().family, (cache, effort), watch)
    }

    /// The audit of the family that the attempt ends with; `None` if an audit that stops at
    /// counterexamples found some, which were added to the samples.
    fn audit_or_learn(
        &mut self,
        cache: &PlantCache,
        watch: Watch<'_>,
    ) -> Result<Option<Audit>, LoopDesignError> {
        let judgement = self.judgement();
        let until = AuditEffort::UntilBelow(self.clearly_new_db(&judgement));
        let (audit, is_complete) = self.audit_of_family(cache, until, watch)?;
        if is_complete {
            return Ok(Some(audit));
        }
        let examples = self.examples(&audit, &judgement);
        self.note(audited_margin_db(&audit), &judgement);
        if self.takes_in(&examples)? {
            return Ok(None);
        }
        Ok(Some(self.audit_of_family(cache, AuditEffort::Complete, watch)?.0))
    }

    /// The audits of the additional plants, one by one.
    fn audit_of_next(&self, watch: Watch<'_>) -> Result<Option<Audit>, LoopDesignError> {
        let plants = &self.shaping.samples().problem().additional_plants;
        let Some(plant) = plants.get(self.additional_audits.len()) else { return Ok(None) };
        let alone = Family::Uncertain(UncertainFamily::of_nominal(plant.clone()));
        let (audit, _) = self.audit_of(&alone, (&PlantCache::default(), AuditEffort::Complete), watch)?;
        Ok(Some(audit))
    }

    /// The outcome of the attempt by its audits; `None` if they found counterexamples, which were
    /// added to the samples.
    pub(super) fn audited(
        &mut self,
        cache: &PlantCache,
        watch: Watch<'_>,
    ) -> Result<Option<AttemptEnding>, LoopDesignError> {
        self.additional_audits.clear();
        while let Some(audit) = self.audit_of_next(watch)? {
            let judgement = self.judgement();
            let examples = of_additional(self.additional_audits.len(), self.examples(&audit, &judgement));
            if !examples.is_empty() {
                self.note(audited_margin_db(&audit), &judgement);
                if self.takes_in(&examples)? {
                    return Ok(None);
                }
            }
            self.additional_audits.push(audit);
        }
        let Some(audit) = self.audit_or_learn(cache, watch)?.map(Box::new) else { return Ok(None) };
        let judgement = self.judgement();
        self.note(audited_margin_db(&audit), &judgement);
        let all = || self.additional_audits.iter().chain([&*audit]);
        let problem = self.shaping.samples().problem();
        let is_met =
            |one: &Audit| one.verdict == Verdict::Met && too_little_delay(one, problem, 0.0).is_empty();
        if all().all(is_met) {
            let misses = self.misses_reserve(&audit, &judgement)?;
            return Ok((!misses).then_some(AttemptEnding::Met(audit)));
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

    /// True if a loop that satisfies its limits misses the reserve at plants that were not among
    /// the samples; these plants are added.
    fn misses_reserve(&mut self, audit: &Audit, judgement: &Judgement) -> Result<bool, LoopDesignError> {
        if self.relaxes || self.options.reserve_db <= 0.0 {
            return Ok(false);
        }
        let examples = self.examples(audit, judgement);
        self.takes_in(&examples)
    }

    /// The audit of an unfinished attempt, or of one that ended without a stable loop.
    pub(in crate::design) fn audited_as_it_is(
        &mut self,
        cache: &PlantCache,
        watch: Watch<'_>,
    ) -> Result<Audit, LoopDesignError> {
        self.additional_audits.clear();
        while let Some(audit) = self.audit_of_next(watch)? {
            self.additional_audits.push(audit);
        }
        Ok(self.audit_of_family(cache, AuditEffort::Complete, watch)?.0)
    }

    /// Counterexamples of an audit for the search.
    fn examples(&self, audit: &Audit, judgement: &Judgement) -> Vec<Counterexample> {
        let mut examples = unstable_plant(audit);
        let relaxation_db = if self.relaxes { -judgement.worst_margin_db } else { 0.0 };
        examples.extend(too_little_delay(audit, self.shaping.samples().problem(), relaxation_db));
        let new = self.new_margins(judgement);
        examples.extend(counterexamples(&audit.specifications, new, self.shaping.tracking()));
        examples
    }

    /// Thresholds of new margins, for single limits and for tracking: margins that miss the
    /// reserve, and that are worse than all evaluated ones if the search accepted less, or
    /// maximised the worst margin itself. The two tracking limits may meet, and a margin to them
    /// counts as a fraction of the distance between them: a negative one is new.
    pub(super) fn new_margins(&self, judgement: &Judgement) -> NewMargins {
        let worst_db = judgement.worst_margin_db;
        let ordinary = 0.5 * self.options.tolerance_db;
        let below_db = match self.aim {
            Aim::WorstMargin if self.relaxes => [RELAXATION_TOLERANCE_DB - worst_db.min(0.0); 2],
            Aim::WorstMargin => [ordinary.min(RELAXATION_TOLERANCE_DB - worst_db), ordinary],
            Aim::Objective => {
                // a search that ends within the tolerance does not receive the same margin again
                let missed = (RELAXATION_TOLERANCE_DB - worst_db).min(self.options.tolerance_db);
                [ordinary.max(missed); 2]
            }
        };
        let reserve_db = if self.relaxes { 0.0 } else { self.options.reserve_db };
        NewMargins { below_db, reserve_db }
    }

    /// A margin so clearly new, even for two limits that count twice, that no worse one need be
    /// searched for before the next descent, dB.
    fn clearly_new_db(&self, judgement: &Judgement) -> f64 {
        let NewMargins { below_db: [single, tracking], .. } = self.new_margins(judgement);
        -2.0 * single.max(tracking) - CLEARLY_DB
    }
}
