//! What is told of the friction of a cylinder from recorded runs: text, JSON, figures, and the
//! fragment of a project file.

mod answer;
mod document;
mod figures;
mod files;

pub use phea_engineering::friction::*;

pub use answer::json;
pub use document::text;
pub(crate) use figures::pictures;
pub use files::files;

use crate::answer::significant;

/// Why a coefficient is not determined, in words.
pub(crate) fn because(estimate: &FrictionEstimate) -> Option<String> {
    let reason = match estimate.untold? {
        UntoldFriction::NothingSlides => "nothing slides at a constant velocity".to_string(),
        UntoldFriction::NoFall => {
            "no fall of the friction from static to sliding is seen: record slower runs".to_string()
        }
        UntoldFriction::NothingPressed => {
            "nothing is pressed from rest while its position is recorded".to_string()
        }
        UntoldFriction::NotSought => "slow runs do not show it, and quick ones are not evaluated".to_string(),
        UntoldFriction::QuickForce => {
            "the force changes too quickly: record one that rises slowly".to_string()
        }
        UntoldFriction::NotExplained { residual } => format!(
            "no bristles explain what is recorded before breakaway: {} times the noise is left",
            significant(residual, 2)
        ),
        UntoldFriction::Hidden => "noise hides its effect in these recordings".to_string(),
    };
    Some(reason)
}
