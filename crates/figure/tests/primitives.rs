//! Clipping, ticks, text and numbers of the drawing layer.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use phea_dynamics::portable::hypot;
use phea_figure::axis::{Axis, Scale};
use phea_figure::scene::{Anchor, Baseline, Point, Rectangle, Text, point};
use phea_figure::svg::{escaped, number};
use phea_figure::ticks::{Tick, decimal_power, floor_log10};
use phea_figure::typeset::{Level, fitted, fitted_title, pieces, width};
use phea_figure::{clip, simplify};

/// Linear congruential generator (Knuth's MMIX constants), sufficient for the tests.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Mostly ordinary numbers, occasionally NaN, infinite or huge.
    fn wild(&mut self) -> f64 {
        match (self.unit() * 40.0) as u32 {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => -1e300,
            3 => 1e17,
            _ => self.between(-300.0, 300.0),
        }
    }
}

const FRAME: Rectangle = Rectangle { left: -100.0, top: -70.0, right: 110.0, bottom: 90.0 };

/// True if the point is on the segment between two others, within rounding: measured from the
/// nearer end, since the other may be very far away.
fn lies_on(p: Point, a: Point, b: Point) -> bool {
    let away = |q: Point| hypot(p.x - q.x, p.y - q.y);
    let (near, far) = if away(a) < away(b) { (a, b) } else { (b, a) };
    let length = hypot(far.x - near.x, far.y - near.y);
    let (ux, uy) = ((far.x - near.x) / length, (far.y - near.y) / length);
    let (wx, wy) = (p.x - near.x, p.y - near.y);
    let tolerance = 1e-9 * (1.0 + near.x.abs() + near.y.abs());
    (wx * uy - wy * ux).abs() <= tolerance && wx * ux + wy * uy >= -tolerance
}

#[test]
fn a_cut_polyline_stays_in_the_frame_and_on_the_curve() {
    let mut random = Random(1);
    for _ in 0..2000 {
        let points: Vec<Point> = (0..12).map(|_| point(random.wild(), random.wild())).collect();
        for run in clip::polyline(&points, &FRAME) {
            assert!(run.len() > 1);
            for pair in run.windows(2) {
                assert!(FRAME.contains_point(pair[0]) && FRAME.contains_point(pair[1]), "{run:?}");
                // both ends and the middle are on one piece of the curve: no line runs along the
                // frame
                let middle = point(0.5 * (pair[0].x + pair[1].x), 0.5 * (pair[0].y + pair[1].y));
                let on_curve = points.windows(2).any(|piece| {
                    piece[0].y.is_finite()
                        && [pair[0], middle, pair[1]].iter().all(|p| lies_on(*p, piece[0], piece[1]))
                });
                assert!(on_curve, "{pair:?} is no part of {points:?}");
            }
        }
    }
}

#[test]
fn a_polyline_inside_the_frame_is_unchanged() {
    let mut random = Random(2);
    for _ in 0..200 {
        let points: Vec<Point> =
            (0..20).map(|_| point(random.between(-99.0, 109.0), random.between(-69.0, 89.0))).collect();
        assert_eq!(clip::polyline(&points, &FRAME), vec![points]);
    }
}

#[test]
fn a_point_out_of_range_or_not_a_number_splits_the_line() {
    let line = |values: [f64; 5]| {
        let points: Vec<Point> = values.iter().enumerate().map(|(i, y)| point(10.0 * i as f64, *y)).collect();
        clip::polyline(&points, &FRAME)
    };
    assert_eq!(line([0.0, 10.0, f64::NAN, 10.0, 0.0]).len(), 2);
    assert_eq!(line([0.0, 10.0, 1e9, 10.0, 0.0]).len(), 2);
    assert_eq!(line([0.0, 10.0, f64::INFINITY, 10.0, 0.0]).len(), 2);
    assert_eq!(line([0.0, 10.0, 20.0, 10.0, 0.0]).len(), 1);
    assert!(line([f64::NAN; 5]).is_empty());
    assert!(line([1e9; 5]).is_empty());
}

#[test]
fn a_cut_polygon_has_the_area_of_the_intersection() {
    // ORIGIN: analytic. A square of side 40 about the corner (110, 90) has 20 x 20 in common with
    // the frame.
    let square = [point(90.0, 70.0), point(130.0, 70.0), point(130.0, 110.0), point(90.0, 110.0)];
    let inside = clip::polygon(&square, &FRAME);
    let area: f64 =
        inside.iter().zip(inside.iter().cycle().skip(1)).map(|(a, b)| 0.5 * (a.x * b.y - b.x * a.y)).sum();
    assert!((area.abs() - 400.0).abs() < 1e-9, "{area}");
    let mut random = Random(3);
    for _ in 0..2000 {
        let corners: Vec<Point> = (0..5).map(|_| point(random.wild(), random.wild())).collect();
        for corner in clip::polygon(&corners, &FRAME) {
            assert!(FRAME.grown(1e-6).contains_point(corner), "{corner:?} from {corners:?}");
        }
    }
}

