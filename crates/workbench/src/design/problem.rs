//! From a project to what a design begins with.

use num_complex::Complex64;
use phea_dynamics::controller::Element;
use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_dynamics::portable;
use phea_qft::design::{ControllerChoice, DesignOptions, DesignProblem, Objective, PrefilterChoice};
use phea_qft::family::Family;
use phea_qft::loop_shaping::{Part, Structure};
use phea_qft::specification::Requirement;
use phea_qft::verification::TOLERANCE_DB;

use crate::command::CommandError;
use crate::control::{ControlError, element, prefilter, sensor, timing};
use crate::project::{DesignObjective, PartKind, Project, StructurePart};
use crate::robust::RobustProblem;

/// How far corner frequencies may lie below and above the design frequencies.
const FREQUENCY_FACTORS: [f64; 2] = [0.1, 100.0];
/// Damping ratios of a pair whose project says nothing of them.
const DAMPING_RATIOS: [f64; 2] = [0.1, 5.0];
/// How far the gain may lie from those that bring the nominal loop to 1 at a design frequency.
const GAIN_FACTOR: f64 = 1e4;

/// What must be kept to, by which plants, in which loop.
///
/// # Errors
/// [`CommandError`] for a sensor that is no transfer function.
pub fn design_problem(project: &Project, given: &RobustProblem) -> Result<DesignProblem, CommandError> {
    Ok(DesignProblem {
        family: given.family.clone(),
        sensor: sensor(project)?,
        timing: timing(project),
        specifications: given.specifications.clone(),
        minimum_delay_margin_s: project.design.clone().unwrap_or_default().minimum_delay_margin,
    })
}

/// How a design is made: by [design], or its defaults; `seed` in place of the project's.
///
/// # Errors
/// [`CommandError`] for a prefilter that is no transfer function, or a nominal plant that cannot be sampled.
pub fn design_options(
    project: &Project,
    given: &RobustProblem,
    seed: Option<u32>,
) -> Result<DesignOptions, CommandError> {
    let design = project.design.clone().unwrap_or_default();
    let controller = if design.structure.is_empty() {
        ControllerChoice::Grow { maximum_order: count(design.maximum_order) }
    } else {
        ControllerChoice::Given(structure(&design.structure, design.gain, given)?)
    };
    Ok(DesignOptions {
        objective: match design.objective {
            DesignObjective::LeastHighFrequencyGain => Objective::LeastHighFrequencyGain,
            DesignObjective::LeastBandwidth => Objective::LeastBandwidth,
            DesignObjective::BestWorstMargin => Objective::BestWorstMargin,
        },
        controller,
        prefilter: prefilter_choice(project, given, design.prefilter_maximum_order)?,
        seed: u64::from(seed.unwrap_or(design.seed)),
        tolerance_db: TOLERANCE_DB,
    })
}

fn count(number: u32) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// A prefilter is designed for tracking alone, and never in place of one that stands beside a controller without a law.
fn prefilter_choice(
    project: &Project,
    given: &RobustProblem,
    maximum_order: u32,
) -> Result<PrefilterChoice, CommandError> {
    let tracks = |one: &phea_qft::specification::Specification| {
        matches!(one.requirement, Requirement::Tracking { .. })
    };
    let is_designed = given.specifications.iter().any(tracks) && maximum_order > 0;
    let is_kept = project.prefilter.is_some() && (!given.has_controller || !is_designed);
    Ok(match prefilter(project)? {
        Some(kept) if is_kept => PrefilterChoice::Given(kept.transfer_function()?),
        _ if is_designed => PrefilterChoice::Grow { maximum_order: count(maximum_order) },
        _ => PrefilterChoice::None,
    })
}

fn structure(
    declared: &[StructurePart],
    gain: Option<[f64; 2]>,
    given: &RobustProblem,
) -> Result<Structure, CommandError> {
    let frequencies = given.design_frequencies();
    let first = frequencies.first().copied().unwrap_or(1.0);
    let last = frequencies.last().copied().unwrap_or(1.0);
    let wide = [first * FREQUENCY_FACTORS[0], last * FREQUENCY_FACTORS[1]];
    let parts = declared.iter().map(|one| part(one, wide)).collect::<Result<Vec<Part>, ControlError>>()?;
    let (sign, gain) = match gain {
        Some([low, high]) if high < 0.0 => (-1.0, [-high, -low]),
        Some(gain) => (1.0, gain),
        None => likely_gain(&parts, given, &frequencies)?,
    };
    Ok(Structure { sign, gain, parts })
}

