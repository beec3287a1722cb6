//! The chapter on the alternatives of the project: one table, the findings, and their curves laid
//! over each other.

use super::chapter::Chapter;
use crate::alternatives::{PrintedAlternatives, document, figures, first_warnings};
use crate::document::Document;
use crate::project::Project;

/// The chapter; `None` for a project without alternatives. If they were not judged, the chapter
/// states how to request this.
pub(super) fn chapter(project: &Project, found: Option<&PrintedAlternatives>) -> Option<Chapter> {
    let names: Vec<&str> = project.alternatives.iter().map(|one| one.name.as_str()).collect();
    let document = match (found, names.as_slice()) {
        (None, []) => return None,
        (None, names) => {
            let mut out = Document::default();
            out.explanation(format!(
                "The project has alternatives that are not judged here: {}. `phea report --alternatives` designs a controller for each and shows them side by side, as `phea alternatives` does.",
                names.join(", ")
            ));
            out
        }
        (Some(found), _) => {
            let mut out = Document::default();
            out.explanation("Each alternative is the project with settings of its own, under a controller designed for the same specifications, driven through the same scenarios.".to_string());
            out.sentences(first_warnings(found));
            out.append(document(found));
            out.figures(figures(found));
            out
        }
    };
    Some(Chapter::of("alternatives", "Alternatives", document))
}
