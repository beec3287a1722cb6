//! Search of a design that was led by its steps, with one of its limits wider.

use phea_qft::loop_shaping::{Aim, Structure};
use phea_qft::specification::Specification;

use super::shaping::{AimedStepLimits, RESERVE_DB, StepShaping};
use super::{AimedSteps, DesignError, led, with_rig};
use crate::design::command_of_steps::ScenarioSteps;
use crate::design::{DesignRun, ProjectDesign};
use crate::setup::Setup;

/// Last search of a design that was led by its steps, and its aim.
pub(in crate::design) type LastStepSearch<'a> = (StepShaping<'a>, (Aim, f64));

/// Search in which a design was led by its steps, with its worst plants; `None` if it was not led.
pub(in crate::design) fn last_step_search<'a>(
    setup: &'a Setup<'_>,
    aimed: AimedSteps<'a>,
    (run, project_design): (&DesignRun, &ProjectDesign),
) -> Result<Option<LastStepSearch<'a>>, DesignError> {
    let (Some(search), Some(led)) = (&run.led, led(setup, aimed, (run, project_design))?) else {
        return Ok(None);
    };
    let linear = search.room.of(aimed.aim.step_limits(led.required));
    let aimed_limits = AimedStepLimits { linear, with_rig: with_rig(led.required) };
    let added = (aimed_limits, aimed.added.to_vec());
    let search = StepShaping::new(search.shaping.clone(), added, led.problem.sensor.clone(), aimed.plants);
    let mut search = search.with_commands(ScenarioSteps::of(setup, project_design));
    search.take_worst(&project_design.design)?;
    search.take_steps(project_design)?;
    let aim = if project_design.is_met() { Aim::Objective } else { Aim::WorstMargin };
    Ok(Some((search, (aim, RESERVE_DB))))
}

impl<'a> StepShaping<'a> {
    /// The search with its plants judged by other limits, and with this multiple of the permitted
    /// steps and commands.
    pub(in crate::design) fn with_limits(
        &self,
        structure: Structure,
        limits: (Vec<Specification>, f64),
        [steps, command]: [f64; 2],
    ) -> StepShaping<'a> {
        let mut wider = self.clone();
        wider.shaping = self.shaping.with_limits(structure, limits);
        wider.allow_commands(command);
        wider.with_step_limits(|step_limits| step_limits.wider(steps))
    }
}