/// Value that a label represents.
fn read(label: &str, exponent: i32) -> f64 {
    let plain = label.replace('\u{2212}', "-");
    let power = |text: &str| decimal_power(text.parse().unwrap());
    let value = match (plain.split_once("×10^"), plain.split_once("10^")) {
        (Some((digits, exponent)), _) => digits.parse::<f64>().unwrap() * power(exponent),
        (None, Some(("-", exponent))) => -power(exponent),
        (None, Some((_, exponent))) => power(exponent),
        _ => plain.parse::<f64>().unwrap(),
    };
    value * decimal_power(exponent)
}

fn check_ticks(axis: &Axis, count: usize) {
    let ticks = axis.ticks(count);
    let labelled: Vec<&Tick> = ticks.iter().filter(|tick| tick.label.is_some()).collect();
    assert!(labelled.len() <= count + 3, "{axis:?}: {} labels for {count}", labelled.len());
    for pair in ticks.windows(2) {
        assert!(pair[0].value < pair[1].value, "{axis:?}");
    }
    for tick in &ticks {
        let fraction = axis.fraction(tick.value);
        assert!((-1e-6..=1.0 + 1e-6).contains(&fraction), "{axis:?}: {tick:?} at {fraction}");
    }
    let span = axis.maximum - axis.minimum;
    for tick in &labelled {
        let value = read(tick.label.as_ref().unwrap(), axis.exponent());
        let tolerance = if axis.scale == Scale::Linear { 1e-6 * span } else { 1e-6 * tick.value.abs() };
        assert!((value - tick.value).abs() <= tolerance, "{axis:?}: {tick:?} reads {value}");
    }
    let mut labels: Vec<&String> = labelled.iter().filter_map(|tick| tick.label.as_ref()).collect();
    labels.sort();
    labels.dedup();
    assert_eq!(labels.len(), labelled.len(), "labels repeat on {axis:?}");
}

#[test]
fn ticks_increase_are_on_the_axis_and_state_their_value() {
    let mut random = Random(4);
    for _ in 0..3000 {
        let scale = decimal_power(random.between(-9.0, 12.0) as i32);
        let (a, b) = (random.between(-1.0, 1.0) * scale, random.between(-1.0, 1.0) * scale);
        let count = random.between(3.0, 10.0) as usize;
        let linear = Axis::linear("", a.min(b), a.max(b));
        check_ticks(&linear, count);
        let fitted = Axis::fit_linear("", [a, b]);
        assert!(fitted.minimum <= a.min(b) + 1e-6 * scale && fitted.maximum >= a.max(b) - 1e-6 * scale);
        assert!(fitted.ticks(6).iter().filter(|tick| tick.label.is_some()).count() >= 2, "{fitted:?}");
        check_ticks(&fitted, count);
        let ratio = decimal_power(random.between(1.0, 12.0) as i32) * random.between(0.3, 1.0);
        let logarithmic = Axis::fit_logarithmic("", [scale, scale * ratio]);
        assert!(logarithmic.minimum <= scale * (1.0 + 1e-9));
        assert!(logarithmic.maximum >= scale * ratio * (1.0 - 1e-9));
        check_ticks(&logarithmic, count);
        check_ticks(&Axis::fit_signed_logarithmic("", [-scale * ratio, scale], 0.1 * scale), count);
        check_ticks(&Axis::fit_angle("", [-random.between(20.0, 900.0), 0.0]), count);
        check_ticks(&Axis::fit_decibel("", [-random.between(1.0, 300.0), 20.0]), count);
    }
}

#[test]
fn an_invalid_axis_becomes_a_valid_one() {
    let strange = [f64::NAN, f64::INFINITY, -f64::INFINITY, 0.0, -1.0, 1.0, 1e308, -1e308, 1e-320];
    for a in strange {
        for b in strange {
            let axes = [
                Axis::linear("", a, b),
                Axis::logarithmic("", a, b),
                Axis::fit_linear("", [a, b]),
                Axis::fit_angle("", [a, b]),
                Axis::fit_decibel("", [a, b]),
                Axis::fit_logarithmic("", [a, b]),
                Axis::fit_signed_logarithmic("", [a, b], b),
            ];
            for axis in axes {
                assert!(axis.minimum < axis.maximum, "{axis:?} from {a}, {b}");
                assert!(axis.fraction(axis.minimum).abs() < 1e-12);
                assert!((axis.fraction(axis.maximum) - 1.0).abs() < 1e-12, "{axis:?} from {a}, {b}");
                let ticks = axis.ticks(6);
                assert!(ticks.len() < 3000, "{axis:?}: {} ticks", ticks.len());
                assert!(ticks.iter().all(|tick| tick.value.is_finite()), "{axis:?}");
            }
        }
    }
}

#[test]
fn decades_are_counted_exactly() {
    for exponent in -300..=300 {
        let power = decimal_power(exponent);
        assert_eq!(floor_log10(power), exponent);
        assert_eq!(floor_log10(power.next_down()), exponent - 1);
    }
}

