//! Misfit of a line: residuals of the recordings that are not noise.

use super::{LineIdentification, ResponseFit, RiseFit, VolumeSource};

/// A signal that the line does not explain.
#[derive(Clone, Debug, PartialEq)]
pub struct LineMisfit {
    /// Path of the file.
    pub file: String,
    /// Signal: `volume` of a pressure rise, or `response` of a frequency response.
    pub signal: &'static str,
    /// Root mean square of the misfit divided by the range of the volume, or by the response.
    pub fraction: f64,
    /// Correlation of neighbouring residuals of a volume.
    pub correlation: Option<f64>,
}

/// Correlation of neighbouring residuals up to which they count as noise, as for a valve.
const OF_NOISE: f64 = 0.4;
/// Number of standard deviations up to which a correlation is chance, as for a valve.
const CHANCE: f64 = 5.0;
/// Fraction of the range below which misfits are not reported, as for a valve.
const SMALLEST_FRACTION: f64 = 1e-3;

impl LineIdentification {
    /// Signals that the line does not explain.
    pub fn misfits(&self) -> Vec<LineMisfit> {
        let rise = self.rise.as_ref().and_then(RiseFit::misfit);
        rise.into_iter().chain(self.response.as_ref().and_then(ResponseFit::misfit_of_response)).collect()
    }
}

impl RiseFit {
    /// ```text
    /// misfit^2 = r rms^2              r the correlation of neighbouring residuals
    /// ```
    ///
    /// around the mean of the residuals: the volume at the first row has the noise of that row.
    /// There is no misfit of a volume that is the integral of a flow: the noise of the meter is
    /// correlated in its neighbouring rows.
    fn misfit(&self) -> Option<LineMisfit> {
        if self.record.source == VolumeSource::Flow {
            return None;
        }
        let points = self.points();
        let differences: Vec<f64> =
            points.iter().map(|(pressure, volume)| self.volume(*pressure) - volume).collect();
        let rows = differences.len().max(1) as f64;
        let mean = differences.iter().sum::<f64>() / rows;
        let residuals: Vec<f64> = differences.iter().map(|one| one - mean).collect();
        let squares: f64 = residuals.iter().map(|one| one * one).sum();
        let products: f64 = residuals.windows(2).map(|pair| pair.iter().product::<f64>()).sum();
        let correlation = if squares > 0.0 { products / squares } else { 0.0 };
        let [least, greatest] = phea_dynamics::order::ends(points.iter().map(|(_, volume)| *volume));
        let fraction = (squares / rows * correlation.max(0.0)).sqrt() / (greatest - least);
        let is_chance = correlation * rows.sqrt() <= CHANCE;
        (correlation > OF_NOISE && !is_chance && fraction >= SMALLEST_FRACTION).then(|| LineMisfit {
            file: self.record.file.clone(),
            signal: "volume",
            fraction,
            correlation: Some(correlation),
        })
    }
}

impl ResponseFit {
    /// Misfit beyond noise, relative to the response.
    fn misfit_of_response(&self) -> Option<LineMisfit> {
        if self.is_explained() {
            return None;
        }
        let [misfit, _] = self.misfit;
        let rows = self.member.points.iter().zip(&self.deviations);
        let noise = rows.map(|(point, deviation)| deviation * deviation / point.response.norm_sqr());
        let mean = noise.sum::<f64>() / self.deviations.len().max(1) as f64;
        let fraction = (mean * (misfit - 1.0)).max(0.0).sqrt();
        let (file, signal) = (self.member.file.clone(), "response");
        Some(LineMisfit { file, signal, fraction, correlation: None })
    }
}
