//! The linear models of a rig while one number of its project varies from one end to the other.
//!
//! ```text
//! line.length=0.5 m..3 m -> range -> values -> read again with --set -> Rig -> linearize -> SweepPoint
//! ```

use num_complex::Complex64;
use phea_dynamics::controller::Controller;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::PlantCoefficients;

use super::{Linearization, linearize, resonance};
use crate::caveat::{Caveat, caveats};
use crate::linear_loop::{LinearLoop, LoopStability, linear_loop, linear_loop_of};
use crate::option::OptionError;
use crate::project::{self, Key, KeyEntry, Loaded, Motions, Refusal};
use crate::quantity::{self, Dimension, DisplayUnit, Units, display};
use crate::rig::RigError;
use crate::setup::{ControlError, Setup};
use crate::source::Source;
use crate::spelling::nearest;

/// The request, as written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SweepRequest {
    /// Key and range, such as `line.length=0.5 m..3 m`; a unit at the end also applies to a bare
    /// number at the start.
    pub range: String,
    /// Number of values, including both ends; [`POINTS`] if absent.
    pub points: Option<usize>,
}

/// Number of values if none is requested.
pub const POINTS: usize = 11;
/// Largest number of values.
pub(crate) const MOST_POINTS: usize = 1000;
/// Ratio of two ends of one sign above which the values are evenly spaced by ratio.
const DECADES: f64 = 100.0;
/// Relative change by which a pole must move to count as dependent on the swept number.
const MOVED: f64 = 1e-9;
/// Band of the settling time with which a loop is computed, percent; steps are not reported.
const BAND_PERCENT: f64 = 2.0;

/// Reason why nothing is swept.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SweepError {
    /// The key, the range or the number of points is invalid.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// One of the values makes the project invalid.
    #[error("{0}")]
    Refused(Refusal),
}

/// A sweep.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The swept key.
    pub path: String,
    /// Unit for display.
    pub unit: DisplayUnit,
    /// SI unit of the values.
    pub si: &'static str,
    /// Motion of the rig and units of display.
    pub units: Units,
    /// True if the values are evenly spaced by ratio.
    pub by_ratio: bool,
    /// True if the plant of every verdict depends on the key. It may not if the project states the
    /// parameters of the linear model: then everything reported about poles refers to the derived
    /// parameters.
    pub plant_follows: bool,
    /// Effects of the project that no verdict on the linear loop includes.
    pub caveats: Vec<Caveat>,
    /// Points in the order of their values.
    pub points: Vec<SweepPoint>,
}

/// One value.
#[derive(Clone, Debug)]
pub struct SweepPoint {
    /// Value, SI.
    pub value: f64,
    /// Models at this value, or the reason why there are none.
    pub found: Result<Swept, NoSweptModels>,
}

/// The models at one value.
#[derive(Clone, Debug)]
pub struct Swept {
    /// Linear models, as `linearize` returns them.
    pub linearization: Linearization,
    /// Poles of the plant, rad/s; with the derived parameters, if the plant does not depend on the
    /// key.
    pub poles: Vec<Complex64>,
    /// Least damped of these poles with a resonance.
    pub resonance: Option<Complex64>,
    /// Frequency up to which force over reference stays within 3 dB of its value towards zero
    /// frequency, rad/s; or the reason why there is none.
    pub bandwidth_rad_per_s: Result<f64, NoBandwidth>,
}

/// Reason why there are no models at a value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoSweptModels {
    /// The controller or the sensor is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A linear model cannot be computed.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
}

/// Reason why a loop has no bandwidth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoBandwidth {
    /// The project gives no controller.
    NoController,
    /// The loop cannot be closed.
    NotClosed,
    /// The closed loop is unstable.
    Unstable,
    /// The force follows up to every frequency at which it was evaluated.
    BeyondRange,
}

