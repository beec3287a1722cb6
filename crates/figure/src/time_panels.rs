//! Quantities of one run, or of several, over time: panels below each other on one time axis.

use super::axis::Axis;
use super::colour::{Role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, Plot};
use super::scene::{Dash, Stroke};
use super::step_response::{TimeEvent, TimeSeries};
use super::{Figure, Words};
use phea_quantity::DisplayUnit;

/// A panel; the series with the same place in each panel have the same colour.
#[derive(Clone, Debug, PartialEq)]
pub struct TimePanel {
    /// What is plotted, such as `Force F_e`.
    pub quantity: String,
    /// Its unit.
    pub unit: DisplayUnit,
    /// Curves.
    pub series: Vec<TimeSeries>,
    /// What is commanded, drawn apart from the others.
    pub reference: Option<TimeSeries>,
    /// What was wished of the curves: lines that they should not cross.
    pub wished: Vec<TimeSeries>,
    /// Least and greatest value that are shown, SI; absent, what holds all curves.
    pub shown: Option<[f64; 2]>,
    /// Height of the frame in view box units.
    pub height: f64,
}

/// What the figure shows.
#[derive(Clone, Debug, PartialEq)]
pub struct TimePanelsInput {
    /// Top to bottom.
    pub panels: Vec<TimePanel>,
    /// What each colour stands for, all panels together.
    pub legend: Vec<String>,
    /// What the reference is called.
    pub reference: String,
    /// Instants, labelled in the tallest panel, the first of several: there is most room beside the
    /// curves.
    pub events: Vec<TimeEvent>,
    /// From and to, s.
    pub span_s: [f64; 2],
}

/// Draws the figure.
pub fn time_panels(words: Words, input: &TimePanelsInput) -> Figure {
    let [start, end] = input.span_s;
    let mut panels: Vec<Panel> = input.panels.iter().map(|panel| drawn(panel, input.span_s)).collect();
    let tallest = input.panels.iter().map(|panel| panel.height).fold(0.0, f64::max);
    let labelled = input.panels.iter().position(|panel| panel.height == tallest);
    for (index, panel) in panels.iter_mut().enumerate() {
        panel.marks.extend(input.events.iter().map(|event| Mark::Reference {
            direction: AxisDirection::X,
            at: event.time_s,
            stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted),
            label: if Some(index) == labelled { event.label.clone() } else { String::new() },
        }));
    }
    let mut legend: Vec<LegendEntry> =
        input.legend.iter().enumerate().map(|(i, text)| LegendEntry::line(text, series_stroke(i))).collect();
    if input.panels.iter().any(|panel| panel.reference.is_some()) {
        legend.push(LegendEntry::line(&input.reference, reference_stroke()));
    }
    if input.panels.iter().any(|panel| !panel.wished.is_empty()) {
        legend.push(LegendEntry::line("wished in time", wished_stroke()));
    }
    let x = Axis::linear("Time (s)", start, end);
    words.with_scene(Plot { x, panels, legend, equal_aspect: false }.draw())
}

fn reference_stroke() -> Stroke {
    Stroke::solid(Role::Muted, 1.6)
}

fn wished_stroke() -> Stroke {
    Stroke::solid(Role::Bad, 1.4).dashed(Dash::LongDash)
}

fn drawn(panel: &TimePanel, span_s: [f64; 2]) -> Panel {
    let points = |series: &TimeSeries| within(series, panel.unit, span_s);
    let curves: Vec<Vec<(f64, f64)>> = panel.series.iter().map(points).collect();
    let reference = panel.reference.as_ref().map(points);
    let wished: Vec<Vec<(f64, f64)>> = panel.wished.iter().map(points).collect();
    let values = curves.iter().chain(&reference).chain(&wished).flatten().map(|point| point.1);
    let title = panel.unit.title(&panel.quantity);
    let y = match panel.shown {
        Some([least, most]) => Axis::linear(title, panel.unit.of(least), panel.unit.of(most)),
        None => Axis::fit_linear(title, values),
    };
    let mut marks: Vec<Mark> = Vec::new();
    marks.extend(reference.map(|points| Mark::Line { points, stroke: reference_stroke() }));
    marks.extend(wished.into_iter().map(|points| Mark::Line { points, stroke: wished_stroke() }));
    let lines = curves.into_iter().enumerate();
    marks.extend(lines.map(|(i, points)| Mark::Line { points, stroke: series_stroke(i) }));
    Panel { y, height: panel.height, marks }
}

/// The part of a curve in a span, in display units.
fn within(series: &TimeSeries, unit: DisplayUnit, [start, end]: [f64; 2]) -> Vec<(f64, f64)> {
    let points = series.times_s.iter().zip(&series.values).map(|(time, value)| (*time, unit.of(*value)));
    points.filter(|(time, value)| *time >= start && *time <= end && value.is_finite()).collect()
}
