//! Effects that a verdict on the linear loop or the models of a linearisation do not include, in
//! sentences.

mod controller;
mod gas;
mod misfit;
mod rig;
mod valve;

pub(crate) use misfit::misfits_in_runs;
use phea_engineering::caveat::{Caveat, UncountedEffect, of_models};
use phea_engineering::setup::Setup;
pub(crate) use rig::{outside, outside_parameters};
pub(crate) use valve::port_valve_in_sizing;

use crate::quantity::Units;
use crate::simulate::beyond_reach;

/// The sentences of caveats, in their order.
pub(crate) fn sentences(caveats: &[Caveat], units: &Units) -> Vec<String> {
    caveats.iter().map(|caveat| sentence(&caveat.effect, units)).collect()
}

/// The sentences on effects that no linear model of a project includes.
pub(crate) fn of_models_in_words(setup: &Setup<'_>) -> Vec<String> {
    let units = &setup.project.units;
    of_models(setup).iter().map(|effect| sentence(effect, units)).collect()
}

/// The sentence of an effect.
pub(crate) fn sentence(effect: &UncountedEffect, units: &Units) -> String {
    use UncountedEffect as Effect;
    match effect {
        Effect::BlockedPiston { force } => rig::blocked_piston(*force, units),
        Effect::ProgressiveSpring { counted, at_rest, stiffest } => {
            rig::progressive_spring(*counted, *at_rest, *stiffest)
        }
        Effect::TransmissionSegments { segments, right_to } => {
            rig::transmission_segments(*segments, *right_to)
        }
        Effect::TransmissionAsSpring => rig::TRANSMISSION_AS_SPRING.to_string(),
        Effect::SeriesParts { damping, mass } => rig::series_parts(*damping, *mass),
        Effect::TelescopicStages { moves } => rig::telescopic_stages(*moves).to_string(),
        Effect::WallWithoutMass => rig::WALL_WITHOUT_MASS.to_string(),
        Effect::LinesInMotion { key, model } => rig::lines_in_motion(key, model),
        Effect::LimitedPump { pressure, taken, delivered } => {
            rig::limited_pump(*pressure, *taken, *delivered, units)
        }
        Effect::ConstantSupply => rig::CONSTANT_SUPPLY.to_string(),
        Effect::FrictionDirections { extending, retracting } => {
            rig::friction_directions(*extending, *retracting, units.motion)
        }
        Effect::BeyondReach(beyond) => {
            let (sentence, remedy) = beyond_reach(beyond, units);
            format!("{sentence}; {remedy}")
        }
        Effect::OutsideFamily(outside) => rig::outside_family(outside),
        Effect::FixedSetting { moves_gas } => gas::fixed_setting(*moves_gas),
        Effect::Gas { key, shut_beyond, of_family } => gas::gas(key, *shut_beyond, of_family.as_ref(), units),
        Effect::GasOutsideModels { necks, heat } => gas::outside_models(*necks, *heat),
        Effect::NeckLoss => gas::NECK_LOSS.to_string(),
        Effect::Adjustment { settings, moves_gas } => gas::adjustment(*settings, *moves_gas),
        Effect::GasValve { transition_pressure, has_range } => gas::valve(*transition_pressure, *has_range),
        Effect::CrossPortOrifice { drop, transition_pressure, conductance, has_range } => {
            valve::cross_port_orifice(*drop, *transition_pressure, *conductance, *has_range)
        }
        Effect::PortValve { side, valve } => valve::port_valve(*side, valve, units),
        Effect::DynamicPressureFeedback => valve::DYNAMIC_PRESSURE_FEEDBACK.to_string(),
        Effect::LeakageHumps { command, greatest, least } => {
            valve::leakage_humps(*command, *greatest, *least)
        }
        Effect::Overlap { dead_band, gain_ratio } => valve::overlap(*dead_band, *gain_ratio),
        Effect::NullSides { flow_gains, mean } => valve::null_sides(*flow_gains, *mean, units.motion),
        Effect::FeedForward { measured, yields } => controller::feed_forward(*measured, *yields),
        Effect::FeedForwardOutsideModels(obstacle) => controller::feed_forward_outside_models(*obstacle),
        Effect::ImpedanceUnmeasured { yields } => controller::impedance_unmeasured(*yields, units.motion),
        Effect::Impedance { yields } => controller::impedance(*yields, units.motion),
        Effect::PressureFeedbackUnmeasured => controller::PRESSURE_FEEDBACK_UNMEASURED.to_string(),
        Effect::PressureFeedbackOutsideModels => controller::PRESSURE_FEEDBACK_OUTSIDE_MODELS.to_string(),
        Effect::MovedRoot { table, root, discretization } => {
            controller::moved_root(table, root, *discretization)
        }
        Effect::Misfit(part, consequence) => misfit::sentence(part, *consequence),
    }
}
