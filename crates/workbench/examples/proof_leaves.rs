//! Draws the leaves of a proof against the number of uncertain parameters from what the bench
//! `proof` of phea-qft measured: `cargo run -p phea-workbench --example proof_leaves --
//! book/src/images`.
//!
//! Reads the committed measurement, writes `proof_leaves.svg` into the folder, and a PNG with the
//! second word `png`.

use std::{env, fs, io, path::PathBuf};

use phea_workbench::figure::Figure;
use phea_workbench::figure::axis::Axis;
use phea_workbench::figure::colour::{Role, series_role};
use phea_workbench::figure::legend::LegendEntry;
use phea_workbench::figure::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel, Plot};
use phea_workbench::figure::scene::{Dash, Stroke};
use phea_workbench::figure::series::series_marker;

const MEASURED: &str = include_str!("../../../benches/peers/proof_leaves.csv");
/// Boxes that interval arithmetic may look at.
const BOXES_MAXIMUM: f64 = 3e6;

fn main() -> io::Result<()> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "book/src/images".to_string()));
    fs::create_dir_all(&folder)?;
    let figure = figure();
    fs::write(folder.join("proof_leaves.svg"), figure.to_svg_standalone())?;
    if env::args().nth(2).is_some_and(|word| word == "png") {
        fs::write(folder.join("proof_leaves.png"), figure.to_png(2.0).map_err(io::Error::other)?)?;
    }
    Ok(())
}

/// Parameters, leaves of the proof, boxes that interval arithmetic showed, and the fraction of the
/// whole that these are.
fn rows() -> Vec<[f64; 4]> {
    let rows = MEASURED.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let wanted = rows.filter(|row| row.len() == 9 && row[0] == "parameters");
    wanted
        .filter_map(|row| {
            Some([row[1].parse().ok()?, row[3].parse().ok()?, row[6].parse().ok()?, row[8].parse().ok()?])
        })
        .collect()
}

fn figure() -> Figure {
    let rows = rows();
    let unmarked = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| (x, y, String::new())).collect();
    let proof: Vec<(f64, f64)> = rows.iter().map(|row| (row[0], row[1])).collect();
    let shown: Vec<(f64, f64)> =
        rows.iter().filter(|row| row[3] >= 1.0).map(|row| (row[0], row[2])).collect();
    let open: Vec<(f64, f64)> =
        rows.iter().filter(|row| row[3] < 1.0).map(|row| (row[0], BOXES_MAXIMUM)).collect();
    let [of_proof, of_intervals] = [0, 1].map(|index| Stroke::solid(series_role(index), 2.0));
    let not_shown = MarkerStyle { marker: Marker::OpenSquare, ..series_marker(1) };
    let marks = vec![
        Mark::Reference {
            direction: AxisDirection::Y,
            at: BOXES_MAXIMUM,
            stroke: Stroke::solid(Role::Muted, 1.2).dashed(Dash::Dashed),
            label: String::new(),
        },
        Mark::Line { points: proof.clone(), stroke: of_proof },
        Mark::Markers { points: unmarked(&proof), style: series_marker(0) },
        Mark::Line { points: shown.clone(), stroke: of_intervals },
        Mark::Markers { points: unmarked(&shown), style: series_marker(1) },
        Mark::Markers { points: unmarked(&open), style: not_shown },
    ];
    let legend = vec![
        LegendEntry { marker: Some(series_marker(0)), ..LegendEntry::line("control points", of_proof) },
        LegendEntry { marker: Some(series_marker(1)), ..LegendEntry::line("intervals", of_intervals) },
        LegendEntry::marker("intervals, not shown with 3 million boxes", not_shown),
    ];
    let plot = Plot {
        x: Axis::linear("Uncertain parameters", 0.5, 8.5),
        panels: vec![Panel::new(Axis::logarithmic("Leaves of the tree", 10.0, 1e7), 260.0, marks)],
        legend,
        equal_aspect: false,
    };
    Figure {
        name: "proof_leaves".to_string(),
        title: "Leaves of a proof".to_string(),
        caption: "|L/(1 + L)|, 0.5 dB above what is reached, under the designed controller.".to_string(),
        scene: plot.draw(),
    }
}
