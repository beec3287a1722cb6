//! Common interface of the integration methods.

use super::Lane;
use super::explicit::{self, DormandPrince};
use super::growth::AmplitudeLost;
use super::kernel::{Kernel, StepTrial};
use super::passage::Passage;
use super::rosenbrock::{self, Rosenbrock};

/// Fraction of the step at which the dense-output residual is checked. Late, because a step
/// shortened for a kink ends just after it.
pub(super) const RESIDUAL_AT: f64 = 0.75;

/// Integration method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// L-stable, linearly implicit, of order 5: for stiff systems. Rodas5P, Steinebach (2023).
    #[default]
    Rosenbrock,
    /// Explicit, of order 5: an independent check if no mode is much faster than the motion of
    /// interest. Dormand and Prince (1980).
    DormandPrince,
}

/// Inputs of one step: at the time of every stage, and their slopes in time at the start.
#[derive(Clone, Debug)]
pub(super) struct StepInputs<S> {
    /// Inputs at the times of [`Stepper::stage_times`].
    pub(super) stages: [Vec<S>; 6],
    /// Slopes per second, at the start.
    pub(super) slopes: Vec<S>,
    /// True if any slope differs from zero.
    pub(super) moving: bool,
}

/// Method with its memory.
#[derive(Clone, Debug)]
enum MethodSteps<S> {
    Implicit(Box<Rosenbrock<S>>),
    /// Explicit method. The Rosenbrock stepper supplies the Jacobian, needed for mode estimates
    /// only.
    Explicit(DormandPrince<S>, Box<Rosenbrock<S>>),
}

/// Method of all lanes, and its scales of errors.
#[derive(Clone, Debug)]
pub(super) struct Stepper<S> {
    steps: MethodSteps<S>,
    /// Typical magnitudes of the states; those of a lane change with its machine.
    pub(super) scales: Vec<S>,
}

impl<S: Lane> Stepper<S> {
    /// Stepper of this method for this system; `None` if the system is too large to find its
    /// pattern.
    pub(super) fn new(method: Method, system: &dyn Kernel<S>) -> Option<Self> {
        let implicit = Box::new(Rosenbrock::new(system)?);
        let steps = match method {
            Method::Rosenbrock => MethodSteps::Implicit(implicit),
            Method::DormandPrince => MethodSteps::Explicit(DormandPrince::new(system.states()), implicit),
        };
        Some(Stepper { steps, scales: system.scales() })
    }

    /// Fractions of the step at which the inputs of each stage are taken.
    pub(super) fn stage_times(&self) -> [f64; 6] {
        match self.steps {
            MethodSteps::Implicit(_) => rosenbrock::STAGE_TIMES,
            MethodSteps::Explicit(..) => explicit::STAGE_TIMES,
        }
    }

    /// Evaluations of the rates in one attempt.
    pub(super) fn evaluations(&self) -> u64 {
        match self.steps {
            MethodSteps::Implicit(_) => 7,
            MethodSteps::Explicit(..) => 6,
        }
    }

    /// Evaluates the start of a step: rates, and the derivatives that the method needs.
    pub(super) fn linearize(&mut self, system: &dyn Kernel<S>, state: &[S], inputs: &StepInputs<S>) {
        let method = match &mut self.steps {
            MethodSteps::Implicit(method) => method,
            MethodSteps::Explicit(method, jacobian) => {
                method.begin(system, state, inputs);
                jacobian
            }
        };
        system.linearize(method, state, inputs);
    }

    /// Attempts a step of length h from the point at which [`Stepper::linearize`] was called;
    /// returns the error of each lane in units of the tolerance. If the error is above one or NaN,
    /// the step must be repeated with a shorter length.
    pub(super) fn attempt(
        &mut self,
        system: &dyn Kernel<S>,
        state: &[S],
        step: S,
        inputs: &StepInputs<S>,
        tolerance: f64,
    ) -> S {
        let trial = StepTrial { state, step, scales: &self.scales, tolerance };
        match &mut self.steps {
            MethodSteps::Implicit(method) => system.attempt(method, trial, inputs),
            MethodSteps::Explicit(method, _) => method.attempt(system, trial, inputs),
        }
    }

    /// True if a step may be less accurate than the error at its end shows. Never for the explicit
    /// method, whose steps are too short for that.
    ///
    /// Inside a step this occurs for states that are stiffly coupled. In addition, a step that was
    /// shortened until its error passed may end where the error estimate is blind: if a rate has a
    /// kink, as friction has at standstill, the estimate is blind for some positions of the kink
    /// within the step, and successively shortened steps find these positions.
    pub(super) fn doubts(&self, lane: usize, passage: &Passage<'_>) -> bool {
        let Some(method) = self.linearized() else { return false };
        passage.rejected || (passage.looked_into() && method.binds_stiffly(lane, passage.step_s))
    }

