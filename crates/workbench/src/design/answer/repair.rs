//! The key `repair` of the answer.

use serde::Serialize;

use super::{LimitRow, PublishedRow, RoundRow, conflict, published, round};
use crate::answer::Number;
use crate::audit;
use crate::design::repair_key;
use crate::design::{ProjectDesign, Repair, RepairStatus};
use crate::trial;
use phea_qft::design::DesignStatus;

#[derive(Serialize)]
pub(super) struct RepairRow<'a> {
    status: &'static str,
    /// The machine whose plant was taken in.
    taken_in: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    taken_in_reason: Option<&'static str>,
    quarter_wave_rad_per_s: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    quarter_wave_rad_per_s_reason: Option<&'static str>,
    relaxation_db: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    relaxation_db_reason: Option<&'static str>,
    conflicts: Vec<LimitRow>,
    /// The plant that was taken in within the loop of the first design, and within the one that was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    plant_before: Option<audit::VerifyAnswer<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plant_after: Option<audit::VerifyAnswer<'a>>,
    /// The first design, where another one took its place.
    #[serde(skip_serializing_if = "Option::is_none")]
    before: Option<PublishedRow<'a>>,
    /// The controller that comes nearest, where none does.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest: Option<PublishedRow<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_machine: Option<trial::TrialAnswer<'a>>,
    /// Of the search for the nearest controller; those of the first design come before them, as they do in `rounds` where it is met.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_rounds: Option<Vec<RoundRow>>,
    /// The controller that was found with the waves in every plant of the family.
    #[serde(skip_serializing_if = "Option::is_none")]
    family_with_waves: Option<audit::VerifyAnswer<'a>>,
    sentences: &'a [String],
}

pub(super) fn row(repair: &Repair) -> RepairRow<'_> {
    let relaxation_db = match repair.status {
        RepairStatus::Infeasible { relaxation_db } => Some(relaxation_db),
        _ => None,
    };
    let taken_in = repair.taken_in.as_deref();
    let quarter = repair.quarter_wave_rad_per_s;
    let nearest = repair.nearest();
    let before = repair.other.as_deref().filter(|_| repair.status == RepairStatus::Met);
    RepairRow {
        status: repair_key(repair),
        taken_in,
        taken_in_reason: taken_in
            .is_none()
            .then_some("no linear plant is known that does what the machine does"),
        quarter_wave_rad_per_s: quarter.map(Number),
        quarter_wave_rad_per_s_reason: quarter.is_none().then_some("no waves were looked at"),
        relaxation_db,
        relaxation_db_reason: relaxation_db.is_none().then_some("the repair was not found infeasible"),
        conflicts: nearest.map_or_else(Vec::new, conflicts),
        plant_before: repair.before.as_ref().map(audit::body),
        plant_after: repair.after.as_ref().map(audit::body),
        before: before.map(|design| published(&design.designed)),
        nearest: nearest.map(|design| published(&design.designed)),
        nearest_machine: nearest.and_then(|design| design.trial.as_ref()).map(trial::body),
        nearest_rounds: nearest.map(|design| design.design.rounds.iter().map(round).collect()),
        family_with_waves: repair.whole.as_ref().map(audit::body),
        sentences: &repair.sentences,
    }
}

/// What stands against one another where the nearest controller can do no better.
fn conflicts(nearest: &ProjectDesign) -> Vec<LimitRow> {
    match &nearest.design.status {
        DesignStatus::Infeasible(relaxation) => {
            relaxation.conflicts.iter().map(|one| conflict(nearest, one)).collect()
        }
        _ => vec![],
    }
}
