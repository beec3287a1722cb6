//! Problem of a design, from a project.

use phea_dynamics::controller::Element;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;
use phea_qft::design::{ControllerChoice, DesignOptions, DesignProblem, PrefilterChoice, gain_range};
use phea_qft::loop_shaping::{Structure, StructureFactor};

use super::DesignError;
use super::deployable::{design_limits, limit_value, pole_range};
use crate::limit_kind::DesignLimitKind;
use crate::project::{DeclaredDesign, StructureChoice, StructurePart};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::setup::{ControlError, LawPlace, element};
use crate::side_by_side::all_cores;

/// Range of corner frequencies below and above the design frequencies.
const FREQUENCY_FACTORS: [f64; 2] = [0.1, 100.0];
/// Factor by which a further pole must reduce the noise in the command: 6 dB.
const EARNED_PER_POLE: f64 = 2.0;
/// Damping ratios of a pair for which the project states none.
const DAMPING_RATIOS: [f64; 2] = [0.1, 5.0];

/// Problem of a design: specifications, plants and loop.
pub fn design_problem(setup: &Setup<'_>, given: &RobustProblem) -> DesignProblem {
    DesignProblem {
        family: given.family.clone(),
        additional_plants: vec![],
        sensor: setup.sensor.clone(),
        timing: setup.timing,
        specifications: given.specifications.clone(),
        minimum_delay_margin_s: limit_value(
            &design_limits(setup, given),
            DesignLimitKind::MinimumDelayMargin,
        )
        .unwrap_or(0.0),
    }
}

/// Options of a design: from `[design]`, or the defaults; `seed` replaces that of the project.
///
/// # Errors
/// [`DesignError`] for a prefilter that is not a transfer function, or a nominal plant that
/// cannot be sampled.
pub fn design_options(
    setup: &Setup<'_>,
    given: &RobustProblem,
    seed: Option<u32>,
) -> Result<DesignOptions, DesignError> {
    let design = setup.project.design.clone().unwrap_or_default();
    let maximum_order = count(design.maximum_order);
    let earned_per_pole_db = earned_per_pole_db(&design);
    let controller = match design.structure_choice {
        _ if !design.structure.is_empty() => {
            let problem = design_problem(setup, given);
            let frequencies = given.design_frequencies();
            ControllerChoice::Given(structure(&design.structure, design.gain, &problem, &frequencies)?)
        }
        StructureChoice::Named(name) => ControllerChoice::Named { name, earned_per_pole_db },
        StructureChoice::Free => ControllerChoice::Grow { maximum_order },
        StructureChoice::Any => {
            let with_pure_gain = given.design_limits.contains(&DesignLimitKind::RequiredStep);
            ControllerChoice::Any { maximum_order, from: None, with_pure_gain, earned_per_pole_db }
        }
    };
    Ok(DesignOptions {
        objective: design.objective,
        controller,
        prefilter: prefilter_choice(setup, given, design.prefilter_maximum_order)?,
        seed: u64::from(seed.unwrap_or(design.seed)),
        tolerance_db: given.tolerance_db,
        reserve_db: design.reserve.map_or(0.0, |factor| 20.0 * portable::log10(factor)),
        poles: pole_range(&design_limits(setup, given)),
        coefficients: setup.quantization.coefficients,
        workers: all_cores(),
    })
}

/// Gain that a further pole must bring, dB.
fn earned_per_pole_db(design: &DeclaredDesign) -> f64 {
    20.0 * portable::log10(design.earned_per_pole.unwrap_or(EARNED_PER_POLE))
}

fn count(number: u32) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// Choice of the prefilter: one is designed for tracking only, and never in place of one that is
/// given together with a controller without a transfer function.
fn prefilter_choice(
    setup: &Setup<'_>,
    given: &RobustProblem,
    maximum_order: u32,
) -> Result<PrefilterChoice, LinearError> {
    let tracks = |one: &phea_qft::specification::Specification| one.requirement.is_tracking();
    let is_designed = given.specifications.iter().any(tracks) && maximum_order > 0;
    let is_satisfied = setup.prefilter.is_some() && (!given.has_controller || !is_designed);
    Ok(match &setup.prefilter {
        Some(kept) if is_satisfied => PrefilterChoice::Given(kept.transfer_function()?),
        _ if is_designed => PrefilterChoice::Grow { maximum_order: count(maximum_order) },
        _ => PrefilterChoice::None,
    })
}

fn structure(
    declared: &[StructurePart],
    gain: Option<[f64; 2]>,
    problem: &DesignProblem,
    frequencies: &[f64],
) -> Result<Structure, ControlError> {
    let first = frequencies.first().copied().unwrap_or(1.0);
    let last = frequencies.last().copied().unwrap_or(1.0);
    let wide = [first * FREQUENCY_FACTORS[0], last * FREQUENCY_FACTORS[1]];
    let parts =
        declared.iter().map(|one| part(one, wide)).collect::<Result<Vec<StructureFactor>, ControlError>>()?;
    let (sign, gain) = match gain {
        Some([low, high]) if high < 0.0 => (-1.0, [-high, -low]),
        Some(gain) => (1.0, gain),
        None => gain_range(problem),
    };
    Ok(Structure { sign, gain, parts })
}

/// A part that the project declares; the ranges of its free numbers are wide if it states none.
fn part(declared: &StructurePart, wide: [f64; 2]) -> Result<StructureFactor, ControlError> {
    let pair = |frequency: &Option<[f64; 2]>, damping_ratio: &Option<[f64; 2]>| {
        (frequency.unwrap_or(wide), damping_ratio.unwrap_or(DAMPING_RATIOS))
    };
    Ok(match declared {
        StructurePart::Integrator => StructureFactor::Fixed(Element::Integrator),
        StructurePart::Zero { frequency } => {
            StructureFactor::RealZero { frequency: frequency.unwrap_or(wide) }
        }
        StructurePart::Pole { frequency } => {
            StructureFactor::RealPole { frequency: frequency.unwrap_or(wide) }
        }
        StructurePart::ZeroPair { frequency, damping_ratio } => {
            let (natural_frequency, damping_ratio) = pair(frequency, damping_ratio);
            StructureFactor::ZeroPair { natural_frequency, damping_ratio }
        }
        StructurePart::PolePair { frequency, damping_ratio } => {
            let (natural_frequency, damping_ratio) = pair(frequency, damping_ratio);
            StructureFactor::PolePair { natural_frequency, damping_ratio }
        }
        // in s, as every factor is
        StructurePart::Fixed { element: fixed } => {
            StructureFactor::Fixed(element(LawPlace::Design, fixed, None)?)
        }
    })
}
