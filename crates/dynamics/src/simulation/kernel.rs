//! Interface of a system to its driver, over the one scalar of the simulation.

use pulp::{Simd, WithSimd};

use super::derivatives::DIRECTIONS;
use super::growth::Sliding;
use super::method::StepInputs;
use super::pattern::JacobianPattern;
use super::propagator::Propagator;
use super::rosenbrock::Rosenbrock;
use super::{Lane, System};
use crate::scalar::{Dependence, Dual};

/// Data of an attempted step.
#[derive(Clone, Copy)]
pub(super) struct StepTrial<'t, S> {
    /// State at the start.
    pub(super) state: &'t [S],
    /// Length, s.
    pub(super) step: S,
    /// Typical magnitudes of the states.
    pub(super) scales: &'t [S],
    /// Tolerance of the error.
    pub(super) tolerance: f64,
}

/// A [`System`] with the parts of the methods that evaluate its equations, compiled for the vector
/// instructions of the processor. All other code of a driver uses a system through this trait only,
/// and is compiled once for all systems.
pub(super) trait Kernel<S: Lane> {
    /// Number as in [`System::states`].
    fn states(&self) -> usize;
    /// Number as in [`System::inputs`].
    fn inputs(&self) -> usize;
    /// Magnitudes as in [`System::scales`].
    fn scales(&self) -> Vec<S>;
    /// Travel times as in [`System::delays`].
    fn delays(&self) -> Vec<S>;
    /// Friction as in [`System::sliding`].
    fn sliding(&self) -> Option<Sliding>;
    /// Number as in [`System::indicators`].
    fn indicators(&self) -> usize;
    /// Rates as in [`System::rates`].
    fn rates(&self, state: &[S], inputs: &[S], rates: &mut [S]);
    /// Waves as in [`System::outgoing`].
    fn outgoing(&self, state: &[S], inputs: &[S], waves: &mut [S]);
    /// Indicators as in [`System::indicate`].
    fn indicate(&self, state: &[S], inputs: &[S], indicators: &mut [S]);
    /// Number as in [`System::kinks`].
    fn kinks(&self) -> usize;
    /// Marks as in [`System::mark`].
    fn mark(&self, state: &[S], inputs: &[S], marks: &mut [S]);
    /// Calls [`JacobianPattern::of`].
    fn pattern(&self) -> Option<JacobianPattern>;
    /// Calls [`Rosenbrock::linearize`].
    fn linearize(&self, method: &mut Rosenbrock<S>, state: &[S], inputs: &StepInputs<S>);
    /// Calls [`Rosenbrock::attempt`].
    fn attempt(&self, method: &mut Rosenbrock<S>, trial: StepTrial<'_, S>, inputs: &StepInputs<S>) -> S;
    /// Calls [`Rosenbrock::error_between`].
    fn error_between(&self, method: &mut Rosenbrock<S>, trial: StepTrial<'_, S>, at: (S, &[S])) -> S;
    /// Calls [`Rosenbrock::carry`].
    fn carry(&self, method: &mut Rosenbrock<S>, step: S, error: &mut [S]);
    /// Calls [`Propagator::step`].
    fn propagate(&self, propagator: &mut Propagator<S>, trial: StepTrial<'_, S>, inputs: &[S]) -> S;
}

impl<S: Lane, E: System<S>> Kernel<S> for E
where
    Dependence: From<S>,
    Dual<DIRECTIONS, S>: From<f64> + From<S>,
{
    fn states(&self) -> usize {
        System::states(self)
    }

    fn inputs(&self) -> usize {
        System::inputs(self)
    }

    fn scales(&self) -> Vec<S> {
        System::scales(self)
    }

    fn delays(&self) -> Vec<S> {
        System::delays(self)
    }

    fn sliding(&self) -> Option<Sliding> {
        System::sliding(self)
    }

    fn indicators(&self) -> usize {
        System::indicators(self)
    }

    fn rates(&self, state: &[S], inputs: &[S], rates: &mut [S]) {
        System::rates(self, state, inputs, rates);
    }

    fn outgoing(&self, state: &[S], inputs: &[S], waves: &mut [S]) {
        System::outgoing(self, state, inputs, waves);
    }

    fn indicate(&self, state: &[S], inputs: &[S], indicators: &mut [S]) {
        System::indicate(self, state, inputs, indicators);
    }

    fn kinks(&self) -> usize {
        System::kinks(self)
    }

    fn mark(&self, state: &[S], inputs: &[S], marks: &mut [S]) {
        System::mark(self, state, inputs, marks);
    }

    fn pattern(&self) -> Option<JacobianPattern> {
        JacobianPattern::of(self)
    }

    fn linearize(&self, method: &mut Rosenbrock<S>, state: &[S], inputs: &StepInputs<S>) {
        S::vectorized(VectorizedLinearization { method, system: self, state, inputs });
    }

    fn attempt(&self, method: &mut Rosenbrock<S>, trial: StepTrial<'_, S>, inputs: &StepInputs<S>) -> S {
        S::vectorized(VectorizedAttempt { method, system: self, trial, inputs }).unwrap_or(S::from(f64::NAN))
    }

    fn error_between(&self, method: &mut Rosenbrock<S>, trial: StepTrial<'_, S>, at: (S, &[S])) -> S {
        S::vectorized(VectorizedErrorBetween { method, system: self, trial, at }).unwrap_or(S::from(f64::NAN))
    }

    fn carry(&self, method: &mut Rosenbrock<S>, step: S, error: &mut [S]) {
        S::vectorized(Carrying { method, step, error });
    }

    fn propagate(&self, propagator: &mut Propagator<S>, trial: StepTrial<'_, S>, inputs: &[S]) -> S {
        S::vectorized(Propagation { propagator, system: self, trial, inputs }).unwrap_or(S::from(f64::NAN))
    }
}

/// [`Rosenbrock::linearize`] with the available vector instructions. A closure cannot replace it: a
/// closure is compiled as a separate function, without them.
struct VectorizedLinearization<'m, S, E> {
    method: &'m mut Rosenbrock<S>,
    system: &'m E,
    state: &'m [S],
    inputs: &'m StepInputs<S>,
}

impl<S: Lane, E: System<S>> WithSimd for VectorizedLinearization<'_, S, E>
where
    Dependence: From<S>,
    Dual<DIRECTIONS, S>: From<f64> + From<S>,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) {
        self.method.linearize(self.system, self.state, self.inputs);
    }
}

