//! The names of the columns of alternatives, and why there are no numbers in them.

use super::{
    ColumnKey, FeasibilityUnknown, JudgeError, JudgedAlternative, LengthUnknown, NoFrontValue, NoNumber,
};
use crate::design::verdict_sentence;
use crate::error::design_error_words;
use crate::linearize::no_closed_impedance_words;
use crate::quantity::MotionKind;
use crate::simulate::{RunStatus, unmeasured_words};
use phea_engineering::parts::{PartKind, PartsUnknown, UnstatedPart};

/// The name of a column for people.
pub(super) fn column_name(key: ColumnKey, motion: MotionKind) -> &'static str {
    match key {
        ColumnKey::Relaxation => "relaxation needed",
        ColumnKey::Order => "order of G",
        ColumnKey::PrefilterOrder => "order of F",
        ColumnKey::RelativeDegree => "relative degree of G",
        ColumnKey::HighFrequencyGain => "high-frequency gain",
        ColumnKey::ModulusMargin => "modulus margin",
        ColumnKey::DelayMargin => "delay tolerated",
        ColumnKey::WorstMargin => "least margin",
        ColumnKey::StiffnessMinimum => motion.either("least K_H", "least K_θ"),
        ColumnKey::StiffnessMaximum => motion.either("greatest K_H", "greatest K_θ"),
        ColumnKey::EquivalentStiffness => "K_eq at the point",
        ColumnKey::ActuatorLength => "length, retracted",
        ColumnKey::LinesLength => "length of both lines",
        ColumnKey::MovingMass => motion.either("moving mass", "inertia"),
        ColumnKey::LinesVolume => "oil in both lines",
        ColumnKey::OilVolume => "oil in all",
        ColumnKey::OilMass => "mass of that oil",
        ColumnKey::GasVolume => "gas",
        ColumnKey::PowerAtRest => "loss at rest",
        ColumnKey::PartsPrice => "price of its parts",
        ColumnKey::PartsMass => "mass of its parts and of the oil in lines",
        ColumnKey::SizedLength => "length by [sizing]",
        ColumnKey::SizedGain => "gain by [sizing]",
        ColumnKey::ImpedanceOpen => "open loop",
        ColumnKey::ImpedanceClosed => "closed loop",
        ColumnKey::ImpedanceRequired => "required",
        ColumnKey::Overshoot => "overshoot",
        ColumnKey::SettlingTime => "settling",
        ColumnKey::DisturbancePeak => "disturbance",
        ColumnKey::ControlPeak => "control peak",
        ColumnKey::ControlRms => "control rms",
        ColumnKey::EnergyFromSupply => "energy from supply",
        ColumnKey::Swept => "swept",
    }
}

/// The name of a measure of dominance for people.
pub(super) fn measure_name(key: ColumnKey, motion: MotionKind) -> &'static str {
    match key {
        ColumnKey::PartsPrice => "price",
        ColumnKey::PartsMass => "mass",
        ColumnKey::Order => "order",
        key => column_name(key, motion),
    }
}

/// Entry of a table for a number that the project should state.
pub(super) const NOT_STATED: &str = "not stated";

/// The error of a missing finding on an alternative.
pub(super) fn judge_error_words(error: &JudgeError) -> String {
    match error {
        JudgeError::Design(error) => design_error_words(error),
        error => error.to_string(),
    }
}

/// Reason why a column has no number.
pub(super) fn no_number_words(reason: &NoNumber) -> String {
    let fixed = match reason {
        NoNumber::NotJudged(error) => return judge_error_words(error),
        NoNumber::Stopped { time_s, status: RunStatus::Diverged } => {
            return format!("the run diverges from {time_s} s on");
        }
        NoNumber::Stopped { time_s, status } => {
            return format!("the run ended at {time_s} s: {}", status.key());
        }
        NoNumber::OutsideModel { time_s } => {
            return format!("from {time_s} s on the equations of the simulation do not hold");
        }
        NoNumber::Parts(reason) => return parts_unknown_words(reason),
        NoNumber::NotFoundInfeasible => "the specifications were not found infeasible",
        NoNumber::NotKnownStable => "not known of a family that is not known to be stable",
        NoNumber::NothingToJudgeBy => "there is nothing by which to judge it",
        NoNumber::Undetermined => "no solver determines the result of the run",
        NoNumber::NoMetric(reason, motion) => unmeasured_words(*reason, *motion),
        NoNumber::NoEvent => "no event begins in the scenario",
        NoNumber::NoHose => "no hose of the catalogue is accepted",
        NoNumber::Length(reason) => length_unknown_words(*reason),
        NoNumber::LineIsVolume => "a line that is stated as a volume has no length",
        NoNumber::NoAccumulator => "there is no accumulator at the chambers",
        NoNumber::NoClosedLoop(reason) => reason.map_or("", no_closed_impedance_words),
    };
    fixed.to_string()
}

