//! Responses over time: reference, responses, settling band, bounds and events.

use super::axis::{Axis, extent};
use super::colour::{Role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, Plot};
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

/// The band a response must stay in from some time on.
#[derive(Clone, Debug, PartialEq)]
pub struct SettlingBand {
    /// Final value, SI.
    pub level: f64,
    /// Half width as a percentage of the level.
    pub percent: f64,
}

/// Curves that a response should stay between.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimeBounds {
    /// Upper curve.
    pub upper: TimeSeries,
    /// Lower curve.
    pub lower: TimeSeries,
}

/// An instant to mark.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeEvent {
    /// When, s.
    pub time_s: f64,
    /// Such as `t_s(1 %) = 0.29 s`.
    pub label: String,
}

/// What the figure shows.
#[derive(Clone, Debug, PartialEq)]
pub struct StepResponseInput {
    /// What is plotted, such as `Force F_e`.
    pub quantity: String,
    /// Its unit.
    pub unit: DisplayUnit,
    /// The commanded value, drawn apart from the responses.
    pub reference: Option<TimeSeries>,
    /// Responses.
    pub responses: Vec<TimeSeries>,
    /// Settling band.
    pub settling_band: Option<SettlingBand>,
    /// Bounds of a tracking specification.
    pub bounds: Option<TimeBounds>,
    /// Instants.
    pub events: Vec<TimeEvent>,
    /// Control signals in V, in a panel of their own; empty for none.
    pub controls: Vec<TimeSeries>,
}

/// Draws the figure.
pub fn step_response(words: Words, input: &StepResponseInput) -> Figure {
    let shown = || {
        let bounds = input.bounds.iter().flat_map(|bounds| [&bounds.upper, &bounds.lower]);
        input.reference.iter().chain(&input.responses).chain(bounds)
    };
    let times = shown().chain(&input.controls).flat_map(|series| series.times_s.iter().copied());
    let (start, end) = extent(times.filter(|t| t.is_finite()));
    let x = Axis::linear("Time (s)", start, end);
    let y = Axis::fit_linear(
        input.unit.title(&input.quantity),
        shown().flat_map(|series| series.values.iter().map(|v| input.unit.of(*v))),
    );
    let mut panels = vec![Panel { y, height: 250.0, marks: marks(input) }];
    if !input.controls.is_empty() {
        panels.push(control_panel(&input.controls));
    }
    for panel in &mut panels {
        let first = !panel.y.title.starts_with("Control");
        panel.marks.extend(input.events.iter().map(|event| Mark::Reference {
            direction: AxisDirection::X,
            at: event.time_s,
            stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted),
            label: if first { event.label.clone() } else { String::new() },
        }));
    }
    words.with_scene(Plot { x, panels, legend: legend(input), equal_aspect: false }.draw())
}

fn reference_stroke() -> Stroke {
    Stroke::solid(Role::Muted, 1.6)
}

fn bound_stroke() -> Stroke {
    Stroke::solid(Role::Bad, 1.4).dashed(Dash::LongDash)
}

fn points(series: &TimeSeries, unit: DisplayUnit) -> Vec<(f64, f64)> {
    series.times_s.iter().zip(&series.values).map(|(t, v)| (*t, unit.of(*v))).collect()
}

fn marks(input: &StepResponseInput) -> Vec<Mark> {
    let mut marks = Vec::new();
    if let Some(band) = &input.settling_band {
        let half = 0.01 * band.percent * band.level;
        marks.push(Mark::Band {
            direction: AxisDirection::Y,
            from: input.unit.of(band.level - half),
            to: input.unit.of(band.level + half),
            fill: Fill { role: Role::Good, opacity: 0.25 },
            hatched: false,
            label: String::new(),
        });
    }
    let line =
        |series: &TimeSeries, stroke: Stroke| Mark::Line { points: points(series, input.unit), stroke };
    if let Some(bounds) = &input.bounds {
        marks.push(line(&bounds.upper, bound_stroke()));
        marks.push(line(&bounds.lower, bound_stroke()));
    }
    marks.extend(input.reference.iter().map(|series| line(series, reference_stroke())));
    marks.extend(input.responses.iter().enumerate().map(|(i, series)| line(series, series_stroke(i))));
    marks
}

fn control_panel(controls: &[TimeSeries]) -> Panel {
    let unit = DisplayUnit::VOLT;
    let values = controls.iter().flat_map(|series| series.values.iter().copied());
    let marks = controls
        .iter()
        .enumerate()
        .map(|(i, series)| Mark::Line { points: points(series, unit), stroke: series_stroke(i) })
        .collect();
    Panel { y: Axis::fit_linear(unit.title("Control U_C"), values.chain([0.0])), height: 110.0, marks }
}

fn legend(input: &StepResponseInput) -> Vec<LegendEntry> {
    let mut legend: Vec<LegendEntry> = input
        .responses
        .iter()
        .enumerate()
        .map(|(index, series)| LegendEntry::line(&series.name, series_stroke(index)))
        .collect();
    legend.extend(input.reference.iter().map(|series| LegendEntry::line(&series.name, reference_stroke())));
    if input.bounds.is_some() {
        legend.push(LegendEntry::line("tracking bounds", bound_stroke()));
    }
    if let Some(band) = &input.settling_band {
        let text = format!("settling band ±{} %", super::ticks::plain(band.percent));
        legend.push(LegendEntry::area(text, Fill { role: Role::Good, opacity: 0.25 }));
    }
    legend
}
