//! A standalone SVG as PNG bytes.
//!
//! The only font is the embedded one: the fonts and settings of the computer have no effect.

use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use super::FigureError;
use super::typeset::FONT;

/// Largest number of pixels of a picture: 40 million, 160 MB while it is drawn.
const PIXEL_LIMIT: f64 = 4.0e7;

/// Draws SVG text of the given size, `scale` pixels to a view box unit.
pub fn render(svg: &str, width: f64, height: f64, scale: f64) -> Result<Vec<u8>, FigureError> {
    let (columns, rows) = ((width * scale).ceil(), (height * scale).ceil());
    let drawable = columns >= 1.0 && rows >= 1.0 && columns * rows <= PIXEL_LIMIT;
    if !drawable {
        return Err(FigureError::ScaleOutOfRange { scale, width, height });
    }
    let tree = Tree::from_str(svg, options()).map_err(|error| FigureError::Raster(error.to_string()))?;
    // both are whole numbers between 1 and 4e7
    let mut pixmap = Pixmap::new(columns as u32, rows as u32).ok_or(FigureError::ScaleOutOfRange {
        scale,
        width,
        height,
    })?;
    let factor = scale as f32;
    resvg::render(&tree, Transform::from_scale(factor, factor), &mut pixmap.as_mut());
    pixmap.encode_png().map_err(|error| FigureError::Raster(error.to_string()))
}

fn options() -> &'static Options<'static> {
    static OPTIONS: OnceLock<Options<'static>> = OnceLock::new();
    OPTIONS.get_or_init(|| {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(FONT.to_vec());
        Options { fontdb: Arc::new(fonts), font_family: "DejaVu Sans".to_string(), ..Options::default() }
    })
}
