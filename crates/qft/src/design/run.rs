//! Sequence of a design: the order in which structures are searched, and the result that is
//! retained.

use std::collections::VecDeque;

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::watch::{Progress, Watch};

use super::NamedStructure;
use super::attempt::{Attempt, AttemptEnding, LoopDesignError, SHAPING, StartingPoints};
use super::binding::{all_conflicts, binding_limits};
use super::candidates::Ground;
use super::diagnosis::{FindingSeverity, diagnose};
use super::named::stage as named_stage;
use super::nearest::{NearAttempt, NearestAttempts};
use super::outcome::{DesignOutcome, LearntPlants};
use super::problem::{ControllerChoice, DesignOptions};
use super::queue::{QueuedStructure, fewer_zeros, longer, structures_to_search};
use super::result::{Design, DesignRound, DesignStatus, Relaxation};
use super::searched::{SearchedStructure, StructureEnding};
use super::stabilising::has_poles_to_move;
use crate::family::{Extent, Family, corners, random};
use crate::loop_shaping::{DesignProblem, Samples, Structure, search_frequencies};
use crate::plant_cache::PlantCache;
use crate::verification::{Audit, PlantPoint};

/// Number of points per decade of the frequency grid of a search.
const POINTS_PER_DECADE: f64 = 20.0;
/// Random plants inside the box at the beginning of a search.
const INTERIOR_PLANTS: usize = 32;
/// Members of a family without a box at the beginning of a search.
const MEMBERS_MAXIMUM: usize = 200;

/// Offset of the seed if a structure is searched once more.
const SEED_AGAIN: u64 = 1000;
/// Reduction of the relaxation above which a larger order is worth its poles, dB.
const RELAXATION_GAINED_DB: f64 = 0.01;

/// Designs a controller and its prefilter: searches and audits structures of growing length, until
/// one meets every specification; then longer ones that may be worth their poles and, for growing
/// order, ones with fewer zeros, as long as these also satisfy the specifications. If none does, it
/// searches for the smallest relaxation.
///
/// # Errors
/// [`LoopDesignError`] if a part of the problem is not a transfer function, or cannot be put into
/// the loop. A stop by the watch is not an error.
///
/// # Example
/// Plants 1/s and 4/s with |S| <= 1/2 required up to 1 rad/s. With a gain g this is g k >= sqrt(3)
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
///     additional_plants: vec![],
///     sensor: TransferFunction::gain_only(1.0),
///     timing: Timing::default(),
///     specifications: vec![Specification { requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s: [0.0, 1.0] }],
///     minimum_delay_margin_s: 0.0,
/// };
/// let pure_gain = Structure { sign: 1.0, gain: [0.01, 100.0], parts: vec![] };
/// let options = DesignOptions {
///     objective: Objective::LeastHighFrequencyGain,
///     controller: ControllerChoice::Given(pure_gain),
///     prefilter: PrefilterChoice::None,
///     seed: 1, tolerance_db: TOLERANCE_DB, reserve_db: 0.0, poles: PoleRange::default(), coefficients: CoefficientFormat::Double, workers: phea_dynamics::pieces::Workers::CALLER,
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
    design_knowing(problem, options, None, LearntPlants::of(options.workers), watch)
}

/// Continues a finished design with additional plants that the loop must control (the nominal one
/// of each). A structure that failed without these plants also fails with them, so the search
/// begins with structures of the order found, and reuses its samples.
///
/// # Errors
/// Errors of [`design`], and [`LoopDesignError`] for a plant that does not fit the loop.
pub fn design_again(
    problem: &DesignProblem,
    options: &DesignOptions,
    before: DesignOutcome,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    let DesignOutcome { design, mut known, .. } = before;
    if let Some(samples) = &mut known.samples {
        for plant in problem.additional_plants.iter().skip(samples.problem().additional_plants.len()) {
            samples.take_in(plant.clone())?;
        }
    }
    design_knowing(problem, options, design, known, watch)
}

