//! The common basis of all scenarios of a project: the machine with its sensor, and the controller
//! as it is deployed.

use phea_dynamics::controller::Controller;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::simulation::{CommandedPlant, Sensed, SimulationSettings};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::machine::{Machine, MachineError, MachineOptions, PowerUnit};
use phea_machine::{Control, Sampled};

use super::SimulateError;
use super::line_limits::LineLimits;
use crate::deployed::executed;
use crate::project::{self, Project, Scenario};
use crate::quantity::Units;
use crate::rig::{OfMotion, Rig, pressure_ratio};
use crate::setup::Setup;

/// A machine with its controller.
#[derive(Clone, Debug)]
pub struct ControlledMachine {
    /// The rig from which it was made.
    pub rig: Rig,
    /// The machine.
    pub machine: Machine,
    /// What commands it.
    pub control: Control,
    /// How exactly it is integrated.
    pub settings: SimulationSettings,
    /// From the load's velocity to the command, V s/m; zero where nothing is fed forward.
    pub feed_forward: f64,
    /// Pressures in Pa up to which the expansions of hoses A and B were measured, if stated.
    pub expansion_stated_at: [Option<f64>; 2],
    /// The capacity of the force sensor, N, if stated.
    pub force_capacity_n: Option<f64>,
    /// Where the relief valve of a limited pump is shut, Pa; `None` for a constant pressure.
    pub relief_shut_pa: Option<f64>,
    /// Working temperatures of the gas at chambers A and B in degC, if stated.
    pub gas_wall_celsius: [Option<f64>; 2],
    /// What lines A and B bear.
    pub line_limits: [LineLimits; 2],
    /// Motion of the rig.
    pub units: Units,
}

impl ControlledMachine {
    /// The machine and the controller of a project.
    ///
    /// # Errors
    /// [`SimulateError`] where one of them is missing or impossible.
    pub fn new(setup: &Setup<'_>) -> Result<ControlledMachine, SimulateError> {
        ControlledMachine::closed(setup, &MachineOptions::default())
    }

    /// The machine for a scenario of the project: in open loop if it states a command, with an
    /// external force if it states one.
    ///
    /// # Errors
    /// As [`ControlledMachine::new`]; an open loop needs no controller.
    pub fn of_scenario(setup: &Setup<'_>, scenario: &Scenario) -> Result<ControlledMachine, SimulateError> {
        let driven = MachineOptions {
            external_force: !scenario.external_force.is_empty(),
            moving_setting: !scenario.setting_change.is_empty(),
            ..MachineOptions::default()
        };
        match scenario.is_open_loop() {
            false => ControlledMachine::closed(setup, &driven),
            true => ControlledMachine::open(setup, &driven),
        }
    }

    fn closed(setup: &Setup<'_>, driven: &MachineOptions) -> Result<ControlledMachine, SimulateError> {
        let project = setup.project;
        let (rig, sensed) = rig_and_machine(setup, driven)?;
        let controller = setup.controller.clone().ok_or(SimulateError::NoController)?;
        let feed_forward = rig.feed_forward();
        let machine = *sensed.plant();
        let sensed = match feed_forward == 0.0 {
            true => sensed,
            false => sensed.with_rate_sensor(&setup.velocity_sensor)?,
        };
        let sensed = sensed.with_impedance(&setup.virtual_impedance.unwrap_or_default())?;
        let control = match controller.timing.sample_time_s {
            None => {
                Control::Continuous(Box::new(CommandedPlant::in_loop(sensed, &controller, feed_forward)?))
            }
            Some(sample_time_s) => {
                Control::Sampled(Box::new(sampled(setup, sensed, controller, sample_time_s, feed_forward)?))
            }
        };
        Ok(ControlledMachine::assembled(project, rig, machine, control, feed_forward))
    }

    /// The machine alone, for a stated command, which is not subject to limits, samples and delays
    /// of a controller.
    fn open(setup: &Setup<'_>, driven: &MachineOptions) -> Result<ControlledMachine, SimulateError> {
        let project = setup.project;
        let (rig, sensed) = rig_and_machine(setup, driven)?;
        let machine = *sensed.plant();
        let control =
            Control::Open(Box::new(CommandedPlant::on_hold(sensed, &TransferFunction::gain_only(1.0))?));
        Ok(ControlledMachine::assembled(project, rig, machine, control, 0.0))
    }

    fn assembled(
        project: &Project,
        rig: Rig,
        machine: Machine,
        control: Control,
        feed_forward: f64,
    ) -> ControlledMachine {
        ControlledMachine {
            relief_shut_pa: relief_shut_pa(rig.actuator.components()),
            rig,
            machine,
            control,
            settings: settings(project),
            feed_forward,
            expansion_stated_at: expansion_stated_at(project),
            force_capacity_n: capacity(project),
            gas_wall_celsius: gas_wall_celsius(project),
            line_limits: LineLimits::of(project),
            units: project.units,
        }
    }

