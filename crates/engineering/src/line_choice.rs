//! Model of lines for which the project states none: lumped unless the loop is near their waves.
//!
//! ```text
//! w_q = pi/(2 T)            frequency at which the slower line is a quarter wave long; T: its travel time
//! w   = max of              frequencies of loop and requirements:
//!         crossover             of the given loop, the highest of the nominal plant and of plants spread over the family
//!         ln(100/band)/t_s      bandwidth of a required settling time, 2.2/t_r that of a required rise time
//!         design frequencies    the highest of limits that require feedback: tracking, sensitivity, disturbance
//!         highest bandwidth     that a design may have, if there is no controller or one is designed;
//!                               that which valve, lines and sampling permit, if a design has no limit
//! w_q > 10 w: lumped        else: waves
//! ```
//!
//! A lumped line is a capacity. Its error grows with the square of w/w_q: 0.8 % of the compliance
//! at a tenth of w_q. Limits on |T| and on the command protect the upper end of the loop's band,
//! and their frequencies do not determine what it must reach.

use phea_dynamics::closed_loop::ClosedLoop;

use crate::audit::highest_crossover;
use crate::design::{DesignLimitKind, design_limits, highest_bandwidth};
use crate::project::{ChosenLines, Loaded, Project, ReachedBy, WavesHindrance};
use crate::rig::{Rig, quarter_wave_of};
use crate::robust::{RobustProblem, robust_problem};
use crate::setup::Setup;
use crate::simulate::time_requirements;
use crate::source::Source;
use crate::specification::closed_loops;
use phea_dynamics::portable;

/// Ratio of the quarter-wave frequency to the highest frequency of the loop from which a line is
/// lumped.
pub const LUMPED_FROM: f64 = 10.0;
/// Rise time from 10 % to 90 % multiplied by the bandwidth of a first-order lag: ln 9.
const RISE_TIMES_BANDWIDTH: f64 = 2.197_224_577_336_219_6;

/// Loop that the command of the program considers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopInQuestion {
    /// The given loop, and a designed one only if none is given.
    Given,
    /// A designed loop, in addition to the given one.
    Designed,
}

/// The project with a model for each line for which it states none; unchanged if there is no such
/// line, if the rig is invalid (reported by whatever needs it), and if a model has been chosen
/// already. A stated model is never changed.
///
/// # Example
/// The controller of this project crosses over near 60 rad/s, and its hose of 1.5 m is a quarter
/// wave long at 560 rad/s: with waves. A hose of 0.5 m is lumped.
/// ```
/// use phea_engineering::line_choice::{LoopInQuestion, with_chosen_lines};
/// use phea_project::source::Memory;
/// let text = include_str!("../../../examples/ybitu/hose.toml").replace("model = \"lumped\"", "");
/// let source = Memory::default().with("rig.toml", text);
/// let loaded = phea_project::read(&source, "rig.toml", &[], &[])?;
/// let chosen = with_chosen_lines(&source, &loaded, LoopInQuestion::Given).and_then(|with| with.lines);
/// assert!(chosen.is_some_and(|lines| lines.with_waves));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn with_chosen_lines(source: &dyn Source, loaded: &Loaded, question: LoopInQuestion) -> Option<Loaded> {
    if loaded.lines.is_some() || loaded.project.lines_without_model().next().is_none() {
        return None;
    }
    let chosen = choice(source, &loaded.project, question)?;
    Some(Loaded {
        project: loaded.project.clone().with_chosen_lines(chosen.with_waves),
        lines: Some(chosen),
        ..loaded.clone()
    })
}

/// Model of the lines without a stated one, with its reason.
fn choice(source: &dyn Source, project: &Project, question: LoopInQuestion) -> Option<ChosenLines> {
    let setup = Setup::new(project).ok()?;
    let quarter_wave_rad_per_s = open_quarter_wave(project, setup.rig().ok()?)?;
    let reach = reach(source, &setup, question);
    let is_near = reach.as_ref().is_some_and(|(reached, _)| quarter_wave_rad_per_s <= LUMPED_FROM * reached);
    let obstacle = is_near.then(|| obstacle(project)).flatten();
    Some(ChosenLines { with_waves: is_near && obstacle.is_none(), quarter_wave_rad_per_s, reach, obstacle })
}

