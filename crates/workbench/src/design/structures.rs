//! The tested structures and the values that each reaches.

use phea_engineering::design::{DesignLimitKind, LedBy, ReachedStructure, SearchedLimit, structure_key};
use phea_qft::design::{ControllerChoice, Objective, StructureEnding};

use super::ProjectDesign;
use super::comparison::gain_at_high_frequency;
use super::words::{reached_words, searched_limit_name, structure_name};
use crate::answer::significant;
use crate::audit::{above_one_again_words, crossover_words};
use crate::document::{Cell, Document, Table};
use crate::limit_kind::limit_words;
use crate::quantity::DisplayUnit;

/// Outcome of a structure whose gain over another one was not worth its poles.
const GIVEN_UP: &str = "given up";

/// A table of the structures; empty if none has a name.
pub(crate) fn document(view: &ProjectDesign) -> Document {
    let mut out = Document::default();
    if view.structures.iter().all(|one| one.name.is_none()) {
        return out;
    }
    out.heading("The structures that were tried");
    out.explanation(
        "The shortest structure that is met is taken. The least margin, and the limit that binds (leaves no room), are those of the plants and frequencies that the search evaluated; crossover and delay margin are those of the nominal loop; overshoot and settling time are the worst of the linear steps, of the structure that is taken over the whole family, of others over 40 of its members; the noise gain is its largest |G/(1+L)|, from the noise of the sensor to the command.",
    );
    let compares_noise = view.options.objective == Objective::LeastHighFrequencyGain;
    let band = view.designed.view.in_time.first().map(|finding| finding.requirement.step_limits.band_percent);
    let settles = band.map_or("settles in".to_string(), |band| format!("settles in ({band} %)"));
    let rises = requires_rise(view);
    let mut headings = vec![
        "structure",
        "poles",
        "result",
        "least margin",
        "binds",
        "nominal crossover",
        "nominal delay margin",
        "high-frequency gain",
        if compares_noise { "noise gain" } else { "compared" },
        "overshoot",
        &settles,
    ];
    headings.extend(rises.then_some("rises in"));
    out.table(Table::new(headings).with(view.structures.iter().map(|one| row(view, one))));
    out.sentences(sampled_gain(view));
    out.sentences(earned_sentence(view));
    out.sentences(laws_that_differ(view));
    out.sentences(view.structures.iter().filter_map(|one| {
        let slowest = one.slowest_zero_rad_per_s.filter(|_| one.ending != StructureEnding::NotEarned)?;
        let found = significant(slowest, 3);
        Some(format!(
            "{}: a zero ended at {found} rad/s, the lowest that is looked for: a lower one may reach more",
            reached_words(one)
        ))
    }));
    let is_missed = |one: &ReachedStructure| !one.is_chosen && misses_in_time(view, one);
    if let Some(missed) = view.structures.iter().find(|one| is_missed(one)) {
        let named = match structure_key(missed.name) {
            "" => String::new(),
            name => format!(", such as `design.structure = \"{name}\"`,"),
        };
        out.sentences([format!(
            "steps missed: those of the controller that the search over frequency found; the structure alone{named} is led by its steps and may satisfy them"
        )]);
    }
    let missed_on_rig = view.structures.iter().any(|one| misses_on_rig_only(view, one));
    out.sentences(missed_on_rig.then(|| {
        "nonlinear runs missed: its linear steps satisfy what is required in time, a run of it on the nonlinear rig missed it or left no room, and the search went on from there".to_string()
    }));
    let is_given_up = |one: &ReachedStructure| ending_words(view, one) == GIVEN_UP;
    out.sentences(view.structures.iter().any(is_given_up).then(|| {
        "given up: it was not worth its poles compared with the structure that the search over frequency found first, and was not led by its steps; it may be worth them beside the one that is taken, and `design.structure` designs it".to_string()
    }));
    out.sentences(way_sentence(view));
    out
}

/// The limits of tracking on the way to a required step.
fn way_sentence(view: &ProjectDesign) -> Option<String> {
    let way = limit_words(DesignLimitKind::RequiredStep);
    let way_binds = Some(SearchedLimit::Design(DesignLimitKind::RequiredStep));
    let is_led = view.structures.iter().any(|one| one.binding == way_binds);
    is_led.then(|| {
        format!("the {way} is limits on |F T| that the search over frequency keeps; a design is judged by its steps")
    })
}

/// Structures whose result differs from their name, and loops in which |L| rises above 1 again
/// beyond the crossover.
fn laws_that_differ(view: &ProjectDesign) -> Vec<String> {
    let renamed = view.structures.iter().filter_map(|one| {
        let name = structure_name(one.name.filter(|_| one.no_pid.is_some())?);
        Some(format!("{}: a {name} whose T_d would not be positive", reached_words(one)))
    });
    let again = |one: &ReachedStructure| {
        Some(format!("{} {}", reached_words(one), above_one_again_words(&one.nominal?.crossovers)?))
    };
    let again: Vec<String> = view.structures.iter().filter_map(again).collect();
    let risen = (!again.is_empty()).then(|| {
        format!("beyond the crossover |L| of the nominal loop is above 1 again: {}", again.join(", "))
    });
    renamed.chain(risen).collect()
}