    /// The same controller around another machine, made from this actuator.
    pub fn around(&self, machine: Machine, actuator: Actuator) -> ControlledMachine {
        let mut bench = self.clone();
        bench.machine = machine;
        bench.rig.actuator = actuator;
        bench.control = bench.control.around(machine);
        bench
    }
}

/// The rig, and its machine with its sensor and the inputs that `driven` has.
fn rig_and_machine(
    setup: &Setup<'_>,
    driven: &MachineOptions,
) -> Result<(Rig, Sensed<Machine>), SimulateError> {
    let rig = setup.rig()?;
    let machine = machine_of(setup.project, &rig.actuator, driven)?;
    Ok((rig.clone(), Sensed::new(machine, &setup.sensor)?))
}

/// The machine of an actuator under the controller of a project, with the inputs that `driven` has.
///
/// # Errors
/// [`SimulateError`] where there is no such machine.
pub fn machine_of(
    project: &Project,
    actuator: &Actuator,
    driven: &MachineOptions,
) -> Result<Machine, SimulateError> {
    let fed_back = project.controller.as_ref().and_then(|controller| controller.pressure_feedback);
    let pressure_ratio = fed_back.map_or(1.0, |fed_back| pressure_ratio(&fed_back, actuator.components()));
    let motion = project.motion();
    Machine::new(actuator, &MachineOptions { pressure_ratio, ..*driven }).map_err(|error| match error {
        MachineError::Line(error) => SimulateError::Line(error),
        MachineError::LoadWithoutMass => SimulateError::LoadMass(motion),
        error => SimulateError::Machine(OfMotion { motion, error }),
    })
}

/// Where the relief valve of a limited pump is shut, Pa.
fn relief_shut_pa(components: &Components) -> Option<f64> {
    match components.power_unit {
        PowerUnit::PumpLimited(unit) => Some(components.supply.pressure - unit.relief_override),
        PowerUnit::Constant => None,
    }
}

fn capacity(project: &Project) -> Option<f64> {
    project.actuator.as_ref().and_then(|actuator| actuator.force_sensor.capacity)
}

fn gas_wall_celsius(project: &Project) -> [Option<f64>; 2] {
    let lines = project.actuator.as_ref().map(|actuator| &actuator.line);
    let working = |line: &project::DeclaredLine| Some(line.accumulator.as_ref()?.temperatures?.working);
    lines.map_or([None; 2], |lines| [&lines.a, &lines.b].map(working))
}

fn expansion_stated_at(project: &Project) -> [Option<f64>; 2] {
    let lines = project.actuator.as_ref().map(|actuator| &actuator.line);
    lines.map_or([None; 2], |lines| [&lines.a, &lines.b].map(project::DeclaredLine::expansion_stated_at))
}

/// The settings of the project for the integration.
pub(super) fn settings(project: &Project) -> SimulationSettings {
    let declared = &project.simulation;
    SimulationSettings {
        tolerance: declared.tolerance,
        maximum_steps: u64::from(declared.maximum_steps),
        method: declared.method,
    }
}

fn sampled(
    setup: &Setup<'_>,
    sensed: Sensed<Machine>,
    mut controller: Controller,
    sample_time_s: f64,
    feed_forward: f64,
) -> Result<Sampled, SimulateError> {
    let project = setup.project;
    let between = between_samples(project, &mut controller)?;
    let controller = setup.deployed(&controller)?;
    let noise = project.actuator.as_ref().map_or(0.0, |actuator| actuator.force_sensor.noise);
    let of_velocity = project.actuator.as_ref().and_then(|actuator| actuator.velocity_sensor.as_ref());
    let of_pressures = project.controller.as_ref().and_then(|controller| controller.pressure_feedback);
    Ok(Sampled {
        held: CommandedPlant::on_hold(sensed, &between)?,
        delay_s: controller.timing.delay_s,
        command_limit: controller.command_limit.unwrap_or(f64::INFINITY),
        deployed: executed(setup, &controller, sample_time_s, feed_forward)?,
        noise,
        velocity_noise: of_velocity.map_or(0.0, |sensor| sensor.noise),
        pressure_noise: of_pressures.map_or(0.0, |declared| declared.noise),
        seed: u64::from(project.simulation.seed),
    })
}

/// The prefilter, removed from a sampled controller if the project lets it also act between
/// samples.
fn between_samples(
    project: &Project,
    controller: &mut Controller,
) -> Result<TransferFunction, SimulateError> {
    if project.prefilter.as_ref().is_some_and(|prefilter| prefilter.continuous) {
        return Ok(std::mem::take(&mut controller.prefilter).transfer_function()?);
    }
    Ok(TransferFunction::gain_only(1.0))
}
