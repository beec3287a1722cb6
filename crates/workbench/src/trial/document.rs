//! The trial of a verdict on the machine, for people.

use super::words::{
    have_one_name, largest_step_words, not_driven, percent_words, reason_words, run_name, units_of,
};
use super::{
    Agreement, BAND_PERCENT, Leg, MOST_OF_SCENARIOS, OVERSHOOT_ROOM_PERCENT, SETTLING_RATIO, SETTLING_ROOM,
    StepResponse, StepSize, Trial, TrialRun, TrialStep,
};
use crate::document::{Cell, Document, Table, capital};
use crate::figure::{FamilySteps, Figure, TimeSeries, Words};
use crate::plant_names::plant_words;
use crate::quantity::DisplayUnit;
use crate::simulate::{reached_words, required_words, satisfied_word};
use crate::verdict_words::agreement_word;
use phea_qft::verification::Verdict;

/// The agreement in words; if only the settling time differs, with those times.
fn headline(trial: &Trial) -> String {
    let agreement = trial.agreement();
    let is_but_for_settling = agreement == Agreement::AgreesButForSettling;
    with_detail(agreement, if is_but_for_settling { settling_apart(trial) } else { None })
}

/// The settling times that are furthest apart, of the nonlinear rig and of the linear loop.
fn settling_apart(trial: &Trial) -> Option<String> {
    let both = |run: &TrialRun| {
        let own_s = run.machine.as_ref()?.settling_time_s?;
        let slowest = run.legs.iter().find(|(_, step)| step.settling_time_s == Some(own_s));
        let is_back = slowest.is_some_and(|(leg, _)| *leg == Leg::Back);
        Some((own_s, run.linear.as_ref()?.settling_time_s?, ends_words(run, is_back)))
    };
    let apart = |own_s: &f64, linear_s: &f64| (own_s / linear_s).max(linear_s / own_s);
    let furthest = trial.runs.iter().filter_map(both);
    let (own_s, linear_s, step) = furthest.max_by(|(one, of_one, _), (other, of_other, _)| {
        apart(one, of_one).total_cmp(&apart(other, of_other))
    })?;
    let [own, linear] = [own_s, linear_s].map(|time_s| DisplayUnit::MILLISECOND.text(time_s, 3));
    Some(format!("{own} for the linear {linear} ({BAND_PERCENT} %, {step})"))
}

fn with_detail(agreement: Agreement, detail: Option<String>) -> String {
    let word = agreement_word(agreement);
    detail.map_or(word.to_string(), |detail| format!("{word}: {detail}"))
}

/// A trial, with its figure if that has a name and a title.
pub(crate) fn document(trial: &Trial, figure_words: Option<[&str; 2]>) -> Document {
    let mut out = Document::default();
    let agreement = trial.agreement();
    out.verdict(agreement.into(), format!("Nonlinear simulation: {}", headline(trial)), vec![]);
    let did = match agreement {
        Agreement::Agrees => "agrees with the linear loop",
        Agreement::AgreesButForSettling => "agrees with the linear loop but for the settling time",
        Agreement::Differs => "differs from the linear loop",
        Agreement::Contradicts => "contradicts the verdict",
    };
    out.explanation(format!(
        "The nonlinear simulation {did}. The nonlinear rig under this controller: steps of the reference there, back and there again, {}, compared with those of the linear loop. Of the three steps the worst numbers are given; a {} within {BAND_PERCENT} % of the step has settled.",
        steps_words(trial),
        units_of(trial).motion.words().force
    ));
    let settles = format!("settles in ({BAND_PERCENT} %)");
    out.table(
        Table::new(["run", "step", "", "overshoot", "linear", &settles, "linear", "remains"])
            .with(distinct(trial).map(cells)),
    );
    out.sentences(reasons(trial));
    out.sentences(meanings(trial));
    out.append(required(trial));
    out.figures(figure_words.and_then(|words| figure(trial, words)));
    out
}

/// The steps through which machines were driven, in words.
fn steps_words(trial: &Trial) -> String {
    let of_scenarios =
        format!("by the steps of the scenarios (the {MOST_OF_SCENARIOS} largest of other sizes)");
    let force = units_of(trial).motion.words().force;
    let tenth = format!("by a tenth of the {force} that the supply can produce");
    let sizes = [
        (StepSize::Required, "by the required step"),
        (StepSize::Tenth, &tenth),
        (StepSize::Reversed, "by as much the other way"),
        (StepSize::Scenario, &of_scenarios),
        (StepSize::Largest, "by the largest step"),
    ];
    let driven = sizes.into_iter().filter(|(size, _)| trial.runs.iter().any(|run| run.size == *size));
    driven.map(|(_, words)| words).collect::<Vec<&str>>().join(", ")
}