/// [`Rosenbrock::attempt`] with the vector instructions of the processor.
struct VectorizedAttempt<'m, S, E> {
    method: &'m mut Rosenbrock<S>,
    system: &'m E,
    trial: StepTrial<'m, S>,
    inputs: &'m StepInputs<S>,
}

impl<S: Lane, E: System<S>> WithSimd for VectorizedAttempt<'_, S, E> {
    type Output = S;

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> S {
        self.method.attempt(self.system, self.trial, self.inputs)
    }
}

/// [`Rosenbrock::error_between`] with the vector instructions of the processor.
struct VectorizedErrorBetween<'m, S, E> {
    method: &'m mut Rosenbrock<S>,
    system: &'m E,
    trial: StepTrial<'m, S>,
    at: (S, &'m [S]),
}

impl<S: Lane, E: System<S>> WithSimd for VectorizedErrorBetween<'_, S, E> {
    type Output = S;

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> S {
        self.method.error_between(self.system, self.trial, self.at)
    }
}

/// [`Rosenbrock::carry`] with the vector instructions of the processor.
struct Carrying<'m, S> {
    method: &'m mut Rosenbrock<S>,
    step: S,
    error: &'m mut [S],
}

impl<S: Lane> WithSimd for Carrying<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) {
        self.method.carry(self.step, self.error);
    }
}

/// [`Propagator::step`] with the vector instructions of the processor.
struct Propagation<'p, S, E> {
    propagator: &'p mut Propagator<S>,
    system: &'p E,
    trial: StepTrial<'p, S>,
    inputs: &'p [S],
}

impl<S: Lane, E: System<S>> WithSimd for Propagation<'_, S, E> {
    type Output = S;

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> S {
        self.propagator.step(self.system, self.trial, self.inputs)
    }
}
