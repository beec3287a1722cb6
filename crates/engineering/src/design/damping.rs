//! Pressure feedback as a free part of a design: it is found first, for the plants of the family,
//! then the loop is designed for the damped rig.
//!
//! ```text
//! P         plants without feedback
//! P_1       plants with a small feedback of gain k_1:   Q = (P/P_1 - 1)/k_1       from command to pressure signal
//! for plants with lumped lines also with their waves
//! P, Q -> qft::inner_loop -> gain, corner -> the rig with them -> the loop, as for any project
//! ```
//!
//! The given controller retains the feedback that the project states; everything after it has the
//! one that was found. The order is from the inner loop outwards, since the feedback then does not
//! depend on a loop that is opened, limited or designed anew, and since its search takes a second,
//! whereas otherwise each of its values would need a design.

mod plants;

use phea_dynamics::controller::InnerFeedback;
use phea_dynamics::watch::{Watch, report_progress};
use phea_qft::family::Family;
use phea_qft::inner_loop::{FoundInnerFeedback, InnerLoopLimits, InnerLoopProblem, InnerPoint};

use self::plants::{ProbedPlants, least_damping_ratio};
use super::deployable::{NOISE_TO_COMMAND_LEFT, design_limits, limit_value};
use super::{DesignError, ProjectDesign};
use crate::family::family;
use crate::limit_kind::DesignLimitKind;
use crate::project::{DeclaredController, DeclaredPressureFeedback, FeedbackChoice, Project, Transfer};
use crate::robust::{RobustError, robust_problem};
use crate::setup::{Setup, with_pressure_feedback};
use crate::source::Source;
use crate::trial;

/// Factor by which a feedback must raise the gain of a proportional loop.
const EARNED: f64 = 1.1;
/// Ratios of the corner frequencies to the frequency that limits the loop without feedback.
const CORNERS: [f64; 2] = [1.0 / 30.0, 3.0];
/// Ratio of the largest corner to pi/T and to the low pass.
const BELOW_END: f64 = 0.9;
/// Ratio of the frequency at which loop gains are compared to the one that limits the loop without
/// feedback.
const REFERENCE: f64 = 0.25;
/// Ratios that bound the band of resonance poles, relative to the frequency that limits the loop
/// without feedback.
const RESONANCE: [f64; 2] = [0.5, 2.0];
/// Distance from -1 if the design has no limit for it.
const MODULUS_MARGIN: f64 = 0.5;

/// Pressure feedback of a design, with its effect.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureFeedbackDesign {
    /// Feedback as declared in a project: gain and high pass as found, the rest as in the project.
    pub declared: DeclaredPressureFeedback,
    /// True if the design uses it; false if it gains too little.
    pub is_used: bool,
    /// Ratio of the largest gain of a proportional loop with it to that without.
    pub loop_gain_factor: f64,
    /// Largest gain of a proportional loop without and with it, V/N.
    pub proportional_gain: [f64; 2],
    /// Frequency at which a proportional loop is limited, without and with it, rad/s.
    pub limited_at_rad_per_s: [f64; 2],
    /// Least damping ratio of the plants' oscillations within a factor of two of the first of
    /// these, without and with it; `None` if plants have no polynomials, or do not oscillate there.
    pub least_damping_ratio: Option<[f64; 2]>,
    /// Number of plants with which it was found.
    pub plants: usize,
    /// Plants with waves in their lines that are missing in the search; absent if none is missing.
    pub missing_with_waves: Option<MissingPlants>,
}

/// Plants that have no responses.
#[derive(Clone, Debug, PartialEq)]
pub struct MissingPlants {
    /// Number of missing plants.
    pub count: usize,
    /// Number of all plants.
    pub of: usize,
    /// Reason why the first of them has none.
    pub reason: DesignError,
}

/// The project with the feedback that was found; `None` if it is not free.
///
/// # Errors
/// [`DesignError::NoPressureFeedback`] if no gain satisfies the limits, others for a family that
/// cannot be built or sampled, and for cancellation by `watch`.
pub fn with_free_pressure_feedback(
    source: &dyn Source,
    setup: &Setup<'_>,
    watch: Watch<'_>,
) -> Result<Option<(Project, PressureFeedbackDesign)>, DesignError> {
    let project = setup.project;
    let choice = project.design.as_ref().map(|design| design.pressure_feedback);
    if choice != Some(FeedbackChoice::Free) {
        return Ok(None);
    }
    report_progress(watch, "pressure feedback", 0, 1)?;
    let declared = project.controller.as_ref().and_then(|controller| controller.pressure_feedback);
    let declared = declared.unwrap_or_default();
    let plain = with_pressure_feedback(project, None);
    let undamped = Setup::new(&plain)?;
    let mut probed = ProbedPlants::new(source, &undamped, &declared)?.complete()?;
    // a stated lumped line hides waves from the loop, but not from the pressures
    let with_waves = trial::with_waves(&plain);
    let with_waves = with_waves.as_ref().map(|other| {
        let setup = Setup::new(other)?;
        ProbedPlants::new(source, &setup, &declared)
    });
    let missing_with_waves = with_waves.and_then(|waves| probed.add(waves));
    let problem = problem(source, &undamped, &declared, &probed)?;
    let Some(found) = problem.best()? else { return Err(DesignError::NoPressureFeedback) };
    report_progress(watch, "pressure feedback", 1, 1)?;
    let declared = DeclaredPressureFeedback {
        gain: found.feedback.gain,
        high_pass: found.feedback.high_pass_rad_per_s,
        ..declared
    };
    let with = with_pressure_feedback(project, Some(declared));
    let found = described((source, &undamped), &with, declared, (&found, &probed))?;
    let found = PressureFeedbackDesign { missing_with_waves, ..found };
    Ok(Some((if found.is_used { with } else { plain }, found)))
}

