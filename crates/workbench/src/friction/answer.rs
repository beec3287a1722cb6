use super::{
    ExplainedByDirections, FRICTION_NAMES, FrictionIdentification, FrictionMisfit, OpenCoefficient,
    RETRACTING_NAMES, ShakenRows, because, misfit_in_words,
};
use crate::answer::{Json, Object, envelope};
use crate::estimate::Estimate;
use crate::project::Loaded;
use crate::quantity::DisplayUnit;

/// Keys of the answer, in the order of the coefficients: as the project has them, with SI units.
const KEYS: [&str; FRICTION_NAMES.len()] = [
    "coulomb_n",
    "static_n",
    "stribeck_velocity_m_per_s",
    "stribeck_exponent",
    "viscous_n_s_per_m",
    "bristle_stiffness_n_per_m",
    "bristle_damping_n_s_per_m",
];

/// Keys of the levels of retracting.
const RETRACTING_KEYS: [&str; RETRACTING_NAMES.len()] = ["coulomb_n", "static_n", "viscous_n_s_per_m"];

/// The JSON object of `identify --of friction`.
pub fn json(loaded: &Loaded, found: &FrictionIdentification) -> String {
    let coefficients = KEYS.iter().zip(&found.estimates);
    let friction = coefficients.fold(Object::new(), |object, (key, one)| object.with(*key, estimate(one)));
    let retracting = found.retracting.as_ref().map(|estimates| {
        let all = RETRACTING_KEYS.iter().zip(estimates);
        all.fold(Object::new(), |object, (key, one)| object.with(*key, estimate(one)))
    });
    let no_zero = match found.retracting {
        Some(_) => "the friction differs by direction, and the instruments are taken to have no zero error",
        None => "the recordings go one way",
    };
    let body = Object::new()
        .with("friction", friction.with("retracting", retracting))
        .known("force_zero_n", found.zero.map(|zero| estimate(&Ok(zero))), no_zero)
        .each("direction_models", found.evidence.iter().flat_map(|evidence| &evidence.models), model)
        .with("direction_models_difference", found.evidence.map(|evidence| evidence.difference()))
        .each("recordings", 0..found.recordings.len(), |index| recording(found, index))
        .with("force_residual_rms_n", found.residual_rms[0])
        .with("position_residual_rms_m", found.residual_rms[1])
        .each("misfits", &found.misfits, |one| misfit(found, one))
        .each("warnings", &found.misfits, |one| {
            Object::new()
                .with("message", misfit_in_words(found, one))
                .with("file", file(found, one.recording))
        })
        .with("independent_share", found.independent)
        .with("converged", found.has_converged());
    envelope("identify", loaded).and(body).print(loaded.project.motion())
}

fn estimate(one: &Result<Estimate, OpenCoefficient>) -> Object {
    let (value, interval, reason) = match one {
        Ok(Estimate { value, interval }) => (Some(*value), interval, None),
        Err(open) => (None, &open.estimate.interval, Some(because(open))),
    };
    let ends = interval.map(Json::Number).to_vec();
    Object::new().with("value", value).with("confidence_95", Json::List(ends)).with("reason", reason)
}

/// Evidence for one friction for both directions, or for one for each.
fn model(explained: &ExplainedByDirections) -> Object {
    let [coulomb, breaking, .., back_coulomb, back_breaking, _] = explained.lugre.to_array();
    Object::new()
        .with("model", explained.model.name())
        .with("criterion", explained.criterion)
        .with("force_zero_n", explained.zero)
        .with("coulomb_n", [coulomb, back_coulomb])
        .with("static_n", [breaking, back_breaking])
}

fn file(found: &FrictionIdentification, recording: usize) -> String {
    found.recordings.get(recording).map_or(String::new(), |one| one.file.clone())
}

fn misfit(found: &FrictionIdentification, one: &FrictionMisfit) -> Object {
    Object::new()
        .with("file", file(found, one.recording))
        .with("signal", one.signal.name())
        .with("share", one.fraction)
        .with("neighbour_correlation", one.correlation)
        .with("velocity_m_per_s", one.place.map(|[velocity, _]| velocity))
        .with("mean_residual_n", one.place.map(|[_, residual]| residual))
}

fn recording(found: &FrictionIdentification, index: usize) -> Object {
    let slides = found.slides.iter().filter(|slide| slide.recording == index);
    let varying = found.varying.iter().filter(|one| one.recording == index);
    let press = found.presses.iter().find(|press| press.recording == index);
    let shake = found.shakes.iter().find(|shake| shake.recording == index);
    let own = found.recordings.get(index);
    Object::new()
        .with("file", own.map_or(String::new(), |one| one.file.clone()))
        .with("rows", own.map_or(0, |one| one.forces.len()) as u64)
        .with("time_step_s", own.map(|one| one.time_step))
        .each("constant_velocities", slides, |slide| {
            Object::new()
                .with("velocity_m_per_s", slide.velocity)
                .with("force_n", slide.settled_force() - found.zero.as_ref().map_or(0.0, |zero| zero.value))
                .with("rows", slide.rows.len() as u64)
        })
        .each("varying_velocities", varying, |one| {
            Object::new()
                .with("velocity_m_per_s", one.velocity)
                .with("velocity_range_m_per_s", Json::List(one.range.map(Json::Number).to_vec()))
                .with("rows", one.rows.len() as u64)
        })
        .maybe("pressed_rows", press.map(|press| press.rows as u64))
        .maybe("breaks_away", press.map(|press| press.breaks_away))
        .maybe("shaken_hz", shake.map(frequencies))
}

/// The frequencies of the sines of its force.
fn frequencies(shake: &ShakenRows) -> Json {
    Json::List(shake.force.frequencies.iter().map(|one| Json::Number(DisplayUnit::HERTZ.of(*one))).collect())
}
