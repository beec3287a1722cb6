//! Families of measured frequency responses.

use num_complex::Complex64;
use phea_dynamics::portable;

/// One measured plant: its response at increasing frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPlant {
    /// Name of the plant, such as the name of its file.
    pub name: String,
    /// Frequencies, positive and increasing, rad/s.
    pub frequencies_rad_per_s: Vec<f64>,
    /// Response P(j w) at each frequency.
    pub command: Vec<Complex64>,
    /// Load-motion path Pd(j w) at each frequency, if measured.
    pub disturbance: Option<Vec<Complex64>>,
    /// Radius of the disc around each P(j w) that contains the true response, for all points
    /// jointly with the confidence of the verdict; empty if the responses are exact.
    pub radii: Vec<f64>,
    /// Number of open-loop poles in the right half plane, which a response does not show.
    pub unstable_poles: usize,
    /// Number of poles less zeros at the origin, if stated: otherwise inferred from the slope at
    /// the lowest frequencies.
    pub integrators: Option<usize>,
    /// True if the response between two points is known to be the interpolated one, as for
    /// [`super::tabulated`]. False for a measurement, where nothing beyond the data is assumed.
    pub is_resolved: bool,
}

/// Measured plants, the nominal one first.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredFamily {
    plants: Vec<MeasuredPlant>,
}

/// Reason why measurements are not a family.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeasurementError {
    /// There is no plant.
    #[error("no response was measured")]
    Empty,
    /// An invalid point: frequencies must be positive, finite and increasing; responses must be
    /// finite, not zero, and equal in number; radii must not be negative.
    #[error(
        "{plant}: point {point} is not one of increasing positive frequencies with a finite response that is not zero"
    )]
    Point {
        /// Name of the plant.
        plant: String,
        /// Index of the point, from 0.
        point: usize,
    },
}

impl MeasuredFamily {
    /// A family of these plants.
    ///
    /// # Errors
    /// [`MeasurementError`] for an empty or invalid family.
    pub fn new(plants: Vec<MeasuredPlant>) -> Result<MeasuredFamily, MeasurementError> {
        if plants.is_empty() {
            return Err(MeasurementError::Empty);
        }
        for plant in &plants {
            if let Some(point) = plant.unsound_point() {
                return Err(MeasurementError::Point { plant: plant.name.clone(), point });
            }
        }
        Ok(MeasuredFamily { plants })
    }

    /// The plants, the nominal one first.
    pub fn plants(&self) -> &[MeasuredPlant] {
        &self.plants
    }
}

impl MeasuredPlant {
    fn unsound_point(&self) -> Option<usize> {
        let count = self.frequencies_rad_per_s.len();
        let sound = |value: &Complex64| value.is_finite() && *value != Complex64::new(0.0, 0.0);
        let mut previous = 0.0;
        for (point, &frequency) in self.frequencies_rad_per_s.iter().enumerate() {
            let disturbance = self
                .disturbance
                .as_ref()
                .map_or(Some(true), |values| values.get(point).map(|value| value.is_finite()));
            let radius = self.radii.get(point).is_none_or(|radius| *radius >= 0.0);
            let good = radius
                && frequency > previous
                && frequency.is_finite()
                && self.command.get(point).is_some_and(sound)
                && disturbance == Some(true);
            if !good {
                return Some(point);
            }
            previous = frequency;
        }
        let disturbance = self.disturbance.as_ref().map_or(count, Vec::len);
        let radii = if self.radii.is_empty() { count } else { self.radii.len() };
        let lengths = [self.command.len(), disturbance, radii];
        if count == 0 || lengths.iter().any(|&length| length != count) { Some(count) } else { None }
    }

    /// Responses P and Pd at a frequency: as measured, or interpolated linearly in magnitude (dB)
    /// and phase over the logarithm of frequency, with the phase along the shorter way. `None`
    /// beyond the ends of the measurement.
    pub fn response(&self, frequency_rad_per_s: f64) -> Option<(Complex64, Option<Complex64>)> {
        let upper = self.frequencies_rad_per_s.partition_point(|&w| w < frequency_rad_per_s);
        let last = *self.frequencies_rad_per_s.get(upper)?;
        if last == frequency_rad_per_s {
            return Some((self.command[upper], self.disturbance.as_ref().map(|values| values[upper])));
        }
        let lower = upper.checked_sub(1)?;
        let first = self.frequencies_rad_per_s[lower];
        let fraction = portable::ln(frequency_rad_per_s / first) / portable::ln(last / first);
        let between = |values: &[Complex64]| {
            let (from, to) = (values[lower], values[upper]);
            let ratio = to / from;
            let size = portable::magnitude(ratio);
            if !(size > 0.0 && size.is_finite()) {
                return from + (to - from) * fraction;
            }
            let turn = Complex64::new(portable::ln(size), portable::argument(ratio));
            from * portable::exp_complex(turn * fraction)
        };
        Some((between(&self.command), self.disturbance.as_ref().map(|values| between(values))))
    }

    /// Radius of the disc around P at a frequency; between two points the wider of theirs, each
    /// relative to its response. Zero if the responses are exact.
    pub(crate) fn radius(&self, frequency_rad_per_s: f64) -> f64 {
        let upper = self.frequencies_rad_per_s.partition_point(|&w| w < frequency_rad_per_s);
        let Some(&radius) = self.radii.get(upper) else { return 0.0 };
        if self.frequencies_rad_per_s[upper] == frequency_rad_per_s {
            return radius;
        }
        let relative = |point: usize| self.radii[point] / portable::magnitude(self.command[point]);
        let widest = upper.checked_sub(1).map_or(0.0, relative).max(relative(upper));
        self.response(frequency_rad_per_s).map_or(0.0, |(command, _)| widest * portable::magnitude(command))
    }
}
