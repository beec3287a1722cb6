//! A plant that a search evaluates temporarily: for a sampled one, its response at a frequency from
//! its modes, without the zeros of its factors.

use std::cell::OnceCell;
use std::rc::Rc;

use num_complex::Complex64;
use phea_dynamics::linear::{HeldFactors, HeldModes, HeldPoint, Polynomial, TransferFunction};
use phea_dynamics::uncertain_plant::{PlantCoefficients, PlantMember, RationalCoefficients};

use super::{Compensation, FedForward, Member, moved_rate};

/// A plant within a loop, ready for a few frequencies.
#[derive(Clone, Debug)]
pub enum TrialPlant {
    /// The whole member.
    Whole(Rc<Member>),
    /// A sampled plant by its modes.
    Held(Rc<ModalPlant>),
}

/// A held and sampled plant by its modes, converted to a whole member once that is needed.
#[derive(Debug)]
pub struct ModalPlant {
    poles: Vec<Complex64>,
    command: HeldModes,
    /// Modes of the plant with its sensor; `None` if the output itself is fed back.
    with_sensor: Option<HeldModes>,
    /// Modes of P_p, and H, of an inner signal; `None` if none is fed back.
    inner: Option<(HeldModes, TransferFunction)>,
    pub(crate) disturbance: Option<RationalCoefficients<f64>>,
    pub(crate) fed_forward: FedForward,
    plant: PlantCoefficients<f64>,
    whole: OnceCell<Option<Rc<Member>>>,
}

/// Responses P and P H of a held plant at a frequency, and the denominator of P H.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldResponse {
    /// Plant P, with hold and delay.
    pub plant: Complex64,
    /// Plant with sensor, P H.
    pub with_sensor: Complex64,
    /// The product of z - p over the poles of P H.
    pub denominator: Complex64,
}

impl Compensation {
    /// A plant of a family within this loop, for a trial evaluation; `None` if it cannot be
    /// sampled. The poles are sought near those of another plant, if one is given.
    ///
    /// # Example
    /// Plant 4/(s + 2), sampled every 0.1 s, at 2 rad/s: the response from the modes equals that
    /// from the factors.
    /// ```
    /// use phea_dynamics::controller::{Controller, Timing};
    /// use phea_dynamics::linear::TransferFunction;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, PlantMember, RationalCoefficients};
    /// use phea_qft::closed_loop::{Compensation, TrialPlant};
    /// let timing = Timing { sample_time_s: Some(0.1), ..Timing::default() };
    /// let controller = Controller { timing, ..Controller::default() };
    /// let around = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
    /// let command = RationalCoefficients { numerator: vec![4.0], denominator: vec![1.0, 2.0] };
    /// let plant = PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None };
    /// let tried = around.trial(PlantMember::Rational(plant), None).ok_or("it can be sampled")?;
    /// let TrialPlant::Held(held) = &tried else { return Err("it has a mode".into()) };
    /// let (found, whole) = (held.at(2.0).ok_or("a mode")?, tried.whole(&around).ok_or("factors")?);
    /// assert!((found.plant - whole.response(2.0).ok_or("factors")?.plant).norm_sqr() < 1e-28);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn trial(&self, plant: PlantMember, near: Option<&TrialPlant>) -> Option<TrialPlant> {
        let held = match &plant {
            PlantMember::Rational(coefficients) => self.held(coefficients, near),
            PlantMember::Responding(_) => None,
        };
        match held {
            Some(held) => Some(TrialPlant::Held(Rc::new(held))),
            None => self.around(plant).ok().map(|whole| TrialPlant::Whole(Rc::new(whole))),
        }
    }

    /// A rational plant of a sampled loop by its modes; `None` if they are not distinct, or if a
    /// rate is fed back within the plant.
    fn held(&self, plant: &PlantCoefficients<f64>, near: Option<&TrialPlant>) -> Option<ModalPlant> {
        let sample_time_s = self.sample_time_s?;
        let fed_back = self.rate_feed_forward != 0.0 && moved_rate(plant).is_some();
        if fed_back || plant.dead_time_s < 0.0 {
            return None;
        }
        let denominator = Polynomial::new(plant.command.denominator.clone());
        let known = match near {
            Some(TrialPlant::Held(near)) => denominator.roots_near(&near.poles),
            _ => None,
        };
        let poles = known.or_else(|| denominator.roots().ok())?;
        let sensor = &self.sensor;
        let own = HeldFactors {
            numerator: &plant.command.numerator,
            gain: 1.0 / denominator.leading_coefficient(),
            zeros: &[],
            poles: &poles,
            dead_time_s: plant.dead_time_s + self.delay_s,
        };
        let seen = [&poles[..], sensor.poles()].concat();
        let with_sensor = match self.senses_the_output() {
            true => None,
            false => Some(HeldModes::new(
                HeldFactors {
                    gain: own.gain * sensor.gain(),
                    zeros: sensor.zeros(),
                    poles: &seen,
                    dead_time_s: own.dead_time_s + sensor.dead_time_s(),
                    ..own
                },
                sample_time_s,
            )?),
        };
        let signal = plant.rate.as_ref().and_then(|rate| rate.inner.as_ref());
        let inner = match self.inner_feedback.as_ref().zip(signal) {
            Some((feedback, [numerator, _])) => {
                Some((HeldModes::new(HeldFactors { numerator, ..own }, sample_time_s)?, feedback.clone()))
            }
            None => None,
        };
        let fed_back = self.inner_feedback.as_ref();
        Some(ModalPlant {
            inner,
            command: HeldModes::new(own, sample_time_s)?,
            with_sensor,
            disturbance: plant.disturbance.clone(),
            fed_forward: FedForward::of(self.rate_feed_forward, self.rate_sensor, fed_back, plant),
            plant: plant.clone(),
            whole: OnceCell::new(),
            poles,
        })
    }
}