/// True if the project should state a number.
pub(super) fn is_unstated(reason: &NoNumber) -> bool {
    match reason {
        NoNumber::Parts(PartsUnknown::NotStated(_)) => true,
        NoNumber::Length(reason) => match reason {
            LengthUnknown::NoDeadLength | LengthUnknown::NoCoil | LengthUnknown::NoSeriesCylinderLength => {
                true
            }
            LengthUnknown::Motor | LengthUnknown::TooFewCoils => false,
        },
        _ => false,
    }
}

/// Reason why the retracted length of an actuator is not known.
fn length_unknown_words(reason: LengthUnknown) -> &'static str {
    match reason {
        LengthUnknown::Motor => "a motor has no retracted length",
        LengthUnknown::NoDeadLength => "not stated: cylinder.dead_length",
        LengthUnknown::NoCoil => "not stated: series.coil, which has a length",
        LengthUnknown::TooFewCoils => "the coils of the series spring are too few to be wound",
        LengthUnknown::NoSeriesCylinderLength => "not stated: series.cylinder_length",
    }
}

/// Reason why the parts of a rig have no known sum.
pub(super) fn parts_unknown_words(reason: &PartsUnknown) -> String {
    match reason {
        PartsUnknown::NoPrice => "no part states a price".to_string(),
        PartsUnknown::NoMass => "no part states a mass".to_string(),
        PartsUnknown::NotStated(parts) => {
            let names: Vec<String> = parts.iter().map(part_name).collect();
            format!("{NOT_STATED}: {}", names.join(", "))
        }
    }
}

fn part_name(part: &UnstatedPart) -> String {
    let [one, several] = match part.kind {
        PartKind::Hose => ["hose", "hoses"],
        PartKind::Pipe => ["pipe", "pipes"],
        PartKind::Accumulator => ["accumulator", "accumulators"],
        PartKind::ChamberValve { names, .. } => names,
        PartKind::SeriesSpring => ["series spring", "series springs"],
        PartKind::TransmissionCylinders => ["cylinders of the transmission", "cylinders of transmissions"],
        PartKind::TransmissionLine => ["line of the transmission", "lines of transmissions"],
        PartKind::Servovalve => ["servovalve", "servovalves"],
    };
    match (part.both, part.side) {
        (true, _) => several.to_string(),
        (false, Some(side)) => format!("{one} {side}"),
        (false, None) => one.to_string(),
    }
}

/// Reason why it is not known whether an alternative satisfies every specification.
pub(super) fn undecided_words(one: &JudgedAlternative) -> String {
    match &one.design {
        Ok(view) => verdict_sentence(&view.verdict(), one.loaded.project.motion()),
        Err(reason) => judge_error_words(reason),
    }
}

/// Reason why it is not known whether a point of a front satisfies every specification.
pub(super) fn unknown_words(reason: &FeasibilityUnknown, motion: MotionKind) -> String {
    match reason {
        FeasibilityUnknown::NotPrepared(error) => error.to_string(),
        FeasibilityUnknown::NotDesigned(error) => judge_error_words(error),
        FeasibilityUnknown::Undecided(verdict) => verdict_sentence(verdict, motion),
    }
}

/// Reason why a point of a front has no value in a column.
pub(super) fn no_front_value_words(reason: &NoFrontValue) -> String {
    match reason {
        NoFrontValue::NotPrepared(error) => error.to_string(),
        NoFrontValue::NoColumn => "there is no such column here".to_string(),
        NoFrontValue::NoNumber(reason) => no_number_words(reason),
        NoFrontValue::NotInEveryScenario => "not in every scenario".to_string(),
    }
}
