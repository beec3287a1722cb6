//! The state at the end of a scenario, as a file to go on from.
//!
//! ```text
//! schema = 1
//! project_sha256 = "..."            of the project it was written for
//! scenario = "step"
//! time_s = 1
//!
//! [state]                           all numbers in SI
//! spool_v = 0.125
//! ```
//!
//! Every state of machine, sensor, controller and prefilter is there by its name, and where the load's ground stands; of a sampled controller
//! what it remembers, the command that is held and where its random numbers are. What is under way in a delay is no number: such an end
//! is not saved.

use std::fmt::Write as _;

use phea_dynamics::simulation::Status;
use phea_machine::{Control, Memory};

use super::bench::Bench;
use super::course::Course;
use super::shortest_number::number;
use crate::project::{Findings, Found, Node, Project, Report, TreeValue, read_tree};
use crate::source::Source;

/// Part of a sample time within which an end is at a sample.
const AT_A_SAMPLE: f64 = 1e-9;

/// A state to go on from.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedState {
    /// When, in s of its run.
    pub time_s: f64,
    /// Every number by its name, in order.
    pub values: Vec<(String, f64)>,
    /// Where the random numbers of a sampled controller are.
    pub random: Option<u64>,
}

/// Names of the continuous states, in the order of the vector.
fn state_names(bench: &Bench) -> Vec<String> {
    let states = |count: usize, of: &'static str| (1..=count).map(move |number| format!("{of}_{number}"));
    let mut names = bench.machine.state_names();
    let sensed = bench.control.sensed();
    names.extend(states(sensed.sensor_at_rest(0.0).len(), "sensor"));
    match &bench.control {
        Control::Continuous(closed) => names.extend(states(closed.controller_states(), "controller")),
        Control::Sampled(sampled) => {
            names.extend(states(sampled.held.prefilter_at_rest(0.0).len(), "prefilter"));
        }
        Control::Open(_) => {}
    }
    names
}

/// Where the load's ground stands.
const GROUND: &str = "ground_position_m";
/// What a sampled controller holds.
const HELD: &str = "held_command_v";

/// Names of all numbers of a saved state.
fn names(bench: &Bench) -> Vec<String> {
    let mut names = state_names(bench);
    names.push(GROUND.to_string());
    if let Control::Sampled(sampled) = &bench.control {
        names.push(HELD.to_string());
        let count = sampled.controller.at_rest().memories().len();
        names.extend((1..=count).map(|number| format!("controller_memory_{number}")));
    }
    names
}

/// The end of a run, or why it is not saved.
pub(super) fn of_end(
    bench: &Bench,
    course: &Course,
    (status, end, end_s): (Status, &[f64], f64),
    memory: Option<&Memory>,
) -> Result<SavedState, &'static str> {
    if status != Status::Completed {
        return Err("it did not come to its end");
    }
    if !bench.control.delays().is_empty() {
        return Err("what is under way in a delay or along a line is no state");
    }
    let mut values = end.to_vec();
    values.push(course.ground.value(end_s));
    if let (Control::Sampled(sampled), Some(memory)) = (&bench.control, memory) {
        let sample_time_s = sampled.controller.sample_time_s();
        let samples = end_s / sample_time_s;
        if (samples - samples.round()).abs() > AT_A_SAMPLE {
            return Err("it ends between two samples of the controller");
        }
        if sampled.delay_s > sample_time_s * (1.0 - AT_A_SAMPLE) {
            return Err("a command is under way in the delay of the controller");
        }
        values.push(memory.command_v);
        values.extend_from_slice(&memory.memories);
    }
    Ok(SavedState {
        time_s: end_s,
        values: names(bench).into_iter().zip(values).collect(),
        random: memory.map(|memory| memory.random),
    })
}

