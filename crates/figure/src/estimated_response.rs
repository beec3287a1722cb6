//! A frequency response estimated from records: magnitude and phase with the band that holds the
//! truth with 95 % confidence, and the coherence.

use num_complex::Complex64;
use phea_dynamics::portable::{asin, log10, magnitude};

use super::axis::Axis;
use super::bode::{FrequencySeries, unwrapped_degrees};
use super::colour::{Role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel, Plot};
use super::scene::{Dash, Fill, Stroke};
use super::{Figure, Words};

/// What the figure shows.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimatedResponseInput {
    /// The quantity, such as `force/command`.
    pub quantity: String,
    /// Its unit, such as `N/V`: 0 dB is one of it.
    pub unit: String,
    /// The response at each frequency.
    pub estimate: FrequencySeries,
    /// Radius of the disc of 95 % around each.
    pub radii: Vec<f64>,
    /// Squared coherence at each.
    pub coherence: Vec<f64>,
    /// Squared coherence that a point must have.
    pub least_coherence: f64,
    /// Models to compare with.
    pub models: Vec<FrequencySeries>,
}

const POINTS: MarkerStyle = MarkerStyle { marker: Marker::Circle, role: Role::Text, radius: 1.8 };

/// Least share of the magnitude that is left of it at the lower edge of a band.
const LEAST: f64 = 0.03;

/// Draws the figure.
pub fn estimated_response(words: Words, input: &EstimatedResponseInput) -> Figure {
    let frequencies = &input.estimate.frequencies_rad_per_s;
    let all = input.models.iter().chain([&input.estimate]);
    let x = Axis::fit_logarithmic(
        "Frequency (rad/s)",
        all.flat_map(|series| series.frequencies_rad_per_s.iter().copied()),
    );
    let level = |value: f64| 20.0 * log10(value);
    let sizes: Vec<f64> = input.estimate.response.iter().map(|value| magnitude(*value)).collect();
    let decibels: Vec<f64> = sizes.iter().map(|size| level(*size)).collect();
    let degrees = unwrapped_degrees(&input.estimate.response, None);
    let shares = || sizes.iter().zip(&input.radii).map(|(size, radius)| radius / size);
    let band = |values: &[f64], of: &dyn Fn(f64) -> [f64; 2]| -> Vec<[f64; 2]> {
        values.iter().zip(shares()).map(|(value, share)| of(share).map(|edge| value + edge)).collect()
    };
    let in_decibels = band(&decibels, &|share| [level((1.0 - share).max(LEAST)), level(1.0 + share)]);
    let in_degrees = band(&degrees, &|share| {
        let edge = asin(share.min(1.0)).to_degrees();
        [-edge, edge]
    });
    let curves: Vec<[Vec<f64>; 2]> = input.models.iter().map(|model| curve(model, degrees.first())).collect();
    let title = format!("|{}| (dB re 1 {})", input.quantity, input.unit);
    let of = |index: usize| curves.iter().filter_map(move |curve| curve.get(index)).flatten().copied();
    let edges = |band: &[[f64; 2]]| band.iter().flatten().copied().collect::<Vec<f64>>();
    let mut panels = vec![
        Panel {
            y: Axis::fit_decibel(title, edges(&in_decibels).into_iter().chain(of(0))),
            height: 190.0,
            marks: vec![],
        },
        Panel {
            y: Axis::fit_angle("Phase (°)", edges(&in_degrees).into_iter().chain(of(1))),
            height: 150.0,
            marks: vec![],
        },
        Panel { y: Axis::linear("Coherence γ²", 0.0, 1.0), height: 90.0, marks: vec![] },
    ];
    let fill = Fill { role: Role::Muted, opacity: 0.3 };
    for (panel, band) in panels.iter_mut().zip([&in_decibels, &in_degrees]) {
        let edge = |index: usize| {
            frequencies.iter().copied().zip(band.iter().filter_map(move |edges| edges.get(index).copied()))
        };
        let back: Vec<(f64, f64)> = edge(1).collect();
        panel.marks.push(Mark::Area { corners: edge(0).chain(back.into_iter().rev()).collect(), fill });
    }
    for (index, (model, curve)) in input.models.iter().zip(&curves).enumerate() {
        for (panel, values) in panels.iter_mut().zip(curve) {
            let points = model.frequencies_rad_per_s.iter().copied().zip(values.iter().copied()).collect();
            panel.marks.push(Mark::Line { points, stroke: series_stroke(index) });
        }
    }
    for (panel, values) in panels.iter_mut().zip([&decibels, &degrees, &input.coherence]) {
        let points = frequencies.iter().zip(values).map(|(at, value)| (*at, *value, String::new())).collect();
        panel.marks.push(Mark::Markers { points, style: POINTS });
    }
    panels.last_mut().into_iter().for_each(|panel| panel.marks.push(limit(input.least_coherence)));
    let legend = legend(input, fill);
    words.with_scene(Plot { x, panels, legend, equal_aspect: false }.draw())
}

/// The line of the least squared coherence.
fn limit(at: f64) -> Mark {
    let stroke = Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted);
    Mark::Reference { direction: AxisDirection::Y, at, stroke, label: String::new() }
}

/// The estimate, its band, and each model.
fn legend(input: &EstimatedResponseInput, fill: Fill) -> Vec<LegendEntry> {
    let models = input.models.iter().enumerate();
    let models = models.map(|(index, model)| LegendEntry::line(model.name.clone(), series_stroke(index)));
    let estimate = LegendEntry::marker(input.estimate.name.clone(), POINTS);
    [estimate, LegendEntry::area("95 % confidence", fill)].into_iter().chain(models).collect()
}

/// Decibels and degrees, the phase on the turn of the estimate.
fn curve(model: &FrequencySeries, first: Option<&f64>) -> [Vec<f64>; 2] {
    let decibels = |value: &Complex64| 20.0 * log10(magnitude(*value));
    [model.response.iter().map(decibels).collect(), unwrapped_degrees(&model.response, first.copied())]
}
