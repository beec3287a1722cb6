//! Sentences on the next steps, as they follow from the results: the controller to take,
//! contradictions by the machine, effects that no verdict includes, requirements in time that are
//! not met, and missing declarations.

use phea_dynamics::closed_loop::ClosedLoop;
use phea_dynamics::order::sort_by_number;
use phea_engineering::audit::ProjectAudit;
use phea_engineering::caveat::caveats;
use phea_engineering::design::{DESIGNED_PROJECT, ProjectDesign};
use phea_engineering::setup::Setup;
use phea_engineering::simulate::TimeRequirement;
use phea_engineering::trial::{Agreement, Trial, TrialRun};
use phea_qft::design::{DesignStatus, Relaxation};
use phea_qft::verification::Verdict;

use super::Contents;
use super::side::Side;
use super::steps::{NEVER_RISEN, NEVER_SETTLED, StepProperty, steps};
use crate::answer::significant;
use crate::audit::in_time;
use crate::caveat::{outside_parameters, sentence};
use crate::design::rig_miss_words;
use crate::document::capital;
use crate::plant_names::plant_text;
use crate::project::{DeclaredSpecification, Project, SpecificationKind};
use crate::quantity::DisplayUnit;
use crate::report::design::Designed;
use crate::report::driven::{DESIGNED, GIVEN};
use crate::specification::numbered;
use crate::trial::{self, brief_reason, run_name};
use crate::verdict_words::frequency_words;

/// Largest number of sentences.
const MOST: usize = 6;
/// Delay of a computer with a sample time of one millisecond, s: a loop that tolerates less must
/// take it into account.
const SHORT_DELAY_S: f64 = 2e-3;
/// Deviation of a simulated from a measured signal that counts as small, as a fraction of its
/// range.
const NEAR: f64 = 0.1;

/// The sentences, the decisive ones first.
pub(super) fn next_steps(contents: &Contents<'_>, sides: &[Side<'_>]) -> Vec<String> {
    let taken = taken(sides);
    let mut steps = Vec::new();
    steps.extend(controller(contents, sides));
    steps.extend(taken.iter().flat_map(|side| machine(side)));
    steps.extend(taken.and_then(|side| missed_requirements(contents, side)));
    steps.extend(uncounted(contents.setup));
    steps.extend(taken.and_then(|side| delay(contents.setup.project, side)));
    steps.extend(undeclared(contents, taken));
    steps.truncate(MOST);
    steps
}

/// The recommended controller: the designed one, unless only the given one satisfies everything or
/// nothing was designed.
fn taken<'a, 's>(sides: &'s [Side<'a>]) -> Option<&'s Side<'a>> {
    let of = |name: &str| sides.iter().find(|side| side.name == name);
    match (of(GIVEN), of(DESIGNED)) {
        (Some(given), Some(designed)) if given.is_met() && !designed.is_met() => Some(given),
        (given, designed) => designed.or(given),
    }
}

fn controller(contents: &Contents<'_>, sides: &[Side<'_>]) -> Option<String> {
    let Some(judged) = contents.judged else {
        let commands = "state what the loop has to do in `[[specification]]`: nothing is required of it yet, and so nothing is judged.";
        return Some(capital(commands));
    };
    let given = sides.iter().find(|side| side.name == GIVEN);
    let found = judged.found();
    let given_words = given.and_then(|side| side.view).map(given_words);
    let designed = match (&judged.designed, found) {
        (_, Some(view)) => designed_words(view, given.is_some_and(Side::is_met)),
        (Some(Designed::Nothing(sentences)), None) => {
            let why = sentences.last().map(String::as_str).unwrap_or_default();
            format!("ease the specifications or shrink the family, no controller was found: {why}")
        }
        (Some(Designed::Impossible(sentences)), None) => {
            format!(
                "change what is required or the rig, no controller makes the step: {}",
                sentences.join("; ")
            )
        }
        _ if given.is_some_and(|side| side.view.is_some_and(is_violated)) => {
            "add `[design]` to the project, and `phea design` looks for one that holds; where it has found none, it names what to relax"
                .to_string()
        }
        _ if given.is_some_and(contradicted) => {
            "do not rely on it before the nonlinear simulation, which contradicts the verdict, agrees"
                .to_string()
        }
        _ if given.is_some_and(Side::is_met) => "keep it".to_string(),
        _ => "remove the reason why the verdict is open".to_string(),
    };
    Some(match given_words {
        Some(given) => format!("{}: {designed}.", capital(&given)),
        None => format!("{}.", capital(&designed)),
    })
}

