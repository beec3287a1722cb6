//! The design: in which order structures are tried, and which result is kept.

use std::collections::VecDeque;

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::watch::{Progress, Watch};

use super::attempt::{Attempt, AttemptEnding, LoopDesignError, StartingPoints};
use super::binding::{all_conflicts, binding_limits};
use super::candidates::Ground;
use super::diagnosis::{FindingSeverity, diagnose};
use super::outcome::{DesignOutcome, LearntPlants};
use super::problem::{ControllerChoice, DesignOptions};
use super::result::{Design, DesignRound, DesignStatus, Relaxation};
use super::stabilising::has_poles_to_move;
use crate::family::{Extent, Family, corners, random};
use crate::kept_plants::KeptPlants;
use crate::loop_shaping::{DesignProblem, Samples, Structure, search_frequencies};
use crate::verification::{Audit, PlantPoint};

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

/// Designs a controller and its prefilter: structures of growing order are tried, each by search
/// and audit, until one meets every specification; then with fewer zeros, as long as these also
/// satisfy the specifications. Where none does, the smallest relaxation is looked for.
///
/// # Errors
/// [`LoopDesignError`] where a part of the problem is not a transfer function, or cannot be put
/// into the loop. A watch that stops it is not an error.
///
/// # Example
/// 1/s and 4/s are to have |S| <= 1/2 at up to 1 rad/s. With a gain g that is g k >= sqrt(3)
/// at the smallest k.
/// ```
/// # use phea_dynamics::controller::Timing;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_dynamics::watch::unwatched;
/// use phea_qft::design::quantization::CoefficientFormat;
/// use phea_qft::design::*;
/// # use phea_qft::family::{Extent, Family, UncertainFamily};
/// use phea_qft::loop_shaping::Structure;
/// # use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// # use phea_qft::verification::TOLERANCE_DB;
/// # let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 4.0 };
/// # let plant = UncertainPlant::record(vec![gain], |p| {
/// #     let command = RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] };
/// #     PlantCoefficients { command, disturbance: None, dead_time_s: 0.0.into(), rate: None }
/// # })?;
/// # let members = vec![vec![1.0], vec![4.0]];
/// # let family = Family::Uncertain(UncertainFamily::new(plant, vec![], members, Extent::Members)?);
/// let requirement = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.5));
/// let problem = DesignProblem {
///     family, // 1/s, 4/s
///     beside: vec![],
///     sensor: TransferFunction::gain_only(1.0),
///     timing: Timing::default(),
///     specifications: vec![Specification { requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s: [0.0, 1.0] }],
///     minimum_delay_margin_s: 0.0,
/// };
/// let gain_alone = Structure { sign: 1.0, gain: [0.01, 100.0], parts: vec![] };
/// let options = DesignOptions {
///     objective: Objective::LeastHighFrequencyGain,
///     controller: ControllerChoice::Given(gain_alone),
///     prefilter: PrefilterChoice::None,
///     seed: 1, tolerance_db: TOLERANCE_DB, reserve_db: 0.0, poles: PoleRange::default(), coefficients: CoefficientFormat::Double,
/// };
/// let found = design(&problem, &options, &mut unwatched)?.design.ok_or("none was found")?;
/// assert_eq!(found.status, DesignStatus::Met);
/// let gain = found.controller.feedback.transfer_function()?.gain();
/// assert!((gain / f64::sqrt(3.0) - 1.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn design(
    problem: &DesignProblem,
    options: &DesignOptions,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    design_knowing(problem, options, None, LearntPlants::default(), watch)
}

/// Continues a finished design with additional plants that the loop must control (the nominal one
/// of each). A structure that failed without these plants also fails with them, so the search
/// begins with structures of the order that was found, and reuses its samples.
///
/// # Errors
/// Those of [`design`], and [`LoopDesignError`] for a plant that does not fit the loop.
pub fn design_again(
    problem: &DesignProblem,
    options: &DesignOptions,
    before: DesignOutcome,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    let DesignOutcome { design, mut known, .. } = before;
    if let Some(samples) = &mut known.samples {
        for plant in problem.beside.iter().skip(samples.problem().beside.len()) {
            samples.take_in(plant.clone())?;
        }
    }
    design_knowing(problem, options, design, known, watch)
}

