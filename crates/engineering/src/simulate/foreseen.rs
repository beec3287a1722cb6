//! Facts about the scenarios of a project that are known before any simulation: files that cannot
//! be read, and references and motions that the rig cannot follow.

use phea_dynamics::simulation::Profile;

use super::bench::ControlledMachine;
use super::force_limits::{ExceededForce, ForceLimits};
use super::prepared_scenario::driven_by;
use super::{SimulateError, measured};
use crate::project::{
    DeclaredActuator, Findings, InputSignal, LateError, Load, MotionShape, Project, Scenario,
};
use crate::setup::Setup;
use crate::source::Source;

/// Files that the project names and that cannot be read, each at its key.
pub fn unreadable(source: &dyn Source, project: &Project) -> Vec<LateError> {
    let scenarios = project.scenarios.iter().enumerate().flat_map(|(index, one)| files_of(index, one));
    let family = project.family.iter().flat_map(|family| &family.measured);
    let family = family.map(|file| ("family.measured".to_string(), file.as_str()));
    scenarios.chain(family).filter_map(|(path, file)| missing(source, project, path, file)).collect()
}

/// Recordings that `[identify]` names but that do not exist, or not yet, each at its key.
fn absent_recordings(source: &dyn Source, project: &Project) -> Vec<LateError> {
    let all = project.identify.iter().flat_map(|identify| &identify.recordings).enumerate();
    let path = |index: usize| format!("identify.recording[{index}].file");
    all.filter_map(|(index, one)| missing(source, project, path(index), &one.file)).collect()
}

/// Error of a file that cannot be read.
fn missing(source: &dyn Source, project: &Project, path: String, file: &str) -> Option<LateError> {
    let mut findings = Findings::default();
    findings.bytes_of(source, &project.path_of(file));
    let refusal = findings.or_refused(()).err()?;
    let message = refusal.diagnostics.first().map(|found| found.message.clone())?;
    Some(LateError::of_file(path, message))
}

/// Files of a scenario with their keys.
fn files_of(index: usize, scenario: &Scenario) -> Vec<(String, &str)> {
    let own = format!("scenario[{index}]");
    let signals = [
        ("reference", &scenario.reference),
        ("command", &scenario.command),
        ("external_force", &scenario.external_force),
        ("setting_change", &scenario.setting_change),
    ];
    let mut files = Vec::new();
    for (name, signals) in signals {
        for (number, signal) in signals.iter().enumerate() {
            if let InputSignal::File { file, .. } = signal {
                files.push((format!("{own}.{name}[{number}].file"), file.as_str()));
            }
        }
    }
    if let Some(MotionShape::File { file }) = scenario.load_motion.as_ref().map(|motion| &motion.shape) {
        files.push((format!("{own}.load_motion.file"), file.as_str()));
    }
    let start = scenario.start.as_ref().and_then(|start| start.file.as_deref());
    files.extend(start.map(|file| (format!("{own}.start.file"), file)));
    let measured = scenario.measured.iter().enumerate();
    files.extend(measured.map(|(number, one)| (format!("{own}.measured[{number}].file"), one.file.as_str())));
    files
}

/// Signal of a scenario that no controller can produce, or an absent recording.
#[derive(Clone, Debug)]
pub enum Foreseen {
    /// A recording that no command uses and that does not exist.
    AbsentRecording(LateError),
    /// A signal of a scenario that the rig cannot follow.
    InScenario {
        /// Index of the scenario in the file, from 0.
        index: usize,
        /// Name of the scenario.
        name: String,
        /// Signal that the rig cannot follow.
        beyond: BeyondRig,
    },
}

/// A reference or a motion that a rig cannot follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BeyondRig {
    /// A reference beyond a limit on the force.
    Reference {
        /// Time, s.
        time: f64,
        /// Force, N.
        force: f64,
        /// Limit that the reference exceeds.
        exceeded: ExceededForce,
    },
    /// A prescribed motion of the load beyond the stroke.
    Motion {
        /// Time, s.
        time: f64,
        /// Displacement of the load, m.
        moved_by: f64,
        /// Position of the piston before, m.
        from: f64,
        /// Stroke of the cylinder, m.
        stroke: f64,
    },
}

