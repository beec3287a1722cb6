//! Identification of a servovalve's coefficients from recorded static tests.
//!
//! ```text
//! files -> Recording -> initial estimate (thesis, section 5.2) -> least squares over all signals at once -> intervals, undetermined combinations
//! ```
//!
//! The model is [`phea_hydraulics::servovalve::TestedValve`]; all signals of all files are
//! explained by one set of coefficients.

mod averaged;
mod bootstrap;
mod channels;
mod contents;
mod evidence;
mod fit;
mod guess;
mod instruments;
mod intervals;
mod joint;
mod memory;
mod misfit;
mod not_identifiable;
mod reading;
mod recording;
mod residuals;
mod simple;
mod terms;
mod variables;
mod warm;

pub use bootstrap::{Bootstrap, FEWEST_REPETITIONS};
pub use contents::{ColumnContents, FileContents, RecordedFiles};
pub use evidence::{DECISIVE, ExplainedBy, ModelEvidence};
pub use joint::{COVERAGE, JointRegion, JointRegionError, SMALLEST_EFFECT, joint_region, with_valve};
pub use misfit::{Misfit, MisfitPlace};
pub use not_identifiable::NotIdentifiableCombination;
pub use reading::recordings;
pub use recording::{RecordedSignal, Recording, SignalKind, TestBranch};
pub use simple::{NullMethod, NullReading, SimpleCalculations};
pub use terms::{TermEvidence, ValveTerm};
pub use warm::TestOil;

use phea_dynamics::least_squares::Ending;
use phea_dynamics::watch::Watch;
use phea_hydraulics::servovalve::{
    LeakageModel, OilLaw, STATIC_COEFFICIENTS, StaticCoefficients, TestedValve, ValveTerms, ramp_delay,
};

use self::fit::Fit;
use self::variables::Variables;
use crate::estimate::Estimate;
use crate::identify_error::IdentifyError;
use crate::project::{Project, RatedFlow, ValveCoefficients};

/// Names of the coefficients, in order, and their units.
pub const COEFFICIENT_NAMES: [(&str, &str); STATIC_COEFFICIENTS] = [
    ("flow_coefficients.supply_to_a", "m3/(s.Pa^0.5)"),
    ("flow_coefficients.a_to_tank", "m3/(s.Pa^0.5)"),
    ("flow_coefficients.supply_to_b", "m3/(s.Pa^0.5)"),
    ("flow_coefficients.b_to_tank", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.supply_to_a", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.a_to_tank", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.supply_to_b", "m3/(s.Pa^0.5)"),
    ("leakage_coefficients.b_to_tank", "m3/(s.Pa^0.5)"),
    ("leakage_shape", "1"),
    ("tare_flow", "m3/s"),
    ("null_bias", "V"),
    ("hysteresis", "V"),
    ("lap.positive", "1"),
    ("lap.negative", "1"),
    ("saturation", "1"),
    ("leakage_shapes.a_to_tank", "1"),
    ("leakage_shapes.supply_to_b", "1"),
    ("leakage_shapes.b_to_tank", "1"),
];

/// Facts that are known in addition to the files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Command of full opening, V.
    pub nominal_voltage: f64,
    /// Delay with which the spool follows a steady ramp, s; 0 if its dynamics are not known.
    pub spool_delay: f64,
    /// Pressure drop below which the flow of an edge is laminar, Pa.
    pub transition_pressure: f64,
    /// Supply pressure, used if a file has no column for it, Pa.
    pub supply_pressure: Option<f64>,
    /// Tank pressure, used if a file has no column for it, Pa.
    pub tank_pressure: f64,
    /// Pressure drop at which the tare flow is reported, Pa; absent: that of the files.
    pub tare_pressure: Option<f64>,
    /// Model of the leakage if the recordings do not decide.
    pub leakage_model: LeakageModel,
    /// Variation of the oil with its temperature.
    pub oil: OilLaw,
    /// Oil temperature for which the coefficients are reported, degC; absent: the mean of the
    /// files.
    pub oil_reference: Option<f64>,
    /// Rated flow, m3/s, and its pressure drop, Pa, if a data sheet states them.
    pub rated_flow: Option<[f64; 2]>,
    /// Coefficients of both edges in series that a positive and a negative command open,
    /// m³/(s·√Pa), if the valve is declared.
    pub path_coefficients: Option<[f64; 2]>,
}

