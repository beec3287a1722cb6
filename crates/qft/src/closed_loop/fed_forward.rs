//! Feed-forward of a rate, sampled and delayed like the rest of the command: a second path of the
//! disturbance, and an additional loop if the command also moves that rate. Inner feedback of a
//! signal likewise.
//!
//! ```text
//! u = G (F r - y) + K H_v v - H p,     y = P u + Pd d,     v = P_v u + V_d d,     p = P_p u + I_d d
//! P' = P/(1 - K H_v P_v),        Pd' = Pd + K H_v V_d P'            V_d = s and P_v = 0 if v is the rate of d itself
//! P' = P/(1 + H P_p),            Pd' = Pd - H I_d P'
//! ```
//!
//! H_v is the sensor of the rate, before the samples: its filter has poles that P lacks, which are
//! zeros of P'; its dead time is only in P_v and V_d.
//!
//! In a sampled loop P and P_v are held and sampled, V_d is not: for a sinusoidal d the samples of
//! v are those of a sine. H_v P_v has the poles of P; in P' these are replaced by the zeros of 1 -
//! K H_v P_v. H belongs to the controller, in z: its poles are zeros of P' too.

use num_complex::Complex64;
use phea_dynamics::controller::RateSensor;
use phea_dynamics::linear::{LinearError, LinearOperation, Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators, RationalCoefficients};

/// Feed-forward path K H_v V_d of one plant.
#[derive(Clone, Debug, PartialEq)]
pub struct FedForward {
    /// Feed-forward gain K.
    pub gain: f64,
    /// Path V_d from the disturbance to the rate; `None` if it is s.
    pub path: Option<RationalCoefficients<f64>>,
    /// Sensor H_v of the rate.
    pub sensor: RateSensor,
    /// Feedback H and path I_d of an inner signal; `None` if none is fed back.
    pub inner: Option<InnerPath>,
}

/// Effect of a disturbance through the inner feedback.
#[derive(Clone, Debug, PartialEq)]
pub struct InnerPath {
    /// Inner feedback H, in z.
    pub feedback: TransferFunction,
    /// Path I_d from the disturbance to the inner signal.
    pub path: RationalCoefficients<f64>,
}

/// The rate of a plant, if the command moves it.
pub(crate) fn moved_rate(plant: &PlantCoefficients<f64>) -> Option<&RateNumerators<f64>> {
    plant.rate.as_ref().filter(|rate| rate.command.iter().any(|coefficient| *coefficient != 0.0))
}

/// Replaces the poles of P by those of P'.
#[derive(Debug)]
pub(super) struct FedBack {
    own: Vec<Complex64>,
    closed: Vec<Complex64>,
    /// Delay of P and P_v, whole samples.
    samples: usize,
    sample_time_s: f64,
}

/// Largest delay that may become poles, samples: as many as may become states.
const DELAY_MAXIMUM: f64 = 200.0;

impl FedForward {
    pub(crate) fn of(
        gain: f64,
        sensor: RateSensor,
        inner: Option<&TransferFunction>,
        plant: &PlantCoefficients<f64>,
    ) -> FedForward {
        let over = |numerator: &Vec<f64>| RationalCoefficients {
            numerator: numerator.clone(),
            denominator: plant.command.denominator.clone(),
        };
        let rate = plant.rate.as_ref();
        let path = rate.filter(|_| gain != 0.0).map(|rate| over(&rate.disturbance));
        let inner = inner.zip(rate.and_then(|rate| rate.inner.as_ref())).map(|(feedback, [_, numerator])| {
            InnerPath { feedback: feedback.clone(), path: over(numerator) }
        });
        FedForward { gain, path, sensor, inner }
    }

    /// Response K H_v V_d - H I_d at jw.
    pub(crate) fn at(&self, frequency_rad_per_s: f64) -> Complex64 {
        let back = self.inner.as_ref().map_or(Complex64::ZERO, |InnerPath { feedback, path }| {
            feedback.at_frequency(frequency_rad_per_s) * path.at_frequency(frequency_rad_per_s)
        });
        let rate = match &self.path {
            _ if self.gain == 0.0 => return -back,
            None => Complex64::new(0.0, self.gain * frequency_rad_per_s),
            Some(path) => self.gain * path.at_frequency(frequency_rad_per_s),
        };
        let shown =
            if self.sensor.is_direct() { rate } else { rate * self.sensor.at_frequency(frequency_rad_per_s) };
        shown - back
    }
}

/// Path P_p before the dead time of the command; `None` if no inner signal is fed back.
pub(super) fn inner_path(
    inner: Option<&TransferFunction>,
    plant: &PlantCoefficients<f64>,
) -> Result<Option<TransferFunction>, LinearError> {
    let numerators = plant.rate.as_ref().and_then(|rate| rate.inner.as_ref());
    let Some((_, [numerator, _])) = inner.zip(numerators) else { return Ok(None) };
    let denominator = Polynomial::new(plant.command.denominator.clone());
    TransferFunction::from_polynomials(&Polynomial::new(numerator.clone()), &denominator).map(Some)
}

