//! A design stepped by its owner.

use std::collections::VecDeque;

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::UncertainPlant;

use super::attempt::{Attempt, Beginning, DesignError, Ending, FEASIBLE_DB};
use super::binding::{all_conflicts, binding_limits};
use super::candidates::Ground;
use super::diagnosis::{Finding, Severity, diagnose};
use super::problem::{ControllerChoice, DesignOptions, DesignProblem};
use super::result::{Design, DesignRound, DesignStatus, Relaxation};
use super::stabilising::has_poles_to_move;
use crate::family::{Extent, Family, random};
use crate::loop_shaping::{Samples, Structure, search_frequencies};
use crate::sampled::SampledPlants;
use crate::verification::{Audit, PlantPoint, corners};

/// Points of the frequency grid of a search in a decade.
const POINTS_PER_DECADE: f64 = 20.0;
/// Random plants inside the box that a search begins with.
const INTERIOR_PLANTS: usize = 32;
/// Members of a family without a box that a search begins with.
const MEMBERS_MAXIMUM: usize = 200;

/// What is added to the seed where a structure is tried once more.
const SEED_AGAIN: u64 = 1000;
/// A larger order is worth its poles where it lowers the relaxation by more than this, dB.
const RELAXATION_GAINED_DB: f64 = 0.01;

/// What is tried after what.
#[derive(Clone, Debug)]
struct Plan {
    ground: Ground,
    /// (order, zeros) that are still to be tried.
    waiting: VecDeque<(usize, usize)>,
    all: usize,
    /// Whether plants have poles that the loop has to move: every structure is tried twice, for a search may miss what is there.
    is_hard: bool,
    /// The structure that was tried last.
    last: Option<Structure>,
    /// Whether a controller was found already, and fewer zeros are tried in its order.
    found: bool,
    /// Whether what was thought infeasible was begun anew.
    again: bool,
}

/// A design stepped by its owner, who may show its progress or stop it at any step.
#[derive(Clone, Debug)]
pub struct DesignRun {
    problem: DesignProblem,
    options: DesignOptions,
    findings: Vec<Finding>,
    plan: Plan,
    attempt: Option<Attempt>,
    samples: Option<Samples>,
    /// The attempt that came nearest, with its worst margin over rate.
    nearest: Option<(f64, Structure, Option<TransferFunction>)>,
    /// The controller of the attempt before.
    before: Option<TransferFunction>,
    relaxing: bool,
    /// The last attempt that found nothing stable.
    unstable: Option<Attempt>,
    /// What is begun anew, from this controller.
    again: Option<(Structure, Option<TransferFunction>)>,
    rounds: Vec<DesignRound>,
    /// The plants that the audits sampled so far.
    sampled: SampledPlants,
    design: Option<Design>,
    done: bool,
}

impl DesignRun {
    /// A design that has not begun.
    pub fn new(problem: DesignProblem, options: DesignOptions) -> DesignRun {
        let ground = Ground::new(&problem);
        let is_hard = has_poles_to_move(&problem);
        let waiting: VecDeque<(usize, usize)> = match options.controller {
            ControllerChoice::Given(_) => VecDeque::from([(0, 0)]),
            ControllerChoice::Grow { maximum_order } => {
                let sampled = problem.timing.sample_time_s.is_some();
                let orders = ground.integrators..=maximum_order;
                let usual = orders.clone().flat_map(|order| degrees(order, ground.integrators, sampled));
                let biproper = orders.filter(|order| !sampled && is_worth_as_many_zeros(*order, &ground));
                let each = usual.chain(biproper.map(|order| (order, order)));
                each.flat_map(|degrees| std::iter::repeat_n(degrees, if is_hard { 2 } else { 1 })).collect()
            }
        };
        // where no controller of any order will do, what is left is by how much
        let findings = diagnose(&problem);
        let impossible = findings.iter().any(|finding| finding.severity() == Severity::Impossible);
        DesignRun {
            plan: Plan {
                ground,
                all: waiting.len(),
                waiting,
                is_hard,
                last: None,
                found: false,
                again: false,
            },
            problem,
            options,
            findings,
            attempt: None,
            samples: None,
            nearest: None,
            before: None,
            relaxing: impossible,
            unstable: None,
            again: None,
            rounds: vec![],
            sampled: SampledPlants::default(),
            design: None,
            done: false,
        }
    }

