//! A sizing for people.

use phea_engineering::sizing::{
    Candidate, Consequence, Influence, OtherMeans, OtherMeansError, SizedGas, SizedLoad, SizedPipe,
    SizedSpring, SizedValve, Sizing,
};

use super::answer::branch_name;
use super::words::{
    coil_unknown_words, decisions, hose_name, length_words, model_name, reason_words, setting_cell,
    uncertain_name, warnings,
};
use crate::answer::significant;
use crate::document::{Cell, Document, StatusMark, Table};
use crate::figure::Figure;
use crate::grouped::grouped;
use crate::quantity::{DisplayUnit, LENGTH, MASS, PRESSURE, Units, VOLUME};

/// Every decision, the candidates with the objections to them, the answer with its figures, and the
/// uncertainties.
pub(crate) fn document(sizing: &Sizing, figures: Vec<Figure>, units: &Units) -> Document {
    let mut out = Document::default();
    out.warnings(warnings(sizing, units));
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
    out.heading(format!("The {} of the hose by other means", mega(found.stiffness).text()));
    let cell = |found: Result<Cell, &OtherMeansError>| {
        found.unwrap_or_else(|reason| Cell::Missing.then(format!(" ({reason})")))
    };
    let mut rows = Table::new(["means", "size"]);
    rows.row(["chambers without any line".into(), mega(found.chambers)]);
    rows.row(["pipe".into(), cell(found.pipe.as_ref().map(pipe))]);
    rows.row(["gas at the chambers".into(), cell(found.gas.as_ref().map(gas))]);
    rows.row(["spring on the rod".into(), cell(found.spring.as_ref().map(spring))]);
    match &found.valves {
        Err(reason) => rows.row(["valve between the chambers".into(), cell(Err(reason))]),
        Ok(valves) => {
            for valve in valves {
                let name = Cell::from("valve between the chambers, K_H ").then(mega(valve.stiffness));
                rows.row([name, valve_cell(valve)]);
            }
        }
    }
    let without = found.actuator_length.map_or_else(
        || Cell::Missing.then(" (not stated: cylinder.dead_length)"),
        |long| length(long).then(" with any of them but the spring"),
    );
    rows.row(["length of the actuator, retracted".into(), without]);
    out.table(rows);
    out.explanation("Pipe, gas and spring stand in place of the hose: K_H is that of chambers and pipe, of chambers and gas, or of chambers and spring in series. A valve between the chambers does not soften: it damps the mode of the load cell, of the rig as it is declared and of its chambers without any line.");
}

fn mega(stiffness: f64) -> Cell {
    Cell::quantity(stiffness, 3, DisplayUnit::MEGANEWTON_PER_METRE)
}

fn length(value: f64) -> Cell {
    Cell::customary(value, 3, &LENGTH)
}

fn pipe(pipe: &SizedPipe) -> Cell {
    let lengths = length(pipe.length).then(" of ").then(length(pipe.bore));
    lengths.then(Cell::customary(pipe.oil, 3, &VOLUME).between(" bore a line, with ", " of oil in both"))
}

fn gas(gas: &SizedGas) -> Cell {
    let [soft, stiff] = gas.stiffness.map(mega);
    let size = Cell::customary(gas.volume, 3, &VOLUME).then(" at ").then(Cell::customary(
        gas.precharge,
        3,
        &PRESSURE,
    ));
    let stiffness =
        soft.between(" at each chamber: K_H at its least over the stroke from ", " to ").then(stiff);
    let ratio = Cell::number(gas.pressure_ratio, 3).between(
        " over the forces; at the supply pressure the gas has ",
        " times the absolute pressure of its precharge",
    );
    size.then(stiffness).then(ratio)
}

fn spring(spring: &SizedSpring) -> Cell {
    let wound = spring.coil.as_ref().map_or_else(
        |reason| format!("how it is wound is not known ({})", coil_unknown_words(*reason)).into(),
        |coil| {
            let wire = length(coil.wire_diameter).between("two coils of ", " wire with ");
            let turns = Cell::number(coil.active_coils, 3).then(" active turns each, ");
            let both = length(coil.installed_length).then(" and ").then(Cell::customary(coil.mass, 3, &MASS));
            wire.then(turns).then(both).then(" together")
        },
    );
    let travel = length(spring.travel).between(", ±", " under the stall force; ");
    let cell = mega(spring.stiffness).then(travel).then(wound);
    match spring.actuator_length {
        Some(long) => cell.then(length(long).between("; the actuator is ", " long")),
        None => cell,
    }
}

/// Damping by a valve, and its cost.
fn valve_cell(valve: &SizedValve) -> Cell {
    let unit = DisplayUnit { symbol: "m3/(s.Pa)", in_si: 1.0 };
    let [ratio, at] = valve.most;
    let most = Cell::number(ratio, 3).then(" at most, with ");
    let own_damping = Cell::number(valve.damping_ratio_without_valve, 3);
    let Some(conductance) = valve.conductance else {
        let from =
            own_damping.between(" (no conductance damps the load cell so much: from ", " without it to ");
        return Cell::Missing.then(from).then(most).then(Cell::quantity(at, 3, unit)).then(")");
    };
    let from = own_damping.between(", from a damping ratio of ", " without it");
    let loss = valve.loss.map_or_else(Cell::empty, |watt| {
        Cell::quantity(watt, 3, DisplayUnit::WATT).between("; it loses ", " at the greatest force")
    });
    let found = Cell::quantity(conductance, 3, unit).then(from).then(loss);
    found.then("; ").then(most).then(Cell::number(at, 3))
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
    let newton_per_metre = DisplayUnit { symbol: "N/m", in_si: 1.0 };
    let metres = |length: f64| Cell::quantity(length, 4, DisplayUnit::METRE);
    let [fastest, slowest] = candidate.time_constant_s;
    let gain_unit = DisplayUnit { symbol: "V/N", in_si: 1.0 };
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
            true => metres(candidate.length_m()),
            false => Cell::listed(branch.lengths_m.map(metres), ", "),
        },
        Cell::number(stiffness.minimum, 4).then(" to ").then(Cell::quantity(
            stiffness.maximum,
            4,
            newton_per_metre,
        )),
        Cell::quantity(branch.gain_v_per_n, 3, gain_unit),
        Cell::number_in(fastest, 3, DisplayUnit::MILLISECOND).then(" to ").then(Cell::quantity(
            slowest,
            3,
            DisplayUnit::MILLISECOND,
        )),
    ]
}

fn influence_cells(influence: &Influence) -> [Cell; 4] {
    let three = |values: [f64; 3], unit: DisplayUnit| {
        Cell::listed(values.map(|value| Cell::number_in(value, 4, unit)), " · ")
    };
    [
        uncertain_name(influence.quantity).into(),
        setting_cell(influence),
        three(influence.stiffness_n_per_m, DisplayUnit::MEGANEWTON_PER_METRE),
        three(influence.length_m, DisplayUnit::METRE),
    ]
}
