//! Verdict, objective and structure of a design in words.

use phea_dynamics::controller::NamedStructure;
use phea_engineering::design::{
    DesignVerdict, ProjectDesign, ReachedStructure, RigMiss, SearchedControllers, SearchedLimit,
    UnusableController,
};
use phea_qft::loop_shaping::{Structure, StructureFactor};

use super::manual::part_name;
use crate::answer::Word;
use crate::audit::DelayedPaths;
use crate::limit_kind::limit_words;
use crate::quantity::{MotionKind, significant};
use crate::specification::numbered;

/// The verdict for people, with what it means.
pub(crate) fn verdict_sentence(verdict: &DesignVerdict, motion: MotionKind) -> String {
    match verdict {
        DesignVerdict::Stopped { is_met, is_driven, miss } => stopped_sentence(*is_met, *is_driven, *miss),
        DesignVerdict::NotProven => {
            "not proven: the controller satisfies every specification over the family, which does not include everything that is declared"
                .to_string()
        }
        DesignVerdict::Refuted => {
            "not met: the proof refutes what the search of the audit found to be met".to_string()
        }
        DesignVerdict::StepsMissed => {
            "not met: the controller satisfies every specification over frequency, and its steps miss what is required in time"
                .to_string()
        }
        DesignVerdict::MissedOnRig(miss) => {
            format!("not met: the controller satisfies every specification, and {}", rig_miss_words(*miss))
        }
        DesignVerdict::PrefilterAmplifies => {
            "not met: the controller satisfies every specification, and its prefilter amplifies by more than `design.prefilter_gain` allows: it commands in advance what the loop does not do"
                .to_string()
        }
        DesignVerdict::CommandBeyondValve { scenario, largest_v, limit_v, held_v } => {
            command_sentence(scenario, [*largest_v, *limit_v], *held_v, motion)
        }
        DesignVerdict::DelayNotTolerated(paths) => format!(
            "not met: the controller satisfies every specification, and its loop tolerates less further delay than `design.minimum_delay_margin` requires{}",
            delay_cure(*paths)
        ),
        DesignVerdict::Met { tolerance_db } => {
            let within = tolerance_db.map_or(String::new(), |tolerance_db| {
                format!(" within the tolerance of {} dB", significant(tolerance_db, 2))
            });
            format!("met: the controller satisfies every specification{within}")
        }
        DesignVerdict::StepsNotReached(controllers) => format!(
            "infeasible: none of the controllers tried{} makes its steps as they are required; the nearest one keeps all that is required over frequency",
            tested_words(*controllers)
        ),
        DesignVerdict::Infeasible { searched: controllers, relaxation_db } => format!(
            "infeasible: none of the controllers tried{} satisfies every specification; with every limit {} dB wider one does",
            tested_words(*controllers),
            significant(*relaxation_db, 3)
        ),
        DesignVerdict::Undecided => {
            "not converged: no audit of a controller that the search found decides whether it satisfies every specification"
                .to_string()
        }
        DesignVerdict::NotConverged { rounds, is_met } => format!(
            "not converged: after {rounds} rounds of search and audit the audit still finds what the search did not see; the controller {}",
            satisfaction(*is_met)
        ),
        DesignVerdict::NotStabilised(controllers) => format!(
            "not stabilised: none of the controllers tried{} makes every plant stable",
            tested_words(*controllers)
        ),
    }
}

fn satisfaction(is_met: bool) -> &'static str {
    if is_met { "satisfies every specification" } else { "does not satisfy every specification" }
}

/// The sentence on a stopped design.
fn stopped_sentence(is_met: bool, is_driven: bool, miss: Option<RigMiss>) -> String {
    let verdict = match is_met && !is_driven {
        true => "satisfies every specification as a linear loop; the nonlinear simulation has not driven it",
        false => satisfaction(is_met),
    };
    let missed = miss.filter(|_| is_met);
    let missed = missed.map_or(String::new(), |miss| format!(", but {}", rig_miss_words(miss)));
    format!("stopped: this is the best controller found so far, and it {verdict}{missed}")
}

/// The failure of the nonlinear rig.
pub(crate) fn rig_miss_words(miss: RigMiss) -> &'static str {
    match miss {
        RigMiss::WithoutRoom => {
            "the nonlinear rig satisfies what is required in time without room: a run comes back to the edge of its band so late that plants between those that were driven may leave it"
        }
        RigMiss::Missed => "the nonlinear rig misses what is required in time",
    }
}

