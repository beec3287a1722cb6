mod carried;
mod stick_step;

use super::{FRICTION_COEFFICIENTS, MultisineForce, MultisineShapes};
use crate::friction::LuGre;
use carried::{CarriedSlopes, LinearForce, STATE};
use stick_step::StickStep;

/// Index of the stiffness of the bristles among the coefficients.
const STIFFNESS: usize = 5;

/// Mass on bristles, initially at rest, pressed by a force. Units: kg, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressedMass {
    /// Moving mass M.
    pub mass: f64,
    /// Time between two rows of the force.
    pub time_step: f64,
    /// Integration steps between two rows.
    pub substeps: usize,
}

/// Force over the rows of a recording, linear between its knots. Unit: N.
#[derive(Clone, Debug, PartialEq)]
pub struct KnottedForce {
    /// Rows of the knots, rising; the first is row 0.
    pub knots: Vec<usize>,
    /// Force at each knot.
    pub forces: Vec<f64>,
}

/// Displacements, and their derivatives over the coefficients of the friction, in the order of
/// [`LuGre::to_array`], and over the further variables (the force at each knot; or the start and
/// the sizes of the sines), row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensitiveDisplacement {
    /// Displacement of each row from the first, m.
    pub displacements: Vec<f64>,
    /// Derivatives: for each row as many as there are coefficients and further variables.
    pub gradients: Vec<f64>,
}

impl KnottedForce {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.knots.last().map_or(0, |last| last + 1)
    }

    /// Knot before each row, and the weight of the knot after it.
    pub fn fractions(&self) -> Vec<(usize, f64)> {
        let mut fractions = Vec::with_capacity(self.rows());
        for (index, ends) in self.knots.windows(2).enumerate() {
            let [from, to] = [0, 1].map(|end| ends.get(end).copied().unwrap_or(0));
            let length = to.saturating_sub(from).max(1) as f64;
            fractions.extend((from..to).map(|row| (index, (row - from) as f64 / length)));
        }
        if self.knots.len() > 1 {
            fractions.push((self.knots.len() - 2, 1.0));
        }
        fractions
    }

    /// Force at each row, and its derivatives with respect to the forces at the knots.
    fn along(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut forces, mut slopes) = (Vec::new(), Vec::new());
        for (knot, fraction) in self.fractions() {
            let at = |index: usize| self.forces.get(index).copied().unwrap_or(0.0);
            forces.push(at(knot) * (1.0 - fraction) + at(knot + 1) * fraction);
            let from = slopes.len();
            slopes.resize(from + self.forces.len(), 0.0);
            for (slope, weight) in slopes.iter_mut().skip(from + knot).zip([1.0 - fraction, fraction]) {
                *slope = weight;
            }
        }
        (forces, slopes)
    }
}

impl PressedMass {
    /// Displacement from the first row, for a force in N at each row, m.
    ///
    /// ```text
    /// M dv/dt = F - F_fr(v, z),   dz/dt = v - w,   w = sigma_0 |v| z/g(v)      F_fr as thesis (4.32)
    /// v(0) = 0,   sigma_0 z(0) = F(0)
    /// ```
    ///
    /// Without w the equations are linear, and are solved exactly for a force that is linear
    /// between rows; w, the slip of the bristles, is assumed linear within a step, from a first
    /// solution with its value at the beginning (Cox and Matthews 2002, ETD2RK). A step is accurate
    /// while the bristles slip in it by little more than their deflection: this covers the time
    /// before the piston breaks away, and the beginning of its motion. For friction that differs by
    /// direction, g differs here; sigma_2, which is small compared with sigma_1, is that of
    /// positive velocity.
    ///
    /// # Example
    /// A slow force F that stays below F_S moves the piston by -(F_S/sigma_0) ln(1 - F/F_S).
    /// ```
    /// use phea_hydraulics::friction::{LuGre, PressedMass};
    /// let lugre = LuGre::same_both_ways([80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3]);
    /// let force: Vec<f64> = (0..=9000).map(|row| 90.0 * row as f64 / 9000.0).collect();
    /// let pressed = PressedMass { mass: 13.1, time_step: 1e-3, substeps: 4 };
    /// let moved = pressed.displacements(&lugre, &force);
    /// let closed_form = 12e-6 * 4.0_f64.ln();
    /// assert!((moved[9000] / closed_form - 1.0).abs() < 1e-3);
    /// ```
    pub fn displacements(&self, lugre: &LuGre, force: &[f64]) -> Vec<f64> {
        let start = [0.0, force.first().copied().unwrap_or(0.0) / lugre.bristle_stiffness];
        let stick = StickStep::over(lugre, self, self.doublings(lugre));
        let mut state = start;
        let mut slipped = 0.0;
        let mut moved: Vec<f64> = force.iter().take(1).map(|_| 0.0).collect();
        for (from, to) in force.iter().zip(force.iter().skip(1)) {
            for (force, rise) in self.within(*from, *to) {
                let slid;
                (state, slid) = stick.with_slip(lugre, state, [force, rise]);
                slipped += slid;
            }
            moved.push(state[1] - start[1] + slipped);
        }
        moved
    }

