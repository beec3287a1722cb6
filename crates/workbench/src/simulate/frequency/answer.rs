//! The JSON object and the tables of a frequency response.

use std::io;

use num_complex::Complex64;
use phea_dynamics::portable;
use serde::Serialize;

use super::{MachineResponse, MachineResponses, ResponsePoint};
use crate::answer::{NumberTable, OutputFile, TableFormat};

#[derive(Serialize)]
pub(crate) struct FrequencyAnswer<'a> {
    position_m: f64,
    force_n: f64,
    command_v: f64,
    stopped: bool,
    open_loop: ResponseRow,
    closed_loop: Option<ResponseRow>,
    closed_loop_reason: Option<&'a str>,
}

#[derive(Serialize)]
struct ResponseRow {
    points: Vec<FrequencyPointAnswer>,
}

#[derive(Serialize)]
struct FrequencyPointAnswer {
    frequency_rad_per_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    amplitude_v: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    amplitude_n: Option<f64>,
    machine: Option<[f64; 2]>,
    machine_reason: Option<&'static str>,
    linear_plant: [f64; 2],
    linearised_machine: Option<[f64; 2]>,
    linearised_machine_reason: Option<&'static str>,
    difference_db: Option<f64>,
    difference_deg: Option<f64>,
    linearised_difference_db: Option<f64>,
    linearised_difference_deg: Option<f64>,
    distortion_percent: Option<f64>,
    /// Of the five above, where one is absent.
    reason: Option<&'static str>,
    settled: bool,
    change_percent: Option<f64>,
    change_percent_reason: Option<&'static str>,
    periods: u64,
    steps: u64,
    reached: Vec<&'static str>,
    ended: Option<&'static str>,
    ended_reason: Option<&'static str>,
}

const NO_WINDOW: &str = "the simulation ended before a window did";
const NO_SYSTEM: &str =
    "a sampled loop around a machine with states and waves is no linear system of finite order here";

/// The part of the JSON object.
pub(crate) fn body(found: &MachineResponses) -> FrequencyAnswer<'_> {
    FrequencyAnswer {
        position_m: found.position_m,
        force_n: found.force_n,
        command_v: found.command_v,
        stopped: found.stopped,
        open_loop: response(&found.open_loop, true),
        closed_loop: found.closed_loop.as_ref().ok().map(|closed| response(closed, false)),
        closed_loop_reason: found.closed_loop.as_ref().err().map(String::as_str),
    }
}

fn response(response: &MachineResponse, open: bool) -> ResponseRow {
    ResponseRow { points: response.points.iter().map(|point| row(point, open)).collect() }
}

fn row(point: &ResponsePoint, open: bool) -> FrequencyPointAnswer {
    let finite = |value: f64| value.is_finite().then_some(value);
    let pair = |value: Complex64| value.is_finite().then_some([value.re, value.im]);
    let [difference_db, difference_deg] = point.differs(point.linear_plant).map(finite);
    let linearised = point.linearised_machine.map(|model| point.differs(model).map(finite));
    let [linearised_difference_db, linearised_difference_deg] = linearised.unwrap_or([None; 2]);
    let machine = pair(point.machine);
    let reason = match (machine, point.linearised_machine) {
        (None, _) => Some(NO_WINDOW),
        (_, None) => Some(NO_SYSTEM),
        _ => None,
    };
    let change_percent = finite(100.0 * point.change);
    FrequencyPointAnswer {
        frequency_rad_per_s: point.frequency_rad_per_s,
        amplitude_v: open.then_some(point.amplitude),
        amplitude_n: (!open).then_some(point.amplitude),
        machine_reason: machine.is_none().then_some(NO_WINDOW),
        machine,
        linear_plant: [point.linear_plant.re, point.linear_plant.im],
        linearised_machine: point.linearised_machine.and_then(pair),
        linearised_machine_reason: point.linearised_machine.is_none().then_some(NO_SYSTEM),
        difference_db,
        difference_deg,
        linearised_difference_db,
        linearised_difference_deg,
        distortion_percent: finite(100.0 * point.distortion),
        reason,
        settled: point.settled,
        change_percent_reason: change_percent.is_none().then_some("fewer than two windows were seen"),
        change_percent,
        periods: point.periods,
        steps: point.steps,
        reached: point.reached.clone(),
        ended: point.ended,
        ended_reason: point.ended.is_none().then_some("it did not end early"),
    }
}

/// A table for each loop.
///
/// # Errors
/// Those of the table.
pub(crate) fn files(found: &MachineResponses, format: TableFormat) -> io::Result<Vec<OutputFile>> {
    let mut files = vec![file("open_loop", "amplitude_v", &found.open_loop, format)?];
    if let Ok(closed) = &found.closed_loop {
        files.push(file("closed_loop", "amplitude_n", closed, format)?);
    }
    Ok(files)
}

fn file(
    name: &str,
    amplitude: &str,
    response: &MachineResponse,
    format: TableFormat,
) -> io::Result<OutputFile> {
    let heads = [
        "frequency_rad_per_s",
        amplitude,
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
