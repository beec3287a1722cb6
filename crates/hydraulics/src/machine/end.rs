use phea_dynamics::scalar::Scalar;

use super::{Machine, Motion};

/// End of the rod on the load's side. Without a linkage this is the load.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoadEnd<T> {
    /// Position x_L and velocity v_L.
    pub(super) motion: Motion<T>,
    /// Lever arm g' of a linkage, m; `None` without one.
    pub(super) lever_arm: Option<T>,
}

impl<T: Scalar> LoadEnd<T> {
    /// Effect on the load of a force on this end in N: the force itself, or a torque in N m.
    #[inline(always)]
    pub(super) fn on_load(&self, force: T) -> T {
        self.lever_arm.map_or(force, |arm| arm * force)
    }
}

impl<S: Scalar> Machine<S> {
    /// Motion of the end of the rod for a motion of the load.
    ///
    /// ```text
    /// x_L = g(theta),   v_L = g'(theta) omega
    /// ```
    #[inline(always)]
    pub(super) fn end_of<T: Scalar + From<S>>(&self, load: &Motion<T>) -> LoadEnd<T> {
        match &self.linkage {
            None => LoadEnd { motion: *load, lever_arm: None },
            Some(linkage) => {
                let end = linkage.end_of(load.position);
                let motion = Motion { position: end.position, velocity: end.lever_arm * load.velocity };
                LoadEnd { motion, lever_arm: Some(end.lever_arm) }
            }
        }
    }

    /// Torque of the load's weight, N m; `None` without one.
    #[inline(always)]
    pub(super) fn weight_on<T: Scalar + From<S>>(&self, load: &Motion<T>) -> Option<T> {
        Some(self.linkage.as_ref()?.weight_of(load.position)?.torque)
    }

    /// Potential energy of the load's weight, J; zero without one, and if the load does not yield.
    pub(super) fn weight_energy<T: Scalar + From<S>>(&self, load: &Motion<T>) -> T {
        let weight = self.linkage.as_ref().filter(|_| self.load.moves());
        let weight = weight.and_then(|linkage| linkage.weight_of(load.position));
        weight.map_or(T::from(0.0), |weight| weight.energy)
    }

    /// Typical magnitudes of the states of a load, from those of force, deflection and velocity of
    /// the rod; `swing` is the velocity of a mass in kg on the sensor.
    pub(super) fn typical_load(&self, deflection: S, velocity: S, swing: impl Fn(S) -> S) -> Motion<S> {
        let mass = self.load.mass();
        match &self.linkage {
            None => Motion { position: deflection, velocity: mass.map_or(velocity, swing) },
            Some(linkage) => {
                let arm = linkage.typical_arm();
                let reflected = mass.map(|inertia| inertia / arm.squared());
                Motion { position: deflection / arm, velocity: reflected.map_or(velocity, swing) / arm }
            }
        }
    }
}

impl Machine {
    /// Load with the end of the rod at a position in m and its force in N held: its motion from its
    /// ground, and the position of the ground.
    pub(super) fn held_load(&self, end: f64, force: f64, velocity: f64) -> Option<(Motion, f64)> {
        let (position, arm, weight) = match &self.linkage {
            None => (end, 1.0, 0.0),
            Some(linkage) => {
                let angle = linkage.angle(end);
                let weight = linkage.weight_at(angle).map_or(0.0, |weight| weight.torque);
                (angle, linkage.end(angle).lever_arm, weight)
            }
        };
        // a load that nothing holds begins to fall from its position
        let torque = force * arm;
        let relative = self.load.held_at(torque + weight).or_else(|| self.load.held_at(torque))?;
        Some((Motion { position: relative, velocity: velocity / arm }, position - relative))
    }

    /// Rotation of the load in rad, at this angle of its joint, for a displacement of its end of
    /// the rod in m, by the lever arm there; the displacement itself without a linkage.
    pub fn turn_of(&self, angle: f64, way: f64) -> f64 {
        self.linkage.map_or(way, |linkage| way / linkage.end(angle).lever_arm)
    }
}
