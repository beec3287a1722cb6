//! Frequency response of the nonlinear model, measured with sines as on a test bench, and compared
//! with the linear plant.

mod closed_loop;
mod open_loop;
mod point;

pub use point::ResponsePoint;

pub use closed_loop::NoClosedLoop;

use num_complex::Complex64;
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::simulation::SimulationSettings;
use phea_hydraulics::machine::{InitialCondition, Machine, MachineOptions};

use super::SimulateError;
use super::bench::{machine_of, settings};
use crate::quantity::Units;
use crate::rig::{OfMotion, Rig};
use crate::setup::Setup;
use phea_dynamics::watch::{Progress, Watch};

/// Default amplitude of a sine, as a fraction of the nominal voltage and of the force that the
/// supply can produce.
const USUAL_AMPLITUDE: f64 = 0.01;
/// Default number of frequencies, the first, and the ratio of the last to the natural frequency of
/// the valve.
const POINTS: usize = 28;
const FIRST_RAD_PER_S: f64 = 0.1;
const LAST_OVER_VALVE: f64 = 3.0;

/// Request for a frequency response; values that are not stated are chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrequencyRequest {
    /// Frequencies, rad/s; empty: 28 from 0.1 rad/s to three times the natural frequency of the
    /// valve.
    pub frequencies_rad_per_s: Vec<f64>,
    /// Amplitude of the command of the open loop, V; absent: at each frequency a hundredth of the
    /// nominal voltage or, if it is less, the voltage that causes a hundredth of the force that the
    /// supply can produce.
    pub command_amplitude_v: Option<f64>,
    /// Amplitude of the reference of the closed loop, N; absent: a hundredth of the force that the
    /// supply can produce.
    pub reference_amplitude_n: Option<f64>,
}

/// Responses of a machine at its operating point.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineResponses {
    /// Motion of the rig.
    pub units: Units,
    /// Equilibrium position of the piston, m.
    pub position_m: f64,
    /// Force on the load, N.
    pub force_n: f64,
    /// Command, V.
    pub command_v: f64,
    /// Response from command to force, N/V.
    pub open_loop: MachineResponse,
    /// Response from reference to force; or the reason why it is absent.
    pub closed_loop: Result<MachineResponse, NoClosedLoop>,
    /// True if `watch` cancelled the measurement.
    pub stopped: bool,
}

/// A response at its frequencies, and its models at finer ones for figures.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineResponse {
    /// Points by rising frequency.
    pub points: Vec<ResponsePoint>,
    /// Frequencies of the models' curves, rad/s.
    pub curve_rad_per_s: Vec<f64>,
    /// Response of the linear plant, or of the loop that it closes, at these frequencies.
    pub linear_plant: Vec<Complex64>,
    /// Response of the machine's exact derivatives at its equilibrium, at these frequencies; empty
    /// if they do not form a linear system.
    pub linearised_machine: Vec<Complex64>,
}

/// A machine in equilibrium, ready to be excited.
struct RestedMachine {
    rig: Rig,
    machine: Machine,
    rest: InitialCondition,
    /// Force on the load, N.
    force_n: f64,
    /// Force that the supply can produce, N.
    push_n: f64,
    settings: SimulationSettings,
}

impl RestedMachine {
    /// Force on the load for amplitudes of the states about the equilibrium, N.
    fn force_amplitude(&self, amplitudes: &[Complex64]) -> Complex64 {
        phea_machine::force_amplitude(&self.machine, &self.rest.state, amplitudes)
    }
}

impl MachineResponses {
    /// True if every point settled.
    pub fn is_settled(&self) -> bool {
        let closed = self.closed_loop.iter().flat_map(|response| &response.points);
        !self.stopped && self.open_loop.points.iter().chain(closed).all(|point| point.settled)
    }
}

/// Measures the machine of a project around its operating point: open from command to force, and
/// closed from reference to force if the project gives a controller. Scenarios are not simulated.
///
/// # Errors
/// [`SimulateError`] if the project describes no machine, or one without an equilibrium at the
/// operating point.
pub fn frequency_response(
    setup: &Setup<'_>,
    request: &FrequencyRequest,
    watch: Watch<'_>,
) -> Result<MachineResponses, SimulateError> {
    let rested = rested(setup)?;
    let frequencies = frequencies(request, &rested);
    let count = 2.0 * frequencies.len() as f64;
    let mut watched =
        |done: usize| watch(Progress { stage: "frequency response", fraction: done as f64 / count });
    let mut stopped = false;
    let open_loop = open_loop::measured(&rested, &frequencies, request, &mut |index| {
        stopped |= !watched(index);
        !stopped
    })?;
    let closed_loop = if stopped {
        Err(NoClosedLoop::Stopped)
    } else {
        let before = frequencies.len();
        closed_loop::measured(setup, &rested, &frequencies, request, &mut |index| {
            stopped |= !watched(before + index);
            !stopped
        })?
    };
    let position_m = rested.rig.point.position;
    let (force_n, command_v) = (rested.force_n, rested.rest.command);
    let units = setup.project.units;
    Ok(MachineResponses { units, position_m, force_n, command_v, open_loop, closed_loop, stopped })
}

fn rested(setup: &Setup<'_>) -> Result<RestedMachine, SimulateError> {
    let (project, rig) = (setup.project, setup.rig()?.clone());
    let impossible = |error| SimulateError::Machine(OfMotion { motion: rig.motion, error });
    let machine = machine_of(project, &rig.actuator, &MachineOptions::default())?;
    let rest = machine.rest(&rig.point).map_err(impossible)?;
    let force_n = phea_machine::force(&machine, &rest.state);
    let components = rig.actuator.components();
    let [area_a, area_b] = components.cylinder.areas_at(rig.point.position);
    let area = 0.5 * (area_a + area_b);
    let push_n = area * (components.supply.pressure - components.supply.tank_pressure);
    Ok(RestedMachine { machine, rest, force_n, push_n, settings: settings(project), rig })
}

/// Requested frequencies in rising order, or the default ones.
fn frequencies(request: &FrequencyRequest, rested: &RestedMachine) -> Vec<f64> {
    let mut requested = request.frequencies_rad_per_s.clone();
    if requested.is_empty() {
        let last = LAST_OVER_VALVE * rested.rig.actuator.components().valve.natural_frequency;
        requested = spread([FIRST_RAD_PER_S, last], POINTS);
    }
    sorted_distinct(requested)
}

/// Frequencies at equal ratios, including the ends.
fn spread([first, last]: [f64; 2], count: usize) -> Vec<f64> {
    let part = |index: usize| index as f64 / (count - 1) as f64;
    let between = |index| first * phea_dynamics::portable::pow(last / first, part(index));
    (0..count).map(|index| if index + 1 == count { last } else { between(index) }).collect()
}

/// Frequencies of a curve through these.
fn curve(frequencies: &[f64]) -> Vec<f64> {
    match (frequencies.first(), frequencies.last()) {
        (Some(first), Some(last)) if first < last => spread([*first, *last], 241),
        _ => frequencies.to_vec(),
    }
}
