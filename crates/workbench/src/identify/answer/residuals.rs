//! Fit of the signals, and what the recordings leave open, for programs.

use phea_dynamics::order::sort_by_number;
use phea_engineering::identify::{
    COEFFICIENT_NAMES, Identification, Misfit, MisfitPlace, NotIdentifiableCombination, SignalFit, SignalKind,
};

use crate::answer::{Answer, words};
use crate::project::StaticTest;

/// Residuals of a recorded signal.
#[derive(Answer)]
pub(super) struct ValveSignalAnswer {
    /// Path of the recording.
    file: String,
    /// Explained signal.
    signal: SignalKind,
    /// SI unit of `rms`, `rms_by_hand`, `scale` and `range`.
    unit: &'static str,
    /// Number of rows that count.
    rows: usize,
    /// Root mean square of the residuals.
    rms: f64,
    /// Root mean square of the residuals with the coefficients that are calculated by hand.
    rms_by_hand: f64,
    /// Scale of the residuals that a few outliers do not change.
    scale: f64,
    /// Largest less smallest recorded value.
    range: f64,
    /// Correlation of neighbouring residuals: near zero for noise, near one where the model is
    /// wrong.
    neighbour_correlation: f64,
}

/// Signal that the identified valve does not explain.
#[derive(Answer)]
pub(super) struct ValveMisfitAnswer {
    /// Path of the recording.
    file: String,
    /// Signal with the misfit.
    signal: SignalKind,
    /// Root mean square of the misfit over the range of the signal.
    fraction: f64,
    /// Correlation of neighbouring residuals.
    neighbour_correlation: f64,
    /// Place of the greatest misfit, if a row shows it.
    #[answer(optional)]
    greatest: Option<MisfitPlaceAnswer>,
}

/// Part of a test in which a misfit is greatest.
#[derive(Answer)]
struct MisfitPlaceAnswer {
    /// True while the command rises, false while it falls.
    command_rises: bool,
    /// Range of the command, from low to high.
    #[answer(interval)]
    command_v: [f64; 2],
    /// Mean of the modelled less the recorded signal, over the range of the signal.
    mean_fraction: f64,
}

/// Correlation of two estimates.
#[derive(Answer)]
pub(super) struct CorrelationAnswer {
    /// Names of both coefficients in the table `[valve]`.
    coefficients: [&'static str; 2],
    /// Correlation, from -1 to 1.
    correlation: f64,
}

/// Combination of coefficients that the recordings do not determine.
#[derive(Answer)]
pub(super) struct NotIdentifiableAnswer {
    /// Names of the coefficients in the table `[valve]`, the greatest component first.
    coefficients: Vec<&'static str>,
    /// Components of the direction of length one in the logarithms of the coefficients, in the
    /// same order.
    components: Vec<f64>,
    /// Standard deviation along the direction, in the logarithm; inf if no recorded signal depends
    /// on it.
    standard_deviation: f64,
    /// Tests that would determine the combination.
    identifiable_by: Vec<StaticTest>,
}

words! {
    /// Recorded signal that a model of the valve explains.
    SignalKind by SignalKind::name [
        PressureA, PressureB, MeanPressure, LeakFlow, PortFlow, PortFlowMagnitude,
    ]
}

words! {
    /// Static test of a servovalve by ISO 10770-1.
    StaticTest by StaticTest::name [Leakage, Metering, PressureGain]
}

/// Correlations below this magnitude are not listed.
const REMARKABLE: f64 = 0.9;

pub(super) fn signals(found: &Identification) -> Vec<ValveSignalAnswer> {
    let one = |signal: &SignalFit| ValveSignalAnswer {
        file: file(found, signal.recording),
        signal: signal.kind,
        unit: if signal.kind.is_pressure() { "Pa" } else { "m3/s" },
        rows: signal.rows,
        rms: signal.rms,
        rms_by_hand: found.residual_rms_of(signal, &found.first_guess),
        scale: signal.scale,
        range: signal.range,
        neighbour_correlation: signal.correlation,
    };
    found.signals.iter().map(one).collect()
}

pub(super) fn misfits(found: &Identification) -> Vec<ValveMisfitAnswer> {
    let place = |place: MisfitPlace| MisfitPlaceAnswer {
        command_rises: place.is_rising,
        command_v: place.command,
        mean_fraction: place.fraction,
    };
    let one = |misfit: Misfit| ValveMisfitAnswer {
        file: file(found, misfit.recording),
        signal: misfit.kind,
        fraction: misfit.fraction,
        neighbour_correlation: misfit.correlation,
        greatest: misfit.place.map(place),
    };
    found.misfits().into_iter().map(one).collect()
}

fn file(found: &Identification, recording: usize) -> String {
    found.recordings.get(recording).map_or(String::new(), |one| one.file.clone())
}

/// Pairs of coefficients that move together, the closest first.
pub(in super::super) fn correlations(found: &Identification) -> Vec<([&'static str; 2], f64)> {
    let names = || COEFFICIENT_NAMES.iter().map(|(name, _)| *name).enumerate();
    let pairs = names().flat_map(|(i, first)| {
        names().filter(move |(j, _)| *j > i).map(move |(j, second)| (i, j, [first, second]))
    });
    let mut listed: Vec<([&'static str; 2], f64)> = pairs
        .filter_map(|(i, j, both)| {
            let correlation = *found.correlations.get(i * COEFFICIENT_NAMES.len() + j)?;
            let are_identified = found.estimates.get(i)?.is_some() && found.estimates.get(j)?.is_some();
            (are_identified && correlation.abs() > REMARKABLE).then_some((both, correlation))
        })
        .collect();
    sort_by_number(&mut listed, |(_, correlation)| -correlation.abs());
    listed
}

pub(super) fn correlation_answers(found: &Identification) -> Vec<CorrelationAnswer> {
    let one = |(coefficients, correlation)| CorrelationAnswer { coefficients, correlation };
    correlations(found).into_iter().map(one).collect()
}

pub(super) fn not_identifiable(found: &NotIdentifiableCombination) -> NotIdentifiableAnswer {
    let (coefficients, components) = found.components.iter().copied().unzip();
    NotIdentifiableAnswer {
        coefficients,
        components,
        standard_deviation: found.deviation,
        identifiable_by: found.identifiable_by.clone(),
    }
}
