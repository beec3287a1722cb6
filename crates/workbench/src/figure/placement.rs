//! Where labels go: the first free place among candidates, away from curves where that can be had.

use super::scene::{Point, Rectangle};

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

    /// Curves and markers beneath a label; one curve counts once per piece, so a curve along the label costs more.
    fn cost(&self, candidate: &Rectangle) -> usize {
        let markers = self.obstacles.iter().filter(|o| o.overlaps(candidate)).count();
        let pieces =
            self.segments.iter().filter(|(a, b)| super::clip::segment(*a, *b, candidate).is_some()).count();
        20 * markers + pieces
    }
}
