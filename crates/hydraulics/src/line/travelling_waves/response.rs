//! Transfer matrix of a line with travelling waves and friction.

use phea_dynamics::analytic::Analytic;

use super::{TravellingWaves, Wave};
use crate::line::TransferMatrix;
use crate::line::attenuation::CORNERS;

/// Response of a wave at s: the terms of its impedances in phase and in opposition.
struct WaveResponse<A> {
    /// Impedance Z_i(s).
    impedance: A,
    /// Sum 1 + E_i.
    sum: A,
    /// Ratio (1 - E_i)/(s T_i).
    decay: A,
    /// Angle s T_i.
    angle: A,
}

impl<const M: usize> TravellingWaves<M> {
    /// Transfer matrix as in [`crate::line::DynamicLine::transfer_matrix`]. With E_i = e^(-s T_i)
    /// A_i(s) the impedances of the waves are
    ///
    /// ```text
    /// in phase        p/q = R_0/2 b_1/(b_1 + s T_1) + sum of Z_i(s) (1 + E_i)/(1 - E_i) = n/(s d)
    /// in opposition   p/q = R_0/2 b_1/(b_1 + s T_1) + sum of Z_i(s) (1 - E_i)/(1 + E_i) = m/e
    ///     d = product of (1 - E_i)/(s T_i),   e = product of (1 + E_i)
    /// a = d = (n e + s d m)/D,   b = 2 n m/D,   c = 2 s d e/D,      D = n e - s d m
    /// ```
    ///
    /// Without friction and with one wave D is Z/T 4 e^(-sT): no other quantity is a divisor, so
    /// that a resonance of the line is an ordinary point.
    pub(in crate::line) fn transfer_matrix<A: Analytic>(&self, s: A) -> TransferMatrix<A> {
        let first = self.waves.first().map_or(0.0, |wave| wave.delay);
        let steady = A::from(self.half_resistance * CORNERS[0]) / (A::from(CORNERS[0]) + s.scaled(first));
        let waves = self.waves.map(|wave| wave.response(s));
        let product = |of: &dyn Fn(&WaveResponse<A>) -> A, without: Option<usize>| {
            let others = waves.iter().enumerate().filter(|(index, _)| Some(*index) != without);
            others.fold(A::from(1.0), |product, (_, wave)| product * of(wave))
        };
        let (sum, decay) = (|wave: &WaveResponse<A>| wave.sum, |wave: &WaveResponse<A>| wave.decay);
        let (both_decays, both_sums) = (product(&decay, None), product(&sum, None));
        let (mut in_phase, mut in_opposition) = (s * steady * both_decays, steady * both_sums);
        for (index, (response, wave)) in waves.iter().zip(&self.waves).enumerate() {
            let yielding = (response.impedance * response.sum).scaled(1.0 / wave.delay);
            in_phase = in_phase + yielding * product(&decay, Some(index));
            let passing = response.impedance * response.angle * response.decay;
            in_opposition = in_opposition + passing * product(&sum, Some(index));
        }
        let (own, crossed) = (in_phase * both_sums, s * both_decays * in_opposition);
        let divisor = own - crossed;
        let straight = (own + crossed) / divisor;
        let passed = TransferMatrix {
            pressure: straight,
            impedance: (in_phase * in_opposition).scaled(2.0) / divisor,
            admittance: (s * both_decays * both_sums).scaled(2.0) / divisor,
            flow: straight,
        };
        let end = s.scaled(self.end_compliance);
        TransferMatrix {
            admittance: passed.admittance + end * passed.pressure,
            flow: passed.flow + end * passed.impedance,
            ..passed
        }
    }

    /// Steady resistance of the line, Pa s/m3: waves at rest add none.
    pub(in crate::line) fn resistance(&self) -> f64 {
        2.0 * self.half_resistance
    }

    /// Immediate compliance, m3/Pa.
    ///
    /// ```text
    /// C = 2 C_end + 1/sum of Z_i/T_i
    /// ```
    pub(in crate::line) fn elastic_compliance(&self) -> f64 {
        let stiffness: f64 = self.waves.iter().map(|wave| wave.impedance / wave.delay).sum();
        2.0 * self.end_compliance + 1.0 / stiffness
    }

    /// Line with fluid and wall stiffer by a factor: its inertia and its friction are unchanged.
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
    /// Response of a wave at s.
    ///
    /// ```text
    /// E = e^(-s T) (1 - s T l(s)),     l(s) = sum over i of w_i/(c_i + s T)
    /// (1 - E)/(s T) = (1 - e^(-s T))/(s T) + l(s) e^(-s T)
    /// ```
    fn response<A: Analytic>(&self, s: A) -> WaveResponse<A> {
        let angle = s.scaled(self.delay);
        let mut lags = A::from(0.0);
        for (weight, corner) in self.weights.iter().zip(CORNERS) {
            lags = lags + A::from(*weight) / (A::from(corner) + angle);
        }
        let one = A::from(1.0);
        let delayed = (-angle).exponential();
        WaveResponse {
            impedance: (one + lags).scaled(self.impedance),
            sum: one + delayed * (one - angle * lags),
            decay: angle.mean_of_decay() + delayed * lags,
            angle,
        }
    }
}
