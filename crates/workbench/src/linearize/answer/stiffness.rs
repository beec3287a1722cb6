//! Hydraulic stiffness over the stroke for programs.

use phea_engineering::linearize::Linearization;

use super::super::stiffness_sentence;
use crate::answer::Answer;
use crate::quantity::{LENGTH, QuantityName, STIFFNESS};

/// Hydraulic stiffness over the stroke.
#[derive(Answer)]
pub(super) struct LinearStiffnessAnswer {
    /// Least stiffness, with the nominal wall of the lines.
    #[answer(key = QuantityName::moving("minimum", &STIFFNESS))]
    minimum: f64,
    /// Greatest stiffness, with the nominal wall of the lines.
    #[answer(key = QuantityName::moving("maximum", &STIFFNESS))]
    maximum: f64,
    /// Position or angle of the least stiffness, from the end of chamber A.
    #[answer(key = QuantityName::OfMotion(["minimum_position", "minimum_angle"], &LENGTH))]
    minimum_position: f64,
    /// Least stiffness with the softest wall of the uncertain lines.
    #[answer(key = QuantityName::moving("minimum_softest_wall", &STIFFNESS))]
    minimum_softest_wall: f64,
    /// Greatest stiffness with the stiffest wall of the uncertain lines.
    #[answer(key = QuantityName::moving("maximum_stiffest_wall", &STIFFNESS))]
    maximum_stiffest_wall: f64,
    /// Least and greatest stiffness in N/m or N m/rad, with one bulk modulus for line and chamber.
    #[answer(interval)]
    uniform: [f64; 2],
    /// Least and greatest stiffness in N/m or N m/rad, with a bulk modulus of each volume.
    #[answer(interval)]
    by_volume: [f64; 2],
    /// Sentence that compares the two stiffness models.
    sentence: String,
}

pub(super) fn stiffness(linearization: &Linearization) -> LinearStiffnessAnswer {
    let [nominal, softest, stiffest] = linearization.stiffness;
    let models = &linearization.stiffness_models;
    LinearStiffnessAnswer {
        minimum: nominal.minimum,
        maximum: nominal.maximum,
        minimum_position: nominal.minimum_position,
        minimum_softest_wall: softest.minimum,
        maximum_stiffest_wall: stiffest.maximum,
        uniform: [models.uniform.minimum, models.uniform.maximum],
        by_volume: [models.by_volume.minimum, models.by_volume.maximum],
        sentence: stiffness_sentence(linearization),
    }
}
