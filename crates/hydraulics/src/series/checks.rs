//! Checks of the element between force sensor and load: consistency of its keys, and its capacity
//! for the force of the cylinder.

use phea_quantity::{self as quantity, AREA, FORCE, LENGTH, PRESSURE, STIFFNESS};
use phea_table::TableCheck;

use super::keys::{DeclaredSeries, DeclaredSpring, DeclaredTransmission};
use super::spring::is_free;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE as ATMOSPHERE;
use crate::line::Stiffening;

impl DeclaredSeries {
    /// Checks the element between a sensor and the load of a cylinder with these stall forces in N,
    /// the greatest push and the greatest pull.
    pub fn check(&self, stall_forces: [f64; 2], check: &mut dyn TableCheck) {
        match self {
            DeclaredSeries::Spring(spring) => spring.check(stall_forces, check),
            DeclaredSeries::Transmission(transmission) => transmission.check(stall_forces, check),
        }
    }
}

impl DeclaredTransmission {
    /// Checks the line between two pistons, and the capacity of its oil for the force of the
    /// cylinder.
    fn check(&self, stall_forces: [f64; 2], check: &mut dyn TableCheck) {
        if check.declared("series.line") {
            self.line.check("series.line", check);
        }
        if let Some(Stiffening { nominal, minimum, maximum }) = self.line.dynamic_stiffening
            && (minimum, maximum) != (nominal, nominal)
        {
            let message = "only `nominal` counts here: the line of a transmission has one stiffness";
            let help = "state the range as [uncertainty] \"series.line.dynamic_stiffening.nominal\"";
            check.warning_with_help("series.line.dynamic_stiffening", message, help);
        }
        let rests = ["series.piston_area", "series.filling_pressure", "supply.pressure"];
        if rests.iter().any(|path| check.refused(path) || !check.declared(path)) || self.piston_area <= 0.0 {
            return;
        }
        self.check_pull(stall_forces[1], check);
        self.check_push(stall_forces[0], check);
    }

    /// Checks that the oil column does not separate under the greatest pull in N.
    fn check_pull(&self, pull: f64, check: &mut dyn TableCheck) {
        let area = self.piston_area;
        let holds = area * (self.filling_pressure + ATMOSPHERE);
        let separates = holds < pull;
        if !separates {
            return;
        }
        let message = format!(
            "filled with {} the oil tears off at a pull of {}, and the cylinder pulls with up to {} (stall force)",
            pressure(self.filling_pressure),
            force(holds),
            force(pull)
        );
        let wider = quantity::display(round_up(pull / (self.filling_pressure + ATMOSPHERE)), &AREA, 4);
        let fuller = round_up(pull / area - ATMOSPHERE);
        let fill = if fuller < MOST_FILLING {
            format!("fill it with {} or more, or ", pressure(fuller))
        } else {
            String::new()
        };
        let help = format!("for loads that are pulled, {fill}take a `piston_area` of at least {wider}");
        check.warning_with_help("series.filling_pressure", message, help);
    }

    /// Checks that its line withstands the greatest push in N.
    fn check_push(&self, push: f64, check: &mut dyn TableCheck) {
        let most = self.filling_pressure + push / self.piston_area;
        let of_hose = self.line.hose().and_then(|hose| hose.working_pressure);
        let of_pipe = self.line.pipe().and_then(|pipe| pipe.working_pressure);
        let (part, limit) = (if of_hose.is_some() { "hose" } else { "pipe" }, of_hose.or(of_pipe));
        let Some(working) = limit.filter(|working| *working < most) else { return };
        let message = format!(
            "at the stall force of {} the oil of the transmission has {}, and the {part}'s `working_pressure` is {}",
            force(push),
            pressure(most),
            pressure(working)
        );
        let key = match part {
            "hose" if self.line.hose_name().is_some() => "hose",
            "hose" => "working_pressure",
            _ if check.declared("series.line.pipe.working_pressure") => "pipe.working_pressure",
            _ => "pipe.model",
        };
        check.warning(&format!("series.line.{key}"), message);
    }
}

/// Largest filling pressure that is proposed, Pa.
const MOST_FILLING: f64 = 500e5;

fn pressure(value: f64) -> String {
    quantity::display(value, &PRESSURE, 4)
}

fn force(value: f64) -> String {
    quantity::display(value, &FORCE, 4)
}

impl DeclaredSpring {
    fn check(&self, stall_forces: [f64; 2], check: &mut dyn TableCheck) {
        if self.travel.is_none() {
            for (key, needs) in [
                ("progression", self.progression > Some(0.0)),
                ("stop_stiffness", self.stop_stiffness.is_some()),
            ] {
                let path = format!("series.{key}");
                if needs && !check.refused("series.travel") {
                    let message = format!(
                        "`{key}` says what happens over the `travel` of the spring, which is not stated"
                    );
                    check.error_with_help(&path, message, "state `travel`, to either side");
                }
            }
        }
        if self.coil.is_some() && self.progression > Some(0.0) {
            let message = "a coil of constant pitch is linear: it has no `progression`";
            check.error_with_help("series.coil", message, "take out one of the two");
        }
        self.check_damped_stops(check);
        self.check_travel(("series.travel", self.stiffness), stall_forces, check);
    }

    /// Requires a damper or a mass with stops: otherwise only the force determines the velocity of
    /// the spring.
    fn check_damped_stops(&self, check: &mut dyn TableCheck) {
        if self.stop_damping == 0.0 {
            return;
        }
        if self.stop_stiffness.is_none() {
            let message = "`stop_damping` damps stops that are not there";
            return check.error_with_help("series.stop_damping", message, "state `stop_stiffness`");
        }
        if is_free(self.damping, self.mass) {
            let message = "`stop_damping` needs `damping` or `mass`: a massless spring without a damper jumps from any speed to any other";
            let help = "state the `damping` of the spring, or the `mass` between sensor and spring";
            check.error_with_help("series.stop_damping", message, help);
        }
    }

    /// Checks that the stall force of the cylinder is within the travel, for a stiffness in N/m
    /// that is stated at `place`.
    pub fn check_travel(
        &self,
        (place, stiffness): (&str, f64),
        [push, pull]: [f64; 2],
        check: &mut dyn TableCheck,
    ) {
        let Some(travel) = self.travel else { return };
        let stall = push.max(pull);
        let holds = stiffness * travel * (1.0 + self.progression.unwrap_or(0.0));
        if ["series.stiffness", "series.travel", "supply.pressure"].iter().any(|path| check.refused(path))
            || !(stall > holds && holds > 0.0)
        {
            return;
        }
        let message = format!(
            "the spring reaches the end of its `travel` of {} at {}, and the cylinder pushes with up to {} (stall force): it would bottom out, \
             and the rig become rigid",
            quantity::display(travel, &LENGTH, 4),
            force(holds),
            force(stall)
        );
        let factor = 1.0 + self.progression.unwrap_or(0.0);
        let help = format!(
            "give it a `travel` of at least {}, or a `stiffness` of at least {}, or lower the supply pressure",
            quantity::display(round_up(stall / (stiffness * factor)), &LENGTH, 4),
            quantity::display(round_up(stall / (travel * factor)), &STIFFNESS, 4)
        );
        check.error_with_help(place, message, help);
    }
}

/// Next higher number with three digits, so that the proposal of a message is sufficient.
fn round_up(value: f64) -> f64 {
    let mut unit = 1.0;
    while value / unit >= 1000.0 {
        unit *= 10.0;
    }
    while value / unit < 100.0 {
        unit /= 10.0;
    }
    (value / unit).ceil() * unit
}
