//! Searches by steps, alternating with audits, from one start.

use phea_dynamics::portable;
use phea_dynamics::watch::{Watch, part, within};
use phea_qft::audit::{audit_by, audit_of_known_plants_by};
use phea_qft::closed_loop::Compensation;
use phea_qft::design::{Design, DesignProblem, DesignStatus, name_of};
use phea_qft::loop_shaping::{Aim, DescentOptions, Samples, SearchProblem, Shaping, descend};
use phea_qft::verification::SpecificationMargin;

use super::shaping::{AimedStepLimits, RESERVE_DB, StepShaping};
use super::starts::SearchReach;
use super::{AimedSteps, LedSearch, NEARLY_DB, StepRoom, with_rig};
use crate::audit::audit_request;
use crate::design::command_of_steps::{CommandDepth, ScenarioSteps, command_of_steps};
use crate::design::search::rank;
use crate::design::{DesignError, ProjectDesign};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::side_by_side::all_cores;
use crate::simulate::StepLimits;

/// Name of the stage.
pub(super) const STAGE: &str = "shaping by steps";
/// Largest number of times that the findings of an audit are added to the search.
const ROUNDS: usize = 5;
/// Least relative improvement of a useful round; this many useless rounds in succession are the
/// last.
const GAIN: f64 = 0.01;
const IN_VAIN: usize = 2;
/// Number of rounds of a search that misses its aim from the beginning.
const ROUNDS_IN_NEED: usize = 2;
/// Ratio to the fastest possible pole of the controller above which its zeros have next to no
/// effect, and ratio to the slowest pole of the prefilter above which its poles have none.
const BEYOND_FASTEST: f64 = 2.0;
const FAST: f64 = 10.0;
/// Ratio of a step, including the contribution of the rig, to its requirement that is worth a
/// trial.
const NEAR: f64 = 1.1;
/// Ratio of the steps of a start to those of an earlier one from which it is abandoned.
const FAR: f64 = 1.3;
/// Fraction of its limit above which the command of the scenarios' steps is part of each audit.
const COMMAND_NEAR: f64 = 0.5;
/// Largest number of continuations of a search with plants that were not part of it.
const MOST_CONTINUATIONS: usize = 5;
/// Number of steps of one search.
const DESCENT_STEPS: usize = 12;

/// An audited design and its deficits.
pub(super) struct AuditedStep {
    pub(super) project_design: Box<ProjectDesign>,
    start: Design,
    pub(super) search: LedSearch,
    free_numbers: Vec<f64>,
    /// Depth of the audit.
    audit: AuditDepth,
    /// Rank of the verdict over frequency.
    verdict: u8,
    /// Largest ratio of a property of its steps to the aim, 1 if they reach it.
    excess: f64,
    /// Least margin of the samples to a limit.
    pub(super) least: Option<SpecificationMargin>,
}

/// Part of a family that is audited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AuditDepth {
    /// Members and corners.
    KnownPlants,
    /// Members, corners and everything between them.
    Whole,
}

impl AuditedStep {
    pub(super) fn is_reached(&self) -> bool {
        self.project_design.is_met() && self.excess <= 1.0
    }

    /// True if the design is nearer than another one by more than this fraction.
    pub(super) fn gains_on(&self, other: &AuditedStep, fraction: f64) -> bool {
        self.verdict < other.verdict
            || self.verdict == other.verdict && self.excess < (1.0 - fraction) * other.excess
    }
}

/// Problem of a design that is led by its steps, and its aim.
pub(super) struct LedDesign<'a> {
    pub(super) setup: &'a Setup<'a>,
    pub(super) aimed: AimedSteps<'a>,
    /// Plants whose steps are checked after each search.
    pub(super) evaluated: Vec<Vec<f64>>,
    pub(super) problem: DesignProblem,
    pub(super) samples: Samples,
    pub(super) required: StepLimits,
    /// Part of the aim that is reserved for the rig.
    pub(super) room: StepRoom,
}

