//! Table `[controller.pressure_feedback]`: consistency with samples and rig.

use std::f64::consts::PI;

use super::Check;
use crate::controller::GAIN_OF_PRESSURES;
use crate::{FeedbackChoice, Load, PressureSignal, Project};

const PLACE: &str = "controller.pressure_feedback";

pub(super) fn pressure_feedback(project: &Project, check: &mut Check<'_, '_>) {
    let is_free = is_free(project);
    if is_free {
        free(project, check);
    }
    let Some(controller) = &project.controller else { return };
    let Some(declared) = &controller.pressure_feedback else { return };
    let at = |name: &str| format!("{PLACE}.{name}");
    if is_measured(project) {
        let message = "[controller.pressure_feedback] needs the response of the pressures, which measured plants do not have";
        let help =
            "measure the plants with the pressures fed back and remove this table, or describe the rig";
        return check.error_with_help(PLACE, message, help);
    }
    if project.actuator.is_none() {
        let message = "[controller.pressure_feedback] acts on the pressures of chambers, and this project has no actuator";
        let help = "give the [plant] with what is fed back within it, or describe the rig";
        return check.error_with_help(PLACE, message, help);
    }
    let moves = project.actuator.as_ref().is_some_and(|actuator| actuator.load != Load::Prescribed);
    let fed = controller.load_velocity_feed_forward.is_some_and(|fed| fed.gain != Some(0.0));
    if controller.sample_time.is_some() && moves && fed {
        let message = "a sampled controller cannot feed the pressures back yet where it feeds the velocity of a load that can move forward too";
        return check.error_with_help(PLACE, message, "leave out one of them, or `sample_time`");
    }
    for (name, corner) in [("high_pass", declared.high_pass), ("low_pass", declared.low_pass)] {
        if let (Some(corner), Some(sample_time)) = (corner, controller.sample_time)
            && corner >= PI / sample_time
        {
            let message =
                format!("`{name}` is not below half the sampling frequency, {:.4} rad/s", PI / sample_time);
            check.error(&at(name), message);
        }
    }
    if declared.noise > 0.0 && controller.sample_time.is_none() {
        check.warning(&at("noise"), "`noise` has no effect on a continuous controller");
    }
    if !is_free && !check.declared(&at("gain")) {
        let message = "missing `gain` in [controller.pressure_feedback]";
        check.error_with_help(PLACE, message, GAIN_OF_PRESSURES);
    }
    if is_free && !check.declared(&at("gain")) {
        let message = "[controller.pressure_feedback] has no `gain` yet: `design` finds one, and until it is stated no pressure is fed back elsewhere";
        check.warning(PLACE, message);
    }
    if declared.gain == 0.0 && !is_free && check.declared(&at("gain")) {
        check.warning(&at("gain"), "[controller.pressure_feedback] has no effect: its gain is zero");
    }
    if declared.gain < 0.0 {
        check.warning(&at("gain"), "a negative `gain` takes damping from the rig");
    }
    if declared.signal == PressureSignal::PressureDifference && declared.area_ratio.is_some() {
        let message = "`area_ratio` is that of `signal = \"load_pressure\"`";
        check.error(&at("area_ratio"), message);
    }
    if let (Some(high), Some(low)) = (declared.high_pass, declared.low_pass)
        && high >= low
    {
        check.error(&at("high_pass"), "`high_pass` is not below `low_pass`: no frequency passes both");
    }
}

/// True if a design finds the feedback.
fn is_free(project: &Project) -> bool {
    project.design.as_ref().is_some_and(|design| design.pressure_feedback == FeedbackChoice::Free)
}

/// True if the plants are measured responses.
fn is_measured(project: &Project) -> bool {
    project.family.as_ref().is_some_and(|family| !family.measured.is_empty())
}

/// Requirements of a free feedback.
fn free(project: &Project, check: &mut Check<'_, '_>) {
    const PLACE: &str = "design.pressure_feedback";
    if is_measured(project) {
        let message = "a free `pressure_feedback` needs the response of the pressures, which measured plants do not have";
        return check.error_with_help(
            PLACE,
            message,
            "describe the rig in place of `measured` of [family], or leave it out",
        );
    }
    if project.actuator.is_none() {
        let message =
            "a free `pressure_feedback` acts on the pressures of chambers, and this project has no actuator";
        return check.error_with_help(PLACE, message, "describe the rig, or leave it out");
    }
    let fed = project.controller.as_ref().and_then(|controller| controller.load_velocity_feed_forward);
    let moves = project.actuator.as_ref().is_some_and(|actuator| actuator.load != Load::Prescribed);
    if moves && fed.is_some_and(|fed| fed.gain != Some(0.0)) {
        let message = "a free `pressure_feedback` is not found yet where the velocity of a load that can move is fed forward";
        check.error_with_help(PLACE, message, "leave out one of them");
    }
}
