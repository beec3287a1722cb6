//! Derivatives of the displacement: those of one step by dual numbers, propagated from step to step
//! by the chain rule.

use phea_dynamics::scalar::Dual;

use super::stick_step::StickStep;
use super::{PressedMass, SensitiveDisplacement};
use crate::friction::LuGre;
use crate::friction::tested::FRICTION_COEFFICIENTS;

/// Force at each step that is linear in some variables.
#[derive(Clone, Copy)]
pub(super) struct LinearForce<'a> {
    /// Force, N.
    pub(super) force: &'a [f64],
    /// Derivatives over the variables, step by step.
    pub(super) slopes: &'a [f64],
    /// Number of variables.
    pub(super) variables: usize,
}

/// Number of variables of a step: the coefficients of the friction, velocity and deflection before
/// it, the force, and its rise.
const OF_STEP: usize = FRICTION_COEFFICIENTS + 4;
pub(super) const STATE: usize = FRICTION_COEFFICIENTS;
const FORCE: usize = FRICTION_COEFFICIENTS + 2;

type StepSlope = Dual<OF_STEP>;

/// Derivatives of the velocity, the deflection, and the slip distance of the bristles.
pub(super) struct CarriedSlopes {
    pub(super) velocity: Vec<f64>,
    pub(super) deflection: Vec<f64>,
    pub(super) slipped: Vec<f64>,
}

impl CarriedSlopes {
    /// Derivatives over this number of variables, all zero.
    pub(super) fn zero(count: usize) -> CarriedSlopes {
        let [velocity, deflection, slipped] = [(); 3].map(|()| vec![0.0; count]);
        CarriedSlopes { velocity, deflection, slipped }
    }

    /// Propagates the derivatives over one step.
    ///
    /// ```text
    /// dy' = (dy'/dc) dc + (dy'/dy) dy + (dy'/dF) dF + (dy'/dr) dr          r: rise of the force
    /// ```
    ///
    /// Argument `forced` has dF and dr, for the variables from the one with index `first` on.
    fn carry(&mut self, after: [StepSlope; 3], forced: impl Iterator<Item = [f64; 2]>, first: usize) {
        let CarriedSlopes { velocity, deflection, slipped } = self;
        let [of_velocity, of_deflection, of_slip] = after.map(|one| *one.gradient());
        for ((v, z), slid) in velocity.iter_mut().zip(deflection.iter_mut()).zip(slipped.iter_mut()) {
            *slid += of_slip[STATE] * *v + of_slip[STATE + 1] * *z;
            (*v, *z) = (
                of_velocity[STATE] * *v + of_velocity[STATE + 1] * *z,
                of_deflection[STATE] * *v + of_deflection[STATE + 1] * *z,
            );
        }
        for (slopes, of) in
            [(&mut *velocity, of_velocity), (&mut *deflection, of_deflection), (&mut *slipped, of_slip)]
        {
            for (slope, own) in slopes.iter_mut().zip(&of[..FRICTION_COEFFICIENTS]) {
                *slope += own;
            }
        }
        let rest = [velocity, deflection, slipped].map(|slopes| slopes.get_mut(first..).unwrap_or_default());
        let [velocity, deflection, slipped] = rest.map(|slopes| slopes.iter_mut());
        for (((v, z), slid), [force, rise]) in velocity.zip(deflection).zip(slipped).zip(forced) {
            *v += of_velocity[FORCE] * force + of_velocity[FORCE + 1] * rise;
            *z += of_deflection[FORCE] * force + of_deflection[FORCE + 1] * rise;
            *slid += of_slip[FORCE] * force + of_slip[FORCE + 1] * rise;
        }
    }
}

impl PressedMass {
    /// Displacements at every `every`-th row, with their derivatives, from a state with its
    /// derivatives.
    pub(super) fn carried(
        &self,
        lugre: &LuGre,
        (start, mut slopes): ([f64; 2], CarriedSlopes),
        along: LinearForce<'_>,
        every: usize,
    ) -> SensitiveDisplacement {
        let substeps = self.substeps.max(1) as f64;
        let coefficients = lugre.to_array();
        let open =
            LuGre::from_array(std::array::from_fn(|index| StepSlope::variable(coefficients[index], index)));
        let stick = StickStep::over(&open, self, self.doublings(lugre));
        let first = slopes.velocity.len() - along.variables;
        let began = slopes.deflection.clone();
        let mut found = SensitiveDisplacement::default();
        let (mut state, mut slipped) = (start, 0.0);
        let forces = along.force.iter().zip(along.force.iter().skip(1));
        let rows: Vec<&[f64]> = along.slopes.chunks_exact(along.variables.max(1)).collect();
        let steps = forces.zip(rows.iter().zip(rows.iter().skip(1)));
        let mut keep = |slopes: &CarriedSlopes, moved: f64| {
            let both = slopes.deflection.iter().zip(&slopes.slipped).zip(&began);
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
