//! Placement of labels: the first free position among candidates, away from curves if possible.

use phea_dynamics::portable::hypot;

use super::scene::{Point, Rectangle};

/// Approximate width of a letter.
const LETTER: f64 = 8.0;
/// Least distance between two texts.
const APART: f64 = 1.5;
/// Distance below which two texts are read as one.
const CROWDED: f64 = 6.0;

/// Position of a label, with a leader line to its point if one is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Led {
    /// Point that the text names.
    pub point: Point,
    /// Bounds of the text.
    pub bounds: Rectangle,
    /// Leader line from the point to the text.
    pub line: Option<(Point, Point)>,
}

/// True if two pieces cross within both.
fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let side = |p: Point, q: Point, r: Point| (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// Distance from a point to the nearest edge of a text.
fn distance(point: Point, bounds: &Rectangle) -> f64 {
    let nearest = (point.x.clamp(bounds.left, bounds.right), point.y.clamp(bounds.top, bounds.bottom));
    hypot(point.x - nearest.0, point.y - nearest.1)
}

/// Piece of a curve.
#[derive(Clone, Copy, Debug)]
struct CurvePiece {
    from: Point,
    to: Point,
    width: f64,
}

/// Occupied areas of a figure.
#[derive(Clone, Debug, Default)]
pub struct Occupancy {
    texts: Vec<Rectangle>,
    segments: Vec<CurvePiece>,
    /// Solid objects that a label must not hide, markers above all.
    obstacles: Vec<Rectangle>,
    /// Leader lines from points to their labels.
    leads: Vec<(Point, Point)>,
}

impl Occupancy {
    /// Adds a text that no label may overlap.
    pub fn add_text(&mut self, bounds: Rectangle) {
        self.texts.push(bounds);
    }

    /// Adds an object that labels should avoid.
    pub(crate) fn add_obstacle(&mut self, bounds: Rectangle) {
        self.obstacles.push(bounds);
    }

    /// Adds a curve of some width that labels should avoid.
    pub(crate) fn add_polyline(&mut self, points: &[Point], width: f64) {
        let piece = |pair: &[Point]| Some(CurvePiece { from: *pair.first()?, to: *pair.get(1)?, width });
        self.segments.extend(points.windows(2).filter_map(piece));
    }

    /// Adds a leader line, which no other label or leader line may cross.
    pub(crate) fn add_lead(&mut self, from: Point, to: Point) {
        self.leads.push((from, to));
    }

    /// Index of the best candidate inside `frame`: free of texts, then with the least curves and
    /// markers beneath it and texts close to it, then the earliest. `None` if every candidate
    /// leaves the frame or covers a text.
    pub fn choose(&self, candidates: &[Rectangle], frame: &Rectangle) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for (index, candidate) in candidates.iter().enumerate() {
            let spaced = candidate.grown(APART);
            if !frame.contains(candidate) || self.texts.iter().any(|text| text.overlaps(&spaced)) {
                continue;
            }
            let cost = self.weight(candidate);
            if cost == 0.0 {
                return Some(index);
            }
            if best.is_none_or(|(_, least)| cost < least) {
                best = Some((index, cost));
            }
        }
        best.map(|(index, _)| index)
    }

    /// Best candidate as in [`Occupancy::choose`], for labels that may have a leader line to their
    /// point: the line crosses no text and no other leader line, and its length is penalised like
    /// the curves under label and line.
    pub(crate) fn choose_led(&self, candidates: &[Led], frame: &Rectangle) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for (index, Led { point, bounds, line }) in candidates.iter().enumerate() {
            let spaced = bounds.grown(APART);
            let is_hit = |text: &Rectangle| {
                text.overlaps(&spaced)
                    || line.is_some_and(|(from, to)| super::clip::segment(from, to, text).is_some())
            };
            let is_crossed = |(a, b): &(Point, Point)| {
                super::clip::segment(*a, *b, &spaced).is_some()
                    || line.is_some_and(|(from, to)| cross(from, to, *a, *b))
            };
            let is_taken = self.texts.iter().any(is_hit) || self.leads.iter().any(is_crossed);
            if !frame.contains(bounds) || is_taken {
                continue;
            }
            let lead = line.map_or(0.0, |(from, to)| self.lead_cost(from, to));
            let cost = lead + self.weight(bounds) + self.ambiguity(*point, bounds);
            if best.is_none_or(|(_, least)| cost < least) {
                best = Some((index, cost));
            }
        }
        best.map(|(index, _)| index)
    }

    /// Penalty of a label that is nearer to other markers than to its point.
    fn ambiguity(&self, point: Point, bounds: &Rectangle) -> f64 {
        const COST: f64 = 6.0;
        let own = distance(point, bounds);
        let nearer = |marker: &&Rectangle| {
            let centre =
                Point { x: (marker.left + marker.right) / 2.0, y: (marker.top + marker.bottom) / 2.0 };
            distance(centre, bounds) < own - 0.5
        };
        COST * self.obstacles.iter().filter(nearer).count() as f64
    }

    /// Cost of a leader line: its length in letters, and the strokes that it crosses.
    fn lead_cost(&self, from: Point, to: Point) -> f64 {
        let crossed = self.segments.iter().filter(|piece| cross(from, to, piece.from, piece.to));
        hypot(to.x - from.x, to.y - from.y) / LETTER + crossed.map(|piece| 2.0 * piece.width).sum::<f64>()
    }

    /// Weight of the objects beneath a label (markers and curves by their length in letters and
    /// their width), and of the texts close to it. A label that touches a curve at all is hard to
    /// read, so that a short line to a free position costs less.
    fn weight(&self, bounds: &Rectangle) -> f64 {
        const MARKER: f64 = 20.0;
        const TOUCHED: f64 = 6.0;
        const CLOSE: f64 = 4.0;
        let markers = self.obstacles.iter().filter(|o| o.overlaps(bounds)).count();
        let hidden: f64 = self
            .segments
            .iter()
            .filter_map(|piece| {
                let (a, b) = super::clip::segment(piece.from, piece.to, bounds)?;
                Some(piece.width * hypot(b.x - a.x, b.y - a.y) / LETTER)
            })
            .sum();
        let touched = if hidden > 0.0 { TOUCHED } else { 0.0 };
        let around = bounds.grown(CROWDED);
        let close = self.texts.iter().filter(|text| text.overlaps(&around)).count();
        MARKER * markers as f64 + touched + hidden + CLOSE * close as f64
    }
}
