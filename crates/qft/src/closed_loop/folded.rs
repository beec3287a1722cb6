//! Effect on its loop of the response of a plant without polynomials beyond half the sampling rate.

use phea_dynamics::portable::magnitude;

use super::images::hold;
use super::{Compensation, Member, turned};
use crate::family::{COARSE, tabulated};

/// Factor by which peaks of the response between the points of its table are higher, at most.
const BETWEEN_POINTS: f64 = 1.1;
/// Factor by which the frequencies of modes are moved.
const MOVED: f64 = 1.25;
/// Multiples of pi/T up to which the response is evaluated, at least.
const LEAST_PASSES: f64 = 4.0;

impl Member {
    /// Bound on the relative change of the return difference by folding, at any frequency up to
    /// pi/T, with the modes beyond pi/T moved by a quarter of their frequency:
    ///
    /// ```text
    /// |f - f_0| <= e |f_0|,       f = 1 - B + L,     f_0 = f without images
    /// e = max over w of  sum over k of  (sup |P H h| |G| + sup |K H_v P_v h| + sup |P_p h| |H_p|)/|f_0|
    /// ```
    ///
    /// with h the magnitude of the hold, G, H_p and f_0 at w, and sup over the frequencies around
    /// |w + 2 pi k/T|, k not zero. With e < 1 no closed-loop pole reaches the boundary of
    /// stability, f = 0, on the way from one plant to another unless f_0 vanishes there too, and
    /// modes beyond pi/T do not pass through f_0. Images beyond the range of the plant are assumed
    /// to fall with the cube of their frequency after a hold. `None` for other members and
    /// continuous loops.
    ///
    /// # Example
    /// An integrator given by its response folds with 1/w^2 at twice the rate, so that a loop that
    /// crosses over at a thirtieth of the sampling rate changes by a few percent.
    /// ```
    /// use std::sync::Arc;
    /// use num_complex::Complex64;
    /// use phea_dynamics::analytic::Disc;
    /// use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
    /// use phea_dynamics::linear::TransferFunction;
    /// use phea_dynamics::uncertain_plant::responding::RespondingPlant;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
    /// use phea_qft::closed_loop::Compensation;
    /// #[derive(Debug)]
    /// struct Hidden;
    /// impl RespondingPlant for Hidden {
    ///     fn response(&self, w: f64) -> [Complex64; 2] {
    ///         [1.0 / Complex64::new(0.0, w); 2]
    ///     }
    /// #     fn enclosure(&self, _: [f64; 2]) -> Disc {
    /// #         Disc::WHOLE
    /// #     }
    /// #     fn slow(&self) -> PlantCoefficients<f64> {
    /// #         let command = RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, 0.0] };
    /// #         PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None }
    /// #     }
    /// #     fn roll_off(&self, _: f64) -> Option<f64> {
    /// #         None
    /// #     }
    /// #     fn unstable_poles(&self) -> Option<usize> {
    /// #         Some(0)
    /// #     }
    /// #     fn range_rad_per_s(&self) -> [f64; 2] {
    /// #         [1.0, 1e4]
    /// #     }
    /// #     fn echo_s(&self) -> f64 {
    /// #         0.0
    /// #     }
    /// }
    /// let timing = Timing { sample_time_s: Some(1e-3), ..Timing::default() };
    /// let feedback = Compensator::new(vec![Element::Gain(200.0)]);
    /// let controller = Controller { feedback, timing, ..Controller::default() };
    /// let around = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
    /// let folding = around.responding(Arc::new(Hidden)).folding(&around);
    /// assert!(folding.is_some_and(|folding| folding > 0.02 && folding < 0.2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn folding(&self, compensation: &Compensation) -> Option<f64> {
        let Member::Responding { plant, sensor, delay_s, sample_time_s, .. } = self else { return None };
        let (plant, sample_time_s, images) = (plant.as_ref(), (*sample_time_s)?, self.images()?);
        let half = std::f64::consts::PI / sample_time_s;
        let [from, to] = plant.range_rad_per_s();
        let top = to.max(LEAST_PASSES * half);
        let beyond = tabulated(plant, [half, top], COARSE).frequencies_rad_per_s;
        let beyond: Vec<(f64, [f64; 3])> = beyond
            .into_iter()
            .map(|frequency| {
                let held = hold(frequency, sample_time_s).abs();
                let [output, rate, signal] = images.unfolded(plant, frequency).map(magnitude);
                let output = output * magnitude(sensor.at_frequency(frequency));
                (frequency, [output, rate, signal].map(|path| path * held))
            })
            .collect();
        let around = |frequency: f64| {
            let first = beyond.partition_point(|(at, _)| *at < frequency / MOVED);
            let near = beyond.iter().skip(first).take_while(|(at, _)| *at <= frequency * MOVED);
            near.fold([0.0_f64; 3], |most, (_, paths)| [0, 1, 2].map(|path| most[path].max(paths[path])))
        };
        let passes = (top / (2.0 * half)).floor().max(1.0) as usize;
        let within = tabulated(plant, [from.min(0.5 * half), half], COARSE).frequencies_rad_per_s;
        let fractions = within.into_iter().map(|frequency| {
            let held = turned(frequency, *delay_s) * hold(frequency, sample_time_s);
            let (feedback, inner) =
                (compensation.feedback().at_frequency(frequency), images.inner_at(frequency));
            let [output, rate, signal] = images.unfolded(plant, frequency).map(|path| path * held);
            let open_loop = output * sensor.at_frequency(frequency) * feedback;
            let difference = magnitude(1.0 - (rate - inner * signal) + open_loop);
            let factors = [magnitude(feedback), 1.0, magnitude(inner)];
            let image = |away: f64| {
                let paths = around(away);
                (0..3).map(|path| paths[path] * factors[path]).sum::<f64>()
            };
            let pair = |pass: usize| {
                let away = 2.0 * half * pass as f64;
                image(away - frequency) + image(away + frequency)
            };
            let later = pair(passes) * passes as f64 / 3.0;
            ((1..=passes).map(pair).sum::<f64>() + later) / difference
        });
        Some(BETWEEN_POINTS * fractions.fold(0.0, f64::max))
    }
}
