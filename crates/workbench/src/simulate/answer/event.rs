//! The events of a run.

use phea_engineering::simulate::{Cause, Metrics, Occurrence, Window};

use crate::answer::{Answer, Reasoned, words};
use crate::quantity::{FORCE, MotionKind, QuantityName};
use crate::simulate::metrics::{EventMetricsAnswer, metrics_answer};
use crate::simulate::occurrence_kind::OccurrenceKind;

/// Event of a run, with the metrics of the time from it to the next.
#[derive(Answer)]
pub(super) struct ScenarioEventAnswer {
    /// Kind of the event.
    kind: Cause,
    /// Time of the event, from the start of the scenario.
    time_s: f64,
    /// Time of the next event, or the end of the scenario.
    until_s: f64,
    #[answer(flatten)]
    step: SteppedAnswer,
    /// Metrics of the event.
    metrics: EventMetricsAnswer,
}

/// Reference and open-loop command before and after the step of an event.
#[derive(Answer)]
pub(crate) struct SteppedAnswer {
    /// Reference before and after its step.
    #[answer(key = QuantityName::moving("reference", &FORCE))]
    reference: Reasoned<[f64; 2]>,
    /// Open-loop command before and after its step.
    command_v: Reasoned<[f64; 2]>,
}

words! {
    /// Kind of an event: a step of the reference or of the open-loop command, the beginning of a
    /// part of either that moves otherwise, or the beginning of a motion of the load, of an
    /// external force or of a change of the setting of accumulators.
    Cause {
        ReferenceStep { .. } => "reference_step",
        ReferenceMotion { .. } => "reference_motion",
        CommandStep { .. } => "command_step",
        CommandMotion { .. } => "command_motion",
        LoadMotion => "load_motion",
        ExternalForce { .. } => "external_force",
        SettingChange => "setting_change",
    }
}

/// Beginning or end of a condition of the machine.
#[derive(Answer)]
pub(super) struct OccurrenceAnswer {
    /// Time from the start of the scenario.
    time_s: f64,
    /// Condition of the machine.
    kind: OccurrenceKind,
    /// True if the condition begins, false if it ends.
    begins: bool,
}

/// An event with its metrics.
pub(super) fn event((window, metrics): &(Window, Metrics), motion: MotionKind) -> ScenarioEventAnswer {
    ScenarioEventAnswer {
        kind: window.cause,
        time_s: window.start_s,
        until_s: window.end_s,
        step: stepped(window),
        metrics: metrics_answer(metrics, motion),
    }
}

/// The step of an event.
pub(crate) fn stepped(window: &Window) -> SteppedAnswer {
    let reference_n = match window.cause {
        Cause::ReferenceStep { from_n, to_n } => Some([from_n, to_n]),
        _ => None,
    };
    let command_v = match window.cause {
        Cause::CommandStep { from_v, to_v } => Some([from_v, to_v]),
        _ => None,
    };
    SteppedAnswer {
        reference: Reasoned::new(reference_n, "the reference does not step"),
        command_v: Reasoned::new(command_v, "no open-loop command steps"),
    }
}

/// Something that began or ended.
pub(super) fn occurrence(occurrence: &Occurrence) -> OccurrenceAnswer {
    OccurrenceAnswer {
        time_s: occurrence.time_s,
        kind: OccurrenceKind(occurrence.kind),
        begins: occurrence.begins,
    }
}
