//! State at the end of a scenario, as a file from which another run can continue.
//!
//! ```text
//! schema = 1
//! project_sha256 = "..."            of the project for which it was written
//! scenario = "step"
//! time_s = 1
//!
//! [state]                           all numbers in SI
//! spool_v = 0.125
//! ```
//!
//! The file contains every state of machine, sensor, controller and prefilter by its name, the
//! position of the load's ground, and the change of the setting of accumulators if it changes; for
//! a sampled controller also its memories, the held command and the position in its random numbers.
//! The content of a delay cannot be stored as numbers: such a final state is not saved.

use std::fmt::Write as _;

use phea_dynamics::simulation::{Outcome, Status};
use phea_machine::{Control, DigitalMemory};

use super::bench::ControlledMachine;
use super::prepared_scenario::PreparedScenario;
use super::shortest_number::number;
use crate::project::{Findings, Place, Project, RawFinding, Refusal, TreeNode, TreeValue, read_tree};
use crate::quantity::significant;
use crate::source::Source;

/// Fraction of a sample time within which an end is at a sample.
const AT_A_SAMPLE: f64 = 1e-9;

/// A state from which a run can continue.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedState {
    /// Time in its run, s.
    pub time_s: f64,
    /// Every continuous state by its name, in order.
    pub states: Vec<(String, f64)>,
    /// Position of the load's ground, m.
    pub ground_m: f64,
    /// Change of the setting of accumulators from rest; `None` if it is not an input.
    pub setting_change: Option<f64>,
    /// Memory of a sampled controller.
    pub(crate) memory: Option<DigitalMemory>,
}

/// Reason why the final state of a run is not saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// The run was not completed.
    NotCompleted,
    /// The states of a motor are not saved.
    Motor,
    /// The states of a rig with a linkage are not saved.
    Linkage,
    /// A signal is in transit in a delay or along a line, which is not a state.
    InTransit,
    /// The run ends between two samples of the controller.
    BetweenSamples,
    /// A command is in transit in the delay of the controller.
    CommandDelayed,
}

/// Names of the continuous states, in the order of the vector.
fn state_names(bench: &ControlledMachine) -> Vec<String> {
    let states = |count: usize, of: &'static str| (1..=count).map(move |number| format!("{of}_{number}"));
    let mut names = bench.machine.state_names();
    let sensed = bench.control.sensed();
    let beside = [sensed.rate_states(), sensed.impedance_states()];
    names.extend(states(sensed.sensor_at_rest(0.0).len() - beside[0] - beside[1], "sensor"));
    names.extend(states(beside[0], "velocity_sensor"));
    names.extend(states(beside[1].saturating_sub(1), "virtual_impedance"));
    names.extend((beside[1] > 0).then(|| "rest_position_m".to_string()));
    match &bench.control {
        Control::Continuous(closed) => names.extend(states(closed.controller_states(), "controller")),
        Control::Sampled(sampled) => {
            names.extend(states(sampled.held.controller_states(), "prefilter"));
        }
        Control::Open(_) => {}
    }
    names
}

/// Name of the change of a setting.
const SETTING_CHANGE: &str = "setting_change";
/// Difference of a setting that counts as rounding.
const SAME_SETTING: f64 = 1e-9;
/// Name of the position of the load's ground.
const GROUND: &str = "ground_position_m";
/// Name of the held command of a sampled controller.
const HELD: &str = "held_command_v";

/// Names of the memories of a sampled controller, numbered from 1.
fn remembered(number: usize) -> String {
    format!("controller_memory_{number}")
}

/// Final state of a run, or the reason why it is not saved.
pub(super) fn of_end(
    bench: &ControlledMachine,
    prepared: &PreparedScenario,
    outcome: &Outcome,
    end_s: f64,
    memory: Option<&DigitalMemory>,
) -> Result<SavedState, NotSaved> {
    if outcome.status != Status::Completed {
        return Err(NotSaved::NotCompleted);
    }
    if bench.units.motion.is_rotary() {
        return Err(NotSaved::Motor);
    }
    if bench.machine.has_linkage() {
        return Err(NotSaved::Linkage);
    }
    if !bench.control.delays().is_empty() {
        return Err(NotSaved::InTransit);
    }
    if let (Control::Sampled(sampled), Some(_)) = (&bench.control, memory) {
        let sample_time_s = sampled.deployed.controller.sample_time_s();
        let samples = end_s / sample_time_s;
        if (samples - samples.round()).abs() > AT_A_SAMPLE {
            return Err(NotSaved::BetweenSamples);
        }
        if sampled.delay_s > sample_time_s * (1.0 - AT_A_SAMPLE) {
            return Err(NotSaved::CommandDelayed);
        }
    }
    Ok(SavedState {
        time_s: end_s,
        states: state_names(bench).into_iter().zip(outcome.end.iter().copied()).collect(),
        ground_m: prepared.ground.value(end_s),
        setting_change: prepared.setting_change.as_ref().map(|change| change.value(end_s)),
        memory: memory.cloned(),
    })
}

impl SavedState {
    /// Text of the file.
    pub fn text(&self, scenario: &str, sha256: &str) -> String {
        let name = scenario.replace('\\', "\\\\").replace('"', "\\\"");
        let mut text = include_str!("saved_head.toml").to_string();
        let _ = writeln!(text, "project_sha256 = \"{sha256}\"\nscenario = \"{name}\"");
        text.push_str("time_s = ");
        number(&mut text, self.time_s);
        text.push('\n');
        if let Some(memory) = &self.memory {
            let _ = writeln!(text, "random = \"{:016x}\"", memory.random);
        }
        text.push_str("\n[state]\n");
        let mut line = |name: &str, value: f64| {
            let _ = write!(text, "{name} = ");
            number(&mut text, value);
            text.push('\n');
        };
        self.states.iter().for_each(|(name, value)| line(name, *value));
        line(GROUND, self.ground_m);
        self.setting_change.iter().for_each(|change| line(SETTING_CHANGE, *change));
        if let Some(memory) = &self.memory {
            line(HELD, memory.command_v);
            for (index, value) in memory.memories.iter().enumerate() {
                line(&remembered(index + 1), *value);
            }
        }
        text
    }
}