    /// Error of the solution at a fraction of the step just attempted, for the inputs there, in
    /// units of the tolerance.
    pub(super) fn error_between(
        &mut self,
        system: &dyn Kernel<S>,
        state: &[S],
        step: S,
        at: (S, &[S]),
        tolerance: f64,
    ) -> S {
        let trial = StepTrial { state, step, scales: &self.scales, tolerance };
        match &mut self.steps {
            MethodSteps::Implicit(method) => system.error_between(method, trial, at),
            MethodSteps::Explicit(..) => S::from(0.0),
        }
    }

    /// Propagates a small error over the step just attempted, if the method has the matrix for it;
    /// returns true if it has.
    pub(super) fn carry(&mut self, system: &dyn Kernel<S>, step: S, error: &mut [S]) -> bool {
        match &mut self.steps {
            MethodSteps::Implicit(method) => {
                system.carry(method, step, error);
                true
            }
            MethodSteps::Explicit(..) => false,
        }
    }

    /// Implicit method with its last Jacobian.
    pub(super) fn linearized(&self) -> Option<&Rosenbrock<S>> {
        match &self.steps {
            MethodSteps::Implicit(method) => Some(method),
            MethodSteps::Explicit(..) => None,
        }
    }

    /// Last Jacobian.
    pub(super) fn jacobian(&self) -> &Rosenbrock<S> {
        match &self.steps {
            MethodSteps::Implicit(method) | MethodSteps::Explicit(_, method) => method,
        }
    }

    /// Relative loss of amplitude in a step, for a mode that neither grows nor decays.
    pub(super) fn amplitude_lost(&self) -> AmplitudeLost {
        match self.steps {
            MethodSteps::Implicit(_) => rosenbrock::AMPLITUDE_LOST,
            MethodSteps::Explicit(..) => explicit::AMPLITUDE_LOST,
        }
    }

    /// One state over the last step.
    pub(super) fn extension(&self, index: usize, start: S) -> Extension<S> {
        match &self.steps {
            MethodSteps::Implicit(method) => method.extension(index, start),
            MethodSteps::Explicit(method, _) => method.extension(index, start),
        }
    }

    /// State at the end of the last step.
    pub(super) fn end(&self) -> &[S] {
        match &self.steps {
            MethodSteps::Implicit(method) => &method.end,
            MethodSteps::Explicit(method, _) => &method.end,
        }
    }

    /// Root mean square of rates over (scale + |y|) in one lane, per second.
    pub(super) fn magnitude(&self, rates: &[S], state: &[S], lane: usize) -> f64 {
        let parts = rates.iter().zip(state).zip(&self.scales).map(|((rate, state), scale)| {
            let part = rate.lane(lane) / (scale.lane(lane) + state.lane(lane).abs());
            part * part
        });
        (parts.sum::<f64>() / rates.len().max(1) as f64).sqrt()
    }
}

/// Root mean square of the errors over tolerance (scale + |y|).
#[inline(always)]
pub(super) fn relative_error<S: Lane>(
    errors: &[S],
    state: &[S],
    end: &[S],
    scales: &[S],
    tolerance: f64,
) -> S {
    let mut sum = S::from(0.0);
    for (((&error, &start), &end), &scale) in errors.iter().zip(state).zip(end).zip(scales) {
        let magnitude = start.abs().maximum(end.abs());
        sum = sum + (error / (scale + magnitude)).squared();
    }
    (sum * S::from(1.0 / scales.len().max(1) as f64)).sqrt() * S::from(1.0 / tolerance)
}

/// State over one step:
///
/// ```text
/// y(theta) = (1 - theta) y_0 + theta (y_1 + (1 - theta) (k_1 + theta (k_2 + theta k_3)))
/// ```
#[derive(Clone, Copy, Debug)]
pub(super) struct Extension<S> {
    pub(super) start: S,
    pub(super) end: S,
    pub(super) coefficients: [S; 3],
}

impl<S: Lane> Extension<S> {
    /// Cubic with these end values and slopes, both slopes times the step.
    pub(super) fn cubic([start, end]: [S; 2], [first, last]: [S; 2]) -> Extension<S> {
        let rise = end - start;
        let coefficients = [first - rise, rise.times(2.0) - first - last, S::from(0.0)];
        Extension { start, end, coefficients }
    }

    /// Slope at this fraction of the step, times the step.
    pub(super) fn slope(&self, part: S) -> S {
        let [first, second, third] = self.coefficients;
        let left = |of: f64, times: f64| S::from(of) - part.times(times);
        let rise = self.end - self.start + first * left(1.0, 2.0);
        rise + (second * left(2.0, 3.0) + third * part * left(3.0, 4.0)) * part
    }

    /// Extension in one lane.
    pub(super) fn lane(&self, index: usize) -> Extension<f64> {
        let coefficients = self.coefficients.map(|coefficient| coefficient.lane(index));
        Extension { start: self.start.lane(index), end: self.end.lane(index), coefficients }
    }

    /// Value at this fraction of the step, from 0 to 1.
    #[inline]
    pub(super) fn at(&self, part: S) -> S {
        let left = S::from(1.0) - part;
        let [first, second, third] = self.coefficients;
        left * self.start + part * (self.end + left * (first + part * (second + part * third)))
    }
}
