//! Machines of a trial and the results of their runs, in words.

use super::{
    Agreement, DampingWall, DifferenceCause, Leg, NotDriven, OvershootNote, REACH, StepSize, Trial,
    TrialFinding, TrialMachine, TrialReason, TrialRun, UnsettledEnd, WorstOf,
};
use crate::document::Cell;
use crate::plant_names::plant_words;
use crate::quantity::{DisplayUnit, MotionKind, MotionWords, Units, significant};
use crate::specification::numbered;
use crate::verdict_words::agreement_word;

/// The machine of a run, without the size of its steps.
pub(crate) fn machine_words(machine: &TrialMachine) -> String {
    match machine {
        TrialMachine::Declared => "the rig as declared".to_string(),
        TrialMachine::WithWaves => "the rig with waves in its lines".to_string(),
        TrialMachine::WorstPlant(of) => worst_plant(of),
        TrialMachine::WorstOfBox { corners, inside } => {
            format!("the worst of {corners} corners of the box and {inside} plants inside")
        }
    }
}

fn worst_plant(of: &WorstOf) -> String {
    match of {
        WorstOf::Specification(named) => format!("the worst plant of {}", numbered(Some(*named))),
        WorstOf::InTime(named) => format!("the worst plant of {} in time", numbered(Some(*named))),
        WorstOf::RequiredStep => "the worst plant of the required step".to_string(),
    }
}

/// The name of a run: its machine, and the size of its steps if it is not the usual one.
pub(crate) fn run_name(run: &TrialRun) -> String {
    name_of(&run.machine_driven, run.size)
}

/// The name of a run through steps of this size.
pub(crate) fn name_of(machine: &TrialMachine, size: StepSize) -> String {
    let ending = match size {
        StepSize::Tenth => "",
        StepSize::Reversed => ", the other way",
        StepSize::Scenario => ", step of a scenario",
        StepSize::Largest => ", largest step",
        StepSize::Required => ", required step",
    };
    format!("{}{ending}", machine_words(machine))
}

/// True if two runs have one machine and steps of equal size.
pub(crate) fn have_one_name(run: &TrialRun, other: &TrialRun) -> bool {
    run.machine_driven == other.machine_driven && run.size == other.size
}

/// The size of a step that is called the largest.
pub(crate) fn largest_step_words(motion: MotionKind) -> String {
    let MotionWords { force, force_sensor, .. } = motion.words();
    format!(
        "up to {} % of the {force} that the supply can produce, the capacity of the {force_sensor} and the limit of the command, whichever is least, and smaller where a run meets a limit all the same",
        significant(100.0 * REACH, 3)
    )
}

/// The word of an agreement for programs.
pub(crate) fn agreement_key(agreement: Agreement) -> &'static str {
    match agreement {
        Agreement::AgreesButForSettling => "agrees_but_for_settling",
        Agreement::Agrees | Agreement::Differs | Agreement::Contradicts => agreement_word(agreement),
    }
}

impl Cell {
    /// The mark for the trial of a verdict on the machine.
    pub(crate) fn agreement(agreement: Agreement) -> Cell {
        Cell::from(agreement_word(agreement)).marked(agreement)
    }
}

/// `2.10 %`; values below a hundredth count as zero.
pub(crate) fn percent_words(percent: f64) -> String {
    if percent < 0.01 { "0 %".to_string() } else { format!("{} %", significant(percent, 3)) }
}

/// Result of a run, with the cause of a difference.
pub(crate) fn reason_words(reason: &TrialReason, units: Units) -> String {
    let finding = finding_words(&reason.finding, units);
    match &reason.cause {
        Some(cause) => format!("{finding}. {}", cause_of_difference(cause)),
        None => finding,
    }
}

/// Result of a run, without the range in which its force swings and without the frequency of the
/// waves in its lines.
pub(crate) fn brief_reason(reason: &TrialReason, units: Units) -> String {
    let finding = match &reason.finding {
        TrialFinding::Unsettled { leg, end: Some(UnsettledEnd::Swings(_)) } => {
            let finding = TrialFinding::Unsettled { leg: *leg, end: None };
            finding_words(&finding, units)
        }
        TrialFinding::Overshoots { percent, leg, linear, note: OvershootNote::Swings(_) } => {
            format!("{}, and does not come to rest", overshoots(*percent, *leg, *linear))
        }
        finding => finding_words(finding, units),
    };
    match &reason.cause {
        Some(cause @ (DifferenceCause::OtherThanWaves | DifferenceCause::Noise)) => {
            format!("{finding}. {}", cause_of_difference(cause))
        }
        Some(DifferenceCause::Waves { .. }) | None => finding,
    }
}

fn milliseconds(time_s: f64) -> String {
    DisplayUnit::MILLISECOND.text(time_s, 3)
}

const NEITHER_SETTLES: &str = "neither the linear loop nor the nonlinear simulation settles";

