//! Plant measured through a sensor.

use super::realization::Realization;
use super::{Plant, Sliding};
use crate::controller::{RateSensor, VirtualImpedance};
use crate::linear::{LinearError, TransferFunction};
use crate::scalar::Scalar;

/// Plant whose measurement passes through the dynamics of a sensor and its dead time.
///
/// ```text
/// dx/dt = A x + B y,    m(t) = C x(t - d) + D y(t - d)         y the output of the plant, m the measurement of the controller
/// y = F + Z_v (x_L - x_0)                                       with a virtual impedance: F the measurement of the plant
/// ```
///
/// States are those of the plant, those of the sensor, those of the sensor of the rate that a
/// controller may feed forward (a [`RateSensor`] between the disturbance of the plant and that of
/// this one), and those of a [`VirtualImpedance`]: its filter, and the rest position x_0, which
/// does not change. A sensor with gain one and no dead time adds no states.
///
/// # Example
/// ```
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{Plant, Sensed};
/// /// A tank that a command fills.
/// struct Tank;
/// impl Plant<f64> for Tank {
///     fn states(&self) -> usize {
///         1
///     }
///     fn inputs(&self) -> usize {
///         0
///     }
///     fn scales(&self) -> Vec<f64> {
///         vec![1.0]
///     }
///     fn command_scale(&self) -> f64 {
///         1.0
///     }
///     fn measurement_scale(&self) -> f64 {
///         1.0
///     }
///     fn rates<T: Scalar + From<f64>>(&self, _: &[T], command: T, _: &[T], rates: &mut [T]) {
///         rates[0] = command;
///     }
///     fn measurement<T: Scalar + From<f64>>(&self, state: &[T], _: &[T]) -> T {
///         state[0]
///     }
/// }
/// // 10/(s + 10) sees nothing at first, and follows the level at ten times the difference
/// let sensor = TransferFunction::from_factors(10.0, vec![], vec![(-10.0).into()])?;
/// let seen = Sensed::new(Tank, &sensor)?;
/// let mut rates = [0.0; 2];
/// seen.rates(&[3.0, 0.0], 0.5, &[], &mut rates);
/// assert_eq!(rates[0], 0.5);
/// assert_eq!(seen.measurement(&[3.0, 0.0], &[]), 0.0);
/// let settled = seen.sensor_at_rest(3.0);
/// assert!((seen.measurement(&[3.0, settled[0]], &[]) - 3.0).abs() < 1e-12);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sensed<P> {
    plant: P,
    sensor: Realization,
    delay_s: f64,
    /// Sensor of the rate; `None` if the disturbance is measured directly.
    rate: Option<SensedRate>,
    /// Realisation of Z_v of a virtual impedance; `None` without one.
    impedance: Option<Realization>,
}

/// Sensor of a rate as states.
#[derive(Clone, Debug, PartialEq)]
struct SensedRate {
    filter: Realization,
    delay_s: f64,
}

impl<P> Sensed<P> {
    /// Plant measured through this sensor.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`] for a sampled one, [`LinearError::Improper`].
    pub fn new(plant: P, sensor: &TransferFunction) -> Result<Self, LinearError> {
        let delay_s = sensor.dead_time_s();
        let sensor = Realization::new(&sensor.clone().with_dead_time(0.0)?)?;
        Ok(Sensed { plant, sensor, delay_s, rate: None, impedance: None })
    }

    /// Plant with its disturbance measured by this sensor.
    ///
    /// # Errors
    /// [`LinearError`] for a sensor that has no transfer function.
    pub fn with_rate_sensor(self, sensor: &RateSensor) -> Result<Self, LinearError> {
        if sensor.is_direct() {
            return Ok(Sensed { rate: None, ..self });
        }
        let filter = RateSensor { delay_s: 0.0, ..*sensor }.transfer_function()?;
        let rate = SensedRate { filter: Realization::new(&filter)?, delay_s: sensor.delay_s };
        Ok(Sensed { rate: Some(rate), ..self })
    }

    /// Plant with the force of a virtual impedance added to its measurement; an impedance of zero
    /// adds nothing.
    ///
    /// # Errors
    /// [`LinearError`] for a damper or a mass without a filter.
    pub fn with_impedance(self, impedance: &VirtualImpedance) -> Result<Self, LinearError> {
        if impedance.is_zero() {
            return Ok(Sensed { impedance: None, ..self });
        }
        Ok(Sensed { impedance: Some(Realization::new(&impedance.transfer_function()?)?), ..self })
    }