/// True if the machine contradicts the verdict.
fn contradicted(side: &Side<'_>) -> bool {
    side.trial.is_some_and(|trial| trial.agreement() == Agreement::Contradicts)
}

fn is_violated(view: &ProjectAudit) -> bool {
    view.verdict() == Verdict::Violated
}

/// `the given controller violates 1 robust stability by 19.2 dB at 1304 rad/s, and 2 more
/// specifications`
fn given_words(view: &ProjectAudit) -> String {
    match view.verdict() {
        Verdict::Met => return "the given controller satisfies every specification".to_string(),
        Verdict::NotProven => {
            return "the given controller is not proven to satisfy the specifications".to_string();
        }
        Verdict::Violated => {}
    }
    if view.misses_in_time() && view.audit.verdict == Verdict::Met {
        return format!("the given controller misses what is required in time, {}", missed_words(view));
    }
    if view.audit.stability.verdict == Verdict::Violated {
        let plant = plant_words(view, &view.audit.stability.plant);
        return format!("the given controller makes a plant of the family unstable{plant}");
    }
    let findings = view.audit.specifications.iter().enumerate();
    let mut violated: Vec<_> = findings
        .filter(|(_, finding)| finding.verdict == Verdict::Violated)
        .filter_map(|(index, finding)| Some((index, finding.worst.as_ref()?)))
        .collect();
    sort_by_number(&mut violated, |one| one.1.margin_db);
    let Some((index, worst)) = violated.first() else {
        return "the given controller does not satisfy every specification".to_string();
    };
    let more = match violated.len() - 1 {
        0 => String::new(),
        1 => ", and one more".to_string(),
        more => format!(", and {more} more"),
    };
    format!(
        "the given controller violates {} by {} dB {}{}{more}",
        numbered(view.named(*index)),
        significant(worst.margin_db.abs(), 3),
        frequency_words(worst.frequency_rad_per_s),
        plant_words(view, &worst.plant)
    )
}

/// `1.08 s where 0.8 s is required`
fn missed_words(view: &ProjectAudit) -> String {
    let missed: Vec<String> =
        view.in_time.iter().filter(|finding| finding.violates()).flat_map(in_time::missed).collect();
    missed.join(" and ")
}

/// The plant, if a few words suffice; otherwise the place where it is listed.
fn plant_words(view: &ProjectAudit, plant: &phea_qft::verification::PlantPoint) -> String {
    match view.names.headings().len() {
        0 => String::new(),
        1 | 2 => format!(" (plant {})", plant_text(&view.names, plant)),
        _ => " (its plant is listed in the audit)".to_string(),
    }
}

fn designed_words(view: &ProjectDesign, given_is_met: bool) -> String {
    match &view.design.status {
        DesignStatus::Met if view.agreement() == Agreement::Contradicts => format!(
            "do not use the designed one (`{DESIGNED_PROJECT}`) before the nonlinear simulation agrees: it satisfies every specification over the family, and the simulation contradicts it; `phea design` goes on from there with the plant that does, or states what cannot be achieved"
        ),
        DesignStatus::Met if view.misses_on_rig() => format!(
            "do not use the designed one (`{DESIGNED_PROJECT}`) unchanged: it satisfies every specification, and {}; state the step that the rig must make (`amplitude`), allow more time, or add poles (`design.maximum_order`)",
            view.rig_miss().map_or("", rig_miss_words)
        ),
        DesignStatus::Met if given_is_met => {
            format!("keep it, or take the designed one of `{DESIGNED_PROJECT}` where its numbers are better")
        }
        DesignStatus::Met if view.designed.view.verdict() == Verdict::NotProven => format!(
            "the designed one of `{DESIGNED_PROJECT}` satisfies every specification over the family, but effects that are not included leave the verdict open"
        ),
        DesignStatus::Met if view.designed.view.misses_in_time() => format!(
            "do not use the designed one of `{DESIGNED_PROJECT}` unchanged: it satisfies every specification over frequency and misses what is required in time, {}; tighten the limits that the requirement follows from, or extend their `frequencies` to where the loop still acts",
            missed_words(&view.designed.view)
        ),
        DesignStatus::Met => {
            format!("use the designed one (`{DESIGNED_PROJECT}`), which satisfies every specification")
        }
        DesignStatus::Infeasible(relaxation) => infeasible_words(view, relaxation),
        DesignStatus::NotConverged { .. } => {
            "give the search more room (`design.maximum_order`) or another `design.seed`, it has not converged".to_string()
        }
        DesignStatus::NotStabilised => {
            "raise `design.maximum_order` or shrink the family, none of the controllers tried makes every plant stable".to_string()
        }
    }
}

