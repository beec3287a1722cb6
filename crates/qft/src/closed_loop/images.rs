//! Sampled plants given frequency by frequency: the images of their response after the hold are
//! folded onto one another.

use num_complex::Complex64;
use phea_dynamics::controller::RateSensor;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;

use super::{MemberResponse, turned};
use crate::family::MeasuredPlant;

/// Largest contribution of the part beyond a measurement, as a fraction of its sampled response.
const UNKNOWN_FRACTION: f64 = 0.01;
/// Fraction of the response, 0.001 dB, below which the remaining images of a model are neglected.
const LEFT_FRACTION: f64 = 1e-4;
/// Largest number of images to each side.
const IMAGES_MAXIMUM: usize = 4000;

/// Sensor, delay and sampling around a plant without polynomials.
///
/// ```text
/// Z{hold P}(e^(jwT)) = sum over k of P(j v) e^(-j v T_d) e^(-j v T/2) sin(v T/2)/(v T/2),     v = w + 2 pi k/T
/// ```
pub(super) struct SamplingImages<'a> {
    pub(super) sensor: &'a TransferFunction,
    /// Delay T_d, or T_d + T/2 in a sampled loop, s.
    pub(super) delay_s: f64,
    pub(super) sample_time_s: Option<f64>,
    /// Feed-forward gain K.
    pub(super) rate_feed_forward: f64,
    /// Sensor H_v of the rate.
    pub(super) rate_sensor: RateSensor,
    /// Inner feedback H_p in z.
    pub(super) inner_feedback: Option<&'a TransferFunction>,
}

