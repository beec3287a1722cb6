//! Measured frequency response on the curves of its models: magnitude, phase, difference from the
//! first model, distortion.

use num_complex::Complex64;
use phea_dynamics::portable::argument;

use super::axis::Axis;
use super::bode::{BodeCurve, FrequencySeries, all, curves, decibels, frequency_axis, level_title, panel};
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle};
use super::{Figure, Words};

/// Measured response and its models.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredResponse {
    /// Quantity, such as `F_e/U_C`.
    pub quantity: String,
    /// Unit, such as `N/V`, which is 0 dB.
    pub unit: String,
    /// Models, of which the first is compared with the measured points.
    pub models: Vec<FrequencySeries>,
    /// Measured points.
    pub measured: FrequencySeries,
    /// First model at the measured points.
    pub model: Vec<Complex64>,
    /// Ratio of harmonics to the fundamental at each point, percent.
    pub distortion_percent: Vec<f64>,
}

const POINTS: MarkerStyle = MarkerStyle { marker: Marker::Ring, role: Role::Text, radius: 3.6 };

impl MeasuredResponse {
    /// Draws the figure.
    pub fn draw(&self, words: &Words) -> Figure {
        let quotients: Vec<Complex64> =
            self.measured.response.iter().zip(&self.model).map(|(machine, model)| machine / model).collect();
        let differences = decibels(&quotients);
        let angles: Vec<f64> = quotients.iter().map(|quotient| argument(*quotient).to_degrees()).collect();
        let curves = curves(&self.models, None);
        let measured = decibels(&self.measured.response);
        let measured_phase = self.near_first(&curves, &angles);
        let levels = all(&curves, |curve| &curve.decibels).chain(measured.iter().copied());
        let phases = all(&curves, |curve| &curve.degrees).chain(measured_phase.iter().copied());
        let low = |title: &str, values: &[f64]| {
            let mut low =
                panel(Axis::fit_linear(title, values.iter().copied().chain([0.0])), 90.0, &[], |c| {
                    &c.degrees
                });
            low.marks.push(Mark::dotted(AxisDirection::Y, 0.0, ""));
            low
        };
        let title = level_title(&self.quantity, &self.unit);
        let mut panels = vec![
            panel(Axis::fit_decibel(title, levels), 170.0, &curves, |c| &c.decibels),
            panel(Axis::fit_angle("Phase (°)", phases), 130.0, &curves, |c| &c.degrees),
            low("Δ (dB)", &differences),
            low("Δ (°)", &angles),
            low("Harmonics (%)", &self.distortion_percent),
        ];
        let points = [&measured, &measured_phase, &differences, &angles, &self.distortion_percent];
        for (panel, values) in panels.iter_mut().zip(points) {
            let at = self.measured.frequencies_rad_per_s.iter().zip(values);
            let points = at.map(|(frequency, value)| (*frequency, *value, String::new())).collect();
            panel.marks.push(Mark::Markers { points, style: POINTS });
        }
        let mut legend = LegendEntry::of_series(self.models.iter().map(|model| &model.name));
        legend.push(LegendEntry::marker(&self.measured.name, POINTS));
        let x = frequency_axis(self.models.iter().chain([&self.measured]));
        words.with_plot(x, panels, legend)
    }

    /// Phase of each measured point: that of the first model's curve at its frequency, on its turn,
    /// plus the difference.
    fn near_first(&self, curves: &[BodeCurve], angles: &[f64]) -> Vec<f64> {
        let Some(curve) = curves.first() else { return angles.to_vec() };
        let at = self.measured.frequencies_rad_per_s.iter().zip(&self.model).zip(angles);
        at.map(|((frequency, model), angle)| {
            let next = curve.frequencies.partition_point(|known| known < frequency);
            let near = curve.degrees.get(next).or(curve.degrees.last()).copied().unwrap_or(0.0);
            let principal = argument(*model).to_degrees();
            principal + 360.0 * ((near - principal) / 360.0).round() + angle
        })
        .collect()
    }
}