/// A design whose steps were led once, before any audit.
pub(super) struct BegunDesign<'a> {
    start: Design,
    search: StepShaping<'a>,
    free_numbers: Vec<f64>,
    /// Least margin of its samples and steps, dB.
    pub(super) least_db: f64,
}

impl<'a> LedDesign<'a> {
    /// The problem with little room for the contribution of the rig to the steps.
    pub(super) fn with_less_room(&self) -> LedDesign<'a> {
        let (evaluated, problem, samples) =
            (self.evaluated.clone(), self.problem.clone(), self.samples.clone());
        LedDesign { evaluated, problem, samples, room: StepRoom::Little, ..*self }
    }

    /// First search from a start; `None` if its loop is not stable.
    pub(super) fn begun(
        &self,
        start: Design,
        project_design: &ProjectDesign,
        reach: SearchReach,
        watch: Watch<'_>,
    ) -> Result<Option<BegunDesign<'a>>, DesignError> {
        let structures = (start.structure.clone(), start.prefilter.clone());
        let shaping =
            Shaping::new(structures.0, structures.1, project_design.options.objective, self.samples.clone())?;
        let aimed_limits = AimedStepLimits {
            linear: self.room.of(self.aimed.aim.step_limits(self.required)),
            with_rig: with_rig(self.required),
        };
        let added = (aimed_limits, self.aimed.added.to_vec());
        let search = StepShaping::new(shaping, added, self.problem.sensor.clone(), self.aimed.plants);
        let mut search = search.with_commands(ScenarioSteps::of(self.setup, project_design));
        if reach == SearchReach::Near {
            search.stay_near(&start.free_numbers);
        }
        if !search.judge(&start.free_numbers).stable {
            return Ok(None);
        }
        search.take_worst(&project_design.design)?;
        search.take_steps(project_design)?;
        let free_numbers = self.descended(&mut search, &start.free_numbers, watch)?;
        let least_db = search.judge(&free_numbers).worst_margin_db;
        Ok(Some(BegunDesign { start, search, free_numbers, least_db }))
    }

    /// A design without zeros and poles that have next to no effect, with its first search; `None`
    /// if it has none of them.
    pub(super) fn shorter(
        &self,
        project_design: &ProjectDesign,
        watch: Watch<'_>,
    ) -> Result<Option<BegunDesign<'a>>, DesignError> {
        let start = &project_design.design;
        let free_numbers = start.free_numbers.as_slice();
        let fastest = BEYOND_FASTEST * project_design.options.poles.fastest_rad_per_s;
        let (own, of_prefilter) = free_numbers.split_at(start.structure.dimension().min(free_numbers.len()));
        let loop_shorter = start.structure.without_roots_beyond(fastest, own);
        let prefilter_shorter = start.prefilter.as_ref().and_then(|prefilter| {
            let law = prefilter.compensator(of_prefilter).transfer_function().ok()?;
            let slowest = law.poles().iter().map(|pole| portable::magnitude(*pole)).fold(fastest, f64::min);
            prefilter.without_roots_beyond(FAST * slowest, of_prefilter)
        });
        if loop_shorter.is_none() && prefilter_shorter.is_none() {
            return Ok(None);
        }
        let (structure, own) = loop_shorter.unwrap_or((start.structure.clone(), own.to_vec()));
        let (prefilter, of_prefilter) = match prefilter_shorter {
            Some((prefilter, x)) => (Some(prefilter), x),
            None => (start.prefilter.clone(), of_prefilter.to_vec()),
        };
        let name = if structure == start.structure { start.name } else { name_of(&structure) };
        let free_numbers = [own, of_prefilter].concat();
        let start = Design { structure, prefilter, free_numbers, name, ..start.clone() };
        self.begun(start, project_design, SearchReach::Anywhere, watch)
    }

    /// Nearest audited design, after searches with the findings of each audit, abandoned if it is
    /// far from the design to be beaten.
    pub(super) fn agreed(
        &self,
        begun: BegunDesign<'a>,
        to_beat: Option<&AuditedStep>,
        project_design: &ProjectDesign,
        watch: Watch<'_>,
    ) -> Result<Option<AuditedStep>, DesignError> {
        let BegunDesign { start, mut search, mut free_numbers, least_db } = begun;
        let rounds = if least_db < 0.0 { ROUNDS_IN_NEED } else { ROUNDS };
        let mut best: Option<AuditedStep> = None;
        let mut in_vain = 0;
        for round in 0..rounds {
            let fraction = [round, round + 1].map(|done| done as f64 / rounds as f64);
            let mut watch = within(&mut *watch, fraction);
            if round > 0 {
                free_numbers = self.descended(&mut search, &free_numbers, &mut watch)?;
            }
            let at = (&start, project_design, free_numbers.as_slice());
            let (mut moved, mut is_new) =
                self.judged(&mut search, at, AuditDepth::KnownPlants, &mut watch)?;
            if moved.is_reached() {
                (moved, is_new) = self.judged(&mut search, at, AuditDepth::Whole, &mut watch)?;
            }
            let (is_reached, gains) =
                (moved.is_reached(), best.as_ref().is_none_or(|best| moved.gains_on(best, GAIN)));
            let is_far = to_beat.is_some_and(|known| moved.excess > FAR * known.excess);
            in_vain = if gains { 0 } else { in_vain + 1 };
            if gains {
                best = Some(moved);
            }
            if is_reached || !is_new || is_far || in_vain >= IN_VAIN {
                break;
            }
        }
        Ok(best)
    }

    /// The design with its audit and its deficits, and true if it adds anything to the search.
    fn judged(
        &self,
        search: &mut StepShaping<'_>,
        (start, project_design, free_numbers): (&Design, &ProjectDesign, &[f64]),
        depth: AuditDepth,
        watch: Watch<'_>,
    ) -> Result<(AuditedStep, bool), DesignError> {
        let at = (start, project_design, free_numbers);
        let moved = self.audited(&search.shaping, at, depth, watch)?;
        let is_new = search.take_worst(&moved.design)? | search.take_steps(&moved)?;
        let with_rig = search.excess_with_rig(free_numbers, &self.required);
        let found = AuditedStep {
            verdict: rank(&moved).0,
            excess: self.aimed.aim.excess(&moved).max(with_rig),
            least: search.least_of_limits(free_numbers),
            project_design: Box::new(moved),
            start: start.clone(),
            search: LedSearch { shaping: search.shaping.clone(), room: self.room },
            free_numbers: free_numbers.to_vec(),
            audit: depth,
        };
        Ok((found, is_new))
    }

    /// The design with a complete audit.
    pub(super) fn completed(
        &self,
        found: AuditedStep,
        project_design: &ProjectDesign,
        watch: Watch<'_>,
    ) -> Result<AuditedStep, DesignError> {
        if found.audit == AuditDepth::Whole {
            return Ok(found);
        }
        let at = (&found.start, project_design, found.free_numbers.as_slice());
        let project_design = self.audited(&found.search.shaping, at, AuditDepth::Whole, watch)?;
        Ok(AuditedStep { project_design: Box::new(project_design), audit: AuditDepth::Whole, ..found })
    }

    /// The design with its audit.
    fn audited(
        &self,
        shaping: &Shaping,
        (start, project_design, free_numbers): (&Design, &ProjectDesign, &[f64]),
        depth: AuditDepth,
        watch: Watch<'_>,
    ) -> Result<ProjectDesign, DesignError> {
        let compensation = Compensation::new(&shaping.controller(free_numbers), self.problem.sensor.clone())?;
        let has_prefilter = project_design.designed.problem.has_prefilter;
        let problem =
            RobustProblem { compensation, has_controller: true, has_prefilter, ..self.aimed.given.clone() };
        let request = audit_request(&problem, &problem.family);
        let audit = match depth {
            AuditDepth::KnownPlants => audit_of_known_plants_by(&request, all_cores(), watch)?,
            AuditDepth::Whole => audit_by(&request, all_cores(), watch)?,
        };
        let status = DesignStatus::NotConverged { rounds: start.rounds.len() };
        let design = Design { status, ..start.clone() };
        let moved = design.moved(shaping, free_numbers.to_vec(), audit, &project_design.options);
        let found = (self.aimed.given, &self.problem);
        let mut found =
            ProjectDesign::new(self.setup, found.0, found.1, moved, project_design.options.clone(), watch)?;
        let depth = match depth {
            AuditDepth::KnownPlants => CommandDepth::KnownPlants,
            AuditDepth::Whole => CommandDepth::Whole,
        };
        // a command far from its limit is evaluated only once the design has been found
        if project_design.command_of_steps.as_ref().is_some_and(|command| command.ratio() > COMMAND_NEAR) {
            found.command_of_steps = command_of_steps((self.setup, &found), self.aimed.plants, depth, watch)?;
        }
        Ok(found)
    }

    /// Free numbers that a search from the given ones finds, continued with plants whose steps miss
    /// the aim with them.
    fn descended(
        &self,
        search: &mut StepShaping<'_>,
        free_numbers: &[f64],
        watch: Watch<'_>,
    ) -> Result<Vec<f64>, DesignError> {
        let mut free_numbers = free_numbers.to_vec();
        for look in 0..MOST_CONTINUATIONS {
            let fraction = [look, look + 1].map(|done| done as f64 / MOST_CONTINUATIONS as f64);
            free_numbers = descended(search, &free_numbers, &mut within(&mut *watch, fraction))?;
            // numbers that miss the aim with these plants miss it with more
            let misses = search.judge(&free_numbers).worst_margin_db < 0.0;
            if misses || !search.take_unseen(&free_numbers, (self.aimed.given, &self.evaluated))? {
                break;
            }
        }
        Ok(free_numbers)
    }

    /// The better one of a design and the result of a start.
    pub(super) fn better(
        &self,
        best: Option<AuditedStep>,
        begun: BegunDesign<'a>,
        project_design: &ProjectDesign,
        watch: Watch<'_>,
    ) -> Result<Option<AuditedStep>, DesignError> {
        let found = self.agreed(begun, best.as_ref(), project_design, watch)?;
        Ok(match (best, found) {
            (Some(best), Some(found)) if !found.gains_on(&best, 0.0) => Some(best),
            (best, found) => found.or(best),
        })
    }

    /// True if a design reaches the aim, or is so near that a trial on the nonlinear rig gives more
    /// information than another start.
    pub(super) fn suffices(&self, found: Option<&AuditedStep>) -> bool {
        let satisfies_limits = |found: &AuditedStep| {
            found.verdict == 0 || found.least.as_ref().is_some_and(|least| least.margin_db >= -NEARLY_DB)
        };
        let is_near = |found: &AuditedStep| {
            !self.aimed.added.is_empty() && satisfies_limits(found) && found.excess <= NEAR
        };
        found.is_some_and(|found| found.is_reached() || is_near(found))
    }
}

/// Free numbers that a search from the given ones finds.
fn descended(
    search: &mut StepShaping<'_>,
    free_numbers: &[f64],
    watch: Watch<'_>,
) -> Result<Vec<f64>, DesignError> {
    let options = DescentOptions {
        reserve_db: RESERVE_DB,
        tolerance_db: 1e-3,
        steps_maximum: DESCENT_STEPS,
        ..DescentOptions::new(Aim::Objective)
    };
    Ok(descend(search, free_numbers, options, &mut part(watch, STAGE, [0.0, 1.0]))?.x)
}
