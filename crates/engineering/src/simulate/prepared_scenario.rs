//! The start of a scenario, and its inputs.

use phea_dynamics::controller::ControllerInput;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::simulation::{Input, Plant, Profile, ProfileError};
use phea_hydraulics::machine::{InitialCondition, StartValues};
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_machine::{Control, HeldInputs, Rest, Waking};

use super::bench::ControlledMachine;
use super::divergence::OtherInputs;
use super::equilibrium::{RestedLoop, rest};
use super::input_signal::{self, SignalOnset as Begun};
use super::motion_file::{self, CHANGES, FORCES, VOLTAGES};
use super::saved::{self, SavedState};
use super::{Cause, SimulateError, Window};
use crate::project::{self, LoadMotion, MotionShape, Project, Scenario};
use crate::rig::OfMotion;
use crate::source::Source;

/// A scenario ready to be simulated.
pub(crate) struct PreparedScenario {
    /// Reference, N.
    pub reference: Profile,
    /// Command of an open loop, V.
    pub command: Profile,
    /// Position of the load or of its ground, m.
    pub ground: Profile,
    /// External force on the load, N, if the machine has that input.
    pub external_force: Option<Profile>,
    /// Change of the setting of accumulators, if the machine has that input.
    pub setting_change: Option<Profile>,
    /// Initial states of the machine, of its sensor and of the continuous part of its controller,
    /// and the waves in transit.
    pub start: Vec<f64>,
    /// Initial state of a sampled controller.
    pub waking: Waking,
    /// Windows that are evaluated.
    pub windows: Vec<Window>,
}

/// Inputs of a scenario, independent of the machine.
pub struct ScenarioDrive {
    /// Reference, N.
    pub reference: Profile,
    /// Command of an open loop, V.
    command: Profile,
    /// External force on the load, N.
    external_force: Profile,
    /// Change of the setting of accumulators.
    setting_change: Profile,
    /// Position of the load or of its ground relative to its start, m.
    pub motion: Profile,
    /// Windows that are evaluated.
    pub windows: Vec<Window>,
    /// Saved state from which the scenario continues.
    saved: Option<SavedState>,
}

impl PreparedScenario {
    /// Inputs that act on the machine in addition to the controller.
    pub(crate) fn other_inputs(&self) -> OtherInputs<'_> {
        let more = [&self.external_force, &self.setting_change].into_iter().flatten();
        OtherInputs { reference: &self.reference, of_load: [&self.ground].into_iter().chain(more).collect() }
    }

    /// Inputs of the machine other than its command.
    pub(crate) fn machine_inputs(&self) -> Vec<Input> {
        let ground = [Input::Value(self.ground.clone()), Input::Rate(self.ground.clone())];
        let setting = self.setting_change.clone();
        let setting = setting.map(|setting| [Input::Value(setting.clone()), Input::Rate(setting)]);
        let external = self.external_force.clone().map(Input::Value);
        ground.into_iter().chain(external).chain(setting.into_iter().flatten()).collect()
    }
}

pub(super) fn prepared(
    source: &dyn Source,
    project: &Project,
    bench: &ControlledMachine,
    scenario: &Scenario,
) -> Result<PreparedScenario, SimulateError> {
    let driven = driven(source, project, bench, scenario)?;
    prepared_scenario_of(&driven, bench, scenario)
}

/// Reference and motion of a scenario.
pub fn driven(
    source: &dyn Source,
    project: &Project,
    bench: &ControlledMachine,
    scenario: &Scenario,
) -> Result<ScenarioDrive, SimulateError> {
    driven_by(source, project, Some(bench), scenario)
}

