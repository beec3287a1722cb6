//! Labels of marks, each at the first free position that suits its kind.

use phea_dynamics::portable::hypot;

use super::super::colour::Role;
use super::super::placement::{Led, Occupancy};
use super::super::scene::{Anchor, Baseline, Point, Rectangle, Scene, Stroke, Text, point};
use super::super::{LABEL_SIZE, WIDTH, typeset};
use super::layout::{EDGE_GAP, Placed};
use super::paint::{band_area, reference_line};
use super::{AxisDirection, Mark, PointSide};

const ROW: f64 = 17.0;
const CLEAR: f64 = 5.0;

type LabelHold = (Point, Anchor, Baseline);

pub(super) fn draw(scene: &mut Scene, placed: &Placed<'_>, marks: &[Mark], occupancy: &mut Occupancy) {
    for mark in marks {
        let (text, role, holds) = match mark {
            Mark::Reference { direction, at, stroke, label } if !label.is_empty() => {
                let Some((from, to)) = reference_line(placed, *direction, *at) else { continue };
                (label, legible(stroke.role), beside_line(from, to, placed.frame))
            }
            Mark::Band { direction, from, to, fill, label, .. } if !label.is_empty() => {
                let Some(area) = band_area(placed, *direction, *from, *to) else { continue };
                (label, legible(fill.role), inside_band(area, *direction, placed.frame))
            }
            Mark::Label { at, text, role, side } => {
                let points = at.iter().map(|(x, y)| placed.at(*x, *y));
                let visible = points.filter(|p| placed.frame.contains_point(*p));
                (text, *role, visible.flat_map(|p| around(p, *side)).collect())
            }
            Mark::Callout { at, text, role } => {
                let points = at.iter().map(|(x, y)| placed.at(*x, *y));
                let visible: Vec<Point> = points.filter(|p| placed.frame.contains_point(*p)).collect();
                call_out(scene, occupancy, placed.frame, text, *role, &visible);
                continue;
            }
            _ => continue,
        };
        place(scene, occupancy, placed.frame, text, role, &holds);
    }
}

/// Names of lines that end at the right side; a name that would touch one above is omitted.
pub(super) fn draw_at_edge(scene: &mut Scene, placed: &Placed<'_>, marks: &[Mark]) {
    let limit = WIDTH - placed.frame.right - EDGE_GAP - 2.0;
    let mut texts: Vec<Text> = marks
        .iter()
        .filter_map(|mark| {
            let Mark::EdgeLabel { at, text, role } = mark else { return None };
            let y = placed.y_at(*at);
            let inside = y >= placed.frame.top && y <= placed.frame.bottom;
            let content = typeset::fitted(text, LABEL_SIZE, limit);
            let text = Text::new(point(placed.frame.right + EDGE_GAP, y), content, LABEL_SIZE);
            inside.then(|| text.held(Anchor::Start, Baseline::Middle).coloured(legible(*role)))
        })
        .collect();
    texts.sort_by(|a, b| a.position.y.total_cmp(&b.position.y));
    let mut end = f64::NEG_INFINITY;
    for text in texts {
        let bounds = text.bounds();
        if bounds.top > end {
            end = bounds.bottom;
            scene.text(text);
        }
    }
}

/// Legible role: series colours are for lines; as text only roles with sufficient contrast are
/// used.
fn legible(role: Role) -> Role {
    match role {
        Role::Text | Role::Muted | Role::Accent | Role::Good | Role::Warning | Role::Bad => role,
        _ => Role::Text,
    }
}

fn place(
    scene: &mut Scene,
    occupancy: &mut Occupancy,
    frame: Rectangle,
    text: &str,
    role: Role,
    holds: &[LabelHold],
) {
    let texts: Vec<Text> = holds
        .iter()
        .map(|&(at, anchor, baseline)| {
            Text::new(at, text, LABEL_SIZE).held(anchor, baseline).coloured(legible(role)).with_halo()
        })
        .collect();
    let bounds: Vec<Rectangle> = texts.iter().map(Text::bounds).collect();
    let Some(index) = occupancy.choose(&bounds, &frame.grown(-2.0)) else { return };
    if let (Some(text), Some(bounds)) = (texts.get(index), bounds.get(index)) {
        occupancy.add_text(*bounds);
        scene.text(text.clone());
    }
}

