//! Frequency response from command to force, in open loop.

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;
use phea_dynamics::simulation::{CommandedPlant, Input, Plant, Profile, Sensed};
use phea_machine::Control;

use super::point::{RestingRig, finer, point, respond};
use super::{FrequencyRequest, MachineResponse, RestedMachine, SimulateError, USUAL_AMPLITUDE, curve};

/// Measures the response at these frequencies; ends before the first for which `continues` is
/// false.
pub(super) fn measured(
    rested: &RestedMachine,
    frequencies: &[f64],
    request: &FrequencyRequest,
    continues: &mut dyn FnMut(usize) -> bool,
) -> Result<MachineResponse, SimulateError> {
    let through = TransferFunction::gain_only(1.0);
    let held = CommandedPlant::on_hold(Sensed::new(rested.machine, &through)?, &through)?;
    let control = Control::Open(Box::new(held));
    let mut points = Vec::new();
    for (index, frequency) in frequencies.iter().enumerate() {
        if !continues(index) {
            break;
        }
        let orbit = orbit(&control, rested, *frequency);
        let linearised = orbit.as_deref().map(|orbit| rested.force_amplitude(orbit));
        let plant = rested.rig.response(*frequency);
        let amplitude =
            request.command_amplitude_v.unwrap_or_else(|| usual(rested, linearised.unwrap_or(plant)));
        let sine = Profile::sine(0.0, amplitude, *frequency).map_err(profile)?.shifted(rested.rest.command);
        let ground = Profile::constant(rested.rest.inputs[0]);
        let typical: f64 = Plant::<f64>::command_scale(&rested.machine);
        let start = [rested.rest.state.as_slice(), &rested.rest.waves].concat();
        let resting = RestingRig {
            control: &control,
            start: &start,
            orbit: orbit.unwrap_or_default(),
            inputs: vec![
                Input::Value(sine),
                Input::Value(Profile::constant(0.0)),
                Input::Value(ground.clone()),
                Input::Rate(ground),
            ],
            settings: finer(rested.settings, amplitude / typical),
        };
        let found = respond(resting, None, [*frequency, amplitude], &mut || continues(index))?;
        points.push(point([*frequency, amplitude], &found, plant, linearised));
    }
    let curve_rad_per_s = curve(frequencies);
    let of_machine = |frequency: &f64| Some(rested.force_amplitude(&orbit(&control, rested, *frequency)?));
    Ok(MachineResponse {
        points,
        linear_plant: curve_rad_per_s.iter().map(|frequency| rested.rig.response(*frequency)).collect(),
        linearised_machine: curve_rad_per_s.iter().map(of_machine).collect::<Option<_>>().unwrap_or_default(),
        curve_rad_per_s,
    })
}

/// States on the orbit of a command of one volt.
fn orbit(control: &Control, rested: &RestedMachine, frequency: f64) -> Option<Vec<Complex64>> {
    let inputs = [&[rested.rest.command, 0.0], rested.rest.all_inputs().as_slice()].concat();
    control.orbit(&rested.rest.state, &inputs, frequency)
}

fn usual(rested: &RestedMachine, response: Complex64) -> f64 {
    let voltage = rested.rig.actuator.components().valve.nominal_voltage;
    USUAL_AMPLITUDE * voltage.min(rested.push_n / portable::magnitude(response))
}

pub(super) fn profile(error: phea_dynamics::simulation::ProfileError) -> SimulateError {
    SimulateError::Profile { name: "frequency response".to_string(), error }
}
