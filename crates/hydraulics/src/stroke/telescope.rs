use phea_dynamics::scalar::Scalar;

use super::keys::{STAGE_TRANSITION_KEY, STROKE_KEY};
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Largest number of stages after the first.
pub const FURTHER_STAGES: usize = 3;

/// Stage of a telescopic piston after the first. Units: m, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PistonStage<S = f64> {
    /// Position x_k at which it begins to move.
    pub from: S,
    /// Ratios of its areas A_A and A_B to those of the first stage.
    pub ratios: [S; 2],
}

/// Piston whose stages follow each other along the stroke, each with its own areas.
///
/// ```text
/// r(x) = 1 + sum over k of (r_k - r_k-1) b(t_k)
/// t_k  = (x - x_k)/w + 1/2 between 0 and 1,     b(t) = t^2 (3 - 2 t)
/// A(x) = r(x) A_1,     l(x) = integral of r from 0 to x
/// V_A  = V_A0 + A_A1 l_A(x),     V_B = V_B0 + A_B1 (l_B(L) - l_B(x))
/// ```
///
/// r is the ratio of an area to that of the first stage, of either side. Over the transition w the
/// areas blend into each other, so that dV/dx = A everywhere and the areas have a slope. Units: m.
///
/// # Example
/// The volume that a piston sweeps over a stage of half the area is half as large:
/// ```
/// use phea_hydraulics::stroke::{PistonStage, Telescope};
/// let half = PistonStage { from: 0.2, ratios: [0.5, 1.0] };
/// let telescope = Telescope { stroke: 0.5, stages: [Some(half), None, None], transition: 1e-3 };
/// assert_eq!(telescope.ratios(0.1), [1.0, 1.0]);
/// assert_eq!(telescope.ratios(0.3), [0.5, 1.0]);
/// let [from_a, to_b] = telescope.travels(0.5_f64);
/// assert!((from_a - 0.35).abs() < 1e-15 && to_b == 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telescope<S = f64> {
    /// Stroke L of all stages together.
    pub stroke: S,
    /// Stages after the first, in order; those that exist come first.
    pub stages: [Option<PistonStage<S>>; FURTHER_STAGES],
    /// Width w of the transition from one stage to the next, x_k in its middle.
    pub transition: S,
}

phea_dynamics::parameters! { Telescope { stroke, stages, transition } }
phea_dynamics::parameters! { PistonStage { from, ratios } }

/// Blend of the transition to a stage, over its fraction t: b, db/dt and the integral of b.
struct Blend<S> {
    value: S,
    slope: S,
    integral: S,
}

impl<S: Scalar> Blend<S> {
    fn at(fraction: S) -> Blend<S> {
        let (zero, one) = (S::from(0.0), S::from(1.0));
        let within = fraction.maximum(zero).minimum(one);
        let square = within.squared();
        let two = S::from(2.0);
        Blend {
            value: square * (S::from(3.0) - two * within),
            slope: S::from(6.0) * within * (one - within),
            integral: square * within * (one - within / two) + (fraction - one).maximum(zero),
        }
    }
}

impl<S: Scalar> Telescope<S> {
    /// Sums over the stages of both sides, from a start: the value that `of` selects from the
    /// blend, times the change of the ratio there.
    #[inline(always)]
    fn summed(&self, x: S, start: S, of: impl Fn(Blend<S>) -> S) -> [S; 2] {
        let (mut sums, mut before) = ([start; 2], [S::from(1.0); 2]);
        for stage in self.stages.iter().flatten() {
            let blend = of(Blend::at((x - stage.from) / self.transition + S::from(0.5)));
            for side in [0, 1] {
                sums[side] = sums[side] + (stage.ratios[side] - before[side]) * blend;
                before[side] = stage.ratios[side];
            }
        }
        sums
    }

    /// Ratios r_A and r_B at a position in m.
    pub fn ratios(&self, x: S) -> [S; 2] {
        self.summed(x, S::from(1.0), |blend| blend.value)
    }

    /// Slopes of the ratios over the position, 1/m; zero away from the transitions.
    pub fn slopes(&self, x: S) -> [S; 2] {
        self.summed(x, S::from(0.0), |blend| blend.slope / self.transition)
    }

    /// Equivalent travels l_A(x) and l_B(L) - l_B(x), m: the travel of a piston with the first
    /// stage's areas that sweeps equal volumes.
    pub fn travels(&self, x: S) -> [S; 2] {
        let swept = |x: S| self.summed(x, x, |blend| blend.integral * self.transition);
        let ([from_a, from_b], [_, whole]) = (swept(x), swept(self.stroke));
        [from_a, whole - from_b]
    }
}

impl Telescope {
    /// Invalid parameters; empty if all are valid.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(STROKE_KEY, self.stroke);
        problems.key_as("transition", STAGE_TRANSITION_KEY, self.transition);
        let half = 0.5 * self.transition;
        let mut before = 0.0;
        for stage in self.stages.iter().flatten() {
            let (from, to) = (stage.from - half, stage.from + half);
            let requirement = ParameterRequirement::AfterTransition;
            problems.require("stage.from", stage.from, from >= before && to <= self.stroke, requirement);
            for ratio in stage.ratios {
                problems.positive("stage.piston_areas", ratio);
            }
            before = to;
        }
        problems.into_vec()
    }
}
