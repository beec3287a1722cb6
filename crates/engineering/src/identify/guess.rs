//! Initial estimates, from readings of the curves by hand.

use phea_hydraulics::servovalve::{Edges, OpeningShape, StaticCoefficients, TestedValve};

use super::recording::Recording;
use super::simple::{SimpleCalculations, largest_command};

/// Starting point of all coefficients: the calculations, or usual values in their absence. A
/// coefficient that may be zero starts at a value that would matter.
pub(super) fn first_guess(
    recordings: &[Recording],
    tested: &TestedValve,
    simple: &SimpleCalculations,
) -> StaticCoefficients {
    let [forward, backward] = simple.flow_coefficients.map(|one| one.map(|one| one.value));
    let leak = simple.leakage_coefficient().map(|one| one.value);
    // leakage at null is about a hundredth of full flow
    let usual = forward.or(backward).or(leak.map(|leak| 120.0 * leak)).unwrap_or(3e-7);
    let [forward, backward] = [forward.unwrap_or(usual), backward.unwrap_or(usual)];
    let mean = f64::midpoint(forward, backward);
    let leak = leak.unwrap_or(mean / 120.0).max(mean / 2000.0);
    let null_leakage = leak * (2.0 * tested.tare_reference_drop).sqrt();
    let largest = largest_command(recordings);
    StaticCoefficients {
        flow_coefficients: Edges::from_array([forward, backward, backward, forward]),
        leakage_coefficients: Edges::equal(leak),
        leakage_shapes: Edges::equal(simple.leakage_shape.unwrap_or(100.0)),
        opening: OpeningShape::default(),
        tare_flow: simple
            .tare_flow
            .map(|one| one.value)
            .unwrap_or(0.8 * null_leakage)
            .max(0.1 * null_leakage),
        null_bias: simple.null_bias().map_or(0.0, |one| one.value),
        hysteresis_width: simple
            .hysteresis()
            .map_or(0.0, |one| one.value)
            .max(0.002 * tested.nominal_voltage)
            .min(largest / 2.0),
    }
}