/// A part that the project declares; validated, so that a fixed one has its element.
fn part(declared: &StructurePart, wide: [f64; 2]) -> Result<Part, ControlError> {
    let frequency = declared.frequency.unwrap_or(wide);
    let damping_ratio = declared.damping_ratio.unwrap_or(DAMPING_RATIOS);
    Ok(match declared.kind {
        PartKind::Integrator => Part::Fixed(Element::Integrator),
        PartKind::Zero => Part::RealZero { frequency },
        PartKind::Pole => Part::RealPole { frequency },
        PartKind::ZeroPair => Part::ZeroPair { natural_frequency: frequency, damping_ratio },
        PartKind::PolePair => Part::PolePair { natural_frequency: frequency, damping_ratio },
        PartKind::Fixed => Part::Fixed(match &declared.element {
            // in s, as every factor is
            Some(fixed) => element("[design]", fixed, None)?,
            None => Element::Gain(1.0),
        }),
    })
}

/// The sign under which feedback opposes the nominal plant, and gains around those that bring the nominal loop to 1 at a design
/// frequency, whatever the free numbers of the structure do there.
fn likely_gain(
    parts: &[Part],
    given: &RobustProblem,
    frequencies: &[f64],
) -> Result<(f64, [f64; 2]), LinearError> {
    let fixed: Vec<TransferFunction> = parts
        .iter()
        .filter_map(
            |part| if let Part::Fixed(element) = part { Some(element.transfer_function()) } else { None },
        )
        .collect::<Result<_, _>>()?;
    let nominal = given.nominal()?;
    let at = |frequency: f64| {
        let plant = nominal.as_ref().and_then(|member| member.response(frequency))?;
        let size = |value: Complex64| portable::magnitude(value);
        let known: f64 = fixed.iter().map(|function| size(function.at_frequency(frequency))).product();
        Some(1.0 / (size(plant.plant) * size(plant.sensor) * known))
            .filter(|gain| gain.is_finite() && *gain > 0.0)
    };
    let gains: Vec<f64> = frequencies.iter().filter_map(|&frequency| at(frequency)).collect();
    let low = gains.iter().copied().fold(f64::INFINITY, f64::min);
    let high = gains.iter().copied().fold(0.0, f64::max);
    let gain = if gains.is_empty() { [1.0, 1.0] } else { [low, high] };
    let sign = nominal_plant(&given.family)?.as_ref().map_or(1.0, opposing_sign);
    Ok((sign, [gain[0] / GAIN_FACTOR, gain[1] * GAIN_FACTOR]))
}

/// P of the nominal plant without its dead time; `None` for a measured one.
fn nominal_plant(family: &Family) -> Result<Option<TransferFunction>, LinearError> {
    let Family::Uncertain(family) = family else { return Ok(None) };
    let plant = family.plant().coefficients(&family.plant().nominal()).command;
    let [above, below] = [plant.numerator, plant.denominator].map(Polynomial::new);
    TransferFunction::from_polynomials(&above, &below).map(Some)
}

/// That of the response towards zero frequency for a plant that is stable or integrates, of the leading coefficient for any other.
fn opposing_sign(plant: &TransferFunction) -> f64 {
    if plant.poles().iter().any(|pole| pole.re > 0.0) {
        return plant.gain().signum();
    }
    let away = |roots: &[Complex64]| roots.iter().filter(|root| root.im == 0.0 && root.re > 0.0).count();
    // each real root to the right turns the sign of k (0 - z_1) (0 - z_2) .../...
    if away(plant.zeros()) % 2 == 0 { plant.gain().signum() } else { -plant.gain().signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plant(gain: f64, zeros: &[f64], poles: &[f64]) -> TransferFunction {
        let roots = |roots: &[f64]| roots.iter().map(|root| Complex64::new(*root, 0.0)).collect();
        TransferFunction::from_factors(gain, roots(zeros), roots(poles)).unwrap()
    }

    /// Integral control of a stable plant needs the sign of its gain at zero frequency; (s + a)/(s^2 - 2.5) needs k > 0.
    #[test]
    fn feedback_opposes_the_plant() {
        assert_eq!(opposing_sign(&plant(2.0, &[], &[-1.0, -3.0])), 1.0);
        assert_eq!(opposing_sign(&plant(-2.0, &[], &[0.0])), -1.0);
        assert_eq!(opposing_sign(&plant(-1.0, &[1.0], &[-1.0, -1.0])), 1.0);
        assert_eq!(opposing_sign(&plant(1.0, &[-0.1], &[1.5, -1.5])), 1.0);
    }
}
