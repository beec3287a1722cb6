//! Responses of a plant within its loop.

use num_complex::Complex64;
use phea_dynamics::controller::RateSensor;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};

use super::images::SamplingImages;
use super::{Member, MemberResponse, turned};

impl MemberResponse {
    /// Response with an additional feed-forward of the disturbance: Pd + K V_d P.
    pub(super) fn fed(self, forward: Complex64) -> MemberResponse {
        MemberResponse { load_motion: self.load_motion + forward * self.plant, ..self }
    }
}

impl Member {
    /// Responses P, Pd and H at a frequency; `None` beyond the range of a measurement.
    ///
    /// Sampling folds the response of a measured plant beyond pi/T back: its images at w + 2 pi k/T
    /// are summed as far as the measurement reaches. If the part beyond it could still contribute
    /// one hundredth (assuming that it is as large as at the end), the response is unknown.
    pub fn response(&self, frequency_rad_per_s: f64) -> Option<MemberResponse> {
        match self {
            Member::Continuous { plant, sensor, fed_forward } => {
                let own = continuous(plant, sensor, frequency_rad_per_s);
                Some(own.fed(fed_forward.at(frequency_rad_per_s)))
            }
            Member::Sampled { command, with_sensor, disturbance, fed_forward, .. } => {
                let plant = command.at_frequency(frequency_rad_per_s);
                let own = MemberResponse {
                    plant,
                    load_motion: load_motion(disturbance.as_ref(), frequency_rad_per_s),
                    sensor: with_sensor.at_frequency(frequency_rad_per_s) / plant,
                };
                Some(own.fed(fed_forward.at(frequency_rad_per_s)))
            }
            Member::Responding { plant, .. } => self.images()?.of_model(plant.as_ref(), frequency_rad_per_s),
            Member::Measured { plant, .. } => self.images()?.of_measurement(plant, frequency_rad_per_s),
        }
    }

    /// Radius of the disc around the P of [`Member::response`] that contains the true one; zero
    /// where the response is exact.
    pub(crate) fn radius(&self, frequency_rad_per_s: f64, response: &MemberResponse) -> f64 {
        match (self, self.images()) {
            (Member::Measured { plant, .. }, Some(images)) if !plant.radii.is_empty() => {
                images.radius(plant, frequency_rad_per_s, response.sensor)
            }
            _ => 0.0,
        }
    }

    /// Internal feedback K H_v P_v(jw) - H_p P_p(jw) of a plant without polynomials, with the delay
    /// of the loop and sampled if the loop is; `None` for other plants, and if the images do not
    /// converge.
    pub(crate) fn fed_back(&self, frequency_rad_per_s: f64) -> Option<Complex64> {
        let Member::Responding { plant, .. } = self else { return None };
        self.images()?.fed_back(plant.as_ref(), frequency_rad_per_s)
    }

    pub(super) fn images(&self) -> Option<SamplingImages<'_>> {
        match self {
            Member::Responding {
                sensor,
                delay_s,
                sample_time_s,
                rate_feed_forward,
                rate_sensor,
                inner_feedback,
                ..
            } => Some(SamplingImages {
                sensor,
                delay_s: *delay_s,
                sample_time_s: *sample_time_s,
                rate_feed_forward: *rate_feed_forward,
                rate_sensor: *rate_sensor,
                inner_feedback: inner_feedback.as_ref(),
            }),
            Member::Measured { sensor, delay_s, sample_time_s, .. } => Some(SamplingImages {
                sensor,
                delay_s: *delay_s,
                sample_time_s: *sample_time_s,
                rate_feed_forward: 0.0,
                rate_sensor: RateSensor::default(),
                inner_feedback: None,
            }),
            Member::Continuous { .. } | Member::Sampled { .. } => None,
        }
    }
}

pub(super) fn continuous(
    plant: &PlantCoefficients<f64>,
    sensor: &TransferFunction,
    frequency_rad_per_s: f64,
) -> MemberResponse {
    MemberResponse {
        plant: plant.command.at_frequency(frequency_rad_per_s)
            * turned(frequency_rad_per_s, plant.dead_time_s),
        load_motion: load_motion(plant.disturbance.as_ref(), frequency_rad_per_s),
        sensor: sensor.at_frequency(frequency_rad_per_s),
    }
}

pub(super) fn load_motion(path: Option<&RationalCoefficients<f64>>, frequency_rad_per_s: f64) -> Complex64 {
    path.map_or(Complex64::new(0.0, 0.0), |path| path.at_frequency(frequency_rad_per_s))
}