/// Result of a run compared with its linear loop.
pub(crate) fn finding_words(finding: &TrialFinding, units: Units) -> String {
    match finding {
        TrialFinding::NeitherSettles { overshoots: None } => NEITHER_SETTLES.to_string(),
        TrialFinding::NeitherSettles { overshoots: Some(both) } => {
            let [own, predicted] = both.map(percent_words);
            format!(
                "it overshoots by {own}, where the linear loop has {predicted}, and {NEITHER_SETTLES} within the run"
            )
        }
        TrialFinding::NotStarted(error) => format!("the nonlinear simulation does not start: {error}"),
        TrialFinding::Diverges(time) => {
            format!("the nonlinear simulation diverges from {} on", milliseconds(*time))
        }
        TrialFinding::StoppedEarly { time, status } => {
            format!("the run ended after {} as {}", milliseconds(*time), status.key())
        }
        TrialFinding::Unsettled { leg, end } => {
            let words = end.map_or(String::new(), |end| format!(": {}", end_words(end, units)));
            format!("the {} does not settle{}{words}", units.motion.words().force, leg_words(*leg))
        }
        TrialFinding::Overshoots { percent, leg, linear, note } => {
            let overshoots = overshoots(*percent, *leg, *linear);
            match note {
                OvershootNote::Nothing => overshoots,
                OvershootNote::BeyondLimit => {
                    format!("{overshoots}: more than the limit on |L/(1+L)| lets a loop overshoot")
                }
                OvershootNote::Swings(range) => {
                    format!("{overshoots}, and does not come to rest: {}", range_words(*range, units))
                }
                OvershootNote::Undetermined => format!("{overshoots}, and no solver determines the result"),
                OvershootNote::Meets(kind) => format!("{overshoots}, and meets {}", kind.replace('_', " ")),
            }
        }
        TrialFinding::Settles { machine, linear, required } => {
            let [own, predicted] = [*machine, *linear].map(milliseconds);
            match required {
                None => format!("it settles in {own}, where the linear loop takes {predicted}"),
                Some(most) => format!(
                    "it settles in {own}, where {} is required and the linear loop takes {predicted}",
                    milliseconds(*most)
                ),
            }
        }
    }
}

fn overshoots(percent: f64, leg: Leg, linear: Option<f64>) -> String {
    let against = linear.map_or(String::new(), |predicted| {
        format!(", where the linear loop has {}", percent_words(predicted))
    });
    format!("it overshoots by {}{}{against}", percent_words(percent), leg_words(leg))
}

fn end_words(end: UnsettledEnd, units: Units) -> String {
    match end {
        UnsettledEnd::AtRest { force, off_percent } => format!(
            "it comes to rest at {}, {} of the step off its reference",
            units.force.text(force, 5),
            percent_words(off_percent)
        ),
        UnsettledEnd::Swings(range) => range_words(range, units),
    }
}

fn leg_words(leg: Leg) -> &'static str {
    match leg {
        Leg::There => "",
        Leg::Back => " on the way back",
        Leg::Again => " when the step is repeated",
    }
}

fn range_words(range: [f64; 2], units: Units) -> String {
    let [low, high] = range.map(|force| units.force.text(force, 3));
    format!("at the end it swings between {low} and {high}")
}

fn cause_of_difference(cause: &DifferenceCause) -> String {
    match cause {
        DifferenceCause::Waves { quarter_wave, wall } => {
            let wall = match wall {
                None => "",
                Some(DampingWall::RelaxationTime) => " a wall that damps (line.relaxation_time)",
                Some(DampingWall::SegmentsWithRelaxationTime) => {
                    " a wall that damps (line.model = \"segments\" with line.relaxation_time)"
                }
            };
            format!(
                "The lines are a quarter wave long at {} rad/s: a shorter line,{wall} or a loop with less gain from there on",
                significant(*quarter_wave, 3)
            )
        }
        DifferenceCause::OtherThanWaves => {
            "The same steps with lumped lines do not agree either: the waves are not the cause".to_string()
        }
        DifferenceCause::Noise => {
            "The same steps without the noise of the sensors agree: the noise is the cause".to_string()
        }
    }
}

/// Plant or step that a trial does not simulate.
fn not_driven_words(one: &NotDriven, units: Units) -> String {
    match one {
        NotDriven::Plant { of, plant, reason } => {
            format!("{} ({}): {reason}", worst_plant(of), plant_words(plant))
        }
        NotDriven::SmallerStep(forces) => {
            let [from, to] = forces.map(|force| units.force.short(force, 3));
            format!("a smaller step of a scenario, {from} to {to}")
        }
    }
}

/// The units of the machines that a trial drives.
pub(super) fn units_of(trial: &Trial) -> Units {
    trial.runs.first().map_or_else(Units::default, |run| run.units)
}

/// Parts that a trial does not drive.
pub(crate) fn not_driven(trial: &Trial) -> Vec<String> {
    let units = units_of(trial);
    trial.not_driven.iter().map(|one| not_driven_words(one, units)).collect()
}
