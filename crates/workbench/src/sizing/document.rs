//! A sizing for people.

use super::answer::branch_name;
use super::words::{
    coil_unknown_words, decisions, hose_name, length_words, model_name, reason_words, setting_words,
    uncertain_name,
};
use super::{Candidate, Consequence, Influence, OtherMeans, OtherMeansError, SizedLoad, SizedValve, Sizing};
use crate::answer::significant;
use crate::document::{Cell, Document, StatusMark, Table};
use crate::figure::Figure;
use crate::grouped::grouped;
use crate::quantity::{DisplayUnit, LENGTH, MASS, PRESSURE, VOLUME, display};

/// Every decision, the candidates with the objections to them, the answer with its figures, and the
/// uncertainties.
pub(crate) fn document(sizing: &Sizing, figures: Vec<Figure>) -> Document {
    let mut out = Document::default();
    out.heading("Procedure (letters as in the flowchart of Ledezma 2019, section 6.3.2)");
    out.sentences(decisions(&sizing.decisions).into_iter().map(|(step, text)| format!("({step}) {text}")));
    let headings = ["", "hose", "compliance", "branch", "length", "K_H over the stroke", "K_p", "tau"];
    out.section("Candidates", Table::new(headings).with(distinct(&sizing.candidates)));
    for group in alike(&sizing.candidates) {
        findings(&mut out, &group);
    }
    out.heading("Answer");
    let [own, other] =
        [sizing.model, sizing.other_model()].map(|model| (model_name(model), sizing.best_of(model)));
    out.marked([
        (Some(is_accepted(own.1).into()), format!("{} (the project's): {}", own.0, answer_sentence(own.1))),
        (Some(is_accepted(other.1).into()), format!("{}: {}", other.0, answer_sentence(other.1))),
    ]);
    out.figures(figures);
    if let Some(found) = &sizing.other_means {
        other_means(&mut out, found);
        if sizing.load != SizedLoad::Prescribed {
            out.explanation("The damping ratios are those with the load held still: `check` lists the modes with the load.");
        }
    }
    let headings = ["quantity", "low · nominal · high", "K_H at this length, MN/m", "length for this K_H, m"];
    out.section(
        "What is uncertain",
        Table::new(headings).with(sizing.influences.iter().map(influence_cells)),
    );
    if !sizing.influences.is_empty() {
        out.explanation("Each number goes from its low to its high value while all others stay nominal. Stiffening has its declared interval; where none is stated, 10 % either way is assumed.");
    }
    out
}

