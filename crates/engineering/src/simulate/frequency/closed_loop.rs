//! Frequency response from reference to force, under the deployed controller.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::controller::{Controller, ControllerInput, Timing};
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;
use phea_dynamics::simulation::{CommandedPlant, Input, Plant, Profile, Sensed, SimulationSettings};
use phea_hydraulics::machine::Machine;
use phea_machine::{Control, ControllerSamples, Deployed, Digital, Sampled, Waking};
use phea_qft::closed_loop::{Compensation, Member};

use super::open_loop::profile;
use super::point::{ResponsePoint, RestingRig, finer, point, respond};
use super::{FrequencyRequest, MachineResponse, RestedMachine, USUAL_AMPLITUDE, curve};
use crate::rig::Rig;
use crate::setup::Setup;
use crate::simulate::SimulateError;
use crate::simulate::bench::ControlledMachine;

/// Least number of samples per period: a command that changes its sign at every sample can only be
/// a square wave.
const FEWEST_SAMPLES: f64 = 4.0;
/// Scale for errors of the force, as a fraction of the force that the supply can produce.
const TYPICAL_PUSH: f64 = 0.1;

/// Reason why a machine has no closed loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoClosedLoop {
    /// The measurement was cancelled before.
    Stopped,
    /// The project gives no controller.
    NoController,
    /// No reference holds the force of the operating point.
    NoReference,
    /// The loop is open.
    Open,
}

/// Measures the response at these frequencies; ends before the first for which `continues` is
/// false. The reason if there is no loop.
pub(super) fn measured(
    setup: &Setup<'_>,
    rested: &RestedMachine,
    frequencies: &[f64],
    request: &FrequencyRequest,
    continues: &mut dyn FnMut(usize) -> bool,
) -> Result<Result<MachineResponse, NoClosedLoop>, SimulateError> {
    let Some(given) = &setup.controller else {
        return Ok(Err(NoClosedLoop::NoController));
    };
    let bench = ControlledMachine::new(setup)?;
    let amplitude = request.reference_amplitude_n.unwrap_or(USUAL_AMPLITUDE * rested.push_n);
    let model = LinearizedLoop::new(setup, rested, given)?;
    let measured_n = setup.sensor.dc_gain() * rested.force_n;
    let reference_n = held_reference(rested, given, measured_n)?;
    if !reference_n.is_finite() {
        return Ok(Err(NoClosedLoop::NoReference));
    }
    let shared = LoopParts { rested, model: &model, reference_n, measured_n, amplitude };
    match &bench.control {
        Control::Continuous(closed) => {
            shared.continuous(&bench.control, closed, frequencies, continues).map(Ok)
        }
        Control::Sampled(sampled) => shared.sampled(sampled, frequencies, continues).map(Ok),
        Control::Open(_) => Ok(Err(NoClosedLoop::Open)),
    }
}

/// Reference at which the controller maintains the command of the equilibrium under this
/// measurement of its force.
///
/// ```text
/// r_0 = (m_0 + U_0/G(0))/F(0),    m_0 = H(0) F_0
/// ```
fn held_reference(rested: &RestedMachine, given: &Controller, measured_n: f64) -> Result<f64, SimulateError> {
    let gain = given.feedback.transfer_function()?.dc_gain();
    let error = if rested.rest.command == 0.0 { 0.0 } else { rested.rest.command / gain };
    Ok((measured_n + error) / given.prefilter.transfer_function()?.dc_gain())
}

/// Data that both kinds of loop need.
struct LoopParts<'a> {
    rested: &'a RestedMachine,
    model: &'a LinearizedLoop,
    reference_n: f64,
    /// Measurement of the controller at rest, N.
    measured_n: f64,
    amplitude: f64,
}

