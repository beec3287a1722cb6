//! Identification of a cylinder's friction from recorded runs.
//!
//! ```text
//! files -> FrictionRecording -> constant velocities | pressed rows | shaken rows -> initial estimate -> least squares over all of them -> coefficients, intervals, open ones
//! ```
//!
//! The model is [`LuGre`]. While the piston slides at a constant velocity, its equation has a
//! solution in closed form, and the force is explained for the recorded velocity. While it is
//! pressed or shaken and has not broken away, the mass on its bristles is simulated, and the
//! position is explained for the recorded force, whose noise is estimated with it: a pressing force
//! is linear between knots, a shaking force is a sum of sines. One set of coefficients explains
//! all.

mod curves;
mod directions;
mod estimates;
mod guess;
mod misfit;
mod motion;
mod pressing;
mod problem;
mod profile;
mod reading;
mod reasons;
mod shaking;
mod sign_error;
mod signs;
mod varying;

pub use curves::{PressedCurve, SteadyPoint};
pub use directions::{DirectionEvidence, DirectionModel, ExplainedByDirections};
pub use estimates::OpenCoefficient;
pub use misfit::{FrictionMisfit, FrictionSignal};
pub use motion::ConstantVelocity;
pub use pressing::PressedRows;
pub use reading::{FrictionRecording, KnownCylinder, friction_recordings, recorded_runs};
pub use reasons::{NotIdentifiableFriction, ROWS_OF_RINGING};
pub use shaking::ShakenRows;
pub use varying::VaryingVelocity;

use phea_dynamics::least_squares::{Ending, Minimum};
use phea_dynamics::watch::{Stopped, Watch};
use phea_hydraulics::friction::{FRICTION_COEFFICIENTS, LuGre, Stribeck};

use self::problem::{FrictionProblem, ShapeCache};
use crate::estimate::Estimate;
use crate::identify_error::{FrictionFitError, IdentifyError, UnsteadyRun};

/// Names of the coefficients as `[cylinder.friction]` has them, and their units.
pub const FRICTION_NAMES: [(&str, &str); BOTH_WAYS] = [
    ("coulomb", "N"),
    ("static", "N"),
    ("stribeck_velocity", "m/s"),
    ("stribeck_exponent", "1"),
    ("viscous", "N.s/m"),
    ("bristle_stiffness", "N/m"),
    ("bristle_damping", "N.s/m"),
];

/// Number of coefficients of a friction that is equal in both directions.
const BOTH_WAYS: usize = 7;

/// Names of the levels of retracting as `[cylinder.friction.retracting]` has them, and their units.
pub const RETRACTING_NAMES: [(&str, &str); FRICTION_COEFFICIENTS - BOTH_WAYS] =
    [("coulomb", "N"), ("static", "N"), ("viscous", "N.s/m")];

/// Friction that explains the recordings best.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionIdentification {
    /// Recorded runs.
    pub recordings: Vec<FrictionRecording>,
    /// Rows of sliding at a constant velocity, in the order of the recordings.
    pub slides: Vec<ConstantVelocity>,
    /// Rows of sliding at a velocity that is constant only on average: omitted.
    pub varying: Vec<VaryingVelocity>,
    /// Rows of pressing without sliding.
    pub presses: Vec<PressedRows>,
    /// Rows of shaking.
    pub shakes: Vec<ShakenRows>,
    /// Estimate of each coefficient, in the order of [`FRICTION_NAMES`]; if friction differs by
    /// direction, those of extending.
    pub estimates: [Result<Estimate, OpenCoefficient>; BOTH_WAYS],
    /// Levels of retracting, in the order of [`RETRACTING_NAMES`]; `None` if friction is equal in
    /// both directions.
    pub retracting: Option<[Result<Estimate, OpenCoefficient>; FRICTION_COEFFICIENTS - BOTH_WAYS]>,
    /// Comparison of one friction for both directions with one for each; `None` if there is no
    /// sliding in one of them.
    pub evidence: Option<DirectionEvidence>,
    /// Friction at the minimum, with values for the open coefficients.
    pub lugre: LuGre,
    /// Zero error of the force, N; `None` if the recordings move in only one direction, and if
    /// friction differs by direction.
    pub zero: Option<Estimate>,
    /// Root mean square of the residual force, N, each block as one row; and of the residual
    /// position of the presses, m.
    pub residual_rms: [Option<f64>; 2],
    /// Misfits that are not noise, the greatest first.
    pub misfits: Vec<FrictionMisfit>,
    /// Fraction of independent residuals, the least of all signals.
    pub independent: f64,
    /// Moving mass, kg.
    pub moving_mass: f64,
    /// Ending of the search.
    pub ending: Ending,
    /// Force at the knots of each press, N, and initial position, m.
    pressed: Vec<(Vec<f64>, f64)>,
    /// Explained force and position of each shake.
    shaken: Vec<PressedCurve>,
}

