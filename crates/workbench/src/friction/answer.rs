use phea_engineering::estimate::Estimate;
use phea_engineering::friction::{
    ConstantVelocity, DirectionModel, ExplainedByDirections, FrictionIdentification, FrictionMisfit,
    FrictionRecording, FrictionSignal, OpenCoefficient, ShakenRows, SteadyPoint, VaryingVelocity,
};

use super::{because, misfit_in_words};
use crate::answer::{Answer, Body, FileWarningAnswer, OrReason, envelope, words};
use crate::project::Loaded;
use crate::quantity::DisplayUnit;

/// Friction of a cylinder identified from recorded runs.
#[derive(Answer)]
pub(crate) struct IdentifiedFrictionAnswer {
    /// Coefficients of the friction.
    friction: FrictionCoefficientsAnswer,
    /// Force that the instruments indicate without friction.
    force_zero_n: OrReason<FrictionEstimateAnswer>,
    /// Fits of one friction for both directions and of one for each; empty if they cannot be
    /// compared, as where the recordings slide in one direction only.
    direction_models: Vec<DirectionFitAnswer>,
    /// Decrease of the information criterion by a friction for each direction; null without
    /// `direction_models`.
    direction_models_difference: Option<f64>,
    /// Recorded runs.
    recordings: Vec<FrictionRunAnswer>,
    /// Root mean square of the residuals of the force, each block of rows as one; null without any.
    force_residual_rms_n: Option<f64>,
    /// Root mean square of the residuals of the position of pressed or shaken pistons; null without
    /// any.
    position_residual_rms_m: Option<f64>,
    /// Misfits that are not noise, the greatest first.
    misfits: Vec<FrictionMisfitAnswer>,
    /// Misfits in sentences.
    warnings: Vec<FileWarningAnswer>,
    /// Fraction of the residuals that are independent, the least of all signals.
    independent_fraction: f64,
    /// True if no further step of the search explains more.
    converged: bool,
}

/// Coefficients of the LuGre friction; where friction differs by direction, those of extending.
#[derive(Answer)]
struct FrictionCoefficientsAnswer {
    /// Coulomb friction.
    coulomb_n: FrictionEstimateAnswer,
    /// Static friction.
    static_n: FrictionEstimateAnswer,
    /// Stribeck velocity.
    stribeck_velocity_m_per_s: FrictionEstimateAnswer,
    /// Exponent of the fall from static to Coulomb friction.
    stribeck_exponent: FrictionEstimateAnswer,
    /// Viscous friction.
    viscous_n_s_per_m: FrictionEstimateAnswer,
    /// Stiffness of the bristles.
    bristle_stiffness_n_per_m: FrictionEstimateAnswer,
    /// Damping of the bristles.
    bristle_damping_n_s_per_m: FrictionEstimateAnswer,
    /// Friction while the rod retracts; null if it is the same both ways.
    retracting: Option<RetractingFrictionAnswer>,
}

/// Friction while the rod retracts.
#[derive(Answer)]
struct RetractingFrictionAnswer {
    /// Coulomb friction.
    coulomb_n: FrictionEstimateAnswer,
    /// Static friction.
    static_n: FrictionEstimateAnswer,
    /// Viscous friction.
    viscous_n_s_per_m: FrictionEstimateAnswer,
}

/// Coefficient of the friction with its confidence interval.
#[derive(Answer)]
struct FrictionEstimateAnswer {
    /// Estimate; null if the recordings do not determine it.
    value: Option<f64>,
    /// Interval of 95 % that the recordings leave, from low to high.
    #[answer(interval)]
    confidence_95: [f64; 2],
    /// Reason for which there is no estimate; null if there is one.
    reason: Option<String>,
}

/// Fit of one friction for both directions, or of one for each.
#[derive(Answer)]
struct DirectionFitAnswer {
    /// Model of the directions.
    model: DirectionModel,
    /// Information criterion of Schwarz: the lower, the better; its zero has no meaning.
    criterion: f64,
    /// Force that the instruments indicate without friction.
    force_zero_n: f64,
    /// Coulomb friction while extending and while retracting.
    coulomb_n: [f64; 2],
    /// Static friction while extending and while retracting.
    static_n: [f64; 2],
}

