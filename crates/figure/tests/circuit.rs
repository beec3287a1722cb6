//! The hydraulic circuit: its symbols agree with the parts of the rig.

use crate::gallery;
use crate::legibility::check;
use phea_figure::scene::{Item, PathStep, Point, Rectangle, Shape};
use phea_figure::*;

/// Circuit of the example rig with a change.
fn circuit(change: impl Fn(&mut Schematic)) -> Figure {
    let mut schematic = gallery::circuit_of_hoses();
    change(&mut schematic);
    let figure = schematic.draw(&Words::new("circuit", "The rig", ""));
    check(&figure);
    figure
}

fn texts(figure: &Figure) -> Vec<&str> {
    figure.scene.texts().map(|text| text.content.as_str()).collect()
}

fn rectangles(figure: &Figure) -> Vec<Rectangle> {
    let of = |item: &Item| match item {
        Item::Drawing { shape: Shape::Rectangle(rectangle, _), .. } => Some(*rectangle),
        _ => None,
    };
    figure.scene.items.iter().filter_map(of).collect()
}

/// Cylinder, the largest object.
fn body(figure: &Figure) -> Rectangle {
    let area = |of: &Rectangle| of.width() * of.height();
    rectangles(figure).into_iter().max_by(|one, other| area(one).total_cmp(&area(other))).unwrap()
}

fn circles(figure: &Figure) -> Vec<Point> {
    let of = |item: &Item| match item {
        Item::Drawing { shape: Shape::Circle(centre, _), .. } => Some(*centre),
        _ => None,
    };
    figure.scene.items.iter().filter_map(of).collect()
}

/// Corners of closed triangles.
fn triangles(figure: &Figure) -> Vec<[Point; 3]> {
    let of = |item: &Item| match item {
        Item::Drawing { shape: Shape::Path(steps), .. } => match steps.as_slice() {
            [PathStep::Move(a), PathStep::Line(b), PathStep::Line(c), PathStep::Close] => Some([*a, *b, *c]),
            _ => None,
        },
        _ => None,
    };
    figure.scene.items.iter().filter_map(of).collect()
}

/// Symbols of a cylinder do not appear with a motor, nor those of a motor with a cylinder.
#[test]
fn a_motor_has_its_own_symbols() {
    let [linear, rotary] = [MotionKind::Linear, MotionKind::Rotary].map(|motion| {
        circuit(|schematic| {
            schematic.motion = motion;
            schematic.environment = Environment::PrescribedMotion;
        })
    });
    let of_a_cylinder = ["x_p", "x_L", "M", "F_e", "F_ref"];
    let of_a_motor = ["θ", "θ_L", "J", "T_e", "T_ref"];
    for (one, other) in of_a_cylinder.into_iter().zip(of_a_motor) {
        assert!(texts(&linear).contains(&one) && !texts(&linear).contains(&other), "{one}");
        assert!(texts(&rotary).contains(&other) && !texts(&rotary).contains(&one), "{other}");
    }
}

/// Each further stage is a sleeve of two walls inside the previous one, up to the number that can
/// be distinguished.
#[test]
fn stages_are_nested() {
    let with = |stages: usize| circuit(|schematic| schematic.further_stages = stages);
    let piston = rectangles(&with(0)).len();
    for stages in 1..=5 {
        let all = rectangles(&with(stages));
        let shown = stages.min(phea_figure::schematic::STAGES);
        assert_eq!(all.len(), piston + 2 * shown);
        let body = body(&with(stages));
        // walls are thinner than any other part of the cylinder
        let walls: Vec<_> = all.iter().filter(|wall| body.contains(wall) && wall.height() < 6.0).collect();
        let halves: Vec<f64> = walls.iter().map(|wall| (wall.centre().y - body.centre().y).abs()).collect();
        assert_eq!(halves.len(), 2 * shown);
        for pair in halves.chunks(2) {
            assert_eq!(pair[0], pair[1], "above and below the axis");
        }
        assert!(halves.chunks(2).is_sorted_by(|outer, inner| inner[0] < outer[0]));
    }
}

/// The rod's end is between joint and load, on the axis of the rod, with the text below them.
#[test]
fn a_linkage_is_a_lever_about_a_joint() {
    let words = ["four-bar", "arm r", "49.8 mm"];
    for environment in [Environment::PrescribedMotion, Environment::Wall, Environment::SpringMassDamper] {
        for series in [None, Some(SeriesKind::Spring), Some(SeriesKind::Transmission)] {
            let figure = circuit(|schematic| {
                schematic.environment = environment.clone();
                schematic.series = series.map(|kind| SeriesSymbol { kind, words: "200 kN/m".into() });
                schematic.linkage = Some(LinkageSymbol { rows: words.map(String::from).to_vec() });
            });
            let axis = body(&figure).centre().y;
            let pins: Vec<Point> = circles(&figure).into_iter().filter(|pin| pin.x > 450.0).collect();
            let [joint, rod, load] = pins[..] else { panic!("{pins:?}") };
            assert!(joint.x == rod.x && rod.x == load.x);
            assert!(joint.y < rod.y && rod.y == axis && axis < load.y);
            assert!(texts(&figure).contains(&"θ") && !texts(&figure).contains(&"x_L"));
            assert!(words.iter().all(|word| texts(&figure).contains(word)), "{:?}", texts(&figure));
            assert!(!texts(&figure).iter().any(|text| text.contains('…')), "{:?}", texts(&figure));
        }
    }
    assert!(circles(&circuit(|_| {})).iter().all(|circle| circle.x < 450.0), "no lever without a linkage");
}

/// An additional triangle is the head of an arrow through the gas; a valve itself has two, which
/// meet in one point between the chamber's port and the gas.
#[test]
fn an_arrow_goes_through_what_is_adjusted() {
    let with = |kind: Option<AccumulatorSymbol>| circuit(|schematic| schematic.line_a.accumulator = kind);
    let plain = triangles(&with(Some(AccumulatorSymbol::Fixed))).len();
    assert_eq!(plain, triangles(&with(None)).len() + 1, "the triangle of the gas");
    assert_eq!(triangles(&with(Some(AccumulatorSymbol::Adjusted))).len(), plain + 1);
    let figure = with(Some(AccumulatorSymbol::ThroughValve));
    let all = triangles(&figure);
    assert_eq!(all.len(), plain + 3);
    let meets = |one: &[Point; 3]| {
        all.iter().filter(|other| one[0].x == other[0].x && one[0].y == other[0].y).count()
    };
    let halves: Vec<_> = all.iter().filter(|one| meets(one) == 2).collect();
    assert_eq!(halves.len(), 2);
    let fixed = rectangles(&figure);
    let shells: Vec<_> =
        fixed.iter().filter(|shell| shell.width() == 16.0 && shell.height() == 32.0).collect();
    let [shell] = shells[..] else { panic!("{shells:?}") };
    let port = body(&figure).left + 30.0;
    assert!(port < halves[0][0].x && halves[0][0].x < shell.left && halves[0][0].y < shell.top);
}
