//! Distribution of many runs over time: bands that contain a fraction of them, their median, and
//! single runs.

use super::axis::Axis;
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel};
use super::scene::{Dash, Fill, Stroke};
use super::{Figure, Words};
use phea_quantity::DisplayUnit;

/// Samples over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimeSeries {
    /// Name.
    pub name: String,
    /// Times, s, rising.
    pub times_s: Vec<f64>,
    /// Values in SI units.
    pub values: Vec<f64>,
}

/// Band between two curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimeBand {
    /// Name, its content.
    pub name: String,
    /// Lower edge.
    pub lower: TimeSeries,
    /// Upper edge.
    pub upper: TimeSeries,
}

/// Many runs by their quantiles at each time.
#[derive(Clone, Debug, PartialEq)]
pub struct FanChart {
    /// Plotted quantity, such as `Force F_e`.
    pub quantity: String,
    /// Unit of the quantity.
    pub unit: DisplayUnit,
    /// Bands, the widest first.
    pub bands: Vec<TimeBand>,
    /// Middle curve.
    pub middle: TimeSeries,
    /// Single highlighted run.
    pub single: Option<TimeSeries>,
    /// Reference, if a force is plotted.
    pub reference: Option<TimeSeries>,
    /// Marked instants, s, with their texts.
    pub events: Vec<(f64, String)>,
    /// Start and end, s.
    pub span_s: [f64; 2],
}

impl FanChart {
    /// Draws the figure.
    pub fn draw(&self, words: &Words) -> Figure {
        let [start, end] = self.span_s;
        let lines: Vec<(&TimeSeries, Stroke)> = self
            .reference
            .iter()
            .map(|series| (series, reference_stroke()))
            .chain(self.single.iter().map(|series| (series, single_stroke())))
            .chain([(&self.middle, middle_stroke())])
            .collect();
        let points = |series: &TimeSeries| within(series, self.unit, self.span_s);
        let mut marks: Vec<Mark> =
            self.bands.iter().enumerate().map(|(i, band)| self.area(i, band)).collect();
        marks.extend(
            lines.iter().map(|(series, stroke)| Mark::Line { points: points(series), stroke: *stroke }),
        );
        marks.extend(self.events.iter().map(|(time, words)| Mark::dotted(AxisDirection::X, *time, words)));
        let edges = self.bands.iter().flat_map(|band| [&band.lower, &band.upper]);
        let all = edges.chain(lines.iter().map(|(series, _)| *series));
        let values: Vec<f64> =
            all.flat_map(|series| points(series).into_iter().map(|point| point.1)).collect();
        let y = Axis::fit_linear(self.unit.title(&self.quantity), values.iter().copied());
        let mut legend: Vec<LegendEntry> =
            self.bands.iter().enumerate().map(|(i, band)| LegendEntry::area(&band.name, fill(i))).collect();
        legend.extend(lines.iter().rev().map(|(series, stroke)| LegendEntry::line(&series.name, *stroke)));
        let panels = vec![Panel::new(y, 260.0, marks)];
        words.with_plot(Axis::linear("Time (s)", start, end), panels, legend)
    }

    fn area(&self, index: usize, band: &TimeBand) -> Mark {
        let edge = |series: &TimeSeries| within(series, self.unit, self.span_s);
        let corners = edge(&band.upper).into_iter().chain(edge(&band.lower).into_iter().rev()).collect();
        Mark::Area { corners, fill: fill(index) }
    }
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

/// Part of a curve in a time span, in display units.
fn within(series: &TimeSeries, unit: DisplayUnit, [start, end]: [f64; 2]) -> Vec<(f64, f64)> {
    let points = series.times_s.iter().zip(&series.values).map(|(time, value)| (*time, unit.of(*value)));
    points.filter(|(time, value)| *time >= start && *time <= end && value.is_finite()).collect()
}
