//! Limits that make a controller deployable, in addition to the specifications, from `[design]` or
//! by default. Only a rig has defaults: a plant given by polynomials may be anything.
//!
//! ```text
//! noise to command     |G/(1+L)| <= a U_n/n           then rms(u) <= a U_n for white noise of n rms at the samples
//! modulus margin       |1/(1+L)| <= 1/m               at every frequency
//! bandwidth            |L/(1+L)| <= 1/sqrt(2)         from w_b on: a crossover beyond has a phase margin of 90 degrees
//! command of steps     |u(t)| <= a U_n                of each step of the reference in a scenario
//! ```

use std::f64::consts::FRAC_1_SQRT_2;

use phea_dynamics::order::sorted_distinct;
use phea_qft::design::PoleRange;
use phea_qft::family::Family;
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{Audit, SpecificationFinding, Verdict};

use super::ProjectDesign;
use crate::audit::PrefilterGain;
use crate::limit_kind::{DesignLimitKind, LimitOrigin};
use crate::project::{DeclaredDesign, UnstatedLimits};
use crate::rig::quarter_wave;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::stepped_references;

/// Fraction of the nominal voltage that noise may take, rms.
const NOISE_FRACTION: f64 = 0.01;
/// Fraction of the permitted noise that is left to the force sensor, and to the pressures, if both
/// have noise: half of its square.
pub(super) const NOISE_TO_COMMAND_LEFT: f64 = FRAC_1_SQRT_2;
const MODULUS_MARGIN: f64 = 0.5;
/// Delay margin of a continuous loop, s.
const DELAY_MARGIN_S: f64 = 0.5e-3;
const POLE_DAMPING_RATIO: f64 = 0.3;
const PREFILTER_GAIN: f64 = 2.0;
/// Fraction of the nominal voltage that the steps of the scenarios may take.
const COMMAND_OF_STEPS: f64 = 1.0;
/// Fraction of pi/T that a bandwidth may reach, and that a pole may reach.
const BANDWIDTH_FRACTION: f64 = 0.2;
const FASTEST_FRACTION: f64 = 0.5;
/// Ratio of the fastest pole of a continuous controller to the highest bandwidth.
const BEYOND_BANDWIDTH: f64 = 10.0;
/// Multiples of the highest bandwidth at which its bounds are drawn.
const DRAWN: [f64; 3] = [1.0, 2.0, 4.0];

/// Limit of a deployable controller.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignLimit {
    /// Kind of the limit.
    pub kind: DesignLimitKind,
    /// Value, SI: a fraction of the nominal voltage, a distance, rad/s or s.
    pub value: f64,
    /// Origin of the value.
    pub origin: LimitOrigin,
    /// Specification that enforces the limit; `None` if the search enforces it.
    pub specification: Option<Specification>,
}

/// True if a response to the reference is required.
fn follows_reference(given: &RobustProblem) -> bool {
    given.specifications.iter().any(|one| one.requirement.is_tracking()) || !given.in_time.is_empty()
}

/// True if a scenario steps the reference of a valve, and the steps of its plants are known.
fn steps_command(setup: &Setup<'_>, given: &RobustProblem) -> bool {
    let has_steps = matches!(given.family, Family::Uncertain(_));
    has_steps && setup.rig().is_ok() && !stepped_references(setup.project).is_empty()
}

