//! Nichols chart: the open loop by phase and magnitude, with bounds, templates, contours of |T| and
//! violations.

mod boundary;
mod chart;
mod contour;

use num_complex::Complex64;
use phea_qft::bound::Bound;
use phea_qft::template::Template;

pub use boundary::{Boundary, boundaries};
pub use contour::magnitude_contour;

use super::bode::FrequencySeries;
use super::plot::Panel;
use super::{Figure, Words};
use chart::PlacedChart;

/// Usual contours of |T| in a chart, dB.
pub const USUAL_CONTOURS_DB: [f64; 10] = [6.0, 3.0, 1.0, 0.5, 0.0, -1.0, -3.0, -6.0, -12.0, -20.0];

/// Bounds of one specification, or of several together.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundGroup<'a> {
    /// Name, such as `|T| <= 1.2`.
    pub name: String,
    /// Bounds, one for each frequency.
    pub bounds: &'a [Bound],
}

/// Plant and frequency of a violation.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoopViolation {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Open loop L of the plant.
    pub open_loop: Complex64,
    /// Text, such as `|T| 19.2 dB over at 1304 rad/s`.
    pub text: String,
}

/// Open loop by phase and magnitude, with the limits that it must satisfy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NicholsChart<'a> {
    /// Open loops; templates and the texts of marks are placed at the first.
    pub loops: Vec<FrequencySeries>,
    /// Marked frequencies on the loops, rad/s.
    pub design_frequencies_rad_per_s: Vec<f64>,
    /// Bounds; groups are distinguished by dash patterns, frequencies by colour.
    pub bounds: Vec<BoundGroup<'a>>,
    /// Templates, drawn at the nominal loop.
    pub templates: &'a [Template],
    /// Violations of specifications.
    pub violations: Vec<OpenLoopViolation>,
    /// Contours of |T|, dB.
    pub contours_db: Vec<f64>,
}

impl NicholsChart<'_> {
    /// Draws the chart.
    pub fn draw(&self, words: &Words) -> Figure {
        let placed = PlacedChart::new(self);
        let panels = vec![Panel::new(placed.y.clone(), 440.0, placed.all_marks())];
        let (x, legend) = (placed.x.clone(), placed.legend());
        words.with_plot(x, panels, legend)
    }
}