/// State in a file for this bench, whose setting begins with the change `setting_change`, or the
/// errors of the file.
pub(super) fn read(
    source: &dyn Source,
    project: &Project,
    file: &str,
    bench: &ControlledMachine,
    setting_change: f64,
) -> Result<SavedState, Box<Refusal>> {
    let mut findings = Findings::default();
    let path = project.path_of(file);
    let bytes = findings.bytes_of(source, &path);
    let root = bytes.and_then(|bytes| read_tree(&path, &bytes, &mut findings));
    let found = root.filter(|_| !findings.has_errors()).map(|root| {
        continues(&root, setting_change, &mut findings);
        taken(&root, bench, &mut findings)
    });
    match found {
        Some(state) if !findings.has_errors() => Ok(state),
        _ => Err(Box::new(findings.report())),
    }
}

/// Number below [`SETTING_CHANGE`] and its place; zero if the previous run moved no setting.
fn moved_before(root: &TreeNode) -> Option<(f64, Place)> {
    let node = &root.get("state")?.node.get(SETTING_CHANGE)?.node;
    match node.value {
        TreeValue::Number(value) => Some((value, node.place)),
        _ => None,
    }
}

/// Fault of a saved state.
#[derive(Debug, thiserror::Error)]
enum SavedProblem {
    #[error(
        "the setting of the accumulators has moved by {before} at the end of that run, and by {begins} at the beginning of this one: \
         let `setting_change` begin there, with `{{ at = \"0 s\", change = {before} }}`"
    )]
    SettingJumps { before: String, begins: String },
    #[error("unknown key `{0}` in a saved state")]
    UnknownKey(String),
    #[error("a saved state says `schema = 1`")]
    NoSchema,
    #[error("`random` is missing: 16 hexadecimal digits")]
    NoRandom,
    #[error("`{0}` must be a finite number")]
    NotFinite(String),
    #[error("the state `{0}` is missing")]
    NoState(String),
    #[error("this machine and its controller have no state `{0}`")]
    UnknownState(String),
}

/// Rejects a setting that would jump from its final value in the previous run.
fn continues(root: &TreeNode, setting_change: f64, findings: &mut Findings) {
    let (before, place) = moved_before(root).unwrap_or((0.0, root.place));
    if (before - setting_change).abs() > SAME_SETTING {
        let [before, begins] = [before, setting_change].map(|change| significant(change, 6));
        findings.push(RawFinding::error(place, SavedProblem::SettingJumps { before, begins }.to_string()));
    }
}

/// Every expected number; others are errors.
fn taken(root: &TreeNode, bench: &ControlledMachine, findings: &mut Findings) -> SavedState {
    let known = ["schema", "project_sha256", "scenario", "time_s", "random", "state"];
    for entry in root.entries().iter().filter(|entry| !known.contains(&entry.key.as_str())) {
        let problem = SavedProblem::UnknownKey(entry.key.clone());
        findings.push(RawFinding::error(entry.key_place, problem.to_string()));
    }
    match root.get("schema").map(|entry| &entry.node.value) {
        Some(TreeValue::Number(1.0)) => {}
        _ => findings.push(RawFinding::error(root.place, SavedProblem::NoSchema.to_string())),
    }
    let random = match root.get("random").map(|entry| &entry.node.value) {
        Some(TreeValue::Text(text)) => u64::from_str_radix(text, 16).ok(),
        _ => None,
    };
    let memories = match &bench.control {
        Control::Sampled(sampled) => Some(sampled.deployed.controller.at_rest().memories().len()),
        Control::Continuous(_) | Control::Open(_) => None,
    };
    if memories.is_some() && random.is_none() {
        findings.push(RawFinding::error(root.place, SavedProblem::NoRandom.to_string()));
    }
    let state = root.get("state").map(|entry| &entry.node);
    let place = state.map_or(root.place, |node| node.place);
    let mut known: Vec<String> = Vec::new();
    let mut number = |name: String| {
        let value = match state.and_then(|node| node.get(&name)).map(|entry| &entry.node) {
            Some(TreeNode { value: TreeValue::Number(value), .. }) if value.is_finite() => Some(*value),
            Some(node) => {
                findings
                    .push(RawFinding::error(node.place, SavedProblem::NotFinite(name.clone()).to_string()));
                None
            }
            None => {
                findings.push(RawFinding::error(place, SavedProblem::NoState(name.clone()).to_string()));
                None
            }
        };
        known.push(name.clone());
        (name, value.unwrap_or_default())
    };
    let taken = SavedState {
        time_s: 0.0,
        states: state_names(bench).into_iter().map(&mut number).collect(),
        ground_m: number(GROUND.to_string()).1,
        setting_change: moved_before(root).map(|_| number(SETTING_CHANGE.to_string()).1),
        memory: memories.map(|count| DigitalMemory {
            command_v: number(HELD.to_string()).1,
            memories: (1..=count).map(|index| number(remembered(index)).1).collect(),
            random: random.unwrap_or_default(),
        }),
    };
    for entry in state.map(TreeNode::entries).unwrap_or_default() {
        if !known.contains(&entry.key) {
            let problem = SavedProblem::UnknownState(entry.key.clone());
            findings.push(RawFinding::error(entry.key_place, problem.to_string()));
        }
    }
    taken
}