impl SamplingImages<'_> {
    /// Response of a model, known at every frequency.
    pub(super) fn of_model(
        &self,
        plant: &dyn RespondingPlant,
        frequency_rad_per_s: f64,
    ) -> Option<MemberResponse> {
        let [_, load_motion] = plant.response(frequency_rad_per_s);
        let [own, with_sensor, back] = self.sums(plant, frequency_rad_per_s)?;
        let found = sampled([own, with_sensor], load_motion);
        let closed = MemberResponse { plant: found.plant / (1.0 - back), ..found };
        let [_, rate] = self.rate(plant, frequency_rad_per_s);
        let [_, inner] = self.inner(plant, frequency_rad_per_s);
        let inner = inner * self.inner_at(frequency_rad_per_s);
        Some(closed.fed(self.rate_feed_forward * rate - inner))
    }

    /// Internal feedback K H_v P_v - H_p P_p.
    pub(super) fn fed_back(
        &self,
        plant: &dyn RespondingPlant,
        frequency_rad_per_s: f64,
    ) -> Option<Complex64> {
        let [_, _, back] = self.sums(plant, frequency_rad_per_s)?;
        Some(back)
    }

    /// Responses P, P H and K H_v P_v - H_p P_p with the delay, folded if the loop is sampled: H_p
    /// is taken at the samples.
    fn sums(&self, plant: &dyn RespondingPlant, frequency: f64) -> Option<[Complex64; 3]> {
        let own = self.inner_at(frequency);
        let at = |v: f64| {
            let ([response, _], [rate, _]) = (plant.response(v.abs()), self.rate(plant, v.abs()));
            let [inner, _] = self.inner(plant, v.abs());
            // an image at a negative frequency is conjugate as a whole, and H_p is not
            let seen = if v < 0.0 { own.conj() } else { own };
            (response, self.rate_feed_forward * rate - seen * inner)
        };
        let Some(sample_time_s) = self.sample_time_s else {
            let turned = turned(frequency, self.delay_s);
            let (response, back) = at(frequency);
            let own = response * turned;
            return Some([own, own * self.sensor.at_frequency(frequency), back * turned]);
        };
        let spacing = 2.0 * std::f64::consts::PI / sample_time_s;
        let image = |(response, back): (Complex64, Complex64), v: f64| {
            let [own, with_sensor] = self.image(response, v, sample_time_s);
            [own, with_sensor, self.held(back, v, sample_time_s)]
        };
        let mut sum = image(at(frequency), frequency);
        for order in 1..IMAGES_MAXIMUM {
            let away = spacing * order as f64;
            let mut largest = [0.0_f64; 2];
            for v in [frequency + away, frequency - away] {
                let here = at(v);
                for (sum, image) in sum.iter_mut().zip(image(here, v)) {
                    *sum += image;
                }
                let held = 2.0 / (v.abs() * sample_time_s);
                for (largest, response) in largest.iter_mut().zip([here.0, here.1]) {
                    *largest = largest.max(portable::magnitude(response) * held);
                }
            }
            // later images fall at least with the cube of their frequency, except at resonances
            let beyond = away > plant.range_rad_per_s()[1].min(spacing * IMAGES_MAXIMUM as f64 / 4.0);
            let left = largest.map(|largest| largest * order as f64);
            let back = portable::magnitude(1.0 - sum[2]);
            let small =
                left[0] <= LEFT_FRACTION * portable::magnitude(sum[0]) && left[1] <= LEFT_FRACTION * back;
            if (beyond || order > 2) && small {
                return Some(sum);
            }
        }
        None
    }

    /// Paths H_v P_v and H_v V_d if a rate is fed forward.
    fn rate(&self, plant: &dyn RespondingPlant, frequency: f64) -> [Complex64; 2] {
        if self.rate_feed_forward == 0.0 {
            return [Complex64::ZERO; 2];
        }
        let rate = plant.rate(frequency);
        if self.rate_sensor.is_direct() {
            return rate;
        }
        let shown = self.rate_sensor.at_frequency(frequency);
        rate.map(|path| path * shown)
    }

    /// Paths P_p and I_d if an inner signal is fed back.
    fn inner(&self, plant: &dyn RespondingPlant, frequency: f64) -> [Complex64; 2] {
        self.inner_feedback.map_or([Complex64::ZERO; 2], |_| plant.inner(frequency))
    }

    /// Responses P, K H_v P_v and P_p at one frequency, without hold and delay.
    pub(super) fn unfolded(&self, plant: &dyn RespondingPlant, frequency: f64) -> [Complex64; 3] {
        let ([output, _], [rate, _]) = (plant.response(frequency), self.rate(plant, frequency));
        let [signal, _] = self.inner(plant, frequency);
        [output, self.rate_feed_forward * rate, signal]
    }

    /// Inner feedback H_p at the samples.
    pub(super) fn inner_at(&self, frequency: f64) -> Complex64 {
        self.inner_feedback.map_or(Complex64::ZERO, |feedback| feedback.at_frequency(frequency))
    }

    /// Response of a measurement within its range; `None` where the part beyond the range could
    /// matter if it were as large as at the end.
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
            if unknown > UNKNOWN_FRACTION * portable::magnitude(sum[0]) {
                return None;
            }
        }
        Some(sampled(sum, load_motion))
    }

    /// Radius of the disc around P, and around P H over |H|, due to the discs of a measurement and
    /// of its images.
    ///
    /// ```text
    /// r = sum over k of r(v) |sin(v T/2)/(v T/2)|,     v = w + 2 pi k/T
    /// ```
    pub(super) fn radius(&self, plant: &MeasuredPlant, frequency_rad_per_s: f64, sensor: Complex64) -> f64 {
        let Some(sample_time_s) = self.sample_time_s else { return plant.radius(frequency_rad_per_s) };
        let spacing = 2.0 * std::f64::consts::PI / sample_time_s;
        let Some(&reach) = plant.frequencies_rad_per_s.last() else { return 0.0 };
        let [mut own, mut with_sensor] = [0.0; 2];
        let mut add = |v: f64| {
            let radius = plant.radius(v.abs()) * hold(v, sample_time_s).abs();
            own += radius;
            with_sensor += radius * portable::magnitude(self.sensor.at_frequency(v.abs()));
        };
        add(frequency_rad_per_s);
        for sign in [1.0, -1.0] {
            let mut v = frequency_rad_per_s + sign * spacing;
            while v.abs() <= reach {
                add(v);
                v += sign * spacing;
            }
        }
        own.max(with_sensor / portable::magnitude(sensor))
    }

    fn unsampled(&self, command: Complex64, load_motion: Complex64, frequency: f64) -> MemberResponse {
        let plant = command * turned(frequency, self.delay_s);
        MemberResponse { plant, load_motion, sensor: self.sensor.at_frequency(frequency) }
    }

    /// The terms of one k, of P and of P H; a response at a negative frequency is the conjugate of
    /// the one at the positive frequency.
    fn image(&self, response: Complex64, v: f64, sample_time_s: f64) -> [Complex64; 2] {
        let sensor = self.sensor.at_frequency(v.abs());
        let held = self.held(response, v, sample_time_s);
        [held, held * if v < 0.0 { sensor.conj() } else { sensor }]
    }

    fn held(&self, response: Complex64, v: f64, sample_time_s: f64) -> Complex64 {
        let signed = if v < 0.0 { response.conj() } else { response };
        signed * turned(v, self.delay_s) * hold(v, sample_time_s)
    }
}

fn sampled([plant, with_sensor]: [Complex64; 2], load_motion: Complex64) -> MemberResponse {
    MemberResponse { plant, load_motion, sensor: with_sensor / plant }
}

/// Relative magnitude of the hold, sin(v T/2)/(v T/2).
pub(super) fn hold(v: f64, sample_time_s: f64) -> f64 {
    let half = v * sample_time_s / 2.0;
    if half == 0.0 { 1.0 } else { portable::sin(half) / half }
}
