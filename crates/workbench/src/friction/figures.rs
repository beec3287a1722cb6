use phea_engineering::friction::{
    FrictionIdentification, PressedCurve, PressedRows, ShakenRows, SteadyPoint,
};

use crate::figure::{Curve, CurveChart, CurvePanel, CurveStyle, Figure, Words};
use crate::quantity::DisplayUnit;

/// The friction map; force and position of each press and each shake.
pub(crate) fn pictures(found: &FrictionIdentification) -> Vec<Figure> {
    let presses = found.presses.iter().enumerate();
    let pressed = presses.filter_map(|(index, press)| pressed(found, index, press));
    let shakes = found.shakes.iter().enumerate();
    let shaken = shakes.filter_map(|(index, shake)| shaken(found, index, shake));
    map(found).into_iter().chain(pressed).chain(shaken).collect()
}

const CURVE_POINTS: u32 = 400;

/// Friction over velocity, measured and by the curve; and over slow velocities only.
fn map(found: &FrictionIdentification) -> Option<Figure> {
    let points = found.steady_points();
    let fastest = points.iter().map(|point| point.velocity.abs()).fold(0.0, f64::max);
    if points.is_empty() {
        return None;
    }
    let shown = DisplayUnit::MILLIMETRE;
    let measured = points.iter().map(|point| (shown.of(point.velocity), point.force));
    let left = |point: &SteadyPoint| (shown.of(point.velocity), point.modelled - point.force);
    let both = CurvePanel::new(
        "Friction (N)",
        220.0,
        vec![curve(found, fastest, 1.0), curve(found, fastest, -1.0), Curve::dots(measured, 1)],
    )
    .with_zero_line();
    let rest =
        CurvePanel::new("\u{394}F (N)", 76.0, vec![Curve::dots(points.iter().map(left), 1)]).with_zero_line();
    let end = 1.05 * shown.of(fastest);
    let chart = CurveChart {
        x_title: "Velocity (mm/s)".to_string(),
        x_range: [-end, end],
        panels: vec![both, rest],
        legend: vec![
            ("constant velocities, recorded".to_string(), CurveStyle::Dots(1)),
            ("identified curve".to_string(), CurveStyle::Line(0)),
        ],
    };
    let caption = "Friction over velocity: recorded at constant velocities, the identified steady curve, and what it leaves.";
    Some(chart.draw(&Words::new("friction_map", "Friction map", caption)))
}

/// The identified curve for one direction: finer where it is steep.
fn curve(found: &FrictionIdentification, fastest: f64, way: f64) -> Curve {
    let point = |step: u32| {
        let part = f64::from(step) / f64::from(CURVE_POINTS);
        let velocity = way * fastest * part * part * part;
        (DisplayUnit::MILLIMETRE.of(velocity), found.lugre.curve.steady_force(velocity))
    };
    Curve::line((1..=CURVE_POINTS).map(point), 0)
}

/// Force and position until the piston breaks away, and the residuals of both over time.
fn pressed(found: &FrictionIdentification, index: usize, press: &PressedRows) -> Option<Figure> {
    let recording = found.recordings.get(press.recording)?;
    let stem = stem(&recording.file);
    let caption = "The piston is pressed and does not yet slide: force and displacement as recorded, by the identified friction, and what is left of both.";
    let title = format!("Before the piston breaks away, {stem}");
    let words = Words::new(format!("pressed_{stem}"), title, caption);
    let curve = found.pressed_curve(index)?;
    Some(over_time(words, &curve, recording.time_step, press.rows))
}

/// Number of drawn rows of a shaken piston, so that each period can be seen.
const SHAKEN_ROWS: usize = 500;

/// Force and position of the first rows of a piston that is shaken.
fn shaken(found: &FrictionIdentification, index: usize, shake: &ShakenRows) -> Option<Figure> {
    let recording = found.recordings.get(shake.recording)?;
    let stem = stem(&recording.file);
    let caption = "The piston is shaken on its bristles: force and displacement as recorded, by the identified friction, and what is left of both; the first rows.";
    let words = Words::new(format!("shaken_{stem}"), format!("The shaken piston, {stem}"), caption);
    let rows = shake.force.rows.min(SHAKEN_ROWS);
    Some(over_time(words, found.shaken_curve(index)?, recording.time_step, rows))
}

fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

fn over_time(words: Words, curve: &PressedCurve, time_step: f64, rows: usize) -> Figure {
    let micrometres = |value: &f64| 1e3 * DisplayUnit::MILLIMETRE.of(*value);
    let time = |row: usize| DisplayUnit::MILLISECOND.of(row as f64 * time_step);
    let over_time = |values: Vec<f64>| -> Vec<(f64, f64)> {
        values.into_iter().take(rows).enumerate().map(|(row, value)| (time(row), value)).collect()
    };
    let less = |model: &[f64], shown: &[f64]| -> Vec<f64> {
        model.iter().zip(shown).map(|(model, shown)| model - shown).collect()
    };
    let PressedCurve { forces, positions, modelled_forces, modelled_positions } = curve;
    let moved: Vec<f64> = positions.iter().map(micrometres).collect();
    let modelled: Vec<f64> = modelled_positions.iter().map(micrometres).collect();
    let rest = over_time(less(&modelled, &moved));
    let force_rest = over_time(less(modelled_forces, forces));
    let [shown, explained] = [forces, modelled_forces].map(|forces| over_time(forces.clone()));
    let panels = vec![
        CurvePanel::new("Force (N)", 110.0, vec![Curve::dots(shown, 1), Curve::line(explained, 0)]),
        CurvePanel::new("\u{394}F (N)", 62.0, vec![Curve::dots(force_rest, 1)]).with_zero_line(),
        CurvePanel::new(
            "Displacement (\u{b5}m)",
            130.0,
            vec![Curve::dots(over_time(moved), 1), Curve::line(over_time(modelled), 0)],
        ),
        CurvePanel::new("\u{394}x (\u{b5}m)", 62.0, vec![Curve::dots(rest, 1)]).with_zero_line(),
    ];
    let chart = CurveChart {
        x_title: "Time (ms)".to_string(),
        x_range: [0.0, time(rows)],
        panels,
        legend: vec![
            ("recorded".to_string(), CurveStyle::Dots(1)),
            ("identified friction".to_string(), CurveStyle::Line(0)),
        ],
    };
    chart.draw(&words)
}
