//! Limit over frequency from each form in which it may be written.

use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_qft::specification::{
    ClosedLoop, ExtraRoot, Limit, LimitTable, LowerWish, MarginError, Translation, UpperWish, WishCheck,
    check_lower, check_upper, delay_margin_limit, robust_stability_limit_for_gain_increase,
    robust_stability_limit_for_gain_reduction, robust_stability_limit_for_modulus_margin,
    robust_stability_limit_for_phase_margin, sensitivity_limit_for_gain_increase,
    sensitivity_limit_for_gain_reduction, sensitivity_limit_for_modulus_margin,
    sensitivity_limit_for_phase_margin, tracking_lower, tracking_upper,
};

use super::SpecificationProblem;
use crate::project::{self, MarginWish, Rational, ResponseWish};
use crate::setup::from_formulas;

/// Forms that a key accepts in addition to those that all keys accept.
#[derive(Clone, Copy, Debug)]
pub(super) enum Takes {
    /// Margins, for robust stability or the sensitivity.
    MarginsOf(ClosedLoop),
    Wish(TrackingSide),
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
        (project::DeclaredLimit::Margins(wish), Takes::MarginsOf(closed_loop)) => {
            of_margins(wish, closed_loop)?
        }
        (project::DeclaredLimit::Response(wish), Takes::Wish(side)) => {
            Limit::Rational(of_wish(wish, side)?.0)
        }
        (project::DeclaredLimit::Margins(_), _) => return Err(SpecificationProblem::TakesNoMargins),
        (project::DeclaredLimit::Response(_), _) => return Err(SpecificationProblem::TakesNoWish),
    })
}

fn function(rational: &Rational) -> Result<TransferFunction, SpecificationProblem> {
    let function = from_formulas(&rational.numerator, &rational.denominator);
    Ok(function.map_err(SpecificationProblem::Formula)??)
}

/// Strictest of the limits that guarantee the margins, or the one that guarantees the delay.
fn of_margins(wish: &MarginWish, closed_loop: ClosedLoop) -> Result<Limit, SpecificationProblem> {
    if let (Some(delay_s), ClosedLoop::RobustStability) = (wish.delay_margin, closed_loop) {
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
    let wishes = [wish.gain_margin, wish.gain_reduction, wish.phase_margin, wish.modulus_margin];
    let mut strictest = None::<f64>;
    for (wished, translate) in wishes.into_iter().zip(translations) {
        if let Some(wished) = wished {
            let limit = translate(wished)?;
            strictest = Some(strictest.map_or(limit, |known| known.min(limit)));
        }
    }
    strictest.map(Limit::Constant).ok_or(SpecificationProblem::Missing)
}

/// Limit that follows from a requirement in time, or the one given with it, and its response in
/// time.
pub(super) fn of_wish(
    wish: &ResponseWish,
    side: TrackingSide,
) -> Result<(TransferFunction, WishCheck), SpecificationProblem> {
    let needed = |value: Option<f64>| value.ok_or(SpecificationProblem::Missing);
    let settling_time_s = needed(wish.settling_time)?;
    let settling_band_percent = needed(wish.settling_band_percent)?;
    let translation = wish.rule.map_or(Translation::Exact, Translation::Rule);
    let given = wish.function.as_ref().map(function).transpose()?;
    match side {
        TrackingSide::Upper => {
            let overshoot_percent = needed(wish.overshoot_percent)?;
            let wished = UpperWish { overshoot_percent, settling_time_s, settling_band_percent };
            if let Some(function) = given {
                let check = check_upper(&function, &wished)?;
                return Ok((function, check));
            }
            let limit = tracking_upper(&wished, extra(wish.zero), translation)?;
            Ok((limit.function, limit.check))
        }
        TrackingSide::Lower => {
            let wished = LowerWish { settling_time_s, settling_band_percent };
            if let Some(function) = given {
                let check = check_lower(&function, &wished)?;
                return Ok((function, check));
            }
            let limit = tracking_lower(&wished, extra(wish.pole), translation)?;
            Ok((limit.function, limit.check))
        }
    }
}

fn extra(root: Option<f64>) -> ExtraRoot {
    root.map_or(ExtraRoot::None, |rad_per_s| ExtraRoot::At { rad_per_s })
}
