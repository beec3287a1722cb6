//! Axes with panels that share x: curves, bands, reference lines, markers and labels that do not
//! overlap.

mod labels;
mod layout;
mod paint;

pub use super::marker::{Marker, MarkerStyle};

use super::axis::Axis;
use super::colour::Role;
use super::legend::LegendEntry;
use super::scene::{Dash, Fill, Scene, Stroke};

/// What a panel shows, in data coordinates, drawn in the order given.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A curve; points out of range or not a number interrupt it.
    Line {
        /// (x, y).
        points: Vec<(f64, f64)>,
        /// Line.
        stroke: Stroke,
    },
    /// Short strokes on the right-hand side of a line, seen along it: the side that is forbidden.
    Fringe {
        /// (x, y).
        points: Vec<(f64, f64)>,
        /// Strokes.
        stroke: Stroke,
    },
    /// Small dots; of several that would lie upon each other one is drawn.
    Dots {
        /// (x, y).
        points: Vec<(f64, f64)>,
        /// Colour.
        role: Role,
        /// Radius.
        radius: f64,
    },
    /// A closed area, cut at the frame.
    Area {
        /// (x, y) around it.
        corners: Vec<(f64, f64)>,
        /// Interior.
        fill: Fill,
    },
    /// Markers; those out of range are not drawn.
    Markers {
        /// (x, y) and a tooltip.
        points: Vec<(f64, f64, String)>,
        /// Form, colour, size.
        style: MarkerStyle,
    },
    /// A band across the panel.
    Band {
        /// The axis that `from` and `to` belong to.
        direction: AxisDirection,
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
        /// Interior.
        fill: Fill,
        /// Diagonal lines, for prints without colour.
        hatched: bool,
        /// Text inside; empty for none.
        label: String,
    },
    /// A straight line across the panel.
    Reference {
        /// The axis that `at` belongs to.
        direction: AxisDirection,
        /// Where.
        at: f64,
        /// Line.
        stroke: Stroke,
        /// Text next to it; empty for no text.
        label: String,
    },
    /// A text outside the frame on the right, level with a value of y: the name of a line that ends
    /// there.
    EdgeLabel {
        /// Value of y.
        at: f64,
        /// Text with markup.
        text: String,
        /// Colour.
        role: Role,
    },
    /// A text that belongs to a point, connected to it by a thin line where it is not next to it.
    Callout {
        /// (x, y) of the point, or of several to choose from.
        at: Vec<(f64, f64)>,
        /// Text with markup.
        text: String,
        /// Colour.
        role: Role,
    },
    /// A text near a point.
    Label {
        /// (x, y) of the point, or of several to choose from, the best first.
        at: Vec<(f64, f64)>,
        /// Text with markup.
        text: String,
        /// Colour.
        role: Role,
        /// The side tried first.
        side: PointSide,
    },
}

impl Mark {
    /// A straight line across the panel, with a text next to it.
    pub(crate) fn reference(
        direction: AxisDirection,
        at: f64,
        stroke: Stroke,
        label: impl Into<String>,
    ) -> Mark {
        Mark::Reference { direction, at, stroke, label: label.into() }
    }

    /// A thin dotted one.
    pub(crate) fn dotted(direction: AxisDirection, at: f64, label: impl Into<String>) -> Mark {
        Mark::reference(direction, at, Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dotted), label)
    }

    /// A band across the panel without a text.
    pub(crate) const fn band(direction: AxisDirection, [from, to]: [f64; 2], fill: Fill) -> Mark {
        Mark::Band { direction, from, to, fill, hatched: false, label: String::new() }
    }
}

/// Which axis a value belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisDirection {
    /// A value of x: the mark is upright.
    X,
    /// A value of y: the mark lies.
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
    /// On the point itself, interrupting what lies below.
    On,
}

/// One pair of axes; x belongs to the plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The upright axis.
    pub y: Axis,
    /// Height of the frame in view box units.
    pub height: f64,
    /// Back to front.
    pub marks: Vec<Mark>,
    /// What its curves are called, in a row above the frame; empty where the legend of the plot
    /// says it.
    pub names: Vec<LegendEntry>,
}

impl Panel {
    /// A panel whose curves the legend of the plot names.
    pub const fn new(y: Axis, height: f64, marks: Vec<Mark>) -> Panel {
        Panel { y, height, marks, names: vec![] }
    }
}

/// Panels below each other on one x axis, with a legend at the bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The lying axis.
    pub x: Axis,
    /// Top to bottom.
    pub panels: Vec<Panel>,
    /// Entries in order; none, no legend.
    pub legend: Vec<LegendEntry>,
    /// One unit of x is as long as one of y (linear axes, one panel): the shorter axis is extended.
    pub equal_aspect: bool,
}

impl Plot {
    /// Draws the plot in the usual width.
    ///
    /// A label that finds no free place is left out, so that nothing overlaps: whatever a figure
    /// labels must also be in a table of the report.
    pub fn draw(&self) -> Scene {
        if self.equal_aspect { layout::draw(&layout::with_equal_aspect(self)) } else { layout::draw(self) }
    }
}