    /// A design that goes on from one that has ended, with one more plant that its loop must serve: of this the nominal one. What did not do
    /// without the plant does not do with it, so that structures of the order that was found come first, and what was looked at is known.
    ///
    /// # Errors
    /// [`DesignError`] for a plant that does not fit the loop.
    pub fn taking_in(self, plant: UncertainPlant) -> Result<DesignRun, DesignError> {
        let mut problem = self.problem.clone();
        problem.beside.push(plant.clone());
        let mut next = DesignRun::new(problem, self.options);
        next.sampled = self.sampled;
        next.rounds = self.rounds;
        if let Some(mut samples) = self.samples {
            samples.take_in(plant)?;
            next.samples = Some(samples);
        }
        if let Some(found) = self.design {
            if let ControllerChoice::Grow { .. } = next.options.controller {
                let order = found.structure.roots(-1.0);
                next.plan.waiting.retain(|(own, _)| *own >= order);
            }
            next.plan.all = next.plan.waiting.len();
            next.before = found.law.feedback.transfer_function().ok();
        }
        Ok(next)
    }

    /// What it works on.
    pub fn problem(&self) -> &DesignProblem {
        &self.problem
    }

    /// How it works.
    pub fn options(&self) -> &DesignOptions {
        &self.options
    }

    /// What no controller can do, and what will be hard; see [`diagnose`].
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Does a small part of the work; whether there is more to do.
    ///
    /// # Errors
    /// [`DesignError`] where a part of the problem is no transfer function, or cannot be put into the loop.
    pub fn step(&mut self) -> Result<bool, DesignError> {
        if self.done {
            return Ok(false);
        }
        match &mut self.attempt {
            None => self.begin()?,
            Some(attempt) => {
                if !attempt.step()? {
                    self.end_attempt()?;
                }
            }
        }
        Ok(!self.done)
    }

    /// Ends it as it stands: where no design is there yet, the controller at hand is audited and becomes one that is not converged.
    ///
    /// # Errors
    /// Those of [`DesignRun::step`].
    pub fn conclude(&mut self) -> Result<(), DesignError> {
        let attempt = self.attempt.take().filter(|attempt| !attempt.x().is_empty());
        if let (None, Some(attempt)) = (&self.design, attempt) {
            let mut attempt = attempt.audited_as_it_is()?;
            while attempt.step()? {}
            if let Some(Ending::Hopeless(audit)) = attempt.ending() {
                let status = DesignStatus::NotConverged { rounds: attempt.rounds().len() };
                self.rounds.extend_from_slice(attempt.rounds());
                self.take(&attempt, status, audit)?;
            }
        }
        self.done = true;
        Ok(())
    }

