//! The effect of the converters of the controller's computer on its loop.

use phea_dynamics::linear::LinearError;
use phea_qft::design::quantization::{LimitCycle, RoundingEffect, RoundingEffects, rounding_effects};
use phea_qft::family::Family;
use phea_qft::verification::PlantPoint;

use crate::quantity::{DisplayUnit, significant};
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// The effect of the converters, or why it cannot be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    effects: Result<RoundingEffects, String>,
    /// The plants for which the effects are computed.
    plants: Vec<PlantPoint>,
}

/// `None` where no converter rounds.
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
    Ok(Some(Rounding { effects: effects.map_err(|error| error.to_string()), plants }))
}

impl Rounding {
    /// The rounded signal, the affected signal, and the effect.
    pub fn each(&self) -> Vec<(&'static str, &'static str, RoundingEffect)> {
        let Ok(effects) = &self.effects else { return vec![] };
        let rows = [
            ("command", "output", effects.force_from_command),
            ("measurement", "output", effects.force_from_measurement),
            ("measurement", "command", effects.command_from_measurement),
        ];
        rows.into_iter().filter_map(|(of, on, effect)| Some((of, on, effect?))).collect()
    }

    /// The effect of the converters, or why it cannot be computed.
    pub fn effects(&self) -> Result<&RoundingEffects, &str> {
        self.effects.as_ref().map_err(String::as_str)
    }

    /// The plant with this index among those for which the effects are computed.
    pub fn plant(&self, index: usize) -> PlantPoint {
        self.plants.get(index).cloned().unwrap_or(PlantPoint::Measured(index))
    }

    /// In sentences, the output in this unit and the command in V; of a plant without units bare
    /// numbers.
    pub fn sentences(&self, unit: Option<DisplayUnit>) -> Vec<String> {
        let effects = match &self.effects {
            Ok(effects) => effects,
            Err(reason) => return vec![format!("the effect of the converters is unknown: {reason}")],
        };
        let mut sentences: Vec<String> = self
            .each()
            .into_iter()
            .map(|(of, on, effect)| {
                let shown = |size: f64| match (unit, on) {
                    (None, _) => significant(size, 3),
                    (Some(_), "command") => DisplayUnit::VOLT.text(size, 3),
                    (Some(unit), _) => unit.text(size, 3),
                };
                let [peak, rms] = [effect.peak, effect.rms].map(shown);
                format!("the rounded {of} moves the {on} by {rms} rms, and by {peak} at most")
            })
            .collect();
        sentences.extend(effects.limit_cycle.and_then(|cycle| match cycle {
            LimitCycle::NotIntegrating => None,
            LimitCycle::CanRest { .. } => {
                Some("the loop can come to rest between the levels of its converters".to_string())
            }
            LimitCycle::Expected { .. } => Some(
                "no level of the command leaves an error that the measurement does not show: expect the command to wander between two"
                    .to_string(),
            ),
        }));
        sentences
    }
}
