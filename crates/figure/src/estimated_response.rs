//! Frequency response estimated from records: magnitude and phase with the band that contains the
//! true response with 95 % confidence, and the coherence.

use phea_dynamics::portable::{asin, log10, magnitude};

use super::axis::Axis;
use super::bode::{
    FrequencySeries, all, curves, decibels, frequency_axis, level_title, panel, unwrapped_degrees,
};
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle};
use super::scene::Fill;
use super::{Figure, Words};

/// Estimated response with its models.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimatedResponse {
    /// Quantity, such as `force/command`.
    pub quantity: String,
    /// Unit, such as `N/V`, which is 0 dB.
    pub unit: String,
    /// Response at each frequency.
    pub estimate: FrequencySeries,
    /// Radius of the 95 % disc around each response.
    pub radii: Vec<f64>,
    /// Squared coherence at each frequency.
    pub coherence: Vec<f64>,
    /// Squared coherence required of a point.
    pub least_coherence: f64,
    /// Models for comparison.
    pub models: Vec<FrequencySeries>,
}

const POINTS: MarkerStyle = MarkerStyle { marker: Marker::Circle, role: Role::Text, radius: 1.8 };
const CONFIDENCE: Fill = Fill { role: Role::Muted, opacity: 0.3 };

/// Least fraction of the magnitude at the lower edge of a band.
const LEAST: f64 = 0.03;

impl EstimatedResponse {
    /// Draws the figure.
    pub fn draw(&self, words: &Words) -> Figure {
        let (levels, degrees) =
            (decibels(&self.estimate.response), unwrapped_degrees(&self.estimate.response, None));
        let level = |value: f64| 20.0 * log10(value);
        let in_decibels =
            self.band(&levels, |fraction| [level((1.0 - fraction).max(LEAST)), level(1.0 + fraction)]);
        let in_degrees = self.band(&degrees, |fraction| {
            let edge = asin(fraction.min(1.0)).to_degrees();
            [-edge, edge]
        });
        // on the same turn as the estimate
        let curves = curves(&self.models, degrees.first().copied());
        let edges = |band: &[[f64; 2]]| band.as_flattened().to_vec().into_iter();
        let title = level_title(&self.quantity, &self.unit);
        let decibel_axis =
            Axis::fit_decibel(title, edges(&in_decibels).chain(all(&curves, |curve| &curve.decibels)));
        let angle_axis =
            Axis::fit_angle("Phase (°)", edges(&in_degrees).chain(all(&curves, |curve| &curve.degrees)));
        let mut panels = vec![
            panel(decibel_axis, 190.0, &curves, |curve| &curve.decibels),
            panel(angle_axis, 150.0, &curves, |curve| &curve.degrees),
            panel(Axis::linear("Coherence γ²", 0.0, 1.0), 90.0, &[], |curve| &curve.degrees),
        ];
        let frequencies = &self.estimate.frequencies_rad_per_s;
        for (panel, band) in panels.iter_mut().zip([&in_decibels, &in_degrees]) {
            let edge =
                |index: usize| frequencies.iter().copied().zip(band.iter().map(move |edges| edges[index]));
            let back: Vec<(f64, f64)> = edge(1).collect();
            let corners = edge(0).chain(back.into_iter().rev()).collect();
            panel.marks.insert(0, Mark::Area { corners, fill: CONFIDENCE });
        }
        for (panel, values) in panels.iter_mut().zip([&levels, &degrees, &self.coherence]) {
            let points =
                frequencies.iter().zip(values).map(|(at, value)| (*at, *value, String::new())).collect();
            panel.marks.push(Mark::Markers { points, style: POINTS });
        }
        if let Some(coherence) = panels.last_mut() {
            coherence.marks.push(Mark::dotted(AxisDirection::Y, self.least_coherence, ""));
        }
        let mut legend = vec![
            LegendEntry::marker(&self.estimate.name, POINTS),
            LegendEntry::area("95 % confidence", CONFIDENCE),
        ];
        legend.extend(LegendEntry::of_series(self.models.iter().map(|model| &model.name)));
        let x = frequency_axis(self.models.iter().chain([&self.estimate]));
        words.with_plot(x, panels, legend)
    }

    /// Band around each value, from the ratio of the radius to the magnitude.
    fn band(&self, values: &[f64], of: impl Fn(f64) -> [f64; 2]) -> Vec<[f64; 2]> {
        let sizes = self.estimate.response.iter().map(|value| magnitude(*value));
        let fractions = sizes.zip(&self.radii).map(|(size, radius)| radius / size);
        values.iter().zip(fractions).map(|(value, fraction)| of(fraction).map(|edge| value + edge)).collect()
    }
}