/// Recorded run, and the rows of it that are used.
#[derive(Answer)]
struct FrictionRunAnswer {
    /// Path of the file.
    file: String,
    /// Number of rows.
    rows: usize,
    /// Time between two rows.
    time_step_s: f64,
    /// Rows that slide at a constant velocity.
    constant_velocities: Vec<ConstantVelocityAnswer>,
    /// Rows that are omitted because their velocity is constant on average only.
    varying_velocities: Vec<VaryingVelocityAnswer>,
    #[answer(flatten)]
    pressed: Option<PressedAnswer>,
    /// Frequencies of the sines of the force, only of a run that is shaken.
    #[answer(optional)]
    shaken_hz: Option<Vec<f64>>,
}

/// Rows that slide at a constant velocity.
#[derive(Answer)]
struct ConstantVelocityAnswer {
    /// Velocity of the piston, positive while the rod extends.
    velocity_m_per_s: f64,
    /// Friction force there, less `force_zero_n`.
    force_n: f64,
    /// Friction force of the identified curve there.
    modelled_force_n: f64,
    /// Number of rows.
    rows: usize,
}

/// Rows whose velocity is constant on average only.
#[derive(Answer)]
struct VaryingVelocityAnswer {
    /// Mean velocity of the piston, positive while the rod extends.
    velocity_m_per_s: f64,
    /// Least and greatest velocity over the shortest windows that noise allows.
    #[answer(interval)]
    velocity_range_m_per_s: [f64; 2],
    /// Number of rows.
    rows: usize,
}

/// Rows in which a piston at rest is pressed.
#[derive(Answer)]
struct PressedAnswer {
    /// Number of rows in which a piston at rest is pressed, from the first; only of such a run.
    pressed_rows: usize,
    /// True if the pressed piston breaks away; only of such a run.
    breaks_away: bool,
}

/// Signal that the friction does not explain.
#[derive(Answer)]
struct FrictionMisfitAnswer {
    /// Path of the recording.
    file: String,
    /// Signal with the misfit.
    signal: FrictionSignal,
    /// Root mean square of the misfit over the range of the signal.
    fraction: f64,
    /// Correlation of neighbouring residuals: of both halves of each constant velocity, or of rows.
    neighbour_correlation: f64,
    /// Constant velocity at which the misfit is greatest; null of pressed or shaken rows.
    velocity_m_per_s: Option<f64>,
    /// Modelled less recorded force at that velocity; null of pressed or shaken rows.
    mean_residual_n: Option<f64>,
}

words! {
    /// Model of the directions: one friction for both, or one for each.
    DirectionModel by DirectionModel::name [SameBothWays, DiffersByDirection]
}

words! {
    /// Signal that friction explains.
    FrictionSignal by FrictionSignal::name [Force, Position]
}

/// The JSON object of `identify --of friction`.
pub fn json(loaded: &Loaded, found: &FrictionIdentification) -> String {
    let mut object = envelope("identify", loaded);
    answer(found).put(&mut object);
    object.print(loaded.project.motion())
}

fn answer(found: &FrictionIdentification) -> IdentifiedFrictionAnswer {
    let no_zero = match found.retracting {
        Some(_) => "the friction differs by direction, and the instruments are taken to have no zero error",
        None => "the recordings go one way",
    };
    let warning = |one| FileWarningAnswer::of_file(misfit_in_words(found, one), file(found, one.recording));
    let recordings = found.recordings.iter().enumerate();
    let [force_residual_rms_n, position_residual_rms_m] = found.residual_rms;
    IdentifiedFrictionAnswer {
        friction: coefficients(found),
        force_zero_n: OrReason::new(found.zero.map(|zero| estimate(&Ok(zero))), no_zero),
        direction_models: found.evidence.iter().flat_map(|one| &one.models).map(direction_fit).collect(),
        direction_models_difference: found.evidence.map(|evidence| evidence.difference()),
        recordings: recordings.map(|(index, one)| run(found, index, one)).collect(),
        force_residual_rms_n,
        position_residual_rms_m,
        misfits: found.misfits.iter().map(|one| misfit(found, one)).collect(),
        warnings: found.misfits.iter().map(warning).collect(),
        independent_fraction: found.independent,
        converged: found.has_converged(),
    }
}

