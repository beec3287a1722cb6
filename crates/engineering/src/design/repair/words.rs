//! What a repair did, and what cannot be achieved, in sentences.

use phea_qft::design::ControllerChoice;
use phea_qft::verification::Verdict;

use super::{Repair, RepairStatus};
use crate::audit::{ProjectAudit, frequency_words, margin_words, stability_sentence};
use crate::design::{NEAREST_PROJECT, ProjectDesign};
use crate::project::{DeclaredLine, Project};
use crate::quantity::{DisplayUnit, significant};
use crate::trial::{Agreement, TrialRun, agreement_word};

/// What was added, the result, and what would help if it failed.
pub(super) fn sentences(
    project: &Project,
    repair: &Repair,
    told: &ProjectDesign,
    found: &ProjectDesign,
) -> Vec<String> {
    let mut sentences: Vec<String> = repair.before.iter().map(before).collect();
    sentences.push(outcome(repair, found));
    sentences.extend(repair.after.iter().map(|after| with_waves(repair.status, after)));
    if repair.status != RepairStatus::Met {
        sentences.extend(crossing(repair, told));
        sentences.push(help(project, repair, told));
        sentences.extend(nearest(found));
        sentences.extend(not_led(found));
    }
    sentences.push(whole(repair.whole.as_ref()));
    sentences
}

/// Why the steps of the nearest controller did not lead to it, where they are missed.
fn not_led(found: &ProjectDesign) -> Option<String> {
    let misses = found.designed.view.misses_in_time() || found.exceeded_command().is_some();
    misses.then(|| {
        "the search with the added plant is one over frequency, which the steps do not lead: `design` with `line.model = \"transmission_line\"` is led by them"
            .to_string()
    })
}

/// What is known about the plants that were not added.
fn whole(view: Option<&ProjectAudit>) -> String {
    let every = "with `line.model = \"transmission_line\"` waves are in every plant of the family";
    let told = match view {
        None => return format!("the plant of the rig itself was added: {every}"),
        Some(view) if view.verdict() == Verdict::Met => {
            "the controller satisfies every specification with those too".to_string()
        }
        Some(view) if view.audit.stability.verdict != Verdict::Met => {
            stability_sentence(&view.audit.stability, &view.names)
        }
        Some(view) => format!("every plant is stable, with {}", margins(view)),
    };
    format!("the plant of the rig itself was added, and nothing is claimed about the others; {every}: {told}")
}

