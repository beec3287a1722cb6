//! Findings on the columns, in sentences that are read in a minute: specifications that are met,
//! contradictions by the machine, the best values, dominance, and the costs of each alternative.

use phea_engineering::alternatives::{
    AlternativeColumns, Alternatives, ColumnKey, ComparedMeasure, ComparedMeasures, JudgedAlternative,
    JudgedCase, MovedRange,
};
use phea_engineering::simulate::{ScenarioRun, required_of_run};
use phea_engineering::trial::Agreement;
use phea_qft::design::ControllerChoice;
use phea_qft::design::DesignStatus;

use super::words::{judge_error_words, measure_name};
use crate::caveat;
use crate::design::verdict_sentence;
use crate::grouped::grouped;
use crate::project::{AS_DECLARED, ImpedanceForm, LINEAR_PARAMETERS};
use crate::quantity::{DisplayUnit, MotionKind, MotionWords, fitting, significant};
use crate::simulate::requirement_sentence;
use crate::trial::{finding_words, run_name};

/// Findings for the declared load, and then for each load case.
pub(crate) fn findings(found: &Alternatives) -> Vec<String> {
    let mut sentences = of_judged(&found.judged, found.not_reached.len());
    sentences.extend(ranges(&found.judged));
    sentences.extend(costs(&MeasuredAlternatives::of(found.judged.iter())));
    sentences.extend(found.not_reached.iter().map(|name| format!("{name}: not reached")));
    for case in &found.cases {
        sentences.extend(of_case(case).into_iter().map(|sentence| format!("{}: {sentence}", case.name)));
    }
    sentences
}

/// Findings for a load case.
pub(super) fn of_case(case: &JudgedCase) -> Vec<String> {
    let not_reached = case.not_reached.iter().map(|name| format!("{name}: not reached"));
    of_judged(&case.judged, case.not_reached.len()).into_iter().chain(not_reached).collect()
}

fn of_judged(judged: &[JudgedAlternative], not_reached: usize) -> Vec<String> {
    let mut sentences = specifications(judged, not_reached);
    sentences.extend(judged.iter().flat_map(missing));
    sentences.extend(grouped_by_sentence(judged, judged.iter().flat_map(lacking)));
    let comparable = MeasuredAlternatives::of(judged.iter().filter(|one| one.is_comparable()));
    sentences.extend(best(&comparable));
    sentences.extend(dominance(&comparable));
    sentences
}

/// Alternatives with the measures that are known for all of them.
struct MeasuredAlternatives {
    motion: MotionKind,
    measures: Vec<ComparedMeasure>,
    all: Vec<(String, ComparedMeasures)>,
}

impl MeasuredAlternatives {
    /// Selects the alternatives that have the four measures.
    fn of<'j>(judged: impl Iterator<Item = &'j JudgedAlternative>) -> MeasuredAlternatives {
        let mut judged = judged.peekable();
        let motion = judged.peek().map(|one| one.loaded.project.motion()).unwrap_or_default();
        let columns: Vec<_> = judged.map(|one| (one.name.clone(), one.columns())).collect();
        let four = ComparedMeasure::of_all(&[]);
        let has_four = |columns: &AlternativeColumns| ComparedMeasures::of(columns, &four).is_some();
        let columns: Vec<_> = columns.into_iter().filter(|(_, columns)| has_four(columns)).collect();
        let (names, columns): (Vec<_>, Vec<_>) = columns.into_iter().unzip();
        let measures = ComparedMeasure::of_all(&columns);
        let measured = columns.iter().filter_map(|columns| ComparedMeasures::of(columns, &measures));
        MeasuredAlternatives { motion, all: names.into_iter().zip(measured).collect(), measures }
    }

    /// The measures in words.
    fn words(&self) -> String {
        let further = self.measures.iter().skip(FOUR.len());
        let further = further.map(|measure| measure_name(measure.key, self.motion));
        let all: Vec<&str> = FOUR.into_iter().chain(further).collect();
        match all.split_last() {
            Some((last, others)) => format!("{} and {last}", others.join(", ")),
            None => String::new(),
        }
    }
}

