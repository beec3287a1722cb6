//! Sizes of margins and frames, grid, ticks and titles.

use super::super::axis::{Axis, Scale};
use super::super::colour::Role;
use super::super::legend;
use super::super::placement::Occupancy;
use super::super::scene::{
    Anchor, Baseline, Fill, PathStep, Point, Rectangle, Scene, Shape, Stroke, Text, point,
};
use super::super::ticks::Tick;
use super::super::{LABEL_SIZE, TITLE_SIZE, WIDTH, typeset};
use super::{Mark, Panel, Plot, labels, paint};

const EDGE: f64 = 8.0;
const RIGHT: f64 = 18.0;
const BETWEEN: f64 = 16.0;
const TICK: f64 = 4.0;
/// Distance from the frame to the capitals below it: clear of a number at the lower left corner.
const X_LABEL: f64 = 12.0;
/// Distance from the frame to a name on its right.
pub(super) const EDGE_GAP: f64 = 6.0;

/// Panel in position: maps values to the view box.
pub(super) struct Placed<'a> {
    pub(super) x: &'a Axis,
    pub(super) y: &'a Axis,
    pub(super) frame: Rectangle,
}

impl Placed<'_> {
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        point(self.x_at(x), self.y_at(y))
    }

    pub(super) fn x_at(&self, value: f64) -> f64 {
        self.frame.left + self.x.fraction(value) * self.frame.width()
    }

    pub(super) fn y_at(&self, value: f64) -> f64 {
        self.frame.bottom - self.y.fraction(value) * self.frame.height()
    }
}

pub(super) fn draw(plot: &Plot) -> Scene {
    let left = left_margin(plot);
    let right = right_edge(plot);
    let names_width = right - left;
    let names_height = |panel: &Panel| legend::height(&panel.names, names_width);
    let heights = plot.panels.iter().map(|panel| names_height(panel) + panel.height + BETWEEN);
    let bottom_of_panels = EDGE + heights.sum::<f64>() - BETWEEN;
    let below_ticks = bottom_of_panels + X_LABEL + LABEL_SIZE;
    let below_title = below_ticks + 8.0 + TITLE_SIZE;
    let legend_left = left.min(70.0);
    let legend_width = WIDTH - legend_left - EDGE;
    let legend_height = legend::height(&plot.legend, legend_width);
    let gap = if plot.legend.is_empty() { 0.0 } else { 8.0 };
    let mut scene = Scene::new(WIDTH, (below_title + gap + legend_height + EDGE).ceil());
    let mut top = EDGE;
    for (index, panel) in plot.panels.iter().enumerate() {
        legend::draw(&mut scene, &panel.names, left, top - 0.25 * BETWEEN, names_width);
        top += names_height(panel);
        let frame = Rectangle { left, top, right, bottom: top + panel.height };
        let last = index + 1 == plot.panels.len();
        draw_panel(&mut scene, plot, panel, frame, last);
        top += panel.height + BETWEEN;
    }
    let title = typeset::fitted(&plot.x.full_title(), TITLE_SIZE, WIDTH - left - EDGE);
    let middle = 0.5 * (left + right);
    scene.text(
        Text::new(point(middle, below_ticks + 6.0), title, TITLE_SIZE).held(Anchor::Middle, Baseline::Top),
    );
    legend::draw(&mut scene, &plot.legend, legend_left, below_title + gap, legend_width);
    scene
}

fn draw_panel(scene: &mut Scene, plot: &Plot, panel: &Panel, frame: Rectangle, last: bool) {
    let placed = Placed { x: &plot.x, y: &panel.y, frame };
    let x_ticks = plot.x.ticks(x_tick_count(frame.width()));
    let y_ticks = panel.y.ticks(y_tick_count(panel.height));
    let mut occupancy = Occupancy::default();
    scene.rectangle(frame, None, Some(Fill::solid(Role::Background)));
    paint::bands(scene, &placed, &panel.marks);
    grid(scene, &placed, &x_ticks, &y_ticks);
    paint::marks(scene, &placed, &panel.marks, &mut occupancy);
    scene.rectangle(frame, Some(Stroke::solid(Role::Axis, 1.0)), None);
    tick_labels(scene, &placed, &x_ticks, &y_ticks, last);
    let (title, size) = typeset::fitted_title(&panel.y.full_title(), TITLE_SIZE, panel.height + BETWEEN);
    let at = point(EDGE, frame.centre().y);
    scene.text(Text::new(at, title, size).held(Anchor::Middle, Baseline::Top).rotated(-90.0));
    labels::draw_at_edge(scene, &placed, &panel.marks);
    labels::draw(scene, &placed, &panel.marks, &mut occupancy);
}

fn x_tick_count(width: f64) -> usize {
    // between 3 and 20 for any width of a figure
    (width / 62.0).clamp(3.0, 20.0) as usize
}

fn y_tick_count(height: f64) -> usize {
    (height / 30.0).clamp(2.0, 20.0) as usize
}

