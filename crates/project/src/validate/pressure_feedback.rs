//! `[controller.pressure_feedback]`: what has to fit samples and rig.

use super::Check;
use crate::{PressureSignal, Project};

const PLACE: &str = "controller.pressure_feedback";

pub(super) fn pressure_feedback(project: &Project, check: &mut Check<'_, '_>) {
    let Some(controller) = &project.controller else { return };
    let Some(declared) = &controller.pressure_feedback else { return };
    let at = |name: &str| format!("{PLACE}.{name}");
    if project.actuator.is_none() {
        let message = "[controller.pressure_feedback] acts on the pressures of chambers, and this project has no actuator";
        let help = "give the [plant] with what is fed back within it, or describe the rig";
        return check.error_with_help(PLACE, message, help);
    }
    if controller.sample_time.is_some() {
        let message = "the pressure feedback of a sampled controller is not simulated yet";
        return check.error_with_help(PLACE, message, "leave out `sample_time`");
    }
    if declared.gain == 0.0 && check.declared(&at("gain")) {
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
