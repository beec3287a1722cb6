//! A frequency response for people.

use phea_dynamics::portable;

use super::{MachineResponse, MachineResponses, ResponsePoint};
use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::quantity::{DisplayUnit, MotionKind, VOLTAGE, display};
use crate::simulate::reasons::no_closed_loop_words;

/// Tables and sentences of a frequency response.
pub(crate) fn document(found: &MachineResponses) -> Document {
    let units = found.units;
    let [position, force] = [(units.position, found.position_m), (units.force, found.force_n)]
        .map(|(unit, value)| unit.short(value, 4));
    let command = display(found.command_v, &VOLTAGE, 4);
    let mut out = Document::default();
    out.line(format!("Around rest at {position}, {force} on the load, a command of {command}."));
    let mut section = |title: &str, found: &MachineResponse, unit: DisplayUnit| {
        out.heading(title);
        out.table(response(found, unit));
        out.sentences(found.points.iter().filter_map(|point| remark(point, units.motion)));
    };
    let motion = units.motion;
    let open = motion.either(
        "Open loop, from command to force, dB re 1 N/V",
        "Open loop, from command to torque, dB re 1 N.m/V",
    );
    section(open, &found.open_loop, DisplayUnit::VOLT);
    match &found.closed_loop {
        Ok(closed) => section(
            motion.either("Closed loop, from reference to force", "Closed loop, from reference to torque"),
            closed,
            units.force,
        ),
        Err(reason) => out.heading(format!("No closed loop: {}.", no_closed_loop_words(*reason, motion))),
    }
    if found.stopped {
        out.line("Stopped before its end.");
    }
    out
}

fn response(response: &MachineResponse, unit: DisplayUnit) -> Table {
    let with_machine = response.points.iter().any(|point| point.linearised_machine.is_some());
    let amplitude = format!("amplitude, {}", unit.symbol);
    let mut heads = vec!["rad/s", &amplitude, "machine, dB", "phase, deg", "minus linear plant, dB", "deg"];
    if with_machine {
        heads.extend(["minus linearised machine, dB", "deg"]);
    }
    heads.extend(["distortion, %", "periods"]);
    let mut last: Option<f64> = None;
    let row = |point: &ResponsePoint| {
        let [decibels, degrees] = own(point);
        // removes jumps by a full turn from row to row
        let degrees = degrees - 360.0 * last.map_or(0.0, |last| ((degrees - last) / 360.0_f64).round());
        last = Some(degrees);
        let mut cells = vec![
            Cell::number(point.frequency_rad_per_s, 4),
            Cell::number(unit.of(point.amplitude), 3),
            Cell::decimal(decibels, 2),
            Cell::decimal(degrees, 1),
        ];
        let linearised = with_machine.then_some(point.linearised_machine);
        for model in std::iter::once(Some(point.linear_plant)).chain(linearised) {
            let [decibels, degrees] = model.map_or([f64::NAN; 2], |model| point.differs(model));
            cells.extend([Cell::decimal(decibels, 3), Cell::decimal(degrees, 2)]);
        }
        cells.extend([Cell::decimal(100.0 * point.distortion, 2), point.periods.to_string().into()]);
        cells
    };
    Table::new(heads).with(response.points.iter().map(row))
}

/// Magnitude in dB and phase in degrees of the machine, the phase near that of the linear plant.
pub(super) fn own(point: &ResponsePoint) -> [f64; 2] {
    let [_, degrees] = point.differs(point.linear_plant);
    let plant = portable::argument(point.linear_plant).to_degrees();
    // a phase lower by a whole turn is visible in the curves; here the principal value of the model
    // is used
    [20.0 * portable::log10(portable::magnitude(point.machine)), plant + degrees]
}

/// A remark on a point.
fn remark(point: &ResponsePoint, motion: MotionKind) -> Option<String> {
    let at = significant(point.frequency_rad_per_s, 4);
    if let Some(status) = point.early_end {
        let (force, word) = (motion.words().force, status.key());
        return Some(format!("{at} rad/s: the simulation ended before the {force} settled ({word})"));
    }
    if !point.settled {
        let percent = significant(100.0 * point.change, 2);
        return Some(format!("{at} rad/s: not settled, the last two windows differ by {percent} %"));
    }
    (!point.reached.is_empty())
        .then(|| format!("{at} rad/s: this is not a small motion, as it meets {}", point.reached.join(", ")))
}