/// The limit that leaves a structure no room.
pub(super) fn binding(view: &ProjectDesign, one: &ReachedStructure) -> Option<String> {
    one.binding.map(|limit| searched_limit_name(view, limit))
}

/// The objective of a design, for the structure that is taken; `None` if limits over frequency were
/// the objective.
fn led_words(view: &ProjectDesign, one: &ReachedStructure) -> Option<String> {
    let words = match view.led_by {
        LedBy::Frequency => return None,
        LedBy::LinearSteps => "linear steps",
        LedBy::NonlinearRuns => "nonlinear runs",
    };
    one.is_chosen.then(|| words.to_string())
}

/// What the high-frequency gain is that of, in a sampled loop.
fn sampled_gain(view: &ProjectDesign) -> Option<String> {
    let is_sampled = view.designed.problem.compensation.sample_time_s().is_some();
    is_sampled.then(|| {
        "the high-frequency gain is that of the continuous law, before it is sampled: the limit of s^r G, r poles more than zeros".to_string()
    })
}

/// Gain required of a longer structure for each further pole, dB, if that decides.
pub(super) fn earned_per_pole_db(view: &ProjectDesign) -> Option<f64> {
    match view.options.controller {
        ControllerChoice::Any { earned_per_pole_db, .. } => Some(earned_per_pole_db),
        ControllerChoice::Given(_) | ControllerChoice::Named { .. } | ControllerChoice::Grow { .. } => None,
    }
}

fn earned_sentence(view: &ProjectDesign) -> Option<String> {
    let by = match view.options.objective {
        Objective::LeastHighFrequencyGain => "lowers the noise gain",
        Objective::LeastBandwidth => "lowers the crossover",
        Objective::BestWorstMargin => "raises the worst margin",
    };
    Some(match earned_per_pole_db(view)? {
        most_db if most_db.is_finite() => format!(
            "a longer structure of these names takes the place of one that is met where it {by} by {} dB for each further pole, one as long by as much (`design.earned_per_pole`)",
            significant(most_db, 3)
        ),
        _ => "no longer structure takes the place of one that is met (`design.earned_per_pole`)".to_string(),
    })
}

fn row(view: &ProjectDesign, one: &ReachedStructure) -> Vec<Cell> {
    let or_missing = |text: Option<String>| text.map_or(Cell::Missing, Cell::from);
    let compared = one.compared_db.map(|value| compared_words(view, value));
    let gain = one.high_frequency_gain_db.map(|gain_db| {
        let degree = i64::from(one.relative_degree);
        gain_at_high_frequency(&significant(gain_db, 4), degree, view.controlled_unit())
    });
    let crossover = one.nominal.map(|margins| crossover_words(&margins.crossovers));
    let delay = one.nominal.map(|margins| match margins.delay_margin_s {
        f64::INFINITY => "unlimited".to_string(),
        delay_s => DisplayUnit::MILLISECOND.text(delay_s, 3),
    });
    let [overshoot, settling] = steps(view, one);
    let rise = requires_rise(view).then(|| {
        let reached = one.steps.as_ref().map(|steps| steps.rise_time_s);
        or_missing(reached.map(|time_s| time_words(time_s, "not risen")))
    });
    let mut cells = vec![
        reached_words(one).into(),
        Cell::count(one.order),
        ending_words(view, one).into(),
        one.least.as_ref().map_or(Cell::Missing, |least| Cell::margin(least.margin_db)),
        or_missing(binding(view, one).or_else(|| led_words(view, one))),
        or_missing(crossover),
        or_missing(delay),
        or_missing(gain),
        or_missing(compared),
        or_missing(overshoot),
        or_missing(settling),
    ];
    cells.extend(rise);
    cells
}

/// True if a rise time is required.
fn requires_rise(view: &ProjectDesign) -> bool {
    let required = view.designed.view.in_time.first();
    required.is_some_and(|finding| finding.requirement.step_limits.rise_time_s.is_some())
}

/// A time in s; infinite if the response does not settle or rise that far.
fn time_words(time_s: f64, never: &str) -> String {
    if time_s.is_finite() { DisplayUnit::MILLISECOND.text(time_s, 3) } else { never.to_string() }
}

/// The quantity by which structures are compared, in dB; the noise gain |G/(1+L)| has the unit of
/// G.
fn compared_words(view: &ProjectDesign, value_db: f64) -> String {
    let value = significant(value_db, 4);
    match view.options.objective {
        Objective::LeastHighFrequencyGain => gain_at_high_frequency(&value, 0, view.controlled_unit()),
        Objective::LeastBandwidth | Objective::BestWorstMargin => format!("{value} dB"),
    }
}

