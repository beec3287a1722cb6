//! Guarantees of the figures of the robust method: exact contours, and edges that enclose the
//! forbidden region.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::gallery::gallery_qft;
use num_complex::Complex64;
use phea_dynamics::portable::{cos, log10, magnitude, pow, sin};
use phea_figure::colour::Role;
use phea_figure::nichols::{Boundary, USUAL_CONTOURS_DB, boundaries, magnitude_contour};
use phea_figure::scene::{Item, PathStep, Point, Shape};
use phea_figure::*;
use phea_qft::bound::{Bound, GainIntervals};

fn open_loop((phase_deg, magnitude_db): (f64, f64)) -> Complex64 {
    let (gain, phase) = (pow(10.0, magnitude_db / 20.0), phase_deg.to_radians());
    Complex64::new(gain * cos(phase), gain * sin(phase))
}

fn complementary_db(open_loop: Complex64) -> f64 {
    20.0 * log10(magnitude(open_loop / (1.0 + open_loop)))
}

#[test]
fn every_point_of_a_contour_has_its_magnitude() {
    for contour in USUAL_CONTOURS_DB.into_iter().chain([20.0, 1e-3, -1e-3, -80.0]) {
        let points = magnitude_contour(contour);
        assert!(points.len() > 100);
        for point in points {
            let found = complementary_db(open_loop(point));
            assert!((found - contour).abs() < 1e-6, "{contour} dB at {point:?}: {found}");
            assert!((-360.0..=0.0).contains(&point.0));
        }
    }
    assert!([f64::NAN, f64::INFINITY, f64::NEG_INFINITY].iter().all(|c| magnitude_contour(*c).is_empty()));
}

fn bound(phases_deg: &[f64], forbidden: impl Fn(f64) -> Vec<[f64; 2]>) -> Bound {
    Bound {
        frequency_rad_per_s: 1.0,
        phases_rad: phases_deg.iter().map(|phase| phase.to_radians()).collect(),
        forbidden: phases_deg.iter().map(|phase| GainIntervals::union_of(forbidden(*phase))).collect(),
    }
}

fn every(step_deg: f64) -> Vec<f64> {
    (0..=(360.0 / step_deg) as usize).map(|i| i as f64 * step_deg - 360.0).collect()
}

/// Twice the area to the left, in degrees times dB: negative if the enclosed region is to the
/// right.
fn area(edge: &Boundary) -> f64 {
    edge.points.windows(2).map(|pair| pair[0].0 * pair[1].1 - pair[1].0 * pair[0].1).sum()
}

/// |T| <= M for one plant forbids exactly the inside of the contour of M (its discriminant is that of the quadratic in the
/// gain), so the traced edge and the contour are two computations of one curve, tips included.
#[test]
fn the_bound_of_one_plant_is_the_contour() {
    let limit: f64 = 1.2;
    let square = limit * limit;
    let roots = |phase: f64| {
        let part = square * cos(phase.to_radians());
        let discriminant = part * part - square * (square - 1.0);
        if part >= 0.0 || discriminant <= 0.0 {
            return vec![];
        }
        let root = discriminant.sqrt();
        vec![[(-part - root) / (square - 1.0), (-part + root) / (square - 1.0)]]
    };
    let edges = boundaries(&bound(&every(1.0), roots));
    assert_eq!(edges.len(), 1);
    assert!(edges[0].closed && area(&edges[0]) < 0.0);
    let limit_db = 20.0 * log10(limit);
    for &point in &edges[0].points {
        let found = complementary_db(open_loop(point));
        assert!((found - limit_db).abs() < 0.02, "{point:?}: {found} against {limit_db}");
    }
    // The tips: cos(phi) = -sqrt(1 - 1/M^2), reached to a tenth of the step.
    let widest = phea_dynamics::portable::acos((1.0 - 1.0 / square).sqrt()).to_degrees();
    let rightmost = edges[0].points.iter().map(|point| point.0 + 180.0).fold(-180.0, f64::max);
    let leftmost = edges[0].points.iter().map(|point| point.0 + 180.0).fold(180.0, f64::min);
    assert!((rightmost - widest).abs() < 0.1 && (leftmost + widest).abs() < 0.1, "{leftmost} {rightmost}");
}

#[test]
fn an_open_bound_has_one_edge_with_the_forbidden_side_below() {
    let edges = boundaries(&bound(&every(5.0), |phase| vec![[0.0, 2.0 + sin(phase.to_radians())]]));
    let visible: Vec<&Boundary> = edges.iter().filter(|edge| edge.points[0].1 > -1000.0).collect();
    assert_eq!((edges.len(), visible.len()), (2, 1));
    assert!(visible.iter().all(|edge| !edge.closed && edge.points.windows(2).all(|p| p[1].0 > p[0].0)));
}

