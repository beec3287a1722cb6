//! Command in the steps of the scenarios, compared with the range of the valve.
//!
//! ```text
//! u(t) = u_0 + sum of (r_k - r_(k-1)) w(t - t_k),   w the unit step through F G/(1 + L)         |u(t)| <= limit
//! ```
//!
//! The sum is over the steps of one scenario, with r_k the reference from t_k on, and u_0 the
//! command that holds a plant at its initial reference r_0. The loop is linear, so that the largest
//! step within the range of the valve follows from w as well.

mod scenario_steps;

use phea_dynamics::watch::{Stopped, Watch, report_progress};
use phea_qft::closed_loop::Member;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::verification::{PlantPoint, Verdict};

use self::scenario_steps::CommandedSteps;
pub(super) use self::scenario_steps::ScenarioSteps;
use super::by_steps::SteppedPlants;
use super::{DesignError, DesignPart, ProjectDesign, unless_stopped};
use crate::audit::{VisitedPlant, visited, worst_additional};
use crate::linear_step::{KnownResponses, StepResponse, StepSignal, linear_step_knowing};
use crate::setup::Setup;
use crate::simulate::{ForceLimit, ForceLimits, ReferenceStep};

/// Name of the stage.
const STAGE: &str = "command of steps";
/// Number of points of a continuous response, over the whole of it and over its first part.
const POINTS: usize = 1000;
/// First part of a continuous response, which has as many points.
const SOON: f64 = 0.1;
/// Number of plants from which the search begins, and largest number of plants that it visits.
const STARTS: usize = 3;
const VISITED_MAXIMUM: usize = 400;
/// Fraction of the limit by which a command may exceed it: a computed response is no more accurate.
const ACCURACY: f64 = 1e-3;

/// Largest command in the steps of the scenarios: evidence of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandOfSteps {
    /// Name of the scenario whose command takes most of the limit.
    pub scenario: String,
    /// Step after which this command occurs.
    pub step: ReferenceStep,
    /// Time in the scenario, s.
    pub at_s: f64,
    /// Largest magnitude of the command, V.
    pub largest_v: f64,
    /// Largest magnitude that remains between steps once the loop has settled, V: the command that
    /// holds the force, which no controller changes.
    pub at_rest_v: f64,
    /// Limit of the command, V.
    pub limit_v: f64,
    /// Largest single step of that sign, from the initial reference of this one at rest, that
    /// satisfies the limit and that supply and sensor permit, N.
    pub largest_step_n: f64,
    /// Limit that prevents a larger step.
    pub step_limit: StepLimit,
    /// Number of plants that were visited.
    pub plants: usize,
    /// Plant with the largest command.
    pub plant: PlantPoint,
    /// Indices of its parameters that affect the largest command; the others may have any value.
    pub moved_by: Vec<usize>,
}

/// Limit that prevents a larger step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepLimit {
    /// The command of the valve.
    Command,
    /// A force that the rig does not reach, or that its sensor does not withstand.
    Force(ForceLimit),
}

impl CommandOfSteps {
    /// True if the command satisfies its limit.
    pub fn is_satisfied(&self) -> bool {
        self.largest_v <= (1.0 + ACCURACY) * self.limit_v
    }

    /// True if the command that holds the force is beyond the limit, whatever the controller.
    pub fn is_out_of_reach(&self) -> bool {
        self.at_rest_v > (1.0 + ACCURACY) * self.limit_v
    }

    /// True if the largest command is the one that holds a force, without a higher peak before.
    pub fn is_at_rest(&self) -> bool {
        self.largest_v <= (1.0 + ACCURACY) * self.at_rest_v
    }

    /// Ratio of the command to its limit.
    pub(super) fn ratio(&self) -> f64 {
        self.largest_v / self.limit_v
    }
}

impl ProjectDesign {
    /// Command of the scenarios' steps, if it is larger than the valve permits.
    pub fn exceeded_command(&self) -> Option<&CommandOfSteps> {
        self.command_of_steps.as_ref().filter(|command| !command.is_satisfied())
    }
}

/// Command of a unit step of one plant, V/N, and the largest in any scenario, V.
#[derive(Clone, Debug)]
struct UnitCommand {
    values: Vec<f64>,
    unit: StepResponse,
    /// Command that holds 1 N, V/N.
    held_v_per_n: f64,
    largest_v: f64,
}

/// Search for the plant whose steps need the largest command.
struct CommandSearch<'a> {
    project_design: &'a ProjectDesign,
    family: &'a UncertainFamily,
    plants: &'a SteppedPlants,
    of: ScenarioSteps,
    visited: Vec<UnitCommand>,
    watch: Watch<'a>,
    /// True if `watch` cancelled the search.
    is_stopped: bool,
}

/// Range of a search for the largest command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CommandDepth {
    /// Members, corners and worst plants of the audit.
    KnownPlants,
    /// The box between them too.
    Whole,
}

