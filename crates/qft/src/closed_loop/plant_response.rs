//! The response of one plant within its loop at one frequency, without forming the member.

use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, StateSpace, TransferFunction};
use phea_dynamics::uncertain_plant::PlantCoefficients;

use super::fed_forward::{FedForward, closed, inner_path, rate_path};
use super::member::{continuous, load_motion};
use super::{Compensation, MemberResponse, check_dead_time, turned};

impl Compensation {
    /// P, Pd and H of a plant at one frequency: the result of its [`Compensation::member`] with a
    /// tenth of the work in a sampled loop, where forming the member involves finding its zeros.
    ///
    /// # Errors
    /// Errors of [`Compensation::member`].
    ///
    /// # Example
    /// ```
    /// # use phea_dynamics::controller::{Controller, Timing};
    /// # use phea_dynamics::linear::TransferFunction;
    /// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
    /// # use phea_qft::closed_loop::Compensation;
    /// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
    /// let timing = Timing { sample_time_s: Some(0.1), delay_s: 0.13, ..Timing::default() };
    /// let controller = Controller { timing, ..Controller::default() };
    /// let compensation = Compensation::new(&controller, TransferFunction::gain_only(2.0))?;
    /// let command = RationalCoefficients { numerator: vec![3.0], denominator: vec![1.0, 0.4, 9.0] };
    /// let plant = PlantCoefficients { command, disturbance: None, dead_time_s: 0.02, rate: None };
    /// let response = compensation.plant_response(plant.clone(), 2.0)?;
    /// let member = compensation.member(plant)?.response(2.0).unwrap();
    /// assert!((response.plant - member.plant).norm_sqr() < 1e-24 && response.sensor.re == 2.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn plant_response(
        &self,
        mut plant: PlantCoefficients<f64>,
        frequency_rad_per_s: f64,
    ) -> Result<MemberResponse, LinearError> {
        check_dead_time(plant.dead_time_s)?;
        plant.dead_time_s += self.delay_s;
        let (gain, dead_time_s) = (self.rate_feed_forward, plant.dead_time_s);
        let inner_feedback = self.inner_feedback.as_ref();
        let fed = FedForward::of(gain, self.rate_sensor, inner_feedback, &plant).at(frequency_rad_per_s);
        let Some(sample_time_s) = self.sample_time_s else {
            let plant = closed(gain, self.rate_sensor, plant)?;
            return Ok(continuous(&plant, &self.sensor, frequency_rad_per_s).fed(fed));
        };
        let rate = rate_path(gain, self.rate_sensor, &plant)?;
        let inner = inner_path(inner_feedback, &plant)?;
        let load_motion = load_motion(plant.disturbance.as_ref(), frequency_rad_per_s);
        let rational = plant.command.transfer_function()?;
        // whole samples only rotate the phase; the remaining fraction of a sample becomes a state
        let held = |function: TransferFunction| {
            let dead_time_s = function.dead_time_s() + dead_time_s;
            let whole_s = (dead_time_s / sample_time_s).floor() * sample_time_s;
            let states = StateSpace::from_transfer_function(&function.with_dead_time(0.0)?)?;
            let part_s = (dead_time_s - whole_s).max(0.0);
            let response =
                states.held_with_dead_time(sample_time_s, part_s)?.at_frequency(frequency_rad_per_s, 0, 0)?;
            Ok::<Complex64, LinearError>(response * turned(frequency_rad_per_s, whole_s))
        };
        let is_gain = self.sensor.poles().is_empty() && self.sensor.dead_time_s() == 0.0;
        let with_sensor = if is_gain { None } else { Some(held(rational.series(&self.sensor)?)?) };
        let plant = held(rational)?;
        let sensor = with_sensor.map_or(Complex64::new(self.sensor.gain(), 0.0), |response| response / plant);
        let back = rate.map(held).transpose()?.map_or(Complex64::ZERO, |rate| gain * rate);
        let inner = inner_feedback.zip(inner.map(held).transpose()?);
        let inner = inner
            .map_or(Complex64::ZERO, |(feedback, inner)| feedback.at_frequency(frequency_rad_per_s) * inner);
        let back = back - inner;
        Ok(MemberResponse { plant: plant / (1.0 - back), load_motion, sensor }.fed(fed))
    }
}
