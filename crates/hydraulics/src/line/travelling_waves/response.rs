use num_complex::Complex64;
use phea_dynamics::portable::exp_complex;

use super::{TravellingWaves, Wave};
use crate::line::attenuation::CORNERS;
use crate::line::{LineResponse, TransferMatrix};

impl<const M: usize> TravellingWaves<M> {
    /// See [`crate::line::DynamicLine::transfer_matrix`]. With E_i = e^(-s T_i) A_i(s) the waves see
    ///
    /// ```text
    /// in phase        p/q = R_0/2 b_1/(b_1 + s T_1) + sum of Z_i(s) (1 + E_i)/(1 - E_i)
    /// in opposition   p/q = R_0/2 b_1/(b_1 + s T_1) + sum of Z_i(s) (1 - E_i)/(1 + E_i)
    /// ```
    pub(in crate::line) fn transfer_matrix(&self, s: Complex64) -> TransferMatrix {
        let first = self.waves.first().map_or(0.0, |wave| wave.delay);
        let steady = self.half_resistance * CORNERS[0] / (CORNERS[0] + s * first);
        let mut response = LineResponse { in_phase: steady, in_opposition: steady };
        for wave in &self.waves {
            let (impedance, passed) = wave.response(s);
            response.in_phase += impedance * (1.0 + passed) / (1.0 - passed);
            response.in_opposition += impedance * (1.0 - passed) / (1.0 + passed);
        }
        TransferMatrix::IDENTITY.across(s * self.end_compliance).then(&response.transfer_matrix())
    }

    /// What yields at once, in m3/Pa.
    ///
    /// ```text
    /// C = 2 C_end + 1/sum of Z_i/T_i
    /// ```
    pub(in crate::line) fn elastic_compliance(&self) -> f64 {
        let stiffness: f64 = self.waves.iter().map(|wave| wave.impedance / wave.delay).sum();
        2.0 * self.end_compliance + 1.0 / stiffness
    }

    /// The same line, fluid and wall stiffer by a factor: its inertia and its friction stay.
    pub(in crate::line) fn stiffened(mut self, factor: f64) -> TravellingWaves<M> {
        let root = factor.sqrt();
        self.end_compliance /= factor;
        for wave in &mut self.waves {
            wave.impedance *= root;
            wave.delay /= root;
        }
        self
    }
}

impl Wave<f64> {
    /// Z_i(s) and e^(-s T_i) A_i(s).
    fn response(&self, s: Complex64) -> (Complex64, Complex64) {
        let angle = s * self.delay;
        let (mut impedance, mut attenuation) = (Complex64::ONE, Complex64::ONE);
        for (weight, corner) in self.weights.iter().zip(CORNERS) {
            let lag = *weight / (corner + angle);
            impedance += lag;
            attenuation -= lag * angle;
        }
        (self.impedance * impedance, exp_complex(-angle) * attenuation)
    }
}