    /// Force and rise of each step from one row to the next.
    fn within(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> + use<> {
        let substeps = self.substeps.max(1);
        let rise = (to - from) * (1.0 / substeps as f64);
        (0..substeps).scan(from, move |force, _| {
            let before = *force;
            *force += rise;
            Some((before, rise))
        })
    }

    /// Displacement for a force with knots, with derivatives.
    pub fn sensitive_displacements(&self, lugre: &LuGre, force: &KnottedForce) -> SensitiveDisplacement {
        let (forces, of_forces) = force.along();
        let along = LinearForce { force: &forces, slopes: &of_forces, variables: force.forces.len() };
        let count = FRICTION_COEFFICIENTS + along.variables;
        let stiffness = lugre.bristle_stiffness;
        let deflection = along.force.first().copied().unwrap_or(0.0) / stiffness;
        let mut slopes = CarriedSlopes::zero(count);
        slopes.deflection[STIFFNESS] = -deflection / stiffness;
        for (to, slope) in slopes.deflection[FRICTION_COEFFICIENTS..].iter_mut().zip(along.slopes) {
            *to = slope / stiffness;
        }
        self.carried(lugre, ([0.0, deflection], slopes), along, 1)
    }

    /// Displacement from the first row for a mass initially in motion, m, with derivatives over the
    /// coefficients, the velocity and the deflection at the first row, and the sizes of the force.
    ///
    /// Unlike in [`PressedMass::displacements`], the velocity and the deflection of the bristles at
    /// the first row are given, in m/s and m, and the force is a sum of sines: it is evaluated at
    /// each step of the integration, not only at the rows, and is linear within a step. It is given
    /// by its sizes in N, and by their factors from [`PressedMass::shapes`] of the same mass.
    ///
    /// # Example
    /// A small force shakes the mass as on a spring and a damper: X = F/(sigma_0 - M omega^2 + j
    /// omega (sigma_1 + sigma_2)).
    /// ```
    /// use phea_hydraulics::friction::{LuGre, MultisineForce, PressedMass};
    /// let lugre = LuGre::same_both_ways([80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3]);
    /// // 0.01 N where the spring and the mass cancel
    /// let omega = (1e7_f64 / 13.1).sqrt();
    /// let sizes = vec![0.0, 0.0, 0.0, 0.01, 0.0];
    /// let force = MultisineForce { rows: 2000, frequencies: vec![omega], duration: 0.2, sizes };
    /// let pressed = PressedMass { mass: 13.1, time_step: 1e-4, substeps: 2 };
    /// let shapes = pressed.shapes(&force);
    /// let moved = pressed.shaken(&lugre, [0.0, 0.0], (&force.sizes, &shapes)).displacements;
    /// let swing = moved[1500..].iter().fold(0.0_f64, |most, at| most.max(at.abs()));
    /// assert!((swing / (0.01 / (2100.0 * omega)) - 1.0).abs() < 0.01);
    /// ```
    pub fn shaken(
        &self,
        lugre: &LuGre,
        [velocity, deflection]: [f64; 2],
        (sizes, shapes): (&[f64], &MultisineShapes),
    ) -> SensitiveDisplacement {
        let substeps = self.substeps.max(1);
        let steps = PressedMass { time_step: self.step(), substeps: 1, ..*self };
        let force = shapes.times(sizes);
        let along = LinearForce { force: &force, slopes: shapes.flat(), variables: shapes.sizes() };
        let mut slopes = CarriedSlopes::zero(STATE + 2 + along.variables);
        (slopes.velocity[STATE], slopes.deflection[STATE + 1]) = (1.0, 1.0);
        steps.carried(lugre, ([velocity, deflection], slopes), along, substeps)
    }

    /// Factors of the sizes of a force at each step of the integration, up to the last row, for
    /// [`PressedMass::shaken`].
    pub fn shapes(&self, force: &MultisineForce) -> MultisineShapes {
        force.shapes(force.rows.saturating_sub(1) * self.substeps.max(1) + 1, self.step())
    }

    /// Length of a step, s.
    fn step(&self) -> f64 {
        self.time_step / self.substeps.max(1) as f64
    }

    /// Number of halvings of the argument of the series.
    fn doublings(&self, lugre: &LuGre) -> u32 {
        let step = self.step();
        let damping = (lugre.bristle_damping + lugre.curve.viscous) / (2.0 * self.mass);
        let square = (damping * damping - lugre.bristle_stiffness / self.mass).abs() * step * step;
        let mut doublings = 0;
        let mut rest = square;
        while rest > 1.0 && doublings < 40 {
            rest /= 4.0;
            doublings += 1;
        }
        doublings
    }
}