#[test]
fn numbers_are_short_and_never_negative_zero() {
    assert_eq!(number(1.0), "1");
    assert_eq!(number(-0.001), "0");
    assert_eq!(number(12.345), "12.35"); // ORIGIN: analytic, two decimals
    assert_eq!(number(-100.5), "-100.5");
    assert_eq!(number(f64::NAN), "0");
    assert_eq!(escaped("a<b & \"c\"\u{0}\u{b}"), "a&lt;b &amp; &quot;c&quot;");
}

#[test]
fn markup_changes_symbols_and_leaves_names_unchanged() {
    let plain = |text: &str| pieces(text).iter().all(|(_, level)| *level == Level::Line);
    for name in ["eaton_synflex_3130_08", "my_rig.toml", "a_", "_", "^", "x^y", "K_", "{}", "_{", "F_1-x_"] {
        let remaining: String = pieces(name).into_iter().map(|(text, _)| text).collect();
        assert!(plain(name) || name.starts_with("F_1"), "{name}: {remaining}");
    }
    let script = |text: &str| {
        pieces(text)
            .into_iter()
            .filter(|(_, level)| *level != Level::Line)
            .map(|(t, _)| t)
            .collect::<Vec<_>>()
    };
    assert_eq!(script("F_e/U_C (dB)"), ["e", "C"]);
    assert_eq!(script("A^2 + f_v K_c"), ["2", "v", "c"]);
    assert_eq!(script("e^{-sT}, β_{0,max}"), ["\u{2212}sT", "0,max"]);
    assert_eq!(script("10^-12 m^3"), ["\u{2212}12", "3"]);
}

#[test]
fn text_has_the_size_of_its_font() {
    // ORIGIN: data sheet, the font's own table: advances in DejaVu Sans 2.37, units of 2048 to the
    // em: H 1540, digit 1303, space 651.
    assert!((width("H", 2048.0) - 1540.0).abs() < 0.5);
    assert!((width("07", 2048.0) - 2.0 * 1303.0).abs() < 1.0);
    assert!((width(" ", 2048.0) - 651.0).abs() < 0.5);
    assert!(width("H_2", 10.0) < width("H2", 10.0));
    let turned = Text::new(point(50.0, 60.0), "Height", 10.0).held(Anchor::Middle, Baseline::Middle);
    let (lying, upright) = (turned.bounds(), turned.clone().rotated(-90.0).bounds());
    assert!((lying.width() - upright.height()).abs() < 1e-9);
    assert!((lying.height() - upright.width()).abs() < 1e-9);
    for limit in [0.0, 5.0, 20.0, 60.0, 1000.0] {
        assert!(width(&fitted("a rather long name", 12.0, limit), 12.0) <= limit);
    }
    assert_eq!(fitted("short", 12.0, 1000.0), "short");
}

#[test]
fn a_simplified_curve_is_close_to_the_original() {
    let mut random = Random(5);
    for _ in 0..500 {
        let mut at = point(0.0, 0.0);
        let bend = random.between(0.0, 1.5);
        let points: Vec<Point> = (0..200)
            .map(|_| {
                at = point(at.x + random.between(-0.1, 1.0), at.y + random.between(-bend, bend));
                at
            })
            .collect();
        let remaining = simplify::polyline(&points);
        assert_eq!((remaining.first(), remaining.last()), (points.first(), points.last()));
        for p in &points {
            let away =
                remaining.windows(2).map(|pair| distance(*p, pair[0], pair[1])).fold(f64::INFINITY, f64::min);
            assert!(away <= 2.0 * simplify::TOLERANCE, "{away}");
        }
    }
    let resonance: Vec<Point> =
        (0..2000).map(|i| point(0.2 * f64::from(i), 100.0 / (0.01 + f64::from(i - 1000).abs()))).collect();
    let remaining = simplify::polyline(&resonance);
    assert!(remaining.len() < 300 && remaining.contains(&resonance[1000]), "{} points", remaining.len());
}

/// Distance of a point from the segment between two others.
fn distance(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let length = dx * dx + dy * dy;
    let t = if length > 0.0 { ((p.x - a.x) * dx + (p.y - a.y) * dy) / length } else { 0.0 };
    let t = t.clamp(0.0, 1.0);
    hypot(p.x - a.x - t * dx, p.y - a.y - t * dy)
}

/// A title that is too long for its panel becomes smaller and loses words, but neither its unit nor
/// the power of ten.
#[test]
fn the_title_of_an_axis_contains_its_unit() {
    for (title, limit) in [
        ("Angle (deg), \u{d7}10^3", 120.0),
        ("Torque \u{3c4}_x (N.m)", 100.0),
        ("The angle of a shaft that turns (deg), \u{d7}10^3", 106.0),
    ] {
        let (fitting, size) = fitted_title(title, 13.5, limit);
        let unit = &title[title.find(" (").unwrap()..];
        assert!(fitting.ends_with(unit) && width(&fitting, size) <= limit, "{fitting} in {size}");
        assert!((phea_figure::SMALL_SIZE..=13.5).contains(&size));
    }
    assert_eq!(fitted_title("U (V)", 13.5, 100.0), ("U (V)".to_string(), 13.5));
}
