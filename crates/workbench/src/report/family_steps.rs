//! Step responses of the family inside the band of the tracking limits' own step responses.

use std::sync::Arc;

use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_dynamics::time_response::{
    TimeResponseError, delayed_loop_step, step_of_frequency_response, step_response, uniform_times,
};
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_dynamics::uncertain_plant::{PlantCoefficients, PlantMember};
use phea_qft::closed_loop::Member;
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::specification::Limit;
use phea_qft::verification::{PlantPoint, Verdict};

use super::closed_loops::DRAWN_MEMBERS;
use crate::audit::ProjectAudit;
use crate::figure::{FamilySteps, Figure, TimeBand, TimeSeries, Words};
use crate::linear_loop::of_responses::real_parts;
use crate::robust::RobustProblem;

/// Samples of each response.
const SAMPLES: usize = 600;
/// Time constants of the slowest pole of the lower limit that are shown.
const TIME_CONSTANTS: f64 = 8.0;

/// The figure under a name and a title, or why there is none; `None` where no tracking is specified
/// by transfer functions.
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
    let times = match problem.compensation.sample_time_s() {
        None => uniform_times(duration, SAMPLES)?,
        Some(sample_time) => {
            let count = (duration / sample_time).ceil().clamp(10.0, 20_000.0) as usize;
            (0..count).map(|sample| sample as f64 * sample_time).collect()
        }
    };
    let limit_times = uniform_times(duration, SAMPLES)?;
    let series = |name: &str, system: &TransferFunction, times_s: &[f64]| {
        let values = step_response(system, times_s)?;
        Ok::<_, TimeResponseError>(TimeSeries { name: name.to_string(), values, times_s: times_s.to_vec() })
    };
    let member = |name: &str, values: &[f64]| {
        let member = family.plant().member(values).ok_or(TimeResponseError::from(LinearError::NoPlant))?;
        let plant = match member {
            PlantMember::Rational(plant) => plant,
            PlantMember::Responding(plant) => {
                let (times_s, values) = step_in_motion(problem, &plant, duration)?;
                return Ok(TimeSeries { name: name.to_string(), times_s, values });
            }
        };
        let delayed = plant.dead_time_s + problem.compensation.delay_s() > 0.0;
        if problem.compensation.sample_time_s().is_none() && delayed {
            let (times_s, values) = delayed_step(problem, plant, duration)?;
            return Ok(TimeSeries { name: name.to_string(), times_s, values });
        }
        series(name, &closed_loop(problem, plant)?, &times)
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
            upper: series("upper limit", upper, &limit_times)?,
            lower: series("lower limit", lower, &limit_times)?,
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

/// F P G/(1 + P G H), sampled where the loop samples.
fn closed_loop(
    problem: &RobustProblem,
    plant: PlantCoefficients<f64>,
) -> Result<TransferFunction, LinearError> {
    let compensation = &problem.compensation;
    let (plant, sensor) = match compensation.member(plant)? {
        Member::Sampled { command, .. } => {
            // A sensor with dynamics is sampled together with the plant, so that the transfer
            // function of the plant alone is not available.
            if !(compensation.sensor().poles().is_empty() && compensation.sensor().dead_time_s() == 0.0) {
                return Err(LinearError::WrongDomain {
                    operation: "a step response with sensor dynamics",
                    needed: "continuous",
                });
            }
            let sensor = compensation.sensor().clone().in_domain(command.domain())?;
            (command, sensor)
        }
        Member::Continuous { plant, sensor, .. } => {
            let rational = TransferFunction::from_polynomials(
                &Polynomial::new(plant.command.numerator),
                &Polynomial::new(plant.command.denominator),
            )?;
            (rational.with_dead_time(plant.dead_time_s)?, sensor)
        }
        Member::Responding { .. } | Member::Measured { .. } => return Err(LinearError::NoPlant),
    };
    let closed = plant.series(compensation.feedback())?.feedback(&sensor)?;
    compensation.prefilter_of_step()?.series(&closed)
}

/// The same for a continuous loop with dead time.
fn delayed_step(
    problem: &RobustProblem,
    plant: PlantCoefficients<f64>,
    duration: f64,
) -> Result<(Vec<f64>, Vec<f64>), TimeResponseError> {
    let compensation = &problem.compensation;
    let rational = TransferFunction::from_polynomials(
        &Polynomial::new(plant.command.numerator),
        &Polynomial::new(plant.command.denominator),
    )?;
    let delay_s = plant.dead_time_s + compensation.delay_s();
    let forward = rational.series(compensation.feedback())?.with_dead_time(delay_s)?;
    delayed_loop_step(&forward, compensation.sensor(), compensation.prefilter(), duration, DELAYED_STEPS)
}

/// The same for a plant with lines in motion, which is known by its response.
fn step_in_motion(
    problem: &RobustProblem,
    plant: &Arc<dyn RespondingPlant>,
    duration: f64,
) -> Result<(Vec<f64>, Vec<f64>), TimeResponseError> {
    let sample_time_s = problem.compensation.sample_time_s();
    let step_s = sample_time_s.unwrap_or(duration / STEPS_IN_MOTION);
    let count = (duration / step_s).ceil().clamp(10.0, 20_000.0) as usize + 1;
    let points = real_parts(plant, &problem.compensation)?;
    let values = step_of_frequency_response(&points, step_s, count, sample_time_s.is_some());
    Ok(((0..count).map(|sample| sample as f64 * step_s).collect(), values))
}

/// Steps that a response of lines in motion is computed in.
const STEPS_IN_MOTION: f64 = 1200.0;
/// Steps that a response with dead time is computed in.
const DELAYED_STEPS: usize = 4000;

fn duration(lower: &TransferFunction) -> f64 {
    let slowest = lower.poles().iter().map(|pole| -pole.re).fold(f64::INFINITY, f64::min);
    if slowest > 0.0 && slowest.is_finite() { (TIME_CONSTANTS / slowest).clamp(1e-3, 1e3) } else { 1.0 }
}
