//! A controller with all its results.

use phea_qft::proof::{ClaimStatus, Proof};
use phea_qft::verification::Verdict;

use super::steps::{StepProperty, steps};
use crate::audit::ProjectAudit;
use crate::design::LoopFigures;
use crate::report::campaign::CampaignStep;
use crate::report::driven::{DESIGNED, GIVEN, MachineChapter};
use crate::report::judged::Judged;
use crate::simulate::{ScenarioRun, TimeRequirement};
use crate::trial::Trial;

/// A controller.
pub(super) struct Side<'a> {
    /// Name of the controller: [`GIVEN`] or [`DESIGNED`].
    pub(super) name: &'static str,
    /// The audit of its family.
    pub(super) view: Option<&'a ProjectAudit>,
    /// The trial of the verdict on the machine.
    pub(super) trial: Option<&'a Trial>,
    /// The scenarios.
    pub(super) runs: Option<&'a [ScenarioRun]>,
    /// The steps of the reference in the campaign.
    pub(super) campaign: &'a [CampaignStep],
    /// The comparison of the controllers, if both are known.
    pub(super) figures: Option<LoopFigures>,
}

/// Given and designed controller, as far as they are known.
pub(super) fn sides<'a>(
    judged: Option<&'a Judged>,
    driven: Option<&'a MachineChapter>,
    campaign: &'a [CampaignStep],
) -> Vec<Side<'a>> {
    let found = judged.and_then(Judged::found);
    // a project that gives no controller is driven under the designed one
    let (of_given, of_designed): (&[CampaignStep], &[CampaignStep]) = match driven {
        Some(driven) if driven.runs_of(GIVEN).is_none() && found.is_some() => (&[], campaign),
        _ => (campaign, &[]),
    };
    let given = Side {
        name: GIVEN,
        view: judged.and_then(|judged| judged.given.as_ref()),
        trial: judged.and_then(|judged| judged.given_trial.as_ref()),
        runs: driven.and_then(|driven| driven.runs_of(GIVEN)),
        campaign: of_given,
        figures: found.and_then(|view| view.published.as_deref()).map(|side| side.figures),
    };
    let designed = Side {
        name: DESIGNED,
        view: found.map(|view| &view.designed.view),
        trial: found.and_then(|view| view.trial.as_ref()),
        runs: driven.and_then(|driven| driven.runs_of(DESIGNED)),
        campaign: of_designed,
        figures: found.map(|view| view.designed.figures),
    };
    [given, designed].into_iter().filter(|side| side.view.is_some() || side.runs.is_some()).collect()
}

impl Side<'_> {
    /// The proof, if one was attempted.
    pub(super) fn proof(&self) -> Option<&Proof> {
        self.view?.proof.as_ref()
    }

    /// True if every plant is proven to be stable and to satisfy every specification at every
    /// frequency; `None` if no proof was attempted.
    pub(super) fn is_proven(&self) -> Option<bool> {
        let proof = self.proof()?;
        // steps in time are searched for, and are not part of a proof
        let searched = self.view?.in_time.iter().any(|finding| finding.requirement.follows);
        let each = proof.specifications.iter().map(|own| &own.claim_status);
        Some(
            std::iter::once(&proof.stability).chain(each).all(|one| !searched && *one == ClaimStatus::Proven),
        )
    }

    /// True if every specification is met.
    pub(super) fn is_met(&self) -> bool {
        self.view.is_some_and(|view| view.verdict() == Verdict::Met)
    }

    /// True if all steps to which a requirement applies satisfy it; `None` if none can be judged.
    pub(super) fn satisfies(&self, required: &TimeRequirement) -> Option<bool> {
        let all = StepProperty::ALL.into_iter().filter_map(|property| steps(self, required, property));
        all.map(|steps| steps.all_satisfied()).reduce(|one, other| one && other)
    }

    /// Additional delay that the family tolerates, s.
    pub(super) fn delay_margin_s(&self) -> Option<f64> {
        Some(self.view?.audit.delay_margin.as_ref()?.delay_s)
    }
}
