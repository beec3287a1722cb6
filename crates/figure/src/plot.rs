//! Axes with panels on one x axis: curves, bands, reference lines, markers and labels that do not
//! overlap.

mod labels;
mod layout;
mod paint;

pub use super::marker::{Marker, MarkerStyle};

use super::axis::Axis;
use super::colour::Role;
use super::legend::LegendEntry;
use super::scene::{Dash, Fill, Scene, Stroke};

/// Content of a panel, in data coordinates, drawn in the order given.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// Curve; points out of range or NaN interrupt it.
    Line {
        /// Points (x, y).
        points: Vec<(f64, f64)>,
        /// Line.
        stroke: Stroke,
    },
    /// Short strokes on the right-hand side of a line, seen along it: the forbidden side.
    Fringe {
        /// Points (x, y).
        points: Vec<(f64, f64)>,
        /// Strokes.
        stroke: Stroke,
    },
    /// Small dots; of several that would overlap one is drawn.
    Dots {
        /// Points (x, y).
        points: Vec<(f64, f64)>,
        /// Colour.
        role: Role,
        /// Radius.
        radius: f64,
    },
    /// Closed area, cut at the frame.
    Area {
        /// Corners (x, y).
        corners: Vec<(f64, f64)>,
        /// Interior.
        fill: Fill,
    },
    /// Markers; those out of range are omitted.
    Markers {
        /// Points (x, y), each with a tooltip.
        points: Vec<(f64, f64, String)>,
        /// Shape, colour and size.
        style: MarkerStyle,
    },
    /// Band across the panel.
    Band {
        /// Axis to which `from` and `to` refer.
        direction: AxisDirection,
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
        /// Interior.
        fill: Fill,
        /// Diagonal lines, for prints without colour.
        hatched: bool,
        /// Text inside; may be empty.
        label: String,
    },
    /// Straight line across the panel.
    Reference {
        /// Axis to which `at` refers.
        direction: AxisDirection,
        /// Value.
        at: f64,
        /// Line.
        stroke: Stroke,
        /// Text next to it; may be empty.
        label: String,
    },
    /// Text outside the frame on the right, at the height of a value of y: the name of a line that
    /// ends there.
    EdgeLabel {
        /// Value of y.
        at: f64,
        /// Text with markup.
        text: String,
        /// Colour.
        role: Role,
    },
    /// Text of a point, connected to it by a thin line unless it is adjacent.
    Callout {
        /// Point (x, y), or several candidates.
        at: Vec<(f64, f64)>,
        /// Text with markup.
        text: String,
        /// Colour.
        role: Role,
    },
    /// Text near a point.
    Label {
        /// Point (x, y), or several candidates, the best first.
        at: Vec<(f64, f64)>,
        /// Text with markup.
        text: String,
        /// Colour.
        role: Role,
        /// Preferred side.
        side: PointSide,
    },
}

impl Mark {
    /// Straight line across the panel, with a text next to it.
    pub(crate) fn reference(
        direction: AxisDirection,
        at: f64,
        stroke: Stroke,
        label: impl Into<String>,
    ) -> Mark {
        Mark::Reference { direction, at, stroke, label: label.into() }
    }

    /// Thin dotted line.
    pub(crate) fn dotted(direction: AxisDirection, at: f64, label: impl Into<String>) -> Mark {
        Mark::reference(direction, at, Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted), label)
    }

    /// Band across the panel without a text.
    pub(crate) const fn band(direction: AxisDirection, [from, to]: [f64; 2], fill: Fill) -> Mark {
        Mark::Band { direction, from, to, fill, hatched: false, label: String::new() }
    }
}

/// Axis of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisDirection {
    /// Value of x: the mark is vertical.
    X,
    /// Value of y: the mark is horizontal.
    Y,
}

/// Side of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointSide {
    /// Above.
    Above,
    /// Below.
    Below,
    /// To the left.
    Left,
    /// To the right.
    Right,
    /// On the point itself, interrupting the objects below.
    On,
}

/// Pair of axes; x belongs to the plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Vertical axis.
    pub y: Axis,
    /// Height of the frame in view box units.
    pub height: f64,
    /// Marks, back to front.
    pub marks: Vec<Mark>,
    /// Names of its curves, in a row above the frame; empty if the legend of the plot has them.
    pub names: Vec<LegendEntry>,
}

impl Panel {
    /// Panel whose curves are named in the legend of the plot.
    pub const fn new(y: Axis, height: f64, marks: Vec<Mark>) -> Panel {
        Panel { y, height, marks, names: vec![] }
    }
}

/// Panels below each other on one x axis, with a legend at the bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Horizontal axis.
    pub x: Axis,
    /// Panels, top to bottom.
    pub panels: Vec<Panel>,
    /// Legend entries in order; empty for no legend.
    pub legend: Vec<LegendEntry>,
    /// True if one unit of x is as long as one of y (linear axes, one panel): the shorter axis is
    /// extended.
    pub equal_aspect: bool,
}

impl Plot {
    /// Draws the plot in the usual width.
    ///
    /// A label without a free position is omitted, so that nothing overlaps: any labelled value
    /// must also be in a table of the report.
    pub fn draw(&self) -> Scene {
        if self.equal_aspect { layout::draw(&layout::with_equal_aspect(self)) } else { layout::draw(self) }
    }
}
