//! Derivatives of the displacement: those of one step by dual numbers, carried along from step to
//! step by the chain rule.

use phea_dynamics::scalar::{Dual, Parameters};

use super::stick_step::StickStep;
use super::{PressedMass, SensitiveDisplacement};
use crate::friction::LuGre;
use crate::friction::tested::FRICTION_COEFFICIENTS;

/// A force at each step that is linear in some variables.
pub(super) struct LinearForce {
    /// N.
    pub(super) force: Vec<f64>,
    /// Derivatives over the variables, step by step.
    pub(super) slopes: Vec<f64>,
    /// How many they are.
    pub(super) variables: usize,
}

/// What a step depends on: the coefficients of the friction, velocity and deflection before it, the
/// force, and by how much it rises.
const OF_STEP: usize = FRICTION_COEFFICIENTS + 4;
pub(super) const STATE: usize = FRICTION_COEFFICIENTS;
const FORCE: usize = FRICTION_COEFFICIENTS + 2;

type StepSlope = Dual<OF_STEP>;

/// Derivatives of velocity, deflection, and the way that the bristles have slipped.
pub(super) struct CarriedSlopes(pub(super) [Vec<f64>; 3]);

impl CarriedSlopes {
    /// Those after a step, from those before it.
    ///
    /// ```text
    /// dy' = (dy'/dc) dc + (dy'/dy) dy + (dy'/dF) dF + (dy'/dr) dr          r: rise of the force
    /// ```
    ///
    /// `forced` has dF and dr, of the variables from the one with index `first` on.
    fn carry(&mut self, after: [StepSlope; 3], forced: impl Iterator<Item = [f64; 2]>, first: usize) {
        let [velocities, deflections, slipped] = &mut self.0;
        let [of_velocity, of_deflection, of_slip] = after.map(|one| *one.gradient());
        let all = velocities.iter_mut().zip(deflections.iter_mut()).zip(slipped.iter_mut());
        for ((velocity, deflection), slipped) in all {
            let [v, z] = [*velocity, *deflection];
            *velocity = of_velocity[STATE] * v + of_velocity[STATE + 1] * z;
            *deflection = of_deflection[STATE] * v + of_deflection[STATE + 1] * z;
            *slipped += of_slip[STATE] * v + of_slip[STATE + 1] * z;
        }
        let parts = [(velocities, of_velocity), (deflections, of_deflection), (slipped, of_slip)];
        let forced: Vec<[f64; 2]> = forced.collect();
        for (slopes, of) in parts {
            for (slope, own) in slopes.iter_mut().zip(&of[..FRICTION_COEFFICIENTS]) {
                *slope += own;
            }
            for (slope, [force, rise]) in slopes.iter_mut().skip(first).zip(&forced) {
                *slope += of[FORCE] * force + of[FORCE + 1] * rise;
            }
        }
    }
}

impl PressedMass {
    /// Displacements of every so many rows, with their derivatives, from a state with its own on.
    pub(super) fn carried(
        &self,
        lugre: &LuGre,
        (start, mut slopes): ([f64; 2], CarriedSlopes),
        along: &LinearForce,
        every: usize,
    ) -> SensitiveDisplacement {
        let substeps = self.substeps.max(1) as f64;
        let mut index = 0;
        let open: LuGre<StepSlope> = lugre.convert(&mut |value| {
            index += 1;
            StepSlope::variable(value, index - 1)
        });
        let stick = StickStep::over(&open, self, self.doublings(lugre));
        let first = slopes.0[0].len() - along.variables;
        let began = slopes.0[1].clone();
        let mut found = SensitiveDisplacement::default();
        let (mut state, mut slipped) = (start, 0.0);
        let forces = along.force.iter().zip(along.force.iter().skip(1));
        let rows: Vec<&[f64]> = along.slopes.chunks_exact(along.variables.max(1)).collect();
        let steps = forces.zip(rows.iter().zip(rows.iter().skip(1)));
        let mut keep = |slopes: &CarriedSlopes, moved: f64| {
            let [_, deflections, slipped] = &slopes.0;
            let both = deflections.iter().zip(slipped).zip(&began);
            found.displacements.push(moved);
            found.gradients.extend(both.map(|((deflection, slipped), began)| deflection - began + slipped));
        };
        if !along.force.is_empty() {
            keep(&slopes, 0.0);
        }
        for (row, ((from, to), (slopes_from, slopes_to))) in steps.enumerate() {
            for (substep, (force, rise)) in self.within(*from, *to).enumerate() {
                let variable = |value: f64, index: usize| StepSlope::variable(value, index);
                let before = [variable(state[0], STATE), variable(state[1], STATE + 1)];
                let forced = [variable(force, FORCE), variable(rise, FORCE + 1)];
                let (after, slid) = stick.with_slip(&open, before, forced);
                let passed = substep as f64 / substeps;
                let of_force = slopes_from.iter().zip(*slopes_to);
                let of_force =
                    of_force.map(|(from, to)| [from + (to - from) * passed, (to - from) / substeps]);
                slopes.carry([after[0], after[1], slid], of_force, first);
                state = after.map(|one| one.value());
                slipped += slid.value();
            }
            if (row + 1) % every == 0 {
                keep(&slopes, state[1] - start[1] + slipped);
            }
        }
        found
    }
}
