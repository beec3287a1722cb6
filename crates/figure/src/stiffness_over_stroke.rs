//! Hydraulic stiffness over the stroke, Ledezma (2019), Figure 6.4: one curve a model or design,
//! with its band.

use super::axis::{Axis, extent};
use super::colour::{Role, series_role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel, Plot, PointSide};
use super::scene::{Dash, Fill, Stroke};
use super::ticks::plain;
use super::{Figure, Words};
use phea_quantity::{DisplayUnit, MotionKind};

/// A curve of stiffness; all vectors have one value for each position.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StiffnessCurve {
    /// Model or design.
    pub name: String,
    /// Piston positions, m, rising.
    pub positions_m: Vec<f64>,
    /// Stiffness there, N/m.
    pub stiffness_n_per_m: Vec<f64>,
    /// Lowest stiffness within the tolerance of the hose's stiffening, N/m; empty for none.
    pub minimum_n_per_m: Vec<f64>,
    /// Highest, N/m; empty for none.
    pub maximum_n_per_m: Vec<f64>,
}

/// What the figure shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StiffnessInput {
    /// Curves; the first is the one the design rests on.
    pub curves: Vec<StiffnessCurve>,
    /// Position of the linear model, m.
    pub operating_position_m: Option<f64>,
    /// What the bands mean, such as `stiffening 4 to 5`.
    pub band_label: String,
    /// How the rig moves: of one that turns, positions are in rad and stiffnesses in N m/rad.
    pub motion: MotionKind,
}

/// Draws the figure: linear from zero, or logarithmic when the curves lie more than a factor of
/// twelve apart.
pub fn stiffness_over_stroke(words: Words, input: &StiffnessInput) -> Figure {
    let (length, stiffness) = units(input.motion);
    let values = input.curves.iter().flat_map(|curve| {
        [&curve.stiffness_n_per_m, &curve.minimum_n_per_m, &curve.maximum_n_per_m].into_iter().flatten()
    });
    let y = stiffness_axis(values.copied().collect(), stiffness);
    let positions = input.curves.iter().flat_map(|curve| curve.positions_m.iter());
    let (left, right) = extent(positions.map(|v| length.of(*v)));
    let x = Axis::linear(length.title("Piston position x_p"), left, right);
    let mut marks = Vec::new();
    let mut legend = Vec::new();
    for (index, curve) in input.curves.iter().enumerate() {
        curve_marks(&mut marks, index, curve, units(input.motion));
        legend.push(LegendEntry::line(&curve.name, series_stroke(index)));
        if !curve.minimum_n_per_m.is_empty() && !input.band_label.is_empty() && index == 0 {
            legend.push(LegendEntry::area(&input.band_label, band_fill(index)));
        }
    }
    if let Some(position) = input.operating_position_m {
        marks.push(Mark::Reference {
            direction: AxisDirection::X,
            at: length.of(position),
            stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted),
            label: "operating point".to_string(),
        });
    }
    let panels = vec![Panel { y, height: 270.0, marks }];
    words.with_scene(Plot { x, panels, legend, equal_aspect: false }.draw())
}

/// The axis of stiffnesses in N/m, or N m/rad.
pub(super) fn stiffness_axis(values: Vec<f64>, unit: DisplayUnit) -> Axis {
    let shown = || values.iter().map(|value| unit.of(*value));
    let (low, high) = extent(shown().filter(|v| v.is_finite()));
    let title = unit.title("Hydraulic stiffness K_H");
    if high > 12.0 * low && low > 0.0 {
        Axis::fit_logarithmic(title, shown())
    } else {
        Axis::fit_linear(title, shown().chain([0.0]))
    }
}

fn band_fill(index: usize) -> Fill {
    Fill { role: series_role(index), opacity: 0.18 }
}

/// Those of position and stiffness.
fn units(motion: MotionKind) -> (DisplayUnit, DisplayUnit) {
    (motion.unit(DisplayUnit::MILLIMETRE), motion.unit(DisplayUnit::MEGANEWTON_PER_METRE))
}

fn curve_marks(
    marks: &mut Vec<Mark>,
    index: usize,
    curve: &StiffnessCurve,
    (length, stiffness): (DisplayUnit, DisplayUnit),
) {
    let points = |values: &[f64]| -> Vec<(f64, f64)> {
        curve.positions_m.iter().zip(values).map(|(x, y)| (length.of(*x), stiffness.of(*y))).collect()
    };
    let mut around = points(&curve.minimum_n_per_m);
    around.extend(points(&curve.maximum_n_per_m).into_iter().rev());
    around.retain(|(x, y)| x.is_finite() && y.is_finite());
    if around.len() > 2 {
        marks.push(Mark::Area { corners: around, fill: band_fill(index) });
    }
    let line = points(&curve.stiffness_n_per_m);
    let least = softest(&line, index, stiffness);
    marks.push(Mark::Line { points: line, stroke: series_stroke(index) });
    marks.extend(least.into_iter().flatten());
}

/// The lowest point of a line with its value.
pub(super) fn softest(line: &[(f64, f64)], index: usize, unit: DisplayUnit) -> Option<[Mark; 2]> {
    let finite = line.iter().copied().filter(|p| p.1.is_finite());
    let (x, y) = finite.reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    let style = MarkerStyle { marker: Marker::Circle, role: series_role(index), radius: 4.0 };
    let text = format!("{} {}", plain(y), unit.symbol);
    Some([
        Mark::Markers { points: vec![(x, y, format!("softest: {text}"))], style },
        Mark::Label { at: vec![(x, y)], text, role: Role::Text, side: PointSide::Above },
    ])
}
