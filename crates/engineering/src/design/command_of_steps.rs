//! The command that the steps of the scenarios take, held against what the valve has.
//!
//! ```text
//! u(t) = u_0 + (r_1 - r_0) w(t),   w the unit step through F G/(1 + L)         |u(t)| <= share U_n
//! ```
//!
//! u_0 is the command of the operating point. The loop is linear, so that the largest step which
//! the valve does follows from w.

use phea_qft::closed_loop::Member;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::verification::{PlantPoint, Verdict};

use super::ProjectDesign;
use super::by_steps::SteppedPlants;
use super::deployable::limit_value;
use crate::audit::{VisitedPlant, visited, worst_beside};
use crate::limit_kind::DesignLimitKind;
use crate::linear_step::{KnownResponses, StepResponse, StepSignal, linear_step_knowing};
use crate::setup::Setup;
use crate::simulate::{ReferenceStep, largest_reference_steps};

/// Points of a continuous response, over the whole of it and over its first part.
const POINTS: usize = 1000;
/// The first part of a continuous response, which has as many points by itself.
const SOON: f64 = 0.1;
/// Duration of a step, in settling times that are required, where one is.
const SETTLING_TIMES: f64 = 10.0;
/// Plants from which the search begins, and most plants that it visits.
const STARTS: usize = 3;
const VISITED_MAXIMUM: usize = 400;
/// Fraction of the limit by which a command may be beyond it: a computed response is no more
/// accurate.
const ACCURACY: f64 = 1e-3;

/// The largest command that the steps of the scenarios take: evidence of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandOfSteps {
    /// The step that takes most of the limit.
    pub step: ReferenceStep,
    /// The largest magnitude of the command in it, V.
    pub largest_v: f64,
    /// The largest that is left at the end of a step: what holds the force, which no controller
    /// changes, V.
    pub at_rest_v: f64,
    /// Most that it may be, V.
    pub limit_v: f64,
    /// The largest step of that sign that keeps the limit, N.
    pub largest_step_n: f64,
    /// How many plants were visited.
    pub plants: usize,
    /// The plant with the largest command.
    pub plant: PlantPoint,
}

impl CommandOfSteps {
    /// True where the command keeps its limit.
    pub fn is_kept(&self) -> bool {
        self.largest_v <= (1.0 + ACCURACY) * self.limit_v
    }

    /// True where the command that holds the force is beyond the limit, whatever the controller.
    pub fn is_out_of_reach(&self) -> bool {
        self.at_rest_v > (1.0 + ACCURACY) * self.limit_v
    }

    /// The ratio of the command to its limit.
    pub(super) fn ratio(&self) -> f64 {
        self.largest_v / self.limit_v
    }
}

impl ProjectDesign {
    /// The command of the scenarios' steps, where it is more than the valve may take.
    pub fn exceeded_command(&self) -> Option<&CommandOfSteps> {
        self.command_of_steps.as_ref().filter(|command| !command.is_kept())
    }
}

/// The steps of the scenarios, and what limits their commands.
#[derive(Clone, Debug)]
pub(super) struct ScenarioSteps {
    steps: Vec<ReferenceStep>,
    /// Command of the operating point, V.
    initial_v: f64,
    /// Most that a command may be, V.
    pub(super) limit_v: f64,
    /// How long a step is followed, s.
    pub(super) duration_s: f64,
}

/// The command of a unit step of one plant.
#[derive(Clone, Debug)]
struct CommandRange {
    values: Vec<f64>,
    /// Least and greatest, V/N, zero among them.
    range: [f64; 2],
    /// At the end, V/N.
    last: f64,
}

/// A search for the plant whose steps take the largest command.
struct CommandSearch<'a> {
    told: &'a ProjectDesign,
    family: &'a UncertainFamily,
    plants: &'a SteppedPlants,
    of: ScenarioSteps,
    visited: Vec<CommandRange>,
}

/// Where a search for the largest command looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CommandDepth {
    /// At the members, the corners and the worst plants of the audit.
    KnownPlants,
    /// Between them too.
    Whole,
}

/// The largest command of the scenarios' steps under a design; `None` where they have no step,
/// nothing limits it, or a response is not known.
pub(super) fn command_of_steps(
    setup: &Setup<'_>,
    told: &ProjectDesign,
    plants: &SteppedPlants,
    depth: CommandDepth,
) -> Option<CommandOfSteps> {
    let of = ScenarioSteps::of(setup, told)?;
    let Family::Uncertain(family) = &told.designed.problem.family else { return None };
    if told.designed.view.audit.stability.verdict != Verdict::Met {
        return None;
    }
    let mut search = CommandSearch { told, family, plants, of, visited: vec![] };
    for values in visited(family, &told.designed.view.audit) {
        search.visit(&values)?;
    }
    let is_whole = depth == CommandDepth::Whole && family.extent() == Extent::Box;
    if is_whole && family.plant().is_rational() {
        search.between()?;
    }
    search.worst()
}

