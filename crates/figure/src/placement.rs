//! Where labels go: the first free place among candidates, away from curves if possible.

use phea_dynamics::portable::hypot;

use super::scene::{Point, Rectangle};

/// Width of a letter, roughly.
const LETTER: f64 = 8.0;
/// Least distance between two texts.
const APART: f64 = 1.5;
/// Distance below which two texts are read as one.
const CROWDED: f64 = 6.0;

/// A place for a label, with the line that leads to its point where one is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Led {
    /// What the text names.
    pub point: Point,
    /// The text.
    pub bounds: Rectangle,
    /// From the point to the text.
    pub line: Option<(Point, Point)>,
}

/// True when two pieces cross within both.
fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let side = |p: Point, q: Point, r: Point| (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// From a point to the nearest edge of a text.
fn distance(point: Point, bounds: &Rectangle) -> f64 {
    let nearest = (point.x.clamp(bounds.left, bounds.right), point.y.clamp(bounds.top, bounds.bottom));
    hypot(point.x - nearest.0, point.y - nearest.1)
}

/// A piece of a curve.
#[derive(Clone, Copy, Debug)]
struct CurvePiece {
    from: Point,
    to: Point,
    width: f64,
}

/// What is taken already.
#[derive(Clone, Debug, Default)]
pub struct Occupancy {
    texts: Vec<Rectangle>,
    segments: Vec<CurvePiece>,
    /// Solid things a label must not hide, markers above all.
    obstacles: Vec<Rectangle>,
    /// Lines from points to their labels.
    leads: Vec<(Point, Point)>,
}

impl Occupancy {
    /// A text that nothing may overlap.
    pub fn add_text(&mut self, bounds: Rectangle) {
        self.texts.push(bounds);
    }

    /// A thing to keep away from.
    pub(crate) fn add_obstacle(&mut self, bounds: Rectangle) {
        self.obstacles.push(bounds);
    }

    /// A curve of some width to keep away from.
    pub(crate) fn add_polyline(&mut self, points: &[Point], width: f64) {
        let piece = |pair: &[Point]| Some(CurvePiece { from: *pair.first()?, to: *pair.get(1)?, width });
        self.segments.extend(points.windows(2).filter_map(piece));
    }

    /// A line from a point to its label, which no other such label or line may cross.
    pub(crate) fn add_lead(&mut self, from: Point, to: Point) {
        self.leads.push((from, to));
    }

    /// The index of the best candidate inside `frame`: free of texts, then with the least of curves
    /// and markers beneath it and of texts close to it, then the earliest. `None` when every
    /// candidate leaves the frame or covers a text.
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

    /// Like [`Occupancy::choose`] for labels that may be led to their point by a line: a line
    /// crosses no text and no other such line, and its length counts against a place as much as the
    /// curves that label and line lie upon.
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

    /// The penalty of a label that lies nearer to other markers than to the point it names.
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

    /// A line's length in letters, and the strokes that it crosses.
    fn lead_cost(&self, from: Point, to: Point) -> f64 {
        let crossed = self.segments.iter().filter(|piece| cross(from, to, piece.from, piece.to));
        hypot(to.x - from.x, to.y - from.y) / LETTER + crossed.map(|piece| 2.0 * piece.width).sum::<f64>()
    }

    /// What lies beneath a label, namely markers and curves by their length in letters and their
    /// width, and the texts close to it. A label that touches a curve at all is hard to read, so
    /// that a short line to a free place costs less.
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
