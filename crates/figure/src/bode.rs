//! Bode diagram: magnitude in dB and phase in degrees over rad/s, with the difference between
//! models.

use num_complex::Complex64;
use phea_dynamics::portable::{argument, log10, magnitude};

use super::axis::{Axis, extent};
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel};
use super::scene::{Dash, Stroke};
use super::series::series_stroke;
use super::ticks::plain;
use super::{Figure, FrequencyMark, Words};

/// Frequency response of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencySeries {
    /// Name of the model.
    pub name: String,
    /// Frequencies, rad/s, rising.
    pub frequencies_rad_per_s: Vec<f64>,
    /// Response at each frequency, in SI units of the quantity.
    pub response: Vec<Complex64>,
}

impl FrequencySeries {
    /// Series of a response at these frequencies.
    pub fn new(
        name: impl Into<String>,
        frequencies_rad_per_s: &[f64],
        response: impl Fn(f64) -> Complex64,
    ) -> FrequencySeries {
        FrequencySeries {
            name: name.into(),
            frequencies_rad_per_s: frequencies_rad_per_s.to_vec(),
            response: frequencies_rad_per_s.iter().map(|frequency| response(*frequency)).collect(),
        }
    }
}

/// Magnitude and phase of one quantity for several models, and the magnitude of each one's
/// difference from the first if both have equal frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct BodeDiagram {
    /// Quantity, such as `F_e/U_C`.
    pub quantity: String,
    /// Unit, such as `N/V`, which is 0 dB.
    pub unit: String,
    /// Models, the reference first.
    pub series: Vec<FrequencySeries>,
    /// Frequencies to mark.
    pub marks: Vec<FrequencyMark>,
}

impl BodeDiagram {
    /// Draws the diagram.
    pub fn draw(&self, words: &Words) -> Figure {
        let curves = curves(&self.series, None);
        let title = level_title(&self.quantity, &self.unit);
        let mut panels = vec![
            panel(Axis::fit_decibel(title, all(&curves, |c| &c.decibels)), 190.0, &curves, |c| &c.decibels),
            panel(Axis::fit_angle("Phase (°)", all(&curves, |c| &c.degrees)), 150.0, &curves, |c| {
                &c.degrees
            }),
        ];
        panels.extend(difference_panels(&curves));
        mark_frequencies(&mut panels, &self.marks);
        let legend = LegendEntry::of_series(self.series.iter().map(|series| &series.name));
        words.with_plot(frequency_axis(&self.series), panels, legend)
    }
}

/// Axis that covers the frequencies of all series.
pub(super) fn frequency_axis<'s>(series: impl IntoIterator<Item = &'s FrequencySeries>) -> Axis {
    let frequencies = series.into_iter().flat_map(|one| one.frequencies_rad_per_s.iter().copied());
    Axis::fit_logarithmic("Frequency (rad/s)", frequencies)
}

/// Title of the magnitude of a quantity in dB.
pub(super) fn level_title(quantity: &str, unit: &str) -> String {
    match unit.split_once('/') {
        Some((over, under)) if over == under => format!("|{quantity}| (dB)"),
        _ => format!("|{quantity}| (dB re 1 {unit})"),
    }
}

/// Adds a vertical line at each frequency to every panel, with its label in the first.
pub(super) fn mark_frequencies(panels: &mut [Panel], marks: &[FrequencyMark]) {
    let stroke = Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dashed);
    for (index, panel) in panels.iter_mut().enumerate() {
        for mark in marks {
            let label = match index {
                0 => format!("{} {} rad/s", mark.label, plain(mark.frequency_rad_per_s)),
                _ => String::new(),
            };
            panel.marks.push(Mark::reference(AxisDirection::X, mark.frequency_rad_per_s, stroke, label));
        }
    }
}

pub(super) struct BodeCurve {
    pub(super) index: usize,
    pub(super) frequencies: Vec<f64>,
    pub(super) decibels: Vec<f64>,
    pub(super) degrees: Vec<f64>,
}

/// Magnitude and unwrapped phase of each response; the phase starts within half a turn of `start`,
/// or of the first response.
pub(super) fn curves(series: &[FrequencySeries], start: Option<f64>) -> Vec<BodeCurve> {
    let mut result: Vec<BodeCurve> = Vec::with_capacity(series.len());
    for (index, one) in series.iter().enumerate() {
        let start = start.or(result.first().and_then(|first| first.degrees.first().copied()));
        result.push(BodeCurve {
            index,
            frequencies: one.frequencies_rad_per_s.clone(),
            decibels: decibels(&one.response),
            degrees: unwrapped_degrees(&one.response, start),
        });
    }
    result
}

/// Magnitude in dB.
pub(super) fn decibel(response: Complex64) -> f64 {
    20.0 * log10(magnitude(response))
}

/// Magnitudes in dB.
pub(super) fn decibels(response: &[Complex64]) -> Vec<f64> {
    response.iter().map(|value| decibel(*value)).collect()
}

/// Phase in degrees without jumps of a full turn, its first value nearest to `start` (or in (-180,
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

/// Difference in dB or degrees below which models agree within rounding.
const ROUNDING: f64 = 1e-9;

/// Panels of |difference| in dB and degrees: models that agree to 1e-4 dB and models that differ by
/// 40 dB in one picture; none if all agree within rounding.
fn difference_panels(curves: &[BodeCurve]) -> Vec<Panel> {
    let differences = differences(curves);
    let both = |curve: &BodeCurve| [curve.decibels.as_slice(), &curve.degrees].concat();
    if differences.iter().flat_map(both).all(|difference| difference < ROUNDING) {
        return Vec::new();
    }
    let axis = |title: &str, of: fn(&BodeCurve) -> &Vec<f64>| {
        let (_, largest) = extent(all(&differences, of));
        let floor = largest * 1e-7;
        Axis::fit_logarithmic(title, all(&differences, of).map(|v| v.max(floor).max(ROUNDING)))
    };
    vec![
        panel(axis("|Δ| (dB)", |c| &c.decibels), 105.0, &differences, |c| &c.decibels),
        panel(axis("|Δ| (°)", |c| &c.degrees), 105.0, &differences, |c| &c.degrees),
    ]
}

/// Magnitude of the difference of each later curve from the first, if both have equal frequencies.
fn differences(curves: &[BodeCurve]) -> Vec<BodeCurve> {
    let Some((first, others)) = curves.split_first() else { return Vec::new() };
    let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
    others
        .iter()
        .filter(|other| other.frequencies == first.frequencies)
        .map(|other| BodeCurve {
            index: other.index,
            frequencies: other.frequencies.clone(),
            decibels: minus(&other.decibels, &first.decibels),
            degrees: minus(&other.degrees, &first.degrees),
        })
        .collect()
}

/// Values of one kind of all curves.
pub(super) fn all<'a>(
    curves: &'a [BodeCurve],
    of: impl Fn(&BodeCurve) -> &Vec<f64> + 'a,
) -> impl Iterator<Item = f64> + 'a {
    curves.iter().flat_map(move |curve| of(curve).clone())
}

/// Panel of the curves.
pub(super) fn panel(
    y: Axis,
    height: f64,
    curves: &[BodeCurve],
    of: impl Fn(&BodeCurve) -> &Vec<f64>,
) -> Panel {
    let marks = curves
        .iter()
        .map(|curve| Mark::Line {
            points: curve.frequencies.iter().copied().zip(of(curve).iter().copied()).collect(),
            stroke: series_stroke(curve.index),
        })
        .collect();
    Panel::new(y, height, marks)
}
