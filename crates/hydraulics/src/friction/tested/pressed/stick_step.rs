//! Step of a mass on bristles that hardly slip.

use phea_dynamics::scalar::Scalar;

use super::PressedMass;
use crate::friction::LuGre;

/// Step of the linear part: y = (v, z), dy/dt = A y + b_F F + b_w w.
pub(super) struct StickStep<S> {
    /// Length h, s.
    length: f64,
    /// Transition matrix e^(A h).
    transition: [[S; 2]; 2],
    /// Effect of a constant force, and of one that rises by 1 within the step.
    of_force: [[S; 2]; 2],
    /// Effect of the slip, likewise.
    of_slip: [[S; 2]; 2],
}

impl<S: Scalar> StickStep<S> {
    /// ```text
    /// A = [-2 d, -q; 1, 0],   d = (sigma_1 + sigma_2)/(2 M),   q = sigma_0/M
    /// e^(A h) = e^(-d h) (cosh(r h) I + sinh(r h)/r (A + d I)),   r^2 = d^2 - q
    /// G_1 = A^-1 (e^(A h) - I),   G_2 = A^-1 (G_1 - h I)
    /// ```
    ///
    /// cosh and sinh by their series at h/2^n, doubled n times: valid for a ringing mass (r^2
    /// negative) and for one that creeps.
    pub(super) fn over(lugre: &LuGre<S>, pressed: &PressedMass, doublings: u32) -> StickStep<S> {
        const TERMS: u32 = 9;
        let (mass, step) = (pressed.mass, pressed.step());
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
            length: step,
            transition,
            of_force: [applied(first, force), over_step(applied(second, force))],
            of_slip: [applied(first, slip), over_step(applied(second, slip))],
        }
    }

    /// State after a step under a rising force, and the slip distance of the bristles in it.
    pub(super) fn with_slip(&self, lugre: &LuGre<S>, state: [S; 2], force: [S; 2]) -> ([S; 2], S) {
        let slip = |[velocity, deflection]: [S; 2]| {
            lugre.bristle_stiffness * velocity.abs() * deflection / lugre.curve.sliding_force(velocity)
        };
        let before = slip(state);
        let tried = self.step(state, force, before);
        let change = slip(tried) - before;
        (self.corrected(tried, change), (before + change.times(0.5)).times(self.length))
    }

    /// State after a step under a rising force and a constant slip.
    fn step(&self, state: [S; 2], [force, rise]: [S; 2], slip: S) -> [S; 2] {
        let mut after = applied(self.transition, state);
        let parts = [(self.of_force[0], force), (self.of_force[1], rise), (self.of_slip[0], slip)];
        for (effect, size) in parts {
            after = [after[0] + effect[0] * size, after[1] + effect[1] * size];
        }
        after
    }

    /// State corrected for a change of the slip within the step.
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
