use phea_dynamics::scalar::Scalar;

/// Oil of a transmission, as it acts on rod and load: springs of its compressibility, and plugs of
/// oil between them with friction against the fixed line. Units: N/m, kg, N s/m.
///
/// ```text
/// rod - k_1 - m - k_2 - m - ... - k_N+1 - load             each m damped by b against the ground
/// k_1 = k_N+1 = A^2/(C_e + C/2N),   k_j = A^2 N/C,   m = A^2 I/N,   b = A^2 R_0/N
/// f_j = k_j d_j = A (p_j-1 - p_0)                          u_j = q_j/A the velocity of plug j
/// ```
///
/// The equations are those of [`Transmission`](super::Transmission) with forces in place of
/// pressures. Every part stores or dissipates, so it is passive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OilColumn<S = f64> {
    /// Stiffness k of the first and the last spring.
    pub end_stiffness: S,
    /// Stiffness k of the springs between two plugs.
    pub inner_stiffness: S,
    /// Mass m of each plug.
    pub mass: S,
    /// Damping b of each plug.
    pub damping: S,
    /// Area A of either piston, m2.
    pub piston_area: S,
    /// Gauge pressure p_0 at which no spring is loaded, Pa.
    pub filling_pressure: S,
    /// Number N of plugs.
    pub segments: usize,
}

phea_dynamics::parameters! {
    OilColumn {
        end_stiffness, inner_stiffness, mass, damping, piston_area, filling_pressure,
        segments: kept,
    }
}

impl<S: Copy> OilColumn<S> {
    /// Stiffness k of the spring behind this many plugs.
    #[inline(always)]
    pub(crate) fn stiffness_behind(&self, plugs: usize) -> S {
        if plugs == 0 || plugs == self.segments { self.end_stiffness } else { self.inner_stiffness }
    }
}

impl<S: Scalar> OilColumn<S> {
    /// Stiffness of all springs in series, which acts in slow motions, N/m.
    pub fn stiffness(&self) -> S {
        let (one, inner) = (S::from(1.0), S::from((self.segments - 1) as f64));
        one / (S::from(2.0) / self.end_stiffness + inner / self.inner_stiffness)
    }

    /// Gauge pressure at a spring force in N, Pa.
    #[inline(always)]
    pub fn pressure(&self, force: S) -> S {
        self.filling_pressure + force / self.piston_area
    }

    /// Force in N through each spring, from the rod on: the force through the sensor, then the
    /// forces of the springs behind the plugs, from their deflections in m.
    pub(crate) fn forces(&self, sensed: S, deflections: impl Iterator<Item = S>) -> Vec<S> {
        let behind = deflections.enumerate();
        let behind = behind.map(|(plug, deflection)| self.stiffness_behind(plug + 1) * deflection);
        [sensed].into_iter().chain(behind).collect()
    }

    /// Force through each spring, from the rod on, if the first carries `force` and all oil moves
    /// at a velocity in m/s, N.
    pub(crate) fn steady_forces(&self, force: S, velocity: S) -> Vec<S> {
        let lost = |plugs: usize| S::from(plugs as f64) * self.damping * velocity;
        (0..=self.segments).map(|plugs| force - lost(plugs)).collect()
    }

    /// Frequency above all modes of the oil column between a sensor and a load: twice that of one
    /// plug between its two springs, rad/s.
    ///
    /// ```text
    /// w^2 <= 2 (k_j + k_j+1)/m                                          Gershgorin's circles of K over m
    /// ```
    pub(crate) fn fastest_rad_per_s(&self) -> S {
        let between = |plug: usize| self.stiffness_behind(plug) + self.stiffness_behind(plug + 1);
        let stiffest = (0..self.segments).map(between).fold(S::from(0.0), |most, one| most.maximum(one));
        (S::from(2.0) * stiffest / self.mass).sqrt()
    }
}