/// A plant towards zero frequency, including the inner feedback with H(1): N/(D + H(1) N_p).
pub(crate) fn closed_at_rest(
    inner: Option<&TransferFunction>,
    mut plant: PlantCoefficients<f64>,
) -> PlantCoefficients<f64> {
    let numerators = plant.rate.as_ref().and_then(|rate| rate.inner.as_ref());
    if let Some((feedback, [numerator, _])) = inner.zip(numerators) {
        let back = Polynomial::new(numerator.clone()).scaled(feedback.dc_gain());
        let whole = Polynomial::new(plant.command.denominator).sum(&back);
        plant.command.denominator = whole.coefficients().to_vec();
    }
    plant
}

/// Path H_v P_v before the dead time of the command; `None` if nothing is fed back.
pub(super) fn rate_path(
    gain: f64,
    sensor: RateSensor,
    plant: &PlantCoefficients<f64>,
) -> Result<Option<TransferFunction>, LinearError> {
    let Some(rate) = moved_rate(plant).filter(|_| gain != 0.0) else { return Ok(None) };
    let denominator = Polynomial::new(plant.command.denominator.clone());
    let own = TransferFunction::from_polynomials(&Polynomial::new(rate.command.clone()), &denominator)?;
    if sensor.is_direct() { Ok(Some(own)) } else { own.series(&sensor.transfer_function()?).map(Some) }
}

/// A plant of a continuous loop without dead time, including its internal feedback: N/(D - K N_v),
/// and d_v N/(d_v D - K N_v) after the filter H_v = 1/d_v of a sensor.
pub(crate) fn closed(
    gain: f64,
    sensor: RateSensor,
    mut plant: PlantCoefficients<f64>,
) -> Result<PlantCoefficients<f64>, LinearError> {
    let Some(rate) = moved_rate(&plant).filter(|_| gain != 0.0) else { return Ok(plant) };
    if plant.dead_time_s > 0.0 || sensor.delay_s > 0.0 {
        return Err(LinearError::NotRational { operation: LinearOperation::RateFeedback });
    }
    let back = Polynomial::new(rate.command.clone()).scaled(-gain);
    let filter = Polynomial::new(sensor.filter.denominator());
    let filtered = |coefficients: Vec<f64>| match sensor.is_direct() {
        true => Polynomial::new(coefficients),
        false => Polynomial::new(coefficients).product(&filter),
    };
    plant.command.denominator = filtered(plant.command.denominator).sum(&back).coefficients().to_vec();
    plant.command.numerator = filtered(plant.command.numerator).coefficients().to_vec();
    Ok(plant)
}

impl FedBack {
    /// Closes the paths of a rate and of an inner signal, both held and sampled; `None` if neither
    /// is fed back.
    pub(super) fn of(
        rate: Option<(f64, &TransferFunction)>,
        inner: Option<(&TransferFunction, &TransferFunction)>,
    ) -> Result<Option<FedBack>, LinearError> {
        match (rate, inner) {
            (None, None) => Ok(None),
            (Some((gain, rate)), None) => FedBack::new(gain, rate).map(Some),
            (None, Some((feedback, path))) => FedBack::new(-1.0, &path.series(feedback)?).map(Some),
            (Some(_), Some(_)) => {
                Err(LinearError::NotRational { operation: LinearOperation::RateAndInnerFeedback })
            }
        }
    }

    /// Feedback of K P_v, held and sampled.
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

    /// The plant P/(1 - K P_v), or such a plant followed by a sensor: it has the poles of P_v
    /// except those of the rate's filter. Dead time of P_v beyond that of P gives zeros at z = 0.
    pub(super) fn around(&self, function: &TransferFunction) -> Result<TransferFunction, LinearError> {
        let (mut poles, mut zeros) = (function.poles().to_vec(), function.zeros().to_vec());
        let mut samples = (function.dead_time_s() / self.sample_time_s).round() - self.samples as f64;
        for own in &self.own {
            match poles.iter().position(|pole| pole == own) {
                Some(index) => drop(poles.swap_remove(index)),
                // the fraction of a sample that a further delay completed
                None if *own == Complex64::ZERO => samples -= 1.0,
                None => zeros.push(*own),
            }
        }
        let ahead = (-samples).max(0.0) as usize;
        zeros.resize(zeros.len() + ahead, Complex64::ZERO);
        poles.extend(&self.closed);
        TransferFunction::from_factors(function.gain(), zeros, poles)?
            .in_domain(function.domain())?
            .with_dead_time(samples.max(0.0) * self.sample_time_s)
    }
}
