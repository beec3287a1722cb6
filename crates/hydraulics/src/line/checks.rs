//! Checks of a line and of its model in motion.

use phea_quantity::{self as quantity, LENGTH, PRESSURE};
use phea_table::TableCheck;

use super::Stiffening;
use super::keys::{Component, DeclaredLine, DeclaredPipe};
use super::motion_keys::LineMotion;

impl DeclaredLine {
    /// Checks what the line is made of, in the table at `path`.
    pub fn check(&self, path: &str, check: &mut dyn TableCheck) {
        let written = |names: &[&str]| names.iter().any(|name| check.declared(&format!("{path}.{name}")));
        let ways = [written(&Component::HOSE), written(&["pipe"]), written(&Component::VOLUME)];
        match ways {
            [false, false, false] => {
                let or_volume =
                    if path.starts_with("line") { "`hose`, `pipe` or `volume`" } else { "`hose` or `pipe`" };
                let message = format!("missing {or_volume} in [{path}]");
                return check.missing(path, "pipe", message);
            }
            [true, false, false] | [false, true, false] | [false, false, true] => {}
            [_, is_pipe, _] => {
                let at = if is_pipe { "pipe" } else { "volume" };
                let ways =
                    if path.starts_with("line") { "a hose, a pipe or a volume" } else { "a hose or a pipe" };
                return check.error(&format!("{path}.{at}"), format!("a line is {ways}: only one of them"));
            }
        }
        self.check_unused(path, check);
        let of_hose = self.hose().map(|hose| ("", hose.working_pressure, hose.burst_pressure));
        let of_pipe = self.pipe().map(|pipe| (".pipe", pipe.working_pressure, pipe.burst_pressure));
        if let Some((part, Some(working), Some(burst))) = of_hose.or(of_pipe)
            && burst < working
        {
            let [low, high] = ["working_pressure", "burst_pressure"].map(|key| format!("{path}{part}.{key}"));
            check.in_order([&low, &high], [working, burst]);
        }
        if let Some(pipe) = self.pipe() {
            pipe.check_outer_diameter(path, check);
        }
        if let Some(Stiffening { nominal, minimum, maximum }) = self.dynamic_stiffening {
            check.bounds(&format!("{path}.dynamic_stiffening"), [minimum, nominal, maximum]);
        }
    }

    /// Warns about keys of both lines that neither uses: one that a side does not use may belong to
    /// the other.
    fn check_unused(&self, path: &str, check: &mut dyn TableCheck) {
        let [length, stiffening] = ["length", "dynamic_stiffening"]
            .map(|key| path == "line" && check.declared(&format!("line.{key}")));
        if length && matches!(self.component, Component::Volume(_)) {
            check.warning("line.length", "`length` has no effect together with `volume`");
        }
        let sized =
            ["time_constant", "settling_time"].iter().any(|key| check.declared(&format!("sizing.{key}")));
        // [sizing] uses it for the hoses that it examines
        if stiffening && self.hose().is_none() && !sized {
            check.warning("line.dynamic_stiffening", "`dynamic_stiffening` has no effect without a hose");
        }
    }

    /// Checks a line at a supply of this pressure in Pa: expansion and strength are known up to a
    /// pressure.
    pub fn check_at_supply(&self, supply: f64, path: &str, check: &mut dyn TableCheck) {
        if let Some(stated) = self.expansion_stated_at().filter(|stated| supply > stated * (1.0 + 1e-9)) {
            let [stated, supply] = [stated, supply].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
            let message = format!(
                "the expansion of the hose is stated at {stated}, and the supply has {supply}: in between it is carried on along its slope"
            );
            let key = if self.hose_name().is_some() { "hose" } else { "volumetric_expansion_pressure" };
            check.warning(&format!("{path}.{key}"), message);
        }
        let working = self.hose().and_then(|hose| hose.working_pressure);
        if working.is_some_and(|working| working < supply) {
            let message = "the hose's `working_pressure` is below the supply pressure";
            let key = if self.hose_name().is_some() { "hose" } else { "working_pressure" };
            check.warning(&format!("{path}.{key}"), message);
        }
        let working = self.pipe().and_then(|pipe| pipe.working_pressure);
        if working.is_some_and(|working| working < supply) {
            let key =
                if check.declared(&format!("{path}.pipe.model")) { "model" } else { "working_pressure" };
            let message = "the pipe's `working_pressure` is below the supply pressure";
            check.warning(&format!("{path}.pipe.{key}"), message);
        }
    }