/// Limits of a design for this problem; empty for a plant without a rig that states none.
pub fn design_limits(setup: &Setup<'_>, given: &RobustProblem) -> Vec<DesignLimit> {
    let declared = setup.project.design.clone().unwrap_or_default();
    let is_rig = setup.project.actuator.is_some() && declared.limits == UnstatedLimits::Default;
    let default = |value: f64| is_rig.then_some((value, LimitOrigin::Default));
    let stated = |value: Option<f64>| value.map(|value| (value, LimitOrigin::Stated));
    let delay_s = setup.timing.sample_time_s.unwrap_or(DELAY_MARGIN_S);
    let unstated = || highest_bandwidth(setup).filter(|_| is_rig);
    let bandwidth = stated(declared.highest_bandwidth).or_else(unstated);
    let each = [
        (DesignLimitKind::NoiseToCommand, stated(declared.noise_to_command).or(default(NOISE_FRACTION))),
        (DesignLimitKind::ModulusMargin, stated(declared.modulus_margin).or(default(MODULUS_MARGIN))),
        (DesignLimitKind::HighestBandwidth, bandwidth),
        (DesignLimitKind::MinimumDelayMargin, stated(declared.minimum_delay_margin).or(default(delay_s))),
        (
            DesignLimitKind::PoleDampingRatio,
            stated(declared.pole_damping_ratio).or(default(POLE_DAMPING_RATIO)),
        ),
        (DesignLimitKind::FastestPole, fastest_pole(setup, &declared, bandwidth)),
        (DesignLimitKind::PrefilterGain, stated(declared.prefilter_gain).or(default(PREFILTER_GAIN))),
        (DesignLimitKind::CommandOfSteps, stated(declared.command_of_steps).or(default(COMMAND_OF_STEPS))),
    ];
    let asks = |(kind, found): (DesignLimitKind, Option<(f64, LimitOrigin)>)| {
        let (value, origin) = found.filter(|(value, _)| *value > 0.0 && value.is_finite())?;
        let specification = specification((setup, given), kind, value);
        // without a noisy sensor in a sampled loop, or a reference to follow, no limit applies
        let is_void = match kind {
            DesignLimitKind::NoiseToCommand => specification.is_none(),
            DesignLimitKind::PrefilterGain => !follows_reference(given),
            DesignLimitKind::CommandOfSteps => !steps_command(setup, given),
            _ => false,
        };
        (!is_void).then_some(DesignLimit { kind, value, origin, specification })
    };
    each.into_iter().filter_map(asks).collect()
}

/// Value of a limit, if there is one.
pub(super) fn limit_value(limits: &[DesignLimit], kind: DesignLimitKind) -> Option<f64> {
    limits.iter().find(|limit| limit.kind == kind).map(|limit| limit.value)
}

impl ProjectDesign {
    /// Largest permitted gain of the designed prefilter and its actual gain, if that is larger.
    pub fn exceeded_prefilter_gain(&self) -> Option<[f64; 2]> {
        self.declared_prefilter.as_ref()?;
        let most = limit_value(&self.limits, DesignLimitKind::PrefilterGain)?;
        let largest = PrefilterGain::of_loop(&self.designed.problem.compensation).largest;
        (largest > most).then_some([most, largest])
    }

    /// Reasons not to use the designed controller; empty if it may be used.
    pub fn unusable(&self) -> Vec<UnusableController> {
        let is_unstable = self.designed.view.audit.stability.verdict == Verdict::Violated;
        let stability = is_unstable.then_some(UnusableController::UnstablePlant);
        let PrefilterGain { largest, .. } = PrefilterGain::of_loop(&self.designed.problem.compensation);
        let is_designed = self.declared_prefilter.is_some() && !self.is_met();
        let amplifies = is_designed && largest > UNUSABLE_PREFILTER_GAIN;
        let prefilter = amplifies.then_some(UnusableController::PrefilterGain(largest));
        stability.into_iter().chain(prefilter).collect()
    }
}

/// Reason not to use a designed controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnusableController {
    /// A plant of the family becomes unstable.
    UnstablePlant,
    /// Largest factor by which its prefilter multiplies the reference.
    PrefilterGain(f64),
}

/// Gain of a prefilter from which a loop that does not satisfy its specifications is not to be
/// used, whatever `design.prefilter_gain` permits.
const UNUSABLE_PREFILTER_GAIN: f64 = 100.0;

/// Range of the poles of a designed controller.
pub(super) fn pole_range(limits: &[DesignLimit]) -> PoleRange {
    let free = PoleRange::default();
    PoleRange {
        least_damping_ratio: limit_value(limits, DesignLimitKind::PoleDampingRatio)
            .unwrap_or(free.least_damping_ratio),
        fastest_rad_per_s: limit_value(limits, DesignLimitKind::FastestPole)
            .unwrap_or(free.fastest_rad_per_s),
    }
}

/// The problem with those limits that are specifications as additional ones, without names.
pub(super) fn limited(given: &RobustProblem, limits: &[DesignLimit]) -> RobustProblem {
    let mut problem = given.clone();
    for limit in limits {
        let Some(specification) = limit.specification.clone() else { continue };
        problem.specifications.push(specification);
        problem.design_limits.push(limit.kind);
    }
    problem
}