fn cells(run: &TrialRun) -> [Cell; 8] {
    let settling = |step: Option<&TrialStep>| {
        let time_s = step.and_then(|step| step.settling_time_s);
        time_s.map_or(Cell::Missing, |time_s| Cell::quantity(time_s, 3, DisplayUnit::MILLISECOND))
    };
    let overshoot = |step: Option<&TrialStep>| {
        Cell::from(step.and_then(|step| step.overshoot_percent).map(percent_words))
    };
    let (linear, machine) = (run.linear.as_ref(), run.machine.as_ref());
    [
        run_name(run).into(),
        step_words(run).into(),
        Cell::agreement(run.agreement),
        overshoot(machine),
        overshoot(linear),
        settling(machine),
        settling(linear),
        run.remaining_amplitude_n.map_or(Cell::Missing, |amplitude| remaining_words(run, amplitude).into()),
    ]
}

/// The runs; those of the worst corners only if no other run has their plant and step.
fn distinct(trial: &Trial) -> impl Iterator<Item = &TrialRun> {
    trial.runs.iter().filter(|run| repeated(trial, run).is_none())
}

/// The run before this one with the same plant and steps.
fn repeated<'a>(trial: &'a Trial, run: &TrialRun) -> Option<&'a TrialRun> {
    let is_same = |other: &&TrialRun| {
        let is_of_plant = other.plant.is_some() && other.plant == run.plant;
        is_of_plant && other.size == run.size && other.reference_n == run.reference_n
    };
    let before = trial.runs.iter().take_while(|other| !std::ptr::eq(*other, run));
    before.into_iter().find(is_same)
}

/// Meanings of the words and of the last column of the table, as far as they occur.
fn meanings(trial: &Trial) -> Vec<String> {
    let motion = units_of(trial).motion;
    let force = motion.words().force;
    let mut sentences = vec![format!(
        "\"agrees\": the overshoot lies within {OVERSHOOT_ROOM_PERCENT} % of the step and the settling time within {} % of those of the linear loop, and the {force} comes to rest without a limit on the way",
        100.0 * SETTLING_ROOM
    )];
    if trial.runs.iter().any(|run| run.agreement == Agreement::AgreesButForSettling) {
        sentences.push(format!(
            "\"agrees but for the settling\": all of this except for the settling time, which is within a factor of {SETTLING_RATIO}"
        ));
    }
    let others = [
        (
            Agreement::Differs,
            "\"differs\": it settles, and is further from the linear loop than this, or meets a limit on the way",
        ),
        (
            Agreement::Contradicts,
            "\"contradicts\": it does not settle, ends early, or overshoots by more than the limit on |L/(1+L)| allows, under a verdict that is not violated",
        ),
    ];
    let driven = others.into_iter().filter(|(one, _)| trial.runs.iter().any(|run| run.agreement == *one));
    sentences.extend(driven.map(|(_, words)| words.to_string()));
    if trial.runs.iter().any(|run| run.size == StepSize::Largest) {
        let but = match trial.corners_lack_largest_step() {
            true => "; corners of the box and plants inside it are driven through the other steps alone",
            false => "",
        };
        sentences.push(format!("\"largest step\": {}{but}", largest_step_words(motion)));
    }
    if trial.runs.iter().any(|run| run.remaining_amplitude_n.is_some()) {
        sentences.push(format!(
            "\"remains\": half the range of the {force} over the last fifth of a step; a run steps there, back and there again, and the largest counts"
        ));
    }
    sentences
}

/// Requirements in time, run by run; empty if there are none.
fn required(trial: &Trial) -> Document {
    let mut out = Document::default();
    let Some(satisfies) = trial.satisfies() else { return out };
    let mut rows = Table::new(["run", "required", "", "reached"]);
    for (run, held) in distinct(trial).flat_map(|run| run.requirements.iter().map(move |held| (run, held))) {
        let verdict = if held.is_satisfied { Verdict::Met } else { Verdict::Violated };
        rows.row([
            run_name(run).into(),
            required_words(&held.step_limits).into(),
            Cell::from(satisfied_word(held.is_satisfied)).marked(verdict),
            reached_words(&held.step_limits, &held.reached).into(),
        ]);
    }
    let verdict = if satisfies { Verdict::Met } else { Verdict::Violated };
    let without_room = (satisfies && trial.lacks_room()).then(|| {
        "without room: a run comes back to the edge of its band so late that plants between those that were driven may leave it, so that `phea design` counts it as missed".to_string()
    });
    let without_room = Vec::from_iter(without_room);
    out.verdict(verdict.into(), format!("Required in time: {}", satisfied_word(satisfies)), without_room);
    out.explanation("The worst of the three steps of each run.");
    out.table(rows);
    out.sentences(corners(trial));
    out
}

/// The corner of the box, or the plant inside it, that is the worst, and the quantity in which it
/// is.
fn corners(trial: &Trial) -> Vec<String> {
    let is_corner = |run: &&TrialRun| trial.corners.iter().any(|corner| have_one_name(corner, run));
    let words = |run: &TrialRun| {
        Some(match repeated(trial, run) {
            Some(other) => format!("{}: that is {}", run_name(run), run_name(other)),
            None => format!("{}: {}", run_name(run), plant_words(run.plant.as_ref()?)),
        })
    };
    let mut sentences: Vec<String> = trial.runs.iter().filter(is_corner).filter_map(words).collect();
    if !sentences.is_empty() {
        sentences.push(
            "the worst of them is the one that takes the largest share of what is required".to_string(),
        );
    }
    sentences
}