fn coefficients(found: &FrictionIdentification) -> FrictionCoefficientsAnswer {
    let [
        coulomb_n,
        static_n,
        stribeck_velocity_m_per_s,
        stribeck_exponent,
        viscous_n_s_per_m,
        bristle_stiffness_n_per_m,
        bristle_damping_n_s_per_m,
    ] = found.estimates.each_ref().map(estimate);
    let retracting = found.retracting.as_ref().map(|estimates| {
        let [coulomb_n, static_n, viscous_n_s_per_m] = estimates.each_ref().map(estimate);
        RetractingFrictionAnswer { coulomb_n, static_n, viscous_n_s_per_m }
    });
    FrictionCoefficientsAnswer {
        coulomb_n,
        static_n,
        stribeck_velocity_m_per_s,
        stribeck_exponent,
        viscous_n_s_per_m,
        bristle_stiffness_n_per_m,
        bristle_damping_n_s_per_m,
        retracting,
    }
}

fn estimate(one: &Result<Estimate, OpenCoefficient>) -> FrictionEstimateAnswer {
    match one {
        Ok(Estimate { value, interval }) => {
            FrictionEstimateAnswer { value: Some(*value), confidence_95: *interval, reason: None }
        }
        Err(open) => FrictionEstimateAnswer {
            value: None,
            confidence_95: open.estimate.interval,
            reason: Some(because(open)),
        },
    }
}

/// Evidence for one friction for both directions, or for one for each.
fn direction_fit(explained: &ExplainedByDirections) -> DirectionFitAnswer {
    let [coulomb, breaking, .., back_coulomb, back_breaking, _] = explained.lugre.to_array();
    DirectionFitAnswer {
        model: explained.model,
        criterion: explained.criterion,
        force_zero_n: explained.zero,
        coulomb_n: [coulomb, back_coulomb],
        static_n: [breaking, back_breaking],
    }
}

fn file(found: &FrictionIdentification, recording: usize) -> &str {
    found.recordings.get(recording).map_or("", |one| one.file.as_str())
}

fn misfit(found: &FrictionIdentification, one: &FrictionMisfit) -> FrictionMisfitAnswer {
    FrictionMisfitAnswer {
        file: file(found, one.recording).to_string(),
        signal: one.signal,
        fraction: one.fraction,
        neighbour_correlation: one.correlation,
        velocity_m_per_s: one.place.map(|[velocity, _]| velocity),
        mean_residual_n: one.place.map(|[_, residual]| residual),
    }
}

fn run(found: &FrictionIdentification, index: usize, own: &FrictionRecording) -> FrictionRunAnswer {
    let steady = found.slides.iter().zip(found.steady_points());
    let steady = steady.filter(|(slide, _)| slide.recording == index);
    let varying = found.varying.iter().filter(|one| one.recording == index);
    let press = found.presses.iter().find(|press| press.recording == index);
    let shake = found.shakes.iter().find(|shake| shake.recording == index);
    FrictionRunAnswer {
        file: own.file.clone(),
        rows: own.forces.len(),
        time_step_s: own.time_step,
        constant_velocities: steady.map(constant_velocity).collect(),
        varying_velocities: varying.map(varying_velocity).collect(),
        pressed: press
            .map(|press| PressedAnswer { pressed_rows: press.rows, breaks_away: press.breaks_away }),
        shaken_hz: shake.map(frequencies),
    }
}

fn constant_velocity((slide, point): (&ConstantVelocity, SteadyPoint)) -> ConstantVelocityAnswer {
    ConstantVelocityAnswer {
        velocity_m_per_s: point.velocity,
        force_n: point.force,
        modelled_force_n: point.modelled,
        rows: slide.rows.len(),
    }
}

fn varying_velocity(one: &VaryingVelocity) -> VaryingVelocityAnswer {
    VaryingVelocityAnswer {
        velocity_m_per_s: one.velocity,
        velocity_range_m_per_s: one.range,
        rows: one.rows.len(),
    }
}

/// The frequencies of the sines of its force.
fn frequencies(shake: &ShakenRows) -> Vec<f64> {
    shake.force.frequencies.iter().map(|one| DisplayUnit::HERTZ.of(*one)).collect()
}