/// A ring: an island with an allowed hole, around which spans split and join.
#[test]
fn a_hole_is_an_edge_of_its_own() {
    let circle = |phase: f64, radius: f64| {
        let square = radius * radius - (phase + 180.0) * (phase + 180.0);
        (square > 0.0).then(|| square.sqrt() / 10.0)
    };
    let gain = |decibel: f64| pow(10.0, decibel / 20.0);
    let ring = |phase: f64| match (circle(phase, 100.0), circle(phase, 40.0)) {
        (Some(outer), Some(inner)) => vec![[gain(-outer), gain(-inner)], [gain(inner), gain(outer)]],
        (Some(outer), None) => vec![[gain(-outer), gain(outer)]],
        (None, _) => vec![],
    };
    let edges = boundaries(&bound(&every(4.0), ring));
    let areas: Vec<f64> = edges.iter().map(area).collect();
    assert!(edges.len() == 2 && edges.iter().all(|edge| edge.closed), "{areas:?}");
    // twice the area of an ellipse with half axes r degrees and r/10 dB; polygons have slightly
    // less
    let ellipse = |radius: f64| 2.0 * std::f64::consts::PI * radius * radius / 10.0;
    for (found, truth) in areas.iter().zip([-ellipse(100.0), ellipse(40.0)]) {
        assert!((found / truth - 1.0).abs() < 0.02, "{found} against {truth}");
    }
}

/// Every end of any spans is on exactly one edge, and an edge is closed or begins and ends at the
/// outermost phases.
#[test]
fn every_end_is_on_one_edge() {
    let mut state = 7_u64;
    let mut unit = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..300 {
        let phases = every(40.0);
        let spans: Vec<Vec<[f64; 2]>> =
            phases.iter().map(|_| (0..4).map(|_| [20.0 * unit(), 20.0 * unit()]).collect()).collect();
        let mut next = spans.into_iter();
        let mut bound = bound(&phases, |_| vec![]);
        bound.forbidden = phases.iter().map(|_| GainIntervals::union_of(next.next().unwrap())).collect();
        let edges = boundaries(&bound);
        for edge in &edges {
            let (first, last) = (edge.points[0], *edge.points.last().unwrap());
            assert_eq!(edge.closed, first == last);
            assert!(edge.closed || [first.0, last.0].iter().all(|phase| *phase == 0.0 || *phase == -360.0));
        }
        for (phase, forbidden) in phases.iter().zip(&bound.forbidden) {
            for gain in forbidden.intervals().iter().flatten() {
                let is_end =
                    |p: &&(f64, f64)| (p.0 - phase).abs() < 1e-9 && (p.1 - 20.0 * log10(*gain)).abs() < 1e-9;
                let met = edges.iter().flat_map(|edge| edge.points.iter().skip(usize::from(edge.closed)));
                assert_eq!(met.filter(is_end).count(), 1, "{gain} at {phase}");
            }
        }
    }
}

/// Labels without space are omitted: on these charts every label must find space.
#[test]
fn every_frequency_and_every_violation_is_labelled() {
    let texts = |name: &str| -> Vec<String> {
        let figure = gallery_qft::all().into_iter().find(|figure| figure.name == name).unwrap();
        figure.scene.texts().map(|text| text.content.clone()).collect()
    };
    let servo = ["0.1", "0.5", "1", "2", "10", "15", "100"];
    for name in ["nichols-stability", "templates"] {
        let texts = texts(name);
        for frequency in servo {
            assert!(texts.contains(&format!("{frequency} rad/s")), "{frequency} rad/s in {name}: {texts:?}");
        }
    }
    let chart = texts("nichols-stability");
    for number in servo {
        assert!(chart.iter().any(|text| text == number), "bound of {number} rad/s: {chart:?}");
    }
    for contour in
        ["6", "3", "1", "0.5", "0", "\u{2212}1", "\u{2212}3", "\u{2212}6", "\u{2212}12", "\u{2212}20"]
    {
        assert!(chart.iter().any(|text| text == contour), "contour of {contour} dB: {chart:?}");
    }
    assert!(texts("nichols-worst-case").contains(&"|T| 0.25 dB over at 67 rad/s".to_string()));
    assert!(texts("family-stability").contains(&"0.25 dB over at 67 rad/s".to_string()));
}