/// The measures of dominance in words.
const FOUR: [&str; 4] = ["disturbance", "control effort", "order", "delay tolerated"];

/// Requirements in time that an alternative misses in its scenarios.
fn missing(one: &JudgedAlternative) -> Vec<String> {
    let Ok(runs) = &one.runs else { return vec![] };
    let missed = |run: &ScenarioRun| -> Vec<String> {
        let found = required_of_run(&one.loaded.project, run).into_iter();
        let missed = found.filter(|held| held.is_satisfied() == Some(false));
        missed.map(|held| format!("{} in `{}` {}", one.name, run.name, requirement_sentence(&held))).collect()
    };
    runs.iter().flat_map(missed).collect()
}

/// Sentences on alternatives that meet every specification, on those that miss some and by how
/// much, and on other outcomes of a design.
fn specifications(judged: &[JudgedAlternative], not_reached: usize) -> Vec<String> {
    let named = |which: &dyn Fn(&JudgedAlternative) -> Option<String>| {
        judged.iter().filter_map(which).collect::<Vec<_>>()
    };
    let met = named(&|one| (one.feasible() == Some(true)).then(|| one.name.clone()));
    let missed = named(&|one| {
        let status = &one.design.as_ref().ok()?.design.status;
        let DesignStatus::Infeasible(relaxation) = status else { return None };
        Some(format!("{} ({} dB)", one.name, significant(relaxation.relaxation_db, 2)))
    });
    let mut sentences = vec![];
    match (met.as_slice(), judged.len()) {
        ([], _) => {}
        (met, all) if met.len() == all => {
            let which = if not_reached > 0 { "all that were reached" } else { "all" };
            sentences.push(format!("{which} satisfy every specification"));
        }
        (met, _) => sentences.push(format!("every specification is satisfied by: {}", met.join(", "))),
    }
    if !missed.is_empty() {
        sentences.push(format!(
            "no controller tried{} does, unless every limit is wider by the amount given in brackets: {}",
            order_words(judged),
            missed.join(", ")
        ));
    }
    let otherwise = named(&|one| match &one.design {
        Err(reason) => Some(format!("{}: not judged: {}", one.name, judge_error_words(reason))),
        Ok(view) if matches!(view.design.status, DesignStatus::Infeasible(_)) => None,
        Ok(_) if one.feasible() == Some(true) => None,
        Ok(view) => {
            Some(format!("{}: {}", one.name, verdict_sentence(&view.verdict(), one.loaded.project.motion())))
        }
    });
    sentences.extend(otherwise);
    sentences
}

/// The greatest order, if the orders were free and equal for all.
fn order_words(judged: &[JudgedAlternative]) -> String {
    let orders = judged.iter().filter_map(|one| match one.design.as_ref().ok()?.options.controller {
        ControllerChoice::Grow { maximum_order } | ControllerChoice::Any { maximum_order, .. } => {
            Some(maximum_order)
        }
        ControllerChoice::Given(_) | ControllerChoice::Named { .. } => None,
    });
    let orders: Vec<usize> = orders.collect();
    match orders.first() {
        Some(first) if orders.iter().all(|order| order == first) => format!(" of order {first} at most"),
        _ => String::new(),
    }
}

/// Each sentence once, after the names of all alternatives to which it applies; if it applies to
/// most of them, after the names of the exceptions.
fn grouped_by_sentence<'a>(
    judged: &'a [JudgedAlternative],
    sentences: impl Iterator<Item = (&'a str, String)>,
) -> Vec<String> {
    let others = |names: &[&str]| {
        let others = judged.iter().map(|one| one.name.as_str()).filter(|name| !names.contains(name));
        others.collect::<Vec<_>>()
    };
    let words = |(sentence, names): (String, Vec<&str>)| match others(&names).as_slice() {
        [] if names.len() > 1 => format!("all: {sentence}"),
        others if names.len() > 3 * others.len() && names.len() > 3 => {
            format!("all but {}: {sentence}", others.join(", "))
        }
        _ => format!("{}: {sentence}", names.join(", ")),
    };
    grouped(sentences.map(|(name, sentence)| (sentence, name))).into_iter().map(words).collect()
}

