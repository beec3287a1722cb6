//! A plant that is seen through a sensor.

use super::realization::Realization;
use super::{Plant, Sliding};
use crate::linear::{LinearError, TransferFunction};
use crate::scalar::Scalar;

/// A plant whose measurement passes through the dynamics of a sensor and its dead time.
///
/// ```text
/// dx/dt = A x + B y,    m(t) = C x(t - d) + D y(t - d)         y what the plant gives, m what the controller sees
/// ```
///
/// States are those of the plant and then those of the sensor. A sensor of one without dead time
/// adds nothing.
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
}

impl<P> Sensed<P> {
    /// This plant, seen through this sensor.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`] for a sampled one, [`LinearError::Improper`].
    pub fn new(plant: P, sensor: &TransferFunction) -> Result<Self, LinearError> {
        let delay_s = sensor.dead_time_s();
        let sensor = Realization::new(&sensor.clone().with_dead_time(0.0)?)?;
        Ok(Sensed { plant, sensor, delay_s })
    }

    /// The plant.
    pub fn plant(&self) -> &P {
        &self.plant
    }

    /// The plant, to be changed.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.plant
    }

    /// States of the sensor at constant output of the plant.
    pub fn sensor_at_rest(&self, measured: f64) -> Vec<f64> {
        self.sensor.at_rest(measured, None)
    }

    /// States of the plant, and inputs of the plant.
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
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        self.sensor.output(&state[own_state.len()..], self.plant.measurement(own_state, own_inputs))
    }
}

impl<S: Scalar, P: Plant<S>> Plant<S> for Sensed<P> {
    #[inline(always)]
    fn states(&self) -> usize {
        self.plant.states() + self.sensor.states
    }

    #[inline(always)]
    fn inputs(&self) -> usize {
        self.plant.inputs() + usize::from(self.delay_s > 0.0)
    }

    fn scales(&self) -> Vec<S> {
        let mut scales = self.plant.scales();
        scales.extend(self.sensor.scales(self.plant.measurement_scale()));
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
        let given = self.plant.measurement(own_state, own_inputs);
        self.sensor.rates(&state[own_state.len()..], given, sensor_rates);
    }

    #[inline(always)]
    fn measurement<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T {
        if self.delay_s > 0.0 { inputs[self.plant.inputs()] } else { self.shown::<S, T>(state, inputs) }
    }

    fn disturbance<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T {
        let (state, inputs) = self.of_plant::<S, T>(state, inputs);
        self.plant.disturbance(state, inputs)
    }

    fn delays(&self) -> Vec<S> {
        let own = (self.delay_s > 0.0).then(|| S::from(self.delay_s));
        self.plant.delays().into_iter().chain(own).collect()
    }

    fn outgoing<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        let (own_state, own_inputs) = self.of_plant::<S, T>(state, inputs);
        let of_plant = waves.len() - usize::from(self.delay_s > 0.0);
        let (plant_waves, own) = waves.split_at_mut(of_plant);
        self.plant.outgoing(own_state, own_inputs, plant_waves);
        if let Some(wave) = own.first_mut() {
            *wave = self.shown::<S, T>(state, inputs);
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
}
