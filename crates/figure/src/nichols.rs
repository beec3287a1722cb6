//! Nichols chart: the open loop by phase and magnitude, with bounds, templates, contours of |T| and
//! what violates them.

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

/// Contours of |T| that a chart usually shows, dB.
pub const USUAL_CONTOURS_DB: [f64; 10] = [6.0, 3.0, 1.0, 0.5, 0.0, -1.0, -3.0, -6.0, -12.0, -20.0];

/// Bounds of one specification, or of several together.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundGroup<'a> {
    /// Such as `|T| <= 1.2`.
    pub name: String,
    /// One for each frequency.
    pub bounds: &'a [Bound],
}

/// A plant or frequency that violates something.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoopViolation {
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// L of the plant there.
    pub open_loop: Complex64,
    /// Such as `|T| 19.2 dB over at 1304 rad/s`.
    pub text: String,
}

/// The open loop by phase and magnitude, with the limits that it must satisfy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NicholsChart<'a> {
    /// Open loops; the first is the one at which templates and the words of marks are put.
    pub loops: Vec<FrequencySeries>,
    /// Frequencies to mark on the loops, rad/s.
    pub design_frequencies_rad_per_s: Vec<f64>,
    /// Bounds; groups are distinguished by their dashes, frequencies by colour.
    pub bounds: Vec<BoundGroup<'a>>,
    /// Templates, drawn where the nominal loop is.
    pub templates: &'a [Template],
    /// What violates a specification.
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
