//! Requirements in time, and a prefilter that amplifies, in sentences.

use phea_qft::verification::Verdict;

use super::{PrefilterGain, ProjectAudit, TimeFinding, TimeOutcome, Unexamined, WorstStep};
use crate::answer::significant;
use crate::plant_names::plant_text;
use crate::simulate::required_words;
use crate::specification::numbered;
use crate::verdict_words::{frequency_words, margin_words};

/// `2 tracking in time: at most 5 % overshoot and settled within 2 % in 0.8 s are required and not
/// met; ...`
pub(crate) fn sentence(view: &ProjectAudit, finding: &TimeFinding) -> String {
    let name = match finding.requirement.limits {
        Some(index) => format!("{} in time", numbered(view.named(index))),
        None => format!("{} step", finding.requirement.number),
    };
    let required = required_words(&finding.requirement.step_limits);
    let (plants, worst) = match &finding.outcome {
        TimeOutcome::NotExamined(why) => {
            return format!("{name} is not examined: {}; required is {required}", unexamined_words(why));
        }
        TimeOutcome::Searched { plants, overshoot, settling, rise } => (plants, [overshoot, settling, rise]),
    };
    let [overshoot, settling, rise] = worst.map(Option::as_ref);
    let worst = [
        overshoot.map(|worst| at(view, &overshoot_words(worst), worst)),
        settling.map(|worst| at(view, &settling_words(worst), worst)),
        rise.map(|worst| at(view, &rise_words(worst), worst)),
    ];
    let worst: Vec<String> = worst.into_iter().flatten().collect();
    let word = if finding.verdict() == Some(Verdict::Met) { "met" } else { "not met" };
    let steps = if *plants == 1 {
        "the linear step of its plant".to_string()
    } else {
        format!("the linear steps of {plants} plants")
    };
    format!("{name} is {word}: {required}; {steps}, a search: {}", worst.join(", "))
}

fn at(view: &ProjectAudit, words: &str, worst: &WorstStep) -> String {
    let plant = plant_text(&view.names, &worst.plant);
    if plant.is_empty() { words.to_string() } else { format!("{words} ({plant})") }
}

/// `2.20 % overshoot`
fn overshoot_words(worst: &WorstStep) -> String {
    if worst.value < 0.01 {
        "no overshoot".into()
    } else {
        format!("{} % overshoot", significant(worst.value, 3))
    }
}

/// `settled in 1.08 s`
fn settling_words(worst: &WorstStep) -> String {
    match worst.value {
        f64::INFINITY => "not settled within the time that was computed".to_string(),
        time_s => format!("settled in {} s", significant(time_s, 3)),
    }
}

/// `risen in 0.12 s`
fn rise_words(worst: &WorstStep) -> String {
    match worst.value {
        f64::INFINITY => "not risen to 90 % within the time that was computed".to_string(),
        time_s => format!("risen from 10 to 90 % in {} s", significant(time_s, 3)),
    }
}

/// Requirements that are missed: `settled in 1.08 s at worst where 0.8 s is required`.
pub(crate) fn missed(finding: &TimeFinding) -> Vec<String> {
    let TimeOutcome::Searched { overshoot, settling, rise, .. } = &finding.outcome else { return vec![] };
    let required = &finding.requirement.step_limits;
    let open = |worst: &&WorstStep| !worst.is_satisfied;
    let of_overshoot = overshoot.as_ref().filter(open).zip(required.overshoot_percent);
    let of_settling = settling.as_ref().filter(open).zip(required.settling_time_s);
    let of_rise = rise.as_ref().filter(open).zip(required.rise_time_s);
    let mut missed = Vec::new();
    missed.extend(
        of_overshoot
            .map(|(worst, most)| format!("{} at worst where {most} % is the most", overshoot_words(worst))),
    );
    missed.extend(
        of_settling
            .map(|(worst, most)| format!("{} at worst where {most} s is required", settling_words(worst))),
    );
    missed.extend(
        of_rise.map(|(worst, most)| format!("{} at worst where {most} s is required", rise_words(worst))),
    );
    missed
}

/// Reason why no step was computed.
pub(crate) fn unexamined_words(why: &Unexamined) -> String {
    match why {
        Unexamined::NoPrefilter => {
            "without a prefilter the spread of the family is judged, and no response".to_string()
        }
        Unexamined::Measured => "measured plants have no step response".to_string(),
        Unexamined::NotStable => "not every plant is known to be stable".to_string(),
        Unexamined::Step(error) => format!("a step cannot be computed, {error}"),
    }
}

/// The gain of a prefilter that amplifies.
pub(crate) fn prefilter_sentence(gain: &PrefilterGain) -> String {
    let at_zero = match (gain.at_zero - 1.0).abs() < 5e-4 {
        true => String::new(),
        false => format!("its gain at zero frequency is {}, ", significant(gain.at_zero, 3)),
    };
    let rise = match gain.rise_db() {
        rise if rise < 0.1 => String::new(),
        rise => format!(
            "|F| rises to {} over that at zero frequency, {}, ",
            margin_words(rise),
            frequency_words(gain.frequency_rad_per_s)
        ),
    };
    format!(
        "the prefilter amplifies: {at_zero}{rise}so that it commands in advance what the loop itself does not do: the response then depends on the plant, and what is fast in the reference reaches the valve as much larger"
    )
}