/// Advice that leaves more delay, if a path within the force loop is delayed too.
fn delay_cure(paths: DelayedPaths) -> &'static str {
    match (paths.pressure_feedback, paths.velocity_feed_forward) {
        (true, _) => ": a smaller gain of the pressure feedback leaves more",
        (false, true) => ": a smaller gain of the velocity feed-forward leaves more",
        (false, false) => "",
    }
}

/// The command of a scenario's step that is beyond its limit.
fn command_sentence(
    scenario: &str,
    [largest_v, limit_v]: [f64; 2],
    held_v: Option<f64>,
    motion: MotionKind,
) -> String {
    let force = motion.words().force;
    let volts = |value: f64| format!("{} V", significant(value, 3));
    let hold = held_v.map_or(String::new(), |held_v| {
        format!(": {} hold the {force}, whatever the controller", volts(held_v))
    });
    format!(
        "not met: the controller satisfies every specification, and the steps of the scenario `{scenario}` take {} of the {} that `design.command_of_steps` leaves the valve{hold}",
        volts(largest_v),
        volts(limit_v)
    )
}

fn tested_words(controllers: SearchedControllers) -> String {
    match controllers {
        SearchedControllers::GivenStructure => ", all of the given structure,".to_string(),
        SearchedControllers::Named(name) => format!(", all of the structure {},", structure_name(name)),
        SearchedControllers::UpToOrder(maximum_order) => format!(", of order {maximum_order} at most,"),
    }
}

/// The reason not to use the designed controller; `None` if it may be used.
pub(super) fn unusable_words(view: &ProjectDesign) -> Option<String> {
    let words = |reason: UnusableController| match reason {
        UnusableController::UnstablePlant => "it does not make every plant of the family stable".to_string(),
        UnusableController::PrefilterGain(largest) => {
            format!("its prefilter multiplies the reference by up to {}", significant(largest, 3))
        }
    };
    let reasons: Vec<String> = view.unusable().into_iter().map(words).collect();
    (!reasons.is_empty()).then(|| reasons.join(", and "))
}

/// The name of a limit that the search satisfies.
pub(super) fn searched_limit_name(view: &ProjectDesign, limit: SearchedLimit) -> String {
    match limit {
        SearchedLimit::Specification(index) => numbered(view.designed.view.named(index)),
        SearchedLimit::Design(kind) => limit_words(kind).to_string(),
    }
}

/// The factors of a structure: integrator, zero, pole pair; a gain where there are none.
pub(super) fn structure_parts(structure: &Structure) -> Vec<&'static str> {
    match structure.parts.as_slice() {
        [] => vec!["gain"],
        parts => parts.iter().map(part_words).collect(),
    }
}

/// `integrator, zero, pole pair`
pub(super) fn structure_words(structure: &Structure) -> String {
    structure_parts(structure).join(", ")
}

/// Name of a structure, as people write it.
pub(super) fn structure_name(name: NamedStructure) -> &'static str {
    match name {
        NamedStructure::Proportional => "P",
        NamedStructure::Integral => "I",
        NamedStructure::ProportionalIntegral => "PI",
        NamedStructure::PiLowPass => "PI with low pass",
        NamedStructure::Pid => "PID with filter",
        NamedStructure::PiNotch => "PI with notch",
        NamedStructure::PiNotchLowPass => "PI with notch and low pass",
        NamedStructure::PiNotchLead => "PI with notch and lead",
        NamedStructure::PiTwoNotches => "PI with two notches",
    }
}

/// The name of a tested structure, or of the law that was found in its place.
pub(super) fn reached_words(one: &ReachedStructure) -> String {
    if let Some(law) = &one.no_pid {
        return law.parts.iter().map(part_name).collect::<Vec<_>>().join(" with ");
    }
    one.name.map_or_else(|| structure_words(&one.structure), |name| structure_name(name).to_string())
}

fn part_words(part: &StructureFactor) -> &'static str {
    match part {
        StructureFactor::ZeroPair { .. } => "zero pair",
        StructureFactor::PolePair { .. } => "pole pair",
        part => part.word(),
    }
}
