//! The curvature, which the subproblem imports from here.

#[path = "../../src/loop_shaping/descent/curvature.rs"]
mod curvature;

pub(super) use curvature::Curvature;