    /// What is being done.
    pub fn stage(&self) -> &'static str {
        match &self.attempt {
            Some(_) if self.relaxing => "looking for the smallest relaxation",
            Some(attempt) => attempt.stage(),
            None => "shaping the loop",
        }
    }

    /// The share of the work that is done, 0 to 1: an estimate, for the structures that it takes are not known before.
    pub fn progress(&self) -> f64 {
        let left = self.plan.waiting.len() as f64 + f64::from(u8::from(!self.done));
        (1.0 - left / (self.plan.all as f64 + 1.0)).max(0.0)
    }

    /// The best design so far; the last one once [`DesignRun::step`] has answered that there is nothing left.
    pub fn design(&self) -> Option<&Design> {
        self.design.as_ref()
    }

    fn begin(&mut self) -> Result<(), DesignError> {
        if let Some((structure, feedback)) = self.again.take() {
            let at = feedback.map(|feedback| self.plan.ground.grown(&structure, &feedback));
            return self.attempt(structure, at.unwrap_or_default());
        }
        let structure = match (&self.options.controller, self.plan.waiting.pop_front()) {
            (_, None) => return self.end(),
            (ControllerChoice::Given(structure), Some(_)) => structure.clone(),
            (ControllerChoice::Grow { .. }, Some((order, zeros))) => self.plan.ground.structure(order, zeros),
        };
        let beginning = match &self.before {
            Some(before) => self.plan.ground.grown(&structure, before),
            None => vec![],
        };
        self.attempt(structure, beginning)
    }

    fn attempt(&mut self, structure: Structure, beginning: Vec<Vec<f64>>) -> Result<(), DesignError> {
        let samples = match self.samples.take() {
            Some(samples) => samples,
            None => self.first_samples()?,
        };
        self.samples = Some(samples.clone());
        let sampled = std::mem::take(&mut self.sampled);
        let stabilising = self.plan.ground.stabilising(&structure, &self.problem);
        let beginning = Beginning { simpler: beginning, stabilising, is_hard: self.plan.is_hard };
        let options = self.options_of(&structure);
        let attempt = Attempt::new(structure, samples, &options, self.relaxing, beginning, sampled)?;
        self.attempt = Some(attempt);
        Ok(())
    }

    /// Those of the design; the same structure again begins at other random points.
    fn options_of(&mut self, structure: &Structure) -> DesignOptions {
        let mut options = self.options.clone();
        if self.plan.last.as_ref() == Some(structure) {
            options.seed = options.seed.wrapping_add(SEED_AGAIN);
        }
        self.plan.last = Some(structure.clone());
        options
    }

    fn first_samples(&self) -> Result<Samples, DesignError> {
        let plants = first_plants(&self.problem, self.options.seed);
        let frequencies = search_frequencies(&self.problem, &plants, POINTS_PER_DECADE)?;
        let mut samples = Samples::new(&self.problem, &plants, &frequencies)?;
        for beside in (0..self.problem.beside.len()).map(PlantPoint::Beside) {
            samples.look_closely_at(&beside)?;
        }
        Ok(samples)
    }

    fn end_attempt(&mut self) -> Result<(), DesignError> {
        let Some(mut attempt) = self.attempt.take() else { return Ok(()) };
        self.sampled = attempt.take_sampled();
        self.samples = Some(attempt.samples());
        self.rounds.extend_from_slice(attempt.rounds());
        self.before = attempt.feedback().or(self.before.take());
        match attempt.ending() {
            Some(Ending::Met(audit)) => {
                self.take(&attempt, DesignStatus::Met, audit)?;
                self.plan.found = true;
                self.plan.waiting = fewer_zeros(&self.options.controller, attempt.structure());
                self.done = self.relaxing || self.plan.waiting.is_empty();
            }
            Some(Ending::Missed { worst_margin_db, audit: Some(_) })
                if *worst_margin_db > FEASIBLE_DB && !self.plan.again =>
            {
                // it can be met after all: from here the objective is looked for
                (self.plan.again, self.relaxing) = (true, false);
                self.again = Some((attempt.structure().clone(), attempt.feedback()));
            }
            Some(Ending::Missed { worst_margin_db, audit: Some(audit) }) => {
                let relaxation_db = -worst_margin_db;
                let is_less = match &self.design {
                    Some(Design { status: DesignStatus::Infeasible(known), .. }) => {
                        relaxation_db < known.relaxation_db - RELAXATION_GAINED_DB
                    }
                    _ => true,
                };
                if is_less {
                    let conflicts = all_conflicts(audit, attempt.beside(), 0.8 * relaxation_db);
                    let status = DesignStatus::Infeasible(Relaxation { relaxation_db, conflicts });
                    self.take(&attempt, status, audit)?;
                }
                self.done = self.plan.waiting.is_empty();
            }
            Some(Ending::Missed { worst_margin_db, audit: None }) => {
                if self.nearest.as_ref().is_none_or(|(best, ..)| worst_margin_db > best) {
                    self.nearest = Some((*worst_margin_db, attempt.structure().clone(), attempt.feedback()));
                }
                self.done = self.plan.found;
            }
            Some(Ending::NotConverged(audit)) => {
                let status = DesignStatus::NotConverged { rounds: attempt.rounds().len() };
                if self.design.is_none() {
                    self.take(&attempt, status, audit)?;
                }
                self.done = self.plan.found || self.relaxing;
            }
            Some(Ending::NotStabilised) | None => {
                self.unstable = Some(attempt);
                self.done = self.plan.found;
            }
            Some(Ending::Hopeless(audit)) => {
                self.take(&attempt, DesignStatus::NotStabilised, audit)?;
                self.done = true;
            }
        }
        Ok(())
    }

    /// What is left when no structure is waiting: a relaxation, or nothing.
    fn end(&mut self) -> Result<(), DesignError> {
        match self.nearest.take() {
            Some((_, structure, feedback)) if !self.plan.found && !self.relaxing => {
                self.relaxing = true;
                let at = feedback.map(|feedback| self.plan.ground.grown(&structure, &feedback));
                self.attempt(structure, at.unwrap_or_default())
            }
            _ => {
                let unstable = self.unstable.take().filter(|_| self.design.is_none());
                self.done = unstable.is_none();
                self.attempt = unstable.map(Attempt::audited_as_it_is).transpose()?;
                Ok(())
            }
        }
    }

    fn take(&mut self, attempt: &Attempt, status: DesignStatus, audit: &Audit) -> Result<(), DesignError> {
        self.design = Some(Design {
            status,
            controller: attempt.deployed()?,
            law: attempt.shaping().controller(attempt.x()),
            structure: attempt.structure().clone(),
            starts: attempt.starts().cloned(),
            objective_db: self.rounds.last().map_or(f64::NAN, |round| round.objective_db),
            audit: audit.clone(),
            beside: attempt.beside().to_vec(),
            binding: binding_limits(audit),
            rounds: self.rounds.clone(),
        });
        Ok(())
    }
}