impl FrictionIdentification {
    /// True if no further step explains more.
    pub fn has_converged(&self) -> bool {
        self.ending == Ending::Converged
    }
}

/// Number of rounds in which the scale of each signal is computed from its residuals.
const ROUNDS: usize = 3;

/// Relative decrease of the sum at which an intermediate search ends.
const ROUGH: f64 = 1e-4;

/// Relative decrease at which the last search ends: a thousandth of the change by one standard
/// deviation.
const FINE: f64 = 1e-7;

/// Largest number of searches to that end, each from the minimum of the one before.
const FINE_SEARCHES: usize = 3;

/// Relative change of the scales below which no further round is made.
const SAME_SCALE: f64 = 1e-2;

/// Identifies the friction that explains all recordings at once.
///
/// # Errors
/// [`IdentifyError`] if the recordings contain neither a constant velocity nor pressing from rest,
/// and after cancellation.
pub fn identify_friction(
    recordings: Vec<FrictionRecording>,
    known: &KnownCylinder,
    watch: Watch<'_>,
) -> Result<FrictionIdentification, IdentifyError> {
    let (mut slides, mut varying) = (Vec::new(), Vec::new());
    for (index, recording) in recordings.iter().enumerate() {
        let motion::SlidingRuns { constant, varying: other } = motion::sliding_runs(recording, index);
        slides.extend(constant);
        varying.extend(other);
    }
    let guess::Guess { around, others, by_direction, presses, shakes } =
        guess::guess(&recordings, &slides, known.moving_mass)
            .ok_or_else(|| FrictionFitError::NothingDetermined(unsteady(&recordings, &varying)))?;
    let goes_both_ways = goes_both_ways(&slides, &presses);
    let setting = (known.moving_mass, around);
    let problem = FrictionProblem::new(&recordings, &slides, (&presses, &shakes), setting, goes_both_ways);
    let mut cache = ShapeCache::default();
    let curves = (others.as_slice(), by_direction);
    let (best, evidence) = SearchedFriction::by_evidence(problem, curves, &mut cache, watch)?;
    let SearchedFriction { problem, minimum } = best;
    let (lugre, _) = problem.friction(&minimum.variables);
    let estimates::Estimates { estimates, retracting, zero } = estimates::estimates(&problem, &minimum);
    let residual_rms = curves::residual_rms(&problem, &minimum);
    let misfits = misfit::misfits(&problem, &minimum.linearised.residuals);
    let independent = problem.channels.iter().map(|channel| channel.independent).fold(1.0, f64::min);
    let pressed = curves::pressed(&problem, &minimum);
    let shaken = curves::shaken(&problem, &minimum, &mut cache);
    let ending = minimum.ending;
    Ok(FrictionIdentification {
        estimates,
        retracting,
        evidence,
        lugre,
        zero,
        residual_rms,
        misfits,
        independent,
        moving_mass: known.moving_mass,
        ending,
        pressed,
        shaken,
        slides,
        varying,
        presses,
        shakes,
        recordings,
    })
}