/// Largest command of the scenarios' steps under a design; `None` if they have no step, nothing
/// limits it, or a response is not known.
///
/// # Errors
/// [`Stopped`] if `watch` cancels it.
pub(super) fn command_of_steps(
    (setup, project_design): (&Setup<'_>, &ProjectDesign),
    plants: &SteppedPlants,
    depth: CommandDepth,
    watch: Watch<'_>,
) -> Result<Option<CommandOfSteps>, Stopped> {
    let (Some(of), Family::Uncertain(family)) =
        (ScenarioSteps::of(setup, project_design), &project_design.designed.problem.family)
    else {
        return Ok(None);
    };
    if of.is_empty() || project_design.designed.view.audit.stability.verdict != Verdict::Met {
        return Ok(None);
    }
    let mut search =
        CommandSearch { project_design, family, plants, of, visited: vec![], watch, is_stopped: false };
    let found = search.found(setup, depth);
    if search.is_stopped { Err(Stopped) } else { Ok(found) }
}

/// A design with the largest command of the scenarios' steps over its whole family; recorded as
/// unfinished if `watch` cancels.
///
/// # Errors
/// None at present: a cancelled search is recorded in the result.
pub(super) fn with_command_of_steps(
    (setup, project_design): (&Setup<'_>, ProjectDesign),
    plants: &SteppedPlants,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    let mut unfinished = project_design.unfinished.clone();
    let command_of_steps =
        match ScenarioSteps::of(setup, &project_design).is_some_and(|steps| !steps.is_empty()) {
            true => unless_stopped(&mut unfinished, DesignPart::CommandOfSteps, || {
                Ok(command_of_steps((setup, &project_design), plants, CommandDepth::Whole, watch)?)
            })?,
            false => None,
        };
    Ok(ProjectDesign { unfinished, command_of_steps, ..project_design })
}

impl CommandSearch<'_> {
    /// Largest command; `None` if a response is not known, and after cancellation.
    fn found(&mut self, setup: &Setup<'_>, depth: CommandDepth) -> Option<CommandOfSteps> {
        let family = self.family;
        if let Some(nominal_v_per_n) = self.held_v_per_n(&family.plant().nominal()) {
            self.of.beginning_at_each_plant(nominal_v_per_n);
        }
        for values in visited(family, &self.project_design.designed.view.audit) {
            self.visit(&values)?;
        }
        let is_whole = depth == CommandDepth::Whole && family.extent() == Extent::Box;
        if is_whole && family.plant().is_rational() {
            self.between()?;
        }
        let found = self.worst(setup)?;
        let moved_by = match is_whole {
            true => self.moved_by(&found)?,
            // a listed member has no neighbouring plants
            false => (0..family.plant().parameters().len()).collect(),
        };
        Some(CommandOfSteps { moved_by, ..found })
    }

    /// Command of a unit step; `None` if it cannot be computed.
    fn command(&mut self, values: &[f64]) -> Option<StepResponse> {
        let project_design = report_progress(self.watch, STAGE, self.visited.len(), VISITED_MAXIMUM);
        self.is_stopped |= project_design.is_err();
        project_design.ok()?;
        let compensation = &self.project_design.designed.problem.compensation;
        if !self.family.plant().is_rational() {
            let plant = self.plants.plant(values, (self.family, compensation)).ok()?;
            return plant.command(compensation, (self.of.duration_s, POINTS));
        }
        let member = compensation.member_of(self.family.plant(), values).ok()?;
        let within = |duration_s: f64| {
            let known = KnownResponses::default();
            let of = (&member, StepSignal::Command);
            linear_step_knowing(of, compensation, (duration_s, POINTS), &known).ok()
        };
        let whole = within(self.of.duration_s)?;
        if !matches!(member, Member::Continuous { .. }) {
            return Some(whole);
        }
        let StepResponse { mut times_s, mut values } = within(SOON * self.of.duration_s)?;
        let soon_s = times_s.last().copied().unwrap_or(0.0);
        let later = whole.times_s.into_iter().zip(whole.values).filter(|(time_s, _)| *time_s > soon_s);
        for (time_s, value) in later {
            times_s.push(time_s);
            values.push(value);
        }
        Some(StepResponse { times_s, values })
    }

    /// Largest magnitude of the command in any scenario, V.
    fn visit(&mut self, values: &[f64]) -> Option<f64> {
        if let Some(known) = self.visited.iter().find(|known| known.values == values) {
            return Some(known.largest_v);
        }
        let command = self.unit_command(values)?;
        let largest_v = command.largest_v;
        self.visited.push(command);
        Some(largest_v)
    }

    fn unit_command(&mut self, values: &[f64]) -> Option<UnitCommand> {
        let unit = self.command(values)?;
        let last = unit.values.last().copied().unwrap_or(0.0);
        let held_v_per_n = self.held_v_per_n(values).unwrap_or(last);
        let largest_v = self.of.largest_held_v(&unit, held_v_per_n);
        Some(UnitCommand { values: values.to_vec(), unit, held_v_per_n, largest_v })
    }

    /// Command that holds 1 N at a plant in a loop with an integrator, F(0)/P(0), V/N; `None` for
    /// any other loop.
    fn held_v_per_n(&self, values: &[f64]) -> Option<f64> {
        let compensation = &self.project_design.designed.problem.compensation;
        let command = self.family.plant().member(values)?.slow().command.transfer_function().ok()?;
        let held = compensation.prefilter().dc_gain() / command.dc_gain();
        Some(held).filter(|held| held.is_finite() && compensation.feedback().dc_gain().is_infinite())
    }

    /// Follows the worst plants to worse ones between the members.
    fn between(&mut self) -> Option<()> {
        let mut sorted: Vec<(f64, Vec<f64>)> =
            self.visited.iter().map(|known| (known.largest_v, known.values.clone())).collect();
        sorted.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        let family = self.family;
        for (_, start) in sorted.into_iter().take(STARTS) {
            worst_additional(family, start, |values| {
                let value = self.visit(values).ok_or(())?;
                Ok::<_, ()>(VisitedPlant { value, is_last: self.visited.len() >= VISITED_MAXIMUM })
            })
            .ok()?;
        }
        Some(())
    }

    /// The scenario, the step and the plant with the largest command.
    fn worst(&self, setup: &Setup<'_>) -> Option<CommandOfSteps> {
        let plant = self.visited.iter().max_by(|one, other| one.largest_v.total_cmp(&other.largest_v))?;
        let peaks = self.of.peaks(&plant.unit, plant.held_v_per_n);
        let (scenario, peak) = peaks.max_by(|(_, one), (_, other)| one.value_v.total_cmp(&other.value_v))?;
        let (largest_step_n, step_limit) = self.largest_step(setup, scenario, &peak.step);
        let at_rest = self.visited.iter().map(|plant| self.of.at_rest_v(plant.held_v_per_n));
        Some(CommandOfSteps {
            scenario: scenario.reference.scenario.clone(),
            step: peak.step,
            at_s: peak.at_s,
            largest_v: peak.value_v,
            at_rest_v: at_rest.fold(0.0, f64::max),
            limit_v: self.of.limit_v,
            largest_step_n,
            step_limit,
            plants: self.visited.len(),
            plant: PlantPoint::Parameters(plant.values.clone()),
            moved_by: vec![],
        })
    }

    /// Largest step in the direction of this one, from its initial reference at rest, that
    /// satisfies the limit at every plant visited, and that supply and sensor permit, N, with its
    /// limit.
    fn largest_step(
        &self,
        setup: &Setup<'_>,
        scenario: &CommandedSteps,
        step: &ReferenceStep,
    ) -> (f64, StepLimit) {
        let direction = step.size_n().signum();
        let room = |plant: &UnitCommand| {
            let resting_v = scenario.resting_v(step, plant.held_v_per_n);
            let of = |value: &f64| {
                let rate = direction * value;
                if rate == 0.0 {
                    return f64::INFINITY;
                }
                (self.of.limit_v - resting_v * rate.signum()) / rate.abs()
            };
            plant.unit.values.iter().map(of).fold(f64::INFINITY, f64::min)
        };
        let by_command = self.visited.iter().map(room).fold(f64::INFINITY, f64::min).max(0.0);
        let limits = setup.project.actuator.as_ref().map(|actuator| ForceLimits::of(setup.project, actuator));
        let by_force = limits.map(|limits| limits.greatest(direction)).map(|(force_n, limit)| {
            let room_n = (direction * (force_n - step.from_n)).max(0.0);
            (room_n, StepLimit::Force(limit))
        });
        let (size_n, limit) = match by_force.filter(|(room_n, _)| *room_n < by_command) {
            Some(found) => found,
            None => (by_command, StepLimit::Command),
        };
        (direction * size_n, limit)
    }

    /// Parameters of the worst plant that affect the largest command at an end of their range, the
    /// others unchanged; `None` if a command cannot be computed.
    fn moved_by(&mut self, found: &CommandOfSteps) -> Option<Vec<usize>> {
        let PlantPoint::Parameters(values) = &found.plant else { return Some(vec![]) };
        let mut moved_by = Vec::new();
        for (index, coordinate) in self.family.coordinates().iter().enumerate() {
            for end in [0.0, 1.0] {
                let mut fractions = self.family.fractions(values);
                *fractions.get_mut(index)? = end;
                let moved = self.family.values(&fractions);
                let known = self.visited.iter().find(|known| known.values == moved);
                let largest_v = match known.map(|known| known.largest_v) {
                    Some(known_v) => known_v,
                    None => self.unit_command(&moved)?.largest_v,
                };
                if (largest_v - found.largest_v).abs() > ACCURACY * found.largest_v {
                    moved_by.extend(&coordinate.parameters);
                    break;
                }
            }
        }
        moved_by.sort_unstable();
        Some(moved_by)
    }
}
