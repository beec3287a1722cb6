//! The chapter on proofs: for both controllers, with the assumptions of the model.

use phea_engineering::audit::ProjectAudit;
use phea_engineering::design::DESIGNED_CERTIFICATE;

use super::assumptions::assumptions;
use super::chapter::Chapter;
use super::judged::Judged;
use crate::audit::{CERTIFICATE_FILE, proven};
use crate::document::Document;
use crate::project::Project;

/// The chapter; `None` if there is no controller.
pub(super) fn chapter(project: &Project, judged: &Judged) -> Option<Chapter> {
    let designed = judged.found().map(|found| &found.designed.view);
    let sides = [
        (judged.given.as_ref(), "The given controller", CERTIFICATE_FILE),
        (designed, "The designed controller", DESIGNED_CERTIFICATE),
    ];
    if sides.iter().all(|(view, ..)| view.is_none_or(|view| view.proof.is_none())) {
        return None;
    }
    let mut out = Document::default();
    out.explanation("What is proven here is a theorem about the linear model, for every plant of the declared box and every frequency of the band, between them too. A closed loop over its limit is at least the first number, which a plant of the box reaches at some frequency, and at most the second; the limit is satisfied where that is 0 dB, up to the tolerance.");
    for (view, title, file) in sides {
        let Some(view) = view else { continue };
        out.append(proven(view, title));
        out.explanations(certified(view, file));
    }
    out.heading("What the theorem assumes");
    out.sentences(assumptions(project));
    Some(Chapter::of("proven", "What is proven", out))
}

/// File of the proof's certificate, and its contents.
fn certified(view: &ProjectAudit, file: &str) -> Option<String> {
    let certificate = view.proof.as_ref()?.certificate.as_ref()?;
    Some(format!(
        "`{file}` has {} claims with {} boxes of plants and frequencies; `phea check-certificate` checks each of them again.",
        certificate.claims.len(),
        certificate.leaves()
    ))
}
