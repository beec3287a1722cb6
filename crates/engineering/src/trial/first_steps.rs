//! Steps through which a machine is simulated before the largest: those with requirements in time.
//!
//! ```text
//! a requirement that states its step                       -> that step
//! a requirement of every step, or none                     -> a tenth of the force of the supply
//! a requirement of every step                              -> that step reversed, and the steps of the scenarios
//! ```

use super::run::{Leg, StepSize};
use super::steps::{HeldLegs, Steps};
use crate::project::Project;
use crate::rig::Rig;
use crate::simulate::{RequiredSteps, TimeRequirement, stepped_references};

/// Largest number of steps of scenarios through which a machine is simulated, the largest of them.
pub const MOST_OF_SCENARIOS: usize = 3;

/// Steps to which the requirements in time of a project apply.
#[derive(Clone, Debug)]
pub(super) struct RequiredOfSteps {
    /// Stated steps, each once.
    stated: Vec<RequiredSteps>,
    /// True if a requirement that is part of the verdict applies to every step.
    pub(super) of_every_step: bool,
    /// Longest required settling or rise time, s; zero if none is required.
    pub(super) longest_s: f64,
}

/// Steps through which a machine is simulated, and their kind.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstSteps {
    pub(super) size: StepSize,
    /// Size and initial force that a requirement states for them.
    pub(super) required: RequiredSteps,
    pub(super) steps: Steps,
}

impl RequiredOfSteps {
    pub(super) fn of(requirements: &[TimeRequirement]) -> RequiredOfSteps {
        let mut stated: Vec<RequiredSteps> = Vec::new();
        for one in requirements.iter().filter(|one| one.steps.are_stated()) {
            if !stated.contains(&one.steps) {
                stated.push(one.steps);
            }
        }
        let of_every_step = requirements.iter().any(|one| one.follows && !one.steps.are_stated());
        let step_limits = requirements.iter().filter(|one| one.follows).map(|one| one.step_limits);
        let times_s = step_limits
            .flat_map(|step_limits| [step_limits.settling_time_s, step_limits.rise_time_s])
            .flatten();
        RequiredOfSteps { stated, of_every_step, longest_s: times_s.fold(0.0, f64::max) }
    }

    /// Steps of a machine.
    pub(super) fn first_steps(&self, (project, rig): (&Project, &Rig), legs: HeldLegs) -> Vec<FirstSteps> {
        self.wanted((project, rig), legs).0
    }

    /// Smaller steps of the scenarios, which are not simulated, from and to, N.
    pub(super) fn left_out(&self, (project, rig): (&Project, &Rig)) -> Vec<[f64; 2]> {
        let held_anyhow = HeldLegs { hold_s: 0.0, last: Leg::There };
        let left = self.wanted((project, rig), held_anyhow).1;
        left.into_iter().map(|steps| [steps.from_n, steps.to_n]).collect()
    }

    /// Steps of a machine, and those of the scenarios that are omitted.
    fn wanted(&self, (project, rig): (&Project, &Rig), legs: HeldLegs) -> (Vec<FirstSteps>, Vec<Steps>) {
        let (mut all, mut left): (Vec<FirstSteps>, Vec<Steps>) = (Vec::new(), Vec::new());
        for &required in &self.stated {
            let steps = Steps::first(rig, required, legs);
            let of = |steps| FirstSteps { size: StepSize::Required, required, steps };
            all.push(of(steps));
            all.extend(steps.reversed(rig).filter(|_| required.amplitude_n.is_none()).map(of));
        }
        let of = |size, steps| FirstSteps { size, required: RequiredSteps::default(), steps };
        let tenth = Steps::first(rig, RequiredSteps::default(), legs);
        if self.stated.is_empty() || self.of_every_step {
            all.push(of(StepSize::Tenth, tenth));
        }
        if self.of_every_step {
            all.extend(tenth.reversed(rig).map(|steps| of(StepSize::Reversed, steps)));
            let mut scenarios = of_scenarios(project, &all, legs);
            left = scenarios.split_off(MOST_OF_SCENARIOS.min(scenarios.len()));
            all.extend(scenarios.into_iter().map(|steps| of(StepSize::Scenario, steps)));
        }
        (all, left)
    }
}

/// Steps of the scenarios that are not simulated already, the largest first.
fn of_scenarios(project: &Project, driven: &[FirstSteps], legs: HeldLegs) -> Vec<Steps> {
    let mut found: Vec<Steps> = Vec::new();
    for step in stepped_references(project).into_iter().flat_map(|stepped| stepped.steps) {
        let mut known = driven.iter().map(|one| &one.steps).chain(&found);
        if !known.any(|steps| steps.are_between(step.from_n, step.to_n)) {
            found.push(Steps { from_n: step.from_n, to_n: step.to_n, legs });
        }
    }
    found.sort_by(|one, other| other.size().total_cmp(&one.size()));
    found
}