impl BeyondRig {
    /// Key of the scenario that states the signal.
    pub fn key(&self) -> &'static str {
        match self {
            BeyondRig::Reference { .. } => "reference",
            BeyondRig::Motion { .. } => "load_motion",
        }
    }
}

/// References beyond the stall force of the piston or beyond the capacity of the force sensor, and
/// prescribed motions beyond the stroke; and recordings that no command uses and that do not exist.
///
/// # Errors
/// [`SimulateError`] for a malformed file, and for signals that are not functions of time.
pub fn foreseen(source: &dyn Source, setup: &Setup<'_>) -> Result<Vec<Foreseen>, SimulateError> {
    let project = setup.project;
    let Some(actuator) = &project.actuator else { return Ok(vec![]) };
    let Ok(rig) = setup.rig() else { return Ok(vec![]) };
    let limits = ForceLimits::of(project, actuator);
    let absent = absent_recordings(source, project).into_iter();
    let mut found: Vec<Foreseen> = absent.map(Foreseen::AbsentRecording).collect();
    for (index, scenario) in project.scenarios.iter().enumerate() {
        let bench = ControlledMachine::of_scenario(setup, scenario).ok();
        let driven = driven_by(source, project, bench.as_ref(), scenario)?;
        measured::measurements(source, project, scenario).map_err(SimulateError::Motion)?;
        let of = |beyond| Foreseen::InScenario { index, name: scenario.name.clone(), beyond };
        if !scenario.is_open_loop() {
            let ends = ends(&driven.reference, scenario.duration);
            found.extend(limits.exceeded_by(ends).into_iter().map(of));
        }
        let starts = scenario.start.as_ref().and_then(|start| start.position);
        let position = starts.unwrap_or(rig.point.position);
        let begun_elsewhere = scenario.start.as_ref().is_some_and(|start| start.file.is_some());
        if actuator.load == Load::Prescribed && actuator.linkage.is_none() && !begun_elsewhere {
            let moved = ends(&driven.motion, scenario.duration);
            found.extend(beyond_stroke(actuator, position, moved).map(of));
        }
    }
    Ok(found)
}

/// Number of instants at which a signal is evaluated in addition to its breaks.
const SAMPLES: u32 = 20_000;

/// Least and greatest value of a signal with their times, s.
fn ends(profile: &Profile, end_s: f64) -> [(f64, f64); 2] {
    let evenly = (0..=SAMPLES).map(|sample| end_s * f64::from(sample) / f64::from(SAMPLES));
    let breaks = profile.breaks().into_iter().filter(|time| (0.0..=end_s).contains(time));
    let mut found = [(0.0, profile.value(0.0)); 2];
    for time_s in evenly.chain(breaks) {
        let value = profile.value(time_s);
        if value < found[0].1 {
            found[0] = (time_s, value);
        }
        if value > found[1].1 {
            found[1] = (time_s, value);
        }
    }
    found
}

impl ForceLimits {
    /// Limits that a reference between these ends exceeds.
    fn exceeded_by(&self, [least, most]: [(f64, f64); 2]) -> Vec<BeyondRig> {
        let mut found = Vec::new();
        for (time, force) in [least, most] {
            let beyond = self.beyond(force).into_iter();
            found.extend(beyond.map(|exceeded| BeyondRig::Reference { time, force, exceeded }));
        }
        found
    }
}

/// A prescribed motion that takes the piston out of its stroke from this initial position, m.
fn beyond_stroke(actuator: &DeclaredActuator, position: f64, moved: [(f64, f64); 2]) -> Option<BeyondRig> {
    let stroke = actuator.stroke()?;
    let outside = |(_, by): &&(f64, f64)| !(0.0..=stroke).contains(&(position + by)) && *by != 0.0;
    let (time, moved_by) = *moved.iter().find(outside)?;
    Some(BeyondRig::Motion { time, moved_by, from: position, stroke })
}
