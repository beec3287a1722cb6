//! What the converters of the controller's computer do to its loop.

use phea_qft::design::quantisation::{LimitCycle, RoundingEffect, RoundingEffects, rounding_effects};
use phea_qft::family::Family;
use phea_qft::verification::PlantPoint;
use serde::Serialize;

use crate::answer::{Number, significant};
use crate::audit::{NamedPlant, PlantNames};
use crate::command::CommandError;
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// What the converters do, or why that cannot be told.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    effects: Result<RoundingEffects, String>,
    /// The plants that the effects count.
    plants: Vec<PlantPoint>,
}

#[derive(Serialize)]
pub(super) struct RoundingRow {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: Vec<EffectRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    command_steps_at_once: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit_cycle: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Serialize)]
struct EffectRow {
    of: &'static str,
    on: &'static str,
    peak: Number,
    peak_plant: NamedPlant,
    rms: Number,
    rms_plant: NamedPlant,
}

/// `None` where no converter rounds.
pub(super) fn rounding(setup: &Setup<'_>, problem: &RobustProblem) -> Result<Option<Rounding>, CommandError> {
    let quantisation = setup.quantisation;
    if quantisation.command.is_none() && quantisation.measurement.is_none() {
        return Ok(None);
    }
    let effects = rounding_effects(&problem.compensation, &problem.members()?, &quantisation);
    let plants = match &problem.family {
        Family::Uncertain(family) => family.members().iter().cloned().map(PlantPoint::Parameters).collect(),
        Family::Measured(family) => (0..family.plants().len()).map(PlantPoint::Measured).collect(),
    };
    Ok(Some(Rounding { effects: effects.map_err(|error| error.to_string()), plants }))
}

impl Rounding {
    /// What is rounded, what that acts on, and the effect.
    fn each(&self) -> Vec<(&'static str, &'static str, RoundingEffect)> {
        let Ok(effects) = &self.effects else { return vec![] };
        let rows = [
            ("command", "output", effects.force_from_command),
            ("measurement", "output", effects.force_from_measurement),
            ("measurement", "command", effects.command_from_measurement),
        ];
        rows.into_iter().filter_map(|(of, on, effect)| Some((of, on, effect?))).collect()
    }

    pub(super) fn row(&self, names: &PlantNames) -> RoundingRow {
        let plant =
            |index: usize| names.named(self.plants.get(index).unwrap_or(&PlantPoint::Measured(index)));
        let effects = self.each().into_iter().map(|(of, on, effect)| EffectRow {
            of,
            on,
            peak: Number(effect.peak),
            peak_plant: plant(effect.peak_plant),
            rms: Number(effect.rms),
            rms_plant: plant(effect.rms_plant),
        });
        let known = self.effects.as_ref().ok();
        RoundingRow {
            effects: effects.collect(),
            command_steps_at_once: known.and_then(|effects| effects.command_steps_at_once),
            limit_cycle: known.and_then(|effects| effects.limit_cycle).map(|cycle| match cycle {
                LimitCycle::NotIntegrating => "not_integrating",
                LimitCycle::CanRest { .. } => "can_rest",
                LimitCycle::Expected { .. } => "expected",
            }),
            reason: self.effects.as_ref().err().cloned(),
        }
    }

    /// In sentences.
    pub(crate) fn sentences(&self) -> Vec<String> {
        let effects = match &self.effects {
            Ok(effects) => effects,
            Err(reason) => return vec![format!("what the converters do cannot be told: {reason}")],
        };
        let mut sentences: Vec<String> = self
            .each()
            .into_iter()
            .map(|(of, on, effect)| {
                let [peak, rms] = [effect.peak, effect.rms].map(|size| significant(size, 3));
                format!("the rounded {of} moves the {on} by {rms} rms, and by {peak} at most (SI)")
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
