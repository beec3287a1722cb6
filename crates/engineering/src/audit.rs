//! The audit of a given controller: family, loop and specifications from the project, findings from
//! `phea_qft`.

mod dead_time;
mod in_time;
mod margins;
mod nominal;
mod prefilter;
mod proven;
mod rig_outside_family;
mod signal_noise;
mod whole_loop;
pub use signal_noise::{NoisySignal, SignalNoise, SignalNoiseEffect, UnknownNoiseEffect};

pub use crate::common_position::CommonPosition;
pub use dead_time::LoopDeadTime;
pub use in_time::{TimeFinding, TimeOutcome, Unexamined, WorstStep};
pub(crate) use in_time::{VisitedPlant, spread_over, steps_of_members, visited, worst_additional};
pub use margins::{AuditMargins, LoopMargin, MarginSet};
pub(crate) use margins::{highest_crossover, plants_of_margins};
pub(crate) use nominal::nominal_margins;
pub use nominal::{Crossovers, NominalMargins};
pub use prefilter::PrefilterGain;
pub use proven::{prove_audit, prove_claims};
pub(crate) use rig_outside_family::{caveat as caveat_of_rig, unexamined as unexamined_rig};
pub use whole_loop::DelayedPaths;

use phea_dynamics::portable;
use phea_qft::audit::audit_by;
use phea_qft::family::{Extent, Family};
use phea_qft::proof::Proof;
use phea_qft::verification::{
    Audit, AuditProblem, Evidence, SpecificationFinding, TrackingJudgement, Verdict,
};

use crate::caveat::Caveat;
use crate::limit_kind::JudgedLimits;
use crate::plant_names::PlantNames;
use crate::quantity::Units;
use crate::robust::{NoPolynomials, RobustError, RobustProblem, robust_problem};
use crate::setup::Setup;
use crate::side_by_side::{all_cores, both};
use crate::source::Source;
use crate::specification::{NamedSpecification, SpecificationName};
use phea_dynamics::watch::{Stopped, Watch, part};

/// Reason why there is nothing to audit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AuditError {
    /// The controller is missing.
    #[error(
        "the project gives no [controller] to be verified: add one, such as `numerator = \"2e-4 s + 3e-3\"` and `denominator = \"s\"`, or let `phea design` find it"
    )]
    NoController,
    /// The controller has no transfer function.
    #[error(
        "[controller] states only when it acts and leaves its transfer function to be designed: `phea design` does that"
    )]
    NoLaw,
    /// The specifications are missing.
    #[error(
        "the project states no [[specification]] to verify the controller against: add one, such as `kind = \"robust_stability\"` and `limit = 1.3`"
    )]
    NoSpecification,
    /// The project is not a problem of the robust method.
    #[error(transparent)]
    Robust(#[from] RobustError),
    /// The progress callback cancelled the audit.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Name of the stage in progress reports.
const STAGE: &str = "auditing";

/// Audits the given controller and prefilter over the whole family and band.
///
/// # Errors
/// [`AuditError`] for a project without a controller, a part of it that is not a transfer function,
/// a family that cannot be built, or a cancellation by `watch`.
pub fn audit_project(
    source: &dyn Source,
    setup: &Setup<'_>,
    watch: Watch<'_>,
) -> Result<ProjectAudit, AuditError> {
    Ok(audit_problem(&problem_to_audit(source, setup)?, watch)?)
}

/// The given controller in a loop with the whole family, and the specifications for the audit.
///
/// # Errors
/// The errors of [`audit_project`], except cancellation.
pub fn problem_to_audit(source: &dyn Source, setup: &Setup<'_>) -> Result<RobustProblem, AuditError> {
    let project = setup.project;
    match &project.controller {
        None => return Err(AuditError::NoController),
        Some(controller) if !controller.has_law() => return Err(AuditError::NoLaw),
        Some(_) => {}
    }
    if project.specifications.is_empty() {
        return Err(AuditError::NoSpecification);
    }
    Ok(robust_problem(source, setup)?)
}

/// Audits an existing robust problem.
///
/// # Errors
/// [`Stopped`] if `watch` cancels it.
pub fn audit_problem(problem: &RobustProblem, watch: Watch<'_>) -> Result<ProjectAudit, Stopped> {
    let fraction = if problem.rig_outside.is_some() { 0.8 } else { 0.9 };
    let requested = audit_request(problem, &problem.family);
    let audit = audit_by(&requested, all_cores(), &mut part(&mut *watch, STAGE, [0.0, fraction]))?;
    let of_rig = caveat_of_rig(problem, &mut part(&mut *watch, STAGE, [fraction, 0.95]))?;
    ProjectAudit::new(problem, audit, of_rig, &mut part(watch, STAGE, [0.95, 1.0]))
}

/// Audits a problem, possibly over another family.
pub fn audit_request<'a>(problem: &'a RobustProblem, family: &'a Family) -> AuditProblem<'a> {
    AuditProblem {
        family,
        compensation: &problem.compensation,
        specifications: &problem.specifications,
        tracking: match problem.has_prefilter {
            true => TrackingJudgement::Magnitude,
            false => TrackingJudgement::Spread,
        },
        tolerance_db: problem.tolerance_db,
    }
}

/// An audit with the names of its project.
#[derive(Clone, Debug)]
pub struct ProjectAudit {
    /// Findings of the audit.
    pub audit: Audit,
    /// The names of the parameters of a plant.
    pub names: PlantNames,
    /// Name of each specification.
    pub specification_names: Vec<SpecificationName>,
    /// Number in the file, from 1, of each specification that is declared there; the others follow.
    pub specification_numbers: Vec<usize>,
    /// Position of every plant; `None` if the plants differ in it or in its stiffness, and without
    /// a rig.
    pub position: Option<CommonPosition>,
    /// Number of plants of the family.
    pub members: usize,
    /// True if everything between the plants belongs to the family.
    pub whole_box: bool,
    /// Reason why the plants have no polynomials; `None` if they have them.
    pub without_polynomials: Option<NoPolynomials>,
    /// Paths that the delay margin delays with the controller; gain, phase and modulus margins are
    /// those of the force loop around them.
    pub delayed_paths: DelayedPaths,
    /// Sample time, s; `None` for a continuous controller.
    pub sample_time_s: Option<f64>,
    /// Delay of the loop, s.
    pub delay_s: f64,
    /// Dead time of plant, sensor and controller.
    pub dead_time: LoopDeadTime,
    /// Motion of the rig and units of display.
    pub units: Units,
    /// Declared effects that the audit does not include.
    pub caveats: Vec<Caveat>,
    /// Magnitude that the worst plant of each specification reaches; `None` for a specification
    /// that does not limit a magnitude.
    pub reached: Vec<Option<ReachedLimit>>,
    /// Effect of the noise of a velocity that is fed forward; `None` without one.
    pub velocity_noise: Option<SignalNoise>,
    /// Effect of the noise of pressures that are fed back; `None` without one.
    pub pressure_noise: Option<SignalNoise>,
    /// Margins of the nominal loop; `None` if the loop is not known to be stable.
    pub nominal: Option<NominalMargins>,
    /// Gain, phase, modulus and delay margin of the nominal loop, and the worst of the family.
    pub margins: AuditMargins,
    /// The requirements in time of its specifications.
    pub in_time: Vec<TimeFinding>,
    /// The prefilter, if it amplifies.
    pub amplifying_prefilter: Option<PrefilterGain>,
    /// Result of the proof, if one was requested.
    pub proof: Option<Proof>,
    /// Limits of a design that the loop satisfies or violates, which are no part of the verdict;
    /// `None` if they were not examined.
    pub below_design: Option<JudgedLimits>,
}

/// A problem with the audit of its loop.
#[derive(Clone, Copy, Debug)]
pub struct AuditedProblem<'a> {
    /// Family in the loop of the controller.
    pub problem: &'a RobustProblem,
    /// Audit of the loop.
    pub view: &'a ProjectAudit,
}

