//! What may be built: the limits of a design beyond its specifications, with what it reaches.

use phea_engineering::design::{
    CommandOfSteps, DesignLimit, DesignLimitKind, limit_key, limit_unit_key, limit_words, origin_key,
    origin_words,
};
use phea_qft::verification::Verdict;

use super::{ProjectDesign, relaxed};
use crate::answer::{Object, significant};
use crate::audit::PrefilterGain;
use crate::document::{Cell, Document, Table};
use crate::quantity::DisplayUnit;

/// A table of the limits; empty where there are none.
pub(crate) fn document(view: &ProjectDesign) -> Document {
    let mut out = Document::default();
    if view.limits.is_empty() {
        return out;
    }
    out.heading("What may be built");
    out.explanation(
        "Limits beyond the specifications, which `[design]` states or which hold by default. Where one binds, the search had no more room there: a looser one may allow a lower order, or less relaxation.",
    );
    let row = |limit: &DesignLimit| {
        [
            limit_words(limit.kind).into(),
            Cell::Code(format!("design.{}", limit_key(limit.kind))),
            value_words(view, limit).into(),
            origin_words(limit.origin).into(),
            view.limit_finding(limit.kind)
                .and_then(|found| found.worst.as_ref())
                .map_or(Cell::Missing, |worst| Cell::margin(worst.margin_db)),
            Cell::from(view.binds(limit).map(|binds| if binds { "binds" } else { "" }.to_string())),
        ]
    };
    out.table(
        Table::new(["limit", "key", "value", "from", "least margin", ""]).with(view.limits.iter().map(row)),
    );
    out.sentences(view.command_of_steps.as_ref().map(|command| command_sentence(view, command)));
    out
}

/// The step that takes the largest command, and the largest one that the valve does.
fn command_sentence(view: &ProjectDesign, command: &CommandOfSteps) -> String {
    let unit = view.gain_per.unwrap_or(DisplayUnit::NEWTON);
    let force = |newton: f64| unit.text(newton, 3);
    let plant = view.designed.view.names.text(&command.plant);
    let plant = if plant.is_empty() { String::new() } else { format!(" ({plant})") };
    format!(
        "the largest command of the scenarios' steps, a search over the linear steps of {} plants, is {} V, in the step from {} to {} of `{}`{plant}; {} V of them hold the change of force once it is reached, under any controller; a step of up to {} keeps within {} V, where supply and sensor allow it",
        command.plants,
        significant(command.largest_v, 3),
        force(command.step.from_n),
        force(command.step.to_n),
        command.step.scenario,
        significant(command.at_rest_v, 3),
        force(command.largest_step_n),
        significant(command.limit_v, 3)
    )
}

/// The same in JSON.
fn command_object(view: &ProjectDesign, command: &CommandOfSteps) -> Object {
    Object::new()
        .with("scenario", command.step.scenario.as_str())
        .with("from_n", command.step.from_n)
        .with("to_n", command.step.to_n)
        .with("largest_v", command.largest_v)
        .with("at_rest_v", command.at_rest_v)
        .with("limit_v", command.limit_v)
        .with("largest_step_n", command.largest_step_n)
        .with("evidence", "search")
        .with("plants", command.plants)
        .with("plant", view.designed.view.names.named(&command.plant))
}

/// The limits in JSON.
pub(crate) fn rows(view: &ProjectDesign) -> Vec<Object> {
    let row = |limit: &DesignLimit| {
        let found = view.limit_finding(limit.kind);
        let margin = found.and_then(|found| found.worst.as_ref()).map(|worst| worst.margin_db);
        Object::new()
            .with("key", limit_key(limit.kind))
            .with(format!("value{}", limit_unit_key(limit.kind)), limit.value)
            .with("origin", origin_key(limit.origin))
            .with("kept", is_kept(view, limit))
            .maybe("worst_margin_db", margin)
            .maybe("binds", view.binds(limit))
            .maybe("command", command(view, limit.kind).map(|found| command_object(view, found)))
            .maybe("relaxed", relaxed::of_limit(view, limit.kind, limit.value))
    };
    view.limits.iter().map(row).collect()
}

/// Whether the design keeps a limit; the ranges of poles are kept by the search itself.
fn is_kept(view: &ProjectDesign, limit: &DesignLimit) -> bool {
    match limit.kind {
        DesignLimitKind::MinimumDelayMargin => view.tolerates_its_delay,
        DesignLimitKind::PrefilterGain => view.exceeded_prefilter_gain().is_none(),
        DesignLimitKind::CommandOfSteps => {
            view.command_of_steps.as_ref().is_some_and(CommandOfSteps::is_kept)
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

/// The command of the scenarios' steps, of the limit on it.
fn command(view: &ProjectDesign, kind: DesignLimitKind) -> Option<&CommandOfSteps> {
    view.command_of_steps.as_ref().filter(|_| kind == DesignLimitKind::CommandOfSteps)
}

fn value_words(view: &ProjectDesign, limit: &DesignLimit) -> String {
    let value = limit.value;
    match limit.kind {
        DesignLimitKind::NoiseToCommand => {
            let percent = significant(100.0 * value, 3);
            format!("{percent} % of the nominal voltage, rms, by the largest gain")
        }
        DesignLimitKind::ModulusMargin => format!("|1+L| at least {}", significant(value, 3)),
        DesignLimitKind::HighestBandwidth => {
            format!("|L/(1+L)| at most -3 dB from {} rad/s on", significant(value, 3))
        }
        DesignLimitKind::MinimumDelayMargin => {
            let words = |seconds: f64| DisplayUnit::MILLISECOND.text(seconds, 3);
            let reached = match view.designed.figures.delay_margin_s {
                Some(f64::INFINITY) => "; the family tolerates any".to_string(),
                Some(margin_s) => format!("; the family tolerates {}", words(margin_s)),
                None => String::new(),
            };
            format!("{} more{reached}", words(value))
        }
        DesignLimitKind::PoleDampingRatio => format!("at least {}", significant(value, 3)),
        DesignLimitKind::FastestPole => format!("at most {} rad/s", significant(value, 3)),
        DesignLimitKind::PrefilterGain => {
            let reached = PrefilterGain::of_loop(&view.designed.problem.compensation).largest;
            format!("|F| at most {}; it has {}", significant(value, 3), significant(reached, 3))
        }
        DesignLimitKind::CommandOfSteps => {
            let volts = |value: f64| format!("{} V", significant(value, 3));
            match &view.command_of_steps {
                Some(found) => {
                    format!("at most {}; they take {}", volts(found.limit_v), volts(found.largest_v))
                }
                None => format!("at most {} % of the nominal voltage", significant(100.0 * value, 3)),
            }
        }
        DesignLimitKind::RequiredStep => String::new(),
    }
}
