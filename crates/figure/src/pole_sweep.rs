//! Poles over a number that is swept: how fast, how damped, and the stiffness that makes them so.

use num_complex::Complex64;
use phea_dynamics::portable::magnitude;

use super::axis::{Axis, Scale, extent};
use super::colour::series_role;
use super::legend::LegendEntry;
use super::plot::{Mark, Marker, MarkerStyle, Panel};
use super::series::series_stroke;
use super::{Figure, Words};
use phea_quantity::{DisplayUnit, MotionKind};

/// What is known at one value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoleSweepPoint {
    /// SI.
    pub value: f64,
    /// rad/s.
    pub poles: Vec<Complex64>,
    /// Least and greatest over the stroke, N/m.
    pub stiffness_n_per_m: [f64; 2],
    /// Bandwidth of the closed loop, rad/s, where there is one.
    pub bandwidth_rad_per_s: Option<f64>,
}

/// Poles, damping and stiffness over a number.
#[derive(Clone, Debug, PartialEq)]
pub struct PoleSweep {
    /// What is swept.
    pub quantity: String,
    /// Its unit.
    pub unit: DisplayUnit,
    /// Motion of the rig.
    pub motion: MotionKind,
    /// The unit of K_H.
    pub stiffness_unit: DisplayUnit,
    /// Whether its axis is logarithmic.
    pub by_ratio: bool,
    /// In order.
    pub points: Vec<PoleSweepPoint>,
}

impl PoleSweep {
    /// Draws the figure.
    pub fn draw(&self, words: &Words) -> Figure {
        let (from, to) = extent(self.points.iter().map(|point| self.unit.of(point.value)));
        let title = self.unit.title(&self.quantity);
        let x = if self.by_ratio && from > 0.0 {
            Axis::logarithmic(title, from, to)
        } else {
            Axis::linear(title, from, to)
        };
        let mut panels = vec![self.poles(), self.damping(), self.stiffness()];
        // markers at both ends are not cut
        let room = if x.scale == Scale::Linear { 0.02 * (to - from) } else { 0.0 };
        let x = Axis { minimum: x.minimum - room, maximum: x.maximum + room, ..x };
        panels.retain(|panel| !panel.marks.is_empty());
        words.with_plot(x, panels, self.legend())
    }

    /// Of each value, the pairs of the upper half plane.
    fn each(&self) -> impl Iterator<Item = (f64, Complex64)> {
        self.points.iter().flat_map(|point| {
            let upper = point.poles.iter().filter(|pole| pole.im >= 0.0);
            upper.map(|pole| (self.unit.of(point.value), *pole))
        })
    }

    fn poles(&self) -> Panel {
        let markers = |complex: bool, style: MarkerStyle| {
            let chosen = self.each().filter(|(_, pole)| (pole.im > 0.0) == complex);
            let points = chosen.map(|(value, pole)| (value, magnitude(pole), String::new())).collect();
            Mark::Markers { points, style }
        };
        let bandwidth: Vec<(f64, f64)> = self.bandwidths().collect();
        let values =
            self.each().map(|(_, pole)| magnitude(pole)).chain(bandwidth.iter().map(|point| point.1));
        let y = Axis::fit_logarithmic("Pole (rad/s)", values.filter(|value| *value > 0.0));
        let mut marks = Vec::new();
        if !bandwidth.is_empty() {
            marks.push(Mark::Line { points: bandwidth, stroke: series_stroke(BANDWIDTH) });
        }
        marks.extend([markers(false, REAL), markers(true, COMPLEX)]);
        Panel::new(y, 230.0, marks)
    }

    fn bandwidths(&self) -> impl Iterator<Item = (f64, f64)> {
        self.points.iter().filter_map(|point| Some((self.unit.of(point.value), point.bandwidth_rad_per_s?)))
    }

    fn damping(&self) -> Panel {
        let of_pair = self.each().filter(|(_, pole)| pole.im > 0.0);
        let ratios: Vec<(f64, f64)> =
            of_pair.map(|(value, pole)| (value, -pole.re / magnitude(pole))).collect();
        let values = ratios.iter().map(|point| point.1);
        // a ringing pair and a well damped one lie decades apart; a pair that grows has no
        // logarithm
        let y = match ratios.iter().all(|point| point.1 > 0.0) {
            true => Axis::fit_logarithmic("Damping ratio ζ", values),
            false => Axis::fit_linear("Damping ratio ζ", values.chain([0.0])),
        };
        let points: Vec<_> = ratios.into_iter().map(|(value, ratio)| (value, ratio, String::new())).collect();
        let marks = if points.is_empty() { vec![] } else { vec![Mark::Markers { points, style: COMPLEX }] };
        Panel::new(y, 110.0, marks)
    }

    fn stiffness(&self) -> Panel {
        let unit = self.stiffness_unit;
        let line = |end: usize, index: usize| {
            let points = self.points.iter();
            let points: Vec<(f64, f64)> = points
                .map(|point| (self.unit.of(point.value), unit.of(point.stiffness_n_per_m[end])))
                .collect();
            Mark::Line { points, stroke: series_stroke(index) }
        };
        let values = self.points.iter().flat_map(|point| point.stiffness_n_per_m).map(|value| unit.of(value));
        let y = Axis::fit_linear(unit.title(self.motion.symbols().stiffness), values.chain([0.0]));
        Panel::new(y, 130.0, vec![line(0, LEAST), line(1, GREATEST)])
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let mut legend =
            vec![LegendEntry::marker("real pole", REAL), LegendEntry::marker("pair of poles, |p|", COMPLEX)];
        if self.bandwidths().next().is_some() {
            legend.push(LegendEntry::line("bandwidth of the loop", series_stroke(BANDWIDTH)));
        }
        let symbol = self.motion.symbols().stiffness;
        legend.push(LegendEntry::line(format!("least {symbol}"), series_stroke(LEAST)));
        legend.push(LegendEntry::line(format!("greatest {symbol}"), series_stroke(GREATEST)));
        legend
    }
}

const REAL: MarkerStyle = MarkerStyle { marker: Marker::Cross, role: series_role(0), radius: 4.5 };
const COMPLEX: MarkerStyle = MarkerStyle { marker: Marker::Circle, role: series_role(1), radius: 3.5 };
const BANDWIDTH: usize = 2;

const LEAST: usize = 3;
const GREATEST: usize = 4;
