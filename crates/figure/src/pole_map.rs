//! Poles and zeros in the complex plane, linear or signed logarithmic, with damping ratios and
//! natural frequencies.

use num_complex::Complex64;
use phea_dynamics::portable::{cos, pow, sin};

use super::axis::{Axis, Scale};
use super::colour::{Role, series_role};
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel, Plot, PointSide};
use super::scene::{Dash, Fill, Stroke};
use super::ticks::{decimal_power, floor_log10, plain};
use super::{Figure, Words};

/// Poles and zeros of one model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoleSeries {
    /// Model.
    pub name: String,
    /// Poles, rad/s.
    pub poles: Vec<Complex64>,
    /// Zeros, rad/s.
    pub zeros: Vec<Complex64>,
}

/// Scale of both axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoleMapScale {
    /// Linear, with equal scales on both axes.
    Linear,
    /// Signed logarithmic on both axes: shows poles at -0.3 and -1000 rad/s together.
    SignedLogarithmic,
}

/// The poles and zeros of models.
#[derive(Clone, Debug, PartialEq)]
pub struct PoleMap {
    /// Models; each has its own shape of pole marker.
    pub series: Vec<PoleSeries>,
    /// Scale.
    pub scale: PoleMapScale,
    /// Damping ratios drawn, between 0 and 1.
    pub damping_ratios: Vec<f64>,
    /// Natural frequencies drawn, rad/s.
    pub natural_frequencies_rad_per_s: Vec<f64>,
}

impl PoleMap {
    /// Draws the map.
    pub fn draw(&self, words: &Words) -> Figure {
        let (x, y) = self.axes();
        let mut marks = vec![Mark::band(AxisDirection::X, [0.0, f64::INFINITY], unstable_fill())];
        self.grid(&mut marks, &x, &y);
        let axis_stroke = Stroke::solid(Role::Axis, 1.2);
        for direction in [AxisDirection::X, AxisDirection::Y] {
            marks.push(Mark::reference(direction, 0.0, axis_stroke, ""));
        }
        let mut legend = Vec::new();
        for (index, series) in self.series.iter().enumerate() {
            roots(&mut marks, &series.poles, pole_style(index), &format!("{}: pole", series.name));
            roots(&mut marks, &series.zeros, zero_style(index), &format!("{}: zero", series.name));
            legend.push(LegendEntry::marker(format!("poles, {}", series.name), pole_style(index)));
            if !series.zeros.is_empty() {
                legend.push(LegendEntry::marker(format!("zeros, {}", series.name), zero_style(index)));
            }
        }
        if !self.damping_ratios.is_empty() || !self.natural_frequencies_rad_per_s.is_empty() {
            legend.push(LegendEntry::line("damping ratio ζ and natural frequency", grid_stroke()));
        }
        legend.push(LegendEntry::area("unstable half plane", unstable_fill()));
        let panels = vec![Panel::new(y, 380.0, marks)];
        words.with_scene(Plot { x, panels, legend, equal_aspect: self.scale == PoleMapScale::Linear }.draw())
    }

    fn axes(&self) -> (Axis, Axis) {
        let all = || self.series.iter().flat_map(|series| series.poles.iter().chain(&series.zeros));
        let (re, im) = ("Real part (rad/s)", "Imaginary part (rad/s)");
        match self.scale {
            PoleMapScale::Linear => {
                let y = Axis::fit_linear(im, all().flat_map(|z| [z.im, -z.im]));
                // a strip of the unstable half plane remains visible
                let strip = 0.2 * y.maximum;
                let x = Axis::fit_linear(re, all().map(|z| z.re).chain([0.0]));
                let (minimum, maximum) = (x.minimum.min(-1.4 * y.maximum), x.maximum.max(strip));
                (Axis::linear(re, minimum, maximum), y)
            }
            PoleMapScale::SignedLogarithmic => {
                let parts =
                    || all().flat_map(|z| [z.re.abs(), z.im.abs()]).filter(|v| v.is_finite() && *v > 0.0);
                let largest = parts().fold(0.0, f64::max);
                let smallest = parts().fold(f64::INFINITY, f64::min).max(largest * 1e-7);
                let limit = if smallest.is_finite() { decimal_power(floor_log10(smallest)) } else { 1.0 };
                // equal extent up and down, so that a real pole is on the middle line
                (
                    Axis::fit_signed_logarithmic(re, all().map(|z| z.re), limit),
                    Axis::fit_signed_logarithmic(im, all().flat_map(|z| [z.im, -z.im]), limit),
                )
            }
        }
    }