pub(super) fn design_knowing(
    problem: &DesignProblem,
    options: &DesignOptions,
    found: Option<Design>,
    known: LearntPlants,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    let findings = diagnose(problem);
    let LearntPlants { samples, plants, rounds, searched } = known;
    let mut run = DesignProgress::new(problem, options, &plants);
    // if no controller of any order suffices, the search determines the deficit
    run.relaxing = findings.iter().any(|finding| finding.severity() == FindingSeverity::Impossible);
    (run.samples, run.rounds, run.searched) = (samples, rounds, searched);
    if let Some(found) = found {
        run.begin_at(&found);
    }
    let current = run.search_structures(watch)?.map(Box::new);
    let DesignProgress { design, samples, rounds, searched, .. } = run;
    let known = LearntPlants { samples, plants, rounds, searched };
    Ok(DesignOutcome { design, findings, stopped: current.is_some(), current, known })
}

/// A design in progress.
pub(super) struct DesignProgress<'a> {
    problem: &'a DesignProblem,
    options: &'a DesignOptions,
    ground: Ground,
    /// Structures still to be searched.
    waiting: VecDeque<QueuedStructure>,
    /// Structure being searched.
    now: QueuedStructure,
    all: usize,
    /// True if plants have poles that the loop has to move: every structure is searched twice,
    /// because one search may miss a solution.
    is_hard: bool,
    /// The structure that was searched last.
    last: Option<Structure>,
    /// True if a controller is already found, and fewer zeros are searched at its order.
    found: bool,
    /// True if the smallest relaxation is sought.
    pub(super) relaxing: bool,
    /// A structure that seemed infeasible, searched again from this controller, once.
    again: Option<(Structure, Option<TransferFunction>)>,
    begun_again: bool,
    nearest: NearestAttempts,
    /// The controller of the previous attempt.
    before: Option<TransferFunction>,
    /// The last attempt that found no stable loop.
    unstable: Option<Attempt>,
    samples: Option<Samples>,
    rounds: Vec<DesignRound>,
    searched: Vec<SearchedStructure>,
    /// The name of the design, if any, and its figure of merit.
    met: Option<(NamedStructure, Option<f64>)>,
    cache: &'a PlantCache,
    design: Option<Design>,
}

