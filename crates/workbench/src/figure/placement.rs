//! Where labels go: the first free place among candidates, away from curves where that can be had.

use super::scene::{Point, Rectangle};

/// A place for a label, with the line that leads to its point where one is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Led {
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

/// What is taken already.
#[derive(Clone, Debug, Default)]
pub struct Occupancy {
    texts: Vec<Rectangle>,
    segments: Vec<(Point, Point)>,
    /// Solid things a label must not hide, markers above all.
    obstacles: Vec<Rectangle>,
}

impl Occupancy {
    /// A text that nothing may overlap.
    pub fn add_text(&mut self, bounds: Rectangle) {
        self.texts.push(bounds);
    }

    /// A thing to keep away from.
    pub fn add_obstacle(&mut self, bounds: Rectangle) {
        self.obstacles.push(bounds);
    }

    /// A curve to keep away from.
    pub fn add_polyline(&mut self, points: &[Point]) {
        self.segments.extend(points.windows(2).filter_map(|pair| Some((*pair.first()?, *pair.get(1)?))));
    }

    /// The index of the best candidate inside `frame`: free of texts, then with the fewest curves and markers beneath
    /// it, then the earliest. `None` when every candidate leaves the frame or covers a text.
    pub fn choose(&self, candidates: &[Rectangle], frame: &Rectangle) -> Option<usize> {
        let mut best: Option<(usize, usize)> = None;
        for (index, candidate) in candidates.iter().enumerate() {
            let spaced = candidate.grown(1.5);
            if !frame.contains(candidate) || self.texts.iter().any(|text| text.overlaps(&spaced)) {
                continue;
            }
            let cost = self.cost(candidate);
            if cost == 0 {
                return Some(index);
            }
            if best.is_none_or(|(_, least)| cost < least) {
                best = Some((index, cost));
            }
        }
        best.map(|(index, _)| index)
    }

    /// Like [`Occupancy::choose`] for labels that may be led to their point by a line: a line crosses no text, and its length
    /// counts against a place as much as the curves that label and line lie upon.
    pub fn choose_led(&self, candidates: &[Led], frame: &Rectangle) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for (index, Led { bounds, line }) in candidates.iter().enumerate() {
            let spaced = bounds.grown(1.5);
            let is_hit = |text: &Rectangle| {
                text.overlaps(&spaced)
                    || line.is_some_and(|(from, to)| super::clip::segment(from, to, text).is_some())
            };
            if !frame.contains(bounds) || self.texts.iter().any(is_hit) {
                continue;
            }
            let (crossings, length) = line.map_or((0, 0.0), |(from, to)| {
                let crossed = self.segments.iter().filter(|(a, b)| cross(from, to, *a, *b));
                (crossed.count(), phea_dynamics::portable::hypot(to.x - from.x, to.y - from.y))
            });
            let cost = (self.cost(bounds) + 2 * crossings) as f64 + length / 6.0;
            if best.is_none_or(|(_, least)| cost < least) {
                best = Some((index, cost));
            }
        }
        best.map(|(index, _)| index)
    }

    /// Curves and markers beneath a label; one curve counts once per piece, so a curve along the label costs more.
    fn cost(&self, candidate: &Rectangle) -> usize {
        let markers = self.obstacles.iter().filter(|o| o.overlaps(candidate)).count();
        let pieces =
            self.segments.iter().filter(|(a, b)| super::clip::segment(*a, *b, candidate).is_some()).count();
        20 * markers + pieces
    }
}