impl ScenarioSteps {
    /// Those of a project; `None` where nothing limits their command.
    pub(super) fn of(setup: &Setup<'_>, told: &ProjectDesign) -> Option<ScenarioSteps> {
        let share = limit_value(&told.limits, DesignLimitKind::CommandOfSteps)?;
        let rig = setup.rig().ok()?;
        let steps = largest_reference_steps(setup.project);
        let hold_s = steps.iter().map(|step| step.hold_s).fold(0.0, f64::max);
        let required = told.designed.problem.in_time.iter().map(|one| SETTLING_TIMES * one.wish.horizon_s);
        Some(ScenarioSteps {
            steps,
            initial_v: rig.point.command,
            limit_v: share * rig.actuator.components().valve.nominal_voltage,
            duration_s: required.reduce(f64::max).unwrap_or(f64::INFINITY).min(hold_s),
        })
    }

    /// The largest magnitude of the command in any step, of this command in a unit step, V.
    pub(super) fn largest_v(&self, unit: &StepResponse) -> f64 {
        self.largest_in(range(unit))
    }

    fn largest_in(&self, range: [f64; 2]) -> f64 {
        self.steps.iter().map(|step| self.in_step(step, range)).fold(0.0, f64::max)
    }

    fn in_step(&self, step: &ReferenceStep, range: [f64; 2]) -> f64 {
        range.map(|one| (self.initial_v + step.size_n() * one).abs()).into_iter().fold(0.0, f64::max)
    }
}

/// Least and greatest value of a response, zero among them.
fn range(response: &StepResponse) -> [f64; 2] {
    response.values.iter().fold([0.0_f64; 2], |[low, high], one| [low.min(*one), high.max(*one)])
}

impl CommandSearch<'_> {
    /// The command of a unit step; `None` where it cannot be computed.
    fn command(&self, values: &[f64]) -> Option<CommandRange> {
        let compensation = &self.told.designed.problem.compensation;
        let of = |response: &StepResponse, range: [f64; 2]| CommandRange {
            values: values.to_vec(),
            range,
            last: response.values.last().copied().unwrap_or(0.0),
        };
        if !self.family.plant().is_rational() {
            let plant = self.plants.plant(values, (self.family, compensation)).ok()?;
            let found = plant.command(compensation, (self.of.duration_s, POINTS))?;
            return Some(of(&found, range(&found)));
        }
        let member = compensation.member_of(self.family.plant(), values).ok()?;
        let within = |duration_s: f64| {
            let known = KnownResponses::default();
            let of = (&member, StepSignal::Command);
            linear_step_knowing(of, compensation, (duration_s, POINTS), &known).ok()
        };
        let found = within(self.of.duration_s)?;
        let [low, high] = range(&found);
        if !matches!(member, Member::Continuous { .. }) {
            return Some(of(&found, [low, high]));
        }
        let soon = range(&within(SOON * self.of.duration_s)?);
        Some(of(&found, [low.min(soon[0]), high.max(soon[1])]))
    }

    /// The largest magnitude of the command in any step, V.
    fn visit(&mut self, values: &[f64]) -> Option<f64> {
        let known = self.visited.iter().find(|known| known.values == values);
        let range = match known {
            Some(known) => known.range,
            None => {
                let found = self.command(values)?;
                let range = found.range;
                self.visited.push(found);
                range
            }
        };
        Some(self.of.largest_in(range))
    }

    /// Follows the worst plants to worse ones between the members.
    fn between(&mut self) -> Option<()> {
        let mut sorted: Vec<(f64, Vec<f64>)> = Vec::new();
        for known in self.visited.clone() {
            sorted.push((self.visit(&known.values)?, known.values));
        }
        sorted.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        let family = self.family;
        for (_, start) in sorted.into_iter().take(STARTS) {
            worst_beside(family, start, |values| {
                let value = self.visit(values).ok_or(())?;
                Ok::<_, ()>(VisitedPlant { value, is_last: self.visited.len() >= VISITED_MAXIMUM })
            })
            .ok()?;
        }
        Some(())
    }

    /// The step and the plant with the largest command.
    fn worst(&self) -> Option<CommandOfSteps> {
        let ScenarioSteps { steps, initial_v, limit_v, .. } = &self.of;
        let each = steps.iter().flat_map(|step| self.visited.iter().map(move |plant| (step, plant)));
        let largest = each.map(|(step, plant)| (self.of.in_step(step, plant.range), step, plant));
        let (largest_v, step, plant) = largest.max_by(|one, other| one.0.total_cmp(&other.0))?;
        let direction = step.size_n().signum();
        let room = |rate: f64| (limit_v - initial_v * rate.signum()) / rate.abs();
        let rates = self.visited.iter().flat_map(|plant| plant.range).map(|rate| direction * rate);
        let most = rates.filter(|rate| *rate != 0.0).map(room).fold(f64::INFINITY, f64::min);
        let at_rest = self.visited.iter().map(|plant| self.of.largest_in([plant.last; 2]));
        Some(CommandOfSteps {
            step: step.clone(),
            largest_v,
            at_rest_v: at_rest.fold(0.0, f64::max),
            limit_v: *limit_v,
            largest_step_n: direction * most.max(0.0),
            plants: self.visited.len(),
            plant: PlantPoint::Parameters(plant.values.clone()),
        })
    }
}
