//! Step responses of a family inside the band between the step responses of the limits.

mod edge;

use self::edge::settling;
use super::axis::{Axis, extent};
use super::colour::{Role, series_role};
use super::fan_chart::{TimeBand, TimeSeries};
use super::legend::LegendEntry;
use super::plot::{Mark, Panel};
use super::scene::{Dash, Fill, Stroke};
use super::series::series_dash;
use super::{Figure, Words};
use phea_quantity::DisplayUnit;

/// Step responses of a family; values are fractions of the step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FamilySteps {
    /// Plotted quantity, such as `Force, part of the step`.
    pub quantity: String,
    /// Band between the step responses of the limits.
    pub band: Option<TimeBand>,
    /// Members.
    pub members: Vec<TimeSeries>,
    /// Nominal plant.
    pub nominal: Option<TimeSeries>,
    /// Members to highlight, such as the worst.
    pub named: Vec<TimeSeries>,
}

/// Largest end time that is shown in milliseconds, s.
const SHORT_S: f64 = 0.5;
/// Range of values that the axis may cover; a response that leaves it, such as an unstable one, is
/// cut at the frame.
const VALUES: std::ops::RangeInclusive<f64> = -0.5..=2.5;

impl FamilySteps {
    /// Draws the figure. The band extends from the lowest future value of the lower limit's
    /// response to the highest future value of the upper limit's: an undershoot of the upper limit
    /// does not cut the band.
    pub fn draw(&self, words: &Words) -> Figure {
        let times = self.shown().flat_map(|series| series.times_s.iter().copied());
        let (start, end) = extent(times.filter(|time| time.is_finite()));
        let unit = if end <= SHORT_S { DisplayUnit::MILLISECOND } else { DisplayUnit::SECOND };
        let x = Axis::linear(unit.title("Time"), unit.of(start), unit.of(end));
        let values = self.shown().flat_map(|series| series.values.iter().copied());
        let y = Axis::fit_linear(&self.quantity, values.filter(|v| VALUES.contains(v)).chain([0.0, 1.1]));
        let panels = vec![Panel::new(y, 270.0, self.marks(unit))];
        words.with_plot(x, panels, self.legend())
    }

    fn shown(&self) -> impl Iterator<Item = &TimeSeries> {
        self.bounds().chain(&self.members).chain(&self.nominal).chain(&self.named)
    }

    fn bounds(&self) -> impl Iterator<Item = &TimeSeries> {
        self.band.iter().flat_map(|band| [&band.upper, &band.lower])
    }

    fn marks(&self, unit: DisplayUnit) -> Vec<Mark> {
        let line = |series: &TimeSeries, stroke: Stroke| Mark::Line { points: points(series, unit), stroke };
        let mut marks = Vec::new();
        if let Some(TimeBand { upper, lower, .. }) = &self.band {
            let (above, below) = (settling(points(upper, unit), 1.0), settling(points(lower, unit), -1.0));
            let around = above.into_iter().chain(below.into_iter().rev()).collect();
            marks.push(Mark::Area { corners: around, fill: BAND });
        }
        marks.extend(self.members.iter().map(|member| line(member, member_stroke())));
        marks.extend(self.bounds().map(|bound| line(bound, bound_stroke())));
        marks.extend(self.named.iter().enumerate().map(|(index, series)| line(series, named_stroke(index))));
        marks.extend(self.nominal.iter().map(|series| line(series, nominal_stroke())));
        marks
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let mut legend: Vec<LegendEntry> =
            self.nominal.iter().map(|series| LegendEntry::line(&series.name, nominal_stroke())).collect();
        let named = self.named.iter().enumerate();
        legend.extend(named.map(|(index, series)| LegendEntry::line(&series.name, named_stroke(index))));
        if !self.members.is_empty() {
            legend.push(LegendEntry::line("members", member_stroke()));
        }
        if let Some(band) = &self.band {
            let stroke = Some(bound_stroke());
            legend.push(LegendEntry { stroke, ..LegendEntry::area(&band.name, BAND) });
        }
        legend
    }
}

fn member_stroke() -> Stroke {
    Stroke::solid(Role::Muted, 0.6)
}

fn nominal_stroke() -> Stroke {
    Stroke::solid(series_role(0), 2.4)
}

fn named_stroke(index: usize) -> Stroke {
    Stroke::solid(series_role(index + 1), 2.0).dashed(series_dash(index + 1))
}

fn bound_stroke() -> Stroke {
    Stroke::solid(Role::Bad, 1.6).dashed(Dash::LongDash)
}

const BAND: Fill = Fill { role: Role::Good, opacity: 0.13 };

fn points(series: &TimeSeries, unit: DisplayUnit) -> Vec<(f64, f64)> {
    series.times_s.iter().map(|time| unit.of(*time)).zip(series.values.iter().copied()).collect()
}
