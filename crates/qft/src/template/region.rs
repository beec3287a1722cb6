//! The region that a template is known to fill, as a union of polygons in the plane of phase and
//! magnitude.
//!
//! Polygons are converted to integers (a step is 2^-26 of the template's extent) and united by
//! `i_overlay`, exactly and identically on every machine.

use std::collections::BTreeMap;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{IntOverlayOptions, Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::simplify::Simplify;
use i_overlay::i_float::int::point::IntPoint;
use i_overlay::i_shape::int::shape::{IntContour, IntShape, IntShapes};

use super::plants::PlantPosition;

/// A corner of an outline, and its plant if it is one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) place: PlantPosition,
    pub(super) plant: Option<usize>,
}

/// A union of polygons.
#[derive(Debug)]
pub(super) struct Region {
    origin: PlantPosition,
    /// Size of an integer step, degrees and dB.
    quantum: [f64; 2],
    shapes: IntShapes<i32>,
    /// Number of integer steps in a turn.
    turn: i64,
    /// Number of integer steps in a tolerance of phase and of magnitude.
    tolerance: [f64; 2],
    plants: BTreeMap<(i64, i32), usize>,
}

/// Extent of the first polygons, in integer steps.
const EXTENT: f64 = (1 << 26) as f64;

/// Largest coordinate of a place.
const LIMIT: f64 = (1 << 29) as f64;

/// Largest coordinate accepted by the union of polygons.
const FARTHEST: i32 = (1 << 30) - 1;

/// Smallest step below which a template counts as a line, in tolerances.
const STEP_MINIMUM: f64 = 1e-9;

/// Smallest area, as a fraction of the square of the extent, that is not a rounding error.
const AREA_MINIMUM: f64 = 1e-6;

/// Largest area of a region that counts as a line.
const LINE_AREA: f64 = AREA_MINIMUM * EXTENT * EXTENT;

impl Region {
    /// An empty region, with integers for positions from `low` to `high` and somewhat beyond.
    pub(super) fn new(low: PlantPosition, high: PlantPosition, tolerance: [f64; 2]) -> Region {
        let step =
            |low: f64, high: f64, tolerance: f64| ((high - low) / EXTENT).max(tolerance * STEP_MINIMUM);
        let turn = (360.0 / step(low.phase_deg, high.phase_deg, tolerance[0])).floor();
        let quantum = [360.0 / turn, step(low.magnitude_db, high.magnitude_db, tolerance[1])];
        Region {
            origin: PlantPosition {
                phase_deg: (low.phase_deg + high.phase_deg) / 2.0,
                magnitude_db: (low.magnitude_db + high.magnitude_db) / 2.0,
            },
            quantum,
            shapes: vec![],
            turn: turn as i64,
            tolerance: [tolerance[0] / quantum[0], tolerance[1] / quantum[1]],
            plants: BTreeMap::new(),
        }
    }

    fn point(&self, place: PlantPosition) -> Option<IntPoint<i32>> {
        let x = ((place.phase_deg - self.origin.phase_deg) / self.quantum[0]).round();
        let y = ((place.magnitude_db - self.origin.magnitude_db) / self.quantum[1]).round();
        (x.abs() <= LIMIT && y.abs() <= LIMIT).then(|| IntPoint::new(x as i32, y as i32))
    }

    fn place(&self, point: IntPoint<i32>) -> PlantPosition {
        PlantPosition {
            phase_deg: self.origin.phase_deg + f64::from(point.x) * self.quantum[0],
            magnitude_db: self.origin.magnitude_db + f64::from(point.y) * self.quantum[1],
        }
    }

    /// Adds the regions that closed walks enclose.
    pub(super) fn fill(&mut self, walks: &[Vec<(PlantPosition, usize)>]) {
        let mut contours: Vec<IntContour<i32>> =
            std::mem::take(&mut self.shapes).into_iter().flatten().collect();
        for walk in walks {
            let points: Option<Vec<_>> = walk.iter().map(|&(place, _)| self.point(place)).collect();
            let Some(points) = points else { continue };
            for (&point, &(_, plant)) in points.iter().zip(walk) {
                self.plants.entry(self.key_of(point)).or_insert(plant);
            }
            let once = points.simplify(FillRule::NonZero, IntOverlayOptions::keep_all_points());
            contours.extend(once.into_iter().flatten());
        }
        // as thin as rounding errors: a line, whose many overlapping contours take long to unite
        if contours.iter().map(area).sum::<f64>() <= LINE_AREA {
            self.shapes = contours.into_iter().map(|contour| vec![contour]).collect();
            return;
        }
        self.shapes = united(&contours);
        for shape in &mut self.shapes {
            let mut outer = true;
            shape.retain(|contour| std::mem::take(&mut outer) || !is_narrow(contour, self.tolerance));
        }
    }

    /// True if the region consists of more than lines.
    pub(super) fn has_area(&self) -> bool {
        self.shapes.iter().flatten().map(area).sum::<f64>() > LINE_AREA
    }

    /// Identifies a position independent of the number of turns.
    pub(super) fn key(&self, place: PlantPosition) -> Option<(i64, i32)> {
        self.point(place).map(|point| self.key_of(point))
    }

