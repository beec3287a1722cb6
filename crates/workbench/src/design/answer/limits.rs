//! Limits of a design in addition to its specifications, with what it reaches, in JSON.

use phea_engineering::design::{CommandOfSteps, DesignLimit, DesignLimitKind, LimitOrigin, StepLimit};
use phea_engineering::simulate::ForceLimit;
use phea_qft::verification::{Evidence, Verdict};

use super::relaxed::{RelaxedValueAnswer, of_limit};
use crate::answer::{Answer, Keyed, words};
use crate::design::ProjectDesign;
use crate::design::limits::margin_db;
use crate::limit_kind::{LimitValueKeys, in_limit_unit};
use crate::plant_names::NamedPlant;
use crate::quantity::{FORCE, QuantityName};

/// Limit of a design in addition to its specifications.
#[derive(Answer)]
pub(super) struct DesignLimitAnswer {
    /// Limit in `[design]`.
    key: DesignLimitKind,
    #[answer(flatten)]
    value: Keyed<LimitValueKeys, f64>,
    /// Origin of the value.
    origin: LimitOrigin,
    /// True if the design satisfies the limit.
    satisfied: bool,
    /// Least margin of the family; negative if the limit is exceeded, left out if it is unknown.
    #[answer(optional)]
    worst_margin_db: Option<f64>,
    /// True if the limit leaves the search no room; left out if this is unknown.
    #[answer(optional)]
    binds: Option<bool>,
    /// Largest command of the steps of the scenarios, only of the limit on it.
    #[answer(optional)]
    command: Option<CommandOfStepsAnswer>,
    /// Gain from relaxing the limit, only if it binds.
    #[answer(optional)]
    relaxed: Option<RelaxedValueAnswer>,
}

/// Largest command that the steps of the scenarios take, as a search over the linear steps of the
/// family finds it.
#[derive(Answer)]
struct CommandOfStepsAnswer {
    /// Scenario whose command takes most of the limit.
    scenario: String,
    /// Reference before the step after which the command is largest.
    #[answer(key = QuantityName::moving("from", &FORCE))]
    from: f64,
    /// Reference after this step.
    #[answer(key = QuantityName::moving("to", &FORCE))]
    to: f64,
    /// Time of the largest command in the scenario.
    at_s: f64,
    /// Phase of the response in which the command is largest.
    peak: CommandPeakKind,
    /// Largest magnitude of the command.
    largest_v: f64,
    /// Largest command that remains between steps under any controller.
    at_rest_v: f64,
    /// Limit of the command.
    limit_v: f64,
    /// Largest single step of this sign, from rest at the reference before the step, within the
    /// limits of command, supply and sensor.
    #[answer(key = QuantityName::moving("largest_step", &FORCE))]
    largest_step: f64,
    /// Limit of the largest single step.
    step_limit: StepLimit,
    /// Evidence for the largest command.
    evidence: Evidence,
    /// Number of plants that the search evaluated.
    plants: usize,
    /// Plant with the largest command.
    plant: NamedPlant,
    /// Names of the parameters that change the largest command.
    moved_by: Vec<String>,
}

/// Phase of a response to a step.
enum CommandPeakKind {
    AtRest,
    Transient,
}

words! {
    /// Phase of a response to a step: at rest after it, or in the transient on the way there.
    CommandPeakKind { AtRest => "at_rest", Transient => "transient" }
}

words! {
    /// Limit of the largest step: the command of the valve, the force at which the supply stalls
    /// the actuator, or the capacity of the force sensor.
    StepLimit {
        Command => "command",
        Force(ForceLimit::Supply) => "supply",
        Force(ForceLimit::Sensor) => "sensor",
    }
}

/// The limits.
pub(super) fn rows(view: &ProjectDesign) -> Vec<DesignLimitAnswer> {
    view.limits.iter().map(|limit| row(view, limit)).collect()
}

fn row(view: &ProjectDesign, limit: &DesignLimit) -> DesignLimitAnswer {
    let command = view.command_of_steps.as_ref().filter(|_| limit.kind == DesignLimitKind::CommandOfSteps);
    DesignLimitAnswer {
        key: limit.kind,
        value: in_limit_unit(limit.kind, limit.value),
        origin: limit.origin,
        satisfied: is_satisfied(view, limit),
        worst_margin_db: margin_db(view, limit),
        binds: view.binds(limit),
        command: command.map(|found| command_of_steps(view, found)),
        relaxed: of_limit(view, limit.kind, limit.value),
    }
}

/// True if the design satisfies a limit; the search itself keeps poles in their ranges.
fn is_satisfied(view: &ProjectDesign, limit: &DesignLimit) -> bool {
    match limit.kind {
        DesignLimitKind::MinimumDelayMargin => view.tolerates_its_delay,
        DesignLimitKind::PrefilterGain => view.exceeded_prefilter_gain().is_none(),
        DesignLimitKind::CommandOfSteps => {
            view.command_of_steps.as_ref().is_some_and(CommandOfSteps::is_satisfied)
        }
        DesignLimitKind::PoleDampingRatio | DesignLimitKind::FastestPole | DesignLimitKind::RequiredStep => {
            true
        }
        DesignLimitKind::NoiseToCommand
        | DesignLimitKind::ModulusMargin
        | DesignLimitKind::HighestBandwidth => {
            view.limit_finding(limit.kind).is_some_and(|found| found.verdict == Verdict::Met)
        }
    }
}

fn command_of_steps(view: &ProjectDesign, command: &CommandOfSteps) -> CommandOfStepsAnswer {
    let names = view.designed.view.names.headings();
    let moved_by = command.moved_by.iter().filter_map(|index| names.get(*index));
    CommandOfStepsAnswer {
        scenario: command.scenario.clone(),
        from: command.step.from_n,
        to: command.step.to_n,
        at_s: command.at_s,
        peak: if command.is_at_rest() { CommandPeakKind::AtRest } else { CommandPeakKind::Transient },
        largest_v: command.largest_v,
        at_rest_v: command.at_rest_v,
        limit_v: command.limit_v,
        largest_step: command.largest_step_n,
        step_limit: command.step_limit,
        evidence: Evidence::Search,
        plants: command.plants,
        plant: view.designed.view.names.named(&command.plant),
        moved_by: moved_by.map(ToString::to_string).collect(),
    }
}
