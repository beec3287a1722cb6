//! Sentences on the steps of a repair, and on the limits of what can be achieved.

use phea_engineering::design::{NEAREST_PROJECT, ProjectDesign, Repair, RepairRemedy, RepairStatus};
use phea_qft::verification::Verdict;

use crate::audit::{ProjectAudit, stability_sentence};
use crate::quantity::{DisplayUnit, significant};
use crate::specification::numbered;
use crate::trial::{Agreement, TrialRun, reason_words, run_name};
use crate::verdict_words::{agreement_word, frequency_words, margin_words};

/// The outcome for people.
pub(super) fn repair_words(status: RepairStatus) -> &'static str {
    match status {
        RepairStatus::Met => "met",
        RepairStatus::Infeasible { .. } => "infeasible",
        RepairStatus::NotConverged => "not converged",
        RepairStatus::NotStabilised => "not stabilised",
        RepairStatus::Stopped => "stopped",
        RepairStatus::NothingToAdd => "nothing to add",
    }
}

/// Sentences on the steps of a repair and the limits of what it can achieve.
pub(super) fn repair_sentences(view: &ProjectDesign, repair: &Repair) -> Vec<String> {
    let mut sentences = added(view, repair);
    if repair.status == RepairStatus::Met {
        sentences.extend(view.contradicting_waves().map(stable_with_waves));
    }
    sentences.extend(left(view.trial.iter().flat_map(|trial| &trial.runs)));
    sentences
}

/// Plants that were added, the result, and changes that would help if it failed.
fn added(view: &ProjectDesign, repair: &Repair) -> Vec<String> {
    if let Some(error) = &repair.no_family {
        return vec![format!("the plant with waves in its lines cannot be added: {error}")];
    }
    let Some(plant) = &repair.before else { return vec![] };
    if plant.audit.verdict == Verdict::Met {
        return view.contradicting_waves().map(stable_with_waves).into_iter().collect();
    }
    let Some(other) = repair.other.as_deref() else { return vec![none_found()] };
    let [first, found] = match repair.status {
        RepairStatus::Met => [other, view],
        _ => [view, other],
    };
    let mut sentences = vec![before(plant), outcome(repair, found)];
    sentences.extend(repair.after.iter().map(|after| with_waves(repair.status, after)));
    if repair.status != RepairStatus::Met {
        sentences.extend(crossing(repair, first));
        sentences.push(help(repair));
        sentences.extend(nearest(found));
        sentences.extend(not_led(found));
    }
    sentences.push(whole(repair.whole.as_ref()));
    sentences
}

/// Reason why the steps of the nearest controller were not its objective, if they miss the
/// requirement.
fn not_led(found: &ProjectDesign) -> Option<String> {
    let misses = found.designed.view.misses_in_time() || found.exceeded_command().is_some();
    misses.then(|| {
        "the search with the added plant is one over frequency, which the steps do not lead: `design` with `line.model = \"transmission_line\"` is led by them"
            .to_string()
    })
}

/// Knowledge about the plants that were not added.
fn whole(view: Option<&ProjectAudit>) -> String {
    let every = "with `line.model = \"transmission_line\"` waves are in every plant of the family";
    let words = match view {
        None => return format!("the plant of the rig itself was added: {every}"),
        Some(view) if view.verdict() == Verdict::Met => {
            "the controller satisfies every specification with those too".to_string()
        }
        Some(view) if view.audit.stability.verdict != Verdict::Met => {
            stability_sentence(&view.audit.stability, &view.names)
        }
        Some(view) => format!("every plant is stable, with {}", margins(view)),
    };
    format!(
        "the plant of the rig itself was added, and nothing is claimed about the others; {every}: {words}"
    )
}

/// The loop of the first design with the plant.
fn before(view: &ProjectAudit) -> String {
    let shown = match view.audit.stability.verdict {
        Verdict::Met => margins(view),
        _ => stability_sentence(&view.audit.stability, &view.names),
    };
    format!("the linear loop reproduces the nonlinear simulation once its plant includes waves: {shown}")
}

fn outcome(repair: &Repair, found: &ProjectDesign) -> String {
    let both = "over the family and with the waves at once";
    match repair.status {
        RepairStatus::Met => {
            let crossover =
                found.designed.figures.nominal.and_then(|nominal| nominal.crossovers.first_rad_per_s);
            let crossover = crossover
                .map_or(String::new(), |crossover| format!(", and crosses over at {}", frequency(crossover)));
            format!("that plant was added: the controller satisfies every specification {both}{crossover}")
        }
        RepairStatus::Infeasible { relaxation_db } => format!(
            "that plant was added: none of the controllers tried satisfies every specification {both}; with every limit {} dB wider one does",
            significant(relaxation_db, 3)
        ),
        RepairStatus::NotStabilised => {
            format!("that plant was added: none of the controllers tried is stable {both}")
        }
        RepairStatus::NotConverged | RepairStatus::Stopped | RepairStatus::NothingToAdd => format!(
            "that plant was added: the search for a controller that satisfies every specification {both} has not converged; another `design.seed` may find one"
        ),
    }
}

/// The loop that was found with the plant.
fn with_waves(status: RepairStatus, view: &ProjectAudit) -> String {
    let whose = if status == RepairStatus::Met { "with waves" } else { "with waves, the nearest controller" };
    match view.audit.stability.verdict {
        Verdict::Met => format!("{whose}: {}", margins(view)),
        _ => format!("{whose}: {}", stability_sentence(&view.audit.stability, &view.names)),
    }
}