fn infeasible_words(view: &ProjectDesign, relaxation: &Relaxation) -> String {
    let mut names: Vec<String> = Vec::new();
    for conflict in &relaxation.conflicts {
        let name = numbered(view.designed.view.named(conflict.specification));
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let which = if names.is_empty() { "the specifications".to_string() } else { names.join(" or ") };
    format!(
        "ease {which} by {} dB, or shrink the family: none of the controllers tried satisfies all of them at once",
        significant(relaxation.relaxation_db, 3)
    )
}

/// Contradictions of a controller by the machine: one sentence for each kind of machine, the worst
/// first.
fn machine(side: &Side<'_>) -> Vec<String> {
    let Some(trial) = side.trial else { return vec![] };
    let mut others: Vec<&TrialRun> =
        trial.runs.iter().filter(|run| run.agreement >= Agreement::Differs).collect();
    others.sort_by_key(|run| std::cmp::Reverse(run.agreement));
    let with_waves = others.iter().find(|run| run.quarter_wave_rad_per_s.is_some());
    let of_plant = others.iter().find(|run| run.plant.is_some());
    let declared = others.iter().find(|run| run.plant.is_none() && run.quarter_wave_rad_per_s.is_none());
    let mut runs: Vec<&TrialRun> = [declared, with_waves, of_plant].into_iter().flatten().copied().collect();
    runs.sort_by_key(|run| std::cmp::Reverse(run.agreement));
    runs.into_iter().map(|run| machine_words(side, run)).collect()
}

fn machine_words(side: &Side<'_>, run: &TrialRun) -> String {
    // the chapter on the machine has the rest: the range of the force, and the travel time of a
    // wave
    let why = brief_reason(&run.reason, run.units);
    let satisfies = side.trial.and_then(Trial::satisfies) == Some(true);
    if satisfies && run.agreement != Agreement::Contradicts {
        return format!(
            "Take times from the nonlinear simulation and not from the linear loop: {} satisfies what is required under the {} controller, and {why}.",
            run_name(run),
            side.name
        );
    }
    let verdict = match run.agreement {
        Agreement::Contradicts => "the nonlinear simulation contradicts the verdict, ",
        Agreement::Differs | Agreement::AgreesButForSettling | Agreement::Agrees => "",
    };
    match run.quarter_wave_rad_per_s {
        Some(quarter) => format!(
            "Shorten the hose, state how its wall damps (`line.relaxation_time`), or ask for less gain from {} rad/s on: with waves in the lines, under the {} controller, {verdict}{why}.",
            significant(quarter, 3),
            side.name
        ),
        None if run.plant.is_some() => format!(
            "Narrow `[uncertainty]`, or take care near {}: simulated as a rig with the {} controller, {verdict}{why}.",
            trial::machine_words(&run.machine_driven),
            side.name
        ),
        None => format!(
            "Do not trust the verdict on this rig yet: driven under the {} controller {verdict}{why}.",
            side.name
        ),
    }
}

fn violates_tracking(view: &ProjectAudit) -> bool {
    let mut all = view.audit.specifications.iter();
    all.any(|one| one.requirement.is_tracking() && one.verdict == Verdict::Violated)
}

fn is_tracking(specification: &DeclaredSpecification) -> bool {
    specification.kind == SpecificationKind::ClosedLoop(ClosedLoop::Tracking)
}

/// A step of the machine that misses the requirement in time, and the response of the tracking
/// limits themselves.
fn missed_requirements(contents: &Contents<'_>, side: &Side<'_>) -> Option<String> {
    let required: &TimeRequirement = contents.driven?.required.as_ref()?;
    let missed = |property| {
        let all = steps(side, required, property).filter(|all| !all.all_satisfied())?;
        Some(all.worst_words())
    };
    let overshoot = missed(StepProperty::Overshoot).map(|words| format!("overshoots by {words}"));
    let settling = missed(StepProperty::Settling).map(|words| match words.strip_prefix(NEVER_SETTLED) {
        Some(within) => format!("does not settle{within}"),
        None => format!("takes {words} to settle"),
    });
    let rise = missed(StepProperty::Rise).map(|words| match words.strip_prefix(NEVER_RISEN) {
        Some(within) => format!("does not rise to 90 %{within}"),
        None => format!("takes {words} to rise"),
    });
    let misses: Vec<String> = [overshoot, settling, rise].into_iter().flatten().collect();
    (!misses.is_empty()).then(|| {
        let worst = format!("at worst a step under the {} controller {}.", side.name, misses.join(" and "));
        let has_tracking = contents.setup.project.specifications.iter().any(is_tracking);
        match side.view {
            Some(view) if violates_tracking(view) => {
                format!("What is required in time is missed with the limits of tracking: {worst}")
            }
            Some(view) if view.misses_in_time() => {
                format!("What is required in time is missed, by the linear loop too; of all steps, {worst}")
            }
            _ if has_tracking => format!(
                "Tighten the limits of tracking if what is required in time must be met exactly: {worst}"
            ),
            _ => format!(
                "State stricter values in the specification of kind `step` and design for them (`phea design`) if every simulated step must satisfy what is required in time: {worst}"
            ),
        }
    })
}

/// Effects that no verdict includes, and a rig outside its own family.
fn uncounted(setup: &Setup<'_>) -> Vec<String> {
    let mut steps = Vec::new();
    if let Some((_, outside)) = setup.outside().filter(|_| !setup.project.specifications.is_empty()) {
        steps.push(format!(
            "Widen `[uncertainty]` until it contains the rig as it is derived: {}.",
            outside_parameters(&outside)
        ));
    }
    let open = caveats(setup).into_iter().filter(|caveat| caveat.unproven);
    steps.extend(open.map(|caveat| {
        format!(
            "Judge this by simulation, since no verdict on the linear loop includes it: {}.",
            sentence(&caveat.effect, &setup.project.units)
        )
    }));
    steps
}

/// A continuous loop that no computer can run unchanged.
fn delay(project: &Project, side: &Side<'_>) -> Option<String> {
    let controller = project.controller.clone().unwrap_or_default();
    let margin_s = side.delay_margin_s().filter(|margin_s| *margin_s < SHORT_DELAY_S)?;
    let continuous = controller.sample_time.is_none() && controller.delay == 0.0;
    (continuous && project.actuator.is_some()).then(|| {
        format!(
            "State `controller.sample_time` and `controller.delay` of the computer, and design again: the {} loop is continuous and tolerates {} of delay.",
            side.name,
            DisplayUnit::MILLISECOND.text(margin_s, 3)
        )
    })
}

/// Declarations that would give more certainty.
fn undeclared(contents: &Contents<'_>, taken: Option<&Side<'_>>) -> Vec<String> {
    let project = contents.setup.project;
    let mut steps = Vec::new();
    if contents.no_hose_fits {
        steps.push("Change the gain, the time constant or the stock length in `[sizing]`: no hose of the catalogue fits.".to_string());
    }
    if project.actuator.is_none() {
        return steps;
    }
    if project.scenarios.is_empty() {
        steps.push("Add a `[[scenario]]` with the steps and the motions of the load that the rig will meet: none was driven.".to_string());
        return steps;
    }
    let runs = taken.and_then(|side| side.runs).unwrap_or_default();
    let overlays: Vec<_> = runs.iter().flat_map(|run| &run.measured).collect();
    let farthest = overlays.iter().filter_map(|overlay| Some((overlay.nrmse.ok()?, overlay)));
    // measurements of a motor are not read yet
    let comparable = !project.motion().is_rotary();
    match farthest.max_by(|one, other| one.0.total_cmp(&other.0)) {
        Some((nrmse, overlay)) if nrmse > NEAR => steps.push(format!(
            "Bring the model nearer to the rig before relying on its numbers: {} lies {} % of its range from what was measured; friction, leakage and the stiffness of the {} are the first to check.",
            overlay.signal.words(project.motion()),
            significant(100.0 * nrmse, 3),
            project.motion().words().load_cell
        )),
        Some(_) => {}
        None if !comparable => steps.push("Measure on the rig what was simulated: nothing here has been compared with it.".to_string()),
        None => steps.push("Compare a scenario with a measurement (`[[scenario.measured]]`): nothing here has been compared with the rig.".to_string()),
    }
    if project.campaign.is_none() {
        steps.push(
            "Add `[campaign]` with the numbers that are uncertain: every run here has the declared ones."
                .to_string(),
        );
    }
    steps
}