impl LoopParts<'_> {
    fn settings(&self) -> SimulationSettings {
        finer(self.rested.settings, self.amplitude / (TYPICAL_PUSH * self.rested.push_n))
    }

    fn reference(&self, frequency: f64) -> Result<Input, SimulateError> {
        let sine = Profile::sine(0.0, self.amplitude, frequency).map_err(profile)?;
        Ok(Input::Value(sine.shifted(self.reference_n)))
    }

    fn ground(&self) -> [Input; 2] {
        let ground = Profile::constant(self.rested.rest.inputs[0]);
        [Input::Value(ground.clone()), Input::Rate(ground)]
    }

    fn response(
        &self,
        points: Vec<ResponsePoint>,
        frequencies: &[f64],
        machine: Vec<Complex64>,
    ) -> Result<MachineResponse, SimulateError> {
        let curve_rad_per_s = curve(frequencies);
        let linear_plant = curve_rad_per_s.iter().map(|frequency| self.model.at(*frequency));
        Ok(MachineResponse {
            points,
            linear_plant: linear_plant.collect::<Result<_, _>>()?,
            linearised_machine: machine,
            curve_rad_per_s,
        })
    }

    /// Signals of the controller at rest: the force, N, and the pressures that it feeds back, Pa.
    fn measured(&self) -> [f64; 2] {
        let rest = &self.rested.rest;
        let inner = Plant::<f64>::inner_measurement(&self.rested.machine, &rest.state, &rest.all_inputs());
        [self.measured_n, inner]
    }

    fn continuous(
        &self,
        control: &Control,
        closed: &CommandedPlant<Sensed<Machine>>,
        frequencies: &[f64],
        continues: &mut dyn FnMut(usize) -> bool,
    ) -> Result<MachineResponse, SimulateError> {
        let rest = &self.rested.rest;
        let mut state = rest.state.clone();
        state.extend(closed.plant().sensor_at_rest(self.rested.force_n));
        state.extend(closed.controller_at_rest(self.reference_n, self.measured(), rest.command));
        control.rest_at(&mut state, rest.inputs[0]);
        let waves = control.under_way(&state, &[self.reference_n], rest);
        let inputs = [&[self.reference_n], &rest.inputs[..], &waves].concat();
        let orbit = |frequency: f64| control.orbit(&state, &inputs, frequency);
        let force = |orbit: &Vec<Complex64>| self.rested.force_amplitude(orbit);
        let start = [state.as_slice(), &waves].concat();
        let mut points = Vec::new();
        for (index, frequency) in frequencies.iter().enumerate() {
            if !continues(index) {
                break;
            }
            let orbit = orbit(*frequency);
            let linearised = orbit.as_ref().map(force);
            let resting = RestingRig {
                control,
                start: &start,
                orbit: orbit.unwrap_or_default(),
                inputs: [self.reference(*frequency)?].into_iter().chain(self.ground()).collect(),
                settings: self.settings(),
            };
            let sine = [*frequency, self.amplitude];
            let found = respond(resting, None, sine, &mut || continues(index))?;
            points.push(point(sine, &found, self.model.at(*frequency)?, linearised));
        }
        let machine = curve(frequencies).into_iter().map(|frequency| Some(force(&orbit(frequency)?)));
        let machine = machine.collect::<Option<Vec<_>>>().unwrap_or_default();
        self.response(points, frequencies, machine)
    }

    /// Response of a sampled controller at the nearest frequencies whose period is a whole number
    /// of samples, without the noise of the sensors and the rounding of the velocity.
    fn sampled(
        &self,
        sampled: &Sampled,
        frequencies: &[f64],
        continues: &mut dyn FnMut(usize) -> bool,
    ) -> Result<MachineResponse, SimulateError> {
        let quiet = Sampled {
            noise: 0.0,
            velocity_noise: 0.0,
            pressure_noise: 0.0,
            deployed: Deployed { velocity_resolution: 0.0, ..sampled.deployed.clone() },
            ..sampled.clone()
        };
        let (held, rest) = (&quiet.held, &self.rested.rest);
        let mut state = rest.state.clone();
        state.extend(held.plant().sensor_at_rest(self.rested.force_n));
        state.extend(held.controller_at_rest(self.reference_n, self.measured(), rest.command));
        let control = Control::Sampled(Box::new(quiet.clone()));
        control.rest_at(&mut state, rest.inputs[0]);
        let waves = control.under_way(&state, &[rest.command, self.reference_n], rest);
        let start = [state.as_slice(), &waves].concat();
        let filtered = held.sampled::<f64, f64>(
            &state,
            &[&[rest.command, self.reference_n], &rest.inputs[..], &waves].concat(),
        );
        let sample_time_s = quiet.deployed.controller.sample_time_s();
        let mut sampled: Vec<f64> = frequencies.iter().filter_map(|one| whole(*one, sample_time_s)).collect();
        sampled.dedup();
        let mut points = Vec::new();
        for (index, frequency) in sampled.iter().enumerate() {
            if !continues(index) {
                break;
            }
            let resting = RestingRig {
                control: &control,
                start: &start,
                orbit: Vec::new(),
                inputs: [Input::Command, self.reference(*frequency)?]
                    .into_iter()
                    .chain(self.ground())
                    .collect(),
                settings: self.settings(),
            };
            let log = RefCell::new(ControllerSamples::default());
            let [reference, measurement, inner] = filtered;
            let read = ControllerInput { reference, measurement, inner, added: 0.0 };
            let waking = Waking::Holding { read, command_v: rest.command };
            let digital = Box::new(Digital::new(&quiet, &waking, &log));
            let sine = [*frequency, self.amplitude];
            let found = respond(resting, Some(digital), sine, &mut || continues(index))?;
            points.push(point(sine, &found, self.model.at(*frequency)?, None));
        }
        self.response(points, &sampled, Vec::new())
    }
}

