//! The JSON object and the tables of a frequency response.

use std::io;

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_hydraulics::signal::Signal;

use super::{MachineResponse, MachineResponses, ResponsePoint};
use crate::answer::{Answer, NumberTable, OutputFile, Reasoned, TableFormat};
use crate::quantity::{FORCE, MotionKind, QuantityName};
use crate::simulate::RunStatus;
use crate::simulate::occurrence_kind::OccurrenceKind;
use crate::simulate::reasons::no_closed_loop_words;

const COMMAND_AMPLITUDE: QuantityName = QuantityName::Fixed("amplitude_v");
const REFERENCE_AMPLITUDE: QuantityName = QuantityName::moving("amplitude", &FORCE);
const NO_WINDOW: &str = "the simulation ended before a window did";
const NO_SYSTEM: &str =
    "a sampled loop around a machine with states and waves is not a linear system of finite order here";

/// Responses of a machine to sines at its equilibrium, compared with the linear plant.
#[derive(Answer)]
pub(crate) struct MachineResponsesAnswer {
    /// Position of the piston at equilibrium, from the A end.
    #[answer(key = Signal::Position.quantity())]
    position: f64,
    /// Force on the load at equilibrium.
    #[answer(key = Signal::Force.quantity())]
    force: f64,
    /// Command at equilibrium.
    command_v: f64,
    /// True if the command was stopped before all frequencies were simulated.
    stopped: bool,
    /// Response from command to force, in N/V, of a motor in N m/V.
    open_loop: MachineResponseAnswer,
    /// Response from reference to force, which is a ratio.
    closed_loop: Reasoned<MachineResponseAnswer>,
}

/// Response of a machine at its frequencies.
#[derive(Answer)]
struct MachineResponseAnswer {
    /// Points by rising frequency.
    points: Vec<MachineResponsePointAnswer>,
}

/// Response of a machine at one frequency, with those of two models.
#[derive(Answer)]
struct MachineResponsePointAnswer {
    /// Frequency of the sine.
    frequency_rad_per_s: f64,
    #[answer(flatten)]
    amplitude: ShakenAmplitude,
    /// Fundamental of the force over the amplitude.
    machine: Reasoned<Complex64>,
    /// Response of the linear plant, or of the loop around it.
    linear_plant: Complex64,
    /// Response of the exact derivatives of the machine at its equilibrium; null if they form no
    /// linear system of finite order.
    linearised_machine: Option<Complex64>,
    /// Reason for which there is no linearised machine; null if there is one.
    linearised_machine_reason: Option<&'static str>,
    /// Magnitude of the machine over that of the linear plant; null with a `reason`.
    difference_db: Option<f64>,
    /// Phase of the machine less that of the linear plant, within half a turn; null with a
    /// `reason`.
    difference_deg: Option<f64>,
    /// Magnitude of the machine over that of the linearised machine; null with a `reason`.
    linearised_difference_db: Option<f64>,
    /// Phase of the machine less that of the linearised machine, within half a turn; null with a
    /// `reason`.
    linearised_difference_deg: Option<f64>,
    /// Root of the sum of squares of the harmonics from the second to the twentieth, of the
    /// fundamental; null with a `reason`.
    distortion_percent: Option<f64>,
    /// Reason for which a difference or the distortion is absent; null if none is.
    reason: Option<&'static str>,
    /// True if the fundamental changed by a ten-thousandth or less between the last two windows.
    settled: bool,
    /// Change of the fundamental between the last two windows.
    change_percent: Reasoned<f64>,
    /// Number of simulated periods.
    periods: u64,
    /// Number of steps of the integration.
    steps: u64,
    /// Conditions that the machine meets, which are outside the neighbourhood of the equilibrium.
    reached: Vec<OccurrenceKind>,
    /// Status of a simulation that ended before the response settled.
    early_end: Reasoned<RunStatus>,
}

/// Amplitude of a sine, of the command in the open loop and of the reference in the closed one.
#[derive(Answer)]
enum ShakenAmplitude {
    Command {
        /// Amplitude of the sine of the command, in the open loop.
        #[answer(key = COMMAND_AMPLITUDE)]
        amplitude: f64,
    },
    Reference {
        /// Amplitude of the sine of the reference, in the closed loop.
        #[answer(key = REFERENCE_AMPLITUDE)]
        amplitude: f64,
    },
}

/// The part of the JSON object.
pub(crate) fn body(found: &MachineResponses) -> MachineResponsesAnswer {
    let closed_loop = found
        .closed_loop
        .as_ref()
        .map(|closed| response(closed, |point| ShakenAmplitude::Reference { amplitude: point.amplitude }));
    MachineResponsesAnswer {
        position: found.position_m,
        force: found.force_n,
        command_v: found.command_v,
        stopped: found.stopped,
        open_loop: response(&found.open_loop, |point| ShakenAmplitude::Command {
            amplitude: point.amplitude,
        }),
        closed_loop: Reasoned::of(closed_loop.map_err(|why| no_closed_loop_words(*why, found.units.motion))),
    }
}

fn response(
    response: &MachineResponse,
    amplitude: fn(&ResponsePoint) -> ShakenAmplitude,
) -> MachineResponseAnswer {
    let points = response.points.iter();
    MachineResponseAnswer { points: points.map(|one| point(one, amplitude(one))).collect() }
}

/// `reason` is that of the five numbers above it, where one is missing.
fn point(point: &ResponsePoint, amplitude: ShakenAmplitude) -> MachineResponsePointAnswer {
    let finite = |value: f64| value.is_finite().then_some(value);
    let pair = |value: Complex64| value.is_finite().then_some(value);
    let [difference_db, difference_deg] = point.differs(point.linear_plant).map(finite);
    let linearised = point.linearised_machine.map(|model| point.differs(model).map(finite));
    let [linearised_difference_db, linearised_difference_deg] = linearised.unwrap_or([None; 2]);
    let machine = pair(point.machine);
    let no_system = point.linearised_machine.is_none().then_some(NO_SYSTEM);
    MachineResponsePointAnswer {
        frequency_rad_per_s: point.frequency_rad_per_s,
        amplitude,
        machine: Reasoned::new(machine, NO_WINDOW),
        linear_plant: point.linear_plant,
        linearised_machine: point.linearised_machine.and_then(pair),
        linearised_machine_reason: no_system,
        difference_db,
        difference_deg,
        linearised_difference_db,
        linearised_difference_deg,
        distortion_percent: finite(100.0 * point.distortion),
        reason: machine.is_none().then_some(NO_WINDOW).or(no_system),
        settled: point.settled,
        change_percent: Reasoned::new(finite(100.0 * point.change), "fewer than two windows were seen"),
        periods: point.periods,
        steps: point.steps,
        reached: point.reached.iter().map(|kind| OccurrenceKind(kind)).collect(),
        early_end: Reasoned::new(point.early_end, "it did not end early"),
    }
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