impl SavedState {
    /// As the text of a file.
    pub fn text(&self, scenario: &str, sha256: &str) -> String {
        let name = scenario.replace('\\', "\\\\").replace('"', "\\\"");
        let mut text =
            "# The state at the end of a scenario: start = { file = \"...\" } goes on from here.\n"
                .to_string();
        let _ = writeln!(text, "schema = 1\nproject_sha256 = \"{sha256}\"\nscenario = \"{name}\"");
        text.push_str("time_s = ");
        number(&mut text, self.time_s);
        text.push('\n');
        if let Some(random) = self.random {
            let _ = writeln!(text, "random = \"{random:016x}\"");
        }
        text.push_str("\n[state]\n");
        for (name, value) in &self.values {
            let _ = write!(text, "{name} = ");
            number(&mut text, *value);
            text.push('\n');
        }
        text
    }

    fn value(&self, name: &str) -> Option<f64> {
        self.values.iter().find(|(known, _)| known == name).map(|(_, value)| *value)
    }

    /// States of the machine, its sensor and all that is continuous in its controller.
    pub(super) fn states(&self, bench: &Bench) -> Vec<f64> {
        self.values.iter().take(state_names(bench).len()).map(|(_, value)| *value).collect()
    }

    /// Where the load's ground stands, m.
    pub(super) fn ground_m(&self) -> f64 {
        self.value(GROUND).unwrap_or(f64::NAN)
    }

    /// What a sampled controller remembers.
    pub(super) fn memory(&self, bench: &Bench) -> Option<Memory> {
        let Control::Sampled(_) = &bench.control else { return None };
        let behind = self.values.iter().skip_while(|(name, _)| name != HELD).skip(1);
        Some(Memory {
            command_v: self.value(HELD)?,
            memories: behind.map(|(_, value)| *value).collect(),
            random: self.random?,
        })
    }
}

/// The state that a file holds for this bench, or what is wrong with the file.
pub(super) fn read(
    source: &dyn Source,
    project: &Project,
    file: &str,
    bench: &Bench,
) -> Result<SavedState, Box<Report>> {
    let mut findings = Findings::default();
    let path = project.path_of(file);
    let root = match source.read(&path) {
        Ok(bytes) => read_tree(&path, &bytes, &mut findings),
        Err(error) => {
            findings.unreadable(&path, &error.to_string());
            None
        }
    };
    let found = root.filter(|_| !findings.has_errors()).map(|root| taken(&root, bench, &mut findings));
    match found {
        Some(state) if !findings.has_errors() => Ok(state),
        _ => Err(Box::new(findings.report())),
    }
}

/// Every number that there should be and no other.
fn taken(root: &Node, bench: &Bench, findings: &mut Findings) -> SavedState {
    let known = ["schema", "project_sha256", "scenario", "time_s", "random", "state"];
    for entry in root.entries().iter().filter(|entry| !known.contains(&entry.key.as_str())) {
        findings.push(Found::error(entry.key_place, format!("unknown key `{}` in a saved state", entry.key)));
    }
    match root.get("schema").map(|entry| &entry.node.value) {
        Some(TreeValue::Number(1.0)) => {}
        _ => findings.push(Found::error(root.place, "a saved state says `schema = 1`")),
    }
    let random = match root.get("random").map(|entry| &entry.node.value) {
        Some(TreeValue::Text(text)) => u64::from_str_radix(text, 16).ok(),
        _ => None,
    };
    if matches!(bench.control, Control::Sampled(_)) && random.is_none() {
        findings.push(Found::error(root.place, "`random` is missing: 16 hexadecimal digits"));
    }
    let state = root.get("state").map(|entry| &entry.node);
    let place = state.map_or(root.place, |node| node.place);
    let names = names(bench);
    for entry in state.map(Node::entries).unwrap_or_default() {
        if !names.contains(&entry.key) {
            let message = format!("this machine and its controller have no state `{}`", entry.key);
            findings.push(Found::error(entry.key_place, message));
        }
    }
    let mut values = Vec::new();
    for name in names {
        match state.and_then(|node| node.get(&name)).map(|entry| &entry.node) {
            Some(Node { value: TreeValue::Number(value), .. }) if value.is_finite() => {
                values.push((name, *value))
            }
            Some(node) => {
                findings.push(Found::error(node.place, format!("`{name}` must be a finite number")))
            }
            None => findings.push(Found::error(place, format!("the state `{name}` is missing"))),
        }
    }
    SavedState { time_s: 0.0, values, random }
}