/// Other parts with the stiffness of the hose, and parts that damp the load cell.
fn other_means(out: &mut Document, found: &OtherMeans) {
    let mega = |value: f64| DisplayUnit::MEGANEWTON_PER_METRE.text(value, 3);
    let length = |value: f64| display(value, &LENGTH, 3);
    let pipe = found.pipe.as_ref().map(|pipe| {
        let oil = display(pipe.oil, &VOLUME, 3);
        format!("{} of {} bore a line, with {oil} of oil in both", length(pipe.length), length(pipe.bore))
    });
    let gas = found.gas.as_ref().map(|gas| {
        let [volume, precharge] = [display(gas.volume, &VOLUME, 3), display(gas.precharge, &PRESSURE, 3)];
        let ratio = significant(gas.pressure_ratio, 3);
        let [soft, stiff] = gas.stiffness.map(mega);
        format!(
            "{volume} at {precharge} at each chamber: K_H at its least over the stroke from {soft} to {stiff} over the forces; at the \
             supply pressure the gas has {ratio} times the absolute pressure of its precharge"
        )
    });
    let spring = found.spring.as_ref().map(|spring| {
        let wound = spring.coil.as_ref().map_or_else(
            |reason| format!("how it is wound is not known ({})", coil_unknown_words(*reason)),
            |coil| {
                let [wire, coils] = [length(coil.wire_diameter), significant(coil.active_coils, 3)];
                let [long, heavy] = [length(coil.installed_length), display(coil.mass, &MASS, 3)];
                format!(
                    "two coils of {wire} wire with {coils} active turns each, {long} and {heavy} together"
                )
            },
        );
        let actuator = spring.actuator_length.map(|long| format!("; the actuator is {} long", length(long)));
        let [stiffness, travel] = [mega(spring.stiffness), length(spring.travel)];
        format!("{stiffness}, ±{travel} under the stall force; {wound}{}", actuator.unwrap_or_default())
    });
    out.heading(format!("The {} of the hose by other means", mega(found.stiffness)));
    let cell =
        |found: Result<String, &OtherMeansError>| found.unwrap_or_else(|reason| format!("- ({reason})"));
    let mut rows = Table::new(["means", "size"]);
    rows.row(["chambers without any line".to_string(), mega(found.chambers)]);
    rows.row(["pipe".to_string(), cell(pipe)]);
    rows.row(["gas at the chambers".to_string(), cell(gas)]);
    rows.row(["spring on the rod".to_string(), cell(spring)]);
    match &found.valves {
        Err(reason) => rows.row(["valve between the chambers".to_string(), format!("- ({reason})")]),
        Ok(valves) => {
            for valve in valves {
                let name = format!("valve between the chambers, K_H {}", mega(valve.stiffness));
                rows.row([name, valve_words(valve)]);
            }
        }
    }
    let without = found.actuator_length.map_or_else(
        || "- (not stated: cylinder.dead_length)".to_string(),
        |long| format!("{} with any of them but the spring", length(long)),
    );
    rows.row(["length of the actuator, retracted".to_string(), without]);
    out.table(rows);
    out.explanation("Pipe, gas and spring stand in place of the hose: K_H is that of chambers and pipe, of chambers and gas, or of chambers and spring in series. A valve between the chambers does not soften: it damps the mode of the load cell, of the rig as it is declared and of its chambers without any line.");
}

/// Damping by a valve, and its cost.
fn valve_words(valve: &SizedValve) -> String {
    let [most, at] = valve.most.map(|value| significant(value, 3));
    let own_damping = significant(valve.damping_ratio_without_valve, 3);
    let Some(conductance) = valve.conductance else {
        return format!(
            "- (no conductance damps the load cell so much: from {own_damping} without it to {most} at most, with {at} m3/(s.Pa))"
        );
    };
    let loss = valve
        .loss
        .map(|watt| format!("; it loses {} at the greatest force", DisplayUnit::WATT.text(watt, 3)));
    format!(
        "{} m3/(s.Pa), from a damping ratio of {own_damping} without it{}; {most} at most, with {at}",
        significant(conductance, 3),
        loss.unwrap_or_default()
    )
}

fn is_accepted(best: Option<&Candidate>) -> bool {
    best.is_some_and(Candidate::accepted)
}

/// The hose to buy and the gain to set, in a sentence.
fn answer_sentence(best: Option<&Candidate>) -> String {
    match best {
        None => {
            "no hose of the catalogue satisfies every requirement; the reasons are listed with the candidates.".to_string()
        }
        Some(candidate) => format!(
            "{}{} with {}: K_H from {} to {} MN/m over the stroke, K_p = {} V/N.",
            if candidate.accepted() { "" } else { "not accepted before its working pressure is known: " },
            hose_name(&candidate.option.name),
            length_words(&candidate.branch, 3),
            DisplayUnit::MEGANEWTON_PER_METRE.number(candidate.branch.stiffness.minimum, 3),
            DisplayUnit::MEGANEWTON_PER_METRE.number(candidate.branch.stiffness.maximum, 3),
            significant(candidate.branch.gain_v_per_n, 3)
        ),
    }
}

/// Candidates of one hose that have equal findings when printed, so that these are stated once; in
/// the order of the first of each.
fn alike(candidates: &[Candidate]) -> Vec<Vec<&Candidate>> {
    let all = candidates.iter().map(|one| ((&one.option.name, marked_reasons(one)), one));
    grouped(all).into_iter().map(|(_, group)| group).collect()
}