/// (order, zeros) of an order: one pole more than zeros; as many for a gain alone, for proportional-integral control, and where the loop is
/// sampled and its gain ends at pi/T anyway.
fn degrees(order: usize, integrators: usize, sampled: bool) -> Vec<(usize, usize)> {
    match order {
        0 => vec![(0, 0)],
        _ if sampled || (order == 1 && integrators == 1) => vec![(order, order - 1), (order, order)],
        _ => vec![(order, order - 1)],
    }
}

/// Whether a continuous controller of this order is tried with as many zeros as poles too, once none with fewer zeros has done: a pair of
/// zeros over a pair of poles, say, which has the phase of the zeros at every frequency above.
fn is_worth_as_many_zeros(order: usize, ground: &Ground) -> bool {
    order >= 2 && order > ground.integrators
}

/// The same order with one zero fewer, where structures grow: a larger relative degree has less gain at high frequency than any smaller one.
fn fewer_zeros(choice: &ControllerChoice, structure: &Structure) -> VecDeque<(usize, usize)> {
    let [order, zeros] = [structure.roots(-1.0), structure.roots(1.0)];
    let fewer = zeros.checked_sub(1).filter(|_| matches!(choice, ControllerChoice::Grow { .. }));
    fewer.map(|zeros| (order, zeros)).into_iter().collect()
}

/// The plants that a search begins with, the nominal one first.
fn first_plants(problem: &DesignProblem, seed: u64) -> Vec<PlantPoint> {
    let mut plants = first_members(&problem.family, seed);
    plants.extend((0..problem.beside.len()).map(PlantPoint::Beside));
    plants
}

fn first_members(family: &Family, seed: u64) -> Vec<PlantPoint> {
    match family {
        Family::Uncertain(family) => {
            let mut values = vec![family.plant().nominal()];
            match family.extent() {
                Extent::Box => {
                    values.extend(corners(family));
                    let inside = random(family.plant(), family.coordinates(), INTERIOR_PLANTS, seed);
                    values.extend(inside.unwrap_or_default());
                }
                Extent::Members => values.extend(family.members().iter().take(MEMBERS_MAXIMUM).cloned()),
            }
            let mut plants: Vec<PlantPoint> = Vec::new();
            for point in values.into_iter().map(PlantPoint::Parameters) {
                if !plants.contains(&point) {
                    plants.push(point);
                }
            }
            plants
        }
        Family::Measured(family) => (0..family.plants().len()).map(PlantPoint::Measured).collect(),
    }
}