fn design_knowing(
    problem: &DesignProblem,
    options: &DesignOptions,
    found: Option<Design>,
    known: LearntPlants,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    let findings = diagnose(problem);
    let LearntPlants { samples, plants, rounds } = known;
    let mut run = DesignProgress::new(problem, options, &plants);
    // where no controller of any order suffices, it remains to find by how much
    run.relaxing = findings.iter().any(|finding| finding.severity() == FindingSeverity::Impossible);
    (run.samples, run.rounds) = (samples, rounds);
    if let Some(found) = found {
        run.begin_at(&found);
    }
    let at_hand = run.try_structures(watch)?.map(Box::new);
    let DesignProgress { design, samples, rounds, .. } = run;
    let known = LearntPlants { samples, plants, rounds };
    Ok(DesignOutcome { design, findings, stopped: at_hand.is_some(), at_hand, known })
}

/// A design on its way.
struct DesignProgress<'a> {
    problem: &'a DesignProblem,
    options: &'a DesignOptions,
    ground: Ground,
    /// (order, zeros) that are still to be tried.
    waiting: VecDeque<(usize, usize)>,
    all: usize,
    /// Whether plants have poles that the loop has to move: every structure is tried twice, for a
    /// search may miss what is there.
    is_hard: bool,
    /// The structure that was tried last.
    last: Option<Structure>,
    /// Whether a controller was found already, and fewer zeros are tried in its order.
    found: bool,
    /// Whether the smallest relaxation is looked for.
    relaxing: bool,
    /// A structure that seemed infeasible and is tried again from this controller; this is done
    /// once.
    again: Option<(Structure, Option<TransferFunction>)>,
    begun_again: bool,
    /// The attempt that came nearest, with its worst margin over rate.
    nearest: Option<(f64, Box<Attempt>)>,
    /// The controller of the attempt before.
    before: Option<TransferFunction>,
    /// The last attempt that found no stable loop.
    unstable: Option<Attempt>,
    samples: Option<Samples>,
    rounds: Vec<DesignRound>,
    kept: &'a KeptPlants,
    design: Option<Design>,
}