/// Reference and motion of a scenario; without a machine, a saved state, which has to fit one, is
/// not read.
pub(super) fn driven_by(
    source: &dyn Source,
    project: &Project,
    bench: Option<&ControlledMachine>,
    scenario: &Scenario,
) -> Result<ScenarioDrive, SimulateError> {
    let named = |error: ProfileError| SimulateError::Profile { name: scenario.name.clone(), error };
    let reference = input_signal::profile(source, project, &scenario.name, &scenario.reference, &FORCES)?;
    let motion = match &scenario.load_motion {
        None => Profile::constant(0.0),
        Some(declared) => motion(source, project, declared).map_err(SimulateError::Motion)?.map_err(named)?,
    };
    let command = input_signal::profile(source, project, &scenario.name, &scenario.command, &VOLTAGES)?;
    let external_force =
        input_signal::profile(source, project, &scenario.name, &scenario.external_force, &FORCES)?;
    let setting_change =
        input_signal::profile(source, project, &scenario.name, &scenario.setting_change, &CHANGES)?;
    within_its_way(project, scenario, &setting_change)?;
    let about_joint = project.actuator.as_ref().is_some_and(|actuator| actuator.linkage.is_some());
    let windows = windows(scenario, about_joint, [&reference, &command, &external_force, &setting_change]);
    let file = scenario.start.as_ref().and_then(|start| start.file.as_ref());
    let begins = setting_change.value(0.0);
    let read = |(file, bench): (&String, &ControlledMachine)| {
        saved::read(source, project, file, (bench, begins)).map_err(SimulateError::Motion)
    };
    let saved = file.zip(bench).map(read).transpose()?;
    Ok(ScenarioDrive { reference, command, external_force, setting_change, motion, windows, saved })
}

/// The scenario for the machine of a bench.
pub(crate) fn prepared_scenario_of(
    driven: &ScenarioDrive,
    bench: &ControlledMachine,
    scenario: &Scenario,
) -> Result<PreparedScenario, SimulateError> {
    if let Some(saved) = &driven.saved {
        let waking = saved.memory.clone().map_or(Waking::AtRest, Waking::Resumed);
        let states = saved.states.iter().map(|(_, value)| *value).collect();
        return Ok(driven.prepared(bench, saved.ground_m, states, waking));
    }
    if let Some(stated) = &scenario.start {
        let named = |error| SimulateError::Start {
            name: scenario.name.clone(),
            error: OfMotion { motion: bench.rig.motion, error },
        };
        let beginning = bench.machine.start(&stated_start(stated)).map_err(named)?;
        let start = loop_start(bench, &beginning, None);
        return Ok(driven.prepared(bench, beginning.inputs[0], start, Waking::AtRest));
    }
    let at = driven.at_start();
    let near = near_rest(bench, scenario, at.reference_n)?;
    let guess = loop_start(bench, &near, Some(at.reference_n));
    let RestedLoop { rest: Rest { start, measured_n, inner_pa, command_v, .. }, ground_m } =
        rest(bench, &guess, &near, at, &scenario.name)?;
    let read = ControllerInput {
        reference: at.reference_n,
        measurement: measured_n,
        inner: inner_pa,
        ..ControllerInput::default()
    };
    let waking = Waking::Holding { read, command_v };
    Ok(driven.prepared(bench, ground_m, start, waking))
}

impl ScenarioDrive {
    /// Constant inputs while the loop is in equilibrium before time zero.
    fn at_start(&self) -> HeldInputs {
        HeldInputs {
            reference_n: self.reference.value(0.0),
            command_v: self.command.value(0.0),
            external_n: self.external_force.value(0.0),
            setting_change: self.setting_change.value(0.0),
        }
    }

    /// Input schedule from a state, with the position of the load's ground, m. The load is at the
    /// rest position of a virtual impedance, unless another run is continued.
    fn prepared(
        &self,
        bench: &ControlledMachine,
        ground: f64,
        mut start: Vec<f64>,
        waking: Waking,
    ) -> PreparedScenario {
        if self.saved.is_none() {
            bench.control.rest_at(&mut start, ground + self.motion.value(0.0));
        }
        PreparedScenario {
            reference: self.reference.clone(),
            command: self.command.clone(),
            ground: self.motion.clone().shifted(ground),
            external_force: bench.machine.has_external_force().then(|| self.external_force.clone()),
            setting_change: bench.machine.has_moving_setting().then(|| self.setting_change.clone()),
            start,
            waking,
            windows: self.windows.clone(),
        }
    }
}

