//! Pareto fronts: alternatives over a swept number, by two or three of their columns.

use super::axis::{Axis, extent};
use super::colour::{Role, series_role};
use super::legend::LegendEntry;
use super::plot::{Mark, Marker, MarkerStyle, Panel};
use super::series::series_stroke;
use super::{Figure, Words};
use phea_quantity::DisplayUnit;

/// Rank of a point among the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontPlace {
    /// No other point is as good in all columns and better in one.
    OnFront,
    /// Another point dominates it.
    Dominated,
    /// Infeasible: a specification is violated, or the machine contradicts the verdict.
    NotToBeHad,
}

/// Point of an alternative.
#[derive(Clone, Debug, PartialEq)]
pub struct ParetoPoint {
    /// Value for each column, SI.
    pub values: Vec<f64>,
    /// Swept number, for its tooltip.
    pub label: String,
    /// Rank among the others.
    pub place: FrontPlace,
}

/// Alternative.
#[derive(Clone, Debug, PartialEq)]
pub struct ParetoCurve {
    /// Name of the alternative.
    pub name: String,
    /// Points in the order of the swept number.
    pub points: Vec<ParetoPoint>,
}

/// Alternatives by their columns.
#[derive(Clone, Debug, PartialEq)]
pub struct ParetoFront {
    /// Two or three columns: quantity and unit. The first is on the x axis.
    pub columns: Vec<(String, DisplayUnit)>,
    /// Alternatives.
    pub curves: Vec<ParetoCurve>,
}

/// Margin beyond the outermost points, as a fraction of their range.
const ROOM: f64 = 0.03;

impl ParetoFront {
    /// Draws the figure.
    pub fn draw(&self, words: &Words) -> Figure {
        let axis = |column: usize| {
            let (title, unit) =
                self.columns.get(column).cloned().unwrap_or((String::new(), DisplayUnit::ONE));
            let points = self.curves.iter().flat_map(|curve| &curve.points);
            let values = points.filter_map(|point| Some(unit.of(*point.values.get(column)?)));
            let (least, greatest) = extent(values);
            // markers at both ends are not cut
            let room = ROOM * (greatest - least);
            (Axis::fit_linear(unit.title(&title), [least - room, greatest + room]), unit)
        };
        let (x, x_unit) = axis(0);
        let panels = (1..self.columns.len()).map(|column| {
            let (y, y_unit) = axis(column);
            Panel::new(y, 260.0, self.marks(column, [x_unit, y_unit]))
        });
        let panels = panels.collect();
        words.with_plot(x, panels, self.legend())
    }

    fn marks(&self, column: usize, [x_unit, y_unit]: [DisplayUnit; 2]) -> Vec<Mark> {
        let mut marks = Vec::new();
        let at = |point: &ParetoPoint| {
            Some((x_unit.of(*point.values.first()?), y_unit.of(*point.values.get(column)?)))
        };
        for (index, curve) in self.curves.iter().enumerate() {
            let points = curve.points.iter().filter_map(at).collect();
            marks.push(Mark::Line { points, stroke: series_stroke(index) });
        }
        for (index, curve) in self.curves.iter().enumerate() {
            for point in &curve.points {
                let Some((x, y)) = at(point) else { continue };
                let points = vec![(x, y, format!("{}, {}", curve.name, point.label))];
                marks.push(Mark::Markers { points, style: style(point.place, series_role(index)) });
            }
        }
        marks
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let mut legend = LegendEntry::of_series(self.curves.iter().map(|curve| &curve.name));
        let places = [
            (FrontPlace::OnFront, "on the front"),
            (FrontPlace::Dominated, "dominated"),
            (FrontPlace::NotToBeHad, "not satisfied, or contradicted by the nonlinear simulation"),
        ];
        let used = |place: FrontPlace| {
            self.curves.iter().flat_map(|curve| &curve.points).any(|point| point.place == place)
        };
        let places = places.into_iter().filter(|(place, _)| used(*place));
        legend.extend(places.map(|(place, words)| LegendEntry::marker(words, style(place, Role::Axis))));
        legend
    }
}

fn style(place: FrontPlace, role: Role) -> MarkerStyle {
    match place {
        FrontPlace::OnFront => MarkerStyle { marker: Marker::Circle, role, radius: 5.0 },
        FrontPlace::Dominated => MarkerStyle { marker: Marker::Ring, role, radius: 4.5 },
        FrontPlace::NotToBeHad => MarkerStyle { marker: Marker::Cross, role, radius: 4.5 },
    }
}