impl<'a> DesignProgress<'a> {
    pub(super) fn new(
        problem: &'a DesignProblem,
        options: &'a DesignOptions,
        cache: &'a PlantCache,
    ) -> DesignProgress<'a> {
        let ground = Ground::new(problem).with_poles(options.poles);
        let is_hard = has_poles_to_move(problem);
        let waiting = structures_to_search(problem, options, &ground, is_hard);
        DesignProgress {
            problem,
            options,
            ground,
            all: waiting.len(),
            waiting,
            now: QueuedStructure::Given,
            is_hard,
            last: None,
            found: false,
            relaxing: false,
            again: None,
            begun_again: false,
            nearest: NearestAttempts::default(),
            before: None,
            unstable: None,
            samples: None,
            rounds: vec![],
            searched: vec![],
            met: None,
            cache,
            design: None,
        }
    }

    /// Skips structures that failed in the design for fewer plants, and begins with its controller.
    fn begin_at(&mut self, found: &Design) {
        let order = found.structure.roots(-1.0);
        let own = |one: &QueuedStructure| one.name().is_some() && one.name() == found.name;
        match (&self.options.controller, self.waiting.iter().position(own)) {
            (ControllerChoice::Given(_) | ControllerChoice::Named { .. }, _) => {}
            (ControllerChoice::Any { .. } | ControllerChoice::Grow { .. }, Some(place)) => {
                self.waiting.drain(..place);
            }
            (ControllerChoice::Any { .. } | ControllerChoice::Grow { .. }, None) => {
                let is_left = |one: &QueuedStructure| matches!(one, QueuedStructure::Free { order: own, .. } if *own >= order);
                self.waiting.retain(is_left);
            }
        }
        self.all = self.waiting.len();
        self.before = found.law.feedback.transfer_function().ok();
    }

    /// Searches one structure after the other; returns the attempt at which the watch stopped it.
    fn search_structures(&mut self, watch: Watch<'_>) -> Result<Option<Attempt>, LoopDesignError> {
        while let Some((structure, feedback)) = self.next() {
            let mut attempt = self.attempt(structure, feedback)?;
            let ending = attempt.run(self.cache, &mut self.part(&mut *watch));
            match ending {
                Err(LoopDesignError::Stopped(_)) => return Ok(Some(self.nearest.nearer_than(attempt))),
                ending => {
                    let (attempt, ending) =
                        attempt.with_shorter_prefilter(ending?, self.cache, &mut self.part(&mut *watch))?;
                    self.note(&attempt, &ending);
                    if self.is_done_with(attempt, ending)? {
                        return Ok(None);
                    }
                }
            }
        }
        let Some(mut attempt) = self.unstable.take().filter(|_| self.design.is_none()) else {
            return Ok(None);
        };
        match attempt.audited_as_it_is(self.cache, &mut self.part(watch)) {
            Err(LoopDesignError::Stopped(_)) => Ok(Some(attempt)),
            audit => {
                self.take(&attempt, DesignStatus::NotStabilised, audit?)?;
                Ok(None)
            }
        }
    }

    /// The next structure, with a controller to begin from: the one to be searched again, the next
    /// in the queue, or a relaxation of the nearest one.
    fn next(&mut self) -> Option<(Structure, Option<TransferFunction>)> {
        if let Some(again) = self.again.take() {
            return Some(again);
        }
        if let Some(candidate) = self.waiting.pop_front() {
            self.now = candidate;
            let structure = candidate.structure(&self.options.controller, &self.ground);
            return Some((structure, self.before.clone()));
        }
        if self.found || (self.relaxing && !self.may_need_less()) {
            return None;
        }
        let NearAttempt { structure, attempt, .. } = self.nearest.take()?;
        (self.relaxing, self.now) = (true, structure);
        Some((attempt.structure().clone(), attempt.feedback()))
    }

    /// The watch of one attempt. The fraction is an estimate, because the number of structures is
    /// not known in advance.
    fn part<'w>(&self, watch: Watch<'w>) -> impl FnMut(Progress) -> bool + use<'w> {
        let left = self.waiting.len() as f64 + 1.0;
        let fraction = (1.0 - left / (self.all as f64 + 1.0)).max(0.0);
        let relaxing = self.relaxing;
        let named = self.now.name().map(named_stage);
        move |Progress { stage, .. }| {
            let stage = match named {
                _ if relaxing => "smallest relaxation",
                Some(named) if stage == SHAPING => named,
                _ => stage,
            };
            watch(Progress { stage, fraction })
        }
    }

    pub(super) fn attempt(
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
        let effort = self.now.effort(&structure, (self.is_hard, self.to_be_reached_db()));
        let beginning = StartingPoints { simpler, stabilising, effort };
        let options = self.options_of(&structure);
        let attempt = Attempt::new(structure, samples, &options, self.relaxing, beginning)?;
        Ok(attempt.that_earns(self.to_be_reached_db()))
    }

    /// The value that a structure must reach to replace the one that meets the limits, dB.
    fn to_be_reached_db(&self) -> Option<f64> {
        let ControllerChoice::Any { earned_per_pole_db, .. } = self.options.controller else { return None };
        let (met, reached_db) = self.met?;
        let further = self.now.name()?.order().saturating_sub(met.order()).max(1);
        Some(reached_db? - earned_per_pole_db * further as f64)
    }

    /// Records the result of an attempt for the comparison of structures; a repeated search
    /// replaces its earlier result.
    fn note(&mut self, attempt: &Attempt, ending: &AttemptEnding) {
        let own = SearchedStructure::new(self.now.name(), attempt, ending);
        match self.searched.iter_mut().find(|known| known.structure == own.structure) {
            // a relaxation does not replace the record that the limits were missed
            Some(known) if known.ending == StructureEnding::Met && own.ending != StructureEnding::Met => {}
            Some(known) => *known = own,
            None => self.searched.push(own),
        }
    }

    /// Options of the design; a repeated structure begins at other random points.
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
        for plant in (0..self.problem.additional_plants.len()).map(PlantPoint::Additional) {
            samples.sample_densely(&plant)?;
        }
        Ok(samples)
    }

    /// Takes the result of an attempt; returns true if no other attempt is worthwhile.
    fn is_done_with(&mut self, attempt: Attempt, ending: AttemptEnding) -> Result<bool, LoopDesignError> {
        self.samples = Some(attempt.samples());
        self.rounds.extend_from_slice(attempt.rounds());
        self.before = attempt.feedback().or(self.before.take());
        match ending {
            AttemptEnding::Met(audit) => {
                // the margins of its last samples, more than the search began with, must still earn
                // its poles
                let reached_db = attempt.reached_db();
                let earns = self.to_be_reached_db().zip(reached_db).is_none_or(|(most, own)| own <= most);
                if !earns {
                    return Ok(self.waiting.is_empty());
                }
                self.take(&attempt, DesignStatus::Met, *audit)?;
                self.found = true;
                self.met = self.now.name().map(|name| (name, reached_db));
                self.waiting = match self.now.name() {
                    Some(name) => longer(name, &self.options.controller, &self.ground),
                    None => fewer_zeros(self.now, attempt.structure()),
                };
                Ok(self.relaxing || self.waiting.is_empty())
            }
            AttemptEnding::Missed { worst_margin_db, audit: Some(_) }
                if worst_margin_db > self.options.feasible_db() && !self.begun_again =>
            {
                // the limits can be met after all: from here on the objective is optimised
                (self.begun_again, self.relaxing) = (true, false);
                self.again = Some((attempt.structure().clone(), attempt.feedback()));
                Ok(false)
            }
            AttemptEnding::Missed { worst_margin_db, audit: Some(audit) } => {
                self.take_relaxation(&attempt, -worst_margin_db, *audit)?;
                Ok(self.waiting.is_empty() && !self.may_need_less())
            }
            AttemptEnding::Missed { worst_margin_db, audit: None } => {
                self.nearest.push(worst_margin_db, self.now, attempt);
                Ok(self.is_done_without())
            }
            AttemptEnding::NotConverged(audit) => {
                let status = DesignStatus::NotConverged { rounds: attempt.rounds().len() };
                if self.design.is_none() {
                    self.take(&attempt, status, *audit)?;
                }
                Ok(self.is_done_without() || self.relaxing)
            }
            AttemptEnding::NotStabilised => {
                self.unstable = Some(attempt);
                Ok(self.is_done_without())
            }
            AttemptEnding::NotEarned => Ok(self.waiting.is_empty()),
        }
    }

    /// True if no candidates remain once a structure beyond a valid one has failed: other names may
    /// still be worth their poles, fewer zeros are not.
    fn is_done_without(&self) -> bool {
        self.found && (self.met.is_none() || self.waiting.is_empty())
    }

    /// True if an attempt that missed may need less relaxation than the one that was found.
    fn may_need_less(&self) -> bool {
        match &self.design {
            Some(Design { status: DesignStatus::Infeasible(known), .. }) => {
                self.nearest.may_need_less(known.relaxation_db - RELAXATION_GAINED_DB)
            }
            _ => false,
        }
    }

    fn take_relaxation(
        &mut self,
        attempt: &Attempt,
        relaxation_db: f64,
        audit: Audit,
    ) -> Result<(), LoopDesignError> {
        if self.design.as_ref().is_some_and(Design::is_open) {
            return Ok(());
        }
        if let Some(Design { status: DesignStatus::Infeasible(known), .. }) = &self.design
            && relaxation_db >= known.relaxation_db - RELAXATION_GAINED_DB
        {
            return Ok(());
        }
        let conflicts = all_conflicts(&audit, attempt.additional_audits(), 0.8 * relaxation_db);
        self.take(attempt, DesignStatus::Infeasible(Relaxation { relaxation_db, conflicts }), audit)
    }

    fn take(&mut self, attempt: &Attempt, status: DesignStatus, audit: Audit) -> Result<(), LoopDesignError> {
        let design = design_of(attempt, status, audit, &self.rounds)?;
        self.design = Some(Design { name: self.now.name(), ..design });
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
        prefilter: attempt.shaping().prefilter().cloned(),
        free_numbers: attempt.x().to_vec(),
        name: None,
        starts: attempt.starts().cloned(),
        objective_db: rounds.last().map_or(f64::NAN, |round| round.objective_db),
        binding: binding_limits(&audit, attempt.options()),
        audit,
        additional_audits: attempt.additional_audits().to_vec(),
        rounds: rounds.to_vec(),
    })
}

/// The initial plants of a search, the nominal one first.
fn first_plants(problem: &DesignProblem, seed: u64) -> Vec<PlantPoint> {
    let mut plants = first_members(&problem.family, seed);
    plants.extend((0..problem.additional_plants.len()).map(PlantPoint::Additional));
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
