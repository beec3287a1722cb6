//! Keys of the stroke of a cylinder.

use phea_quantity::LENGTH;
use phea_table::{Key, key};

pub(crate) const STROKE_KEY: Key =
    key("stroke", &LENGTH, "Stroke; x = 0 is the end of chamber A.").positive().usual(0.01, 6.0, "cylinders");
pub(crate) const STAGE_TRANSITION_KEY: Key = key(
    "stage_transition",
    &LENGTH,
    "Width over which the areas of a stage blend into those of the next, about `from`.",
)
.positive()
.or(5e-3);
