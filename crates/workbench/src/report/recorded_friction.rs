//! The chapter on the recorded runs of the cylinder.

use phea_engineering::friction::{KnownCylinder, friction_recordings, identify_friction, recorded_runs};

use super::chapter::Chapter;
use crate::document::Document;
use crate::error::CommandError;
use crate::friction;
use crate::project::Loaded;
use crate::source::Source;
use phea_dynamics::watch::Watch;

/// Findings of the recordings of the project on the friction of its cylinder; nothing if the
/// project declares none.
pub(super) fn chapter(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<Option<Chapter>, CommandError> {
    let files = recorded_runs(&loaded.project);
    if files.is_empty() {
        return Ok(None);
    }
    let known = KnownCylinder::of(&loaded.project)?;
    let recordings = friction_recordings(source, &files, &known)?;
    let found = identify_friction(recordings, &known, watch)?;
    let mut out = Document::default();
    out.explanation("The friction of the cylinder follows from runs at constant velocities, from a force that slowly presses the piston until it breaks away, and from one that shakes it before. One set of coefficients explains all recordings that the project declares. The other chapters take the friction that `[cylinder.friction]` states, not this one: compare them.");
    friction::write(&found, &mut out);
    out.figures(friction::pictures(&found));
    Ok(Some(Chapter::of("recorded_friction", "The friction from recordings", out)))
}