fn left_margin(plot: &Plot) -> f64 {
    let widest = plot
        .panels
        .iter()
        .flat_map(|panel| panel.y.ticks(y_tick_count(panel.height)))
        .filter_map(|tick| tick.label)
        .map(|label| typeset::width(&label, LABEL_SIZE))
        .fold(0.0, f64::max);
    (EDGE + TITLE_SIZE + 9.0 + widest + TICK + 4.0).ceil()
}

/// Right side of the frames: space for half a tick label, or for the names of lines that end there.
fn right_edge(plot: &Plot) -> f64 {
    let widest = plot
        .panels
        .iter()
        .flat_map(|panel| &panel.marks)
        .filter_map(|mark| match mark {
            Mark::EdgeLabel { text, .. } => Some(typeset::width(text, LABEL_SIZE) + EDGE_GAP + EDGE),
            _ => None,
        })
        .fold(RIGHT, f64::max);
    WIDTH - widest.min(0.3 * WIDTH).ceil()
}

/// All lines of a kind as one path.
fn strokes(scene: &mut Scene, ends: impl Iterator<Item = (Point, Point)>, stroke: Stroke) {
    let steps: Vec<PathStep> = ends.flat_map(|(a, b)| [PathStep::Move(a), PathStep::Line(b)]).collect();
    if !steps.is_empty() {
        scene.shape(Shape::Path(steps), Some(stroke), None);
    }
}

fn grid(scene: &mut Scene, placed: &Placed<'_>, x_ticks: &[Tick], y_ticks: &[Tick]) {
    let frame = placed.frame;
    let kinds = [(false, Stroke::solid(Role::MinorGrid, 0.8)), (true, Stroke::solid(Role::Grid, 1.0))];
    for (labelled, stroke) in kinds {
        let upright = x_ticks.iter().filter(|tick| tick.label.is_some() == labelled).map(|tick| {
            let x = placed.x_at(tick.value);
            (point(x, frame.top), point(x, frame.bottom))
        });
        let lying = y_ticks.iter().filter(|tick| tick.label.is_some() == labelled).map(|tick| {
            let y = placed.y_at(tick.value);
            (point(frame.left, y), point(frame.right, y))
        });
        strokes(scene, upright.chain(lying), stroke);
    }
    let length = |tick: &Tick| if tick.label.is_some() { TICK } else { 0.5 * TICK };
    let below = x_ticks.iter().map(|tick| {
        let x = placed.x_at(tick.value);
        (point(x, frame.bottom), point(x, frame.bottom + length(tick)))
    });
    let beside = y_ticks.iter().map(|tick| {
        let y = placed.y_at(tick.value);
        (point(frame.left - length(tick), y), point(frame.left, y))
    });
    strokes(scene, below.chain(beside), Stroke::solid(Role::Axis, 1.0));
}

fn tick_labels(scene: &mut Scene, placed: &Placed<'_>, x_ticks: &[Tick], y_ticks: &[Tick], last: bool) {
    let frame = placed.frame;
    let mut end = f64::NEG_INFINITY;
    for tick in x_ticks {
        let x = placed.x_at(tick.value);
        let Some(label) = tick.label.as_ref().filter(|_| last) else { continue };
        let text = Text::new(point(x, frame.bottom + X_LABEL), label.clone(), LABEL_SIZE)
            .held(Anchor::Middle, Baseline::Top);
        let bounds = text.bounds();
        if bounds.left > end + 6.0 && bounds.right <= WIDTH {
            end = bounds.right;
            scene.text(text);
        }
    }
    let mut above = f64::INFINITY;
    for tick in y_ticks {
        let y = placed.y_at(tick.value);
        let Some(label) = &tick.label else { continue };
        let text = Text::new(point(frame.left - TICK - 4.0, y), label.clone(), LABEL_SIZE)
            .held(Anchor::End, Baseline::Middle);
        let bounds = text.bounds();
        if bounds.bottom < above - 1.0 {
            above = bounds.top;
            scene.text(text);
        }
    }
}

/// Extends the axis that is too short for equal units, x at its lower end, y at both; scales other
/// than linear are unchanged.
pub(super) fn with_equal_aspect(plot: &Plot) -> Plot {
    let mut result = plot.clone();
    let width = right_edge(plot) - left_margin(plot);
    let [panel] = result.panels.as_mut_slice() else { return result };
    if plot.x.scale != Scale::Linear || panel.y.scale != Scale::Linear {
        return result;
    }
    let per_x = (plot.x.maximum - plot.x.minimum) / width;
    let per_y = (panel.y.maximum - panel.y.minimum) / panel.height;
    if per_x < per_y {
        result.x.minimum = result.x.maximum - per_y * width;
    } else {
        let (middle, half) = (0.5 * (panel.y.minimum + panel.y.maximum), 0.5 * per_x * panel.height);
        (panel.y.minimum, panel.y.maximum) = (middle - half, middle + half);
    }
    result
}
