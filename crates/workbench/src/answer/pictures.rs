use super::OutputFile;
use crate::figure::{Figure, FigureError};

/// Pixels of a PNG per unit of the drawing.
pub(crate) const PNG_SCALE: f64 = 2.0;

/// Figures as SVG and PNG.
///
/// # Errors
/// A figure that the rasteriser rejects.
pub(crate) fn picture_files(figures: &[Figure]) -> Result<Vec<OutputFile>, FigureError> {
    part_files(figures, "")
}

/// The same for a part, whose name follows that of the figure.
pub(crate) fn part_files(figures: &[Figure], part: &str) -> Result<Vec<OutputFile>, FigureError> {
    let mut files = Vec::new();
    for figure in figures {
        let file = |ending: &str, bytes| OutputFile::new(format!("{}{part}.{ending}", figure.name), bytes);
        files.push(file("svg", figure.to_svg_standalone().into_bytes()));
        files.push(file("png", figure.to_png(PNG_SCALE)?));
    }
    Ok(files)
}