    /// Plant without a virtual impedance.
    #[must_use]
    pub fn without_impedance(self) -> Self {
        Sensed { impedance: None, ..self }
    }

    /// The plant.
    pub fn plant(&self) -> &P {
        &self.plant
    }

    /// The plant, mutable.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.plant
    }

    /// States of the sensors at constant output of the plant, whose rate is zero, with the load at
    /// its rest position of zero: see [`Sensed::rest_at`].
    pub fn sensor_at_rest(&self, measured: f64) -> Vec<f64> {
        let mut states = self.sensor.at_rest(measured, None);
        states.resize(states.len() + self.rate_states() + self.impedance_states(), 0.0);
        states
    }

    /// Number of states of a virtual impedance: the last ones, with the rest position.
    #[inline(always)]
    pub fn impedance_states(&self) -> usize {
        self.impedance.as_ref().map_or(0, |impedance| impedance.states + 1)
    }

    /// Sets the rest position of a virtual impedance to the load position of a state, with its
    /// filter at rest.
    pub fn rest_at(&self, state: &mut [f64], inputs: &[f64])
    where
        P: Plant<f64>,
    {
        if self.impedance.is_none() {
            return;
        }
        let (own_state, own_inputs) = self.of_plant::<f64, f64>(state, inputs);
        let position = self.plant.position(own_state, own_inputs);
        let end = Plant::<f64>::states(self);
        let virtual_states = &mut state[end - self.impedance_states()..end];
        virtual_states.fill(0.0);
        if let Some(rest) = virtual_states.last_mut() {
            *rest = position;
        }
    }

    /// Output of a virtual impedance for the position of the load, in the unit of the measurement:
    /// the force by which the reference yields. Zero without one.
    #[inline(always)]
    pub fn given_way<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T
    where
        P: Plant<S>,
    {
        let Some(impedance) = &self.impedance else { return T::from(0.0) };
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        let own = self.virtual_states(state);
        impedance.output(own, self.plant.position(own_state, own_inputs) - own[impedance.states])
    }

    #[inline(always)]
    fn virtual_states<'t, S: Scalar, T: Scalar + From<S>>(&self, state: &'t [T]) -> &'t [T]
    where
        P: Plant<S>,
    {
        let from = self.plant.states() + self.sensor.states + self.rate_states();
        &state[from..from + self.impedance_states()]
    }

    /// Measurement of the plant plus the output of a virtual impedance.
    #[inline(always)]
    fn given<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T
    where
        P: Plant<S>,
    {
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        let measured = self.plant.measurement(own_state, own_inputs);
        match self.impedance.is_some() {
            true => measured + self.given_way::<S, T>(state, inputs),
            false => measured,
        }
    }

    /// Number of states of the sensor of the rate.
    #[inline(always)]
    pub fn rate_states(&self) -> usize {
        self.rate.as_ref().map_or(0, |rate| rate.filter.states)
    }

    /// True if the sensor has dead time.
    #[inline(always)]
    fn is_late(&self) -> bool {
        self.delay_s > 0.0
    }

    /// True if the sensor of the rate has dead time.
    #[inline(always)]
    fn is_rate_late(&self) -> bool {
        self.rate.as_ref().is_some_and(|rate| rate.delay_s > 0.0)
    }

    /// States and inputs of the plant.
    #[inline(always)]
    fn of_plant<'t, S: Scalar, T: Scalar + From<S>>(
        &self,
        state: &'t [T],
        inputs: &'t [T],
    ) -> (&'t [T], &'t [T])
    where
        P: Plant<S>,
    {
        (&state[..self.plant.states()], &inputs[..self.plant.inputs()])
    }

    #[inline(always)]
    fn shown<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T
    where
        P: Plant<S>,
    {
        let from = self.plant.states();
        let of_sensor = &state[from..from + self.sensor.states];
        self.sensor.output(of_sensor, self.given::<S, T>(state, inputs))
    }

    /// Filtered rate before its dead time.
    #[inline(always)]
    fn shown_rate<S: Scalar, T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T
    where
        P: Plant<S>,
    {
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        let given = self.plant.disturbance(own_state, own_inputs);
        let Some(rate) = &self.rate else { return given };
        rate.filter.output(&state[own_state.len() + self.sensor.states..], given)
    }
}