impl<'a> DesignProgress<'a> {
    fn new(
        problem: &'a DesignProblem,
        options: &'a DesignOptions,
        kept: &'a KeptPlants,
    ) -> DesignProgress<'a> {
        let ground = Ground::new(problem).with_poles(options.poles);
        let is_hard = has_poles_to_move(problem);
        let waiting = structures_to_try(problem, options, &ground, is_hard);
        DesignProgress {
            problem,
            options,
            ground,
            all: waiting.len(),
            waiting,
            is_hard,
            last: None,
            found: false,
            relaxing: false,
            again: None,
            begun_again: false,
            nearest: None,
            before: None,
            unstable: None,
            samples: None,
            rounds: vec![],
            kept,
            design: None,
        }
    }

    /// Skips structures with fewer poles than the design for fewer plants, and begins with its
    /// controller.
    fn begin_at(&mut self, found: &Design) {
        if let ControllerChoice::Grow { .. } = self.options.controller {
            let order = found.structure.roots(-1.0);
            self.waiting.retain(|(own, _)| *own >= order);
        }
        self.all = self.waiting.len();
        self.before = found.law.feedback.transfer_function().ok();
    }

    /// Tries one structure after the other; the attempt at which the watch stopped it.
    fn try_structures(&mut self, watch: Watch<'_>) -> Result<Option<Attempt>, LoopDesignError> {
        while let Some((structure, feedback)) = self.next() {
            let mut attempt = self.attempt(structure, feedback)?;
            match attempt.run(self.kept, &mut self.part(watch)) {
                Err(LoopDesignError::Stopped(_)) => return Ok(Some(self.nearer(attempt))),
                ending => {
                    if self.is_done_with(attempt, ending?)? {
                        return Ok(None);
                    }
                }
            }
        }
        let Some(mut attempt) = self.unstable.take().filter(|_| self.design.is_none()) else {
            return Ok(None);
        };
        match attempt.audited_as_it_is(self.kept, &mut self.part(watch)) {
            Err(LoopDesignError::Stopped(_)) => Ok(Some(attempt)),
            audit => {
                self.take(&attempt, DesignStatus::NotStabilised, audit?)?;
                Ok(None)
            }
        }
    }

    /// The next structure, with a controller to begin from: the one that is tried again, the next
    /// in the queue, or a relaxation of the one that came nearest.
    fn next(&mut self) -> Option<(Structure, Option<TransferFunction>)> {
        if let Some(again) = self.again.take() {
            return Some(again);
        }
        if let Some((order, zeros)) = self.waiting.pop_front() {
            let structure = match &self.options.controller {
                ControllerChoice::Given(structure) => structure.clone(),
                ControllerChoice::Grow { .. } => self.ground.structure(order, zeros),
            };
            return Some((structure, self.before.clone()));
        }
        let (_, nearest) = self.nearest.take().filter(|_| !self.found && !self.relaxing)?;
        self.relaxing = true;
        Some((nearest.structure().clone(), nearest.feedback()))
    }

    /// The attempt that is stopped, or the nearest before it if that came nearer.
    fn nearer(&mut self, mut stopped: Attempt) -> Attempt {
        let reached_db = stopped.worst_margin_db().unwrap_or(f64::NEG_INFINITY);
        match self.nearest.take() {
            Some((worst_margin_db, nearest)) if worst_margin_db > reached_db => *nearest,
            _ => stopped,
        }
    }

    /// The watch of one attempt. The share is an estimate, because the number of structures is not
    /// known in advance.
    fn part<'w>(&self, watch: Watch<'w>) -> impl FnMut(Progress) -> bool + use<'w> {
        let left = self.waiting.len() as f64 + 1.0;
        let share = (1.0 - left / (self.all as f64 + 1.0)).max(0.0);
        let relaxing = self.relaxing;
        move |Progress { stage, .. }| {
            let stage = if relaxing { "looking for the smallest relaxation" } else { stage };
            watch(Progress { stage, share })
        }
    }

    fn attempt(
        &mut self,
        structure: Structure,
        feedback: Option<TransferFunction>,
    ) -> Result<Attempt, LoopDesignError> {
        let simpler = feedback.map(|feedback| self.ground.grown(&structure, &feedback)).unwrap_or_default();
        let samples = match &self.samples {
            Some(samples) => samples.clone(),
            None => self.first_samples()?,
        };
        let stabilising = self.ground.stabilising(&structure, self.problem);
        let beginning = StartingPoints { simpler, stabilising, is_hard: self.is_hard };
        let options = self.options_of(&structure);
        Attempt::new(structure, samples, &options, self.relaxing, beginning)
    }

    /// Those of the design; the same structure again begins at other random points.
    fn options_of(&mut self, structure: &Structure) -> DesignOptions {
        let mut options = self.options.clone();
        if self.last.as_ref() == Some(structure) {
            options.seed = options.seed.wrapping_add(SEED_AGAIN);
        }
        self.last = Some(structure.clone());
        options
    }

    fn first_samples(&self) -> Result<Samples, LoopDesignError> {
        let plants = first_plants(self.problem, self.options.seed);
        let frequencies = search_frequencies(self.problem, &plants, POINTS_PER_DECADE)?;
        let mut samples = Samples::new(self.problem, &plants, &frequencies)?;
        for beside in (0..self.problem.beside.len()).map(PlantPoint::Beside) {
            samples.look_closely_at(&beside)?;
        }
        Ok(samples)
    }

    /// Takes the result of an attempt; returns whether no other attempt is worthwhile.
    fn is_done_with(&mut self, attempt: Attempt, ending: AttemptEnding) -> Result<bool, LoopDesignError> {
        self.samples = Some(attempt.samples());
        self.rounds.extend_from_slice(attempt.rounds());
        self.before = attempt.feedback().or(self.before.take());
        match ending {
            AttemptEnding::Met(audit) => {
                self.take(&attempt, DesignStatus::Met, *audit)?;
                self.found = true;
                self.waiting = fewer_zeros(&self.options.controller, attempt.structure());
                Ok(self.relaxing || self.waiting.is_empty())
            }
            AttemptEnding::Missed { worst_margin_db, audit: Some(_) }
                if worst_margin_db > self.options.feasible_db() && !self.begun_again =>
            {
                // it can be met after all: from here on the objective is optimised
                (self.begun_again, self.relaxing) = (true, false);
                self.again = Some((attempt.structure().clone(), attempt.feedback()));
                Ok(false)
            }
            AttemptEnding::Missed { worst_margin_db, audit: Some(audit) } => {
                self.take_relaxation(&attempt, -worst_margin_db, *audit)?;
                Ok(self.waiting.is_empty())
            }
            AttemptEnding::Missed { worst_margin_db, audit: None } => {
                if self.nearest.as_ref().is_none_or(|(best, _)| worst_margin_db > *best) {
                    self.nearest = Some((worst_margin_db, Box::new(attempt)));
                }
                Ok(self.found)
            }
            AttemptEnding::NotConverged(audit) => {
                let status = DesignStatus::NotConverged { rounds: attempt.rounds().len() };
                if self.design.is_none() {
                    self.take(&attempt, status, *audit)?;
                }
                Ok(self.found || self.relaxing)
            }
            AttemptEnding::NotStabilised => {
                self.unstable = Some(attempt);
                Ok(self.found)
            }
        }
    }

    fn take_relaxation(
        &mut self,
        attempt: &Attempt,
        relaxation_db: f64,
        audit: Audit,
    ) -> Result<(), LoopDesignError> {
        if let Some(Design { status: DesignStatus::Infeasible(known), .. }) = &self.design
            && relaxation_db >= known.relaxation_db - RELAXATION_GAINED_DB
        {
            return Ok(());
        }
        let conflicts = all_conflicts(&audit, attempt.beside(), 0.8 * relaxation_db);
        self.take(attempt, DesignStatus::Infeasible(Relaxation { relaxation_db, conflicts }), audit)
    }

    fn take(&mut self, attempt: &Attempt, status: DesignStatus, audit: Audit) -> Result<(), LoopDesignError> {
        self.design = Some(design_of(attempt, status, audit, &self.rounds)?);
        Ok(())
    }
}