/// Largest distance of a text from its point without a line.
const BESIDE: f64 = 10.0;

/// Text next to one of the points, or farther away at the end of a line.
fn call_out(
    scene: &mut Scene,
    occupancy: &mut Occupancy,
    frame: Rectangle,
    text: &str,
    role: Role,
    points: &[Point],
) {
    let mut texts = Vec::new();
    let mut candidates = Vec::new();
    for &from in points {
        for away in [9.0, 16.0, 26.0, 38.0, 52.0, 70.0] {
            for (at, anchor, baseline) in directions(from, away) {
                let label = Text::new(at, text, LABEL_SIZE).held(anchor, baseline);
                let bounds = label.bounds();
                let to =
                    point(from.x.clamp(bounds.left, bounds.right), from.y.clamp(bounds.top, bounds.bottom));
                let line = (away > BESIDE).then(|| (beside(from, to), to));
                candidates.push(Led { point: from, bounds, line });
                texts.push(label.coloured(legible(role)).with_halo());
            }
        }
    }
    let Some(index) = occupancy.choose_led(&candidates, &frame.grown(-2.0)) else { return };
    if let (Some(text), Some(Led { bounds, line, .. })) = (texts.get(index), candidates.get(index)) {
        if let Some((from, to)) = *line {
            scene.line(from, to, Stroke::solid(legible(role), 0.8));
            occupancy.add_lead(from, to);
        }
        occupancy.add_text(*bounds);
        scene.text(text.clone());
    }
}

/// Point at which a line towards a text leaves the marker.
fn beside(from: Point, to: Point) -> Point {
    const MARKER: f64 = 5.0;
    let length = hypot(to.x - from.x, to.y - from.y).max(MARKER);
    point(from.x + MARKER / length * (to.x - from.x), from.y + MARKER / length * (to.y - from.y))
}

/// Candidates in eight directions from a point, sideways first.
fn directions(at: Point, away: f64) -> [LabelHold; 8] {
    let (right, left) = (at.x + away, at.x - away);
    let slant = 0.75 * away;
    [
        (point(right, at.y), Anchor::Start, Baseline::Middle),
        (point(left, at.y), Anchor::End, Baseline::Middle),
        (point(at.x + slant, at.y - slant), Anchor::Start, Baseline::Letters),
        (point(at.x + slant, at.y + slant), Anchor::Start, Baseline::Top),
        (point(at.x - slant, at.y - slant), Anchor::End, Baseline::Letters),
        (point(at.x - slant, at.y + slant), Anchor::End, Baseline::Top),
        (point(at.x, at.y - away), Anchor::Middle, Baseline::Letters),
        (point(at.x, at.y + away), Anchor::Middle, Baseline::Top),
    ]
}

fn rows(top: f64, bottom: f64) -> impl Iterator<Item = f64> {
    let count = ((bottom - top) / ROW).clamp(0.0, 40.0) as usize;
    (0..count).map(move |index| top + 5.0 + ROW * index as f64)
}

/// Candidates next to a vertical line from the top down; above or below a horizontal line at its
/// right end, its left end, its middle.
fn beside_line(from: Point, to: Point, frame: Rectangle) -> Vec<LabelHold> {
    if from.x == to.x {
        return rows(frame.top, frame.bottom)
            .flat_map(|y| {
                [
                    (point(from.x + CLEAR, y), Anchor::Start, Baseline::Top),
                    (point(from.x - CLEAR, y), Anchor::End, Baseline::Top),
                ]
            })
            .collect();
    }
    let y = from.y;
    let ends = [
        (to.x - CLEAR, Anchor::End),
        (from.x + CLEAR, Anchor::Start),
        (0.5 * (from.x + to.x), Anchor::Middle),
    ];
    ends.into_iter()
        .flat_map(|(x, anchor)| {
            [
                (point(x, y - CLEAR), anchor, Baseline::Letters),
                (point(x, y + CLEAR), anchor, Baseline::Top),
                (point(x, y - CLEAR - ROW), anchor, Baseline::Letters),
            ]
        })
        .collect()
}