/// Corners of the areas painted in a role, in view box units.
fn painted(figure: &Figure, role: Role) -> Vec<Vec<Point>> {
    let corners = |steps: &[PathStep]| -> Vec<Point> {
        let corner = |step: &PathStep| match step {
            PathStep::Move(p) | PathStep::Line(p) => Some(*p),
            _ => None,
        };
        steps.iter().filter_map(corner).collect()
    };
    let area = |item: &Item| match item {
        Item::Drawing { shape: Shape::Path(steps), fill: Some(fill), .. } if fill.role == role => {
            Some(corners(steps))
        }
        _ => None,
    };
    figure.scene.items.iter().filter_map(area).collect()
}

fn frame_of(figure: &Figure) -> (f64, f64) {
    let sides = figure.scene.items.iter().find_map(|item| match item {
        Item::Drawing { shape: Shape::Rectangle(frame, _), .. } => Some((frame.left, frame.right)),
        _ => None,
    });
    sides.unwrap()
}

fn magnitudes(frequencies: &[f64], magnitudes: &[f64]) -> MagnitudeCurve {
    MagnitudeCurve { frequencies_rad_per_s: frequencies.to_vec(), magnitudes: magnitudes.to_vec() }
}

/// A magnitude equal to its frequency crosses a limit of 1 at 1 rad/s, halfway between 0.1 and 10
/// rad/s; as the least of a family it misses a lower limit of 1 below there. A tolerance moves the
/// crossing.
#[test]
fn violated_areas_begin_where_the_limit_is_crossed() {
    let (one, rising) =
        (magnitudes(&[0.1, 10.0], &[1.0, 1.0]), magnitudes(&[0.1, 0.3, 10.0], &[0.1, 0.3, 10.0]));
    let upper = FamilyMagnitude {
        upper_limit: Some(one.clone()),
        envelopes: vec![FamilyEnvelope { greatest: rising.clone(), ..FamilyEnvelope::default() }],
        ..FamilyMagnitude::default()
    };
    let lower = FamilyMagnitude {
        lower_limit: Some(one),
        envelopes: vec![FamilyEnvelope {
            greatest: rising.clone(),
            least: Some(rising),
            ..FamilyEnvelope::default()
        }],
        ..FamilyMagnitude::default()
    };
    // twice the limit is reached at 2 rad/s
    let tolerant = FamilyMagnitude { tolerance_db: 20.0 * log10(2.0), ..upper.clone() };
    let two = 0.5 * (1.0 + log10(2.0));
    for (chart, parts) in [(upper, (0.5, 1.0)), (lower, (0.0, 0.5)), (tolerant, (two, 1.0))] {
        let figure = chart.draw(&Words::new("f", "f", "f"));
        let (areas, (left, right)) = (painted(&figure, Role::Bad), frame_of(&figure));
        assert_eq!(areas.len(), 1);
        let part = |p: &Point| (p.x - left) / (right - left);
        let from = areas[0].iter().map(part).fold(1.0, f64::min);
        let to = areas[0].iter().map(part).fold(0.0, f64::max);
        assert!((from - parts.0).abs() < 1e-9 && (to - parts.1).abs() < 1e-9, "{from} {to}");
    }
}

/// Violations of another loop are painted too, next to the parts that the first loop satisfies.
#[test]
fn the_other_loop_is_judged_by_the_same_limit() {
    let (one, rising) =
        (magnitudes(&[0.1, 10.0], &[1.0, 1.0]), magnitudes(&[0.1, 0.3, 10.0], &[0.1, 0.3, 10.0]));
    let satisfied = magnitudes(&[0.1, 10.0], &[0.5, 0.5]);
    let envelope = |name: &str, greatest| FamilyEnvelope { name: name.to_string(), greatest, least: None };
    let chart = FamilyMagnitude {
        upper_limit: Some(one),
        envelopes: vec![envelope("one", satisfied), envelope("other", rising)],
        ..FamilyMagnitude::default()
    };
    let figure = chart.draw(&Words::new("f", "f", "f"));
    let (areas, (left, right)) = (painted(&figure, Role::Bad), frame_of(&figure));
    assert_eq!(areas.len(), 1);
    let from = areas[0].iter().map(|p| (p.x - left) / (right - left)).fold(1.0, f64::min);
    assert!((from - 0.5).abs() < 1e-9, "{from}");
    let texts: Vec<String> = figure.scene.texts().map(|text| text.content.clone()).collect();
    assert!(texts.contains(&"one: greatest".to_string()) && texts.contains(&"other: greatest".to_string()));
}

