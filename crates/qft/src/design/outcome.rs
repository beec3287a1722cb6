//! Outcome of a design, and the data to continue from it.

use phea_dynamics::pieces::Workers;
use phea_dynamics::watch::{Watch, unwatched};

use super::attempt::{Attempt, LoopDesignError};
use super::diagnosis::Finding;
use super::problem::DesignOptions;
use super::result::{Design, DesignRound, DesignStatus};
use super::run::{design_knowing, design_of};
use super::searched::SearchedStructure;
use crate::loop_shaping::{DesignProblem, Samples};
use crate::plant_cache::PlantCache;

/// Outcome of a design.
#[derive(Clone, Debug)]
pub struct DesignOutcome {
    /// The best design; `None` if no controller was found.
    pub design: Option<Design>,
    /// Findings on impossible and difficult requirements; see [`diagnose`](super::diagnose).
    pub findings: Vec<Finding>,
    /// True if the watch stopped the design, which is then the best so far.
    pub stopped: bool,
    /// The attempt in progress when the design was stopped.
    pub(super) current: Option<Box<Attempt>>,
    pub(super) known: LearntPlants,
}

impl DesignOutcome {
    /// Every structure that was searched, in order, with its result.
    pub fn searched(&self) -> &[SearchedStructure] {
        &self.known.searched
    }

    /// Samples that the searches evaluated; `None` before the first search.
    pub fn samples(&self) -> Option<&Samples> {
        self.known.samples.as_ref()
    }

    /// Audits the present controller, if the design was stopped before any result; it becomes a
    /// design that has not converged.
    ///
    /// # Errors
    /// Errors of [`design`](super::design).
    pub fn conclude(&mut self) -> Result<(), LoopDesignError> {
        let current = self.current.take().filter(|attempt| !attempt.x().is_empty());
        if let (None, Some(mut attempt)) = (&self.design, current) {
            let audit = attempt.audited_as_it_is(&self.known.plants, &mut unwatched)?;
            let status = DesignStatus::NotConverged { rounds: attempt.rounds().len() };
            self.known.rounds.extend_from_slice(attempt.rounds());
            self.design = Some(design_of(&attempt, status, audit, &self.known.rounds)?);
        }
        Ok(())
    }
}

/// A design for other specifications of the plants and loop of an earlier design: plants sampled
/// then are not sampled again. Except for rounding, the result is that of
/// [`design`](super::design).
///
/// # Errors
/// Errors of [`design`](super::design).
///
/// # Example
/// A wider limit allows less gain, as a design from the beginning also finds:
/// ```
/// # use phea_dynamics::controller::Timing;
/// # use phea_dynamics::pieces::Workers;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_dynamics::watch::unwatched;
/// # use phea_qft::design::quantization::CoefficientFormat;
/// # use phea_qft::design::*;
/// # use phea_qft::family::{Extent, Family, UncertainFamily};
/// # use phea_qft::loop_shaping::Structure;
/// # use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// # use phea_qft::verification::TOLERANCE_DB;
/// # let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 4.0 };
/// # let plant = UncertainPlant::record(vec![gain], |p| {
/// #     let command = RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] };
/// #     PlantCoefficients { command, disturbance: None, dead_time_s: 0.0.into(), rate: None }
/// # })?;
/// # let members = vec![vec![1.0], vec![4.0]];
/// # let family = Family::Uncertain(UncertainFamily::new(plant, vec![], members, Extent::Members)?);
/// # let requirement = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.5));
/// # let problem = DesignProblem {
/// #     family, // 1/s, 4/s
/// #     additional_plants: vec![],
/// #     sensor: TransferFunction::gain_only(1.0),
/// #     timing: Timing::default(),
/// #     specifications: vec![Specification { requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s: [0.0, 1.0] }],
/// #     minimum_delay_margin_s: 0.0,
/// # };
/// # let pure_gain = Structure { sign: 1.0, gain: [0.01, 100.0], parts: vec![] };
/// # let options = DesignOptions {
/// #     objective: Objective::LeastHighFrequencyGain,
/// #     controller: ControllerChoice::Given(pure_gain),
/// #     prefilter: PrefilterChoice::None,
/// #     seed: 1, tolerance_db: TOLERANCE_DB, reserve_db: 0.0, poles: PoleRange::default(), coefficients: CoefficientFormat::Double,
/// #     workers: Workers::CALLER,
/// # };
/// let before = design(&problem, &options, &mut unwatched)?;
/// let mut wider = problem.clone();
/// wider.specifications[0].requirement = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.6));
/// let after = design_after(&wider, &options, &before, &mut unwatched)?.design.ok_or("none was found")?;
/// let gain = after.controller.feedback.transfer_function()?.gain();
/// // |1/(1 + k/j)| = 0.6 of the plant 1/s at 1 rad/s
/// assert!((gain / (1.0 / 0.36 - 1.0_f64).sqrt() - 1.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn design_after(
    problem: &DesignProblem,
    options: &DesignOptions,
    before: &DesignOutcome,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    design_knowing(problem, options, None, before.known.of_plants(), watch)
}

/// A design for stricter limits than those of an earlier design: structures shorter than the one
/// that met them are skipped, and the search also begins with that controller.
///
/// # Errors
/// Errors of [`design`](super::design).
pub fn design_stricter(
    problem: &DesignProblem,
    options: &DesignOptions,
    before: &DesignOutcome,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    let met = before.design.clone().filter(|design| design.status == DesignStatus::Met);
    design_knowing(problem, options, met, before.known.of_plants(), watch)
}

/// Data learnt about the plants.
#[derive(Clone, Debug, Default)]
pub(super) struct LearntPlants {
    /// The samples that searches evaluate; `None` before the first search.
    pub(super) samples: Option<Samples>,
    /// The plants that audits sampled.
    pub(super) plants: PlantCache,
    pub(super) rounds: Vec<DesignRound>,
    pub(super) searched: Vec<SearchedStructure>,
}

impl LearntPlants {
    /// Empty data, with the workers that search for plants.
    pub(super) fn of(workers: Workers) -> LearntPlants {
        LearntPlants { plants: PlantCache::of(workers), ..LearntPlants::default() }
    }

    /// The plants only, for a design with other specifications.
    fn of_plants(&self) -> LearntPlants {
        LearntPlants { plants: self.plants.clone(), ..LearntPlants::default() }
    }
}
