//! Effect of the converters of the controller's computer on its loop.

use phea_dynamics::linear::LinearError;
use phea_qft::design::quantization::{QuantizationError, RoundingEffect, RoundingEffects, rounding_effects};
use phea_qft::family::Family;
use phea_qft::verification::PlantPoint;

use crate::robust::RobustProblem;
use crate::setup::Setup;

/// Effect of the converters, or the reason why it cannot be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    effects: Result<RoundingEffects, QuantizationError>,
    /// Plants for which the effects are computed.
    plants: Vec<PlantPoint>,
}

/// A signal of the loop that converters round or that their rounding affects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoundedSignal {
    /// Command of the controller.
    Command,
    /// Measurement of the force.
    Measurement,
    /// Force.
    Output,
}

/// Effect of rounding; `None` if no converter rounds.
pub(super) fn rounding(setup: &Setup<'_>, problem: &RobustProblem) -> Result<Option<Rounding>, LinearError> {
    let quantization = setup.quantization;
    if quantization.command.is_none() && quantization.measurement.is_none() {
        return Ok(None);
    }
    let effects = rounding_effects(&problem.compensation, &problem.members()?, &quantization);
    let plants = match &problem.family {
        Family::Uncertain(family) => family.members().iter().cloned().map(PlantPoint::Parameters).collect(),
        Family::Measured(family) => (0..family.plants().len()).map(PlantPoint::Measured).collect(),
    };
    Ok(Some(Rounding { effects, plants }))
}

impl Rounding {
    /// Rounded signals, affected signals, and effects.
    pub fn each(&self) -> Vec<(RoundedSignal, RoundedSignal, RoundingEffect)> {
        let Ok(effects) = &self.effects else { return vec![] };
        let rows = [
            (RoundedSignal::Command, RoundedSignal::Output, effects.force_from_command),
            (RoundedSignal::Measurement, RoundedSignal::Output, effects.force_from_measurement),
            (RoundedSignal::Measurement, RoundedSignal::Command, effects.command_from_measurement),
        ];
        rows.into_iter().filter_map(|(of, on, effect)| Some((of, on, effect?))).collect()
    }

    /// Effect of the converters, or the reason why it cannot be computed.
    ///
    /// # Errors
    /// [`QuantizationError`] for plants whose loop with the converters cannot be computed.
    pub fn effects(&self) -> Result<&RoundingEffects, &QuantizationError> {
        self.effects.as_ref()
    }

    /// Plant with this index among those for which the effects are computed.
    pub fn plant(&self, index: usize) -> PlantPoint {
        self.plants.get(index).cloned().unwrap_or(PlantPoint::Measured(index))
    }
}
