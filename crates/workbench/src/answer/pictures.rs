use super::OutputFile;
use crate::figure::{Figure, FigureError, png};

/// Pixels of a PNG per unit of the drawing.
const PNG_SCALE: f64 = 2.0;

/// Figures as SVG.
pub(crate) fn picture_files(figures: &[Figure]) -> Vec<OutputFile> {
    let file = |figure: &Figure| OutputFile::new(format!("{}.svg", figure.name), figure.to_svg_standalone());
    figures.iter().map(file).collect()
}

/// The PNG of a drawing, which is written with it: 2 pixels to a unit of its view box; `None` for a
/// file that is not an SVG drawing.
///
/// # Errors
/// A drawing that the rasteriser rejects.
///
/// # Example
/// ```
/// use phea_workbench::answer::{OutputFile, picture_of};
/// let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 40 30\"/>";
/// let picture = picture_of(&OutputFile::new("empty.svg", svg))?.ok_or("not drawn")?;
/// assert_eq!(picture.name, "empty.png");
/// assert!(picture.bytes.starts_with(b"\x89PNG"));
/// assert_eq!(picture_of(&OutputFile::new("runs.csv", "time_s\n"))?, None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn picture_of(file: &OutputFile) -> Result<Option<OutputFile>, FigureError> {
    picture_at(file, PNG_SCALE)
}

/// The PNG of a drawing with this many pixels to a unit of its view box, as [`picture_of`].
///
/// # Errors
/// As [`picture_of`].
pub fn picture_at(file: &OutputFile, scale: f64) -> Result<Option<OutputFile>, FigureError> {
    let drawing = file.name.strip_suffix(".svg").zip(std::str::from_utf8(&file.bytes).ok());
    let Some((name, svg)) = drawing else { return Ok(None) };
    let Some([width, height]) = view_box(svg) else { return Ok(None) };
    Ok(Some(OutputFile::new(format!("{name}.png"), png::render(svg, width, height, scale)?)))
}

/// Width and height of a drawing.
fn view_box(svg: &str) -> Option<[f64; 2]> {
    let (_, after) = svg.split_once("viewBox=\"")?;
    let (numbers, _) = after.split_once('"')?;
    let mut numbers = numbers.split_whitespace().skip(2).map(str::parse);
    Some([numbers.next()?.ok()?, numbers.next()?.ok()?])
}
