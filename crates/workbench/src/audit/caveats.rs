//! Effects that the verdict of an audit does not include, in sentences.

use super::{ProjectAudit, RigInLoop, RigOutside};

/// The rig itself where the family does not contain it, then the effects that are declared.
pub fn caveats(view: &ProjectAudit) -> Vec<String> {
    let of_rig = view.rig_outside.iter().map(|rig| rig_outside(view, rig));
    of_rig.chain(view.caveats.iter().map(|caveat| caveat.sentence.clone())).collect()
}

fn rig_outside(view: &ProjectAudit, rig: &RigOutside) -> String {
    let does = match &rig.in_loop {
        RigInLoop::Met => "the loop with it is stable and satisfies every specification".to_string(),
        RigInLoop::Unstable => "the loop with it is unstable".to_string(),
        RigInLoop::Violates(violated) => {
            let violated: Vec<String> =
                violated.iter().map(|index| format!("{} {}", index + 1, view.name_of(*index))).collect();
            format!("the loop with it violates {}", violated.join(", "))
        }
        RigInLoop::NotProven => "nothing is proven of the loop with it".to_string(),
    };
    format!("the family does not contain the rig as it is derived ({}): {does}", rig.beyond)
}
