//! A measured frequency response on the curves of its models: magnitude, phase, difference from the
//! first model, distortion.

use num_complex::Complex64;
use phea_dynamics::portable::{argument, log10, magnitude};

use super::axis::Axis;
use super::bode::{FrequencySeries, unwrapped_degrees};
use super::colour::{Role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel, Plot};
use super::scene::{Dash, Stroke};
use super::{Figure, Words};

/// A response with its name.
pub type ResponseCurve = FrequencySeries;

/// What the figure shows.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredResponseInput {
    /// The quantity, such as `F_e/U_C`.
    pub quantity: String,
    /// Its unit, such as `N/V`: 0 dB is one of it.
    pub unit: String,
    /// Models, the first of which the measured points are compared with.
    pub curves: Vec<ResponseCurve>,
    /// Measured points.
    pub measured: ResponseCurve,
    /// The first model at the measured points.
    pub model: Vec<Complex64>,
    /// Harmonics over the fundamental at each.
    pub distortion_percent: Vec<f64>,
}

const POINTS: MarkerStyle = MarkerStyle { marker: Marker::Ring, role: Role::Text, radius: 3.6 };

/// Draws the figure.
pub fn measured_response(words: Words, input: &MeasuredResponseInput) -> Figure {
    let frequencies = &input.measured.frequencies_rad_per_s;
    let all = input.curves.iter().chain([&input.measured]);
    let x = Axis::fit_logarithmic(
        "Frequency (rad/s)",
        all.flat_map(|curve| curve.frequencies_rad_per_s.iter().copied()),
    );
    let decibels = |response: &[Complex64]| -> Vec<f64> {
        response.iter().map(|value| 20.0 * log10(magnitude(*value))).collect()
    };
    let quotients: Vec<Complex64> =
        input.measured.response.iter().zip(&input.model).map(|(machine, model)| machine / model).collect();
    let differences = decibels(&quotients);
    let angles: Vec<f64> = quotients.iter().map(|quotient| argument(*quotient).to_degrees()).collect();
    let phases = phases(&input.curves);
    let measured_phase = near_first(input, &phases, &angles);
    let (magnitudes, measured) = (
        input.curves.iter().map(|curve| decibels(&curve.response)).collect::<Vec<_>>(),
        decibels(&input.measured.response),
    );
    let title = format!("|{}| (dB re 1 {})", input.quantity, input.unit);
    let values = magnitudes.iter().flatten().chain(&measured).copied();
    let of_phase = phases.iter().flatten().chain(&measured_phase).copied();
    let mut panels = vec![
        panel(Axis::fit_decibel(title, values), 170.0, &input.curves, &magnitudes),
        panel(Axis::fit_angle("Phase (°)", of_phase), 130.0, &input.curves, &phases),
        panel(Axis::fit_linear("Δ (dB)", differences.iter().copied().chain([0.0])), 90.0, &[], &[]),
        panel(Axis::fit_linear("Δ (°)", angles.iter().copied().chain([0.0])), 90.0, &[], &[]),
        panel(
            Axis::fit_linear("Harmonics (%)", input.distortion_percent.iter().copied().chain([0.0])),
            90.0,
            &[],
            &[],
        ),
    ];
    for panel in panels.iter_mut().skip(2) {
        let stroke = Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted);
        panel.marks.push(Mark::Reference {
            direction: AxisDirection::Y,
            at: 0.0,
            stroke,
            label: String::new(),
        });
    }
    let points = [&measured, &measured_phase, &differences, &angles, &input.distortion_percent];
    for (panel, values) in panels.iter_mut().zip(points) {
        let at = frequencies.iter().zip(values).map(|(frequency, value)| (*frequency, *value, String::new()));
        panel.marks.push(Mark::Markers { points: at.collect(), style: POINTS });
    }
    let mut legend: Vec<LegendEntry> = input
        .curves
        .iter()
        .enumerate()
        .map(|(index, curve)| LegendEntry::line(curve.name.clone(), series_stroke(index)))
        .collect();
    legend.push(LegendEntry::marker(input.measured.name.clone(), POINTS));
    words.with_scene(Plot { x, panels, legend, equal_aspect: false }.draw())
}

/// Without jumps of a turn, each beginning near the first.
fn phases(curves: &[ResponseCurve]) -> Vec<Vec<f64>> {
    let mut phases: Vec<Vec<f64>> = Vec::new();
    for curve in curves {
        let start = phases.first().and_then(|first| first.first().copied());
        phases.push(unwrapped_degrees(&curve.response, start));
    }
    phases
}

/// The phase of each measured point: that of the first model's curve at its frequency, on the same
/// turn, and what it differs by.
fn near_first(input: &MeasuredResponseInput, phases: &[Vec<f64>], angles: &[f64]) -> Vec<f64> {
    let Some((curve, phases)) = input.curves.first().zip(phases.first()) else { return angles.to_vec() };
    let at = input.measured.frequencies_rad_per_s.iter().zip(&input.model).zip(angles);
    at.map(|((frequency, model), angle)| {
        let next = curve.frequencies_rad_per_s.partition_point(|known| known < frequency);
        let near = phases.get(next).or(phases.last()).copied().unwrap_or(0.0);
        let principal = argument(*model).to_degrees();
        principal + 360.0 * ((near - principal) / 360.0).round() + angle
    })
    .collect()
}

fn panel(y: Axis, height: f64, curves: &[ResponseCurve], values: &[Vec<f64>]) -> Panel {
    let lines = curves.iter().zip(values).enumerate().map(|(index, (curve, values))| Mark::Line {
        points: curve.frequencies_rad_per_s.iter().copied().zip(values.iter().copied()).collect(),
        stroke: series_stroke(index),
    });
    Panel { y, height, marks: lines.collect() }
}
