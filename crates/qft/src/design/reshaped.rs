//! The controller of a design, reshaped for another loop around its plants.

use phea_dynamics::controller::Controller;
use phea_dynamics::watch::Watch;

use super::attempt::LoopDesignError;
use super::problem::{ControllerChoice, DesignOptions};
use super::result::{Design, DesignStatus};
use super::run::DesignProgress;
use crate::loop_shaping::DesignProblem;
use crate::plant_cache::PlantCache;

/// Reshapes the structure of a design for another problem, by a descent from its controller: for
/// example to find the performance possible with another timing of the loop. The result is not
/// audited. `None` if no stabilising controller is found.
///
/// # Errors
/// Errors of [`design`](super::design), and [`LoopDesignError::Stopped`] by the watch.
///
/// # Example
/// Plants 1/s and 4/s with |S| <= 1/2 required up to 1 rad/s, which a gain of sqrt(3) reaches at
/// the smallest k; with |S| <= 3/5 a gain of 4/3 is enough:
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
/// let found = design(&problem, &options, &mut unwatched)?.design.ok_or("none was found")?;
/// let mut wider = problem.clone();
/// wider.specifications[0].requirement = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.6));
/// let reshaped = reshaped(&wider, &options, &found, &mut unwatched)?.ok_or("none was found")?;
/// let gain = reshaped.feedback.transfer_function()?.gain();
/// assert!((gain / (4.0 / 3.0) - 1.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn reshaped(
    problem: &DesignProblem,
    options: &DesignOptions,
    design: &Design,
    watch: Watch<'_>,
) -> Result<Option<Controller>, LoopDesignError> {
    let cache = PlantCache::of(options.workers);
    let controller = ControllerChoice::Given(design.structure.clone());
    let options = DesignOptions { controller, ..options.clone() };
    let mut progress = DesignProgress::new(problem, &options, &cache);
    progress.relaxing = matches!(design.status, DesignStatus::Infeasible(_));
    let feedback = design.law.feedback.transfer_function()?;
    let mut attempt = progress.attempt(design.structure.clone(), Some(feedback))?;
    let is_found = attempt.reshape(&cache, watch)?;
    Ok(is_found.then(|| attempt.shaping().controller(attempt.x())))
}
