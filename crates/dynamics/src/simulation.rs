//! Nonlinear systems in time: equations written once over [`Scalar`], an L-stable method with error
//! control, known functions of time as inputs, delays, samples and events.
//!
//! Time enters a system only through its inputs. The solver knows each input and its slope at any
//! time, and the times at which they break, so that no step ever crosses a break and every restart
//! is exact.

mod carried;
mod commanded_plant;
mod derivatives;
mod driver;
mod equilibrium;
mod explicit;
mod frozen;
mod growth;
mod history;
mod interface;
mod kernel;
mod method;
mod passage;
mod pattern;
mod profile;
mod propagator;
mod quantities;
mod quartic;
mod realization;
mod rosenbrock;
mod sensed;
mod sine_response;
mod slot;
mod small_signal;
mod square;
mod step_matrix;
mod stretch;
mod task;
mod trajectory;
mod vector;

pub use commanded_plant::{CommandedPlant, LoopSignals};
pub use derivatives::DIRECTIONS;
pub use driver::drive;
pub use equilibrium::{EquilibriumError, equilibrium};
pub use frozen::{Frozen, FrozenMode, FrozenWatch, SampledLaw};
pub use growth::Sliding;
pub use history::WaveHistory;
pub use interface::{
    Amplification, Attention, Event, GrowthCause, Input, InputSchedule, Observer, Outcome, Sampler,
    SimulationError, SimulationSettings, Status, StepCounts, UnfollowedCause, UnfollowedKinks,
};
pub use method::Method;
pub use profile::{Harmonic, Moment, Profile, ProfileError, ProfileNumber, ProfilePiece, schroeder_phases};
pub use quantities::{SimulationCount, SimulationNumber};
pub use quartic::{Quartic, gauss_points};
pub use sensed::Sensed;
pub use sine_response::{SinePlan, SineResponse, sine_response};
pub use small_signal::small_signal;
pub use stretch::Stretch;
pub use task::{Queue, Task};
pub use trajectory::{Simulated, Trajectory, drive_one, simulate};
pub use vector::{Vectorized, can_drive};

use crate::scalar::{LANES, Lanes, Scalar};

/// System of ordinary differential equations.
///
/// ```text
/// dy/dt = f(y, w)            y states, w inputs; both in SI units
/// ```
///
/// Parameters are of type `S`: one number, or lanes of them. The equations are evaluated over any
/// `T` that such parameters can enter as constants: `S` itself, its dual numbers, and
/// [`crate::scalar::Dependence`].
pub trait System<S: Scalar> {
    /// Number of states.
    fn states(&self) -> usize;

    /// Number of inputs, delayed waves included.
    fn inputs(&self) -> usize;

    /// Typical magnitude of each state, in its unit: if the state is smaller, its error is relative
    /// to this magnitude.
    fn scales(&self) -> Vec<S>;

    /// Rates of all states, per second.
    fn rates<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T], rates: &mut [T]);

    /// Travel times of the delayed waves, s. The last inputs are these waves on arrival, in this
    /// order.
    ///
    /// A wave that leaves at a break of the input schedule arrives as a break, at which a step
    /// ends, through up to twelve delays. A jump that has passed more delays is smeared over the
    /// step in which it arrives.
    fn delays(&self) -> Vec<S> {
        Vec::new()
    }

    /// Waves sent into the delays.
    fn outgoing<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T], _waves: &mut [T]) {}

    /// Number of indicators.
    fn indicators(&self) -> usize {
        0
    }

    /// States on which friction acts. Its falling slope may feed an oscillation from one step to
    /// the next; all other parts of the Jacobian are assumed to change slowly, over tens of steps.
    /// With `None`, nothing is assumed, and the modes are computed at every step.
    fn sliding(&self) -> Option<Sliding> {
        None
    }

    /// Quantities whose change of sign is an event (contact, cavitation): reported with its time,
    /// never acted on.
    ///
    /// They are compared at the ends of each step: one that changes its sign twice within a step is
    /// not seen.
    fn indicate<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T], _indicators: &mut [T]) {}

    /// Number of kinks.
    fn kinks(&self) -> usize {
        0
    }

    /// Quantities that change their sign where a derivative of the rates jumps: when a motion with
    /// friction reverses, or a stop is touched. The error of a step that crosses such a point is
    /// checked there, and a step that fails this check ends there. A kink that is not listed costs
    /// accuracy: the error estimate of a step may not see it.
    fn mark<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T], _marks: &mut [T]) {}
}

