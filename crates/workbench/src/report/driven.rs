//! The scenarios of a project, driven under each controller of the report.

use crate::answer::significant;
use crate::error::CommandError;
use crate::project::Project;
use crate::setup::Setup;
use crate::simulate::{
    Cause, Metric, NamedRun, RunStatus, ScenarioRun, SimulateError, StepLimits, TimeRequirement, Window,
    cause_words, cells_of, concerns, simulate_project, status_words, time_requirements,
};
use crate::source::Source;
use phea_dynamics::watch::{Stopped, Watch};

/// Name of the controller that the project gives.
pub(super) const GIVEN: &str = "given";
/// Name of the designed controller.
pub(super) const DESIGNED: &str = "designed";

/// The runs of the machine in every scenario.
pub(super) struct MachineChapter {
    /// Given and designed controller, if they exist.
    pub(super) sides: Vec<DrivenSide>,
    /// Requirement in time for a step, from the first specification that has one.
    pub(super) required: Option<TimeRequirement>,
}

/// The runs under one controller.
pub(super) struct DrivenSide {
    /// Name of the controller: [`GIVEN`] or [`DESIGNED`].
    pub(super) name: &'static str,
    /// The runs in file order, or the reason why there are none.
    pub(super) runs: Result<Vec<ScenarioRun>, SimulateError>,
}

/// Drives the scenarios under the given controller, and under the `designed` one if there is one;
/// `None` without scenarios.
///
/// # Errors
/// [`CommandError::Stopped`] if the watch stops it, or an error if a requirement in time is
/// invalid.
pub(super) fn driven(
    source: &dyn Source,
    setup: &Setup<'_>,
    designed: Option<&Project>,
    watch: Watch<'_>,
) -> Result<Option<MachineChapter>, CommandError> {
    let project = setup.project;
    if project.scenarios.is_empty() {
        return Ok(None);
    }
    let has_law = project.controller.as_ref().is_some_and(|controller| controller.has_law());
    let given = (has_law || designed.is_none()).then(|| (GIVEN, setup.clone()));
    let designed = designed.map(Setup::new).transpose()?.map(|setup| (DESIGNED, setup));
    let mut sides = Vec::new();
    for (name, setup) in given.into_iter().chain(designed) {
        let runs = simulate_project(source, &setup, watch);
        if runs.iter().flatten().any(ScenarioRun::was_cancelled) {
            return Err(Stopped.into());
        }
        sides.push(DrivenSide { name, runs });
    }
    Ok(Some(MachineChapter { sides, required: time_requirements(project)?.first().copied() }))
}

impl MachineChapter {
    /// Requirement in time for the steps of a scenario; `None` if the scenario has no step to which
    /// it applies.
    pub(super) fn requirement_of(&self, index: usize) -> Option<&StepLimits> {
        self.required_of(index).map(|required| &required.step_limits)
    }

    /// The requirement together with the steps to which it applies.
    pub(super) fn required_of(&self, index: usize) -> Option<&TimeRequirement> {
        let required = self.required.as_ref()?;
        let windows = self.sides.iter().filter_map(|side| run_of(side, index)).flat_map(|run| &run.windows);
        let mut windows = windows.map(|(window, _)| window);
        windows.any(|window| concerns(required, window)).then_some(required)
    }

    /// The runs of a scenario by its index in the file. If a stated command drives the valve, no
    /// controller acts, and there is a single run.
    pub(super) fn of_scenario<'a>(&'a self, index: usize) -> Vec<NamedRun<'a>> {
        let named = |side: &'a DrivenSide| Some(NamedRun { name: side.name, run: run_of(side, index)? });
        let mut named: Vec<NamedRun<'a>> = self.sides.iter().filter_map(named).collect();
        if named.iter().any(|named| named.run.open_loop) {
            named.truncate(1);
        }
        named
    }

    /// The runs of a scenario in the order of the figures that compare both controllers; the first
    /// colour is that of the designed one.
    pub(super) fn drawn(&self, index: usize) -> Vec<NamedRun<'_>> {
        let mut named = self.of_scenario(index);
        named.reverse();
        named
    }

    /// The runs of one controller; `None` if it was not driven.
    pub(super) fn runs_of(&self, name: &str) -> Option<&[ScenarioRun]> {
        let side = self.sides.iter().find(|side| side.name == name)?;
        side.runs.as_deref().ok()
    }

    /// The first reference step and the greatest disturbance by load, force or setting, in a few
    /// words each, of the controller that a reader would take first.
    pub(super) fn facts(&self) -> Vec<(&'static str, String)> {
        let names = [(GIVEN, "Simulated, given controller"), (DESIGNED, "Simulated, designed controller")];
        let fact = |(side, name): (&str, &'static str)| Some((name, fact_words(self.runs_of(side)?)?));
        names.into_iter().filter_map(fact).collect()
    }
}

fn run_of(side: &DrivenSide, index: usize) -> Option<&ScenarioRun> {
    side.runs.as_ref().ok()?.get(index)
}

/// The first step and the greatest disturbance of these runs.
fn fact_words(runs: &[ScenarioRun]) -> Option<String> {
    if let Some((run, stopped)) = runs.iter().find_map(|run| Some((run, run.stopped()?))) {
        let (word, time) = (status_words(stopped.status), significant(stopped.time_s, 3));
        return Some(match stopped.status {
            RunStatus::Diverged => format!("{} diverges from {time} s on", run.name),
            _ => format!("{} ended at {time} s: {word}", run.name),
        });
    }
    let windows = || runs.iter().flat_map(|run| &run.windows);
    let is_step = |window: &Window| matches!(window.cause, Cause::ReferenceStep { .. });
    let units = runs.first()?.record.units;
    let step = windows().find(|(window, _)| is_step(window)).map(|(window, metrics)| {
        let cells = cells_of(metrics, units);
        let settling = match metrics.settling_time_s {
            Ok(_) => format!(
                "settling {} ({} %)",
                cells[Metric::SettlingTime].text(),
                metrics.settling_band_percent
            ),
            Err(_) => cells[Metric::SettlingTime].text(),
        };
        format!("{}: {} overshoot, {settling}", cause_words(window, units), cells[Metric::Overshoot].text())
    });
    let greatest = runs.iter().flat_map(disturbances).max_by(|one, other| one.2.total_cmp(&other.2));
    let disturbed = greatest.map(|(run, window, peak_n)| {
        let peak = run.record.units.force.text(peak_n, 3);
        let is_first = runs.first().is_some_and(|first| first.name == run.name);
        let scenario = if is_first { String::new() } else { format!("{}, ", run.name) };
        format!("{scenario}{}: {peak} of disturbance", cause_words(&window, units))
    });
    let parts: Vec<String> = step.into_iter().chain(disturbed).collect();
    (!parts.is_empty()).then(|| parts.join("; "))
}

/// The disturbances of a run, in N, with their windows.
fn disturbances(run: &ScenarioRun) -> impl Iterator<Item = (&ScenarioRun, Window, f64)> {
    run.windows
        .iter()
        .filter_map(move |(window, metrics)| Some((run, *window, metrics.disturbance_peak_n.ok()?)))
}