/// Contradictions by the machine, effects that the verdict leaves out, and the reason why nothing
/// was driven.
fn lacking(one: &JudgedAlternative) -> Vec<(&str, String)> {
    let view = one.design.as_ref().ok();
    let runs =
        view.and_then(|view| view.trial.as_ref()).map(|trial| trial.runs.as_slice()).unwrap_or_default();
    let contradicts: Vec<_> = runs.iter().filter(|run| run.agreement == Agreement::Contradicts).collect();
    let contradicts = contradicts.split_first().map(|(first, further)| {
        // the remedy is in the reason after the first sentence, and with `design`
        let reason = finding_words(&first.reason.finding, first.units);
        let further = match further.len() {
            0 => String::new(),
            1 => ", and in another run".to_string(),
            count => format!(", and in {count} further runs"),
        };
        format!("the nonlinear simulation contradicts the verdict: {}: {reason}{further}", run_name(first))
    });
    let caveats = view.map(|view| &view.designed.view);
    let caveats = caveats.into_iter().flat_map(|view| caveat::sentences(&view.caveats, &view.units));
    let impedance = impedance(one).into_iter().flatten();
    let not_driven = one.runs.as_ref().err().filter(|_| view.is_some()).map(|reason| reason.to_string());
    contradicts
        .into_iter()
        .chain(caveats)
        .chain(impedance)
        .chain(not_driven)
        .map(|sentence| (one.name.as_str(), sentence))
        .collect()
}

/// Properties that are compared for a loop with a virtual impedance at the load.
fn impedance(one: &JudgedAlternative) -> Option<Vec<String>> {
    let declared = one.loaded.project.controller.as_ref()?.impedance?;
    let MotionWords { force, position, .. } = one.loaded.project.motion().words();
    let form = (declared.form == ImpedanceForm::Admittance).then(|| {
        format!(
            "designed as the same loop with form = \"impedance\": of the {position} it is C_x = G (M_v s^2 + B_v s + K_v)"
        )
    });
    let disturbance_words = format!(
        "the disturbance is the whole change of the {force}, and counts what the virtual impedance asks for: the impedances at the \
         load show how near it comes"
    );
    Some(form.into_iter().chain([disturbance_words]).collect())
}

/// The ranges that follow a rig, in one sentence.
fn ranges(judged: &[JudgedAlternative]) -> Option<String> {
    let each = judged.iter().flat_map(|one| {
        let motion = one.loaded.project.motion();
        one.moved.iter().map(move |range| moved_words(&one.name, range, motion))
    });
    let each: Vec<String> = each.collect();
    (!each.is_empty()).then(|| format!("ranges that follow the rig: {}", each.join("; ")))
}

fn moved_words(name: &str, range: &MovedRange, motion: MotionKind) -> String {
    let [[_, least, greatest], [_, less, more]] = [range.stated, range.moved];
    let known = LINEAR_PARAMETERS.iter().find(|parameter| parameter.key.name == range.name);
    let unit = known.map_or(DisplayUnit::ONE, |known| match known.key.dimension.si {
        "N/m" => motion.unit(DisplayUnit::MEGANEWTON_PER_METRE),
        _ => fitting(more.abs(), motion.dimension(known.key.dimension)),
    });
    let number = |value: f64| unit.number(value, 3);
    let moved = unit.with_symbol(format!("{} to {}", number(less), number(more)));
    let stated = unit.with_symbol(format!("{} to {}", number(least), number(greatest)));
    format!("{name}, {} {moved} in place of {stated}", range.name)
}

