//! Picture as a list of primitives that name roles for their colours.
//!
//! Coordinates are those of the view box: x to the right, y down. Geometry that leaves its frame is
//! cut before it enters a scene ([`clip`](crate::clip)), so no clip paths and no identifiers are
//! needed, and several figures can be on one page.

use super::colour::Role;

/// Point of the view box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Coordinate to the right.
    pub x: f64,
    /// Coordinate downwards.
    pub y: f64,
}

/// Shorthand for a [`Point`].
pub const fn point(x: f64, y: f64) -> Point {
    Point { x, y }
}

/// Rectangle with its sides along the axes; `left <= right` and `top <= bottom`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Smallest x.
    pub left: f64,
    /// Smallest y.
    pub top: f64,
    /// Largest x.
    pub right: f64,
    /// Largest y.
    pub bottom: f64,
}

impl Rectangle {
    /// Rectangle from two opposite corners in any order.
    pub(crate) fn from_corners(a: Point, b: Point) -> Self {
        Rectangle { left: a.x.min(b.x), top: a.y.min(b.y), right: a.x.max(b.x), bottom: a.y.max(b.y) }
    }

    /// Extent in x.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Extent in y.
    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Midpoint.
    pub fn centre(&self) -> Point {
        point(0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom))
    }

    /// Rectangle enlarged by `margin` on each side (reduced by a negative one).
    pub fn grown(&self, margin: f64) -> Self {
        Rectangle {
            left: self.left - margin,
            top: self.top - margin,
            right: self.right + margin,
            bottom: self.bottom + margin,
        }
    }

    /// True if the interiors intersect.
    pub fn overlaps(&self, other: &Rectangle) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// True if `other` is inside or on the border.
    pub fn contains(&self, other: &Rectangle) -> bool {
        self.left <= other.left
            && self.top <= other.top
            && self.right >= other.right
            && self.bottom >= other.bottom
    }

    /// True if the point is inside or on the border.
    pub fn contains_point(&self, p: Point) -> bool {
        p.x >= self.left && p.x <= self.right && p.y >= self.top && p.y <= self.bottom
    }
}

/// Dash pattern: series stay distinguishable in a grey print.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    Solid,
    /// Dashes.
    Dashed,
    /// Dash and dot.
    DashDot,
    /// Dots.
    Dotted,
    /// Long dashes.
    LongDash,
    /// Dash and two dots.
    DashDotDot,
    /// Short dashes with short gaps.
    ShortDash,
    /// A long and a short dash.
    LongShort,
}

impl Dash {
    /// Lengths of strokes and gaps; empty for a solid line.
    pub const fn lengths(self) -> &'static [f64] {
        match self {
            Dash::Solid => &[],
            Dash::Dashed => &[6.0, 3.5],
            Dash::DashDot => &[8.0, 3.0, 1.8, 3.0],
            Dash::Dotted => &[1.8, 2.6],
            Dash::LongDash => &[12.0, 4.0],
            Dash::DashDotDot => &[8.0, 2.6, 1.8, 2.6, 1.8, 2.6],
            Dash::ShortDash => &[3.2, 3.2],
            Dash::LongShort => &[13.0, 3.0, 4.5, 3.0],
        }
    }
}

/// Style of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Colour by role.
    pub role: Role,
    /// Width in view box units.
    pub width: f64,
    /// Dash pattern.
    pub dash: Dash,
}

impl Stroke {
    /// Solid line.
    pub const fn solid(role: Role, width: f64) -> Self {
        Stroke { role, width, dash: Dash::Solid }
    }

    /// Stroke with another dash pattern.
    pub const fn dashed(self, dash: Dash) -> Self {
        Stroke { dash, ..self }
    }
}

/// Style of an interior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fill {
    /// Colour by role.
    pub role: Role,
    /// Opacity: 1 covers, less lets the background through.
    pub opacity: f64,
}

impl Fill {
    /// Opaque.
    pub const fn solid(role: Role) -> Self {
        Fill { role, opacity: 1.0 }
    }

    /// Tint for areas behind curves and text.
    pub(crate) const fn tint(role: Role) -> Self {
        Fill { role, opacity: 0.14 }
    }
}

/// Step of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathStep {
    /// Beginning of a new run.
    Move(Point),
    /// Straight line to a point.
    Line(Point),
    /// Cubic Bezier curve with two control points.
    Curve(Point, Point, Point),
    /// Straight line back to the beginning of the run.
    Close,
}

/// Geometry of a primitive.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Runs of straight and curved pieces.
    Path(Vec<PathStep>),
    /// Rectangle, with a corner radius.
    Rectangle(Rectangle, f64),
    /// Circle by centre and radius.
    Circle(Point, f64),
}

/// Horizontal anchor of a text (before rotation).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Beginning of the text.
    Start,
    /// Middle of the text.
    Middle,
    /// End of the text.
    End,
}

