//! Residuals of a shaken piston.

use std::collections::BTreeMap;

use phea_hydraulics::friction::{
    FRICTION_COEFFICIENTS, LuGre, MultisineShapes, PressedMass, SensitiveDisplacement,
};

use super::{FrictionProblem, ResidualRows, ZERO};
use crate::friction::shaking::ShakenRows;

/// Number of variables of a shake in addition to the coefficients of its force: initial position,
/// velocity and deflection of the bristles.
const BEGINNINGS: usize = 3;

/// Largest angle by which the fastest sine, and the oscillation on the bristles, turn in an
/// integration step, rad: a straight line within it is 1e-3 too weak.
const STEP_ANGLE: f64 = 0.1;

/// Largest number of steps between two rows.
const MOST_STEPS: f64 = 40.0;

/// Shaken piston for given variables.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::friction) struct Shake {
    /// Position at the first row, relative to the first recorded one, m.
    pub(in crate::friction) begins: f64,
    /// Initial velocity, m/s, and deflection of the bristles, m.
    start: [f64; 2],
    /// Coefficients of the force as the instruments show it, N.
    pub(in crate::friction) sizes: Vec<f64>,
}

/// Shapes that the coefficients of the forces multiply, for each recording: a search requests them
/// repeatedly.
#[derive(Debug, Default)]
pub(in crate::friction) struct ShapeCache {
    at_rows: BTreeMap<usize, MultisineShapes>,
    /// Shapes with the number of steps between two rows that was requested last.
    at_steps: BTreeMap<usize, (usize, MultisineShapes)>,
}

impl ShapeCache {
    /// Shapes at the rows.
    pub(in crate::friction) fn at_rows(&mut self, shake: &ShakenRows, time_step: f64) -> &MultisineShapes {
        let of = || shake.force.shapes(shake.force.rows, time_step);
        self.at_rows.entry(shake.recording).or_insert_with(of)
    }

    /// Shapes at the integration steps of this mass.
    fn at_steps(&mut self, shake: &ShakenRows, shaken: PressedMass) -> &MultisineShapes {
        let of = || (shaken.substeps, shaken.shapes(&shake.force));
        let cache = self.at_steps.entry(shake.recording).or_insert_with(of);
        if cache.0 != shaken.substeps {
            *cache = of();
        }
        &cache.1
    }
}

impl ShakenRows {
    /// Number of variables of the shake.
    pub(in crate::friction) fn variable_count(&self) -> usize {
        BEGINNINGS + self.force.sizes.len()
    }
}

impl FrictionProblem<'_> {
    /// Damping of a mass that oscillates on its bristles, N·s/m, if its velocity is that of its
    /// force.
    fn ringing_damping(&self) -> f64 {
        self.around.damping[1]
    }

    /// Velocity of a mass that oscillates with the deflection at breakaway, m/s.
    fn ringing_velocity(&self) -> f64 {
        self.around.force / self.ringing_damping()
    }

    pub(super) fn shake_start(&self, shake: &ShakenRows) -> Vec<f64> {
        let sizes = shake.force.sizes.iter().map(|size| size / self.around.force);
        let [velocity, deflection] = shake.beginning();
        let start = [0.0, velocity / self.ringing_velocity(), deflection / self.around.length];
        start.into_iter().chain(sizes).collect()
    }

    pub(super) fn shake_bounds(shake: &ShakenRows) -> Vec<[f64; 2]> {
        let beginnings = [[-1e6, 1e6], [-1e3, 1e3], [-1e3, 1e3]].into_iter();
        beginnings.chain(shake.force.sizes.iter().map(|_| [-1e3, 1e3])).collect()
    }

    /// Shake for its variables.
    pub(in crate::friction) fn shake_of(&self, own: &[f64]) -> Option<Shake> {
        let (beginnings, sizes) = own.split_at_checked(BEGINNINGS)?;
        let [begins, velocity, deflection] = *beginnings else { return None };
        let length = self.around.length;
        let sizes = sizes.iter().map(|size| size * self.around.force).collect();
        Some(Shake {
            begins: begins * length,
            start: [velocity * self.ringing_velocity(), deflection * length],
            sizes,
        })
    }

    pub(super) fn shake(
        &self,
        shake: &ShakenRows,
        (lugre, zero): (&LuGre, f64),
        (first, own): (usize, &[f64]),
        [force_scale, position_scale]: [f64; 2],
        (cache, rows): (&mut ShapeCache, &mut ResidualRows),
    ) -> Option<()> {
        let force = self.around.force;
        let recording = self.recordings.get(shake.recording)?;
        let found = self.shake_of(own)?;
        let count = shake.force.sizes.len();
        let sizes_from = first + BEGINNINGS;
        let shapes = cache.at_rows(shake, recording.time_step);
        for (shapes, shown) in shapes.rows().zip(&recording.forces) {
            let modelled: f64 = shapes.iter().zip(&found.sizes).map(|(one, size)| one * size).sum();
            let row = rows.next((modelled - shown) / force_scale);
            for (to, shape) in row.iter_mut().skip(sizes_from).zip(shapes) {
                *to = shape * force / force_scale;
            }
        }
        let moved = found.moved((self.mass, recording.time_step), lugre, zero, (shake, cache));
        let start = recording.positions.first()? + found.begins;
        let slopes = moved.gradients.chunks_exact(FRICTION_COEFFICIENTS + 2 + count);
        for ((moved, gradient), shown) in moved.displacements.iter().zip(slopes).zip(&recording.positions) {
            if !moved.is_finite() {
                return None;
            }
            let row = rows.next((start + moved - shown) / position_scale);
            let (coefficients, own) = gradient.split_at(FRICTION_COEFFICIENTS);
            for (to, slope) in row.iter_mut().zip(self.shared_slopes(lugre, coefficients)) {
                *to = slope / position_scale;
            }
            let (state, by_size) = own.split_at(2);
            let length = self.around.length;
            let mean = by_size.first().copied().unwrap_or(0.0);
            let beginnings = [length, state[0] * self.ringing_velocity(), state[1] * length];
            let sizes = by_size.iter().map(|slope| slope * force);
            let values = beginnings.into_iter().chain(sizes);
            for (to, slope) in row.iter_mut().skip(first).zip(values) {
                *to = slope / position_scale;
            }
            row.iter_mut().skip(ZERO).take(1).for_each(|to| *to = -mean * force / position_scale);
        }
        Some(())
    }
}

impl Shake {
    /// Displacement from the first row, with this zero error of the force.
    pub(in crate::friction) fn moved(
        &self,
        (mass, time_step): (f64, f64),
        lugre: &LuGre,
        zero: f64,
        (shake, cache): (&ShakenRows, &mut ShapeCache),
    ) -> SensitiveDisplacement {
        let mut acting = self.sizes.clone();
        acting.iter_mut().take(1).for_each(|mean| *mean -= zero);
        let ringing = (lugre.bristle_stiffness / mass).sqrt();
        let fastest = shake.force.frequencies.iter().copied().fold(ringing, f64::max);
        let substeps = (fastest * time_step / STEP_ANGLE).ceil().clamp(1.0, MOST_STEPS) as usize;
        let shaken = PressedMass { mass, time_step, substeps };
        shaken.shaken(lugre, self.start, (&acting, cache.at_steps(shake, shaken)))
    }
}