    /// Checks the model of the line in motion.
    pub fn check_motion(&self, path: &str, check: &mut dyn TableCheck) {
        if let LineMotion::Segments(segments) = self.motion
            && segments.count() > segments.most()
        {
            let message = format!(
                "{} segments have too many states for a simulation: with this friction and wall there may be {}",
                segments.count(),
                segments.most()
            );
            check.error_with_help(
                &format!("{path}.segments"),
                message,
                "\"steady\" `friction` leaves room for more, but damps the waves too little",
            );
        }
        self.check_model_fits(path, check);
        let stiffening = self.dynamic_stiffening.map_or(1.0, |stiffening| stiffening.nominal);
        // creep of a wall that is as stiff at rest as in motion
        if self.motion.relaxation_time().is_some() && self.hose().is_some() && stiffening == 1.0 {
            let message = "`relaxation_time` has no effect: with a `dynamic_stiffening` of 1 nothing creeps";
            check.warning(&format!("{path}.relaxation_time"), message);
        }
    }

    /// Rejects models that do not fit: a volume has no dynamics, and the wall of a pipe neither
    /// creeps nor moves along its axis.
    fn check_model_fits(&self, path: &str, check: &mut dyn TableCheck) {
        let motion = &self.motion;
        let (at, model) = (format!("{path}.model"), motion.model());
        match (&self.component, motion) {
            (_, LineMotion::Automatic | LineMotion::Lumped) => {}
            (Component::Volume(_), _) => {
                let message =
                    format!("model \"{model}\" needs a hose or a pipe: a volume has neither length nor bore");
                let help = "give `hose` or `pipe` with its `length`, or model \"lumped\"";
                check.error_with_help(&at, message, help);
            }
            (Component::Pipe { .. }, LineMotion::Creeping { .. } | LineMotion::TwoWave { .. }) => {
                let message =
                    format!("model \"{model}\" is for hoses: the wall of a pipe neither creeps nor moves");
                let help = "a pipe takes model \"lumped\", \"segments\" or \"transmission_line\"";
                check.error_with_help(&at, message, help);
            }
            (Component::Pipe { .. }, _) if motion.relaxation_time().is_some() => {
                let message = "`relaxation_time` is for hoses: the wall of a pipe does not creep";
                let help = "remove it, or choose a hose";
                check.error_with_help(&format!("{path}.relaxation_time"), message, help);
            }
            _ => {}
        }
    }
}

/// Tolerance of the outer diameter relative to bore and walls: data sheets round.
const OUTER_ROUNDED: f64 = 0.02;

impl DeclaredPipe {
    /// Checks that the outer diameter of a pipe is its bore plus both walls.
    fn check_outer_diameter(&self, path: &str, check: &mut dyn TableCheck) {
        let (Some(outer), Some(wall)) = (self.outer_diameter, &self.wall) else { return };
        let made = self.bore + 2.0 * wall.thickness;
        if (made - outer).abs() > OUTER_ROUNDED * outer {
            let [outer, made] = [outer, made].map(|size| quantity::display(size, &LENGTH, 4));
            let message = format!("`outer_diameter` is {outer}, and bore and walls make {made}");
            check.warning(&format!("{path}.pipe.outer_diameter"), message);
        }
    }
}