/// Reason why a rig is not computed with waves.
fn obstacle(project: &Project) -> Option<WavesHindrance> {
    if project.has_free_load() {
        return Some(WavesHindrance::FreeLoad);
    }
    let rig = Setup::rig_of(&project.clone().with_chosen_lines(true));
    rig.err().map(|error| WavesHindrance::Rig(error.to_string()))
}

/// Highest frequency that loop and requirements reach, and its cause.
fn reach(source: &dyn Source, setup: &Setup<'_>, question: LoopInQuestion) -> Option<(f64, ReachedBy)> {
    let project = setup.project;
    let has_law = setup.controller.is_some();
    let problem = robust_problem(source, setup).ok();
    let crossover = problem.as_ref().filter(|_| has_law).and_then(highest_crossover);
    let is_designed =
        (question == LoopInQuestion::Designed || !has_law) && !project.specifications.is_empty();
    let bandwidth = problem.as_ref().filter(|_| is_designed).and_then(|problem| bandwidth(setup, problem));
    let all = crossover.map(|reached| (reached, ReachedBy::Crossover)).into_iter();
    let all = all.chain(required_times(project)).chain(design_frequencies(project));
    let all = all.chain(bandwidth);
    all.filter(|(reached, _)| *reached > 0.0 && reached.is_finite())
        .max_by(|one, other| one.0.total_cmp(&other.0))
}

/// Highest bandwidth of a design; if it is not limited, that which the rig permits.
fn bandwidth(setup: &Setup<'_>, problem: &RobustProblem) -> Option<(f64, ReachedBy)> {
    let limits = design_limits(setup, problem);
    let limit = limits.iter().find(|limit| limit.kind == DesignLimitKind::HighestBandwidth);
    let stated = limit.map(|limit| (limit.value, ReachedBy::HighestBandwidth));
    stated.or_else(|| Some((highest_bandwidth(setup)?.0, ReachedBy::UnlimitedBandwidth)))
}

/// Bandwidths of first-order lags that settle and rise in the required times.
fn required_times(project: &Project) -> Vec<(f64, ReachedBy)> {
    let requirements = time_requirements(project).unwrap_or_default();
    let each = requirements.into_iter().flat_map(|required| {
        let step_limits = required.step_limits;
        let settles =
            step_limits.settling_time_s.map(|time_s| portable::ln(100.0 / step_limits.band_percent) / time_s);
        let rises = step_limits.rise_time_s.map(|time_s| RISE_TIMES_BANDWIDTH / time_s);
        settles
            .into_iter()
            .chain(rises)
            .map(move |reached| (reached, ReachedBy::RequiredTime(required.number)))
    });
    each.collect()
}

/// Highest design frequency of each limit that requires feedback.
fn design_frequencies(project: &Project) -> impl Iterator<Item = (f64, ReachedBy)> {
    closed_loops(project).filter_map(|(number, closed_loop, declared)| {
        let requires_feedback = match closed_loop {
            ClosedLoop::Tracking
            | ClosedLoop::Sensitivity
            | ClosedLoop::PlantInputDisturbance
            | ClosedLoop::LoadMotion => true,
            ClosedLoop::RobustStability | ClosedLoop::ControlEffort => false,
        };
        let highest = declared.frequencies.iter().copied().reduce(f64::max)?;
        requires_feedback.then_some((highest, ReachedBy::DesignFrequency(number)))
    })
}

/// Quarter-wave frequency of the slower of the lines without a stated model, rad/s.
fn open_quarter_wave(project: &Project, rig: &Rig) -> Option<f64> {
    let declared = &project.actuator.as_ref()?.line;
    let components = rig.actuator.components();
    let both = [(&declared.a, &components.line_a), (&declared.b, &components.line_b)];
    let is_open = |line: &crate::project::DeclaredLine| {
        project.lines_without_model().any(|one| std::ptr::eq(one, line))
    };
    quarter_wave_of(rig, both.into_iter().filter(|(declared, _)| is_open(declared)).map(|(_, line)| line))
}
