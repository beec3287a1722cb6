//! Band that closed loops allow for the magnitude of their prefilters, with the prefilters in it.

use super::axis::{Axis, extent};
use super::colour::{Role, series_role};
use super::family_magnitude::excess;
use super::legend::LegendEntry;
use super::plot::{Mark, Panel};
use super::scene::{Dash, Fill, Stroke};
use super::{Figure, Words};

/// Band at one frequency, and the prefilter there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PrefilterPoint {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Lower limit over min|T|, dB; minus infinity if there is no lower limit.
    pub least_db: f64,
    /// Upper limit over max|T|, dB.
    pub greatest_db: f64,
    /// |F|, dB; `None` without one.
    pub prefilter_db: Option<f64>,
}

/// Loop with its prefilter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PrefilterPanel {
    /// Name of the loop.
    pub name: String,
    /// Points, over rising frequency.
    pub points: Vec<PrefilterPoint>,
}

/// Depth below the highest magnitude down to which magnitudes are shown, dB.
const DEPTH_DB: f64 = 60.0;

/// Draws a panel for each loop, all with equal axes. If the smallest magnitude is above the
/// largest, no prefilter satisfies the limits.
pub fn prefilter_band(words: &Words, panels: &[PrefilterPanel]) -> Figure {
    let all = || panels.iter().flat_map(|panel| &panel.points);
    let x = Axis::fit_logarithmic("Frequency (rad/s)", all().map(|point| point.frequency_rad_per_s));
    let values = all().flat_map(|point| [Some(point.least_db), Some(point.greatest_db), point.prefilter_db]);
    let values: Vec<f64> = values.flatten().filter(|value| value.is_finite()).collect();
    let (_, highest) = extent(values.iter().copied());
    let axis = |name: &str| {
        let seen = values.iter().copied().filter(|value| *value > highest - DEPTH_DB);
        Axis::fit_decibel(title(name), seen.chain([-5.0, 5.0]))
    };
    let height = if panels.len() > 1 { 190.0 } else { 270.0 };
    let panel = |(index, one): (usize, &PrefilterPanel)| {
        let y = axis(&one.name);
        let marks = marks(one, index, y.minimum - 1.0);
        Panel::new(y, height, marks)
    };
    let panels_drawn = panels.iter().enumerate().map(panel).collect();
    words.with_plot(x, panels_drawn, legend(panels))
}

fn title(name: &str) -> String {
    if name.is_empty() { "|F| (dB)".to_string() } else { format!("{name} |F| (dB)") }
}

const BAND: Fill = Fill { role: Role::Good, opacity: 0.13 };
const CLOSED: Fill = Fill { role: Role::Bad, opacity: 0.28 };

fn edge_stroke() -> Stroke {
    Stroke::solid(Role::Bad, 1.8).dashed(Dash::LongDash)
}

fn prefilter_stroke(index: usize) -> Stroke {
    let dash = if index == 0 { Dash::Solid } else { Dash::DashDot };
    Stroke::solid(series_role(index), 2.4).dashed(dash)
}

fn marks(panel: &PrefilterPanel, index: usize, foot: f64) -> Vec<Mark> {
    let curve = |value: fn(&PrefilterPoint) -> f64| -> Vec<(f64, f64)> {
        panel.points.iter().map(|point| (point.frequency_rad_per_s, value(point).max(foot))).collect()
    };
    let (least, greatest) = (curve(|point| point.least_db), curve(|point| point.greatest_db));
    let areas = |above, below, fill: Fill| {
        excess(above, below).into_iter().map(move |corners| Mark::Area { corners, fill })
    };
    let mut marks: Vec<Mark> = areas(&greatest, &least, BAND).collect();
    marks.extend(areas(&least, &greatest, CLOSED));
    for edge in [greatest.into_iter().rev().collect(), least] {
        marks.push(Mark::Fringe { points: Vec::clone(&edge), stroke: Stroke::solid(Role::Bad, 0.7) });
        marks.push(Mark::Line { points: edge, stroke: edge_stroke() });
    }
    let prefilter =
        panel.points.iter().filter_map(|point| Some((point.frequency_rad_per_s, point.prefilter_db?)));
    marks.push(Mark::Line { points: prefilter.collect(), stroke: prefilter_stroke(index) });
    marks
}

fn legend(panels: &[PrefilterPanel]) -> Vec<LegendEntry> {
    let named = |name: &str| if name.is_empty() { "|F|".to_string() } else { format!("|F| {name}") };
    let numbered = panels.iter().enumerate();
    let mut legend: Vec<LegendEntry> = numbered
        .map(|(index, panel)| LegendEntry::line(named(&panel.name), prefilter_stroke(index)))
        .collect();
    let band = LegendEntry::area("left for |F| by the loop", BAND);
    legend.push(LegendEntry { stroke: Some(edge_stroke()), ..band });
    let is_closed = |point: &PrefilterPoint| point.least_db > point.greatest_db;
    if panels.iter().any(|panel| panel.points.iter().any(is_closed)) {
        legend.push(LegendEntry::area("nothing left: no prefilter will do", CLOSED));
    }
    legend
}
