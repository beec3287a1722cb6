//! The key `repair` of the answer of a design.

use phea_engineering::design::RepairStatus;

use super::binding::{BindingLimitAnswer, conflicts};
use super::rounds::{DesignRoundAnswer, rounds};
use super::side::{AuditedControllerAnswer, audited};
use crate::answer::{Answer, OrReason, words};
use crate::audit::{self, AuditAnswer};
use crate::design::repair::repair_sentences;
use crate::design::{ProjectDesign, Repair};
use crate::trial::{self, TrialAnswer};

/// Repair of a design that the nonlinear machine contradicts: the plant of that machine is added
/// to the family, and the search continues.
#[derive(Answer)]
pub(super) struct RepairAnswer {
    /// Outcome of the repair.
    status: RepairStatus,
    /// Name of the run of the machine whose plant was added.
    added_plant: OrReason<String>,
    /// Frequency at which the slower line of this machine is a quarter of a wave long.
    quarter_wave_rad_per_s: OrReason<f64>,
    /// Amount by which every limit must be relaxed for a controller to satisfy it.
    relaxation_db: OrReason<f64>,
    /// Limits that conflict at this relaxation.
    conflicts: Vec<BindingLimitAnswer>,
    /// Audit of the first design with the added plant, only if such a plant is known.
    #[answer(optional)]
    plant_before: Option<AuditAnswer>,
    /// Audit of the controller that was found with the added plant, only if one was found.
    #[answer(optional)]
    plant_after: Option<AuditAnswer>,
    /// First design, only if the repair replaced it.
    #[answer(optional)]
    before: Option<AuditedControllerAnswer>,
    /// Controller that comes nearest, only if none satisfies every specification.
    #[answer(optional)]
    nearest: Option<AuditedControllerAnswer>,
    /// Trial of the nearest controller on the nonlinear machine.
    #[answer(optional)]
    nearest_machine: Option<TrialAnswer>,
    /// Rounds of the search for the nearest controller, those of the first design first.
    #[answer(optional)]
    nearest_rounds: Option<Vec<DesignRoundAnswer>>,
    /// Audit of the controller that was found with waves in every plant of the family, only if it
    /// is known.
    #[answer(optional)]
    family_with_waves: Option<AuditAnswer>,
    /// Steps of the repair, and the limits of what it can achieve, in sentences.
    sentences: Vec<String>,
}

words! {
    /// Outcome of a repair.
    RepairStatus {
        Met => "met",
        Infeasible { .. } => "infeasible",
        NotConverged => "not_converged",
        NotStabilised => "not_stabilised",
        Stopped => "stopped",
        NothingToAdd => "nothing_to_add",
    }
}

/// A repair.
pub(super) fn answer(view: &ProjectDesign, repair: &Repair) -> RepairAnswer {
    let relaxation_db = match repair.status {
        RepairStatus::Infeasible { relaxation_db } => Some(relaxation_db),
        _ => None,
    };
    let added_plant = repair.added_plant.as_ref().map(|(machine, size)| trial::name_of(machine, *size));
    let nearest = repair.nearest();
    let before = repair.other.as_deref().filter(|_| repair.status == RepairStatus::Met);
    RepairAnswer {
        status: repair.status,
        added_plant: OrReason::new(
            added_plant,
            "no linear plant is known that does what the nonlinear simulation does",
        ),
        quarter_wave_rad_per_s: OrReason::new(repair.quarter_wave_rad_per_s, "no waves were looked at"),
        relaxation_db: OrReason::new(relaxation_db, "the repair was not found infeasible"),
        conflicts: nearest.map_or_else(Vec::new, conflicts),
        plant_before: repair.before.as_ref().map(audit::body),
        plant_after: repair.after.as_ref().map(audit::body),
        before: before.map(|design| audited(&design.designed)),
        nearest: nearest.map(|design| audited(&design.designed)),
        nearest_machine: nearest.and_then(|design| design.trial.as_ref()).map(trial::body),
        nearest_rounds: nearest.map(|design| rounds(&design.design)),
        family_with_waves: repair.whole.as_ref().map(audit::body),
        sentences: repair_sentences(view, repair),
    }
}