/// Edges that cross at 1 rad/s, halfway along the axis, leave a band below it and nothing above.
#[test]
fn the_band_of_a_prefilter_ends_where_its_edges_cross() {
    let point = |frequency: f64, least_db: f64| PrefilterPoint {
        frequency_rad_per_s: frequency,
        least_db,
        greatest_db: 0.0,
        prefilter_db: Some(-1.0),
    };
    let panel = PrefilterPanel { name: "loop".to_string(), points: vec![point(0.1, -5.0), point(10.0, 5.0)] };
    let figure = prefilter_band(&Words::new("p", "p", "p"), &[panel]);
    let (left, right) = frame_of(&figure);
    for (role, ends) in [(Role::Good, [0.0, 0.5]), (Role::Bad, [0.5, 1.0])] {
        let areas = painted(&figure, role);
        assert_eq!(areas.len(), 1, "{role:?}");
        let parts = areas[0].iter().map(|p| (p.x - left) / (right - left));
        let found = [parts.clone().fold(1.0, f64::min), parts.fold(0.0, f64::max)];
        assert!((found[0] - ends[0]).abs() < 1e-9 && (found[1] - ends[1]).abs() < 1e-9, "{role:?} {found:?}");
    }
    let texts: Vec<String> = figure.scene.texts().map(|text| text.content.clone()).collect();
    assert!(texts.iter().any(|text| text.starts_with("nothing left")), "{texts:?}");
}

/// Every loop has its own shape of marks, and a violation is crossed out on its own loop and turn.
#[test]
fn a_violation_is_on_its_own_loop() {
    let w = vec![1.0, 10.0];
    let level = |phase: f64, magnitude: f64| FrequencySeries {
        name: format!("at {phase}"),
        response: vec![open_loop((phase, magnitude)), open_loop((phase, magnitude - 20.0))],
        frequencies_rad_per_s: w.clone(),
    };
    let chart = NicholsChart {
        loops: vec![level(-100.0, 30.0), level(-200.0, 10.0)],
        design_frequencies_rad_per_s: w.clone(),
        violations: vec![OpenLoopViolation {
            frequency_rad_per_s: 1.0,
            open_loop: open_loop((-200.0, 10.0)),
            text: "second".to_string(),
        }],
        ..NicholsChart::default()
    };
    let figure = chart.draw(&Words::new("n", "n", "n"));
    // middle of the corners of all objects drawn with this note
    let place = |note: &str| {
        let found = figure.scene.items.iter().find_map(|item| match item {
            Item::Drawing { shape: Shape::Path(steps), note: Some(found), .. } if found == note => {
                Some(steps)
            }
            _ => None,
        });
        let corners = found.unwrap_or_else(|| panic!("{note}")).iter().filter_map(|step| match step {
            PathStep::Move(p) | PathStep::Line(p) => Some(*p),
            _ => None,
        });
        let corners: Vec<Point> = corners.collect();
        let count = corners.len() as f64;
        let sum = corners.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.x, sum.1 + p.y));
        (sum.0 / count, sum.1 / count)
    };
    let (cross, square) = (place("second"), place("1 rad/s: \u{2212}200°, 10 dB"));
    assert!((cross.0 - square.0).abs() < 1e-9 && (cross.1 - square.1).abs() < 1e-9, "{cross:?} {square:?}");
    let circles = figure.scene.items.iter().filter(|item| {
        matches!(item, Item::Drawing { shape: Shape::Circle(..), note: Some(note), .. } if note.contains("rad/s"))
    });
    assert_eq!(circles.count(), 2, "the first loop keeps its circles");
}

/// The chart of a loop that makes three turns is wide enough for its visible part, and no wider.
#[test]
fn the_phase_axis_follows_the_loop() {
    let response = |turns: f64| -> FrequencySeries {
        let w: Vec<f64> = (0..=200).map(|i| 1.0 + 0.01 * f64::from(i)).collect();
        let at = |w: &f64| open_loop((-360.0 * turns * (w - 1.0) / 2.0 - 1.0, 0.0));
        FrequencySeries {
            name: String::new(),
            response: w.iter().map(at).collect(),
            frequencies_rad_per_s: w,
        }
    };
    for (turns, leftmost) in [(0.5, "\u{2212}270"), (1.5, "\u{2212}630"), (9.0, "\u{2212}1080")] {
        let chart = NicholsChart { loops: vec![response(turns)], ..NicholsChart::default() };
        let figure = chart.draw(&Words::new("n", "n", "n"));
        let first = figure.scene.texts().next().unwrap().content.clone();
        assert_eq!(first, leftmost);
    }
}
