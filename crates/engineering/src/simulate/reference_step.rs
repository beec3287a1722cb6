//! The steps of the reference that the scenarios of a project make.

use crate::project::{InputSignal, Project, Scenario};

/// A step of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceStep {
    /// Time, s.
    pub at_s: f64,
    /// Reference before the step, N.
    pub from_n: f64,
    /// Reference after the step, N.
    pub to_n: f64,
}

impl ReferenceStep {
    /// Signed size of the step, N.
    pub fn size_n(&self) -> f64 {
        self.to_n - self.from_n
    }
}

/// All steps of the reference in one scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct SteppedReference {
    /// The name of the scenario.
    pub scenario: String,
    /// Steps in the order of time; at least one.
    pub steps: Vec<ReferenceStep>,
    /// End of the scenario, s.
    pub end_s: f64,
}

/// Steps of the reference in each scenario that has any, whatever else moves; a ramp or a sine is
/// no step, nor is the initial reference of a run that begins at rest.
///
/// # Example
/// ```
/// use phea_project::source::Memory;
/// let source = Memory::default().with("rig.toml", include_str!("../../../../examples/ybitu/hose.toml"));
/// let scenario = r#"scenario=[{ name = "there and back", duration = "3 s", reference = [{ at = "0 s", force = "1 kN" }, { at = "1 s", force = "4 kN" }, { at = "2 s", force = "0 N" }] }]"#;
/// let project = phea_project::read(&source, "rig.toml", &[scenario.to_string()], &[])?.project;
/// let [stepped] = &phea_engineering::simulate::stepped_references(&project)[..] else { panic!() };
/// let [there, back] = stepped.steps[..] else { panic!() };
/// assert_eq!((there.at_s, there.from_n, there.to_n), (1.0, 1000.0, 4000.0));
/// assert_eq!((back.at_s, back.size_n(), stepped.end_s), (2.0, -4000.0, 3.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn stepped_references(project: &Project) -> Vec<SteppedReference> {
    project.scenarios.iter().filter_map(stepped).collect()
}

fn stepped(scenario: &Scenario) -> Option<SteppedReference> {
    if !scenario.command.is_empty() {
        return None;
    }
    let (single, staircases): (Vec<&InputSignal>, Vec<&InputSignal>) =
        scenario.reference.iter().partition(|signal| matches!(signal, InputSignal::Step { .. }));
    // single steps form one staircase
    let mut parts: Vec<Vec<(f64, f64)>> = vec![single.into_iter().flat_map(InputSignal::steps).collect()];
    parts.extend(staircases.into_iter().map(InputSignal::steps));
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
    let steps = times_s.iter().filter(|time_s| begins(**time_s)).map(|&time_s| ReferenceStep {
        at_s: time_s,
        from_n: value(&|other| other < time_s),
        to_n: value(&|other| other <= time_s),
    });
    let steps: Vec<ReferenceStep> = steps.filter(|step| step.from_n != step.to_n).collect();
    let end_s = scenario.duration;
    (!steps.is_empty()).then(|| SteppedReference { scenario: scenario.name.clone(), steps, end_s })
}