/// Number of instants at which a setting is checked in addition to its breaks.
const INSTANTS: u32 = 20_000;
/// Distance beyond its ends to which rounding may move a setting.
const BEYOND: f64 = 1e-9;

/// Rejects a setting outside 0 to 1.
fn within_its_way(project: &Project, scenario: &Scenario, change: &Profile) -> Result<(), SimulateError> {
    let adjusted = project.actuator.as_ref().map_or([None; 2], project::DeclaredActuator::adjustments);
    if scenario.setting_change.is_empty() {
        return Ok(());
    }
    let end_s = scenario.duration;
    let evenly = (0..=INSTANTS).map(|look| end_s * f64::from(look) / f64::from(INSTANTS));
    let breaks = change.breaks().into_iter().filter(|time| *time <= end_s);
    let beyond = |setting: f64| (setting - 1.0).max(-setting);
    let mut farthest: Option<(f64, f64)> = None;
    for time_s in evenly.chain(breaks) {
        for one in adjusted.into_iter().flatten() {
            let setting = one.setting.unwrap_or(0.0) + change.value(time_s);
            let before = farthest.map_or(BEYOND, |(setting, _)| beyond(setting));
            if beyond(setting) > before || setting.is_nan() {
                farthest = Some((setting, time_s));
            }
        }
    }
    match farthest {
        None => Ok(()),
        Some((setting, time_s)) => {
            let name = scenario.name.clone();
            Err(SimulateError::Setting { name, setting, time_s })
        }
    }
}

/// The load motion as a function of time.
fn motion(
    source: &dyn Source,
    project: &Project,
    LoadMotion { shape, start }: &LoadMotion,
) -> Result<Result<Profile, ProfileError>, Box<project::Refusal>> {
    Ok(match shape {
        MotionShape::SmoothStep { duration, distance } => Profile::smooth_step(*start, *duration, *distance),
        MotionShape::FirstOrder { distance, time_constant } => {
            Profile::first_order(*start, *time_constant, *distance)
        }
        MotionShape::Sine { amplitude, frequency } => Profile::sine(*start, *amplitude, *frequency),
        MotionShape::Chirp { duration, amplitude, frequency, final_frequency } => {
            Profile::chirp(*start, *duration, *amplitude, [*frequency, *final_frequency])
        }
        MotionShape::File { file } => motion_file::motion(source, project, file, *start)?,
    })
}

/// Start of the search for an equilibrium: the machine at the position of its operating point under
/// the force of the reference, or without force if there is no such operating point.
fn near_rest(
    bench: &ControlledMachine,
    scenario: &Scenario,
    reference_n: f64,
) -> Result<InitialCondition, SimulateError> {
    let position = bench.rig.point.position;
    let near = |force: f64| -> Result<InitialCondition, SimulateError> {
        let point = operating_point(&bench.rig.actuator, position, Condition::Load(SteadyLoad::Force(force)))
            .map_err(|error| SimulateError::Equilibrium {
                name: scenario.name.clone(),
                error: OfMotion { motion: bench.rig.motion, error },
            })?;
        let start = StartValues {
            position: point.position,
            pressure_a: point.pressure_a,
            pressure_b: point.pressure_b,
            spool: point.command,
            ..StartValues::default()
        };
        let named = |error| SimulateError::Start {
            name: scenario.name.clone(),
            error: OfMotion { motion: bench.rig.motion, error },
        };
        bench.machine.rest_under_load(&point).or_else(|_| bench.machine.start(&start)).map_err(named)
    };
    near(reference_n).or_else(|_| near(0.0))
}