/// A closed-loop magnitude and the limit to which it is nearest, or which it violates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachedLimit {
    /// The magnitude.
    pub magnitude: f64,
    /// The limit.
    pub limit: f64,
    /// Side of the magnitude on which the limit is.
    pub side: LimitSide,
}

/// Side of a magnitude that a limit bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitSide {
    /// Upper limit without a lower one.
    Only,
    /// Upper limit of two.
    Upper,
    /// Lower limit of two.
    Lower,
}

/// Decibels per neper, 20 log10(e).
pub(crate) const DECIBELS_PER_NEPER: f64 = 20.0 * std::f64::consts::LOG10_E;

/// Magnitude that the worst plant reaches; `None` for a spread, and at the ends of the frequency
/// axis if there are two limits.
fn reached(problem: &RobustProblem, finding: &SpecificationFinding) -> Option<ReachedLimit> {
    let worst = finding.worst.as_ref().filter(|worst| worst.other.is_none())?;
    let frequency = worst.frequency_rad_per_s;
    let (lower, upper) = finding.requirement.limits();
    let upper = upper.magnitude(frequency)?;
    if !(frequency > 0.0 && frequency.is_finite()) {
        // A loop has no response there, but its margin tends to a limit, and so does the magnitude
        // if its limit is a number.
        let single = lower.is_none() && upper > 0.0 && upper.is_finite();
        let magnitude = upper * portable::exp(-worst.margin_db / DECIBELS_PER_NEPER);
        return single.then_some(ReachedLimit { magnitude, limit: upper, side: LimitSide::Only });
    }
    if lower.is_none() {
        // among all plants compatible with a measured response, this is the worst
        let magnitude = upper * portable::exp(-worst.margin_db / DECIBELS_PER_NEPER);
        return Some(ReachedLimit { magnitude, limit: upper, side: LimitSide::Only });
    }
    if worst.margin_db == f64::NEG_INFINITY {
        let limit = lower?.magnitude(frequency)?;
        return Some(ReachedLimit { magnitude: 0.0, limit, side: LimitSide::Lower });
    }
    let response = problem.response(&problem.member(&worst.plant)?, frequency)?;
    let magnitude = portable::magnitude(finding.requirement.closed_loop().response(&response));
    let (limit, side) = match lower {
        None => (upper, LimitSide::Only),
        Some(lower) => {
            let lower = lower.magnitude(frequency)?;
            if magnitude / lower < upper / magnitude {
                (lower, LimitSide::Lower)
            } else {
                (upper, LimitSide::Upper)
            }
        }
    };
    Some(ReachedLimit { magnitude, limit, side })
}

