//! The curvature, which the subproblem takes from here.

#[path = "../../src/loop_shaping/descent/curvature.rs"]
mod curvature;

pub(super) use curvature::Curvature;
