//! A rate that is fed forward, sampled and delayed like the rest of the command: a second path of
//! the disturbance, and a loop where the command moves that rate too.
//!
//! ```text
//! u = G (F r - y) + K v,     y = P u + Pd d,     v = P_v u + V_d d
//! P' = P/(1 - K P_v),        Pd' = Pd + K V_d P'                    V_d = s and P_v = 0 where v is the rate of d itself
//! ```
//!
//! In a sampled loop P and P_v are held and sampled, V_d is not: of a sine of d the samples of v
//! are those of a sine. P and P_v have the same poles, and P' those of 1 - K P_v in their place.

use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};

/// K V_d of one plant.
#[derive(Clone, Debug, PartialEq)]
pub struct FedForward {
    /// K
    pub gain: f64,
    /// V_d; `None` where it is s.
    pub path: Option<RationalCoefficients<f64>>,
}

/// What takes the poles of P for those of P'.
#[derive(Debug)]
pub(super) struct FedBack {
    own: Vec<Complex64>,
    closed: Vec<Complex64>,
    /// Whole samples by which P and P_v are delayed.
    samples: usize,
    sample_time_s: f64,
}

/// Samples of delay that may become poles, as many as may become states.
const DELAY_MAXIMUM: f64 = 200.0;

impl FedForward {
    pub(crate) fn of(gain: f64, plant: &PlantCoefficients<f64>) -> FedForward {
        let path = plant.rate.as_ref().filter(|_| gain != 0.0).map(|rate| RationalCoefficients {
            numerator: rate.disturbance.clone(),
            denominator: plant.command.denominator.clone(),
        });
        FedForward { gain, path }
    }

    /// K V_d(jw)
    pub(crate) fn at(&self, frequency_rad_per_s: f64) -> Complex64 {
        match &self.path {
            _ if self.gain == 0.0 => Complex64::ZERO,
            None => Complex64::new(0.0, self.gain * frequency_rad_per_s),
            Some(path) => self.gain * path.at_frequency(frequency_rad_per_s),
        }
    }
}

/// P_v before its dead time; `None` where nothing is fed back.
pub(super) fn rate_path(
    gain: f64,
    plant: &PlantCoefficients<f64>,
) -> Result<Option<TransferFunction>, LinearError> {
    let Some(rate) = plant.rate.as_ref().filter(|_| gain != 0.0) else { return Ok(None) };
    let denominator = Polynomial::new(plant.command.denominator.clone());
    TransferFunction::from_polynomials(&Polynomial::new(rate.command.clone()), &denominator).map(Some)
}

/// A plant of a continuous loop without dead time, including what is fed back within it: N/(D - K
/// N_v).
pub(crate) fn closed(
    gain: f64,
    mut plant: PlantCoefficients<f64>,
) -> Result<PlantCoefficients<f64>, LinearError> {
    let Some(rate) = plant.rate.as_ref().filter(|_| gain != 0.0) else { return Ok(plant) };
    if plant.dead_time_s > 0.0 {
        return Err(LinearError::NotRational { operation: "a rate that is fed back" });
    }
    let back = Polynomial::new(rate.command.clone()).scaled(-gain);
    plant.command.denominator = Polynomial::new(plant.command.denominator).sum(&back).coefficients().to_vec();
    Ok(plant)
}

impl FedBack {
    /// Of K and of P_v, held and sampled.
    pub(super) fn new(gain: f64, rate: &TransferFunction) -> Result<FedBack, LinearError> {
        let TimeDomain::Discrete { sample_time_s } = rate.domain() else {
            return Err(LinearError::DomainMismatch);
        };
        let samples = (rate.dead_time_s() / sample_time_s).round();
        if samples > DELAY_MAXIMUM {
            return Err(LinearError::TooManyDelayStates { samples });
        }
        let mut poles = rate.poles().to_vec();
        poles.resize(poles.len() + samples as usize, Complex64::ZERO);
        let open = TransferFunction::from_factors(rate.gain(), rate.zeros().to_vec(), poles)?;
        let around = open.in_domain(rate.domain())?.feedback(&TransferFunction::gain_only(-gain))?;
        Ok(FedBack {
            own: rate.poles().to_vec(),
            closed: around.poles().to_vec(),
            samples: samples as usize,
            sample_time_s,
        })
    }

    /// P/(1 - K P_v), and so with what stands behind P as a sensor does: it has the poles of P_v,
    /// and its dead time at least.
    pub(super) fn around(&self, function: &TransferFunction) -> Result<TransferFunction, LinearError> {
        let (mut poles, mut zeros) = (function.poles().to_vec(), function.zeros().to_vec());
        let mut samples = (function.dead_time_s() / self.sample_time_s).round() - self.samples as f64;
        for own in &self.own {
            match poles.iter().position(|pole| pole == own) {
                Some(index) => drop(poles.swap_remove(index)),
                // the rest of a sample that a further delay made whole
                None if *own == Complex64::ZERO => samples -= 1.0,
                None => zeros.push(*own),
            }
        }
        poles.extend(&self.closed);
        TransferFunction::from_factors(function.gain(), zeros, poles)?
            .in_domain(function.domain())?
            .with_dead_time(samples.max(0.0) * self.sample_time_s)
    }
}