    /// Lines of constant damping ratio and constant natural frequency in the left half plane,
    /// labelled at their ends.
    fn grid(&self, marks: &mut Vec<Mark>, x: &Axis, y: &Axis) {
        let reach = x.minimum.abs().max(y.maximum.abs());
        let least = match x.scale {
            Scale::SignedLogarithmic { limit } => 1e-3 * limit,
            _ => 1e-6 * reach,
        };
        for &ratio in &self.damping_ratios {
            let height = (1.0 - ratio * ratio).max(0.0).sqrt();
            let at = |radius: f64, sign: f64| (-ratio * radius, sign * height * radius);
            for sign in [1.0, -1.0] {
                let points: Vec<(f64, f64)> = (0..=120)
                    .map(|i| at(least * pow(2.0 * reach / least, f64::from(i) / 120.0), sign))
                    .collect();
                marks.push(Mark::Line { points, stroke: grid_stroke() });
            }
            let farthest = (x.minimum.abs() / ratio.max(1e-9)).min(y.maximum / height.max(1e-9));
            let places = PLACES.map(|part| at(part * farthest, 1.0)).to_vec();
            let text = format!("ζ {}", plain(ratio));
            marks.push(Mark::Label { at: places, text, role: Role::Muted, side: PointSide::On });
        }
        for &frequency in &self.natural_frequencies_rad_per_s {
            let points: Vec<(f64, f64)> = (0..=90)
                .map(|i| {
                    let angle = f64::from(i).mul_add(2.0, 90.0).to_radians();
                    (frequency * cos(angle), frequency * sin(angle))
                })
                .collect();
            marks.push(Mark::Line { points, stroke: grid_stroke() });
            let places = [250.0_f64, 235.0, 220.0, 260.0, 205.0, 265.0]
                .map(|degrees| degrees.to_radians())
                .map(|angle| (frequency * cos(angle), frequency * sin(angle)))
                .to_vec();
            let text = format!("{} rad/s", plain(frequency));
            marks.push(Mark::Label { at: places, text, role: Role::Muted, side: PointSide::On });
        }
    }
}

fn unstable_fill() -> Fill {
    Fill { role: Role::Bad, opacity: 0.1 }
}

/// Marker shapes that stay visible when models have a common pole.
fn pole_style(index: usize) -> MarkerStyle {
    let (marker, radius) = match index % 4 {
        0 => (Marker::Cross, 5.0),
        1 => (Marker::Plus, 6.5),
        2 => (Marker::OpenDiamond, 7.5),
        _ => (Marker::OpenSquare, 8.5),
    };
    MarkerStyle { marker, role: series_role(index), radius }
}

fn zero_style(index: usize) -> MarkerStyle {
    MarkerStyle { marker: Marker::Ring, role: series_role(index), radius: 5.0 + 1.5 * (index % 3) as f64 }
}

fn roots(marks: &mut Vec<Mark>, roots: &[Complex64], style: MarkerStyle, what: &str) {
    let points = roots
        .iter()
        .map(|root| {
            let sign = if root.im < 0.0 { "\u{2212}" } else { "+" };
            let note = match root.im == 0.0 {
                true => format!("{what} at {} rad/s", plain(root.re)),
                false => format!("{what} at {} {sign} {}j rad/s", plain(root.re), plain(root.im.abs())),
            };
            (root.re, root.im, note)
        })
        .collect();
    marks.push(Mark::Markers { points, style });
}

/// Positions of a label along a line, as fractions of the distance to the frame.
const PLACES: [f64; 7] = [0.85, 0.7, 0.55, 0.4, 0.25, 0.12, 0.06];

fn grid_stroke() -> Stroke {
    Stroke::solid(Role::Muted, 1.0).dashed(Dash::Dotted)
}
