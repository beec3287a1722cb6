//! Proof of a design: if it refutes a specification that the search found to be met, the refuting
//! plants are added and the design continues.

use phea_dynamics::uncertain_plant::UncertainPlant;
use phea_dynamics::watch::Watch;
use phea_qft::design::{DesignOptions, design_again};
use phea_qft::family::Family;
use phea_qft::proof::ClaimStatus;
use phea_qft::verification::{PlantPoint, Verdict};

use super::{AuditedController, DesignError, DesignRun, ProjectDesign};
use crate::audit::prove_claims;
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// Largest number of continuations of a design with refuting plants.
const REFUTATIONS_MAXIMUM: usize = 4;

/// The design with its audit and the proof; `None` if nothing was found, or after cancellation by
/// `watch`.
pub(super) fn proven(
    (setup, given): (&Setup<'_>, &RobustProblem),
    mut run: DesignRun,
    options: &DesignOptions,
    watch: Watch<'_>,
) -> Result<(DesignRun, Option<ProjectDesign>), DesignError> {
    for round in 0..=REFUTATIONS_MAXIMUM {
        let Some(design) = run.outcome.design.clone().filter(|_| !run.outcome.stopped) else { break };
        let was_met = design.audit.verdict == Verdict::Met;
        let mut project_design =
            ProjectDesign::new(setup, given, &run.problem, design, options.clone(), watch)?;
        prove_claims(&project_design.designed.problem, &mut project_design.designed.view, watch)?;
        let refuting = if was_met { refuting(&project_design.designed) } else { vec![] };
        if refuting.is_empty() || round == REFUTATIONS_MAXIMUM {
            return Ok((run, Some(project_design)));
        }
        run.problem.additional_plants.extend(refuting);
        run.outcome = design_again(&run.problem, options, run.outcome, watch)?;
        run.outcome.conclude()?;
    }
    Ok((run, None))
}

/// Plants that refute a specification that the search found to be met.
fn refuting(designed: &AuditedController) -> Vec<UncertainPlant> {
    let Family::Uncertain(family) = &designed.problem.family else { return vec![] };
    let proofs = designed.view.proof.iter().flat_map(|proof| &proof.specifications);
    let refuted = proofs.filter(|own| own.claim_status == ClaimStatus::Refuted);
    let points = refuted.filter_map(|own| match &own.worst.as_ref()?.plant {
        PlantPoint::Parameters(values) => Some(family.plant().with_nominal(values)),
        PlantPoint::Measured(_) | PlantPoint::Additional(_) => None,
    });
    points.collect()
}
