//! Bode diagrams of a frequency response: points of the machine on the curves of its models.

use super::{MachineResponse, MachineResponses};
use crate::figure::{Figure, FrequencySeries, MeasuredResponse, Words};
use crate::quantity::MotionKind;

/// A diagram for each loop.
pub(crate) fn pictures(found: &MachineResponses) -> Vec<Figure> {
    let motion = found.units.motion;
    let mut figures = vec![diagram(
        &found.open_loop,
        motion,
        (
            "frequency-response-open-loop",
            "Open loop: machine and linear plant",
            motion.either("F_e/U_C", "T_e/U_C"),
            motion.either("N/V", "N.m/V"),
            "linear plant P",
        ),
    )];
    if let Ok(closed) = &found.closed_loop {
        figures.push(diagram(
            closed,
            motion,
            (
                "frequency-response-closed-loop",
                "Closed loop: machine and linear plant",
                motion.either("F_e/F_ref", "T_e/T_ref"),
                motion.either("N/N", "N.m/(N.m)"),
                "loop of the linear plant",
            ),
        ));
    }
    figures
}

fn diagram(
    response: &MachineResponse,
    motion: MotionKind,
    (name, title, quantity, unit, model): (&str, &str, &str, &str, &str),
) -> Figure {
    let caption = format!(
        "Each point is the fundamental of the {}, over whole periods of a sine that the nonlinear model has settled to; \
         below, what it differs by from the linear plant, and its harmonics over the fundamental.",
        motion.words().force
    );
    let curve = |name: &str, response: &[num_complex::Complex64], frequencies: &[f64]| FrequencySeries {
        name: name.to_string(),
        frequencies_rad_per_s: frequencies.to_vec(),
        response: response.to_vec(),
    };
    let frequencies = &response.curve_rad_per_s;
    let mut models = vec![curve(model, &response.linear_plant, frequencies)];
    if !response.linearised_machine.is_empty() {
        models.push(curve("machine, linearised", &response.linearised_machine, frequencies));
    }
    let seen = || response.points.iter().filter(|point| point.machine.is_finite());
    let chart = MeasuredResponse {
        quantity: quantity.to_string(),
        unit: unit.to_string(),
        models,
        measured: FrequencySeries {
            name: "machine, sines".to_string(),
            frequencies_rad_per_s: seen().map(|point| point.frequency_rad_per_s).collect(),
            response: seen().map(|point| point.machine).collect(),
        },
        model: seen().map(|point| point.linear_plant).collect(),
        distortion_percent: seen().map(|point| 100.0 * point.distortion).collect(),
    };
    chart.draw(&Words::new(name, title, caption))
}
