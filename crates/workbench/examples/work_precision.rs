//! Draws work against precision from what `benches/peers/closed_loop_times.py` measured:
//! `cargo run -p phea-workbench --example work_precision -- book/src/images`.
//!
//! Reads the committed measurement, writes `work_precision.svg` into the folder, and a PNG with the
//! second word `png`.

use std::{env, fs, io, path::PathBuf};

use phea_workbench::figure::Figure;
use phea_workbench::figure::axis::Axis;
use phea_workbench::figure::colour::{Role, series_role};
use phea_workbench::figure::legend::LegendEntry;
use phea_workbench::figure::plot::{AxisDirection, Mark, Panel, Plot};
use phea_workbench::figure::scene::{Dash, Stroke};
use phea_workbench::figure::series::series_marker;

const MEASURED: &str = include_str!("../../../benches/peers/work_precision.csv");
/// Names in the table, and in the legend.
const METHODS: [(&str, &str); 6] = [
    ("phea", "phea"),
    ("bdf_stability", "CVODE BDF, stability limit"),
    ("bdf", "CVODE BDF"),
    ("adams", "CVODE Adams, Newton"),
    ("adams_functional", "CVODE Adams, fixed point"),
    ("runge_kutta", "Runge-Kutta, fixed step"),
];

fn main() -> io::Result<()> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "book/src/images".to_string()));
    fs::create_dir_all(&folder)?;
    let figure = figure();
    fs::write(folder.join("work_precision.svg"), figure.to_svg_standalone())?;
    if env::args().nth(2).is_some_and(|word| word == "png") {
        fs::write(folder.join("work_precision.png"), figure.to_png(2.0).map_err(io::Error::other)?)?;
    }
    Ok(())
}

/// Error in N and time in ms of a method under a controller.
fn points(controller: &str, method: &str) -> Vec<(f64, f64)> {
    let rows = MEASURED.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let wanted = rows.filter(|row| row.len() == 5 && row[0] == controller && row[1] == method);
    wanted.filter_map(|row| Some((row[4].parse().ok()?, row[3].parse().ok()?))).collect()
}

fn figure() -> Figure {
    let panel = |controller: &str, title: &str| {
        let mut marks = vec![Mark::Reference {
            direction: AxisDirection::X,
            at: 0.02,
            stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dashed),
            label: "0.02 N".to_string(),
        }];
        for (index, (method, _)) in METHODS.iter().enumerate() {
            let points = points(controller, method);
            let stroke = Stroke::solid(series_role(index), if index == 0 { 2.6 } else { 1.6 });
            marks.push(Mark::Line { points: points.clone(), stroke });
            let points = points.into_iter().map(|(error, time)| (error, time, String::new())).collect();
            marks.push(Mark::Markers { points, style: series_marker(index) });
        }
        Panel::new(Axis::logarithmic(title, 0.2, 500.0), 250.0, marks)
    };
    let legend = METHODS.iter().enumerate().map(|(index, (_, name))| LegendEntry {
        marker: Some(series_marker(index)),
        ..LegendEntry::line(*name, Stroke::solid(series_role(index), 1.6))
    });
    let plot = Plot {
        x: Axis::logarithmic("Largest error of the force (N)", 1e-6, 100.0),
        panels: vec![
            panel("continuous", "Time per run (ms), continuous"),
            panel("sampled", "Time per run (ms), sampled at 1 kHz"),
        ],
        legend: legend.collect(),
        equal_aspect: false,
    };
    Figure {
        name: "work_precision".to_string(),
        title: "Work against precision".to_string(),
        caption: "Five seconds of the closed loop on one core.".to_string(),
        scene: plot.draw(),
    }
}