pub(super) fn design_of(
    attempt: &Attempt,
    status: DesignStatus,
    audit: Audit,
    rounds: &[DesignRound],
) -> Result<Design, LoopDesignError> {
    Ok(Design {
        status,
        controller: attempt.deployed()?,
        law: attempt.shaping().controller(attempt.x()),
        structure: attempt.structure().clone(),
        starts: attempt.starts().cloned(),
        objective_db: rounds.last().map_or(f64::NAN, |round| round.objective_db),
        binding: binding_limits(&audit),
        audit,
        beside: attempt.beside().to_vec(),
        rounds: rounds.to_vec(),
    })
}

/// (order, zeros) in the order in which they are tried.
fn structures_to_try(
    problem: &DesignProblem,
    options: &DesignOptions,
    ground: &Ground,
    is_hard: bool,
) -> VecDeque<(usize, usize)> {
    let ControllerChoice::Grow { maximum_order } = options.controller else {
        return VecDeque::from([(0, 0)]);
    };
    let sampled = problem.timing.sample_time_s.is_some();
    let orders = ground.integrators..=maximum_order;
    let usual = orders.clone().flat_map(|order| degrees(order, ground.integrators, sampled));
    let biproper = orders.filter(|order| !sampled && is_worth_as_many_zeros(*order, ground));
    let each = usual.chain(biproper.map(|order| (order, order)));
    each.flat_map(|degrees| std::iter::repeat_n(degrees, if is_hard { 2 } else { 1 })).collect()
}

/// (order, zeros) of an order: one pole more than zeros; as many for a gain alone, for
/// proportional-integral control, and where the loop is sampled and its gain ends at pi/T anyway.
fn degrees(order: usize, integrators: usize, sampled: bool) -> Vec<(usize, usize)> {
    match order {
        0 => vec![(0, 0)],
        _ if sampled || (order == 1 && integrators == 1) => vec![(order, order - 1), (order, order)],
        _ => vec![(order, order - 1)],
    }
}

/// Whether a continuous controller of this order is also tried with as many zeros as poles, once
/// none with fewer zeros has succeeded: a lead of first order, or a pair of zeros over a pair of
/// poles, say, which has the phase of the zeros at every frequency above.
fn is_worth_as_many_zeros(order: usize, ground: &Ground) -> bool {
    order > ground.integrators
}

/// The same order with one zero fewer, where structures grow: a larger relative degree has less
/// gain at high frequency than any smaller one.
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
