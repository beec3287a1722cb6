//! Renders every figure with numbers of Ledezma (2019): `cargo run --example figures -- DIRECTORY`.
//!
//! Writes an SVG, a light and a dark PNG of each, and a page that shows all of them under the style
//! sheet.

mod gallery;

use std::{env, fs, io, path::PathBuf};

use phea_figure::{Figure, Theme, png, style_sheet};

fn main() -> io::Result<()> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "figures".to_string()));
    fs::create_dir_all(&folder)?;
    let figures = gallery::all();
    for figure in &figures {
        fs::write(folder.join(format!("{}.svg", figure.name)), figure.to_svg_standalone())?;
        fs::write(
            folder.join(format!("{}.png", figure.name)),
            figure.to_png(2.0).map_err(io::Error::other)?,
        )?;
        let dark = figure.to_svg_themed(Theme::Dark);
        let bytes =
            png::render(&dark, figure.scene.width, figure.scene.height, 2.0).map_err(io::Error::other)?;
        fs::write(folder.join(format!("{}-dark.png", figure.name)), bytes)?;
    }
    fs::write(folder.join("index.html"), page(&figures))
}

fn page(figures: &[Figure]) -> String {
    let body: String = figures
        .iter()
        .map(|figure| {
            format!(
                "<figure><h2>{}</h2>{}<figcaption>{}</figcaption></figure>\n",
                figure.title,
                figure.to_svg_inline(),
                figure.caption
            )
        })
        .collect();
    format!(
        "<!doctype html><meta charset=\"utf-8\"><title>Figures</title><style>{}\
         body{{background:var(--figure-background);color:var(--figure-text);font:16px sans-serif;max-width:680px;\
         margin:2em auto}}</style>\n{body}",
        style_sheet()
    )
}