impl Default for Known {
    fn default() -> Known {
        Known {
            nominal_voltage: 10.0,
            spool_delay: 0.0,
            transition_pressure: 1e3,
            supply_pressure: None,
            tank_pressure: 0.0,
            tare_pressure: None,
            oil: OilLaw::default(),
            oil_reference: None,
            leakage_model: LeakageModel::EachEdge,
            rated_flow: None,
            path_coefficients: None,
        }
    }
}

impl Known {
    /// Facts that a project states about its valve and its supply; the defaults if it has no
    /// actuator.
    pub fn of(project: &Project) -> Known {
        let temperature = project.identify.as_ref().map(|one| one.oil_temperature).unwrap_or_default();
        let oil =
            OilLaw { viscosity_slope: temperature.viscosity_slope, density_slope: temperature.density_slope };
        let oil_reference = temperature.reference;
        let Some(actuator) = &project.actuator else {
            return Known { oil, oil_reference, ..Known::default() };
        };
        let valve = &actuator.valve;
        Known {
            rated_flow: valve.flow.rating().map(|rated| [rated.flow, rated.pressure_drop]),
            path_coefficients: Some(path_coefficients(&valve.flow)),
            nominal_voltage: valve.nominal_voltage,
            spool_delay: ramp_delay(valve.natural_frequency, valve.damping_ratio),
            transition_pressure: valve.transition_pressure,
            supply_pressure: Some(actuator.supply.pressure),
            tank_pressure: actuator.supply.tank_pressure,
            tare_pressure: valve.tare_pressure,
            oil,
            oil_reference,
            leakage_model: valve.leakage_model,
        }
    }
}

/// Coefficients of the two edges in series that a positive and a negative command open.
fn path_coefficients(flow: &ValveCoefficients<RatedFlow>) -> [f64; 2] {
    match flow {
        ValveCoefficients::Edges { edges, .. } => {
            let series = |one: f64, other: f64| 1.0 / (1.0 / (one * one) + 1.0 / (other * other)).sqrt();
            [series(edges.supply_to_a, edges.b_to_tank), series(edges.supply_to_b, edges.a_to_tank)]
        }
        ValveCoefficients::Rated(rated) => [rated.flow / rated.pressure_drop.sqrt(); 2],
    }
}

/// Difference of the criterion that no further search can offset.
const FAR: f64 = 1000.0;

/// Extent of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Number of starting points, including the initial estimate.
    pub starts: usize,
    /// Seed of the other starting points, and of the bootstrap.
    pub seed: u32,
    /// Model of the leakage whose coefficients are requested; absent: the one that the recordings
    /// support.
    pub leakage_model: Option<LeakageModel>,
    /// Number of bootstrap repetitions; zero disables it.
    pub bootstrap: usize,
}

impl Default for Search {
    fn default() -> Search {
        Search { starts: 6, seed: 1, leakage_model: None, bootstrap: 0 }
    }
}

/// Valve that explains the files best.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// Recorded tests.
    pub recordings: Vec<Recording>,
    /// Coefficients of the valve.
    pub coefficients: StaticCoefficients,
    /// Estimate of each coefficient with its linearised interval; `None` if the data do not
    /// determine it.
    pub estimates: [Option<Estimate>; STATIC_COEFFICIENTS],
    /// Standard deviation of each coefficient, in its unit; infinite if nothing depends on it.
    pub deviations: [f64; STATIC_COEFFICIENTS],
    /// Intervals by the bootstrap, if requested.
    pub bootstrap: Option<Bootstrap>,
    /// Correlations of all pairs, row by row.
    pub correlations: Vec<f64>,
    /// Combinations that the data do not determine, the least known first.
    pub not_identifiable: Vec<NotIdentifiableCombination>,
    /// Results of the calculations of section 5.2, for comparison.
    pub simple: SimpleCalculations,
    /// Initial estimate, at which the search began.
    pub first_guess: StaticCoefficients,
    /// Comparison of both models of the leakage.
    pub evidence: ModelEvidence,
    /// Evidence for each term of the valve.
    pub terms: Vec<TermEvidence>,
    /// Fit of each signal, with the errors of the instruments that explain most, within their
    /// stated accuracies.
    pub signals: Vec<SignalFit>,
    /// Root mean square of all residuals, each divided by the range of its signal.
    pub residual_rms: f64,
    /// Minimised cost: the sum of the losses of all residuals divided by their scales.
    pub cost: f64,
    /// Coefficients that ended at a bound of the search.
    pub at_bounds: Vec<&'static str>,
    /// Number of starting points, and number of those that lead to this minimum.
    pub starts: [usize; 2],
    /// Ending of the search.
    pub ending: Ending,
    /// Valve and conditions that were assumed to be known.
    pub tested: TestedValve,
    /// Oil, if its temperature was recorded.
    pub oil: Option<TestOil>,
}

