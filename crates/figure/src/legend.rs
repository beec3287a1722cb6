//! Legend below the axes, where it covers no data.

use super::LABEL_SIZE;
use super::marker::{MarkerStyle, draw_marker};
use super::scene::{Anchor, Baseline, Fill, Rectangle, Scene, Stroke, Text, point};
use super::series::series_stroke;
use super::typeset;

const SWATCH: f64 = 30.0;
/// Width of the sample of a marker without a line.
const NARROW: f64 = 14.0;
const GAP: f64 = 7.0;
const BETWEEN: f64 = 20.0;
/// Height of a row.
pub const ROW: f64 = 19.0;

/// Legend entry with any of a line, a marker and an area.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    /// Name, with markup.
    pub text: String,
    /// Line.
    pub stroke: Option<Stroke>,
    /// Marker.
    pub marker: Option<MarkerStyle>,
    /// Area.
    pub fill: Option<Fill>,
}

impl LegendEntry {
    /// Entry for a line.
    pub fn line(text: impl Into<String>, stroke: Stroke) -> Self {
        LegendEntry { text: text.into(), stroke: Some(stroke), marker: None, fill: None }
    }

    /// Entries for the lines of series, each in its colour.
    pub(crate) fn of_series<'n>(names: impl IntoIterator<Item = &'n String>) -> Vec<LegendEntry> {
        let entry = |(index, name): (usize, &String)| LegendEntry::line(name, series_stroke(index));
        names.into_iter().enumerate().map(entry).collect()
    }

    /// Note on the whole figure, without a sample.
    pub fn note(text: impl Into<String>) -> Self {
        LegendEntry { text: text.into(), stroke: None, marker: None, fill: None }
    }

    /// Entry for a marker.
    pub fn marker(text: impl Into<String>, marker: MarkerStyle) -> Self {
        LegendEntry { text: text.into(), stroke: None, marker: Some(marker), fill: None }
    }

    /// Entry for an area.
    pub fn area(text: impl Into<String>, fill: Fill) -> Self {
        LegendEntry { text: text.into(), stroke: None, marker: None, fill: Some(fill) }
    }
}

/// Width of the sample with the gap after it.
fn swatch(entry: &LegendEntry) -> f64 {
    match (entry.stroke.is_none() && entry.fill.is_none(), entry.marker) {
        (true, None) => 0.0,
        (true, Some(_)) => NARROW + GAP,
        (false, _) => SWATCH + GAP,
    }
}

/// Entries distributed over rows of the given width: each with its offset from the left.
fn rows(entries: &[LegendEntry], width: f64) -> Vec<Vec<(f64, String, &LegendEntry)>> {
    let mut result: Vec<Vec<(f64, String, &LegendEntry)>> = Vec::new();
    let mut x = 0.0;
    for entry in entries {
        let text = typeset::fitted(&entry.text, LABEL_SIZE, width - swatch(entry));
        let length = swatch(entry) + typeset::width(&text, LABEL_SIZE);
        if result.is_empty() || x + length > width {
            result.push(Vec::new());
            x = 0.0;
        }
        if let Some(row) = result.last_mut() {
            row.push((x, text, entry));
        }
        x += length + BETWEEN;
    }
    result
}

/// Height of the legend at a given width.
pub fn height(entries: &[LegendEntry], width: f64) -> f64 {
    ROW * rows(entries, width).len() as f64
}

/// Draws the legend with its upper left corner at the given position.
pub fn draw(scene: &mut Scene, entries: &[LegendEntry], left: f64, top: f64, width: f64) {
    for (index, row) in rows(entries, width).into_iter().enumerate() {
        let middle = top + ROW * (index as f64 + 0.5);
        for (offset, text, entry) in row {
            let x = left + offset;
            if let Some(fill) = entry.fill {
                let area = Rectangle { left: x, top: middle - 6.0, right: x + SWATCH, bottom: middle + 6.0 };
                let darker = Fill { opacity: (1.6 * fill.opacity).min(1.0), ..fill };
                scene.rectangle(area, None, Some(darker));
            }
            if let Some(stroke) = entry.stroke {
                scene.line(point(x, middle), point(x + SWATCH, middle), stroke);
            }
            if let Some(marker) = entry.marker {
                draw_marker(scene, point(x + 0.5 * (swatch(entry) - GAP), middle), marker, None);
            }
            let at = point(x + swatch(entry), middle);
            scene.text(Text::new(at, text, LABEL_SIZE).held(Anchor::Start, Baseline::Middle));
        }
    }
}
