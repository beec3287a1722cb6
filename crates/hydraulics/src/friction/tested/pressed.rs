use phea_dynamics::scalar::{Dual, Parameters, Scalar};

use super::{FRICTION_COEFFICIENTS, MultisineForce};
use crate::friction::LuGre;

/// A mass on bristles that a force presses, at rest at first. Units: kg, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressedMass {
    /// Moving mass M.
    pub mass: f64,
    /// Time between two rows of the force.
    pub time_step: f64,
    /// Steps of the integration between two rows.
    pub substeps: usize,
}

/// A force over the rows of a recording that is straight between its knots. Unit: N.
#[derive(Clone, Debug, PartialEq)]
pub struct KnottedForce {
    /// Rows of the knots, rising; the first is row 0.
    pub knots: Vec<usize>,
    /// The force there.
    pub forces: Vec<f64>,
}

/// Displacements, and their derivatives over the coefficients of the friction, in the order of
/// [`LuGre::to_array`], and over what else they depend on (the force at each knot; or the start and
/// the sizes of the sines), row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensitiveDisplacement {
    /// m, of each row from the first.
    pub displacements: Vec<f64>,
    /// For each row as many as there are coefficients and further variables.
    pub gradients: Vec<f64>,
}

impl KnottedForce {
    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.knots.last().map_or(0, |last| last + 1)
    }

    /// Of each row, the knot before it and the share of the knot after it.
    pub fn shares(&self) -> Vec<(usize, f64)> {
        let mut shares = Vec::with_capacity(self.rows());
        for (index, ends) in self.knots.windows(2).enumerate() {
            let [from, to] = [0, 1].map(|end| ends.get(end).copied().unwrap_or(0));
            let length = to.saturating_sub(from).max(1) as f64;
            shares.extend((from..to).map(|row| (index, (row - from) as f64 / length)));
        }
        if self.knots.len() > 1 {
            shares.push((self.knots.len() - 2, 1.0));
        }
        shares
    }

    fn along<S: Scalar>(&self, forces: &[S]) -> Vec<S> {
        let at = |index: usize| forces.get(index).copied().unwrap_or(S::from(0.0));
        let of = |(knot, share): (usize, f64)| at(knot).times(1.0 - share) + at(knot + 1).times(share);
        self.shares().into_iter().map(of).collect()
    }
}

/// Derivatives that are carried along at once.
const AT_ONCE: usize = 8;

type PressedSlope = Dual<AT_ONCE>;

/// A value that is the variable of this index.
type AsVariable<'a> = &'a dyn Fn(f64, usize) -> PressedSlope;

