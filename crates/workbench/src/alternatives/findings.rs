//! Findings on the columns, in sentences that are read in a minute: specifications that are met,
//! contradictions by the machine, the best values, dominance, and the costs of each alternative.

use phea_engineering::alternatives::{ColumnKey, ComparedMeasure, ComparedMeasures, WorstColumns};

use super::printed::{PrintedAlternative, PrintedAlternatives, PrintedCase};
use super::words::measure_name;
use crate::grouped::grouped;
use crate::project::AS_DECLARED;
use crate::quantity::{DisplayUnit, MotionKind, significant};

/// Findings for the declared load, and then for each load case.
pub(crate) fn findings(found: &PrintedAlternatives) -> Vec<String> {
    let mut sentences = of_judged(&found.judged, found.not_reached.len(), found.motion);
    sentences.extend(ranges(&found.judged));
    sentences.extend(costs(&MeasuredAlternatives::of(found.judged.iter(), found.motion)));
    sentences.extend(found.not_reached.iter().map(|name| format!("{name}: not reached")));
    for case in &found.cases {
        sentences.extend(
            of_case(case, found.motion).into_iter().map(|sentence| format!("{}: {sentence}", case.name)),
        );
    }
    sentences
}

/// Findings for a load case.
pub(super) fn of_case(case: &PrintedCase, motion: MotionKind) -> Vec<String> {
    let not_reached = case.not_reached.iter().map(|name| format!("{name}: not reached"));
    of_judged(&case.judged, case.not_reached.len(), motion).into_iter().chain(not_reached).collect()
}

fn of_judged(judged: &[PrintedAlternative], not_reached: usize, motion: MotionKind) -> Vec<String> {
    let mut sentences = specifications(judged, not_reached);
    sentences.extend(judged.iter().flat_map(|one| one.sentences.missed.clone()));
    sentences.extend(lacking(judged));
    let comparable = MeasuredAlternatives::of(judged.iter().filter(|one| one.is_comparable), motion);
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
    fn of<'j>(
        judged: impl Iterator<Item = &'j PrintedAlternative>,
        motion: MotionKind,
    ) -> MeasuredAlternatives {
        let four = ComparedMeasure::of_all(&[]);
        let has_four = |one: &&PrintedAlternative| ComparedMeasures::of(&one.worst, &four).is_some();
        let measured = judged.filter(has_four).map(|one| (one.name.clone(), one.worst.clone()));
        let (names, columns): (Vec<String>, Vec<WorstColumns>) = measured.unzip();
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

/// Sentences on alternatives that meet every specification, on those that miss some and by how
/// much, and on other outcomes of a design.
fn specifications(judged: &[PrintedAlternative], not_reached: usize) -> Vec<String> {
    let met = judged.iter().filter(|one| one.feasible == Some(true)).map(|one| one.name.clone());
    let met: Vec<String> = met.collect();
    let missed = judged.iter().filter_map(|one| {
        let relaxation_db = one.infeasible_by_db?;
        Some(format!("{} ({} dB)", one.name, significant(relaxation_db, 2)))
    });
    let missed: Vec<String> = missed.collect();
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
    sentences.extend(judged.iter().filter_map(|one| one.sentences.otherwise.clone()));
    sentences
}

/// The greatest order, if the orders were free and equal for all.
fn order_words(judged: &[PrintedAlternative]) -> String {
    let orders: Vec<usize> = judged.iter().filter_map(|one| one.maximum_order).collect();
    match orders.first() {
        Some(first) if orders.iter().all(|order| order == first) => format!(" of order {first} at most"),
        _ => String::new(),
    }
}

/// Effects that the verdicts do not include, each sentence once, after the names of all
/// alternatives to which it applies; if it applies to most of them, after the names of the
/// exceptions.
fn lacking(judged: &[PrintedAlternative]) -> Vec<String> {
    let sentences = judged.iter().flat_map(|one| {
        let lacking = one.sentences.lacking.iter();
        lacking.map(|sentence| (sentence.clone(), one.name.as_str()))
    });
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
    grouped(sentences).into_iter().map(words).collect()
}

/// The ranges that follow a rig, in one sentence.
fn ranges(judged: &[PrintedAlternative]) -> Option<String> {
    let each: Vec<&str> = judged.iter().flat_map(|one| &one.sentences.moved).map(String::as_str).collect();
    (!each.is_empty()).then(|| format!("ranges that follow the rig: {}", each.join("; ")))
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
