//! Limit over frequency from each form in which it may be written.

use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_qft::specification::{
    ClosedLoop, ExtraRoot, Limit, LimitTable, LowerStepRequirement, MarginError, RequirementCheck,
    Translation, UpperStepRequirement, check_lower, check_upper, delay_margin_limit,
    robust_stability_limit_for_gain_increase, robust_stability_limit_for_gain_reduction,
    robust_stability_limit_for_modulus_margin, robust_stability_limit_for_phase_margin,
    sensitivity_limit_for_gain_increase, sensitivity_limit_for_gain_reduction,
    sensitivity_limit_for_modulus_margin, sensitivity_limit_for_phase_margin, tracking_lower, tracking_upper,
};

use super::SpecificationProblem;
use crate::project::{self, MarginRequirement, Rational, ResponseRequirement};
use crate::setup::from_formulas;

/// Forms that a key accepts in addition to those that all keys accept.
#[derive(Clone, Copy, Debug)]
pub(super) enum Takes {
    /// Margins, for robust stability or the sensitivity.
    MarginsOf(ClosedLoop),
    RequirementInTime(TrackingSide),
}

/// Side of tracking that is limited.
#[derive(Clone, Copy, Debug)]
pub(super) enum TrackingSide {
    Upper,
    Lower,
}

pub(super) fn over_frequency(
    limit: &project::DeclaredLimit,
    takes: Takes,
) -> Result<Limit, SpecificationProblem> {
    Ok(match (limit, takes) {
        (project::DeclaredLimit::Constant(value), _) => Limit::Constant(*value),
        (project::DeclaredLimit::Text(formula), _) => {
            let ratio = formula.numbers().map_err(SpecificationProblem::Formula)?;
            let [numerator, denominator] = [ratio.numerator, ratio.denominator].map(Polynomial::new);
            Limit::Rational(TransferFunction::from_polynomials(&numerator, &denominator)?)
        }
        (project::DeclaredLimit::Rational(rational), _) => Limit::Rational(function(rational)?),
        (project::DeclaredLimit::Table(table), _) => {
            let points = table.frequencies.iter().copied().zip(table.values.iter().copied());
            Limit::Table(LimitTable::new(points.collect())?)
        }
        (project::DeclaredLimit::Margins(requirement), Takes::MarginsOf(closed_loop)) => {
            of_margins(requirement, closed_loop)?
        }
        (project::DeclaredLimit::Response(requirement), Takes::RequirementInTime(side)) => {
            Limit::Rational(of_requirement(requirement, side)?.0)
        }
        (project::DeclaredLimit::Margins(_), _) => return Err(SpecificationProblem::TakesNoMargins),
        (project::DeclaredLimit::Response(_), _) => {
            return Err(SpecificationProblem::TakesNoRequirementInTime);
        }
    })
}

fn function(rational: &Rational) -> Result<TransferFunction, SpecificationProblem> {
    let function = from_formulas(&rational.numerator, &rational.denominator);
    Ok(function.map_err(SpecificationProblem::Formula)??)
}

/// Strictest of the limits that guarantee the margins, or the one that guarantees the delay.
fn of_margins(
    requirement: &MarginRequirement,
    closed_loop: ClosedLoop,
) -> Result<Limit, SpecificationProblem> {
    if let (Some(delay_s), ClosedLoop::RobustStability) = (requirement.delay_margin, closed_loop) {
        return Ok(delay_margin_limit(delay_s)?);
    }
    type Translate = fn(f64) -> Result<f64, MarginError>;
    let translations: [Translate; 4] = match closed_loop {
        ClosedLoop::RobustStability => [
            robust_stability_limit_for_gain_increase,
            robust_stability_limit_for_gain_reduction,
            robust_stability_limit_for_phase_margin,
            robust_stability_limit_for_modulus_margin,
        ],
        ClosedLoop::Sensitivity => [
            sensitivity_limit_for_gain_increase,
            sensitivity_limit_for_gain_reduction,
            sensitivity_limit_for_phase_margin,
            sensitivity_limit_for_modulus_margin,
        ],
        _ => return Err(SpecificationProblem::TakesNoMargins),
    };
    let margins = [
        requirement.gain_margin,
        requirement.gain_reduction,
        requirement.phase_margin,
        requirement.modulus_margin,
    ];
    let mut strictest = None::<f64>;
    for (required, translate) in margins.into_iter().zip(translations) {
        if let Some(required) = required {
            let limit = translate(required)?;
            strictest = Some(strictest.map_or(limit, |known| known.min(limit)));
        }
    }
    strictest.map(Limit::Constant).ok_or(SpecificationProblem::Missing)
}

/// Limit that follows from a requirement in time, or the one given with it, and its response in
/// time.
pub(super) fn of_requirement(
    requirement: &ResponseRequirement,
    side: TrackingSide,
) -> Result<(TransferFunction, RequirementCheck), SpecificationProblem> {
    let needed = |value: Option<f64>| value.ok_or(SpecificationProblem::Missing);
    let settling_time_s = needed(requirement.settling_time)?;
    let settling_band_percent = needed(requirement.settling_band_percent)?;
    let translation = requirement.rule.map_or(Translation::Exact, Translation::Rule);
    let given = requirement.function.as_ref().map(function).transpose()?;
    match side {
        TrackingSide::Upper => {
            let overshoot_percent = needed(requirement.overshoot_percent)?;
            let required = UpperStepRequirement { overshoot_percent, settling_time_s, settling_band_percent };
            if let Some(function) = given {
                let check = check_upper(&function, &required)?;
                return Ok((function, check));
            }
            let limit = tracking_upper(&required, extra(requirement.zero), translation)?;
            Ok((limit.function, limit.check))
        }
        TrackingSide::Lower => {
            let required = LowerStepRequirement { settling_time_s, settling_band_percent };
            if let Some(function) = given {
                let check = check_lower(&function, &required)?;
                return Ok((function, check));
            }
            let limit = tracking_lower(&required, extra(requirement.pole), translation)?;
            Ok((limit.function, limit.check))
        }
    }
}

fn extra(root: Option<f64>) -> ExtraRoot {
    root.map_or(ExtraRoot::None, |rad_per_s| ExtraRoot::At { rad_per_s })
}
