//! What many runs do over time: bands that hold a share of them, their median, and single ones.

use super::axis::Axis;
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, Plot};
use super::scene::{Dash, Fill, Stroke};
use super::step_response::{TimeEvent, TimeSeries};
use super::{Figure, Words};
use phea_quantity::DisplayUnit;

/// A band between two curves of the same times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimeBands {
    /// What it holds.
    pub name: String,
    /// Its lower edge.
    pub lower: TimeSeries,
    /// Its upper edge.
    pub upper: TimeSeries,
}

/// What the figure shows.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeBandsInput {
    /// What is plotted, such as `Force F_e`.
    pub quantity: String,
    /// Its unit.
    pub unit: DisplayUnit,
    /// Bands, the widest first.
    pub bands: Vec<TimeBands>,
    /// The curve in the middle.
    pub middle: TimeSeries,
    /// A run apart from the others.
    pub single: Option<TimeSeries>,
    /// What is commanded, where a force is.
    pub reference: Option<TimeSeries>,
    /// Instants to mark.
    pub events: Vec<TimeEvent>,
    /// From and to, s.
    pub span_s: [f64; 2],
}

/// Draws the figure.
pub fn time_bands(words: Words, input: &TimeBandsInput) -> Figure {
    let [start, end] = input.span_s;
    let lines: Vec<(&TimeSeries, Stroke)> = input
        .reference
        .iter()
        .map(|series| (series, reference_stroke()))
        .chain(input.single.iter().map(|series| (series, single_stroke())))
        .chain([(&input.middle, middle_stroke())])
        .collect();
    let points = |series: &TimeSeries| within(series, input.unit, input.span_s);
    let mut marks: Vec<Mark> = input.bands.iter().enumerate().map(|(i, band)| area(i, band, input)).collect();
    marks.extend(lines.iter().map(|(series, stroke)| Mark::Line { points: points(series), stroke: *stroke }));
    marks.extend(input.events.iter().map(|event| Mark::Reference {
        direction: AxisDirection::X,
        at: event.time_s,
        stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted),
        label: event.label.clone(),
    }));
    let edges = input.bands.iter().flat_map(|band| [&band.lower, &band.upper]);
    let all = edges.chain(lines.iter().map(|(series, _)| *series));
    let values: Vec<f64> = all.flat_map(|series| points(series).into_iter().map(|point| point.1)).collect();
    let y = Axis::fit_linear(input.unit.title(&input.quantity), values.iter().copied());
    let mut legend: Vec<LegendEntry> =
        input.bands.iter().enumerate().map(|(i, band)| LegendEntry::area(&band.name, fill(i))).collect();
    legend.extend(lines.iter().rev().map(|(series, stroke)| LegendEntry::line(&series.name, *stroke)));
    let panels = vec![Panel { y, height: 260.0, marks }];
    words.with_scene(
        Plot { x: Axis::linear("Time (s)", start, end), panels, legend, equal_aspect: false }.draw(),
    )
}

fn area(index: usize, band: &TimeBands, input: &TimeBandsInput) -> Mark {
    let edge = |series: &TimeSeries| within(series, input.unit, input.span_s);
    let corners = edge(&band.upper).into_iter().chain(edge(&band.lower).into_iter().rev()).collect();
    Mark::Area { corners, fill: fill(index) }
}

fn fill(index: usize) -> Fill {
    Fill { role: Role::Good, opacity: if index == 0 { 0.18 } else { 0.34 } }
}

fn middle_stroke() -> Stroke {
    Stroke::solid(Role::Good, 1.8)
}

fn single_stroke() -> Stroke {
    Stroke::solid(Role::Bad, 1.4).dashed(Dash::LongDash)
}

fn reference_stroke() -> Stroke {
    Stroke::solid(Role::Muted, 1.4)
}

/// The part of a curve in a span, in display units.
fn within(series: &TimeSeries, unit: DisplayUnit, [start, end]: [f64; 2]) -> Vec<(f64, f64)> {
    let points = series.times_s.iter().zip(&series.values).map(|(time, value)| (*time, unit.of(*value)));
    points.filter(|(time, value)| *time >= start && *time <= end && value.is_finite()).collect()
}