/// The loop of the first design with the plant.
fn before(view: &ProjectAudit) -> String {
    match view.audit.stability.verdict {
        Verdict::Met => {
            format!(
                "the linear loop reproduces the nonlinear simulation once its plant includes waves: {}",
                margins(view)
            )
        }
        _ => format!(
            "the linear loop reproduces the nonlinear simulation once its plant includes waves: {}",
            stability_sentence(&view.audit.stability, &view.names)
        ),
    }
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
        RepairStatus::NotConverged | RepairStatus::Stopped | RepairStatus::NothingToTakeIn => format!(
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
    let told = findings.filter_map(|(index, finding)| {
        let worst = finding.worst.as_ref()?;
        Some(format!(
            "{} {} {}",
            view.numbered(index),
            margin_words(worst.margin_db),
            frequency_words(worst.frequency_rad_per_s)
        ))
    });
    told.collect::<Vec<_>>().join(", ")
}

/// The highest frequency at which |L| = 1: a resonance may bring it there, far beyond the
/// crossover.
fn last_crossing(design: &ProjectDesign) -> Option<f64> {
    let nominal = design.designed.figures.nominal.as_ref()?;
    Some(nominal.crossover_rad_per_s).filter(|crossing| *crossing > 0.0)
}

/// Up to where the loop has |L| = 1, and where the line is a quarter wave long.
fn crossing(repair: &Repair, told: &ProjectDesign) -> Option<String> {
    let (own, quarter) = (last_crossing(told)?, repair.quarter_wave_rad_per_s?);
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

/// What would help: a line so short that its quarter wave lies beyond that frequency, a wall that
/// damps, less bandwidth.
fn help(project: &Project, repair: &Repair, told: &ProjectDesign) -> String {
    let mut ways = Vec::new();
    let lines = project.actuator.as_ref().map(|actuator| [&actuator.line.a, &actuator.line.b]);
    let longest = lines.iter().flatten().filter_map(|line| DeclaredLine::length(line)).fold(0.0, f64::max);
    if let (Some(own), Some(quarter)) = (last_crossing(told), repair.quarter_wave_rad_per_s)
        && own > quarter
        && longest > 0.0
    {
        let length = DisplayUnit::METRE.text(longest * quarter / own, 2);
        ways.push(format!("a line shorter than {length}, whose quarter wave lies beyond that frequency"));
    }
    if lines.iter().flatten().any(|line| line.hose().is_some()) {
        ways.push(
            "what is known of the wall that damps its waves (`line.model = \"segments\"` with `line.relaxation_time`)"
                .to_string(),
        );
    }
    if let ControllerChoice::Grow { maximum_order } | ControllerChoice::Any { maximum_order, .. } =
        told.options.controller
    {
        ways.push(format!("a controller of higher order (`design.maximum_order`, now {maximum_order})"));
    }
    let wider = match repair.status {
        RepairStatus::Infeasible { relaxation_db } => {
            format!(" (limits {} dB wider are enough)", significant(relaxation_db, 3))
        }
        _ => String::new(),
    };
    ways.push(format!("specifications that ask for less bandwidth{wider}"));
    format!("what would help: {}", ways.join("; "))
}

/// The trial of the nearest controller on the machine.
fn nearest(found: &ProjectDesign) -> Option<String> {
    let trial = found.trial.as_ref()?;
    let waves = trial.runs.iter().find(|run| run.quarter_wave_rad_per_s.is_some())?;
    Some(format!(
        "under the nearest controller (`{NEAREST_PROJECT}`) the nonlinear simulation with waves {} with its linear loop: {}",
        agreement_word(waves.agreement),
        waves.reason
    ))
}

/// A machine with waves that contradicts the design although its plant satisfies every
/// specification in the loop.
pub(super) fn stable_with_waves(run: &TrialRun) -> String {
    format!(
        "the linear loop satisfies every specification with waves in its plant too, and {} contradicts it all the same: so the waves are not the cause",
        run.what
    )
}

/// No controller at all.
pub(super) fn nothing_found() -> String {
    "that plant was added, and the search ended without a controller that makes every plant stable"
        .to_string()
}

/// Deviations that no linear plant explains, run by run, and what to change.
pub(super) fn left<'a>(runs: impl Iterator<Item = &'a TrialRun>) -> Vec<String> {
    let contradicting = runs.filter(|run| run.agreement == Agreement::Contradicts);
    let others = contradicting.filter(|run| run.quarter_wave_rad_per_s.is_none());
    others.map(|run| format!("{}: {}: {}", run.what, run.reason, advice(run))).collect()
}

/// What to change, by the events of the run.
fn advice(run: &TrialRun) -> String {
    let [from, to] = run.reference_n;
    let step = run.units.force.short((to - from).abs(), 3);
    let met = |names: &[&str]| run.met.iter().any(|one| names.iter().any(|name| one.starts_with(name)));
    if run.machine.is_none() {
        return "no linear plant has this; the nonlinear simulation must first find an equilibrium, at a reference and a position that it can hold".to_string();
    }
    if met(&["cavitation", "empty", "supply_lost"]) {
        return format!(
            "no linear plant has this; a smaller step than {step}, more supply, or a higher tank pressure"
        );
    }
    if met(&["end_stop", "load_contact"]) {
        return format!("no linear plant has this; more room for the piston, or a smaller step than {step}");
    }
    if met(&["command_limit"]) {
        return format!(
            "no linear plant has this: the command was at its limit; a smaller step than {step}, a larger valve or supply, `controller.anti_windup`, or a loop with less bandwidth"
        );
    }
    "no linear plant has this: a limit cycle of friction and of the valve about null, since no limit was reached on the way; or a loop with less gain"
        .to_string()
}
