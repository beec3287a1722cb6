//! Bode diagram: magnitude in dB and phase in degrees over rad/s, with the difference between
//! models on request.

use num_complex::Complex64;
use phea_dynamics::portable::{argument, log10, magnitude};

use super::axis::{Axis, extent};
use super::colour::{Role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, Plot};
use super::scene::{Dash, Stroke};
use super::ticks::plain;
use super::{Figure, FrequencyMark, Words};

/// A frequency response.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencySeries {
    /// Name of the model.
    pub name: String,
    /// Frequencies, rad/s, rising.
    pub frequencies_rad_per_s: Vec<f64>,
    /// Response at each, in SI units of the quantity.
    pub response: Vec<Complex64>,
}

/// What a Bode diagram shows.
#[derive(Clone, Debug, PartialEq)]
pub struct BodeInput {
    /// The quantity, such as `F_e/U_C`.
    pub quantity: String,
    /// Its unit, such as `N/V`: 0 dB is one of it.
    pub unit: String,
    /// Models, the reference first.
    pub series: Vec<FrequencySeries>,
    /// Adds panels with the size of each model's difference from the first, on a logarithmic axis
    /// (same frequencies only).
    pub with_difference: bool,
    /// Frequencies to mark.
    pub marks: Vec<FrequencyMark>,
}

/// Draws the diagram.
pub fn bode(words: Words, input: &BodeInput) -> Figure {
    let curves = curves(&input.series);
    let frequencies = input.series.iter().flat_map(|s| s.frequencies_rad_per_s.iter().copied());
    let x = Axis::fit_logarithmic("Frequency (rad/s)", frequencies);
    let magnitude_title = format!("|{}| (dB re 1 {})", input.quantity, input.unit);
    let mut panels = vec![
        panel(Axis::fit_decibel(magnitude_title, all(&curves, |c| &c.decibels)), 190.0, &curves, |c| {
            &c.decibels
        }),
        panel(Axis::fit_angle("Phase (°)", all(&curves, |c| &c.degrees)), 150.0, &curves, |c| &c.degrees),
    ];
    if input.with_difference {
        panels.extend(difference_panels(&curves));
    }
    mark_frequencies(&mut panels, &input.marks);
    let legend = curves
        .iter()
        .map(|curve| LegendEntry::line(curve.name.clone(), series_stroke(curve.index)))
        .collect();
    let plot = Plot { x, panels, legend, equal_aspect: false };
    words.with_scene(plot.draw())
}

/// Adds an upright line at each frequency to every panel, its label to the first.
pub(super) fn mark_frequencies(panels: &mut [Panel], marks: &[FrequencyMark]) {
    for (index, panel) in panels.iter_mut().enumerate() {
        for mark in marks {
            let label = match index {
                0 => format!("{} {} rad/s", mark.label, plain(mark.frequency_rad_per_s)),
                _ => String::new(),
            };
            panel.marks.push(Mark::Reference {
                direction: AxisDirection::X,
                at: mark.frequency_rad_per_s,
                stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dashed),
                label,
            });
        }
    }
}

pub(super) struct BodeCurve {
    pub(super) index: usize,
    pub(super) name: String,
    pub(super) frequencies: Vec<f64>,
    pub(super) decibels: Vec<f64>,
    pub(super) degrees: Vec<f64>,
}

/// Magnitude and unwrapped phase of each response; a later one starts within half a turn of the
/// first.
fn curves(series: &[FrequencySeries]) -> Vec<BodeCurve> {
    let mut result: Vec<BodeCurve> = Vec::with_capacity(series.len());
    for (index, one) in series.iter().enumerate() {
        let start = result.first().and_then(|first| first.degrees.first().copied());
        result.push(BodeCurve {
            index,
            name: one.name.clone(),
            frequencies: one.frequencies_rad_per_s.clone(),
            decibels: one.response.iter().map(|z| 20.0 * log10(magnitude(*z))).collect(),
            degrees: unwrapped_degrees(&one.response, start),
        });
    }
    result
}

/// Phase in degrees without jumps of a turn, its first value nearest to `start` (or in (-180,
/// 180]).
pub(crate) fn unwrapped_degrees(response: &[Complex64], start: Option<f64>) -> Vec<f64> {
    let mut previous = start.filter(|v| v.is_finite());
    response
        .iter()
        .map(|z| {
            let principal = argument(*z).to_degrees();
            let value = match previous {
                Some(before) => principal + 360.0 * ((before - principal) / 360.0).round(),
                None => principal,
            };
            if value.is_finite() {
                previous = Some(value);
            }
            value
        })
        .collect()
}

/// Panels of |difference| in dB and degrees: models that agree to 1e-4 dB and models that part by
/// 40 dB in one picture.
fn difference_panels(curves: &[BodeCurve]) -> Vec<Panel> {
    let differences = differences(curves);
    if differences.is_empty() {
        return Vec::new();
    }
    let axis = |title: &str, of: fn(&BodeCurve) -> &Vec<f64>| {
        let (_, largest) = extent(all(&differences, of));
        let floor = largest * 1e-7;
        Axis::fit_logarithmic(title, all(&differences, of).map(|v| v.max(floor).max(1e-9)))
    };
    vec![
        panel(axis("|Δ| (dB)", |c| &c.decibels), 105.0, &differences, |c| &c.decibels),
        panel(axis("|Δ| (°)", |c| &c.degrees), 105.0, &differences, |c| &c.degrees),
    ]
}

/// Each later curve minus the first, its size, where both have the same frequencies.
fn differences(curves: &[BodeCurve]) -> Vec<BodeCurve> {
    let Some((first, others)) = curves.split_first() else { return Vec::new() };
    let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
    others
        .iter()
        .filter(|other| other.frequencies == first.frequencies)
        .map(|other| BodeCurve {
            index: other.index,
            name: other.name.clone(),
            frequencies: other.frequencies.clone(),
            decibels: minus(&other.decibels, &first.decibels),
            degrees: minus(&other.degrees, &first.degrees),
        })
        .collect()
}

fn all<'a>(
    curves: &'a [BodeCurve],
    of: impl Fn(&BodeCurve) -> &Vec<f64> + 'a,
) -> impl Iterator<Item = f64> + 'a {
    curves.iter().flat_map(move |curve| of(curve).clone())
}

fn panel(y: Axis, height: f64, curves: &[BodeCurve], of: impl Fn(&BodeCurve) -> &Vec<f64>) -> Panel {
    let marks = curves
        .iter()
        .map(|curve| Mark::Line {
            points: curve.frequencies.iter().copied().zip(of(curve).iter().copied()).collect(),
            stroke: series_stroke(curve.index),
        })
        .collect();
    Panel { y, height, marks }
}