/// Words for a step from one reference to the other.
fn step_words(run: &TrialRun) -> String {
    ends_words(run, false)
}

/// Words for a step from one reference to the other, or back.
fn ends_words(run: &TrialRun, is_back: bool) -> String {
    let [from, to] = run.reference_n.map(|force| run.units.force.short(force, 3));
    if is_back { format!("{to} to {from}") } else { format!("{from} to {to}") }
}

/// Fraction of the step below which an oscillation counts as none.
const NOTHING: f64 = 1e-4;

/// The amplitude of an oscillation that remains.
fn remaining_words(run: &TrialRun, amplitude_n: f64) -> String {
    let [from, to] = run.reference_n;
    let is_nothing = amplitude_n < NOTHING * (to - from).abs();
    format!("±{}", run.units.force.short(if is_nothing { 0.0 } else { amplitude_n }, 2))
}

/// Reason why a machine does not behave like the linear loop, and which plants were not driven.
fn reasons(trial: &Trial) -> Vec<String> {
    let others = trial.runs.iter().filter(|run| run.agreement != Agreement::Agrees);
    let sentences = others.map(|run| format!("{}: {}", run_name(run), reason_words(&run.reason, run.units)));
    sentences.chain(not_driven(trial).into_iter().map(|missing| format!("not driven: {missing}"))).collect()
}

/// Number of settling times of the linear loop that are drawn, and of required ones at least.
const SETTLING_TIMES: f64 = 3.0;
const REQUIRED_TIMES: f64 = 1.2;
/// Range of the frame, fractions of the step; a response that leaves it is drawn up to its edge.
const SHOWN: std::ops::RangeInclusive<f64> = -0.4..=2.4;

/// The steps of all machines that were driven, and that of the linear loop with the nominal plant.
fn figure(trial: &Trial, [name, title]: [&str; 2]) -> Option<Figure> {
    let runs = &trial.runs;
    let first = runs.first()?;
    let driven_s = first.machine_response.times_s.last().copied()?;
    let settles_s = first.linear.and_then(|step| step.settling_time_s);
    let required_s = first.requirements.iter().filter_map(|held| held.step_limits.settling_time_s);
    let seen_s = REQUIRED_TIMES * required_s.fold(0.0, f64::max);
    let end_s = settles_s.map_or(driven_s, |time_s| driven_s.min(seen_s.max(SETTLING_TIMES * time_s)));
    let series = |name: &str, response: &StepResponse| {
        let rows = response.times_s.iter().copied().zip(response.values.iter().copied());
        let shown = rows.take_while(|(time_s, value)| *time_s <= end_s && SHOWN.contains(value));
        let (times_s, values): (Vec<f64>, Vec<f64>) = shown.unzip();
        (!times_s.is_empty()).then(|| TimeSeries { name: name.to_string(), times_s, values })
    };
    let nominal = series("linear loop, nominal plant", &first.linear_response);
    let is_first = |size| matches!(size, StepSize::Tenth | StepSize::Required);
    let is_notable = |run: &TrialRun| run.agreement != Agreement::Agrees || !run.satisfies();
    let drawn = runs.iter().filter(|run| is_first(run.size) || is_notable(run));
    let named = drawn.filter_map(|run| series(&run_name(run), &run.machine_response)).collect();
    let force = units_of(trial).motion.words().force;
    let quantity = format!("{}, part of the step", capital(force));
    let chart = FamilySteps { quantity, nominal, named, ..FamilySteps::default() };
    let waves = if runs.iter().any(|run| run.quarter_wave_rad_per_s.is_some()) {
        " with waves in its lines,"
    } else {
        ""
    };
    let caption = format!(
        "The worst of three steps of the reference (there, back and there again) in the nonlinear simulation: of the rig as declared,{waves} and its worst plants made into rigs; of their other steps those that do not agree with the linear loop or miss what is required. A {force} that leaves the frame is drawn up to there."
    );
    Some(chart.draw(&Words::new(name, title, caption)))
}

/// The agreement in a few words: the word, and its basis.
pub(crate) fn words(trial: &Trial) -> String {
    with_detail(trial.agreement(), agreement_detail(trial))
}

/// The settling times that differ most, if nothing else differs, or the worst machine; `None` if
/// every run agrees.
pub(crate) fn agreement_detail(trial: &Trial) -> Option<String> {
    let agreement = trial.agreement();
    match agreement {
        Agreement::Agrees => None,
        Agreement::AgreesButForSettling => settling_apart(trial),
        Agreement::Differs | Agreement::Contradicts => {
            trial.runs.iter().find(|run| run.agreement == agreement).map(run_name)
        }
    }
}