/// Displacements with as many derivatives, some at once.
fn carried(
    (rows, count): (usize, usize),
    moved: &dyn Fn(AsVariable<'_>) -> Vec<PressedSlope>,
) -> SensitiveDisplacement {
    let mut found = SensitiveDisplacement { displacements: Vec::new(), gradients: vec![0.0; rows * count] };
    for first in (0..count).step_by(AT_ONCE) {
        // an index beyond those that are carried along belongs to no variable
        let place = |index: usize| index.checked_sub(first).unwrap_or(AT_ONCE);
        let moved = moved(&|value, index| PressedSlope::variable(value, place(index)));
        for (row, slopes) in moved.iter().zip(found.gradients.chunks_exact_mut(count)) {
            for (to, slope) in slopes.iter_mut().skip(first).zip(row.gradient()) {
                *to = *slope;
            }
        }
        if first == 0 {
            found.displacements = moved.iter().map(PressedSlope::value).collect();
        }
    }
    found
}

/// The coefficients as the first variables.
fn open(lugre: &LuGre, variable: AsVariable<'_>) -> LuGre<PressedSlope> {
    let mut index = 0;
    lugre.convert(&mut |value| {
        index += 1;
        variable(value, index - 1)
    })
}

impl PressedMass {
    /// Displacement in m from the first row, for a force in N at each row.
    ///
    /// ```text
    /// M dv/dt = F - F_fr(v, z),   dz/dt = v - w,   w = sigma_0 |v| z/g(v)      F_fr as thesis (4.32)
    /// v(0) = 0,   sigma_0 z(0) = F(0)
    /// ```
    ///
    /// Without w the equations are linear, and are solved exactly for a force that is straight
    /// between rows; w, the slip of the bristles, is taken as straight within a step, from a first
    /// solution with its value at the beginning (Cox and Matthews 2002, ETD2RK). A step is good
    /// while the bristles slip by little more than their deflection in it: it suits the time before
    /// the piston breaks away, and its beginning.
    ///
    /// # Example
    /// A slow force F that stays below F_S moves the piston by -(F_S/sigma_0) ln(1 - F/F_S).
    /// ```
    /// use phea_hydraulics::friction::{LuGre, PressedMass};
    /// let lugre = LuGre::from_array([80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3]);
    /// let force: Vec<f64> = (0..=9000).map(|row| 90.0 * row as f64 / 9000.0).collect();
    /// let pressed = PressedMass { mass: 13.1, time_step: 1e-3, substeps: 4 };
    /// let moved = pressed.displacements(&lugre, &force);
    /// let closed_form = 12e-6 * 4.0_f64.ln();
    /// assert!((moved[9000] / closed_form - 1.0).abs() < 1e-3);
    /// ```
    pub fn displacements(&self, lugre: &LuGre, force: &[f64]) -> Vec<f64> {
        let doublings = self.doublings(lugre);
        self.moved(lugre, self.at_rest(lugre, force), force, doublings)
    }

    /// Velocity and deflection of a mass at rest under the first force.
    fn at_rest<S: Scalar>(&self, lugre: &LuGre<S>, force: &[S]) -> [S; 2] {
        let first = force.first().copied().unwrap_or(S::from(0.0));
        [S::from(0.0), first / lugre.bristle_stiffness]
    }

    /// The same for a force with knots, with derivatives.
    pub fn sensitive_displacements(&self, lugre: &LuGre, force: &KnottedForce) -> SensitiveDisplacement {
        let doublings = self.doublings(lugre);
        let shape = (force.rows(), FRICTION_COEFFICIENTS + force.forces.len());
        carried(shape, &|variable| {
            let open = open(lugre, variable);
            let own = force.forces.iter().enumerate();
            let own = own.map(|(knot, value)| variable(*value, FRICTION_COEFFICIENTS + knot));
            let along = force.along(&own.collect::<Vec<PressedSlope>>());
            self.moved(&open, self.at_rest(&open, &along), &along, doublings)
        })
    }

    /// Displacement in m from the first row, in motion at first, with derivatives over the
    /// coefficients, the velocity and the deflection at the first row, and the sizes of the force.
    ///
    /// As [`PressedMass::displacements`], but that the velocity and the deflection of the bristles
    /// at the first row are given, in m/s and m, and that the force is a sum of sines: it is
    /// evaluated at each step of the integration, not only at the rows, and is straight within a
    /// step.
    ///
    /// # Example
    /// A small force shakes the mass as it would on a spring and a damper:
    /// X = F/(sigma_0 - M omega^2 + j omega (sigma_1 + sigma_2)).
    /// ```
    /// use phea_hydraulics::friction::{LuGre, MultisineForce, PressedMass};
    /// let lugre = LuGre::from_array([80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3]);
    /// // 0.01 N where the spring and the mass cancel
    /// let omega = (1e7_f64 / 13.1).sqrt();
    /// let sizes = vec![0.0, 0.0, 0.0, 0.01, 0.0];
    /// let force = MultisineForce { rows: 2000, frequencies: vec![omega], duration: 0.2, sizes };
    /// let pressed = PressedMass { mass: 13.1, time_step: 1e-4, substeps: 2 };
    /// let moved = pressed.shaken(&lugre, [0.0, 0.0], &force).displacements;
    /// let swing = moved[1500..].iter().fold(0.0_f64, |most, at| most.max(at.abs()));
    /// assert!((swing / (0.01 / (2100.0 * omega)) - 1.0).abs() < 0.01);
    /// ```
    pub fn shaken(
        &self,
        lugre: &LuGre,
        [velocity, deflection]: [f64; 2],
        force: &MultisineForce,
    ) -> SensitiveDisplacement {
        let substeps = self.substeps.max(1);
        let steps = PressedMass { time_step: self.time_step / substeps as f64, substeps: 1, ..*self };
        let doublings = steps.doublings(lugre);
        let shapes = force.shapes(force.rows.saturating_sub(1) * substeps + 1, steps.time_step);
        let first = FRICTION_COEFFICIENTS + 2;
        carried((force.rows, first + force.sizes.len()), &|variable| {
            let start =
                [variable(velocity, FRICTION_COEFFICIENTS), variable(deflection, FRICTION_COEFFICIENTS + 1)];
            let sizes = force.sizes.iter().enumerate();
            let sizes: Vec<PressedSlope> =
                sizes.map(|(index, size)| variable(*size, first + index)).collect();
            let sum = |shapes: &[f64]| {
                let parts = sizes.iter().zip(shapes);
                parts.fold(PressedSlope::from(0.0), |sum, (size, shape)| sum + size.times(*shape))
            };
            let along: Vec<PressedSlope> = shapes.chunks_exact(sizes.len().max(1)).map(sum).collect();
            let moved = steps.moved(&open(lugre, variable), start, &along, doublings);
            moved.into_iter().step_by(substeps).collect()
        })
    }

    /// How often the argument of the series is halved.
    fn doublings(&self, lugre: &LuGre) -> u32 {
        let step = self.time_step / self.substeps.max(1) as f64;
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

    fn moved<S: Scalar>(&self, lugre: &LuGre<S>, start: [S; 2], force: &[S], doublings: u32) -> Vec<S> {
        let substeps = self.substeps.max(1);
        let step = self.time_step / substeps as f64;
        let stick = StickStep::over(lugre, self.mass, step, doublings);
        let slip = |[velocity, deflection]: [S; 2]| {
            lugre.bristle_stiffness * velocity.abs() * deflection / lugre.curve.sliding_force(velocity)
        };
        let mut moved = Vec::with_capacity(force.len());
        if force.is_empty() {
            return moved;
        }
        let mut state = start;
        let mut slipped = S::from(0.0);
        moved.push(S::from(0.0));
        for (from, to) in force.iter().zip(force.iter().skip(1)) {
            let rise = (*to - *from).times(1.0 / substeps as f64);
            let mut force = *from;
            for _ in 0..substeps {
                let before = slip(state);
                let tried = stick.step(state, [force, rise], before);
                let change = slip(tried) - before;
                state = stick.corrected(tried, change);
                slipped = slipped + (before + change.times(0.5)).times(step);
                force = force + rise;
            }
            moved.push(state[1] - start[1] + slipped);
        }
        moved
    }
}

/// A step of the linear part: y = (v, z), dy/dt = A y + b_F F + b_w w.
struct StickStep<S> {
    /// e^(A h).
    transition: [[S; 2]; 2],
    /// Effect of a constant force, and of one that rises by 1 within the step.
    of_force: [[S; 2]; 2],
    /// The same of the slip.
    of_slip: [[S; 2]; 2],
}

impl<S: Scalar> StickStep<S> {
    /// ```text
    /// A = [-2 d, -q; 1, 0],   d = (sigma_1 + sigma_2)/(2 M),   q = sigma_0/M
    /// e^(A h) = e^(-d h) (cosh(r h) I + sinh(r h)/r (A + d I)),   r^2 = d^2 - q
    /// G_1 = A^-1 (e^(A h) - I),   G_2 = A^-1 (G_1 - h I)
    /// ```
    ///
    /// cosh and sinh by their series at h/2^n, doubled n times: they are the same for a ringing
    /// mass (r^2 negative) and for one that creeps.
    fn over(lugre: &LuGre<S>, mass: f64, step: f64, doublings: u32) -> StickStep<S> {
        const TERMS: u32 = 9;
        let (one, none) = (S::from(1.0), S::from(0.0));
        let damping = (lugre.bristle_damping + lugre.curve.viscous).times(0.5 / mass);
        let stiffness = lugre.bristle_stiffness.times(1.0 / mass);
        let short = step / f64::from(1_u32 << doublings.min(31));
        let square = (damping.squared() - stiffness).times(short * short);
        let (mut cosh, mut sinh) = (one, one);
        for term in (1..=TERMS).rev() {
            let even = f64::from(2 * term);
            cosh = one + square.times(1.0 / (even * (even - 1.0))) * cosh;
            sinh = one + square.times(1.0 / (even * (even + 1.0))) * sinh;
        }
        sinh = sinh.times(short);
        for _ in 0..doublings {
            sinh = (sinh * cosh).times(2.0);
            cosh = cosh.squared().times(2.0) - one;
        }
        let fading = (-damping.times(step)).exp();
        let [c, s] = [cosh * fading, sinh * fading];
        let transition = [[c - s * damping, -(s * stiffness)], [s, c + s * damping]];
        let inverse = [[none, one], [-(one / stiffness), -(damping.times(2.0) / stiffness)]];
        let less = |[[a, b], [c, d]]: [[S; 2]; 2], by: S| [[a - by, b], [c, d - by]];
        let first = product(inverse, less(transition, one));
        let second = product(inverse, less(first, S::from(step)));
        let force = [S::from(1.0 / mass), none];
        let slip = [lugre.bristle_damping.times(1.0 / mass), -one];
        let over_step = |by: [S; 2]| by.map(|part| part.times(1.0 / step));
        StickStep {
            transition,
            of_force: [applied(first, force), over_step(applied(second, force))],
            of_slip: [applied(first, slip), over_step(applied(second, slip))],
        }
    }

    /// The state after a step under a force that rises and a slip that stays.
    fn step(&self, state: [S; 2], [force, rise]: [S; 2], slip: S) -> [S; 2] {
        let mut after = applied(self.transition, state);
        let parts = [(self.of_force[0], force), (self.of_force[1], rise), (self.of_slip[0], slip)];
        for (effect, size) in parts {
            after = [after[0] + effect[0] * size, after[1] + effect[1] * size];
        }
        after
    }

    /// The same where the slip changes by this within the step.
    fn corrected(&self, [velocity, deflection]: [S; 2], change: S) -> [S; 2] {
        let [of_velocity, of_deflection] = self.of_slip[1];
        [velocity + of_velocity * change, deflection + of_deflection * change]
    }
}

fn applied<S: Scalar>([[a, b], [c, d]]: [[S; 2]; 2], [x, y]: [S; 2]) -> [S; 2] {
    [a * x + b * y, c * x + d * y]
}

fn product<S: Scalar>(first: [[S; 2]; 2], [[a, b], [c, d]]: [[S; 2]; 2]) -> [[S; 2]; 2] {
    let [left, right] = [applied(first, [a, c]), applied(first, [b, d])];
    [[left[0], right[0]], [left[1], right[1]]]
}
