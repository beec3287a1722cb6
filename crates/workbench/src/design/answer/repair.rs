//! The key `repair` of the answer.

use super::{audited, conflicts, round};
use crate::answer::{Describe, Object};
use crate::audit;
use crate::design::repair::{repair_key, repair_sentences};
use crate::design::{ProjectDesign, Repair, RepairStatus};
use crate::trial;

/// `taken_in` is the machine whose plant was taken in; `plant_before` and `plant_after` are that
/// plant within the loop of the first design and within the one that was found; `before` is the
/// first design, where another one took its place; `nearest` the controller that comes nearest,
/// where none does, with the rounds of its search: those of the first design come before them, as
/// they do in `rounds` where it is met; `family_with_waves` the controller that was found with the
/// waves in every plant of the family.
pub(super) fn row(view: &ProjectDesign, repair: &Repair) -> Object {
    let relaxation_db = match repair.status {
        RepairStatus::Infeasible { relaxation_db } => Some(relaxation_db),
        _ => None,
    };
    let no_plant = "no linear plant is known that does what the nonlinear simulation does";
    let nearest = repair.nearest();
    let before = repair.other.as_deref().filter(|_| repair.status == RepairStatus::Met);
    let rounds = nearest.map(|design| design.design.rounds.iter().map(round).collect::<Vec<_>>());
    Object::new()
        .with("status", repair_key(repair.status))
        .known(
            "taken_in",
            repair.taken_in.as_ref().map(|(machine, size)| trial::name_of(machine, *size)),
            no_plant,
        )
        .known("quarter_wave_rad_per_s", repair.quarter_wave_rad_per_s, "no waves were looked at")
        .known("relaxation_db", relaxation_db, "the repair was not found infeasible")
        .with("conflicts", nearest.map_or_else(Vec::new, conflicts))
        .maybe("plant_before", repair.before.as_ref().map(|view| audit::body(view).into_json()))
        .maybe("plant_after", repair.after.as_ref().map(|view| audit::body(view).into_json()))
        .maybe("before", before.map(|design| audited(&design.designed)))
        .maybe("nearest", nearest.map(|design| audited(&design.designed)))
        .maybe(
            "nearest_machine",
            nearest.and_then(|design| design.trial.as_ref()).map(|trial| trial::body(trial).into_json()),
        )
        .maybe("nearest_rounds", rounds)
        .maybe("family_with_waves", repair.whole.as_ref().map(|view| audit::body(view).into_json()))
        .with("sentences", repair_sentences(view, repair).as_slice())
}
