//! A Nichols chart of loops that leave it, and the positions of its labels.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use num_complex::Complex64;
use phea_dynamics::portable::{cos, pow, sin};
use phea_figure::scene::{Item, PathStep, Point, Rectangle, Shape, Stroke};
use phea_figure::*;

fn open_loop((phase_deg, magnitude_db): (f64, f64)) -> Complex64 {
    let (gain, phase) = (pow(10.0, magnitude_db / 20.0), phase_deg.to_radians());
    Complex64::new(gain * cos(phase), gain * sin(phase))
}

fn drawn(chart: &NicholsChart<'_>) -> Figure {
    chart.draw(&Words::new("n", "n", "n"))
}

fn frame_of(figure: &Figure) -> Rectangle {
    let found = figure.scene.items.iter().find_map(|item| match item {
        Item::Drawing { shape: Shape::Rectangle(frame, _), .. } => Some(*frame),
        _ => None,
    });
    found.unwrap()
}

/// Runs of points of all objects drawn with strokes of a width.
fn runs(figure: &Figure, width: f64) -> Vec<Vec<Point>> {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    for item in &figure.scene.items {
        let Item::Drawing { shape: Shape::Path(steps), stroke: Some(Stroke { width: own, .. }), .. } = item
        else {
            continue;
        };
        for step in steps.iter().filter(|_| *own == width) {
            match step {
                PathStep::Move(p) => runs.push(vec![*p]),
                PathStep::Line(p) | PathStep::Curve(_, _, p) => runs.last_mut().unwrap().push(*p),
                PathStep::Close => {}
            }
        }
    }
    runs
}

const LOOP_WIDTH: f64 = 2.4;

/// A loop that comes from -470 degrees far above 0 dB, passes 0 dB between -150 and -120 degrees,
/// and continues to -600 degrees far below.
fn far_turning_loop() -> FrequencySeries {
    let corners = [(-470.0, 80.0), (-150.0, 40.0), (-120.0, -15.0), (-600.0, -60.0)];
    let counts = [100, 400, 100];
    let mut places = vec![corners[0]];
    for (pair, count) in corners.windows(2).zip(counts) {
        let between = |from: f64, to: f64, i: i32| from + (to - from) * f64::from(i) / f64::from(count);
        let place = |i: i32| (between(pair[0].0, pair[1].0, i), between(pair[0].1, pair[1].1, i));
        places.extend((1..=count).map(place));
    }
    FrequencySeries {
        name: String::new(),
        frequencies_rad_per_s: (0..places.len()).map(|i| 1.0 + i as f64).collect(),
        response: places.into_iter().map(open_loop).collect(),
    }
}

/// Points far from 0 dB do not widen the axis: the loop is cut at the frame, which it leaves on the
/// left above, and below too if the chart extends that far down. A design frequency there widens it
/// to a whole turn.
#[test]
fn a_loop_far_from_0_db_leaves_the_frame() {
    // the mark at 41 rad/s is at -342 degrees, that at 11 rad/s at -438 degrees
    let cases = [(vec![], "\u{2212}270", 2), (vec![41.0], "\u{2212}360", 1), (vec![11.0], "\u{2212}360", 1)];
    for (marks, leftmost, ends) in cases {
        let chart = NicholsChart {
            loops: vec![far_turning_loop()],
            design_frequencies_rad_per_s: marks,
            ..NicholsChart::default()
        };
        let figure = drawn(&chart);
        assert_eq!(figure.scene.texts().next().unwrap().content, leftmost);
        let (frame, runs) = (frame_of(&figure), runs(&figure, LOOP_WIDTH));
        // below the frame is the legend
        let points: Vec<Point> = runs.into_iter().flatten().filter(|p| p.y <= frame.bottom).collect();
        let outside = points.iter().filter(|p| !frame.contains_point(**p));
        assert_eq!(outside.count(), 0);
        let at_left = points.iter().filter(|p| (p.x - frame.left).abs() < 1e-9);
        assert_eq!(at_left.count(), ends);
    }
}

/// Labels of three adjacent loops, with space on both sides, are not on a loop.
#[test]
fn labels_do_not_cover_loops_if_there_is_room() {
    let upright = |phase: f64| FrequencySeries {
        name: format!("{phase}"),
        frequencies_rad_per_s: (0..=80).map(|i| 1.0 + f64::from(i)).collect(),
        response: (0..=80).map(|i| open_loop((phase, 20.0 - 0.5 * f64::from(i)))).collect(),
    };
    let chart = NicholsChart {
        loops: [-135.0, -128.0, -142.0].map(upright).to_vec(),
        design_frequencies_rad_per_s: vec![11.0, 41.0, 61.0],
        ..NicholsChart::default()
    };
    let figure = drawn(&chart);
    let labels: Vec<_> = figure.scene.texts().filter(|text| text.content.ends_with("rad/s")).collect();
    assert_eq!(labels.len(), 3);
    for pair in runs(&figure, LOOP_WIDTH).iter().flat_map(|run| run.windows(2)) {
        for label in &labels {
            let hit = clip::segment(pair[0], pair[1], &label.bounds());
            assert!(hit.is_none() || pair[0].y > frame_of(&figure).bottom, "{} is on a loop", label.content);
        }
    }
}

/// The earliest position is rejected in favour of one that is not close to another text.
#[test]
fn labels_do_not_overlap() {
    let frame = Rectangle { left: 0.0, top: 0.0, right: 300.0, bottom: 40.0 };
    let text = |left: f64| Rectangle { left, top: 10.0, right: left + 40.0, bottom: 26.0 };
    let mut occupancy = placement::Occupancy::default();
    occupancy.add_text(text(20.0));
    assert_eq!(occupancy.choose(&[text(63.0), text(90.0)], &frame), Some(1));
    assert_eq!(occupancy.choose(&[text(63.0)], &frame), Some(0), "where no other place exists");
}
