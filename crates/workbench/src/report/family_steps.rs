//! Step responses of the family inside the band of the tracking limits' own step responses.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::time_response::{TimeResponseError, step_response, uniform_times};
use phea_engineering::audit::ProjectAudit;
use phea_engineering::linear_step::{StepResponse, linear_step};
use phea_engineering::robust::RobustProblem;
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::specification::Limit;
use phea_qft::verification::{PlantPoint, Verdict};

use super::closed_loops::DRAWN_MEMBERS;
use crate::figure::{FamilySteps, Figure, TimeBand, TimeSeries, Words};

/// Number of points of each response, and of those of the limits.
const POINTS: usize = 1200;
const SAMPLES: usize = 600;
/// Time constants of the slowest pole of the lower limit that are shown.
const TIME_CONSTANTS: f64 = 8.0;

/// The figure under a name and a title, or the reason why there is none; `None` if no tracking is
/// specified by transfer functions.
pub(super) fn figure(
    problem: &RobustProblem,
    view: &ProjectAudit,
    names: [&str; 2],
) -> Option<Result<Figure, String>> {
    let limits =
        problem.specifications.iter().find_map(|specification| match specification.requirement.limits() {
            (Some(Limit::Rational(lower)), Limit::Rational(upper)) => Some((lower, upper)),
            _ => None,
        })?;
    if view.audit.stability.verdict != Verdict::Met {
        return Some(Err("not every plant is known to be stable".to_string()));
    }
    let Family::Uncertain(family) = &problem.family else {
        return Some(Err("measured responses have no step response".to_string()));
    };
    let drawn = drawn(problem, family, view, limits);
    Some(drawn.map(|chart| chart.draw(&words(names))).map_err(|error| error.to_string()))
}

fn drawn(
    problem: &RobustProblem,
    family: &UncertainFamily,
    view: &ProjectAudit,
    (lower, upper): (&TransferFunction, &TransferFunction),
) -> Result<FamilySteps, TimeResponseError> {
    let duration = duration(lower);
    let limit_times = uniform_times(duration, SAMPLES)?;
    let series = |name: &str, system: &TransferFunction| {
        let values = step_response(system, &limit_times)?;
        Ok::<_, TimeResponseError>(TimeSeries {
            name: name.to_string(),
            values,
            times_s: limit_times.clone(),
        })
    };
    let member = |name: &str, values: &[f64]| {
        let member = problem.compensation.member_of(family.plant(), values)?;
        let StepResponse { times_s, values } = linear_step(&member, &problem.compensation, duration, POINTS)?;
        Ok::<_, TimeResponseError>(TimeSeries { name: name.to_string(), times_s, values })
    };
    let step = family.members().len() / DRAWN_MEMBERS + 1;
    let members: Vec<TimeSeries> =
        family.members().iter().step_by(step).map(|values| member("", values)).collect::<Result<_, _>>()?;
    let worst = view.audit.specifications.iter().find(|one| one.requirement.is_tracking());
    let worst = worst.and_then(|finding| finding.worst.as_ref());
    let named = match worst.map(|worst| &worst.plant) {
        Some(PlantPoint::Parameters(values)) => vec![member("the plant that tracks worst", values)?],
        _ => vec![],
    };
    Ok(FamilySteps {
        quantity: "Output, part of the step".to_string(),
        band: Some(TimeBand {
            name: "band of the limits".to_string(),
            upper: series("upper limit", upper)?,
            lower: series("lower limit", lower)?,
        }),
        nominal: Some(member("nominal plant", &family.plant().nominal())?),
        members,
        named,
    })
}

fn words([name, title]: [&str; 2]) -> Words {
    let caption = "Step responses of plants of the family (thin) and those of the tracking limits. A limit on magnitudes does not bound a response in time: the band is the response of the limits themselves.";
    Words::new(name, title, caption)
}

fn duration(lower: &TransferFunction) -> f64 {
    let slowest = lower.poles().iter().map(|pole| -pole.re).fold(f64::INFINITY, f64::min);
    if slowest > 0.0 && slowest.is_finite() { (TIME_CONSTANTS / slowest).clamp(1e-3, 1e3) } else { 1.0 }
}