/// The problem with the project's specifications only, the audit of a design reduced to them, and
/// the findings for the limits.
pub(super) fn split(given: &RobustProblem, audit: &Audit) -> (RobustProblem, Audit, Vec<LimitFinding>) {
    let own = given.specifications.len() - given.design_limits.len();
    let (audit, others) = audit.split_off(own);
    let mut problem = given.clone();
    problem.specifications.truncate(own);
    let kinds = std::mem::take(&mut problem.design_limits);
    (problem, audit, kinds.into_iter().zip(others).collect())
}

/// Finding of an audit for a limit.
pub type LimitFinding = (DesignLimitKind, SpecificationFinding);

/// Least bandwidth of those that waves in the lines, the servovalve and sampling permit.
pub(crate) fn highest_bandwidth(setup: &Setup<'_>) -> Option<(f64, LimitOrigin)> {
    let rig = setup.rig().ok()?;
    let valve = rig.actuator.components().valve.natural_frequency;
    let sampled = setup.timing.sample_time_s.map(|time_s| BANDWIDTH_FRACTION * std::f64::consts::PI / time_s);
    let each = [
        quarter_wave(rig).map(|frequency| (frequency, LimitOrigin::QuarterWave)),
        Some((valve, LimitOrigin::Servovalve)),
        sampled.map(|frequency| (frequency, LimitOrigin::Sampling)),
    ];
    each.into_iter().flatten().min_by(|one, other| one.0.total_cmp(&other.0))
}

/// Fastest pole that a controller of growing order may have; a structure that the project states
/// has its own ranges.
fn fastest_pole(
    setup: &Setup<'_>,
    declared: &DeclaredDesign,
    bandwidth: Option<(f64, LimitOrigin)>,
) -> Option<(f64, LimitOrigin)> {
    let has_none = setup.project.actuator.is_none() || declared.limits == UnstatedLimits::None;
    if !declared.structure.is_empty() || has_none {
        return None;
    }
    match setup.timing.sample_time_s {
        Some(time_s) => Some((FASTEST_FRACTION * std::f64::consts::PI / time_s, LimitOrigin::Sampling)),
        None => bandwidth.map(|(frequency, _)| (BEYOND_BANDWIDTH * frequency, LimitOrigin::Bandwidth)),
    }
}

/// Specification that enforces a limit.
pub(super) fn specification(
    (setup, given): (&Setup<'_>, &RobustProblem),
    kind: DesignLimitKind,
    value: f64,
) -> Option<Specification> {
    let highest = given.compensation.highest_frequency_rad_per_s();
    let over = |closed_loop, limit: f64, frequencies: Vec<f64>, band_rad_per_s: [f64; 2]| Specification {
        requirement: Requirement::at_most(closed_loop, Limit::Constant(limit)),
        frequencies_rad_per_s: frequencies.into_iter().filter(|frequency| *frequency <= highest).collect(),
        band_rad_per_s,
    };
    let drawn = || given.design_frequencies();
    match kind {
        DesignLimitKind::ModulusMargin => {
            Some(over(ClosedLoop::Sensitivity, 1.0 / value, drawn(), [0.0, f64::INFINITY]))
        }
        DesignLimitKind::HighestBandwidth => {
            let frequencies = DRAWN.map(|factor| factor * value).to_vec();
            Some(over(ClosedLoop::RobustStability, FRAC_1_SQRT_2, frequencies, [value, f64::INFINITY]))
        }
        DesignLimitKind::NoiseToCommand => {
            setup.timing.sample_time_s?;
            let noise_n = setup.project.actuator.as_ref()?.force_sensor.noise;
            let nominal_v = setup.rig().ok()?.actuator.components().valve.nominal_voltage;
            let has_pressures = given.pressure_noise > 0.0 && given.compensation.inner_feedback().is_some();
            let left = if has_pressures { NOISE_TO_COMMAND_LEFT } else { 1.0 };
            let limit = left * value * nominal_v / noise_n;
            let mut frequencies = drawn();
            frequencies.extend([0.1, 0.3, 0.9].map(|fraction| fraction * highest));
            let found =
                || over(ClosedLoop::ControlEffort, limit, sorted_distinct(frequencies), [0.0, highest]);
            (noise_n > 0.0).then(found)
        }
        DesignLimitKind::MinimumDelayMargin
        | DesignLimitKind::PoleDampingRatio
        | DesignLimitKind::FastestPole
        | DesignLimitKind::PrefilterGain
        | DesignLimitKind::CommandOfSteps
        | DesignLimitKind::RequiredStep => None,
    }
}
