//! Status, objective and structure in words.

use phea_dynamics::controller::Element;
use phea_qft::design::{ControllerChoice, DesignStatus, Objective};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::verification::Verdict;

use super::{CommandOfSteps, DesignPart, ProjectDesign, Repair, RepairStatus};
use crate::audit::DelayedPaths;
use crate::project::{DESIGN_OBJECTIVES, word_of};
use crate::quantity::significant;
use crate::robust::DEFAULT_TOLERANCE_DB;

/// The word of a status in JSON.
pub fn status_key(view: &ProjectDesign) -> &'static str {
    match view.design.status {
        _ if view.is_stopped() => "stopped",
        DesignStatus::Met if view.designed.view.verdict() == Verdict::NotProven => "not_proven",
        DesignStatus::Met if view.designed.view.audit.verdict == Verdict::Violated => "not_converged",
        DesignStatus::Met if view.designed.view.misses_in_time() || view.misses_on_rig() => "missed_in_time",
        DesignStatus::Met if view.exceeded_prefilter_gain().is_some() => "prefilter_amplifies",
        DesignStatus::Met if view.exceeded_command().is_some() => "command_beyond_valve",
        DesignStatus::Met if !view.tolerates_its_delay => "delay_not_tolerated",
        DesignStatus::Met => "met",
        DesignStatus::Infeasible(_) => "infeasible",
        DesignStatus::NotConverged { .. } => "not_converged",
        DesignStatus::NotStabilised => "not_stabilised",
    }
}

/// The tolerance, where a specification or a limit of the design is met within it alone, and it is
/// more than what margins are computed to.
fn within_tolerance(view: &ProjectDesign) -> String {
    let limits = view.limit_findings.iter().filter(|(kind, _)| !kind.is_led_to()).map(|(_, found)| found);
    let all = view.designed.view.audit.specifications.iter().chain(limits);
    let least = all.filter_map(|found| Some(found.worst.as_ref()?.margin_db)).fold(f64::INFINITY, f64::min);
    match least < -DEFAULT_TOLERANCE_DB {
        true => {
            format!(" within the tolerance of {} dB", significant(view.designed.view.audit.tolerance_db, 2))
        }
        false => String::new(),
    }
}

fn satisfaction(view: &ProjectDesign) -> &'static str {
    if view.is_met() { "satisfies every specification" } else { "does not satisfy every specification" }
}

/// Advice that leaves more delay, where a path within the force loop is delayed too.
fn delay_cure(paths: DelayedPaths) -> &'static str {
    match (paths.pressure_feedback, paths.velocity_feed_forward) {
        (true, _) => ": a smaller gain of the pressure feedback leaves more",
        (false, true) => ": a smaller gain of the velocity feed-forward leaves more",
        (false, false) => "",
    }
}

/// The sentence on a stopped design.
fn stopped_sentence(view: &ProjectDesign) -> String {
    let verdict = match view.is_met() {
        true if view.unfinished.contains(&DesignPart::Trial) => {
            "satisfies every specification as a linear loop; the nonlinear simulation has not driven it"
        }
        _ => satisfaction(view),
    };
    let missed = match view.is_met() && view.misses_on_rig() {
        true => format!(", but {}", view.missed_on_rig_words()),
        false => String::new(),
    };
    format!("stopped: this is the best controller found so far, and it {verdict}{missed}")
}