impl<S: Scalar, P: Plant<S>> Plant<S> for Sensed<P> {
    #[inline(always)]
    fn states(&self) -> usize {
        self.plant.states() + self.sensor.states + self.rate_states() + self.impedance_states()
    }

    #[inline(always)]
    fn inputs(&self) -> usize {
        self.plant.inputs() + usize::from(self.is_late()) + usize::from(self.is_rate_late())
    }

    fn scales(&self) -> Vec<S> {
        let mut scales = self.plant.scales();
        scales.extend(self.sensor.scales(self.plant.measurement_scale()));
        if let Some(rate) = &self.rate {
            scales.extend(rate.filter.scales(self.plant.disturbance_scale()));
        }
        if let Some(impedance) = &self.impedance {
            scales.extend(impedance.scales(self.plant.measurement_scale()));
            scales.push(self.plant.position_scale());
        }
        scales
    }

    fn command_scale(&self) -> S {
        self.plant.command_scale()
    }

    fn measurement_scale(&self) -> S {
        self.plant.measurement_scale()
    }

    #[inline(always)]
    fn rates<T: Scalar + From<S>>(&self, state: &[T], command: T, inputs: &[T], rates: &mut [T]) {
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        let (plant_rates, sensor_rates) = rates.split_at_mut(own_state.len());
        self.plant.rates(own_state, command, own_inputs, plant_rates);
        let given = self.given::<S, T>(state, inputs);
        let (of_sensor, of_rate) = state[own_state.len()..].split_at(self.sensor.states);
        let (sensor_rates, rate_rates) = sensor_rates.split_at_mut(self.sensor.states);
        let (rate_rates, virtual_rates) = rate_rates.split_at_mut(self.rate_states());
        self.sensor.rates(of_sensor, given, sensor_rates);
        if let Some(rate) = &self.rate {
            let given = self.plant.disturbance(own_state, own_inputs);
            rate.filter.rates(of_rate, given, rate_rates);
        }
        if let Some(impedance) = &self.impedance {
            let own = self.virtual_states::<S, T>(state);
            let away = self.plant.position(own_state, own_inputs) - own[impedance.states];
            virtual_rates.fill(T::from(0.0));
            impedance.rates(own, away, virtual_rates);
        }
    }

    #[inline(always)]
    fn measurement<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T {
        if self.is_late() { inputs[self.plant.inputs()] } else { self.shown::<S, T>(state, inputs) }
    }

    fn disturbance<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T {
        match self.is_rate_late() {
            true => inputs[self.plant.inputs() + usize::from(self.is_late())],
            false => self.shown_rate::<S, T>(state, inputs),
        }
    }

    fn disturbance_scale(&self) -> S {
        self.plant.disturbance_scale()
    }

    #[inline(always)]
    fn inner_measurement<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T {
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        self.plant.inner_measurement(own_state, own_inputs)
    }

    fn inner_measurement_scale(&self) -> S {
        self.plant.inner_measurement_scale()
    }

    fn delays(&self) -> Vec<S> {
        let own = self.is_late().then(|| S::from(self.delay_s));
        let of_rate = self.rate.iter().map(|rate| rate.delay_s).filter(|delay_s| *delay_s > 0.0);
        self.plant.delays().into_iter().chain(own).chain(of_rate.map(S::from)).collect()
    }

    fn outgoing<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        let of_plant = waves.len() - usize::from(self.is_late()) - usize::from(self.is_rate_late());
        let (plant_waves, own) = waves.split_at_mut(of_plant);
        self.plant.outgoing(own_state, own_inputs, plant_waves);
        let (of_sensor, of_rate) = own.split_at_mut(usize::from(self.is_late()));
        if let Some(wave) = of_sensor.first_mut() {
            *wave = self.shown::<S, T>(state, inputs);
        }
        if let Some(wave) = of_rate.first_mut() {
            *wave = self.shown_rate::<S, T>(state, inputs);
        }
    }

    fn sliding(&self) -> Option<Sliding> {
        self.plant.sliding()
    }

    fn indicators(&self) -> usize {
        self.plant.indicators()
    }

    fn indicate<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], indicators: &mut [T]) {
        let (state, inputs) = self.of_plant::<S, T>(state, inputs);
        self.plant.indicate(state, inputs, indicators);
    }

    fn kinks(&self) -> usize {
        self.plant.kinks()
    }

    fn mark<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], marks: &mut [T]) {
        let (state, inputs) = self.of_plant::<S, T>(state, inputs);
        self.plant.mark(state, inputs, marks);
    }
}