/// Vertical anchor of a text (before rotation).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Baseline {
    /// Baseline of the letters.
    Letters,
    /// Half the height of a capital.
    Middle,
    /// Top of a capital.
    Top,
}

/// Line of text; [`typeset`](crate::typeset) explains its markup.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Point to which anchor and baseline refer.
    pub position: Point,
    /// Text with sub- and superscripts, such as `K_H (10^6 N/m)`.
    pub content: String,
    /// Font size in view box units.
    pub size: f64,
    /// Horizontal anchor.
    pub anchor: Anchor,
    /// Vertical anchor.
    pub baseline: Baseline,
    /// Clockwise rotation about the position, degrees.
    pub rotation_degrees: f64,
    /// Colour by role.
    pub role: Role,
    /// True for a background outline, which keeps the text legible over lines.
    pub halo: bool,
}

impl Text {
    /// Text in the ordinary colour, anchored at its start on the baseline of its letters.
    pub fn new(position: Point, content: impl Into<String>, size: f64) -> Self {
        Text {
            position,
            content: content.into(),
            size,
            anchor: Anchor::Start,
            baseline: Baseline::Letters,
            rotation_degrees: 0.0,
            role: Role::Text,
            halo: false,
        }
    }

    /// Text with other anchors.
    pub fn held(self, anchor: Anchor, baseline: Baseline) -> Self {
        Text { anchor, baseline, ..self }
    }

    /// Text with another colour.
    pub fn coloured(self, role: Role) -> Self {
        Text { role, ..self }
    }

    /// Text with a background outline.
    pub(crate) fn with_halo(self) -> Self {
        Text { halo: true, ..self }
    }

    /// Text rotated clockwise about its position.
    pub fn rotated(self, degrees: f64) -> Self {
        Text { rotation_degrees: degrees, ..self }
    }
}

/// Primitive with its paint.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// Shape; a browser shows `note` when the pointer is on it.
    Drawing {
        /// Geometry.
        shape: Shape,
        /// Outline.
        stroke: Option<Stroke>,
        /// Interior.
        fill: Option<Fill>,
        /// Text of a tooltip, without markup.
        note: Option<String>,
    },
    /// Text.
    Text(Text),
}

/// Picture: the size of its view box and its items from back to front.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Width of the view box.
    pub width: f64,
    /// Height of the view box.
    pub height: f64,
    /// Items, back to front.
    pub items: Vec<Item>,
}

impl Scene {
    /// Empty picture.
    pub fn new(width: f64, height: f64) -> Self {
        Scene { width, height, items: Vec::new() }
    }

    /// Adds a shape.
    pub fn shape(&mut self, shape: Shape, stroke: Option<Stroke>, fill: Option<Fill>) {
        self.items.push(Item::Drawing { shape, stroke, fill, note: None });
    }

    /// Adds a straight line.
    pub fn line(&mut self, from: Point, to: Point, stroke: Stroke) {
        self.polyline(&[from, to], stroke);
    }

    /// Adds straight pieces through the points.
    pub fn polyline(&mut self, points: &[Point], stroke: Stroke) {
        self.shape(Shape::Path(run(points, false)), Some(stroke), None);
    }

    /// Adds a closed polygon.
    pub fn polygon(&mut self, points: &[Point], stroke: Option<Stroke>, fill: Option<Fill>) {
        self.shape(Shape::Path(run(points, true)), stroke, fill);
    }

    /// Adds a rectangle.
    pub(crate) fn rectangle(&mut self, rectangle: Rectangle, stroke: Option<Stroke>, fill: Option<Fill>) {
        self.shape(Shape::Rectangle(rectangle, 0.0), stroke, fill);
    }

    /// Adds a circle.
    pub fn circle(&mut self, centre: Point, radius: f64, stroke: Option<Stroke>, fill: Option<Fill>) {
        self.shape(Shape::Circle(centre, radius), stroke, fill);
    }

    /// Adds a text.
    pub fn text(&mut self, text: Text) {
        if !text.content.is_empty() {
            self.items.push(Item::Text(text));
        }
    }

    /// Texts from back to front.
    pub fn texts(&self) -> impl Iterator<Item = &Text> {
        self.items.iter().filter_map(|item| match item {
            Item::Text(text) => Some(text),
            Item::Drawing { .. } => None,
        })
    }
}

/// Path steps through the points.
pub fn run(points: &[Point], closed: bool) -> Vec<PathStep> {
    let mut steps: Vec<PathStep> = points
        .iter()
        .enumerate()
        .map(|(index, &p)| if index == 0 { PathStep::Move(p) } else { PathStep::Line(p) })
        .collect();
    if closed && !steps.is_empty() {
        steps.push(PathStep::Close);
    }
    steps
}