/// The same for people, with what it means.
pub fn status_sentence(view: &ProjectDesign) -> String {
    if view.is_stopped() {
        return stopped_sentence(view);
    }
    match &view.design.status {
        DesignStatus::Met if view.designed.view.verdict() == Verdict::NotProven => {
            "not proven: the controller satisfies every specification over the family, which does not include everything that is declared"
                .to_string()
        }
        DesignStatus::Met if view.designed.view.audit.verdict == Verdict::Violated => {
            "not met: the proof refutes what the search of the audit found to be met".to_string()
        }
        DesignStatus::Met if view.designed.view.misses_in_time() => {
            "not met: the controller satisfies every specification over frequency, and its steps miss what is required in time"
                .to_string()
        }
        DesignStatus::Met if view.misses_on_rig() => {
            format!("not met: the controller satisfies every specification, and {}", view.missed_on_rig_words())
        }
        DesignStatus::Met if view.exceeded_prefilter_gain().is_some() => {
            "not met: the controller satisfies every specification, and its prefilter amplifies by more than `design.prefilter_gain` allows: it commands in advance what the loop does not do"
                .to_string()
        }
        DesignStatus::Met if !view.tolerates_its_delay && view.exceeded_command().is_none() => {
            let cure = delay_cure(view.designed.view.delayed_paths);
            format!(
                "not met: the controller satisfies every specification, and its loop tolerates less further delay than `design.minimum_delay_margin` requires{cure}"
            )
        }
        DesignStatus::Met => match view.exceeded_command() {
            Some(command) => command_words(command),
            None => format!("met: the controller satisfies every specification{}", within_tolerance(view)),
        },
        DesignStatus::Infeasible(_) if keeps_all_but_steps(view) => format!(
            "infeasible: none of the controllers tried{} makes its steps as they are required; the nearest one keeps all that is required over frequency",
            tried(&view.options.controller)
        ),
        DesignStatus::Infeasible(relaxation) => format!(
            "infeasible: none of the controllers tried{} satisfies every specification; with every limit {} dB wider one does",
            tried(&view.options.controller),
            significant(relaxation.relaxation_db, 3)
        ),
        DesignStatus::NotConverged { .. } if view.designed.view.audit.verdict == Verdict::NotProven => {
            "not converged: no audit of a controller that the search found decides whether it satisfies every specification"
                .to_string()
        }
        DesignStatus::NotConverged { rounds } => format!(
            "not converged: after {rounds} rounds of search and audit the audit still finds what the search did not see; the controller {}",
            satisfaction(view)
        ),
        DesignStatus::NotStabilised => {
            format!(
                "not stabilised: none of the controllers tried{} makes every plant stable",
                tried(&view.options.controller)
            )
        }
    }
}

/// The command of a scenario's step that is beyond its limit.
fn command_words(command: &CommandOfSteps) -> String {
    let volts = |value: f64| format!("{} V", significant(value, 3));
    let hold = match command.is_out_of_reach() {
        true => format!(": {} hold the force, whatever the controller", volts(command.at_rest_v)),
        false => String::new(),
    };
    format!(
        "not met: the controller satisfies every specification, and the steps of the scenario `{}` take {} of the {} that `design.command_of_steps` leaves the valve{hold}",
        command.scenario,
        volts(command.largest_v),
        volts(command.limit_v)
    )
}

/// True where a design misses what is required in time and nothing else.
fn keeps_all_but_steps(view: &ProjectDesign) -> bool {
    let is_met = view.designed.view.audit.verdict == Verdict::Met && view.keeps_its_limits();
    is_met && view.designed.view.misses_in_time()
}

/// The word of the outcome of a repair, in JSON.
pub fn repair_key(repair: &Repair) -> &'static str {
    match repair.status {
        RepairStatus::Met => "met",
        RepairStatus::Infeasible { .. } => "infeasible",
        RepairStatus::NotConverged => "not_converged",
        RepairStatus::NotStabilised => "not_stabilised",
        RepairStatus::Stopped => "stopped",
        RepairStatus::NothingToTakeIn => "nothing_to_take_in",
    }
}

/// The same for people.
pub fn repair_words(repair: &Repair) -> String {
    repair_key(repair).replace('_', " ")
}

fn tried(choice: &ControllerChoice) -> String {
    match choice {
        ControllerChoice::Given(_) => ", all of the given structure,".to_string(),
        ControllerChoice::Named { name, .. } => format!(", all of the structure {},", name.words()),
        ControllerChoice::Any { maximum_order, .. } | ControllerChoice::Grow { maximum_order } => {
            format!(", of order {maximum_order} at most,")
        }
    }
}

/// The word of an objective, as the project file spells it.
pub fn objective_key(objective: Objective) -> &'static str {
    word_of(&DESIGN_OBJECTIVES, &objective)
}

/// `integrator, zero, pole pair`
pub fn structure_words(structure: &Structure) -> String {
    let words: Vec<String> = structure.parts.iter().map(|part| part_key(part).replace('_', " ")).collect();
    if words.is_empty() { "gain".to_string() } else { words.join(", ") }
}

/// The word of a factor, as the project file spells it.
pub fn part_key(part: &StructureFactor) -> &'static str {
    match part {
        StructureFactor::Fixed(Element::Integrator) => "integrator",
        StructureFactor::Fixed(_) => "fixed",
        StructureFactor::RealZero { .. } => "zero",
        StructureFactor::RealPole { .. } => "pole",
        StructureFactor::ZeroPair { .. } => "zero_pair",
        StructureFactor::PolePair { .. } => "pole_pair",
        StructureFactor::Notch { .. } => "notch",
    }
}
