//! Recordings of friction from its equations, which are written here again: the records of a bench
//! with known friction, with the errors of its instruments.
//!
//! ```text
//! dz/dt = v - sigma_0 |v| z/g(v)        F = sigma_0 z + sigma_1 dz/dt + sigma_2 v
//! g(v) = F_C + (F_S - F_C) exp(-|v/v_S|^alpha)        F_C, F_S and sigma_2 by the sign of v
//! ```

#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use std::fmt::Write as _;

use phea_dynamics::random::{normal, stream};

pub(crate) const MASS: f64 = 13.1;

/// Area of both chambers, m2.
pub(crate) fn area() -> f64 {
    std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022)
}

/// Levels of Coulomb and static friction, N, and viscous friction, N s/m.
#[derive(Clone, Copy)]
pub(crate) struct Levels {
    pub(crate) coulomb: f64,
    pub(crate) breaking: f64,
    pub(crate) viscous: f64,
}

/// A known friction: levels for extending and for retracting, and the parameters common to both.
#[derive(Clone, Copy)]
pub(crate) struct TrueFriction {
    pub(crate) levels: [Levels; 2],
    pub(crate) stribeck: f64,
    pub(crate) exponent: f64,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
}

/// Position in m and force in N of each row, as instruments without errors would show them.
pub(crate) type Rows = Vec<(f64, f64)>;

/// Time between rows, s.
const STEP: f64 = 1e-3;

impl TrueFriction {
    /// The friction of the example.
    pub(crate) fn of_the_example() -> TrueFriction {
        let levels = Levels { coulomb: 80.0, breaking: 120.0, viscous: 100.0 };
        TrueFriction { levels: [levels; 2], stribeck: 0.01, exponent: 2.0, stiffness: 1e7, damping: 2e3 }
    }

    fn of(&self, velocity: f64) -> Levels {
        self.levels[usize::from(velocity < 0.0)]
    }

    /// Level g(v), N.
    fn carried(&self, velocity: f64) -> f64 {
        let Levels { coulomb, breaking, .. } = self.of(velocity);
        coulomb + (breaking - coulomb) * (-(velocity.abs() / self.stribeck).powf(self.exponent)).exp()
    }

    /// Constant velocities of half a second in both directions, with ramps of 50 ms between them.
    /// The bristles are solved exactly for the velocity of each part of a row.
    pub(crate) fn sliding(&self, speeds: &[f64]) -> Rows {
        let mut velocities = vec![0.0; 50];
        for target in speeds.iter().flat_map(|speed| [*speed, -speed]) {
            let before = velocities[velocities.len() - 1];
            velocities.extend((0..50).map(|row| before + (target - before) * f64::from(row) / 49.0));
            velocities.extend([target; 500]);
        }
        let (mut position, mut deflection, mut before) = (0.0, 0.0, 0.0);
        let mut rows = Vec::new();
        for velocity in velocities {
            let carried = self.carried(velocity);
            let rate = velocity - self.stiffness * velocity.abs() * deflection / carried;
            let friction =
                self.stiffness * deflection + self.damping * rate + self.of(velocity).viscous * velocity;
            rows.push((position, friction + MASS * (velocity - before) / STEP));
            before = velocity;
            let settled = velocity.signum() * carried / self.stiffness;
            deflection =
                settled + (deflection - settled) * (-self.stiffness * velocity.abs() * STEP / carried).exp();
            position += velocity * STEP;
        }
        rows
    }

    /// A force that rises from rest by 1.3 times the static friction in 3 s, until the piston has
    /// moved by half a millimetre.
    pub(crate) fn breakaway(&self, way: f64) -> Rows {
        let rise = 1.3 * self.of(way).breaking / 3.0;
        let force = |time: f64, _: f64| way * rise * (time - 0.05).max(0.0);
        self.moved(force, 4.0, 200)
    }

    /// A piston on a spring in N/m whose other end moves at a speed in m/s.
    pub(crate) fn pulled(&self, speed: f64, spring: f64) -> Rows {
        self.moved(|time, position| spring * (speed * time - position), 3.0, 50)
    }

    /// A mass under a force of time and position, by steps that are implicit in the velocity.
    fn moved(&self, force: impl Fn(f64, f64) -> f64, duration: f64, parts: u32) -> Rows {
        let (mut position, mut velocity, mut deflection) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut rows = Vec::new();
        let by = STEP / f64::from(parts);
        let mut time = 0.0;
        while time < duration && (parts < 100 || position.abs() < 5e-4) {
            rows.push((position, force(time, position)));
            for part in 0..parts {
                let now = time + by * f64::from(part);
                let open = 1.0 - velocity.signum() * self.stiffness * deflection / self.carried(velocity);
                let damping = self.damping * open + self.of(velocity).viscous;
                let inertia = MASS + by * damping + by * by * self.stiffness * open;
                velocity =
                    (MASS * velocity + by * (force(now, position) - self.stiffness * deflection)) / inertia;
                deflection += by * velocity * open;
                position += by * velocity;
            }
            time += STEP;
        }
        rows
    }
}

/// Errors of the instruments.
#[derive(Clone, Copy, Default)]
pub(crate) struct Errors {
    /// Errors of the zeros of both pressures, bar.
    pub(crate) zeros: [f64; 2],
    /// Seed of the noise of 5 kPa and 1 um; 0 for none.
    pub(crate) seed: u64,
}

/// Rows as recorded: the mean of both pressures is 30 bar throughout.
pub(crate) fn table(rows: &Rows, errors: Errors) -> String {
    let mut chance = stream(errors.seed, 11);
    let size = if errors.seed > 0 { 1.0 } else { 0.0 };
    let mut noise = || size * normal(&mut chance);
    let mut text = "time_s,position_mm,pressure_a_bar,pressure_b_bar\n".to_string();
    for (index, (position, force)) in rows.iter().enumerate() {
        let half = force / area() * 1e-5 / 2.0;
        let [a, b] = [30.0 + half + errors.zeros[0], 30.0 - half + errors.zeros[1]];
        let position = 1e3 * position + 1e-3 * noise();
        let time = STEP * index as f64;
        writeln!(text, "{time:.4},{position:.6},{:.6},{:.6}", a + 0.05 * noise(), b + 0.05 * noise())
            .unwrap();
    }
    text
}