/// Sweeps a number of a project.
///
/// # Errors
/// [`SweepError`] for an invalid request, or a value that makes the project invalid.
pub fn sweep(
    source: &dyn Source,
    (loaded, setup): (&Loaded, &Setup<'_>),
    catalogues: &[String],
    request: &SweepRequest,
) -> Result<Sweep, SweepError> {
    let units = loaded.project.units;
    let requested = range(&request.range, loaded.project.motions())?;
    let by_ratio = requested.by_ratio();
    let SweepRange { path, key, ends } = requested;
    let count = points(request.points)?;
    let mut found = Vec::new();
    for value in values(ends, count, by_ratio) {
        let mut settings = loaded.all_settings();
        settings.push(format!("{path}={value:e}"));
        let there =
            project::read(source, &loaded.path, &settings, catalogues).map_err(SweepError::Refused)?;
        found.push((value, linearized(&there.with_lines_of(loaded))));
    }
    let plant_follows = moves(&found);
    let points = found
        .into_iter()
        .map(|(value, found)| SweepPoint { value, found: found.map(|models| swept(models, plant_follows)) })
        .collect();
    let unit = quantity::fitting(ends[0].abs().max(ends[1].abs()), key.dimension);
    let caveats = caveats(setup);
    Ok(Sweep { path, unit, si: key.dimension.si, units, by_ratio, plant_follows, caveats, points })
}

/// A parsed range.
pub(crate) struct SweepRange {
    pub(crate) path: String,
    pub(crate) key: Key,
    /// Ends of the range, SI.
    pub(crate) ends: [f64; 2],
}

impl SweepRange {
    /// True if the values are evenly spaced by ratio.
    pub(crate) fn by_ratio(&self) -> bool {
        let [from, to] = self.ends;
        let ratio = (to / from).abs();
        from * to > 0.0 && ratio.max(1.0 / ratio) > DECADES
    }
}

fn refused(text: &str, problem: &SweepProblem) -> OptionError {
    OptionError { option: "sweep", text: text.to_string(), message: problem.to_string() }
}

/// Fault of a requested sweep.
#[derive(Debug, thiserror::Error)]
enum SweepProblem {
    #[error("a sweep has the form KEY=FROM..TO, such as line.length=0.5 m..3 m")]
    Form,
    #[error("both ends are the same: there is nothing to sweep")]
    NoRange,
    #[error("`{path}` takes {takes}, and only a number can be swept")]
    NoNumber { path: String, takes: String },
    #[error("the project file has no number `{path}`")]
    UnknownKey { path: String },
    #[error("the project file has no number `{path}`; did you mean `{near}`?")]
    MisspelledKey { path: String, near: String },
    #[error("{error}; write {}, such as {}{}", dimension.name, dimension.examples, further(error))]
    Unreadable { error: quantity::QuantityError, dimension: &'static Dimension },
    #[error("{shown} is outside of what `{key}` may be")]
    OutOfRange { shown: String, key: &'static str },
    #[error("a sweep has 2 to {MOST_POINTS} points")]
    Points,
}

fn further(error: &quantity::QuantityError) -> String {
    error.help.as_ref().map_or(String::new(), |help| format!("; {help}"))
}

/// Range stated in a text, in the units of the motions of rig and load.
pub(crate) fn range(text: &str, motions: Motions) -> Result<SweepRange, OptionError> {
    let form = || refused(text, &SweepProblem::Form);
    let (path, ends) = text.split_once('=').ok_or_else(form)?;
    let (from, to) = ends.split_once("..").ok_or_else(form)?;
    let [path, from, to] = [path, from, to].map(str::trim);
    if from.is_empty() || to.is_empty() {
        return Err(form());
    }
    let key = key(text, path)?.in_motion(motions);
    // the unit of the end also applies to a bare start, as in a list
    let from = if bare(from).is_some() && bare(to).is_none() {
        format!("{from} {}", unit_of(to))
    } else {
        from.to_string()
    };
    let ends = [number(text, &from, &key)?, number(text, to, &key)?];
    if ends[0] == ends[1] {
        return Err(refused(text, &SweepProblem::NoRange));
    }
    Ok(SweepRange { path: path.to_string(), key, ends })
}

/// Entry of the key, or the nearest spelling.
fn key(text: &str, path: &str) -> Result<Key, OptionError> {
    let keys = project::keys();
    let is_number = |entry: &&KeyEntry| entry.takes == entry.key.dimension.name;
    let named = |entry: &&KeyEntry| entry.path == path;
    if let Some(entry) = keys.iter().filter(is_number).find(named) {
        return Ok(entry.key);
    }
    if let Some(entry) = keys.iter().find(named) {
        let problem = SweepProblem::NoNumber { path: path.to_string(), takes: entry.takes.clone() };
        return Err(refused(text, &problem));
    }
    let names = keys.iter().filter(is_number).map(|entry| entry.path.as_str());
    let path = path.to_string();
    let problem = match nearest(&path, names).map(str::to_string) {
        Some(near) => SweepProblem::MisspelledKey { path, near },
        None => SweepProblem::UnknownKey { path },
    };
    Err(refused(text, &problem))
}

fn bare(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|value| value.is_finite())
}

/// Text after the number.
fn unit_of(text: &str) -> &str {
    let number =
        (0..text.len()).rev().find(|end| text.get(..*end).is_some_and(|start| bare(start.trim()).is_some()));
    number.and_then(|end| text.get(end..)).unwrap_or_default().trim()
}

fn number(text: &str, part: &str, key: &Key) -> Result<f64, OptionError> {
    let value = match bare(part) {
        Some(value) => value,
        None => quantity::parse(part, key.dimension)
            .map_err(|error| refused(text, &SweepProblem::Unreadable { error, dimension: key.dimension }))?,
    };
    if key.range.contains(value) {
        return Ok(value);
    }
    let shown = display(value, key.dimension, 6);
    Err(refused(text, &SweepProblem::OutOfRange { shown, key: key.name }))
}

pub(crate) fn points(requested: Option<usize>) -> Result<usize, OptionError> {
    match requested.unwrap_or(POINTS) {
        count @ 2..=MOST_POINTS => Ok(count),
        count => Err(OptionError {
            option: "points",
            text: count.to_string(),
            message: SweepProblem::Points.to_string(),
        }),
    }
}

pub(crate) fn values([from, to]: [f64; 2], count: usize, by_ratio: bool) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    let at = |index: usize| {
        let fraction = index as f64 / last;
        match (index, by_ratio) {
            (0, _) => from,
            _ if index + 1 == count => to,
            (_, true) => from * portable::exp(fraction * portable::ln(to / from)),
            (_, false) => from + fraction * (to - from),
        }
    };
    (0..count).map(at).collect()
}

/// Models and controller at one value.
struct Models {
    linearization: Linearization,
    /// Plant from command to force, as in the loop.
    seen: PlantCoefficients<f64>,
    given: Option<Controller>,
    sensor: TransferFunction,
}

fn linearized(loaded: &Loaded) -> Result<Models, NoSweptModels> {
    let setup = Setup::new(&loaded.project)?;
    let rig = setup.rig()?;
    let seen = rig.in_loop().plant.coefficients();
    let linearization = linearize(rig, setup.controller.as_ref(), &setup.sensor)?;
    Ok(Models { linearization, seen, given: setup.controller, sensor: setup.sensor })
}

/// True if a pole of the plant changes with the value.
fn moves(found: &[(f64, Result<Models, NoSweptModels>)]) -> bool {
    let mut plants =
        found.iter().filter_map(|(_, found)| Some(found.as_ref().ok()?.linearization.plant.command.poles()));
    let Some(first) = plants.next() else { return true };
    let near = |one: &Complex64, other: &Complex64| {
        portable::magnitude(one - other) <= MOVED * portable::magnitude(*one)
    };
    plants.any(|poles| {
        poles.len() != first.len() || !first.iter().zip(poles).all(|(one, other)| near(one, other))
    })
}

fn swept(models: Models, plant_follows: bool) -> Swept {
    let Models { linearization, seen, given, sensor } = models;
    let derived = &linearization.derived_plant;
    let function = if plant_follows { &linearization.plant.command } else { derived };
    let closed = given.map(|given| match plant_follows {
        true => linear_loop_of(&seen, &given, &sensor, BAND_PERCENT),
        false => linear_loop(derived, &given, &sensor, BAND_PERCENT),
    });
    let bandwidth_rad_per_s = match closed {
        None => Err(NoBandwidth::NoController),
        Some(Err(_)) => Err(NoBandwidth::NotClosed),
        Some(Ok(closed)) => bandwidth(&closed, &sensor),
    };
    Swept {
        poles: function.poles().to_vec(),
        resonance: resonance(function),
        bandwidth_rad_per_s,
        linearization,
    }
}

/// Range of frequencies in which a bandwidth is searched, rad/s, and the resolution.
const LOOKED_AT: [f64; 2] = [1e-2, 1e5];
const STEPS_PER_DECADE: f64 = 200.0;

/// Frequency at which |F L/(1 + L)/H| first falls 3 dB below its value towards zero frequency,
/// rad/s.
fn bandwidth(closed: &LinearLoop, sensor: &TransferFunction) -> Result<f64, NoBandwidth> {
    if closed.stability == LoopStability::Unstable {
        return Err(NoBandwidth::Unstable);
    }
    let magnitude = |frequency: f64| {
        let open = closed.open_loop.at_frequency(frequency);
        let tracked = closed.prefilter.at_frequency(frequency) * open / (1.0 + open);
        portable::magnitude(tracked / sensor.at_frequency(frequency))
    };
    let [first, last] = LOOKED_AT;
    let least = magnitude(first) * std::f64::consts::FRAC_1_SQRT_2;
    let factor = portable::exp(std::f64::consts::LN_10 / STEPS_PER_DECADE);
    let mut low = first;
    while low < last {
        let high = low * factor;
        if magnitude(high) < least {
            return Ok(bisected(low, high, |frequency| magnitude(frequency) < least));
        }
        low = high;
    }
    Err(NoBandwidth::BeyondRange)
}

fn bisected(mut low: f64, mut high: f64, is_beyond: impl Fn(f64) -> bool) -> f64 {
    const HALVINGS: usize = 40;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_beyond(middle) { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}
