//! Hydraulic stiffness, Ledezma (2019), Figure 6.4: one curve per model or design, with its band,
//! over the stroke; of a rig with gas also over the force that is held at standstill.

use super::axis::{Axis, extent};
use super::colour::{Role, series_role};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel, PointSide};
use super::scene::Fill;
use super::series::series_stroke;
use super::ticks::plain;
use super::{Figure, Words};
use phea_quantity::{DisplayUnit, Units};

/// Abscissa of the stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StiffnessOver {
    /// Position of the piston, m; each curve shows its softest position.
    #[default]
    Stroke,
    /// Hydraulic force, N; the first curve shows its softest force.
    Force,
}

/// Curve of stiffness; all vectors have one value for each place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StiffnessCurve {
    /// Name of the model, setting or design.
    pub name: String,
    /// Positions or forces, rising.
    pub places: Vec<f64>,
    /// Stiffness at each place, N/m; NaN if there is none.
    pub stiffness_n_per_m: Vec<f64>,
    /// Lowest stiffness within the tolerance of the hose's stiffening, N/m; may be empty.
    pub minimum_n_per_m: Vec<f64>,
    /// Highest stiffness, N/m; may be empty.
    pub maximum_n_per_m: Vec<f64>,
}

/// Hydraulic stiffness over the stroke or the force.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StiffnessDiagram {
    /// Abscissa.
    pub over: StiffnessOver,
    /// Curves; the first is the basis of the design.
    pub curves: Vec<StiffnessCurve>,
    /// Position or force of the linear model.
    pub operating_point: Option<f64>,
    /// Meaning of the bands, such as `stiffening 4 to 5`.
    pub band_label: String,
    /// Units of positions and forces, with the motion of the rig: for one that turns, positions are
    /// in rad, forces in N m and stiffnesses in N m/rad.
    pub units: Units,
}

impl StiffnessDiagram {
    /// Draws the diagram: linear from zero, or logarithmic if the curves differ by more than a
    /// factor of twelve.
    pub fn draw(&self, words: &Words) -> Figure {
        let motion = self.units.motion;
        let (place, title) = match self.over {
            StiffnessOver::Stroke => {
                (self.units.position, motion.either("Piston position x_p", "Shaft angle θ"))
            }
            StiffnessOver::Force => {
                (self.units.force, motion.either("Hydraulic force F_H", "Hydraulic torque T_H"))
            }
        };
        let places = self.curves.iter().flat_map(|curve| curve.places.iter());
        let (left, right) = extent(places.map(|v| place.of(*v)));
        let mut marks = Vec::new();
        let mut legend = Vec::new();
        for (index, curve) in self.curves.iter().enumerate() {
            self.curve_marks(&mut marks, index, curve, place);
            legend.push(LegendEntry::line(&curve.name, series_stroke(index)));
            if !curve.minimum_n_per_m.is_empty() && !self.band_label.is_empty() && index == 0 {
                legend.push(LegendEntry::area(&self.band_label, band_fill(index)));
            }
        }
        let point = self.operating_point.map(|at| place.of(at));
        marks.extend(point.map(|at| Mark::dotted(AxisDirection::X, at, "operating point")));
        let panels = vec![Panel::new(self.axis(), 270.0, marks)];
        let x = Axis::linear(place.title(title), left, right);
        words.with_plot(x, panels, legend)
    }

    fn unit(&self) -> DisplayUnit {
        self.units.motion.unit(DisplayUnit::MEGANEWTON_PER_METRE)
    }

    fn axis(&self) -> Axis {
        let values = || {
            let all = |curve: &StiffnessCurve| {
                [&curve.stiffness_n_per_m, &curve.minimum_n_per_m, &curve.maximum_n_per_m].map(Vec::clone)
            };
            self.curves.iter().flat_map(all).flatten().map(|value| self.unit().of(value))
        };
        let (low, high) = extent(values().filter(|v| v.is_finite()));
        let title =
            self.unit().title(&format!("Hydraulic stiffness {}", self.units.motion.symbols().stiffness));
        if high > 12.0 * low && low > 0.0 {
            Axis::fit_logarithmic(title, values())
        } else {
            Axis::fit_linear(title, values().chain([0.0]))
        }
    }

    fn curve_marks(&self, marks: &mut Vec<Mark>, index: usize, curve: &StiffnessCurve, place: DisplayUnit) {
        let points = |values: &[f64]| -> Vec<(f64, f64)> {
            curve.places.iter().zip(values).map(|(x, y)| (place.of(*x), self.unit().of(*y))).collect()
        };
        let mut around = points(&curve.minimum_n_per_m);
        around.extend(points(&curve.maximum_n_per_m).into_iter().rev());
        around.retain(|(x, y)| x.is_finite() && y.is_finite());
        if around.len() > 2 {
            marks.push(Mark::Area { corners: around, fill: band_fill(index) });
        }
        let line = points(&curve.stiffness_n_per_m);
        let is_told = self.over == StiffnessOver::Stroke || index == 0;
        let least = softest(&line, index, self.unit()).filter(|_| is_told);
        marks.push(Mark::Line { points: line, stroke: series_stroke(index) });
        marks.extend(least.into_iter().flatten());
    }
}

fn band_fill(index: usize) -> Fill {
    Fill { role: series_role(index), opacity: 0.18 }
}

/// Lowest point of a line with its value.
fn softest(line: &[(f64, f64)], index: usize, unit: DisplayUnit) -> Option<[Mark; 2]> {
    let finite = line.iter().copied().filter(|p| p.1.is_finite());
    let (x, y) = finite.reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    let style = MarkerStyle { marker: Marker::Circle, role: series_role(index), radius: 4.0 };
    let text = format!("{} {}", plain(y), unit.symbol);
    Some([
        Mark::Markers { points: vec![(x, y, format!("softest: {text}"))], style },
        Mark::Label { at: vec![(x, y)], text, role: Role::Text, side: PointSide::Above },
    ])
}