impl Identification {
    /// Pressure drop from supply to tank of most rows, Pa.
    pub fn usual_drop(&self) -> f64 {
        recording::usual_drop(&self.recordings)
    }

    /// Indices of the coefficients in its model, in their order.
    pub fn in_model(&self) -> impl Iterator<Item = usize> {
        let terms = self.tested.terms;
        (0..STATIC_COEFFICIENTS).filter(move |index| variables::has(terms, *index))
    }

    /// Path of a coefficient in the project: the shape of edge 3 is that of all if the edges have
    /// no separate shapes.
    pub fn path(&self, name: &str) -> String {
        match name {
            "leakage_shape" if self.tested.terms.leakage_by_edge => {
                "valve.leakage_shapes.supply_to_a".to_string()
            }
            name => format!("valve.{name}"),
        }
    }

    /// Indices of those coefficients on which the linear plant depends.
    pub fn of_plant(&self) -> impl Iterator<Item = usize> {
        self.in_model().filter(|index| !variables::ONLY_OF_TEST.contains(index))
    }

    /// True if no further step explains more.
    pub fn has_converged(&self) -> bool {
        self.ending == Ending::Converged
    }
}

/// Fit of a signal, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalFit {
    /// Index of the recording.
    pub recording: usize,
    /// Kind of the signal.
    pub kind: SignalKind,
    /// Number of rows that count.
    pub rows: usize,
    /// Root mean square of the residuals.
    pub rms: f64,
    /// Scale of the residuals, insensitive to a few outliers.
    pub scale: f64,
    /// Largest minus smallest recorded value.
    pub range: f64,
    /// Correlation of neighbouring residuals: near zero for noise, near one if the model is wrong.
    pub correlation: f64,
}

/// Finds the coefficients that explain all recordings at once.
///
/// # Errors
/// [`IdentifyError`] if no valve explains the recordings, and after cancellation.
pub fn identify(
    mut recordings: Vec<Recording>,
    known: &Known,
    search: Search,
    watch: Watch<'_>,
) -> Result<Identification, IdentifyError> {
    let oil = warm::warm(&mut recordings, known.oil, known.oil_reference);
    let tested = TestedValve {
        nominal_voltage: known.nominal_voltage,
        transition_pressure: known.transition_pressure,
        tare_reference_drop: known.tare_pressure.unwrap_or_else(|| recording::usual_drop(&recordings)),
        leakage_model: known.leakage_model,
        terms: ValveTerms::default(),
    };
    let simple = simple::simple_calculations(&recordings, &tested, known.rated_flow);
    let first_guess = guess::first_guess(&recordings, &tested, &simple);
    let variables = Variables::around(&first_guess, tested.nominal_voltage);
    let first = fit::fitted(&recordings, tested, &variables, search, watch)?;
    let starts = first.starts;
    let remembered = memory::remembered(&first, first_guess.hysteresis_width, watch)?;
    let first = match &remembered {
        Some(with_memories) => with_memories.fitted(&first, watch)?,
        None => first,
    };
    let (evidence, found, terms) = best_model(first, (search.leakage_model, known.leakage_model), watch)?;
    let variables = found.together.variables.clone();
    let coefficients = found.coefficients();
    let groups = found.together.groups(found.block_rows());
    let shared = instruments::shared_changes(&found.together, &found.minimum.variables, oil.as_ref());
    let uncertainty =
        intervals::uncertainty(&found.minimum.linearised, (&groups, &shared), &variables, &coefficients);
    let signals = found.signals_with(&instruments::without_errors(&found.minimum.linearised, &shared));
    let mut estimates = intervals::estimates(&variables, &coefficients, &uncertainty.deviations);
    intervals::lowered_tare_flow(&mut estimates, &recordings, &signals);
    let deviations = intervals::deviations(&variables, &coefficients, &uncertainty.deviations);
    let usual = usual(&coefficients, &estimates, &first_guess);
    let scales = variables.scales(&usual);
    let bootstrap = match search.bootstrap {
        0 => None,
        repetitions => Some(bootstrap::bootstrap(&found, repetitions, search.seed, watch)?),
    };
    let tested = found.together.tested;
    let recordings = found.together.recordings.to_vec();
    let combinations = not_identifiable::combinations(&uncertainty, &usual, &scales, (&recordings, &tested));
    Ok(Identification {
        coefficients,
        estimates,
        deviations,
        bootstrap,
        not_identifiable: combinations,
        correlations: uncertainty.correlations,
        simple,
        first_guess,
        evidence,
        terms,
        residual_rms: residual_rms(&signals),
        cost: found.minimum.cost,
        signals,
        at_bounds: found.at_bounds(),
        starts,
        ending: found.minimum.ending,
        tested,
        oil,
        recordings,
    })
}

