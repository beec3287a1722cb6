//! Driving-point impedance Z = -F_e/(s X_L): magnitude with its asymptotes, phase, and the bands
//! where it is not passive.

use num_complex::Complex64;
use phea_dynamics::portable::{magnitude, pow};
use phea_quantity::MotionKind;

use super::axis::{Axis, extent};
use super::bode::{FrequencySeries, frequency_axis, mark_frequencies, unwrapped_degrees};
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, PointSide};
use super::scene::{Dash, Fill, Stroke};
use super::series::series_stroke;
use super::{Figure, FrequencyMark, Words};

/// Asymptote of the diagram: |Z| = coefficient * frequency^exponent.
#[derive(Clone, Debug, PartialEq)]
pub struct AsymptoteLine {
    /// Dominating element, such as `damper (A^2 + f_v K_c)/K_c`.
    pub label: String,
    /// |Z| at 1 rad/s, N.s/m.
    pub coefficient: f64,
    /// Exponent: 1 for a mass, 0 for a damper, -1 for a spring.
    pub exponent: i32,
    /// Lower end of the line, rad/s.
    pub from_rad_per_s: f64,
    /// Upper end of the line, rad/s.
    pub to_rad_per_s: f64,
}

/// Impedances with their asymptotes and bands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpedanceDiagram {
    /// Motion of the load.
    pub motion: MotionKind,
    /// Impedances in N.s/m, such as open and closed loop.
    pub series: Vec<FrequencySeries>,
    /// Asymptotes.
    pub asymptotes: Vec<AsymptoteLine>,
    /// Corner frequencies between regimes.
    pub corners: Vec<FrequencyMark>,
    /// Bands in rad/s where Re Z < 0.
    pub non_passive_bands_rad_per_s: Vec<(f64, f64)>,
    /// True to add the phase: passive between -90 and 90 degrees.
    pub with_phase: bool,
}

impl ImpedanceDiagram {
    /// Draws the figure.
    pub fn draw(&self, words: &Words) -> Figure {
        let x = frequency_axis(&self.series);
        let values = self.series.iter().flat_map(|s| s.response.iter().map(|z| magnitude(*z)));
        let mut marks: Vec<Mark> = self.bands("not passive");
        marks.extend(self.asymptotes.iter().map(|line| asymptote_line(line, &x)));
        marks.extend(self.curves(|response| response.iter().map(|z| magnitude(*z)).collect()));
        marks.extend(self.asymptotes.iter().map(|line| asymptote_label(line, &x)));
        let mut panels = vec![Panel::new(
            Axis::fit_logarithmic(self.motion.either("|Z| (N·s/m)", "|Z| (N·m·s/rad)"), values),
            290.0,
            marks,
        )];
        if self.with_phase {
            panels.push(self.phase_panel());
        }
        mark_frequencies(&mut panels, &self.corners);
        let mut legend = LegendEntry::of_series(self.series.iter().map(|series| &series.name));
        if !self.asymptotes.is_empty() {
            legend.push(LegendEntry::line("asymptotes", asymptote_stroke()));
        }
        if !self.non_passive_bands_rad_per_s.is_empty() {
            legend.push(LegendEntry::area("Re Z < 0: not passive", Fill::tint(Role::Bad)));
        }
        words.with_plot(x, panels, legend)
    }

    fn curves(&self, of: impl Fn(&[Complex64]) -> Vec<f64>) -> Vec<Mark> {
        self.series
            .iter()
            .enumerate()
            .map(|(index, series)| Mark::Line {
                points: series.frequencies_rad_per_s.iter().copied().zip(of(&series.response)).collect(),
                stroke: series_stroke(index),
            })
            .collect()
    }

    fn bands(&self, label: &str) -> Vec<Mark> {
        self.non_passive_bands_rad_per_s
            .iter()
            .map(|&(from, to)| Mark::Band {
                direction: AxisDirection::X,
                from,
                to,
                fill: Fill::tint(Role::Bad),
                hatched: true,
                label: label.to_string(),
            })
            .collect()
    }

    fn phase_panel(&self) -> Panel {
        // Re Z >= 0 bounds the phase of a passive impedance, so each curve starts from its
        // principal value
        let degrees = |response: &[Complex64]| unwrapped_degrees(response, None);
        let (low, high) = extent(self.series.iter().flat_map(|s| degrees(&s.response)));
        let mut marks = self.bands("");
        let stroke = Stroke::solid(Role::Bad, 1.2).dashed(Dash::LongDash);
        marks.extend([-90.0, 90.0].map(|limit| Mark::reference(AxisDirection::Y, limit, stroke, "")));
        marks.extend(self.curves(degrees));
        let y = Axis::fit_angle("arg Z (°)", [low, high, -95.0, 95.0]);
        Panel::new(y, 120.0, marks)
    }
}

fn asymptote_stroke() -> Stroke {
    Stroke::solid(Role::Axis, 1.3).dashed(Dash::Dashed)
}

fn asymptote_line(line: &AsymptoteLine, x: &Axis) -> Mark {
    let (from, to) = (line.from_rad_per_s.max(x.minimum), line.to_rad_per_s.min(x.maximum));
    let at = |w: f64| (w, line.coefficient * pow(w, f64::from(line.exponent)));
    Mark::Line { points: vec![at(from), at(to)], stroke: asymptote_stroke() }
}

fn asymptote_label(line: &AsymptoteLine, x: &Axis) -> Mark {
    let (from, to) = (line.from_rad_per_s.max(x.minimum), line.to_rad_per_s.min(x.maximum));
    let middle = (from * to).sqrt();
    let at = (middle, line.coefficient * pow(middle, f64::from(line.exponent)));
    let side = if line.exponent < 0 { PointSide::Right } else { PointSide::Above };
    Mark::Label { at: vec![at], text: line.label.clone(), role: Role::Text, side }
}
