//! Figure of merit of an attempt, for the comparison of structures of different length.

use num_complex::Complex64;
use phea_dynamics::controller::Objective;
use phea_dynamics::frequency::decibels;
use phea_dynamics::portable;

use super::Attempt;
use crate::closed_loop::Compensation;

impl Attempt {
    /// Figure of merit for the comparison with attempts of other length, dB, smaller is better: the
    /// objective, or minus the worst margin. The high-frequency gain, whose unit depends on the
    /// relative degree, is replaced by the largest gain from the sensor's noise to the command.
    ///
    /// ```text
    /// 20 log10 max |G/(1 + L)|         over the frequencies of the samples, of the nominal plant
    /// ```
    ///
    /// `None` without a response.
    pub(in crate::design) fn reached_db(&self) -> Option<f64> {
        let shaping = self.shaping();
        match self.options.objective {
            Objective::LeastHighFrequencyGain => self.noise_gain_db(),
            Objective::LeastBandwidth => self.rounds.last().map(|round| round.objective_db),
            Objective::BestWorstMargin => {
                let margins = shaping.margins(&self.x);
                Some(-margins.iter().map(|margin| margin.margin_db).fold(f64::INFINITY, f64::min))
            }
        }
    }

    fn noise_gain_db(&self) -> Option<f64> {
        let samples = self.shaping.samples();
        let law = self.shaping.controller(&self.x);
        let around = Compensation::new(&law, samples.problem().sensor.clone()).ok()?;
        let nominal = samples.members().first()?;
        let gain = |frequency: &f64| {
            let plant = nominal.response(*frequency)?;
            let feedback = around.response(*frequency).feedback;
            let open_loop = plant.plant * feedback * plant.sensor;
            Some(portable::magnitude(feedback / (Complex64::ONE + open_loop)))
        };
        let frequencies = samples.grid_frequencies_rad_per_s();
        frequencies.iter().filter_map(gain).reduce(f64::max).map(decibels)
    }
}
