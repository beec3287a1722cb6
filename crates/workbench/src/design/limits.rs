//! Limits of a design in addition to its specifications, with what it reaches.

use phea_engineering::audit::PrefilterGain;
use phea_engineering::design::{
    CommandOfSteps, DesignLimit, DesignLimitKind, ProjectDesign, StepLimit, limit_key,
};
use phea_engineering::plant_names::NamedPlant;
use phea_engineering::simulate::ForceLimit;

use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::limit_kind::{limit_words, origin_words};
use crate::plant_names::plant_words;
use crate::quantity::{DisplayUnit, MotionWords};
use phea_dynamics::frequency::decibels;
use phea_dynamics::portable::magnitude;

/// Ratio up to which a pole counts as being at the limit.
const SAME: f64 = 1.000001;

/// A table of the limits; empty if there are none.
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
            match limit.kind.has_key() {
                true => Cell::Code(format!("design.{}", limit_key(limit.kind))),
                false => Cell::Missing,
            },
            value_cell(view, limit),
            origin_words(limit.origin).into(),
            margin_db(view, limit).map_or(Cell::Missing, Cell::margin),
            if view.binds(limit) == Some(true) { "binds" } else { "" }.into(),
        ]
    };
    out.table(
        Table::new(["limit", "key", "value", "from", "least margin", ""]).with(view.limits.iter().map(row)),
    );
    out.sentences(view.command_of_steps.as_ref().map(|command| command_sentence(view, command)));
    out.sentences(fast_notch(view));
    out
}

/// A pole of the designed controller beyond the fastest allowed one: that of a notch whose poles
/// are so strongly damped that they are real.
fn fast_notch(view: &ProjectDesign) -> Option<String> {
    let limit = view.limits.iter().find(|limit| limit.kind == DesignLimitKind::FastestPole)?;
    let law = view.design.law.feedback.transfer_function().ok()?;
    let fastest = law.poles().iter().map(|pole| magnitude(*pole)).fold(0.0, f64::max);
    (fastest > SAME * limit.value).then(|| {
        format!(
            "a notch is within the fastest pole by its natural frequency: the faster of its two real poles lies at {} rad/s",
            significant(fastest, 4)
        )
    })
}

/// The largest command of the scenarios' steps, and the largest step that valve, supply and sensor
/// allow.
fn command_sentence(view: &ProjectDesign, command: &CommandOfSteps) -> String {
    let unit = view.gain_per.unwrap_or(DisplayUnit::NEWTON);
    let force = |newton: f64| unit.text(newton, 3);
    let volts = |value: f64| format!("{} V", significant(value, 3));
    let MotionWords { force: quantity, piston, .. } = view.designed.problem.units.motion.words();
    let step = &command.step;
    let [from, to] = [step.from_n, step.to_n].map(force);
    let place = match command.is_at_rest() {
        true => {
            let scenario = &command.scenario;
            format!("what holds {to} after the step from {from} in `{scenario}` under any controller")
        }
        false => {
            let after = DisplayUnit::MILLISECOND.text(command.at_s - step.at_s, 3);
            format!("{after} after the step from {from} to {to} in `{}`", command.scenario)
        }
    };
    let room = match command.step_limit {
        StepLimit::Command => format!("keeps within {}", volts(command.limit_v)),
        StepLimit::Force(limit) => {
            let end = match limit {
                ForceLimit::Supply => {
                    &*format!("the {quantity} at which the lowest supply pressure stalls the {piston}")
                }
                ForceLimit::Sensor => "the declared capacity of the sensor",
            };
            format!("reaches {end}, and the valve would do more within {}", volts(command.limit_v))
        }
    };
    let at_rest = match command.is_at_rest() {
        true => String::new(),
        false => {
            format!(
                "under any controller at most {} hold the {quantity} between these steps; ",
                volts(command.at_rest_v)
            )
        }
    };
    format!(
        "the largest command of the scenarios' steps, a search over the linear steps of {} plants, is {}, {place}{}; {at_rest}a single step of {} from {from} {room}",
        command.plants,
        volts(command.largest_v),
        set_by(view, command),
        force(command.largest_step_n),
    )
}

/// The parameters that set the largest command.
fn set_by(view: &ProjectDesign, command: &CommandOfSteps) -> String {
    let names = &view.designed.view.names;
    let NamedPlant(all) = names.named(&command.plant);
    let count = all.len();
    let moved_by = all.into_iter().enumerate().filter(|(index, _)| command.moved_by.contains(index));
    let set_by = NamedPlant(moved_by.map(|(_, one)| one).collect());
    match set_by.0.len() {
        0 if count == 0 => String::new(),
        0 => ", at every plant alike".to_string(),
        own if own == count => format!(" ({})", plant_words(&set_by)),
        _ => format!(" ({}, whatever the other parameters)", plant_words(&set_by)),
    }
}

/// The least margin of a limit over the family, dB.
pub(super) fn margin_db(view: &ProjectDesign, limit: &DesignLimit) -> Option<f64> {
    match limit.kind {
        // the search uses a limit on |S| in its place
        DesignLimitKind::PrefilterGain => {
            let largest = PrefilterGain::of_loop(&view.designed.problem.compensation).largest;
            Some(decibels(limit.value / largest))
        }
        _ => view.limit_finding(limit.kind)?.worst.as_ref().map(|worst| worst.margin_db),
    }
}

fn value_cell(view: &ProjectDesign, limit: &DesignLimit) -> Cell {
    let value = limit.value;
    let three = |unit: DisplayUnit| Cell::quantity(value, 3, unit);
    match limit.kind {
        DesignLimitKind::NoiseToCommand => {
            three(DisplayUnit::PERCENT).then(" of the nominal voltage, rms, by the largest gain")
        }
        DesignLimitKind::ModulusMargin => {
            Cell::Equation("|1+L|".to_string()).then(" at least ").then(three(DisplayUnit::ONE))
        }
        DesignLimitKind::HighestBandwidth => {
            let loop_gain =
                Cell::Equation("|L/(1+L)|".to_string()).then(" at most ").then(Cell::unit("-3 dB"));
            loop_gain.then(three(DisplayUnit::RADIAN_PER_SECOND).between(" from ", " on"))
        }
        DesignLimitKind::MinimumDelayMargin => {
            let more = three(DisplayUnit::MILLISECOND).then(" more");
            match view.designed.figures.delay_margin_s {
                Some(f64::INFINITY) => more.then("; the family tolerates any"),
                Some(margin_s) => more.then("; the family tolerates ").then(Cell::quantity(
                    margin_s,
                    3,
                    DisplayUnit::MILLISECOND,
                )),
                None => more,
            }
        }
        DesignLimitKind::PoleDampingRatio => Cell::from("at least ").then(three(DisplayUnit::ONE)),
        DesignLimitKind::FastestPole => Cell::from("at most ").then(three(DisplayUnit::RADIAN_PER_SECOND)),
        DesignLimitKind::PrefilterGain => {
            let reached = PrefilterGain::of_loop(&view.designed.problem.compensation).largest;
            three(DisplayUnit::ONE).between("|F| at most ", "; it has ").then(Cell::number(reached, 3))
        }
        DesignLimitKind::CommandOfSteps => {
            let volts = |value: f64| Cell::quantity(value, 3, DisplayUnit::VOLT);
            match &view.command_of_steps {
                Some(found) => {
                    volts(found.limit_v).between("at most ", "; they take ").then(volts(found.largest_v))
                }
                None => three(DisplayUnit::PERCENT).between("at most ", " of the nominal voltage"),
            }
        }
        DesignLimitKind::RequiredStep => Cell::empty(),
    }
}
