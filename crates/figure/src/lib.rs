//! Figures as plain values: numbers in, a scene of primitives out, SVG text and PNG bytes from it.
//!
//! ```text
//! numbers -> chart (BodeDiagram, Nomograph, ...) -> Figure { scene } -> to_svg_inline | to_svg_standalone | to_png
//! ```
//!
//! The layer is our own because one small list of primitives with roles for colours serves axes,
//! the circuit diagram, the nomograph and control charts, and lets one SVG follow a light or dark
//! page. The plotting libraries that were examined resolve every colour when they draw: plotters
//! 0.3 passes RGB values to its back ends; the themes of kuva 0.6 stop at axes and text, its clip
//! paths are numbered by a counter of the process, so the same figure drawn twice differs, and the
//! circuit diagram and the nomograph would have been separate drawings in either.
//!
//! Sizes: the view box is [`WIDTH`] units wide. Shown 680 px wide a unit is 1.21 px and the text of
//! axes (13 units) is 16 px; printed 85 mm wide a unit is 0.152 mm and that text is 5.6 pt, the
//! size of captions in a journal's column.

pub mod axis;
pub mod bode;
pub mod clip;
pub mod colour;
pub mod curve_chart;
pub mod estimated_response;
pub mod family_magnitude;
pub mod family_steps;
pub mod fan_chart;
pub mod impedance;
pub mod legend;
pub mod marker;
pub mod measured_response;
pub mod nichols;
pub mod nomograph;
mod open_loop;
pub mod pareto_front;
pub mod placement;
pub mod plot;
pub mod png;
pub mod pole_map;
pub mod pole_sweep;
pub mod prefilter_band;
pub mod scene;
pub mod schematic;
pub mod series;
pub mod simplify;
pub mod sizing_chart;
pub mod stiffness;
pub mod svg;
pub mod templates;
pub mod ticks;
pub mod tornado;
pub mod typeset;

pub use bode::{BodeDiagram, FrequencySeries};
pub use colour::{Theme, style_sheet};
pub use curve_chart::{Curve, CurveChart, CurvePanel, CurveRange, CurveStyle, SettlingBand};
pub use estimated_response::EstimatedResponse;
pub use family_magnitude::{FamilyEnvelope, FamilyMagnitude, MagnitudeCurve, MagnitudeMark};
pub use family_steps::FamilySteps;
pub use fan_chart::{FanChart, TimeBand, TimeSeries};
pub use impedance::{AsymptoteLine, ImpedanceDiagram};
pub use measured_response::MeasuredResponse;
pub use nichols::{BoundGroup, NicholsChart, OpenLoopViolation, USUAL_CONTOURS_DB};
pub use nomograph::{Nomograph, NomographBore};
pub use pareto_front::{FrontPlace, ParetoCurve, ParetoFront, ParetoPoint};
pub use phea_quantity::{DisplayUnit, MotionKind};
pub use pole_map::{PoleMap, PoleMapScale, PoleSeries};
pub use pole_sweep::{PoleSweep, PoleSweepPoint};
pub use prefilter_band::{PrefilterPanel, PrefilterPoint, prefilter_band};
pub use schematic::{
    AccumulatorSymbol, ControllerSymbol, CrossPortSymbol, Environment, LineKind, LineSymbol, LinkageSymbol,
    Rods, Schematic, SeriesKind, SeriesSymbol, SupplyKind, TestCircuit, TestPorts,
};
pub use sizing_chart::{SizingCandidate, SizingChart, SizingCurve};
pub use stiffness::{StiffnessCurve, StiffnessDiagram, StiffnessOver};
pub use templates::templates;
pub use tornado::{Tornado, TornadoBar};

use axis::Axis;
use legend::LegendEntry;
use plot::{Panel, Plot};
use scene::Scene;
use svg::{SvgDestination, SvgNames};

/// Width of every figure's view box.
pub const WIDTH: f64 = 560.0;
/// Font size of axis titles.
pub(crate) const TITLE_SIZE: f64 = 13.5;
/// Font size of tick labels, legends and annotations.
pub(crate) const LABEL_SIZE: f64 = 13.0;
/// Smallest font size.
pub const SMALL_SIZE: f64 = 12.0;