impl TrialPlant {
    /// The whole member; `None` if it cannot be sampled.
    pub fn whole(&self, compensation: &Compensation) -> Option<Rc<Member>> {
        match self {
            TrialPlant::Whole(member) => Some(Rc::clone(member)),
            TrialPlant::Held(held) => held.whole(compensation),
        }
    }
}

impl ModalPlant {
    /// Response at a frequency; `None` where the modes do not give it.
    pub fn at(&self, frequency_rad_per_s: f64) -> Option<HeldResponse> {
        let HeldPoint { response, denominator } = self.command.at(frequency_rad_per_s)?;
        let back = self.fed_back(frequency_rad_per_s)?;
        let closed = |with_sensor: Complex64, denominator: Complex64| HeldResponse {
            plant: response / back,
            with_sensor: with_sensor / back,
            denominator: denominator * back,
        };
        let Some(with_sensor) = &self.with_sensor else { return Some(closed(response, denominator)) };
        let seen = with_sensor.at(frequency_rad_per_s)?;
        Some(closed(seen.response, seen.denominator))
    }

    /// Return difference 1 + H P_p of the inner loop; one if nothing is fed back.
    fn fed_back(&self, frequency_rad_per_s: f64) -> Option<Complex64> {
        let Some((modes, feedback)) = &self.inner else { return Some(Complex64::ONE) };
        let signal = modes.at(frequency_rad_per_s)?.response;
        Some(1.0 + feedback.at_frequency(frequency_rad_per_s) * signal)
    }

    /// True if its factors were needed.
    pub fn is_whole(&self) -> bool {
        self.whole.get().is_some()
    }

    /// The whole member with its factors, within the loop of this plant.
    pub fn whole(&self, compensation: &Compensation) -> Option<Rc<Member>> {
        let build = || compensation.member(self.plant.clone()).ok().map(Rc::new);
        self.whole.get_or_init(build).clone()
    }
}
