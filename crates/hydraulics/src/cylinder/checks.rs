//! Checks of a cylinder, and of a motor in its place.

use phea_quantity::{LENGTH, display};
use phea_table::TableCheck;

use super::keys::DeclaredCylinder;
use super::motor_keys::DeclaredMotor;
use crate::stroke::FURTHER_STAGES;

impl DeclaredCylinder {
    /// Checks piston, rods and stages.
    pub fn check(&self, check: &mut dyn TableCheck) {
        self.check_piston(check);
        // rods are already subtracted from an area
        let by_area = self.piston_area.is_some() || self.piston_areas.is_some();
        let written =
            ["rod_diameter", "rod_diameters"].iter().any(|name| check.declared(&format!("cylinder.{name}")));
        let by_model = self.rod_diameter.is_some() || self.rod_diameters.is_some();
        if !by_area && !written && !by_model && !check.refused("cylinder.model") {
            let message = "missing `rod_diameter` or `rod_diameters` in [cylinder]";
            check.missing("cylinder", "rod_diameter", message);
        }
        let too_thick = |piston: f64| self.rod_diameters_m().iter().any(|rod| *rod >= piston);
        if self.piston_diameter.is_some_and(too_thick) {
            let at =
                if self.rod_diameters.is_some() { "cylinder.rod_diameters" } else { "cylinder.rod_diameter" };
            check.error(at, "the rod is as thick as the piston or thicker: no area is left for the oil");
        }
        if self.stages.is_empty() && check.declared("cylinder.stage_transition") {
            let message = "`stage_transition` has no effect without [[cylinder.stage]]";
            check.warning("cylinder.stage_transition", message);
        }
        self.check_stages(check);
    }

    /// Checks the piston: a single area suffices only for a rod through both chambers.
    fn check_piston(&self, check: &mut dyn TableCheck) {
        let [rod_a, rod_b] = self.rod_diameters_m();
        if self.piston_area.is_some() && (rod_a - rod_b).abs() > 0.0 {
            let message = "with unequal rods `piston_area` is not the same in both chambers: give `piston_diameter`, or `piston_areas`";
            check.error("cylinder.piston_area", message);
        }
    }

    /// Checks that the stages of a telescopic piston follow each other within the stroke.
    fn check_stages(&self, check: &mut dyn TableCheck) {
        if self.stages.len() > FURTHER_STAGES {
            let message = format!(
                "{} stages follow the first, and a telescopic piston has at most {FURTHER_STAGES} of them",
                self.stages.len()
            );
            check.error(&format!("cylinder.stage[{FURTHER_STAGES}]"), message);
        }
        let half = 0.5 * self.stage_transition;
        let in_words = |value: f64| display(value, &LENGTH, 4);
        let mut before = 0.0;
        for (index, stage) in self.stages.iter().enumerate() {
            let at = format!("cylinder.stage[{index}].from");
            if stage.from - half < before {
                let least = in_words(before + half);
                let message = format!(
                    "this stage begins within the transition before it, which ends at {}: `from` must be at least {least}",
                    in_words(before)
                );
                check.error_with_help(&at, message, "let it begin later, or reduce `stage_transition`");
            } else if stage.from + half > self.stroke {
                let most = in_words(self.stroke - half);
                let message = format!(
                    "the transition to this stage ends beyond the stroke of {}: `from` must be at most {most}",
                    in_words(self.stroke)
                );
                check.error_with_help(
                    &at,
                    message,
                    "let it begin earlier, or state the stroke of all stages",
                );
            }
            before = stage.from + half;
        }
    }
}

impl DeclaredMotor {
    /// Checks that a motor with stops has ends.
    pub fn check(&self, check: &mut dyn TableCheck) {
        if self.end_stops.is_some() && self.stroke.is_none() && !check.declared("motor.stroke") {
            let message = "a motor without `stroke` rotates without limit: it has no ends to stop at";
            let help = "state the `stroke`, or remove [motor.end_stops]";
            check.error_with_help("motor.end_stops", message, help);
        }
    }
}