/// The best alternative in each measure, among those that may be compared.
fn best(comparable: &MeasuredAlternatives) -> Option<String> {
    let MeasuredAlternatives { measures, all, motion } = comparable;
    if all.len() < 2 {
        return None;
    }
    let each = measures.iter().enumerate().map(|(index, measure)| {
        let values = all.iter().map(|(_, measures)| measures.0[index]);
        let best = values.reduce(if measure.is_more() { f64::max } else { f64::min }).unwrap_or_default();
        let names = all.iter().filter(|(_, measures)| measures.0[index] == best);
        let names: Vec<&str> = names.map(|(name, _)| name.as_str()).collect();
        let most = if measure.is_more() { "most" } else { "least" };
        let name = measure_name(measure.key, *motion);
        format!("{most} {name} {} ({})", words_of(measure, best), names.join(", "))
    });
    let each: Vec<String> = each.collect();
    Some(format!(
        "best of those that satisfy every specification and that the nonlinear simulation does not contradict: {}",
        each.join("; ")
    ))
}

/// Dominance among the alternatives that satisfy every specification, on the machine too.
fn dominance(comparable: &MeasuredAlternatives) -> Vec<String> {
    let MeasuredAlternatives { measures, all, .. } = comparable;
    if all.len() < 2 {
        return vec![];
    }
    let each = all.iter().filter_map(|(name, own)| {
        let dominated = all.iter().filter(|(_, other)| own.dominates(other, measures));
        let dominated: Vec<&str> = dominated.map(|(other, _)| other.as_str()).collect();
        (!dominated.is_empty()).then(|| format!("{name} dominates {}", dominated.join(", ")))
    });
    let each: Vec<String> = each.collect();
    let words = comparable.words();
    vec![match each.as_slice() {
        [] => format!("none of these dominates another in {words}"),
        each => format!("no worse in {words}, and better in one: {}", each.join("; ")),
    }]
}

/// Gains and costs of each alternative relative to the project as declared.
fn costs(found: &MeasuredAlternatives) -> Vec<String> {
    let Some(((base, given), others)) = found.all.split_first() else { return vec![] };
    if base != AS_DECLARED {
        return vec![];
    }
    others.iter().map(|(name, other)| cost(name, (other, given), found)).collect()
}

fn cost(
    name: &str,
    (other, base): (&ComparedMeasures, &ComparedMeasures),
    MeasuredAlternatives { motion, measures, .. }: &MeasuredAlternatives,
) -> String {
    let (mut better, mut worse) = (Vec::new(), Vec::new());
    for (index, measure) in measures.iter().enumerate() {
        let [own, given] = [other.0[index], base.0[index]];
        let [shown, instead] = [own, given].map(|value| words_of(measure, value));
        if shown == instead {
            continue;
        }
        let side = if (own > given) == measure.is_more() { &mut better } else { &mut worse };
        side.push(format!("{} {shown} instead of {instead}", measure_name(measure.key, *motion)));
    }
    let side =
        |word: &str, parts: &[String]| (!parts.is_empty()).then(|| format!("{word} in {}", parts.join(", ")));
    let sides: Vec<String> = [side("better", &better), side("worse", &worse)].into_iter().flatten().collect();
    match sides.as_slice() {
        [] => {
            let count = match measures.len() {
                4 => "four",
                5 => "five",
                _ => "six",
            };
            format!("{name} against {AS_DECLARED}: the same in all {count}")
        }
        sides => format!("{name} against {AS_DECLARED}: {}", sides.join("; ")),
    }
}

fn words_of(measure: &ComparedMeasure, value: f64) -> String {
    match measure.key {
        ColumnKey::DisturbancePeak => measure.unit.text(value, 3),
        ColumnKey::ControlRms => DisplayUnit::VOLT.text(value, 3),
        ColumnKey::DelayMargin => DisplayUnit::MILLISECOND.text(value, 3),
        ColumnKey::PartsPrice => measure.unit.text(value, 4),
        ColumnKey::PartsMass => measure.unit.text(value, 3),
        _ => significant(value, 1),
    }
}