    fn key_of(&self, point: IntPoint<i32>) -> (i64, i32) {
        (i64::from(point.x).rem_euclid(self.turn), point.y)
    }

    /// All contours, outer ones and holes, each with the region on its left.
    pub(super) fn contours(&self) -> Vec<Vec<Corner>> {
        self.shapes.iter().flatten().map(|contour| self.corners(contour)).collect()
    }

    fn corners(&self, contour: &IntContour<i32>) -> Vec<Corner> {
        let corner = |&point: &IntPoint<i32>| Corner {
            place: self.place(point),
            plant: self.plants.get(&self.key_of(point)).copied(),
        };
        contour.iter().map(corner).collect()
    }

    /// Polygons without holes that make up the region, phases taken modulo a turn.
    pub(super) fn pieces(&self) -> Vec<Vec<Corner>> {
        let mut pending = self.within_a_turn();
        let mut pieces = vec![];
        while let Some(shape) = pending.pop() {
            match middle_of_hole(&shape) {
                Some(at) => {
                    pending.extend(part(&shape, -FARTHEST, at));
                    pending.extend(part(&shape, at, FARTHEST));
                }
                None => pieces.extend(shape.first().map(|contour| self.corners(contour))),
            }
        }
        pieces
    }

    /// The region itself if it is no wider than a turn; otherwise the part beyond a turn is mapped
    /// onto the rest.
    fn within_a_turn(&self) -> IntShapes<i32> {
        let ends = |choose: fn(i32, i32) -> i32| {
            self.shapes.iter().flatten().flatten().map(|point| point.x).reduce(choose)
        };
        let (Some(left), Some(right)) = (ends(i32::min), ends(i32::max)) else { return vec![] };
        let width = i64::from(right) - i64::from(left);
        let Ok(turn) = i32::try_from(self.turn) else { return self.shapes.clone() };
        if width <= self.turn {
            return self.shapes.clone();
        }
        let mut contours: Vec<IntContour<i32>> = vec![];
        let mut start = left;
        while start < right {
            let back = start - left;
            let parts = self.shapes.iter().flat_map(|shape| part(shape, start, start.saturating_add(turn)));
            let moved = |contour: IntContour<i32>| {
                contour.into_iter().map(|point| IntPoint::new(point.x - back, point.y)).collect()
            };
            contours.extend(parts.flatten().map(moved));
            start = start.saturating_add(turn);
        }
        united(&contours)
    }
}

/// The union of shapes given by their contours, outer ones and holes.
fn united(contours: &[IntContour<i32>]) -> IntShapes<i32> {
    let corners = contours.iter().map(Vec::len).sum();
    let mut overlay = Overlay::new_custom(corners, IntOverlayOptions::keep_all_points(), Default::default());
    overlay.add_source(contours, ShapeType::Subject);
    let mut shapes = overlay.overlay(OverlayRule::Subject, FillRule::Positive);
    shapes.retain(|shape| shape.first().is_some_and(|outer| area(outer) > AREA_MINIMUM * EXTENT));
    shapes
}

/// True if no place of a hole is more than half a tolerance away from its rim, because it is small
/// or thin.
fn is_narrow(hole: &IntContour<i32>, tolerance: [f64; 2]) -> bool {
    let extent = |coordinate: fn(&IntPoint<i32>) -> i32| {
        let low = hole.iter().map(coordinate).min().unwrap_or(0);
        let high = hole.iter().map(coordinate).max().unwrap_or(0);
        f64::from(high) - f64::from(low)
    };
    let disc = std::f64::consts::PI / 4.0 * tolerance[0] * tolerance[1];
    extent(|point| point.x) < tolerance[0]
        || extent(|point| point.y) < tolerance[1]
        || area(hole).abs() < disc
}

/// A phase that cuts the first hole of a shape in two.
fn middle_of_hole(shape: &IntShape<i32>) -> Option<i32> {
    let hole = shape.get(1)?;
    let left = hole.iter().map(|point| point.x).min()?;
    let right = hole.iter().map(|point| point.x).max()?;
    (right - left > 1).then(|| left + (right - left) / 2)
}

/// The part of a shape between two phases.
fn part(shape: &IntShape<i32>, left: i32, right: i32) -> IntShapes<i32> {
    let window = [(left, -FARTHEST), (right, -FARTHEST), (right, FARTHEST), (left, FARTHEST)];
    let window = window.map(|(x, y)| IntPoint::new(x, y));
    let mut overlay =
        Overlay::new_custom(shape.len(), IntOverlayOptions::keep_all_points(), Default::default());
    overlay.add_source(shape, ShapeType::Subject);
    overlay.add_contour(&window, ShapeType::Clip);
    overlay.overlay(OverlayRule::Intersect, FillRule::NonZero)
}

/// Signed area, positive for an outer contour.
fn area(contour: &IntContour<i32>) -> f64 {
    let next = contour.iter().cycle().skip(1);
    let cross = |(a, b): (&IntPoint<i32>, &IntPoint<i32>)| {
        f64::from(a.x) * f64::from(b.y) - f64::from(a.y) * f64::from(b.x)
    };
    contour.iter().zip(next).map(cross).sum::<f64>() / 2.0
}
