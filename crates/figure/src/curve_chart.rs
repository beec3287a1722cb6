//! Measured and computed curves over one common quantity: panels below each other.

use super::axis::Axis;
use super::colour::{Role, series_role};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel};
use super::scene::{Dash, Fill, Stroke};
use super::series::series_stroke;
use super::ticks::plain;
use super::{Figure, Words};

/// Style of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveStyle {
    /// Line in the colour and dash pattern of a series.
    Line(usize),
    /// Small dot for each point, in the colour of a series.
    Dots(usize),
    /// Commanded value: a thin line without a colour of its own.
    Reference,
    /// Limit of the other curves.
    Limit,
}

impl CurveStyle {
    const fn stroke(self) -> Stroke {
        match self {
            CurveStyle::Line(series) | CurveStyle::Dots(series) => series_stroke(series),
            CurveStyle::Reference => Stroke::solid(Role::Muted, 1.6),
            CurveStyle::Limit => Stroke::solid(Role::Bad, 1.4).dashed(Dash::LongDash),
        }
    }
}

/// Curve in the units of its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Points (x, y).
    pub points: Vec<(f64, f64)>,
    /// Style.
    pub style: CurveStyle,
}

impl Curve {
    /// Curve as a line.
    pub fn line(points: impl IntoIterator<Item = (f64, f64)>, series: usize) -> Curve {
        Curve { points: points.into_iter().collect(), style: CurveStyle::Line(series) }
    }

    /// Curve as dots.
    pub fn dots(points: impl IntoIterator<Item = (f64, f64)>, series: usize) -> Curve {
        Curve { points: points.into_iter().collect(), style: CurveStyle::Dots(series) }
    }
}

/// Band in which a response must remain from some time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettlingBand {
    /// Final value, in the unit of the panel.
    pub level: f64,
    /// Half width as a percentage of the level.
    pub percent: f64,
}

/// Range of the vertical axis of a panel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CurveRange {
    /// All curves.
    #[default]
    Fitted,
    /// All curves and zero.
    WithZero,
    /// Given range.
    Between([f64; 2]),
}

/// Pair of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurvePanel {
    /// Title of the vertical axis, with its unit.
    pub title: String,
    /// Height of the frame in view box units.
    pub height: f64,
    /// Curves, back to front.
    pub curves: Vec<Curve>,
    /// Range of the vertical axis.
    pub range: CurveRange,
    /// Marked values of x, with a word in this panel.
    pub marked: Vec<(f64, String)>,
    /// True if zero is marked, as for residuals.
    pub zero_line: bool,
    /// Settling band of a response.
    pub settling_band: Option<SettlingBand>,
    /// Names of its curves, if given in this panel.
    pub named: Vec<(String, CurveStyle)>,
}

impl CurvePanel {
    /// Panel of curves with an axis that covers all of them.
    pub fn new(title: impl Into<String>, height: f64, curves: Vec<Curve>) -> CurvePanel {
        CurvePanel { title: title.into(), height, curves, ..CurvePanel::default() }
    }

    /// Panel with zero marked.
    pub fn with_zero_line(self) -> CurvePanel {
        CurvePanel { zero_line: true, ..self }
    }

    fn placed(&self, [least, most]: [f64; 2]) -> Panel {
        let shown = |curve: &Curve| -> Vec<(f64, f64)> {
            let all = curve.points.iter().copied();
            all.filter(|(x, y)| (least..=most).contains(x) && y.is_finite()).collect()
        };
        let curves: Vec<(Vec<(f64, f64)>, CurveStyle)> =
            self.curves.iter().map(|curve| (shown(curve), curve.style)).collect();
        let values = curves.iter().flat_map(|(points, _)| points.iter().map(|(_, y)| *y));
        let y = match self.range {
            CurveRange::Fitted => Axis::fit_linear(&self.title, values),
            CurveRange::WithZero => Axis::fit_linear(&self.title, values.chain([0.0])),
            CurveRange::Between([from, to]) => Axis::linear(&self.title, from, to),
        };
        let mut marks: Vec<Mark> = self.settling_band.iter().map(band).collect();
        if self.zero_line {
            marks.push(Mark::reference(AxisDirection::Y, 0.0, Stroke::solid(Role::Muted, 1.2), ""));
        }
        marks.extend(curves.into_iter().map(|(points, style)| match style {
            CurveStyle::Dots(series) => Mark::Dots { points, role: series_role(series), radius: DOT },
            _ => Mark::Line { points, stroke: style.stroke() },
        }));
        marks.extend(self.marked.iter().map(|(at, word)| Mark::dotted(AxisDirection::X, *at, word)));
        Panel { y, height: self.height, marks, names: self.named.iter().map(entry).collect() }
    }
}

/// Legend entry of a name with a sample of its curve.
fn entry((text, style): &(String, CurveStyle)) -> LegendEntry {
    match style {
        CurveStyle::Dots(series) => {
            let style = MarkerStyle { marker: Marker::Circle, role: series_role(*series), radius: 2.5 };
            LegendEntry::marker(text, style)
        }
        _ => LegendEntry::line(text, style.stroke()),
    }
}

fn band(settling: &SettlingBand) -> Mark {
    let half = 0.01 * settling.percent * settling.level;
    Mark::band(AxisDirection::Y, [settling.level - half, settling.level + half], SETTLED)
}

/// Chart of curves over one quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveChart {
    /// Title of the horizontal axis, with its unit.
    pub x_title: String,
    /// Ends of the horizontal axis; points beyond are omitted.
    pub x_range: [f64; 2],
    /// Panels, top to bottom.
    pub panels: Vec<CurvePanel>,
    /// Names of the styles.
    pub legend: Vec<(String, CurveStyle)>,
}

/// Radius of a dot.
const DOT: f64 = 1.5;
const SETTLED: Fill = Fill { role: Role::Good, opacity: 0.25 };

impl CurveChart {
    /// Draws the chart.
    pub fn draw(&self, words: &Words) -> Figure {
        let [least, most] = self.x_range;
        self.over(words, Axis::linear(&self.x_title, least, most))
    }

    /// Draws the chart over a logarithmic axis.
    pub fn draw_over_decades(&self, words: &Words) -> Figure {
        self.over(words, Axis::fit_logarithmic(&self.x_title, self.x_range))
    }

    fn over(&self, words: &Words, x: Axis) -> Figure {
        let panels = self.panels.iter().map(|panel| panel.placed(self.x_range)).collect();
        let bands = self.panels.iter().filter_map(|panel| panel.settling_band);
        let bands =
            bands.map(|band| LegendEntry::area(format!("settling band ±{} %", plain(band.percent)), SETTLED));
        let legend = self.legend.iter().map(entry).chain(bands).collect();
        words.with_plot(x, panels, legend)
    }
}
