//! Measured and computed curves over one common quantity: panels below each other.

use super::axis::Axis;
use super::colour::{Role, series_role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel, Plot};
use super::scene::{Dash, Stroke};
use super::{Figure, Words};

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveStyle {
    /// A line, in the colour and dash of a series.
    Line(usize),
    /// A small dot for each point, in the colour of a series.
    Dots(usize),
}

/// A curve in the units of its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// (x, y).
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: CurveStyle,
}

/// One pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePanel {
    /// Title of the upright axis, with its unit.
    pub title: String,
    /// Back to front.
    pub curves: Vec<Curve>,
    /// Values of x that are marked, with a word in this panel.
    pub marked: Vec<(f64, String)>,
    /// Whether zero is marked, as for residuals.
    pub zero_line: bool,
    /// Height of the frame in view box units.
    pub height: f64,
}

/// What the figure shows.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvesInput {
    /// Title of the lying axis, with its unit.
    pub x_title: String,
    /// Its ends; points beyond are left out.
    pub x_range: [f64; 2],
    /// Top to bottom.
    pub panels: Vec<CurvePanel>,
    /// What each style stands for.
    pub legend: Vec<(String, CurveStyle)>,
}

/// Radius of a dot.
const DOT: f64 = 1.5;

/// Draws the figure.
pub fn curves(words: Words, input: &CurvesInput) -> Figure {
    let [least, most] = input.x_range;
    over(words, input, Axis::linear(&input.x_title, least, most))
}

/// Draws the figure over a logarithmic axis.
pub fn curves_over_decades(words: Words, input: &CurvesInput) -> Figure {
    over(words, input, Axis::fit_logarithmic(&input.x_title, input.x_range))
}

fn over(words: Words, input: &CurvesInput, x: Axis) -> Figure {
    let panels = input.panels.iter().map(|panel| drawn(panel, input.x_range)).collect();
    let entry = |(text, style): &(String, CurveStyle)| match style {
        CurveStyle::Line(series) => LegendEntry::line(text, series_stroke(*series)),
        CurveStyle::Dots(series) => {
            let style = MarkerStyle { marker: Marker::Circle, role: series_role(*series), radius: 2.5 };
            LegendEntry::marker(text, style)
        }
    };
    let legend = input.legend.iter().map(entry).collect();
    words.with_scene(Plot { x, panels, legend, equal_aspect: false }.draw())
}

fn drawn(panel: &CurvePanel, [least, most]: [f64; 2]) -> Panel {
    let shown = |curve: &Curve| -> Vec<(f64, f64)> {
        let all = curve.points.iter().copied();
        all.filter(|(x, y)| (least..=most).contains(x) && y.is_finite()).collect()
    };
    let curves: Vec<(Vec<(f64, f64)>, CurveStyle)> =
        panel.curves.iter().map(|curve| (shown(curve), curve.style)).collect();
    let values = curves.iter().flat_map(|(points, _)| points.iter().map(|(_, y)| *y));
    let y = Axis::fit_linear(&panel.title, values);
    let mut marks = Vec::new();
    let thin = Stroke::solid(Role::Muted, 1.2);
    if panel.zero_line {
        let zero =
            Mark::Reference { direction: AxisDirection::Y, at: 0.0, stroke: thin, label: String::new() };
        marks.push(zero);
    }
    marks.extend(curves.into_iter().map(|(points, style)| match style {
        CurveStyle::Line(series) => Mark::Line { points, stroke: series_stroke(series) },
        CurveStyle::Dots(series) => Mark::Dots { points, role: series_role(series), radius: DOT },
    }));
    marks.extend(panel.marked.iter().map(|(at, label)| Mark::Reference {
        direction: AxisDirection::X,
        at: *at,
        stroke: thin.dashed(Dash::Dotted),
        label: label.clone(),
    }));
    Panel { y, height: panel.height, marks }
}