/// The findings on a candidate, each after its consequence.
fn marked_reasons(candidate: &Candidate) -> Vec<(Option<StatusMark>, String)> {
    let marked = candidate.findings.iter().map(|finding| {
        let text = reason_words(finding);
        match finding.consequence() {
            Consequence::Rejects => (Some(StatusMark::Bad), format!("rejects: {text}")),
            Consequence::LeavesOpen => (Some(StatusMark::Bad), format!("not known: {text}")),
            Consequence::Warns => (Some(StatusMark::Note), format!("warns: {text}")),
        }
    });
    marked.collect()
}

/// The common objections to these candidates.
fn findings(out: &mut Document, group: &[&Candidate]) {
    let Some(first) = group.first().filter(|first| !first.findings.is_empty()) else { return };
    let verdict = match (first.accepted(), first.fits()) {
        (true, _) => "accepted",
        (false, true) => "not accepted, since a number is missing",
        (false, false) => "rejected",
    };
    let of = |one: &&Candidate| (model_name(one.branch.model), branch_name(one.branch.by_gain));
    let by_model = grouped(group.iter().map(of));
    let names: Vec<String> =
        by_model.into_iter().map(|(model, branches)| format!("{model} {}", branches.join(" and "))).collect();
    out.heading(format!("{} ({}): {verdict}", hose_name(&first.option.name), names.join(", ")));
    out.marked(marked_reasons(first));
}

/// A row for each candidate; branches that lead to equal numbers have a single row.
fn distinct(candidates: &[Candidate]) -> Vec<Vec<Cell>> {
    let mut rows: Vec<(Vec<Cell>, Vec<&'static str>)> = Vec::new();
    for candidate in candidates {
        let branch = branch_name(candidate.branch.by_gain);
        let cells = candidate_cells(candidate).to_vec();
        match rows.iter_mut().find(|(known, _)| *known == cells) {
            Some((_, branches)) => branches.push(branch),
            None => rows.push((cells, vec![branch])),
        }
    }
    let named = rows.into_iter().map(|(mut cells, branches)| {
        cells.insert(BRANCH, Cell::Code(branches.join(", ")));
        cells
    });
    named.collect()
}

/// Column of the branch in a row.
const BRANCH: usize = 3;

/// A candidate without its branch.
fn candidate_cells(candidate: &Candidate) -> [Cell; 7] {
    let branch = &candidate.branch;
    let stiffness = &branch.stiffness;
    let accepted = candidate.accepted();
    let [fastest, slowest] =
        candidate.time_constant_s.map(|time_s| DisplayUnit::MILLISECOND.number(time_s, 3));
    [
        Cell::from(match (accepted, candidate.fits()) {
            (true, _) => "yes",
            (false, true) => "not known",
            (false, false) => "no",
        })
        .marked(accepted),
        Cell::Code(hose_name(&candidate.option.name)),
        Cell::Code(model_name(branch.model).to_string()),
        match branch.is_alike() {
            true => format!("{} m", significant(candidate.length_m(), 4)).into(),
            false => branch.lengths_m.map(|length| format!("{} m", significant(length, 4))).join(", ").into(),
        },
        format!("{} to {} N/m", significant(stiffness.minimum, 4), significant(stiffness.maximum, 4)).into(),
        format!("{} V/N", significant(branch.gain_v_per_n, 3)).into(),
        format!("{fastest} to {slowest} ms").into(),
    ]
}

fn influence_cells(influence: &Influence) -> [String; 4] {
    let three = |values: [f64; 3]| values.map(|value| significant(value, 4)).join(" · ");
    let mega = DisplayUnit::MEGANEWTON_PER_METRE;
    [
        uncertain_name(influence.quantity).to_string(),
        setting_words(influence),
        three(influence.stiffness_n_per_m.map(|stiffness| mega.of(stiffness))),
        three(influence.length_m),
    ]
}
