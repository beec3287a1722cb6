//! Limits of a deployable controller that a given loop violates, so that a design would reject it.
//! They are no part of its verdict.

use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::design::DesignProblem;
use phea_qft::specification::Specification;
use phea_qft::verification::{
    AuditProblem, SpecificationFinding, TrackingJudgement, Verdict, audit_specifications,
};

use super::deployable::{DesignLimit, design_limits};
use super::problem::design_problem;
use crate::audit::{DECIBELS_PER_NEPER, PrefilterGain, ProjectAudit, plants_of_margins};
use crate::limit_kind::{DesignLimitKind, ExceededLimit, JudgedLimits};
use crate::robust::RobustProblem;
use crate::setup::{Setup, is_of_position};

/// Limits of `[design]`, stated or by default, that the audited loop satisfies or violates; empty
/// if the family is not stable, which no design would return either, and for a plant without a rig
/// that states none.
///
/// Modulus and delay margin are those of the audit. Noise and bandwidth are the worst of the plants
/// whose margins it compares, over the whole band. The poles of a given controller are not judged:
/// their ranges are those of a search, not of a loop.
///
/// # Errors
/// [`Stopped`] if `watch` cancels it.
pub fn below_design(
    setup: &Setup<'_>,
    given: &RobustProblem,
    view: &ProjectAudit,
    watch: Watch<'_>,
) -> Result<JudgedLimits, Stopped> {
    if view.margins.family.is_none() || is_of_position(setup.project) {
        return Ok(JudgedLimits::default());
    }
    let limits = design_limits(setup, given);
    let (searched, stated) = limits.into_iter().partition::<Vec<DesignLimit>, _>(is_searched);
    let specifications: Vec<Specification> =
        searched.iter().filter_map(|limit| limit.specification.clone()).collect();
    let family = plants_of_margins(given, &view.audit);
    let problem = AuditProblem {
        family: &family,
        compensation: &given.compensation,
        specifications: &specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: given.tolerance_db,
    };
    let findings = if searched.is_empty() { vec![] } else { audit_specifications(&problem, watch)?.0 };
    let requested = design_problem(setup, given);
    let of_audit =
        stated.iter().filter_map(|limit| Some((limit, exceeded_margin(limit, &requested, given, view)?)));
    let violated = searched.iter().zip(&findings).filter(|(_, found)| found.verdict == Verdict::Violated);
    let of_search = violated.map(|(limit, found)| (limit, reached(limit, found)));
    let exceeded = |(limit, reached): (&DesignLimit, f64)| ExceededLimit {
        kind: limit.kind,
        reached,
        limit: limit.value,
        origin: limit.origin,
    };
    let exceeded: Vec<ExceededLimit> = of_audit.chain(of_search).map(exceeded).collect();
    let judged = searched.iter().chain(&stated).map(|limit| limit.kind);
    let is_satisfied =
        |kind: &DesignLimitKind| is_of_loop(*kind, given) && exceeded.iter().all(|one| one.kind != *kind);
    let satisfied = judged.filter(is_satisfied).collect();
    Ok(JudgedLimits { exceeded, satisfied })
}

/// True for a limit that applies to a given loop too, and not only to a search or to the scenarios.
fn is_of_loop(kind: DesignLimitKind, given: &RobustProblem) -> bool {
    match kind {
        DesignLimitKind::NoiseToCommand
        | DesignLimitKind::ModulusMargin
        | DesignLimitKind::HighestBandwidth
        | DesignLimitKind::MinimumDelayMargin => true,
        DesignLimitKind::PrefilterGain => given.has_prefilter,
        DesignLimitKind::PoleDampingRatio
        | DesignLimitKind::FastestPole
        | DesignLimitKind::CommandOfSteps
        | DesignLimitKind::RequiredStep => false,
    }
}

/// True for a limit for which the family is searched; the worst modulus is in the audit itself.
fn is_searched(limit: &DesignLimit) -> bool {
    limit.specification.is_some() && limit.kind != DesignLimitKind::ModulusMargin
}

/// Worst value of a margin in the audit, or largest gain of the prefilter, if it is beyond its
/// limit.
fn exceeded_margin(
    limit: &DesignLimit,
    requested: &DesignProblem,
    given: &RobustProblem,
    view: &ProjectAudit,
) -> Option<f64> {
    let worst = view.margins.family.as_ref()?;
    let tolerated = portable::exp(-given.tolerance_db / DECIBELS_PER_NEPER);
    match limit.kind {
        DesignLimitKind::ModulusMargin => {
            Some(worst.modulus.value).filter(|modulus| *modulus < tolerated * limit.value)
        }
        DesignLimitKind::MinimumDelayMargin => {
            Some(worst.delay_s.value).filter(|delay_s| !requested.tolerates_its_delay(*delay_s))
        }
        DesignLimitKind::PrefilterGain => {
            let largest = PrefilterGain::of_loop(&given.compensation).largest;
            Some(largest).filter(|gain| given.has_prefilter && *gain > limit.value)
        }
        _ => None,
    }
}

/// Value that the worst plant reaches for a limit that it violates: the end of the last band in
/// which it does, or the limit multiplied according to its margin.
fn reached(limit: &DesignLimit, found: &SpecificationFinding) -> f64 {
    if limit.kind == DesignLimitKind::HighestBandwidth {
        return found.violations.last().map_or(f64::INFINITY, |band| band.band_rad_per_s[1]);
    }
    let margin_db = found.worst.as_ref().map_or(0.0, |worst| worst.margin_db);
    limit.value * portable::exp(-margin_db / DECIBELS_PER_NEPER)
}