/// Coefficients at which a further test is judged: one that is not determined may have ended
/// anywhere, and is replaced by its usual value.
fn usual(
    coefficients: &StaticCoefficients,
    estimates: &[Option<Estimate>; STATIC_COEFFICIENTS],
    first_guess: &StaticCoefficients,
) -> StaticCoefficients {
    let mut usual = coefficients.to_array();
    for ((number, estimate), start) in usual.iter_mut().zip(estimates).zip(first_guess.to_array()) {
        *number = if estimate.is_some() { *number } else { start };
    }
    StaticCoefficients::from_array(usual)
}

/// Comparison of both models of the leakage, with the terms of the valve beyond edges that open in
/// proportion; and the fit of the requested model, or else the preferred one, or else the usual
/// one.
///
/// A term of the valve may make one model of the leakage resemble the other: if a term is added,
/// both are compared again with it.
fn best_model<'a>(
    first: Fit<'a>,
    models: (Option<LeakageModel>, LeakageModel),
    watch: Watch<'_>,
) -> Result<(ModelEvidence, Fit<'a>, Vec<TermEvidence>), IdentifyError> {
    let (evidence, found) = better_leakage(first, models, watch)?;
    // in addition to a model that the recordings contradict, a term would replace what that model
    // lacks
    if evidence.preferred().is_some_and(|preferred| preferred != found.together.tested.leakage_model) {
        return Ok((evidence, found, Vec::new()));
    }
    let (found, terms) = terms::with_terms(found, watch)?;
    if found.together.tested.terms == ValveTerms::default() || found.together.tested.terms.leakage_by_edge {
        return Ok((evidence, found, terms));
    }
    let model = found.together.tested.leakage_model;
    let (evidence, found) = better_leakage(found, models, watch)?;
    match found.together.tested.leakage_model == model {
        true => Ok((evidence, found, terms)),
        false => {
            let (found, again) = terms::with_terms(found, watch)?;
            let before = terms.into_iter().filter(|one| one.taken);
            Ok((evidence, found, before.chain(again).collect()))
        }
    }
}

/// Comparison of both models of the leakage, and the fit of the requested one, or else the
/// preferred one, or else the usual one.
fn better_leakage<'a>(
    first: Fit<'a>,
    (wanted, usual): (Option<LeakageModel>, LeakageModel),
    watch: Watch<'_>,
) -> Result<(ModelEvidence, Fit<'a>), IdentifyError> {
    let model = first.together.tested.leakage_model;
    let is_first = |evidence: &ModelEvidence| wanted.or(evidence.preferred()).unwrap_or(usual) == model;
    let leakage_model = match model {
        LeakageModel::EachEdge => LeakageModel::OneCurve,
        LeakageModel::OneCurve => LeakageModel::EachEdge,
    };
    let other = TestedValve { leakage_model, ..first.together.tested };
    let second = fit::with_another_model(&first, other, watch)?;
    let rough = ModelEvidence::of([&first, &second]);
    let is_settled = rough.difference() > FAR && is_first(&rough);
    let second = if is_settled { second } else { second.searched_to_the_end(watch)? };
    let evidence = ModelEvidence::of([&first, &second]);
    let found = if is_first(&evidence) { first } else { second };
    Ok((evidence, found))
}

/// Root mean square of all residuals, each divided by the range of its signal.
fn residual_rms(signals: &[SignalFit]) -> f64 {
    let of = |one: &SignalFit| one.rows as f64 * (one.rms / one.range) * (one.rms / one.range);
    let rows: usize = signals.iter().map(|one| one.rows).sum();
    (signals.iter().map(of).sum::<f64>() / rows as f64).sqrt()
}