fn stated_start(stated: &project::Start) -> StartValues {
    let number = |value: Option<f64>| value.unwrap_or(0.0);
    StartValues {
        position: number(stated.position),
        velocity: number(stated.velocity),
        pressure_a: number(stated.pressure_a),
        pressure_b: number(stated.pressure_b),
        force: number(stated.force),
        spool: number(stated.spool),
    }
}

/// States of the loop with its machine there, and the waves in transit. Controller and sensor hold
/// the machine at a reference, N; without one they begin at zero, like everything that is not
/// stated.
fn loop_start(bench: &ControlledMachine, beginning: &InitialCondition, held_at: Option<f64>) -> Vec<f64> {
    let mut start = beginning.state.clone();
    let measured = bench.machine.measurement(&beginning.state, &beginning.all_inputs());
    let reference = held_at.unwrap_or(0.0);
    let mut sensor = bench.control.sensed().sensor_at_rest(measured);
    let inner = bench.machine.inner_measurement(&beginning.state, &beginning.all_inputs());
    let commanded = bench.control.commanded();
    let mut control = commanded.controller_at_rest(reference, [measured, inner], beginning.command);
    if held_at.is_none() {
        sensor.fill(0.0);
        control.fill(0.0);
    }
    start.extend(sensor);
    start.extend(control);
    let leading: &[f64] = match &bench.control {
        Control::Continuous(_) => &[reference],
        Control::Sampled(_) | Control::Open(_) => &[0.0, reference],
    };
    let waves = bench.control.under_way(&start, leading, beginning);
    start.extend(waves);
    start
}

/// One window for each event in reference, command, external force and setting, and for the motion
/// of the load, each lasting until the next.
fn windows(
    scenario: &Scenario,
    about_joint: bool,
    [reference, command, external, setting]: [&Profile; 4],
) -> Vec<Window> {
    let end_s = scenario.duration;
    let window = |cause: Cause, start_s: f64| Window { cause, start_s, end_s };
    let referred = |begun: Begun| match begun {
        Begun::Step { time_s, from, to } => window(Cause::ReferenceStep { from_n: from, to_n: to }, time_s),
        Begun::Motion { time_s, kind } => window(Cause::ReferenceMotion { kind }, time_s),
    };
    let commanded = |begun: Begun| match begun {
        Begun::Step { time_s, from, to } => window(Cause::CommandStep { from_v: from, to_v: to }, time_s),
        Begun::Motion { time_s, kind } => window(Cause::CommandMotion { kind }, time_s),
    };
    let begun = input_signal::beginnings(&scenario.reference, reference, end_s).into_iter().map(referred);
    let of_command = input_signal::beginnings(&scenario.command, command, end_s).into_iter().map(commanded);
    let outside = input_signal::beginnings(&scenario.external_force, external, end_s).into_iter();
    let outside = outside.map(|begun| window(Cause::ExternalForce { about_joint }, begun.time_s()));
    let adjusted = input_signal::beginnings(&scenario.setting_change, setting, end_s).into_iter();
    let adjusted = adjusted.map(|begun| window(Cause::SettingChange, begun.time_s()));
    // a loop that starts in equilibrium starts with the inputs at time zero
    let stands = |window: &Window| {
        let steps = matches!(
            window.cause,
            Cause::ReferenceStep { .. } | Cause::CommandStep { .. } | Cause::SettingChange
        );
        scenario.start.is_none() && steps && window.start_s <= 0.0
    };
    let begun = begun.chain(of_command).chain(outside).chain(adjusted);
    let mut windows: Vec<Window> = begun.filter(|window| !stands(window)).collect();
    if let Some(motion) = scenario.load_motion.as_ref().filter(|motion| motion.start < end_s) {
        windows.push(window(Cause::LoadMotion, motion.start));
    }
    sort_by_number(&mut windows, |window| window.start_s);
    let starts: Vec<f64> = windows.iter().map(|window| window.start_s).collect();
    for window in &mut windows {
        let next = starts.iter().copied().find(|start| *start > window.start_s);
        window.end_s = next.unwrap_or(end_s);
    }
    windows
}
