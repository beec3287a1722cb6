//! Plants that are known frequency by frequency, behind a hold and sampled: the images of their response folded onto one another.

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;
use phea_dynamics::responding::RespondingPlant;

use super::{MemberResponse, turned};
use crate::family::MeasuredPlant;

/// What lies beyond a measurement may count for this share of its sampled response.
const UNKNOWN_SHARE: f64 = 0.01;
/// Images of a model are summed until what is left counts for this share, 0.001 dB.
const LEFT_SHARE: f64 = 1e-4;
/// Images to each side at most.
const IMAGES_MAXIMUM: usize = 4000;

/// Sensor, delay and sampling around such a plant.
///
/// ```text
/// Z{hold P}(e^(jwT)) = sum over k of P(j v) e^(-j v T_d) e^(-j v T/2) sin(v T/2)/(v T/2),     v = w + 2 pi k/T
/// ```
pub(super) struct Images<'a> {
    pub(super) sensor: &'a TransferFunction,
    /// T_d, or T_d + T/2 in a sampled loop.
    pub(super) delay_s: f64,
    pub(super) sample_time_s: Option<f64>,
}

impl Images<'_> {
    /// A model has a response at every frequency.
    pub(super) fn of_model(
        &self,
        plant: &dyn RespondingPlant,
        frequency_rad_per_s: f64,
    ) -> Option<MemberResponse> {
        let [here, load_motion] = plant.response(frequency_rad_per_s);
        let Some(sample_time_s) = self.sample_time_s else {
            return Some(self.unsampled(here, load_motion, frequency_rad_per_s));
        };
        let spacing = 2.0 * std::f64::consts::PI / sample_time_s;
        let mut sum = self.image(here, frequency_rad_per_s, sample_time_s);
        for order in 1..IMAGES_MAXIMUM {
            let away = spacing * order as f64;
            let mut largest = 0.0_f64;
            for v in [frequency_rad_per_s + away, frequency_rad_per_s - away] {
                let [response, _] = plant.response(v.abs());
                let image = self.image(response, v, sample_time_s);
                sum = [sum[0] + image[0], sum[1] + image[1]];
                largest = largest.max(portable::magnitude(response) * 2.0 / (v.abs() * sample_time_s));
            }
            // later images fall by the cube of their frequency at least, but for resonances
            let beyond = away > plant.range_rad_per_s()[1].min(spacing * IMAGES_MAXIMUM as f64 / 4.0);
            let left = largest * order as f64;
            if (beyond || order > 2) && left <= LEFT_SHARE * portable::magnitude(sum[0]) {
                return Some(sampled(sum, load_motion));
            }
        }
        None
    }

    /// As far as the measurement reaches; `None` where what lies beyond it could count, were it as large as at its end.
    pub(super) fn of_measurement(
        &self,
        plant: &MeasuredPlant,
        frequency_rad_per_s: f64,
    ) -> Option<MemberResponse> {
        let (here, disturbance) = plant.response(frequency_rad_per_s)?;
        let load_motion = disturbance.unwrap_or(Complex64::new(0.0, 0.0));
        let Some(sample_time_s) = self.sample_time_s else {
            return Some(self.unsampled(here, load_motion, frequency_rad_per_s));
        };
        let spacing = 2.0 * std::f64::consts::PI / sample_time_s;
        let reach = *plant.frequencies_rad_per_s.last()?;
        let mut sum = self.image(here, frequency_rad_per_s, sample_time_s);
        for sign in [1.0, -1.0] {
            let mut v = frequency_rad_per_s + sign * spacing;
            while v.abs() <= reach {
                let (response, _) = plant.response(v.abs())?;
                let image = self.image(response, v, sample_time_s);
                sum = [sum[0] + image[0], sum[1] + image[1]];
                v += sign * spacing;
            }
            let (last, _) = plant.response(reach)?;
            let unknown = 2.0 * portable::magnitude(last) * hold(v, sample_time_s).abs();
            if unknown > UNKNOWN_SHARE * portable::magnitude(sum[0]) {
                return None;
            }
        }
        Some(sampled(sum, load_motion))
    }

    fn unsampled(&self, command: Complex64, load_motion: Complex64, frequency: f64) -> MemberResponse {
        let plant = command * turned(frequency, self.delay_s);
        MemberResponse { plant, load_motion, sensor: self.sensor.at_frequency(frequency) }
    }

    /// The terms of one k, of P and of P H; a response at a negative frequency is the conjugate of that at the positive one.
    fn image(&self, response: Complex64, v: f64, sample_time_s: f64) -> [Complex64; 2] {
        let sensor = self.sensor.at_frequency(v.abs());
        let signed = |value: Complex64| if v < 0.0 { value.conj() } else { value };
        let held = signed(response) * turned(v, self.delay_s) * hold(v, sample_time_s);
        [held, held * signed(sensor)]
    }
}

fn sampled([plant, with_sensor]: [Complex64; 2], load_motion: Complex64) -> MemberResponse {
    MemberResponse { plant, load_motion, sensor: with_sensor / plant }
}

/// sin(v T/2)/(v T/2)
fn hold(v: f64, sample_time_s: f64) -> f64 {
    let half = v * sample_time_s / 2.0;
    if half == 0.0 { 1.0 } else { portable::sin(half) / half }
}