/// Candidates in the middle of a vertical band from the top down, otherwise next to it; in a
/// horizontal band at its ends or its middle.
fn inside_band(area: Rectangle, direction: AxisDirection, frame: Rectangle) -> Vec<LabelHold> {
    match direction {
        AxisDirection::X => rows(frame.top, frame.bottom)
            .flat_map(|y| {
                [
                    (point(area.centre().x, y), Anchor::Middle, Baseline::Top),
                    (point(area.left + CLEAR, y), Anchor::Start, Baseline::Top),
                    (point(area.right - CLEAR, y), Anchor::End, Baseline::Top),
                ]
            })
            .collect(),
        AxisDirection::Y => [area.centre().y, area.top + ROW, area.bottom - ROW]
            .into_iter()
            .flat_map(|y| {
                [
                    (point(frame.left + 2.0 * CLEAR, y), Anchor::Start, Baseline::Middle),
                    (point(frame.right - 2.0 * CLEAR, y), Anchor::End, Baseline::Middle),
                    (point(frame.centre().x, y), Anchor::Middle, Baseline::Middle),
                ]
            })
            .collect(),
    }
}

/// Candidates around a point: the preferred side and its corners, the other sides, the other
/// corners, then farther away.
fn around(at: Point, side: PointSide) -> Vec<LabelHold> {
    const UP: [(f64, f64); 2] = [(1.0, -1.0), (-1.0, -1.0)];
    const DOWN: [(f64, f64); 2] = [(1.0, 1.0), (-1.0, 1.0)];
    const LEFT: [(f64, f64); 2] = [(-1.0, -1.0), (-1.0, 1.0)];
    const RIGHT: [(f64, f64); 2] = [(1.0, -1.0), (1.0, 1.0)];
    let (order, [first, second]) = match side {
        PointSide::On => return vec![(at, Anchor::Middle, Baseline::Middle)],
        PointSide::Above => {
            ([PointSide::Above, PointSide::Right, PointSide::Left, PointSide::Below], [UP, DOWN])
        }
        PointSide::Below => {
            ([PointSide::Below, PointSide::Right, PointSide::Left, PointSide::Above], [DOWN, UP])
        }
        PointSide::Left => {
            ([PointSide::Left, PointSide::Above, PointSide::Below, PointSide::Right], [LEFT, RIGHT])
        }
        PointSide::Right => {
            ([PointSide::Right, PointSide::Above, PointSide::Below, PointSide::Left], [RIGHT, LEFT])
        }
    };
    let near = |side: PointSide, away: f64| match side {
        PointSide::Above => (point(at.x, at.y - away), Anchor::Middle, Baseline::Letters),
        PointSide::Below => (point(at.x, at.y + away), Anchor::Middle, Baseline::Top),
        PointSide::Left => (point(at.x - away, at.y), Anchor::End, Baseline::Middle),
        PointSide::Right | PointSide::On => (point(at.x + away, at.y), Anchor::Start, Baseline::Middle),
    };
    let corner = |(dx, dy): (f64, f64), away: f64| {
        let anchor = if dx > 0.0 { Anchor::Start } else { Anchor::End };
        let baseline = if dy > 0.0 { Baseline::Top } else { Baseline::Letters };
        (point(at.x + dx * away, at.y + dy * away), anchor, baseline)
    };
    [9.0, 18.0, 30.0]
        .into_iter()
        .flat_map(|away| {
            let [wanted, others @ ..] = order;
            let own = first.map(|c| corner(c, 0.8 * away));
            let far = second.map(|c| corner(c, 0.8 * away));
            let sides = others.map(|s| near(s, away));
            [near(wanted, away)].into_iter().chain(own).chain(sides).chain(far)
        })
        .collect()
}