/// A model and the end of its search.
struct SearchedFriction<'a> {
    problem: FrictionProblem<'a>,
    minimum: Minimum,
}

impl<'a> SearchedFriction<'a> {
    /// Model that the recordings support, from further curves for one friction, and from one with
    /// levels for each direction.
    fn by_evidence(
        problem: FrictionProblem<'a>,
        (others, by_direction): (&[(Stribeck, f64)], Option<Stribeck>),
        cache: &mut ShapeCache,
        watch: Watch<'_>,
    ) -> Result<(SearchedFriction<'a>, Option<DirectionEvidence>), IdentifyError> {
        let same = SearchedFriction::from_guess(problem.clone(), others, cache, watch)?;
        if same.minimum.ending == Ending::NoStart {
            return Err(FrictionFitError::NoStart.into());
        }
        if same.minimum.linearised.residuals.len() <= problem.count() {
            return Err(FrictionFitError::TooFewRows.into());
        }
        let Some(curve) = by_direction else { return Ok((same, None)) };
        let directions = DirectionModel::DiffersByDirection;
        let differs =
            SearchedFriction::by_direction(FrictionProblem { directions, ..problem }, curve, cache, watch)?;
        if differs.minimum.ending == Ending::NoStart {
            return Ok((same, None));
        }
        let evidence = DirectionEvidence::of([&same, &differs]);
        Ok((if evidence.chosen() == directions { differs } else { same }, Some(evidence)))
    }

    /// One friction for both directions.
    fn from_guess(
        problem: FrictionProblem<'a>,
        others: &[(Stribeck, f64)],
        cache: &mut ShapeCache,
        watch: Watch<'_>,
    ) -> Result<SearchedFriction<'a>, Stopped> {
        let minimum = problem.first_minimum(others, ROUGH, cache, watch)?;
        SearchedFriction::refined(problem, minimum, cache, watch)
    }

    /// Levels for each direction, from a curve that has both.
    fn by_direction(
        problem: FrictionProblem<'a>,
        curve: Stribeck,
        cache: &mut ShapeCache,
        watch: Watch<'_>,
    ) -> Result<SearchedFriction<'a>, Stopped> {
        let minimum = problem.minimum_from(&(curve, 0.0), ROUGH, cache, watch)?;
        SearchedFriction::refined(problem, minimum, cache, watch)
    }

    /// The search with the scale of each signal from its residuals.
    fn refined(
        mut problem: FrictionProblem<'a>,
        mut minimum: Minimum,
        cache: &mut ShapeCache,
        watch: Watch<'_>,
    ) -> Result<SearchedFriction<'a>, Stopped> {
        for _ in 0..ROUNDS {
            let change = problem.rescale(&minimum.linearised.residuals);
            minimum = problem.searched(&minimum.variables, ROUGH, cache, watch)?;
            if change < SAME_SCALE {
                break;
            }
        }
        for _ in 0..FINE_SEARCHES {
            minimum = problem.searched(&minimum.variables, FINE, cache, watch)?;
            if minimum.ending == Ending::Converged {
                break;
            }
        }
        Ok(SearchedFriction { problem, minimum })
    }
}

/// Runs that were omitted because their velocity is constant only on average.
fn unsteady(recordings: &[FrictionRecording], varying: &[VaryingVelocity]) -> Vec<UnsteadyRun> {
    let of = |one: &VaryingVelocity| UnsteadyRun {
        file: recordings.get(one.recording).map_or(String::new(), |recording| recording.file.clone()),
        mean: one.velocity,
        range: one.range,
    };
    varying.iter().map(of).collect()
}

/// True if friction acts in both directions, so that it differs from a constant force.
fn goes_both_ways(slides: &[ConstantVelocity], presses: &[PressedRows]) -> bool {
    let broken = presses.iter().filter(|press| press.breaks_away).map(PressedRows::way);
    let ways: Vec<f64> = slides.iter().map(|slide| slide.velocity).chain(broken).collect();
    ways.iter().any(|way| *way > 0.0) && ways.iter().any(|way| *way < 0.0)
}
