//! Line and marker of each series: by its index, colour, dash pattern and shape together.

use super::colour::{SERIES_COUNT, series_role};
use super::marker::{Marker, MarkerStyle};
use super::scene::{Dash, Stroke};

/// Line of the series with this index: colour and dash pattern together. After the last colour they
/// repeat with other patterns, so that the first 64 lines differ.
///
/// # Example
/// ```
/// use phea_figure::series::series_stroke;
/// let strokes: Vec<_> = (0..64).map(series_stroke).collect();
/// assert!((0..64).all(|one| (0..one).all(|other| strokes[one] != strokes[other])));
/// ```
pub const fn series_stroke(index: usize) -> Stroke {
    Stroke { role: series_role(index), width: 2.0, dash: series_dash(index) }
}

/// Dash pattern of the series with this index.
pub(crate) const fn series_dash(index: usize) -> Dash {
    match (index + 7 * (index / SERIES_COUNT as usize)) % 8 {
        0 => Dash::Solid,
        1 => Dash::Dashed,
        2 => Dash::DashDot,
        3 => Dash::Dotted,
        4 => Dash::LongDash,
        5 => Dash::DashDotDot,
        6 => Dash::ShortDash,
        _ => Dash::LongShort,
    }
}

/// Marker of the series with this index.
pub const fn series_marker(index: usize) -> MarkerStyle {
    let marker = match index % 6 {
        0 => Marker::Circle,
        1 => Marker::Square,
        2 => Marker::Triangle,
        3 => Marker::Diamond,
        4 => Marker::Cross,
        _ => Marker::Plus,
    };
    MarkerStyle { marker, role: series_role(index), radius: 4.0 }
}