/// Error for a figure that cannot become a PNG.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FigureError {
    /// A picture without pixels or with more than forty million.
    #[error("a scale of {scale} gives no drawable picture from {width} x {height} units")]
    ScaleOutOfRange {
        /// Pixels per unit.
        scale: f64,
        /// Width of the view box.
        width: f64,
        /// Height of the view box.
        height: f64,
    },
    /// SVG text that the rasteriser rejected.
    #[error("the picture could not be drawn: {0}")]
    Raster(String),
}

/// Marked frequency, such as a resonance.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyMark {
    /// Label, to which the value is added.
    pub label: String,
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
}

/// Name, title and caption of a figure.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Words {
    /// Name of files and of the anchor on a page, unique in a report.
    pub name: String,
    /// Short title.
    pub title: String,
    /// Interpretation of the figure, in a sentence or two.
    pub caption: String,
}

impl Words {
    /// Words from name, title and caption.
    pub fn new(name: impl Into<String>, title: impl Into<String>, caption: impl Into<String>) -> Self {
        Words { name: name.into(), title: title.into(), caption: caption.into() }
    }

    /// Figure of a scene.
    fn with_scene(&self, scene: Scene) -> Figure {
        let Words { name, title, caption } = self.clone();
        Figure { name, title, caption, scene }
    }

    /// Figure of panels on one x axis, with their legend.
    fn with_plot(&self, x: Axis, panels: Vec<Panel>, legend: Vec<LegendEntry>) -> Figure {
        self.with_scene(Plot { x, panels, legend, equal_aspect: false }.draw())
    }
}

/// Verdict of a procedure on a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CandidateVerdict {
    /// All requirements are satisfied.
    Accepted,
    /// Usable, with a reservation.
    Warned,
    /// Not usable.
    Rejected,
}

impl CandidateVerdict {
    /// Marker of the verdict: shape and colour both identify it.
    pub const fn marker(self) -> plot::MarkerStyle {
        match self {
            CandidateVerdict::Accepted => {
                plot::MarkerStyle { marker: plot::Marker::Circle, role: colour::Role::Good, radius: 5.5 }
            }
            CandidateVerdict::Warned => {
                plot::MarkerStyle { marker: plot::Marker::Triangle, role: colour::Role::Warning, radius: 5.5 }
            }
            CandidateVerdict::Rejected => {
                plot::MarkerStyle { marker: plot::Marker::Cross, role: colour::Role::Bad, radius: 4.5 }
            }
        }
    }

    /// Colour of the verdict.
    pub const fn role(self) -> colour::Role {
        self.marker().role
    }

    /// Name for legends.
    pub const fn label(self) -> &'static str {
        match self {
            CandidateVerdict::Accepted => "accepted",
            CandidateVerdict::Warned => "accepted with a warning",
            CandidateVerdict::Rejected => "rejected",
        }
    }

    /// All verdicts, best first.
    pub const ALL: [CandidateVerdict; 3] =
        [CandidateVerdict::Accepted, CandidateVerdict::Warned, CandidateVerdict::Rejected];
}

/// Picture with its title and caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name of files and of the anchor on a page, unique in a report.
    pub name: String,
    /// Short title.
    pub title: String,
    /// Interpretation of the figure, in a sentence or two.
    pub caption: String,
    /// Picture.
    pub scene: Scene,
}

impl Figure {
    /// SVG for a page with the [`style_sheet`]: follows light, dark and print.
    pub fn to_svg_inline(&self) -> String {
        self.write(SvgDestination::Page)
    }

    /// SVG for a file, in light colours.
    pub fn to_svg_standalone(&self) -> String {
        self.write(SvgDestination::File(Theme::Light))
    }

    /// SVG for a file, in the colours of a theme.
    pub fn to_svg_themed(&self, theme: Theme) -> String {
        self.write(SvgDestination::File(theme))
    }

    /// PNG bytes in light colours, with `scale` pixels per unit of the view box (2 gives 1120
    /// pixels of width).
    ///
    /// # Errors
    /// Scale that gives no pixel, or more than forty million.
    pub fn to_png(&self, scale: f64) -> Result<Vec<u8>, FigureError> {
        png::render(&self.to_svg_standalone(), self.scene.width, self.scene.height, scale)
    }

    fn write(&self, destination: SvgDestination) -> String {
        let names = SvgNames { identifier: &self.name, title: &self.title, description: &self.caption };
        svg::write(&self.scene, names, destination)
    }
}