/// Plant that a controller commands.
///
/// ```text
/// dy/dt = f(y, u, w),        F = h(y, w)          u the command, w other inputs, F the measurement of the controller
/// ```
///
/// Unlike a [`System`] with one more input, its measurement, waves and indicators do not depend on
/// the command, which a controller computes from the measurement.
pub trait Plant<S: Scalar> {
    /// Number of states.
    fn states(&self) -> usize;

    /// Number of inputs other than the command, delayed waves included.
    fn inputs(&self) -> usize;

    /// Typical magnitude of each state, in its unit.
    fn scales(&self) -> Vec<S>;

    /// Typical magnitude of the command, in its unit.
    fn command_scale(&self) -> S;

    /// Typical magnitude of the measurement, in its unit.
    fn measurement_scale(&self) -> S;

    /// Rates of all states, per second.
    fn rates<T: Scalar + From<S>>(&self, state: &[T], command: T, inputs: &[T], rates: &mut [T]);

    /// Measurement for the controller.
    fn measurement<T: Scalar + From<S>>(&self, state: &[T], inputs: &[T]) -> T;

    /// Disturbance that a feed-forward would compensate: the velocity of a load, in m/s.
    fn disturbance<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T]) -> T {
        T::from(0.0)
    }

    /// Typical magnitude of [`Plant::disturbance`], in its unit.
    fn disturbance_scale(&self) -> S {
        S::from(1.0)
    }

    /// Second signal that a controller feeds back: the pressure of a load, in Pa.
    fn inner_measurement<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T]) -> T {
        T::from(0.0)
    }

    /// Typical magnitude of [`Plant::inner_measurement`], in its unit.
    fn inner_measurement_scale(&self) -> S {
        S::from(1.0)
    }

    /// Position of a load, in m, on which a virtual impedance acts.
    fn position<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T]) -> T {
        T::from(0.0)
    }

    /// Typical magnitude of [`Plant::position`], in its unit.
    fn position_scale(&self) -> S {
        S::from(1.0)
    }

    /// Travel times as in [`System::delays`].
    fn delays(&self) -> Vec<S> {
        Vec::new()
    }

    /// Waves as in [`System::outgoing`].
    fn outgoing<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T], _waves: &mut [T]) {}

    /// Friction as in [`System::sliding`].
    fn sliding(&self) -> Option<Sliding> {
        None
    }

    /// Number as in [`System::indicators`].
    fn indicators(&self) -> usize {
        0
    }

    /// Indicators as in [`System::indicate`].
    fn indicate<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T], _indicators: &mut [T]) {}

    /// Number as in [`System::kinks`].
    fn kinks(&self) -> usize {
        0
    }

    /// Quantities as in [`System::mark`].
    fn mark<T: Scalar + From<S>>(&self, _state: &[T], _inputs: &[T], _marks: &mut [T]) {}
}

/// Scalar of one number or several parallel numbers.
///
/// # Example
/// ```
/// use phea_dynamics::scalar::Lanes;
/// use phea_dynamics::simulation::Lane;
/// assert_eq!(2.5_f64.lane(0), 2.5);
/// let mut lanes = Lanes([1.0, 2.0, 3.0, 4.0]);
/// lanes.set_lane(1, 5.0);
/// assert_eq!(lanes, Lanes([1.0, 5.0, 3.0, 4.0]));
/// ```
pub trait Lane: Scalar + Vectorized {
    /// Number of lanes.
    const COUNT: usize;

    /// Number in one lane. An index beyond the last lane means the last lane.
    fn lane(&self, index: usize) -> f64;

    /// Sets the number in one lane. An index beyond the last lane means the last lane.
    fn set_lane(&mut self, index: usize, value: f64);
}

impl Lane for f64 {
    const COUNT: usize = 1;

    #[inline]
    fn lane(&self, _index: usize) -> f64 {
        *self
    }
    #[inline]
    fn set_lane(&mut self, _index: usize, value: f64) {
        *self = value;
    }
}

impl Lane for Lanes {
    const COUNT: usize = LANES;

    #[inline]
    fn lane(&self, index: usize) -> f64 {
        self.0[index.min(LANES - 1)]
    }
    #[inline]
    fn set_lane(&mut self, index: usize, value: f64) {
        self.0[index.min(LANES - 1)] = value;
    }
}
