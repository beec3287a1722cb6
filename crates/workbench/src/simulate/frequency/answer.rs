//! The JSON object and the tables of a frequency response.

use std::io;

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_hydraulics::signal::Signal;

use super::{MachineResponse, MachineResponses, ResponsePoint};
use crate::answer::{NumberTable, Object, OutputFile, TableFormat};
use crate::quantity::{FORCE, MotionKind, QuantityName};
use crate::simulate::RunStatus;
use crate::simulate::reasons::no_closed_loop_words;

const COMMAND_AMPLITUDE: QuantityName = QuantityName::Fixed("amplitude_v");
const REFERENCE_AMPLITUDE: QuantityName = QuantityName::moving("amplitude", &FORCE);
const NO_WINDOW: &str = "the simulation ended before a window did";
const NO_SYSTEM: &str =
    "a sampled loop around a machine with states and waves is not a linear system of finite order here";

/// The part of the JSON object.
pub(crate) fn body(found: &MachineResponses) -> Object {
    let points = |response: &MachineResponse, amplitude: QuantityName| {
        Object::new().each("points", &response.points, |point| row(point, amplitude))
    };
    let closed_loop = found.closed_loop.as_ref().map(|closed| points(closed, REFERENCE_AMPLITUDE));
    Object::new()
        .with(Signal::Position.quantity(), found.position_m)
        .with(Signal::Force.quantity(), found.force_n)
        .with("command_v", found.command_v)
        .with("stopped", found.stopped)
        .with("open_loop", points(&found.open_loop, COMMAND_AMPLITUDE))
        .told("closed_loop", closed_loop.map_err(|why| no_closed_loop_words(*why, found.units.motion)))
}

/// `reason` is that of the five numbers above it, where one is missing.
fn row(point: &ResponsePoint, amplitude: QuantityName) -> Object {
    let finite = |value: f64| value.is_finite().then_some(value);
    let pair = |value: Complex64| value.is_finite().then_some(value);
    let [difference_db, difference_deg] = point.differs(point.linear_plant).map(finite);
    let linearised = point.linearised_machine.map(|model| point.differs(model).map(finite));
    let [linearised_difference_db, linearised_difference_deg] = linearised.unwrap_or([None; 2]);
    let machine = pair(point.machine).ok_or(NO_WINDOW);
    let no_system = point.linearised_machine.is_none().then_some(NO_SYSTEM);
    Object::new()
        .with("frequency_rad_per_s", point.frequency_rad_per_s)
        .with(amplitude, point.amplitude)
        .told("machine", machine)
        .with("linear_plant", point.linear_plant)
        .with("linearised_machine", point.linearised_machine.and_then(pair))
        .with("linearised_machine_reason", no_system)
        .with("difference_db", difference_db)
        .with("difference_deg", difference_deg)
        .with("linearised_difference_db", linearised_difference_db)
        .with("linearised_difference_deg", linearised_difference_deg)
        .with("distortion_percent", finite(100.0 * point.distortion))
        .with("reason", machine.err().or(no_system))
        .with("settled", point.settled)
        .told("change_percent", finite(100.0 * point.change).ok_or("fewer than two windows were seen"))
        .with("periods", point.periods)
        .with("steps", point.steps)
        .with("reached", point.reached.as_slice())
        .told("ended", point.ended.map(RunStatus::key).ok_or("it did not end early"))
}

/// A table for each loop.
///
/// # Errors
/// Those of the table.
pub(crate) fn files(
    found: &MachineResponses,
    format: TableFormat,
    motion: MotionKind,
) -> io::Result<Vec<OutputFile>> {
    let mut files = vec![file("open_loop", COMMAND_AMPLITUDE, &found.open_loop, (format, motion))?];
    if let Ok(closed) = &found.closed_loop {
        files.push(file("closed_loop", REFERENCE_AMPLITUDE, closed, (format, motion))?);
    }
    Ok(files)
}

fn file(
    name: &str,
    amplitude: QuantityName,
    response: &MachineResponse,
    (format, motion): (TableFormat, MotionKind),
) -> io::Result<OutputFile> {
    let amplitude = amplitude.text(motion);
    let heads = [
        "frequency_rad_per_s",
        &amplitude,
        "magnitude_db",
        "phase_deg",
        "linear_plant_magnitude_db",
        "linear_plant_phase_deg",
        "linearised_machine_magnitude_db",
        "linearised_machine_phase_deg",
        "difference_db",
        "difference_deg",
        "distortion_percent",
        "change_percent",
        "periods",
        "settled",
    ];
    let polar = |value: Complex64| {
        [20.0 * portable::log10(portable::magnitude(value)), portable::argument(value).to_degrees()]
    };
    let mut table = NumberTable::new(Vec::new(), format, &heads)?;
    for point in &response.points {
        let linearised = point.linearised_machine.map_or([f64::NAN; 2], polar);
        let pairs =
            [polar(point.machine), polar(point.linear_plant), linearised, point.differs(point.linear_plant)];
        let mut row = vec![point.frequency_rad_per_s, point.amplitude];
        row.extend(pairs.into_iter().flatten());
        row.extend([100.0 * point.distortion, 100.0 * point.change, point.periods as f64]);
        row.push(f64::from(u8::from(point.settled)));
        table.row(&row)?;
    }
    Ok(OutputFile::new(format!("frequency_response_{name}.{}", format.ending()), table.finish()?))
}