/// The worst overshoot and settling time.
fn steps(view: &ProjectDesign, one: &ReachedStructure) -> [Option<String>; 2] {
    let Some(reached) = reached_steps(view, one) else { return [None, None] };
    let [overshoot, settling] = reached;
    [
        overshoot.map(|percent| format!("{} %", significant(percent, 3))),
        settling.map(|time_s| time_words(time_s, "not settled")),
    ]
}

/// Percent and s, as far as they are required.
pub(super) fn reached_steps(view: &ProjectDesign, one: &ReachedStructure) -> Option<[Option<f64>; 2]> {
    let (reached, required) = (one.steps?, view.designed.view.in_time.first()?.requirement.step_limits);
    Some([
        required.overshoot_percent.map(|_| reached.overshoot_percent),
        required.settling_time_s.map(|_| reached.settling_time_s),
    ])
}

/// True if linear steps of a structure miss a requirement in time.
fn has_late_steps(view: &ProjectDesign, one: &ReachedStructure) -> bool {
    let Some((reached, finding)) = one.steps.zip(view.designed.view.in_time.first()) else { return false };
    finding.requirement.follows && finding.requirement.step_limits.excess(&reached) > 1.0
}

/// The same of a structure that keeps every limit.
pub(super) fn misses_in_time(view: &ProjectDesign, one: &ReachedStructure) -> bool {
    one.ending == StructureEnding::Met && has_late_steps(view, one)
}

/// True if a run on the nonlinear rig misses the requirement, and the linear steps do not.
fn misses_on_rig_only(view: &ProjectDesign, one: &ReachedStructure) -> bool {
    let misses = one.misses_on_rig || one.is_chosen && view.misses_on_rig();
    misses && !has_late_steps(view, one)
}

/// A structure compared with the one that is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ComparedWithTaken {
    /// The structure is shorter, or one of the two values is unknown.
    Open,
    /// No gain.
    NotBetter,
    /// A gain smaller than its additional poles require.
    NotWorthItsPoles,
    /// A gain at least as large as its additional poles require.
    WorthItsPoles,
}

/// The gain of a structure over the one that is taken, in the quantity by which they are compared.
fn compare_with_taken(view: &ProjectDesign, one: &ReachedStructure) -> ComparedWithTaken {
    let taken = view.structures.iter().find(|other| other.is_chosen && other.order <= one.order);
    let Some((taken, earned_db)) = taken.zip(earned_per_pole_db(view)) else {
        return ComparedWithTaken::Open;
    };
    let Some((own_db, taken_db)) = one.compared_db.zip(taken.compared_db) else {
        return ComparedWithTaken::Open;
    };
    let further = (one.order - taken.order).max(1) as f64;
    match taken_db - own_db {
        gained_db if gained_db >= earned_db * further => ComparedWithTaken::WorthItsPoles,
        gained_db if gained_db > 0.0 && one.order > taken.order => ComparedWithTaken::NotWorthItsPoles,
        _ => ComparedWithTaken::NotBetter,
    }
}

fn ending_words(view: &ProjectDesign, one: &ReachedStructure) -> &'static str {
    let has_missed_run = one.misses_on_rig || one.is_chosen && view.misses_on_rig();
    let misses_steps = misses_in_time(view, one) || has_missed_run && has_late_steps(view, one);
    match one.ending {
        _ if misses_steps && one.is_chosen => "steps missed, nearest",
        _ if misses_steps => "steps missed",
        _ if one.is_chosen && has_missed_run => "nonlinear runs missed, nearest",
        _ if has_missed_run => "nonlinear runs missed",
        StructureEnding::Met if one.is_chosen => "met, taken",
        StructureEnding::Missed if one.is_chosen => "missed, nearest",
        StructureEnding::Missed => "missed",
        ending @ (StructureEnding::Met | StructureEnding::NotEarned) => {
            match (ending, compare_with_taken(view, one)) {
                (StructureEnding::Met, ComparedWithTaken::Open | ComparedWithTaken::WorthItsPoles) => "met",
                (StructureEnding::Met, ComparedWithTaken::NotBetter) => "met, not better",
                (StructureEnding::Met, ComparedWithTaken::NotWorthItsPoles) => "met, not worth its poles",
                (_, ComparedWithTaken::NotBetter) => "not better",
                (_, ComparedWithTaken::NotWorthItsPoles) => "not worth its poles",
                (_, ComparedWithTaken::Open | ComparedWithTaken::WorthItsPoles) => GIVEN_UP,
            }
        }
        StructureEnding::NotConverged => "not converged",
        StructureEnding::NotStabilised => "not stabilised",
    }
}
