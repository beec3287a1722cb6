//! Table `[controller.impedance]`: consistency with controller, samples and load.

use std::f64::consts::PI;

use super::Check;
use crate::{DeclaredController, DeclaredImpedance, ImpedanceForm, Project};

const PLACE: &str = "controller.impedance";

pub(super) fn impedance(project: &Project, check: &mut Check<'_, '_>) {
    let Some(controller) = &project.controller else { return };
    let Some(declared) = &controller.impedance else { return };
    let stated = |name: &str| check.declared(&format!("{PLACE}.{name}"));
    if !["stiffness", "damping", "mass"].into_iter().any(stated) {
        return check
            .error(PLACE, "an impedance takes `stiffness`, `damping` or `mass`, at least one of them");
    }
    if project.actuator.is_none() {
        let message = "[controller.impedance] acts on the position of the load, and this project has no actuator with a load";
        return check.error_with_help(
            PLACE,
            message,
            "give the [plant] the loop with its impedance, or describe the rig",
        );
    }
    if declared.is_zero() && declared.form == ImpedanceForm::Impedance {
        check
            .warning(PLACE, "[controller.impedance] has no effect: its stiffness, damping and mass are zero");
    }
    filter(declared, controller.sample_time, check);
    if declared.form == ImpedanceForm::Admittance {
        admittance(declared, controller, check);
    }
}

/// Checks the filter, which makes damper and mass proper, and acts before the samples.
fn filter(declared: &DeclaredImpedance, sample_time: Option<f64>, check: &mut Check<'_, '_>) {
    let place = format!("{PLACE}.filter_time");
    let Some(filter_time) = declared.filter_time else {
        if declared.damping > 0.0 || declared.mass > 0.0 {
            let message = "`damping` and `mass` differentiate the measured position, which needs a filter: state its `filter_time`";
            check.missing(PLACE, "filter_time", message);
        }
        return;
    };
    if declared.damping == 0.0 && declared.mass == 0.0 {
        check.warning(&place, "`filter_time` has no effect without `damping` or `mass`");
    }
    if let Some(sample_time) = sample_time.filter(|sample_time| filter_time < sample_time / PI) {
        let least = sample_time / PI;
        let message = format!(
            "`filter_time` is too short for the samples: the filter passes what lies beyond half the sampling frequency, at {:.4} rad/s",
            PI / sample_time
        );
        check.error_with_help(&place, message, format!("at least sample_time/pi = {least:.3e} s"));
    }
}

/// Checks an inner position loop: its law with the impedance is a force law.
fn admittance(declared: &DeclaredImpedance, controller: &DeclaredController, check: &mut Check<'_, '_>) {
    let place = format!("{PLACE}.form");
    if declared.is_zero() {
        let message = "an admittance needs an impedance: its stiffness, damping and mass are zero";
        return check.error(&place, message);
    }
    if !controller.has_law() {
        let message = "form = \"admittance\" needs the controller of the position: [controller] gives no transfer function";
        return check.error_with_help(
            &place,
            message,
            "a controller of the force can be designed with form = \"impedance\"",
        );
    }
    if super::linear_loop::is_discrete(&controller.transfer) {
        let message = "form = \"admittance\" takes a controller in `s`: this one is in `z`";
        check.error_with_help(&place, message, "write the controller of the force, and form = \"impedance\"");
    }
}