impl ProjectAudit {
    /// An audit of the loop of this problem, with the findings for the rig itself if the family
    /// does not contain it.
    ///
    /// # Errors
    /// [`Stopped`] if `watch` cancels the search of the worst steps.
    pub(crate) fn new(
        problem: &RobustProblem,
        mut audit: Audit,
        of_rig: Option<Caveat>,
        watch: Watch<'_>,
    ) -> Result<ProjectAudit, Stopped> {
        let RobustProblem { family, compensation, .. } = problem;
        let delayed_paths = DelayedPaths::of(problem);
        if delayed_paths.are_some() {
            audit.delay_margin = whole_loop::least_delay(problem, &audit).or(audit.delay_margin);
        }
        let caveats: Vec<Caveat> = of_rig.into_iter().chain(problem.caveats.clone()).collect();
        if caveats.iter().any(|caveat| caveat.unproven) {
            audit.verdict = audit.verdict.max(Verdict::NotProven);
        }
        let (in_time, margins) = both(
            watch,
            0.5,
            |watch| in_time::findings(problem, &audit, watch),
            |_| AuditMargins::of(problem, &audit),
        );
        let in_time = in_time?;
        let noise = |signal| SignalNoise::of(signal, problem, audit.stability.verdict);
        let [velocity_noise, pressure_noise] = [NoisySignal::LoadVelocity, NoisySignal::Pressures].map(noise);
        let nominal = margins.nominal.as_ref().and_then(|set| {
            let own = nominal_margins(problem)?;
            let delay_margin_s =
                if delayed_paths.are_some() { set.delay_s.value } else { own.delay_margin_s };
            Some(NominalMargins { delay_margin_s, ..own })
        });
        Ok(ProjectAudit {
            nominal,
            margins,
            reached: audit.specifications.iter().map(|finding| reached(problem, finding)).collect(),
            audit,
            names: problem.names.clone(),
            specification_names: problem.specification_names.clone(),
            specification_numbers: problem.specification_numbers.clone(),
            position: problem.position.filter(|_| matches!(family, Family::Uncertain(_))),
            members: match family {
                Family::Uncertain(family) => family.members().len(),
                Family::Measured(family) => family.plants().len(),
            },
            without_polynomials: problem.without_polynomials,
            delayed_paths,
            whole_box: matches!(family, Family::Uncertain(family) if family.extent() == Extent::Box),
            sample_time_s: compensation.sample_time_s(),
            delay_s: compensation.delay_s(),
            dead_time: LoopDeadTime::of(problem),
            units: problem.units,
            caveats,
            velocity_noise,
            pressure_noise,
            in_time,
            amplifying_prefilter: PrefilterGain::amplifying(compensation),
            proof: None,
            below_design: None,
        })
    }

    /// Verdict on the specifications over frequency and on the requirements in time: a step that
    /// misses one violates a requirement.
    pub fn verdict(&self) -> Verdict {
        self.in_time.iter().map(TimeFinding::part_of_verdict).fold(self.audit.verdict, Verdict::max)
    }

    /// Evidence for that verdict: the steps of the visited plants are a search.
    pub fn evidence(&self) -> Evidence {
        let own = self.audit.evidence;
        let of_verdict = |finding: &TimeFinding| finding.requirement.follows && finding.verdict().is_some();
        let searched = || self.in_time.iter().any(of_verdict);
        match (self.audit.verdict, self.misses_in_time()) {
            (Verdict::Violated, true) => own.max(Evidence::Search),
            (_, true) => Evidence::Search,
            (Verdict::Met, false) if searched() => own.min(Evidence::Search),
            (_, false) => own,
        }
    }

    /// The requirement in time of a limit on a closed loop, by its index.
    pub fn in_time_of(&self, index: usize) -> Option<&TimeFinding> {
        self.in_time.iter().find(|finding| finding.requirement.limits == Some(index))
    }

    /// True if a step misses a requirement in time from which limits follow.
    pub fn misses_in_time(&self) -> bool {
        self.in_time.iter().any(TimeFinding::violates)
    }

    /// A specification by its number and its name.
    pub fn named(&self, index: usize) -> Option<NamedSpecification> {
        let name = *self.specification_names.get(index)?;
        Some(NamedSpecification { number: self.number_of(index), name })
    }

    /// True if the plants have lines with waves, which are fitted.
    pub fn has_lines_in_motion(&self) -> bool {
        self.without_polynomials == Some(NoPolynomials::LinesInMotion)
    }

    /// The number of a specification in the file, from 1; `None` for one that is not declared.
    pub fn number_of(&self, index: usize) -> Option<usize> {
        self.specification_numbers.get(index).copied()
    }
}
