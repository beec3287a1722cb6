//! Combinations of coefficients that the data do not determine, and tests that would.

use phea_dynamics::least_squares::{Direction, Uncertainty};
use phea_dynamics::order::sort_by_number;
use phea_hydraulics::servovalve::{STATIC_COEFFICIENTS, StaticCoefficients, Supply, TestInput, TestedValve};

use super::COEFFICIENT_NAMES;
use super::recording::{Recording, SignalKind, usual_drop};
use super::variables::has;
use crate::bench::StaticTest;

/// Standard deviation in the logarithm of a coefficient beyond which it is not determined: a factor
/// of e^0.98 = 2.7 in either direction at 95 %.
const NOT_IDENTIFIABLE: f64 = 0.5;

/// Standard deviation below which a test determines a combination.
const IDENTIFIABLE: f64 = 0.1;

/// Component of a direction below which a coefficient does not count.
const PART: f64 = 0.2;

/// A combination of coefficients that the data do not determine.
#[derive(Clone, Debug, PartialEq)]
pub struct NotIdentifiableCombination {
    /// Coefficients with their components of the direction, as factors: of length one, the greatest
    /// first.
    pub components: Vec<(&'static str, f64)>,
    /// Standard deviation along it, in the logarithm; infinite if no recorded signal depends on it.
    pub deviation: f64,
    /// Tests that would determine it, at 30 % of the command with errors of 1 % of each signal's
    /// range.
    pub identifiable_by: Vec<StaticTest>,
}

/// Combinations that are not determined, the least known first.
pub(super) fn combinations(
    uncertainty: &Uncertainty,
    coefficients: &StaticCoefficients,
    slopes: &[f64; STATIC_COEFFICIENTS],
    (recordings, tested): (&[Recording], &TestedValve),
) -> Vec<NotIdentifiableCombination> {
    let varied = |direction: &&Direction| {
        let components = direction.fractions.iter().enumerate();
        components.filter(|(index, _)| has(tested.terms, *index)).any(|(_, one)| one.abs() > PART)
    };
    let unknown =
        uncertainty.directions.iter().rev().filter(|direction| direction.deviation > NOT_IDENTIFIABLE);
    let unknown = unknown.filter(varied);
    let tests =
        StaticTest::ALL.map(|test| (test, sensitivities(test, coefficients, slopes, (recordings, tested))));
    unknown
        .map(|direction| {
            let parts = COEFFICIENT_NAMES.iter().zip(&direction.fractions);
            let mut components: Vec<(&'static str, f64)> = parts
                .filter(|(_, component)| component.abs() > PART)
                .map(|((name, _), component)| (*name, *component))
                .collect();
            sort_by_number(&mut components, |(_, component)| -component.abs());
            let determines = |rows: &[[f64; STATIC_COEFFICIENTS]]| {
                let along = |row: &[f64; STATIC_COEFFICIENTS]| -> f64 {
                    row.iter().zip(&direction.fractions).map(|(slope, component)| slope * component).sum()
                };
                rows.iter().map(|row| along(row) * along(row)).sum::<f64>()
                    > 1.0 / (IDENTIFIABLE * IDENTIFIABLE)
            };
            let identifiable_by =
                tests.iter().filter(|(_, rows)| determines(rows)).map(|(test, _)| *test).collect();
            NotIdentifiableCombination { components, deviation: direction.deviation, identifiable_by }
        })
        .collect()
}

/// Derivatives of the readings of a test, divided by a hundredth of the range of each signal.
fn sensitivities(
    test: StaticTest,
    coefficients: &StaticCoefficients,
    slopes: &[f64; STATIC_COEFFICIENTS],
    (recordings, tested): (&[Recording], &TestedValve),
) -> Vec<[f64; STATIC_COEFFICIENTS]> {
    const ROWS: i32 = 100;
    let amplitude = if test == StaticTest::PressureGain { 0.05 } else { 0.3 };
    let supply = Supply { pressure: usual_drop(recordings), tank_pressure: 0.0 };
    let inputs: Vec<TestInput> = (-ROWS..=ROWS)
        .chain((-ROWS..ROWS).rev())
        .map(|step| f64::from(step) / f64::from(ROWS))
        // finer around null
        .map(|position| amplitude * tested.nominal_voltage * position * position.abs())
        .map(|command| TestInput::new(command, supply, 0.0))
        .collect();
    let outputs = tested.sensitive_outputs(coefficients, test.circuit(), &inputs);
    let kinds: &[SignalKind] = match test {
        StaticTest::Leakage => &[SignalKind::PressureA, SignalKind::PressureB, SignalKind::LeakFlow],
        StaticTest::PressureGain => &[SignalKind::PressureA, SignalKind::PressureB],
        StaticTest::Metering => &[SignalKind::MeanPressure, SignalKind::PortFlow],
    };
    let mut rows = Vec::new();
    for kind in kinds {
        let shown: Vec<_> =
            outputs.iter().map(|output| output.combined(kind.weights(&output.values()))).collect();
        let least = shown.iter().map(|one| one.value()).fold(f64::INFINITY, f64::min);
        let most = shown.iter().map(|one| one.value()).fold(f64::NEG_INFINITY, f64::max);
        let scale = 0.01 * (most - least);
        for one in shown {
            let mut row = *one.gradient();
            for (slope, own) in row.iter_mut().zip(slopes) {
                *slope *= own / scale;
            }
            rows.push(row);
        }
    }
    rows
}
