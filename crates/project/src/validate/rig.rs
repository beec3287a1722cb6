//! Parts of the actuator: each checks its own keys, with the sizes next to it.

use super::Check;
use crate::text::RawFinding;
use crate::{DeclaredActuator, LineMotion};
use phea_hydraulics::servovalve::Supply;

/// Checks every part by itself.
pub(super) fn parts(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    actuator.supply.check(check);
    actuator.valve.check(&actuator.supply, check);
    match &actuator.motor {
        Some(motor) => motor.check(check),
        None => actuator.cylinder.check(check),
    }
    if let Some(law) = actuator.friction() {
        law.check(&format!("{}.friction", actuator.moving_part()), check);
    }
    lines(actuator, check);
    if let Some(port) = &actuator.cross_port {
        port.check(actuator.fluid.density, narrowest_port(actuator), check);
    }
    if let Some(valves) = &actuator.port_valves {
        valves.check(check);
    }
    if actuator.motor.is_some() {
        return;
    }
    if let Some(series) = &actuator.series {
        series.check(stall_forces(actuator), check);
    }
    if let Some(linkage) = &actuator.linkage {
        linkage.check(actuator.cylinder.stroke, check);
    }
}

/// Greatest push and greatest pull that the supply gives the piston, N.
pub(super) fn stall_forces(actuator: &DeclaredActuator) -> [f64; 2] {
    let [retracting, extending] = actuator.cylinder.component().stall_forces(&Supply::of(&actuator.supply));
    [extending, -retracting]
}

/// Diameter in m and name of the narrower line, or of the piston if the lines are plain volumes;
/// `None` if unknown, as those of a motor.
fn narrowest_port(actuator: &DeclaredActuator) -> Option<(f64, &'static str)> {
    let bores = [&actuator.line.a, &actuator.line.b].into_iter().filter_map(|line| line.bore());
    match bores.reduce(f64::min) {
        Some(bore) => Some((bore, "the bore of the line")),
        None if actuator.motor.is_some() => None,
        None => Some((actuator.cylinder.piston_diameter_m(), "the piston")),
    }
}

fn lines(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    nobody_inherits(check);
    let supply = actuator.supply.pressure;
    for (name, line) in [("a", &actuator.line.a), ("b", &actuator.line.b)] {
        let own = |check: &Check<'_, '_>, rest: &str| {
            let own = format!("line.{name}{rest}");
            if check.declared(&own) { own } else { format!("line{rest}") }
        };
        let path = own(check, "");
        line.check(&path, check);
        line.check_motion(&path, check);
        line.check_at_supply(supply, &path, check);
        if let Some(gas) = &line.accumulator {
            let path = own(check, ".accumulator");
            gas.check_at_chamber(supply, &path, check);
            if let Some(bore) = line.bore() {
                gas.check_passage(actuator.fluid.density, bore, &path, check);
            }
        }
    }
}

/// Warns about keys of [line] for a model, which have no effect if both sides choose their own.
fn nobody_inherits(check: &mut Check<'_, '_>) {
    let Some(line) = check.reader.root_entry("line") else { return };
    let chooses = |side: &str| line.node.get(side).is_some_and(|side| side.node.get("model").is_some());
    if !(chooses("a") && chooses("b")) {
        return;
    }
    for name in LineMotion::KEYS {
        if let Some(entry) = line.node.get(name) {
            let message = format!("`{name}` has no effect: [line.a] and [line.b] choose a model each");
            let found = RawFinding::error(entry.key_place, message);
            check.reader.findings.push(found.help("write it next to the `model` that it belongs to"));
        }
    }
}
