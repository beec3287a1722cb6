//! The steps of the reference that the scenarios of a project make.

use crate::project::{Project, Scenario, Signal};

/// A step of the reference in a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceStep {
    /// The name of the scenario.
    pub scenario: String,
    /// Before, N.
    pub from_n: f64,
    /// From then on, N.
    pub to_n: f64,
    /// Until the next step or the end, s.
    pub hold_s: f64,
}

impl ReferenceStep {
    /// Size with its sign, N.
    pub fn size_n(&self) -> f64 {
        self.to_n - self.from_n
    }
}

/// The largest step of the reference in each scenario that has one, whatever moves beside it; a
/// ramp or a sine is no step, nor is what a run that begins at rest begins with.
///
/// # Example
/// ```
/// use phea_project::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../../examples/ybitu/hose.toml"));
/// let scenario = r#"scenario=[{ name = "there and back", duration = "3 s", reference = [{ at = "0 s", force = "1 kN" }, { at = "1 s", force = "4 kN" }, { at = "2 s", force = "0 N" }] }]"#;
/// let project = phea_project::read(&source, "rig.toml", &[scenario.to_string()], &[])?.project;
/// let [step] = &phea_engineering::simulate::largest_reference_steps(&project)[..] else { panic!() };
/// assert_eq!((step.from_n, step.to_n, step.hold_s), (4000.0, 0.0, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn largest_reference_steps(project: &Project) -> Vec<ReferenceStep> {
    project.scenarios.iter().filter_map(largest).collect()
}

fn largest(scenario: &Scenario) -> Option<ReferenceStep> {
    if !scenario.command.is_empty() {
        return None;
    }
    let (single, staircases): (Vec<&Signal>, Vec<&Signal>) =
        scenario.reference.iter().partition(|signal| matches!(signal, Signal::Step { .. }));
    // single steps are one staircase
    let mut parts: Vec<Vec<(f64, f64)>> = vec![single.into_iter().flat_map(Signal::steps).collect()];
    parts.extend(staircases.into_iter().map(Signal::steps));
    let mut times_s: Vec<f64> = parts.iter().flatten().map(|(time_s, _)| *time_s).collect();
    times_s.sort_by(f64::total_cmp);
    times_s.dedup();
    let value = |is_past: &dyn Fn(f64) -> bool| -> f64 {
        let held = |part: &Vec<(f64, f64)>| {
            let past = part.iter().filter(|(time_s, _)| is_past(*time_s));
            past.max_by(|one, other| one.0.total_cmp(&other.0)).map_or(0.0, |(_, value)| *value)
        };
        parts.iter().map(held).sum()
    };
    let begins = |time_s: f64| time_s < scenario.duration && (time_s > 0.0 || scenario.start.is_some());
    let steps = times_s.iter().filter(|time_s| begins(**time_s)).map(|&time_s| {
        let next = times_s.iter().copied().find(|other| *other > time_s);
        ReferenceStep {
            scenario: scenario.name.clone(),
            from_n: value(&|other| other < time_s),
            to_n: value(&|other| other <= time_s),
            hold_s: next.unwrap_or(scenario.duration).min(scenario.duration) - time_s,
        }
    });
    let steps = steps.filter(|step| step.from_n != step.to_n);
    steps.max_by(|one, other| one.size_n().abs().total_cmp(&other.size_n().abs()))
}
