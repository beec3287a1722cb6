//! A system as its driver sees it, over the one scalar that is driven.

use pulp::{Simd, WithSimd};

use super::derivatives::DIRECTIONS;
use super::growth::Sliding;
use super::method::StepInputs;
use super::pattern::JacobianPattern;
use super::propagator::Propagator;
use super::rosenbrock::Rosenbrock;
use super::{Lane, System};
use crate::scalar::{Dependence, Dual};

/// What a step is tried with.
#[derive(Clone, Copy)]
pub(super) struct StepTrial<'t, S> {
    /// State at its start.
    pub(super) state: &'t [S],
    /// Its length, s.
    pub(super) step: S,
    /// Typical magnitudes of the states.
    pub(super) scales: &'t [S],
    /// What the error is measured by.
    pub(super) tolerance: f64,
}

/// A [`System`] with the parts of the methods that evaluate its equations, compiled for the vector
/// instructions of the processor. All else of a driver knows a system by this trait alone, and is
/// compiled once for all systems.
pub(super) trait Kernel<S: Lane> {
    /// As [`System::states`].
    fn states(&self) -> usize;
    /// As [`System::inputs`].
    fn inputs(&self) -> usize;
    /// As [`System::scales`].
    fn scales(&self) -> Vec<S>;
    /// As [`System::delays`].
    fn delays(&self) -> Vec<S>;
    /// As [`System::sliding`].
    fn sliding(&self) -> Option<Sliding>;
    /// As [`System::indicators`].
    fn indicators(&self) -> usize;
    /// As [`System::rates`].
    fn rates(&self, state: &[S], inputs: &[S], rates: &mut [S]);
    /// As [`System::outgoing`].
    fn outgoing(&self, state: &[S], inputs: &[S], waves: &mut [S]);
    /// As [`System::indicate`].
    fn indicate(&self, state: &[S], inputs: &[S], indicators: &mut [S]);
    /// As [`System::kinks`].
    fn kinks(&self) -> usize;
    /// As [`System::mark`].
    fn mark(&self, state: &[S], inputs: &[S], marks: &mut [S]);
    /// As [`JacobianPattern::of`].
    fn pattern(&self) -> Option<JacobianPattern>;
    /// As [`Rosenbrock::linearize`].
    fn linearize(&self, method: &mut Rosenbrock<S>, state: &[S], inputs: &StepInputs<S>);
    /// As [`Rosenbrock::attempt`].
    fn attempt(&self, method: &mut Rosenbrock<S>, trial: StepTrial<'_, S>, inputs: &StepInputs<S>) -> S;
    /// As [`Rosenbrock::error_between`].
    fn error_between(&self, method: &mut Rosenbrock<S>, trial: StepTrial<'_, S>, at: (S, &[S])) -> S;
    /// As [`Rosenbrock::carry`].
    fn carry(&self, method: &mut Rosenbrock<S>, step: S, error: &mut [S]);
    /// As [`Propagator::step`].
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

/// [`Rosenbrock::linearize`] with the vector instructions that there are. A closure would not do:
/// the call of a closure is a function of its own, and compiled without them.
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

/// [`Rosenbrock::attempt`] with the vector instructions that there are.
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

/// [`Rosenbrock::error_between`] with the vector instructions that there are.
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

/// [`Rosenbrock::carry`] with the vector instructions that there are.
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

/// [`Propagator::step`] with the vector instructions that there are.
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