/// `1 robust stability +0.1 dB at 330 rad/s, ...`
fn margins(view: &ProjectAudit) -> String {
    let findings = view.audit.specifications.iter().enumerate();
    let margins = findings.filter_map(|(index, finding)| {
        let worst = finding.worst.as_ref()?;
        Some(format!(
            "{} {} {}",
            numbered(view.named(index)),
            margin_words(worst.margin_db),
            frequency_words(worst.frequency_rad_per_s)
        ))
    });
    margins.collect::<Vec<_>>().join(", ")
}

/// The crossover up to which the loop has |L| = 1, and the frequency at which the line is a quarter
/// wave long.
fn crossing(repair: &Repair, first: &ProjectDesign) -> Option<String> {
    let (own, quarter) = (first.designed.figures.last_crossing_rad_per_s()?, repair.quarter_wave_rad_per_s?);
    let beyond = if own > quarter { "beyond" } else { "below" };
    Some(format!(
        "in the loop that satisfies the family |L| is 1 up to {}, {beyond} the quarter wave of its slower line at {}",
        frequency(own),
        frequency(quarter)
    ))
}

fn frequency(rad_per_s: f64) -> String {
    format!("{} rad/s ({})", significant(rad_per_s, 3), DisplayUnit::HERTZ.text(rad_per_s, 3))
}

/// Changes that would help.
fn help(repair: &Repair) -> String {
    let ways: Vec<String> = repair.remedies.iter().map(remedy_words).collect();
    format!("what would help: {}", ways.join("; "))
}

fn remedy_words(remedy: &RepairRemedy) -> String {
    match *remedy {
        RepairRemedy::ShorterLine { below_m } => {
            let length = DisplayUnit::METRE.text(below_m, 2);
            format!("a line shorter than {length}, whose quarter wave lies beyond that frequency")
        }
        RepairRemedy::WallDamping => {
            "what is known of the wall that damps its waves (`line.model = \"segments\"` with `line.relaxation_time`)"
                .to_string()
        }
        RepairRemedy::HigherOrder { maximum_order } => {
            format!("a controller of higher order (`design.maximum_order`, now {maximum_order})")
        }
        RepairRemedy::LessBandwidth { relaxation_db } => {
            let wider = relaxation_db.map_or(String::new(), |relaxation_db| {
                format!(" (limits {} dB wider are enough)", significant(relaxation_db, 3))
            });
            format!("specifications that ask for less bandwidth{wider}")
        }
    }
}

/// The trial of the nearest controller on the machine.
fn nearest(found: &ProjectDesign) -> Option<String> {
    let trial = found.trial.as_ref()?;
    let waves = trial.runs.iter().find(|run| run.quarter_wave_rad_per_s.is_some())?;
    Some(format!(
        "under the nearest controller (`{NEAREST_PROJECT}`) the nonlinear simulation with waves {} with its linear loop: {}",
        agreement_word(waves.agreement),
        reason_words(&waves.reason, waves.units)
    ))
}

/// A machine with waves that contradicts the design although its plant satisfies every
/// specification in the loop.
fn stable_with_waves(run: &TrialRun) -> String {
    format!(
        "the linear loop satisfies every specification with waves in its plant too, and {} contradicts it all the same: so the waves are not the cause",
        run_name(run)
    )
}

/// Sentence for a repair without any controller.
fn none_found() -> String {
    "that plant was added, and the search ended without a controller that makes every plant stable"
        .to_string()
}

/// Deviations that no linear plant explains, run by run, and the changes to make.
fn left<'a>(runs: impl Iterator<Item = &'a TrialRun>) -> Vec<String> {
    let contradicting = runs.filter(|run| run.agreement == Agreement::Contradicts);
    let others = contradicting.filter(|run| run.quarter_wave_rad_per_s.is_none());
    others
        .map(|run| format!("{}: {}: {}", run_name(run), reason_words(&run.reason, run.units), advice(run)))
        .collect()
}

/// Changes to make, from the events of the run.
fn advice(run: &TrialRun) -> String {
    let [from, to] = run.reference_n;
    let step = run.units.force.short((to - from).abs(), 3);
    let met = |names: &[&str]| run.met.iter().any(|one| names.iter().any(|name| one.starts_with(name)));
    if run.machine.is_none() {
        let position = run.units.motion.either("a position", "an angle");
        return format!(
            "no linear plant has this; the nonlinear simulation must first find an equilibrium, at a reference and {position} that it can hold"
        );
    }
    if met(&["cavitation", "empty", "supply_lost"]) {
        return format!(
            "no linear plant has this; a smaller step than {step}, more supply, or a higher tank pressure"
        );
    }
    if met(&["end_stop", "load_contact"]) {
        let piston = run.units.motion.words().piston;
        return format!(
            "no linear plant has this; more room for the {piston}, or a smaller step than {step}"
        );
    }
    if met(&["command_limit"]) {
        return format!(
            "no linear plant has this: the command was at its limit; a smaller step than {step}, a larger valve or supply, `controller.anti_windup`, or a loop with less bandwidth"
        );
    }
    "no linear plant has this: a limit cycle of friction and of the valve about null, since no limit was reached on the way; or a loop with less gain"
        .to_string()
}
