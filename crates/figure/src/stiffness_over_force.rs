//! Hydraulic stiffness of a rig with gas over the force that is held at standstill.

use super::axis::{Axis, extent};
use super::colour::{Role, series_stroke};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, Plot};
use super::scene::{Dash, Stroke};
use super::stiffness_over_stroke::{softest, stiffness_axis};
use super::{Figure, Words};
use phea_quantity::{DisplayUnit, MotionKind};

/// A curve of stiffness; both vectors have one value for each force.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceStiffnessCurve {
    /// Setting or design.
    pub name: String,
    /// Hydraulic forces, N, rising.
    pub forces_n: Vec<f64>,
    /// Stiffness there, N/m; not a number where there is none.
    pub stiffness_n_per_m: Vec<f64>,
}

/// What the figure shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceStiffnessInput {
    /// Curves; the first is the one the design rests on.
    pub curves: Vec<ForceStiffnessCurve>,
    /// Force of the linear model, N.
    pub operating_force_n: Option<f64>,
    /// How the rig moves: of one that turns, forces are in N m and stiffnesses in N m/rad.
    pub motion: MotionKind,
}

/// Draws the figure, with the least stiffness of the first curve: linear from zero, or logarithmic when
/// the curves lie more than a factor of twelve apart.
pub fn stiffness_over_force(words: Words, input: &ForceStiffnessInput) -> Figure {
    let force = input.motion.unit(DisplayUnit::KILONEWTON);
    let stiffness = input.motion.unit(DisplayUnit::MEGANEWTON_PER_METRE);
    let values = input.curves.iter().flat_map(|curve| &curve.stiffness_n_per_m).copied();
    let y = stiffness_axis(values.collect(), stiffness);
    let forces = input.curves.iter().flat_map(|curve| curve.forces_n.iter());
    let (left, right) = extent(forces.map(|v| force.of(*v)));
    let x = Axis::linear(force.title("Hydraulic force F_H"), left, right);
    let (mut marks, mut legend) = (Vec::new(), Vec::new());
    for (index, curve) in input.curves.iter().enumerate() {
        let values = curve.forces_n.iter().zip(&curve.stiffness_n_per_m);
        let line: Vec<(f64, f64)> = values.map(|(x, y)| (force.of(*x), stiffness.of(*y))).collect();
        let least = softest(&line, index, stiffness).filter(|_| index == 0);
        marks.push(Mark::Line { points: line, stroke: series_stroke(index) });
        marks.extend(least.into_iter().flatten());
        legend.push(LegendEntry::line(&curve.name, series_stroke(index)));
    }
    if let Some(at) = input.operating_force_n {
        marks.push(Mark::Reference {
            direction: AxisDirection::X,
            at: force.of(at),
            stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted),
            label: "operating point".to_string(),
        });
    }
    let panels = vec![Panel { y, height: 270.0, marks }];
    words.with_scene(Plot { x, panels, legend, equal_aspect: false }.draw())
}