/// Nearest frequency whose period is a whole number of samples; `None` for one with fewer than four
/// samples a period.
fn whole(frequency: f64, sample_time_s: f64) -> Option<f64> {
    let samples = (TAU / (frequency * sample_time_s)).round();
    (samples >= FEWEST_SAMPLES).then(|| TAU / (samples * sample_time_s))
}

/// Loop that the linear plant closes, from reference to force; for lines with waves, from their
/// response.
///
/// ```text
/// T = F G P e^(-s d)/(1 + G P H e^(-s d))
/// sampled: T = F G/(1 + L) hold P e^(-s d),    hold = (1 - e^(-s T))/(s T), L in z; the fundamental of the signal between the samples.
/// ```
///
/// The command grows by the factor P_z'/P_z if the velocity of a load that can move is fed forward,
/// or pressures are fed back, at the samples; these are the plants in z with and without it. With a
/// virtual impedance, L is that of y = F_e + Z_v X_L, and P between reference and force that of the
/// force.
struct LinearizedLoop {
    /// The rig as part of the loop.
    rig: Rig,
    compensation: Compensation,
    /// The rig within its loop, sampled if the loop is.
    member: Member,
    /// The rig in its loop without the feedforward, if the loop includes one.
    alone: Option<Member>,
    /// The rig with the force as output, in its loop, if there is a virtual impedance.
    force: Option<Member>,
}

impl LinearizedLoop {
    fn new(
        setup: &Setup<'_>,
        rested: &RestedMachine,
        given: &Controller,
    ) -> Result<LinearizedLoop, SimulateError> {
        let seen = rested.rig.in_loop();
        let rig = rested.rig.without_impedance().in_loop();
        let compensation = match given.timing.sample_time_s {
            None => Compensation::new(given, setup.sensor.clone())?,
            Some(_) => setup.compensation(given)?,
        };
        let of = |rig: &Rig, compensation: &Compensation| match rig.in_motion {
            Some(moving) => Ok(compensation.responding(Arc::new(moving))),
            None => compensation.member(rig.plant.coefficients()).map_err(SimulateError::Plant),
        };
        let within = |compensation: &Compensation| of(&seen, compensation);
        let Timing { sample_time_s, rate_feed_forward, inner_feedback, .. } = given.timing;
        let is_fed = sample_time_s.is_some() && (rate_feed_forward != 0.0 || !inner_feedback.is_zero());
        let alone = is_fed.then(|| within(&compensation.without_inner_paths())).transpose()?;
        let member = within(&compensation)?;
        let force = seen.virtual_impedance.is_some().then(|| of(&rig, &compensation)).transpose()?;
        Ok(LinearizedLoop { rig, compensation, member, alone, force })
    }

    fn at(&self, frequency: f64) -> Result<Complex64, SimulateError> {
        let plant = self.member.response(frequency).ok_or(SimulateError::Plant(LinearError::NoPlant))?;
        let feedback = self.compensation.feedback().at_frequency(frequency);
        let between = match self.compensation.sample_time_s() {
            None => {
                let force = self.force.as_ref().and_then(|force| force.response(frequency));
                force.map_or(plant.plant, |force| force.plant)
            }
            Some(sample_time_s) => {
                let late = Complex64::new(0.0, -frequency * self.compensation.delay_s());
                let turn = Complex64::new(0.0, frequency * sample_time_s);
                let hold = (1.0 - portable::exp_complex(-turn)) / turn;
                hold * self.rig.response(frequency) * portable::exp_complex(late)
            }
        };
        let alone = self.alone.as_ref().and_then(|alone| alone.response(frequency));
        let more = alone.map_or(Complex64::ONE, |alone| plant.plant / alone.plant);
        let closed = more * feedback / (1.0 + feedback * plant.plant * plant.sensor);
        Ok(self.compensation.prefilter().at_frequency(frequency) * closed * between)
    }
}