/// Effect of a feedback, for display and for programs.
fn described(
    (source, undamped): (&dyn Source, &Setup<'_>),
    with: &Project,
    declared: DeclaredPressureFeedback,
    (found, probed): (&FoundInnerFeedback, &ProbedPlants),
) -> Result<PressureFeedbackDesign, DesignError> {
    let loop_gain_factor = found.reach.loop_gain / found.without.loop_gain;
    let with = Setup::new(with)?;
    let band = RESONANCE.map(|factor| factor * found.without.frequency_rad_per_s);
    let ratio = |setup: &Setup<'_>| least_damping_ratio(source, setup, (probed, band));
    let least_damping_ratio = match ratio(undamped)? {
        Some(without) => ratio(&with)?.map(|with| [without, with]),
        None => None,
    };
    Ok(PressureFeedbackDesign {
        declared,
        is_used: loop_gain_factor >= EARNED,
        loop_gain_factor,
        proportional_gain: [found.without.outer_gain, found.reach.outer_gain],
        limited_at_rad_per_s: [found.without.frequency_rad_per_s, found.reach.frequency_rad_per_s],
        least_damping_ratio,
        plants: probed.plants.len(),
        missing_with_waves: None,
    })
}

/// Plants with the limits that the design has too.
fn problem(
    source: &dyn Source,
    undamped: &Setup<'_>,
    declared: &DeclaredPressureFeedback,
    probed: &ProbedPlants,
) -> Result<InnerLoopProblem, DesignError> {
    let given = robust_problem(source, undamped)?;
    let limits = design_limits(undamped, &given);
    let value = |kind| limit_value(&limits, kind);
    let nominal_v = undamped.rig().map(|rig| rig.actuator.components().valve.nominal_voltage).ok();
    let noise = value(DesignLimitKind::NoiseToCommand).zip(nominal_v).filter(|_| declared.noise > 0.0);
    let mut problem = InnerLoopProblem {
        plants: probed.plants.clone(),
        timing: undamped.timing,
        low_pass_rad_per_s: declared.low_pass,
        high_pass_rad_per_s: [f64::NAN; 2],
        limits: InnerLoopLimits {
            modulus_margin: value(DesignLimitKind::ModulusMargin).unwrap_or(MODULUS_MARGIN),
            delay_margin_s: value(DesignLimitKind::MinimumDelayMargin).unwrap_or(0.0),
            highest_bandwidth_rad_per_s: value(DesignLimitKind::HighestBandwidth).unwrap_or(f64::INFINITY),
            noise: noise.map(|(fraction, volts)| [declared.noise, NOISE_TO_COMMAND_LEFT * fraction * volts]),
        },
    };
    let without = problem.reach(&InnerFeedback::default())?.ok_or(DesignError::NoPressureFeedback)?;
    let limiting = without.frequency_rad_per_s;
    for plant in &mut problem.plants {
        let near = |point: &&InnerPoint| (point.frequency_rad_per_s / (REFERENCE * limiting) - 1.0).abs();
        let point = plant.points.iter().min_by(|one, other| near(one).total_cmp(&near(other)));
        plant.reference = point.copied().unwrap_or(plant.reference);
    }
    let end = undamped.timing.sample_time_s.map_or(f64::INFINITY, |time_s| std::f64::consts::PI / time_s);
    let end = BELOW_END * end.min(declared.low_pass.unwrap_or(f64::INFINITY));
    let [low, high] = CORNERS.map(|factor| (factor * limiting).min(end));
    problem.high_pass_rad_per_s = [low, high];
    Ok(problem)
}

/// Family of a project for a loop without sampling and delay, with pressure feedback.
///
/// # Errors
/// [`DesignError`] for a family that cannot be built.
pub(super) fn family_at_once(source: &dyn Source, project: &Project) -> Result<Family, DesignError> {
    let controller = project.controller.clone().unwrap_or_default();
    let controller = DeclaredController {
        transfer: Transfer::default(),
        sample_time: None,
        delay: 0.0,
        quantization: None,
        ..controller
    };
    let at_once = Project { controller: Some(controller), prefilter: None, ..project.clone() };
    Ok(family(&Setup::new(&at_once)?, source).map_err(RobustError::from)?)
}

impl ProjectDesign {
    /// The design with the pressure feedback that was found before the loop.
    pub(super) fn with_pressure_feedback(mut self, found: Option<PressureFeedbackDesign>) -> ProjectDesign {
        if let Some(repair) = &mut self.repair
            && let Some(other) = &mut repair.other
        {
            other.pressure_feedback = found.clone();
        }
        ProjectDesign { pressure_feedback: found, ..self }
    }
}
